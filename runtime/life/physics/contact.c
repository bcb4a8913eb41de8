/* contact.c: contacts of a rounded box with planes, a height field, and obstacles, which are rounded boxes, too.
 *
 * Two of these touch with corners of one on the other, or with edges. A corner outside the other's box is pushed out
 * along the shortest way; a corner inside by the side that is cheapest for it and the centre of its body together, so
 * that a body is not caught around an obstacle.
 * source   Ericson: Real-Time Collision Detection, 2005, sections 4.4.1 (separating axes) and 5.1.9 (segments) */
#include "life/physics/contact_internal.h"

#include "core/base/vector_internal.h"
#include "life/physics/world_ask_internal.h"
#include "life/physics/world_internal.h"
#include "life/physics/shape_internal.h"
#include "noh/low_core.h"
#include "noh/body.h"
#include "noh/low_life.h"

#define SAME 1e-3f /* metres: edges within this of the farthest one along an axis also touch */

static void add(noh_contacts *c, const float point[3], const float normal[3], float gap)
{
    uint32_t at = c->count;
    if (!(gap < 0.0f)) return;
    if (at == NOH_CONTACTS_MAX) {
        at = 0;
        for (uint32_t i = 1; i < NOH_CONTACTS_MAX; i++) {
            if (c->at[i].gap > c->at[at].gap) at = i;
        }
        if (c->at[at].gap <= gap) return;
    } else {
        c->count++;
    }
    memcpy(c->at[at].point, point, sizeof c->at[at].point);
    memcpy(c->at[at].normal, normal, sizeof c->at[at].normal);
    c->at[at].gap = gap;
}

/* ---- corners ---- */

/* Get corner 0..7. Returns 0 for a duplicate of a corner of lower number, where a side is 0. */
static int corner_of(const noh_obb *box, uint32_t corner, float out[3])
{
    float local[3];
    for (uint32_t i = 0; i < 3; i++) {
        const int above = corner >> i & 1u;
        if (above && !(box->half[i] > 0.0f)) return 0;
        local[i] = above ? box->half[i] : -box->half[i];
    }
    noh_quat_rotate(box->rotation, local, out);
    noh_madd3(box->centre, 1.0f, out, out);
    return 1;
}

static void into(const noh_obb *box, const float point[3], float out[3])
{
    float back[4], d[3];
    noh_quat_conjugate(box->rotation, back);
    noh_sub3(point, box->centre, d);
    noh_quat_rotate(back, d, out);
}

/* The way out of a box for a point inside it, in the box's space. middle: centre of the point's body */
static float way_out(const float half[3], const float p[3], const float middle[3], float normal[3])
{
    float least = 1e30f, way = 0.0f;
    for (int side = 0; side < 6; side++) {
        const int i = side / 2;
        const float sign = side % 2 ? -1.0f : 1.0f, own = half[i] - sign * p[i], other = half[i] - sign * middle[i];
        const float cost = own + (other > 0.0f ? other : 0.0f);
        if (!(cost < least)) continue;
        least = cost;
        way = own;
        normal[0] = normal[1] = normal[2] = 0.0f;
        normal[i] = sign;
    }
    return -way;
}

/* The distance of a point from a box, below 0 inside, and the direction out. */
static float from_box(const noh_obb *box, const float point[3], const float middle[3], float normal[3])
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    float p[3], m[3], off[3], far;
    into(box, point, p);
    for (int i = 0; i < 3; i++) {
        const float past = noh_abs(p[i]) - box->half[i];
        off[i] = past > 0.0f ? (p[i] < 0.0f ? -past : past) : 0.0f;
    }
    far = noh_length3(off);
    if (far > 1e-6f) {
        memcpy(normal, off, sizeof off);
        noh_normalize3(normal, up);
    } else {
        into(box, middle, m);
        far = way_out(box->half, p, m, normal);
    }
    noh_quat_rotate(box->rotation, normal, normal);
    return far;
}

/* Corners of a body in an obstacle. */
static void corners_in(const noh_round_box *body, const noh_round_box *on, noh_contacts *contacts)
{
    for (uint32_t i = 0; i < 8; i++) {
        float corner[3], normal[3], point[3];
        if (!corner_of(&body->box, i, corner)) continue;
        const float far = from_box(&on->box, corner, body->box.centre, normal);
        noh_madd3(corner, -body->radius, normal, point);
        add(contacts, point, normal, far - on->radius - body->radius);
    }
}

