/* triangles.c: triangles as the physics of a world: a tree of boxes, and rays.
 *
 * A node's triangles are halved by their middles along the longest side, down to four. The order is by middle, then by
 * index, so the same triangles give the same tree everywhere.
 * source   Ericson: Real-Time Collision Detection, 2005, section 6.2 (trees of boxes)
 *          Moeller, Trumbore: Fast, Minimum Storage Ray/Triangle Intersection, 1997 */
#include "life/physics/triangles_internal.h"

#include "core/base/assert_internal.h"
#include "life/physics/shape_internal.h"
#include "core/base/vector_internal.h"
#include "noh/base.h"

#define LEAF 4u
#define EDGE 1e-6f /* of a triangle: a ray may miss it by this, so that none falls between two */

/* ---- memory ---- */

/* At each depth nodes have one of two sizes, `size` and one more: `fewer` and `more` of these. */
static size_t nodes_of(uint32_t triangles)
{
    size_t nodes = 0, fewer = 1, more = 0;
    for (uint32_t size = triangles; fewer + more; size /= 2u) {
        nodes += fewer + more;
        if (size <= LEAF) fewer = 0;
        if (size + 1u <= LEAF) more = 0;
        const size_t halved = fewer;
        fewer = size % 2u ? halved : 2u * halved + more;
        more = size % 2u ? halved + 2u * more : more;
    }
    return nodes;
}

static noh_triangles *carve(noh_arena *arena, uint32_t count)
{
    noh_triangles *t = noh_arena_carve(arena, sizeof *t, 16);
    noh_triangle_node *nodes = noh_arena_carve(arena, nodes_of(count) * sizeof *nodes, 16);
    uint32_t *order = noh_arena_carve(arena, count * sizeof *order, 16);
    if (arena->base) {
        t->nodes = nodes;
        t->order = order;
    }
    return t;
}

size_t noh_triangles_size(uint32_t count)
{
    noh_arena arena = noh_arena_measure();
    if (!count || count > NOH_TRIANGLES_MAX) return 0;
    (void)carve(&arena, count);
    return arena.used;
}

/* ---- the tree ---- */

static float middle_of(const noh_triangles *t, uint32_t triangle, int axis)
{
    const uint32_t *i = t->indices + 3u * (size_t)triangle;
    float sum = 0.0f;
    for (int k = 0; k < 3; k++) sum += t->positions[3u * (size_t)i[k] + (size_t)axis];
    return sum;
}

typedef struct rank {
    float middle;
    uint32_t triangle;
} rank;

static int comes_before(const rank *a, const rank *b)
{
    return a->middle < b->middle || (a->middle == b->middle && a->triangle < b->triangle);
}

static rank rank_of(const noh_triangles *t, uint32_t triangle, int axis)
{
    const rank r = { middle_of(t, triangle, axis), triangle };
    return r;
}

/* Reorder so that the first `half` come before all others.
 * source  Hoare: Algorithm 65: Find, 1961 */
static void halve(const noh_triangles *t, uint32_t *order, uint32_t count, uint32_t half, int axis)
{
    int64_t low = 0, high = (int64_t)count - 1;
    while (low < high) {
        const rank pivot = rank_of(t, order[(low + high) / 2], axis);
        int64_t i = low, j = high;
        while (i <= j) {
            rank a = rank_of(t, order[i], axis), b = rank_of(t, order[j], axis);
            while (comes_before(&a, &pivot)) a = rank_of(t, order[++i], axis);
            while (comes_before(&pivot, &b)) b = rank_of(t, order[--j], axis);
            if (i > j) break;
            const uint32_t kept = order[i];
            order[i++] = order[j];
            order[j--] = kept;
        }
        if ((int64_t)half <= j) {
            high = j;
        } else if ((int64_t)half >= i) {
            low = i;
        } else {
            return;
        }
    }
}

static void bound(const noh_triangles *t, const uint32_t *order, uint32_t count, noh_triangle_node *n)
{
    for (int k = 0; k < 3; k++) {
        n->min[k] = 1e30f;
        n->max[k] = -1e30f;
    }
    for (size_t i = 0; i < 3u * (size_t)count; i++) {
        const float *at = t->positions + 3u * (size_t)t->indices[3u * (size_t)order[i / 3u] + i % 3u];
        for (int k = 0; k < 3; k++) {
            n->min[k] = at[k] < n->min[k] ? at[k] : n->min[k];
            n->max[k] = at[k] > n->max[k] ? at[k] : n->max[k];
        }
    }
}

typedef struct part {
    uint32_t first, count, parent; /* parent: of a second child; NOH_NONE: of another */
} part;

