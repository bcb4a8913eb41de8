/* prosody.h: what a voice asks of the rest of the face: stress raises brows and nods the head, pauses bring blinks and
 * looks aside, loudness opens the mouth. */
#ifndef NOH_NOH_SPEAK_PROSODY_H
#define NOH_NOH_SPEAK_PROSODY_H

#include <stdint.h>

#include "noh/clip.h"
#include "noh/face.h"
#include "sound.h"

#define PROSODY_RATE 100u /* frames a second */

typedef struct prosody_frame {
    noh_face_speech face;
    float loud; /* 0..1, of the voice's own range */
} prosody_frame;

typedef struct prosody {
    prosody_frame *frames;            /* [count] the middle of the n-th is at (n + 1/2) / PROSODY_RATE s */
    uint32_t count, stresses, pauses; /* a pause counts if the voice goes on behind it, or ends */
} prosody;

/* From fundamental frequency and energy, the same for a synthetic voice and for a recording. Prints an error and
 * returns an exit code; 0 on success. */
int prosody_make(const sound *voice, prosody *out);
void prosody_free(prosody *p);

/* The frame at a tick; zeros outside. */
prosody_frame prosody_at(const prosody *p, int64_t tick);

#endif
