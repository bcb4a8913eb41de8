#include "alignment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/face.h"
#include "warp.h"

#define TOP_HZ 7600.0f
#define TOP_PART 0.475f   /* of the recording's rate, where that is less */
#define SPOKEN_PART 0.3f  /* share of the range from the quietest to the loudest above which a frame is speech */
#define SPOKEN_GAP 12u    /* frames: a shorter silence is within speech, as before a p, t or k */
#define RANGE_DB 45.0f    /* floor of speech in a room: quieter differences carry no information */
#define QUIET_DB (-75.0f) /* a recording below this everywhere has no speech */
#define RIDGE 0.2         /* on the diagonal of the voices' differences: people differ more */
#define PAUSE_COST 0.45f  /* of the quietest frame in a pause, where a frame that fits costs about 1 */
#define PAUSE_SLOPE 2.75f /* and more up to the loudest: breath is cheaper than speech */
#define SHIFT_FRAMES 10.0 /* of a class, at which its own mean counts as much as the mean of all */

/* ---- which frames are speech ---- */

typedef struct heard {
    features f;
    float *pause_cost;
    uint32_t *at;
    double seconds;  /* of speech */
    float low, high; /* levels in dB */
} heard;

static void fill_gaps(unsigned char *spoken, size_t frames)
{
    size_t gap = SPOKEN_GAP;
    for (size_t t = 0; t < frames; t++) {
        if (!spoken[t]) {
            gap++;
            continue;
        }
        if (gap < SPOKEN_GAP) memset(spoken + t - gap, 1, gap);
        gap = 0;
    }
}

static int hear_speech(heard *h)
{
    unsigned char *spoken = calloc(h->f.frames + 1u, 1);
    const float limit = h->low + SPOKEN_PART * (h->high - h->low);
    if (!spoken) return tool_fail("speak", "out of memory");
    for (size_t t = 0; t < h->f.frames; t++) spoken[t] = h->f.level[t] >= limit;
    fill_gaps(spoken, h->f.frames);
    for (size_t t = 0; t < h->f.frames; t++) h->seconds += spoken[t] ? 1.0 / FEATURE_RATE : 0.0;
    features_normalise(&h->f, spoken);
    free(spoken);
    return 0;
}

static int hear(const sound *recording, float top_hz, heard *h)
{
    sound at_rate;
    int status = sound_resample(recording, FEATURE_SOUND_RATE, &at_rate);
    if (status) return status;
    status = features_make(&at_rate, top_hz, &h->f);
    sound_free(&at_rate);
    if (status) return status;
    h->low = features_level(&h->f, 0.05f);
    h->high = features_level(&h->f, 0.95f);
    if (h->low < h->high - RANGE_DB) h->low = h->high - RANGE_DB;
    h->pause_cost = malloc((h->f.frames + 1u) * sizeof *h->pause_cost);
    h->at = malloc((h->f.frames + 1u) * sizeof *h->at);
    if (!h->pause_cost || !h->at) return tool_fail("speak", "out of memory");
    if (!h->f.frames || h->high < QUIET_DB) {
        return tool_fail("speak", "the recording is silent: it never exceeds %d dB", (int)QUIET_DB);
    }
    for (size_t t = 0; t < h->f.frames; t++) {
        const float part = (h->f.level[t] - h->low) / (h->high - h->low + 1e-3f);
        h->pause_cost[t] = (PAUSE_COST + PAUSE_SLOPE * (part > 0.0f ? part : 0.0f)) * sqrtf(FEATURE_COUNT);
    }
    return hear_speech(h);
}

static void heard_free(heard *h)
{
    features_free(&h->f);
    free(h->pause_cost);
    free(h->at);
}

/* ---- features by how much they say ---- */

/* The lower triangle of a matrix into its Cholesky factor. It is positive: a ridge stands on its diagonal. */
static void factor(double *a)
{
    for (uint32_t i = 0; i < FEATURE_COUNT; i++) {
        for (uint32_t j = 0; j <= i; j++) {
            double sum = a[i * FEATURE_COUNT + j];
            for (uint32_t k = 0; k < j; k++) sum -= a[i * FEATURE_COUNT + k] * a[j * FEATURE_COUNT + k];
            a[i * FEATURE_COUNT + j] = i == j ? sqrt(fmax(sum, 1e-9)) : sum / a[j * FEATURE_COUNT + j];
        }
    }
}

