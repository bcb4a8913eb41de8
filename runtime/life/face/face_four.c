/* face_four.c: the mode of four channels, from C. Granberg, Character Animation with Direct3D, 2009, chapter 9
 * (Animation Channels) and its code: one blink, one emotion, two mouth shapes.
 *
 * The timers are the book's: between blinks (1500 + r mod 4000) / 1000 s of a clock that runs at 0.8, a lid that is
 * half a sine for 0.15 s of it; emotions that rise and fade by 1 per second and hold for (2000 + r mod 6000) / 1000 s.
 * Its errors are corrected: numbers come from the face's own seed and not from rand(), so a face does not depend on
 * other users of rand(); time is in whole ticks and not in frames, so a blink shorter than a frame is not lost and a
 * fade never passes its goal; mouth shapes are limited to a sum of 1. */
#include <string.h>

#include "core/base/trig_internal.h"
#include "core/base/assert_internal.h"
#include "life/face/face_internal.h"
#include "noh/face.h"
#include "noh/low_core.h"

#define LID_TICKS 9000u   /* 0.15 s / 0.8 */
#define FADE_TICKS 48000u /* 1 s */

uint32_t noh_face_four_wait(const noh_face *face, uint32_t blink)
{
    const float u = noh_face_uniform(face->seed, NOH_FACE_INTERVAL, blink);
    return LID_TICKS + 60u * (1500u + (uint32_t)(u * 4000.0f)); /* 48 ticks a millisecond / 0.8 */
}

float noh_face_four_lid(uint32_t ticks)
{
    float sine, cosine;
    if (ticks >= LID_TICKS) return 0.0f;
    noh_sin_cos(3.14159265f * (float)ticks / (float)LID_TICKS, &sine, &cosine);
    return sine < 0.0f ? 0.0f : sine;
}

/* ---- moods: spontaneous emotions in sequence, in the first slot ---- */

void noh_face_mood_begin(noh_face *face, uint32_t emotion, float amount, uint32_t hold)
{
    noh_face_emotion *f = &face->emotions[0];
    memset(face->emotions, 0, sizeof face->emotions);
    f->amount.goal = amount;
    f->amount.omega = 1.0f;
    f->amount.start = (uint32_t)face->clock;
    f->emotion = (uint8_t)emotion;
    f->on = 1;
    f->end = f->amount.start + FADE_TICKS + hold;
}

/* Start a random emotion other than the present one. */
void noh_face_mood_next(noh_face *face)
{
    const uint32_t n = face->moods++;
    const float which = noh_face_uniform(face->seed, NOH_FACE_MOOD, 2u * n),
                hold = noh_face_uniform(face->seed, NOH_FACE_MOOD, 2u * n + 1u);
    uint32_t emotion = (uint32_t)(which * (float)(NOH_EMOTION_COUNT - 1));
    emotion = emotion < NOH_EMOTION_COUNT - 1u ? emotion : NOH_EMOTION_COUNT - 2u;
    if (face->emotions[0].on && emotion >= face->emotions[0].emotion) emotion++;
    noh_face_mood_begin(face, emotion, 1.0f, 48u * (2000u + (uint32_t)(hold * 6000.0f)));
}

uint32_t noh_face_mood_end(const noh_face *face)
{
    return face->emotions[0].end + FADE_TICKS;
}

float noh_face_mood_at(const noh_face *face)
{
    const noh_face_emotion *f = &face->emotions[0];
    const uint32_t age = (uint32_t)face->clock - f->amount.start,
                   left = noh_face_mood_end(face) - (uint32_t)face->clock;
    const uint32_t whole = noh_face_mood_end(face) - f->amount.start;
    const uint32_t least = age < left ? age : left;
    if (age > whole) return 0.0f;
    return f->amount.goal * (least < FADE_TICKS ? (float)least / (float)FADE_TICKS : 1.0f);
}

/* ---- contents of the four channels ---- */

void noh_face_four_of(const noh_face_pose *pose, const float *visemes, noh_face_four *four)
{
    NOH_ASSERT(four);
    memset(four, 0, sizeof *four);
    four->emotion = NOH_EMOTION_COUNT;
    if (pose) four->weights[0] = pose->blink;
    for (uint8_t i = 0; pose && i < NOH_EMOTION_COUNT; i++) {
        if (pose->emotions[i] <= four->weights[1]) continue;
        four->weights[1] = pose->emotions[i];
        four->emotion = i;
    }
    for (uint8_t v = 1; visemes && v < NOH_VISEME_COUNT; v++) {
        if (visemes[v] > four->weights[2]) {
            four->weights[3] = four->weights[2];
            four->speech[1] = four->speech[0];
            four->weights[2] = visemes[v];
            four->speech[0] = v;
        } else if (visemes[v] > four->weights[3]) {
            four->weights[3] = visemes[v];
            four->speech[1] = v;
        }
    }
    for (int i = 2; i < 4; i++) four->weights[i] = four->weights[i] < 1.0f ? four->weights[i] : 1.0f;
    if (four->weights[2] + four->weights[3] > 1.0f) {
        const float sum = four->weights[2] + four->weights[3];
        four->weights[2] /= sum;
        four->weights[3] /= sum;
    }
}

void noh_face_four_visemes(const noh_face_four *four, float *visemes)
{
    NOH_ASSERT(four && visemes);
    memset(visemes, 0, NOH_VISEME_COUNT * sizeof *visemes);
    for (int i = 0; i < 2; i++) {
        if (four->weights[2 + i] > 0.0f) visemes[four->speech[i]] = four->weights[2 + i];
    }
}
