/* gl_morph_internal.h (private to gl_morph*.c): how an accumulator is laid out. */
#ifndef NOH_GL_GL_MORPH_INTERNAL_H
#define NOH_GL_GL_MORPH_INTERNAL_H

#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_table_internal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* With finished vertices: make a vertex array for each instance of a mesh and each buffer of the ring, so that draws
 * need not set attribute pointers again, which is slow in drivers. Call it after init and after each restore; without
 * it noh_gl_mesh_bind changes the pointers of the mesh's own array and restores them. Without finished vertices it does
 * nothing.
 * mesh    index in the desc
 * drawn   the noh_gl_mesh that draws the mesh; its buffers must stay
 * errors  GL the driver refused a vertex array; the mesh then has none */
noh_result noh_gl_morph_set_mesh(noh_gl_morph *morph, uint32_t mesh, const struct noh_gl_mesh *drawn, noh_error *error);

/* Get the targets that the path streams adds, in index order: those with nonzero weights, at most the four with the
 * largest |weight| x radius.
 * shapes   weights[target_count]
 * returns  the number of targets */
uint32_t noh_gl_morph_streamed(const noh_mesh *mesh, const float *weights, uint32_t targets[NOH_MORPH_STREAMS_MAX]);

/* Release the GL objects of a lost context without GL calls (gl_device.h). They may be restored later. */
void noh_gl_morph_forget(noh_gl_morph *morph);

/* With desc.coarse: set the finest level to accumulate. Deltas are read from the pack of `mesh`, which must stay as
 * long. The next update accumulates each instance whose level changes.
 * mesh  a whole mesh: the one of desc.coarse, or the one passed to noh_gl_morph_fill after everything is uploaded */
void noh_gl_morph_use(noh_gl_morph *morph, const noh_mesh *mesh);

/* Blocks of 4 x 4 accumulation texels touched by each target's rectangles, summed over targets; the unit of work of the
 * GPU paths. */
uint32_t noh_gl_morph_blocks(const noh_mesh *mesh);

/* Rows of such blocks, summed over rectangles; each is a quad on the blended paths. */
uint32_t noh_gl_morph_strips(const noh_mesh *mesh);

/* As noh_gl_morph_init, without delta data, for meshes that are levels of one: noh_gl_morph_fill uploads it, and only
 * then an update may be made.
 * programs  [2] without and with changes of occlusion (noh_gl_morph_compile); borrowed, also by restores: their names
 *           may change. NULL: as noh_gl_morph_init
 * tiles     filled delta tiles of accumulators with the same key, whose name this one takes; the last that has it
 *           deletes it. NULL: it makes its own
 * errors    UNSUPPORTED the program that it needs is 0; as noh_gl_morph_init */
noh_result noh_gl_morph_init_empty(void *memory, size_t bytes, const noh_gl_device *device,
                                   const noh_gl_morph_desc *desc, const GLuint *programs, const noh_gl_texture *tiles,
                                   noh_gl_morph **morph, noh_error *error);

/* After noh_gl_morph_forget, as noh_gl_morph_restore. tiles: as above. */
noh_result noh_gl_morph_remake(noh_gl_morph *morph, const noh_gl_texture *tiles, char *log, size_t log_bytes,
                               noh_error *error);

/* What the texture of delta tiles depends on, all bytes of it; `mesh` NULL: there is none that others can use. */
typedef struct noh_gl_tiles_key {
    const noh_mesh_header *mesh; /* whose targets it has */
    const noh_transfer_header *transfer;
    uint32_t block_count;
    uint16_t wide, by_block;
} noh_gl_tiles_key;
/* meshes: [count] of a desc without `coarse` */
noh_gl_tiles_key noh_gl_morph_key(const noh_mesh *meshes, uint32_t count, const noh_gl_morph_plan *plan);
noh_gl_tiles_key noh_gl_morph_key_of(const noh_gl_morph *morph);

/* Whether a path sums by a program of its own. */
int noh_gl_morph_has_program(noh_morph_path path);
/* Compile a program for accumulators that share it. Delete it by noh_gl_program_delete.
 * errors  as noh_gl_morph_init */
noh_result noh_gl_morph_compile(const noh_gl_device *device, noh_morph_path path, const noh_gl_morph_desc *desc,
                                int occlusion, GLuint *program, noh_error *error);

/* With desc.coarse: upload the next piece of the delta data of the finest of `meshes`, which is not used yet; after
 * noh_gl_morph_init_empty, of all.
 * ranges   from: the whole mesh, at the finest level of `meshes` or a finer one; *at: initially 0, then as left by the
 *          previous call; *bytes: most bytes to send, at least 256 for progress; the bytes sent are subtracted
 * state    texture 0 of unit 0, the active one
 * returns  1 once everything is uploaded */
