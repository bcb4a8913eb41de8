#include "core/base/vector_internal.h"
#include "core/base/assert_internal.h"
#include "deform/morph/morph_internal.h"
#include "deform/pick/bounds_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "deform/pick/pick_internal.h"
#include "deform/skin/skin_blend_internal.h"

#define EDGE 1e-6f /* tolerance beyond a triangle's edge, so that rays do not slip between two */

typedef struct ray {
    float origin[3], direction[3], limit; /* limit: the nearest hit so far */
    float moved;                          /* upper bound on how far targets move a corner; below 0: not computed */
} ray;

/* A box is the intersection of three slabs; a ray is inside each slab for an interval of its distance, and in the box
 * where the three intervals and 0..limit overlap. Without a component along an axis it is inside that slab always or
 * never. */
static int ray_meets_box(const ray *r, const float box[6])
{
    float enter = 0.0f, leave = r->limit;
    for (int i = 0; i < 3; i++) {
        float a = box[i] - r->origin[i], b = box[i + 3] - r->origin[i];
        if (r->direction[i] == 0.0f) {
            if (a > 0.0f || b < 0.0f) {
                return 0;
            }
            continue;
        }
        a /= r->direction[i];
        b /= r->direction[i];
        if (a > b) {
            float swap = a;
            a = b;
            b = swap;
        }
        enter = a > enter ? a : enter;
        leave = b < leave ? b : leave;
    }
    return enter <= leave * 1.00001f; /* the quotients are rounded */
}

/* Moller and Trumbore 1997: origin + t direction = a + u ab + v ac is three linear equations in t, u and v, solved by
 * Cramer's rule; the scalar triple products share two cross products. The sign of the determinant gives the side from
 * which the triangle is seen, and both count. Fills distance and barycentric of a hit nearer than the limit. */
static int ray_meets_triangle(const ray *r, float corners[3][3], noh_pick_hit *hit)
{
    float ab[3], ac[3], from[3], p[3], q[3], determinant, u, v, t;
    for (int i = 0; i < 3; i++) {
        ab[i] = corners[1][i] - corners[0][i];
        ac[i] = corners[2][i] - corners[0][i];
        from[i] = r->origin[i] - corners[0][i];
    }
    noh_cross3(r->direction, ac, p);
    determinant = noh_dot3(ab, p);
    if (determinant == 0.0f) {
        return 0; /* no area, or seen from its edge */
    }
    noh_cross3(from, ab, q);
    u = noh_dot3(from, p) / determinant;
    v = noh_dot3(r->direction, q) / determinant;
    t = noh_dot3(ac, q) / determinant;
    if (!(u >= -EDGE && v >= -EDGE && u + v <= 1.0f + EDGE && t >= 0.0f && t <= r->limit)) {
        return 0;
    }
    hit->distance = t;
    hit->barycentric[0] = 1.0f - u - v;
    hit->barycentric[1] = u;
    hit->barycentric[2] = v;
    return 1;
}

/* ---- the mesh ---- */

