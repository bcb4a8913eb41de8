/* gl_draw.h: meshes on the GPU, and a plain renderer for them.
 *
 * The renderer is deliberately small: one shader in variants, one key light, base
 * colour textures and vertex colours. A game has its own shaders (gl_shader_text.h)
 * and needs only noh_gl_mesh, a noh_gl_morph_binding and a noh_gl_skin_binding.
 *
 * Threads: the context's own thread; noh_gl_mesh_bytes, noh_gl_mesh_lod and noh_gl_picture_bytes, any. */
#ifndef NOH_GL_GL_DRAW_H
#define NOH_GL_GL_DRAW_H

#include "base/limits.h"
#include "gl/gl_morph.h"
#include "gl/gl_skin.h"
#include "gl/gl_variants.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Attribute locations of a noh_gl_mesh's vertex array. */
#define NOH_ATTRIBUTE_POSITION 0u /* float3 */
#define NOH_ATTRIBUTE_NORMAL 1u   /* ivec2, octahedral: direction_of_pair in shaders_es/common_attributes.glsl */
#define NOH_ATTRIBUTE_TANGENT \
    2u                      /* ivec2, octahedral with handedness: tangent_of_pair; constant where the mesh has none */
#define NOH_ATTRIBUTE_UV 3u /* unorm16 x 2, to be scaled by the mesh's uv_offset and uv_scale */
#define NOH_ATTRIBUTE_COLOR 4u           /* unorm8 x 4, rgb as square roots; constant white where there are none */
#define NOH_ATTRIBUTE_INFLUENCES 5u      /* uint, uvec2, uvec3, uvec4: the first words of a vertex's influences */
#define NOH_ATTRIBUTE_MORE_INFLUENCES 6u /* uvec3: the last three of seven */
#define NOH_ATTRIBUTE_TEXEL 7u           /* uint: morph texel and palette, with NOH_MESH_TEXELS */

typedef struct noh_gl_mesh {
    noh_mesh mesh; /* at the finest LOD level that was uploaded */
    GLuint vertex_array;
    noh_gl_buffer positions, attributes, influences, indices; /* no influences in a rigid mesh */
    GLenum index_type;
} noh_gl_mesh;

/* GPU bytes of a mesh's buffers, exact. `mesh` may be any LOD level: what only finer ones have is not counted. */
uint64_t noh_gl_mesh_bytes(const noh_mesh *mesh);

/* Upload a mesh and all its coarser LOD levels straight from the pack. `mesh` may be any level; finer ones are not
 * uploaded. errors  as noh_gl_buffer_create */
noh_result noh_gl_mesh_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *mesh, noh_gl_mesh *out,
                              noh_error *error);
void noh_gl_mesh_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_mesh *mesh);

/* Make it again in a new context (gl_lost.h). errors  as create; it then holds nothing */
noh_result noh_gl_mesh_restore(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_mesh *mesh, noh_error *error);

/* The view that a draw of an LOD level uses. level 0 is the full mesh; it is clamped to the levels that were uploaded.
 * first  byte offset of its indices in the index buffer; a submesh's first_index counts from there */
noh_mesh noh_gl_mesh_lod(const noh_gl_mesh *mesh, uint32_t level, size_t *first);

/* GPU bytes of a pack's texture with its mip levels: exact. */
uint64_t noh_gl_picture_bytes(const noh_texture *texture);

/* An sRGB texture with mip levels. errors  as noh_gl_texture_create */
noh_result noh_gl_picture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                 noh_gl_texture *out, noh_error *error);

/* Make it again in a new context (gl_lost.h). errors  as create; it then holds nothing */
noh_result noh_gl_picture_restore(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                  noh_gl_texture *picture, noh_error *error);

typedef struct noh_gl_renderer_desc {
    noh_debug_view view;
    int layers_uint;        /* as in noh_gl_morph_binding.is_uint */
    const noh_mesh *meshes; /* [mesh_count] that will be drawn; not kept */
    uint32_t mesh_count;
    noh_palette_mode palettes; /* noh_gl_skin_plan.mode; 0: nothing is skinned, all meshes are in their bind pose */
    int crowds;                /* noh_gl_draw_crowd will be called: wants NOH_PALETTE_TEXTURE */
    int fewer_influences;      /* bindings will lower `influences` */
    int fades;                 /* draws will fade (noh_gl_lod): variants that discard pixels beside those that do not */
    int encode_srgb; /* the shader encodes: for a target that is not sRGB, as WebGL's canvas. 0: the target does */
} noh_gl_renderer_desc;

