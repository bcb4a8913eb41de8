/* speech.c: mouth shapes of speech. */
#include "core/base/trig_internal.h"
#include "noh/base.h"
#include "noh/face.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "life/face/face_internal.h"

#define NEIGHBOURS 8u        /* phones on each side of a tick that can affect it */
#define HARD_TICKS 1632      /* 34 ms */
#define HARD_RAMP_TICKS 1440 /* 30 ms, on each side */
#define OPEN_RAMP_TICKS 2400 /* 50 ms more, if the mouth is wide open: lips move no faster */
#define MEET_TICKS 576       /* 12 ms: the shortest contact */

/* How long before its middle a phone begins to dominate, how fast its influence decays (1/s), and its strength. */
typedef struct dominance {
    float amount, rise, fall;
} dominance;

/* Rounding begins early (8/s: a tenth of a second before); vowels dominate consonants made by the tongue alone. */
static const dominance dominances[NOH_VISEME_COUNT] = {
    { 0.6f, 12.0f, 12.0f },                                                 /* sil */
    { 1.0f, 35.0f, 30.0f }, { 1.0f, 30.0f, 25.0f },                         /* PP FF */
    { 0.7f, 25.0f, 20.0f }, { 0.4f, 25.0f, 20.0f }, { 0.4f, 25.0f, 20.0f }, /* TH DD kk */
    { 0.9f, 12.0f, 14.0f }, { 0.8f, 25.0f, 20.0f }, { 0.4f, 25.0f, 20.0f }, /* CH SS nn */
    { 0.6f, 12.0f, 14.0f },                                                 /* RR */
    { 1.0f, 14.0f, 12.0f }, { 1.0f, 14.0f, 12.0f }, { 0.9f, 14.0f, 12.0f }, /* aa E ih */
    { 1.0f, 8.0f, 12.0f },  { 1.0f, 8.0f, 12.0f },                          /* oh ou */
};

noh_result noh_speech_check(const noh_speech *speech, noh_error *error)
{
    NOH_ASSERT(speech);
    if (!speech->phones || speech->phone_count == 0 || speech->phone_count > NOH_SPEECH_PHONES_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "phone_count must be 1 to NOH_SPEECH_PHONES_MAX", 0, speech->phone_count);
    }
    for (uint32_t i = 0; i < speech->phone_count; i++) {
        const uint32_t next = i + 1u < speech->phone_count ? speech->phones[i + 1u].start : speech->end;
        if (speech->phones[i].viseme >= NOH_VISEME_COUNT) {
            return noh_fail(error, NOH_ERR_DATA, "a phone's viseme is not a noh_viseme", i, NOH_VISEME_COUNT);
        }
        if (next <= speech->phones[i].start) {
            return noh_fail(error, NOH_ERR_DATA, "a phone ends before it begins: starts must increase, up to the end",
                            i, 0);
        }
    }
    return NOH_OK;
}

