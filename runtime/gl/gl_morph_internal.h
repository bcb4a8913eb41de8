/* gl_morph_internal.h (private to gl_morph*.c): how an accumulator is laid out. */
#ifndef NOH_GL_GL_MORPH_INTERNAL_H
#define NOH_GL_GL_MORPH_INTERNAL_H

#include "base/arena.h"
#include "deform/morph.h"
#include "gl/gl_morph.h"
#include "gl/gl_table_internal.h"

#define NOH_GATHER_CHUNK 2048u /* entries that gather builds at once at load: 32 KiB */
#define NOH_STREAM_STRIDE 12u  /* bytes of a vertex in a stream */
#define NOH_STREAM_CHUNK 3072u /* bytes of streams that are sent at once at load */
#define NOH_RECT_CHUNK 256u    /* rectangles that are sent at once at load */

/* One mesh of the desc. Its instances' tiles fill a band of the atlas, row by row. */
typedef struct noh_gl_morph_mesh {
    noh_mesh mesh;
    uint32_t instance_count, first_instance;
    uint32_t first_weight; /* into weights */
    uint32_t columns, band_y;
    uint32_t owner; /* the mesh of the desc whose part of the tables this one uses: itself, or a finer LOD level */
    /* where an owner's part begins */
    uint32_t first_rect;  /* into the rect table (blended paths) */
    uint32_t first_texel; /* into the delta table */
    uint32_t first_start; /* into the starts table (gather) */
    uint32_t first_pair;  /* into the entry table (gather) */
} noh_gl_morph_mesh;

struct noh_gl_morph {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    noh_gl_morph_plan plan;
    uint32_t mesh_count;
    uint32_t table_count;      /* mesh_count, and 1 where there is desc.coarse: its tables are the last */
    noh_gl_morph_mesh *meshes; /* [table_count] */
    noh_mesh source;           /* with desc.coarse: the finest level that is accumulated, in the pack that has it */
    uint32_t *instance_mesh;   /* [instance_count] */
    uint8_t *dirty;            /* [instance_count] */
    uint8_t *levels;           /* [instance_count] LOD level that is accumulated; none is finer than its mesh */
    uint32_t dirty_count;
    float *weights;    /* [weight_count], instance after instance */
    uint32_t *records; /* [weight_count][4] of the active targets: staging of the record table */
    void *staging;     /* rect records, gather's tiles, or the CPU's layers; at load, chunks of the tables */
    size_t staging_bytes;
    noh_morph_kernel kernel; /* of the path cpu */
    int wide; /* a rect record, the indices of a rectangle and a target's record, is 2 x 32 bits instead of 2 x 16 */

    noh_gl_texture layers;
    noh_gl_table deltas; /* delta texels by rectangle, or gather's entries */
    noh_gl_table rects;  /* rectangles, or gather's starts */
    noh_gl_table record_table;
    noh_gl_buffer stream; /* rect records, gather's tiles, or the streams */
    GLuint vertex_array, program;
    GLuint framebuffers[3];
    GLint u_layer;
};

/* Place tiles and tables, and count. `meshes` NULL only counts. */
noh_result noh_gl_morph_layout(const noh_gl_morph_desc *desc, uint32_t texture_size_max, noh_gl_morph_mesh *meshes,
                               noh_gl_morph_plan *plan, noh_error *error);

/* Carve everything behind the struct itself from an arena. `m` NULL only measures. */
void noh_gl_morph_carve(noh_arena *arena, const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan,
                        noh_gl_morph *m);

/* With occlusion, gather's table of starts has a number for each target in front of an owner's starts, the first
 * target's last: noh_transfer_ratio. */
uint32_t noh_gl_morph_ratio_count(const noh_mesh_header *h, uint32_t occlusion);

/* 1 when rect records need 32 bits. */
int noh_gl_morph_wide(const noh_gl_morph_plan *plan);

/* Rows from one tile to the next: a multiple of four. Rasterisers work in blocks of 2 x 2 to 4 x 4 pixels, and the
 * converter cuts rectangles along those blocks, so every tile must be aligned to them (an eighth less work for mrt with
 * 100 heads on llvmpipe). */
uint32_t noh_gl_morph_pitch(const noh_mesh_header *header);

/* Whether the tables of a mesh of the desc, or of desc.coarse behind them, are uploaded when they are made. */
static inline int noh_gl_morph_is_there(const noh_gl_morph *m, uint32_t mesh)
{
    return m->meshes[mesh].owner == mesh && (m->table_count == m->mesh_count || mesh == m->mesh_count);
}

/* An instance's mesh at the LOD level that is accumulated. */
noh_mesh noh_gl_morph_view(const noh_gl_morph *m, uint32_t instance);
/* The mesh of the desc whose part of the tables an instance uses. */
const noh_gl_morph_mesh *noh_gl_morph_tables(const noh_gl_morph *m, uint32_t instance);

void noh_gl_morph_tile(const noh_gl_morph *m, uint32_t instance, uint32_t *x, uint32_t *y);
/* Where an instance's weights begin, and so its row of records in the gather path. */
uint32_t noh_gl_morph_first_weight(const noh_gl_morph *m, uint32_t instance);

/* Write the record of a target: weight * scale for each layer, and a last word that the paths use differently. */
void noh_gl_morph_put_record(uint32_t record[4], const noh_target *target, float weight, uint32_t last);

uint32_t noh_gl_morph_target_bits(const noh_target *target);

/* Set u_tables and u_atlas of the path's program. */
void noh_gl_morph_constants(noh_gl_morph *m);

/* Make the buffer and the vertex array of the instanced draws: one integer attribute, one element per instance. */
noh_result noh_gl_morph_stream(noh_gl_morph *m, const char *attribute, GLint components, GLenum type, noh_error *error);

/* Bind what a draw reads; leave the state that noh_gl_morph_update promises. */
void noh_gl_morph_begin(const noh_gl_morph *m);
void noh_gl_morph_end(const noh_gl_morph *m);

/* The paths: make their GL objects, and do one update. */
noh_result noh_gl_morph_init_blend(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error);
noh_result noh_gl_morph_init_gather(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error);
int noh_gl_morph_fill_blend(noh_gl_morph *m, const noh_mesh *from, uint32_t *at, uint32_t *bytes);
int noh_gl_morph_fill_gather(noh_gl_morph *m, const noh_mesh *from, uint32_t *at, uint32_t *bytes);
void noh_gl_morph_update_blend(noh_gl_morph *m, noh_gl_morph_stats *stats);
void noh_gl_morph_update_gather(noh_gl_morph *m, noh_gl_morph_stats *stats);
void noh_gl_morph_update_cpu(noh_gl_morph *m, noh_gl_morph_stats *stats);
noh_result noh_gl_morph_init_streams(noh_gl_morph *m, noh_error *error);
void noh_gl_morph_update_streams(const noh_gl_morph *m, noh_gl_morph_stats *stats);
uint64_t noh_gl_morph_stream_bytes(const noh_mesh_header *header);
void noh_gl_morph_set_streams(const noh_gl_morph *m, uint32_t instance, noh_gl_morph_binding *binding);

/* A framebuffer over the layers. which: 0 to 2 for one layer, or one of these. */
#define NOH_LAYERS_ALL 3     /* all as draw buffers */
#define NOH_LAYERS_LAYERED 4 /* all as a layered attachment */
noh_result noh_gl_morph_framebuffer(noh_gl_morph *m, int which, GLuint *framebuffer, noh_error *error);

#endif
