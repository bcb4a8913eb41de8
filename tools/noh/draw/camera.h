/* camera.h: the camera of a picture and what it frames. */
#ifndef NOH_NOH_DRAW_CAMERA_H
#define NOH_NOH_DRAW_CAMERA_H

#include "noh/low_gl.h"

typedef struct bounds {
    double low[3], high[3];
} bounds;

bounds bounds_union(bounds a, bounds b);
/* About the vertical axis, from +z towards +x, by a multiple of 90 degrees. */
bounds bounds_turned(bounds b, double degrees);

/* What a camera frames. */
typedef enum view_frame {
    FRAME_FULL,
    FRAME_UPPER, /* of a body, from the waist */
    FRAME_FACE,  /* with its hair */
    FRAME_AUTO   /* the face of a head, otherwise all */
} view_frame;

typedef struct view_options {
    const char *camera; /* OPTION_CAMERA; NULL: full */
    uint32_t width, height;
    int around;    /* 1: also frames the surroundings of the box */
    double facing; /* where the front is, in degrees from +z towards +x; AZ,EL without a frame does not turn with it */
} view_options;

#define ORBIT_VIEW_RAD 0.5235987755982988 /* the height of the view: 30 degrees */

/* A camera that orbits a centre. Angles in radians, lengths in model units. */
typedef struct orbit {
    double azimuth, elevation, distance;
    double center[3], radius; /* of the sphere that it orbits; the near and far planes enclose it */
    double aspect;            /* width over height */
} orbit;

/* An orbit from the front that frames the box. facing: where the front is, as in view_options */
orbit orbit_fit(const bounds *box, double aspect, double facing);
/* margin: the share of the picture that stays free at each border; as orbit_fit: 0.024 */
#define ORBIT_MARGIN 0.024
/* Look at the middle of the box from where the orbit looks; all of it is in the picture. */
void orbit_frame(orbit *o, const bounds *box, double margin);
/* Its unit axes in the world; `back` points from the centre to the eye. */
void orbit_axes(const orbit *o, double right[3], double up[3], double back[3]);
/* A perspective camera, lit from over the left shoulder. */
void orbit_camera(const orbit *o, noh_gl_camera *camera);

/* The camera of the options, framing the box. 0, or EXIT_USAGE after printing. */
int view_camera(const view_options *o, const bounds *box, noh_gl_camera *camera);
/* What the options frame. */
view_frame view_frame_of(const view_options *o);
/* Whether they frame something; 0: they give a direction alone. */
int view_frames(const view_options *o);

#endif
