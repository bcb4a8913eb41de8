/* stage_look.c: the first phase of a frame: which views see each actor, and the level to show it at. Each job handles
 * its own actors. */
#include <string.h>

#include "core/base/math_internal.h"
#include "stage/character/character_internal.h"
#include "noh/modules.h"
#include "stage/character/time_lod_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"
#include "stage/character/lod_internal.h"

#define ROUNDING 1.000002f

/* out may be own. */
void noh_stage_sphere_in_world(const float world[12], const float own[4], float out[4])
{
    const float x = own[0], y = own[1], z = own[2];
    for (int i = 0; i < 3; i++)
        out[i] = world[4 * i] * x + world[4 * i + 1] * y + world[4 * i + 2] * z + world[4 * i + 3];
    out[3] = own[3] * noh_stretch(world) * ROUNDING;
}

static int is_inside(const noh_view_planes *v, const float sphere[4])
{
    for (int p = 0; p < 4; p++) {
        const float *plane = v->planes[p];
        if (plane[0] * sphere[0] + plane[1] * sphere[1] + plane[2] * sphere[2] + plane[3] < -sphere[3]) return 0;
    }
    return 1;
}

static uint32_t find_views(const noh_stage *s, const noh_stage_actor *a, const float reach[4])
{
    uint32_t views = 0;
    for (uint32_t v = 0; v < s->view_count && !a->look.hidden; v++) {
        const noh_view_planes *planes = &s->planes[v];
        if (is_inside(planes, reach) && !(planes->is_light && a->look.no_shadow)) views |= 1u << v;
    }
    return views;
}

static uint32_t look_at_own(const noh_stage *s, uint32_t index, const noh_stage_kind *k, const float own[4])
{
    float reach[4];
    noh_stage_reach(k, own, reach);
    noh_stage_sphere_in_world(s->shown[index].world, reach, reach);
    return find_views(s, &s->actors[index], reach);
}

/* An attached actor is seen where those that carry it may take it. Its matrix is known only when they were posed: until
 * then their last poses stand for it. They may be looked at in another job: what a look changes of them is not read.
 * What modules turn is not read either: the reach of a kind holds it however it turns.
 * own: its sphere in its own space; matrix: from there to the world, as of the last poses. */
static uint32_t look_at_attached(const noh_stage *s, uint32_t index, const noh_stage_kind *k, const float own[4],
                                 float matrix[12])
{
    const noh_stage_actor *a = &s->actors[index], *on = a, *next;
    noh_stage_kind *of = NULL;
    noh_place place;
    float world[12], reach[4], shown[4], length;
    noh_stage_shown_place(s, a, s->origin, &place);
    noh_place_matrix(&place, matrix);
    noh_stage_reach(k, own, reach);
    noh_stage_sphere_in_world(matrix, reach, reach);
    for (; (next = noh_stage_parent_of(s, on, &of)) != NULL; on = next) {
        const noh_character *ch = noh_stage_character(of, noh_stage_index(of, next));
        if (next->look.hidden) return 0;
        length = noh_sqrt(noh_dot3(reach, reach)) + reach[3]; /* from the joint */
        if (ch->time.posed && on->joint < of->skeleton.joint_count) {
            const float *joint = noh_character_pose_palette(ch, ch->time.to_pose) + 12u * (size_t)on->joint;
            length *= noh_stretch(joint);
            noh_matrix_multiply(joint, matrix, matrix);
        }
        noh_stage_sphere_in_world(matrix, own, shown);
        memcpy(reach, of->reach, sizeof reach);
        reach[3] += length;
        noh_stage_widen(reach, shown);
        noh_stage_shown_place(s, next, s->origin, &place);
        noh_place_matrix(&place, world);
        noh_matrix_multiply(world, matrix, matrix);
        noh_stage_sphere_in_world(world, reach, reach);
    }
    return on == a ? 0 : find_views(s, a, reach);
}

/* Whether a view sees something that is attached to an actor, which then has to be posed. */
static int carries_seen(const noh_stage *s, const noh_stage_actor *a)
{
    for (uint32_t i = 0; i < s->actor_count; i++) {
        const noh_stage_actor *other = &s->actors[i];
        const noh_stage_kind *k;
        float matrix[12];
        if (!other->alive || other == a || noh_stage_steps_to(s, other, a) == NOH_NONE) continue;
        k = noh_stage_kind_of(s, i);
        if (look_at_attached(s, i, k, k->reach, matrix)) return 1;
    }
    return 0;
}

float noh_stage_size(const noh_stage *s, const noh_stage_actor *a)
{
    noh_place place;
    if (a->parent) return noh_stretch(s->shown[a - s->actors].world);
    noh_stage_shown_place(s, a, s->origin, &place);
    return place.scale;
}

