/* lod_build.c: the order of the collapses, and the levels.
 *
 * Simplification by half-edge collapses from a priority queue: the point whose best collapse costs least is removed and
 * its neighbours are judged again, until the level has few enough triangles (or the next collapse would exceed the
 * level's error). The cost makes the difference, because a coarse face must still smile: a point has a quadric for each
 * pose in which it moves (rest, every target, mixes, frames of clips), and the largest counts, not the sum, so an error
 * that shows in a single pose is not averaged away.
 *
 * Quadrics measure planes, not triangles, and lose track of how far the surface has already moved. So they only rank:
 * the TESTED best collapses of a point are measured by samples of the full surface, which stay attached to the
 * triangles that replace theirs (lod_track.c, lod_measure.c); changes of UVs, colours and skin weights are added as
 * lengths (lod_attribute.c). LOD_FAST omits the measuring. */
#include "lod_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lod_queue.h"
#include "convert/model/model_build.h"

#define TESTED 4u         /* candidates of a point that are measured, the best by quadric */
#define QUADRIC_SHARE 0.3 /* the quadric's share in the cost of a measured collapse */
#define PROGRESS_STEP 256u

#define MINOR_GROWTH 1.5
#define STALE_SHARE 0.7 /* of the cost that a point had before its surroundings changed */
#define CHEAP_SHARE 0.2 /* one whose cost may be less than this of it is put to where that would be */

typedef enum point_state { OUT, QUEUED, PARKED } point_state;

typedef struct builder {
    lod_surface surface;
    lod_options options;
    lod_quadric_row *quadrics;
    lod_track *track; /* NULL: fast */
    lod_queue queue;
    uint32_t *best_to;                    /* [vertex_count] the neighbour that a queued point would move to */
    float *best_length;                   /* [vertex_count] that collapse's error as a length */
    uint8_t *state;                       /* [vertex_count] point_state; PARKED points wait for a coarser level */
    uint8_t *stale;                       /* [vertex_count] a queued point whose surroundings have changed */
    uint32_t steps, live, full, coarsest; /* live, full, coarsest: triangles left, of the mesh, of the last level */
    float cost;
    lod *out;
} builder;

typedef struct candidate {
    uint32_t to;
    double quadric;
} candidate;

/* ---- costs ---- */

static uint32_t list_candidates(builder *b, const lod_fan *fan, candidate *out)
{
    lod_move move;
    uint32_t count = 0;
    for (uint32_t i = 0; i < fan->ring_count; i++) {
        uint32_t at = count;
        candidate c = { fan->ring[i], 0.0 };
        if (!lod_move_allowed(&b->surface, fan, c.to, &move) || !lod_contact_allows(&b->surface, fan, c.to)) {
            continue;
        }
        c.quadric = lod_quadric_cost(&b->surface, b->quadrics, fan->point, c.to);
        while (at > 0 && out[at - 1u].quadric > c.quadric) {
            out[at] = out[at - 1u];
            at--;
        }
        out[at] = c;
        count++;
    }
    return count;
}

/* The squared length that a collapse costs; *length is the error that it leaves. Stops at `bound`. */
static double measure(builder *b, const lod_fan *fan, const candidate *c, double bound, float *length)
{
    const lod_surface *s = &b->surface;
    uint32_t triangles[LOD_FAN_MAX], count = fan->count;
    const uint32_t *list = triangles;
    double cost, parts, tracked = c->quadric;
    lod_move move;
    lod_move_allowed(&b->surface, fan, c->to, &move);
    if (b->track) {
        cost = QUADRIC_SHARE * c->quadric;
        list = lod_track_triangles(b->track, &count);
        cost += lod_attribute_cost(s, &move, list, count, s->mesh->indices, &parts);
        if (cost >= bound) {
            return cost;
        }
        cost += lod_track_cost(b->track, &move, bound - cost, &tracked);
        *length = (float)sqrt(tracked > parts ? tracked : parts);
        return cost;
    }
    for (uint32_t i = 0; i < count; i++) {
        triangles[i] = fan->corner[i] / 3u;
    }
    cost = tracked + lod_attribute_cost(s, &move, list, count, s->corner, &parts);
    tracked = parts > tracked ? parts : tracked;
    *length = (float)sqrt(tracked > 0.0 ? tracked : 0.0);
    return cost;
}

/* The factor on a squared length at a point: in small parts (eyes, teeth) it grows with the length, which is a larger
 * share of them. */
static double importance(const builder *b, uint32_t point, double squared)
{
    const lod_surface *s = &b->surface;
    double weight = s->face[point] ? b->options.face_weight : 1.0;
    if (s->minor[s->part[point]] && s->edge > 0.0f) {
        weight *= 1.0 + MINOR_GROWTH * sqrt(squared) / s->edge;
    }
    return weight * weight;
}

