/* face.h: what the library keeps to itself of face.h. */
#ifndef NOH_FACE_FACE_H
#define NOH_FACE_FACE_H

#include <stdint.h>

#include "noh/face.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Advance time while the face is not visible, at constant cost. It ends at rest, with the same gaze target and
 * emotions; blinks, breaths and glances come at other times than with noh_face_step. */
void noh_face_skip(noh_face *face, const noh_face_desc *desc, int64_t ticks);

/* Compute noh_face_pose.breath alone. */
float noh_face_breath(const noh_face *face, const noh_face_desc *desc);

/* The four channels of a frame, for a shader that has only four: one blink, the strongest emotion, the two strongest
 * mouth shapes, with a sum of at most 1. */
typedef struct noh_face_four {
    float weights[4];  /* blink, emotion, first and second mouth shape */
    uint8_t emotion;   /* noh_emotion; NOH_EMOTION_COUNT: none */
    uint8_t speech[2]; /* noh_viseme (face.h); 0: none */
    uint8_t reserved;
} noh_face_four;

/* Reduce a pose and mouth shapes to four channels.
 * pose     NULL: at rest
 * visemes  [15], as for noh_face_channels; NULL: silent */
void noh_face_four_of(const noh_face_pose *pose, const float *visemes, noh_face_four *four);

/* Expand the mouth shapes: visemes[15], at most two of them not 0. */
void noh_face_four_visemes(const noh_face_four *four, float *visemes);

#ifdef __cplusplus
}
#endif

#endif
