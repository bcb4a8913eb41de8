/* face.c: functions of a face, and the order of its events.
 *
 * A step goes from one event to the next: a blink, a breath, the end of a latency or a saccade, a glance, a
 * microsaccade, the end of an emotion's hold. Between two events all motion is a function of the clock. So a face does
 * not depend on how time is split into steps. */
#include "core/base/assert_internal.h"
#include "life/face/face_internal.h"
#include "noh/base.h"
#include "noh/face.h"

#include <string.h>

#include "core/base/compiler_internal.h"
#include "core/base/math_internal.h"
#include "core/base/name_internal.h"

NOH_STATIC_ASSERT(sizeof(noh_face) == 256, face_bytes);

#define NEAREST_M 0.05f
#define BREATHS_PER_MINUTE 15.0f
#define FOLLOW_RAD (1.5f * NOH_DEGREE) /* a target that moves less per call is followed without a saccade */
#define HOLD_MAX 0x7fffffffu

/* ---- names ---- */

static const char *const emotion_names[NOH_EMOTION_COUNT] = { "joy",   "sadness", "surprise", "fear",
                                                              "anger", "disgust", "contempt" };

noh_emotion noh_emotion_of_name(const char *name)
{
    uint32_t i = 0;
    NOH_ASSERT(name);
    while (i < NOH_EMOTION_COUNT && !noh_names_equal(emotion_names[i], name)) i++;
    return (noh_emotion)i;
}

const char *noh_emotion_name(noh_emotion emotion)
{
    return (uint32_t)emotion < NOH_EMOTION_COUNT ? emotion_names[emotion] : NULL;
}

/* ---- descs ---- */

static const char *bad_desc(const noh_face_desc *d, uint64_t *where)
{
    for (uint32_t i = 0; i < 6; i++) {
        *where = i;
        if (!noh_is_number(d->eyes[i / 3][i % 3])) return "eyes of a face desc are not finite, or too large";
    }
    *where = 0;
    if (d->eyes[0][0] - d->eyes[1][0] < 1e-4f) return "eyes of a face desc: the left eye must have the greater x";
    *where = 6;
    if (!noh_is_within(d->head_yaw_max, 0.0f, 3.1f)) return "head_yaw_max of a face desc is not in 0..3.1";
    *where = 7;
    return noh_is_within(d->head_pitch_max, 0.0f, 1.5f) ? NULL : "head_pitch_max of a face desc is not in 0..1.5";
}

/* ---- a face ---- */

uint32_t noh_face_breath_ticks(const noh_face *face, uint32_t breath)
{
    const float u = noh_face_uniform(face->seed, NOH_FACE_BREATH, breath);
    return noh_face_ticks(60.0f / BREATHS_PER_MINUTE * (0.85f + 0.3f * u));
}

static int has_moods(const noh_face *face)
{
    return noh_face_is_four(face) && !(face->flags & NOH_FACE_CALM);
}

static void look_ahead(noh_face *face, const noh_face_desc *desc)
{
    for (int i = 0; i < 3; i++) face->target[i] = 0.5f * (desc->eyes[0][i] + desc->eyes[1][i]);
    face->target[2] += 2.0f;
}

noh_result noh_face_init(noh_face *face, const noh_face_desc *desc, uint32_t seed, uint32_t flags, noh_error *error)
{
    NOH_ASSERT(face && desc);
    uint64_t where = 0;
    const char *what = bad_desc(desc, &where);
    if (what || flags > NOH_FACE_FLAGS) {
        return noh_fail(error, NOH_ERR_ARG, what ? what : "flags must be bits of NOH_FACE_FLAGS", where, 0);
    }
    memset(face, 0, sizeof *face);
    face->seed = seed;
    face->flags = (uint8_t)flags;
    for (int i = 0; i < 2; i++) face->head[i].omega = 1.0f;
    look_ahead(face, desc);
    noh_face_blink_schedule(face);
    noh_face_glance_schedule(face);
    if (has_moods(face)) noh_face_mood_next(face);
    return NOH_OK;
}

