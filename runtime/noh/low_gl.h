/* low_gl.h: meshes, morph targets, palettes and a plain renderer without a stage: for engines built of parts
 * (noh_low.h).
 *
 *     noh_gl_mesh_create      upload a mesh of the pack; noh_gl_picture_create uploads a texture
 *     noh_gl_morph_init       an accumulator for the morph targets of all instances
 *     noh_gl_skin_init        palettes for the skins of all instances
 *     noh_gl_renderer_create  the plain renderer; or use shaders of your own (noh_gl.h)
 *
 * In a frame, call noh_gl_morph_set_weights and noh_gl_skin_set_matrices for each instance that moved, then
 * noh_gl_morph_update and noh_gl_skin_update once, then draw. */

#ifndef NOH_LOW_GL_H
#define NOH_LOW_GL_H

#include <stdint.h>

#include "base.h"
#include "format.h"
#include "pack.h"
#include "gl_device.h"
#include "noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== GL objects ========
 * GL objects with counted bytes.
 *
 *   noh_gl_texture_bytes        bytes of a texture with its mip levels
 *   noh_gl_ledger_bytes         bytes of all existing objects
 *   noh_gl_buffer_create / noh_gl_buffer_delete
 *   noh_gl_texture_create / noh_gl_texture_delete
 *
 * Sizes are the requested sizes: OpenGL ES does not report what a driver adds for alignment or metadata. The same
 * functions plan a budget and count its use, so both agree to the byte.
 *
 * Every create clears pending GL errors first and leaves nothing bound to its target; on error it deletes what it made,
 * and the ledger is unchanged. Deleting an object twice does nothing.
 *
 * Threads: the context's own thread; any thread for the functions that only return bytes. */

#define NOH_GL_CUBE UINT32_MAX

typedef struct noh_gl_texture_desc {
    unsigned format; /* a sized internal format that noh uses, an ETC2 or ASTC format, or RG11_EAC */
    uint32_t width;  /* texels, 1..65536 */
    uint32_t height; /* texels, 1..65536 */
    uint32_t layers; /* 0: GL_TEXTURE_2D; NOH_GL_CUBE: GL_TEXTURE_CUBE_MAP with six square faces; 1..65536:
                      * GL_TEXTURE_2D_ARRAY with this many layers */
    uint32_t levels; /* mip levels, at most 1 + log2 of the longer side; 0: one */
    unsigned filter; /* for minification and magnification; 0: GL_NEAREST. GL_LINEAR with mip levels is trilinear */
    unsigned wrap;   /* 0: GL_CLAMP_TO_EDGE */
} noh_gl_texture_desc;

/* The bytes of a texture; 0 for an invalid desc. */
uint64_t noh_gl_texture_bytes(const noh_gl_texture_desc *desc);

/* Make a buffer of `bytes` bytes, filled from `data` (NULL: contents undefined). A GL_ELEMENT_ARRAY_BUFFER becomes part
 * of the bound vertex array: bind vertex array 0 first.
 * errors  ARG bytes is 0; LIMIT bytes does not fit a GLsizeiptr; MEMORY GL_OUT_OF_MEMORY (need: `bytes`); GL the driver
 *         refused the buffer */
noh_result noh_gl_buffer_create(const noh_gl_api *api, noh_gl_ledger *ledger, unsigned target, uint64_t bytes,
                                const void *data, unsigned usage, noh_gl_buffer *out, noh_error *error);
void noh_gl_buffer_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_buffer *buffer);

/* Make a texture with undefined contents. Leaves texture unit 0 active. Compare the size with the limits of noh_gl_caps
 * first: for a texture that is too large the result is only GL.
 * errors  ARG an invalid desc; MEMORY, GL as noh_gl_buffer_create */
noh_result noh_gl_texture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_gl_texture_desc *desc,
                                 noh_gl_texture *out, noh_error *error);
void noh_gl_texture_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_texture *texture);

/* ======== GL programs ========
 * Compiling and linking shaders.
 *
 *   noh_gl_program_create  compile up to three stages, link, bind samplers and blocks
 *   noh_gl_program_delete
 *
 * A source is a #version line and the rest of the text in pieces, passed to glShaderSource without copying.
 *
 * Threads: the context's own thread, for every function. */

/* The text of one shader stage. */
typedef struct noh_gl_source {
    const char *version;       /* "#version 300 es\n" */
    const char *const *pieces; /* the text after it */
    uint32_t piece_count;      /* 1..NOH_GL_PIECES_MAX */
} noh_gl_source;

typedef struct noh_gl_program_desc {
    const char *name;              /* for the debug label and the log; NULL: none */
    const noh_gl_source *vertex;   /* required */
    const noh_gl_source *geometry; /* NULL: none */
    const noh_gl_source *fragment; /* required */
    const char *version;           /* a #version line with its newline for all stages, which must be equal in ES; NULL:
                                    * the sources' own */
    const char *defines; /* whole lines directly after #version in every stage: #extension, #define; NULL: none */
    const char *geometry_defines; /* more such lines for the geometry stage only; NULL: none */

    const char *const *samplers; /* sampler i reads texture unit i; names removed by the linker are skipped */
    uint32_t sampler_count;      /* default 0 */
    const char *const *blocks;   /* uniform block i reads binding i; names removed by the linker are skipped */
    uint32_t block_count;        /* default 0 */

    const char *const *varyings; /* outputs of the vertex stage for transform feedback */
    uint32_t varying_count;      /* default 0: no transform feedback */

    /* All attributes of the vertex arrays that the program will draw. Reading an integer as a float, or a missing
     * attribute, is undefined and no GL error, so each active input is checked: it must be at one of these locations,
     * of the same kind (float, integer, unsigned), with no more components, except a vec4 whose w is then 1 */
    const noh_gl_input *inputs;
    uint32_t input_count; /* default 0: not checked */

    noh_gl_ledger *ledger; /* counts the program; NULL: not counted */
} noh_gl_program_desc;