/* Frames times the inverse of the factor: distances between them are then Mahalanobis's. */
static void whiten(const double *l, float *values, size_t frames)
{
    for (size_t t = 0; t < frames; t++) {
        float *v = values + t * FEATURE_COUNT;
        for (uint32_t i = 0; i < FEATURE_COUNT; i++) {
            double sum = (double)v[i];
            for (uint32_t k = 0; k < i; k++) sum -= l[i * FEATURE_COUNT + k] * (double)v[k];
            v[i] = (float)(sum / l[i * FEATURE_COUNT + i]);
        }
    }
}

static void weigh(reference *r, features *f)
{
    for (uint32_t i = 0; i < FEATURE_COUNT; i++) r->within[i * FEATURE_COUNT + i] += RIDGE;
    factor(r->within);
    whiten(r->within, f->values, f->frames);
    whiten(r->within, r->means, r->state_count);
}

/* ---- the speaker ---- */

static uint32_t class_of(const reference *r, size_t state)
{
    return noh_viseme_of_phone(r->said.phones[r->states[state].phone].name, NULL);
}

typedef struct shifts {
    double sum[NOH_VISEME_COUNT + 1][FEATURE_COUNT], count[NOH_VISEME_COUNT + 1];
    double all[FEATURE_COUNT], all_count;
} shifts;

static void measure_shifts(const reference *r, const heard *h, shifts *s)
{
    memset(s, 0, sizeof *s);
    for (size_t t = 0; t < h->f.frames; t++) {
        const size_t state = h->at[t];
        const uint32_t class = class_of(r, state);
        if (r->states[state].pause) continue;
        s->count[class] += 1.0;
        s->all_count += 1.0;
        for (uint32_t c = 0; c < FEATURE_COUNT; c++) {
            const double d = (double)(h->f.values[t * FEATURE_COUNT + c] - r->means[state * FEATURE_COUNT + c]);
            s->sum[class][c] += d;
            s->all[c] += d;
        }
    }
}

/* The voices' sounds are moved to the speaker's, class by class, by the result of a first warp. */
static void adapt(reference *r, const heard *h)
{
    shifts s;
    measure_shifts(r, h, &s);
    for (size_t i = 0; i < r->state_count; i++) {
        const uint32_t class = class_of(r, i);
        if (r->states[i].pause) continue;
        for (uint32_t c = 0; c < FEATURE_COUNT; c++) {
            const double common = SHIFT_FRAMES * s.all[c] / fmax(s.all_count, 1.0);
            r->means[i * FEATURE_COUNT + c] += (float)((s.sum[class][c] + common) / (s.count[class] + SHIFT_FRAMES));
        }
    }
}

/* ---- how well it fits ---- */

#define TURN \
    0.38 /* of the states, which go from the beginning to the end: what repeats itself seldom does so there \
          */

