/* gl_morph_cpu.c: the path cpu. deform.h accumulates each changed instance, and the sums are uploaded to its
 * tile. The texture is only fetched from, never rendered to, so three components are enough without occlusion. */
#include <string.h>

#include "gl/morph/gl_morph_internal.h"
#include "gl/device/gl_state_internal.h"
#include "deform/morph/morph_internal.h"
#include "core/base/half_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/light.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

/* Floats to halves in place. Half i ends at byte 2 i + 2, before float i + 1 begins, so no unread float is overwritten.
 */
static void narrow_to_half(void *floats, size_t count)
{
    uint8_t *bytes = (uint8_t *)floats;
    for (size_t i = 0; i < count; i++) {
        float value;
        uint16_t half;
        memcpy(&value, bytes + 4 * i, sizeof value);
        half = noh_half_from_float(value, NOH_HALF_RNE);
        memcpy(bytes + 2 * i, &half, sizeof half);
    }
}

/* [layers][texels][3] to [layers][texels][4] in place, from the end, so that no unread float is overwritten. The fourth
 * component is the occlusion, stored after all layers, in the first layer, and 0 in the others. */
static void widen(float *staging, uint32_t layers, size_t texels)
{
    const float *occlusion = staging + 4u * layers * texels;
    for (size_t i = layers * texels; i-- > 0;) {
        for (size_t c = 3; c-- > 0;) staging[4u * i + c] = staging[3u * i + c];
        staging[4u * i + 3u] = i < texels ? occlusion[i] : 0.0f;
    }
}

static void update_instance(noh_gl_morph *m, uint32_t instance, noh_gl_morph_stats *stats)
{
    const noh_mesh mesh = noh_gl_morph_view(m, instance);
    const noh_mesh_header *h = mesh.header;
    const float *weights = m->weights + noh_gl_morph_first_weight(m, instance);
    noh_morph_cost cost = noh_morph_cost_of(&mesh, weights);
    int half = m->plan.accumulate == NOH_ACCUMULATE_F16;
    noh_morph_layers layers;
    uint32_t x, y;
    const size_t floats = noh_morph_layers_size(&mesh) / 12u; /* of a layer */
    const size_t texels = floats / 3u, wide = m->plan.occlusion ? 4u : 3u;
    memset(m->staging, 0, 4u * (wide * texels * m->plan.layer_count + (m->plan.occlusion ? texels : 0u)));
    layers.position = (float *)m->staging;
    layers.normal = layers.position + floats;
    layers.tangent = m->plan.layer_count == 3u ? layers.normal + floats : NULL;
    m->kernel.accumulate(&mesh, weights, &layers);
    if (m->plan.occlusion) {
        if (mesh.transfer) noh_transfer_accumulate(&mesh, weights, layers.position + 4u * m->plan.layer_count * texels);
        widen(layers.position, m->plan.layer_count, texels);
    }
    if (half) {
        narrow_to_half(m->staging, wide * texels * m->plan.layer_count);
    }
    noh_gl_morph_tile(m, instance, &x, &y);
    m->gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, (GLint)x, (GLint)y, 0, (GLsizei)(1u << h->morph_width_log2),
                         (GLsizei)h->morph_height, (GLsizei)m->plan.layer_count, m->plan.occlusion ? GL_RGBA : GL_RGB,
                         half ? GL_HALF_FLOAT : GL_FLOAT, m->staging);
    stats->targets += cost.targets;
    stats->rects += cost.rects;
    stats->texels += cost.texels;
    stats->pairs += cost.pairs;
}

void noh_gl_morph_update_cpu(noh_gl_morph *m, noh_gl_morph_stats *stats)
{
    noh_gl_pixels kept;
    m->gl->ActiveTexture(GL_TEXTURE0);
    m->gl->BindTexture(GL_TEXTURE_2D_ARRAY, m->layers.name);
    noh_gl_unpack_begin(m->gl, &kept);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        if (m->dirty[i] && noh_gl_morph_view(m, i).header->morph_height) {
            update_instance(m, i, stats);
        }
    }
    noh_gl_unpack_end(m->gl, &kept);
    m->gl->BindTexture(GL_TEXTURE_2D_ARRAY, 0);
    noh_gl_morph_end(m, NULL);
}
