/* ray_tree.c: a tree of boxes with eight children a node, and leaves of eight triangles. Tests are free of branches
 * over lanes, so that compilers vectorise them. */
#include "ray_tree.h"

#include <stdlib.h>
#include <string.h>

#include "core/base/compiler_internal.h"
#include "noh/format.h"

/* Comparisons may be evaluated for all lanes: floating-point exception flags are not read. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3", "no-trapping-math")
#endif

/* A second version with AVX2 where the processor has it; without fused multiply-adds, so with the same bits. Sanitizers
 * do not take functions that are chosen at load time. */
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define RAY_WIDE __attribute__((target_clones("default", "avx2")))
#else
#define RAY_WIDE
#endif
/* A loop over lanes is vectorised only if its calls are inlined. */
#if defined(__GNUC__)
#define RAY_INLINE static inline __attribute__((always_inline))
#else
#define RAY_INLINE static inline
#endif

#define STACK (TRIANGLE_TREE_STACK * (RAY_LANES - 1u)) /* a level leaves all boxes but one to be visited */

/* ---- building ---- */

static float surface(const triangle_node *n)
{
    const float x = n->high[0] - n->low[0], y = n->high[1] - n->low[1], z = n->high[2] - n->low[2];
    return x * y + y * z + z * x;
}

/* The inner box with the largest surface, which more rays meet than smaller ones; RAY_LANES: all are leaves. */
static uint32_t largest(const ray_tree *t, const ray_node *n)
{
    uint32_t found = RAY_LANES;
    for (uint32_t i = 0; i < n->count; i++) {
        const triangle_node *box = &t->boxes.nodes[n->box[i]];
        if (!box->count && (found == RAY_LANES || surface(box) > surface(&t->boxes.nodes[n->box[found]]))) found = i;
    }
    return found;
}

/* A node whose first box is given: boxes are opened, the largest first, until there is no room. */
static void open_boxes(ray_tree *t, ray_node *n)
{
    for (uint32_t i; n->count < RAY_LANES && (i = largest(t, n)) < RAY_LANES;) {
        const uint32_t left = t->boxes.nodes[n->box[i]].first;
        n->box[i] = left;
        n->box[n->count++] = left + 1u;
    }
    for (uint32_t i = 0; i < n->count; i++) {
        if (t->boxes.nodes[n->box[i]].count) {
            n->leaves |= 1u << i;
            n->next[i] = t->block_count++;
        } else {
            n->next[i] = t->node_count;
            t->nodes[t->node_count].box[0] = n->box[i];
            t->nodes[t->node_count++].count = 1;
        }
    }
}

/* Lanes that are left have the first triangle again. */
static void fill_block(const ray_tree *t, const triangle_node *leaf, const float *triangles, ray_block *out)
{
    for (uint32_t i = 0; i < RAY_LANES; i++) {
        const uint32_t triangle = t->boxes.order[leaf->first + (i < leaf->count ? i : 0u)];
        const float *corners = triangles + 9u * (size_t)triangle;
        out->triangle[i] = triangle;
        for (uint32_t k = 0; k < 3u; k++) {
            out->corner[k][i] = corners[k];
            out->first[k][i] = corners[3u + k] - corners[k];
            out->second[k][i] = corners[6u + k] - corners[k];
        }
    }
}

static void fill(ray_tree *t, const float *triangles)
{
    for (uint32_t i = 0; i < t->node_count; i++) {
        ray_node *n = &t->nodes[i];
        t->live[i] = (1u << n->count) - 1u;
        for (uint32_t lane = 0; lane < n->count; lane++) {
            const triangle_node *box = &t->boxes.nodes[n->box[lane]];
            for (uint32_t k = 0; k < 3u; k++) {
                n->low[k][lane] = box->low[k];
                n->high[k][lane] = box->high[k];
            }
            if (box->count) fill_block(t, box, triangles, &t->blocks[n->next[lane]]);
        }
    }
}

