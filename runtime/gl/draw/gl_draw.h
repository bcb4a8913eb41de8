/* gl_draw.h: meshes on the GPU, and a plain renderer for them.
 *
 *   noh_gl_mesh_create       upload a mesh; noh_gl_mesh_delete, noh_gl_mesh_restore, noh_gl_mesh_bytes
 *   noh_gl_mesh_lod          which indices an LOD level draws
 *   noh_gl_mesh_bind         its vertex array, with an instance's finished vertices; noh_gl_mesh_unbind
 *   noh_gl_mesh_create_empty buffers for levels that come later; noh_gl_mesh_fill fills them piece by piece
 *   noh_gl_picture_create    upload a texture; delete it by noh_gl_texture_delete (gl_memory.h)
 *   noh_gl_renderer_create   compile the shaders of the plain renderer; _size, _delete, _forget, _restore,
 *                            _variant
 *   noh_gl_draw_begin        begin to draw; noh_gl_draw_end ends it
 *   noh_gl_draw_mesh         draw one instance
 *   noh_gl_draw_crowd        draw many instances of one mesh in one call
 *   noh_gl_draw_tint         the tint of what noh_gl_draw_mesh draws next; noh_gl_draw_wrinkles, its wrinkles;
 *                            noh_gl_draw_user, values for shaders of your own; noh_gl_draw_triangles, which
 *                            triangles of it; noh_gl_draw_priority, which of what blends; noh_gl_next_priority
 *
 * The renderer is deliberately small: one shader in variants, one key light, and the
 * textures of glTF's materials.
 * A game's own shaders take its place (noh_gl_renderer_desc.shaders): two texts, compiled for whatever kinds of meshes
 * there are. A game with its own renderer needs only noh_gl_mesh, a noh_gl_morph_binding, a noh_gl_skin_binding and
 * noh_gl_shader_prefix.
 *
 * Threads: the context's own thread; noh_gl_mesh_bytes, noh_gl_mesh_lod and noh_gl_picture_bytes, any. */
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
#define NOH_ATTRIBUTE_UV 3u         /* vec2 in 0..1, to be scaled by the mesh's uv_offset and uv_scale */
#define NOH_ATTRIBUTE_COLOR 4u      /* vec4 in 0..1, rgb as square roots; not in every mesh */
#define NOH_ATTRIBUTE_INFLUENCES 5u /* uint, uvec2, uvec3 or uvec4: the first words of a vertex's influences */
#define NOH_ATTRIBUTE_MORE_INFLUENCES 6u /* uvec3: the last three of seven words */
#define NOH_ATTRIBUTE_TEXEL 7u           /* uint: accumulation texel and palette; only with NOH_MESH_TEXELS */
#define NOH_ATTRIBUTE_LOBE 8u            /* ivec4: the first bytes of a transfer's record; only with a transfer */
#define NOH_ATTRIBUTE_MORE_LOBE 9u       /* ivec2 or ivec4: the rest of it */
#define NOH_ATTRIBUTE_UV_TEXEL 14u       /* uint: accumulation texel of its UV; only with NOH_MESH_UV_TARGETS */
/* NOH_ATTRIBUTE_STREAMS and three more (gl_morph.h): uvec3: delta texels; only on the path streams. On others, the first
 * two are those of the bind pose, whatever is at NOH_ATTRIBUTE_POSITION and NOH_ATTRIBUTE_NORMAL: */
#define NOH_ATTRIBUTE_REST 10u        /* vec3 */
#define NOH_ATTRIBUTE_REST_NORMAL 11u /* ivec2 */

typedef struct noh_gl_mesh {
    noh_mesh mesh; /* the finest LOD level that was uploaded */
    const noh_mesh_header
        *room; /* of the finest level that the buffers have room for: that of `mesh`, or a finer one */
    unsigned vertex_array;
    noh_gl_buffer positions, attributes, influences, indices; /* no influences in a rigid mesh */
    noh_gl_buffer transfer;                                   /* records; none without a transfer */
    unsigned index_type;
} noh_gl_mesh;

/* The exact GPU bytes of a mesh's buffers. `mesh` may be any LOD level: what only finer levels use is not counted. */
uint64_t noh_gl_mesh_bytes(const noh_mesh *mesh);

/* Upload a mesh and all its coarser LOD levels straight from the pack. `mesh` may be any level; finer ones are not
 * uploaded. Leaves vertex array 0 bound.
 * errors  as noh_gl_buffer_create */
noh_result noh_gl_mesh_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *mesh, noh_gl_mesh *out,
                              noh_error *error);
void noh_gl_mesh_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_mesh *mesh);

/* The same without contents, for a mesh whose finer levels come later. Of `room`, at the finest level that may come,
 * only headers are read, and they must stay. Fill it from `mesh`, a coarser level of the same mesh, before it is drawn:
 * draws show no finer level. Where a finer one was filled, set out->mesh to it, or back again.
 * errors  as noh_gl_mesh_create */
