#include "noh/base.h"
#include "noh/face.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "life/face/ear_internal.h"

enum {
    ONE = 32768,
    DECIBEL = 85, /* 1/256 octaves of power */
    LIPS = 5,     /* closed, lip on teeth, rounded, open, narrow */
    CLOSED = 0,
    TEETH = 1,
    /* 1/256 octaves of probability that other lips must accumulate */
    TO_CLOSED = 620,
    TO_TEETH = 1000,
    TO_OTHER = 2160,
    FROM_CLOSED = 710,
    FADE = 1100,        /* 1/32768: the share of speech falls by this much a frame: all of it takes 0.3 s */
    LEAST_LIKELY = 128, /* 1/32768: minimum weight of a frame */
    OTHER_SHAPE = 3,    /* halves: the lead that another shape of the same lips needs */
    AROUND = 2,         /* frames on both sides whose weights are averaged, as far as they are known */
    LAG_MAX = (NOH_EAR_LATENCY_MAX_MS - NOH_EAR_LATENCY_MIN_MS) / 10,
    KEPT = AROUND + 1 + LAG_MAX
};

/* A frame that the network has read. */
typedef struct ear_read {
    uint16_t weights[NOH_VISEME_COUNT];
    uint16_t level;     /* 1/32768 */
    uint8_t from[LIPS]; /* the lips before these, on the likeliest path */
} ear_read;

typedef struct ear {
    uint32_t rate, phase; /* phase: of the sample being made, in 1/rate of it */
    int64_t area;
    int32_t last; /* last input sample */
    int16_t samples[EAR_WINDOW], before;
    uint16_t skipped, filled, heard, ready;
    uint32_t frames;
    ear_voice voice;
    int8_t seen[EAR_NEAR][EAR_FEATURES];
    int8_t past[EAR_BEFORE + 1][EAR_FIRST];
    int32_t loud[EAR_AFTER + 1];
    ear_read kept[KEPT]; /* the latest frame is last */
    /* 1/256 octave: of the likeliest path that ends with these lips; 0: the likeliest of all */
    int32_t cost[LIPS];
    int32_t speech;                   /* 1/32768: the share of speech in the latest frame read */
    int32_t shapes[NOH_VISEME_COUNT]; /* 1/32768: decaying sums */
    uint8_t shape, lag;
} ear;

typedef char ear_fits[sizeof(ear) <= NOH_EAR_BYTES ? 1 : -1];

/* 1/256 octaves that lips lose in each frame: synthesisers round and open theirs more than people do. */
static const int16_t less[LIPS] = { -20, -70, 250, 110, 0 };
static const uint8_t opens[NOH_VISEME_COUNT] = { 0, 0, 10, 20, 20, 25, 15, 10, 20, 20, 100, 60, 30, 70, 25 };
static const uint8_t rounds[NOH_VISEME_COUNT] = { 0, 0, 0, 0, 0, 0, 60, 0, 0, 40, 0, 0, 0, 80, 100 };
static const uint8_t lips[NOH_VISEME_COUNT] = { CLOSED, CLOSED, TEETH, 4, 4, 4, 4, 4, 4, 4, 3, 3, 4, 2, 2 };

static void begin(ear *e, uint32_t sample_rate, uint32_t lag)
{
    e->rate = sample_rate;
    e->lag = (uint8_t)lag;
    e->shapes[NOH_VISEME_SIL] = ONE;
    for (uint32_t i = CLOSED + 1; i < LIPS; i++) e->cost[i] = TO_OTHER;
    for (uint32_t i = 0; i < KEPT; i++) e->kept[i].weights[NOH_VISEME_SIL] = ONE - 1;
}

noh_result noh_ear_init(noh_ear *memory, uint32_t sample_rate, uint32_t latency_ms, noh_error *error)
{
    ear *e = (ear *)(void *)memory;
    NOH_ASSERT(memory);
    if (sample_rate < NOH_EAR_MIN_RATE || sample_rate > NOH_EAR_MAX_RATE) {
        return noh_fail(error, NOH_ERR_ARG, "sample_rate must be 8000 to 48000 Hz", sample_rate, NOH_EAR_MAX_RATE);
    }
    if (latency_ms < NOH_EAR_LATENCY_MIN_MS || latency_ms > NOH_EAR_LATENCY_MAX_MS) {
        return noh_fail(error, NOH_ERR_ARG, "latency_ms must be 40 to 80", latency_ms, NOH_EAR_LATENCY_MAX_MS);
    }
    memset(memory, 0, sizeof *memory);
    noh_ear_voice_init(&noh_ear_tables, &e->voice);
    begin(e, sample_rate, (latency_ms - NOH_EAR_LATENCY_MIN_MS) / 10u);
    return NOH_OK;
}