int ray_tree_make(const float *triangles, uint32_t count, ray_tree *out)
{
    memset(out, 0, sizeof *out);
    if (triangle_tree_make(triangles, count, RAY_LANES, &out->boxes)) {
        return 1;
    }
    /* Every node opens an inner box; halves of more than eight triangles have four or more. */
    out->nodes = calloc((size_t)out->boxes.node_count / 2u + 1u, sizeof *out->nodes);
    out->blocks = calloc((size_t)out->boxes.node_count / 2u + 1u, sizeof *out->blocks);
    out->live = calloc((size_t)out->boxes.node_count / 2u + 1u, sizeof *out->live);
    if (!out->nodes || !out->blocks || !out->live) {
        return 1;
    }
    out->node_count = out->nodes[0].count = count > 0;
    for (uint32_t i = 0; i < out->node_count; i++) {
        open_boxes(out, &out->nodes[i]);
    }
    fill(out, triangles);
    return 0;
}

void ray_tree_fit(ray_tree *t, const float *triangles)
{
    triangle_tree_fit(&t->boxes, triangles);
    fill(t, triangles);
}

void ray_tree_free(ray_tree *t)
{
    triangle_tree_free(&t->boxes);
    free(t->nodes);
    free(t->blocks);
    free(t->live);
    memset(t, 0, sizeof *t);
}

/* The lowest lane of a set, which is taken from it. */
RAY_INLINE uint32_t next_lane(uint32_t *lanes)
{
    const uint32_t lane = noh_trailing_zeros(*lanes);
    *lanes &= *lanes - 1u;
    return lane;
}

/* ---- the half of space in front of a plane ---- */

#define THIN 1e-5f /* of the distances in a node: what lies behind the plane by less may be in front of it */

typedef struct plane {
    float normal[3], at;
} plane;

/* A bit for each of a node's boxes that reaches in front. */
RAY_INLINE uint32_t boxes_in_front(const plane *p, const ray_node *n)
{
    uint32_t front = 0;
    for (uint32_t i = 0; i < RAY_LANES; i++) {
        float most = -p->at, size = p->at < 0.0f ? -p->at : p->at;
        for (uint32_t k = 0; k < 3u; k++) {
            const float a = p->normal[k] * n->low[k][i], b = p->normal[k] * n->high[k][i];
            const float more = a > b ? a : b;
            most += more;
            size += more < 0.0f ? -more : more;
        }
        front |= most > -THIN * size ? 1u << i : 0u;
    }
    return front;
}

/* Whether a triangle of a block does. */
RAY_INLINE uint32_t block_in_front(const plane *p, const ray_block *b)
{
    uint32_t front = 0;
    for (uint32_t i = 0; i < RAY_LANES; i++) {
        float most = -p->at, first = 0.0f, second = 0.0f, size = p->at < 0.0f ? -p->at : p->at;
        for (uint32_t k = 0; k < 3u; k++) {
            const float x = p->normal[k] * b->corner[k][i];
            most += x;
            size += x < 0.0f ? -x : x;
            first += p->normal[k] * b->first[k][i];
            second += p->normal[k] * b->second[k][i];
        }
        first = first > second ? first : second;
        most += first > 0.0f ? first : 0.0f;
        front |= most > -THIN * size ? 1u << i : 0u;
    }
    return front;
}

