/* demo_assets OUT.glb: models a Noh mask and writes it as a glTF binary.
 * demo_assets --nell OUT.glb: a head and shoulders like a figure of an animated film.
 * demo_assets --puppet OUT.glb: the same mask, worn by an animated puppet.
 * demo_assets --coat OUT.glb: a coat for the puppet.
 * demo_assets --get-up OUT.glb: the puppet's skeleton, with clips that get up from back and front.
 * demo_assets --roam OUT.glb: the same skeleton, with clips that walk wherever a stick points.
 * demo_assets --arm OUT.glb: arms in parts and in one piece, bent and twisted by each kind of skinning.
 * demo_assets --flush OUT.png: where the mask changes colour with its targets (noh build --color-map).
 * demo_assets --festival OUT: a festival's square, as OUT.obj and OUT.mtl. */
#include "festival/festival.h"
#include "mask/flush.h"
#include "mask/gltf_write.h"
#include "mask/mask.h"
#include "nell/nell.h"
#include "shared/grab.h"
#include "arm/arm_write.h"
#include "puppet/puppet_write.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Write to a temporary file first, so that a failure never leaves half of one. */
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
        fprintf(stderr, "demo_assets: cannot write %s\n", path);
        remove(beside);
    }
    free(beside);
    return good;
}

static int make_figure(const char *path, Figure mask)
{
    Buffer file = { 0 };
    Census census = gltf_write(&file, &mask);
    int good = save(path, &file);
    if (good) {
        printf("%s: %d vertices, %d triangles, %d targets, %d animations, %d bytes\n", path, census.vertices,
               census.triangles, census.targets, census.animations, file.count);
    }
    buffer_free(&file);
    figure_free(&mask);
    return good;
}

static int make_puppet(const char *path)
{
    Buffer file = { 0 };
    PuppetCensus census = puppet_write(&file);
    int good = save(path, &file);
    if (good) {
        printf("%s: %d and %d vertices (body and mask), %d triangles, %d joints, %d animations, %d bytes\n", path,
               census.body_vertices, census.mask_vertices, census.triangles, census.joints, census.animations,
               file.count);
    }
    buffer_free(&file);
    return good;
}

/* What belongs to the puppet: clips, or a coat. */
static int make_part(const char *path, PuppetCensus (*write)(Buffer *file))
{
    Buffer file = { 0 };
    PuppetCensus census = write(&file);
    int good = save(path, &file);
    if (good) {
        printf("%s: %d vertices, %d joints, %d animations, %d bytes\n", path, census.body_vertices, census.joints,
               census.animations, file.count);
    }
    buffer_free(&file);
    return good;
}

static int make_arm(const char *path)
{
    Buffer file = { 0 };
    ArmCensus census = arm_write(&file);
    int good = save(path, &file);
    if (good) {
        printf("%s: %d meshes, %d vertices, %d triangles, %d joints, %d animations, %d bytes\n", path, census.meshes,
               census.vertices, census.triangles, census.joints, census.animations, file.count);
    }
    buffer_free(&file);
    return good;
}

static int make_flush(const char *path)
{
    Buffer file = { 0 };
    flush_write(&file);
    int good = save(path, &file);
    buffer_free(&file);
    return good;
}

static int make_festival(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    int length = (int)strlen(path) + 5;
    char *obj = grab(NULL, length, 1), *mtl = grab(NULL, length, 1);
    Buffer model = { 0 }, colors = { 0 };
    snprintf(obj, (size_t)length, "%s.mtl", name);
    FestivalCensus census = festival_write(&model, &colors, obj);
    snprintf(obj, (size_t)length, "%s.obj", path);
    snprintf(mtl, (size_t)length, "%s.mtl", path);
    int good = save(mtl, &colors) && save(obj, &model);
    if (good) {
        printf("%s: %d vertices, %d faces, %d bytes\n", obj, census.vertices, census.faces, model.count);
    }
    free(obj);
    free(mtl);
    buffer_free(&model);
    buffer_free(&colors);
    return good;
}

int main(int argc, char **argv)
{
    if (argc == 2 && argv[1][0] != '-') {
        return make_figure(argv[1], mask_build()) ? 0 : 1;
    }
    if (argc == 3 && !strcmp(argv[1], "--nell")) {
        return make_figure(argv[2], nell_build()) ? 0 : 1;
    }
    if (argc == 3 && !strcmp(argv[1], "--puppet")) {
        return make_puppet(argv[2]) ? 0 : 1;
    }
    if (argc == 3 && !strcmp(argv[1], "--get-up")) {
        return make_part(argv[2], get_up_write) ? 0 : 1;
    }
    if (argc == 3 && !strcmp(argv[1], "--roam")) {
        return make_part(argv[2], roam_write) ? 0 : 1;
    }
    if (argc == 3 && !strcmp(argv[1], "--roam-all")) {
        return make_part(argv[2], roam_all_write) ? 0 : 1;
    }
    if (argc == 3 && !strcmp(argv[1], "--coat")) {
        return make_part(argv[2], coat_write) ? 0 : 1;
    }
    if (argc == 3 && !strcmp(argv[1], "--arm")) {
        return make_arm(argv[2]) ? 0 : 1;
    }
    if (argc == 3 && !strcmp(argv[1], "--flush")) {
        return make_flush(argv[2]) ? 0 : 1;
    }
    if (argc == 3 && !strcmp(argv[1], "--festival")) {
        return make_festival(argv[2]) ? 0 : 1;
    }
    fprintf(
        stderr,
        "usage: demo_assets [--nell|--puppet|--coat|--get-up|--roam|--roam-all|--arm] OUT.glb, "
        "demo_assets --flush OUT.png, or demo_assets --festival OUT\n");
    return 2;
}
