/* gl_skin.h: the joints of skinned meshes on the GPU, for many instances at once.
 *
 *   noh_gl_skin_plan_make     where palettes go, why, and every byte they will take: before any load
 *   noh_gl_skin_init          build it in your memory and make its GL object
 *   noh_gl_skin_delete        delete the GL object
 *   noh_gl_skin_restore       make it again after a lost context
 *   noh_gl_skin_set_matrices  one instance's joint matrices
 *   noh_gl_skin_set_place     one instance's place in the world and its morph tile, for crowds
 *   noh_gl_skin_update        one upload of what changed
 *   noh_gl_skin_binding_of    where a vertex shader finds an instance's palettes
 *   noh_gl_skin_plan_of, noh_gl_skin_instance, noh_palette_mode_name
 *   noh_gl_palette_row, noh_gl_joint_rows, noh_gl_normal_rows
 *
 * A palette is what one draw needs, in rows of four floats: three a joint, a matrix; or, in a mesh with
 * NOH_MESH_DUAL_QUATERNION, four: rotation, dual part and the stretch. The converter splits meshes whose
 * joints do not fit one palette, as Granberg, Character Animation with Direct3D (2009), ch. 3, has it. Instances are
 * numbered as in a noh_gl_morph of the same meshes and counts.
 *
 *   mode     in                                for
 *   uniform  a uniform block, up to 16 KiB     instances that are drawn one by one
 *   texture  RGBA32F, in rows                  crowds too: noh_gl_draw_crowd draws many in one call
 * Both are core ES 3.0, and both give the same bits.
 *
 * Threads: the context's own thread. noh_gl_skin_set_matrices and noh_gl_skin_set_place call no GL: another thread may,
 * while no other call on that object runs. noh_gl_skin_plan_make and the pure functions, any. */
#ifndef NOH_GL_GL_SKIN_H
#define NOH_GL_GL_SKIN_H

#include "gl/gl_morph.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_palette_mode {
    NOH_PALETTE_AUTO = 0, /* texture where a mesh has several instances, else uniform */
    NOH_PALETTE_UNIFORM,
    NOH_PALETTE_TEXTURE
} noh_palette_mode;

/* "auto", "uniform", "texture". */
const char *noh_palette_mode_name(noh_palette_mode mode);

typedef struct noh_gl_skin_desc {
    const noh_mesh *meshes; /* [mesh_count]; copied, the packs must stay. Rigid ones take no palette */
    uint32_t mesh_count;
    const uint32_t *instance_counts; /* [mesh_count]; NULL: one of each. 1..NOH_MORPH_INSTANCES_MAX in all */
    noh_palette_mode mode;           /* 0: auto */
} noh_gl_skin_desc;

/* The resolved plan on a GPU with these capabilities. All bytes are exact. */
typedef struct noh_gl_skin_plan {
    noh_palette_mode mode; /* never AUTO */
    const char *reason;    /* why this mode, in words; a string constant */
    uint32_t instance_count;
    uint32_t texel_count;   /* rows of four floats, gaps between palettes included */
    uint32_t width, height; /* of the texture; 0 in a uniform buffer */
    uint64_t cpu_bytes;     /* the block that noh_gl_skin_init needs */
    uint64_t gpu_bytes;
} noh_gl_skin_plan;

typedef struct noh_gl_skin noh_gl_skin;

/* Where an instance's palettes are. */
typedef struct noh_gl_skin_binding {
    noh_palette_mode mode;
    GLuint name;         /* the uniform buffer, or the texture (GL_TEXTURE_2D) */
    uint32_t first;      /* the instance's first row of four floats */
    uint32_t stride;     /* from there to the next instance of the same mesh */
    uint32_t width_log2; /* row i is the texel (i & (width - 1), i >> width_log2); 0 in a uniform buffer */
    uint32_t align;      /* palettes start at multiples of this many rows */
    uint32_t influences; /* at most this many joints per vertex, the strongest ones; 0: all */
} noh_gl_skin_binding;