/* Compile, link and label a program. Leaves program 0 in use; `program` is untouched on error.
 * log     [log_bytes], NULL with 0: no log. Empty on success, otherwise "NAME: STAGE: " and the driver's log, cut to
 *         fit and always zero-terminated. For the library's shaders, comments in their generated source
 *         explain its source numbers
 * memory  none
 * errors  ARG a stage is missing or has too many pieces; DATA a stage does not compile or link (`what` names it; where:
 *         the GL stage, 0: linking), or it reads an input that is not in `inputs` (where: the location); GL, MEMORY the
 *         driver refused a call */
noh_result noh_gl_program_create(const noh_gl_api *api, const noh_gl_program_desc *desc, unsigned *program, char *log,
                                 size_t log_bytes, noh_error *error);

/* Delete a program and set it to 0; does nothing for 0. ledger NULL: the program was not counted. */
void noh_gl_program_delete(const noh_gl_api *api, noh_gl_ledger *ledger, unsigned *program);

/* ======== spherical harmonics ========
 * Real spherical harmonics of order 1 to 6: functions on the sphere as 1, 4, 9, 16, 25 or 36 numbers.
 *
 *   noh_sh_basis         the basis functions in a direction
 *   noh_sh_convolve      convolution with a kernel symmetric about its axis, by band
 *   noh_sh_cosine_lobe   the kernel of irradiance
 *
 * Order n has the bands 0 to n - 1, band l has the 2 l + 1 functions m = -l to l, and coefficient (l, m) is number
 * l (l + 1) + m. The functions are orthonormal over the sphere and have no Condon-Shortley phase: band 0 is the
 * constant 0.2821, band 1 is 0.4886 times y, z, x. A zonal function has one coefficient per band, m = 0 about its axis.
 *
 * All functions use only sums, products, quotients and square roots: the same bits on every machine.
 * source   Ramamoorthi, Hanrahan: An efficient representation for irradiance environment maps, SIGGRAPH 2001; Sloan,
 *          Kautz, Snyder: Precomputed radiance transfer, SIGGRAPH 2002; Ivanic, Ruedenberg: Rotation matrices for real
 *          spherical harmonics, J. Phys. Chem. 100, 1996, with the additions and corrections of 102, 1998
 * Threads: no state; any thread. */

#define NOH_SH_COUNT(order) ((order) * (order))

/* Compute the basis functions in a direction.
 * shapes  direction[3], basis[NOH_SH_COUNT(order)]
 * ranges  order 1..NOH_SH_ORDER_MAX; direction is unit
 * errors  at most 3e-6 absolute */
void noh_sh_basis(uint32_t order, const float direction[3], float *basis);

/* Multiply band l of coefs by bands[l]. For convolution with a symmetric kernel of zonal coefficients k_l, bands[l] =
 * sqrt(4 pi / (2 l + 1)) k_l.
 * source  Funk-Hecke theorem; Ramamoorthi, Hanrahan 2001, equation 5 */
void noh_sh_convolve(uint32_t order, const float *bands, float *coefs);

/* bands[NOH_SH_ORDER_MAX] of the clamped cosine over pi: 1, 2/3, 1/4, 0, -1/24, 0. Convolving radiance with it gives
 * the light reflected by a white matte surface, by its normal. */
extern const float noh_sh_cosine_lobe[NOH_SH_ORDER_MAX];

/* ======== morph targets on the GPU ========
 * Morph targets accumulated on the GPU, for many instances at once.
 *
 *   noh_gl_morph_plan_make    choose the path and compute its exact bytes, without GL calls
 *   noh_gl_morph_init         build the accumulator in your memory and make its GL objects
 *   noh_gl_morph_delete       delete the GL objects
 *   noh_gl_morph_restore      make the GL objects again after a lost context
 *   noh_gl_morph_set_weights  set one instance's weights; costs only a comparison if they did not change
 *   noh_gl_morph_set_lod      accumulate an instance only for an LOD level
 *   noh_gl_morph_update       accumulate the instances whose weights changed
 *   noh_gl_morph_binding_of   where a vertex shader finds an instance's deltas
 *   noh_gl_morph_plan_of      the plan of an accumulator
 *   noh_gl_morph_instance     the number of an instance of a mesh
 *   noh_gl_morph_bind         bind an instance's textures for your own draw
 *   noh_gl_morph_bind_streams bind the streams for your own draw
 *   noh_morph_path_name, noh_accumulate_name
 *
 * Deltas of position, normal and tangent are accumulated in the three layers of one texture array. Without tangents
 * there are two layers, and tangents of the bind pose are turned with the normal. For meshes with a transfer
 * (light.h) the fourth component of positions accumulates the change of occlusion. Each instance has a tile with one
 * accumulation texel per vertex that any target moves. The base mesh stays in the vertex buffers, and the vertex shader
 * adds the accumulated deltas (shaders_es/common_layers.glsl), so a half-float accumulator rounds only deltas.
 * Microsoft's SparseMorphTargets sample (DirectX SDK) accumulates in the same way, but whole vertices, and only one
 * mesh.
 *
 *   path       needs                      how
 *   layered    geometry shader, blending  one additive pass into three layers
 *   mrt        ES 3.0, blending           one additive pass with three outputs
 *   per-layer  ES 3.0, blending           three additive passes
 *   gather     ES 3.0                     no blending: each fragment sums the active targets of one vertex
 *   cpu        nothing                    SIMD on the CPU; uploads the sums, or vertices (desc.vertices)
 *   streams    ES 3.0                     no accumulation: the draw adds up to four targets as vertex streams
 *   direct     ES 3.0                     no accumulation: the draw's vertex shader sums the active targets
 *
 * Two policies choose a path: `auto` takes the cheapest on this GPU for the expected targets and draws; `blend` takes
 * layered draws if supported, otherwise per-layer passes. Blending into the accumulation format needs an extension.
 * Most phones have it for float16, but not for float32 (EXT_float_blend).
 *
 * Threads: the context's own thread; any thread for noh_gl_morph_plan_make and the names. */

