#include "spoil.h"

#include <math.h>
#include <string.h>

#include "life/face/ear_internal.h"

enum { ROOM = 2 * VOICE_SAMPLES_MAX, ECHOES = 50, ZEROS = 12 };

#define PI 3.14159265358979323846

static float sound[ROOM], wet[ROOM];
static int16_t heard[ROOM];

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

/* A few dozen echoes that fade: by 60 dB in 0.1 to 0.5 s. */
static void reverberate(int count)
{
    const double fade = voices_random(.1, .5), level = decibels(-16, -4);
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

static void add_noise(int count, int hard)
{
    const double gain = decibels(-24, 0), colour = hard ? voices_random(0, .95) : 0;
    double energy = 0, level, noise = 0;
    for (int i = 0; i < count; i++) energy += (double)sound[i] * sound[i] / count;
    level = sqrt(energy) * gain * (hard ? decibels(-45, -10) : decibels(-70, -40)) + .3;
    for (int i = 0; i < count; i++) {
        const double white = voices_random(-1, 1) + voices_random(-1, 1) + voices_random(-1, 1);
        noise = colour * noise + sqrt(1 - colour * colour) * white;
        heard[i] = (int16_t)fmax(-32768, fmin(32767, rint(gain * sound[i] + level * noise)));
    }
}

const int16_t *spoil(const utterance *said, double warp, int hard, int *count)
{
    *count = resample(said, warp);
    if (hard) {
        tilt(*count);
        if (voices_random(0, 1) < .5) reverberate(*count);
        if (voices_random(0, 1) < .7) resonate(*count);
        if (voices_random(0, 1) < .4) cut_low(*count);
        if (voices_random(0, 1) < .2) cut_high(*count);
    }
    add_noise(*count, hard);
    return heard;
}
