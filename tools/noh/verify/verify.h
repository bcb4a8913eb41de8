/* verify.h (private to cmd_verify.c, verify_*.c): what is compared, and what came of it.
 *
 *   verify_paths    every path and format, SIMD, skins, against the CPU
 *   verify_skin     skinned vertices
 *   verify_rows     which row fails; telling it */
#ifndef NOH_NOH_VERIFY_VERIFY_H
#define NOH_NOH_VERIFY_VERIFY_H

#include "draw/load.h"

typedef struct verify_row {
    const char *path, *accumulate, *reason;
    int available, exact; /* exact: equality is demanded */
    uint64_t values, differing, vertex_values, vertex_differing;
    double max_error_um, bound_um; /* f16 against f32 */
    double max_normal_error;       /* of fetched normals: the GPU's reciprocal root is not exact */
    uint64_t cpu_predicted, cpu_used, gpu_predicted, gpu_used;
    const char *failure; /* which of its values is past its bound: below, NULL: none */
    double failure_value, failure_bound;
} verify_row;

typedef struct verify_job {
    pack_file file;
    scene scene;
    gpu g;
    uint64_t state; /* of the random weights */
    verify_row rows[16];
    int row_count, failed;
    double bound_scale;         /* of skinned vertices */
    const char *memory_failure; /* NULL: memory is as predicted */
    load_options load;          /* of the load whose memory is compared with its budget */
    uint64_t gpu_predicted, gpu_used, cpu_predicted, cpu_used;
} verify_job;

/* Fill job->rows. Prints why it could not and returns an exit code; 0 on success, whatever failed to be equal. */
int verify_paths(verify_job *job);

/* Note the first value of a row that is past its bound, if any is; 1 then. */
int verify_row_failed(verify_row *row);
/* Unless ok, the check fails for this reason. */
void verify_check_memory(verify_job *job, int ok, const char *failure);
/* On stdout. Return an exit code: 0, unless JSON found no memory. */
int verify_print(const verify_job *job);
int verify_print_json(const verify_job *job);

#endif
