/* mesh_internal.h: the private part of low_core.h. */
#ifndef NOH_MESH_MESH_INTERNAL_H
#define NOH_MESH_MESH_INTERNAL_H

#include "core/base/compiler_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The wrinkle weight of a triangle by its area, as in the SparseMorphTargets sample: 0.3 at rest, more when it shrinks,
 * slightly less when it grows, within 0..1. Areas are in bind space: after targets, before joints. A triangle with no
 * area at rest keeps its rest weight. */
float noh_wrinkles_area(float area_at_rest, float area);

/* Blend the colours of regions onto an albedo, one region after the other.
 * shapes  cover: a texel of the colour map; regions[NOH_WRINKLE_REGIONS]; rgb: linear albedo
 * state   wrinkles->colors is not NULL */
void noh_wrinkles_color(const noh_wrinkles *wrinkles, const uint8_t cover[4], const float *regions, float rgb[3]);

/* Blend a wrinkle normal onto a base normal, with the wrinkle's slopes times weight.
 * shapes  base, wrinkle, out: [3] unit, tangent space; out may be base or wrinkle
 * ranges  z of both above 0; weight 0..1
 * source  reoriented normal mapping: Barre-Brisebois, Hill, Blending in Detail, 2012 */
void noh_wrinkles_normal(const float *base, const float *wrinkle, float weight, float *out);

/* The accumulation texel of a vertex's texture coordinates; header->touched_count or more: none, no target moves
 * them. */
uint32_t noh_mesh_uv_texel(const noh_mesh *mesh, uint32_t vertex);

/* The chunk that is about the n-th mesh, whose number is its first word. NULL: there is none. */
const void *noh_pack_chunk_of_mesh(const noh_pack *pack, noh_chunk_type type, uint32_t mesh);

/* Where a record's words of extra attributes begin: behind its colour, in front of its texels. */
static inline uint32_t noh_mesh_extra_offset(const noh_mesh_header *h)
{
    return h->attribute_stride - 4u * (h->extra_words + (h->flags & NOH_MESH_TEXELS ? 1u : 0u) +
                                       (h->flags & NOH_MESH_UV_TARGETS ? 1u : 0u));
}

/* Decode a vertex's normal and tangent without normalising; their lengths are 0.57 to 1. Without tangents the tangent
 * is 0. */
void noh_mesh_directions(const noh_mesh *mesh, uint32_t index, float normal[3], float tangent[3]);

/* The material of a submesh; glTF's default for one without. */
const noh_material *noh_mesh_material(const noh_mesh *mesh, const noh_submesh *submesh);

#define NOH_PRIORITY_NONE 1000 /* above all priorities */

/* The lowest priority above `above` of a mesh's blended materials; NOH_PRIORITY_NONE: there is none. */
int noh_mesh_next_priority(const noh_mesh *mesh, int above);

/* The core of a blended surface, where alpha is at least this, is drawn as opaque: it hides what is behind it. */
#define NOH_CORE_ALPHA 0.9f

NOH_UNUSED static inline int noh_material_has_core(const noh_material *m)
{
    return (m->flags & NOH_MATERIAL_BLEND) && m->base_color_texture != NOH_NONE;
}

/* The i-th index of a mesh with all its levels, the finest first. */
NOH_UNUSED static inline uint32_t noh_mesh_index_of_all(const noh_mesh *mesh, uint64_t i)
{
    return mesh->header->index_bytes == 2 ? ((const uint16_t *)mesh->indices)[i] : ((const uint32_t *)mesh->indices)[i];
}

#ifdef __cplusplus
}
#endif

#endif
