/* hearing.h: a recording without words: mouth shapes as the ear hears them, or by loudness alone. */
#ifndef NOH_NOH_SPEAK_HEARING_H
#define NOH_NOH_SPEAK_HEARING_H

#include "sound.h"
#include "speech_track.h"

typedef struct hearing {
    int live;          /* in one pass, as from a microphone; otherwise a second pass knows the voice from the start */
    double latency_ms; /* of the ear, where live */
    int amplitude;     /* by loudness alone, not by the ear (face.h) */
} hearing;

/* Fills `said` with runs of one shape, each as a phone of that shape, and `track` with frames. Prints an
 * error and returns an exit code; 0 on success. */
int hearing_make(const sound *recording, const hearing *how, synthesis *said, speech_track *track);

/* How long after its sound a frame is known; 0 for a recording that is heard as a whole. */
double hearing_latency_ms(const hearing *how);

#endif
