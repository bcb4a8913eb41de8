#include "noh/base.h"
#include "noh/face.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "life/face/ear_internal.h"

enum {
    ONE = 32768,
    DECIBEL = 85, /* 1/256 octaves of power */
    LIPS = 6,     /* closed for p, b, m; lip on teeth, rounded, open, narrow; at rest */
    SHUT = 0,
    REST = 5,
    /* 1/256 octaves of probability that other lips must accumulate */
    TO_SHUT = 800,
    TO_REST = 3400,
    TO_OTHER = 2200,
    FROM_SHUT = 1300,  /* from closed or resting lips to others */
    LEAST_LIKELY = 32, /* 1/32768: minimum weight of a frame */
    OTHER_SHAPE = 200, /* halves: lead that another shape of the same lips needs */
    SMOOTHED = 3       /* frames whose weights are averaged */
};

typedef struct ear {
    uint32_t rate, phase; /* phase: of the sample being made, in 1/rate of it */
    int64_t area;
    int32_t last; /* last input sample */
    int16_t samples[EAR_WINDOW], before;
    uint16_t skipped, filled, heard, ready;
    uint32_t frames;
    ear_voice voice;
    int8_t seen[EAR_SEEN][EAR_FEATURES];
    uint16_t weights[SMOOTHED][NOH_VISEME_COUNT];
    int32_t loud[EAR_AFTER + 1];
    /* 1/256 octave: of the likeliest path that ends with these lips; 0: the likeliest of all */
    int32_t cost[LIPS];
    int32_t shapes[NOH_VISEME_COUNT]; /* 1/32768: decaying sums */
    uint8_t shape;
} ear;

typedef char ear_fits[sizeof(ear) <= NOH_EAR_BYTES ? 1 : -1];

static const uint8_t opens[NOH_VISEME_COUNT] = { 0, 0, 10, 20, 20, 25, 15, 10, 20, 20, 100, 60, 30, 70, 25 };
static const uint8_t rounds[NOH_VISEME_COUNT] = { 0, 0, 0, 0, 0, 0, 60, 0, 0, 40, 0, 0, 0, 80, 100 };
static const uint8_t lips[NOH_VISEME_COUNT] = { REST, SHUT, 1, 4, 4, 4, 4, 4, 4, 4, 3, 3, 4, 2, 2 };

static void begin(ear *e)
{
    e->shapes[NOH_VISEME_SIL] = ONE;
    for (uint32_t i = 0; i < REST; i++) e->cost[i] = TO_OTHER;
    for (uint32_t i = 0; i < SMOOTHED; i++) e->weights[i][NOH_VISEME_SIL] = ONE - 1;
}

noh_result noh_ear_init(noh_ear *memory, uint32_t sample_rate, noh_error *error)
{
    ear *e = (ear *)(void *)memory;
    NOH_ASSERT(memory);
    if (sample_rate < NOH_EAR_MIN_RATE || sample_rate > NOH_EAR_MAX_RATE) {
        return noh_fail(error, NOH_ERR_ARG, "sample_rate must be 8000 to 48000 Hz", sample_rate, NOH_EAR_MAX_RATE);
    }
    memset(memory, 0, sizeof *memory);
    e->rate = sample_rate;
    noh_ear_voice_init(&noh_ear_tables, &e->voice);
    begin(e);
    return NOH_OK;
}

void noh_ear_restart(noh_ear *memory)
{
    ear *e = (ear *)(void *)memory;
    ear_voice voice;
    uint32_t rate;
    NOH_ASSERT(memory);
    voice = e->voice;
    rate = e->rate;
    memset(memory, 0, sizeof *memory);
    e->voice = voice;
    e->rate = rate;
    begin(e);
}

/* Position between the quietest and the loudest recent level: 1/32768. */
static int32_t level(const ear *e, int32_t loud)
{
    const int32_t lowest = e->voice.high - 26 * DECIBEL, low = e->voice.low > lowest ? e->voice.low : lowest;
    const int32_t range = e->voice.high - low > 18 * DECIBEL ? e->voice.high - low : 18 * DECIBEL;
    const int32_t above = loud - low - 3 * DECIBEL, at = above < 0 ? 0 : above;
    return at > range ? ONE : at * ONE / range;
}