void noh_face_set_flags(noh_face *face, uint32_t flags)
{
    NOH_ASSERT(face && flags <= NOH_FACE_FLAGS);
    const uint32_t before = face->flags;
    if (flags & (NOH_FACE_CALM | NOH_FACE_NO_WANDER)) memset(face->away, 0, sizeof face->away);
    if (flags & NOH_FACE_CALM) memset(face->tremor, 0, sizeof face->tremor);
    face->flags = (uint8_t)flags;
    if ((before ^ flags) & NOH_FACE_FOUR) {
        memset(face->emotions, 0, sizeof face->emotions);
        face->blinking = 0;
    }
    if (has_moods(face) && before != flags) noh_face_mood_next(face);
    noh_face_blink_schedule(face);
    noh_face_glance_schedule(face);
    face->next_tremor = (uint32_t)face->clock;
    face->breath_start = (uint32_t)face->clock;
}

/* ---- time ---- */

typedef enum event {
    EVENT_NONE,
    EVENT_BLINK,
    EVENT_BREATH,
    EVENT_GAZE,
    EVENT_GLANCE,
    EVENT_TREMOR,
    EVENT_EMOTION,
    EVENT_MOOD
} event;

/* Keep the sooner of the next event and `tick`; ticks are compared by the time left. */
static void take_sooner(uint32_t now, uint32_t tick, event e, uint32_t *left, event *next)
{
    const uint32_t to = tick - now;
    if (to < *left || (to == *left && *next == EVENT_NONE)) {
        *left = to;
        *next = e;
    }
}

static int does(const noh_face *face, uint32_t flag)
{
    return !(face->flags & (NOH_FACE_CALM | flag));
}

/* The first event within `left` ticks. At one tick, the first in this order. */
static event next_event(const noh_face *face, uint32_t *left)
{
    const uint32_t now = (uint32_t)face->clock;
    event next = EVENT_NONE;
    if (does(face, NOH_FACE_NO_BLINK)) take_sooner(now, face->next_blink, EVENT_BLINK, left, &next);
    if (does(face, NOH_FACE_NO_BREATH)) {
        take_sooner(now, face->breath_start + noh_face_breath_ticks(face, face->breaths), EVENT_BREATH, left, &next);
    }
    if (face->gaze != NOH_GAZE_HOLD) {
        take_sooner(now, face->gaze_start + face->gaze_ticks, EVENT_GAZE, left, &next);
    }
    if (does(face, NOH_FACE_NO_WANDER)) {
        take_sooner(now, face->next_glance, EVENT_GLANCE, left, &next);
    }
    if (does(face, 0)) take_sooner(now, face->next_tremor, EVENT_TREMOR, left, &next);
    if (has_moods(face)) take_sooner(now, noh_face_mood_end(face), EVENT_MOOD, left, &next);
    for (uint32_t i = 0; i < NOH_FACE_EMOTIONS_MAX; i++) {
        if (face->emotions[i].holds) take_sooner(now, face->emotions[i].end, EVENT_EMOTION, left, &next);
    }
    return next;
}

static void fade_emotions(noh_face *face)
{
    const uint32_t now = (uint32_t)face->clock;
    for (uint32_t i = 0; i < NOH_FACE_EMOTIONS_MAX; i++) {
        noh_face_emotion *f = &face->emotions[i];
        if (f->holds && f->end == now) {
            noh_face_spring_to(&f->amount, now, 0.0f, f->fade_omega);
            f->holds = 0;
        }
    }
}

static void handle(noh_face *face, const noh_face_desc *desc, event e)
{
    switch (e) {
    case EVENT_BLINK: noh_face_blink_begin(face); break;
    case EVENT_BREATH:
        face->breath_start = (uint32_t)face->clock;
        face->breaths++;
        break;
    case EVENT_GAZE: noh_face_gaze_event(face, desc); break;
    case EVENT_GLANCE: noh_face_glance(face, desc); break;
    case EVENT_TREMOR: noh_face_tremor(face); break;
    case EVENT_EMOTION: fade_emotions(face); break;
    case EVENT_MOOD: noh_face_mood_next(face); break;
    case EVENT_NONE: break;
    }
}

/* Restart springs at rest, long before ticks modulo 2^32 wrap. */
static void settle(noh_face *face)
{
    const uint32_t now = (uint32_t)face->clock;
    for (int i = 0; i < 2; i++) noh_face_spring_settle(&face->head[i], now);
    for (uint32_t i = 0; i < NOH_FACE_EMOTIONS_MAX && !noh_face_is_four(face); i++) {
        noh_face_spring_settle(&face->emotions[i].amount, now);
    }
    if (now - face->blink_start > 48000u) face->blinking = 0;
    if (noh_face_is_four(face) && (int32_t)(now - noh_face_mood_end(face)) > 0) face->emotions[0].on = 0;
}

