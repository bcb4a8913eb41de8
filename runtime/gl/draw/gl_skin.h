/* gl_skin.h: the joints of skinned meshes on the GPU, for many instances at once.
 *
 *   noh_gl_skin_plan_make     choose where palettes are stored, and compute exact bytes, without GL calls
 *   noh_gl_skin_init          build the palettes in your memory and make the GL object
 *   noh_gl_skin_delete        delete the GL object
 *   noh_gl_skin_restore       make the GL object again after a lost context
 *   noh_gl_skin_set_matrices  set one instance's joint matrices
 *   noh_gl_skin_write_matrices, noh_gl_skin_touch  set matrices from several threads at once
 *   noh_gl_skin_set_place     set one instance's place in the world and its morph tile, for crowds
 *   noh_gl_skin_set_tint      set one instance's tint, for crowds
 *   noh_gl_skin_set_user      set four floats of one instance, for crowds and your own shaders
 *   noh_gl_skin_update        upload what changed
 *   noh_gl_skin_binding_of    where a vertex shader finds an instance's palettes
 *   noh_gl_skin_plan_of, noh_gl_skin_instance, noh_palette_mode_name
 *   noh_gl_palette_row, noh_gl_joint_rows, noh_gl_normal_rows
 *
 * A palette holds the joints of one draw in rows of four floats: three rows per joint, a 3 x 4 matrix; or, for a mesh
 * with NOH_MESH_DUAL_QUATERNION, four rows: the rotation, the dual part, and two for the stretch. The converter splits
 * a mesh if its joints do not fit one palette (Granberg, Character Animation with Direct3D, 2009, ch. 3). Instances are
 * numbered as in a noh_gl_morph of the same meshes and counts.
 *
 *   mode     where                       for
 *   uniform  a uniform block of 16 KiB   instances drawn one by one
 *   texture  RGBA32F                     also crowds: noh_gl_draw_crowd draws many instances in one call
 *
 * Both are core ES 3.0 and give the same bits.
 *
 * Threads: the context's own thread. noh_gl_skin_set_matrices, _set_place and _set_tint make no GL calls: another
 * thread may call them while no other call on the object runs. Any thread for noh_gl_skin_plan_make and the pure
 * functions. */
#ifndef NOH_GL_GL_SKIN_H
#define NOH_GL_GL_SKIN_H

#include "gl/morph/gl_morph.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_palette_mode {
    NOH_PALETTE_AUTO = 0, /* texture if a mesh has several instances, otherwise uniform */
    NOH_PALETTE_UNIFORM,
    NOH_PALETTE_TEXTURE
} noh_palette_mode;

/* The names "auto", "uniform", "texture". */
const char *noh_palette_mode_name(noh_palette_mode mode);

typedef struct noh_gl_skin_desc {
    const noh_mesh *meshes; /* [mesh_count]; copied, but the packs must stay. Rigid meshes have no palette */
    uint32_t mesh_count;
    const uint32_t *instance_counts; /* [mesh_count]; NULL: one of each. 1..NOH_MORPH_INSTANCES_MAX in all */
    noh_palette_mode mode;           /* 0: auto */
    int user_values;                 /* 1: room for noh_gl_skin_set_user: one more row per instance, in a texture */
} noh_gl_skin_desc;

/* The resolved plan on a GPU with these capabilities. All bytes are exact. */
typedef struct noh_gl_skin_plan {
    noh_palette_mode mode; /* never AUTO */
    const char *reason;    /* why this mode was chosen; a string constant */
    uint32_t instance_count;
    uint32_t texel_count;   /* rows of four floats, including gaps between palettes */
    uint32_t width, height; /* of the texture; 0 for a uniform buffer */
    uint64_t cpu_bytes;     /* the block for noh_gl_skin_init */
    uint64_t gpu_bytes;
} noh_gl_skin_plan;

typedef struct noh_gl_skin noh_gl_skin;

/* Where an instance's palettes are. */
typedef struct noh_gl_skin_binding {
    noh_palette_mode mode;
    unsigned name;       /* the uniform buffer, or the texture (GL_TEXTURE_2D) */
    uint32_t first;      /* the instance's first row of four floats */
    uint32_t stride;     /* rows from there to the next instance of the same mesh */
    uint32_t width_log2; /* row i is the texel (i & (width - 1), i >> width_log2); 0 for a uniform buffer */
    uint32_t align;      /* palettes start at multiples of this many rows */
    uint32_t influences; /* use at most this many joints per vertex, the strongest ones; 0: all */
    uint32_t user_row;   /* the instance's row with its user values; 0: none */
} noh_gl_skin_binding;

/* Choose the mode and compute its exact bytes, without GL calls.
 * errors  ARG a desc field is out of range; UNSUPPORTED the desc requests uniform blocks, which are too small here;
 *         LIMIT too many instances, or more rows than a texture of this GPU can hold */