/* The phone at a tick: the last that has begun, by binary search. */
static uint32_t phone_at(const noh_speech *s, int64_t tick)
{
    uint32_t low = 0, high = s->phone_count;
    while (high - low > 1u) {
        const uint32_t middle = low + (high - low) / 2u;
        if ((int64_t)s->phones[middle].start <= tick) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static uint32_t end_of(const noh_speech *s, uint32_t phone)
{
    return phone + 1u < s->phone_count ? s->phones[phone + 1u].start : s->end;
}

/* Full within the middle half of the phone, exponential outside: a e^(-rate |t|). */
static float rule(const noh_speech *s, uint32_t phone, int64_t tick)
{
    const dominance *d = &dominances[s->phones[phone].viseme];
    const int64_t start = s->phones[phone].start, quarter = ((int64_t)end_of(s, phone) - start) / 4;
    const int64_t before = start + quarter - tick, after = tick - ((int64_t)end_of(s, phone) - quarter);
    const float t = (float)(before > 0 ? before : after > 0 ? after : 0) / NOH_FACE_TICKS_PER_S;
    return d->amount * noh_exp2(-1.44269504f * (before > 0 ? d->rise : d->fall) * t);
}

/* Outside the utterance silence dominates, as a phone of its own. */
static float silence(const noh_speech *s, int64_t tick)
{
    const dominance *d = &dominances[NOH_VISEME_SIL];
    const int64_t before = tick - (int64_t)s->phones[0].start, after = (int64_t)s->end - tick;
    const int64_t within = before < after ? before : after;
    return d->amount * (within <= 0 ? 1.0f : noh_exp2(-1.44269504f * d->rise * (float)within / NOH_FACE_TICKS_PER_S));
}

/* The distance of a tick from the time in which the lips must be closed for the phone: HARD_TICKS around its middle, or
 * its whole length, whichever is longer. 0 within. */
static int64_t outside(const noh_speech *s, uint32_t phone, int64_t tick)
{
    const int64_t start = s->phones[phone].start, end = end_of(s, phone), middle = (start + end) / 2;
    const int64_t half = end - start > HARD_TICKS ? (end - start) / 2 : HARD_TICKS / 2;
    const int64_t from = tick > middle ? tick - middle : middle - tick;
    return from > half ? from - half : 0;
}

static float ramp(int64_t ticks, int64_t length)
{
    return ticks < length ? 1.0f - (float)ticks / (float)length : 0.0f;
}

/* How long lips take to close what is open. */
static int64_t ramp_ticks(const float *visemes)
{
    const float open = visemes[NOH_VISEME_AA] + 0.6f * visemes[NOH_VISEME_E] + 0.7f * visemes[NOH_VISEME_OH];
    return HARD_RAMP_TICKS + (int64_t)((float)OPEN_RAMP_TICKS * open);
}

/* Closed lips reduce all other shapes. Next to a lip on teeth, closed lips open and close faster, down to MEET_TICKS,
 * so that two neighbouring contacts each have their time. */
static void shut_lips(const noh_speech *s, uint32_t first, uint32_t end, int64_t tick, float *visemes)
{
    const int64_t slow = ramp_ticks(visemes);
    int64_t away[2] = { slow, slow };
    float met, bitten;
    for (uint32_t i = first; i < end; i++) {
        const uint32_t v = s->phones[i].viseme;
        if (v == NOH_VISEME_PP || v == NOH_VISEME_FF) {
            const int64_t now = outside(s, i, tick);
            away[v - NOH_VISEME_PP] = now < away[v - NOH_VISEME_PP] ? now : away[v - NOH_VISEME_PP];
        }
    }
    met = ramp(away[0], MEET_TICKS + (slow - MEET_TICKS) * away[1] / slow);
    bitten = ramp(away[1], slow);
    bitten = bitten < 1.0f - met ? bitten : 1.0f - met;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) visemes[v] *= 1.0f - (met + bitten);
    visemes[NOH_VISEME_PP] += met;
    visemes[NOH_VISEME_FF] += bitten;
}

void noh_speech_visemes(const noh_speech *speech, int64_t tick, float *visemes)
{
    float sum = 0.0f;
    uint32_t at, first, end;
    NOH_ASSERT(speech && visemes);
    NOH_VALIDATE(noh_speech_check(speech, NULL) == NOH_OK);
    at = phone_at(speech, tick);
    first = at > NEIGHBOURS ? at - NEIGHBOURS : 0u;
    end = at + NEIGHBOURS < speech->phone_count ? at + NEIGHBOURS : speech->phone_count;
    memset(visemes, 0, NOH_VISEME_COUNT * sizeof *visemes);
    visemes[NOH_VISEME_SIL] = silence(speech, tick);
    for (uint32_t i = first; i < end; i++) visemes[speech->phones[i].viseme] += rule(speech, i, tick);
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) sum += visemes[v];
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) visemes[v] /= sum; /* silence is never 0 before its e^-x is */
    shut_lips(speech, first, end, tick, visemes);
}