/* Corners of an obstacle in a body: the normal leads from the obstacle to the body. */
static void corners_on(const noh_round_box *body, const noh_round_box *on, noh_contacts *contacts)
{
    for (uint32_t i = 0; i < 8; i++) {
        float corner[3], normal[3], point[3];
        if (!corner_of(&on->box, i, corner)) continue;
        const float far = from_box(&body->box, corner, on->box.centre, normal);
        for (int k = 0; k < 3; k++) normal[k] = -normal[k];
        noh_madd3(corner, on->radius, normal, point);
        add(contacts, point, normal, far - on->radius - body->radius);
    }
}

/* ---- edges ---- */

typedef struct axes {
    float of[3][3]; /* of a box */
} axes;

static axes axes_of(const noh_obb *box)
{
    static const float units[3][3] = { { 1.0f, 0.0f, 0.0f }, { 0.0f, 1.0f, 0.0f }, { 0.0f, 0.0f, 1.0f } };
    axes a;
    for (int i = 0; i < 3; i++) noh_quat_rotate(box->rotation, units[i], a.of[i]);
    return a;
}

static float reach_along(const noh_obb *box, const axes *a, const float axis[3])
{
    float reach = 0.0f;
    for (int i = 0; i < 3; i++) reach += box->half[i] * noh_abs(noh_dot3(a->of[i], axis));
    return reach;
}

/* An axis along which two boxes are separated, or overlap least: from the obstacle to the body. */
typedef struct parting {
    float axis[3], far; /* separation; below 0: overlap */
    int edge_a, edge_b; /* the two edges whose product is the axis; below 0: the axis is a side */
} parting;

typedef struct pair {
    const noh_round_box *a, *b; /* body and obstacle */
    axes axes_a, axes_b;
    float between[3]; /* from the obstacle's centre to the body's */
} pair;

static void try_axis(const pair *p, const float axis[3], int edge_a, int edge_b, parting *best)
{
    const float along = noh_dot3(p->between, axis), sign = along < 0.0f ? -1.0f : 1.0f;
    const float reach = reach_along(&p->a->box, &p->axes_a, axis) + reach_along(&p->b->box, &p->axes_b, axis);
    const float far = sign * along - reach;
    if (!(far > best->far)) return;
    for (int k = 0; k < 3; k++) best->axis[k] = sign * axis[k];
    best->far = far;
    best->edge_a = edge_a;
    best->edge_b = edge_b;
}

/* Edges first: a side must be better than these, because its corners are found without it. */
static parting parting_of(const pair *p)
{
    parting best = { { 0.0f, 1.0f, 0.0f }, -1e30f, -1, -1 };
    for (int k = 0; k < 9; k++) {
        float axis[3];
        const int i = k / 3, j = k % 3;
        if (!(p->a->box.half[i] > 0.0f) || !(p->b->box.half[j] > 0.0f)) continue;
        noh_cross3(p->axes_a.of[i], p->axes_b.of[j], axis);
        const float square = noh_dot3(axis, axis);
        if (!(square > 1e-4f)) continue; /* nearly parallel: corners are enough */
        for (int n = 0; n < 3; n++) axis[n] /= noh_sqrt(square);
        try_axis(p, axis, i, j, &best);
    }
    best.far += 1e-5f;
    for (int i = 0; i < 3; i++) {
        try_axis(p, p->axes_a.of[i], -1, -1, &best);
        try_axis(p, p->axes_b.of[i], -1, -1, &best);
    }
    return best;
}

/* Get edge 0..3 along axis i: its ends, and its distance along `axis`. Returns 0 for a duplicate of an edge of lower
 * number. */
static int edge_of(const noh_obb *box, const axes *a, int i, uint32_t edge, const float axis[3], float ends[2][3],
                   float *far)
{
    float middle[3];
    memcpy(middle, box->centre, sizeof middle);
    for (uint32_t n = 0; n < 2; n++) {
        const int k = (i + 1 + (int)n) % 3, above = edge >> n & 1u;
        if (above && !(box->half[k] > 0.0f)) return 0;
        noh_madd3(middle, above ? box->half[k] : -box->half[k], a->of[k], middle);
    }
    noh_madd3(middle, -box->half[i], a->of[i], ends[0]);
    noh_madd3(middle, box->half[i], a->of[i], ends[1]);
    *far = noh_dot3(middle, axis);
    return 1;
}