noh_result noh_gl_skin_plan_make(const noh_gl_skin_desc *desc, const noh_gl_caps *caps, noh_gl_skin_plan *plan,
                                 noh_error *error);

/* Build palettes in memory[bytes], aligned to NOH_MEMORY_ALIGN and at least plan.cpu_bytes long, and make the GL
 * object, counted in the device's ledger. All matrices are initially the identity, the bind pose. On error the GL
 * object is deleted.
 * errors  as noh_gl_skin_plan_make; ARG memory is NULL or misaligned; MEMORY memory is too small (need:
 *         plan.cpu_bytes); GL, MEMORY the driver refused the object */
noh_result noh_gl_skin_init(void *memory, size_t bytes, const noh_gl_device *device, const noh_gl_skin_desc *desc,
                            noh_gl_skin **skin, noh_error *error);

/* Delete the GL object. The memory may then be reused. */
void noh_gl_skin_delete(noh_gl_skin *skin);

/* Release the GL object of a lost context without GL calls (gl_lost.h). It may be restored later. */
void noh_gl_skin_forget(noh_gl_skin *skin);

/* Make the GL object again in a new context (gl_lost.h); the next noh_gl_skin_update sends everything.
 * errors  GL, MEMORY as noh_gl_skin_init; it then has no GL object, and restore may be called again */
noh_result noh_gl_skin_restore(noh_gl_skin *skin, noh_error *error);

const noh_gl_skin_plan *noh_gl_skin_plan_of(const noh_gl_skin *skin);

/* The number of the i-th instance of the m-th mesh. */
uint32_t noh_gl_skin_instance(const noh_gl_skin *skin, uint32_t mesh, uint32_t i);

/* Set the joint matrices of one instance. Does nothing for a rigid mesh.
 * shapes  matrices[joint_count of the mesh's skin][12]: the joint in model space * its inverse bind matrix */
void noh_gl_skin_set_matrices(noh_gl_skin *skin, uint32_t instance, const float *matrices);

/* Set matrices in two halves, so that several threads may write different instances at once, with no other call on the
 * object meanwhile. An update sends written matrices only if noh_gl_skin_touch was called for the instance afterwards.
 * returns  1 if a row changed */
int noh_gl_skin_write_matrices(noh_gl_skin *skin, uint32_t instance, const float *matrices);
void noh_gl_skin_touch(noh_gl_skin *skin, uint32_t instance);

/* Set the placement of one instance, for noh_gl_draw_crowd.
 * shapes  world[12] rows of 3 x 4
 * morph   its accumulated deltas; NULL: no target is active
 * errors  UNSUPPORTED palettes are in a uniform buffer, which cannot draw crowds; ARG `world` mirrors (where: the
 *         instance): one draw cannot have triangles of both windings, so draw this instance alone */
noh_result noh_gl_skin_set_place(noh_gl_skin *skin, uint32_t instance, const float world[12],
                                 const noh_gl_morph_binding *morph, noh_error *error);

/* Set the tint of one instance, for noh_gl_draw_crowd: noh_vertex.tint in shaders. noh_gl_skin_set_place keeps it.
 * shapes  tint: sRGB and alpha, multiplied with vertex colours, except for NOH_MATERIAL_UNTINTED; alpha is used only by
 *         blended materials. NULL: white, the initial value
 * errors  UNSUPPORTED palettes are in a uniform buffer, which cannot draw crowds */
noh_result noh_gl_skin_set_tint(noh_gl_skin *skin, uint32_t instance, const uint8_t tint[4], noh_error *error);

/* Set four floats of one instance, for noh_gl_draw_crowd: noh_user() in your own vertex shaders. Initially zeros.
 * errors  UNSUPPORTED palettes are in a uniform buffer, which cannot draw crowds, or the desc has no user_values */
noh_result noh_gl_skin_set_user(noh_gl_skin *skin, uint32_t instance, const float values[4], noh_error *error);

/* Set the wrinkles of one instance's regions, for noh_gl_draw_crowd; initially 0. noh_gl_skin_set_place keeps them.
 * shapes  regions of noh_wrinkles_weights, 0..1, stored in 255ths; NULL: none
 * errors  UNSUPPORTED palettes are in a uniform buffer, which cannot draw crowds; NOT_FOUND the instance's mesh has no
 *         wrinkles */
noh_result noh_gl_skin_set_wrinkles(noh_gl_skin *skin, uint32_t instance, const float *regions, noh_error *error);

/* Upload the range of rows changed since the last update, in one call.
 * state   gl_state.h: the texture of unit 0, or the uniform buffer, is 0. No state is changed if no row changed
 * errors  none: init checked everything */
void noh_gl_skin_update(noh_gl_skin *skin);

/* The binding of an instance, with `influences` 0; set `influences` to draw with fewer joints per vertex. */
noh_gl_skin_binding noh_gl_skin_binding_of(const noh_gl_skin *skin, uint32_t instance);

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

#endif
