/* wrinkle_strain.h: how targets compress the surface of a mesh. */
#ifndef NOH_CONVERT_WRINKLE_WRINKLE_STRAIN_H
#define NOH_CONVERT_WRINKLE_WRINKLE_STRAIN_H

#include <stdint.h>

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The principal stretches of a triangle that moves: the singular values of its two-dimensional deformation gradient. */
typedef struct wrinkle_strain {
    double most, least; /* most >= least >= 0; 1: as at rest */
    double axis[3]; /* unit, in the plane at rest: the direction that is stretched by `most`; creases run along it */
} wrinkle_strain;

/* Returns 0 where the triangle has no area at rest: nothing is written. */
int wrinkle_strain_of(double rest[3][3], double now[3][3], wrinkle_strain *out);

/* All targets of a mesh, each alone at weight 1, over the triangles of one material. shrink is 1 - least, from 0 up. */
typedef struct wrinkle_field {
    const model_mesh *mesh;
    uint32_t material;
    uint32_t triangle_count;
    uint32_t *triangles; /* [triangle_count] first index of each in mesh->indices */
    double *area;        /* [triangle_count] at rest */
    float *shrink;       /* [triangle_count][target_count]; 0 where it may be the rounding of coordinates */
    float *largest;      /* [triangle_count] of them */
    /* [triangle_count] sum over targets of shrink^2 * axis * axis^T: xx, yy, zz, xy, xz, yz. Its largest principal axis
     * is the direction that creases should have */
    double (*demand)[6];
    uint32_t *point;      /* [vertex_count] the first vertex at the same place: the points of the surface */
    double *point_area;   /* [vertex_count] of the triangles around a point */
    float *point_shrink;  /* [vertex_count][target_count] their mean */
    float *point_largest; /* [vertex_count] of those */
    double (*tensor)[6];  /* [vertex_count] mean demand of those triangles */
    double shrinking;     /* sum of area * largest */
    uint8_t clamped[2]; /* wrinkle_uv_settle: whether textures of wrinkles end at the edges of u and of v; at first 0 */
} wrinkle_field;

/* Returns 0, or 1: out of memory. Free in both cases. */
int wrinkle_field_make(const model_mesh *mesh, uint32_t material, wrinkle_field *out);
void wrinkle_field_free(wrinkle_field *f);

/* The corner of a triangle of the field. */
static inline uint32_t wrinkle_corner(const wrinkle_field *f, uint32_t triangle, uint32_t corner)
{
    return f->mesh->indices[f->triangles[triangle] + corner];
}

#ifdef __cplusplus
}
#endif
#endif
