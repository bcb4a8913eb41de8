/* lod.h: coarser levels of a mesh that keep its face: every morph target, mixes of them and frames of clips are poses
 * that the levels have to follow.
 *
 *   lod_build, lod_free     half-edge collapses in order, and the levels cut out of them
 *   lod_certify             how far a level lies from the full mesh, measured both ways
 *
 * A collapse moves one point of the surface onto a neighbour. Nothing new is made: the vertices
 * of a level are a subset of the finer level's, and their data stay as they are.
 *
 * source  Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics" (1997);
 *         Mohr and Gleicher, "Deformation Sensitive Decimation" (2003) and DeCoro and
 *         Rusinkiewicz, "Pose-independent Simplification of Articulated Meshes" (2005), which
 *         add the quadrics of the poses up (here the largest counts); Kobbelt, Campagna and
 *         Seidel, "A General Framework for Mesh Decimation" (1998) for distances tracked by
 *         samples that stay attached to the surface; Dey et al., "Topology Preserving Edge
 *         Contraction" (1999) for the link condition. */
#ifndef NOH_CONVERT_LOD_LOD_H
#define NOH_CONVERT_LOD_LOD_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LOD_LEVELS_MAX 16u
#define LOD_POSES_MAX 4096u

typedef enum lod_mode {
    LOD_QUALITY, /* quadrics choose the candidates, tracked samples measure them: tens of seconds for a body */
    LOD_FAST     /* quadrics only: seconds */
} lod_mode;

/* All zeros is the default. Lengths are in the mesh's own units (metres of the model). */
typedef struct lod_options {
    lod_mode mode;
    uint32_t level_count;      /* 0: four, or no more than LOD_LEVELS_MAX */
    const float *ratios;       /* [level_count] falling shares of the triangles, 0 to 1; NULL: 1, 0.5, 0.25, 0.1 */
    const float *errors;       /* [level_count] rising: instead of ratios, the largest cost that a level may have */
    const float *const *poses; /* [pose_count][vertex_count][3] further shapes, such as frames of clip */
    uint32_t pose_count;
    uint32_t mix_count; /* random mixes of targets as poses; 0: 24 */
    uint64_t mix_seed;  /* 0: a fixed one */
    float pose_weight;  /* factor on distances in the given poses; 0: 0.4, because a moving body is seen as a whole */
    float face_weight;  /* factor on distances at vertices that targets move; 0: 1.2 with poses, else 1 */
    float uv_weight;    /* a UV slide of one length counts as so much of it; 0: 0.1; below 0: none */
    float color_length; /* a colour difference of 1 counts as this length, in a small part as three times as much; 0:
                         * 0.24 of the mean edge; below 0: none */
    float skin_length;  /* all skin weight on other joints counts as this length; 0: the mean edge; below 0: none */
    void (*progress)(void *user, uint32_t done, uint32_t total); /* now and then, triangles taken away; NULL: none */
    void *user;
} lod_options;

/* One vertex is removed; its triangles use another one. The vertices of one point (a seam splits
 * it) follow each other and carry the same step. */
typedef struct lod_collapse {
    uint32_t from, to; /* vertices of the mesh */
    uint32_t step;     /* counts the points collapsed, from 0 */
    float cost; /* distance of the surface from the full one after this collapse, in the worst pose that the builder
                   saw; never falls along the list */
} lod_collapse;

typedef struct lod_level {
    uint32_t collapse_count; /* the level is what these first collapses leave */
    uint32_t vertex_count;   /* that are used; those of no triangle are in no level */
    uint32_t index_count;    /* of all submeshes */
    uint32_t *indices; /* [index_count] vertices of the mesh, the submeshes one after another, triangles in the mesh's
                          order */
    uint32_t *submesh_first, *submesh_count; /* [submesh_count] into indices */
    float cost;                              /* the largest of its collapses */
} lod_level;

typedef struct lod {
    uint32_t submesh_count, collapse_count, level_count;
    lod_collapse *collapses;
    lod_level levels[LOD_LEVELS_MAX];
} lod;

/* Simplify. The same input and options give the same result on every machine.
 * ranges  positions, deltas and poses within 1e5; targets' positions not NULL; indices within vertex_count
 * memory  about vertices x poses x 12 bytes, and 88 bytes for each vertex and pose that moves it
 * errors  1 and *error: out of memory, NaN, larger than 1e5, bad ratios, indices out of range. A mesh that cannot
 *         be simplified so far (locked borders, foldings) is no error: the level has more triangles. */
int lod_build(const model_mesh *mesh, const lod_options *options, lod **out, model_error *error);
void lod_free(lod *l);

/* How far two surfaces are apart in one pose: lengths, the larger of both ways. */
typedef struct lod_distance {
    float max; /* over vertices, a fixed grid on every triangle and random samples */
    float p99; /* 99 % of the area is nearer; at rest only, else 0 */
} lod_distance;

/* Measure a level against the full mesh, each submesh against itself.
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
