/* ear_net.c: a network with two hidden layers, in integers, and its inputs. The second layer reads the first at several
 * times, so that the first is computed once for each frame (Waibel et al., "Phoneme Recognition Using Time-Delay Neural
 * Networks", 1989). */
#include "life/face/ear_internal.h"
#include "noh/face.h"

enum { ONE = 32768, OCTAVE = 256, LEVEL_MOST = 12 * OCTAVE };

void noh_ear_voice_init(const ear_tables *t, ear_voice *v)
{
    for (uint32_t c = 0; c < EAR_CEPSTRA; c++) v->mean[c] = t->mean[c] * 256;
    v->peak = -1000000;
    v->count = 0;
    v->low = 26 * OCTAVE; /* -38 dB and -24 dB of full scale */
    v->high = 31 * OCTAVE;
}

/* Speech is as loud as the recent peak minus 11.5 octaves of coefficient 0; the mean is over 2 s. */
static void take_mean(ear_voice *v, const int32_t *cepstra)
{
    v->peak = v->peak - 7 > cepstra[0] ? v->peak - 7 : cepstra[0];
    if (cepstra[0] <= v->peak - 2944) return;
    v->count += v->count < 180;
    for (uint32_t c = 0; c < EAR_CEPSTRA; c++) v->mean[c] += (cepstra[c] * 256 - v->mean[c]) / (v->count + 20);
}

/* Move a percentile by steps up and down, in proportion to its shares of frames below and above. */
static void take_loudness(ear_voice *v, int32_t loudness)
{
    v->low += loudness > v->low ? 3 : -57;
    v->high += loudness > v->high ? 57 : -3;
    if (v->high < v->low) v->high = v->low;
}

static int32_t limit(int32_t value, int32_t most)
{
    return value < -most ? -most : value > most ? most : value;
}

void noh_ear_measure(ear_voice *v, const int32_t *cepstra, int32_t loudness, int32_t *features)
{
    take_mean(v, cepstra);
    take_loudness(v, loudness);
    for (uint32_t c = 0; c < EAR_CEPSTRA; c++) features[c] = cepstra[c] - v->mean[c] / 256;
    features[EAR_CEPSTRA] = limit(loudness - v->low, LEVEL_MOST);
    features[EAR_CEPSTRA + 1] = limit(loudness - v->high, LEVEL_MOST);
}

void noh_ear_scale(const ear_tables *t, const int32_t *features, int8_t *scaled)
{
    for (uint32_t i = 0; i < EAR_FEATURES; i++) {
        scaled[i] = (int8_t)limit((int32_t)((int64_t)features[i] * t->scale[i] / 4096), 127);
    }
}

static int32_t dot(const int8_t *a, const int8_t *b, uint32_t count)
{
    int32_t sum = 0;
    for (uint32_t i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

void noh_ear_see(const ear_tables *t, const int8_t (*near)[EAR_FEATURES], int8_t *first)
{
    for (uint32_t h = 0; h < EAR_FIRST; h++) {
        const int64_t value = t->first_bias[h] + dot(t->first[h], near[0], EAR_INPUTS);
        first[h] = (int8_t)(value < 0 ? 0 : limit((int32_t)(value * t->first_scale[h] >> 16), 127));
    }
}

uint32_t noh_ear_tap(uint32_t n)
{
    static const uint8_t taps[EAR_TAPS] = { 0, 3, 6, 9 };
    return taps[n];
}

/* 2^-x, x in 1/32768: 1/32768, within 1/300 of it. */
static int32_t power_of_half(int64_t x)
{
    const int64_t whole = x >> 15, f = x & 32767;
    /* 2^-f is a line minus a parabola over one octave */
    const int64_t line = ONE - f / 2, bend = (f * (ONE - f) >> 15) * 5636 / ONE;
    return whole > 15 ? 0 : (int32_t)((line - bend) >> whole);
}

void noh_ear_read(const ear_tables *t, const int8_t (*past)[EAR_FIRST], int32_t *weights)
{
    int64_t second[EAR_SECOND], score[NOH_VISEME_COUNT], best = INT64_MIN, sum = 0;
    for (uint32_t h = 0; h < EAR_SECOND; h++) {
        int32_t value = t->second_bias[h];
        for (uint32_t n = 0; n < EAR_TAPS; n++) {
            value += dot(t->second[h] + n * EAR_FIRST, past[noh_ear_tap(n)], EAR_FIRST);
        }
        second[h] = value < 0 ? 0 : value;
    }
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        score[v] = t->output_bias[v];
        for (uint32_t h = 0; h < EAR_SECOND; h++) score[v] += t->output[v][h] * second[h];
        best = score[v] > best ? score[v] : best;
    }
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) {
        weights[v] = power_of_half((best - score[v]) * ONE / t->unit);
        sum += weights[v];
    }
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) weights[v] = (int32_t)(weights[v] * (int64_t)(ONE - 1) / sum);
}
