/* noh_gl.h: a stage drawn with OpenGL ES 3.x.
 *
 * noh creates no context and links no GL. It includes no GL header and defines no GL name: include the header or loader
 * that you use, before or after this one. Make a context current, then:
 *
 *     noh_gl_api_load     fill a table of GL functions through your lookup (such as eglGetProcAddress)
 *     noh_gl_caps_probe   find out what this GPU can do
 *     noh_stage_init      with noh_stage_desc.gpu = &noh_stage_on_gl
 *     noh_stage_draw      in each frame, after noh_stage_frame
 *
 * Memory. As in noh.h: you bring it, and noh_stage_plan_make gives the exact bytes on the CPU and on the GPU without
 * touching GL. GL objects are made at init and never grow; a ledger counts them.
 *
 * Errors. When the driver refuses a call, the create or init that made it fails with NOH_ERR_GL, or with NOH_ERR_MEMORY
 * where the GPU is out of memory. `where` is then the GL error code, and no object is left behind.
 *
 * State. Render state is yours: noh reads it and restores it. Bindings that noh used are left at 0. gl_device.h has
 * the table.
 *
 * Threads. All calls are made on the thread of the context that the objects were made in.
 *
 * Lost context. The _restore functions make the same objects again from the pack (gl_device.h). */

#ifndef NOH_GL_H
#define NOH_GL_H

#include <stdint.h>

#include "base.h"
#include "format.h"
#include "pack.h"
#include "body.h"
#include "noh.h"
#include "modules.h"
#include "marks.h"
#include "gl_device.h"
#include "light.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== light on the GPU ========
 * Light for the plain renderer: environment light and reflections, one key light with a shadow map,
 * exposure, a tone map.
 *
 *   noh_lighting_make       shader lighting from any light: the key light and the rest
 *   noh_lighting_shadow     set the view of the shadow map
 *   noh_gl_light_upload     upload a changed reflection
 *
 * A renderer with noh_gl_renderer_desc.lit uses it (shaders_es/common_light.glsl): diffuse light by spherical harmonics
 * of order 3, specular light from the cube map by roughness with the split sum, the key light with the shadow map.
 * Occlusion dims both. A renderer without `lit` has its own light and needs none of this.
 *
 * Threads: the context's own thread; any thread for noh_lighting_*. */

typedef enum noh_tonemap {
    NOH_TONEMAP_NONE,   /* radiance 1 is white; brighter values are clamped */
    NOH_TONEMAP_FILMIC, /* a curve with a shoulder: K. Narkowicz, ACES filmic tone mapping curve, 2015 */
    NOH_TONEMAP_NEUTRAL /* keeps hue and most colours as they are: Khronos PBR Neutral Tone Mapper, 2024 */
} noh_tonemap;

/* Lighting values. Plain data: change any field between draws. */
typedef struct noh_lighting {
    noh_light rest;         /* world space, without the key light */
    float key_direction[3]; /* unit, towards it, world; toons take it without a key, too */
    float key[3];           /* its light reflected by a white matte surface facing it; zeros: none */
    float key_gloss; /* its share of highlights: 0 if the reflection already contains it, 1 for a lamp of yours */
    float turn[9];   /* rows: world to the reflection's space */
    float exposure;  /* factor before the tone map; for faces: noh_light_exposure */
    noh_tonemap tonemap;
    float shadow[16];   /* world to the shadow map's clip space, column-major */
    float shadow_texel; /* size of a shadow texel, world; 0: no shadow */
    float floor;        /* world height of a level floor that takes the shadow (noh_stage_floor) */
    int has_floor;      /* 0: none. Set both before noh_stage_draw_shadow */
} noh_lighting;

/* Split light, rotated by `rotation`, into a key light and the rest, with no shadow, exposure 1 and no tone map.
 * shapes  rotation[9] 3 rows of 3, orthonormal with determinant 1; NULL: not rotated
 * ranges  light's order at least 2
 * key     0: all light stays in `rest`, and nothing casts shadows */
void noh_lighting_make(const noh_light *light, const float rotation[9], int key, noh_lighting *out);

/* Enable shadows of the key light.
 * shapes  view_projection[16]: the parallel view that the shadow map was drawn with (noh_view_shadow)
 * ranges  radius: of the view, above 0; shadow_px as in noh_gl_light_desc, not 0 */
void noh_lighting_shadow(noh_lighting *lighting, const float view_projection[16], float radius, uint32_t shadow_px);

typedef struct noh_gl_light_desc {
    const noh_reflection *reflection; /* required; must stay, with its texels, as long as the light */
    uint32_t shadow_px;               /* side of the shadow map, even; 0: none */
} noh_gl_light_desc;

typedef struct noh_gl_light {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    noh_gl_light_desc desc;
    int is_soft; /* 1: noh_gl_caps.render_f16, so shadows are soft: shaders read `moments`; 0: they read `depth` */
    noh_gl_texture cube, depth;   /* GL_RGB9_E5; GL_DEPTH_COMPONENT16 of casters, one texel without shadows */
    noh_gl_texture rows, moments; /* to blur, blurred: GL_RG16F of a quarter, half the side; none if not soft */
    unsigned framebuffer, soft_framebuffer, blur, vertex_array; /* 0 without shadows */
    int u_blur;
    noh_gl_offscreen kept; /* state restored after the shadow map */
} noh_gl_light;

