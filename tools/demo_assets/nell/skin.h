/* Nell's skin: face, head and neck in one grid, with slits for the eyes and the mouth. */
#ifndef NELL_SKIN_H
#define NELL_SKIN_H

#include "mask/model.h"

/* Landmarks in the plane of shape.h where eyes and mouth are shut. */
#define EYE_S 0.0345
#define EYE_T (-0.0035)
#define EYE_REACH 0.0190
#define MOUTH_T (-0.0435)
#define MOUTH_REACH 0.0220

typedef struct {
    double s, t;
    int eye, mouth; /* side of the slits, as in Seed */
} SkinPoint;

void skin_build(Model *model);
SkinPoint skin_point(const Seed *seed);
V3 skin_place(SkinPoint point, const Pose *pose);
V3 lid_place(const Seed *seed, const Pose *pose);
V3 lip_place(const Seed *seed, const Pose *pose);

/* The lines along which lids and lips meet, the width of a slit (1 in its middle, 0 at its corners), and the edge of
 * the red above (+1) or below (-1) the mouth's line. */
double lids_line(double s);
double lips_line(double s);
double lids_width(double s);
double lips_width(double s);
double red_edge(double s, int side);

/* The ball of an eye, and the depth of a shell `lift` outside it. */
#define EYEBALL 0.0245
V3 eyeball(int side);
double eyeball_shell(int side, double x, double y, double lift);

/* Turns a point that follows the jaw by `weight`, 0 to 1, about its hinge. */
V3 jaw_turn(V3 at, double weight, const Pose *pose);

#endif
