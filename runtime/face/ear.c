/* ear.c: see ear.h. */
#include "face/ear.h"

#include <string.h>

#include "base/assert.h"
#include "base/result.h"
#include "face/ear_internal.h"

enum {
    ONE = 32768,
    HOLD = 7,      /* frames for which a shape shows at least: 70 ms */
    SHUT_HOLD = 4, /* shut lips: 34 ms are one frame at 30 Hz */
    MARGIN = 2600, /* by which another shape must lead */
    DECIBEL = 85   /* 1/256 octaves of power */
};

typedef struct ear {
    uint32_t rate, phase; /* phase: of the sample that is being made, in 1/rate of it */
    int64_t area;
    int32_t last; /* sample heard */
    int16_t samples[EAR_WINDOW], before;
    uint16_t filled, heard, ready;
    uint32_t frames;
    ear_mean mean;
    int16_t seen[EAR_SEEN][EAR_COEFFICIENTS];
    uint16_t weights[EAR_SMOOTHED][NOH_VISEME_COUNT];
    int32_t loud[EAR_AFTER + 1];
    int32_t low, high; /* percentiles of loudness, 1/256 octave */
    uint8_t shape, held, shut, shut_left;
} ear;

typedef char ear_fits[sizeof(ear) <= NOH_EAR_BYTES ? 1 : -1];

static const uint8_t opens[NOH_VISEME_COUNT] = { 0, 0, 10, 20, 20, 25, 15, 10, 20, 20, 100, 60, 30, 70, 25 };
static const uint8_t rounds[NOH_VISEME_COUNT] = { 0, 0, 0, 0, 0, 0, 60, 0, 0, 40, 0, 0, 0, 80, 100 };

noh_result noh_ear_init(noh_ear *memory, uint32_t sample_rate, noh_error *error)
{
    ear *e = (ear *)(void *)memory;
    NOH_ASSERT(memory);
    if (sample_rate < NOH_EAR_MIN_RATE || sample_rate > NOH_EAR_MAX_RATE) {
        return noh_fail(error, NOH_ERR_ARG, "an ear hears 8000 to 48000 samples a second", sample_rate,
                        NOH_EAR_MAX_RATE);
    }
    memset(memory, 0, sizeof *memory);
    e->rate = sample_rate;
    noh_ear_mean_init(&noh_ear_tables, &e->mean);
    e->low = 26 * 256; /* -38 dB and -24 dB of full scale */
    e->high = 31 * 256;
    for (uint32_t i = 0; i < EAR_SMOOTHED; i++) e->weights[i][NOH_VISEME_SIL] = ONE - 1;
    return NOH_OK;
}

/* 2^-x, x in 1/2^19: 1/32768. */
static int32_t power_of_half(int64_t x)
{
    const int64_t whole = x >> 19, f = (x & ((1 << 19) - 1)) >> 4;
    /* 2^-f = 1 - .6565 f - .3435 f (1 - f) - ... over one octave, within 1/300 */
    const int64_t line = 32768 - f / 2, bend = (f * (32768 - f) >> 15) * 5636 / 32768;
    return whole > 15 ? 0 : (int32_t)((line - bend) >> whole);
}

static void weigh(const ear_tables *t, const int16_t *c, uint16_t *weights)
{
    int64_t score[NOH_VISEME_COUNT], best = INT64_MIN, sum = 0;
    int32_t part[NOH_VISEME_COUNT];
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        score[v] = t->bias[v];
        for (uint32_t i = 0; i < EAR_COEFFICIENTS; i++) score[v] += (int32_t)t->weight[v][i] * c[i];
        best = score[v] > best ? score[v] : best;
    }
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) sum += part[v] = power_of_half(best - score[v]);
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) weights[v] = (uint16_t)(part[v] * (int64_t)(ONE - 1) / sum);
}

/* A percentile moves by steps up and down whose sizes are as its share of the frames below and above. */
static void hear_loudness(ear *e, int32_t loud)
{
    e->low += loud > e->low ? 3 : -57;
    e->high += loud > e->high ? 57 : -3;
    if (e->high < e->low) e->high = e->low;
}

/* Where between the quietest and the loudest of late: 1/32768. */
static int32_t level(const ear *e, int32_t loud)
{
    const int32_t lowest = e->high - 26 * DECIBEL, low = e->low > lowest ? e->low : lowest;
    const int32_t range = e->high - low > 18 * DECIBEL ? e->high - low : 18 * DECIBEL;
    const int32_t above = loud - low - 3 * DECIBEL, at = above < 0 ? 0 : above;
    return at > range ? ONE : at * ONE / range;
}

/* Drops the first `drop` bytes; there is no memmove in the library. */
static void drop_first(void *bytes, size_t drop, size_t size)
{
    uint8_t rest[sizeof(int16_t) * EAR_WINDOW];
    memcpy(rest, (const uint8_t *)bytes + drop, size - drop);
    memcpy(bytes, rest, size - drop);
}

static void analyse(ear *e)
{
    const ear_tables *t = &noh_ear_tables;
    int32_t c[EAR_COEFFICIENTS], loud;
    noh_ear_mfcc(t, e->samples, e->before, c, &loud);
    noh_ear_mean_take(&e->mean, c);
    drop_first(e->seen, sizeof e->seen[0], sizeof e->seen);
    drop_first(e->weights, sizeof e->weights[0], sizeof e->weights);
    drop_first(e->loud, sizeof e->loud[0], sizeof e->loud);
    for (uint32_t i = 0; i < EAR_COEFFICIENTS; i++) e->seen[EAR_SEEN - 1][i] = (int16_t)c[i];
    e->loud[EAR_AFTER] = loud;
    hear_loudness(e, loud);
    weigh(t, e->seen[EAR_SEEN - 1], e->weights[EAR_SMOOTHED - 1]);
    e->before = e->samples[EAR_HOP - 1];
    drop_first(e->samples, sizeof(int16_t) * EAR_HOP, sizeof e->samples);
    e->filled = EAR_WINDOW - EAR_HOP;
    e->ready = ++e->heard > EAR_AFTER;
    if (e->heard > EAR_AFTER) e->heard = EAR_AFTER + 1;
}

