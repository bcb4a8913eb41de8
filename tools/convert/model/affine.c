#include "affine.h"

#include <math.h>
#include <string.h>

#include "model_build.h"
#include "convert/base/quat.h"

void affine_identity(double out[16])
{
    for (int i = 0; i < 16; i++) {
        out[i] = i % 5 == 0 ? 1.0 : 0.0;
    }
}

void affine_of_floats(const float in[16], double out[16])
{
    for (int i = 0; i < 16; i++) {
        out[i] = (double)in[i];
    }
}

void affine_of_node(const model_node *node, double out[16])
{
    double q[4], columns[9];
    for (int i = 0; i < 4; i++) {
        q[i] = (double)node->rotation[i];
    }
    (void)quat_normalize(q);
    quat_columns(q, columns);
    affine_identity(out);
    for (int c = 0; c < 3; c++) {
        for (int r = 0; r < 3; r++) {
            out[4 * c + r] = columns[3 * c + r] * (double)node->scale[c];
        }
        out[12 + c] = (double)node->translation[c];
    }
}

void affine_multiply(const double a[16], const double b[16], double out[16])
{
    for (int i = 0; i < 16; i++) {
        double sum = 0.0;
        for (int k = 0; k < 4; k++) {
            sum += a[4 * k + i % 4] * b[i / 4 * 4 + k];
        }
        out[i] = sum;
    }
}

void affine_cofactors(const double m[16], double out[9])
{
    vec_cross(m + 4, m + 8, out);
    vec_cross(m + 8, m, out + 3);
    vec_cross(m, m + 4, out + 6);
}

void affine_point(const double m[16], const double point[3], double out[3])
{
    for (int r = 0; r < 3; r++) out[r] = m[r] * point[0] + m[4 + r] * point[1] + m[8 + r] * point[2] + m[12 + r];
}

double affine_determinant(const double m[16])
{
    double cofactors[9];
    affine_cofactors(m, cofactors);
    return vec_dot(m, cofactors);
}

int affine_invert(const double in[16], double out[16])
{
    double cofactors[9], determinant = affine_determinant(in);
    double size = sqrt(vec_dot(in, in) * vec_dot(in + 4, in + 4) * vec_dot(in + 8, in + 8));
    if (!(fabs(determinant) > 1e-9 * size)) {
        return 1;
    }
    affine_cofactors(in, cofactors);
    affine_identity(out);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            out[4 * c + r] = cofactors[3 * r + c] / determinant;
        }
    }
    for (int r = 0; r < 3; r++) {
        out[12 + r] = -(out[r] * in[12] + out[4 + r] * in[13] + out[8 + r] * in[14]);
    }
    return 0;
}
