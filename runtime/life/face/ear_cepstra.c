/* ear_cepstra.c: mel-frequency cepstral coefficients of a window of sound, in integers. */
#include "life/face/ear_internal.h"

static int32_t times(int32_t value, int16_t factor)
{
    return (int32_t)(((int64_t)value * factor) >> 15);
}

static int16_t sine_of(const ear_tables *t, uint32_t step)
{
    const uint32_t quarter = EAR_FFT / 4, at = step & (EAR_FFT / 2 - 1u);
    const int16_t value = t->sine[at <= quarter ? at : 2 * quarter - at];
    return step & (EAR_FFT / 2) ? (int16_t)-value : value;
}

static int16_t cosine_of(const ear_tables *t, uint32_t step)
{
    return sine_of(t, step + EAR_FFT / 4);
}

/* Pre-emphasis and window, as pairs in the order that the transform needs, scaled up to 20 bits.
 * returns  the number of bits of scaling */
static int prepare(const ear_tables *t, const int16_t *samples, int16_t before, int32_t (*z)[2])
{
    int32_t largest = 1;
    int shift = 0;
    for (uint32_t i = 0; i < EAR_FFT; i++) {
        uint32_t at = 0;
        for (uint32_t bit = 0; bit < 8; bit++) at |= ((i >> 1) >> bit & 1u) << (7 - bit);
        int32_t value = 0;
        if (i < EAR_WINDOW) {
            const int32_t raised = ((int32_t)samples[i] * 128 - times((int32_t)before * 128, 31785)) / 2;
            value = times(raised, t->window[i < EAR_WINDOW / 2 ? i : EAR_WINDOW - 1 - i]);
            before = samples[i];
        }
        z[at][i & 1u] = value;
        largest |= value < 0 ? -value : value;
    }
    while (largest < 1 << 19) {
        largest *= 2;
        shift++;
    }
    for (uint32_t i = 0; shift && i < EAR_FFT / 2; i++) {
        z[i][0] *= 1 << shift;
        z[i][1] *= 1 << shift;
    }
    return shift;
}

static void transform(const ear_tables *t, int32_t (*z)[2])
{
    for (uint32_t half = 1; half < EAR_FFT / 2; half *= 2) {
        for (uint32_t k = 0; k < half; k++) {
            const int16_t c = cosine_of(t, k * (EAR_FFT / 2 / half));
            const int16_t s = sine_of(t, k * (EAR_FFT / 2 / half));
            for (uint32_t i = k; i < EAR_FFT / 2; i += 2 * half) {
                int32_t *a = z[i], *b = z[i + half];
                const int32_t re = times(b[0], c) + times(b[1], s), im = times(b[1], c) - times(b[0], s);
                b[0] = a[0] - re;
                b[1] = a[1] - im;
                a[0] += re;
                a[1] += im;
            }
        }
    }
}

/* The power of a bin of the real transform, from the complex one of half its length. */
static uint64_t power_at(const ear_tables *t, const int32_t (*z)[2], uint32_t k)
{
    const int32_t *a = z[k & (EAR_FFT / 2 - 1u)], *b = z[(EAR_FFT / 2 - k) & (EAR_FFT / 2 - 1u)];
    const int32_t even_re = (a[0] + b[0]) / 2, even_im = (a[1] - b[1]) / 2;
    const int32_t odd_re = (a[1] + b[1]) / 2, odd_im = (b[0] - a[0]) / 2;
    const int16_t c = cosine_of(t, k), s = sine_of(t, k);
    const int64_t re = even_re + times(odd_re, c) + times(odd_im, s);
    const int64_t im = even_im + times(odd_im, c) - times(odd_re, s);
    return (uint64_t)(re * re + im * im) >> 12;
}

/* log2 in 1/256, within 1/128. */
int32_t noh_ear_log2(uint64_t value)
{
    int32_t whole = 0;
    int64_t part;
    while (value >> whole > 1) whole++;
    part = (int64_t)(whole > 15 ? value >> (whole - 15) : value << (15 - whole)) - 32768;
    return whole * 256 + (int32_t)((part + (part * (32768 - part) >> 15) * 11256 / 32768) >> 7);
}

/* Loudness of the sound minus its mean, without pre-emphasis, which would make noise seem loud. */
static int32_t loudness_of(const int16_t *samples)
{
    int64_t sum = 0, squares = 0;
    for (uint32_t i = 0; i < EAR_WINDOW; i++) {
        sum += samples[i];
        squares += (int64_t)samples[i] * samples[i];
    }
    return noh_ear_log2((uint64_t)(squares - sum * sum / EAR_WINDOW) + 1u);
}

/* 64 units are one bit of a sample; squares of them, minus the 12 bits of power_at. */
enum { UNIT_BITS = 2 * 6 - 12, FILTER_BITS = 8, FLOOR = 107 };

static void log_mels(const ear_tables *t, const int16_t *samples, int16_t before, int32_t *logs)
{
    int32_t z[EAR_FFT / 2][2];
    uint64_t mel[EAR_MELS + 1] = { 0 };
    const int shift = prepare(t, samples, before, z);
    transform(t, z);
    for (uint32_t k = 1; k <= EAR_FFT / 2; k++) {
        const uint64_t power = power_at(t, (const int32_t(*)[2])z, k) >> 6;
        if (t->mel[k] == 255) continue;
        /* filter 0 is the rising edge below the first one */
        if (t->mel[k] > 0) mel[t->mel[k] - 1] += power * (256u - t->share[k]);
        mel[t->mel[k]] += power * t->share[k];
    }
    for (uint32_t m = 0; m < EAR_MELS; m++) {
        const uint64_t floor = ((uint64_t)FLOOR << FILTER_BITS) << (2 * shift);
        logs[m] = noh_ear_log2(mel[m] + (floor >> 6)) - 2 * 256 * shift;
    }
}

/* A cosine of c (m + 1/2) / 24 half turns, from the table of 512 steps per turn: within 1/160. */
static int16_t basis(const ear_tables *t, uint32_t c, uint32_t m)
{
    return cosine_of(t, (c * (2 * m + 1) * EAR_FFT + 2 * EAR_MELS) / (4 * EAR_MELS));
}

void noh_ear_cepstra(const ear_tables *t, const int16_t *samples, int16_t before, int32_t *cepstra, int32_t *loudness)
{
    int32_t logs[EAR_MELS];
    log_mels(t, samples, before, logs);
    *loudness = loudness_of(samples);
    for (uint32_t c = 0; c < EAR_CEPSTRA; c++) {
        int64_t sum = 0;
        for (uint32_t m = 0; m < EAR_MELS; m++) sum += (int64_t)basis(t, c, m) * logs[m];
        /* by sqrt(1 / 24) and sqrt(2 / 24): makes the transform orthonormal */
        cepstra[c] = (int32_t)(sum / 32768 * (c ? 4730 : 3344) / 16384);
    }
}
