/* lod_compare: our LOD levels against meshoptimizer's, at equal triangle counts, in one run.
 *
 *   lod_compare FILE.glb [--fast] [--picture OUT.png] [--npm SCRIPT FOLDER]
 *
 * The mesh with the most vertices and targets, at 50, 25 and 10 % of its triangles; the last level has vertices of its
 * own where they are few, as in packs (not with --fast). The builder sees rest, targets, its own random mixes and, of a
 * skinned mesh, 12 frames; compared are all targets, 20 other mixes and 28 other frames. Each submesh of meshoptimizer's
 * level has as many triangles as ours, or as few as meshoptimizer reaches.
 *
 * There are two peers. Debian's meshoptimizer sees positions alone. The npm package's, with --npm, sees the targets as
 * attributes, too: at most 32 numbers for each vertex, so the directions in which the targets vary most. Of several
 * weights each level has the one with the least error over targets and mixes. SCRIPT is meshopt.mjs; files for it are
 * left in FOLDER; NODE_PATH says where the package is. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "compare.h"
#include "convert/lod/lod_fit.h"

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

typedef struct settings {
    const char *picture, *script, *folder; /* NULL: none */
    lod_mode mode;
    uint32_t mesh;
} settings;

/* The mesh with the most vertices times shapes. */
static uint32_t largest_mesh(const model *m)
{
    uint32_t best = 0;
    size_t most = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        size_t work = (size_t)m->meshes[i].vertex_count * (1u + m->meshes[i].target_count);
        best = work > most ? i : best;
        most = work > most ? work : most;
    }
    return best;
}

static lod *build(const model *m, const settings *s, model_error *error)
{
    lod_options o = { 0 };
    lod_frames seen = { 0 };
    lod *l = NULL;
    uint32_t node = lod_skinned_node(m, s->mesh);
    clock_t start = clock();
    if (node != MODEL_NONE && lod_frames_choose(m, node, SEEN_FRAMES, &seen)) {
        snprintf(error->what, sizeof error->what, "frames could not be skinned");
        return NULL;
    }
    o.mode = s->mode;
    o.poses = (const float *const *)seen.poses;
    o.pose_count = seen.count;
    o.progress = show_progress;
    if (!lod_build(&m->meshes[s->mesh], &o, &l, error)) {
        printf("\r built in %.1f s of processor time\n", (double)(clock() - start) / CLOCKS_PER_SEC);
    }
    lod_frames_free(&seen);
    return l;
}

/* Of each level but the full mesh, the figures with its best weight, and that weight. Returns 0 if that peer cannot be
 * had. */
static int measure_npm(const model *m, const lod *ours, const settings *s, const shapes *unseen, figures *out,
                       float *weights)
{
    const model_mesh *mesh = &m->meshes[s->mesh];
    peer_npm peer;
    if (!s->script) {
        printf(" npm: no node, or no meshoptimizer from npm: left out\n");
        return 0;
    }
    if (peer_npm_levels(mesh, ours, s->script, s->folder, &peer)) {
        printf(" npm: meshoptimizer failed: left out\n");
        return 0;
    }
    printf(" npm: its attributes hold %.2f %% of what the targets do\n", 100.0 * (double)peer.kept);
    for (uint32_t i = 1; i < ours->level_count; i++) {
        uint32_t best = 0;
        float least = INFINITY;
        for (uint32_t w = 0; w < PEER_WEIGHTS; w++) {
            float error = figures_skin(mesh, &peer.levels[w]->levels[i], unseen);
            best = error < least ? w : best;
            least = error < least ? error : least;
        }
        figures_of(m, mesh, &peer.levels[best]->levels[i], unseen, &out[i]);
        weights[i] = peer.weights[best];
    }
    peer_npm_free(&peer);
    return 1;
}

/* Vertices of its own for the coarsest level, as in packs. The poses are made again, since the mesh has more vertices
 * then. */