noh_result noh_gl_mesh_create_empty(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *room,
                                    const noh_mesh *mesh, noh_gl_mesh *out, noh_error *error);

/* Upload the next piece of a mesh and all its coarser levels, which may lie in another pack than `room`. What levels
 * share is written with the bytes that are there already, so that it may be drawn meanwhile. Leaves vertex array 0
 * bound.
 * ranges   *at: 0 at first, then as the call before left it; *bytes: at most so many, at least 64 for any progress;
 *          what was sent is subtracted
 * returns  1 once all is there */
int noh_gl_mesh_fill(const noh_gl_api *api, const noh_gl_mesh *mesh, const noh_mesh *from, uint64_t *at,
                     uint32_t *bytes);

/* Make the GL objects of noh_gl_mesh_create again in a new context (gl_lost.h).
 * errors  GL, MEMORY as noh_gl_mesh_create: it then has no GL objects */
noh_result noh_gl_mesh_restore(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_mesh *mesh, noh_error *error);

/* Bind a mesh's vertex array for one instance, for a renderer of your own: noh_gl_draw_mesh does it by itself. Where the
 * instance has finished vertices, positions, normals and tangents are pointed to them; noh_gl_mesh_unbind points them
 * back and binds vertex array 0. Leaves array buffer 0 bound.
 * morph   NULL: the bind pose */
void noh_gl_mesh_bind(const noh_gl_api *api, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph);
void noh_gl_mesh_unbind(const noh_gl_api *api, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph);

/* The mesh as a draw of an LOD level sees it. Level 0 is the full mesh; clamped to the levels that were uploaded.
 * first  byte offset of the level's indices in the index buffer; a submesh's first_index counts from there */
noh_mesh noh_gl_mesh_lod(const noh_gl_mesh *mesh, uint32_t level, size_t *first);

/* The exact GPU bytes of a pack's texture with its mip levels.
 * etc2  of noh_gl_caps: 0: blocks are decoded, to 4 bytes a texel */
uint64_t noh_gl_picture_bytes(const noh_texture *texture, int etc2);

/* Upload a pack's texture with its mip levels, as sRGB or, with NOH_TEXTURE_LINEAR, as data. Where the context does not
 * read ETC2 (noh_gl_api.etc2), noh_gl_api.decode decodes its blocks.
 * errors  as noh_gl_texture_create; UNSUPPORTED the texture has blocks, the context does not read them, and
 *         noh_gl_api.decode is NULL */
noh_result noh_gl_picture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                 noh_gl_texture *out, noh_error *error);

/* Make its GL objects again in a new context (gl_lost.h).
 * errors  GL, MEMORY as noh_gl_picture_create: it then has no GL objects */
noh_result noh_gl_picture_restore(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                  noh_gl_texture *picture, noh_error *error);

/* The passes that a renderer compiles variants for. */
typedef enum noh_gl_passes {
    NOH_PASSES_COLOR = 0, /* NOH_DRAW_OPAQUE and NOH_DRAW_BLENDED */
    NOH_PASSES_ALL,
    NOH_PASSES_DEPTH /* NOH_DRAW_DEPTH alone */
} noh_gl_passes;

typedef struct noh_gl_renderer_desc {
    noh_debug_view view;    /* 0: lit */
    int layers_uint;        /* as in noh_gl_morph_binding.is_uint */
    int without_tangents;   /* as in noh_gl_morph_desc */
    const noh_mesh *meshes; /* [mesh_count] that will be drawn; not kept */
    uint32_t mesh_count;
    noh_palette_mode palettes; /* noh_gl_skin_plan.mode; 0: nothing is skinned, all meshes are in their bind pose */
    int crowds;                /* noh_gl_draw_crowd will be called; needs NOH_PALETTE_TEXTURE */
    int fewer_influences;      /* bindings will lower `influences` */
    int fades;                 /* LOD levels will fade (noh_gl_lod): also compile variants that discard pixels */
    int encode_srgb;           /* the shader encodes to sRGB, for targets that do not, such as WebGL's canvas */
    int lit;                   /* shaders are lit by noh_gl_renderer_light */
    noh_gl_passes passes;
    const noh_gl_shader_desc *shaders; /* your own in place of the library's; copied, without its texts. NULL: none */
} noh_gl_renderer_desc;

typedef struct noh_gl_camera {
    float view_projection[16]; /* column-major, clip space of GL */
    float eye[3];              /* world */
    float key[3];              /* unit vector towards the key light, world */
} noh_gl_camera;

/* Some triangles of a mesh's level, in an index buffer of your own. */
typedef struct noh_gl_triangles {
    unsigned buffer;         /* of uint32_t, three for each triangle, in the order of `numbers` */
    uint32_t first;          /* triangle of the buffer */
    const uint32_t *numbers; /* [count] rising: of the level */
    uint32_t count;
} noh_gl_triangles;

