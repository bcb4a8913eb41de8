/* jitter.h: noise of magnetic and other sensors, filtered without changing the motion.
 *
 * How strong: a motion is smooth, so the sixth differences of its samples are the noise's, sqrt(924) times as large;
 * their median ignores hits and falls. That they are noise: the fourth differences, sqrt(70) times as
 * large, give the same strength; if they give much more, both contain motion and the track is unchanged.
 *
 * How far: Butterworth's filter of second order, forward and backward (no delay), at the lowest cut-off whose residual
 * equals the noise (Winter, Biomechanics and Motor Control of Human Movement, 2009, section 3.4.4.3,
 * with a measured noise in place of the line drawn by eye). No sample is moved by more than four times the noise: a
 * larger change was a hit, and stays. */
#ifndef NOH_CONVERT_MOCAP_JITTER_H
#define NOH_CONVERT_MOCAP_JITTER_H

#include "convert/clips/raw_clip.h"

/* Weaker noise than this, per sample, is left: it is what text files and sensors round away. */
#define JITTER_LEAST_DEGREES 0.05
#define JITTER_LEAST_CM 0.02

typedef struct jitter_report {
    uint32_t tracks;           /* that were filtered */
    double degrees, cm;        /* the strongest noise found: root mean square of a sample */
    double cutoff_hz;          /* the lowest used; 0: none */
    double moved_cm, worst_cm; /* how far joints were moved in object space: root mean square, at most */
} jitter_report;

/* Clips of 16 frames and more. A clip marked as a loop is filtered as one. Adds to *report (moved_cm: of this clip).
 * Returns 1 when out of memory. */
int jitter_filter(const raw_skeleton *skeleton, raw_clip *clip, jitter_report *report);

#endif
