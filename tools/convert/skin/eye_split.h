/* eye_split.h: eyeballs that are part of a mesh get joints of their own, so that a gaze can turn them.
 *
 * An eyeball is an island of the mesh (triangles that hang together) whose vertices lie on a sphere; two of one size
 * stand side by side. What is concentric with one, such as a cornea, turns with it. */
#ifndef NOH_CONVERT_SKIN_EYE_SPLIT_H
#define NOH_CONVERT_SKIN_EYE_SPLIT_H

#include <stdio.h>

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A sphere of least squares (linear in centre and r^2 - |centre|^2), through vertices of a mesh. */
typedef struct eye_sphere {
    double centre[3], radius;
    double residual; /* root mean square of the distances from it, as a share of the radius */
} eye_sphere;

/* vertices[count]. 1: they do not span a sphere. */
int eye_sphere_fit(const float *positions, const uint32_t *vertices, uint32_t count, eye_sphere *out);
/* The same of a ball, or of a half one that is closed at its back: what lies inside is left out. `vertices` are sorted.
 * 1: it is none. */
int eye_ball_fit(const float *positions, uint32_t *vertices, uint32_t count, eye_sphere *out);
/* Whether they are two eyes: equal in size, side by side at one height and depth, with room for a nose between. */
int eye_spheres_pair(const eye_sphere *a, const eye_sphere *b);

/* Find the eyes of the first mesh that has any, and add the joints LeftEye and RightEye at their centres: below the
 * joint that moves them, or, in a mesh without a skin, below a new joint Face that moves all else. x is to the left, as
 * in glTF. Call it before clips and skins are made of the model. report: centres and residuals; NULL: quiet.
 * errors  1: there are no eyes, or more than two, or the joint that moves them is ambiguous */
int eyes_split(model *m, FILE *report, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