/* Upload the reflection's texels again, after noh_reflection_init in the same memory with the same side.
 * errors  GL the driver refused the upload */
noh_result noh_gl_light_upload(const noh_gl_light *light, noh_error *error);

/* ======== morph targets on the GPU ======== */

#define NOH_LAYERS_STREAMS 2 /* values of is_uint */
#define NOH_LAYERS_VERTICES 3
#define NOH_LAYERS_DIRECT 4

typedef enum noh_morph_path {
    NOH_MORPH_AUTO = 0,
    NOH_MORPH_LAYERED,
    NOH_MORPH_MRT,
    NOH_MORPH_PER_LAYER,
    NOH_MORPH_GATHER,
    NOH_MORPH_CPU,
    NOH_MORPH_BLEND, /* a policy: additive blending, layered if supported, otherwise per-layer */
    /* Never chosen automatically. With more than four active targets, the four that move the mesh most are drawn. No
     * crowds in one draw, no change of occlusion or texture coordinates, no levels loaded later, f32 only; other
     * readers of sums, such as marks and hair, read zeros */
    NOH_MORPH_STREAMS,
    NOH_MORPH_DIRECT /* no sums: the vertex shader of each draw adds the active targets; f32 only */
} noh_morph_path;
#define NOH_MORPH_PATH_COUNT 9
#define NOH_ATTRIBUTE_STREAMS 10u /* the first of NOH_MORPH_STREAMS_MAX attributes: uvec3 */

typedef enum noh_accumulate {
    NOH_ACCUMULATE_AUTO = 0, /* f32 */
    NOH_ACCUMULATE_F32,
    NOH_ACCUMULATE_F16 /* half the memory; position errors are at most the mesh's f16_position_bound, or 1.5 times that
                        * if the GPU also rounds addends (NOH_HALF_RTZ_RNE) */
} noh_accumulate;

/* Costs compared by `auto`, for a frame of one instance of each mesh with the expected share of its targets active. The
 * unit is a texel blended into three layers of RGBA32F; paths that cannot run here also have a cost. Factors were
 * measured on a software rasteriser and one GPU */
typedef struct noh_gl_morph_costs {
    float texels, quads, blocks, pairs;        /* of the active targets: delta texels, strips, blocks of 4 x 4, pairs */
    float touched;                             /* vertices that any target moves */
    float upload_bytes;                        /* of the lists of gather and direct */
    uint32_t pixel_bytes;                      /* of a texel over all layers */
    uint32_t tile_bytes;                       /* of tile memory per pixel on this GPU; 0: none, or unknown */
    uint32_t draws;                            /* of an instance in a frame */
    float mrt, per_layer, gather, cpu, direct; /* cpu: apart from the upload, another processor does the work */
} noh_gl_morph_costs;

/* The resolved plan on a GPU with these capabilities. All bytes are exact. */
typedef struct noh_gl_morph_plan {
    noh_morph_path path;       /* never AUTO or BLEND */
    noh_accumulate accumulate; /* never AUTO */
    const char *reason;        /* why this path was chosen; a string constant */
    unsigned layer_format;     /* 0 (streams, vertices, direct), RGBA32F, RGBA16F, RGBA32UI (float bits), RGB32F or
                                         * RGB16F */
    uint32_t layer_count;      /* 3; 2 without tangents */
    uint32_t occlusion;        /* 1: a mesh has a transfer (light.h), and the fourth component of positions
                                         * sums changes of occlusion */
    uint32_t atlas_width, atlas_height; /* of the texture array of tiles, in texels */
    uint32_t instance_count, weight_count;
    uint32_t rect_count, texel_count, pair_count; /* of the tables, shared by LOD levels of one mesh */
    uint32_t block_count;                         /* blocks of 4 x 4 delta texels in them */
    uint32_t wide;         /* 1: a delta texel has 16 bytes, for occlusion, or for faster fetches by a software
                            * rasteriser; 0: 12 */
    uint32_t points;       /* 1: blocks are blended as points; 0: as strips, one quad each */
    uint64_t cpu_bytes;    /* the block for noh_gl_morph_init */
    uint64_t delta_bytes;  /* GPU: delta texels, in blocks, or the streams */
    uint64_t table_bytes;  /* GPU: 0; no path has a table besides its deltas */
    uint64_t stream_bytes; /* GPU: data for one draw of an update: weights, with vertices or lists */
    uint64_t layer_bytes;  /* GPU: the accumulation texels */
    uint32_t vertex_ring;  /* buffers of finished vertices, used in turn, 2 or 3; 0: none */
    uint64_t vertex_bytes; /* GPU: of these buffers */
    uint64_t gpu_bytes;    /* the sum of these five */
    uint64_t update_bytes; /* most bytes sent by one update: all targets of all instances active */
    noh_gl_morph_costs costs;
} noh_gl_morph_plan;

/* Where an instance's accumulated deltas are. tile_x, tile_y, width_log2 and touched are the uniform noh_morph of
 * common_layers.glsl, in this order. */
