/* The arms of the file: what they look like, where they stand, how they move. */
#ifndef ARM_ARMS_H
#define ARM_ARMS_H

#include "tube.h"

enum { BEND, TWIST, CLIP_COUNT };
enum { ARM_COUNT = 4, SEGMENT_COUNT = 2 };

/* One seamless mesh, held by the joints of its tube. */
typedef struct {
    const char *name;
    V3 stand; /* where its lower end is */
    Tube tube;
    int clip;    /* the clip that turns its joints, except the first */
    double turn; /* of each joint at the clip's peak, radians */
    Dye dye;
} Arm;

const Arm *arm_number(int number);

/* The same in two rigid parts: the second's node is a child of the first's and turns about the elbow. */
typedef struct {
    const char *name;
    V3 bone;   /* from the node above */
    Tube tube; /* about its own node */
    Dye dye;
} Segment;

const Segment *segment_number(int number);

/* The hands: one shape over the other's triangles. */
V3 hand_stand(int open);
extern const Dye hand_dye;

/* About which axis a clip turns joints. */
V3 clip_axis(int clip);
const char *clip_name(int clip);
extern const double segment_turn; /* radians, at the peak of BEND */

#endif