static void add_sample(ear *e, int64_t value)
{
    if (!e->filled) e->before = (int16_t)value; /* the first of all: no click */
    e->samples[e->filled++] = (int16_t)(value < -32768 ? -32768 : value > 32767 ? 32767 : value);
    if (e->filled == EAR_WINDOW) analyse(e);
}

/* Fewer samples than wanted: straight lines between them. */
static int32_t between(const ear *e, int32_t sample)
{
    return e->last + (int32_t)((int64_t)(sample - e->last) * (int32_t)e->phase / EAR_RATE);
}

size_t noh_ear_hear(noh_ear *memory, const int16_t *samples, size_t count)
{
    ear *e = (ear *)(void *)memory;
    size_t taken = 0;
    NOH_ASSERT(memory && (samples || !count));
    while (taken < count && !e->ready) {
        const int32_t sample = samples[taken++];
        if (e->rate < EAR_RATE) {
            for (; e->phase < EAR_RATE; e->phase += e->rate) add_sample(e, between(e, sample));
            e->phase -= EAR_RATE;
            e->last = sample;
            continue;
        }
        /* more than wanted: the mean over each one's time */
        if (e->phase + EAR_RATE < e->rate) {
            e->area += (int64_t)sample * EAR_RATE;
            e->phase += EAR_RATE;
            continue;
        }
        e->area += (int64_t)sample * (e->rate - e->phase);
        e->phase += EAR_RATE - e->rate;
        add_sample(e, e->area / (int64_t)e->rate);
        e->area = (int64_t)sample * e->phase;
    }
    return taken;
}

/* The mean of the last frames' weights, of which silence takes what is not loud enough to be speech. */
static void smooth(const ear *e, int32_t loudness, int32_t *weights)
{
    const int32_t speech = loudness * 6 > ONE ? ONE : loudness * 6;
    int32_t all = 0;
    for (uint32_t v = 1; v < NOH_VISEME_COUNT; v++) {
        int32_t sum = 0;
        for (uint32_t i = 0; i < EAR_SMOOTHED; i++) sum += e->weights[i][v];
        weights[v] = (int32_t)((int64_t)(sum / EAR_SMOOTHED) * speech / ONE);
        all += weights[v];
    }
    weights[NOH_VISEME_SIL] = ONE - all;
}

/* Lips that shut do so at once; any other shape waits for its turn, and has to lead. */
static void choose(ear *e, const int32_t *weights)
{
    uint32_t best = 0;
    for (uint32_t v = 1; v < NOH_VISEME_COUNT; v++) best = weights[v] > weights[best] ? v : best;
    if (e->held < 255) e->held++;
    if (e->shut_left) {
        best = NOH_VISEME_PP;
    } else if (e->held < HOLD || (best != e->shape && weights[best] < weights[e->shape] + MARGIN)) {
        best = e->shape;
    }
    if (best != e->shape) e->held = 0;
    e->shape = (uint8_t)best;
}

/* What shows leads: the others give way until it does. */
static void lead(const ear *e, int32_t *weights)
{
    int32_t best = 0, others;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        if (v != e->shape && weights[v] > best) best = weights[v];
    }
    if (!e->shut_left && weights[e->shape] > best) return;
    others = ONE - weights[e->shape];
    /* what they keep: all but shut lips share half of it */
    for (uint32_t v = 0; v < NOH_VISEME_COUNT && others; v++) {
        if (v != e->shape) weights[v] = e->shut_left ? 0 : (int32_t)((int64_t)weights[v] * (ONE / 2 - 1) / others);
    }
    weights[e->shape] = ONE;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        if (v != e->shape) weights[e->shape] -= weights[v];
    }
}

int noh_ear_next(noh_ear *memory, noh_ear_frame *frame)
{
    ear *e = (ear *)(void *)memory;
    int32_t weights[NOH_VISEME_COUNT], loudness, open = 0, round = 0;
    NOH_ASSERT(memory && frame);
    if (!e->ready) return 0;
    e->ready = 0;
    loudness = level(e, e->loud[0]);
    smooth(e, loudness, weights);
    if (e->shut_left) e->shut_left--;
    if (noh_ear_shut_score(&noh_ear_tables, (const int16_t(*)[EAR_COEFFICIENTS])e->seen) > 0) e->shut_left = SHUT_HOLD;
    choose(e, weights);
    lead(e, weights);
    frame->index = e->frames++;
    frame->shape = (noh_viseme)e->shape;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        frame->visemes[v] = (float)weights[v] * (1.0f / ONE);
        open += weights[v] * opens[v] / 100;
        round += weights[v] * rounds[v] / 100;
    }
    loudness = loudness * 6 < ONE * 2 / 5 + loudness / 5 * 3 ? loudness * 6 : ONE * 2 / 5 + loudness / 5 * 3;
    const int64_t loud_open = (int64_t)open * loudness / ONE;
    frame->open = (float)loud_open * (1.0f / ONE);
    frame->round = (float)round * (1.0f / ONE);
    frame->closed = e->shut_left ? 1.0f : frame->visemes[NOH_VISEME_PP];
    return 1;
}