typedef struct noh_gl_morph_binding {
    unsigned texture; /* GL_TEXTURE_2D_ARRAY of the accumulated deltas; 0: none */
    int is_uint;      /* 1: float bits as RGBA32UI: build your shader with NOH_LAYERS_UINT; NOH_LAYERS_STREAMS: no
                       * texture: build it with NOH_STREAMS; NOH_LAYERS_VERTICES: nothing to add: build it with
                       * NOH_VERTICES, or without morphing; NOH_LAYERS_DIRECT: with NOH_DIRECT, and `tables` */
    int layer_count;  /* 2: no layer of tangents: build your shader with NOH_TWO_LAYERS */
    /* Finished vertices, for noh_gl_mesh_bind. There is then no texture, and `touched` is 0 */
    unsigned vertex_buffer;                      /* 0 without finished vertices */
    unsigned vertex_array;                       /* of the buffers' own vertex array; otherwise 0 */
    uint32_t vertex_offset, vertex_stride;       /* bytes; a stride of 20 includes a tangent */
    int32_t tile_x, tile_y, width_log2, touched; /* texels; log2 of the tile's width; count of vertices that any target
                                                  * moves */
    float lips; /* by how much the targets open the lips: half of their gap, in depths of the mouth, a multiple of 1/128
                 * below 1.5. Skin and teeth between them take their light from it */
    /* With NOH_LAYERS_STREAMS, for the instance's current weights: noh_gl_morph_bind_streams */
    unsigned stream_buffer;                         /* otherwise 0 */
    uint32_t stream_offsets[NOH_MORPH_STREAMS_MAX]; /* bytes */
    float streams[NOH_MORPH_STREAMS_MAX][4]; /* weight x scale of position, normal, tangent; the widths of the fields */
    /* With NOH_LAYERS_DIRECT: GL_TEXTURE_2D of delta texels, lists of active targets, and starts of lists. tile_x,
     * tile_y and width_log2 then say where the instance's starts are, for common_layers.glsl only */
    unsigned tables[3];
} noh_gl_morph_binding;

/* ======== palettes on the GPU ======== */

typedef enum noh_palette_mode {
    NOH_PALETTE_AUTO = 0, /* texture if a mesh has several instances, or where it costs less (Mali); else uniform */
    NOH_PALETTE_UNIFORM,
    NOH_PALETTE_TEXTURE
} noh_palette_mode;

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
    uint32_t before_row; /* rows from its first row to its rows of the last frame, in the same order; 0: none */
} noh_gl_skin_binding;

/* ======== programs of the plain renderer ======== */

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

#define NOH_LIT_SOFT 2u /* noh_gl_variant_key.lit where noh_gl_light.is_soft */

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
    uint32_t features;       /* NOH_FEATURE_* of the material; with depth 0 */
    uint8_t cut;             /* with depth, 1: for alpha-cut materials. Without depth 0: NOH_FEATURE_ALPHA */
    uint8_t lit;             /* 1: lit by noh_gl.h; NOH_LIT_SOFT: its shadows are soft; with depth 0 */
    uint8_t transfer;        /* with lit: the order of the mesh's transfer, and NOH_TRANSFER_ON_NORMAL; 0: none */
    uint8_t uv_targets;      /* 1: the mesh has NOH_MESH_UV_TARGETS; with depth only if cut */
} noh_gl_variant_key;

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

/* ======== meshes and a plain renderer ======== */

typedef struct noh_gl_mesh {
    noh_mesh mesh;               /* the finest uploaded LOD level */
    const noh_mesh_header *room; /* of the finest level that fits the buffers: of `mesh`, or finer */
    unsigned vertex_array;
    noh_gl_buffer positions, attributes, influences, indices; /* no influences in a rigid mesh */
    noh_gl_buffer transfer;                                   /* records; none without a transfer */
    unsigned index_type;
} noh_gl_mesh;

/* ======== drawing a stage ========
 * A stage drawn by OpenGL ES 3.
 *
 *   noh_stage_on_gl           its address goes into noh_stage_desc.gpu; noh_stage_init then takes a noh_gl_device
 *   noh_stage_draw            draw one pass of a view of the last frame
 *   noh_stage_set_lighting    light a stage that has noh_stage_desc.light
 *   noh_stage_light_of        its light textures
 *   noh_stage_draw_shadow     draw its shadow map
 *   noh_stage_shader_size     shaders of your own in place of the library's,
 *   noh_stage_shader_create   in every variant that the kinds of the stage need
 *   noh_stage_shader_delete, noh_stage_shader_restore
 *   noh_stage_morph_plan      how its targets are accumulated
 *   noh_actor_on_gl           the GL objects of an actor, for draws of your own
 *
 * The GPU holds each mesh of a pack once, however many kinds draw it. Actors at the same LOD level are drawn by one
 * call for each submesh; actors that fade between two levels are drawn one by one.
 *
 * Stages that share. Stages with noh_stage_desc.share and the same noh_gl_ledger hold the vertices, indices, delta
 * texels and textures of a pack once: a stage takes what another one has, without an upload, where the bytes of the
 * pack in memory are the same and, for meshes, the finest level and whether a transfer is used; for delta texels also
 * the finest level with slots, and a path that orders them alike (gather and direct, or the blended paths). The last
 * stage that uses an object deletes it, whatever the order in which stages end and kinds leave their slots. A kind that
 * is put into a slot uses objects that exist, also of its own stage; others can use its own once it is drawn. A stage
 * has its own meshes with levels that are loaded later (`finer`), covers, light and programs. Pictures and states are
 * the same as without sharing. After a lost context count noh_gl_ledger.contexts first, then restore each stage. Once
 * all are restored, the ledger is as before, except that kinds in slots may share more or less, and that textures that
 * were being loaded start again.
 *
 * Threads: the context's own thread. */

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
#define NOH_UNIT_LISTS 13u /* path direct: lists; starts on the next; delta texels on NOH_UNIT_LAYERS */
#define NOH_UNIT_COLORS 15u
#define NOH_UNIT_USER 16u /* the first unit for a game's own shaders */

