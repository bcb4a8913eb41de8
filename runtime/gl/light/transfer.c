#include "core/mesh/mesh_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/light.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "core/base/octahedral_internal.h"
#include "gl/light/transfer_internal.h"

noh_result noh_transfer_of(const noh_mesh *mesh, noh_transfer *transfer, noh_error *error)
{
    const noh_transfer_header *h;
    const uint8_t *bytes;
    NOH_ASSERT(mesh && transfer);
    h = mesh->transfer;
    if (!h) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the mesh has no transfer: build its pack with --transfer 4 or 6", 0,
                        0);
    }
    bytes = (const uint8_t *)h;
    transfer->header = h;
    transfer->records = bytes + h->records_offset;
    transfer->scales = (const float *)(const void *)(bytes + h->scales_offset);
    transfer->deltas = (const int8_t *)(const void *)(bytes + h->deltas_offset);
    return NOH_OK;
}

static void accumulate_target(const noh_mesh *mesh, uint32_t index, float weight, float *occlusion)
{
    const noh_target *t = &mesh->targets[index];
    const float ratio = noh_transfer_ratio(mesh, index), scaled = t->position_scale * weight;
    uint32_t texel = t->first_texel;
    for (uint32_t i = t->first_rect; i < t->first_rect + t->rect_count; i++) {
        const noh_rect *rect = &mesh->rects[i];
        for (uint32_t y = 0; y < rect->h; y++) {
            float *row = occlusion + ((size_t)(rect->y + y) << mesh->header->morph_width_log2) + rect->x;
            for (uint32_t x = 0; x < rect->w; x++) {
                row[x] += (float)noh_transfer_delta(mesh, texel++) * ratio * scaled;
            }
        }
    }
}

void noh_transfer_accumulate(const noh_mesh *mesh, const float *weights, float *occlusion)
{
    NOH_ASSERT(mesh && mesh->transfer && weights && occlusion);
    for (uint32_t i = 0; i < mesh->header->target_count; i++) {
        if (weights[i] != 0.0f) {
            accumulate_target(mesh, i, weights[i], occlusion);
        }
    }
}

static float signed_byte(uint8_t byte)
{
    return (float)(byte < 128u ? (int)byte : (int)byte - 256) / 127.0f;
}

void noh_transfer_lobe(const noh_mesh *mesh, const noh_transfer *transfer, uint32_t vertex, noh_lobe *lobe)
{
    NOH_ASSERT(mesh && transfer && lobe && vertex < mesh->header->vertex_count);
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    const uint32_t order = transfer->header->order, flags = transfer->header->flags;
    const uint8_t *record = transfer->records + (size_t)vertex * NOH_TRANSFER_RECORD_BYTES(order, flags);
    memset(lobe, 0, sizeof *lobe);
    lobe->occlusion = (float)record[0] / 255.0f;
    lobe->shape[0] = 1.0f;
    for (uint32_t l = 1; l < order; l++) {
        lobe->shape[l] = signed_byte(record[l]);
    }
    if (flags & NOH_TRANSFER_ON_NORMAL) {
        float tangent[3];
        noh_mesh_directions(mesh, vertex, lobe->axis, tangent);
    } else {
        noh_octahedral_unfold(signed_byte(record[order]), signed_byte(record[order + 1u]), lobe->axis);
    }
    noh_normalize3(lobe->axis, up);
}

/* Rodrigues' formula, with the sine in the length of the cross product. */
void noh_lobe_turn(noh_lobe *lobe, const float from[3], const float to[3])
{
    const float cross[3] = { from[1] * to[2] - from[2] * to[1], from[2] * to[0] - from[0] * to[2],
                             from[0] * to[1] - from[1] * to[0] };
    const float *a = lobe->axis;
    const float cosine = noh_dot3(from, to);
    float turned[3], along;
    if (cosine < -0.9999f) {
        return;
    }
    along = noh_dot3(cross, a) / (1.0f + cosine);
    for (uint32_t i = 0; i < 3u; i++) {
        const uint32_t j = (i + 1u) % 3u, k = (i + 2u) % 3u;
        turned[i] = a[i] * cosine + (cross[j] * a[k] - cross[k] * a[j]) + cross[i] * along;
    }
    noh_normalize3(turned, a);
    memcpy(lobe->axis, turned, sizeof turned);
}

void noh_lobe_shade(const noh_lobe *lobe, uint32_t order, const noh_light *light, float rgb[3])
{
    NOH_ASSERT(lobe && light && rgb && order >= 1 && order <= NOH_SH_ORDER_MAX);
    const uint32_t bands = order < light->order ? order : light->order;
    float basis[NOH_SH_COUNT_MAX];
    noh_sh_basis(bands, lobe->axis, basis);
    noh_sh_convolve(bands, lobe->shape, basis);
    memset(rgb, 0, 3 * sizeof *rgb);
    for (uint32_t i = 0; i < 3u * NOH_SH_COUNT(bands); i++) {
        rgb[i % 3u] += basis[i / 3u] * light->coefs[i / 3u][i % 3u];
    }
    for (uint32_t c = 0; c < 3u; c++) {
        rgb[c] *= lobe->occlusion;
    }
}

void noh_transfer_shade(const noh_mesh *mesh, const noh_transfer *transfer, uint32_t vertex, const float normal[3],
                        const float *occlusion, const noh_light *light, float rgb[3])
{
    const uint32_t texel = noh_mesh_accumulation_texel(mesh, vertex);
    float rest[3], tangent[3];
    noh_lobe lobe;
    noh_transfer_lobe(mesh, transfer, vertex, &lobe);
    noh_mesh_directions(mesh, vertex, rest, tangent);
    noh_normalize3(rest, normal);
    noh_lobe_turn(&lobe, rest, normal);
    if (occlusion && texel < mesh->header->touched_count) {
        lobe.occlusion += occlusion[texel];
        lobe.occlusion = lobe.occlusion < 0.0f ? 0.0f : lobe.occlusion > 1.0f ? 1.0f : lobe.occlusion;
    }
    noh_lobe_shade(&lobe, transfer->header->order, light, rgb);
}
