/* Stress is where pitch and loudness are high together; it shows in brows and nods (Busso, Deng, Grimm, Neumann and
 * Narayanan, "Rigid head motion in expressive speech animation", 2007), blinks and looks aside come at pauses (Albrecht,
 * Haber and Seidel, "Automatic generation of non-verbal facial expressions from speech", 2002). */
#include "prosody.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

#define RATE 8000u
#define HOP (RATE / PROSODY_RATE)
#define WINDOW 320  /* 40 ms */
#define LAG_MIN 20  /* 400 Hz */
#define LAG_MAX 114 /* 70 Hz */
#define VOICED 0.5  /* correlation of a voice with itself a period later */
#define VOICE_DB -55.0f /* a voice is louder */
#define RANGE_DB 35.0
#define SMOOTH 6 /* frames to each side */
#define APART 30 /* least frames between two stresses */
#define STRESS_MIN 0.55f
#define PAUSE_LOUD 0.12f
#define PAUSE 18 /* least frames of a pause; with PAUSE_LONG it looks aside */
#define PAUSE_LONG 35
#define ASIDE_MAX 80
#define BLINK 15

typedef struct voice_frame {
    float db, pitch; /* pitch: semitones over the median; 0: not voiced */
    float stress;
} voice_frame;

/* The lag at which a window is most like itself, 0 where it is not voiced. */
static double period_of(const float *x)
{
    double best = VOICED, energy = 0.0, found = 0.0;
    for (int i = 0; i < WINDOW; i++) energy += (double)x[i] * (double)x[i];
    for (int lag = LAG_MIN; lag <= LAG_MAX; lag++) {
        double sum = 0.0, other = 0.0;
        for (int i = 0; i < WINDOW; i++) {
            sum += (double)x[i] * (double)x[i + lag];
            other += (double)x[i + lag] * (double)x[i + lag];
        }
        sum /= sqrt(energy * other) + 1e-9;
        if (sum > best * 1.02) {
            best = sum;
            found = lag;
        }
    }
    return found;
}

