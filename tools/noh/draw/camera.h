/* camera.h: the camera of a picture and what it frames. */
#ifndef NOH_NOH_DRAW_CAMERA_H
#define NOH_NOH_DRAW_CAMERA_H

#include "noh/low_gl.h"

typedef struct bounds {
    double low[3], high[3];
} bounds;

bounds bounds_union(bounds a, bounds b);

typedef struct view_options {
    const char *camera; /* "face", "body" or "AZ,EL,DIST" in degrees and model units; NULL: body */
    uint32_t width, height;
    int around; /* 1: also frames the surroundings of the box */
} view_options;

#define ORBIT_VIEW_RAD 0.5235987755982988 /* the height of the view: 30 degrees */

/* A camera that orbits a centre. Angles in radians, lengths in model units. */
typedef struct orbit {
    double azimuth, elevation, distance;
    double center[3], radius; /* of the sphere that it orbits; the near and far planes enclose it */
    double aspect;            /* width over height */
} orbit;

/* An orbit from the front that frames the box. */
orbit orbit_fit(const bounds *box, double aspect);
/* Its unit axes in the world; `back` points from the centre to the eye. */
void orbit_axes(const orbit *o, double right[3], double up[3], double back[3]);
/* A perspective camera, lit from over the left shoulder. */
void orbit_camera(const orbit *o, noh_gl_camera *camera);

/* The camera of the options, framing the box. 0, or EXIT_USAGE after printing. */
int view_camera(const view_options *o, const bounds *box, noh_gl_camera *camera);
/* 1 if the options frame the face. */
int view_wants_face(const view_options *o);

#endif
