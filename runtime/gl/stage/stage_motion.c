/* stage_motion.c: where everything was in the last frame, for motion vectors (noh_stage_desc.motion).
 *
 * Each instance in the palette texture has the rows of the last frame after its own, and each slot has two tiles of
 * accumulators: changed weights go to the tile that the last frame did not show, so that nothing is accumulated twice.
 *
 * The last frame is known of a mesh that was shown in the frame just before, unless its actor was cut (noh_actor_cut) or
 * a state was restored since. Otherwise it is taken to have been where it is, and its velocity is 0. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "gl/draw/gl_skin_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "noh/base.h"
#include "noh/low_gl.h"
#include "noh/low_motion.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "stage/actors/stage_draws_internal.h"

static noh_gl_last *last_of(const noh_stage *s, const noh_stage_kind *k, uint32_t index)
{
    return &((const noh_stage_gl *)s->gpu)->kinds[k - s->kinds].last[index];
}

static const noh_gl_item *item_of(const noh_stage *s, const noh_stage_kind *k, uint32_t mesh)
{
    return &((const noh_stage_gl *)s->gpu)->kinds[k - s->kinds].items[mesh];
}

/* Called before shown->frame becomes this frame's number: a restored state has 0 there, a cut actor was not seen. */
static uint32_t known_meshes(const noh_stage *s, const noh_stage_kind *k, uint32_t index, const noh_gl_last *last)
{
    const noh_stage_shown *shown = &s->shown[k->first_actor + index];
    const int was_seen = k->actors[index].was_seen > 1u && last->frame && last->frame + 1u == s->frame &&
                         shown->frame == last->frame;
    return was_seen ? ~last->hidden_meshes : 0;
}

int noh_gl_motion_pose(const noh_stage *s, const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_shown *shown = &s->shown[k->first_actor + index];
    noh_gl_last *last = last_of(s, k, index);
    int changed = 0;
    last->known = known_meshes(s, k, index, last);
    last->same_slot = last->slot.pool == shown->slot.pool && last->slot.slot == shown->slot.slot;
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const uint32_t was = last->known >> m & 1u ? last->place : NOH_NONE;
        if (!k->meshes[m].skinned || k->actors[index].look.hidden_meshes >> m & 1u) continue;
        changed |= noh_gl_skin_write_before(item_of(s, k, m)->skin, shown->place, was);
    }
    return changed;
}

/* What the views of a frame are relative to, wherever the origin was moved meanwhile. */
static void origin_of(const noh_stage *s, double origin[3])
{
    for (int i = 0; i < 3; i++) origin[i] = (double)s->origin[i] + s->shifted[i];
}

/* From this frame's origin to the one before. */
static void moved_origin(const noh_stage *s, float by[3])
{
    const noh_gl_views *views = ((const noh_stage_gl *)s->gpu)->views;
    for (int i = 0; i < 3; i++) by[i] = (float)(views[0].origin[i] - views[1].origin[i]);
}

/* An actor that was not posed yet shows no pose of this frame. */
static void begin_actor(const noh_stage *s, const noh_stage_kind *k, uint32_t index, const float by[3])
{
    noh_gl_last *last = last_of(s, k, index);
    if (s->shown[k->first_actor + index].frame != s->frame) last->known = 0;
    memcpy(last->world_before, last->world, sizeof last->world);
    for (int i = 0; i < 3; i++) last->world_before[4 * i + 3] -= by[i];
}

void noh_gl_motion_begin(const noh_stage *s)
{
    noh_gl_views *views = ((const noh_stage_gl *)s->gpu)->views;
    float by[3];
    views[1] = views[0];
    views[0].count = s->view_count;
    origin_of(s, views[0].origin);
    for (uint32_t v = 0; v < s->view_count; v++) {
        memcpy(views[0].view_projection[v], s->views[v].view_projection, sizeof views[0].view_projection[v]);
    }
    moved_origin(s, by);
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        for (uint32_t p = 0; p < noh_stage_seen(k); p++) begin_actor(s, k, k->order[p], by);
    }
}

void noh_gl_motion_view(const noh_stage *s, uint32_t view, float view_projection[16])
{
    const noh_gl_views *views = ((const noh_stage_gl *)s->gpu)->views;
    const int known = view < views[1].count && !s->views[view].cut;
    float by[3];
    memcpy(view_projection, views[known].view_projection[view], sizeof views->view_projection[view]);
    moved_origin(s, by);
    if (known && (by[0] != 0.0f || by[1] != 0.0f || by[2] != 0.0f)) noh_projection_less(view_projection, by, NULL);
}

int noh_gl_motion_of(const noh_stage *s, const noh_stage_kind *k, uint32_t index, uint32_t mesh, float world[12],
                     noh_gl_morph_binding *morph)
{
    const noh_stage_mesh *m = &k->meshes[mesh];
    const noh_gl_item *item = item_of(s, k, mesh);
    const noh_stage_shown *shown = &s->shown[k->first_actor + index];
    const noh_gl_last *last = last_of(s, k, index);
    const int known = (int)(last->known >> mesh & 1u);
    memcpy(world, known ? last->world_before : shown->world, sizeof last->world_before);
    if (!m->skinned && m->node_world) noh_matrix_multiply(world, m->node_world, world);
    if (!noh_gl_has_tile(item, shown)) return 0;
    *morph = noh_gl_morph_binding_of(item->model->morph, noh_gl_tile_of(item, shown, known && last->same_slot));
    return 1;
}

void noh_gl_motion_turn(const noh_gl_item *item, const noh_stage_shown *shown, const float *weights, uint32_t count)
{
    const uint32_t tile = noh_gl_item_tile(item, shown);
    uint8_t *side = &item->model->sides[tile / 2u];
    const float *own = noh_gl_morph_weights_of(item->model->morph, tile);
    *side &= NOH_SIDE_SECOND;
    if (memcmp(own, weights, count * sizeof *weights) != 0)
        *side = (uint8_t)((*side ^ NOH_SIDE_SECOND) | NOH_SIDE_CHANGED);
}

void noh_gl_motion_upload(const noh_stage *s, const noh_stage_kind *k, uint32_t index, uint32_t mesh)
{
    const noh_stage_shown *shown = &s->shown[k->first_actor + index];
    noh_gl_morph_binding morph;
    float world[12];
    const int is_morphed = noh_gl_motion_of(s, k, index, mesh, world, &morph);
    noh_gl_skin_put_before(item_of(s, k, mesh)->skin, shown->place, world, is_morphed ? &morph : NULL);
}

static void keep_actor(const noh_stage *s, const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_shown *shown = &s->shown[k->first_actor + index];
    noh_gl_last *last = last_of(s, k, index);
    last->frame = shown->frame;
    last->place = shown->place;
    last->hidden_meshes = k->actors[index].look.hidden_meshes;
    last->slot = shown->slot;
    memcpy(last->world, shown->world, sizeof last->world);
}

void noh_gl_motion_end(const noh_stage *s)
{
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        for (uint32_t p = 0; p < noh_stage_seen(k); p++) keep_actor(s, k, k->order[p]);
        for (uint32_t m = 0; m < k->plan->mesh_count; m++) noh_gl_skin_keep(item_of(s, k, m)->skin);
    }
}
