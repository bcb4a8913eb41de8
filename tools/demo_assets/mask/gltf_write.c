#include "gltf_write.h"

#include "animate.h"
#include "mask_write.h"
#include "targets.h"

#include <stddef.h>

static void write_animations(Writer *w, Buffer *json)
{
    buffer_print(json, "\"animations\":[\n");
    for (int i = 0; i < ANIMATION_COUNT; i++) {
        Animation animation = animation_make(i);
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

Census gltf_write(Buffer *file, const Mask *mask)
{
    Writer w = { 0 };
    Buffer json = { 0 };
    buffer_print(&json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"noh demo_assets\"},\n"
                        "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\n"
                        "\"nodes\":[{\"name\":\"mask\",\"mesh\":0}],\n"
                        "\"materials\":[");
    mask_materials_write(&json);
    buffer_print(&json, "],\n\"meshes\":[");
    mask_mesh_write(&w, &json, mask, NULL);
    buffer_print(&json, "],\n");
    write_animations(&w, &json);
    writer_finish(&w, &json, file);
    buffer_free(&json);
    Census census = { .targets = target_count(), .animations = ANIMATION_COUNT };
    for (int i = 0; i < PART_COUNT; i++) {
        census.vertices += mask->model.parts[i].seed_count;
        census.triangles += mask->model.parts[i].index_count / 3;
    }
    return census;
}
