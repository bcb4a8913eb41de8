/* walker_cpu.c: a figure walks and speaks, without a GPU and without a stage. Prints its footsteps, draws its last
 * frame.
 *
 *   walker_cpu PACK [SECONDS] [-o OUT.ppm]        default: 2 seconds, walker_cpu.ppm
 *
 * open_walker has the calls that a game makes once, frame the calls of each frame. */
#include <stdlib.h>
#include <string.h>

#include "noh/deform.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "picture.h"

#define FRAME_TICKS (NOH_TICKS_PER_SECOND / 60u)

typedef struct walker {
    noh_pack pack;
    noh_clip_bank *bank; /* the pack's clips */
    noh_controller *controller;
    noh_pose_scratch scratch;
    noh_transform *pose;            /* [joint_count] */
    float *floats;                  /* [float_count] morph weights and named floats */
    float *model, *matrices, *sums; /* of the skeleton, of a skin, of a mesh's targets */
    noh_root_pose root;             /* root motion of the clips */
} walker;

static unsigned char file[8u << 20] ALIGNED_16;
static unsigned char memory[4u << 20] ALIGNED_16; /* all memory for noh */
static picture image;

static int fail(const char *what, const noh_error *error)
{
    fprintf(stderr, "%s: %s (at %lu, need %lu)\n", what, error->what, (unsigned long)error->where,
            (unsigned long)error->need);
    return 1;
}

static void on_key(void *user, const noh_event *event)
{
    const walker *w = (const walker *)user;
    noh_pack_clip clip;
    if (noh_pack_clip_at(&w->pack, w->bank->pack_clips[event->clip], &clip, NULL) == NOH_OK) {
        printf("%5.2f s  %s\n", (double)event->clock / NOH_TICKS_PER_SECOND,
               noh_pack_string(&w->pack, clip.events[event->index].name));
    }
}

/* Play a clip if the pack has it. */
static int start(walker *w, uint32_t track, const char *name)
{
    noh_track_desc desc;
    noh_error error;
    memset(&desc, 0, sizeof desc);
    desc.clip = noh_clip_bank_find(w->bank, name);
    if (desc.clip == NOH_NONE) return 0;
    return noh_controller_start(w->controller, &w->bank->clips, track, &desc, &error) ? fail(name, &error) : 0;
}

/* Create the objects that move the figure, from one block. */
static int open_walker(walker *w)
{
    noh_arena arena = noh_arena_over(memory, sizeof memory);
    noh_clip_bank_desc clips;
    noh_controller_desc tracks;
    noh_error error;
    size_t bytes;
    memset(&clips, 0, sizeof clips);
    memset(&tracks, 0, sizeof tracks);
    clips.clips = &w->pack;
    clips.root_axes = NOH_ROOT_GROUND;
    clips.root_up = 1;
    bytes = noh_clip_bank_size(&clips, &error);
    if (!bytes || noh_clip_bank_init(noh_arena_carve(&arena, bytes, 16), bytes, &clips, &w->bank, &error))
        return fail("clips", &error);
    tracks.set = &w->bank->clips;
    bytes = noh_controller_size(&tracks);
    if (noh_controller_init(noh_arena_carve(&arena, bytes, 16), bytes, &tracks, &w->controller, &error))
        return fail("controller", &error);
    bytes = noh_pose_scratch_size(tracks.set, 0);
    if (noh_pose_scratch_init(noh_arena_carve(&arena, bytes, 16), bytes, tracks.set, 0, &w->scratch, &error))
        return fail("pose scratch", &error);
    w->pose = (noh_transform *)noh_arena_carve(&arena, tracks.set->joint_count * sizeof *w->pose, 16);
    w->floats = (float *)noh_arena_carve(&arena, tracks.set->float_count * sizeof(float), 16);
    w->model = (float *)noh_arena_carve(&arena, tracks.set->joint_count * 12u * sizeof(float), 16);
    w->matrices = (float *)noh_arena_carve(&arena, NOH_SKIN_JOINTS_MAX * 12u * sizeof(float), 16);
    w->sums = (float *)noh_arena_carve(&arena, sizeof memory - arena.used - 64u, 16);
    return start(w, 0, "walk") || start(w, 1, "speak");
}

static void frame(walker *w)
{
    const noh_clip_set *set = &w->bank->clips;
    noh_root_pose moved;
    noh_clip_cache_begin_frame(w->bank->cache);
    noh_controller_step(w->controller, set, FRAME_TICKS, on_key, w);
    moved = noh_controller_root_motion(w->controller, set);
    w->root = noh_root_compose(1, &w->root, &moved);
    noh_controller_pose(w->controller, set, &w->scratch, w->pose, w->floats);
}

/* Morph, skin and draw a mesh. */
static int draw(const walker *w, uint32_t index)
{
    noh_morph_layers layers;
    noh_error error;
    noh_skin skin;
    noh_mesh mesh;
    const float *weights = noh_clip_bank_mesh_weights(w->bank, w->floats, index);
    if (noh_pack_mesh_at(&w->pack, index, &mesh, &error)) return fail("mesh", &error);
    if (noh_pack_skin_at(&w->pack, mesh.header->skin, &skin, NULL)) return 0; /* rigid: not part of the figure */
    if (noh_morph_layers_init(w->sums, sizeof memory / 2u, &mesh, &layers, &error)) return fail(mesh.name, &error);
    noh_morph_accumulate(&mesh, weights ? weights : mesh.weights, &layers);
    noh_pose_skin(&w->bank->skeleton, &skin, w->pose, w->model, w->matrices);
    for (uint32_t s = 0; s < mesh.header->submesh_count; s++) {
        const noh_submesh *part = &mesh.submeshes[s];
        const float *tint = part->material == NOH_NONE ? picture_white : w->pack.materials[part->material].base_color;
        for (uint32_t i = 0; i < part->index_count; i++) {
            noh_vertex v;
            noh_skin_vertex(&mesh, w->matrices, &layers, noh_mesh_index(&mesh, part->first_index + i), &v);
            picture_corner(&image, i % 3u, v.position, v.normal, v.color, tint);
        }
    }
    return 0;
}

int main(int argc, char **argv)
{
    static const float centre[3] = { 0.0f, 0.78f, 0.0f };
    static walker w;
    const char *out = argc > 4 ? argv[4] : argc == 4 && !strcmp(argv[2], "-o") ? argv[3] : "walker_cpu.ppm";
    const double seconds = argc == 3 || argc > 4 ? atof(argv[2]) : 2.0;
    noh_error error;
    size_t bytes = argc > 1 ? picture_read(argv[1], file, sizeof file) : 0;
    if (argc < 2 || noh_pack_open(file, bytes, &w.pack, &error)) return argc < 2 ? 2 : fail(argv[1], &error);
    if (open_walker(&w)) return 1;
    for (unsigned i = 0; i < (unsigned)(60.0 * seconds + 0.5); i++) frame(&w);
    printf("%.2f m from where it began\n", w.root.translation[2]);
    picture_clear(&image, centre, 1.75f);
    for (uint32_t i = 0; i < w.pack.runs[NOH_CHUNK_MESH].count; i++) {
        if (draw(&w, i)) return 1;
    }
    return picture_save(&image, out);
}