int noh_gl_morph_fill(noh_gl_morph *morph, const noh_mesh *from, uint32_t *at, uint32_t *bytes);

#ifdef __cplusplus
}
#endif

#define NOH_TILE_CHUNK 64u       /* tiles of delta texels sent at once at load: at most 16 KiB */
#define NOH_BATCH_QUADS 4096u    /* quads that the blended paths draw at once, 48 bytes each */
#define NOH_BATCH_POINTS 1536u   /* likewise points, 12 bytes each (gl_morph_blend.c) */
#define NOH_BATCH_ENTRIES 16384u /* list entries that gather sends at once, more only if one instance has more */
#define NOH_STREAM_STRIDE 12u    /* bytes of a vertex in a stream */
#define NOH_STREAM_CHUNK 3072u   /* bytes of streams sent at once at load */
#define NOH_VERTEX_CHUNK 1024u   /* finished vertices sent at once if buffers cannot be mapped */
#define NOH_VERTEX_RING_MAX 3u

/* One mesh of the desc. Its instances' tiles fill a band of the atlas, row by row. */
typedef struct noh_gl_morph_mesh {
    noh_mesh mesh;
    uint32_t instance_count, first_instance;
    uint32_t first_weight; /* index into weights */
    uint32_t columns, band_y;
    uint32_t owner; /* the mesh of the desc whose tables this one uses: itself, or a finer LOD level */
    /* where an owner's data begins */
    uint32_t first_tile, tile_count; /* of the delta tiles */
    uint32_t first_target;           /* into target_tiles */
    uint32_t first_byte;             /* finished vertices of its instances, in each buffer of the ring */
    /* direct: entries of lists of each instance, and where those and the starts of the first one begin */
    uint32_t list_count, first_list, first_start;
} noh_gl_morph_mesh;

/* The blocks of 4 x 4 accumulation texels of a tile that a rectangle touches: x0..x1-1, y0..y1-1. */
typedef struct noh_gl_blocks {
    uint32_t x0, y0, x1, y1;
} noh_gl_blocks;

/* Upper bounds of the data sent for one draw. */
typedef struct noh_gl_batch {
    uint32_t entries;              /* points, quads, or entries of lists */
    uint32_t positions, instances; /* lists, and for gather their instances */
    uint64_t bytes;                /* blended paths: vertices of all batches of an update */
} noh_gl_batch;

struct noh_gl_morph {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    noh_gl_morph_plan plan;
    uint32_t mesh_count;
    uint32_t table_count;      /* mesh_count, plus 1 with desc.coarse, whose tables are the last */
    noh_gl_morph_mesh *meshes; /* [table_count] */
    noh_mesh source;           /* with desc.coarse: the finest accumulated level, in its own pack */
    uint32_t *instance_mesh;   /* [instance_count] */
    uint8_t *dirty;            /* [instance_count] */
    uint8_t *levels;           /* [instance_count] accumulated LOD level, never finer than the mesh */
    uint32_t dirty_count;
    float *weights;    /* [weight_count], instance after instance */
    uint32_t *records; /* [weight_count][4] of the active targets (blended paths): staging of the record table */
    void *staging;     /* a batch of vertices, gather's lists, or the CPU's layers; at load, chunks of the tables */
    size_t staging_bytes;
    noh_morph_kernel kernel; /* for the path cpu */
    noh_gl_batch batch;
    uint32_t *target_tiles; /* per owner, [target_count]: a target's first tile, in the order of targets */
    uint32_t *slots;        /* [block_count] (lists): position of the tile, in the order of blocks: x | y << 9 */

    /* Finished vertices (gl_morph_vertices.c). A slot is an instance's part of one buffer of the ring. */
    float *slot_weights;   /* [ring][weight_count] weights of each written slot */
    uint8_t *slot_levels;  /* [ring][instance_count] its level; NOH_SLOT_STALE: write it completely */
    uint8_t *slot_drawn;   /* [instance_count] index in the ring */
    GLuint *vertex_arrays; /* [ring][instance_count]; 0: none */
    uint8_t *groups;       /* for the largest mesh; 1: write this group of texels */
    void *finished;        /* [NOH_VERTEX_CHUNK] vertices at most */
    uint32_t update_count;
    noh_gl_buffer ring[NOH_VERTEX_RING_MAX];
    GLsync fences[NOH_VERTEX_RING_MAX - 1u];

