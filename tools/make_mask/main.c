/* make_mask OUT.glb: models a Noh mask and writes it as a glTF binary. */
#include "colour.h"
#include "gltf_write.h"
#include "occlusion.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Writes beside the file first, so that a failure never leaves half of one. */
static int save(const char *path, const Buffer *file)
{
    int length = (int)strlen(path) + 5;
    char *beside = grab(NULL, length, 1);
    snprintf(beside, (size_t)length, "%s.tmp", path);
    FILE *out = fopen(beside, "wb");
    int good = out && fwrite(file->bytes, 1, (size_t)file->count, out) == (size_t)file->count;
    if (out && fclose(out)) {
        good = 0;
    }
    if (good && rename(beside, path)) {
        good = 0;
    }
    if (!good) {
        fprintf(stderr, "make_mask: cannot write %s\n", path);
        remove(beside);
    }
    free(beside);
    return good;
}

int main(int argc, char **argv)
{
    static const Pose rest;
    if (argc != 2) {
        fprintf(stderr, "usage: make_mask OUT.glb\n");
        return 2;
    }
    Model model = { 0 };
    Frame frames[PART_COUNT];
    int *weld[PART_COUNT];
    double *open[PART_COUNT];
    model_build(&model);
    for (int i = 0; i < PART_COUNT; i++) {
        weld[i] = mesh_weld(&model.parts[i]);
        frames[i] = mesh_frame(&model.parts[i], weld[i], &rest);
    }
    occlusion_bake(&model, frames, open);
    colour_bake(&model, frames, open);
    Buffer file = { 0 };
    Census census = gltf_write(&file, &model, frames, weld);
    int good = save(argv[1], &file);
    if (good) {
        printf("%s: %d vertices, %d triangles, %d targets, %d animations, %d bytes\n", argv[1],
               census.vertices, census.triangles, census.targets, census.animations, file.count);
    }
    for (int i = 0; i < PART_COUNT; i++) {
        mesh_free(&frames[i]);
        free(weld[i]);
        free(open[i]);
    }
    buffer_free(&file);
    model_free(&model);
    return good ? 0 : 1;
}