void noh_ear_restart(noh_ear *memory)
{
    ear *e = (ear *)(void *)memory;
    ear_voice voice;
    uint32_t rate, lag;
    NOH_ASSERT(memory);
    voice = e->voice;
    rate = e->rate;
    lag = e->lag;
    memset(memory, 0, sizeof *memory);
    e->voice = voice;
    begin(e, rate, lag);
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

/* The network's weights; silence replaces what is too quiet to be speech, except p, b and m. The closure of a stop
 * is as quiet as a pause, but short: the share of speech falls slowly, so that t and k do not close the lips. */
static void weigh(ear *e, ear_read *read)
{
    int32_t weights[NOH_VISEME_COUNT], rest = ONE - 1, speech = read->level * 6 > ONE ? ONE : read->level * 6;
    if (speech < e->speech - FADE) speech = e->speech - FADE;
    e->speech = speech;
    noh_ear_read(&noh_ear_tables, (const int8_t(*)[EAR_FIRST])e->past, weights);
    for (uint32_t v = 1; v < NOH_VISEME_COUNT; v++) {
        if (v != NOH_VISEME_PP) weights[v] = (int32_t)((int64_t)weights[v] * speech / ONE);
        read->weights[v] = (uint16_t)weights[v];
        rest -= weights[v];
    }
    read->weights[NOH_VISEME_SIL] = (uint16_t)rest;
}

static int32_t cost_of_change(uint32_t from, uint32_t to)
{
    if (from == to) return 0;
    return to == CLOSED ? TO_CLOSED : to == TEETH ? TO_TEETH : from == CLOSED ? FROM_CLOSED : TO_OTHER;
}

/* The likeliest path through all frames so far to each of the lips (Viterbi, 1967). */
static void follow(ear *e, ear_read *read)
{
    int32_t sum[LIPS] = { 0 }, cost[LIPS], least = INT32_MAX;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) sum[lips[v]] += read->weights[v];
    for (uint32_t to = 0; to < LIPS; to++) {
        cost[to] = INT32_MAX;
        for (uint32_t from = 0; from < LIPS; from++) {
            const int32_t path = e->cost[from] + cost_of_change(from, to);
            if (path > cost[to] || (path == cost[to] && from != to)) continue;
            cost[to] = path;
            read->from[to] = (uint8_t)from;
        }
        cost[to] += less[to] + 15 * 256 - noh_ear_log2((uint64_t)(sum[to] > LEAST_LIKELY ? sum[to] : LEAST_LIKELY));
        least = cost[to] < least ? cost[to] : least;
    }
    for (uint32_t i = 0; i < LIPS; i++) e->cost[i] = cost[i] - least;
}

/* The newest frame whose surroundings are known. */
static void read_frame(ear *e)
{
    ear_read *read = &e->kept[KEPT - 1];
    drop_first(e->past, sizeof e->past[0], sizeof e->past);
    noh_ear_see(&noh_ear_tables, (const int8_t(*)[EAR_FEATURES])e->seen, e->past[EAR_BEFORE]);
    for (uint32_t f = 0; e->heard == EAR_AFTER && f < EAR_BEFORE; f++) {
        memcpy(e->past[f], e->past[EAR_BEFORE], sizeof e->past[f]);
    }
    drop_first(e->kept, sizeof e->kept[0], sizeof e->kept);
    read->level = (uint16_t)level(e, e->loud[0]);
    weigh(e, read);
    follow(e, read);
}

