/* model_build.h: shared by readers and model_complete while they build a model.
 *
 *   model_new      an empty model
 *   model_mesh_clear  frees the contents of a mesh, not the mesh itself
 *   model_warn     add a sentence to the model's warnings
 *   weld_vertices  finds vertices that are one point of the surface
 *   normals_*      fans of smooth corners, and their normals in any pose
 *   tangents_*     groups of corners that share a tangent, likewise; vertices with several are split */
#ifndef NOH_CONVERT_MODEL_MODEL_BUILD_H
#define NOH_CONVERT_MODEL_MODEL_BUILD_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Deltas shorter than this are rounding noise and are stored as exact zeros. */
#define MODEL_DELTA_NOISE 1e-7

model *model_new(void);
void model_mesh_clear(model_mesh *mesh);
/* Remove a mesh that no node draws. */
void model_drop_mesh(model *m, uint32_t mesh);

/* Add a warning (printf form). After MODEL_WARNINGS_MAX the rest is dropped with
 * a note, so that a hostile file cannot fill the memory. Returns 1 when out of memory. */
#define MODEL_WARNINGS_MAX 256u
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
int model_warn(model *m, const char *format, ...);

/* For each vertex, the first vertex that is the same point of the surface: at the same position, and moved alike by
 * every target (two lips that touch are two points). out [vertex_count]. Returns 1 when out of memory. */
int weld_vertices(const model_mesh *mesh, uint32_t *out);
int model_same_floats(const float *a, const float *b, size_t count); /* -0 and +0 are the same */

/* A fan: the corners around one point that share one normal. A vertex is in only one fan, because vertices are never
 * split for normals. */
typedef struct normal_fans {
    uint32_t corner_count, fan_count;
    uint32_t *corner_fan; /* [corner_count]; a corner is an entry of mesh->indices */
    uint32_t *vertex_fan; /* [vertex_count], MODEL_NONE for a vertex of no triangle */
    double *normal;       /* [fan_count][3] of the last normals_evaluate, unit or zero */
} normal_fans;

/* Find the fans of a mesh's base pose: corners of one vertex, and corners of welded
 * vertices whose triangles meet at an edge below the crease angle (60 degrees).
 * Returns 1 when out of memory. */
int normals_build(const model_mesh *mesh, const uint32_t *weld, normal_fans *out);

/* Angle-weighted normals of the fans in one pose: base plus delta.
 * delta    [vertex_count][3] or NULL for the base pose
 * touched  [fan_count] only these are evaluated, the others keep their values; NULL = all
 * A fan without area gets a zero normal. */
void normals_evaluate(normal_fans *fans, const model_mesh *mesh, const float *delta, const uint8_t *touched);
void normals_free(normal_fans *fans);

/* A tangent group: the corners of a fan, which share a tangent. */
typedef struct tangent_groups {
    uint32_t group_count;
    uint32_t *corner_group; /* [index_count]; MODEL_NONE: the triangle has no area, or its UVs have none and no fan
                             * reaches it */
    uint32_t *vertex_group; /* [vertex_count] */
    double *sum;            /* [group_count][3] of the last tangents_evaluate; zero where there are no usable UVs */
    signed char *hand;      /* [group_count] +1 where the UVs run counter-clockwise in the base pose, else -1 */
} tangent_groups;

/* Find the fans of the base pose. A vertex that has several belongs to the one with the hand of its file's tangent and
 * the largest weight. Needs mesh->normal; without mesh->uv every sum is zero. Returns 1 when out of memory. */
int tangents_build(const model_mesh *mesh, tangent_groups *out);

/* Give each further fan of a vertex whose tangent is missing a copy of that vertex.
 * missing   [vertex_count] MODEL_MISSING_* bits
 * *sources  [*count] what was copied, to be freed; the copies follow the vertices that were there
 * Returns 1 when out of memory. */
int tangents_split(tangent_groups *groups, model_mesh *mesh, const uint8_t *missing, uint32_t **sources,
                   uint32_t *count);

/* Angle-weighted tangents in one pose: base plus deltas.
 * position_delta, normal_delta  [vertex_count][3] or NULL
 * uv_delta  [vertex_count][2] or NULL
 * touched  [group_count] only these are evaluated; NULL = all */
void tangents_evaluate(tangent_groups *groups, const model_mesh *mesh, const float *position_delta,
                       const float *normal_delta, const float *uv_delta, const uint8_t *touched);
void tangents_free(tangent_groups *groups);

/* How far the picture slides over the surface for a texture coordinate, in the mean over all triangles, model units: so
 * what a target changes of texture coordinates compares with what it moves. The mesh has some, and vertices. */
double model_uv_length(const model_mesh *mesh);

/* Small vector helpers in double precision; a, b and out are [3]. */
double vec_dot(const double *a, const double *b);
double vec_distance(const double *a, const double *b);
void vec_cross(const double *a, const double *b, double *out);
/* Scale to length 1. Returns 0 and leaves v alone when it has no length. */
int vec_normalize(double *v);
/* Reduce v to its part perpendicular to the unit vector n. */
void vec_reject(double *v, const double *n);
/* Any unit vector perpendicular to the unit vector n. */
void vec_any_perpendicular(const double *n, double *out);
/* The angle between two vectors, 0..pi, to 1e-7. Without libm, whose last bits differ between machines. */
double vec_angle(const double *a, const double *b);
/* A vertex's position or normal in a pose. delta may be NULL. */
void vec_posed(const float *base, const float *delta, uint32_t vertex, double *out);

#ifdef __cplusplus
}
#endif
#endif
