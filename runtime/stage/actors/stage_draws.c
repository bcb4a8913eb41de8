/* stage_draws.c: what a pass of a view draws, in which order: for what draws a stage, and as a list for the game.
 *
 * Opaque meshes are drawn for all actors of a run at once. Blended ones follow by priority, and within a priority each
 * actor's meshes from far to near; a priority with one mesh is drawn for all actors of a run at once. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/mesh/mesh_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/actors/stage_draws_internal.h"
#include "stage/cast/stage_internal.h"
#include "stage/character/character_internal.h"
#include "stage/character/lod_internal.h"

/* A pass at one kind, between two places in its order. */
typedef struct walk {
    const noh_stage_pass *pass;
    const noh_stage_kind *k;
    uint32_t first, end;
    int priority;
} walk;

/* Where a run begins, of what is between the two places. */
static uint32_t begin_of(const walk *w, uint32_t run)
{
    const uint32_t at = w->k->runs[run];
    return at < w->first ? w->first : at > w->end ? w->end : at;
}

static const noh_stage_shown *shown_at(const walk *w, uint32_t place)
{
    return &w->pass->s->shown[w->k->first_actor + w->k->order[place]];
}

static const noh_stage_actor *actor_at(const walk *w, uint32_t place)
{
    return &w->k->actors[w->k->order[place]];
}

static int is_seen(const walk *w, uint32_t place)
{
    return (int)(shown_at(w, place)->views >> w->pass->view & 1u);
}

/* Whether the view sees an actor and the actor has the mesh on. */
static int shows(const walk *w, uint32_t mesh, uint32_t place)
{
    return is_seen(w, place) && !(actor_at(w, place)->look.hidden_meshes >> mesh & 1u);
}

/* The same sign as noh_gl_normal_rows. */
static float determinant(const float w[12])
{
    const float x = w[5] * w[10] - w[6] * w[9], y = w[6] * w[8] - w[4] * w[10], z = w[4] * w[9] - w[5] * w[8];
    return w[0] * x + w[1] * y + w[2] * z;
}

int noh_stage_is_mirrored(const noh_stage_mesh *mesh, const noh_stage_actor *actor, const noh_stage_shown *shown)
{
    const int node = !mesh->skinned && mesh->node_world && determinant(mesh->node_world) < 0.0f;
    return node || (actor->parent && determinant(shown->world) < 0.0f);
}

static int is_mirrored(const walk *w, uint32_t mesh, uint32_t place)
{
    return noh_stage_is_mirrored(&w->k->meshes[mesh], actor_at(w, place), shown_at(w, place));
}

/* Whether two actors can be drawn together. */
static int wear_the_same(const walk *w, uint32_t a, uint32_t b)
{
    const noh_appearance *of_a = &actor_at(w, a)->look, *of_b = &actor_at(w, b)->look;
    return of_a->texture_set == of_b->texture_set && of_a->wrinkle_models == of_b->wrinkle_models &&
           of_a->smoothed == of_b->smoothed && shown_at(w, a)->cover == shown_at(w, b)->cover;
}

/* ---- opaque meshes ---- */

/* Vertices that virtual joints move need all of these: errors of fewer influences are errors of the skeleton's
 * joints. */
static uint32_t influences_of(const noh_stage_kind *k, uint32_t mesh, uint32_t level, uint32_t fewer)
{
    const noh_far_joints_header *far_joints = k->meshes[mesh].mesh.far_joints;
    return far_joints && noh_stage_mesh_level(k, mesh, level) >= far_joints->level ? 0u : fewer;
}

noh_stage_drawing noh_stage_drawing_alone(const noh_stage_kind *k, uint32_t mesh, uint32_t place, noh_stage_part part)
{
    const noh_character *ch = noh_stage_character(k, k->order[place]);
    const uint32_t fewer = noh_lod_influence_count(&ch->lod, &k->table);
    const uint32_t influences = influences_of(k, mesh, part.level, fewer);
    return (noh_stage_drawing){ k, mesh, place, 1, part.level, influences, part.from, part.to, NOH_STAGE_OPAQUE, 1 };
}

static void draw_alone(const walk *w, uint32_t mesh, uint32_t place, noh_stage_part part)
{
    noh_stage_drawing d = noh_stage_drawing_alone(w->k, mesh, place, part);
    d.priority = w->priority;
    w->pass->draw(w->pass->user, &d);
}

static void draw_together(const walk *w, uint32_t mesh, uint32_t run, uint32_t first, uint32_t count)
{
    const uint32_t caps = noh_stage_influence_levels(w->k);
    const noh_lod_table *table = &w->k->table;
    const uint32_t fewer = table->influence_level_count ? table->influences[run % caps].influence_count : 0;
    const uint32_t influences = influences_of(w->k, mesh, run / caps, fewer);
    const noh_stage_drawing d = { w->k, mesh, first, count, run / caps, influences, 0.0f, 1.0f, w->priority, 0 };
    w->pass->draw(w->pass->user, &d);
}

