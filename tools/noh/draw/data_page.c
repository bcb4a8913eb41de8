#include "draw/data_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/deform.h"
#include "noh/low_core.h"

const char *const data_layer_names[DATA_LAYERS] = { "position", "normal", "tangent" };

int data_page_open(data_page *p, const noh_mesh *mesh)
{
    const size_t texels = noh_morph_layers_size(mesh) / (3u * 3u * sizeof(float));
    memset(p, 0, sizeof *p);
    if (!texels) return 0;
    p->width = 1u << mesh->header->morph_width_log2;
    p->height = mesh->header->morph_height;
    p->rgba = malloc(DATA_LAYERS * texels * 4u);
    p->memory = malloc(noh_morph_layers_size(mesh));
    if (p->rgba && p->memory) return 0;
    data_page_close(p);
    return tool_fail("data textures", "out of memory");
}

void data_page_close(data_page *p)
{
    free(p->rgba);
    free(p->memory);
    memset(p, 0, sizeof *p);
}

/* value: 0 black, 1 white */
static uint8_t byte_of(float value)
{
    return (uint8_t)(255.0f * fminf(fmaxf(value, 0.0f), 1.0f) + 0.5f);
}

static uint8_t *pixel(const data_page *p, uint32_t layer, uint32_t texel)
{
    return p->rgba + 4u * ((size_t)layer * p->width * p->height + texel);
}

static void clear(data_page *p)
{
    memset(p->rgba, 0, 4u * (size_t)DATA_LAYERS * p->width * p->height);
    memset(p->most, 0, sizeof p->most);
}

void data_page_base(data_page *p, const noh_mesh *mesh)
{
    const noh_mesh_header *h = mesh->header;
    if (!p->rgba) return;
    clear(p);
    for (uint32_t i = 0; i < h->vertex_count; i++) {
        const uint32_t texel = noh_mesh_accumulation_texel(mesh, i);
        noh_vertex v;
        if (texel >= h->touched_count) continue;
        noh_mesh_vertex(mesh, i, &v);
        for (uint32_t c = 0; c < 3; c++) {
            const float size = h->bounds_max[c] - h->bounds_min[c];
            pixel(p, 0, texel)[c] = byte_of(size > 0.0f ? (v.position[c] - h->bounds_min[c]) / size : 0.5f);
            pixel(p, 1, texel)[c] = byte_of(0.5f + 0.5f * v.normal[c]);
            pixel(p, 2, texel)[c] = byte_of(0.5f + 0.5f * v.tangent[c]);
        }
        for (uint32_t layer = 0; layer < DATA_LAYERS; layer++) pixel(p, layer, texel)[3] = 255;
    }
}

static void show_layer(data_page *p, uint32_t layer, const float *values, uint32_t touched, float gain)
{
    float most = 0.0f;
    for (uint32_t i = 0; i < 3u * touched; i++) most = fmaxf(most, fabsf(values[i]));
    p->most[layer] = most;
    for (uint32_t i = 0; i < touched; i++) {
        uint8_t *to = pixel(p, layer, i);
        for (uint32_t c = 0; c < 3; c++) {
            to[c] = byte_of(most > 0.0f ? 0.5f + 0.5f * gain * (values[3u * i + c] / most) : 0.5f);
        }
        to[3] = 255;
    }
}

void data_page_sums(data_page *p, const noh_mesh *mesh, const float *weights, float gain)
{
    noh_morph_layers layers;
    if (!p->rgba) return;
    clear(p);
    if (noh_morph_layers_init(p->memory, noh_morph_layers_size(mesh), mesh, &layers, NULL)) return;
    noh_morph_accumulate(mesh, weights, &layers);
    show_layer(p, 0, layers.position, mesh->header->touched_count, gain);
    show_layer(p, 1, layers.normal, mesh->header->touched_count, gain);
    show_layer(p, 2, layers.tangent, mesh->header->touched_count, gain);
}

void data_page_delta(data_page *p, const noh_mesh *mesh, uint32_t target, float gain)
{
    static float weights[NOH_TARGETS_MAX];
    weights[target] = 1.0f;
    data_page_sums(p, mesh, weights, gain);
    weights[target] = 0.0f;
}