void noh_face_step(noh_face *face, const noh_face_desc *desc, uint32_t ticks)
{
    NOH_ASSERT(face && desc);
    while (ticks) {
        uint32_t left = ticks < HOLD_MAX ? ticks : HOLD_MAX;
        const event e = next_event(face, &left);
        face->clock += left;
        ticks -= left;
        handle(face, desc, e);
    }
    settle(face);
}

/* Move a spring to its goal. */
static void arrive(noh_face_spring *s, uint32_t now)
{
    s->from = s->goal;
    s->speed = 0.0f;
    s->start = now;
}

static void skip_emotion(noh_face_emotion *f, uint32_t now, int64_t ticks)
{
    const uint32_t left = f->end - (now - (uint32_t)ticks);
    if (f->holds && ticks >= (int64_t)left) {
        f->holds = 0;
        f->amount.goal = 0.0f;
    }
    arrive(&f->amount, now);
    if (!(f->amount.goal > 0.0f)) f->on = 0;
}

void noh_face_skip(noh_face *face, const noh_face_desc *desc, int64_t ticks)
{
    uint32_t now;
    NOH_ASSERT(face && desc && ticks >= 0);
    face->clock += ticks;
    now = (uint32_t)face->clock;
    if (has_moods(face)) noh_face_mood_next(face);
    for (uint32_t i = 0; i < NOH_FACE_EMOTIONS_MAX && !noh_face_is_four(face); i++) {
        if (face->emotions[i].on) skip_emotion(&face->emotions[i], now, ticks);
    }
    face->gaze = NOH_GAZE_HOLD;
    face->blinking = 0;
    memset(face->away, 0, sizeof face->away);
    face->breath_start = face->next_tremor = now;
    noh_face_head_follow(face, desc);
    for (int i = 0; i < 2; i++) arrive(&face->head[i], now);
    noh_face_blink_schedule(face);
    noh_face_glance_schedule(face);
}

/* ---- calls ---- */

static noh_result check_point(const noh_face_desc *desc, const float point[3], noh_error *error)
{
    float square = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float way = point[i] - 0.5f * (desc->eyes[0][i] + desc->eyes[1][i]);
        square += way * way;
    }
    return square >= NEAREST_M * NEAREST_M && square < 1e12f
               ? NOH_OK
               : noh_fail(error, NOH_ERR_ARG, "the point to look at is not finite, or within 5 cm of the eyes", 0, 0);
}

noh_result noh_face_follow(noh_face *face, const noh_face_desc *desc, const float point[3], noh_error *error)
{
    noh_result result;
    NOH_ASSERT(face && desc && point);
    result = check_point(desc, point, error);
    if (result == NOH_OK) {
        memcpy(face->target, point, sizeof face->target);
        if (face->gaze == NOH_GAZE_HOLD) noh_face_head_follow(face, desc);
    }
    return result;
}

noh_result noh_face_look_at(noh_face *face, const noh_face_desc *desc, const float point[3], noh_error *error)
{
    float before[3], goal[3];
    noh_result result;
    NOH_ASSERT(face && desc);
    result = point ? check_point(desc, point, error) : NOH_OK;
    if (result != NOH_OK) {
        return result;
    }
    noh_face_gaze_at(face, desc, before);
    if (point) {
        memcpy(face->target, point, sizeof face->target);
    } else {
        look_ahead(face, desc);
    }
    if (face->gaze != NOH_GAZE_HOLD) {
        return NOH_OK;
    }
    noh_face_gaze_goal(face, desc, goal);
    if (noh_face_angle(before, goal) <= FOLLOW_RAD) {
        noh_face_head_follow(face, desc);
        return NOH_OK;
    }
    memset(face->away, 0, sizeof face->away);
    noh_face_gaze_shift(face, before, noh_face_latency(face));
    face->glances++;
    noh_face_glance_schedule(face);
    return NOH_OK;
}