/* The mean distance of speech to the states of its path. */
static double distance_of(const reference *r, const heard *h)
{
    double sum = 0.0, count = 0.0;
    for (size_t t = 0; t < h->f.frames; t++) {
        if (r->states[h->at[t]].pause) continue;
        sum += (double)warp_distance(h->f.values + t * FEATURE_COUNT, r->means + h->at[t] * FEATURE_COUNT);
        count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

/* The same sounds in another order. */
static int turn(const reference *r, reference *out)
{
    size_t first = (size_t)(TURN * (double)r->state_count);
    *out = *r;
    while (first && r->states[first].phone == r->states[first - 1u].phone) first--;
    out->states = malloc(r->state_count * sizeof *out->states);
    out->means = malloc(r->state_count * FEATURE_COUNT * sizeof *out->means);
    if (!out->states || !out->means) {
        free(out->states);
        free(out->means);
        return tool_fail("speak", "out of memory");
    }
    for (size_t i = 0; i < r->state_count; i++) {
        const size_t from = (i + first) % r->state_count;
        out->states[i] = r->states[from];
        memcpy(out->means + i * FEATURE_COUNT, r->means + from * FEATURE_COUNT, FEATURE_COUNT * sizeof *r->means);
    }
    return 0;
}

/* The path's distance against the best path through the same sounds in another order. */
static int score(const reference *r, heard *h, double *out)
{
    reference turned;
    double own = distance_of(r, h), other;
    int status = turn(r, &turned);
    if (status) return status;
    status = warp_make(&turned, &h->f, h->pause_cost, h->at);
    other = status ? 0.0 : distance_of(&turned, h);
    *out = own < other ? 1.0 - own / other : 0.0;
    free(turned.states);
    free(turned.means);
    return status;
}

/* ---- phones and words of the recording ---- */

static uint32_t sample_of(const synthesis *s, size_t frame)
{
    return (uint32_t)((uint64_t)frame * s->sample_rate / FEATURE_RATE);
}

/* Words begin with the first phone at or behind their place in the text as it was synthesised. */
static void place_words(const synthesis *from, const uint32_t *start, synthesis *out)
{
    size_t phone = 0;
    for (size_t i = 0; i < from->word_count; i++) {
        const uint32_t near = from->sample_rate / 200u;
        while (phone + 1u < from->phone_count &&
               (from->phones[phone].sample + near < from->words[i].sample || start[phone] == UINT32_MAX)) {
            phone++;
        }
        if (start[phone] == UINT32_MAX) break;
        out->words[out->word_count] = from->words[i];
        out->words[out->word_count++].sample = start[phone];
    }
}

static void place_phones(const reference *r, const heard *h, uint32_t *start, synthesis *out)
{
    for (size_t t = 0; t < h->f.frames; t++) {
        const reference_state *now = &r->states[h->at[t]], *before = t ? &r->states[h->at[t - 1u]] : NULL;
        spoken_phone *p = &out->phones[out->phone_count];
        if (before && now->phone == before->phone && now->pause == before->pause) continue;
        memset(p, 0, sizeof *p);
        p->sample = sample_of(out, t);
        if (!now->pause) {
            memcpy(p->name, r->said.phones[now->phone].name, sizeof p->name);
            start[now->phone] = p->sample;
        }
        out->phone_count++;
    }
}

static int place(const reference *r, const heard *h, const sound *recording, synthesis *out)
{
    uint32_t *start = malloc((r->said.phone_count + 1u) * sizeof *start);
    out->sample_rate = recording->rate;
    out->sample_count = recording->count;
    out->phones = calloc(2u * r->said.phone_count + 2u, sizeof *out->phones);
    out->words = calloc(r->said.word_count + 1u, sizeof *out->words);
    if (!start || !out->phones || !out->words) {
        free(start);
        return tool_fail("speak", "out of memory");
    }
    for (size_t i = 0; i < r->said.phone_count; i++) start[i] = UINT32_MAX;
    place_phones(r, h, start, out);
    place_words(&r->said, start, out);
    free(start);
    return 0;
}

/* ---- all of it ---- */

static int align(const sound *recording, const char *text, const char *language, float top_hz, heard *h, alignment *out)
{
    reference r;
    int status = reference_make(text, language, h->seconds, top_hz, &r);
    if (status) return status;
    weigh(&r, &h->f);
    status = warp_make(&r, &h->f, h->pause_cost, h->at);
    if (!status) {
        adapt(&r, h);
        status = warp_make(&r, &h->f, h->pause_cost, h->at);
    }
    if (!status) status = place(&r, h, recording, &out->said);
    if (!status) status = score(&r, h, &out->score);
    reference_free(&r);
    return status;
}

int alignment_make(const sound *recording, const char *text, const char *language, alignment *out)
{
    const float half = TOP_PART * (float)recording->rate, top_hz = half < TOP_HZ ? half : TOP_HZ;
    heard h;
    int status;
    memset(out, 0, sizeof *out);
    memset(&h, 0, sizeof h);
    status = hear(recording, top_hz, &h);
    if (!status) status = align(recording, text, language, top_hz, &h, out);
    heard_free(&h);
    if (status) alignment_free(out);
    return status;
}

void alignment_free(alignment *a)
{
    synthesis_free(&a->said);
    memset(a, 0, sizeof *a);
}
