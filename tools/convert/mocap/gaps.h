/* gaps.h: what a camera did not see: frames in which a joint stood still, fell to zero or was taken for another.
 *
 * Optical capture loses markers behind limbs. What was exported then shows it in one of two ways: the last value is
 * held until the marker comes back, or the value jumps away (to zero, to another marker's) and jumps back. A gap is
 *
 *   held   equal frames, two or more after the first, that end with a jump, where the motion around them goes on
 *   away   at most GAPS_LONGEST_S between two jumps, after which the joint is about where it was
 *
 * A jump is a step that those before and after it do not lead up to. What rests, starts to move or hits something
 * is none (tests/unit/convert/test_mocap.c tries all known clips). */
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
 * slopes are those of up to three steps on each side. Frames outside of gaps keep their bits. Adds to *report. Returns
 * 1 when out of memory. */
int gaps_fill(const raw_skeleton *skeleton, raw_clip *clip, gaps_report *report);

#endif
