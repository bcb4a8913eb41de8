/* gl_draw.h: meshes on the GPU, and a plain renderer for them.
 *
 *   noh_gl_mesh_create       upload a mesh; noh_gl_mesh_delete, noh_gl_mesh_restore, noh_gl_mesh_bytes
 *   noh_gl_mesh_lod          the indices of an LOD level
 *   noh_gl_mesh_bind         bind its vertex array, with an instance's finished vertices; noh_gl_mesh_unbind
 *   noh_gl_mesh_create_empty buffers for levels loaded later; noh_gl_mesh_fill fills them piece by piece
 *   noh_gl_picture_create    upload a texture; delete it with noh_gl_texture_delete (gl_memory.h)
 *   noh_gl_renderer_create   compile the shaders of the plain renderer; _size, _delete, _forget, _restore,
 *                            _variant
 *   noh_gl_draw_begin        begin drawing; noh_gl_draw_end ends it
 *   noh_gl_draw_mesh         draw one instance
 *   noh_gl_draw_crowd        draw many instances of one mesh in one call
 *   noh_gl_draw_tint         the tint of the next meshes; noh_gl_draw_wrinkles, their wrinkles; noh_gl_draw_user,
 *                            values for your own shaders; noh_gl_draw_triangles, a part of their triangles;
 *                            noh_gl_draw_priority, a part of their blended submeshes; noh_gl_next_priority
 *
 * The renderer is deliberately small: one shader in variants, one key light, and the textures of glTF materials. A
 * game's own shaders can replace it (noh_gl_renderer_desc.shaders): two texts, compiled for all types of meshes. A game
 * with its own renderer needs only noh_gl_mesh, a noh_gl_morph_binding, a noh_gl_skin_binding and noh_gl_shader_prefix.
 *
 * Threads: the context's own thread; any thread for noh_gl_mesh_bytes, noh_gl_mesh_lod and noh_gl_picture_bytes. */
#ifndef NOH_GL_GL_DRAW_H
#define NOH_GL_GL_DRAW_H

#include "core/base/limits.h"
#include "gl/draw/gl_light.h"
#include "gl/morph/gl_morph.h"
#include "gl/draw/gl_skin.h"
#include "gl/device/gl_state.h"
#include "gl/draw/gl_variants.h"

#ifdef __cplusplus
extern "C" {
#endif

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
#define NOH_ATTRIBUTE_UV_TEXEL 14u       /* uint: accumulation texel of its UV; only with NOH_MESH_UV_TARGETS */
/* Locations 10 to 13 are delta texels (uvec3) on the path streams: NOH_ATTRIBUTE_STREAMS (gl_morph.h). On other paths
 * the first two are the bind pose, even if finished vertices are at NOH_ATTRIBUTE_POSITION and NOH_ATTRIBUTE_NORMAL */
#define NOH_ATTRIBUTE_REST 10u        /* vec3 */
#define NOH_ATTRIBUTE_REST_NORMAL 11u /* ivec2 */

typedef struct noh_gl_mesh {
    noh_mesh mesh;               /* the finest uploaded LOD level */
    const noh_mesh_header *room; /* of the finest level that fits the buffers: of `mesh`, or finer */
    unsigned vertex_array;
    noh_gl_buffer positions, attributes, influences, indices; /* no influences in a rigid mesh */
    noh_gl_buffer transfer;                                   /* records; none without a transfer */
    unsigned index_type;
} noh_gl_mesh;

/* The exact GPU bytes of a mesh's buffers. `mesh` may be any LOD level: data used only by finer levels is not
 * counted. */
uint64_t noh_gl_mesh_bytes(const noh_mesh *mesh);

/* Upload a mesh and all its coarser LOD levels directly from the pack. `mesh` may be any level; finer ones are not
 * uploaded. Leaves vertex array 0 bound.
 * errors  as noh_gl_buffer_create */
noh_result noh_gl_mesh_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *mesh, noh_gl_mesh *out,
                              noh_error *error);
