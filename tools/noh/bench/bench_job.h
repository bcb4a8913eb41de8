/* bench_job.h (private to `noh bench`): shared by its files.
 *
 *   bench_timing.c      cells timed in interleaved rounds; medians
 *   bench_weights.c     weights that change every frame, and the vertices that targets move
 *   bench_stage.c       where meshes are drawn: targets, camera, programs
 *   bench_check.c       every method against the CPU reference, before it is timed
 *   bench_paths.c       our five paths, and the unmorphed mesh
 *   bench_before.c      rows morph-before: the path cpu against its form in version 0.1
 *   bench_loops.c       baselines that loop over targets in the vertex shader
 *   bench_quads.c       baseline: one quad per target through a geometry shader
 *   bench_morph.c       rows morph/one-pass, morph/three-pass and frame
 *   bench_crowd.c       rows crowd/100-heads, and cost over pairs
 *   bench_cpu.c         rows morph/cpu
 *   bench_clip*.c       rows clip/ (see bench_clip.h)
 *   bench_match.c       rows clip/match: the search of motion matching against comparing all rows
 *   bench_crowd_pose.c  rows crowd/pose: a thousand characters, posed at the update rate that pixels need
 *   bench_crowd_frame.c rows crowd/cpu and crowd/gpu: frames of a thousand bodies on a stage, with and without LOD
 *   bench_cast.c        rows stage/: frames of a stage, against its parts joined by hand, and without detail
 *   bench_look.c        rows look/: frames with one part of a look, against the plain frame
 *   bench_face.c        rows face/: a thousand living faces, against noh_controller_step
 *   bench_ear.c         row face/ear: live sound heard, against a frame drawn
 *   bench_skin_gpu.c    rows skin/gpu: a crowd in one draw, joints per vertex
 *   bench_skin_cpu.c    rows skin/cpu
 *   bench_sim.c         rows sim/ragdoll: dolls that fall, by lanes
 *   bench_springs.c     rows sim/spring: characters whose joints swing
 *   bench_ik.c          rows sim/two-bone, sim/feet, sim/retarget: a leg, both feet on a slope, a pose on another figure
 *   bench_hair.c        rows sim/hair, sim/hair_points: control hairs of a head that shakes
 *   bench_agents.c      rows crowd/agents: a crowd's steps against ORCA's
 *   bench_people.c      rows crowd/people: the share of agents and walkers in a frame of a thousand bodies
 *   bench_wire.c        rows wire/: the wire form unpacked, against memcpy and zstd
 *   bench_report.c      prints rows and storage
 *
 * A method is one way to morph a mesh: one of ours, a baseline, or none at all.
 * All of them draw the same triangles with the same fragment shader and give it
 * the same position and normal. */
#ifndef NOH_NOH_BENCH_BENCH_JOB_H
#define NOH_NOH_BENCH_BENCH_JOB_H

#include "gl/device/gl_timer_internal.h"
#include "gl/device/gl_memory_internal.h"
#include "noh/deform.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gpu/gpu.h"
#include "file/pack_file.h"

/* ---- rows ---- */

typedef struct bench_row {
    char name[64], baseline[32];
    double ratio;     /* the baseline's cost over ours: above 1, ours is cheaper */
    double value;     /* our cost */
    const char *unit; /* of value */
    uint32_t runs;
} bench_row;

typedef struct bench_rows {
    bench_row *rows;
    uint32_t count, capacity;
    int failed; /* out of memory */
} bench_rows;

/* ours and theirs in the same unit; ours at or below nothing gives an infinite ratio. */
void bench_add_row(bench_rows *rows, const char *name, const char *baseline, double theirs, double ours,
                   const char *unit, uint32_t runs);

/* ---- weights ---- */

#define BENCH_FRAMES 16u /* sets of weights, taken in turn */

typedef struct bench_weights {
    uint32_t target_count, active; /* active: weights that are not zero */
    float *frames;                 /* [BENCH_FRAMES][target_count] */
    double pairs, texels;          /* that a frame touches, on average */
} bench_weights;

/* `active` of the targets at a time, every one of them in turn. 0 on success. */
int bench_weights_open(bench_weights *w, const noh_mesh *mesh, uint32_t active);
void bench_weights_close(bench_weights *w);
const float *bench_weights_of(const bench_weights *w, uint32_t frame);

