#include "posteriors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "life/face/ear_internal.h"

#define PROBABILITY_MIN 4 /* 1/32768 */

/* What the network reads of the frames so far. */
typedef struct listener {
    ear_voice voice;
    int8_t seen[EAR_NEAR][EAR_FEATURES];
    int8_t past[EAR_BEFORE + 1][EAR_FIRST];
} listener;

static void hear_frame(listener *l, const int16_t *samples, posteriors *p)
{
    int32_t cepstra[EAR_CEPSTRA], features[EAR_FEATURES], loudness;
    noh_ear_cepstra(&noh_ear_tables, samples, samples[-1], cepstra, &loudness);
    noh_ear_measure(&l->voice, cepstra, loudness, features);
    if (loudness > p->loudest) p->loudest = loudness;
    memmove(l->seen, l->seen[1], sizeof l->seen - sizeof l->seen[0]);
    noh_ear_scale(&noh_ear_tables, features, l->seen[EAR_NEAR - 1]);
}

static void read_frame(listener *l, int32_t *cost)
{
    int32_t weights[NOH_VISEME_COUNT];
    memmove(l->past, l->past[1], sizeof l->past - sizeof l->past[0]);
    noh_ear_see(&noh_ear_tables, (const int8_t(*)[EAR_FEATURES])l->seen, l->past[EAR_BEFORE]);
    noh_ear_read(&noh_ear_tables, (const int8_t(*)[EAR_FIRST])l->past, weights);
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        const int32_t weight = weights[v] > PROBABILITY_MIN ? weights[v] : PROBABILITY_MIN;
        cost[v] = 15 * POSTERIOR_OCTAVE - noh_ear_log2((uint64_t)weight);
    }
}

/* samples: of `frames` windows; silence stands around them, so that all frames have a past and a future. */
static void hear(listener *l, const int16_t *samples, posteriors *p)
{
    for (size_t t = 0; t < p->frames + EAR_AFTER; t++) {
        hear_frame(l, samples + t * EAR_HOP, p);
        if (t >= EAR_AFTER) read_frame(l, p->cost[t - EAR_AFTER]);
    }
}

int posteriors_make(const sound *recording, posteriors *out)
{
    listener l;
    sound at_rate;
    int16_t *samples;
    int status = sound_resample(recording, EAR_RATE, &at_rate);
    memset(out, 0, sizeof *out);
    if (status) return status;
    out->prior = noh_ear_tables.prior;
    out->frames = at_rate.count / EAR_HOP;
    samples = calloc(EAR_SKIP + at_rate.count + EAR_AFTER * EAR_HOP + 2u * EAR_WINDOW, sizeof *samples);
    out->cost = malloc((out->frames + 1u) * sizeof *out->cost);
    if (samples && out->cost) {
        for (size_t i = 0; i < at_rate.count; i++) {
            const float value = 32768.0f * at_rate.samples[i];
            samples[i + 1u] = (int16_t)lrintf(value < -32768.0f ? -32768.0f : value > 32767.0f ? 32767.0f : value);
        }
        memset(&l, 0, sizeof l);
        noh_ear_voice_init(&noh_ear_tables, &l.voice);
        hear(&l, samples + 1 + EAR_SKIP, out);
        hear(&l, samples + 1 + EAR_SKIP, out);
    }
    free(samples);
    sound_free(&at_rate);
    if (samples && out->cost) return 0;
    posteriors_free(out);
    return tool_fail("speak", "out of memory");
}

void posteriors_free(posteriors *p)
{
    free(p->cost);
    memset(p, 0, sizeof *p);
}