#define NOH_GL_RENDERER_BYTES 4u /* the white texel */

extern const noh_stage_gpu noh_stage_on_gl;

typedef enum noh_pass {
    NOH_PASS_COLOR = 0, /* opaque, then blended */
    NOH_PASS_OPAQUE,
    NOH_PASS_BLENDED,
    NOH_PASS_DEPTH /* the same triangles as NOH_PASS_OPAQUE, depth alone: for shadow maps and depth prepasses */
} noh_pass;

typedef struct noh_stage_shader noh_stage_shader;

#define NOH_DRAWABLE_UNIFORMS 14u

/* The GL objects of a backdrop, a floor, blobs, hair, decals, patches or a terrain: private to their functions. All
 * zeros: not created, and deleting it does nothing. */
typedef struct noh_gl_drawable {
    const noh_gl_api *gl; /* NULL: not created */
    noh_gl_ledger *ledger;
    uint32_t units;       /* texture units that its programs read, from 0 on */
    int is_soft;          /* as in noh_gl_light */
    unsigned programs[2]; /* 0: colour, 1: depth alone */
    unsigned vertex_array;
    noh_gl_texture texture;
    noh_gl_buffer buffer;
    int uniforms[2][NOH_DRAWABLE_UNIFORMS]; /* locations in each program; -1: not used by it */
} noh_gl_drawable;

/* Draw one view of the last frame into the current framebuffer and viewport. A view without height_px leaves out actors
 * with no_shadow.
 * shader  NULL: the library's
 * state   the table in gl_device.h: depth function, front face and blending are yours
 * errors  ARG the stage is lit and no lighting was set; the last frame had no such view, or a frame has begun and not
 *         ended; noh_stage_desc has no `gpu`; or its without_shader or without_depth excludes this draw */
noh_result noh_stage_draw(noh_stage *stage, noh_pass pass, uint32_t view, noh_stage_shader *shader, noh_error *error);

/* Set the lighting for all later draws. It is borrowed, and read at each draw. A stage with noh_stage_desc.light draws
 * no colour without it; other stages ignore it. NULL: none. */
void noh_stage_set_lighting(noh_stage *stage, const noh_lighting *lighting);

/* The light textures of the stage, for backdrops, floors and shaders of your own; NULL without noh_stage_desc.light or
 * noh_stage_desc.gpu. */
const noh_gl_light *noh_stage_light_of(const noh_stage *stage);

/* Draw a view into the shadow map of the stage. The view has no height_px: noh_view_shadow makes one.
 * state   the table in gl_device.h
 * errors  ARG as noh_stage_draw of NOH_PASS_DEPTH, or the stage has no light with a shadow map */
noh_result noh_stage_draw_shadow(noh_stage *stage, uint32_t view, noh_error *error);

/* Create shaders of your own (low_gl.h; shaders_es/README.md lists what they can call).
 * memory  [bytes] at least noh_stage_shader_size, aligned to NOH_MEMORY_ALIGN; the shader keeps it
 * log     as in noh_gl_device: messages of the driver
 * errors  ARG memory is NULL or misaligned, or noh_stage_desc has no `gpu`; MEMORY `bytes` is too small; else as
 *         noh_gl_renderer_create */
size_t noh_stage_shader_size(const noh_stage *stage);
noh_result noh_stage_shader_create(noh_stage *stage, void *memory, size_t bytes, const noh_gl_shader_desc *desc,
                                   char *log, size_t log_bytes, noh_stage_shader **shader, noh_error *error);
void noh_stage_shader_delete(noh_stage_shader *shader);

/* Create the programs again in a new context (gl_device.h).
 * errors  as noh_gl_renderer_restore */
noh_result noh_stage_shader_restore(noh_stage_shader *shader, char *log, size_t log_bytes, noh_error *error);

/* Get the path, format and reason of the accumulator of the first mesh with targets, as a stage of this plan has it. No
 * driver is needed.
 * errors  as noh_gl_morph_plan_make */
noh_result noh_stage_morph_plan(const noh_stage_desc *desc, const noh_gl_caps *caps, const noh_stage_plan *plan,
                                noh_gl_morph_plan *out, noh_error *error);

/* A mesh of an actor on the GPU. */
typedef struct noh_stage_drawn {
    const noh_gl_mesh *mesh; /* valid until the next frame, or until its kind leaves its slot */
    noh_gl_morph_binding morph;
    noh_gl_skin_binding skin;
    int is_morphed, is_skinned; /* 0: do not use that binding */
    /* Of the last frame, with noh_stage_desc.motion; else as they are now. Palettes: noh_gl_skin_binding.before_row */
    noh_gl_morph_binding morph_before;
    float world_before[12];         /* relative to noh_stage_origin of this frame */
    const noh_gl_texture *pictures; /* [textures of its mesh pack], from the texture set of the actor */
} noh_stage_drawn;

/* Get a mesh of an actor, by the index of noh_actor_mesh_at. Valid until the next frame.
 * errors  NOT_FOUND the actor is gone, has no such mesh, or no view of the last frame saw it; ARG noh_stage_desc has no
 *         `gpu` */
