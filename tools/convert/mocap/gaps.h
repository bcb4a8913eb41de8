/* gaps.h: frames that a camera missed: a joint stood still, fell to zero or was confused with another.
 *
 * Optical capture loses markers behind limbs. The export shows it in one of two ways: the last value is
 * held until the marker comes back, or the value jumps away (to zero, to another marker's) and jumps back. A gap is
 *
 *   held   equal frames, two or more after the first, that end with a jump, in the middle of a motion
 *   away   at most GAPS_LONGEST_S between two jumps, after which the joint is about where it was
 *
 * A jump is a step that the steps before and after do not lead up to. Resting, starting to move or hitting something
 * is not a jump (tests/unit/convert/test_mocap.c tries all known clips). */
#ifndef NOH_CONVERT_MOCAP_GAPS_H
#define NOH_CONVERT_MOCAP_GAPS_H

#include "convert/clips/raw_clip.h"

#define GAPS_LONGEST_S 1.0

typedef struct gaps_report {
    uint32_t filled, frames, tracks; /* gaps and their frames, each track by itself; tracks that had any */
    uint32_t left;                   /* longer than GAPS_LONGEST_S: not touched */
    double longest_s;                /* of those filled */
} gaps_report;

/* Fill them by cubic Hermite curves (quaternions in modified Rodrigues parameters about the gap's first frame), whose
 * slopes come from up to three steps on each side. Frames outside of gaps keep their bits. Adds to *report. Returns
 * 1 when out of memory. */
int gaps_fill(const raw_skeleton *skeleton, raw_clip *clip, gaps_report *report);

#endif
