#include "stage/decal_grow.h"

#include <string.h>

#include "base/math_internal.h"
#include "sim/vector_internal.h"

#define FACING 0.2f        /* as shaders_es/decal_fragment.glsl has it */
#define NEAR_MAX 384u      /* triangles that are looked at */
#define SPHERE_SQUARE 2.0f /* of sizes: through the corners of the square */

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

/* From a point to a segment that begins at it plus `from`; squared. */
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

/* From the centre to the nearest place of a triangle, squared; -1: it has no area, or faces elsewhere. */
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

/* ---- what hangs together ---- */

static int is_same_place(const float *a, const float *b)
{
    return a == b || (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]);
}

/* By two corners: one is a point alone. */
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

/* Move what hangs together with the first triangle to the patch, in the order of steps from it. */
static void spread(const noh_mesh *mesh, uint32_t *near, uint32_t near_count, noh_decal_patch *out)
{
    for (uint32_t at = 0; at < out->count; at++) {
        for (uint32_t i = 0; i < near_count;) {
            if (!share_edge(mesh, out->triangles[at], near[i])) {
                i++;
            } else if (out->count == NOH_DECAL_TRIANGLES_MAX) {
                out->left_out++;
                near[i] = near[--near_count];
            } else {
                out->triangles[out->count++] = near[i];
                near[i] = near[--near_count];
            }
        }
    }
    out->lone = near_count;
}

void noh_decal_grow(const noh_decal *decal, const noh_mesh *mesh, uint32_t triangle, noh_decal_patch *out)
{
    const float reach = SPHERE_SQUARE * decal->size * decal->size;
    const uint32_t count = mesh->header->index_count / 3u;
    uint32_t near[NEAR_MAX], near_count = 0, first = NOH_NONE;
    float best = reach;
    NOH_ASSERT(decal && mesh && out && (triangle == NOH_NONE || triangle < count));
    memset(out, 0, sizeof *out);
    for (uint32_t t = 0; t < count; t++) {
        const float *p[3];
        float square;
        corners_of(mesh, t, p);
        square = near_square(decal, p);
        if (t == triangle) first = near_count;
        if (t != triangle && !(square >= 0.0f && square <= reach)) continue;
        if (near_count == NEAR_MAX) {
            out->left_out++;
            if (t != triangle) continue;
            near_count--;
            first = near_count;
        }
        if (triangle == NOH_NONE && (first == NOH_NONE || square < best)) best = square, first = near_count;
        near[near_count++] = t;
    }
    if (first == NOH_NONE) return;
    out->triangles[out->count++] = near[first];
    near[first] = near[near_count - 1u];
    spread(mesh, near, near_count - 1u, out);
}