    noh_gl_texture layers;
    noh_gl_texture tiles; /* delta texels, in tiles of 4 x 4 (gl_morph_tiles.c) */
    uint32_t tiles_across_log2;
    uint32_t tiles_taken;      /* 1: they were filled when they came */
    noh_gl_table record_table;     /* records of active targets, or lists */
    noh_gl_table starts;           /* where lists begin, by block */
    noh_gl_buffer stream, indices; /* vertices of blocks, gather's instances, or the streams; quads (blended paths) */
    const GLuint *programs;        /* [2] borrowed, by plan.occlusion; NULL: `program` is its own */
    GLuint vertex_array, program;
    GLuint framebuffers[3];
    GLuint a_stream; /* attribute of the stream */
    int flushes;     /* flush between draws of points (gl_morph_blend.c) */
    GLint u_layer, u_tables, u_atlas;
};

/* Place tiles and tables, and count. `meshes` NULL only counts. */
noh_result noh_gl_morph_layout(const noh_gl_morph_desc *desc, uint32_t texture_size_max, noh_gl_morph_mesh *meshes,
                               noh_gl_morph_plan *plan, noh_error *error);

/* Whether the path cpu writes finished vertices. */
int noh_gl_morph_finishes(const noh_gl_morph_desc *desc, noh_accumulate accumulate);

/* Fill plan->costs. The plan has accumulate and layer_count. */
void noh_gl_morph_weigh(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, noh_gl_morph_plan *plan);

/* Carve everything after the struct itself from an arena. `m` NULL only measures. */
void noh_gl_morph_carve(noh_arena *arena, const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan,
                        noh_gl_morph *m);

noh_gl_blocks noh_gl_blocks_of(const noh_rect *rect);

noh_gl_batch noh_gl_morph_batch(const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan);

/* Fill plan->layer_format, wide and points, by its path, accumulate and occlusion. */
void noh_gl_morph_set_formats(const noh_gl_caps *caps, noh_gl_morph_plan *plan);

/* Number of blocks of an instance's tile in the atlas. */
uint32_t noh_gl_morph_positions(const noh_mesh_header *h);

/* Targets may move only vertices below this number: the first ones, if vertex n has texel n. */
uint32_t noh_gl_morph_vertex_end(const noh_mesh_header *h);

/* The texture of the delta tiles of a plan, which is `1 << *across_log2` tiles wide. */
noh_gl_texture_desc noh_gl_morph_tiles_desc(const noh_gl_morph_plan *plan, uint32_t *across_log2);

/* Rows from one tile to the next: a multiple of four. Rasterisers work in blocks of 2 x 2 to 4 x 4 pixels, and the
 * converter cuts rectangles along these blocks, so every tile is aligned to them (an eighth less work for mrt with 100
 * heads on llvmpipe). */
uint32_t noh_gl_morph_pitch(const noh_mesh_header *header);

/* Whether the tables of a mesh of the desc, or of desc.coarse after them, are uploaded at creation. */
static inline int noh_gl_morph_is_there(const noh_gl_morph *m, uint32_t mesh)
{
    return !m->programs && m->meshes[mesh].owner == mesh && (m->table_count == m->mesh_count || mesh == m->mesh_count);
}

/* An instance's mesh at its accumulated LOD level. */
noh_mesh noh_gl_morph_view(const noh_gl_morph *m, uint32_t instance);
/* The mesh of the desc whose tables an instance uses. */
const noh_gl_morph_mesh *noh_gl_morph_tables(const noh_gl_morph *m, uint32_t instance);

void noh_gl_morph_tile(const noh_gl_morph *m, uint32_t instance, uint32_t *x, uint32_t *y);
/* Where an instance's weights begin. */
uint32_t noh_gl_morph_first_weight(const noh_gl_morph *m, uint32_t instance);

/* The weights that it was given last. */
static inline const float *noh_gl_morph_weights_of(const noh_gl_morph *m, uint32_t instance)
{
    return m->weights + noh_gl_morph_first_weight(m, instance);
}

/* Write the record of a target: weight * scale for each layer, and a last word that the paths use differently. */
void noh_gl_morph_put_record(uint32_t record[4], const noh_target *target, float weight, uint32_t last);

/* The widths of fields in an entry's fourth word (shaders_es/common_delta.glsl). */
#define NOH_ENTRY_WIDTHS(position, normal) ((uint32_t)(position) << 18 | (uint32_t)(normal) << 23)

uint32_t noh_gl_morph_target_bits(const noh_target *target);

/* Find u_tables and u_atlas of the path's program, and set them. */
void noh_gl_morph_constants(noh_gl_morph *m);

/* Make the buffer of the draws and its vertex array, with one attribute of `components` uint32_t; `instanced` 1: per
 * instance, 0: per vertex. */