/* The cost of a point's best collapse together with the collapse of the point that touches it, the larger one. Returns 1
 * when out of memory. */
static int measure_contact(builder *b, uint32_t point, double *best)
{
    const uint32_t other = b->surface.other[point];
    candidate c = { lod_contact_goes_to(&b->surface, b->best_to[point]), 0.0 };
    float length = 0.0f;
    lod_fan fan;
    double cost;
    if (other == LOD_NONE) {
        return 0;
    }
    if (lod_fan_gather(&b->surface, other, &fan) || (b->track && lod_track_open(b->track, &fan))) {
        return 1;
    }
    c.quadric = lod_quadric_cost(&b->surface, b->quadrics, other, c.to);
    cost = measure(b, &fan, &c, HUGE_VAL, &length);
    *best = cost > *best ? cost : *best;
    b->best_length[point] = length > b->best_length[point] ? length : b->best_length[point];
    return 0;
}

/* The work depends on the shapes of targets, and is known only while it is done: beyond the limit, nothing more is
 * measured. */
static void limit_work(builder *b)
{
    if (b->track && b->options.work_max && lod_track_work(b->track) > b->options.work_max) {
        lod_track_free(b->track);
        b->track = NULL;
    }
}

/* Find a point's best collapse and queue it. Returns 1 when out of memory. */
static int queue_point(builder *b, uint32_t point)
{
    candidate list[LOD_RING_MAX];
    lod_fan fan;
    double best = HUGE_VAL;
    uint32_t count;
    float length = 0.0f;
    limit_work(b);
    if (b->state[point] == QUEUED) {
        lod_queue_drop(&b->queue, point);
    }
    b->state[point] = OUT;
    b->stale[point] = 0;
    if (b->surface.locked[point] || lod_fan_gather(&b->surface, point, &fan)) {
        return 0;
    }
    count = list_candidates(b, &fan, list);
    if (count == 0) {
        return 0;
    }
    if (b->track && lod_track_open(b->track, &fan)) {
        return 1;
    }
    count = b->track && count > TESTED ? TESTED : count;
    for (uint32_t i = 0; i < count; i++) {
        double cost = measure(b, &fan, &list[i], best, &length);
        if (cost < best) {
            best = cost;
            b->best_to[point] = list[i].to;
            b->best_length[point] = length;
        }
    }
    if (measure_contact(b, point, &best)) {
        return 1;
    }
    b->state[point] = QUEUED;
    lod_queue_put(&b->queue, point, (float)(best * importance(b, point, best)));
    return 0;
}

/* ---- collapsing ---- */

static int record(builder *b, const lod_move *m)
{
    lod *l = b->out;
    float length = b->best_length[m->from];
    b->cost = length > b->cost ? length : b->cost;
    for (uint32_t w = 0; w < m->wedge_count; w++) {
        lod_collapse *c = &l->collapses[l->collapse_count++];
        c->from = m->wedge_from[w];
        c->to = m->wedge_to[w];
        c->step = b->steps;
        c->cost = b->cost;
        c->triangles = b->live - m->gone_count;
    }
    for (uint32_t i = 0; i < m->gone_count; i++) {
        l->gone[m->gone[i] / 3u] = l->collapse_count;
    }
    l->measured = b->track || b->options.mode == LOD_FAST ? l->collapse_count : l->measured;
    b->steps++;
    b->live -= m->gone_count;
    if (b->options.progress && b->steps % PROGRESS_STEP == 0) {
        b->options.progress(b->options.user, b->full - b->live, b->full - b->coarsest);
    }
    return lod_quadric_merge(b->quadrics, m->from, m->to);
}

/* A lower bound of a point's cost that is cheap to measure. */
static double least_cost(builder *b, const lod_fan *fan, const candidate *list, uint32_t count, double bound)
{
    double least = HUGE_VAL;
    count = b->track && count > TESTED ? TESTED : count;
    for (uint32_t i = 0; i < count && least > bound; i++) {
        double cost = list[i].quadric;
        lod_move move;
        if (b->track) {
            lod_move_allowed(&b->surface, fan, list[i].to, &move);
            cost = QUADRIC_SHARE * cost + lod_track_least(b->track, &move);
        }
        least = cost < least ? cost : least;
    }
    return least * importance(b, fan->point, least);
}

/* A point next to a collapse is evaluated again only when its turn comes, since most change several times before. Until
 * then it keeps its place, a little to the front, as costs seldom fall; a point that may have become cheap moves to the
 * front. Returns 1 when out of memory. */