/* Drop the first `drop` bytes; the library has no memmove. */
static void drop_first(void *bytes, size_t drop, size_t size)
{
    uint8_t rest[sizeof(int16_t) * EAR_WINDOW];
    memcpy(rest, (const uint8_t *)bytes + drop, size - drop);
    memcpy(bytes, rest, size - drop);
}

static void analyse(ear *e)
{
    const ear_tables *t = &noh_ear_tables;
    int32_t cepstra[EAR_CEPSTRA], features[EAR_FEATURES], loudness;
    noh_ear_cepstra(t, e->samples, e->before, cepstra, &loudness);
    noh_ear_measure(&e->voice, cepstra, loudness, features);
    drop_first(e->seen, sizeof e->seen[0], sizeof e->seen);
    drop_first(e->loud, sizeof e->loud[0], sizeof e->loud);
    noh_ear_scale(t, features, e->seen[EAR_SEEN - 1]);
    /* before the first frame the sound is assumed to be like the first frame */
    for (uint32_t f = 0; !e->heard && f < EAR_SEEN - 1; f++) memcpy(e->seen[f], e->seen[EAR_SEEN - 1], EAR_FEATURES);
    e->loud[EAR_AFTER] = loudness;
    e->before = e->samples[EAR_HOP - 1];
    drop_first(e->samples, sizeof(int16_t) * EAR_HOP, sizeof e->samples);
    e->filled = EAR_WINDOW - EAR_HOP;
    e->ready = ++e->heard > EAR_AFTER;
    if (e->heard > EAR_AFTER) e->heard = EAR_AFTER + 1;
}

static void add_sample(ear *e, int64_t value)
{
    const int16_t sample = (int16_t)(value < -32768 ? -32768 : value > 32767 ? 32767 : value);
    if (e->skipped < EAR_SKIP) {
        e->skipped++;
        e->before = sample;
        return;
    }
    e->samples[e->filled++] = sample;
    if (e->filled == EAR_WINDOW) analyse(e);
}

/* Fewer samples than needed: interpolate linearly. */
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
        /* more than needed: average over the time of each */
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

/* The network's weights; silence replaces what is too quiet to be speech. */
static void weigh(ear *e, int32_t loudness, int32_t *weights)
{
    const int32_t speech = loudness * 6 > ONE ? ONE : loudness * 6;
    int32_t rest = ONE - 1;
    noh_ear_read(&noh_ear_tables, (const int8_t(*)[EAR_FEATURES])e->seen, weights);
    for (uint32_t v = 1; v < NOH_VISEME_COUNT; v++) {
        weights[v] = (int32_t)((int64_t)weights[v] * speech / ONE);
        rest -= weights[v];
    }
    weights[NOH_VISEME_SIL] = rest;
}

static int32_t least_of(const int32_t *cost)
{
    int32_t least = cost[0];
    for (uint32_t i = 1; i < LIPS; i++) least = cost[i] < least ? cost[i] : least;
    return least;
}

/* The lips at the end of the likeliest path through all frames so far (Viterbi, 1967); changing lips costs something,
 * and least to close. */
static uint32_t follow(ear *e, const int32_t *weights)
{
    const int32_t least = least_of(e->cost), shut = e->cost[SHUT] < e->cost[REST] ? e->cost[SHUT] : e->cost[REST];
    const int32_t opens_up = shut + FROM_SHUT, other = least + TO_OTHER < opens_up ? least + TO_OTHER : opens_up;
    int32_t sum[LIPS] = { 0 };
    uint32_t best = 0;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) sum[lips[v]] += weights[v];
    for (uint32_t i = 0; i < LIPS; i++) {
        const int32_t change = i == SHUT ? least + TO_SHUT : i == REST ? least + TO_REST : other;
        if (e->cost[i] > change) e->cost[i] = change;
        e->cost[i] += 15 * 256 - noh_ear_log2((uint64_t)(sum[i] > LEAST_LIKELY ? sum[i] : LEAST_LIKELY));
        if (e->cost[i] < e->cost[best]) best = i;
    }
    for (uint32_t i = 0, from = (uint32_t)e->cost[best]; i < LIPS; i++) e->cost[i] -= (int32_t)from;
    return best;
}