/* The names "auto", "layered", "mrt", "per-layer", "gather", "cpu", "blend", "streams", "direct"; and "auto", "f32",
 * "f16". */
const char *noh_morph_path_name(noh_morph_path path);
const char *noh_accumulate_name(noh_accumulate accumulate);

typedef struct noh_gl_morph_desc {
    /* [mesh_count]; copied, but the packs must stay. May contain several LOD levels of one mesh, each with its own tile
     * size, for a few near and many far instances; they share the tables of the finest one */
    const noh_mesh *meshes;
    uint32_t mesh_count;
    const uint32_t *instance_counts; /* [mesh_count]; NULL: one of each. 1..NOH_MORPH_INSTANCES_MAX in all */
    noh_morph_path path;             /* 0: the cheapest on this GPU; or the policy blend, or a path */
    noh_accumulate accumulate;       /* 0: f32 */
    float expected_active;           /* for auto: share of targets active at once, 0..1; 0: 0.5 */
    int without_tangents;            /* 1: two layers, a third less memory, if no shader reads morphed tangents */
    /* For levels loaded later: `meshes` are levels of one mesh, and only their headers are read, which must stay. Until
     * they are, this coarser level of the same mesh, possibly of another pack, is the finest that is accumulated.
     * Default (NULL) all of `meshes` is loaded */
    const noh_mesh *coarse;
    /* 1: on the path cpu, writes finished vertices to vertex buffers (deform.h) instead of sums to a texture,
     * which is faster. Draw with noh_gl_draw_mesh or noh_gl_mesh_bind, with a binding taken after the last update, and
     * a renderer with layers_uint NOH_LAYERS_VERTICES; noh_gl_draw_crowd does not support it. Shaders read the bind
     * pose from noh_a_rest. f16, transfers, UV targets and `coarse` need sums; plan.vertex_ring is then 0. Default (0)
     * sums in a texture */
    int vertices;
    const char *simd; /* name of the kernel of the path cpu (deform.h), for tests. NULL or unavailable: the fastest */
    /* With `coarse`: noh_gl_morph_plan.block_count of the finest mesh and its rows, counted on the whole mesh */
    uint32_t later_blocks, later_strips;
    uint32_t draws;     /* for auto: draws of an instance in a frame, shadow maps included; 0: 1 */
    int without_direct; /* 1: auto takes no path `direct`. A renderer draws it or paths with sums, not both */
} noh_gl_morph_desc;

typedef struct noh_gl_morph noh_gl_morph;
struct noh_gl_mesh;

/* Counts of one update. */
typedef struct noh_gl_morph_stats {
    uint32_t instances;            /* accumulated */
    uint32_t draws;                /* accumulation draws, without clears */
    uint32_t targets;              /* active targets, summed over instances */
    uint32_t rects, texels, pairs; /* rectangles and texels drawn, pairs added */
} noh_gl_morph_stats;

/* Choose the path and compute its exact bytes, without GL calls.
 * errors  ARG a desc field is out of range; UNSUPPORTED the path of the desc cannot run here (`what` names the missing
 *         capability); LIMIT the atlas or a table exceeds the texture size */
noh_result noh_gl_morph_plan_make(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, noh_gl_morph_plan *plan,
                                  noh_error *error);

/* Build an accumulator in memory[bytes], aligned to NOH_MEMORY_ALIGN and at least plan.cpu_bytes long, and make its GL
 * objects, counted in the device's ledger. All weights are initially 0. On error all GL objects made so far are
 * deleted.
 * errors  as noh_gl_morph_plan_make; ARG memory is NULL or misaligned; MEMORY memory is too small (need:
 *         plan.cpu_bytes); GL, MEMORY the driver refused an object; DATA a shader does not compile or link */
noh_result noh_gl_morph_init(void *memory, size_t bytes, const noh_gl_device *device, const noh_gl_morph_desc *desc,
                             noh_gl_morph **morph, noh_error *error);

/* Delete the GL objects. The memory may then be reused. */
void noh_gl_morph_delete(noh_gl_morph *morph);

/* Make the GL objects again in a new context (gl_device.h). Weights stay; the next noh_gl_morph_update accumulates
 * every instance. `log` as in noh_gl_program_create.
 * errors  GL, MEMORY, DATA as noh_gl_morph_init; it then has no GL objects, and restore may be called again */
noh_result noh_gl_morph_restore(noh_gl_morph *morph, char *log, size_t log_bytes, noh_error *error);

const noh_gl_morph_plan *noh_gl_morph_plan_of(const noh_gl_morph *morph);

/* The number of the i-th instance of the m-th mesh. */
uint32_t noh_gl_morph_instance(const noh_gl_morph *morph, uint32_t mesh, uint32_t i);

