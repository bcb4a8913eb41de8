/* stage_face_eyes.c: where the eyes of a kind are at rest: at their joints, behind what blinks, or behind what targets of
 * looks move. */
#include <string.h>

#include "core/base/math_internal.h"
#include "deform/morph/morph_kernel_internal.h"
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/face.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/modules/stage_face_internal.h"

#define BEHIND_LIDS 0.19f /* of the distance of the eyes: their centres lie behind the lids, and behind their fronts */
#define APART_MIN 1e-3f   /* model units */

/* What moves on one side of the face. */
typedef struct lid {
    float at[3], weight;
} lid;

typedef struct search {
    const noh_kind_desc *kind;
    noh_skeleton skeleton;
    noh_face_link *links;
    float *model, *matrices; /* [joint_count][12] */
    uint32_t item_count;
    noh_stage_item items[NOH_STAGE_MESHES_MAX];
    lid lids[2];
    float head; /* z of its joint at rest */
} search;

static void begin(search *s, const noh_kind_desc *kind)
{
    memset(s, 0, sizeof *s);
    s->kind = kind;
    if (noh_pack_skeleton_at(kind->mesh, kind->skeleton, &s->skeleton, NULL, NULL) != NOH_OK) {
        s->skeleton.joint_count = 0;
    }
    s->item_count = noh_stage_items(kind, s->items);
    if (s->item_count > NOH_STAGE_MESHES_MAX) s->item_count = NOH_STAGE_MESHES_MAX;
}

/* Targets are numbered through all meshes of the kind. */
static uint32_t find_target(const void *user, const char *name, uint32_t nth)
{
    const search *s = user;
    uint32_t first = 0;
    for (uint32_t i = 0; i < s->item_count; i++) {
        noh_mesh mesh;
        uint32_t target;
        if (noh_pack_mesh_at(s->kind->mesh, s->items[i].mesh, &mesh, NULL) != NOH_OK) continue;
        target = noh_mesh_find_target(&mesh, name);
        if (target != NOH_NONE && nth-- == 0) return first + target <= UINT16_MAX ? first + target : NOH_NONE;
        first += mesh.header->target_count;
    }
    return NOH_NONE;
}

static size_t carve(search *s, noh_arena *arena, uint32_t links)
{
    const size_t matrices = sizeof(float) * 12u * s->skeleton.joint_count;
    s->links = noh_arena_carve(arena, sizeof *s->links * links, 16);
    s->model = noh_arena_carve(arena, matrices, 16);
    s->matrices = noh_arena_carve(arena, matrices, 16);
    return arena->used;
}

/* How far a target moves a vertex: the delta texel that is the vertex's accumulation texel. */
static float way_of(const noh_mesh *mesh, const noh_target *t, uint32_t vertex)
{
    const uint32_t texel = noh_mesh_accumulation_texel(mesh, vertex), log2 = mesh->header->morph_width_log2;
    const uint32_t x = texel & ((1u << log2) - 1u), y = texel >> log2;
    const morph_field field = { 0, 32u - t->position_bits, t->position_scale };
    uint32_t first = t->first_texel;
    if (texel >= mesh->header->touched_count || !t->position_bits) return 0.0f;
    for (uint32_t i = 0; i < t->rect_count; i++) {
        const noh_rect r = mesh->rects[t->first_rect + i];
        if (x - r.x < r.w && y - r.y < r.h) {
            const uint32_t *words = mesh->texels + 3u * (size_t)(first + (y - r.y) * r.w + (x - r.x));
            float way[3];
            for (int k = 0; k < 3; k++) way[k] = noh_field_value(words[k], field);
            return noh_sqrt(noh_dot3(way, way));
        }
        first += (uint32_t)r.w * r.h;
    }
    return 0.0f;
}

/* What a target moves, to the left of the middle and to the right. */
static void add_target(search *s, const noh_stage_item *item, const noh_mesh *mesh, uint32_t target)
{
    const noh_target *t = &mesh->targets[target];
    const float *world = item->node == NOH_NONE ? NULL : s->kind->mesh->nodes[item->node].world;
    noh_skin skin;
    const int skinned = noh_pack_skin_at(s->kind->mesh, mesh->header->skin, &skin, NULL) == NOH_OK &&
                        skin.header->joint_count <= s->skeleton.joint_count;
    if (skinned) noh_skin_matrices(&skin, s->model, s->matrices);
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        const float way = way_of(mesh, t, v), *rest = mesh->positions + 3u * (size_t)v;
        float at[3] = { rest[0], rest[1], rest[2] };
        lid *l;
        if (way == 0.0f) continue;
        if (skinned) noh_skin_position(mesh, s->matrices, NULL, v, at);
        for (int r = 0; r < 3 && world && !skinned; r++) at[r] = noh_dot3(world + 4 * r, rest) + world[4 * r + 3];
        l = &s->lids[at[0] < 0.0f];
        for (int i = 0; i < 3; i++) l->at[i] += way * at[i];
        l->weight += way;
    }
}

