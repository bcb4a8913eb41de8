/* face_blink.c: when the eyes blink, and how the lids move.
 *
 * Intervals between spontaneous blinks are log-normal, about 17 per minute at rest, 26 in talk and 4.5 in reading
 * (Bentivoglio and others, "Analysis of blink rate patterns in normal subjects", Movement Disorders 12, 1997). A blink
 * with another cause, a large eye movement or the end of a phrase, replaces the next spontaneous one, and the following
 * one stays due when it would have been: so the rate does not change. */
#include "core/base/trig_internal.h"
#include "noh/face.h"
#include "noh/low_core.h"
#include "life/face/face_internal.h"

#define SIGMA 0.7f             /* standard deviation of the logarithm of intervals */
#define INTERVAL_MIN_S 0.36f   /* the longest blink has ended by this time */
#define DOUBLE_GAP_TICKS 1920u /* 0.04 s between the two blinks of a double blink */
#define DOUBLES 0.02f          /* share of blinks that are followed by another */
#define STRATA 32u
#define APART_S 0.7f  /* from a blink of another owner to one by a look or by speech, at least */
#define HIDES 0.9f    /* lids shut so far by another owner show no blink, so one in progress ends */
#define SEEN_S 5.0f   /* from a blink of another owner to a spontaneous one, at least */
#define DEBT_MAX 4.0f /* mean intervals by which blinks in advance may delay the next one */

/* A minute. */
static const float rates[NOH_ACTIVITY_COUNT] = { 17.0f, 26.0f, 4.5f };

float noh_face_blink_mean(uint32_t activity)
{
    return 60.0f / rates[activity];
}

/* A permutation of 0..STRATA-1 by the key: every step is invertible. */
static uint32_t shuffled(uint32_t i, uint32_t key)
{
    i = (i ^ key) % STRATA;
    i = (i * 13u + (key >> 5)) % STRATA;
    i ^= i >> 3;
    i = i * (2u * (key >> 10) + 1u) % STRATA;
    return i ^ i >> 2;
}

/* A uniform number: of every 32 in a row, one in each 32nd of 0 to 1. So each face keeps its rate within minutes, and
 * not only on average over many faces. */
static float stratum(const noh_face *face, uint32_t blink)
{
    const float key = noh_face_uniform(face->seed, NOH_FACE_STRATA, blink / STRATA);
    const float within = noh_face_uniform(face->seed, NOH_FACE_INTERVAL, blink);
    return ((float)shuffled(blink % STRATA, (uint32_t)(key * 1048576.0f)) + within) / (float)STRATA;
}

static uint32_t interval(const noh_face *face, uint32_t blink)
{
    const float u = stratum(face, blink);
    if (noh_face_is_four(face)) return noh_face_four_wait(face, blink);
    const float s = noh_face_log_normal(u, noh_face_blink_mean(face->activity), SIGMA);
    return noh_face_ticks(s < INTERVAL_MIN_S ? INTERVAL_MIN_S : s < 600.0f ? s : 600.0f);
}

/* Closing takes 75 to 100 ms, opening 150 to 200 ms. */
noh_face_lid noh_face_lid_of(const noh_face *face, uint32_t blink)
{
    noh_face_lid lid;
    lid.closing = noh_face_ticks(0.075f + 0.025f * noh_face_uniform(face->seed, NOH_FACE_SHAPE, 3u * blink));
    lid.shut = noh_face_ticks(0.020f + 0.030f * noh_face_uniform(face->seed, NOH_FACE_SHAPE, 3u * blink + 1u));
    lid.opening = noh_face_ticks(0.150f + 0.050f * noh_face_uniform(face->seed, NOH_FACE_SHAPE, 3u * blink + 2u));
    return lid;
}

/* Down along a raised cosine; up fast at first and then slower, as an exponential of 60 ms shifted to end at 0. */
static float lid_at(const noh_face_lid *lid, uint32_t ticks)
{
    const float rate = 1.44269504f / 0.060f;
    float sine, cosine, last;
    if (ticks < lid->closing) {
        noh_sin_cos((float)ticks / (float)lid->closing * 3.14159265f, &sine, &cosine);
        return 0.5f - 0.5f * cosine;
    }
    ticks -= lid->closing;
    if (ticks < lid->shut) {
        return 1.0f;
    }
    ticks -= lid->shut;
    if (ticks >= lid->opening) {
        return 0.0f;
    }
    last = noh_exp2(-rate * noh_face_seconds(lid->opening));
    return (noh_exp2(-rate * noh_face_seconds(ticks)) - last) / (1.0f - last);
}

static int is_double(const noh_face *face, uint32_t blink)
{
    return noh_face_uniform(face->seed, NOH_FACE_DOUBLE, blink) < DOUBLES;
}

/* Close the lids at the face's clock. `due` is the time of the spontaneous blink that it replaces, which may be later.
 * A double blink counts as two. */
static void begin(noh_face *face, uint32_t due)
{
    const uint32_t count = !noh_face_is_four(face) && is_double(face, face->blinks) ? 2u : 1u;
    face->blink_start = (uint32_t)face->clock;
    face->blinking = (uint8_t)count;
    face->next_blink = due;
    for (uint32_t i = 0; i < count; i++) {
        face->next_blink += interval(face, face->blinks++);
    }
}

void noh_face_blink_begin(noh_face *face)
{
    begin(face, face->next_blink);
}

float noh_face_blink_at(const noh_face *face)
{
    uint32_t ticks = (uint32_t)face->clock - face->blink_start;
    if (noh_face_is_four(face)) return face->blinking ? noh_face_four_lid(ticks) : 0.0f;
    for (uint32_t blink = face->blinks - face->blinking; blink != face->blinks; blink++) {
        const noh_face_lid lid = noh_face_lid_of(face, blink);
        const uint32_t whole = lid.closing + lid.shut + lid.opening;
        if (ticks < whole) return lid_at(&lid, ticks);
        if (ticks < whole + DOUBLE_GAP_TICKS) return 0.0f;
        ticks -= whole + DOUBLE_GAP_TICKS;
    }
    return 0.0f;
}

/* Whether a blink is in progress, or another owner's has just been; it is not started again. */
static int is_blinking(const noh_face *face)
{
    const float since = noh_face_seconds((uint32_t)face->clock - face->blink_start);
    return (face->blinking || face->blink_start) && since < (face->blinking ? INTERVAL_MIN_S : APART_S);
}

void noh_face_blink_pull(noh_face *face)
{
    const uint32_t now = (uint32_t)face->clock;
    const uint32_t most = noh_face_ticks(DEBT_MAX * noh_face_blink_mean(face->activity));
    const int by_itself = !(face->flags & (NOH_FACE_CALM | NOH_FACE_NO_BLINK));
    if (is_blinking(face)) {
        return;
    }
    begin(face, by_itself ? face->next_blink : now);
    if (face->next_blink - now > most) {
        face->next_blink = now + most;
    }
}

void noh_face_blink_schedule(noh_face *face)
{
    face->next_blink = (uint32_t)face->clock + interval(face, face->blinks++);
}

void noh_face_blink_seen(noh_face *face, float shut)
{
    const uint32_t now = (uint32_t)face->clock, least = noh_face_ticks(SEEN_S);
    if (face->next_blink - now < least) face->next_blink = now + least;
    if (face->blinking && is_blinking(face) && shut < HIDES) return;
    face->blinking = 0;
    face->blink_start = now;
}
