/* sound.c: mouth shapes from sound or text. */
#include <emscripten.h>
#include <string.h>

#include "web.h"

#define SAMPLES 2048u /* per call: 256 ms at 8 kHz */
#define FRAMES 32u    /* most frames of a call */
#define PHONES 1024u

static float samples[SAMPLES];
static int16_t integers[SAMPLES];
static noh_ear ear;
static noh_ear_frame frames[FRAMES];
static noh_phone phones[PHONES];
static noh_speech speech;
static float shapes[NOH_VISEME_COUNT];

/* ---- the ear ---- */

/* Start a new ear. rate: Hz; latency_ms: 40 to 80. */
EMSCRIPTEN_KEEPALIVE int web_ear_open(uint32_t rate, uint32_t latency_ms)
{
    return (int)noh_ear_init(&ear, rate, latency_ms, &web.error);
}
/* Restart the sound; the ear keeps its adaptation to the speaker and the room. */
EMSCRIPTEN_KEEPALIVE void web_ear_restart(void)
{
    noh_ear_restart(&ear);
}
/* Where the page writes samples, -1..1, and how many per call. */
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

/* Hear `count` samples. Returns the number of new frames. */
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
/* Of a new frame: the fifteen weights, and the opening of the jaw. */
EMSCRIPTEN_KEEPALIVE const float *web_ear_shapes(uint32_t frame)
{
    return frames[frame].visemes;
}
EMSCRIPTEN_KEEPALIVE float web_ear_open_by(uint32_t frame)
{
    return frames[frame].open;
}

/* ---- mouth shapes ---- */

/* Where the page writes the fifteen weights. */
EMSCRIPTEN_KEEPALIVE float *web_shapes(void)
{
    return shapes;
}
/* 1: show the weights; 0: silence. */
EMSCRIPTEN_KEEPALIVE void web_show_shapes(int says)
{
    web_say(says ? shapes : NULL);
}

/* ---- phones at their times ---- */

/* Where the page writes phones, each with start in ticks and shape (noh_phone), and their largest number. */
EMSCRIPTEN_KEEPALIVE uint32_t *web_phones(void)
{
    return &phones[0].start;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_phone_room(void)
{
    return PHONES;
}

/* Start to speak `count` phones; the last one lasts until tick `end`. */
EMSCRIPTEN_KEEPALIVE int web_speak(uint32_t count, uint32_t end)
{
    speech.phones = phones;
    speech.phone_count = count;
    speech.end = end;
    return (int)noh_speech_check(&speech, &web.error);
}

/* Compute the weights at a tick of the speech. */
EMSCRIPTEN_KEEPALIVE void web_speak_at(double tick)
{
    noh_speech_visemes(&speech, (int64_t)tick, shapes);
}
