/* Grid lines across one direction. */
#ifndef MASK_AXIS_H
#define MASK_AXIS_H

enum { MAX_LINES = 128, MAX_ANCHORS = 8 };

/* Anchors are positions at which a line must lie exactly: slits begin and end there. */
typedef struct {
    int count;
    double at[MAX_LINES];
    int anchor[MAX_ANCHORS];
} Axis;

/* Lines from -half to half, spaced in proportion to `spacing`. */
void axis_spread(Axis *axis, int count, double half, double (*spacing)(double));

/* Moves the nearest line onto each anchor, and the lines between in step. */
void axis_snap(Axis *axis, const double *anchors, int anchor_count);

#endif