void noh_gl_mesh_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_mesh *mesh);

/* Make a mesh without contents, for levels loaded later. Only the headers of `room`, the finest level that may be
 * loaded, are read, and they must stay. Before drawing, fill it from `mesh`, a coarser level of the same mesh; draws
 * show no finer level. After filling a finer level, set out->mesh to it, or back again.
 * errors  as noh_gl_mesh_create */
noh_result noh_gl_mesh_create_empty(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *room,
                                    const noh_mesh *mesh, noh_gl_mesh *out, noh_error *error);

/* Upload the next piece of a mesh and all its coarser levels, possibly from another pack than `room`. Data shared by
 * levels is overwritten with equal bytes, so the mesh may be drawn meanwhile. Leaves vertex array 0 bound.
 * ranges   *at: initially 0, then as left by the previous call; *bytes: most bytes to send, at least 64 for progress;
 *          the bytes sent are subtracted
 * returns  1 once everything is uploaded */
int noh_gl_mesh_fill(const noh_gl_api *api, const noh_gl_mesh *mesh, const noh_mesh *from, uint64_t *at,
                     uint32_t *bytes);

/* Make a mesh's GL objects again in a new context (gl_lost.h).
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
 * etc2  noh_gl_caps.etc2; 0: blocks are decoded to 4 bytes per texel */
uint64_t noh_gl_picture_bytes(const noh_texture *texture, int etc2);

/* Upload a pack's texture with its mip levels, as sRGB or, with NOH_TEXTURE_LINEAR, as data. If the context does not
 * support ETC2 (noh_gl_api.etc2), noh_gl_api.decode decodes its blocks.
 * errors  as noh_gl_texture_create; UNSUPPORTED the texture has blocks, the context does not support them, and
 *         noh_gl_api.decode is NULL */
noh_result noh_gl_picture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                 noh_gl_texture *out, noh_error *error);

/* Make a texture's GL objects again in a new context (gl_lost.h).
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
    int lit;                   /* 1: shaders use the light of noh_gl_renderer_light */
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
    float wrinkles[NOH_WRINKLE_REGIONS]; /* of the next noh_gl_draw_mesh, as vectors of noh_wrinkle_regions */
    uint8_t wrinkle_models, smoothed;    /* of noh_gl_draw_wrinkle_look */
    const noh_gl_triangles *triangles;   /* of the next noh_gl_draw_mesh; NULL: all of the level */
    noh_gl_raster raster;                /* state restored by noh_gl_draw_end */
    uint32_t variant_count;
    noh_gl_variant *variants; /* [variant_count] in the memory passed to create */
} noh_gl_renderer;

#define NOH_GL_RENDERER_BYTES 4u /* the white texel */

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

/* Release the GL objects of a lost context without GL calls (gl_lost.h). They may be restored later. */
void noh_gl_renderer_forget(noh_gl_renderer *renderer);

/* Make the GL objects again in a new context (gl_lost.h). `log` as in noh_gl_program_create.
 * errors  GL, MEMORY, DATA as noh_gl_renderer_create; it then has no GL objects */
noh_result noh_gl_renderer_restore(noh_gl_renderer *renderer, char *log, size_t log_bytes, noh_error *error);

/* Find the variant of a key; encode_srgb and two_layers are taken from the renderer (0 for depth). NULL: no mesh of the
 * renderer's desc needs it. */
const noh_gl_variant *noh_gl_renderer_variant(const noh_gl_renderer *renderer, noh_gl_variant_key key);

/* Set the light of a renderer with `lit`, from the next noh_gl_draw_begin on. Both are borrowed, and read by draws. */
void noh_gl_renderer_light(noh_gl_renderer *renderer, const noh_gl_light *light, const noh_lighting *lighting);