RAY_WIDE void ray_tree_front(const ray_tree *t, const float origin[3], const float normal[3])
{
    const plane p = { { normal[0], normal[1], normal[2] },
                      normal[0] * origin[0] + normal[1] * origin[1] + normal[2] * origin[2] };
    memset(t->live, 0, t->node_count * sizeof *t->live);
    if (t->node_count) t->live[0] = 1;
    for (uint32_t i = 0; i < t->node_count; i++) {
        const ray_node *n = &t->nodes[i];
        uint32_t live = t->live[i] ? boxes_in_front(&p, n) & ((1u << n->count) - 1u) : 0u;
        for (uint32_t lanes = live; lanes;) {
            const uint32_t lane = next_lane(&lanes);
            if (!(n->leaves >> lane & 1u)) {
                t->live[n->next[lane]] = 1;
            } else if (!block_in_front(&p, &t->blocks[n->next[lane]])) {
                live &= ~(1u << lane);
            }
        }
        t->live[i] = live;
    }
    for (uint32_t i = t->node_count; i-- > 0;) {
        const ray_node *n = &t->nodes[i];
        for (uint32_t lanes = t->live[i] & ~n->leaves; lanes;) {
            const uint32_t lane = next_lane(&lanes);
            if (!t->live[n->next[lane]]) t->live[i] &= ~(1u << lane);
        }
    }
}

/* ---- rays ---- */

typedef struct ray {
    float origin[3], direction[3], inverse[3];
    float least, farthest;
} ray;

RAY_INLINE ray ray_of(const float origin[3], const float direction[3], float least)
{
    ray r;
    memcpy(r.origin, origin, sizeof r.origin);
    memcpy(r.direction, direction, sizeof r.direction);
    for (uint32_t k = 0; k < 3u; k++) {
        r.inverse[k] = 1.0f / (direction[k] > -1e-20f && direction[k] < 1e-20f ? 1e-20f : direction[k]);
    }
    r.least = least;
    r.farthest = 1e30f;
    return r;
}

/* A bit for each of a node's boxes that the ray meets, and where it enters them. */
RAY_INLINE uint32_t meet_boxes(const ray *r, const ray_node *n, float *enter)
{
    uint32_t met = 0;
    for (uint32_t i = 0; i < RAY_LANES; i++) {
        float near = r->least, far = r->farthest;
        for (uint32_t k = 0; k < 3u; k++) {
            const float a = (n->low[k][i] - r->origin[k]) * r->inverse[k];
            const float b = (n->high[k][i] - r->origin[k]) * r->inverse[k];
            const float first = a < b ? a : b, last = a < b ? b : a;
            near = first > near ? first : near;
            far = last < far ? last : far;
        }
        enter[i] = near;
        met |= near <= far * 1.000001f ? 1u << i : 0u;
    }
    return met;
}

typedef struct block_meeting {
    float u[RAY_LANES], v[RAY_LANES], distance[RAY_LANES];
} block_meeting;

/* A bit for each of a block's triangles that the ray meets, not farther than the farthest so far. A triangle that is
 * edge on, or without area, is not met. */
RAY_INLINE uint32_t meet_block(const ray *r, const ray_block *b, block_meeting *out)
{
    const float *d = r->direction;
    uint32_t met = 0;
    for (uint32_t i = 0; i < RAY_LANES; i++) {
        const float ex = b->first[0][i], ey = b->first[1][i], ez = b->first[2][i];
        const float fx = b->second[0][i], fy = b->second[1][i], fz = b->second[2][i];
        const float sx = r->origin[0] - b->corner[0][i], sy = r->origin[1] - b->corner[1][i];
        const float sz = r->origin[2] - b->corner[2][i];
        const float px = d[1] * fz - d[2] * fy, py = d[2] * fx - d[0] * fz, pz = d[0] * fy - d[1] * fx;
        const float qx = sy * ez - sz * ey, qy = sz * ex - sx * ez, qz = sx * ey - sy * ex;
        const float volume = ex * px + ey * py + ez * pz, scale = 1.0f / volume;
        const float u = scale * (sx * px + sy * py + sz * pz), v = scale * (d[0] * qx + d[1] * qy + d[2] * qz);
        const float distance = scale * (fx * qx + fy * qy + fz * qz);
        const int whole = (volume <= -1e-20f) | (volume >= 1e-20f);
        const int inside = (u >= 0.0f) & (u <= 1.0f) & (v >= 0.0f) & (u + v <= 1.0f);
        out->u[i] = u;
        out->v[i] = v;
        out->distance[i] = distance;
        const int meets = whole & inside & (distance > r->least) & (distance <= r->farthest);
        met |= (uint32_t)meets << i;
    }
    return met;
}