noh_result noh_actor_on_gl(noh_stage *stage, noh_actor actor, uint32_t index, noh_stage_drawn *out, noh_error *error);

/* ======== backdrop ========
 * The background of a lit stage: its environment, blurred and dimmed, or a gradient of its colours.
 *
 *   noh_backdrop_create   the GL objects; noh_backdrop_delete, noh_backdrop_restore
 *   noh_backdrop_draw     fill the viewport
 *
 * Threads: the context's own thread. */

typedef enum noh_backdrop_kind {
    NOH_BACKDROP_GRADIENT, /* from the light from below to the light from above */
    NOH_BACKDROP_LIGHT     /* the environment as a rough mirror shows it */
} noh_backdrop_kind;

typedef struct noh_backdrop {
    noh_gl_drawable drawable;
    int encode_srgb;
} noh_backdrop;

/* encode_srgb  as in noh_stage_desc
 * errors       DATA, GL, MEMORY as noh_gl_program_create. `out` then has no GL objects */
noh_result noh_backdrop_create(const noh_gl_device *device, int encode_srgb, noh_backdrop *out, noh_error *error);
void noh_backdrop_delete(noh_backdrop *backdrop);

/* Create the GL objects again in a new context (gl_device.h). `log` as in noh_gl_device.
 * errors  as noh_backdrop_create */
noh_result noh_backdrop_restore(noh_backdrop *backdrop, char *log, size_t log_bytes, noh_error *error);

/* Fill the current framebuffer and viewport with the background of `view`. Depth is not written.
 * light  noh_stage_light_of the stage
 * state  the table in gl_device.h */
void noh_backdrop_draw(const noh_backdrop *backdrop, noh_backdrop_kind kind, const noh_gl_light *light,
                       const noh_lighting *lighting, const noh_stage_view *view);

/* ======== blob shadows ========
 * Blob shadows (marks.h) drawn on the ground.
 *
 *   noh_stage_blob_create   the GL objects; noh_stage_blob_delete, noh_stage_blob_restore
 *   noh_stage_blob_draw     all blobs of a view
 *
 * Draw them after the ground and before characters. A blob multiplies the colours in the framebuffer, so it works on
 * any ground, and on a background without one. It takes no GPU memory besides its program.
 *
 * Threads: the context's own thread. */

#define NOH_BLOBS_DRAWN 32 /* blobs in one draw call */

typedef struct noh_stage_blob {
    noh_gl_drawable drawable;
    uint32_t draws; /* draw calls so far */
} noh_stage_blob;

/* errors  DATA, GL, MEMORY as noh_gl_program_create. `out` then has no GL objects */
noh_result noh_stage_blob_create(const noh_gl_device *device, noh_stage_blob *out, noh_error *error);
void noh_stage_blob_delete(noh_stage_blob *blob);

/* Create the GL objects again in a new context (gl_device.h). `log` as in noh_gl_device.
 * errors  as noh_stage_blob_create */
noh_result noh_stage_blob_restore(noh_stage_blob *blob, char *log, size_t log_bytes, noh_error *error);

/* Draw into the current framebuffer and viewport, NOH_BLOBS_DRAWN blobs per draw call.
 * shapes  blobs[count]
 * state   the table in gl_device.h */
void noh_stage_blob_draw(noh_stage_blob *blob, const noh_stage_view *view, const noh_blob *blobs, uint32_t count);

/* ======== decals ========
 * Decals on actors (marks.h) drawn by projection.
 *
 *   noh_stage_decals_size     exact bytes of memory
 *   noh_stage_decals_create   programs for the meshes of a stage, and a texture for one ring; _delete, _restore
 *   noh_stage_decals_draw     the decals of an actor
 *
 * A pixel shows a decal if its place in the bind pose lies within the sphere of the decal and its surface faces the
 * same way. A fold that only touches the decal in the bind pose shows it, too; noh_stage_patches avoids that.
 *
 * Meshes with decals are drawn again, each with all its decals in one draw call: pixels without a decal are discarded,
 * the others are blended over the surface, with its light, normal map and wrinkles. LOD levels may fade meanwhile.
 *
 * GPU memory: NOH_STAGE_DECALS_BYTES. Threads: the context's own thread. */

#define NOH_STAGE_DECALS_BYTES 4096u /* on the GPU, without the picture */

/* An image of tiles, counted from its upper left corner. */
typedef struct noh_decal_picture {
    unsigned texture;       /* GL_TEXTURE_2D, sRGB with straight alpha; 0: decals are round spots */
    uint32_t columns, rows; /* tiles in each direction, from 1; unused if texture is 0 */
} noh_decal_picture;

typedef struct noh_decal_program noh_decal_program;

typedef struct noh_stage_decals {
    noh_gl_drawable drawable; /* a texture, GL_RGBA32F, 4 x NOH_DECALS_MAX */
    noh_stage *stage;
    noh_stage_shader *shader;
    noh_decal_program *programs; /* [program_count] of the shader */
    uint32_t program_count;
    noh_decal_picture picture;
    /* of the current draw: */
    uint32_t count;
    unsigned corners; /* GL texture of the corners of patches; 0: decals are projected */
    uint32_t corner_row;
    int reversed; /* depth falls with distance */

    uint32_t draws; /* draw calls so far */
} noh_stage_decals;

/* The exact bytes of memory. 0: noh_stage_desc has no `gpu`. */
size_t noh_stage_decals_size(const noh_stage *stage);

