/* reference.h: a text as several voices say it, state after state, to be compared with a recording of it. */
#ifndef NOH_NOH_SPEAK_REFERENCE_H
#define NOH_NOH_SPEAK_REFERENCE_H

#include "cepstra.h"
#include "synthesis.h"

/* A hundredth of a second or so of a phone, or a pause that may be left out or last. */
typedef struct reference_state {
    uint32_t phone; /* of reference.said; for a pause the phone behind it */
    uint32_t pause;
} reference_state;

typedef struct reference {
    synthesis said; /* by the first voice */
    reference_state *states;
    float *means;                                 /* [state_count * FEATURE_COUNT] over all voices */
    double within[FEATURE_COUNT * FEATURE_COUNT]; /* covariance of what voices differ by; its lower triangle */
    size_t state_count;
} reference;

/* seconds: how long the speech lasts, without its pauses; top_hz: as features_make. Prints an error and returns an exit
 * code; 0 on success. */
int reference_make(const char *text, const char *language, double seconds, float top_hz, reference *out);
void reference_free(reference *r);

#endif
