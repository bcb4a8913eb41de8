/* gl_morph.h: morph targets accumulated on the GPU, for many instances at once.
 *
 *   noh_gl_morph_blocks       blocks of 4 x 4 accumulation texels touched by the targets of a mesh
 *   noh_gl_morph_strips       rows of such blocks
 *   noh_gl_morph_plan_make    choose the path and compute its exact bytes, without GL calls
 *   noh_gl_morph_calibrate    choose the path by measuring at start-up
 *   noh_gl_morph_calibrate_size
 *   noh_gl_morph_init         build the accumulator in your memory and make its GL objects
 *   noh_gl_morph_delete       delete the GL objects
 *   noh_gl_morph_restore      make the GL objects again after a lost context
 *   noh_gl_morph_set_mesh     vertex arrays for finished vertices
 *   noh_gl_morph_set_weights  set one instance's weights; costs only a comparison if they did not change
 *   noh_gl_morph_set_lod      accumulate an instance only for an LOD level
 *   noh_gl_morph_update       accumulate the instances whose weights changed
 *   noh_gl_morph_binding_of   where a vertex shader finds an instance's deltas
 *   noh_gl_morph_plan_of      the plan of an accumulator
 *   noh_gl_morph_instance     the number of an instance of a mesh
 *   noh_gl_morph_streamed     the targets that the path streams adds
 *   noh_gl_morph_bind_streams bind the streams for your own draw
 *   noh_morph_path_name, noh_accumulate_name
 *
 * Deltas of position, normal and tangent are accumulated in the three layers of one texture array. Without tangents
 * there are two layers, and tangents of the bind pose are turned with the normal. For meshes with a transfer
 * (transfer.h) the fourth component of positions accumulates the change of occlusion. Each instance has a tile with one
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
 *
 * Two policies choose a path: `auto` takes the cheapest on this GPU; `blend` takes layered draws if supported,
 * otherwise per-layer passes. Blending into the accumulation format needs an extension. Most phones have it for
 * float16, but not for float32 (EXT_float_blend).
 *
 * Threads: the context's own thread; any thread for noh_gl_morph_plan_make and the names. */
#ifndef NOH_GL_GL_MORPH_H
#define NOH_GL_GL_MORPH_H

#include "gl/device/gl_caps.h"
#include "gl/device/gl_memory.h"
#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

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
    NOH_MORPH_STREAMS
} noh_morph_path;
#define NOH_MORPH_PATH_COUNT 8
#define NOH_ATTRIBUTE_STREAMS 10u /* the first of NOH_MORPH_STREAMS_MAX attributes: uvec3 */

typedef enum noh_accumulate {
    NOH_ACCUMULATE_AUTO = 0, /* f32 */
    NOH_ACCUMULATE_F32,
    NOH_ACCUMULATE_F16 /* half the memory; position errors are at most the mesh's f16_position_bound, or 1.5 times that
                        * if the GPU also rounds addends (NOH_HALF_RTZ_RNE) */
} noh_accumulate;

/* The names "auto", "layered", "mrt", "per-layer", "gather", "cpu", "blend", "streams"; and "auto", "f32", "f16". */
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
    float expected_active;           /* for auto and calibration: share of targets active at once, 0..1; 0: 0.5 */
    int without_tangents;            /* 1: two layers, a third less memory, if no shader reads morphed tangents */
    /* For levels loaded later: `meshes` are levels of one mesh, and only their headers are read, which must stay. Until
     * noh_gl_morph_use is called, this coarser level of the same mesh, possibly of another pack, is the finest that is
     * accumulated. Default (NULL) all of `meshes` is loaded */
    const noh_mesh *coarse;
    /* 1: on the path cpu, writes finished vertices to vertex buffers (morph_finish.h) instead of sums to a texture,
     * which is faster. Draw with noh_gl_draw_mesh or noh_gl_mesh_bind, with a binding taken after the last update, and
     * a renderer with layers_uint NOH_LAYERS_VERTICES; noh_gl_draw_crowd does not support it. Shaders read the bind
     * pose from noh_a_rest. f16, transfers, UV targets and `coarse` need sums; plan.vertex_ring is then 0. Default (0)
     * sums in a texture */
    int vertices;
    const char *simd; /* name of the kernel of the path cpu (morph.h), for tests. NULL or unavailable: the fastest */
    /* With `coarse`: noh_gl_morph_blocks and noh_gl_morph_strips of the finest mesh, counted on the whole mesh */
    uint32_t later_blocks, later_strips;
} noh_gl_morph_desc;

