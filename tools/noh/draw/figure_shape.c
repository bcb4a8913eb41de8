/* figure_shape.c: the shape of a figure in its pose, on the CPU: levels, joints, vertices, bounds. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "convert/base/names.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "figure.h"

/* ---- meshes and levels ---- */

int figure_draws(const noh_pack *pack)
{
    for (uint32_t i = 0; i < pack->node_count; i++) {
        if (pack->nodes[i].mesh != NOH_NONE) return 1;
    }
    return !pack->node_count && pack->runs[NOH_CHUNK_MESH].count;
}

uint32_t figure_level_count(const noh_pack *pack)
{
    uint32_t most = 1;
    noh_mesh mesh;
    for (uint32_t i = 0; noh_pack_mesh_at(pack, i, &mesh, NULL) == NOH_OK; i++) {
        most = mesh.header->level_count > most ? mesh.header->level_count : most;
    }
    return most;
}

uint32_t figure_level_first(const noh_pack *pack)
{
    uint32_t least = pack->runs[NOH_CHUNK_MESH].count ? NOH_LOD_LEVELS_MAX : 0;
    noh_mesh mesh;
    for (uint32_t i = 0; noh_pack_mesh_at(pack, i, &mesh, NULL) == NOH_OK; i++) {
        least = mesh.header->level_first < least ? mesh.header->level_first : least;
    }
    return least;
}

int figure_check_level(const pack_file *file, uint32_t level)
{
    const uint32_t count = figure_level_count(&file->pack);
    return level < count
               ? 0
               : tool_fail(file->path, "no LOD level %u: the pack has %u level%s (`noh build --lod N` makes them)",
                           level, count, plural(count));
}

uint32_t figure_triangles(const figure *f, uint32_t level)
{
    uint32_t triangles = 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        const noh_kind_plan *plan = &f->plan.kinds[k];
        triangles += plan->levels[level < plan->level_count ? level : plan->level_count - 1u].triangle_count;
    }
    return triangles;
}

/* ---- joints ---- */

float *figure_joints(const figure *f, uint32_t kind, noh_skeleton *skeleton)
{
    float *matrices;
    if (noh_pack_skeleton_at(f->kinds[kind].mesh, f->kinds[kind].skeleton, skeleton, NULL, NULL)) {
        return NULL;
    }
    matrices = calloc(skeleton->joint_count, 12u * sizeof *matrices);
    for (uint32_t j = 0; matrices && j < skeleton->joint_count; j++) {
        (void)noh_actor_joint(f->stage, f->actors[kind], j, matrices + 12u * (size_t)j, NULL);
    }
    return matrices;
}

void figure_anchor(const figure *f, double anchor[3])
{
    float joint[12];
    const int has = noh_actor_joint(f->stage, f->actors[0], 0, joint, NULL) == NOH_OK;
    anchor[0] = has ? (double)joint[3] : 0.0;
    anchor[1] = 0.0;
    anchor[2] = has ? (double)joint[11] : 0.0;
    if (has && f->desc.body) {
        const float at[3] = { joint[3], 0.0f, joint[11] };
        anchor[1] = (double)figure_body_height(f->desc.body, at);
    }
}

/* ---- vertices ---- */

static void deform(const noh_mesh *mesh, const noh_actor_mesh *shown, const float *matrices,
                   const noh_dual_quaternion *dual, const noh_morph_layers *layers, noh_vertex *vertices)
{
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        if (dual) {
            noh_skin_vertex_dual(mesh, dual, layers, v, &vertices[v]);
        } else if (shown->joint_count) {
            noh_skin_vertex(mesh, matrices, layers, v, &vertices[v]);
        } else {
            noh_morph_vertex(mesh, layers, v, &vertices[v]);
        }
    }
}

