/* gl_morph.h: morph targets accumulated on the GPU, for many instances at once.
 *
 *   noh_gl_morph_blocks       blocks of 4 x 4 accumulation texels that the targets of a mesh touch
 *   noh_gl_morph_strips       rows of such blocks
 *   noh_gl_morph_plan_make    which path, why, and every byte that it takes; touches no GL
 *   noh_gl_morph_calibrate    measure instead of choosing by a model, at start-up
 *   noh_gl_morph_calibrate_size
 *   noh_gl_morph_init         build it in your memory and make its GL objects
 *   noh_gl_morph_delete       delete the GL objects
 *   noh_gl_morph_restore      make them again after a lost context
 *   noh_gl_morph_set_mesh     vertex arrays for finished vertices
 *   noh_gl_morph_set_weights  set one instance's weights; costs no more than a comparison if they did not change
 *   noh_gl_morph_set_lod      accumulate only what an LOD level of an instance needs
 *   noh_gl_morph_update       accumulate the instances whose weights changed
 *   noh_gl_morph_binding_of   where a vertex shader finds an instance's deltas
 *   noh_gl_morph_plan_of      the plan that it was built by
 *   noh_gl_morph_instance     the number of an instance of a mesh
 *   noh_gl_morph_streamed     which targets the path streams adds
 *   noh_gl_morph_bind_streams give them to a draw of your own
 *   noh_morph_path_name, noh_accumulate_name
 *
 * Deltas of position, normal and tangent are accumulated in the three layers of one texture array; in two of them where
 * tangents are not wanted, and then those of the bind pose are turned with the normal. Of meshes that have a transfer
 * (transfer.h) the change of occlusion is accumulated beside the position, in its fourth component. Each instance
 * has a tile of it with one accumulation texel per vertex that any target moves. The base mesh stays in the vertex
 * buffers, and the vertex shader adds the accumulated deltas to it (shaders_es/common_layers.glsl), so a half-float
 * accumulator rounds only deltas. Microsoft's SparseMorphTargets sample (DirectX SDK) accumulates in the same way, but
 * whole vertices, and of one mesh.
 *
 *   path       needs                      how
 *   layered    geometry shader, blending  one additive pass into three layers
 *   mrt        ES 3.0, blending           one additive pass with three outputs
 *   per-layer  ES 3.0, blending           three additive passes
 *   gather     ES 3.0                     no blending: each fragment sums what active targets add to one vertex
 *   cpu        nothing                    SIMD on the CPU; the sums are uploaded, or vertices (desc.vertices)
 *   streams    ES 3.0                     nothing is accumulated: the draw adds up to four targets as vertex streams
 *
 * Two policies choose among them: `auto` takes the cheapest on this GPU; `blend` takes layered draws where they are
 * supported and per-layer passes otherwise. Blending into the accumulation format needs an extension. Most phones lack
 * that for float32 (EXT_float_blend), and have it for float16.
 *
 * Threads: the context's own thread. noh_gl_morph_plan_make and the names, any. */
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
    NOH_MORPH_BLEND, /* a policy: additive blending, layered draws where supported, else per-layer passes */
    /* Never chosen by itself. Of more than four active targets the four are drawn that move the mesh most. No crowds
     * in one draw, no change of occlusion or of texture coordinates, no levels that come later, f32 only; what else
     * reads sums, as marks and hair do, finds zeros */
    NOH_MORPH_STREAMS
} noh_morph_path;
#define NOH_MORPH_PATH_COUNT 8
#define NOH_ATTRIBUTE_STREAMS 10u /* the first of so many attributes: uvec3 */

typedef enum noh_accumulate {
    NOH_ACCUMULATE_AUTO = 0, /* f32 */
    NOH_ACCUMULATE_F32,
    NOH_ACCUMULATE_F16 /* half the memory; positions are off by at most the mesh's f16_position_bound, and
                        * half as much more where a GPU rounds what it adds, too (NOH_HALF_RTZ_RNE) */
} noh_accumulate;