/* Where two edges cross, if they do. */
static void cross_edges(const pair *p, const parting *best, float a[2][3], float b[2][3], noh_contacts *contacts)
{
    float along[2], on_a[3], on_b[3], d[3];
    noh_segments_closest(a[0], a[1], b[0], b[1], along);
    if (along[0] <= 0.0f || along[0] >= 1.0f || along[1] <= 0.0f || along[1] >= 1.0f) return; /* at a corner */
    noh_sub3(a[1], a[0], d);
    noh_madd3(a[0], along[0], d, on_a);
    noh_sub3(b[1], b[0], d);
    noh_madd3(b[0], along[1], d, on_b);
    noh_sub3(on_a, on_b, d);
    noh_madd3(on_a, -p->a->radius, best->axis, on_a);
    add(contacts, on_a, best->axis, noh_dot3(d, best->axis) - p->a->radius - p->b->radius);
}

static void edges_on(const pair *p, const parting *best, noh_contacts *contacts)
{
    const float reach_a = noh_dot3(p->a->box.centre, best->axis) - reach_along(&p->a->box, &p->axes_a, best->axis);
    const float reach_b = noh_dot3(p->b->box.centre, best->axis) + reach_along(&p->b->box, &p->axes_b, best->axis);
    for (uint32_t i = 0; i < 4; i++) {
        float a[2][3], b[2][3], far;
        if (!edge_of(&p->a->box, &p->axes_a, best->edge_a, i, best->axis, a, &far)) continue;
        for (uint32_t k = 0; k < 4; k++) {
            float far_b;
            if (!edge_of(&p->b->box, &p->axes_b, best->edge_b, k, best->axis, b, &far_b)) continue;
            if (far - reach_a < SAME && reach_b - far_b < SAME) cross_edges(p, best, a, b, contacts);
        }
    }
}

/* ---- obstacles of a world ---- */

static void touch_round(const noh_round_box *body, const noh_round_box *on, noh_contacts *contacts)
{
    pair p = { body, on, axes_of(&body->box), axes_of(&on->box), { 0.0f, 0.0f, 0.0f } };
    const float reach = noh_length3(body->box.half) + noh_length3(on->box.half) + body->radius + on->radius;
    const uint32_t before = contacts->count;
    noh_sub3(body->box.centre, on->box.centre, p.between);
    if (noh_dot3(p.between, p.between) >= reach * reach) return;
    const parting best = parting_of(&p);
    if (best.far >= body->radius + on->radius) return;
    corners_in(body, on, contacts);
    corners_on(body, on, contacts);
    if (best.edge_a >= 0) edges_on(&p, &best, contacts);
    if (contacts->count == before && best.far < 0.0f) { /* one has passed through the other */
        add(contacts, body->box.centre, best.axis, best.far - body->radius - on->radius);
    }
}

/* Ask what each corner of a body touches, as a ball. Corners of no number ask nothing.
 * shapes  touches[8] */
static void ask_corners(const noh_world *w, const float origin[3], const noh_round_box *body, noh_touches *touches)
{
    noh_world_body asked[8];
    noh_touches answers[8];
    uint32_t count = 0, of[8];
    memset(answers, 0, sizeof answers);
    for (uint32_t i = 0; i < 8; i++) {
        noh_world_body *a = &asked[count];
        if (!corner_of(&body->box, i, a->capsule.from)) continue;
        memcpy(a->capsule.to, a->capsule.from, sizeof a->capsule.to);
        memcpy(a->origin, origin, sizeof a->origin);
        a->capsule.radius = body->radius;
        a->reach = noh_length3(body->box.half) + body->radius;
        of[count++] = i;
    }
    noh_world_ask_touches(w, asked, count, answers);
    for (uint32_t i = 0; i < count; i++) touches[of[i]] = answers[i];
}

static void touch_ground(const noh_world *w, const float origin[3], const noh_round_box *body, noh_contacts *contacts)
{
    const int asks = noh_world_asks(w);
    noh_touches touches[8];
    for (uint32_t i = 0; i < 8; i++) touches[i].count = 0;
    if (asks) ask_corners(w, origin, body, touches);
    for (uint32_t i = 0; i < 8; i++) {
        float corner[3], point[3], normal[3], height;
        if (!corner_of(&body->box, i, corner)) continue;
        for (uint32_t k = 0; asks && k < touches[i].count; k++) {
            const noh_plane *plane = &touches[i].at[k].plane;
            noh_madd3(corner, -body->radius, plane->normal, point);
            add(contacts, point, plane->normal, noh_dot3(point, plane->normal) - plane->distance);
        }
        for (uint32_t k = 0; k < w->plane_count; k++) {
            const float *n = w->planes[k].normal;
            noh_madd3(corner, -body->radius, n, point);
            add(contacts, point, n, noh_dot3(point, n) - noh_plane_distance(&w->planes[k], origin));
        }
        if (w->field && noh_field_height_about(w->field, origin, corner[0], corner[2], &height, normal)) {
            noh_madd3(corner, -body->radius, normal, point);
            add(contacts, point, normal, (corner[1] - height) * normal[1] - body->radius);
        }
    }
}

