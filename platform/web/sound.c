/* sound.c: from what is heard, or typed, to mouth shapes. */
#include <emscripten.h>
#include <string.h>

#include "web.h"

#define SAMPLES 2048u /* at one time: 256 ms at 8 kHz */
#define FRAMES 32u    /* that they may make */
#define PHONES 1024u

static float samples[SAMPLES];
static int16_t integers[SAMPLES];
static noh_ear ear;
static noh_ear_frame frames[FRAMES];
static noh_phone phones[PHONES];
static noh_speech speech;
static float shapes[NOH_VISEME_COUNT];

/* ---- the ear ---- */

/* Hz: an ear that has heard nothing yet. */
EMSCRIPTEN_KEEPALIVE int web_ear_open(uint32_t rate)
{
    return (int)noh_ear_init(&ear, rate, &web.error);
}
/* The same sound from its beginning, by an ear that knows the speaker and the room. */
EMSCRIPTEN_KEEPALIVE void web_ear_restart(void)
{
    noh_ear_restart(&ear);
}
EMSCRIPTEN_KEEPALIVE uint32_t web_ear_latency(void) /* ms */
{
    return NOH_EAR_LATENCY_MS;
}
/* Where the page is to write samples, -1..1, and how many at a time. */
EMSCRIPTEN_KEEPALIVE float *web_ear_samples(void)
{
    return samples;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_ear_room(void)
{
    return SAMPLES;
}

static int16_t integer_of(float sample)
{
    const float s = sample * 32768.0f;
    return s >= 32767.0f ? 32767 : s <= -32768.0f ? -32768 : s == s ? (int16_t)s : 0;
}

/* Hear so many samples. Returns how many frames that made. */
EMSCRIPTEN_KEEPALIVE uint32_t web_ear_hear(uint32_t count)
{
    uint32_t made = 0;
    for (uint32_t i = 0; i < count; i++) integers[i] = integer_of(samples[i]);
    for (uint32_t at = 0; at < count;) {
        at += (uint32_t)noh_ear_hear(&ear, integers + at, count - at);
        while (made < FRAMES && noh_ear_next(&ear, &frames[made])) made++;
    }
    return made;
}
/* Of these frames: the fifteen weights, and how far the jaw is open. */
EMSCRIPTEN_KEEPALIVE const float *web_ear_shapes(uint32_t frame)
{
    return frames[frame].visemes;
}
EMSCRIPTEN_KEEPALIVE float web_ear_open_by(uint32_t frame)
{
    return frames[frame].open;
}

/* ---- what the mouths show ---- */

/* Where the page is to write the fifteen weights. */
EMSCRIPTEN_KEEPALIVE float *web_shapes(void)
{
    return shapes;
}
/* 1: the weights; 0: nothing is said. */
EMSCRIPTEN_KEEPALIVE void web_show_shapes(int says)
{
    web_say(says ? shapes : NULL);
}

/* ---- phones at their times ---- */

/* Where the page is to write phones: start in ticks and shape (noh_phone); and how many at most. */
EMSCRIPTEN_KEEPALIVE uint32_t *web_phones(void)
{
    return &phones[0].start;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_phone_room(void)
{
    return PHONES;
}

/* Begin to speak so many of them, the last one up to a tick. */
EMSCRIPTEN_KEEPALIVE int web_speak(uint32_t count, uint32_t end)
{
    speech.phones = phones;
    speech.phone_count = count;
    speech.end = end;
    return (int)noh_speech_check(&speech, &web.error);
}

/* The weights at a tick of it. */
EMSCRIPTEN_KEEPALIVE void web_speak_at(double tick)
{
    noh_speech_visemes(&speech, (int64_t)tick, shapes);
}
