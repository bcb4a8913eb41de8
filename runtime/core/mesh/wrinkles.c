#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "core/mesh/mesh_internal.h"

noh_result noh_wrinkles_of(const noh_mesh *mesh, noh_wrinkles *wrinkles, noh_error *error)
{
    const noh_pack *pack;
    NOH_ASSERT(mesh && mesh->pack && wrinkles);
    pack = mesh->pack;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_WRINKLES].count; i++) {
        const uint8_t *bytes = noh_pack_chunk_at(pack, NOH_CHUNK_WRINKLES, i);
        const noh_wrinkles_header *h = (const noh_wrinkles_header *)(const void *)bytes;
        const uint8_t *first = (const uint8_t *)(mesh->header - (mesh->header->level - mesh->header->level_first));
        if (noh_pack_chunk_at(pack, NOH_CHUNK_MESH, h->mesh) == first) {
            wrinkles->target_count = h->target_count;
            wrinkles->matrix = bytes + h->matrix_offset;
            wrinkles->colors = h->colors_offset ? bytes + h->colors_offset : NULL;
            wrinkles->color_material = h->color_material;
            wrinkles->color_texture = h->color_texture;
            return NOH_OK;
        }
    }
    return noh_fail(error, NOH_ERR_NOT_FOUND,
                    "the mesh has no wrinkles or colours: build its pack with --wrinkles auto or --color-map", 0,
                    pack->runs[NOH_CHUNK_WRINKLES].count);
}

static void add_row(const uint8_t *row, uint32_t count, float weight, float *regions)
{
    for (uint32_t r = 0; r < count; r++) {
        regions[r] += weight * ((float)row[r] * (1.0f / 255.0f));
    }
}

void noh_wrinkles_weights(const noh_wrinkles *wrinkles, const float *weights, float *regions)
{
    NOH_ASSERT(wrinkles && weights && regions);
    memset(regions, 0, NOH_WRINKLE_REGIONS * sizeof *regions);
    for (uint32_t t = 0; t < wrinkles->target_count; t++) {
        if (!(weights[t] > 0.0f)) continue;
        add_row(wrinkles->matrix + (size_t)t * NOH_WRINKLE_FOLDS, NOH_WRINKLE_FOLDS, weights[t], regions);
        if (wrinkles->colors) {
            add_row(wrinkles->colors + ((size_t)NOH_WRINKLE_COLORS + t) * 4u, NOH_WRINKLE_COLORS, weights[t],
                    regions + NOH_WRINKLE_FOLDS);
        }
    }
    for (uint32_t r = 0; r < NOH_WRINKLE_REGIONS; r++) {
        regions[r] = regions[r] < 1.0f ? regions[r] : 1.0f;
    }
}

float noh_wrinkles_area(float area_at_rest, float area)
{
    const float shrunk = area_at_rest > 1e-18f ? (area_at_rest - area) / area_at_rest : 0.0f;
    const float weight = 0.3f + (shrunk < 0.0f ? 0.005f * shrunk : shrunk);
    return weight < 0.0f ? 0.0f : weight < 1.0f ? weight : 1.0f;
}

static void make_unit(float v[3])
{
    const float length = noh_sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

void noh_wrinkles_color(const noh_wrinkles *wrinkles, const uint8_t cover[4], const float *regions, float rgb[3])
{
    NOH_ASSERT(wrinkles && wrinkles->colors && cover && regions && rgb);
    for (uint32_t c = 0; c < NOH_WRINKLE_COLORS; c++) {
        const float weight = regions[NOH_WRINKLE_FOLDS + c] * ((float)cover[c] / 255.0f);
        for (uint32_t i = 0; i < 3; i++) {
            const float root = (float)wrinkles->colors[4u * c + i] / 255.0f;
            rgb[i] += weight * (root * root - rgb[i]);
        }
    }
}

void noh_wrinkles_normal(const float *base, const float *wrinkle, float weight, float *out)
{
    float t[3] = { base[0], base[1], base[2] + 1.0f };
    float u[3] = { -wrinkle[0] * weight, -wrinkle[1] * weight, wrinkle[2] }, along;
    NOH_ASSERT(base && wrinkle && out);
    make_unit(u);
    along = (t[0] * u[0] + t[1] * u[1] + t[2] * u[2]) / t[2];
    for (int i = 0; i < 3; i++) {
        t[i] = t[i] * along - u[i];
    }
    make_unit(t);
    memcpy(out, t, sizeof t);
}