static void draw_run(const walk *w, uint32_t mesh, uint32_t run)
{
    const uint32_t end = begin_of(w, run + 1u);
    uint32_t at = begin_of(w, run);
    while (at < end) {
        uint32_t first;
        while (at < end && !shows(w, mesh, at)) at++;
        first = at;
        while (at < end && shows(w, mesh, at) && wear_the_same(w, at, first) && !is_mirrored(w, mesh, at)) at++;
        if (at > first) {
            draw_together(w, mesh, run, first, at - first);
        } else if (at < end) {
            draw_alone(w, mesh, at++, (noh_stage_part){ run / noh_stage_influence_levels(w->k), 0.0f, 1.0f });
        }
    }
}

uint32_t noh_stage_parts_of(const noh_stage_kind *k, const noh_stage_shown *shown, uint32_t mesh, int fades,
                            noh_stage_part parts[2])
{
    const noh_character *ch = noh_stage_character(k, k->order[shown->place]);
    const float part = noh_lod_fade(&ch->lod, ch->time.clock);
    const int both = fades &&
                     noh_stage_mesh_level(k, mesh, shown->level) != noh_stage_mesh_level(k, mesh, shown->level_before);
    parts[0] = (noh_stage_part){ shown->level, 0.0f, both ? part : 1.0f };
    parts[1] = (noh_stage_part){ shown->level_before, part, 1.0f };
    return both ? 2u : 1u;
}

/* An actor that fades: the new level and the old one, each in its share of the pixels. */
static void draw_fading(const walk *w, uint32_t mesh, uint32_t place)
{
    noh_stage_part parts[2];
    const uint32_t count = noh_stage_parts_of(w->k, shown_at(w, place), mesh, w->pass->fades, parts);
    for (uint32_t i = 0; i < count; i++) draw_alone(w, mesh, place, parts[i]);
}

static void draw_opaque(const walk *w)
{
    const uint32_t runs = noh_stage_run_count(w->k);
    for (uint32_t m = 0; m < w->k->plan->mesh_count; m++) {
        for (uint32_t run = 0; run < runs; run++) draw_run(w, m, run);
        for (uint32_t p = begin_of(w, runs); p < begin_of(w, runs + 1u); p++) {
            if (shows(w, m, p)) draw_fading(w, m, p);
        }
    }
}

/* ---- blended meshes, from far to near ---- */

static void move_point(const float *matrix, const float *p, float out[3])
{
    for (int i = 0; i < 3; i++) {
        const float *row = matrix + 4 * i;
        out[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
    }
}

/* The centre of a mesh's bounds, moved by the mean of its joints. */
static void move_skinned(const noh_character *ch, const noh_skin *skin, const float middle[3], float out[3])
{
    const float *palette = noh_character_pose_palette(ch, ch->time.to_pose);
    const int multiplied = (int)(ch->multiplied >> ch->time.to_pose & 1u);
    const uint32_t count = skin->header->joint_count;
    float sum[3] = { 0.0f, 0.0f, 0.0f };
    for (size_t k = 0; k < count; k++) {
        float bound[3], p[3];
        memcpy(bound, middle, sizeof bound);
        if (!multiplied) move_point(skin->inverse_bind + 12u * k, middle, bound);
        move_point(palette + 12u * skin->joints[k], bound, p);
        for (int i = 0; i < 3; i++) sum[i] += p[i];
    }
    for (int i = 0; i < 3; i++) out[i] = sum[i] / (float)count;
}

/* The squared distance of a mesh from the eye. */
static float distance_of(const walk *w, uint32_t mesh, uint32_t place)
{
    const noh_stage_mesh *m = &w->k->meshes[mesh];
    const noh_mesh_header *h = m->mesh.header;
    const float *eye = w->pass->s->views[w->pass->view].eye, *world = shown_at(w, place)->world;
    float p[3], at[3], square = 0.0f;
    for (int i = 0; i < 3; i++) p[i] = 0.5f * (h->bounds_min[i] + h->bounds_max[i]);
    if (m->skinned) {
        move_skinned(noh_stage_character(w->k, w->k->order[place]), &m->skin, p, at);
    } else if (m->node_world) {
        move_point(m->node_world, p, at);
    } else {
        memcpy(at, p, sizeof at);
    }
    move_point(world, at, p);
    for (int i = 0; i < 3; i++) square += (p[i] - eye[i]) * (p[i] - eye[i]);
    return square;
}

/* One actor's meshes of a priority. At equal distance the first in the pack is drawn first. */
static void draw_sorted(const walk *w, const uint8_t *meshes, uint32_t count, uint32_t place, uint32_t run)
{
    float distances[NOH_STAGE_MESHES_MAX];
    uint8_t sorted[NOH_STAGE_MESHES_MAX];
    for (uint32_t i = 0; i < count; i++) {
        const float distance = distance_of(w, meshes[i], place);
        uint32_t at = i;
        for (; at && distances[at - 1u] < distance; at--) {
            distances[at] = distances[at - 1u];
            sorted[at] = sorted[at - 1u];
        }
        distances[at] = distance;
        sorted[at] = meshes[i];
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!shows(w, sorted[i], place)) continue;
        if (run == NOH_NONE) {
            draw_fading(w, sorted[i], place);
        } else if (is_mirrored(w, sorted[i], place)) {
            draw_alone(w, sorted[i], place, (noh_stage_part){ run / noh_stage_influence_levels(w->k), 0.0f, 1.0f });
        } else {
            draw_together(w, sorted[i], run, place, 1);
        }
    }
}