/* memory   [bytes] at least noh_stage_decals_size, aligned to NOH_MEMORY_ALIGN; the decals keep it
 * device   the one that the stage was created with
 * picture  NULL: round spots. Its texture must outlive the decals
 * out      must stay where it is: the shaders refer to it
 * errors   ARG, MEMORY, DATA, GL as noh_stage_shader_create and noh_gl_texture_create. `out` then has no GL objects */
noh_result noh_stage_decals_create(noh_stage *stage, const noh_gl_device *device, void *memory, size_t bytes,
                                   const noh_decal_picture *picture, noh_stage_decals *out, noh_error *error);
void noh_stage_decals_delete(noh_stage_decals *decals);

/* Create the GL objects again in a new context (gl_device.h). `picture` as in noh_stage_decals_create, `log` as in
 * noh_gl_device.
 * errors  as noh_stage_decals_create */
noh_result noh_stage_decals_restore(noh_stage_decals *decals, const noh_decal_picture *picture, char *log,
                                    size_t log_bytes, noh_error *error);

/* Draw into the framebuffer of the stage, after noh_stage_draw of NOH_PASS_OPAQUE or NOH_PASS_COLOR of the same view.
 * ring    the decals of that actor
 * state   as noh_gl_draw_end leaves it
 * errors  NOT_FOUND the actor is gone, or the view did not see it; ARG as noh_stage_draw. Nothing is drawn then */
noh_result noh_stage_decals_draw(noh_stage_decals *decals, uint32_t view, noh_actor actor, const noh_decals *ring,
                                 noh_error *error);

/* ======== floor shadow ========
 * The shadow of actors on a level floor that has no mesh.
 *
 *   noh_stage_floor_create   the GL objects; noh_stage_floor_delete, noh_stage_floor_restore
 *   noh_stage_floor_draw     the shadow on a disc
 *
 * Draw it after the background and before characters, once the shadow map is drawn. It multiplies the colours in the
 * framebuffer and the floor itself is invisible, so it works on any background. It takes no GPU memory besides its
 * program. Set noh_lighting.floor and has_floor before the shadow map is drawn: otherwise the edge of a soft shadow is
 * hard and too far out.
 *
 * Threads: the context's own thread. */

typedef struct noh_stage_floor {
    noh_gl_drawable drawable;
    int encode_srgb;
} noh_stage_floor;

/* encode_srgb  as in noh_stage_desc
 * errors       DATA, GL, MEMORY as noh_gl_program_create. `out` then has no GL objects */
noh_result noh_stage_floor_create(const noh_gl_device *device, int encode_srgb, noh_stage_floor *out, noh_error *error);
void noh_stage_floor_delete(noh_stage_floor *shadow);

/* Create the GL objects again in a new context (gl_device.h). `log` as in noh_gl_device.
 * errors  as noh_stage_floor_create */
noh_result noh_stage_floor_restore(noh_stage_floor *shadow, char *log, size_t log_bytes, noh_error *error);

/* Draw into the current framebuffer and viewport. Nothing is drawn from below, nor without a shadow map.
 * light   noh_stage_light_of the stage
 * shapes  disc[4]: world position of the centre, radius. The shadow fades over the outer half. A light at 45 degrees or
 *         higher keeps its shadow within twice the radius given to noh_lighting_shadow
 * state   the table in gl_device.h */
void noh_stage_floor_draw(const noh_stage_floor *shadow, const noh_gl_light *light, const noh_lighting *lighting,
                          const noh_stage_view *view, const float disc[4]);

/* ======== hair of an actor ========
 * Hair of the actors of a kind (modules.h) drawn, from one head to a crowd.
 *
 *   noh_stage_hair_size, noh_stage_hair_bytes   exact bytes on the CPU and on the GPU
 *   noh_stage_hair_create                       the GL objects; _delete, _restore
 *   noh_stage_hair_update                       upload heads and the hair that moves
 *   noh_stage_hair_draw                         draw the hair that a view sees; noh_stage_hair_draw_shadow
 *
 * The vertex shader computes strips from their numbers and a texture of control hairs (low_life.h). Hair that moves has
 * control hairs of its own in the texture; all other heads share those at rest. Each head has as many strips as its
 * size in pixels needs; fewer strips are wider. From 50 pixels per metre down hair fades, pixel by pixel, into the
 * texture of the head; from 25 down nothing is drawn.
 *
 * Strips are lit by the model of Kajiya and Kay with two lobes. Their opaque core writes depth, then their fringe is
 * blended. Each takes one draw call for each group of heads of similar size, NOH_HAIR_GROUPS at most. Fringes of
 * smaller heads are blended first; within a group the order is arbitrary.
 *
 * Threads: the context's own thread; noh_stage_hair_size and noh_stage_hair_bytes, any.
 * source   Kajiya, Kay: Rendering Fur with Three Dimensional Textures, 1989; Scheuermann: Practical Real-Time Hair
 *          Rendering and Shading, 2004 */

#define NOH_HAIR_GROUPS 5u /* each of heads with at most half as many strips as the group before */

/* The heads of a group follow each other in the texture. */
typedef struct noh_hair_group {
    uint32_t first, count;
    uint32_t strips; /* of the head that has most */
} noh_hair_group;

