#include "gltf_write.h"

#include "animate.h"
#include "mask_write.h"
#include "targets.h"

#include <stddef.h>

static void write_animations(Writer *w, Buffer *json, const Figure *figure)
{
    buffer_print(json, "\"animations\":[\n");
    for (int i = 0; i < figure->animation_count; i++) {
        Animation animation = figure->animation(i);
        int times = write_scalars(w, animation.times, animation.key_count, 1);
        int values = write_scalars(w, animation.values, animation.value_count, 0);
        buffer_print(json,
                     "%s{\"name\":\"%s\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,"
                     "\"path\":\"weights\"}}],\"samplers\":[{\"input\":%d,\"output\":%d,"
                     "\"interpolation\":\"%s\"}]}",
                     i ? ",\n" : "", animation.name, times, values, animation.interpolation);
        animation_free(&animation);
    }
    buffer_print(json, "],\n");
}

Census gltf_write(Buffer *file, const Figure *mask)
{
    Writer w = { 0 };
    Buffer json = { 0 };
    buffer_print(&json,
                 "{\"asset\":{\"version\":\"2.0\",\"generator\":\"noh demo_assets\"},\n"
                 "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\n"
                 "\"nodes\":[{\"name\":\"%s\",\"mesh\":0}],\n"
                 "\"materials\":[",
                 mask->name);
    materials_write(&json, mask->materials, mask->model.part_count);
    buffer_print(&json, "],\n\"meshes\":[");
    mask_mesh_write(&w, &json, mask, NULL);
    buffer_print(&json, "],\n");
    if (mask->animation_count) {
        write_animations(&w, &json, mask);
    }
    writer_finish(&w, &json, file);
    buffer_free(&json);
    Census census = { .targets = mask->target_count, .animations = mask->animation_count };
    for (int i = 0; i < mask->model.part_count; i++) {
        census.vertices += mask->model.parts[i].seed_count;
        census.triangles += mask->model.parts[i].index_count / 3;
    }
    return census;
}
