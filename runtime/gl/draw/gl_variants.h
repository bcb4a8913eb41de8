/* gl_variants.h: the programs of the plain renderer, one for each type of mesh.
 *
 *   noh_gl_variant_key_of   the key of a mesh with given bindings
 *   noh_gl_variant_key_depth  the key that draws the same depth without colour
 *   noh_gl_variant_defines  the #defines of a key as text
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
#ifndef NOH_GL_GL_VARIANTS_H
#define NOH_GL_GL_VARIANTS_H

#include "gl/device/gl_program.h"
#include "gl/draw/gl_skin.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_debug_view {
    NOH_VIEW_LIT,
    NOH_VIEW_POSITION,
    NOH_VIEW_NORMAL,
    NOH_VIEW_TANGENT,
    NOH_VIEW_LOD,       /* facets in the colour of the LOD level: from 0, white, orange, sky blue, green, yellow, blue,
                         * vermilion, purple (the palette of Okabe and Ito, safe for colour-blind eyes, white for
                         * black) */
    NOH_VIEW_LIGHT,     /* the light on a white matte surface */
    NOH_VIEW_OCCLUSION, /* the share of environment light that reaches the surface */
    NOH_VIEW_WRINKLE    /* wrinkle weights of a pixel by model: area orange, regions blue, channels green */
} noh_debug_view;

typedef struct noh_gl_variant_key {
    uint8_t influences;      /* stored per vertex: 1, 2, 4 or 8; 0: rigid, or the bind pose */
    uint8_t drawn;           /* used of them: 1, 2, 4 or 8; 0 if influences is 0 */
    uint8_t texture;         /* 1: palettes or crowd rows are in a texture */
    uint8_t dual_quaternion; /* 1: the mesh has NOH_MESH_DUAL_QUATERNION */
    uint8_t texels;          /* 1: the mesh has NOH_MESH_TEXELS */
    uint8_t crowd;           /* 1: for noh_gl_draw_crowd */
    uint8_t layers_uint;     /* as noh_gl_morph_binding.is_uint */
    uint8_t view;            /* noh_debug_view */
    uint8_t fade;            /* 1: draws only some pixels (noh_gl_lod) */
    uint8_t encode_srgb;     /* as in noh_gl_renderer_desc */
    uint8_t depth;           /* 1: only depth (NOH_DRAW_DEPTH): positions, and the inputs of alpha if cut */
    uint8_t two_layers;      /* 1: noh_gl_morph_binding.layer_count is 2; with depth 0 */
    uint16_t features;       /* NOH_FEATURE_* of the material; with depth 0 */
    uint8_t cut;             /* with depth, 1: for alpha-cut materials. Without depth 0: all colour variants cut */
    uint8_t lit;             /* 1: lit by gl_light.h; with depth 0 */
    uint8_t transfer;        /* with lit: the order of the mesh's transfer, and NOH_TRANSFER_ON_NORMAL; 0: none */
    uint8_t uv_targets;      /* 1: the mesh has NOH_MESH_UV_TARGETS; with depth only if cut */
} noh_gl_variant_key;

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

typedef struct noh_gl_variant {
    noh_gl_variant_key key;
    uint8_t has_camera; /* 1: its program has the camera of this pass */
    unsigned program;
    int u_view_projection, u_world, u_normal, u_uv, u_morph, u_skin, u_camera, u_key, u_base_color, u_material,
        u_bounds_min, u_bounds_size, u_lod, u_blends, u_f0, u_emissive, u_maps, u_lighting, u_center, u_wrinkle_regions,
        u_wrinkle_models, u_surface_values, u_surface_more, u_rest, u_f90, u_user, u_streams;
} noh_gl_variant;

/* Texture units of mesh.vert and mesh.frag; the uniform block binding is 0. */
#define NOH_UNIT_LAYERS 0u
#define NOH_UNIT_BASE_COLOR 1u
#define NOH_UNIT_PALETTES 2u
#define NOH_UNIT_NORMAL 3u
#define NOH_UNIT_SURFACE 4u
#define NOH_UNIT_EMISSIVE 5u
#define NOH_UNIT_WRINKLE 6u
#define NOH_UNIT_WRINKLE_WEIGHTS 7u /* and the next two */
#define NOH_UNIT_SHADOW 10u
#define NOH_UNIT_ENVIRONMENT 11u
#define NOH_UNIT_SPECULAR 12u
#define NOH_UNIT_USER 13u /* the first unit for a game's own shaders */

