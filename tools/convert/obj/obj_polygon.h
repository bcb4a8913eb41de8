/* obj_polygon.h: cuts a polygon into triangles.
 *
 * source  Eberly, Triangulation by Ear Clipping, 2002 */
#ifndef NOH_CONVERT_OBJ_OBJ_POLYGON_H
#define NOH_CONVERT_OBJ_OBJ_POLYGON_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Steps that the polygons of a file may take to be cut, some ten seconds. One of 46,000 corners has no chance to be cut
 * with fewer, and one of 10,000 corners that crosses itself everywhere takes them all. */
#define OBJ_CUT_STEPS (UINT64_C(1) << 31)

/* A convex polygon becomes a fan about its first corner. Another one loses ears, which are corners whose triangle holds
 * no other; one that crosses itself loses what comes nearest to an ear.
 * points     [count][3], count at least 3; need not lie in one plane
 * triangles  [count - 2][3] places among the points
 * steps      OBJ_CUT_STEPS before a file's first polygon
 * Returns 0; 1 when out of memory; 2 where too few steps are left. */
int obj_polygon_cut(const float *points, uint32_t count, uint32_t *triangles, uint64_t *steps);

#ifdef __cplusplus
}
#endif
#endif