/* "auto", "layered", "mrt", "per-layer", "gather", "cpu", "blend", "streams"; "auto", "f32", "f16". */
const char *noh_morph_path_name(noh_morph_path path);
const char *noh_accumulate_name(noh_accumulate accumulate);

typedef struct noh_gl_morph_desc {
    /* [mesh_count]; copied, but the packs must stay. May hold several LOD levels of one mesh, each with tiles of its
     * own size, for a few instances near and many far; they share the tables of the finest one */
    const noh_mesh *meshes;
    uint32_t mesh_count;
    const uint32_t *instance_counts; /* [mesh_count]; NULL: one of each. 1..NOH_MORPH_INSTANCES_MAX in all */
    noh_morph_path path;             /* 0: the cheapest on this GPU; or the policy blend, or one path */
    noh_accumulate accumulate;       /* 0: f32 */
    float
        expected_active;  /* for auto and for calibration: the share of targets that are active at once, 0..1; 0: 0.5 */
    int without_tangents; /* 1: two layers, a third less memory, where no shader reads morphed tangents */
    /* For levels that come later: `meshes` are levels of one mesh, and of them only headers are read,
     * which must stay. Until noh_gl_morph_use says otherwise, this coarser level of the same mesh,
     * which may lie in another pack, is the finest that is accumulated. Default (NULL) all of `meshes` is there */
    const noh_mesh *coarse;
    /* 1: where the path is cpu, finished vertices in vertex buffers (morph_finish.h) in place of sums in a
     * texture, which is faster. Draw by noh_gl_draw_mesh or noh_gl_mesh_bind, with a binding that was
     * taken after the last update, and a renderer with layers_uint NOH_LAYERS_VERTICES; noh_gl_draw_crowd cannot.
     * Shaders find the bind pose in noh_a_rest. Where f16, transfers, UV targets or `coarse` ask for sums, there are none:
     * plan.vertex_ring tells. Default (0) sums in a texture */
    int vertices;
    const char *simd; /* kernel of the path cpu by its name (morph.h), for tests. NULL, or one that is not here:
                       * the fastest */
    /* With `coarse`: noh_gl_morph_blocks and noh_gl_morph_strips of the finest mesh, counted where that is whole */
    uint32_t later_blocks, later_strips;
} noh_gl_morph_desc;

/* What `auto` weighs, for one update of one instance of each mesh with the expected share of its targets active. The
 * costs of paths are in texels blended into three layers of RGBA32F; a path has one also where it cannot run. Factors
 * for software rasterisers were measured, those for GPUs on one of them (gl_morph_cost.c); noh_gl_morph_calibrate
 * measures on the GPU at hand */
typedef struct noh_gl_morph_costs {
    float texels, quads, blocks, pairs; /* of the active targets: delta texels, strips, blocks of 4 x 4, pairs */
    float touched;                      /* vertices that any target moves */
    float upload_bytes;                 /* of gather's lists */
    uint32_t pixel_bytes;               /* of a texel in all layers */
    uint32_t tile_bytes;                /* that the tile memory of this GPU has for it; 0: none, or not known */
    float mrt, per_layer, gather, cpu;  /* cpu: its work beside what is uploaded is done by another processor */
} noh_gl_morph_costs;

