/* gl_skin.h: the joints of skinned meshes on the GPU, for many instances at once.
 *
 *   noh_gl_skin_plan_make  where palettes go, why, and every byte they will take: before any load
 *   noh_gl_skin_init       place it in your memory and make its GL object
 *   noh_gl_skin_set_matrices        give one instance its joint matrices
 *   noh_gl_skin_set_place      give one instance its place in the world and its morph tile, for crowds
 *   noh_gl_skin_update     one upload of what changed
 *   noh_gl_skin_binding_of where a vertex shader finds an instance's palettes
 *
 * A palette is what one draw needs, in rows of four floats: three a joint, a matrix; or, in a mesh with
 * NOH_MESH_DUAL_QUATERNION, four: rotation, dual part and the stretch (rows C3.4-C3.6). Instances are
 * numbered as in a noh_gl_morph of the same meshes and counts.
 *
 *   mode     in                                for
 *   uniform  a uniform block of at most 16 KiB instances that are drawn one by one
 *   texture  RGBA32F, in rows                  crowds too: noh_gl_draw_crowd draws many in one call
 * Both are core ES 3.0, and both give the same bits. */
#ifndef NOH_GL_GL_SKIN_H
#define NOH_GL_GL_SKIN_H

#include "gl/gl_morph.h"

typedef enum noh_palette_mode {
    NOH_PALETTE_AUTO = 0, /* texture where a mesh has several instances, else uniform */
    NOH_PALETTE_UNIFORM,
    NOH_PALETTE_TEXTURE
} noh_palette_mode;

/* "auto", "uniform", "texture". */
const char *noh_palette_mode_name(noh_palette_mode mode);

typedef struct noh_gl_skin_desc {
    const noh_mesh *meshes;          /* [mesh_count]; copied, the packs must stay. Rigid ones take no palette */
    uint32_t mesh_count;
    const uint32_t *instance_counts; /* [mesh_count]; NULL: one of each. 1..NOH_MORPH_INSTANCES_MAX in all */
    noh_palette_mode mode;           /* 0: auto */
} noh_gl_skin_desc;

/* What a desc comes to on a GPU with these capabilities. All bytes are exact. */
typedef struct noh_gl_skin_plan {
    noh_palette_mode mode;  /* never AUTO */
    const char *reason;     /* why this mode, in words; a string constant */
    uint32_t instance_count;
    uint32_t texel_count;   /* rows of four floats, with what lies between palettes */
    uint32_t width, height; /* of the texture; 0 in a uniform buffer */
    uint64_t cpu_bytes;     /* the block that noh_gl_skin_init wants */
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
    uint32_t align;      /* palettes start at multiples of so many rows */
    uint32_t influences; /* draw with at most so many joints per vertex, the strongest (LOD); 0: all */
} noh_gl_skin_binding;

/* Decide and measure, without touching GL.
 * errors  ARG a desc field is out of range; UNSUPPORTED uniform blocks are too small for the forced
 *         mode; LIMIT too many instances, or palettes for more than a texture of this GPU holds */
noh_result noh_gl_skin_plan_make(const noh_gl_skin_desc *desc, const noh_gl_caps *caps, noh_gl_skin_plan *plan,
                                 noh_error *error);

/* Build in memory[bytes], which is aligned to NOH_MEMORY_ALIGN and at least plan.cpu_bytes long, and make the GL object,
 * counted in the device's ledger. All joints start as the identity: the bind pose.
 * errors  as noh_gl_skin_plan_make; ARG memory is NULL or misaligned, MEMORY it is too small (`need`: plan.cpu_bytes),
 *         nothing is then touched; GL, MEMORY the driver refused the object. On error no GL object is left */
noh_result noh_gl_skin_init(void *memory, size_t bytes, const noh_gl_device *device, const noh_gl_skin_desc *desc,
                            noh_gl_skin **skin, noh_error *error);

/* Delete the GL object. The memory is yours again. */
void noh_gl_skin_delete(noh_gl_skin *skin);

/* Make the object again in a new context (gl_lost.h); the next update sends all. errors  as init */
noh_result noh_gl_skin_restore(noh_gl_skin *skin, noh_error *error);

const noh_gl_skin_plan *noh_gl_skin_plan_of(const noh_gl_skin *skin);

/* The number of the i-th instance of the m-th mesh. */
uint32_t noh_gl_skin_instance(const noh_gl_skin *skin, uint32_t mesh, uint32_t i);

/* Set the joints of one instance; cheap where they did not move. Nothing happens to a rigid one.
 * shapes  matrices[joint_count of the mesh's skin][12]: model space of the joint * inverse bind */
void noh_gl_skin_set_matrices(noh_gl_skin *skin, uint32_t instance, const float *matrices);

/* Set where one instance stands, for noh_gl_draw_crowd.
 * shapes   world[12] rows of 3 x 4
 * morph    where its deltas are; NULL: none
 * errors   UNSUPPORTED palettes are in a uniform buffer, which draws no crowds; ARG `world` mirrors,
 *          and the triangles of one draw cannot face two ways: draw that instance alone */
noh_result noh_gl_skin_set_place(noh_gl_skin *skin, uint32_t instance, const float world[12],
                             const noh_gl_morph_binding *morph, noh_error *error);

/* Send the span of what changed since the last update, in one call. Nothing is touched when nothing
 * changed; else texture unit 0 and the uniform buffer binding are left at 0.
 * errors  none: everything was checked at init */
void noh_gl_skin_update(noh_gl_skin *skin);

/* All influences are drawn until you lower `influences`. */
noh_gl_skin_binding noh_gl_skin_binding_of(const noh_gl_skin *skin, uint32_t instance);

/* The first row of a palette, counted from the instance's own first row. */
uint32_t noh_gl_palette_row(const noh_gl_skin_binding *binding, const noh_mesh *mesh, uint32_t palette);

/* Rows of one joint of a mesh: 3 or 4. In a uniform buffer, the range to bind for a palette begins at
 * 16 * (binding.first + noh_gl_palette_row) bytes and holds NOH_PALETTE_JOINTS_MAX joints. */
uint32_t noh_gl_joint_rows(const noh_mesh *mesh);

/* Rows of the inverse transpose of a placement, up to a positive factor: the cofactors with the sign
 * of the determinant, so that a mirrored node's normals still point outwards (row E4). Returns the
 * determinant. */
float noh_gl_normal_rows(const float world[12], float rows[12]);

#endif