static int change_point(builder *b, uint32_t point)
{
    candidate list[LOD_RING_MAX];
    lod_fan fan;
    uint32_t count;
    double cost = b->queue.cost[point] * (b->stale[point] ? 1.0 : STALE_SHARE), least;
    if (b->state[point] == OUT) {
        return queue_point(b, point);
    }
    if (b->state[point] == QUEUED) {
        lod_queue_drop(&b->queue, point);
    }
    b->state[point] = OUT;
    count = lod_fan_gather(&b->surface, point, &fan) ? 0u : list_candidates(b, &fan, list);
    if (!count) {
        return 0;
    }
    if (b->track && lod_track_open(b->track, &fan)) {
        return 1;
    }
    least = least_cost(b, &fan, list, count, cost * CHEAP_SHARE);
    b->state[point] = QUEUED;
    b->stale[point] = 1;
    lod_queue_put(&b->queue, point, (float)(least < cost * CHEAP_SHARE ? least : cost));
    return 0;
}

static int collapse(builder *b, lod_fan *fan, const lod_move *m)
{
    if (b->track) {
        if (lod_track_open(b->track, fan)) {
            return 1;
        }
        lod_track_commit(b->track, m);
    }
    lod_move_apply(&b->surface, m);
    if (record(b, m)) {
        return 1;
    }
    for (uint32_t i = 0; i < fan->ring_count; i++) { /* `to` is among them */
        const uint32_t point = fan->ring[i], other = b->surface.other[point];
        if (change_point(b, point) || (other != LOD_NONE && change_point(b, other))) {
            return 1;
        }
    }
    return 0;
}

/* The point that touches one that has gone follows it. Returns 1 when out of memory. */
static int follow(builder *b, uint32_t point)
{
    const uint32_t other = b->surface.other[point];
    lod_fan fan;
    lod_move move;
    if (other == LOD_NONE || lod_fan_gather(&b->surface, other, &fan) ||
        !lod_move_allowed(&b->surface, &fan, lod_contact_goes_to(&b->surface, b->best_to[point]), &move)) {
        return 0;
    }
    if (b->state[other] == QUEUED) {
        lod_queue_drop(&b->queue, other);
    }
    b->state[other] = OUT;
    b->best_length[other] = b->best_length[point];
    return collapse(b, &fan, &move);
}

/* Take the cheapest point of the queue. Returns 1 when out of memory. */
static int take(builder *b, uint32_t point)
{
    lod_fan fan;
    lod_move move;
    b->state[point] = OUT;
    if (lod_fan_gather(&b->surface, point, &fan)) {
        return 0;
    }
    if (!lod_move_allowed(&b->surface, &fan, b->best_to[point], &move) ||
        !lod_contact_allows(&b->surface, &fan, b->best_to[point])) {
        return queue_point(b, point); /* a change two rings away now forbids the collapse */
    }
    return collapse(b, &fan, &move) || follow(b, point);
}

/* Whether a point has to wait for a coarser level. */
static int is_beyond(const builder *b, uint32_t level, uint32_t point)
{
    const float most = b->options.errors ? b->options.errors[level] : b->options.error_max;
    return most > 0.0f && b->best_length[point] > most;
}

/* The number of triangles wanted for a level: its share of those that may go. Otherwise the rest would have to make up
 * for hair cards, which keep two each. */
static uint32_t goal_of(const builder *b, uint32_t level)
{
    const uint32_t least = lod_cards_least(&b->surface);
    return b->options.errors
               ? 0u
               : least + (uint32_t)ceil((double)b->options.ratios[level] * (double)(b->full - least) - 1e-3);
}

static int collapse_to_level(builder *b, uint32_t level)
{
    uint32_t point, goal = goal_of(b, level);
    int failed = 0;
    for (uint32_t p = 0; p < b->surface.mesh->vertex_count; p++) {
        if (b->state[p] == PARKED) {
            b->state[p] = QUEUED;
            lod_queue_put(&b->queue, p, b->queue.cost[p]);
        }
    }
    while (!failed && b->live > goal && lod_queue_first(&b->queue, &point)) {
        if (b->stale[point]) {
            failed = queue_point(b, point);
            continue;
        }
        lod_queue_take(&b->queue);
        if (is_beyond(b, level, point)) {
            b->state[point] = PARKED;
        } else {
            failed = take(b, point);
        }
    }
    return failed;
}

/* ---- levels ---- */

static uint32_t count_vertices(const lod_level *level, uint32_t *mark, uint32_t stamp)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < level->index_count; i++) {
        count += mark[level->indices[i]] != stamp;
        mark[level->indices[i]] = stamp;
    }
    return count;
}