static void grow(noh_triangles *t)
{
    part stack[NOH_TRIANGLE_DEPTH];
    uint32_t waiting = 1, made = 0;
    stack[0] = (part){ 0, t->count, NOH_NONE };
    while (waiting) {
        const part p = stack[--waiting];
        const uint32_t own = made++, half = p.count / 2u;
        noh_triangle_node *n = &t->nodes[own];
        if (p.parent != NOH_NONE) t->nodes[p.parent].at = own;
        bound(t, t->order + p.first, p.count, n);
        n->at = p.first;
        n->count = p.count <= LEAF ? p.count : 0u;
        if (n->count) continue;
        int axis = 0;
        for (int k = 1; k < 3; k++) axis = n->max[k] - n->min[k] > n->max[axis] - n->min[axis] ? k : axis;
        halve(t, t->order + p.first, p.count, half, axis);
        stack[waiting++] = (part){ p.first + half, p.count - half, own };
        stack[waiting++] = (part){ p.first, half, NOH_NONE };
    }
}

/* ---- rays ---- */

/* The distance at which a ray enters through the front of a triangle; below 0: it does not. */
static float enter(const noh_triangles *t, uint32_t triangle, const noh_world_ray *r, float normal[3])
{
    static const float none[3] = { 0.0f, 0.0f, 0.0f };
    float a[3], b[3], c[3], p[3], q[3], from[3];
    noh_triangle_corner(t, triangle, 0, r->origin, a);
    noh_triangle_corner(t, triangle, 1, r->origin, b);
    noh_triangle_corner(t, triangle, 2, r->origin, c);
    noh_sub3(b, a, b);
    noh_sub3(c, a, c);
    noh_cross3(r->ray.direction, c, p);
    const float facing = noh_dot3(b, p); /* minus the direction along the normal, times twice the area */
    if (!(facing > 0.0f)) return -1.0f;
    noh_sub3(r->ray.from, a, from);
    noh_cross3(from, b, q);
    const float u = noh_dot3(from, p) / facing, v = noh_dot3(r->ray.direction, q) / facing;
    if (!(u >= -EDGE && v >= -EDGE && u + v <= 1.0f + EDGE)) return -1.0f;
    noh_cross3(b, c, normal);
    noh_normalize3(normal, none);
    return noh_dot3(c, q) / facing;
}

static noh_world_hit first_hit(const noh_triangles *t, const noh_world_ray *r)
{
    noh_world_hit hit = { -1.0f, { 0.0f, 1.0f, 0.0f } };
    noh_triangle_walk walk = { { 0 }, 1 };
    noh_ray ray = r->ray;
    while (walk.count) {
        const uint32_t own = walk.stack[--walk.count];
        const noh_triangle_node *n = &t->nodes[own];
        const noh_aabb box = noh_triangle_box(n, r->origin);
        if (noh_ray_aabb(&ray, &box) < 0.0f) continue;
        if (!n->count) {
            walk.stack[walk.count++] = n->at;
            walk.stack[walk.count++] = own + 1u;
        }
        for (uint32_t i = 0; i < n->count; i++) {
            float normal[3] = { 0.0f, 0.0f, 0.0f };
            const float far = enter(t, t->order[n->at + i], r, normal);
            if (!(far > 0.0f && far <= ray.distance_max) || (hit.distance > 0.0f && far >= hit.distance)) continue;
            hit.distance = far;
            ray.distance_max = far;
            memcpy(hit.normal, normal, sizeof normal);
        }
    }
    return hit;
}

static void answer_rays(void *user, const noh_world_ray *rays, uint32_t count, noh_world_hit *hits)
{
    for (uint32_t i = 0; i < count; i++) hits[i] = first_hit(user, &rays[i]);
}

/* The address of a function of another file would need a table of offsets. */
static void answer_touches(void *user, const noh_world_body *bodies, uint32_t count, noh_touches *touches)
{
    noh_triangles_touch(user, bodies, count, touches);
}

/* ---- init ---- */

noh_result noh_triangles_init(void *memory, size_t bytes, const noh_triangles_desc *desc, noh_world_physics *physics,
                              noh_error *error)
{
    const uint32_t count = desc->triangle_count;
    noh_arena arena;
    NOH_ASSERT(physics && desc->positions && desc->indices);
    if (!noh_triangles_size(count)) {
        return noh_fail(error, NOH_ERR_LIMIT, "triangles of a world must be 1 to NOH_TRIANGLES_MAX", count,
                        NOH_TRIANGLES_MAX);
    }
    for (size_t i = 0; i < 3u * (size_t)count; i++) {
        if (desc->indices[i] >= desc->position_count)
            return noh_fail(error, NOH_ERR_ARG, "an index of a world's triangle is past its positions", i / 3u, 0);
        if (!noh_is_finite3(desc->positions + 3u * (size_t)desc->indices[i]))
            return noh_fail(error, NOH_ERR_ARG, "a corner of a world's triangle is not finite", i / 3u, 0);
    }
    const noh_result result = noh_arena_open(&arena, memory, bytes, noh_triangles_size(count), error);
    if (result) return result;
    noh_triangles *t = carve(&arena, count);
    t->positions = desc->positions;
    t->indices = desc->indices;
    t->count = count;
    for (uint32_t i = 0; i < count; i++) t->order[i] = i;
    grow(t);
    *physics = (noh_world_physics){ answer_rays, answer_touches, t, 1 };
    return NOH_OK;
}