static void draw_meshes(const walk *w, const uint8_t *meshes, uint32_t count)
{
    const uint32_t runs = noh_stage_run_count(w->k);
    for (uint32_t run = 0; run < runs; run++) {
        if (count == 1u) {
            draw_run(w, meshes[0], run);
            continue;
        }
        for (uint32_t p = begin_of(w, run); p < begin_of(w, run + 1u); p++) {
            if (is_seen(w, p)) draw_sorted(w, meshes, count, p, run);
        }
    }
    for (uint32_t p = begin_of(w, runs); p < begin_of(w, runs + 1u); p++) {
        if (is_seen(w, p)) draw_sorted(w, meshes, count, p, NOH_NONE);
    }
}

/* The lowest priority of a mesh above `above`, at its finest level. */
static int next_priority(const noh_stage_kind *k, uint32_t mesh, int above)
{
    const noh_mesh finest = noh_mesh_at_lod(&k->meshes[mesh].mesh,
                                            noh_stage_mesh_level(k, mesh, k->plan->finest_level));
    return noh_mesh_next_priority(&finest, above);
}

static void draw_blended(walk *w)
{
    int priority = -NOH_PRIORITY_NONE;
    for (;;) {
        uint8_t meshes[NOH_STAGE_MESHES_MAX];
        uint32_t count = 0;
        int next = NOH_PRIORITY_NONE;
        for (uint32_t m = 0; m < w->k->plan->mesh_count; m++) {
            const int p = next_priority(w->k, m, priority);
            if (p > next || p == NOH_PRIORITY_NONE) continue;
            if (p < next) count = 0;
            next = p;
            meshes[count++] = (uint8_t)m;
        }
        if (!count) break;
        w->priority = next;
        draw_meshes(w, meshes, count);
        priority = next;
    }
}

/* ---- blended meshes of all actors ---- */

/* Whether `a` is drawn after `b`; equally far ones in the order of actors. */
static int is_after(const noh_stage_far *a, const noh_stage_far *b)
{
    return a->distance < b->distance || (a->distance == b->distance && a->actor > b->actor);
}

/* Sift the heap's entry `at` down; the entry drawn last is at the top. */
static void sift(noh_stage_far *heap, uint32_t at, uint32_t count)
{
    const noh_stage_far moved = heap[at];
    for (uint32_t child; (child = 2u * at + 1u) < count; at = child) {
        if (child + 1u < count && is_after(&heap[child + 1u], &heap[child])) child++;
        if (!is_after(&heap[child], &moved)) break;
        heap[at] = heap[child];
    }
    heap[at] = moved;
}

static void sort_far(noh_stage_far *heap, uint32_t count)
{
    for (uint32_t i = count / 2u; i > 0; i--) sift(heap, i - 1u, count);
    for (uint32_t end = count; end > 1u; end--) {
        const noh_stage_far last = heap[0];
        heap[0] = heap[end - 1u];
        heap[end - 1u] = last;
        sift(heap, 0, end - 1u);
    }
}

/* The first mesh of a kind that has a blended material; NOH_NONE: none has. */
static uint32_t first_blended(const noh_stage_kind *k)
{
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        if (next_priority(k, m, -NOH_PRIORITY_NONE) != NOH_PRIORITY_NONE) return m;
    }
    return NOH_NONE;
}

