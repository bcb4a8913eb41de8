/* triangles_touch.c: what capsules touch of triangles.
 *
 * Each end of a capsule has its own planes: of faces that it is in front of, then of edges and corners that stick out
 * of these planes. An edge between two faces of one plane is none, so that nothing stumbles over it. An end that is
 * behind the nearest face is led back out of it. Between the ends only edges can touch first.
 * source   Ericson: Real-Time Collision Detection, 2005, sections 5.1.5 (point and triangle), 5.1.9 (segments) */
#include "life/physics/triangles_internal.h"

#include "life/physics/shape_internal.h"
#include "core/base/vector_internal.h"

#define NEAREST 12u /* candidates that are kept of one point */
#define END_MAX 3u  /* planes of one end */
#define BETWEEN_MAX 2u
#define SAME 1e-3f /* metres: within it a point lies on a plane */
#define PARALLEL 0.999f
#define BETWEEN 0.02f /* of a capsule's length: nearer to an end it is that end which touches */

static const float zero[3] = { 0.0f, 0.0f, 0.0f };

typedef struct candidate {
    float normal[3], at[3]; /* at: the point of the triangle */
    float far, along;       /* far: from the point; 0.. */
    int is_face;
} candidate;

typedef struct candidates {
    candidate nearest[NEAREST]; /* by distance */
    uint32_t count;
    candidate behind; /* the nearest face that the point is behind; far below 0: none */
} candidates;

typedef struct query {
    const noh_triangles *triangles;
    const noh_world_body *body;
    float reach;      /* from the axis */
    uint32_t ends;    /* 1: a ball */
    candidates of[3]; /* of `to`, of `from`, and between them */
} query;

static void keep(candidates *c, const candidate *new_one)
{
    uint32_t i = c->count < NEAREST ? c->count++ : NEAREST;
    if (i == NEAREST && !(new_one->far < c->nearest[NEAREST - 1u].far)) return;
    if (i == NEAREST) i--;
    for (; i && new_one->far < c->nearest[i - 1u].far; i--) c->nearest[i] = c->nearest[i - 1u];
    c->nearest[i] = *new_one;
}

/* ---- a point and a triangle ---- */

typedef struct face {
    float corners[3][3], normal[3];
} face;

/* Returns 0: it has no area. */
static int face_of(const query *q, uint32_t triangle, face *f)
{
    float ab[3], ac[3];
    for (uint32_t i = 0; i < 3; i++) {
        noh_triangle_corner(q->triangles, triangle, i, q->body->origin, f->corners[i]);
    }
    noh_sub3(f->corners[1], f->corners[0], ab);
    noh_sub3(f->corners[2], f->corners[0], ac);
    noh_cross3(ab, ac, f->normal);
    noh_normalize3(f->normal, zero);
    return noh_dot3(f->normal, f->normal) > 0.5f;
}

/* Whether the foot of a point's perpendicular is inside the triangle. */
static int is_above(const face *f, const float point[3])
{
    for (int i = 0; i < 3; i++) {
        float edge[3], inwards[3], d[3];
        noh_sub3(f->corners[(i + 1) % 3], f->corners[i], edge);
        noh_cross3(f->normal, edge, inwards);
        noh_sub3(point, f->corners[i], d);
        if (noh_dot3(inwards, d) < 0.0f) return 0;
    }
    return 1;
}

static float side_of(const face *f, const float point[3])
{
    float d[3];
    noh_sub3(point, f->corners[0], d);
    return noh_dot3(d, f->normal);
}

/* From a point of an edge to one of the axis. Returns 0: too far, or no direction. */
static int point_out(const query *q, const float point[3], candidate *c)
{
    noh_sub3(point, c->at, c->normal);
    c->far = noh_length3(c->normal);
    noh_normalize3(c->normal, zero);
    return c->far > 1e-6f && c->far <= q->reach;
}

static void meet_point(const query *q, const face *f, const float point[3], float along, candidates *out)
{
    const float side = side_of(f, point);
    candidate c = { { 0.0f }, { 0.0f }, side, along, 1 };
    if (noh_abs(side) > q->reach) return;
    if (is_above(f, point)) {
        memcpy(c.normal, f->normal, sizeof c.normal);
        noh_madd3(point, -side, f->normal, c.at);
        if (side >= 0.0f) keep(out, &c);
        c.far = -side;
        if (side < 0.0f && (out->behind.far < 0.0f || c.far < out->behind.far)) out->behind = c;
        return;
    }
    if (side <= 0.0f) return;
    c.is_face = 0;
    c.far = 1e30f;
    for (int i = 0; i < 3; i++) { /* the nearest edge */
        const float *a = f->corners[i], *b = f->corners[(i + 1) % 3];
        float share[2], edge[3], at[3], d[3];
        noh_segments_closest(a, b, point, point, share);
        noh_sub3(b, a, edge);
        noh_madd3(a, share[0], edge, at);
        noh_sub3(point, at, d);
        const float square = noh_dot3(d, d);
        if (square < c.far) {
            c.far = square;
            memcpy(c.at, at, sizeof at);
        }
    }
    if (point_out(q, point, &c)) keep(out, &c);
}