RAY_WIDE int ray_tree_hit(const ray_tree *t, const float origin[3], const float direction[3], float least,
                          uint32_t *last)
{
    const ray r = ray_of(origin, direction, least);
    uint32_t stack[STACK], depth = t->node_count > 0;
    float enter[RAY_LANES];
    block_meeting m;
    stack[0] = 0;
    if (*last < t->block_count && meet_block(&r, &t->blocks[*last], &m)) {
        return 1;
    }
    while (depth) {
        const uint32_t node = stack[--depth];
        const ray_node *n = &t->nodes[node];
        const uint32_t met = meet_boxes(&r, n, enter) & t->live[node];
        for (uint32_t lanes = met & n->leaves; lanes;) {
            const uint32_t block = n->next[next_lane(&lanes)];
            if (meet_block(&r, &t->blocks[block], &m)) {
                *last = block;
                return 1;
            }
        }
        for (uint32_t lanes = met & ~n->leaves; lanes;) {
            stack[depth++] = n->next[next_lane(&lanes)];
        }
    }
    *last = NOH_NONE;
    return 0;
}

/* Boxes still to be visited. */
typedef struct box_stack {
    uint32_t count;
    struct {
        float enter;
        uint32_t next, leaf;
    } boxes[STACK];
} box_stack;

/* Push what is met, the nearest last. */
RAY_INLINE void push(box_stack *s, const ray_node *n, uint32_t met, const float *enter)
{
    const uint32_t first = s->count;
    while (met) {
        const uint32_t lane = next_lane(&met);
        uint32_t at = s->count++;
        for (; at > first && s->boxes[at - 1u].enter < enter[lane]; at--) s->boxes[at] = s->boxes[at - 1u];
        s->boxes[at].enter = enter[lane];
        s->boxes[at].next = n->next[lane];
        s->boxes[at].leaf = n->leaves >> lane & 1u;
    }
}

/* Take the nearest of the triangles met. Returns whether there is one by now. */
RAY_INLINE uint32_t take(const ray_block *b, uint32_t met, const block_meeting *m, ray *r, uint32_t found,
                         ray_meeting *meeting)
{
    while (met) {
        const uint32_t i = next_lane(&met);
        if (m->distance[i] < r->farthest ||
            (found && m->distance[i] == r->farthest && b->triangle[i] < meeting->triangle)) {
            *meeting = (ray_meeting){ b->triangle[i], m->u[i], m->v[i] };
            r->farthest = m->distance[i];
            found = 1;
        }
    }
    return found;
}

RAY_WIDE int ray_tree_nearest(const ray_tree *t, const float origin[3], const float direction[3], float least,
                              ray_meeting *meeting)
{
    ray r = ray_of(origin, direction, least);
    box_stack s;
    uint32_t found = 0;
    s.count = t->node_count > 0;
    memset(s.boxes, 0, sizeof *s.boxes);
    while (s.count) {
        const uint32_t next = s.boxes[--s.count].next;
        if (s.boxes[s.count].enter > r.farthest * 1.000001f) continue;
        if (s.boxes[s.count].leaf) {
            block_meeting m;
            const uint32_t met = meet_block(&r, &t->blocks[next], &m);
            found = take(&t->blocks[next], met, &m, &r, found, meeting);
        } else {
            float enter[RAY_LANES];
            const uint32_t met = meet_boxes(&r, &t->nodes[next], enter) & ((1u << t->nodes[next].count) - 1u);
            push(&s, &t->nodes[next], met, enter);
        }
    }
    return (int)found;
}