static void draw_from_far(const noh_stage_pass *pass)
{
    const noh_stage *s = pass->s;
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const walk w = { pass, &s->kinds[i], 0, UINT32_MAX, NOH_STAGE_OPAQUE };
        const uint32_t mesh = first_blended(w.k);
        for (uint32_t p = 0; mesh != NOH_NONE && !w.k->finer.hidden && p < noh_stage_seen(w.k); p++) {
            if (!is_seen(&w, p)) continue;
            s->by_distance[count].distance = distance_of(&w, mesh, p);
            s->by_distance[count++].actor = w.k->first_actor + w.k->order[p];
        }
    }
    sort_far(s->by_distance, count);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t actor = s->by_distance[i].actor, place = s->shown[actor].place;
        walk w = { pass, noh_stage_kind_of(s, actor), place, place + 1u, NOH_STAGE_OPAQUE };
        draw_blended(&w);
    }
}

void noh_stage_draw_pass(const noh_stage_pass *pass)
{
    if (pass->blended && pass->s->desc.sort_blended) {
        draw_from_far(pass);
        return;
    }
    for (uint32_t i = 0; i < pass->s->desc.kind_count; i++) {
        walk w = { pass, &pass->s->kinds[i], 0, UINT32_MAX, NOH_STAGE_OPAQUE };
        if (w.k->finer.hidden) continue;
        if (pass->blended) {
            draw_blended(&w);
        } else {
            draw_opaque(&w);
        }
    }
}

/* ---- a list for the game ---- */

typedef struct lister {
    const noh_stage *s;
    noh_draw *draws;
    uint32_t capacity, count;
} lister;

/* A mesh at a level, which may be of levels loaded later. */
static noh_mesh mesh_at(const noh_stage *s, const noh_stage_kind *k, uint32_t mesh, uint32_t level)
{
    noh_mesh own = k->meshes[mesh].mesh;
    if (level < own.header->level && k->finer.kind != NOH_NONE && s->kinds[k->finer.kind].finer.from) {
        (void)noh_pack_mesh_at(s->kinds[k->finer.kind].finer.from, k->meshes[mesh].item.mesh, &own, NULL);
    }
    return noh_mesh_at_lod(&own, level);
}

static void list_submesh(lister *l, const noh_stage_drawing *of, const noh_draw *shared, const noh_submesh *s,
                         const noh_material *m)
{
    noh_draw draw = *shared;
    const int blends = (m->flags & NOH_MATERIAL_BLEND) != 0, is_blended = of->priority != NOH_STAGE_OPAQUE;
    if (!s->index_count ||
        (is_blended ? !blends || m->priority != of->priority : blends && !noh_material_has_core(m))) {
        return;
    }
    draw.submesh = s;
    draw.material = m;
    draw.alpha_cutoff = m->flags & NOH_MATERIAL_MASK ? m->alpha_cutoff : -1.0f;
    if (!is_blended && noh_material_has_core(m)) draw.alpha_cutoff = NOH_CORE_ALPHA;
    if (l->count < l->capacity) l->draws[l->count] = draw;
    l->count++;
}

static void list_one(void *user, const noh_stage_drawing *of)
{
    lister *l = user;
    const noh_stage_kind *k = of->k;
    const uint32_t level = noh_stage_mesh_level(k, of->mesh, of->level), actor = k->order[of->first];
    const noh_mesh mesh = mesh_at(l->s, k, of->mesh, level);
    noh_draw draw;
    memset(&draw, 0, sizeof draw);
    draw.kind = (uint32_t)(k - l->s->kinds);
    draw.index = of->mesh;
    draw.mesh = k->meshes[of->mesh].item.mesh;
    draw.level = mesh.header->level;
    draw.actors = k->order + of->first;
    draw.actor_count = of->count;
    draw.first_actor = k->first_actor;
    draw.influence_count = of->influence_count;
    draw.texture_set = k->actors[actor].look.texture_set;
    draw.mirrored = noh_stage_is_mirrored(&k->meshes[of->mesh], &k->actors[actor],
                                          &l->s->shown[k->first_actor + actor]);
    draw.from = of->from;
    draw.to = of->to;
    if (!(of->from < of->to)) return;
    for (uint32_t i = 0; i < mesh.header->submesh_count; i++) {
        list_submesh(l, of, &draw, &mesh.submeshes[i], noh_mesh_material(&mesh, &mesh.submeshes[i]));
    }
}

uint32_t noh_stage_list_draws(const noh_stage *stage, uint32_t view, int blended, noh_draw *draws, uint32_t capacity)
{
    NOH_ASSERT(stage && (draws || !capacity));
    lister l = { stage, draws, capacity, 0 };
    const noh_stage_pass pass = { stage, view, blended, !stage->desc.full_detail, list_one, &l };
    if (stage->phase == NOH_STAGE_IDLE && view < stage->view_count) noh_stage_draw_pass(&pass);
    return l.count;
}
