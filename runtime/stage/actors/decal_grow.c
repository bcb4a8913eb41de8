#include "core/base/assert_internal.h"
#include "stage/actors/decal_grow_internal.h"
#include "noh/base.h"
#include "noh/marks.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/vector_internal.h"

#define FACING 0.2f        /* cosine; as in shaders_es/decal_fragment.glsl */
#define SPHERE_SQUARE 2.0f /* squared radius in sizes: through the corners of the square */
#define SHRINKS_MAX 24     /* times that the squared reach is halved while there is too little room */

void noh_decal_uv(const noh_decal *decal, const float bind_position[3], float uv[2])
{
    float to[3], up[3];
    NOH_ASSERT(decal && bind_position && uv);
    for (int i = 0; i < 3; i++) to[i] = (bind_position[i] - decal->centre[i]) / decal->size;
    noh_cross3(decal->normal, decal->right, up);
    uv[0] = 0.5f + 0.5f * noh_dot3(to, decal->right);
    uv[1] = 0.5f - 0.5f * noh_dot3(to, up);
}

/* ---- near ---- */

static void corners_of(const noh_mesh *mesh, uint32_t triangle, const float *p[3])
{
    for (uint32_t i = 0; i < 3; i++) p[i] = mesh->positions + 3u * (size_t)noh_mesh_index(mesh, 3u * triangle + i);
}

/* Squared distance from the origin to a segment that begins at `from`. */
static float segment_square(const float from[3], const float to[3])
{
    float along[3], rest[3], square, t;
    noh_sub3(to, from, along);
    square = noh_dot3(along, along);
    t = square > 0.0f ? -noh_dot3(from, along) / square : 0.0f;
    t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
    noh_madd3(from, t, along, rest);
    return noh_dot3(rest, rest);
}

/* Squared distance from the centre to a triangle; -1: it has no area, or faces elsewhere. */
static float near_square(const noh_decal *decal, const float *const p[3])
{
    float to[3][3], ab[3], ac[3], normal[3], length, least, side[3];
    int inside = 1;
    for (int k = 0; k < 3; k++) noh_sub3(p[k], decal->centre, to[k]);
    noh_sub3(to[1], to[0], ab);
    noh_sub3(to[2], to[0], ac);
    noh_cross3(ab, ac, normal);
    length = noh_dot3(normal, normal);
    if (!(length > 0.0f) || noh_dot3(normal, decal->normal) < FACING * noh_sqrt(length)) return -1.0f;
    least = segment_square(to[0], to[1]);
    for (int k = 0; k < 3; k++) {
        const float square = segment_square(to[k], to[(k + 1) % 3]);
        if (square < least) least = square;
        noh_cross3(to[k], to[(k + 1) % 3], side);
        inside &= noh_dot3(side, normal) >= 0.0f;
    }
    return inside ? noh_dot3(to[0], normal) * noh_dot3(to[0], normal) / length : least;
}

/* Whether the bounds of a triangle and of a sphere around the centre overlap. Most do not, and need no distance. */
static int is_about(const noh_decal *decal, float radius, const float *const p[3])
{
    for (int k = 0; k < 3; k++) {
        const float low = decal->centre[k] - radius, high = decal->centre[k] + radius;
        if ((p[0][k] < low && p[1][k] < low && p[2][k] < low) || (p[0][k] > high && p[1][k] > high && p[2][k] > high)) {
            return 0;
        }
    }
    return 1;
}

/* ---- connected triangles ---- */

static int is_same_place(const float *a, const float *b)
{
    return a == b || (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]);
}

/* Whether two triangles have two places in common. */
static int share_edge(const noh_mesh *mesh, uint32_t a, uint32_t b)
{
    const float *p[3], *q[3];
    uint32_t shared = 0;
    corners_of(mesh, a, p);
    corners_of(mesh, b, q);
    for (int i = 0; i < 3; i++) {
        shared += is_same_place(p[i], q[0]) || is_same_place(p[i], q[1]) || is_same_place(p[i], q[2]);
    }
    return shared >= 2;
}

