/* lod_levels.h: the LOD levels of one mesh as its pack holds them: built, certified, and each vertex's rank. */
#ifndef NOH_CONVERT_LOD_LOD_LEVELS_H
#define NOH_CONVERT_LOD_LOD_LEVELS_H

#include <stdio.h>

#include "noh/base.h"
#include "lod.h"
#include "lod_frames.h"
#include "lod_joints.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All zeros: the full mesh alone. */
typedef struct lod_settings {
    uint32_t level_count; /* counting the full mesh, 2 to NOH_LOD_LEVELS_MAX; 0 and 1: the full mesh alone. LOD_SHARES
                             has the shares of triangles */
    int by_error; /* instead: up to four coarser levels, with costs of 1/4000 of the box's diagonal, and four times as
                     much for each further one */
    lod_mode mode;
    float color_edges; /* of lod_options */
    float own_share;   /* the coarsest levels that together use no more than this share of the mesh's vertices have
                          vertices of their own (lod_fit.h); 0: LOD_OWN_SHARE; below 0, or with LOD_FAST: none has */
    FILE *progress;    /* a terminal, for progress; NULL: none */
    uint32_t
        face_joints; /* where lod_joints_allowed, levels from this one on, or else the coarsest, have virtual joints
                             instead of targets; 0: none has */
} lod_settings;

#define LOD_SHARES                                            \
    {                                                         \
        1.0f, 0.5f, 0.25f, 0.1f, 0.05f, 0.025f, 0.01f, 0.005f \
    }

/* Certified: the largest distances to the full mesh, in the mesh's own units. None is below the finer level's. */
typedef struct lod_errors {
    float rest, rest_p99, targets, pairs, clip;
} lod_errors;

/* The largest of them. */
float lod_worst(const lod_errors *errors);

/* The triangles of one level. */
typedef struct lod_view {
    const uint32_t *indices;       /* submeshes one after another */
    const uint32_t *first, *count; /* [submesh_count] into indices */
} lod_view;

typedef struct mesh_levels {
    uint32_t count; /* 1: the full mesh alone, and all that follows is 0 */
    lod *built;     /* for k >= 1, level k of the mesh is built->levels[which[k]] */
    uint32_t which[NOH_LOD_LEVELS_MAX];
    uint8_t *rank; /* [vertex_count] the coarsest level that a vertex is in */
    lod_errors errors[NOH_LOD_LEVELS_MAX];
    float cap_error[LOD_CAPS]; /* lod_frames.h */
    lod_joints joints;
} mesh_levels;

/* Build and certify the levels of all meshes; out [mesh_count]. By shares, the meshes of an asset have levels of like
 * error: level k of all of them together has its share of all triangles, and each mesh is simplified as far as the
 * others are for one error in world units. So a fringe of hair does not vanish while a smooth body hardly changes.
 * m  vertices that coarse levels have of their own are appended to its meshes, whose triangles stay as they are
 * Returns 1 and *error: out of memory, or as lod_build. Free each in both cases. */
int model_levels_make(model *m, const lod_settings *settings, mesh_levels *out, model_error *error);

/* The levels of one mesh by itself. Levels that would have nearly as many triangles as the finer one are left out.
 * m, mesh  a model that is complete and bound to its skins: clips that move the mesh are sampled for poses
 * Returns 1 and *error: out of memory, or as lod_build. Free in both cases. */
int mesh_levels_make(model *m, uint32_t mesh, const lod_settings *settings, mesh_levels *out, model_error *error);
void mesh_levels_free(mesh_levels *levels);

/* The two halves of mesh_levels_make, for model_levels_make: the order of collapses, to a share of the mesh's triangles
 * (0: to the settings' levels); and what follows once built->levels are there. frames is freed by the second. */
typedef struct lod_part {
    uint32_t asset_triangles; /* lod_options */
    float share;
} lod_part;

int mesh_levels_build(const model *m, uint32_t mesh, const lod_settings *settings, lod_part part, lod_frames *frames,
                      mesh_levels *out, model_error *error);
int mesh_levels_finish(model *m, uint32_t mesh, const lod_settings *settings, lod_frames *frames, mesh_levels *out,
                       model_error *error);

/* A level that is not the full mesh. */
lod_view mesh_levels_view(const mesh_levels *levels, uint32_t level);

#ifdef __cplusplus
}
#endif
#endif