/* Costs compared by `auto`, for one update of one instance of each mesh with the expected share of its targets active.
 * The unit is a texel blended into three layers of RGBA32F; paths that cannot run here also have a cost. Factors were
 * measured on a software rasteriser and one GPU (gl_morph_cost.c); noh_gl_morph_calibrate measures on the player's
 * GPU */
typedef struct noh_gl_morph_costs {
    float texels, quads, blocks, pairs; /* of the active targets: delta texels, strips, blocks of 4 x 4, pairs */
    float touched;                      /* vertices that any target moves */
    float upload_bytes;                 /* of the lists of gather */
    uint32_t pixel_bytes;               /* of a texel over all layers */
    uint32_t tile_bytes;                /* of tile memory per pixel on this GPU; 0: none, or unknown */
    float mrt, per_layer, gather, cpu;  /* cpu: apart from the upload, another processor does the work */
} noh_gl_morph_costs;

/* The resolved plan on a GPU with these capabilities. All bytes are exact. */
typedef struct noh_gl_morph_plan {
    noh_morph_path path;                /* never AUTO or BLEND */
    noh_accumulate accumulate;          /* never AUTO */
    const char *reason;                 /* why this path was chosen; a string constant */
    unsigned layer_format;              /* 0 (streams, vertices), RGBA32F, RGBA16F, RGBA32UI (float bits), RGB32F or
                                         * RGB16F */
    uint32_t layer_count;               /* 3; 2 without tangents */
    uint32_t occlusion;                 /* 1: a mesh has a transfer (transfer.h), and the fourth component of positions
                                         * sums changes of occlusion */
    uint32_t atlas_width, atlas_height; /* of the texture array of tiles, in texels */
    uint32_t instance_count, weight_count;
    uint32_t rect_count, texel_count, pair_count; /* of the tables, shared by LOD levels of one mesh */
    uint32_t block_count;                         /* blocks of 4 x 4 delta texels in them, noh_gl_morph_blocks */
    uint32_t wide;         /* 1: a delta texel has 16 bytes, for occlusion, or for faster fetches by a software
                            * rasteriser; 0: 12 */
    uint32_t points;       /* 1: blocks are blended as points; 0: as strips, one quad each */
    uint64_t cpu_bytes;    /* the block for noh_gl_morph_init */
    uint64_t delta_bytes;  /* GPU: delta texels, in blocks, or the streams */
    uint64_t table_bytes;  /* GPU: 0; no path has a table beside its deltas */
    uint64_t stream_bytes; /* GPU: data for one draw of an update: weights, with vertices or lists */
    uint64_t layer_bytes;  /* GPU: the accumulation texels */
    uint32_t vertex_ring;  /* buffers of finished vertices, used in turn, 2 or 3; 0: none */
    uint64_t vertex_bytes; /* GPU: of these buffers */
    uint64_t gpu_bytes;    /* the sum of these five */
    uint64_t update_bytes; /* most bytes sent by one update: all targets of all instances active */
    noh_gl_morph_costs costs;
} noh_gl_morph_plan;

typedef struct noh_gl_morph noh_gl_morph;
struct noh_gl_mesh; /* gl_draw.h */

/* Counts of one update. */
typedef struct noh_gl_morph_stats {
    uint32_t instances;            /* accumulated */
    uint32_t draws;                /* accumulation draws, without clears */
    uint32_t targets;              /* active targets, summed over instances */
    uint32_t rects, texels, pairs; /* rectangles and texels drawn, pairs added */
} noh_gl_morph_stats;

#define NOH_LAYERS_STREAMS 2 /* values of is_uint */
#define NOH_LAYERS_VERTICES 3