static void add_link(search *s, uint32_t target)
{
    for (uint32_t i = 0; i < s->item_count; i++) {
        noh_mesh mesh;
        if (noh_pack_mesh_at(s->kind->mesh, s->items[i].mesh, &mesh, NULL) != NOH_OK) continue;
        if (target < mesh.header->target_count) {
            add_target(s, &s->items[i], &mesh, target);
            return;
        }
        target -= mesh.header->target_count;
    }
}

static int is_blink(const noh_face_link *link)
{
    return link->channel == NOH_CHANNEL_BLINK_LEFT || link->channel == NOH_CHANNEL_BLINK_RIGHT;
}

static int is_of_eyes(const noh_face_link *link)
{
    return link->channel >= NOH_CHANNEL_EYES && link->channel < NOH_CHANNEL_EYES + 8;
}

/* A target that both sides share counts once: it moves both. */
static void add_links(search *s, uint32_t count, int (*wanted)(const noh_face_link *link))
{
    memset(s->lids, 0, sizeof s->lids);
    for (uint32_t i = 0; i < count; i++) {
        int seen = !wanted(&s->links[i]);
        for (uint32_t j = 0; j < i && !seen; j++) {
            seen = wanted(&s->links[j]) && s->links[j].target == s->links[i].target;
        }
        if (!seen) add_link(s, s->links[i].target);
    }
}

/* 0: nothing moves on one of the sides. The eyes of a face that is well behind the joint of its head look along -z. */
static int place(const search *s, float eyes[2][3])
{
    float found[2][3], apart;
    for (int e = 0; e < 2; e++) {
        if (!(s->lids[e].weight > 0.0f)) return 0;
        for (int i = 0; i < 3; i++) found[e][i] = s->lids[e].at[i] / s->lids[e].weight;
    }
    apart = found[0][0] - found[1][0];
    if (!(apart > APART_MIN)) return 0;
    const int turned = found[0][2] + found[1][2] + apart < 2.0f * s->head;
    for (int e = 0; e < 2; e++) {
        found[e][2] -= turned ? -BEHIND_LIDS * apart : BEHIND_LIDS * apart;
        memcpy(eyes[turned ? 1 - e : e], found[e], sizeof found[e]);
    }
    return 1;
}

size_t noh_kind_find_eyes_size(const noh_kind_desc *kind)
{
    noh_arena arena = noh_arena_measure();
    search s;
    NOH_ASSERT(kind && kind->mesh);
    begin(&s, kind);
    return carve(&s, &arena, noh_stage_face_bind(kind, find_target, &s, NULL, 0));
}

noh_result noh_kind_find_eyes(const noh_kind_desc *kind, void *scratch, size_t scratch_bytes, float eyes[2][3],
                              noh_error *error)
{
    noh_arena arena;
    noh_result result;
    uint32_t links;
    search s;
    float head = -1e30f; /* none */
    NOH_ASSERT(kind && kind->mesh && eyes);
    if (noh_stage_face_eye_joints(kind, eyes, &head)) return NOH_OK;
    result = noh_arena_open(&arena, scratch, scratch_bytes, noh_kind_find_eyes_size(kind), error);
    if (result != NOH_OK) return result;
    begin(&s, kind);
    s.head = head;
    links = noh_stage_face_bind(kind, find_target, &s, NULL, 0);
    (void)carve(&s, &arena, links);
    if (s.skeleton.joint_count) {
        noh_local_to_model(&s.skeleton, s.skeleton.bind_pose, s.skeleton.joint_count, s.model);
    }
    (void)noh_stage_face_bind(kind, find_target, &s, s.links, links);
    add_links(&s, links, is_blink);
    if (place(&s, eyes)) return NOH_OK;
    add_links(&s, links, is_of_eyes);
    if (place(&s, eyes)) return NOH_OK;
    return noh_fail(error, NOH_ERR_NOT_FOUND,
                    "a face has no joints for its eyes, and no targets that shut or turn both: set "
                    "noh_kind_face.face.eyes to their centres",
                    0, 0);
}