/* The resolved plan on a GPU with these capabilities. All bytes are exact. */
typedef struct noh_gl_morph_plan {
    noh_morph_path path;                /* never AUTO or BLEND */
    noh_accumulate accumulate;          /* never AUTO */
    const char *reason;                 /* why this path, in words; a string constant */
    unsigned layer_format;              /* 0 (streams, vertices), RGBA32F, RGBA16F, RGBA32UI (float bits), RGB32F or
                                         * RGB16F */
    uint32_t layer_count;               /* 3; 2 without tangents */
    uint32_t occlusion;                 /* 1: a mesh has a transfer (transfer.h), and what targets change of its
                                         * occlusion is summed, too: the fourth component beside positions */
    uint32_t atlas_width, atlas_height; /* of the texture array that holds the tiles, in texels */
    uint32_t instance_count, weight_count;
    uint32_t rect_count, texel_count, pair_count; /* of the tables, which LOD levels of one mesh share */
    uint32_t block_count;                         /* of these: blocks of 4 x 4 delta texels, noh_gl_morph_blocks */
    uint32_t wide;         /* 1: a delta texel has 16 bytes, for occlusion or a software rasteriser, which fetches them
                            * faster; 0: 12 */
    uint32_t points;       /* 1: blocks are blended as points; 0: as strips, each a quad */
    uint64_t cpu_bytes;    /* the block that noh_gl_morph_init needs */
    uint64_t delta_bytes;  /* GPU: delta texels, in blocks, or the streams */
    uint64_t table_bytes;  /* GPU: 0; no path has a table beside its deltas */
    uint64_t stream_bytes; /* GPU: what is sent for one draw of an update: weights, with vertices or lists */
    uint64_t layer_bytes;  /* GPU: the accumulation texels */
    uint32_t vertex_ring;  /* buffers that finished vertices take turns in, 2 or 3; 0: there are none */
    uint64_t vertex_bytes; /* GPU: all of these */
    uint64_t gpu_bytes;    /* the sum of these five */
    uint64_t update_bytes; /* that one update sends at most: all targets of all instances active */
    noh_gl_morph_costs costs;
} noh_gl_morph_plan;

typedef struct noh_gl_morph noh_gl_morph;
struct noh_gl_mesh; /* gl_draw.h */

/* What one update did. */
typedef struct noh_gl_morph_stats {
    uint32_t instances;            /* accumulated again */
    uint32_t draws;                /* accumulation draws, not counting clears */
    uint32_t targets;              /* active targets, summed over instances */
    uint32_t rects, texels, pairs; /* rectangles and texels that were drawn, pairs that were added */
} noh_gl_morph_stats;

#define NOH_LAYERS_STREAMS 2 /* of is_uint */
#define NOH_LAYERS_VERTICES 3

/* Where an instance's accumulated deltas are. The last four numbers go into noh_morph of common_layers.glsl in
 * this order. */
typedef struct noh_gl_morph_binding {
    unsigned texture; /* GL_TEXTURE_2D_ARRAY */
    int is_uint;      /* 1: it holds the bits of floats as RGBA32UI: build your shader with NOH_LAYERS_UINT;
                      * NOH_LAYERS_STREAMS: there is no texture: build it with NOH_STREAMS; NOH_LAYERS_VERTICES: there
                      * is nothing to add: with NOH_VERTICES, or not at all */
    int layer_count;  /* 2: it has no layer of tangents: build your shader with NOH_TWO_LAYERS */
    /* Finished vertices: noh_gl_mesh_bind. There is no texture then, and `touched` is 0 */
    unsigned vertex_buffer;                      /* else 0 */
    unsigned vertex_array;                       /* that reads them: noh_gl_morph_set_mesh; else 0 */
    uint32_t vertex_offset, vertex_stride;       /* bytes; a stride of 20 has a tangent */
    int32_t tile_x, tile_y, width_log2, touched; /* texels; log2 of the tile's width; vertices that any target moves */
    /* With NOH_LAYERS_STREAMS, by the weights that the instance has now: noh_gl_morph_bind_streams */
    unsigned stream_buffer;                         /* else 0 */
    uint32_t stream_offsets[NOH_MORPH_STREAMS_MAX]; /* bytes */
    float streams[NOH_MORPH_STREAMS_MAX][4]; /* weight x scale of position, normal, tangent; the widths of the fields */
} noh_gl_morph_binding;