/* Set an instance's weights[target_count of its mesh]: any finite values, including below 0 and above 1.
 * errors  ARG a weight is not finite (where: its index); nothing is changed */
noh_result noh_gl_morph_set_weights(noh_gl_morph *morph, uint32_t instance, const float *weights, noh_error *error);

/* Accumulate an instance only for an LOD level of its mesh. Draw the instance at this level or a coarser one; while two
 * levels fade, pass the finer. The level's accumulation texels have the same bits as at level 0, except that targets
 * without a rectangle in the level do not move it. The instance's binding stays the same. A finer level is accumulated
 * by the next update; a coarser one costs nothing and takes effect when the weights next change.
 * ranges  level 0 is the full mesh; clamped to the levels of the mesh in the desc */
void noh_gl_morph_set_lod(noh_gl_morph *morph, uint32_t instance, uint32_t level);

/* Accumulate the instances with changed weights or levels. stats may be NULL.
 * state   the table in gl_device.h: bindings of units 0 to 2 are empty. No state is changed if no instance changed
 * errors  none: init checked everything */
void noh_gl_morph_update(noh_gl_morph *morph, noh_gl_morph_stats *stats);

noh_gl_morph_binding noh_gl_morph_binding_of(const noh_gl_morph *morph, uint32_t instance);

/* Bind the textures of a binding to their units: the accumulated deltas to NOH_UNIT_LAYERS; on the path direct the
 * three tables to NOH_UNIT_LAYERS, NOH_UNIT_LISTS and the next. */
void noh_gl_morph_bind(const noh_gl_api *api, const noh_gl_morph_binding *binding);

/* Point the attributes NOH_ATTRIBUTE_STREAMS and up of the bound vertex array to an instance's streams, and set the
 * uniform noh_streams of the program in use. Does nothing on other paths. The vertex array keeps the buffer: delete the
 * mesh when the accumulator is deleted.
 * u_streams  the location of noh_streams in that program: find it once, when the program is linked */
void noh_gl_morph_bind_streams(const noh_gl_api *api, int u_streams, const noh_gl_morph_binding *binding);

/* ======== palettes on the GPU ========
 * The joints of skinned meshes on the GPU, for many instances at once.
 *
 *   noh_gl_skin_plan_make     choose where palettes are stored, and compute exact bytes, without GL calls
 *   noh_gl_skin_init          build the palettes in your memory and make the GL object
 *   noh_gl_skin_delete        delete the GL object
 *   noh_gl_skin_restore       make the GL object again after a lost context
 *   noh_gl_skin_set_matrices  set one instance's joint matrices
 *   noh_gl_skin_set_place     set one instance's place in the world and its morph tile, for crowds
 *   noh_gl_skin_set_tint      set one instance's tint, for crowds
 *   noh_gl_skin_set_user      set four floats of one instance, for crowds and your own shaders
 *   noh_gl_skin_update        upload what changed
 *   noh_gl_skin_binding_of    where a vertex shader finds an instance's palettes
 *   noh_gl_skin_instance      the number of an instance of a mesh
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

typedef struct noh_gl_skin_desc {
    const noh_mesh *meshes; /* [mesh_count]; copied, but the packs must stay. Rigid meshes have no palette */
    uint32_t mesh_count;
    const uint32_t *instance_counts; /* [mesh_count]; NULL: one of each. 1..NOH_MORPH_INSTANCES_MAX in all */
    noh_palette_mode mode;           /* 0: auto */
    int user_values;                 /* 1: room for noh_gl_skin_set_user: one more row per instance, in a texture */
    int motion;                      /* 1: room for the rows of the last frame, which a stage writes; in a texture */
} noh_gl_skin_desc;

/* The resolved plan on a GPU with these capabilities. All bytes are exact. */
typedef struct noh_gl_skin_plan {
    noh_palette_mode mode; /* never AUTO */
    const char *reason;    /* why this mode was chosen; a string constant */
    uint32_t instance_count;
    uint32_t texel_count;   /* rows of four floats, including gaps between palettes */
    uint32_t width, height; /* of the texture; 0 for a uniform buffer */
    uint32_t kept_count;    /* rows of the last frame that are kept on the CPU; 0: without motion */
    uint64_t cpu_bytes;     /* the block for noh_gl_skin_init */
    uint64_t gpu_bytes;
} noh_gl_skin_plan;

typedef struct noh_gl_skin noh_gl_skin;

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

/* Make the GL object again in a new context (gl_device.h); the next noh_gl_skin_update sends everything.
 * errors  GL, MEMORY as noh_gl_skin_init; it then has no GL object, and restore may be called again */
noh_result noh_gl_skin_restore(noh_gl_skin *skin, noh_error *error);

/* The number of the i-th instance of the m-th mesh. */
uint32_t noh_gl_skin_instance(const noh_gl_skin *skin, uint32_t mesh, uint32_t i);

/* Set the joint matrices of one instance. Does nothing for a rigid mesh.
 * shapes  matrices[joint_count of the mesh's skin][12]: the joint in model space * its inverse bind matrix */
void noh_gl_skin_set_matrices(noh_gl_skin *skin, uint32_t instance, const float *matrices);

/* Set the placement of one instance, for noh_gl_draw_crowd.
 * shapes  world[12] rows of 3 x 4
 * morph   its accumulated deltas, by which skin and teeth also know how far its lips are open: again after
 *         noh_gl_morph_set_weights. NULL: no target is active
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

/* Set the wrinkles and colours of one instance's regions, for noh_gl_draw_crowd; initially 0. noh_gl_skin_set_place
 * keeps them.
 * shapes  regions of noh_wrinkles_weights, 0..1, stored in 255ths; NULL: none
 * errors  UNSUPPORTED palettes are in a uniform buffer, which cannot draw crowds; NOT_FOUND the instance's mesh has no
 *         wrinkles */
