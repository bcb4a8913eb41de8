/* texture_trim.h: textures without the columns and rows that no triangle reads.
 *
 *   texture_trim          choose the parts of each texture to keep, and move texture coordinates accordingly
 *   texture_trim_texels   take the columns and rows out of an image
 *   texture_trim_word     noh_texture_header.trim
 *
 * A texture is divided into up to 64 columns and as many rows. Those that no triangle of any level comes near are
 * removed, and both sides move together, so each triangle keeps its texels and its scale. All maps of a
 * material share one set of texture coordinates and lose the same parts, and so do materials with a common texture or
 * vertex, and a texture whose name is another's with a suffix (noh_texture_set).
 *
 * Columns and rows are multiples of 4 texels in every map, so blocks stay the same, and mip levels too as long as a
 * column is a whole number of texels. What is within 4 texels of the smallest map of a material and within 1/128 of the
 * side stays, around the border where textures repeat: filters of that reach find what they found.
 *
 * Left whole: textures of eyes, which are read off the texture coordinates; those that are read texel by texel;
 * where targets move texture coordinates; an axis on which a texture that does not repeat is read beyond 0..1; what
 * no triangle reads at all; and where less than 1/16 would go. */
#ifndef NOH_CONVERT_TEXTURE_TEXTURE_TRIM_H
#define NOH_CONVERT_TEXTURE_TEXTURE_TRIM_H

#include "convert/lod/lod_levels.h"
#include "convert/model/model.h"

/* For the report. */
typedef struct texture_trimmed {
    uint32_t count;         /* textures that lost something */
    uint64_t texels, whole; /* of those: what is left, and what they had, in the sizes that are stored */
} texture_trimmed;

/* Sets model_texture.cells and .kept, and moves model_mesh.uv. levels: [mesh_count], finished. Targets are encoded
 * before. Returns 0, or 1: out of memory; then nothing has changed. */
int texture_trim(model *m, const mesh_levels *levels, texture_trimmed *done);

/* texels[*height][*width][texel_bytes]: what stays moves to the front, and the sides shrink to it. */
void texture_trim_texels(const model_texture *t, void *texels, size_t texel_bytes, uint32_t *width, uint32_t *height);

/* 0: the texture is whole. Textures of the same word have the same parts of what they were. */
uint32_t texture_trim_word(const model_texture *t);

#endif
