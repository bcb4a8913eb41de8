/* obj_polygon.h: cuts a polygon into triangles.
 *
 * source  Eberly, Triangulation by Ear Clipping, 2002 */
#ifndef NOH_CONVERT_OBJ_OBJ_POLYGON_H
#define NOH_CONVERT_OBJ_OBJ_POLYGON_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The most corners of a polygon that is not convex: the time grows with their square. */
#define OBJ_CONCAVE_MAX 16384u

/* A convex polygon becomes a fan about its first corner. Another one loses ears, which are corners whose triangle holds
 * no other; one that crosses itself loses what comes nearest to an ear.
 * points     [count][3], count at least 3; need not lie in one plane
 * triangles  [count - 2][3] places among the points
 * Returns 0; 1 when out of memory; 2 where it is not convex and has more than OBJ_CONCAVE_MAX corners. */
int obj_polygon_cut(const float *points, uint32_t count, uint32_t *triangles);

#ifdef __cplusplus
}
#endif
#endif
