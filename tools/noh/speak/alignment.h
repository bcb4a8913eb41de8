/* alignment.h: finds the words of a known text in a recording.
 *
 * No words are recognised: the phones of the text, as eSpeak NG says it, follow each other with minimum durations and
 * optional pauses, and one Viterbi search finds their times by the probabilities that the live ear's network gives. */
#ifndef NOH_NOH_SPEAK_ALIGNMENT_H
#define NOH_NOH_SPEAK_ALIGNMENT_H

#include "sound.h"
#include "synthesis.h"

typedef struct alignment {
    synthesis said; /* phones and words at samples of the recording, which itself it does not hold */
    double score;   /* how much better the words fit than in another order: 0..1, see ALIGNMENT_SCORE_POOR */
} alignment;

/* Words that are not in the recording come out below, words that are above (tools/noh/speak/README.md). */
#define ALIGNMENT_SCORE_POOR 0.22

/* Prints an error and returns an exit code; 0 on success. */
int alignment_make(const sound *recording, const char *text, const char *language, alignment *out);
void alignment_free(alignment *a);

#endif