typedef struct noh_gl_renderer {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    int layers_uint, encode_srgb, fades;
    noh_debug_view view;
    noh_gl_texture white; /* 1 x 1, where a material has no texture */
    uint32_t variant_count;
    noh_gl_variant variants[NOH_GL_VARIANTS_MAX];
} noh_gl_renderer;

#define NOH_GL_RENDERER_BYTES 4u /* the white texel */

/* Compile every variant that the meshes of the desc can be drawn by: nothing is compiled later.
 * memory  writes *out at once; on error it holds nothing
 * errors  ARG crowds without a texture for palettes; LIMIT the meshes need more variants than
 *         NOH_GL_VARIANTS_MAX; MEMORY, GL, DATA as noh_gl_program_create and noh_gl_texture_create */
noh_result noh_gl_renderer_create(const noh_gl_device *device, const noh_gl_renderer_desc *desc, noh_gl_renderer *out,
                                  noh_error *error);
void noh_gl_renderer_delete(noh_gl_renderer *renderer);

/* Make it again in a new context (gl_lost.h). errors  as create; it then holds nothing */
noh_result noh_gl_renderer_restore(noh_gl_renderer *renderer, char *log, size_t log_bytes, noh_error *error);

/* The variant of that key; the key's encode_srgb is taken from the renderer. NULL where the renderer's desc had no mesh
 * that needs it. */
const noh_gl_variant *noh_gl_renderer_variant(const noh_gl_renderer *renderer, noh_gl_variant_key key);

typedef struct noh_gl_camera {
    float view_projection[16]; /* column-major, clip space of GL */
    float eye[3];              /* world */
    float key[3];              /* unit vector towards the key light, world */
} noh_gl_camera;

/* Depth test on, blending set up, the camera in every variant, a debug group open until noh_gl_draw_end; the
 * framebuffer and viewport are the caller's. */
void noh_gl_draw_begin(const noh_gl_renderer *renderer, const noh_gl_camera *camera);

#define NOH_DRAW_OPAQUE 0
#define NOH_DRAW_BLENDED 1

/* The LOD level of a draw, and which of its pixels are drawn. A change of level is faded by two draws, the new level
 * with (0, f) and the old one with (f, 1), f as in noh_lod_fade: a pixel that both cover is drawn by exactly one of
 * them, so colour and depth are those of one surface. The pattern is fixed to the screen. */
typedef struct noh_gl_lod {
    uint32_t level; /* as noh_gl_mesh_lod takes it; influences are the skin binding's, joints those of its matrices */
    float from, to; /* pixels are drawn where from <= noise < to, noise in [0, 1); 0 and 1: all. Other values want a
                     * renderer with `fades` */
} noh_gl_lod;

/* Draw a mesh's submeshes of one pass: draw every mesh opaque, then every mesh blended. A mesh that needs a variant
 * which was not in the renderer's desc is not drawn (and asserts). shapes  world[12] rows of 3 x 4; pictures[pack
 * texture_count] morph   where the deltas are, accumulated for this level or a finer one; NULL: the rest pose skin
 * where the joints are; NULL: rigid, or the bind pose detail  NULL: the finest level that is there, all pixels */
void noh_gl_draw_mesh(const noh_gl_renderer *renderer, const noh_gl_mesh *mesh, const float world[12],
                      const noh_gl_morph_binding *morph, const noh_gl_skin_binding *skin, const noh_gl_lod *lod,
                      const noh_gl_texture *pictures, int pass);

/* The same for `count` instances of one mesh, beginning with that of the binding `first`: one draw per submesh for all.
 * Each stands where noh_gl_skin_set_place put it; rigid meshes work too. morph: any instance's binding. Blended
 * submeshes of a crowd are not sorted. Palettes must be in a texture. */
void noh_gl_draw_crowd(const noh_gl_renderer *renderer, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph,
                       const noh_gl_skin_binding *first, uint32_t count, const noh_gl_lod *lod,
                       const noh_gl_texture *pictures, int pass);

/* Unbind program, vertex array, textures and uniform buffer; depth test, culling and blending are then off. */
void noh_gl_draw_end(const noh_gl_renderer *renderer);

#ifdef __cplusplus
}
#endif

#endif
