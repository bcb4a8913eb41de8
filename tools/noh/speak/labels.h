/* labels.h: phones that a person, or another program, has found in a recording, to measure others against. */
#ifndef NOH_NOH_SPEAK_LABELS_H
#define NOH_NOH_SPEAK_LABELS_H

#include "synthesis.h"

/* Counts, so that several recordings can be added. */
typedef struct label_score {
    uint32_t frames;         /* of a hundredth of a second, whose middle lies in a phone that is known */
    uint32_t visemes_right;  /* of fifteen */
    uint32_t lips_right;     /* of five: closed, lip and teeth, rounded, open, other */
    uint32_t closures;       /* p, b and m */
    uint32_t closures_found; /* one begins within 150 ms */
    uint32_t phones,
        onsets;            /* all phones of the labels; those matched by a phone of the same viseme in the same order */
    double onset_median_s; /* of the onsets */
} label_score;

/* path: lines of "start end phone", seconds, phones of ARPABET or IPA. Prints an error and returns an exit code; 0 on
 * success. */
int labels_score(const char *path, const synthesis *said, label_score *out);

#endif