/* Begin drawing with your render state (gl_state.h), and open a debug group that noh_gl_draw_end closes. Bind your
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
 * shapes  world[12] rows of 3 x 4; pictures[texture_count of the pack]
 * morph   its deltas, accumulated for this LOD level or a finer one; NULL: no target is active
 * skin    its palettes; NULL: a rigid mesh, or the bind pose
 * lod     NULL: the finest uploaded level, all pixels */
void noh_gl_draw_mesh(noh_gl_renderer *renderer, const noh_gl_mesh *mesh, const float world[12],
                      const noh_gl_morph_binding *morph, const noh_gl_skin_binding *skin, const noh_gl_lod *lod,
                      const noh_gl_texture *pictures, int pass);

/* Set the tint for the next noh_gl_draw_mesh calls; noh_gl_draw_begin resets it to white. Instances of a crowd have
 * their own (noh_gl_skin_set_tint).
 * shapes  tint: sRGB and alpha, multiplied with vertex colours, except for NOH_MATERIAL_UNTINTED; alpha is used only by
 *         blended materials. NULL: white */
void noh_gl_draw_tint(noh_gl_renderer *renderer, const uint8_t tint[4]);

/* Set noh_user() of your own vertex shaders, four floats, for the next noh_gl_draw_mesh calls; noh_gl_draw_begin resets
 * them to 0. Instances of a crowd have their own (noh_gl_skin_set_user). NULL: zeros */
void noh_gl_draw_user(noh_gl_renderer *renderer, const float values[4]);

#define NOH_PRIORITY_ANY 1000

/* Draw only blended submeshes with materials of this priority in the next noh_gl_draw_mesh and noh_gl_draw_crowd calls.
 * To sort the meshes of a figure, draw them once for each priority, from low to high, and within a priority from far to
 * near. NOH_PRIORITY_ANY, the state after noh_gl_draw_begin: all, from low to high, and for equal priorities in the
 * order of the pack. Opaque submeshes are always drawn. */
void noh_gl_draw_priority(noh_gl_renderer *renderer, int priority);

/* The lowest priority above `above` of a mesh's blended materials; NOH_PRIORITY_ANY: there is none. */
int noh_gl_next_priority(const noh_mesh *mesh, int above);

/* Set the triangles for the next noh_gl_draw_mesh calls; noh_gl_draw_begin resets them to all. Borrowed until then.
 * NULL: all. */
void noh_gl_draw_triangles(noh_gl_renderer *renderer, const noh_gl_triangles *triangles);

/* Set the wrinkles of regions for the next noh_gl_draw_mesh calls; noh_gl_draw_begin resets them to none. Instances of
 * a crowd have their own (noh_gl_skin_set_wrinkles).
 * shapes  regions of noh_wrinkles_weights, 0..1. NULL: none */
void noh_gl_draw_wrinkles(noh_gl_renderer *renderer, const float regions[NOH_WRINKLE_REGIONS]);

/* Set the wrinkle models for the next noh_gl_draw_mesh and noh_gl_draw_crowd calls.
 * models    NOH_WRINKLE_BY_*; 0, the state after noh_gl_draw_begin: the material's
 * smoothed  0..255: how far wrinkles are smoothed out; 255: completely */
void noh_gl_draw_wrinkle_look(noh_gl_renderer *renderer, uint32_t models, uint32_t smoothed);

/* Draw `count` consecutive instances of one mesh, from the binding `first` on, with one draw call per submesh.
 * noh_gl_skin_set_place places the instances. Rigid meshes work too; palettes must be in a texture. Blended submeshes
 * are not sorted between instances.
 * morph   the binding of any instance, for its texture; NULL if noh_gl_skin_set_place had none */
void noh_gl_draw_crowd(noh_gl_renderer *renderer, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph,
                       const noh_gl_skin_binding *first, uint32_t count, const noh_gl_lod *lod,
                       const noh_gl_texture *pictures, int pass);

/* End drawing: unbind program, vertex array, textures and uniform buffer, and restore render state (gl_state.h). */
void noh_gl_draw_end(const noh_gl_renderer *renderer);

#ifdef __cplusplus
}
#endif

#endif