/* Where an instance's accumulated deltas are. tile_x, tile_y, width_log2 and touched are the uniform noh_morph of
 * common_layers.glsl, in this order. */
typedef struct noh_gl_morph_binding {
    unsigned texture; /* GL_TEXTURE_2D_ARRAY */
    int is_uint;      /* 1: float bits as RGBA32UI: build your shader with NOH_LAYERS_UINT; NOH_LAYERS_STREAMS: no
                       * texture: build it with NOH_STREAMS; NOH_LAYERS_VERTICES: nothing to add: build it with
                       * NOH_VERTICES, or without morphing */
    int layer_count;  /* 2: no layer of tangents: build your shader with NOH_TWO_LAYERS */
    /* Finished vertices, for noh_gl_mesh_bind. There is then no texture, and `touched` is 0 */
    unsigned vertex_buffer;                      /* 0 without finished vertices */
    unsigned vertex_array;                       /* vertex array of noh_gl_morph_set_mesh; otherwise 0 */
    uint32_t vertex_offset, vertex_stride;       /* bytes; a stride of 20 includes a tangent */
    int32_t tile_x, tile_y, width_log2, touched; /* texels; log2 of the tile's width; count of vertices that any target
                                                  * moves */
    /* With NOH_LAYERS_STREAMS, for the instance's current weights: noh_gl_morph_bind_streams */
    unsigned stream_buffer;                         /* otherwise 0 */
    uint32_t stream_offsets[NOH_MORPH_STREAMS_MAX]; /* bytes */
    float streams[NOH_MORPH_STREAMS_MAX][4]; /* weight x scale of position, normal, tangent; the widths of the fields */
} noh_gl_morph_binding;

/* Blocks of 4 x 4 accumulation texels touched by each target's rectangles, summed over targets; the unit of work of the
 * GPU paths. */
uint32_t noh_gl_morph_blocks(const noh_mesh *mesh);

/* Rows of such blocks, summed over rectangles; each is a quad on the blended paths. */
uint32_t noh_gl_morph_strips(const noh_mesh *mesh);

/* Choose the path and compute its exact bytes, without GL calls.
 * errors  ARG a desc field is out of range; UNSUPPORTED the path of the desc cannot run here (`what` names the missing
 *         capability); LIMIT the atlas or a table exceeds the texture size */
noh_result noh_gl_morph_plan_make(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, noh_gl_morph_plan *plan,
                                  noh_error *error);

/* Returns the time in nanoseconds after the GPU has finished: call glFinish first, or, if it returns at once as in
 * browsers, read a pixel back. The library has no clock of its own. */
typedef uint64_t (*noh_gl_clock)(void *user);

/* Results of noh_gl_morph_calibrate. */
typedef struct noh_gl_morph_times {
    noh_morph_path path;               /* the fastest */
    uint64_t ns[NOH_MORPH_PATH_COUNT]; /* by path: the fastest update of all instances; 0: not measured */
    uint32_t rounds[NOH_MORPH_PATH_COUNT];
} noh_gl_morph_times;

/* The memory for noh_gl_morph_calibrate.
 * errors  as noh_gl_morph_plan_make */
noh_result noh_gl_morph_calibrate_size(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, uint64_t *bytes,
                                       noh_error *error);

/* Measure gather, mrt and cpu, as far as they run here, on this driver with your meshes; then set desc.path =
 * times->path for noh_gl_morph_init. Weights change in each round, with the share desc.expected_active of the targets
 * active; a round is an update and the wait for it. desc.path is not read, and desc.coarse must be NULL.
 * shapes  memory[bytes], at least noh_gl_morph_calibrate_size; free again afterwards
 * ranges  budget_ns: rounds begin until it is spent, at least one for each path; 50,000,000 is enough. Making the
 *         objects and compiling shaders is not included
 * state   as after noh_gl_morph_update; all GL objects it makes are deleted
 * errors  as noh_gl_morph_init */
noh_result noh_gl_morph_calibrate(void *memory, size_t bytes, const noh_gl_device *device,
                                  const noh_gl_morph_desc *desc, noh_gl_clock clock, void *user, uint64_t budget_ns,
                                  noh_gl_morph_times *times, noh_error *error);