typedef struct noh_stage_hair {
    noh_gl_drawable drawable; /* a GL_RGB32F texture: control hairs, corners of patches, heads */
    const noh_actor_hair *hair;
    int lit, encode_srgb;
    float *points; /* control hairs of one head, while they are uploaded */
    float *table;  /* heads, as in the texture */
    noh_hair_group groups[NOH_HAIR_GROUPS];
    uint32_t views;  /* a bit for each view that sees a head */
    uint32_t strips; /* of all heads */
    uint32_t draws;  /* draw calls so far */
} noh_stage_hair;

/* The exact bytes: 12 for each control point of one head, and 60 for each head, rounded up to whole rows of the
 * texture. */
size_t noh_stage_hair_size(const noh_actor_hair_desc *desc);

/* The exact bytes on the GPU: 12 for each control point of near_max heads, and of one at rest where not all heads move;
 * 24 for each patch; 60 for each head. Each is rounded up to whole rows. */
uint64_t noh_stage_hair_bytes(const noh_actor_hair_desc *desc);

/* hair         must outlive `out`
 * memory       [bytes] at least noh_stage_hair_size, aligned to NOH_MEMORY_ALIGN; `out` keeps it
 * lit          1: the stage has a light
 * encode_srgb  as in noh_stage_desc
 * errors       ARG memory is NULL or misaligned; MEMORY `bytes` is too small; DATA, GL, MEMORY as noh_gl_program_create
 *              and noh_gl_texture_create. `out` then has no GL objects */
noh_result noh_stage_hair_create(const noh_gl_device *device, const noh_actor_hair *hair, void *memory, size_t bytes,
                                 int lit, int encode_srgb, noh_stage_hair *out, noh_error *error);
void noh_stage_hair_delete(noh_stage_hair *hair);

/* Create the GL objects again in a new context (gl_device.h). `log` as in noh_gl_device.
 * errors  as noh_stage_hair_create */
noh_result noh_stage_hair_restore(noh_stage_hair *hair, char *log, size_t log_bytes, noh_error *error);

/* Upload the heads that noh_actor_hair_frame found. Call it before the draws of that frame. */
void noh_stage_hair_update(noh_stage_hair *hair);

/* Draw into the current framebuffer and viewport, after the stage.
 * pass   NOH_PASS_OPAQUE: the core; NOH_PASS_BLENDED: the fringe; NOH_PASS_COLOR: both; NOH_PASS_DEPTH: the core, depth
 *        alone
 * state  as noh_gl_draw_end leaves it */
void noh_stage_hair_draw(noh_stage_hair *hair, const noh_stage *stage, uint32_t view, noh_pass pass);

/* Add the hair to the shadow map, after noh_stage_draw_shadow. Framebuffer 0 is bound afterwards. */
void noh_stage_hair_draw_shadow(noh_stage_hair *hair, const noh_stage *stage, uint32_t view);

/* ======== grown decals ========
 * Decals on actors (marks.h) drawn as patches of triangles.
 *
 *   noh_stage_patches_size, NOH_STAGE_PATCHES_BYTES   exact bytes on the CPU and on the GPU
 *   noh_stage_patches_create                          room for the triangles of one ring; _delete, _restore
 *   noh_stage_patches_draw                            in place of noh_stage_decals_draw
 *
 * A decal covers only the surface connected to the triangle that was hit, not a fold that touches it in the bind pose.
 * Only triangles with decals are drawn again, all of a mesh in one draw call, from the vertices of the mesh itself:
 * they move exactly as the mesh does. The programs of noh_stage_decals draw them, and test only the decals that have
 * grown over a triangle.
 *
 * A decal grows when it is first drawn at a LOD level: one pass over the triangles of that level for each decal. Two
 * levels are kept, so that nothing grows again while one fades into the other. All decals of a ring share room for
 * triangles; a decal that finds too little of it is smaller.
 *
 * Two triangles near a decal that share only one vertex cannot be told apart.
 * Threads: the context's own thread. */

/* The exact bytes on the GPU: indices and a texture of corners, for two levels. Neither argument may be 0. */
#define NOH_STAGE_PATCHES_BYTES(capacity, triangles) \
    (24u * (uint64_t)(triangles) + 8u * NOH_PATCH_WIDTH * NOH_PATCH_ROWS(capacity, triangles))

typedef struct noh_stage_patch noh_stage_patch;

/* The triangles of one LOD level, of all meshes. */
typedef struct noh_stage_patch_level {
    uint32_t level;           /* of the actor; NOH_NONE: nothing has grown */
    noh_stage_patch *patches; /* [capacity], one for each decal of the ring */
    uint32_t *pool;           /* [triangle_room] triangles of the patches, the first `used` of them valid */
    uint32_t *numbers;        /* [triangle_room] triangles of the meshes, as in the index buffer */
    uint32_t used;
    uint8_t marks[NOH_DECALS_MAX];   /* [mark_count] decals in the index buffer, mesh by mesh */
    uint32_t counts[NOH_DECALS_MAX]; /* [mark_count] triangles of a mesh, at its first decal; else 0 */
    uint32_t mark_count;
} noh_stage_patch_level;

typedef struct noh_stage_patches {
    noh_gl_drawable drawable; /* indices [2][triangle_room][3], and a GL_R32UI texture: for each level where the corners
                               * of each decal begin, then all corners, in rising order for each decal */
    noh_stage_decals *decals;
    uint32_t capacity, triangle_room;
    uint32_t kind; /* of the stage; NOH_NONE: nothing has grown */
    uint32_t last; /* index in levels[] of the level drawn last */
    noh_stage_patch_level levels[2];
    uint32_t *sorted;  /* [triangle_room] while corners are sent */
    uint32_t grown;    /* decals grown so far */
    uint32_t left_out; /* triangles of them that had no room */
} noh_stage_patches;

