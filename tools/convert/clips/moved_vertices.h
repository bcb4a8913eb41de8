/* moved_vertices.h: the vertices that a skeleton moves, and how far they are apart in two poses. */
#ifndef NOH_CONVERT_CLIPS_MOVED_VERTICES_H
#define NOH_CONVERT_CLIPS_MOVED_VERTICES_H

#include "convert/clips/raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MOVED_WEIGHT_LEAST 0.05f /* a joint with less weight does not place the vertex: others do */

/* A vertex lies at the sum of weight * pose[joint] * place over its holds, the strongest first. */
typedef struct vertex_hold {
    uint32_t joint;
    float weight, place[3];
} vertex_hold;

typedef struct moved_vertices {
    uint32_t vertex_count, hold_count, joint_count;
    uint32_t *first;    /* [vertex_count + 1] of its holds */
    vertex_hold *holds; /* [hold_count] */
    float (*boxes)[6];  /* [joint_count] lowest and highest place that each joint holds; lowest above highest: none */
} moved_vertices;

/* Add a mesh's vertices; joints[skin's joint_count]: the skeleton's joints. Returns 1: out of memory. */
int moved_vertices_add(moved_vertices *v, const model_mesh *mesh, const model_skin *skin, const uint32_t *joints);
/* Add a mesh that one joint moves; place[12]: from the mesh to the joint's own space. */
int moved_vertices_add_rigid(moved_vertices *v, const model_mesh *mesh, uint32_t joint, const double *place);
/* All meshes that are bound to a set (skins.h). */
int moved_vertices_add_bound(moved_vertices *v, const model *m, uint32_t set);
/* After the last mesh. The struct is zeroed before the first, and freed also on failure. */
int moved_vertices_close(moved_vertices *v, uint32_t joint_count);
void moved_vertices_free(moved_vertices *v);

/* The largest distance of a vertex between two poses, in their unit, or `floor` if none is larger.
 * a, b     [joint_count][12] object-space matrices, four columns
 * scratch  [joint_count] */
double moved_vertices_apart(const moved_vertices *v, const double *a, const double *b, double floor, double *scratch);

/* Raise out[joint_count] to the distance, in centimetres, from each joint to the vertices that it and the joints below
 * it hold with a weight of at least MOVED_WEIGHT_LEAST, in a pose; `own` != 0: to those that it holds itself. */
void moved_vertices_reach(const moved_vertices *v, const raw_skeleton *skeleton, const double *pose, int own,
                          double *out);

#ifdef __cplusplus
}
#endif
#endif