/* Build an accumulator in memory[bytes], aligned to NOH_MEMORY_ALIGN and at least plan.cpu_bytes long, and make its GL
 * objects, counted in the device's ledger. All weights are initially 0. On error all GL objects made so far are
 * deleted.
 * errors  as noh_gl_morph_plan_make; ARG memory is NULL or misaligned; MEMORY memory is too small (need:
 *         plan.cpu_bytes); GL, MEMORY the driver refused an object; DATA a shader does not compile or link */
noh_result noh_gl_morph_init(void *memory, size_t bytes, const noh_gl_device *device, const noh_gl_morph_desc *desc,
                             noh_gl_morph **morph, noh_error *error);

/* Delete the GL objects. The memory may then be reused. */
void noh_gl_morph_delete(noh_gl_morph *morph);

/* Release the GL objects of a lost context without GL calls (gl_lost.h). They may be restored later. */
void noh_gl_morph_forget(noh_gl_morph *morph);

/* Make the GL objects again in a new context (gl_lost.h). Weights stay; the next noh_gl_morph_update accumulates every
 * instance. `log` as in noh_gl_program_create.
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
 * state   gl_state.h: bindings of units 0 to 2 are empty. No state is changed if no instance changed
 * errors  none: init checked everything */
void noh_gl_morph_update(noh_gl_morph *morph, noh_gl_morph_stats *stats);

/* With desc.coarse: upload the next piece of the delta data of the finest of `meshes`, which is not used yet.
 * ranges   from: the whole mesh, at the finest level of `meshes` or a finer one; *at: initially 0, then as left by the
 *          previous call; *bytes: most bytes to send, at least 256 for progress; the bytes sent are subtracted
 * state    texture 0 of unit 0, the active one
 * returns  1 once everything is uploaded */
int noh_gl_morph_fill(noh_gl_morph *morph, const noh_mesh *from, uint32_t *at, uint32_t *bytes);

/* With desc.coarse: set the finest level to accumulate. Deltas are read from the pack of `mesh`, which must stay as
 * long. The next update accumulates each instance whose level changes.
 * mesh  a whole mesh: the one of desc.coarse, or the one passed to noh_gl_morph_fill after everything is uploaded */
void noh_gl_morph_use(noh_gl_morph *morph, const noh_mesh *mesh);

/* With finished vertices: make a vertex array for each instance of a mesh and each buffer of the ring, so that draws
 * need not set attribute pointers again, which is slow in drivers. Call it after init and after each restore; without
 * it noh_gl_mesh_bind changes the pointers of the mesh's own array and restores them. Without finished vertices it does
 * nothing.
 * mesh    index in the desc
 * drawn   the noh_gl_mesh that draws the mesh; its buffers must stay
 * errors  GL the driver refused a vertex array; the mesh then has none */
noh_result noh_gl_morph_set_mesh(noh_gl_morph *morph, uint32_t mesh, const struct noh_gl_mesh *drawn, noh_error *error);

noh_gl_morph_binding noh_gl_morph_binding_of(const noh_gl_morph *morph, uint32_t instance);

/* Get the targets that the path streams adds, in index order: those with nonzero weights, at most the four with the
 * largest |weight| x radius.
 * shapes   weights[target_count]
 * returns  the number of targets */
uint32_t noh_gl_morph_streamed(const noh_mesh *mesh, const float *weights, uint32_t targets[NOH_MORPH_STREAMS_MAX]);

/* Point the attributes NOH_ATTRIBUTE_STREAMS and up of the bound vertex array to an instance's streams, and set the
 * uniform noh_streams of the program in use. Does nothing on other paths. The vertex array keeps the buffer: delete the
 * mesh when the accumulator is deleted.
 * u_streams  the location of noh_streams in that program: find it once, when the program is linked */
void noh_gl_morph_bind_streams(const noh_gl_api *api, int u_streams, const noh_gl_morph_binding *binding);

#ifdef __cplusplus
}
#endif

#endif