/* Positions on the morphed surface as drawn. */
static void move_point(const noh_pick_surface *s, uint32_t vertex, const float p[3], float out[3])
{
    if (s->dual_quaternions) {
        noh_skin_point_dual(s->mesh, s->dual_quaternions, vertex, p, out);
    } else if (s->matrices) {
        noh_skin_point(s->mesh, s->matrices, vertex, p, out);
    } else {
        memcpy(out, p, 3 * sizeof *out);
        for (int i = 0; s->world && i < 3; i++) {
            const float *row = s->world + 4 * i;
            out[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
        }
    }
}

static void corner_position(const noh_pick_surface *s, uint32_t vertex, float out[3])
{
    float p[3];
    if (s->weights && !s->layers) {
        noh_morph_position_by(s->mesh, s->weights, vertex, p);
    } else {
        noh_morph_position(s->mesh, s->layers, vertex, p);
    }
    move_point(s, vertex, p, out);
}

static int boxes_meet(const float a[6], const float b[6])
{
    return a[0] <= b[3] && b[0] <= a[3] && a[1] <= b[4] && b[1] <= a[4] && a[2] <= b[5] && b[2] <= a[5];
}

/* For each joint a box that contains all its vertices as drawn. A vertex lies in the hull of the positions from each of
 * its joints. In the bind pose it is in the box of each of these joints, so only joints whose boxes overlap there can
 * share a vertex, and the union of their moved boxes contains it. No hit is lost, and most triangles are skipped. */
static void neighbourhoods(const noh_mesh *mesh, uint32_t count, const float *boxes, float *out)
{
    for (size_t j = 0; j < count; j++) {
        memcpy(out + 6u * j, boxes + 6u * j, 6 * sizeof *out);
        for (size_t i = 0; i < count; i++) {
            if (i != j && boxes_meet(mesh->joint_boxes + 6u * i, mesh->joint_boxes + 6u * j)) {
                noh_box_unite(out + 6u * j, boxes + 6u * i, out + 6u * j);
            }
        }
    }
}

static uint32_t strongest_joint(const noh_mesh *mesh, uint32_t vertex)
{
    uint32_t words = NOH_INFLUENCE_WORDS(mesh->header->influence_count);
    uint32_t place = mesh->influences[(size_t)vertex * words] & 255u;
    return mesh->palette_joints[mesh->palettes[noh_mesh_palette(mesh, vertex)].first_joint + place];
}

/* ---- how far targets go ---- */

/* An upper bound on the stretch of a matrix: the root of the sum of its squares. */
static float stretch_of(const float m[12])
{
    float square = 0.0f;
    for (int r = 0; r < 3; r++) square += noh_dot3(m + 4 * r, m + 4 * r);
    return noh_sqrt(square);
}

/* The sum of all weighted differences lies in a box, and no matrix stretches it by more than the largest stretch. A
 * blend of dual quaternions stretches no more either. */
static float moved_at_most(const noh_pick_surface *s, uint32_t joints)
{
    float most[3] = { 0.0f, 0.0f, 0.0f }, stretch = s->world && !joints ? stretch_of(s->world) : joints ? 0.0f : 1.0f;
    for (uint32_t t = 0; t < s->mesh->header->target_count; t++) {
        const float *box = s->mesh->target_boxes + 6u * (size_t)t, weight = noh_abs(s->weights[t]);
        for (int i = 0; weight > 0.0f && i < 3; i++) {
            const float low = noh_abs(box[i]), high = noh_abs(box[i + 3]);
            most[i] += weight * (low > high ? low : high);
        }
    }
    for (uint32_t j = 0; j < joints; j++) {
        const float own = stretch_of(s->matrices + 12u * (size_t)j);
        stretch = own > stretch ? own : stretch;
    }
    return 1.001f * stretch * noh_length3(most);
}

/* Whether the ray passes a triangle without targets closely enough to hit it with targets. */
static int comes_near(const noh_pick_surface *s, const ray *r, const uint32_t vertices[3])
{
    float box[6], p[3];
    noh_box_empty(box);
    for (int c = 0; c < 3; c++) {
        move_point(s, vertices[c], s->mesh->positions + 3u * (size_t)vertices[c], p);
        for (int i = 0; i < 3; i++) {
            box[i] = p[i] - r->moved < box[i] ? p[i] - r->moved : box[i];
            box[i + 3] = p[i] + r->moved > box[i + 3] ? p[i] + r->moved : box[i + 3];
        }
    }
    return ray_meets_box(r, box);
}

/* Whether the ray may hit this triangle. near: neighbourhoods; NULL for a rigid mesh. */
static int is_candidate(const ray *r, const noh_mesh *mesh, const uint32_t corners[3], const float *near)
{
    float box[6];
    if (!near) {
        return 1;
    }
    memcpy(box, near + 6u * (size_t)strongest_joint(mesh, corners[0]), sizeof box);
    for (int c = 1; c < 3; c++) {
        noh_box_unite(box, near + 6u * (size_t)strongest_joint(mesh, corners[c]), box);
    }
    return ray_meets_box(r, box);
}

static void pick_submesh(const noh_pick_surface *s, uint32_t index, const float *near, ray *r, noh_pick_hit *hit)
{
    const noh_submesh *sub = &s->mesh->submeshes[index];
    noh_pick_hit own = *hit;
    for (uint32_t i = 0; i < sub->index_count; i += 3) {
        uint32_t vertices[3];
        float corners[3][3];
        for (uint32_t c = 0; c < 3; c++) {
            vertices[c] = noh_mesh_index(s->mesh, sub->first_index + i + c);
        }
        if (!is_candidate(r, s->mesh, vertices, near) || (r->moved >= 0.0f && !comes_near(s, r, vertices))) {
            continue;
        }
        for (uint32_t c = 0; c < 3; c++) {
            corner_position(s, vertices[c], corners[c]);
        }
        if (ray_meets_triangle(r, corners, &own) &&
            noh_pick_shows(s->mesh, sub, vertices, own.barycentric, s->tint ? s->tint[3] : 255)) {
            r->limit = own.distance;
            *hit = own;
            hit->submesh = index;
            hit->triangle = (sub->first_index + i) / 3;
        }
    }
}

/* ---- the hit ---- */

/* The joint with the largest weight at the point: its corners' weights, interpolated. */
static uint32_t joint_at(const noh_mesh *mesh, const uint32_t vertices[3], const float mix[3])
{
    uint32_t joints[3 * NOH_INFLUENCES_MAX], count = 0, best = 0;
    float sums[3 * NOH_INFLUENCES_MAX];
    for (int c = 0; c < 3; c++) {
        uint32_t places[NOH_INFLUENCES_MAX], influences, k;
        float weights[NOH_INFLUENCES_MAX];
        influences = noh_mesh_influences(mesh, vertices[c], places, weights);
        for (uint32_t i = 0; i < influences; i++) {
            for (k = 0; k < count && joints[k] != places[i]; k++) {}
            if (k == count) {
                joints[count] = places[i];
                sums[count++] = 0.0f;
            }
            sums[k] += mix[c] * weights[i];
        }
    }
    for (uint32_t k = 1; k < count; k++) {
        best = sums[k] > sums[best] ? k : best;
    }
    return joints[best];
}

static void finish(const noh_pick_surface *s, const ray *r, noh_pick_hit *hit)
{
    uint32_t vertices[3];
    for (uint32_t c = 0; c < 3; c++) {
        vertices[c] = noh_mesh_index(s->mesh, 3 * hit->triangle + c);
    }
    for (size_t i = 0; i < 3; i++) {
        hit->point[i] = r->origin[i] + hit->distance * r->direction[i];
        hit->bind_point[i] = 0.0f;
        for (int c = 0; c < 3; c++) {
            hit->bind_point[i] += hit->barycentric[c] * s->mesh->positions[3u * (size_t)vertices[c] + i];
        }
    }
    hit->joint = s->mesh->header->skin == NOH_NONE ? NOH_NONE : joint_at(s->mesh, vertices, hit->barycentric);
}

static uint32_t joint_count(const noh_mesh *mesh)
{
    noh_skin skin;
    return noh_pack_skin_at(mesh->pack, mesh->header->skin, &skin, NULL) ? 0 : skin.header->joint_count;
}

size_t noh_pick_scratch_size(const noh_mesh *mesh)
{
    return joint_count(mesh) * 12u * sizeof(float);
}

/* Whether the ray hits the mesh's box. For a skinned mesh, fills boxes[count][6], then the neighbourhoods after
 * them. */
static int may_hit(const noh_pick_surface *s, const ray *r, float *boxes, uint32_t count)
{
    float box[6];
    if (!count) {
        noh_mesh_box(s->mesh, s->world, s->weights, box);
        return ray_meets_box(r, box);
    }
    noh_skin_joint_boxes(s->mesh, s->matrices, s->weights, boxes);
    noh_box_empty(box);
    for (size_t j = 0; j < count; j++) {
        noh_box_unite(box, boxes + 6u * j, box);
    }
    if (!ray_meets_box(r, box)) {
        return 0;
    }
    neighbourhoods(s->mesh, count, boxes, boxes + 6u * (size_t)count);
    return 1;
}

noh_result noh_pick(const noh_pick_surface *surface, const float origin[3], const float direction[3],
                    float distance_max, void *scratch, size_t scratch_bytes, noh_pick_hit *hit, noh_error *error)
{
    const uint32_t count = joint_count(surface->mesh);
    const size_t need = noh_pick_scratch_size(surface->mesh);
    noh_pick_hit nearest = { 0 };
    noh_arena arena;
    noh_result result;
    ray r;
    NOH_ASSERT(origin && direction && hit);
    memcpy(r.origin, origin, sizeof r.origin);
    memcpy(r.direction, direction, sizeof r.direction);
    r.limit = distance_max;
    r.moved = -1.0f;
    if (count && !surface->matrices) {
        return noh_fail(error, NOH_ERR_ARG, "matrices is NULL: a skinned mesh needs them", 0, 0);
    }
    if (!(noh_dot3(direction, direction) > 0.0f)) {
        return noh_fail(error, NOH_ERR_ARG, "the ray's direction has length 0", 0, 0);
    }
    result = need ? noh_arena_open(&arena, scratch, scratch_bytes, need, error) : NOH_OK;
    if (result) {
        return result;
    }
    nearest.triangle = NOH_NONE;
    if (surface->weights && !surface->layers) r.moved = moved_at_most(surface, count);
    if (may_hit(surface, &r, (float *)scratch, count)) {
        for (uint32_t i = 0; i < surface->mesh->header->submesh_count; i++) {
            pick_submesh(surface, i, count ? (float *)scratch + 6u * (size_t)count : NULL, &r, &nearest);
        }
    }
    if (nearest.triangle == NOH_NONE) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the ray hits nothing within distance_max", 0, 0);
    }
    finish(surface, &r, &nearest);
    *hit = nearest;
    return NOH_OK;
}