noh_result noh_gl_skin_set_wrinkles(noh_gl_skin *skin, uint32_t instance, const float *regions, noh_error *error);

/* Upload the range of rows changed since the last update, in one call.
 * state   the table in gl_device.h: the texture of unit 0, or the uniform buffer, is 0. No state is changed if no row
 *         changed
 * errors  none: init checked everything */
void noh_gl_skin_update(noh_gl_skin *skin);

/* The binding of an instance, with `influences` 0; set `influences` to draw with fewer joints per vertex. */
noh_gl_skin_binding noh_gl_skin_binding_of(const noh_gl_skin *skin, uint32_t instance);

/* ======== programs of the plain renderer ========
 * The programs of the plain renderer, one for each type of mesh.
 *
 *   noh_gl_variant_key_of   the key of a mesh with given bindings
 *   noh_gl_shader_prefix    the text between #version and a shader's own text, for a key
 *   noh_gl_shader_desc      your own shaders instead of mesh.vert and mesh.frag
 *   noh_gl_variant_create   compile a program for a key
 *   noh_gl_variant_delete
 *   noh_gl_variant_skin     bind an instance's palettes
 *
 * A key stands for a set of #defines that choose how a vertex is fetched and which pixels are drawn. The texts after
 * them, shaders_es/common_*.glsl, are the same for the library's and a game's shaders (shaders_es/README.md).
 *
 * Threads: the context's own thread; any thread for keys, noh_gl_variant_defines and noh_gl_shader_prefix. */

/* Features of a material; a variant has no cost for others. */
#define NOH_FEATURE_NORMAL_MAP 1u
#define NOH_FEATURE_SURFACE_MAP 2u /* occlusion, roughness, metallic */
#define NOH_FEATURE_EMISSIVE 4u
#define NOH_FEATURE_SKIN 8u
#define NOH_FEATURE_EYE 16u
#define NOH_FEATURE_WRINKLES 32u /* a wrinkle normal map and its three weight maps, read by vertices */
#define NOH_FEATURE_TEETH 64u
#define NOH_FEATURE_TOON 128u
#define NOH_FEATURE_WRINKLE_PIXEL 256u /* with wrinkles: pixels read a mask of regions instead of the weight maps */
#define NOH_FEATURE_SPECULAR_MAP 512u
#define NOH_FEATURE_SPECULAR_ROUGHNESS 1024u /* with a specular map: its alpha is roughness */
#define NOH_FEATURE_ALPHA 2048u              /* cut or blended: pixels are discarded by alpha */
#define NOH_FEATURE_PHONE 4096u /* the phone tier: approximations at pixels; set by the renderer, not by a material */

#define NOH_FEATURE_TOON_SHADE 8192u   /* with a toon: its shade has a texture */
#define NOH_FEATURE_MATCAP 16384u      /* with a toon */
#define NOH_FEATURE_OUTLINE 32768u     /* with a toon: the outline's hull in place of the surface */
#define NOH_FEATURE_COLORS 65536u      /* a map of regions that targets colour (noh_wrinkles.colors) */
#define NOH_FEATURE_HAIR 131072u       /* cards of hair */
#define NOH_FEATURE_TOON_MASKS 262144u /* with a toon: masks of its edge and its rim */

#define NOH_GL_DEFINES_BYTES 864u

typedef struct noh_gl_variant {
    noh_gl_variant_key key;
    uint8_t has_camera; /* 1: its program has the camera of this pass */
    unsigned program;
    int u_view_projection, u_world, u_normal, u_uv, u_morph, u_skin, u_camera, u_key, u_base_color, u_material,
        u_bounds_min, u_bounds_size, u_lod, u_blends, u_f0, u_emissive, u_maps, u_lighting, u_center, u_wrinkle_regions,
        u_wrinkle_models, u_colors, u_surface_values, u_surface_more, u_rest, u_f90, u_user, u_streams, u_before,
        u_extras;
} noh_gl_variant;

/* The key of a mesh with given bindings; set `fade`, `encode_srgb`, `two_layers`, `depth`, `cut` and `features`
 * yourself, they are 0.
 * skin   NULL: a rigid mesh, or the bind pose. Not NULL, and in a texture, for a crowd
 * crowd  1: for noh_gl_draw_crowd */
noh_gl_variant_key noh_gl_variant_key_of(const noh_mesh *mesh, const noh_gl_skin_binding *skin, int crowd,
                                         int layers_uint, noh_debug_view view);

/* Write the text between the line #version 300 es and a shader's own text: defines, precision, and the declarations of
 * attributes, uniforms and functions (shaders_es/README.md). It ends with a #line, so that a driver's messages count
 * the lines of your own text.
 * stage    GL_VERTEX_SHADER or GL_FRAGMENT_SHADER
 * text     [bytes], zero-terminated; untouched if too small; NULL with 0: only returns the size
 * returns  the bytes of the text with its zero */
size_t noh_gl_shader_prefix(noh_gl_variant_key key, unsigned stage, char *text, size_t bytes);

/* Compile a program for a key. The device's ledger may be NULL.
 * own       the shaders; NULL: the library's. Calls `made`, but not `bind`
 * varyings  [varying_count] outputs for transform feedback, interleaved; none with 0
 * errors    LIMIT more samplers than NOH_GL_OWN_SAMPLERS_MAX, or more inputs than NOH_GL_OWN_INPUTS_MAX; DATA, GL,
 *           MEMORY as noh_gl_program_create; the log then has the driver's messages, which count the lines of your text
 *           from 1 */