/* Decide and measure, without touching GL.
 * errors  ARG a desc field is out of range; UNSUPPORTED uniform blocks are too small for the forced
 *         mode; LIMIT too many instances, or palettes for more than a texture of this GPU holds */
noh_result noh_gl_skin_plan_make(const noh_gl_skin_desc *desc, const noh_gl_caps *caps, noh_gl_skin_plan *plan,
                                 noh_error *error);

/* Build in memory[bytes], which is aligned to NOH_MEMORY_ALIGN and at least plan.cpu_bytes long, and make the GL
 * object, counted in the device's ledger. All joints start as the identity: the bind pose. errors  as
 * noh_gl_skin_plan_make; ARG memory is NULL or misaligned, MEMORY it is too small (`need`: plan.cpu_bytes), nothing is
 * then touched; GL, MEMORY the driver refused the object. On error no GL object is left */
noh_result noh_gl_skin_init(void *memory, size_t bytes, const noh_gl_device *device, const noh_gl_skin_desc *desc,
                            noh_gl_skin **skin, noh_error *error);

/* Delete the GL object. The memory is yours again. */
void noh_gl_skin_delete(noh_gl_skin *skin);

/* Make the object again in a new context (gl_lost.h); the next update sends all. errors  as init */
noh_result noh_gl_skin_restore(noh_gl_skin *skin, noh_error *error);

const noh_gl_skin_plan *noh_gl_skin_plan_of(const noh_gl_skin *skin);

/* The number of the i-th instance of the m-th mesh. */
uint32_t noh_gl_skin_instance(const noh_gl_skin *skin, uint32_t mesh, uint32_t i);

/* Set the joint matrices of one instance; only rows that changed are sent. Does nothing for a rigid mesh.
 * shapes  matrices[joint_count of the mesh's skin][12]: model space of the joint * inverse bind */
void noh_gl_skin_set_matrices(noh_gl_skin *skin, uint32_t instance, const float *matrices);

/* Set the placement of one instance, for noh_gl_draw_crowd.
 * shapes   world[12] rows of 3 x 4
 * morph    where its deltas are; NULL: none
 * errors   UNSUPPORTED palettes are in a uniform buffer, which cannot draw crowds; ARG `world` mirrors: the
 *          triangles of one draw cannot face both ways, so draw that instance alone. `where` is the instance */
noh_result noh_gl_skin_set_place(noh_gl_skin *skin, uint32_t instance, const float world[12],
                                 const noh_gl_morph_binding *morph, noh_error *error);

/* Send the span of what changed since the last update, in one call. Nothing is touched when nothing
 * changed; else texture unit 0 and the uniform buffer binding are left at 0.
 * errors  none: everything was checked at init */
void noh_gl_skin_update(noh_gl_skin *skin);

/* `influences` is 0; set it to draw fewer. */
noh_gl_skin_binding noh_gl_skin_binding_of(const noh_gl_skin *skin, uint32_t instance);

/* The first row of a palette, counted from the instance's own first row. */
uint32_t noh_gl_palette_row(const noh_gl_skin_binding *binding, const noh_mesh *mesh, uint32_t palette);

/* Rows of one joint of a mesh: 3 or 4. In a uniform buffer, the range to bind for a palette begins at
 * 16 * (binding.first + noh_gl_palette_row) bytes and holds NOH_PALETTE_JOINTS_MAX joints. */
uint32_t noh_gl_joint_rows(const noh_mesh *mesh);

/* Rows that transform normals: the inverse transpose of a placement's 3 x 3 part, up to a positive factor. They are its
 * cofactors times the sign of its determinant, so nothing is divided and normals of a mirrored node still point
 * outwards. Transforming normals by the matrix itself is right for rotations and uniform scales only. Returns the
 * determinant. source  Turkowski, "Properties of Surface-Normal Transformations", Graphics Gems (1990) */
float noh_gl_normal_rows(const float world[12], float rows[12]);

#ifdef __cplusplus
}
#endif

#endif
