/* crowd_frame.c: a frame of a crowd on the CPU: clocks, LOD levels, poses, uploads. */
#include <math.h>
#include <string.h>

#include "crowd.h"

#define BODY_PIXELS \
    0.018f /* hundreds of pixels that a body of 1.8 m covers per pixel per metre: urgency of an update */

/* The cost of an update, nanoseconds, roughly as `noh bench` measures it. */
static const noh_cost_weights costs = { 500.0f, 40.0f, 0.0f, 0.0f };

/* ---- clocks ---- */

typedef struct witness {
    crowd_events *events;
    uint32_t body;
} witness;

static void on_event(void *user, const noh_event *event)
{
    const witness *w = user;
    const uint64_t what[4] = { w->body, event->clip, event->index, (uint64_t)event->clock };
    uint64_t hash = 14695981039346656037u;
    for (int i = 0; i < 4; i++) {
        hash = (hash ^ what[i]) * 1099511628211u;
    }
    w->events->count++;
    w->events->sum += hash;
}

/* For all bodies, visible or not. An invisible one costs nothing else. */
void crowd_step(crowd *c, uint32_t ticks)
{
    noh_clip_cache_begin_frame(c->bank->cache);
    c->frame_ticks = ticks;
    for (uint32_t i = 0; i < c->plan->options.count; i++) {
        witness w = { &c->events, i };
        noh_character_step(crowd_character(c, i), &c->set, ticks, on_event, &w);
    }
}

/* ---- visibility and LOD ---- */

/* The bounding sphere against the four side planes of the view and the plane of the eye. The view is symmetric, so that
 * |across| and |up| test two planes each: a plane through the eye at half the angle of view a has the normal
 * (cos a, -sin a) in (across, depth), and the sphere is outside where its centre is a radius or more beyond it. Also
 * sets the scale at the nearest point. */

static int is_seen(const crowd *c, const crowd_camera *camera, crowd_body *b)
{
    const float radius = c->sphere[3];
    float way[3], depth, across, up;
    for (int i = 0; i < 3; i++) {
        way[i] = b->centre[i] - camera->eye[i];
    }
    depth = way[0] * camera->forward[0] + way[1] * camera->forward[1] + way[2] * camera->forward[2];
    across = fabsf(way[0] * camera->right[0] + way[1] * camera->right[1] + way[2] * camera->right[2]);
    up = fabsf(way[0] * camera->up[0] + way[1] * camera->up[1] + way[2] * camera->up[2]);
    b->scale = noh_lod_scale(depth - radius, c->plan->options.field_of_view_rad, c->plan->options.height);
    return c->unculled || (depth > -radius && across * camera->cosine[0] - depth * camera->sine[0] < radius &&
                           up * camera->cosine[1] - depth * camera->sine[1] < radius);
}

static void update(crowd *c, uint32_t i)
{
    noh_character_update(crowd_character(c, i), &c->set, &c->skeleton, NULL, &c->scratch);
    c->stats.updated++;
}

uint32_t crowd_update_cost(const noh_character *ch)
{
    return noh_cost_ns(&costs, noh_character_joint_work(ch), 0, 0);
}

/* Choose the levels of a body, update it at once or offer it for an update, and ask for a slot of its mesh level. */
static void look_at(crowd *c, uint32_t i)
{
    noh_character *ch = crowd_character(c, i);
    crowd_body *b = &c->bodies[i];
    noh_due due;
    uint32_t cost;
    if (!b->was_seen) {
        noh_lod_cut(&ch->lod);
    }
    due = noh_character_look(ch, &c->table, &c->settings, b->scale);
    cost = due == NOH_DUE_NOT ? 0 : crowd_update_cost(ch);
    if (due == NOH_DUE_AT_ONCE) {
        noh_schedule_spend(&c->schedule, cost);
        update(c, i);
    } else if (due == NOH_DUE) {
        noh_schedule_offer(&c->schedule, i, noh_character_late(ch), b->scale * BODY_PIXELS, cost);
    }
    noh_lod_pools_ask(c->pools, i, noh_lod_finest(&ch->lod), b->scale);
}

/* Pools may be short of fine slots: the body is then drawn no finer than the slot it got, and chooses no finer in the
 * next frame. */
static void take_slot(crowd *c, uint32_t i)
{
    crowd_body *b = &c->bodies[i];
    noh_lod *d = &crowd_character(c, i)->lod;
    b->slot = noh_lod_pools_slot(c->pools, i);
    b->level = d->mesh > b->slot.level ? d->mesh : b->slot.level;
    b->level_before = d->mesh_before > b->slot.level ? d->mesh_before : b->slot.level;
    noh_lod_set_limit(d, b->slot.level);
}

static int fades(const crowd_body *b)
{
    return b->level != b->level_before;
}

