#include "spoil.h"

#include <math.h>
#include <string.h>

#include "life/face/ear_internal.h"

enum { ROOM = 2 * VOICE_SAMPLES_MAX, CROWD = 120 * EAR_RATE, ECHOES = 50, ZEROS = 12 };

#define PI 3.14159265358979323846

static float sound[ROOM], wet[ROOM], crowd[CROWD];
static int16_t heard[ROOM];
static int joined; /* where the next of the crowd goes */

static double decibels(double low, double high)
{
    return pow(10, voices_random(low, high) / 20);
}

/* A windowed sinc where samples are left out, straight lines where they are added. */
static double sample_at(const utterance *said, double at, double step)
{
    double sum = 0, all = 0;
    const int k = (int)at;
    if (step <= 1) return said->samples[k] + (at - k) * (said->samples[k + 1] - said->samples[k]);
    for (int i = (int)ceil(at - ZEROS * step); i <= at + ZEROS * step; i++) {
        const double x = (i - at) / step;
        const double weight = (fabs(x) < 1e-9 ? 1 : sin(PI * x) / (PI * x)) * (.5 + .5 * cos(PI * x / (ZEROS + .5)));
        if (i < 0 || i >= said->count) continue;
        sum += weight * said->samples[i];
        all += weight;
    }
    return sum / all;
}

static int resample(const utterance *said, double warp)
{
    const double step = said->rate * warp / EAR_RATE;
    const int count = (int)((said->count - 2) / step);
    for (int i = 0; i < count; i++) sound[i] = (float)sample_at(said, i * step, step);
    return count;
}

static void tilt(int count)
{
    const double share = voices_random(-.35, .35);
    float before = 0;
    for (int i = 0; i < count; i++) {
        const float now = sound[i];
        sound[i] += (float)(share * before);
        before = now;
    }
}

/* A few dozen echoes that fade: by 60 dB in 0.08 to 0.7 s. */
static void reverberate(int count)
{
    const double fade = voices_random(.08, .7), level = decibels(-14, 2);
    double energy = 0, gain[ECHOES];
    int delay[ECHOES];
    for (int k = 0; k < ECHOES; k++) {
        delay[k] = (int)(voices_random(.003, fade) * EAR_RATE);
        gain[k] = pow(10, -3.0 * delay[k] / EAR_RATE / fade) * voices_random(-1, 1);
        energy += gain[k] * gain[k];
    }
    memset(wet, 0, sizeof *wet * (size_t)count);
    for (int k = 0; k < ECHOES; k++) {
        const float g = (float)(gain[k] * level / sqrt(energy));
        for (int i = delay[k]; i < count; i++) wet[i] += g * sound[i - delay[k]];
    }
    for (int i = 0; i < count; i++) sound[i] += wet[i];
}

/* One tone is stronger or weaker, by up to 7 dB, as rooms and loudspeakers have it. */
static void resonate(int count)
{
    const double hz = 200 * pow(25, voices_random(0, 1)), gain = decibels(-7, 7) - 1, q = voices_random(.7, 3);
    const double w = 2 * PI * hz / EAR_RATE, alpha = sin(w) / 2 / q;
    double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
    for (int i = 0; i < count; i++) {
        const double x = sound[i], y = (alpha * (x - x2) + 2 * cos(w) * y1 - (1 - alpha) * y2) / (1 + alpha);
        x2 = x1, x1 = x, y2 = y1, y1 = y;
        sound[i] += (float)(gain * y);
    }
}

static void cut_low(int count)
{
    const double r = exp(-2 * PI * voices_random(60, 300) / EAR_RATE);
    double out = 0, before = 0;
    for (int i = 0; i < count; i++) {
        const double x = sound[i];
        out = r * (out + x - before);
        before = x;
        sound[i] = (float)out;
    }
}

static void cut_high(int count)
{
    const double r = exp(-2 * PI * voices_random(2500, 5000) / EAR_RATE);
    double first = 0, second = 0;
    for (int i = 0; i < count; i++) {
        first += (1 - r) * (sound[i] - first);
        second += (1 - r) * (first - second);
        sound[i] = (float)second;
    }
}

/* Other people, of what was said before; their times and levels are drawn. */
static void add_crowd(int count)
{
    for (int k = (int)voices_random(2, 6); k > 0; k--) {
        const double gain = voices_random(.3, 1);
        int from = (int)voices_random(0, CROWD);
        for (int i = 0; i < count; i++, from = (from + 1) % CROWD) wet[i] += (float)(gain * crowd[from]);
    }
}

static void add_hum(int count)
{
    const double w = 2 * PI * (voices_random(0, 1) < .5 ? 50 : 60) / EAR_RATE;
    for (int k = 1; k <= 8; k++) {
        const double gain = voices_random(0, 1) / k;
        for (int i = 0; i < count; i++) wet[i] += (float)(gain * sin(w * k * i));
    }
}

/* Hiss of some colour; it may come and go, or have a crowd or a hum in it. */
static void make_noise(int count, int hard)
{
    const double colour = hard ? voices_random(0, .99) : 0, kind = hard ? voices_random(0, 1) : 0;
    double noise = 0, level = 1;
    memset(wet, 0, sizeof *wet * (size_t)count);
    if (kind > .65 && kind < .85) add_crowd(count);
    if (kind > .85 && kind < .92) add_hum(count);
    for (int i = 0; i < count; i++) {
        const double white = voices_random(-1, 1) + voices_random(-1, 1) + voices_random(-1, 1);
        noise = colour * noise + sqrt(1 - colour * colour) * white;
        if (kind > .92 && i % 1600 == 0) level = pow(4, voices_random(-1, 1));
        wet[i] = (float)(wet[i] + (kind > .65 && kind < .92 ? .2 : level) * noise);
    }
}

static double loudness_of(const float *samples, int count)
{
    double energy = 0;
    for (int i = 0; i < count; i++) energy += (double)samples[i] * samples[i] / count;
    return sqrt(energy);
}

static void add_noise(int count, int hard)
{
    const double gain = hard ? decibels(-30, 6) : decibels(-24, 0),
                 ratio = hard ? decibels(-40, 0) : decibels(-70, -40);
    double level;
    make_noise(count, hard);
    level = loudness_of(sound, count) * ratio / (loudness_of(wet, count) + 1e-9);
    for (int i = 0; i < count; i++) {
        sound[i] += (float)(level * wet[i]);
        heard[i] = (int16_t)fmax(-32768, fmin(32767, rint(gain * sound[i] + voices_random(-.5, .5))));
    }
}

static void join_crowd(int count)
{
    const double gain = 1 / (loudness_of(sound, count) + 1);
    for (int i = 0; i < count; i++, joined = (joined + 1) % CROWD) crowd[joined] = (float)(gain * sound[i]);
}

const int16_t *spoil(const utterance *said, double warp, int hard, int *count)
{
    *count = resample(said, warp);
    if (!hard) join_crowd(*count);
    if (hard) {
        tilt(*count);
        if (voices_random(0, 1) < .5) reverberate(*count);
        if (voices_random(0, 1) < .7) resonate(*count);
        if (voices_random(0, 1) < .4) cut_low(*count);
        if (voices_random(0, 1) < .3) cut_high(*count);
    }
    add_noise(*count, hard);
    return heard;
}