noh_result noh_gl_variant_create(const noh_gl_device *device, noh_gl_variant_key key, const noh_gl_shader_desc *own,
                                 const char *const *varyings, uint32_t varying_count, noh_gl_variant *out,
                                 noh_error *error);
void noh_gl_variant_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_variant *variant);

/* Bind a palette of an instance, for the submeshes that use it. The variant's program must be in use. For your own
 * program, fill a variant with `key` and `u_skin`, the location of noh_skin (-1: palettes are in a uniform block).
 * state   leaves the texture bound to NOH_UNIT_PALETTES, or the buffer's range to uniform binding 0 */
void noh_gl_variant_skin(const noh_gl_api *api, const noh_gl_variant *variant, const noh_mesh *mesh,
                         const noh_gl_skin_binding *skin, uint32_t palette);

/* Write the key as lines of #define, zero-terminated. */
void noh_gl_variant_defines(noh_gl_variant_key key, char text[NOH_GL_DEFINES_BYTES]);

/* ======== meshes and a plain renderer ========
 * Meshes on the GPU, and a plain renderer for them.
 *
 *   noh_gl_mesh_create       upload a mesh; noh_gl_mesh_delete, noh_gl_mesh_restore
 *   noh_gl_mesh_lod          the indices of an LOD level
 *   noh_gl_mesh_bind         bind its vertex array, with an instance's finished vertices; noh_gl_mesh_unbind
 *   noh_gl_picture_create    upload a texture; delete it with noh_gl_texture_delete
 *   noh_gl_renderer_create   compile the shaders of the plain renderer; _size, _delete, _restore
 *   noh_gl_draw_begin        begin drawing; noh_gl_draw_end ends it
 *   noh_gl_draw_mesh         draw one instance
 *   noh_gl_draw_crowd        draw many instances of one mesh in one call
 *   noh_gl_draw_instance     tint, wrinkles and values for your own shaders, of the next meshes
 *
 * The renderer is deliberately small: one shader in variants, one key light, and the textures of glTF materials. A
 * game's own shaders can replace it (noh_gl_renderer_desc.shaders): two texts, compiled for all types of meshes. A game
 * with its own renderer needs only noh_gl_mesh, a noh_gl_morph_binding, a noh_gl_skin_binding and noh_gl_shader_prefix.
 *
 * Threads: the context's own thread; any thread for noh_gl_mesh_lod and noh_gl_picture_bytes. */

#define NOH_PRIORITY_ANY 1000

/* Attribute locations of a noh_gl_mesh's vertex array. */
#define NOH_ATTRIBUTE_POSITION 0u   /* vec3 */
#define NOH_ATTRIBUTE_NORMAL 1u     /* ivec2, octahedral: noh_direction_of_pair in shaders_es/common_attributes.glsl */
#define NOH_ATTRIBUTE_TANGENT 2u    /* ivec2, octahedral with handedness: noh_tangent_of_pair; not in every mesh */
#define NOH_ATTRIBUTE_UV 3u         /* vec2 in 0..1, scaled by the mesh's uv_offset and uv_scale */
#define NOH_ATTRIBUTE_COLOR 4u      /* vec4 in 0..1, rgb as square roots; not in every mesh */
#define NOH_ATTRIBUTE_INFLUENCES 5u /* uint, uvec2, uvec3 or uvec4: the first words of a vertex's influences */
#define NOH_ATTRIBUTE_MORE_INFLUENCES 6u /* uvec3: the last three of seven words */
#define NOH_ATTRIBUTE_TEXEL 7u           /* uint: accumulation texel and palette; only with NOH_MESH_TEXELS */
#define NOH_ATTRIBUTE_LOBE 8u            /* ivec4: the first bytes of a transfer record; only with a transfer */
#define NOH_ATTRIBUTE_MORE_LOBE 9u       /* ivec2 or ivec4: the rest of the record */
#define NOH_ATTRIBUTE_UV_TEXEL 14u       /* int: accumulation texel of its UV; only with NOH_MESH_UV_TARGETS */
#define NOH_ATTRIBUTE_MORE_EXTRA 14u     /* ivec4, without it: extra words from the fifth on; not in every mesh */
#define NOH_ATTRIBUTE_EXTRA 15u          /* ivec4: the first four words of extra attributes; not in every mesh */
/* Locations 10 to 13 are delta texels (uvec3) on the path streams: NOH_ATTRIBUTE_STREAMS. On other paths
 * the first two are the bind pose, even if finished vertices are at NOH_ATTRIBUTE_POSITION and NOH_ATTRIBUTE_NORMAL */
#define NOH_ATTRIBUTE_REST 10u        /* vec3 */
#define NOH_ATTRIBUTE_REST_NORMAL 11u /* ivec2 */

/* Upload a mesh and all its coarser LOD levels directly from the pack. `mesh` may be any level; finer ones are not
 * uploaded. Leaves vertex array 0 bound.
 * errors  as noh_gl_buffer_create */
noh_result noh_gl_mesh_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *mesh, noh_gl_mesh *out,
                              noh_error *error);
void noh_gl_mesh_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_mesh *mesh);

/* Make a mesh's GL objects again in a new context (gl_device.h).
 * errors  GL, MEMORY as noh_gl_mesh_create; it then has no GL objects */
noh_result noh_gl_mesh_restore(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_mesh *mesh, noh_error *error);

