/* The painted front: its plane, its depth, and how a pose moves it. */
#ifndef MASK_FACE_H
#define MASK_FACE_H

#include "model.h"

/* Landmarks in the closed face plane, metres. */
#define FACE_HALF_WIDTH 0.0690
#define FACE_HALF_HEIGHT 0.1050
#define EYE_X 0.0310
#define EYE_Y 0.0110
#define EYE_HALF 0.0140
#define MOUTH_Y (-0.0540)
#define MOUTH_HALF 0.0218

typedef struct {
    double s, t;    /* closed face plane */
    int eye, mouth; /* side of the slits, as in Seed */
} FacePoint;

V3 face_place(FacePoint point, const Pose *pose);

/* The lines along which lids and lips meet. */
double eye_line(double s);
double mouth_line(double s);

/* 1 at the middle of a slit, 0 at its corners and beyond. */
double eye_almond(double s);
double mouth_almond(double s);

/* The same, but it widens and softens away from the line between the lips: only on that line must it end at the
 * corners, and a sharp end would show. */
double mouth_gate(double s, double from_line);

/* Half the width of the mask's outline at height t, as a share of its largest. */
double outline_width(double t);

#endif