/* Copy the triangles that are left. Returns 1 when out of memory. */
static int write_level(builder *b, lod_level *level)
{
    const lod_surface *s = &b->surface;
    uint32_t at = 0;
    for (uint32_t i = 0; i < b->out->submesh_count; i++) {
        level->index_count += s->live[i] * 3u;
    }
    if (lod_level_alloc(level, b->out->submesh_count)) {
        return 1;
    }
    for (uint32_t i = 0; i < b->out->submesh_count; i++) {
        const model_submesh *sub = &s->mesh->submeshes[i];
        level->submesh_first[i] = at;
        level->submesh_count[i] = s->live[i] * 3u;
        for (uint32_t t = sub->first_index / 3u; t < (sub->first_index + sub->index_count) / 3u; t++) {
            if (!s->dead[t]) {
                memcpy(level->indices + at, s->corner + (size_t)t * 3u, 3u * sizeof *level->indices);
                at += 3u;
            }
        }
    }
    level->collapse_count = b->out->collapse_count;
    level->cost = b->cost;
    b->surface.stamp += 2u;
    level->vertex_count = count_vertices(level, b->surface.mark, b->surface.stamp);
    return 0;
}

static int build_levels(builder *b)
{
    int failed = 0;
    for (uint32_t i = 0; i < b->out->submesh_count; i++) {
        b->full += b->surface.live[i];
    }
    b->live = b->full;
    b->out->least = lod_cards_least(&b->surface);
    b->coarsest = goal_of(b, b->options.level_count - 1u);
    for (uint32_t p = 0; p < b->surface.mesh->vertex_count && !failed; p++) {
        failed = queue_point(b, p);
        b->out->points += b->surface.first[p] != LOD_NONE;
        b->out->stuck += b->surface.first[p] != LOD_NONE && b->state[p] == OUT;
    }
    for (uint32_t i = 0; i < b->options.level_count && !failed; i++) {
        failed = collapse_to_level(b, i) || write_level(b, &b->out->levels[i]);
        b->out->level_count += !failed;
    }
    return failed;
}

/* ---- all of it ---- */

static int allocate(builder *b, const model_mesh *mesh)
{
    size_t vertices = (size_t)mesh->vertex_count + 1u;
    b->best_to = calloc(vertices, sizeof *b->best_to);
    b->best_length = calloc(vertices, sizeof *b->best_length);
    b->state = calloc(vertices, 1);
    b->stale = calloc(vertices, 1);
    b->out = calloc(1, sizeof *b->out);
    if (!b->best_to || !b->best_length || !b->state || !b->stale || !b->out) {
        return 1;
    }
    b->out->submesh_count = mesh->submesh_count;
    b->out->gone = malloc(((size_t)mesh->index_count / 3u + 1u) * sizeof *b->out->gone);
    if (!b->out->gone) {
        return 1;
    }
    for (uint32_t t = 0; t < mesh->index_count / 3u; t++) {
        b->out->gone[t] = b->surface.dead[t] ? 0u : LOD_STAYS;
    }
    b->out->collapses = calloc(vertices, sizeof *b->out->collapses);
    return !b->out->collapses || lod_queue_make(&b->queue, mesh->vertex_count);
}

static void builder_free(builder *b)
{
    lod_quadrics_free(b->quadrics, b->surface.mesh->vertex_count);
    lod_track_free(b->track);
    lod_surface_free(&b->surface);
    lod_queue_free(&b->queue);
    free(b->best_to);
    free(b->best_length);
    free(b->state);
    free(b->stale);
}

int lod_build(const model_mesh *mesh, const lod_options *options, lod **out, model_error *error)
{
    builder b;
    int failed;
    memset(&b, 0, sizeof b);
    *out = NULL;
    b.options = *options;
    if (lod_check_options(&b.options, mesh->target_count, error) || lod_check_mesh(mesh, &b.options, error)) {
        return 1;
    }
    failed = lod_surface_make(mesh, &b.options, &b.surface) || allocate(&b, mesh);
    if (!failed) {
        b.quadrics = lod_quadrics_make(&b.surface);
        b.track = b.options.mode == LOD_QUALITY ? lod_track_make(&b.surface) : NULL;
        failed = !b.quadrics || (b.options.mode == LOD_QUALITY && !b.track) || build_levels(&b);
    }
    builder_free(&b);
    if (failed) {
        lod_free(b.out);
        return model_fail(error, "", "out of memory for the LOD levels");
    }
    *out = b.out;
    return 0;
}

void lod_free(lod *l)
{
    if (l) {
        for (uint32_t i = 0; i < LOD_LEVELS_MAX; i++) {
            free(l->levels[i].indices);
            free(l->levels[i].submesh_first);
        }
        free(l->collapses);
        free(l->gone);
        free(l);
    }
}
