/* verify.h (private to cmd_verify.c, verify_*.c): the comparisons and their results.
 *
 *   verify_paths    every path and format, SIMD, skins, against the CPU
 *   verify_skin     skinned vertices
 *   verify_rows     finds rows that fail; prints rows */
#ifndef NOH_NOH_VERIFY_VERIFY_H
#define NOH_NOH_VERIFY_VERIFY_H

#include "draw/figure.h"
#include "noh/pack.h"

typedef struct verify_row {
    const char *path, *accumulate, *reason;
    int available, exact; /* exact: equality is demanded */
    uint64_t values, differing, vertex_values, vertex_differing;
    double max_error_um, bound_um; /* f16 against f32; of streams, against the CPU */
    double max_uv_error;           /* of fetched texture coordinates, of their size where that is above 1 */
    double max_normal_error;       /* of fetched normals: the GPU's reciprocal root is not exact */
    double normal_bound;           /* on top of that: what rounding to pairs of 16 bits allows */
    uint64_t cpu_predicted, cpu_used, gpu_predicted, gpu_used;
    const char *failure; /* which value is past its bound; NULL: none */
    double failure_value, failure_bound;
} verify_row;

typedef struct verify_job {
    pack_file file;
    noh_mesh *meshes; /* [meshes of the pack] at the level that is asked for */
    gpu g;
    uint64_t state; /* of the random weights */
    verify_row rows[24];
    int row_count, failed;
    double bound_scale;         /* of skinned vertices */
    int without_tangents;       /* accumulators of two layers */
    const char *memory_failure; /* NULL: memory was as predicted */
    figure_desc figure;         /* of the stage whose memory is compared with its budget */
    uint64_t gpu_predicted, gpu_used, cpu_predicted, cpu_used;
} verify_job;

/* Fill job->rows. Prints an error and returns an exit code; 0 if the comparisons ran, whatever their results. */
int verify_paths(verify_job *job);

/* Record the first value of a row that is past its bound. Returns 1 if there is one. */
int verify_row_failed(verify_row *row);
/* Unless ok, the check fails for this reason. */
void verify_check_memory(verify_job *job, int ok, const char *failure);
/* Print the results. Return an exit code: 0, or EXIT_FAILED if memory for JSON ran out. */
int verify_print(const verify_job *job);
int verify_print_json(const verify_job *job);

#endif
