#include "core/base/trig_internal.h"
#include "life/hair/haircut_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/pack.h"

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"

#define PIXELS_FULL 500.0f
#define PIXELS_NONE 25.0f

noh_result noh_haircut_open(const noh_pack *pack, noh_haircut *out, noh_error *error)
{
    NOH_ASSERT(pack && out);
    const uint8_t *bytes = noh_pack_chunk_at(pack, NOH_CHUNK_HAIR, 0);
    const noh_pack_hair_header *h = (const noh_pack_hair_header *)(const void *)bytes;
    if (!h) return noh_fail(error, NOH_ERR_NOT_FOUND, "the pack has no haircut", 0, 0);
    memset(out, 0, sizeof *out);
    out->header = h;
    out->joint = noh_pack_string(pack, h->joint);
    out->patches = (const uint32_t *)(const void *)(bytes + h->patches_offset);
    out->desc.rest = (const float *)(const void *)(bytes + h->points_offset);
    out->desc.hair_count = h->hair_count;
    out->desc.point_count = h->point_count;
    out->desc.spheres = (const noh_hair_sphere *)(const void *)(bytes + h->spheres_offset);
    out->desc.sphere_count = h->sphere_count;
    out->desc.seed = h->seed;
    out->desc.pull = h->pull;
    out->desc.pull_at_tip = h->pull_at_tip;
    out->desc.damping = h->damping;
    out->desc.gravity = h->gravity;
    return NOH_OK;
}

uint32_t noh_haircut_strips(const noh_haircut *cut, float pixels_per_metre)
{
    const uint32_t all = cut->header->strip_count;
    if (!(pixels_per_metre > PIXELS_NONE)) return 0;
    if (pixels_per_metre >= PIXELS_FULL) return all;
    const uint32_t strips = (uint32_t)((float)all * (pixels_per_metre / PIXELS_FULL));
    return strips ? strips : 1u;
}

float noh_haircut_fade(float pixels_per_metre)
{
    const float fade = pixels_per_metre / PIXELS_NONE - 1.0f;
    return !(fade > 0.0f) ? 0.0f : fade < 1.0f ? fade : 1.0f;
}

/* ---- a vertex ---- */

/* A number in 0..1 for a strip: from a sequence in which any interval is evenly distributed (as in common_fade.glsl),
 * then hashed where neighbours must differ. */
static float share_of(uint32_t bits)
{
    return (float)(bits >> 8) * (1.0f / 16777216.0f);
}

static uint32_t mixed(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/* The four points around a place on a curve, and their weights: for the curve, and for its derivative by the
 * segment. */
typedef struct curve_weights {
    uint32_t at[4];
    float place[4], slope[4];
} curve_weights;

static curve_weights weights_of(uint32_t count, float t)
{
    curve_weights w;
    const float x = t * (float)(count - 1u);
    uint32_t i = (uint32_t)x;
    i = i + 1u < count ? i : count - 2u;
    const float f = x - (float)i, f2 = f * f, f3 = f2 * f;
    w.at[0] = i ? i - 1u : 0;
    w.at[1] = i;
    w.at[2] = i + 1u;
    w.at[3] = i + 2u < count ? i + 2u : count - 1u;
    w.place[0] = 0.5f * (2.0f * f2 - f - f3);
    w.place[1] = 0.5f * (2.0f - 5.0f * f2 + 3.0f * f3);
    w.place[2] = 0.5f * (f + 4.0f * f2 - 3.0f * f3);
    w.place[3] = 0.5f * (f3 - f2);
    w.slope[0] = 0.5f * (4.0f * f - 1.0f - 3.0f * f2);
    w.slope[1] = 0.5f * (9.0f * f2 - 10.0f * f);
    w.slope[2] = 0.5f * (1.0f + 8.0f * f - 9.0f * f2);
    w.slope[3] = 0.5f * (3.0f * f2 - 2.0f * f);
    return w;
}

static void add_hair(const noh_haircut *cut, const float *points, uint32_t hair, const curve_weights *w, float share,
                     float position[3], float tangent[3])
{
    const float *hairs = points + (size_t)hair * cut->header->point_count * 3u;
    for (int k = 0; k < 4; k++) {
        noh_madd3(position, share * w->place[k], hairs + 3u * (size_t)w->at[k], position);
        noh_madd3(tangent, share * w->slope[k], hairs + 3u * (size_t)w->at[k], tangent);
    }
}

/* How a strip strays and curls: about its line in the patch, in a frame that is continuous except for hair that points
 * straight up (Frisvad: Building an Orthonormal Basis from a 3D Unit Vector Without Normalization, 2012). */
static void stray(const noh_pack_hair_header *h, uint32_t strip, float along, const float tangent[3], float position[3])
{
    const float a = share_of(mixed(strip * 3u + 1u)), b = share_of(mixed(strip * 3u + 2u));
    const float scatter = h->scatter * along, curl = h->curl_radius * along;
    const float x = tangent[0], z = tangent[2], fall = 1.0f - tangent[1], rise = 1.0f / (fall > 1e-4f ? fall : 1e-4f);
    const float side[3] = { 1.0f - x * x * rise, x, -x * z * rise };
    const float across[3] = { -x * z * rise, z, 1.0f - z * z * rise };
    float sine, cosine;
    noh_sin_cos(6.2831853f * (h->curl_turns * along + a), &sine, &cosine);
    noh_madd3(position, scatter * (2.0f * a - 1.0f) + curl * cosine, side, position);
    noh_madd3(position, scatter * (2.0f * b - 1.0f) + curl * sine, across, position);
}

void noh_haircut_vertex(const noh_haircut *cut, const float *points, uint32_t strip, float along, float position[3],
                        float tangent[3])
{
    static const float down[3] = { 0.0f, -1.0f, 0.0f };
    const noh_pack_hair_header *h = cut->header;
    const uint32_t patch = strip % h->patch_count, turn = strip / h->patch_count, own = mixed(patch + 1u);
    const uint32_t *corners = cut->patches + 4u * (size_t)patch;
    /* each patch has the sequence from another place on, otherwise all have the same gaps */
    const float u = share_of(turn * 0xc13fa9a9u + own), v = share_of(turn * 0x91e10da6u + mixed(own));
    const float t = along * (0.8f + 0.2f * share_of(mixed(strip * 3u)));
    const curve_weights w = weights_of(h->point_count, t);
    memset(position, 0, 3 * sizeof(float));
    memset(tangent, 0, 3 * sizeof(float));
    add_hair(cut, points, corners[0], &w, (1.0f - u) * (1.0f - v), position, tangent);
    add_hair(cut, points, corners[1], &w, u * (1.0f - v), position, tangent);
    add_hair(cut, points, corners[2], &w, (1.0f - u) * v, position, tangent);
    add_hair(cut, points, corners[3], &w, u * v, position, tangent);
    noh_normalize3(tangent, down);
    stray(h, strip, along, tangent, position);
}
