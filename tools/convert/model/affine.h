/* affine.h: 4 x 4 matrices whose last row is 0 0 0 1; column-major, double precision. */
#ifndef NOH_CONVERT_MODEL_AFFINE_H
#define NOH_CONVERT_MODEL_AFFINE_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

void affine_identity(double out[16]);
void affine_of_floats(const float in[16], double out[16]);
/* A node's local translation, rotation and scale. */
void affine_of_node(const model_node *node, double out[16]);
/* out = a * b; out may be neither. */
void affine_multiply(const double a[16], const double b[16], double out[16]);
/* Returns 1 if there is no inverse: an axis has no length, or all lie in one plane to within 1e-9. out may not be in.
 */
int affine_invert(const double in[16], double out[16]);
double affine_determinant(const double m[16]);
void affine_point(const double m[16], const double point[3], double out[3]); /* out is not point */
/* The matrix that turns normals as m turns points: the inverse transposed times the determinant; [3][3] columns.
 * The matrix itself would tilt normals under unequal scales. */
void affine_cofactors(const double m[16], double out[9]);

#ifdef __cplusplus
}
#endif
#endif