typedef struct noh_gl_renderer {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    int layers_uint, without_tangents, encode_srgb, fades, lit;
    noh_debug_view view;
    noh_gl_shader_desc shaders; /* zeros: the library's */
    noh_gl_texture white;       /* 1 x 1, for materials without a texture */
    const noh_gl_light *light;  /* of this pass; NULL where it is not lit */
    const noh_lighting *lighting;
    noh_gl_camera camera;                /* of this pass */
    uint8_t tint[4];                     /* of the next noh_gl_draw_mesh */
    float user[4];                       /* likewise */
    int priority;                        /* likewise, or NOH_PRIORITY_ANY */
    float wrinkles[NOH_WRINKLE_REGIONS]; /* likewise, as vectors of noh_wrinkle_regions */
    uint8_t wrinkle_models, smoothed;    /* of noh_gl_draw_wrinkle_look */
    const noh_gl_triangles *triangles;   /* of the next noh_gl_draw_mesh; NULL: all of the level */
    noh_gl_raster raster;                /* what noh_gl_draw_end puts back */
    uint32_t variant_count;
    noh_gl_variant *variants; /* [variant_count] in the memory that create was given */
} noh_gl_renderer;

#define NOH_GL_RENDERER_BYTES 4u /* the white texel */

/* The bytes of memory for the variants of a desc: a kind of mesh needs 2 to 8 for each kind of material on it, and with
 * fades or depth twice that. 0: they are more than NOH_GL_VARIANTS_MAX, or the desc is one that create refuses. */
size_t noh_gl_renderer_size(const noh_gl_renderer_desc *desc);

/* Compile every variant that the meshes of the desc may need: nothing is compiled later.
 * memory  [bytes] at least noh_gl_renderer_size(desc), aligned to NOH_MEMORY_ALIGN; it stays with the renderer
 * out     may be written even on error, but then owns no GL object
 * errors  ARG crowds without palettes in a texture, unknown passes, or memory is NULL or misaligned; LIMIT the meshes
 *         need more variants than NOH_GL_VARIANTS_MAX; MEMORY it is too small; MEMORY, GL, DATA as
 *         noh_gl_program_create and noh_gl_texture_create */
noh_result noh_gl_renderer_create(const noh_gl_device *device, const noh_gl_renderer_desc *desc, void *memory,
                                  size_t bytes, noh_gl_renderer *out, noh_error *error);
void noh_gl_renderer_delete(noh_gl_renderer *renderer);

/* The same where the context was lost (gl_lost.h): no GL is called. It may be restored later. */
void noh_gl_renderer_forget(noh_gl_renderer *renderer);

/* Make its GL objects again in a new context (gl_lost.h). `log` as in noh_gl_program_create.
 * errors  GL, MEMORY, DATA as noh_gl_renderer_create: it then has no GL objects */
noh_result noh_gl_renderer_restore(noh_gl_renderer *renderer, char *log, size_t log_bytes, noh_error *error);

/* The variant of a key, whose encode_srgb and two_layers are taken from the renderer, 0 for depth. NULL: no mesh of the
 * renderer's desc needs it. */
const noh_gl_variant *noh_gl_renderer_variant(const noh_gl_renderer *renderer, noh_gl_variant_key key);

/* Light what a renderer with `lit` draws from the next noh_gl_draw_begin on. Both are borrowed, and read at draws. */
void noh_gl_renderer_light(noh_gl_renderer *renderer, const noh_gl_light *light, const noh_lighting *lighting);

/* Begin to draw with render state of yours (gl_state.h), and open a debug group that noh_gl_draw_end closes. Bind your
 * framebuffer, and set your viewport and depth function before. The camera is copied; each variant is given it when it
 * is first drawn with. */
void noh_gl_draw_begin(noh_gl_renderer *renderer, const noh_gl_camera *camera);

#define NOH_DRAW_OPAQUE 0
#define NOH_DRAW_BLENDED 1
/* the depth of what NOH_DRAW_OPAQUE draws, to the bit, and no colour: shadow maps, depth first */
#define NOH_DRAW_DEPTH 2

/* The LOD level of a draw, and which of its pixels are drawn. Two draws fade from one level to another: the new level
 * with (0, f), the old one with (f, 1), f from noh_lod_fade. A pixel that both cover is drawn by exactly one of them,
 * so its colour and depth are those of one surface. The pattern is fixed to the screen. */
typedef struct noh_gl_lod {
    uint32_t level; /* as in noh_gl_mesh_lod */
    float from, to; /* pixels where from <= noise < to, noise in [0, 1); 0 and 1: all. Other values need a renderer
                     * with `fades` */
} noh_gl_lod;

