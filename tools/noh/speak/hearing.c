#include "hearing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/face.h"

#define RATE 16000u
#define OPEN_STEP 0.125f /* of a mouth, in a frame of a track: as fast as speech.c closes lips */
#define WINDOW_FRAMES (SPEECH_TRACK_RATE / NOH_AMPLITUDE_RATE) /* of a track, in a window of face.h */

static float open_of(const float *visemes)
{
    float open = 0.0f;
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) open += visemes[v] * viseme_open(v);
    return open;
}

typedef struct listening {
    int16_t *samples;
    size_t count;
    speech_track *track;
} listening;

double hearing_latency_ms(const hearing *how)
{
    return !how->live ? 0.0 : how->amplitude ? NOH_AMPLITUDE_LATENCY_MS : how->latency_ms;
}

/* At RATE, with silence behind it: the last frames are known only then. */
static int listen(const sound *recording, listening *l)
{
    const size_t tail = RATE / 10u;
    sound at_rate;
    if (sound_resample(recording, RATE, &at_rate)) return 1;
    l->count = at_rate.count + tail;
    l->samples = calloc(l->count, sizeof *l->samples);
    for (size_t i = 0; l->samples && i < at_rate.count; i++) {
        const float value = 32768.0f * at_rate.samples[i];
        l->samples[i] = (int16_t)lrintf(value < -32768.0f ? -32768.0f : value > 32767.0f ? 32767.0f : value);
    }
    sound_free(&at_rate);
    return l->samples ? 0 : tool_fail("speak", "out of memory");
}

/* ---- the ear ---- */

static void hear_ear(listening *l, noh_ear *ear)
{
    speech_track *t = l->track;
    noh_ear_frame frame;
    t->frame_count = 1; /* the ear's frames lie 12.5 ms behind their number, the track's 5 ms */
    for (size_t at = 0; at < l->count;) {
        at += noh_ear_hear(ear, l->samples + at, l->count - at);
        while (noh_ear_next(ear, &frame)) {
            speech_track_frame *f = &t->frames[t->frame_count];
            if (t->frame_count == t->frame_room) return;
            f->shape = frame.shape;
            memcpy(f->visemes, frame.visemes, sizeof f->visemes);
            f->open = frame.open;
            f->round = frame.round;
            if (t->frame_count++ == 1) t->frames[0] = *f;
        }
    }
}

/* Leave a frame no more than a step more open than its neighbour, by a blend with it. */
static void close_towards(speech_track_frame *f, const speech_track_frame *neighbour)
{
    const float more = open_of(f->visemes) - open_of(neighbour->visemes);
    for (uint32_t v = 0; v < NOH_VISEME_COUNT && more > OPEN_STEP; v++) {
        f->visemes[v] = neighbour->visemes[v] + OPEN_STEP / more * (f->visemes[v] - neighbour->visemes[v]);
    }
    f->open = fminf(f->open, neighbour->open + OPEN_STEP);
}

/* The ear shuts lips from one frame to the next; a recording's track knows before that they will. */
static void slow_lips(speech_track *t)
{
    for (uint32_t f = 1; f < t->frame_count; f++) close_towards(&t->frames[f], &t->frames[f - 1u]);
    for (uint32_t f = t->frame_count; f > 1; f--) close_towards(&t->frames[f - 2u], &t->frames[f - 1u]);
}

static void by_ear(listening *l, const hearing *how)
{
    noh_ear ear;
    /* the rate is one that it takes, and so is the latency */
    (void)noh_ear_init(&ear, RATE, how->live ? (uint32_t)how->latency_ms : NOH_EAR_LATENCY_MAX_MS, NULL);
    if (!how->live) {
        hear_ear(l, &ear);
        noh_ear_restart(&ear);
    }
    hear_ear(l, &ear);
    if (!how->live) slow_lips(l->track);
}

/* ---- loudness ---- */

