/* gl_skin_internal.h (private to gl_skin*.c): how palettes are laid out. */
#ifndef NOH_GL_GL_SKIN_INTERNAL_H
#define NOH_GL_GL_SKIN_INTERNAL_H

#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Release the GL object of a lost context without GL calls (gl_device.h). It may be restored later. */
void noh_gl_skin_forget(noh_gl_skin *skin);

/* Set matrices in two halves, so that several threads may write different instances at once, with no other call on the
 * object meanwhile. An update sends written matrices only if noh_gl_skin_touch was called for the instance afterwards.
 * returns  1 if a row changed */
int noh_gl_skin_write_matrices(noh_gl_skin *skin, uint32_t instance, const float *matrices);
void noh_gl_skin_touch(noh_gl_skin *skin, uint32_t instance);

/* With noh_gl_skin_desc.motion: the rows of the last frame. Keep what is now, once all draws of a frame are sent; then
 * copy for each instance the palettes of the instance that it was (NOH_NONE: as they are now), after its matrices were
 * written, in the same thread; and write where it was, with its deltas (NULL: none).
 * returns  1 if a row changed, as noh_gl_skin_write_matrices */
void noh_gl_skin_keep(noh_gl_skin *skin);
int noh_gl_skin_write_before(noh_gl_skin *skin, uint32_t instance, uint32_t was);
void noh_gl_skin_put_before(noh_gl_skin *skin, uint32_t instance, const float world[12],
                            const noh_gl_morph_binding *morph);

/* The first row of a palette, counted from the instance's own first row. */
uint32_t noh_gl_palette_row(const noh_gl_skin_binding *binding, const noh_mesh *mesh, uint32_t palette);

/* Rows of one joint of a mesh: 3 or 4. In a uniform buffer, the range to bind for a palette begins at byte
 * 16 * (binding.first + noh_gl_palette_row(...)) and holds NOH_PALETTE_JOINTS_MAX joints. */
uint32_t noh_gl_joint_rows(const noh_mesh *mesh);

/* Get the rows that transform normals: the inverse transpose of the 3 x 3 part of a placement, up to a positive factor.
 * They are its cofactors times the sign of its determinant, without division, so the normals of a mirrored node still
 * point outwards. (The matrix itself would be correct only for rotations and uniform scales.) Returns the determinant.
 * source  Turkowski, "Properties of Surface-Normal Transformations", Graphics Gems (1990) */
float noh_gl_normal_rows(const float world[12], float rows[12]);

#ifdef __cplusplus
}
#endif

#define NOH_CROWD_ROWS 4u            /* before an instance's palettes in a texture: see crowd_row */
#define NOH_CROWD_REGIONS 4u         /* index of one more row, of a mesh with wrinkle regions */
#define NOH_CROWD_COLORS 5u          /* and of one more, if targets colour them */
#define NOH_SKIN_ROWS_MAX (1u << 26) /* 1 GiB */

/* One mesh of the desc. */
typedef struct noh_gl_skin_mesh {
    noh_mesh mesh;
    uint32_t instance_count, first_instance;
    uint32_t first_row, stride; /* row of the first instance; rows from one instance to the next */
    uint32_t first_kept;        /* in noh_gl_skin.kept, before_row rows for each instance */
    uint32_t before_row;        /* from an instance's first row to its rows of the last frame; 0: none */
} noh_gl_skin_mesh;

struct noh_gl_skin {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    noh_gl_skin_plan plan;
    uint32_t align, width_log2;
    uint32_t user_rows; /* per instance, after its palettes: 0 or 1 */
    uint32_t mesh_count;
    noh_gl_skin_mesh *meshes; /* [mesh_count] */
    float *rows;              /* [texel_count, in a texture width * height][4] */
    float *kept; /* [plan.kept_count][4] rows of the last frame, but for user values; NULL without motion */
    uint32_t dirty_first, dirty_end; /* the span that the next update sends; empty if first >= end */
    noh_gl_buffer buffer;            /* either this */
    noh_gl_texture texture;          /* or this */
};

/* Pack a tint into the high bits of a tile's x, y and width_log2: 255 - red above the 16 bits of x, 255 - green above
 * the 16 bits of y, 255 - blue and then 255 - alpha above the 8 bits of width_log2. White is 0, and all three numbers
 * stay below 2^24, so they are exact as floats. tint NULL: white. */
#define NOH_TILE_XY_MASK 0xffffu
#define NOH_TILE_LOG2_MASK 0xffu
static inline void noh_gl_tint_bits(const uint8_t tint[4], uint32_t bits[3])
{
    for (int i = 0; i < 3; i++) bits[i] = tint ? (uint32_t)(255 - tint[i]) << (i < 2 ? 16 : 8) : 0;
    if (tint) bits[2] |= (uint32_t)(255 - tint[3]) << 16;
}

/* The numbers of a tile, which are below 2^24 and so exact. */
static inline void noh_gl_tile_floats(const noh_gl_morph_binding *morph, float tile[4])
{
    tile[0] = (float)morph->tile_x;
    tile[1] = (float)morph->tile_y;
    tile[2] = (float)morph->width_log2;
    tile[3] = (float)morph->touched;
}

/* Rows before the palettes of an instance of this mesh. */
uint32_t noh_gl_crowd_rows(const noh_mesh *mesh);

/* Palettes start at multiples of this many rows. */
uint32_t noh_gl_skin_align(const noh_gl_skin_plan *plan, const noh_gl_caps *caps);

/* Place every mesh's instances, and return the number of rows. `meshes` NULL only counts. */
uint64_t noh_gl_skin_layout(const noh_gl_skin_desc *desc, noh_palette_mode mode, uint32_t align,
                            noh_gl_skin_mesh *meshes);

/* Carve everything after the struct itself from an arena. `skin` NULL only measures. */
void noh_gl_skin_carve(noh_arena *arena, uint32_t mesh_count, const noh_gl_skin_plan *plan, noh_gl_skin *skin);

#endif