/* The slot of this emotion, else a free one, else the weakest. */
static noh_face_emotion *emotion_for(noh_face *face, noh_emotion emotion)
{
    const uint32_t now = (uint32_t)face->clock;
    noh_face_emotion *best = &face->emotions[0];
    for (uint32_t i = 0; i < NOH_FACE_EMOTIONS_MAX; i++) {
        if (face->emotions[i].on && face->emotions[i].emotion == emotion) return &face->emotions[i];
    }
    for (uint32_t i = 0; i < NOH_FACE_EMOTIONS_MAX; i++) {
        noh_face_emotion *f = &face->emotions[i];
        if (!f->on) return f;
        if (noh_face_spring_at(&f->amount, now) < noh_face_spring_at(&best->amount, now)) best = f;
    }
    return best;
}

noh_result noh_face_set_emotion(noh_face *face, noh_emotion emotion, float amount, uint32_t onset_ticks,
                                uint32_t hold_ticks, uint32_t fade_ticks, noh_error *error)
{
    noh_face_emotion *f;
    NOH_ASSERT(face);
    if ((unsigned)emotion >= NOH_EMOTION_COUNT)
        return noh_fail(error, NOH_ERR_ARG,
                        "unknown emotion: use joy, sadness, surprise, fear, anger, disgust or contempt", emotion, 0);
    if (!(amount >= 0.0f && amount <= 1.0f)) return noh_fail(error, NOH_ERR_ARG, "amount must be 0 to 1", 0, 0);
    if (onset_ticks > HOLD_MAX || hold_ticks > HOLD_MAX || fade_ticks > HOLD_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "onset_ticks, hold_ticks and fade_ticks must be below 2^31", 0, HOLD_MAX);
    }
    if (noh_face_is_four(face)) {
        noh_face_mood_begin(face, (uint32_t)emotion, amount, hold_ticks ? hold_ticks : 240000u);
        return NOH_OK;
    }
    f = emotion_for(face, emotion);
    if (!f->on || f->emotion != emotion) {
        memset(f, 0, sizeof *f);
        f->amount.omega = 1.0f;
        f->amount.start = (uint32_t)face->clock;
    }
    f->emotion = (uint8_t)emotion;
    f->on = 1;
    f->holds = hold_ticks != 0;
    f->end = (uint32_t)face->clock + hold_ticks;
    f->fade_omega = noh_face_omega(fade_ticks ? fade_ticks : 38400u);
    noh_face_spring_to(&f->amount, (uint32_t)face->clock, amount, noh_face_omega(onset_ticks ? onset_ticks : 16800u));
    return NOH_OK;
}

void noh_face_set_activity(noh_face *face, noh_activity activity)
{
    NOH_ASSERT(face && (unsigned)activity < NOH_ACTIVITY_COUNT);
    const uint32_t now = (uint32_t)face->clock;
    float before, after;
    if (activity == face->activity) {
        return;
    }
    before = noh_face_blink_mean(face->activity);
    after = noh_face_blink_mean(activity);
    face->next_blink = now + (uint32_t)((float)(face->next_blink - now) * (after / before));
    face->activity = (uint8_t)activity;
    noh_face_glance_schedule(face);
}

void noh_face_blink(noh_face *face)
{
    NOH_ASSERT(face);
    noh_face_blink_pull(face);
}

noh_result noh_face_speak(noh_face *face, const noh_face_desc *desc, const noh_face_speech *speech, noh_error *error)
{
    static const noh_face_speech none = { 0.0f, 0.0f, 0.0f, 0.0f };
    const noh_face_speech *s = speech ? speech : &none;
    noh_face_speech before;
    NOH_ASSERT(face && desc);
    before = face->speech;
    if (!(s->brows >= 0.0f && s->brows <= 1.0f && s->nod >= 0.0f && s->nod <= 1.0f && s->blink >= 0.0f &&
          s->blink <= 1.0f && s->away >= 0.0f && s->away <= 1.0f)) {
        return noh_fail(error, NOH_ERR_ARG, "what speech asks of a face must be 0 to 1", 0, 0);
    }
    face->speech = *s;
    if (s->blink > 0.5f && !(before.blink > 0.5f)) noh_face_blink_pull(face);
    if ((s->away > 0.5f) != (before.away > 0.5f)) noh_face_look_aside(face, desc, s->away > 0.5f);
    return NOH_OK;
}