noh_vertex *figure_deform(const figure *f, uint32_t kind, uint32_t index, uint32_t level, noh_mesh *mesh,
                          noh_actor_mesh *shown)
{
    const int found = noh_actor_mesh_at(f->stage, f->actors[kind], index, shown, NULL, NULL) == NOH_OK;
    const size_t joints = found ? shown->joint_count + 1u : 1u;
    float *matrices = malloc(joints * 12u * sizeof *matrices);
    noh_dual_quaternion *dual = malloc(joints * sizeof *dual);
    noh_vertex *vertices = NULL;
    noh_morph_layers layers;
    void *memory = NULL;
    if (found) {
        (void)noh_pack_mesh_at(f->kinds[kind].mesh, shown->mesh, mesh, NULL);
        *mesh = noh_mesh_at_lod(mesh, level);
        vertices = malloc(sizeof *vertices * (mesh->header->vertex_count + 1u));
        memory = malloc(noh_morph_layers_size(mesh) + 16u);
    }
    if (matrices && dual && vertices && memory) {
        const int is_dual = shown->joint_count && mesh->header->flags & NOH_MESH_DUAL_QUATERNION;
        (void)noh_actor_mesh_at(f->stage, f->actors[kind], index, shown, matrices, NULL);
        if (is_dual) noh_skin_dual_quaternions(matrices, shown->joint_count, dual);
        noh_morph_layers_init(memory, noh_morph_layers_size(mesh) + 16u, mesh, &layers, NULL);
        noh_morph_accumulate(mesh, shown->weights, &layers);
        deform(mesh, shown, matrices, is_dual ? dual : NULL, &layers, vertices);
    } else {
        tool_fail(f->desc.file->path, found ? "out of memory" : "it is not posed");
        free(vertices);
        vertices = NULL;
    }
    free(memory);
    free(matrices);
    free(dual);
    return vertices;
}

/* ---- bounds ---- */

static void grow(bounds *b, const double p[3])
{
    for (int c = 0; c < 3; c++) {
        b->low[c] = fmin(b->low[c], p[c]);
        b->high[c] = fmax(b->high[c], p[c]);
    }
}

static void grow_mesh(bounds *b, const noh_mesh *mesh, const noh_vertex *vertices, const float world[12], int face,
                      double above)
{
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        const float *p = vertices[v].position;
        double placed[3];
        if (face && noh_mesh_accumulation_texel(mesh, v) >= mesh->header->touched_count) {
            continue;
        }
        for (int r = 0; r < 3; r++) {
            const float *row = world + 4 * r;
            placed[r] = (double)row[0] * p[0] + (double)row[1] * p[1] + (double)row[2] * p[2] + (double)row[3];
        }
        if (placed[1] >= above) grow(b, placed);
    }
}

/* face: only what targets move; above: only what is as high; low above high where nothing is */
static bounds measure(const figure *f, int face, double above)
{
    bounds b = { { INFINITY, INFINITY, INFINITY }, { -INFINITY, -INFINITY, -INFINITY } };
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        for (uint32_t i = 0; i < f->plan.kinds[k].mesh_count; i++) {
            noh_mesh mesh;
            noh_actor_mesh shown;
            noh_vertex *vertices = figure_deform(f, k, i, NOH_LOD_LEVELS_MAX, &mesh, &shown);
            if (vertices) grow_mesh(&b, &mesh, vertices, shown.world, face, above);
            free(vertices);
        }
    }
    return b;
}

#define NECK_TO_CROWN 1.2 /* a head's width, in its height over its joint */
#define HEAD_MAX 0.3      /* of the figure's height */

/* The box over a joint, no wider than heads are. */
static bounds over_joint(const bounds *all, const float joint[12])
{
    const double high = all->high[1] - (double)joint[7];
    bounds b = *all;
    b.low[1] = (double)joint[7];
    for (int c = 0; c < 3; c += 2) {
        b.low[c] = fmax(b.low[c], (double)joint[3 + 4 * c] - 0.5 * NECK_TO_CROWN * high);
        b.high[c] = fmin(b.high[c], (double)joint[3 + 4 * c] + 0.5 * NECK_TO_CROWN * high);
    }
    return b;
}

/* The head of a figure whose face no target moves, by the joint that a name calls its head; 0: there is none. */
static int head_by_joint(const figure *f, const bounds *all, bounds *head)
{
    const char *name;
    for (uint32_t j = 0; (name = noh_stage_name(f->stage, 0, NOH_NAME_JOINT, j)) != NULL; j++) {
        char means[NOH_NAME_BYTES_MAX];
        float joint[12];
        if (!names_find(NAME_JOINT, name, means, NULL) || strcmp(means, "head") != 0 ||
            noh_actor_joint(f->stage, f->actors[0], j, joint, NULL) != NOH_OK) {
            continue;
        }
        *head = over_joint(all, joint);
        return head->high[1] > head->low[1] && head->high[1] - head->low[1] < HEAD_MAX * (all->high[1] - all->low[1]);
    }
    return 0;
}

