/* lod_compare: our LOD levels against meshoptimizer's, at equal triangle counts, in one run.
 *
 *   lod_compare FILE.glb [--fast] [--picture OUT.png]
 *
 * The file's first mesh, at 50, 25 and 10 % of its triangles. The builder sees rest, targets, its own random mixes and,
 * of a skinned mesh, 12 frames; compared are all targets, 20 other mixes and 28 other frames. Each submesh of
 * meshoptimizer's level has as many triangles as ours, or as few as meshoptimizer reaches. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "compare.h"

#define UNSEEN_MIXES 20u
#define UNSEEN_FRAMES 28u
#define SEEN_FRAMES 12u

static int fail(const char *what, const char *where)
{
    fprintf(stderr, "lod_compare: %s %s\n", what, where);
    return 1;
}

void *compare_zeros(size_t count, size_t bytes)
{
    void *p = calloc(count + 1u, bytes);
    if (!p) {
        exit(fail("out of memory", ""));
    }
    return p;
}

uint32_t find_submesh(const model *m, const model_mesh *mesh, const char *material)
{
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        if (mesh->submeshes[s].material != MODEL_NONE &&
            !strcmp(m->materials[mesh->submeshes[s].material].name, material)) {
            return s;
        }
    }
    return MODEL_NONE;
}

void box_of(const model_mesh *mesh, uint32_t submesh, const float *position, float border, float *box)
{
    const model_submesh *sub = &mesh->submeshes[submesh];
    for (uint32_t i = 0; i < sub->index_count; i++) {
        const float *p = position + (size_t)mesh->indices[sub->first_index + i] * 3u;
        box[0] = i == 0 || p[0] - border < box[0] ? p[0] - border : box[0];
        box[1] = i == 0 || p[1] - border < box[1] ? p[1] - border : box[1];
        box[2] = i == 0 || p[0] + border > box[2] ? p[0] + border : box[2];
        box[3] = i == 0 || p[1] + border > box[3] ? p[1] + border : box[3];
    }
}

static void show_progress(void *user, uint32_t done, uint32_t total)
{
    (void)user;
    fprintf(stderr, "\r%3u %%", (uint32_t)(100.0 * done / (total ? total : 1u)));
}

static lod *build(const model *m, lod_mode mode, model_error *error)
{
    lod_options o = { 0 };
    lod_frames seen = { 0 };
    lod *l = NULL;
    uint32_t node = lod_skinned_node(m, 0);
    clock_t start = clock();
    if (node != MODEL_NONE && lod_frames_choose(m, node, SEEN_FRAMES, &seen)) {
        snprintf(error->what, sizeof error->what, "frames could not be skinned");
        return NULL;
    }
    o.mode = mode;
    o.poses = (const float *const *)seen.poses;
    o.pose_count = seen.count;
    o.progress = show_progress;
    if (!lod_build(&m->meshes[0], &o, &l, error)) {
        printf("\r built in %.1f s of processor time\n", (double)(clock() - start) / CLOCKS_PER_SEC);
    }
    lod_frames_free(&seen);
    return l;
}

static int compare(const model *m, const lod *ours, const char *picture)
{
    const model_mesh *mesh = &m->meshes[0];
    lod *peer = peer_levels(mesh, ours);
    figures a[LOD_LEVELS_MAX], b[LOD_LEVELS_MAX];
    float pixel_mm[LOD_LEVELS_MAX];
    shapes unseen;
    int failed = 0;
    shapes_make(m, 0, UNSEEN_MIXES, UNSEEN_FRAMES, &unseen);
    for (uint32_t i = 0; i < ours->level_count; i++) {
        figures_of(m, mesh, &ours->levels[i], &unseen, &a[i]);
        figures_of(m, mesh, &peer->levels[i], &unseen, &b[i]);
        pixel_mm[i] = a[i].targets > a[i].mixes ? a[i].targets : a[i].mixes;
    }
    figures_print(ours, a, b);
    if (picture && !pictures_write(m, mesh, ours, peer, pixel_mm, picture)) {
        failed = fail("cannot write", picture);
    }
    shapes_free(&unseen);
    lod_free(peer);
    return failed;
}

int main(int argument_count, char **arguments)
{
    const char *picture = NULL;
    lod_mode mode = LOD_QUALITY;
    model_error error = { "", "" };
    model *m = NULL;
    lod *ours;
    int failed;
    for (int i = 2; i < argument_count; i++) {
        if (!strcmp(arguments[i], "--fast")) {
            mode = LOD_FAST;
        } else if (!strcmp(arguments[i], "--picture") && i + 1 < argument_count) {
            picture = arguments[++i];
        } else {
            return fail("does not know", arguments[i]) + 1;
        }
    }
    if (argument_count < 2) {
        return fail("FILE.glb [--fast] [--picture OUT.png]", "") + 1;
    }
    if (model_read_gltf(arguments[1], &m, &error)) {
        return fail(error.what, error.where);
    }
    if (!m->mesh_count) {
        return fail("no mesh in", arguments[1]);
    }
    printf("%s\n", arguments[1]);
    ours = build(m, mode, &error);
    if (!ours) {
        return fail(error.what, error.where);
    }
    failed = compare(m, ours, picture);
    lod_free(ours);
    model_free(m);
    return failed;
}
