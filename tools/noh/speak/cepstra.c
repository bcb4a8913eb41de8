#include "cepstra.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

#define FFT 512u
#define WINDOW 400u
#define HOP (FEATURE_SOUND_RATE / FEATURE_RATE)
#define MELS 24u
#define LOW_HZ 80.0
#define PRE_EMPHASIS 0.97f
#define FLOOR 1e-7 /* of a band's power, full scale being 1 */
#define SLOPE 2    /* frames on each side that a slope looks at */
#define PI 3.14159265358979323846

typedef struct bank {
    float window[WINDOW];
    float cosine[FFT], sine[FFT]; /* of the turn by i / FFT */
    float edges[MELS + 2u];       /* of the bands, in bins */
    float dct[FEATURE_CEPSTRA][MELS];
} bank;

static double mel_of(double hz)
{
    return 2595.0 * log10(1.0 + hz / 700.0);
}

static double hz_of(double mel)
{
    return 700.0 * (pow(10.0, mel / 2595.0) - 1.0);
}

static void bank_make(bank *b, double top_hz)
{
    for (uint32_t i = 0; i < WINDOW; i++) b->window[i] = (float)(0.54 - 0.46 * cos(2.0 * PI * i / (WINDOW - 1u)));
    for (uint32_t i = 0; i < FFT; i++) {
        b->cosine[i] = (float)cos(2.0 * PI * i / FFT);
        b->sine[i] = (float)sin(2.0 * PI * i / FFT);
    }
    for (uint32_t i = 0; i < MELS + 2u; i++) {
        const double mel = mel_of(LOW_HZ) + (mel_of(top_hz) - mel_of(LOW_HZ)) * i / (MELS + 1u);
        b->edges[i] = (float)(hz_of(mel) * FFT / FEATURE_SOUND_RATE);
    }
    for (uint32_t c = 0; c < FEATURE_CEPSTRA; c++) {
        for (uint32_t m = 0; m < MELS; m++) {
            b->dct[c][m] = (float)(sqrt((c ? 2.0 : 1.0) / MELS) * cos(PI * c * (m + 0.5) / MELS));
        }
    }
}

/* The discrete Fourier transform in place, by halving in time. */
static void transform(const bank *b, float *re, float *im)
{
    for (uint32_t i = 1, j = 0; i < FFT; i++) {
        uint32_t bit = FFT >> 1;
        for (; j & bit; bit >>= 1) j ^= bit;
        j |= bit;
        if (i < j) {
            const float t = re[i];
            re[i] = re[j];
            re[j] = t;
        }
    }
    for (uint32_t size = 2; size <= FFT; size <<= 1) {
        for (uint32_t at = 0; at < FFT; at += size) {
            for (uint32_t k = 0; k < size / 2u; k++) {
                const float c = b->cosine[k * (FFT / size)], s = b->sine[k * (FFT / size)];
                const uint32_t u = at + k, v = u + size / 2u;
                const float x = re[v] * c + im[v] * s, y = im[v] * c - re[v] * s;
                re[v] = re[u] - x;
                im[v] = im[u] - y;
                re[u] += x;
                im[u] += y;
            }
        }
    }
}

static float sample(const sound *in, ptrdiff_t at)
{
    return at >= 0 && at < (ptrdiff_t)in->count ? in->samples[at] : 0.0f;
}

static float band_power(const bank *b, const float *power, uint32_t band)
{
    const float low = b->edges[band], peak = b->edges[band + 1u], high = b->edges[band + 2u];
    float sum = 0.0f;
    for (uint32_t k = (uint32_t)low; k <= (uint32_t)high + 1u && k <= FFT / 2u; k++) {
        const float up = ((float)k - low) / (peak - low), down = (high - (float)k) / (high - peak);
        const float w = up < down ? up : down;
        sum += w > 0.0f ? w * power[k] : 0.0f;
    }
    return sum;
}