static uint32_t hear_amplitude(listening *l, noh_amplitude *a, noh_amplitude_frame *windows, uint32_t room)
{
    uint32_t count = 0;
    for (size_t at = 0; at < l->count;) {
        at += noh_amplitude_hear(a, l->samples + at, l->count - at);
        while (count < room && noh_amplitude_next(a, &windows[count])) count++;
    }
    noh_amplitude_end(a);
    while (count < room && noh_amplitude_next(a, &windows[count])) count++;
    return count;
}

/* From the middle of one window to the middle of the next. */
static void mix_windows(const noh_amplitude_frame *windows, uint32_t count, speech_track *t)
{
    for (t->frame_count = 0; t->frame_count < t->frame_room; t->frame_count++) {
        speech_track_frame *f = &t->frames[t->frame_count];
        const uint32_t at = 2u * t->frame_count + 1u, step = 2u * WINDOW_FRAMES; /* in halves of a frame */
        const uint32_t from = at < WINDOW_FRAMES ? 0u : (at - WINDOW_FRAMES) / step;
        const uint32_t to = from + 1u < count ? from + 1u : from;
        const float part = at < WINDOW_FRAMES ? 0.0f : (float)((at - WINDOW_FRAMES) % step) / (float)step;
        if (from >= count) break;
        noh_amplitude_between(&windows[from], &windows[to], part, f->visemes);
        f->shape = (uint32_t)windows[part < 0.5f ? from : to].viseme;
        f->open = open_of(f->visemes);
        f->round = 0.0f;
        for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) f->round += f->visemes[v] * viseme_round(v);
    }
}

static int by_amplitude(listening *l, int live)
{
    const uint32_t room = (uint32_t)(l->count / (RATE / NOH_AMPLITUDE_RATE)) + 3u;
    noh_amplitude_frame *windows = calloc(room, sizeof *windows);
    noh_amplitude a;
    uint32_t count;
    if (!windows) return tool_fail("speak", "out of memory");
    (void)noh_amplitude_init(&a, RATE, 1, NULL);
    if (!live) {
        (void)hear_amplitude(l, &a, windows, room);
        noh_amplitude_restart(&a);
    }
    count = hear_amplitude(l, &a, windows, room);
    mix_windows(windows, count, l->track);
    free(windows);
    return 0;
}

/* ---- runs of one shape ---- */

static int find_runs(const speech_track *t, const sound *recording, synthesis *said)
{
    static const char *const phones[NOH_VISEME_COUNT] = { "",  "p",        "f", "\xce\xb8", "t", "k", "\xca\x83", "s",
                                                          "n", "\xc9\xb9", "a", "\xc9\x9b", "i", "o", "u" };
    memset(said, 0, sizeof *said);
    said->sample_rate = recording->rate;
    said->sample_count = recording->count;
    said->phones = calloc(t->frame_count + 1u, sizeof *said->phones);
    if (!said->phones) return tool_fail("speak", "out of memory");
    for (uint32_t f = 0; f < t->frame_count; f++) {
        const uint64_t sample = (uint64_t)f * recording->rate / SPEECH_TRACK_RATE;
        spoken_phone *p = &said->phones[said->phone_count];
        if (f && t->frames[f].shape == t->frames[f - 1u].shape) continue;
        if (sample >= recording->count) break;
        p->sample = (uint32_t)sample;
        memcpy(p->name, phones[t->frames[f].shape], strlen(phones[t->frames[f].shape]) + 1u);
        said->phone_count++;
    }
    return 0;
}

int hearing_make(const sound *recording, const hearing *how, synthesis *said, speech_track *track)
{
    listening l;
    int status;
    memset(&l, 0, sizeof l);
    l.track = track;
    status = speech_track_frames(track, (double)recording->count / recording->rate);
    if (!status) status = listen(recording, &l);
    if (!status && !how->amplitude) by_ear(&l, how);
    if (!status && how->amplitude) status = by_amplitude(&l, how->live);
    if (!status) status = find_runs(track, recording, said);
    free(l.samples);
    return status;
}
