/* labels.h: phones and their times as a person or a program wrote them: to measure others against, or to speak. */
#ifndef NOH_NOH_SPEAK_LABELS_H
#define NOH_NOH_SPEAK_LABELS_H

#include "speech_track.h"
#include "synthesis.h"

/* Counts, so that several recordings can be added. */
typedef struct label_score {
    uint32_t frames;         /* of a hundredth of a second, whose middle lies in a phone that is known */
    uint32_t visemes_right;  /* of fifteen */
    uint32_t lips_right;     /* of five: closed, lip and teeth, rounded, open, other */
    uint32_t closures;       /* p, b and m */
    uint32_t closures_found; /* one begins within 150 ms; or, of what was heard, lips are closed within 30 ms of it */
    uint32_t phones,
        onsets;            /* all phones of the labels; those matched by a phone of the same viseme in the same order */
    double onset_median_s; /* of the onsets */
    uint32_t vowels, vowels_shut; /* frames of vowels; those where lips are closed */
    uint32_t lip_changes;         /* between frames */
    int with_opening;
    double opening_correlation; /* of what was heard with the labels' shapes, both averaged over 70 ms */
} label_score;

/* track: what was heard, for its opening, or NULL. path: lines of "start end phone", seconds, phones of ARPABET or IPA.
 * Prints an error and returns an exit code; 0 on success. */
int labels_score(const char *path, const synthesis *said, const speech_track *track, label_score *out);

/* The phones of such a file, with pauses between them where it has none, as if they were spoken: without sound and words.
 * An unknown phone gives a warning. Free with synthesis_free, also on failure. */
int labels_say(const char *path, synthesis *out);

#endif
