/* lod.h: coarser levels of a mesh that can still morph: every target, mixes of targets and frames of clips are poses
 * that the levels have to follow.
 *
 *   lod_build, lod_free     an ordered list of half-edge collapses, and the levels cut from it
 *   lod_cut                 other levels from the same list
 *   lod_certify             the distance between a level and the full mesh, measured both ways
 *
 * A collapse moves one point of the surface onto a neighbour. No vertex is created or changed: the vertices of a level
 * are a subset of the finer level's. lod_fit.h gives coarse levels vertices of their own afterwards.
 *
 * source  Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics" (1997);
 *         Mohr and Gleicher, "Deformation Sensitive Decimation" (2003) and DeCoro and
 *         Rusinkiewicz, "Pose-independent Simplification of Articulated Meshes" (2005), which sum the quadrics of the
 * poses (here the largest counts); Kobbelt, Campagna and Seidel, "A General Framework for Mesh Decimation" (1998) for
 * distances tracked by samples that stay attached to the surface; Dey et al., "Topology Preserving Edge Contraction"
 * (1999) for the link condition. */
#ifndef NOH_CONVERT_LOD_LOD_H
#define NOH_CONVERT_LOD_LOD_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LOD_LEVELS_MAX 16u
#define LOD_POSES_MAX 4096u
#define LOD_STAYS 0xffffffffu

typedef enum lod_mode {
    LOD_QUALITY, /* quadrics choose candidates, tracked samples measure them: tens of seconds for a body */
    LOD_FAST     /* quadrics alone: seconds */
} lod_mode;

/* All zeros is the default. Lengths are in the mesh's own units (metres of the model). */
typedef struct lod_options {
    lod_mode mode;
    uint32_t level_count;      /* 0: four, or no more than LOD_LEVELS_MAX */
    const float *ratios;       /* [level_count] falling shares of the triangles, 0 to 1; NULL: 1, 0.5, 0.25, 0.1 */
    const float *errors;       /* [level_count] rising: the largest cost of each level, instead of ratios */
    float error_max;           /* with ratios: the largest cost, where a share would ask for more; 0: any */
    const float *const *poses; /* [pose_count][vertex_count][3] further shapes, such as frames of clips */
    uint32_t pose_count;
    uint32_t mix_count; /* random mixes of targets as poses; 0: 24 */
    uint64_t mix_seed;  /* 0: a fixed one */
    float pose_weight;  /* factor on distances in `poses`; 0: 0.4, because in motion a body is seen less closely */
    float face_weight;  /* factor on distances at vertices that targets move; 0: 1.2 with poses, else 1 */
    float uv_weight;    /* factor on the length by which UVs slide; 0: 0.1; below 0: ignored */
    float color_length; /* a colour difference of 1 counts as this length, three times that in small parts; 0: see
                           color_edges; below 0: ignored */
    float color_edges;  /* color_length in mean edges; 0: 0.24 */
    float skin_length; /* skin weights that go to other joints entirely count as this length; 0: the mean edge; below 0:
                          ignored */
    uint32_t asset_triangles; /* of all meshes of the asset: a part with few of them is a small part; 0: this mesh's */
    void (*progress)(void *user, uint32_t done,
                     uint32_t total); /* called now and then with the triangles removed; NULL: none */
    void *user;
    uint64_t work_max; /* distances that LOD_QUALITY measures before it continues as LOD_FAST; 0: any number */
} lod_options;

/* One vertex is removed; its triangles use another one. The vertices of one point (several at a seam) stand next to
 * each other with the same step. */
typedef struct lod_collapse {
    uint32_t from, to; /* vertices of the mesh */
    uint32_t step;     /* counts the points collapsed, from 0 */
    float cost; /* distance from the full surface after this collapse, in the worst pose that the builder saw; never
                   falls along the list */
    uint32_t triangles; /* left after it */
} lod_collapse;

typedef struct lod_level {
    uint32_t collapse_count; /* the level is what this many collapses leave */
    uint32_t vertex_count;   /* used ones; vertices of no triangle are in no level */
    uint32_t index_count;    /* of all submeshes */
    uint32_t *indices; /* [index_count] vertices of the mesh, the submeshes one after another, triangles in the mesh's
                          order */
    uint32_t *submesh_first, *submesh_count; /* [submesh_count] into indices */
    float cost;                              /* the largest of its collapses */
} lod_level;

typedef struct lod {
    uint32_t submesh_count, collapse_count, level_count;
    lod_collapse *collapses;
    uint32_t *gone; /* [triangles of the mesh] after how many collapses of the list each is gone; LOD_STAYS: none */
    uint32_t stuck; /* points that no collapse was ever allowed for, of `points` */
    uint32_t points;
    uint32_t least;    /* triangles that hair cards keep in any case */
    uint32_t measured; /* collapses before work_max was reached; of collapse_count */
    lod_level levels[LOD_LEVELS_MAX];
} lod;

/* Simplify. The same input and options give the same result on every machine.
 * ranges  positions, deltas and poses within 1e6; targets' positions not NULL; indices within vertex_count
 * memory  about vertices x poses x 12 bytes, plus 88 bytes for each pair of a vertex and a pose that moves it
 * errors  1 and *error: out of memory, NaN, larger than 1e6, bad ratios, indices out of range, memory above
 * LOD_BYTES_MAX. If a mesh cannot be
 * simplified that far (locked borders, folds) the level has more triangles; that is not an error. */
int lod_build(const model_mesh *mesh, const lod_options *options, lod **out, model_error *error);
#define LOD_BYTES_MAX 2e9 /* of the memory above: more is an error */
/* This memory, bytes; mix_count: 0, the default. */
double lod_bytes(const model_mesh *mesh, uint32_t pose_count, uint32_t mix_count);
void lod_free(lod *l);

/* Cut other levels from the list of collapses: level k is the mesh after the first collapse_counts[k] (rising). The old
 * levels are freed. Returns 1 when out of memory. */
int lod_cut(const model_mesh *mesh, lod *l, const uint32_t *collapse_counts, uint32_t level_count);

/* The distance between two surfaces in one pose, the larger of both directions. */
typedef struct lod_distance {
    float max; /* over a grid of samples on every triangle, and random ones */
    float p99; /* 99 % of the area is nearer than this; measured at rest, else 0 */
} lod_distance;

/* Measure a level against the full mesh, submesh by submesh.
 * level  only its indices, submesh_first and submesh_count are read
 * poses  [pose_count][vertex_count][3] further shapes, as in lod_options
 * out    [submesh_count][1 + target_count + pose_count]: at rest, with each target alone at full weight, in
 *        each pose; zeros for a submesh that draws nothing
 * errors 1 and *error: out of memory */
int lod_certify(const model_mesh *mesh, const lod_level *level, const float *const *poses, uint32_t pose_count,
                lod_distance *out, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