/* The detail of an actor that comes into view is chosen by a pose that may be old, or by none: the next frame, which
 * knows what this one shows, chooses again. */
static int is_fresh(const noh_stage *s, noh_stage_actor *a)
{
    if (a->was_seen < 3u) a->was_seen++;
    return s->cut || a->was_seen < 3u;
}

void noh_stage_follow_lod(noh_controller *inner, const noh_controller *outer)
{
    (void)noh_controller_set_lod(inner, outer->lod,
                                 outer->lod_joint_count < outer->joint_count ? outer->lod_joint_count : 0);
}

/* inner  controller of the actor's graph; NULL: none */
static noh_due choose_detail(const noh_stage_kind *k, noh_character *ch, const noh_controller *inner,
                             const noh_lod_settings *settings, float pixels_per_metre)
{
    float error_m[NOH_UPDATE_RATE_COUNT], of_inner[NOH_UPDATE_RATE_COUNT] = { 0.0f };
    if (!k->table.update_error_m) return noh_character_select_lod(ch, &k->table, settings, pixels_per_metre);
    noh_time_lod_error(noh_character_controller(ch), k->table.update_error_m, error_m);
    if (inner) noh_time_lod_error(inner, k->table.update_error_m, of_inner);
    for (int r = 0; r < NOH_UPDATE_RATE_COUNT; r++) {
        error_m[r] = of_inner[r] > error_m[r] ? of_inner[r] : error_m[r];
        for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) error_m[r] += k->modules[slot].error_m[r];
    }
    return noh_character_select_lod_for(ch, &k->table, settings, pixels_per_metre, error_m);
}

static void choose(noh_stage *s, noh_stage_kind *k, uint32_t index)
{
    noh_stage_actor *a = &s->actors[index];
    const uint32_t i = noh_stage_index(k, a);
    noh_stage_shown *shown = &s->shown[index];
    noh_character *ch = noh_stage_character(k, i);
    noh_controller *inner = noh_stage_inner(k, i);
    const float scale = shown->scale * noh_stage_size(s, a);
    noh_lod_settings settings = s->desc.lod;
    const int was_seen = a->was_seen;
    float asked;
    if (is_fresh(s, a)) noh_lod_cut(&ch->lod);
    if (a->look.pixels > 0.0f) settings.pixels = a->look.pixels;
    noh_character_set_behind(ch, s->head->behind_ticks);
    /* one that is out of view itself is posed in full for what it carries */
    asked = a->look.posed || !shown->views || noh_stage_is_full(s, a) ? NOH_MODIFIER_FULL_DETAIL : scale;
    shown->due = (uint8_t)choose_detail(k, ch, inner, &settings, asked);
    if (shown->due == NOH_DUE_AT_ONCE && was_seen && ch->time.posed) shown->due = NOH_STAGE_DUE_LONG;
    if (noh_stage_is_full(s, a)) {
        const uint32_t level = a->look.level ? a->look.level - 1u : k->plan->finest_level;
        noh_lod_set_mesh(&ch->lod, &k->table, level, scale);
        (void)noh_controller_set_lod(noh_character_controller(ch), ch->lod.mesh, 0);
    }
    if (inner) noh_stage_follow_lod(inner, noh_character_controller(ch));
}

static void look_at(noh_stage *s, noh_stage_kind *k, uint32_t index, float *matrices)
{
    noh_stage_actor *a = &s->actors[index];
    noh_stage_shown *shown = &s->shown[index];
    float own[4];
    if (k->weight_count) noh_stage_take_floats(k, noh_stage_index(k, a));
    noh_stage_sphere(k, noh_stage_index(k, a), own);
    if (a->parent) {
        shown->views = (uint16_t)look_at_attached(s, index, k, own, shown->world);
    } else {
        noh_stage_own_matrix(s, k, a, shown->world);
        shown->views = (uint16_t)look_at_own(s, index, k, own);
    }
    a->on_its_way = 0;
    shown->due = NOH_DUE_NOT;
    shown->updates &= NOH_STAGE_CARRIES;
    noh_stage_measure(s, k, noh_stage_index(k, a), own, matrices);
    if (shown->views || a->look.posed || (shown->updates && carries_seen(s, a))) {
        choose(s, k, index);
    } else {
        a->was_seen = 0;
    }
}

void noh_stage_look_at(noh_stage *s, uint32_t job, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++) {
        if (s->actors[i].alive) {
            look_at(s, noh_stage_kind_of(s, i), i, s->jobs[job].matrices);
        } else {
            s->shown[i].views = 0;
            s->shown[i].updates = 0;
            s->shown[i].due = NOH_DUE_NOT;
        }
    }
}