static void frame_make(const bank *b, const sound *in, size_t frame, float *cepstra, float *level)
{
    const ptrdiff_t start = (ptrdiff_t)(frame * HOP + HOP / 2u) - (ptrdiff_t)(WINDOW / 2u);
    float re[FFT] = { 0 }, im[FFT] = { 0 }, power[FFT / 2u + 1u];
    double sum = 0.0, energy = 0.0, bright = 0.0;
    for (uint32_t i = 0; i < WINDOW; i++) {
        const float now = sample(in, start + (ptrdiff_t)i), before = sample(in, start + (ptrdiff_t)i - 1);
        re[i] = b->window[i] * (now - PRE_EMPHASIS * before);
        sum += (double)now;
        energy += (double)(now * now);
        bright += (double)(re[i] * re[i]);
    }
    energy -= sum * sum / WINDOW;
    *level = (float)(5.0 * log10(fmax(energy, 0.0) / WINDOW + 1e-10) + 5.0 * log10(bright / WINDOW + 1e-10));
    transform(b, re, im);
    for (uint32_t k = 0; k <= FFT / 2u; k++) power[k] = re[k] * re[k] + im[k] * im[k];
    memset(cepstra, 0, FEATURE_CEPSTRA * sizeof *cepstra);
    for (uint32_t m = 0; m < MELS; m++) {
        const float loud = (float)log((double)band_power(b, power, m) + FLOOR);
        for (uint32_t c = 0; c < FEATURE_CEPSTRA; c++) cepstra[c] += b->dct[c][m] * loud;
    }
}

static void slopes(features *f)
{
    for (size_t t = 0; t < f->frames; t++) {
        for (uint32_t c = 0; c < FEATURE_CEPSTRA; c++) {
            float sum = 0.0f;
            for (int k = 1; k <= SLOPE; k++) {
                const size_t before = t >= (size_t)k ? t - (size_t)k : 0u;
                const size_t after = t + (size_t)k < f->frames ? t + (size_t)k : f->frames - 1u;
                sum += (float)k * (f->values[after * FEATURE_COUNT + c] - f->values[before * FEATURE_COUNT + c]);
            }
            f->values[t * FEATURE_COUNT + FEATURE_CEPSTRA + c] = sum;
        }
    }
}

int features_make(const sound *in, float top_hz, features *out)
{
    bank *b = malloc(sizeof *b);
    memset(out, 0, sizeof *out);
    out->frames = (in->count + HOP - 1u) / HOP;
    out->values = malloc((out->frames * FEATURE_COUNT + 1u) * sizeof *out->values);
    out->level = malloc((out->frames + 1u) * sizeof *out->level);
    if (!b || !out->values || !out->level) {
        free(b);
        features_free(out);
        return tool_fail("speak", "out of memory");
    }
    bank_make(b, (double)top_hz);
    for (size_t t = 0; t < out->frames; t++) frame_make(b, in, t, out->values + t * FEATURE_COUNT, &out->level[t]);
    slopes(out);
    free(b);
    return 0;
}

void features_normalise(features *f, const unsigned char *used)
{
    for (uint32_t c = 0; c < FEATURE_COUNT; c++) {
        double sum = 0.0, squares = 0.0, count = 0.0, mean, deviation;
        for (size_t t = 0; t < f->frames; t++) {
            const double v = (double)f->values[t * FEATURE_COUNT + c];
            if (used && !used[t]) continue;
            sum += v;
            squares += v * v;
            count += 1.0;
        }
        mean = count > 0.0 ? sum / count : 0.0;
        deviation = count > 0.0 ? sqrt(fmax(squares / count - mean * mean, 0.0)) + 1e-3 : 1.0;
        for (size_t t = 0; t < f->frames; t++) {
            f->values[t * FEATURE_COUNT + c] = (float)(((double)f->values[t * FEATURE_COUNT + c] - mean) / deviation);
        }
    }
}

static int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

float features_level(const features *f, float part)
{
    float *sorted = malloc((f->frames + 1u) * sizeof *sorted), level = -100.0f;
    if (sorted && f->frames) {
        memcpy(sorted, f->level, f->frames * sizeof *sorted);
        qsort(sorted, f->frames, sizeof *sorted, by_value);
        level = sorted[(size_t)(part * (float)(f->frames - 1u))];
    }
    free(sorted);
    return level;
}

void features_free(features *f)
{
    free(f->values);
    free(f->level);
    memset(f, 0, sizeof *f);
}