/* Blocks of 4 x 4 accumulation texels that each target's rectangles touch, summed over targets: what the GPU's paths
 * work on. */
uint32_t noh_gl_morph_blocks(const noh_mesh *mesh);

/* Rows of such blocks, summed over rectangles: each is a quad of the blended paths. */
uint32_t noh_gl_morph_strips(const noh_mesh *mesh);

/* Choose the path and measure it, without touching GL.
 * errors  ARG a desc field is out of range; UNSUPPORTED the path of the desc cannot run here, `what` says what is
 *         missing; LIMIT the atlas or a table is larger than textures can be */
noh_result noh_gl_morph_plan_make(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, noh_gl_morph_plan *plan,
                                  noh_error *error);

/* Nanoseconds, once the GPU has done all that it was given: call glFinish first, or where that returns at once, as in
 * browsers, read a pixel back. The library has no clock of its own. */
typedef uint64_t (*noh_gl_clock)(void *user);

/* What was measured. */
typedef struct noh_gl_morph_times {
    noh_morph_path path;               /* the fastest */
    uint64_t ns[NOH_MORPH_PATH_COUNT]; /* by path: the fastest update of all instances; 0: not tried */
    uint32_t rounds[NOH_MORPH_PATH_COUNT];
} noh_gl_morph_times;

/* The memory that noh_gl_morph_calibrate needs. The same errors as noh_gl_morph_plan_make. */
noh_result noh_gl_morph_calibrate_size(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, uint64_t *bytes,
                                       noh_error *error);

/* Measure gather, mrt and cpu, as far as they run here, on the driver itself and with the meshes that will be shown:
 * give desc.path = times->path to noh_gl_morph_init. Weights change in each round, with the share desc.expected_active
 * of the targets active; a round is an update and the wait for it. desc.path is not read, and desc.coarse must be NULL.
 * shapes  memory[bytes], at least noh_gl_morph_calibrate_size; free again afterwards
 * ranges  budget_ns: rounds begin as long as it lasts, and each path has at least one; 50,000,000 is enough. Making
 *         the objects, and with them the driver's compiler, comes on top
 * state   as after noh_gl_morph_update; all GL objects that it made are deleted
 * errors  as noh_gl_morph_init */
noh_result noh_gl_morph_calibrate(void *memory, size_t bytes, const noh_gl_device *device,
                                  const noh_gl_morph_desc *desc, noh_gl_clock clock, void *user, uint64_t budget_ns,
                                  noh_gl_morph_times *times, noh_error *error);

/* Build it in memory[bytes], aligned to NOH_MEMORY_ALIGN and at least plan.cpu_bytes long, and make its GL objects,
 * counted in the device's ledger. All weights are 0 at first. On error no GL object is left.
 * errors  as noh_gl_morph_plan_make; ARG memory is NULL or misaligned; MEMORY it is too small, `need` is
 *         plan.cpu_bytes; GL, MEMORY the driver refused an object; DATA a shader does not compile or link */
noh_result noh_gl_morph_init(void *memory, size_t bytes, const noh_gl_device *device, const noh_gl_morph_desc *desc,
                             noh_gl_morph **morph, noh_error *error);

/* Delete the GL objects. The memory is yours again. */
void noh_gl_morph_delete(noh_gl_morph *morph);

/* The same where the context was lost (gl_lost.h): no GL is called. It may be restored later. */
void noh_gl_morph_forget(noh_gl_morph *morph);

/* Make its GL objects again in a new context (gl_lost.h). Weights stay; the next noh_gl_morph_update accumulates every
 * instance. `log` as in noh_gl_program_create.
 * errors  GL, MEMORY, DATA as noh_gl_morph_init: it then has no GL objects, and may be restored again */
noh_result noh_gl_morph_restore(noh_gl_morph *morph, char *log, size_t log_bytes, noh_error *error);