static noh_round_box round_of_capsule(const noh_capsule *c, const float origin[3])
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f }, x[3] = { 1.0f, 0.0f, 0.0f };
    noh_round_box r;
    float from[3], axis[3];
    memset(&r, 0, sizeof r);
    noh_sub3(c->from, origin, from);
    noh_sub3(c->to, c->from, axis);
    noh_madd3(from, 0.5f, axis, r.box.centre);
    r.box.half[2] = 0.5f * noh_length3(axis);
    noh_quat_between(z, axis, x, r.box.rotation);
    r.radius = c->radius;
    return r;
}

/* Capsules of a world, then its boxes. */
static noh_round_box obstacle_of(const noh_world *w, uint32_t i, const float origin[3])
{
    if (i < w->capsule_count) return round_of_capsule(&w->capsules[i], origin);
    noh_round_box r = { w->boxes[i - w->capsule_count], 0.0f };
    noh_sub3(r.box.centre, origin, r.box.centre);
    return r;
}

void noh_contacts_find(const noh_world *w, const float origin[3], const noh_round_box *body, noh_contacts *contacts)
{
    contacts->count = 0;
    touch_ground(w, origin, body, contacts);
    for (uint32_t i = 0; i < w->capsule_count + w->box_count; i++) {
        const noh_round_box on = obstacle_of(w, i, origin);
        touch_round(body, &on, contacts);
    }
}

/* ---- balls ---- */

typedef struct ball {
    const noh_world_body *body;
    noh_touches *touches;
} ball;

/* `far`: from the ball's centre to the surface. */
static void add_touch(const ball *b, const float normal[3], float far)
{
    const float *at = b->body->capsule.from;
    noh_touches *t = b->touches;
    uint32_t to = t->count;
    if (!(far < b->body->capsule.radius + b->body->reach)) return;
    if (to == NOH_TOUCHES_MAX) {
        float most = far;
        for (uint32_t i = 0; i < NOH_TOUCHES_MAX; i++) {
            const float own = noh_dot3(t->at[i].plane.normal, at) - t->at[i].plane.distance;
            if (own > most) most = own, to = i;
        }
        if (to == NOH_TOUCHES_MAX) return;
    } else {
        t->count++;
    }
    memcpy(t->at[to].plane.normal, normal, sizeof t->at[to].plane.normal);
    t->at[to].plane.distance = noh_dot3(normal, at) - far;
    t->at[to].along = 0.0f;
}

static void touch_rounded(const ball *b, const noh_round_box *on)
{
    const float *at = b->body->capsule.from;
    float normal[3];
    const float far = from_box(&on->box, at, at, normal);
    add_touch(b, normal, far - on->radius);
}

static void touch_shapes(const noh_world *w, const ball *b)
{
    const float *at = b->body->capsule.from, *origin = b->body->origin;
    float height, normal[3];
    for (uint32_t i = 0; i < w->plane_count; i++) {
        const float *n = w->planes[i].normal;
        add_touch(b, n, noh_dot3(n, at) - noh_plane_distance(&w->planes[i], origin));
    }
    if (w->field && noh_field_height_about(w->field, origin, at[0], at[2], &height, normal)) {
        add_touch(b, normal, (at[1] - height) * normal[1]);
    }
    for (uint32_t i = 0; i < w->capsule_count + w->box_count; i++) {
        const noh_round_box on = obstacle_of(w, i, origin);
        touch_rounded(b, &on);
    }
}

void noh_touches_find(const noh_world *w, const noh_world_body *balls, uint32_t count, noh_touches *touches)
{
    noh_world_ask_touches(w, balls, count, touches);
    for (uint32_t i = 0; i < count; i++) {
        const ball b = { &balls[i], &touches[i] };
        touch_shapes(w, &b);
    }
}