noh_result noh_gl_morph_stream(noh_gl_morph *m, const char *attribute, GLint components, uint64_t bytes,
                               GLuint instanced, noh_error *error);

/* Make the delta tiles, and fill those already loaded. */
noh_result noh_gl_morph_make_tiles(noh_gl_morph *m, noh_error *error);

/* As noh_gl_morph_fill. mesh: the owner's mesh, whose tiles are filled. */
int noh_gl_morph_fill_tiles(noh_gl_morph *m, const noh_gl_morph_mesh *to, const noh_mesh *mesh, uint32_t *at,
                            uint32_t *bytes);

/* Bind the inputs of a draw; restore the state as noh_gl_morph_update promises.
 * kept  NULL at the end: nothing was drawn */
void noh_gl_morph_begin(const noh_gl_morph *m, noh_gl_offscreen *kept);
void noh_gl_morph_end(const noh_gl_morph *m, const noh_gl_offscreen *kept);

/* Lists of active targets for one upload, in the staging memory (gl_morph_lists.c). */
typedef struct noh_gl_lists {
    uint32_t (*entries)[4], (*tiles)[4], *starts, *cursors; /* tiles: of gather's instances */
    uint32_t entry_count, start_count, tile_count;
    uint32_t first_entry; /* index of entries[0] in the table; entry 0 of the table is the empty list */
} noh_gl_lists;

static inline int noh_gl_morph_has_lists(noh_morph_path path)
{
    return path == NOH_MORPH_GATHER || path == NOH_MORPH_DIRECT;
}

noh_gl_lists noh_gl_morph_lists_of(const noh_gl_morph *m);
/* The list of blocks without an active target. */
void noh_gl_morph_put_empty(uint32_t entry[4]);
/* Count the active targets of each block in the cursors; return their sum. */
uint32_t noh_gl_morph_count_lists(const noh_mesh *mesh, const float *weights, noh_gl_lists *l);
/* Append the lists of an instance, whose targets were counted. Its tiles may belong to a finer LOD level: a target's
 * rectangles at a coarser level are its first ones at a finer level. */
void noh_gl_morph_put_lists(noh_gl_morph *m, uint32_t instance, noh_gl_lists *l, noh_gl_morph_stats *stats);

/* The paths: make their GL objects, and do one update. */
noh_result noh_gl_morph_compile_blend(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error);
noh_result noh_gl_morph_compile_gather(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error);
noh_result noh_gl_morph_init_blend(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error);
noh_result noh_gl_morph_init_gather(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error);
void noh_gl_morph_update_blend(noh_gl_morph *m, noh_gl_morph_stats *stats);
void noh_gl_morph_update_gather(noh_gl_morph *m, noh_gl_morph_stats *stats);
noh_result noh_gl_morph_init_direct(noh_gl_morph *m, noh_error *error);
void noh_gl_morph_update_direct(noh_gl_morph *m, noh_gl_morph_stats *stats);
void noh_gl_morph_set_direct(const noh_gl_morph *m, uint32_t instance, noh_gl_morph_binding *binding);
void noh_gl_morph_update_cpu(noh_gl_morph *m, noh_gl_morph_stats *stats);
noh_result noh_gl_morph_init_vertices(noh_gl_morph *m, noh_error *error);
void noh_gl_morph_delete_vertices(noh_gl_morph *m, const noh_gl_api *gl);
void noh_gl_morph_update_vertices(noh_gl_morph *m, noh_gl_morph_stats *stats);
void noh_gl_morph_set_vertices(const noh_gl_morph *m, uint32_t instance, noh_gl_morph_binding *binding);
noh_result noh_gl_morph_init_streams(noh_gl_morph *m, noh_error *error);
void noh_gl_morph_update_streams(const noh_gl_morph *m, noh_gl_morph_stats *stats);
uint64_t noh_gl_morph_stream_bytes(const noh_mesh_header *header);
void noh_gl_morph_set_streams(const noh_gl_morph *m, uint32_t instance, noh_gl_morph_binding *binding);

struct noh_gl_mesh;

/* A vertex array like the mesh's own, except for the vertices finished by `morph`; 0 if the driver refuses. */
GLuint noh_gl_mesh_make_array(const noh_gl_api *gl, const struct noh_gl_mesh *mesh, const noh_gl_morph_binding *morph);

#define NOH_SLOT_STALE 255u

/* A framebuffer over the layers. which: 0 to 2 for one layer, or one of these. */
#define NOH_LAYERS_ALL 3     /* all as draw buffers */
#define NOH_LAYERS_LAYERED 4 /* all as a layered attachment */
noh_result noh_gl_morph_framebuffer(noh_gl_morph *m, int which, GLuint *framebuffer, noh_error *error);

#endif
