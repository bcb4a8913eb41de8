/* alignment.h: finds the words of a known text in a recording.
 *
 * No recogniser: the text is spoken by several voices of a synthesiser, whose phones begin at known times, and the
 * recording is warped onto them. Voices that say the same phone differ as speakers differ, so features are weighted by
 * how little they differ. Sources: Sakoe and Chiba, "Dynamic programming algorithm optimization for spoken word
 * recognition", 1978 (the warp and its limits of slope); Malfrere and Dutoit, "High-quality speech synthesis for
 * phonetic speech segmentation", 1997 (onto synthetic speech). */
#ifndef NOH_NOH_SPEAK_ALIGNMENT_H
#define NOH_NOH_SPEAK_ALIGNMENT_H

#include "sound.h"
#include "synthesis.h"

typedef struct alignment {
    synthesis said; /* phones and words at samples of the recording, which itself it does not hold */
    double score;   /* how much better the words fit than any sounds in any order: 0..1, see ALIGNMENT_SCORE_POOR */
} alignment;

/* Words that are not in the recording come out below, words that are above (tools/noh/speak/README.md). */
#define ALIGNMENT_SCORE_POOR 0.10

/* Prints an error and returns an exit code; 0 on success. */
int alignment_make(const sound *recording, const char *text, const char *language, alignment *out);
void alignment_free(alignment *a);

#endif