/* Lips at rest are closed, too. */
static int is_alike(uint32_t a, uint32_t b)
{
    return a == b || ((a == SHUT || a == REST) && (b == SHUT || b == REST));
}

/* When lips change, the likeliest shape of this frame; else another shape has to lead for a while. */
static void choose(ear *e, const int32_t *weights)
{
    const uint32_t now = follow(e, weights);
    const int same = is_alike(lips[e->shape], now);
    uint32_t best = e->shape;
    int32_t most = same ? e->shapes[e->shape] / 2 * OTHER_SHAPE : -1;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        const int32_t weight = same ? e->shapes[v] : weights[v];
        e->shapes[v] += weights[v] - e->shapes[v] / 5;
        if (weight <= most || !(same ? is_alike(lips[v], now) : lips[v] == now)) continue;
        most = weight;
        best = v;
    }
    e->shape = (uint8_t)best;
}

/* The mean of the last frames' weights. */
static void smooth(ear *e, int32_t *weights)
{
    int32_t rest = ONE;
    drop_first(e->weights, sizeof e->weights[0], sizeof e->weights);
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) e->weights[SMOOTHED - 1][v] = (uint16_t)weights[v];
    for (uint32_t v = 1; v < NOH_VISEME_COUNT; v++) {
        weights[v] = 0;
        for (uint32_t i = 0; i < SMOOTHED; i++) weights[v] += e->weights[i][v];
        weights[v] /= SMOOTHED;
        rest -= weights[v];
    }
    weights[NOH_VISEME_SIL] = rest;
}

/* The visible shape leads: others are reduced until it does. Closed lips exclude all others. */
static void lead(const ear *e, int32_t *weights)
{
    const int shut = e->shape == NOH_VISEME_SIL || e->shape == NOH_VISEME_PP;
    int32_t best = 0, others;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        if (v != e->shape && weights[v] > best) best = weights[v];
    }
    if (!shut && weights[e->shape] > best) return;
    others = ONE - weights[e->shape];
    weights[e->shape] = ONE;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        if (v == e->shape) continue;
        if (others) weights[v] = shut ? 0 : (int32_t)((int64_t)weights[v] * (ONE / 2 - 1) / others);
        weights[e->shape] -= weights[v];
    }
}

static void show(const ear *e, const int32_t *weights, int32_t loudness, noh_ear_frame *frame)
{
    const int32_t quiet = loudness * 6, loud = ONE * 2 / 5 + loudness / 5 * 3;
    int64_t open = 0, round = 0, as_loud;
    frame->shape = (noh_viseme)e->shape;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        frame->visemes[v] = (float)weights[v] * (1.0f / ONE);
        open += weights[v] * opens[v] / 100;
        round += weights[v] * rounds[v] / 100;
    }
    as_loud = open * (quiet < loud ? quiet : loud) / ONE;
    frame->open = (float)as_loud * (1.0f / ONE);
    frame->round = (float)round * (1.0f / ONE);
    frame->closed = frame->visemes[NOH_VISEME_PP];
}

int noh_ear_next(noh_ear *memory, noh_ear_frame *frame)
{
    ear *e = (ear *)(void *)memory;
    int32_t weights[NOH_VISEME_COUNT], loudness;
    NOH_ASSERT(memory && frame);
    if (!e->ready) return 0;
    e->ready = 0;
    loudness = level(e, e->loud[0]);
    weigh(e, loudness, weights);
    choose(e, weights);
    smooth(e, weights);
    lead(e, weights);
    show(e, weights, loudness, frame);
    frame->index = e->frames++;
    return 1;
}