/* The deltas of one target at weight 1, into layers that noh_morph_layers_init placed. */
void bench_target_deltas(const noh_mesh *mesh, uint32_t target, float *weights, const noh_morph_layers *layers);

/* ---- time ---- */

typedef struct bench_clock {
    const noh_gl_api *gl; /* NULL: nothing to finish */
    noh_gl_timer gpu;     /* where the GL is hardware */
    int is_gpu;
    const char *what; /* "process CPU time" or "GPU time" */
} bench_clock;

/* Process CPU time for a software rasteriser and for no GL at all (g NULL), else GPU timers. */
void bench_clock_open(bench_clock *clock, gpu *g);
void bench_clock_close(bench_clock *clock);

/* One thing to time. */
typedef struct bench_cell {
    void (*work)(void *self, uint32_t frame);
    void *self;
    uint32_t repeats;
    uint32_t frame;  /* runs on from sample to sample, so that weights always change */
    double *samples; /* [rounds] nanoseconds per repeat */
} bench_cell;

typedef struct bench_cells {
    bench_cell *cells;
    uint32_t count, capacity, rounds;
    int failed;
} bench_cells;

/* Add a cell; its index, to ask for its samples later. */
uint32_t bench_add_cell(bench_cells *cells, void (*work)(void *self, uint32_t frame), void *self);
/* Calibrate each cell to at least sample_ns, then time all of them, round after round, up to the requested
 * number, or fewer if that would take long; cells->rounds has the number. `what` for progress. */
int bench_run_cells(bench_cells *cells, bench_clock *clock, uint32_t rounds, double sample_ns, const char *what);
void bench_free_cells(bench_cells *cells);
double bench_median(const bench_cells *cells, uint32_t cell);
/* A tenth of the samples is faster than this: more reliable than the median on a shared machine. */
double bench_low_tenth(const bench_cells *cells, uint32_t cell);
/* The median over rounds of cell minus floor: both were timed in the same round. */
double bench_median_above(const bench_cells *cells, uint32_t cell, uint32_t floor);
double bench_median_of(double *values, uint32_t count); /* sorts them */

/* ---- drawing ---- */

typedef enum bench_pass { BENCH_COLOR, BENCH_DEPTH, BENCH_CHECK, BENCH_PASS_COUNT } bench_pass;

#define BENCH_FRAME_SIZE 512u

typedef struct bench_stage {
    gpu *g;
    const noh_mesh *mesh;
    noh_gl_mesh gl_mesh;
    GLuint framebuffer;
    noh_gl_renderbuffer depth;
    noh_gl_texture color, white;
} bench_stage;

int bench_stage_open(bench_stage *s, gpu *g, const noh_mesh *mesh);
void bench_stage_close(bench_stage *s);

typedef struct bench_method {
    char name[32];
    GLuint programs[BENCH_PASS_COUNT];
    const noh_gl_mesh *mesh; /* the drawn mesh: the same triangles for all */
    const uint32_t *order;   /* [vertex_count] drawn vertex -> pack vertex, or NULL where they are the same */
    int is_baseline;
    double slack; /* error allowed to this method on top of the common one, model units */
    double normal_slack;
    uint32_t most_targets;   /* that it morphs at once; 0: any number. It has rows of so few alone */
    int normals_of_one_only; /* normals agree with a linear sum only while one target is active at weight 1 */
    void *self;
    void (*prepare)(void *self, const float *weights); /* once a frame; NULL: nothing to do */
    const noh_gl_morph_binding *binding;       /* whose finished vertices a draw takes, if it has any; NULL: none */
    void (*bind)(void *self, bench_pass pass); /* textures and uniforms; the program is in use; NULL: none */
    void (*close)(void *self);                 /* NULL: nothing to delete */
} bench_method;

/* Compile bench_mesh.vert for a method's three passes: `defines` selects how it morphs. */
int bench_programs(bench_stage *s, bench_method *m, const char *defines);
void bench_method_close(bench_stage *s, bench_method *m);

/* Draw with rasterisation discarded, once, or three times as a frame with a shadow and a depth pass does. */
void bench_draw_discarded(bench_stage *s, const bench_method *m, int three_passes);
/* A whole lit frame. */
void bench_draw_frame(bench_stage *s, const bench_method *m);

