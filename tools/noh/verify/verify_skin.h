/* verify_skin.h: skinned meshes on the GPU against the CPU, in the poses of the pack's clips. */
#ifndef NOH_NOH_VERIFY_VERIFY_SKIN_H
#define NOH_NOH_VERIFY_VERIFY_SKIN_H

#include "gpu/gpu.h"
#include "file/pack_file.h"
#include "noh/pack.h"
#include "noh/noh_gl.h"

#define VERIFY_SKIN_TIMES 20u /* random times of each clip; as many random poses where no clip fits a skeleton */
/* The allowed error of a vertex, as a share of the larger of the mesh's box and its distance to the origin, at rest and
 * in the pose. The CPU and the GPU round the same products and sums in different orders; a coordinate at a distance d
 * has steps of up to d * 2^-23, however small the mesh is, and 17 of those are allowed. */
#define VERIFY_SKIN_SHARE 2e-6

typedef struct verify_skin {
    double bound_scale; /* given: bounds are multiplied by it */
    uint64_t values;    /* coordinates that were compared */
    double error_um;    /* of the mesh that comes nearest to its bound, or over it */
    double bound_um;
    double normal_error; /* the largest of a component */
    uint64_t cpu_predicted, gpu_predicted, gpu_used;
} verify_skin;

/* 1 where the pack has something to verify. */
int verify_skin_wanted(const noh_mesh *meshes, const noh_pack *pack);

/* Every vertex of every skinned mesh, with random weights. state: of the random numbers. Prints an error and returns an
 * exit code; 0 if it ran, whatever the errors of vertices. All of *out but bound_scale is written. */
int verify_skin_run(gpu *g, const pack_file *file, const noh_mesh *meshes, const noh_gl_mesh *gl_meshes,
                    noh_palette_mode mode, uint64_t *state, verify_skin *out);

#endif