static void analyse(ear *e)
{
    const ear_tables *t = &noh_ear_tables;
    int32_t cepstra[EAR_CEPSTRA], features[EAR_FEATURES], loudness;
    noh_ear_cepstra(t, e->samples, e->before, cepstra, &loudness);
    noh_ear_measure(&e->voice, cepstra, loudness, features);
    drop_first(e->seen, sizeof e->seen[0], sizeof e->seen);
    drop_first(e->loud, sizeof e->loud[0], sizeof e->loud);
    noh_ear_scale(t, features, e->seen[EAR_NEAR - 1]);
    /* before the first frame the sound is assumed to be like the first frame */
    for (uint32_t f = 0; !e->heard && f < EAR_NEAR - 1; f++) memcpy(e->seen[f], e->seen[EAR_NEAR - 1], EAR_FEATURES);
    e->loud[EAR_AFTER] = loudness;
    e->before = e->samples[EAR_HOP - 1];
    drop_first(e->samples, sizeof(int16_t) * EAR_HOP, sizeof e->samples);
    e->filled = EAR_WINDOW - EAR_HOP;
    if (e->heard >= EAR_AFTER) read_frame(e);
    e->heard = (uint16_t)(e->heard + (e->heard <= EAR_AFTER + e->lag));
    e->ready = e->heard > EAR_AFTER + e->lag;
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

/* The lips of the frame shown: on the path that is likeliest now. */
static uint32_t look_back(const ear *e)
{
    uint32_t at = 0;
    for (uint32_t i = 1; i < LIPS; i++) at = e->cost[i] < e->cost[at] ? i : at;
    for (uint32_t k = 0; k < e->lag; k++) at = e->kept[KEPT - 1 - k].from[at];
    return at;
}

/* When lips change, their likeliest shape in the frames known; else another shape has to lead. */
static void choose(ear *e)
{
    const uint32_t now = look_back(e);
    const int same = lips[e->shape] == now;
    int32_t most = -1;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        if (same) e->shapes[v] = e->shapes[v] / 8 * 7 + e->kept[KEPT - 1].weights[v];
        if (!same) e->shapes[v] = 0;
        for (uint32_t f = KEPT - 1u - e->lag; !same && f < KEPT; f++) e->shapes[v] += e->kept[f].weights[v];
    }
    if (same) most = e->shapes[e->shape] / 2 * OTHER_SHAPE;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        if (lips[v] != now || e->shapes[v] <= most) continue;
        most = e->shapes[v];
        e->shape = (uint8_t)v;
    }
}

/* The mean weights around the frame shown. */
static void smooth(const ear *e, int32_t *weights)
{
    const uint32_t at = KEPT - 1u - e->lag, end = at + (e->lag < AROUND ? e->lag : AROUND);
    int32_t rest = ONE;
    for (uint32_t v = 1; v < NOH_VISEME_COUNT; v++) {
        weights[v] = 0;
        for (uint32_t f = at - AROUND; f <= end; f++) weights[v] += e->kept[f].weights[v];
        weights[v] /= (int32_t)(end - at + AROUND + 1u);
        rest -= weights[v];
    }
    weights[NOH_VISEME_SIL] = rest;
}

/* The jaw as the shapes' mean has it, by loudness. Closed lips leave it little. */
static float jaw(const ear *e, const int32_t *weights)
{
    const int32_t loudness = e->kept[KEPT - 1u - e->lag].level;
    const int32_t quiet = loudness * 6, loud = ONE * 3 / 5 + loudness / 5 * 2;
    int64_t open = 0;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) open += weights[v] * opens[v] / 100;
    open = open * (quiet < loud ? quiet : loud) / ONE;
    return (float)(int32_t)(lips[e->shape] == CLOSED ? open * 3 / 10 : open) * (1.0f / ONE);
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

int noh_ear_next(noh_ear *memory, noh_ear_frame *frame)
{
    ear *e = (ear *)(void *)memory;
    int32_t weights[NOH_VISEME_COUNT], round = 0;
    NOH_ASSERT(memory && frame);
    if (!e->ready) return 0;
    e->ready = 0;
    choose(e);
    smooth(e, weights);
    frame->index = e->frames++;
    frame->shape = (noh_viseme)e->shape;
    frame->open = jaw(e, weights);
    lead(e, weights);
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        frame->visemes[v] = (float)weights[v] * (1.0f / ONE);
        round += weights[v] * rounds[v] / 100;
    }
    frame->round = (float)round * (1.0f / ONE);
    frame->closed = frame->visemes[NOH_VISEME_PP];
    return 1;
}