/* Bind a mesh's vertex array for one instance, for your own renderer; noh_gl_draw_mesh does it itself. If the instance
 * has finished vertices, positions, normals and tangents point to them; noh_gl_mesh_unbind restores the pointers and
 * binds vertex array 0. Leaves array buffer 0 bound.
 * morph   NULL: the bind pose */
void noh_gl_mesh_bind(const noh_gl_api *api, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph);
void noh_gl_mesh_unbind(const noh_gl_api *api, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph);

/* The mesh at an LOD level, for drawing. Level 0 is the full mesh; clamped to the uploaded levels.
 * first  receives the byte offset of the level's indices in the index buffer; first_index of submeshes counts from
 *        there */
noh_mesh noh_gl_mesh_lod(const noh_gl_mesh *mesh, uint32_t level, size_t *first);

/* The exact GPU bytes of a pack's texture with its mip levels.
 * etc2  noh_gl_caps.etc2; 0: ETC2 and EAC blocks are decoded to 4 bytes per texel */
uint64_t noh_gl_picture_bytes(const noh_texture *texture, int etc2);

/* Upload a pack's texture with its mip levels, as sRGB or, with NOH_TEXTURE_LINEAR, as data. If the context does not
 * support ETC2 (noh_gl_api.etc2), noh_gl_api.decode decodes its blocks.
 * errors  as noh_gl_texture_create; UNSUPPORTED the texture has ETC2 blocks, the context does not support them, and
 *         noh_gl_api.decode is NULL; or it has ASTC blocks and the context does not support them (noh_gl_api.astc) */
noh_result noh_gl_picture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                 noh_gl_texture *out, noh_error *error);

/* Make a texture's GL objects again in a new context (gl_device.h).
 * errors  GL, MEMORY as noh_gl_picture_create; it then has no GL objects */
noh_result noh_gl_picture_restore(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                  noh_gl_texture *picture, noh_error *error);

/* The passes that a renderer compiles variants for. */
typedef enum noh_gl_passes {
    NOH_PASSES_COLOR = 0, /* NOH_DRAW_OPAQUE and NOH_DRAW_BLENDED */
    NOH_PASSES_ALL,
    NOH_PASSES_DEPTH /* only NOH_DRAW_DEPTH */
} noh_gl_passes;

typedef struct noh_gl_renderer_desc {
    noh_debug_view view;    /* 0: lit */
    int layers_uint;        /* as in noh_gl_morph_binding.is_uint */
    int without_tangents;   /* as in noh_gl_morph_desc */
    const noh_mesh *meshes; /* [mesh_count] to be drawn; not kept */
    uint32_t mesh_count;
    noh_palette_mode palettes; /* noh_gl_skin_plan.mode; 0: no skinning, all meshes in the bind pose */
    int crowds;                /* 1: for noh_gl_draw_crowd; needs NOH_PALETTE_TEXTURE */
    int fewer_influences;      /* 1: bindings will lower `influences` */
    int fades;                 /* 1: LOD levels will fade (noh_gl_lod): also compiles variants that discard pixels */
    int encode_srgb;           /* 1: the shader encodes to sRGB, for framebuffers that do not, such as WebGL's canvas */
    int lit;                   /* 1: shaders use the light of a stage (noh_stage_set_lighting) */
    noh_shading shading;       /* as in noh_stage_desc */
    noh_gl_passes passes;
    const noh_gl_shader_desc *shaders; /* your own shaders instead of the library's; copied, except its texts. NULL:
                                        * none */
} noh_gl_renderer_desc;

typedef struct noh_gl_camera {
    float view_projection[16]; /* column-major, clip space of GL */
    float eye[3];              /* world */
    float key[3];              /* unit vector towards the key light, world */
} noh_gl_camera;

/* Some triangles of a mesh level, in your own index buffer. */
typedef struct noh_gl_triangles {
    unsigned buffer;         /* of uint32_t, three per triangle, in the order of `numbers` */
    uint32_t first;          /* first triangle in the buffer */
    const uint32_t *numbers; /* [count] triangle numbers of the level, increasing */
    uint32_t count;
} noh_gl_triangles;

typedef struct noh_gl_renderer {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    int layers_uint, without_tangents, encode_srgb, fades, lit;
    noh_debug_view view;
    noh_gl_shader_desc shaders; /* zeros: the library's */
    noh_gl_texture white;       /* 1 x 1, for materials without a texture */
    const noh_gl_light *light;  /* of this pass; NULL if not lit */
    const noh_lighting *lighting;
    noh_gl_camera camera;                /* of this pass */
    uint8_t tint[4];                     /* of the next noh_gl_draw_mesh */
    float user[4];                       /* of the next noh_gl_draw_mesh */
    int priority;                        /* of the next draws, or NOH_PRIORITY_ANY */
    float wrinkles[NOH_WRINKLE_REGIONS]; /* of the next noh_gl_draw_mesh: of noh_wrinkle_regions, then colours */
    uint8_t wrinkle_models, smoothed;    /* NOH_WRINKLE_BY_*, 0: the material's; 255: smoothed out */
    uint8_t shading;                     /* noh_shading */
    const noh_gl_triangles *triangles;   /* of the next noh_gl_draw_mesh; NULL: all of the level */
    const struct noh_gl_before *before;  /* of the next draws, the last frame; NULL: as they are now */
    unsigned cover;       /* of the next draws: a buffer in place of the mesh's indices, as large; 0: none */
    noh_gl_raster raster; /* state restored by noh_gl_draw_end */
    uint32_t variant_count;
    noh_gl_variant *variants; /* [variant_count] in the memory passed to create */
} noh_gl_renderer;