/* The exact bytes of memory; arguments as in noh_stage_patches_create. */
size_t noh_stage_patches_size(uint32_t capacity, uint32_t triangles);

/* decals     draw the patches; they must outlive `out`
 * capacity   of the largest ring that is drawn; 0: NOH_DECALS_MAX
 * triangles  of all decals together at one level, up to 2^20; 0: NOH_DECAL_TRIANGLES for each decal
 * memory     [bytes] at least noh_stage_patches_size, aligned to NOH_MEMORY_ALIGN; the patches keep it
 * errors     ARG, MEMORY as any init; MEMORY, GL as noh_gl_buffer_create. `out` then has no GL objects */
noh_result noh_stage_patches_create(noh_stage_decals *decals, uint32_t capacity, uint32_t triangles, void *memory,
                                    size_t bytes, noh_stage_patches *out, noh_error *error);
void noh_stage_patches_delete(noh_stage_patches *patches);

/* Create the GL objects again in a new context (gl_device.h), after noh_stage_decals_restore.
 * errors  as noh_stage_patches_create */
noh_result noh_stage_patches_restore(noh_stage_patches *patches, noh_error *error);

/* As noh_stage_decals_draw. Drawing several rings with the same patches grows all decals again at each change of ring:
 * give each ring patches of its own.
 * ring    the decals of that actor; its capacity must not exceed noh_stage_patches.capacity */
noh_result noh_stage_patches_draw(noh_stage_patches *patches, uint32_t view, noh_actor actor, const noh_decals *ring,
                                  noh_error *error);

/* ======== terrain ========
 * A height field drawn as the ground of a stage, in blocks at the levels of body.h.
 *
 *   noh_stage_terrain_size, noh_stage_terrain_bytes   exact bytes on the CPU and on the GPU
 *   noh_stage_terrain_create                          the GL objects; _delete, _restore
 *   noh_stage_terrain_choose                          LOD levels for a view
 *   noh_stage_terrain_draw                            draw the visible blocks; noh_stage_terrain_draw_shadow
 *
 * There are no vertex buffers: the vertex shader computes vertices from their numbers and a texture of the 16-bit
 * heights. Each block is one draw call of at most 2,048 triangles. Drawing uploads nothing.
 *
 * Threads: the context's own thread; noh_stage_terrain_size and noh_stage_terrain_bytes, any. */

/* Zeros are good values. */
typedef struct noh_stage_terrain_desc {
    int lit, encode_srgb;    /* lit: the stage has a light; encode_srgb: as in noh_stage_desc */
    float flat[3], steep[3]; /* linear colours; default (0) grass and rock */
} noh_stage_terrain_desc;

typedef struct noh_stage_terrain {
    noh_gl_drawable drawable; /* with the heights in a GL_R16UI texture */
    noh_stage_terrain_desc desc;
    noh_terrain_lod lod;
    uint32_t draws, triangles; /* of the last draw */
} noh_stage_terrain;

/* The first is on the CPU, for choosing levels; the second on the GPU, 2 bytes per height. */
size_t noh_stage_terrain_size(const noh_field *field);
uint64_t noh_stage_terrain_bytes(const noh_field *field);

/* field    in the unit of the stage; its heights must outlive the terrain
 * desc     NULL: zeros
 * memory   [bytes] at least noh_stage_terrain_size, aligned to NOH_MEMORY_ALIGN; the terrain keeps it
 * errors   ARG memory is NULL or misaligned, or the field has fewer than 2 x 2 heights; LIMIT a side of the field has
 *          more heights than the largest texture of device->caps has texels; MEMORY `bytes` is too small; DATA, GL,
 *          MEMORY as noh_gl_program_create and noh_gl_texture_create. `out` then has no GL objects */
noh_result noh_stage_terrain_create(const noh_gl_device *device, const noh_field *field,
                                    const noh_stage_terrain_desc *desc, void *memory, size_t bytes,
                                    noh_stage_terrain *out, noh_error *error);
void noh_stage_terrain_delete(noh_stage_terrain *terrain);

/* Create the GL objects again in a new context (gl_device.h). `log` as in noh_gl_device.
 * errors  as noh_stage_terrain_create */
noh_result noh_stage_terrain_restore(noh_stage_terrain *terrain, char *log, size_t log_bytes, noh_error *error);

/* Choose the visible blocks, each at the coarsest level with an error of at most `pixels`. All later draws, the shadow
 * too, use this choice. */
void noh_stage_terrain_choose(noh_stage_terrain *terrain, const noh_stage_view *view, float pixels);

/* Draw into the current framebuffer and viewport, before or after the opaque pass of the stage.
 * stage    provides the light; NULL: none
 * state    the table in gl_device.h */
void noh_stage_terrain_draw(noh_stage_terrain *terrain, const noh_stage *stage, const noh_stage_view *view);

/* Add the whole field to the shadow map of the stage, after noh_stage_draw_shadow. */
void noh_stage_terrain_draw_shadow(noh_stage_terrain *terrain, const noh_stage *stage, const noh_stage_view *view);

#ifdef __cplusplus
}
#endif

#endif
