/* compare.h: shared by the files of the comparison with meshoptimizer.
 *
 *   peer_levels     the levels of Debian's meshoptimizer at our triangle counts
 *   peer_npm_*      the levels of npm's version, which is given the targets, too
 *   shapes_*        poses that the builder did not see, named faces
 *   faults_of       turned UVs, non-manifold edges
 *   canvas_*        a software z-buffer, for what shows and for pictures
 *   figures_*       all of it as numbers
 *   pictures_write  and as pictures */
#ifndef NOH_LOD_COMPARE_COMPARE_H
#define NOH_LOD_COMPARE_COMPARE_H

#include "convert/lod/lod.h"
#include "convert/lod/lod_frames.h"

/* ---- the peer: peer.c ---- */

/* meshopt_simplify for each submesh, down to our number of triangles. Ends the program when out of memory. */
lod *peer_levels(const model_mesh *mesh, const lod *ours);
/* Memory for a level with no more indices than the mesh; lod_free frees it. */
void peer_level_new(const model_mesh *mesh, lod_level *out);

/* ---- the peer from npm: peer_npm.c, principal.c, meshopt.mjs ---- */

#define PEER_WEIGHTS 10u

typedef struct peer_npm {
    float weights[PEER_WEIGHTS]; /* of the targets: 0 is positions alone, 1 is as much as positions */
    lod *levels[PEER_WEIGHTS];   /* with each weight */
    float kept;                  /* of the sum of the targets' squares, what the attributes hold: 0 to 1 */
} peer_npm;

/* simplifyWithAttributes for each submesh and weight, down to our number of triangles, by node with the program
 * `script`; files are left in `folder`. Returns 1, and *out is empty, if node, the package or the files fail. */
int peer_npm_levels(const model_mesh *mesh, const lod *ours, const char *script, const char *folder, peer_npm *out);
void peer_npm_free(peer_npm *p);

/* The targets' deltas in sizes of the mesh, projected onto the `count` directions in which they vary most:
 * [vertex_count][count], to be freed. *kept: see peer_npm. */
float *principal_of(const model_mesh *mesh, uint32_t count, float *kept);

/* ---- poses: shapes.c ---- */

typedef struct shapes {
    uint32_t mix_count, frame_count;
    float **poses; /* [mix_count + frame_count][vertex_count][3] */
} shapes;

/* Random mixes with another seed than the builder's, and frames at random times of the clips that move the skin. */
void shapes_make(const model *m, uint32_t mesh, uint32_t mixes, uint32_t frames, shapes *out);
void shapes_free(shapes *s);

/* Weights that shut both eyes, or open the mouth. Returns 0 if the mesh has no such targets. */
int shapes_eyes_shut(const model_mesh *mesh, float *weights);
int shapes_mouth_open(const model_mesh *mesh, float *weights);
/* Positions and, unless NULL, unit normals. */
void shapes_mixed(const model_mesh *mesh, const float *weights, float *position, float *normal);

/* ---- faults: faults.c ---- */

typedef struct faults {
    uint32_t uv_flips;     /* triangles whose UVs run against the UVs of most triangles of their island */
    uint32_t non_manifold; /* edges of more than two triangles, with vertices at one position counted as one */
} faults;

void faults_of(const model_mesh *mesh, const uint32_t *indices, uint32_t index_count, faults *out);

/* ---- what is seen: canvas.c ---- */

typedef struct canvas {
    uint32_t width, height;
    float left, top, pixel; /* in the mesh's lengths; looking along -Z */
    float *depth;
    uint8_t *submesh; /* 255: nothing */
    uint8_t *rgb;
} canvas;

canvas canvas_new(float left, float bottom, float right, float top, float pixel);
void canvas_free(canvas *c);
/* Draw a level: triangles that face the camera or have a two-sided material, without the blended ones. */
void canvas_draw(canvas *c, const model *m, const model_mesh *mesh, const lod_level *level, const float *position,
                 const float *normal);
/* Pixels in which a submesh is in front. */
uint32_t canvas_count(const canvas *c, uint32_t submesh);
/* Copy a picture into a sheet of RGB, `shrink` x `shrink` pixels averaged to one. */
void canvas_paste(const canvas *c, uint32_t shrink, uint8_t *sheet, uint32_t sheet_width, uint32_t x, uint32_t y);

/* ---- figures: report.c ---- */

/* Of one level: lengths in millimetres, areas in square millimetres. */
typedef struct figures {
    uint32_t triangles, main_triangles;            /* of all submeshes; of the largest one */
    float targets, mixes, frames, rest_p99;        /* of the largest submesh: the largest distances */
    float others;                                  /* of all other submeshes, in any of those poses */
    float eyes_open, eyes_shut, teeth, teeth_skin; /* seen from the front; teeth_skin: with all but the skin in full */
    faults faults;
} figures;

void figures_of(const model *m, const model_mesh *mesh, const lod_level *level, const shapes *unseen, figures *out);
/* The largest distance of the largest submesh over targets and mixes, in millimetres. */
float figures_skin(const model_mesh *mesh, const lod_level *level, const shapes *unseen);
/* [level_count] each; npm and weights (of npm's levels, each from 1 on) are NULL where that peer is left out. */
void figures_print(const lod *l, const figures *ours, const figures *peer, const figures *npm, const float *weights);

/* ---- pictures.c ---- */

/* A sheet of the levels, ours above meshoptimizer's, each at the size at which its largest error is one pixel. pixel_mm
 * [level_count]. Returns 0 if the picture could not be written. */
int pictures_write(const model *m, const model_mesh *mesh, const lod *ours, const lod *peer, const float *pixel_mm,
                   const char *path);

/* The submesh of a material, or MODEL_NONE. */
uint32_t find_submesh(const model *m, const model_mesh *mesh, const char *material);
/* Left, bottom, right, top of a submesh's vertices, with a border around them. */
void box_of(const model_mesh *mesh, uint32_t submesh, const float *position, float border, float *box);
/* Zeroed memory; ends the program when there is none. */
void *compare_zeros(size_t count, size_t bytes);

#endif