#define FACE_IS_ALL \
    0.3               /* of the figure's height: a face as high is a head alone or a bust; of a body it is a seventh */
#define HAIR_OVER 0.1 /* of the figure's height: hair may reach over its meshes by as much */

/* The face with its hair and ears, within the figure: the room around it, of its height, and as much as what is over
 * the chin reaches, tails and hats, not arms. */
static bounds around_face(const figure *f, const bounds *all, bounds face)
{
    const double high = face.high[1] - face.low[1];
    const double hair = f->hair.is_there ? HAIR_OVER * (all->high[1] - all->low[1]) : 0.0;
    const bounds head = bounds_turned(measure(f, 0, face.low[1]), -f->facing);
    /* a drawn head is half hair, over the face and behind it */
    const double below[3] = { 0.35, 0.12, 1.3 }, above[3] = { 0.35, 0.9, 0.35 }, most[3] = { 1.2, 1.8, 2.6 };
    bounds b;
    for (int c = 0; c < 3; c++) {
        b.low[c] = fmax(face.low[c] - below[c] * high, all->low[c] - (c != 1 ? hair : 0.0));
        b.high[c] = fmin(face.high[c] + above[c] * high, all->high[c] + (c < 2 ? hair : 0.0));
        if (c != 1) b.low[c] = fmin(b.low[c], fmax(head.low[c], face.low[c] - most[c] * high));
        if (c != 2) b.high[c] = fmax(b.high[c], fmin(head.high[c], face.high[c] + most[c] * high));
    }
    return b;
}

/* A head with its neck and hair. */
static bounds around_head(const bounds *all, bounds head)
{
    const double high = head.high[1] - head.low[1];
    head.low[1] = fmax(head.low[1] - 0.4 * high, all->low[1]);
    return head;
}

#define UPPER_SHARE 0.45 /* of the height of a body */

static bounds upper_of(bounds box)
{
    const double high = UPPER_SHARE * (box.high[1] - box.low[1]), middle = 0.5 * (box.low[0] + box.high[0]);
    box.low[1] = box.high[1] - high;
    box.low[0] = fmax(box.low[0], middle - 0.5 * high);
    box.high[0] = fmin(box.high[0], middle + 0.5 * high);
    return box;
}

static int is_head(const bounds *all, const bounds *face)
{
    return face->high[1] - face->low[1] > FACE_IS_ALL * (all->high[1] - all->low[1]);
}

int figure_is_head(const figure *f)
{
    const bounds all = measure(f, 0, -INFINITY), face = measure(f, 1, -INFINITY);
    return face.low[0] <= face.high[0] && is_head(&all, &face);
}

bounds figure_bounds(const figure *f, view_frame frame)
{
    const bounds all = measure(f, 0, -INFINITY), none = { { 0.0, 0.0, 0.0 }, { 0.0, 0.0, 0.0 } };
    if (all.low[0] > all.high[0]) return none;
    if (frame == FRAME_FULL) return all;
    const bounds own = bounds_turned(all, -f->facing);
    bounds face = measure(f, 1, -INFINITY);
    if (face.low[0] <= face.high[0] && (frame == FRAME_FACE || is_head(&all, &face))) {
        return bounds_turned(around_face(f, &own, bounds_turned(face, -f->facing)), f->facing);
    }
    if (frame == FRAME_FACE && head_by_joint(f, &all, &face)) return around_head(&all, face);
    return frame == FRAME_UPPER ? bounds_turned(upper_of(own), f->facing) : all;
}

const noh_clip_entry *figure_clip(const figure *f, uint32_t kind, const char *name)
{
    const uint32_t index = noh_stage_find(f->stage, kind, NOH_NAME_CLIP, name);
    const noh_clip_set *set = NULL;
    if (index == NOH_NONE || !noh_actor_controller(f->stage, f->actors[kind], &set)) return NULL;
    return &set->clips[index];
}

view_frame figure_framed(const figure *f, view_frame frame, const option_list *clips)
{
    if (frame != FRAME_AUTO || !clips->count) return frame;
    for (int i = 0; i < clips->count; i++) {
        for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
            const noh_clip_entry *entry = figure_clip(f, k, clips->items[i]);
            if (entry && !(entry->flags & NOH_CLIP_FLOATS_ONLY)) return FRAME_AUTO;
        }
    }
    return FRAME_FACE;
}