/* 0 when the method gives the positions and normals that the CPU reference gives. */
int bench_check(bench_stage *s, const bench_method *m, const char *subject);

/* ---- methods ---- */

/* Each fills *m. 0 on success, an exit code after a message on failure, -1 without one where this GL lacks it. */
int bench_open_unmorphed(bench_method *m, bench_stage *s);
/* vertices: of the path cpu: finished ones, not sums in a texture */
int bench_open_path(bench_method *m, bench_stage *s, noh_morph_path path, noh_accumulate accumulate, int vertices);
typedef enum bench_loop { BENCH_LOOP_ALL, BENCH_LOOP_HOISTED, BENCH_LOOP_ACTIVE } bench_loop;
int bench_open_dense(bench_method *m, bench_stage *s, bench_loop loop);
int bench_open_filament(bench_method *m, bench_stage *s);
/* artist[vertex_count]: pack vertex -> vertex of the asset; NULL: in the pack's order. */
int bench_open_quads(bench_method *m, bench_stage *s, const uint32_t *artist);

/* ---- the asset's own vertex order ---- */

/* Read the asset that the pack was built from and find its vertex order: out[vertex_count], pack
 * vertex -> asset vertex, to be freed. Prints why not. */
int bench_artist_order(const char *asset, uint32_t mesh_index, const noh_mesh *mesh, uint32_t **out);

/* ---- the job ---- */

typedef struct bench_slope {
    char path[16];
    double ns_per_pair, fixed_us, fit; /* fit: R squared */
    uint32_t draws;                    /* accumulation draws for all heads */
} bench_slope;

/* Memory planned and taken. */
typedef struct bench_memory {
    char name[32];
    uint64_t planned_cpu, planned_gpu, cpu, gpu;
} bench_memory;

#define BENCH_FILES_MAX 8

typedef struct bench_job {
    pack_file files[BENCH_FILES_MAX]; /* the first one's meshes are benched, and the clips of all */
    uint32_t file_count;
    int has_mesh; /* a mesh with targets; without, nothing is drawn: mesh, g, gl_clock and slopes are empty */
    noh_mesh mesh;
    uint32_t mesh_index;
    gpu g;
    bench_clock gl_clock, cpu_clock;
    uint32_t rounds;
    const uint32_t *artist; /* or NULL */
    bench_rows rows;
    bench_slope slopes[8];
    uint32_t slope_count;
    bench_memory memories[8];
    uint32_t memory_count;
    uint64_t crowd_events; /* events that every crowd got, with LOD and without */
    int quick;             /* few bodies: for tests */
    const char *only;      /* the one group of rows to measure; NULL: all */
} bench_job;

int bench_morph(bench_job *job);
int bench_before(bench_job *job);
int bench_crowd(bench_job *job);
int bench_cpu(bench_job *job);
int bench_ear(bench_job *job);
int bench_clip_rows(bench_job *job); /* none where no pack has clips */
int bench_match(bench_job *job);     /* none where no pack has a table */
int bench_crowd_pose(bench_job *job);
int bench_crowd_frame(bench_job *job);
int bench_face(bench_job *job);           /* with the targets of the mesh */
int bench_has_cast(const noh_pack *pack); /* a mesh with joints and levels, and clips for it */
int bench_cast(bench_job *job);           /* none where no mesh has joints and levels, or there are no clips */
int bench_look(bench_job *job);
/* The skinned mesh of the most vertices; no rows where the pack has none. */
int bench_skin_gpu(bench_job *job);
int bench_skin_cpu(bench_job *job);
int bench_sim(bench_job *job);
int bench_springs(bench_job *job);
int bench_hair(bench_job *job);
int bench_ik(bench_job *job);

/* A cell of `count` two-bone solves (body.h), the baseline of springs and hair. self: unused */
#define BENCH_TWO_BONE_SOLVES 1000u
void bench_two_bone(void *self, uint32_t frame);
int bench_agents(bench_job *job);
int bench_wire(bench_job *job);
int bench_people(bench_job *job); /* none where the first pack has no body that walks */

void bench_print(bench_job *job);
int bench_print_json(bench_job *job);

#endif