/* Draw a mesh's submeshes of one pass: first every mesh with NOH_DRAW_OPAQUE, then every mesh with NOH_DRAW_BLENDED.
 * Of a material that blends and has a texture, NOH_DRAW_OPAQUE draws the pixels with an alpha of 0.9 or more, which
 * then hide what is behind them; so strands of hair are in order from all sides without being sorted. A tint's alpha
 * counts in that. NOH_DRAW_DEPTH fetches positions alone (for alpha-cut materials uv, colours and texture, too) and
 * writes no colour. It may come before the others, with the same framebuffer, or stand alone. A mesh whose variant the
 * renderer's desc did not ask for asserts, and is not drawn.
 * shapes  world[12] rows of 3 x 4; pictures[texture_count of the pack]
 * morph   where its deltas are, accumulated for this LOD level or a finer one; NULL: no target is active
 * skin    where its palettes are; NULL: a rigid mesh, or the bind pose
 * lod     NULL: the finest level that was uploaded, all pixels */
void noh_gl_draw_mesh(noh_gl_renderer *renderer, const noh_gl_mesh *mesh, const float world[12],
                      const noh_gl_morph_binding *morph, const noh_gl_skin_binding *skin, const noh_gl_lod *lod,
                      const noh_gl_texture *pictures, int pass);

/* The tint of the meshes that noh_gl_draw_mesh draws next; noh_gl_draw_begin makes it white. Instances of a crowd have
 * their own (noh_gl_skin_set_tint).
 * shapes  tint: sRGB and alpha, by which the colour of vertices is multiplied, but for NOH_MATERIAL_UNTINTED; alpha
 *         counts where the material blends.
 *         NULL: white */
void noh_gl_draw_tint(noh_gl_renderer *renderer, const uint8_t tint[4]);

/* Four floats for the meshes that noh_gl_draw_mesh draws next, which are noh_user() in vertex shaders of your own;
 * noh_gl_draw_begin makes them 0. Instances of a crowd have their own (noh_gl_skin_set_user). NULL: zeros */
void noh_gl_draw_user(noh_gl_renderer *renderer, const float values[4]);

/* Which blended submeshes noh_gl_draw_mesh and noh_gl_draw_crowd draw next: those of materials of this priority. A
 * renderer of your own that sorts the meshes of a figure draws them once for each priority, from low to high, and
 * within one from far to near. NOH_PRIORITY_ANY, as after noh_gl_draw_begin: all, from low to high, and in the order of
 * the pack where they are alike. Opaque ones are drawn in any case */
#define NOH_PRIORITY_ANY 1000
void noh_gl_draw_priority(noh_gl_renderer *renderer, int priority);

/* The lowest priority of a mesh's blended materials that is above `above`; NOH_PRIORITY_ANY: there is none. */
int noh_gl_next_priority(const noh_mesh *mesh, int above);

/* Which triangles noh_gl_draw_mesh draws next; noh_gl_draw_begin makes it all. Borrowed until then. NULL: all. */
void noh_gl_draw_triangles(noh_gl_renderer *renderer, const noh_gl_triangles *triangles);

/* How much the regions of the meshes are wrinkled that noh_gl_draw_mesh draws next; noh_gl_draw_begin smooths them out.
 * Instances of a crowd have their own (noh_gl_skin_set_wrinkles).
 * shapes  regions of noh_wrinkles_weights, 0..1. NULL: none */
void noh_gl_draw_wrinkles(noh_gl_renderer *renderer, const float regions[NOH_WRINKLE_REGIONS]);

/* Which wrinkles show in what noh_gl_draw_mesh and noh_gl_draw_crowd draw next.
 * models    NOH_WRINKLE_BY_*: in place of those of the material; 0: those of the material, as after noh_gl_draw_begin
 * smoothed  0..255: how far wrinkles are smoothed out; 255: nothing is left of them */
void noh_gl_draw_wrinkle_look(noh_gl_renderer *renderer, uint32_t models, uint32_t smoothed);

/* The same for `count` successive instances of one mesh, the first of them with the binding `first`: one draw call per
 * submesh. Each instance stands where noh_gl_skin_set_place put it. Rigid meshes work too; palettes must be in a
 * texture. The instances' blended submeshes are not sorted.
 * morph   the binding of any instance, for its texture; NULL: noh_gl_skin_set_place was given none */
void noh_gl_draw_crowd(noh_gl_renderer *renderer, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph,
                       const noh_gl_skin_binding *first, uint32_t count, const noh_gl_lod *lod,
                       const noh_gl_texture *pictures, int pass);

/* End what noh_gl_draw_begin began: unbind program, vertex array, textures and uniform buffer, and put render state
 * back (gl_state.h). */
void noh_gl_draw_end(const noh_gl_renderer *renderer);

#ifdef __cplusplus
}
#endif

#endif