static void own_vertices(model *m, uint32_t index, lod *ours, shapes *unseen)
{
    model_mesh *mesh = &m->meshes[index];
    const uint32_t before = mesh->vertex_count;
    model_error error = { "", "" };
    const uint32_t k = ours->level_count - 1u;
    if ((float)ours->levels[k].vertex_count <= LOD_OWN_SHARE * (float)before) {
        if (lod_fit(mesh, &ours->levels[k], &error)) {
            exit(fail(error.what, error.where));
        }
        printf(" vertices of its own: %u in level %u, the mesh has %u\n", mesh->vertex_count - before, k, before);
        shapes_free(unseen);
        shapes_make(m, index, UNSEEN_MIXES, UNSEEN_FRAMES, unseen);
    }
}

static int compare(model *m, lod *ours, const settings *s)
{
    const model_mesh *mesh = &m->meshes[s->mesh];
    lod *peer = peer_levels(mesh, ours);
    figures a[LOD_LEVELS_MAX], b[LOD_LEVELS_MAX], c[LOD_LEVELS_MAX];
    float pixel_mm[LOD_LEVELS_MAX], weights[LOD_LEVELS_MAX];
    shapes unseen;
    int failed = 0, npm;
    shapes_make(m, s->mesh, UNSEEN_MIXES, UNSEEN_FRAMES, &unseen);
    for (uint32_t i = 0; i < ours->level_count; i++) {
        figures_of(m, mesh, &peer->levels[i], &unseen, &b[i]);
    }
    npm = measure_npm(m, ours, s, &unseen, c, weights);
    if (s->mode == LOD_QUALITY) {
        own_vertices(m, s->mesh, ours, &unseen);
    }
    for (uint32_t i = 0; i < ours->level_count; i++) {
        figures_of(m, mesh, &ours->levels[i], &unseen, &a[i]);
        pixel_mm[i] = a[i].targets > a[i].mixes ? a[i].targets : a[i].mixes;
    }
    figures_print(ours, a, b, npm ? c : NULL, npm ? weights : NULL);
    if (s->picture && !pictures_write(m, mesh, ours, peer, pixel_mm, s->picture)) {
        failed = fail("cannot write", s->picture);
    }
    shapes_free(&unseen);
    lod_free(peer);
    return failed;
}

static int read_settings(int argument_count, char **arguments, settings *s)
{
    s->picture = s->script = s->folder = NULL;
    s->mode = LOD_QUALITY;
    for (int i = 2; i < argument_count; i++) {
        if (!strcmp(arguments[i], "--fast")) {
            s->mode = LOD_FAST;
        } else if (!strcmp(arguments[i], "--picture") && i + 1 < argument_count) {
            s->picture = arguments[++i];
        } else if (!strcmp(arguments[i], "--npm") && i + 2 < argument_count) {
            s->script = arguments[++i];
            s->folder = arguments[++i];
        } else {
            return fail("does not know", arguments[i]) + 1;
        }
    }
    return argument_count < 2 ? fail("FILE.glb [--fast] [--picture OUT.png] [--npm SCRIPT FOLDER]", "") + 1 : 0;
}

int main(int argument_count, char **arguments)
{
    settings s;
    model_error error = { "", "" };
    model *m = NULL;
    lod *ours;
    int failed = read_settings(argument_count, arguments, &s);
    if (failed) {
        return failed;
    }
    if (model_read_gltf(arguments[1], &m, &error)) {
        return fail(error.what, error.where);
    }
    if (!m->mesh_count) {
        return fail("no mesh in", arguments[1]);
    }
    s.mesh = largest_mesh(m);
    printf("%s, mesh %s: %u triangles, %u targets\n", arguments[1], m->meshes[s.mesh].name,
           m->meshes[s.mesh].index_count / 3u, m->meshes[s.mesh].target_count);
    ours = build(m, &s, &error);
    if (!ours) {
        return fail(error.what, error.where);
    }
    failed = compare(m, ours, &s);
    lod_free(ours);
    model_free(m);
    return failed;
}