static int by_size(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Sorts the values. */
static float percentile(float *values, uint32_t count, double part)
{
    if (!count) return 0.0f;
    qsort(values, count, sizeof *values, by_size);
    return values[(uint32_t)(part * (count - 1u))];
}

static void smooth(prosody *p, voice_frame *v)
{
    for (uint32_t i = 0; i < p->count; i++) {
        const uint32_t first = i > SMOOTH ? i - SMOOTH : 0,
                       end = i + SMOOTH + 1u < p->count ? i + SMOOTH + 1u : p->count;
        float loud = 0.0f, pitch = 0.0f;
        for (uint32_t k = first; k < end; k++) {
            loud += p->frames[k].loud;
            pitch += v[k].pitch;
        }
        pitch = fmaxf(0.0f, fminf(1.0f, 0.5f + pitch / (float)(end - first) / 8.0f));
        v[i].stress = loud / (float)(end - first) * (0.6f + 0.8f * pitch);
    }
}

/* Loudness and pitch of each frame. */
static void measure(const sound *s, prosody *p, voice_frame *v, float *sorted)
{
    uint32_t voiced = 0;
    float loudest, median;
    for (uint32_t f = 0; f < p->count; f++) {
        const float *x = s->samples + (size_t)f * HOP;
        double energy = 0.0, lag;
        for (int i = 0; i < WINDOW; i++) energy += (double)x[i] * (double)x[i];
        v[f].db = (float)(10.0 * log10(energy / WINDOW + 1e-10));
        lag = v[f].db > VOICE_DB ? period_of(x) : 0.0;
        v[f].pitch = lag > 0.0 ? (float)(12.0 * log2(RATE / lag)) : 0.0f;
    }
    for (uint32_t f = 0; f < p->count; f++) sorted[f] = v[f].db;
    loudest = fmaxf(percentile(sorted, p->count, 0.95), VOICE_DB);
    for (uint32_t f = 0; f < p->count; f++) {
        p->frames[f].loud = (float)fmax(0.0, fmin(1.0, 1.0 + ((double)v[f].db - (double)loudest) / RANGE_DB * 1.4));
        if (v[f].pitch > 0.0f) sorted[voiced++] = v[f].pitch;
    }
    median = percentile(sorted, voiced, 0.5);
    for (uint32_t f = 0; f < p->count; f++) v[f].pitch = v[f].pitch > 0.0f ? v[f].pitch - median : 0.0f;
    smooth(p, v);
}

/* A bump of a cosine about a frame. */
static float bump(double frame, double at, double rise, double fall)
{
    const double t = frame < at ? (at - frame) / rise : (frame - at) / fall;
    return t < 1.0 ? (float)(0.5 + 0.5 * cos(3.14159265358979 * t)) : 0.0f;
}

static void add_stress(prosody *p, const voice_frame *v, uint32_t at, float strongest)
{
    const float over = strongest - STRESS_MIN + 1e-6f;
    const float size = 0.3f + 0.7f * (v[at].stress - STRESS_MIN) / over;
    for (uint32_t f = at > 20u ? at - 20u : 0; f < at + 45u && f < p->count; f++) {
        noh_face_speech *face = &p->frames[f].face;
        face->nod = fmaxf(face->nod, size * bump(f, at, 12.0, 28.0));
        face->brows = fmaxf(face->brows, size * bump(f, at, 20.0, 45.0));
    }
    p->stresses++;
}

/* Frames that are the highest for APART frames on both sides. */
static void find_stresses(prosody *p, const voice_frame *v)
{
    float strongest = 0.0f;
    for (uint32_t i = 0; i < p->count; i++) strongest = fmaxf(strongest, v[i].stress);
    for (uint32_t i = 0; i < p->count; i++) {
        int highest = v[i].stress >= STRESS_MIN;
        const uint32_t end = i + APART < p->count ? i + APART : p->count;
        for (uint32_t k = i > APART ? i - APART : 0; k < end && highest; k++) {
            highest = k == i || v[k].stress < v[i].stress || (k > i && v[k].stress <= v[i].stress);
        }
        if (highest) add_stress(p, v, i, strongest);
    }
}

static void add_pause(prosody *p, uint32_t first, uint32_t end)
{
    for (uint32_t f = first; f < first + BLINK && f < p->count; f++) p->frames[f].face.blink = 1.0f;
    for (uint32_t f = first; end - first >= PAUSE_LONG && f < end && f < first + ASIDE_MAX; f++) {
        p->frames[f].face.away = 1.0f;
    }
    p->pauses++;
}

/* Behind a voice: what is quiet before it is no pause. */
static void find_pauses(prosody *p)
{
    uint32_t quiet = 0, spoken = 0;
    for (uint32_t i = 0; i <= p->count; i++) {
        if (i < p->count && p->frames[i].loud < PAUSE_LOUD) {
            quiet++;
            continue;
        }
        if (spoken && (quiet >= PAUSE || (i == p->count && quiet > 2u))) add_pause(p, i - quiet, i);
        quiet = 0;
        spoken = 1;
    }
}

int prosody_make(const sound *voice, prosody *out)
{
    sound s;
    voice_frame *v;
    float *sorted;
    memset(out, 0, sizeof *out);
    if (sound_resample(voice, RATE, &s)) return 1;
    out->count = s.count > WINDOW + LAG_MAX ? (uint32_t)((s.count - WINDOW - LAG_MAX) / HOP) : 0;
    out->frames = calloc(out->count + 1u, sizeof *out->frames);
    v = calloc(out->count + 1u, sizeof *v);
    sorted = calloc(out->count + 1u, sizeof *sorted);
    if (out->frames && v && sorted) {
        measure(&s, out, v, sorted);
        find_stresses(out, v);
        find_pauses(out);
    }
    free(sorted);
    sound_free(&s);
    if (out->frames && v && sorted) {
        free(v);
        return 0;
    }
    free(v);
    prosody_free(out);
    return tool_fail("speak", "out of memory");
}

void prosody_free(prosody *p)
{
    free(p->frames);
    memset(p, 0, sizeof *p);
}

prosody_frame prosody_at(const prosody *p, int64_t tick)
{
    const int64_t frame = tick * PROSODY_RATE / NOH_TICKS_PER_SECOND;
    const prosody_frame none = { { 0.0f, 0.0f, 0.0f, 0.0f }, 0.0f };
    return tick >= 0 && frame < (int64_t)p->count ? p->frames[frame] : none;
}
