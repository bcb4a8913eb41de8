/* stage_look.c: the first phase of a frame: who is seen by which view, and how finely that actor is to be shown. Each
 * job looks at actors of its own. */
#include <string.h>

#include "base/math_internal.h"
#include "stage/stage_internal.h"

static void to_world(const float world[12], float scale, const float own[4], float out[4])
{
    for (int i = 0; i < 3; i++) {
        out[i] = world[4 * i] * own[0] + world[4 * i + 1] * own[1] + world[4 * i + 2] * own[2] + world[4 * i + 3];
    }
    out[3] = own[3] * scale;
}

/* The sphere that culling takes: where any clip may take the actor, or what was shown last where that sticks out. */
static void reach_in_world(const noh_stage_kind *k, const noh_character *ch, const float world[12], float scale,
                           float out[4])
{
    float own[4];
    memcpy(own, k->reach, sizeof own);
    if (ch->time.posed && k->skeleton.joint_count) { /* without joints no sphere is kept */
        float shown[4], apart = 0.0f;
        noh_character_sphere(ch, shown);
        for (int i = 0; i < 3; i++) apart += (shown[i] - own[i]) * (shown[i] - own[i]);
        apart = noh_sqrt(apart) + shown[3];
        own[3] = apart > own[3] ? apart : own[3];
    }
    to_world(world, scale, own, out);
}

/* The sphere that detail is chosen by: how far targets may move a face together says nothing of how near it is. */
static void shown_in_world(const noh_stage_kind *k, const float world[12], float scale, const float reach[4],
                           float out[4])
{
    if (k->skeleton.joint_count || k->rigid[3] < 0.0f) {
        memcpy(out, reach, 4 * sizeof *out);
    } else {
        to_world(world, scale, k->rigid, out);
    }
}

static int is_inside(const noh_view_planes *v, const float sphere[4])
{
    for (int p = 0; p < 4; p++) {
        const float *plane = v->planes[p];
        if (plane[0] * sphere[0] + plane[1] * sphere[1] + plane[2] * sphere[2] + plane[3] < -sphere[3]) return 0;
    }
    return 1;
}

/* Pixels per unit at the nearest point of a sphere. */
static float scale_at(const noh_view_planes *v, const float sphere[4])
{
    const float *w = v->eye_plane;
    const float middle = w[0] * sphere[0] + w[1] * sphere[1] + w[2] * sphere[2] + w[3];
    const float nearest = middle - sphere[3] * v->w_slope;
    return v->scale / (nearest > 1e-3f ? nearest : 1e-3f);
}

/* reach: seen or not; shown: how large. */
static uint32_t find_views(const noh_stage *s, const noh_stage_actor *a, const float reach[4], const float shown[4],
                           float *scale)
{
    uint32_t views = 0;
    for (uint32_t v = 0; v < s->view_count && !a->look.hidden; v++) {
        const noh_view_planes *planes = &s->planes[v];
        if (is_inside(planes, reach) && !(planes->is_light && a->look.no_shadow)) {
            const float here = scale_at(planes, shown);
            views |= 1u << v;
            *scale = here > *scale ? here : *scale;
        }
    }
    return views;
}

/* What hangs on another is where that is seen: its own matrix is known only when the other was posed. world: that of
 * the actor itself, or of the other. */
static uint32_t look_from(const noh_stage *s, uint32_t index, const noh_stage_kind *k, const noh_place *own,
                          float world[12], float *scale)
{
    const noh_stage_actor *a = &s->actors[index], *on = a;
    const noh_stage_kind *of = k;
    const noh_character *ch;
    noh_place place = *own;
    float reach[4], shown[4];
    if (a->parent) {
        on = noh_stage_actor_of(s, (noh_actor){ a->parent }, NULL);
        if (!on || on->look.hidden) return 0;
        noh_stage_shown_place(s, on, s->origin, &place);
        of = noh_stage_kind_of(s, (uint32_t)(on - s->actors));
    }
    ch = noh_stage_character(of, noh_stage_index(of, on));
    noh_place_matrix(&place, world);
    reach_in_world(of, ch, world, place.scale, reach);
    if (a == on) {
        shown_in_world(of, world, place.scale, reach, shown);
        return find_views(s, a, reach, shown, scale);
    }
    reach[3] += (k->reach[3] +
                 noh_sqrt(k->reach[0] * k->reach[0] + k->reach[1] * k->reach[1] + k->reach[2] * k->reach[2])) *
                own->scale * place.scale;
    return find_views(s, a, reach, reach, scale);
}

static void look_at(noh_stage *s, noh_stage_kind *k, uint32_t index)
{
    noh_stage_actor *a = &s->actors[index];
    noh_stage_shown *shown = &s->shown[index];
    noh_character *ch = noh_stage_character(k, noh_stage_index(k, a));
    noh_lod_settings settings = s->desc.lod;
    noh_place place;
    float world[12], scale = 0.0f, asked;
    noh_stage_shown_place(s, a, s->origin, &place);
    shown->views = look_from(s, index, k, &place, world, &scale);
    a->on_its_way = 0;
    shown->due = NOH_DUE_NOT;
    shown->updates = 0;
    shown->scale = scale;
    if (!shown->views && !a->look.posed) {
        a->was_seen = 0;
        return;
    }
    if (!a->was_seen || s->cut) {
        noh_lod_cut(&ch->lod);
    }
    a->was_seen = 1;
    if (!a->parent) memcpy(shown->world, world, sizeof world);
    if (a->look.pixels > 0.0f) settings.pixels = a->look.pixels;
    noh_character_set_behind(ch, s->head->behind_ticks);
    asked = a->look.posed || noh_stage_is_full(s, a) ? NOH_PART_FULL_DETAIL : scale * place.scale;
    shown->due = (uint8_t)(k->graph_count ? noh_stage_look_graph(k, noh_stage_index(k, a), &settings, asked)
                                          : noh_character_look(ch, &k->table, &settings, asked));
    if (noh_stage_is_full(s, a)) {
        const uint32_t level = a->look.level ? a->look.level - 1u : k->plan->finest_level;
        noh_lod_set_mesh(&ch->lod, &k->table, level, scale * place.scale);
        (void)noh_controller_set_lod(noh_character_controller(ch), ch->lod.mesh, 0);
    }
    if (k->graph_count) noh_stage_follow_lod(k, noh_stage_index(k, a));
}

void noh_stage_look_at(noh_stage *s, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++) {
        if (s->actors[i].alive) {
            look_at(s, noh_stage_kind_of(s, i), i);
        } else {
            s->shown[i].views = 0;
            s->shown[i].updates = 0;
            s->shown[i].due = NOH_DUE_NOT;
        }
    }
}
