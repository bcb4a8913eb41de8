/* framing.h: the space that a figure takes in a clip, so that a camera that follows it keeps it in the picture.
 *
 *   framing_open / framing_close
 *   framing_clip    the box that a clip fills around the camera's target
 *   orbit_sees      the share of a figure's vertices that a camera sees
 *
 * A figure is measured by outline points: of each joint, the vertices that it moves most and that lie farthest out in
 * 26 directions, moved by that joint alone. This is within some millimetres of the skinned surface, and a clip of ten
 * seconds is measured in some milliseconds. */
#ifndef NOH_NOH_DRAW_FRAMING_H
#define NOH_NOH_DRAW_FRAMING_H

#include "figure.h"
#include "noh/low_gl.h"

#define FRAMING_RATE_HZ 15.0 /* how often a clip is measured */

typedef struct framing framing;

/* For a figure's pack and clips, on its own stage without a driver. Prints an error and returns NULL. */
framing *framing_open(const figure_desc *desc);
void framing_close(framing *f);

/* The box of all of a clip, relative to figure_anchor at each moment. Returns 0 where the clip moves no joint, or
 * cannot be played. */
int framing_clip(framing *f, const char *clip, bounds *box);

/* 0..1, of the vertices of the coarsest levels. */
double orbit_sees(const figure *f, const noh_gl_camera *camera);

#endif