/* The bytes of memory for the variants of a desc: a type of mesh needs 2 to 8 variants for each type of material on it,
 * and twice as many with fades or depth. 0: more than NOH_GL_VARIANTS_MAX variants, or the desc is invalid. */
size_t noh_gl_renderer_size(const noh_gl_renderer_desc *desc);

/* Compile every variant that the meshes of the desc may need; nothing is compiled later.
 * memory  [bytes] at least noh_gl_renderer_size(desc), aligned to NOH_MEMORY_ALIGN; used by the renderer until it is
 *         deleted
 * out     may be written even on error, but then owns no GL objects
 * errors  ARG crowds without palettes in a texture, unknown passes, or memory is NULL or misaligned; LIMIT the meshes
 *         need more variants than NOH_GL_VARIANTS_MAX; MEMORY memory is too small; MEMORY, GL, DATA as
 *         noh_gl_program_create and noh_gl_texture_create */
noh_result noh_gl_renderer_create(const noh_gl_device *device, const noh_gl_renderer_desc *desc, void *memory,
                                  size_t bytes, noh_gl_renderer *out, noh_error *error);
void noh_gl_renderer_delete(noh_gl_renderer *renderer);

/* Make the GL objects again in a new context (gl_device.h). `log` as in noh_gl_program_create.
 * errors  GL, MEMORY, DATA as noh_gl_renderer_create; it then has no GL objects */
noh_result noh_gl_renderer_restore(noh_gl_renderer *renderer, char *log, size_t log_bytes, noh_error *error);

/* Begin drawing with your render state (gl_device.h), and open a debug group that noh_gl_draw_end closes. Bind your
 * framebuffer and set your viewport and depth function first. The camera is copied, and set for each variant at its
 * first draw. */
void noh_gl_draw_begin(noh_gl_renderer *renderer, const noh_gl_camera *camera);

#define NOH_DRAW_OPAQUE 0
#define NOH_DRAW_BLENDED 1
/* the same depth as NOH_DRAW_OPAQUE, to the bit, without colour: for shadow maps and depth passes */
#define NOH_DRAW_DEPTH 2

/* The LOD level of a draw, and the part of its pixels to draw. Two draws fade from one level to another: the new level
 * with (0, f), the old one with (f, 1), f from noh_lod_fade. A pixel that both cover is drawn by exactly one of them,
 * so its colour and depth come from one surface. The pattern is fixed to the screen. */
typedef struct noh_gl_lod {
    uint32_t level; /* as in noh_gl_mesh_lod */
    float from, to; /* pixels where from <= noise < to, noise in [0, 1); 0 and 1: all. Other values need a renderer
                     * with `fades` */
} noh_gl_lod;

/* Draw a mesh's submeshes of one pass. Draw every mesh with NOH_DRAW_OPAQUE first, then every mesh with
 * NOH_DRAW_BLENDED. For a blended material with a texture, NOH_DRAW_OPAQUE draws the pixels with an alpha of 0.9 or
 * more, including the tint's alpha; they hide pixels behind them, so hair strands need no sorting. NOH_DRAW_DEPTH
 * fetches only positions (for alpha-cut materials also uv, colours and texture) and writes no colour. It may precede
 * the other passes with the same framebuffer, or be used alone. A mesh whose variant is not in the renderer's desc
 * asserts, and is not drawn.
 * shapes  world[12] rows of 3 x 4; pictures[textures of the pack]
 * morph   its deltas, accumulated for this LOD level or a finer one; NULL: no target is active
 * skin    its palettes; NULL: a rigid mesh, or the bind pose
 * lod     NULL: the finest uploaded level, all pixels */
void noh_gl_draw_mesh(noh_gl_renderer *renderer, const noh_gl_mesh *mesh, const float world[12],
                      const noh_gl_morph_binding *morph, const noh_gl_skin_binding *skin, const noh_gl_lod *lod,
                      const noh_gl_texture *pictures, int pass);

/* Set the values of one instance for the next noh_gl_draw_mesh calls. After noh_gl_draw_begin each is as for NULL.
 * Instances of a crowd have their own (noh_gl_skin_set_tint, _set_user, _set_wrinkles).
 * shapes  tint: sRGB and alpha, multiplied with vertex colours, except for NOH_MATERIAL_UNTINTED; alpha is used only by
 *         blended materials. NULL: white
 *         user: noh_user() of your own vertex shaders. NULL: zeros
 *         regions: wrinkles and colours, 0..1, of noh_wrinkles_weights. NULL: none */
void noh_gl_draw_instance(noh_gl_renderer *renderer, const uint8_t tint[4], const float user[4],
                          const float regions[NOH_WRINKLE_REGIONS]);

/* Draw `count` consecutive instances of one mesh, from the binding `first` on, with one draw call per submesh.
 * noh_gl_skin_set_place places the instances. Rigid meshes work too; palettes must be in a texture. Blended submeshes
 * are not sorted between instances.
 * morph   the binding of any instance, for its texture; NULL if noh_gl_skin_set_place had none */
void noh_gl_draw_crowd(noh_gl_renderer *renderer, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph,
                       const noh_gl_skin_binding *first, uint32_t count, const noh_gl_lod *lod,
                       const noh_gl_texture *pictures, int pass);

/* End drawing: unbind program, vertex array, textures and uniform buffer, and restore render state (gl_device.h). */
void noh_gl_draw_end(const noh_gl_renderer *renderer);

#ifdef __cplusplus
}
#endif

#endif