/* NOH_FEATURE_* of a material on a mesh. Normal maps need tangents; unlit materials have no features. */
uint16_t noh_gl_features_of(const noh_mesh *mesh, const noh_material *material);

/* The key of a mesh with given bindings; set `fade`, `encode_srgb`, `two_layers`, `depth`, `cut` and `features`
 * yourself, they are 0.
 * skin   NULL: a rigid mesh, or the bind pose. Not NULL, and in a texture, for a crowd
 * crowd  1: for noh_gl_draw_crowd */
noh_gl_variant_key noh_gl_variant_key_of(const noh_mesh *mesh, const noh_gl_skin_binding *skin, int crowd,
                                         int layers_uint, noh_debug_view view);

/* The key that draws the same triangles with the same depth, to the bit, without colour.
 * cut  1: for alpha-cut materials */
noh_gl_variant_key noh_gl_variant_key_depth(noh_gl_variant_key key, int cut);

#define NOH_GL_DEFINES_BYTES 768u

/* Write the key as lines of #define, zero-terminated. */
void noh_gl_variant_defines(noh_gl_variant_key key, char text[NOH_GL_DEFINES_BYTES]);

/* Write the text between the line #version 300 es and a shader's own text: defines, precision, and the declarations of
 * attributes, uniforms and functions (shaders_es/README.md). It ends with a #line, so that a driver's messages count
 * the lines of your own text.
 * stage    GL_VERTEX_SHADER or GL_FRAGMENT_SHADER
 * text     [bytes], zero-terminated; untouched if too small; NULL with 0: only returns the size
 * returns  the bytes of the text with its zero */
size_t noh_gl_shader_prefix(noh_gl_variant_key key, unsigned stage, char *text, size_t bytes);

/* Your own shaders. The texts are bodies without #version: noh_gl_shader_prefix precedes each, so one pair serves every
 * key (shaders_es/README.md). If only one is given, the other is the library's, with the varyings of mesh.vert. All
 * zeros: the library's. The strings and arrays must stay as long as the programs exist. */
typedef struct noh_gl_shader_desc {
    const char *name;              /* for the log and debug labels; NULL: "mesh" */
    const char *vertex, *fragment; /* NULL: mesh.vert, mesh.frag */
    const char *defines;           /* whole lines after #version in both: #extension, #define; NULL: none */
    const char *const *samplers;   /* [sampler_count] sampler i reads texture unit NOH_UNIT_USER + i */
    uint32_t sampler_count;        /* 0..NOH_GL_OWN_SAMPLERS_MAX */
    /* Called before each draw, with the program in use and the library's uniforms set: set your uniforms and bind
     * textures to units from NOH_UNIT_USER on, which stay bound. Do not change program, vertex array or render state.
     * material: of the submesh. NULL: nothing to set */
    void (*bind)(void *user, const noh_gl_api *api, unsigned program, const noh_material *material);
    void *user;
    noh_debug_view view; /* shown by mesh.frag; NOH_DEBUG_VIEW in your own fragment shader. 0: lit, or the view of the
                          * renderer's desc */
    /* Your own attributes, which you set in the vertex arrays to be drawn (noh_gl_mesh.vertex_array): the vertex shader
     * may read these, at locations of your choice below GL_MAX_VERTEX_ATTRIBS, besides the attributes of meshes */
    const noh_gl_input *inputs;
    uint32_t input_count; /* 0..NOH_GL_OWN_INPUTS_MAX */
    /* Called once for each program after create, and again after restore: look up uniforms and set constant ones. The
     * program is in use; none is in use afterwards. key: the type of mesh and the pass. NULL: nothing to do */
    void (*made)(void *user, const noh_gl_api *api, unsigned program, noh_gl_variant_key key);
} noh_gl_shader_desc;

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

#ifdef __cplusplus
}
#endif

#endif