uint32_t crowd_run_count(const crowd *c)
{
    return c->plan->level_count * c->table.influence_level_count;
}

static uint32_t run_of(const crowd *c, uint32_t i)
{
    const crowd_body *b = &c->bodies[i];
    return fades(b) ? crowd_run_count(c)
                    : b->level * c->table.influence_level_count + crowd_character(c, i)->lod.influences;
}

/* A counting sort by run, fading bodies last: count each run, turn counts into starts, then place each body. It needs
 * no second list and is stable. */
static void put_in_order(crowd *c)
{
    uint32_t next[CROWD_RUNS_MAX + 1u] = { 0 }, count = 0;
    const uint32_t runs = crowd_run_count(c);
    for (uint32_t i = 0; i < c->plan->options.count; i++) {
        if (c->bodies[i].seen) {
            c->stats.seen++;
            c->stats.levels[c->bodies[i].level]++;
            next[run_of(c, i)]++;
        }
    }
    c->stats.fading = next[runs];
    for (uint32_t k = 0; k <= runs; k++) {
        c->runs[k] = count;
        count += next[k];
        next[k] = c->runs[k];
    }
    for (uint32_t i = 0; i < c->plan->options.count; i++) {
        if (c->bodies[i].seen) {
            c->bodies[i].place = next[run_of(c, i)]++;
            c->order[c->bodies[i].place] = i;
        }
    }
}

void crowd_look(crowd *c, const crowd_camera *camera)
{
    uint32_t i;
    noh_schedule_begin(&c->schedule, c->frame_ticks, c->plan->options.budget_ns);
    noh_lod_pools_begin(c->pools);
    memset(&c->stats, 0, sizeof c->stats);
    for (i = 0; i < c->plan->options.count; i++) {
        crowd_body *b = &c->bodies[i];
        b->was_seen = b->seen;
        b->shown = 0;
        b->seen = is_seen(c, camera, b);
        if (b->seen && !c->plan->options.plain) {
            look_at(c, i);
        }
    }
    noh_lod_pools_share(c->pools);
    for (i = 0; i < c->plan->options.count && !c->plan->options.plain; i++) {
        if (c->bodies[i].seen) {
            take_slot(c, i);
        }
    }
    put_in_order(c);
}

/* ---- uploads ---- */

/* Without LOD: all joints, in this frame. */
static void pose_fully(crowd *c, noh_character *ch)
{
    noh_controller_pose(noh_character_controller(ch), &c->set, &c->scratch.pose, c->scratch.local, c->floats);
    noh_pose_skin(&c->skeleton, &c->plan->skin, c->scratch.local, c->scratch.model, c->matrices);
}

/* The weights that clips animate, or the mesh's own, without those too small to be seen. */
static void give_weights(crowd *c, const crowd_body *b, uint32_t instance, noh_lod *d, const float *floats)
{
    const float *weights = c->first_weight == NOH_NONE ? c->plan->mesh.weights : floats + c->first_weight;
    if (!c->plan->options.plain) {
        noh_lod_targets(d, &c->settings, weights, c->lod.radius_m, c->plan->mesh.header->target_count, c->weights);
        weights = c->weights;
        noh_gl_morph_set_lod(c->morph, instance, b->level < b->level_before ? b->level : b->level_before);
    }
    (void)noh_gl_morph_set_weights(c->morph, instance, weights, NULL); /* clips hold finite weights */
}

static void show_body(crowd *c, uint32_t i)
{
    noh_character *ch = crowd_character(c, i);
    const crowd_body *b = &c->bodies[i];
    const int plain = c->plan->options.plain;
    const uint32_t instance = plain ? i : noh_gl_morph_instance(c->morph, b->slot.pool, b->slot.slot);
    noh_gl_morph_binding morph = noh_gl_morph_binding_of(c->morph, instance);
    if (plain) {
        pose_fully(c, ch);
    } else {
        noh_character_skin(ch, &c->plan->skin, c->matrices);
    }
    noh_gl_skin_set_matrices(c->palettes, b->place, c->matrices);
    give_weights(c, b, instance, &ch->lod, plain ? c->floats : noh_character_floats(ch, c->floats));
    (void)noh_gl_skin_set_place(c->palettes, b->place, b->world, &morph, NULL); /* no body is mirrored */
}

/* Updated bodies first, each uploaded while its pose is in the CPU's cache; then the others. */
void crowd_show(crowd *c)
{
    uint32_t i;
    while (noh_schedule_next(&c->schedule, &i)) {
        update(c, i);
        show_body(c, i);
        c->bodies[i].shown = 1;
    }
    for (uint32_t k = 0; k < c->stats.seen; k++) {
        if (!c->bodies[c->order[k]].shown) {
            show_body(c, c->order[k]);
        }
    }
}