const noh_gl_morph_plan *noh_gl_morph_plan_of(const noh_gl_morph *morph);

/* The number of the i-th instance of the m-th mesh. */
uint32_t noh_gl_morph_instance(const noh_gl_morph *morph, uint32_t mesh, uint32_t i);

/* Set an instance's weights[target_count of its mesh]: any finite values, below 0 and above 1 too.
 * errors  ARG a weight is not finite, `where` is its index; nothing is changed */
noh_result noh_gl_morph_set_weights(noh_gl_morph *morph, uint32_t instance, const float *weights, noh_error *error);

/* Accumulate only what an LOD level of an instance's mesh needs. Draw the instance at this level or a coarser one;
 * while two levels fade, pass the finer. The level's accumulation texels have the same bits as at level 0, except that
 * targets without a rectangle in the level do not move it. The instance's binding stays the same. A finer level is
 * accumulated by the next update; a coarser one costs nothing and takes effect when the weights next change. ranges
 * level 0 is the full mesh; clamped to the levels of the mesh in the desc */
void noh_gl_morph_set_lod(noh_gl_morph *morph, uint32_t instance, uint32_t level);

/* Accumulate the instances whose weights or level changed. stats may be NULL.
 * state   gl_state.h: bindings of units 0 to 2 are empty. No state is changed if no instance changed
 * errors  none: init checked everything */
void noh_gl_morph_update(noh_gl_morph *morph, noh_gl_morph_stats *stats);

/* With desc.coarse: upload the next piece of what the finest of `meshes` is accumulated from, which is not in use yet.
 * ranges   from: the mesh, whole, at the finest level of `meshes` or a finer one; *at: 0 at first, then as the call
 *          before left it; *bytes: at most so many, at least 256 for any progress; what was sent is subtracted
 * state    texture 0 of unit 0, the active one
 * returns  1 once all is there */
int noh_gl_morph_fill(noh_gl_morph *morph, const noh_mesh *from, uint32_t *at, uint32_t *bytes);

/* With desc.coarse: from now on no finer level than `mesh` is accumulated, and what targets change is taken from its
 * pack, which must stay as long. The next update accumulates each instance whose level changes by that.
 * mesh  whole: as desc.coarse was, or as noh_gl_morph_fill was given, once that has sent all of it */
void noh_gl_morph_use(noh_gl_morph *morph, const noh_mesh *mesh);

/* With finished vertices: make a vertex array for each instance of a mesh and each buffer of the ring, so that no draw
 * points attributes anew, which drivers look up states for. Call it after init and after each restore; without it
 * noh_gl_mesh_bind points the mesh's own array there and back. Elsewhere it does nothing.
 * mesh    index in the desc
 * drawn   by which the mesh is drawn; its buffers must stay
 * errors  GL the driver refuses: there are then none of this mesh */
noh_result noh_gl_morph_set_mesh(noh_gl_morph *morph, uint32_t mesh, const struct noh_gl_mesh *drawn, noh_error *error);

noh_gl_morph_binding noh_gl_morph_binding_of(const noh_gl_morph *morph, uint32_t instance);

/* Which targets the path streams adds: those whose weight is not 0, of more than four the four with the largest
 * |weight| x radius, in index order.
 * shapes   weights[target_count]
 * returns  their number */
uint32_t noh_gl_morph_streamed(const noh_mesh *mesh, const float *weights, uint32_t targets[NOH_MORPH_STREAMS_MAX]);

/* Point the attributes NOH_ATTRIBUTE_STREAMS and up of the bound vertex array to an instance's streams, and set the
 * uniform noh_streams of `program`, which is in use. Does nothing on other paths. The vertex array keeps the buffer:
 * delete the mesh when the accumulator is deleted. */
void noh_gl_morph_bind_streams(const noh_gl_api *api, unsigned program, const noh_gl_morph_binding *binding);

#ifdef __cplusplus
}
#endif

#endif