/* Move the triangles connected to the first one to the front, in breadth-first order. near_count: of out->triangles */
static void spread(const noh_mesh *mesh, uint32_t near_count, noh_decal_patch *out)
{
    uint32_t *t = out->triangles;
    for (uint32_t at = 0; at < out->count; at++) {
        for (uint32_t i = out->count; i < near_count; i++) {
            if (share_edge(mesh, t[at], t[i])) {
                const uint32_t found = t[i];
                t[i] = t[out->count];
                t[out->count++] = found;
            }
        }
    }
    out->lone = near_count - out->count;
}

/* Collect triangles within `reach` (squared), as many as there is room for, beginning with the one to grow from.
 * Returns the number within reach; 0: none to grow from. */
static uint32_t collect(const noh_decal *decal, const noh_mesh *mesh, uint32_t triangle, float reach,
                        noh_decal_patch *out)
{
    const float radius = noh_sqrt(reach);
    uint32_t near_count = 1, first = triangle;
    float best = reach;
    for (uint32_t t = 0; t < mesh->header->index_count / 3u; t++) {
        const float *p[3];
        float square;
        uint32_t other;
        corners_of(mesh, t, p);
        if (t == triangle || !is_about(decal, radius, p)) continue;
        square = near_square(decal, p);
        if (!(square >= 0.0f && square <= reach)) continue;
        other = t;
        if (triangle == NOH_NONE &&
            (first == NOH_NONE || square < best)) { /* the previous best is an ordinary one now */
            other = first;
            first = t, best = square;
        }
        if (other == NOH_NONE) continue;
        if (near_count < out->room) out->triangles[near_count] = other;
        near_count++;
    }
    if (first == NOH_NONE) return 0;
    if (out->room) out->triangles[0] = first;
    return near_count;
}

void noh_decal_grow(const noh_decal *decal, const noh_mesh *mesh, uint32_t triangle, noh_decal_patch *out)
{
    NOH_ASSERT(decal && mesh && out && (out->triangles || !out->room));
    NOH_ASSERT(triangle == NOH_NONE || triangle < mesh->header->index_count / 3u);
    float reach = SPHERE_SQUARE * decal->size * decal->size;
    uint32_t all, near_count;
    out->count = out->left_out = out->lone = 0;
    all = near_count = collect(decal, mesh, triangle, reach, out);
    for (int i = 0; i < SHRINKS_MAX && near_count > out->room; i++) {
        reach *= 0.5f;
        near_count = collect(decal, mesh, triangle, reach, out);
    }
    if (near_count > out->room) near_count = out->room;
    out->left_out = all - near_count;
    if (!near_count) return;
    out->count = 1;
    spread(mesh, near_count, out);
}

/* ---- at another level ---- */

static int has_corner(const noh_decal_patch *patch, const noh_mesh *mesh, uint32_t vertex)
{
    for (uint32_t i = 0; i < 3u * patch->count; i++) {
        if (noh_mesh_index(mesh, 3u * patch->triangles[i / 3u] + i % 3u) == vertex) return 1;
    }
    return 0;
}

uint32_t noh_decal_again(const noh_decal *decal, const noh_decal_patch *before, const noh_mesh *mesh_before,
                         const noh_mesh *mesh)
{
    NOH_ASSERT(decal && before && mesh_before && mesh);
    const float reach = SPHERE_SQUARE * decal->size * decal->size, radius = noh_sqrt(reach);
    uint32_t best = NOH_NONE;
    float least = reach;
    for (uint32_t t = 0; t < mesh->header->index_count / 3u; t++) {
        const float *p[3];
        float square;
        int shared = 0;
        corners_of(mesh, t, p);
        if (!is_about(decal, radius, p)) continue;
        square = near_square(decal, p);
        if (!(square >= 0.0f && square <= least) || (square == least && best != NOH_NONE)) continue;
        for (uint32_t i = 0; i < 3 && !shared; i++) {
            shared = has_corner(before, mesh_before, noh_mesh_index(mesh, 3u * t + i));
        }
        if (shared) best = t, least = square;
    }
    return best;
}