static void meet_edges(query *q, const face *f)
{
    const noh_capsule *k = &q->body->capsule;
    float axis[3];
    noh_sub3(k->to, k->from, axis);
    for (int i = 0; i < 3; i++) {
        const float *a = f->corners[i], *b = f->corners[(i + 1) % 3];
        float share[2], edge[3], point[3];
        candidate c = { { 0.0f }, { 0.0f }, 0.0f, 0.0f, 0 };
        noh_segments_closest(k->from, k->to, a, b, share);
        if (share[0] < BETWEEN || share[0] > 1.0f - BETWEEN) continue;
        noh_madd3(k->from, share[0], axis, point);
        noh_sub3(b, a, edge);
        noh_madd3(a, share[1], edge, c.at);
        c.along = 2.0f * share[0] - 1.0f;
        if (side_of(f, point) > 0.0f && point_out(q, point, &c)) keep(&q->of[2], &c);
    }
}

static void meet(query *q, uint32_t triangle)
{
    const noh_capsule *k = &q->body->capsule;
    face f;
    if (!face_of(q, triangle, &f)) return;
    meet_point(q, &f, k->to, 1.0f, &q->of[0]);
    if (q->ends == 1u) return;
    meet_point(q, &f, k->from, -1.0f, &q->of[1]);
    meet_edges(q, &f);
}

/* ---- what counts ---- */

static void answer(noh_touches *t, const candidate *c)
{
    noh_touch *touch = &t->at[t->count++];
    memcpy(touch->plane.normal, c->normal, sizeof c->normal);
    touch->plane.distance = noh_dot3(c->at, c->normal);
    touch->along = c->along;
}

/* How far a point is in front of the lowest of some planes; 1e30: there is none. */
static float over_planes(const noh_touches *t, uint32_t first, const float point[3], const float normal[3], float like)
{
    float least = 1e30f;
    for (uint32_t i = first; i < t->count; i++) {
        const noh_plane *p = &t->at[i].plane;
        const float over = noh_dot3(point, p->normal) - p->distance;
        if (noh_dot3(p->normal, normal) > like && over < least) least = over;
    }
    return least;
}

static void answer_end(const candidates *c, noh_touches *t)
{
    const uint32_t first = t->count;
    if (c->behind.far >= 0.0f && !(c->count && c->nearest[0].far < c->behind.far)) answer(t, &c->behind);
    for (uint32_t i = 0; i < c->count && t->count < first + END_MAX; i++) {
        const candidate *n = &c->nearest[i];
        if (n->is_face && noh_abs(over_planes(t, first, n->at, n->normal, PARALLEL)) > SAME) answer(t, n);
    }
    for (uint32_t i = 0; i < c->count && t->count < first + END_MAX; i++) {
        const candidate *n = &c->nearest[i];
        if (!n->is_face && over_planes(t, first, n->at, n->normal, -2.0f) > SAME) answer(t, n);
    }
}

static void answer_between(const candidates *c, noh_touches *t)
{
    const uint32_t first = t->count;
    for (uint32_t i = 0; i < c->count && t->count < first + BETWEEN_MAX; i++) {
        const candidate *n = &c->nearest[i];
        const int is_new = over_planes(t, first, n->at, n->normal, -2.0f) > SAME;
        if (is_new && over_planes(t, 0, n->at, n->normal, PARALLEL) > SAME) answer(t, n);
    }
}

/* ---- the walk ---- */

static noh_aabb box_of(const query *q)
{
    const noh_capsule *k = &q->body->capsule;
    noh_aabb box;
    for (int i = 0; i < 3; i++) {
        box.min[i] = (k->from[i] < k->to[i] ? k->from[i] : k->to[i]) - q->reach;
        box.max[i] = (k->from[i] > k->to[i] ? k->from[i] : k->to[i]) + q->reach;
    }
    return box;
}

static int boxes_meet(const noh_aabb *a, const noh_aabb *b)
{
    int meet = 1;
    for (int i = 0; i < 3; i++) meet &= a->min[i] <= b->max[i] && b->min[i] <= a->max[i];
    return meet;
}

static void touch_one(const noh_triangles *t, const noh_world_body *body, noh_touches *touches)
{
    query q = { .triangles = t, .body = body };
    noh_triangle_walk walk = { { 0 }, 1 };
    q.reach = body->capsule.radius + body->reach;
    q.ends = memcmp(body->capsule.from, body->capsule.to, sizeof body->capsule.to) ? 2u : 1u;
    for (int i = 0; i < 3; i++) q.of[i].behind.far = -1.0f;
    const noh_aabb near_body = box_of(&q);
    while (walk.count) {
        const uint32_t own = walk.stack[--walk.count];
        const noh_triangle_node *n = &t->nodes[own];
        const noh_aabb box = noh_triangle_box(n, body->origin);
        if (!boxes_meet(&near_body, &box)) continue;
        if (!n->count) {
            walk.stack[walk.count++] = n->at;
            walk.stack[walk.count++] = own + 1u;
        }
        for (uint32_t i = 0; i < n->count; i++) meet(&q, t->order[n->at + i]);
    }
    touches->count = 0;
    answer_end(&q.of[0], touches);
    if (q.ends == 1u) return;
    answer_end(&q.of[1], touches);
    answer_between(&q.of[2], touches);
}

void noh_triangles_touch(const noh_triangles *triangles, const noh_world_body *bodies, uint32_t count,
                         noh_touches *touches)
{
    for (uint32_t i = 0; i < count; i++) touch_one(triangles, &bodies[i], &touches[i]);
}
