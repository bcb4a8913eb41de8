#include "learn.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "voices.h"

enum {
    N = EAR_INPUTS,
    A = EAR_FIRST,
    M = EAR_TAPS * EAR_FIRST,
    B = EAR_SECOND,
    V = NOH_VISEME_COUNT,
    RUN = 32,                /* frames in a row: the first layer is computed once for each frame */
    ROWS = RUN + EAR_BEFORE, /* what the second layer reads of the first for them */
    RUNS = 32                /* in a step */
};
enum {
    FIRST = 0, /* weights by input, then by output */
    FIRST_BIAS = FIRST + N * A,
    SECOND = FIRST_BIAS + A,
    SECOND_BIAS = SECOND + M * B,
    OUTPUT = SECOND_BIAS + B,
    OUTPUT_BIAS = OUTPUT + B * V,
    COUNT = OUTPUT_BIAS + V
};

/* Inputs are features; 32 is a standard deviation. The first layer's outputs end at 4, as a byte's 127. */
#define INPUT_UNIT (1.0f / 32)
#define FIRST_MAX 4.0f

/* Networks of other seeds differ by up to 0.02 of lips read (runtime/life/LOG.md). */
enum { SEED = 155554 };

#define LEAN 0.5 /* octaves towards p, b and m: lips that fail to close show more than lips that close in vain */

static float weight[COUNT], gradient[COUNT], mean[COUNT], square[COUNT];
static float x[(ROWS + EAR_NEAR) * EAR_FEATURES], first[ROWS][A], second[RUN][B], p[RUN][V];
static float first_back[ROWS][A];

static void begin_layer(int at, int inputs, int outputs)
{
    for (int i = 0; i < inputs * outputs; i++) {
        const double around_0 = voices_random(-1, 1) + voices_random(-1, 1) + voices_random(-1, 1);
        weight[at + i] = (float)(around_0 * sqrt(1.0 / inputs));
    }
}

/* ---- one layer ---- */

static inline void multiply(const float *in, int inputs, int at, int outputs, float *out)
{
    for (int i = 0; i < inputs; i++) {
        for (int o = 0; o < outputs; o++) out[o] += in[i] * weight[at + i * outputs + o];
    }
}

static inline void back(const float *in, int inputs, int at, int outputs, const float *slope, float *in_slope)
{
    for (int i = 0; i < inputs; i++) {
        float sum = 0;
        for (int o = 0; o < outputs; o++) gradient[at + i * outputs + o] += in[i] * slope[o];
        if (!in_slope) continue;
        for (int o = 0; o < outputs; o++) sum += weight[at + i * outputs + o] * slope[o];
        in_slope[i] += sum;
    }
}

static void add(int at, const float *slope, int count)
{
    for (int i = 0; i < count; i++) gradient[at + i] += slope[i];
}

/* ---- a run of frames ---- */

static void take_outputs(float *out)
{
    float most = -1e30f, sum = 0;
    for (int v = 0; v < V; v++) most = fmaxf(most, out[v]);
    for (int v = 0; v < V; v++) sum += out[v] = expf(out[v] - most);
    for (int v = 0; v < V; v++) out[v] /= sum;
}

static void forward(const lesson *l, int frame)
{
    const int8_t *f = l->features[frame - EAR_BEFORE - EAR_AFTER];
    for (int i = 0; i < (ROWS + EAR_NEAR - 1) * EAR_FEATURES; i++) x[i] = f[i] * INPUT_UNIT;
    for (int r = 0; r < ROWS; r++) {
        memcpy(first[r], weight + FIRST_BIAS, sizeof first[r]);
        multiply(x + r * EAR_FEATURES, N, FIRST, A, first[r]);
        for (int h = 0; h < A; h++) first[r][h] = fminf(FIRST_MAX, fmaxf(0, first[r][h]));
    }
    for (int t = 0; t < RUN; t++) {
        memcpy(second[t], weight + SECOND_BIAS, sizeof second[t]);
        memcpy(p[t], weight + OUTPUT_BIAS, sizeof p[t]);
        for (int n = 0; n < EAR_TAPS; n++) {
            multiply(first[t + (int)noh_ear_tap((uint32_t)n)], A, SECOND + n * A * B, B, second[t]);
        }
        for (int h = 0; h < B; h++) second[t][h] = fmaxf(0, second[t][h]);
        multiply(second[t], B, OUTPUT, V, p[t]);
        take_outputs(p[t]);
    }
}

static void backward_frame(int t, int shape)
{
    float slope[B] = { 0 };
    p[t][shape] -= 1;
    add(OUTPUT_BIAS, p[t], V);
    back(second[t], B, OUTPUT, V, p[t], slope);
    for (int h = 0; h < B; h++) slope[h] = second[t][h] > 0 ? slope[h] : 0;
    add(SECOND_BIAS, slope, B);
    for (int n = 0; n < EAR_TAPS; n++) {
        const int row = t + (int)noh_ear_tap((uint32_t)n);
        back(first[row], A, SECOND + n * A * B, B, slope, first_back[row]);
    }
}

/* returns  the loss of its frames, whose number is added to *frames */
static double learn_run(const lesson *l, int frame, int *frames)
{
    double loss = 0;
    forward(l, frame);
    memset(first_back, 0, sizeof first_back);
    for (int t = 0; t < RUN; t++) {
        if (l->shapes[frame + t] < 0) continue;
        ++*frames;
        loss -= log((double)p[t][(int)l->shapes[frame + t]] + 1e-9);
        backward_frame(t, l->shapes[frame + t]);
    }
    for (int r = 0; r < ROWS; r++) {
        for (int h = 0; h < A; h++) {
            if (first[r][h] <= 0 || first[r][h] >= FIRST_MAX) first_back[r][h] = 0;
        }
        add(FIRST_BIAS, first_back[r], A);
        back(x + r * EAR_FEATURES, N, FIRST, A, first_back[r], NULL);
    }
    return loss;
}

static void step(int at, int all, int frames)
{
    const double rate = 2e-3 * .5 * (1 + cos(3.14159265358979 * at / all));
    const double fade1 = 1 - pow(.9, at), fade2 = 1 - pow(.999, at);
    for (int i = 0; i < COUNT; i++) {
        const float g = gradient[i] / (float)(frames + 1);
        mean[i] = .9f * mean[i] + .1f * g;
        square[i] = .999f * square[i] + .001f * g * g;
        weight[i] -= (float)(rate * (mean[i] / fade1 / (sqrt(square[i] / fade2) + 1e-8) + 1e-4 * weight[i]));
    }
    memset(gradient, 0, sizeof gradient);
}

/* Runs that cover the utterances, from another frame on in each round, in another order.
 * returns  their number */
static int choose_runs(const lesson *l, int *runs)
{
    int count = 0;
    for (int u = 0; u < l->count; u++) {
        const int end = l->spans[u][1] - EAR_AFTER - RUN;
        int frame = l->spans[u][0] + EAR_BEFORE + EAR_AFTER + (int)voices_random(0, RUN);
        for (; frame <= end; frame += RUN) runs[count++] = frame;
    }
    for (int i = count - 1; i > 0; i--) {
        const int k = (int)voices_random(0, i + 1), kept = runs[i];
        runs[i] = runs[k];
        runs[k] = kept;
    }
    return count;
}

static void descend(const lesson *l, int rounds)
{
    int *runs, frames_all = 0, at = 0;
    for (int u = 0; u < l->count; u++) frames_all += l->spans[u][1] - l->spans[u][0];
    runs = malloc((size_t)(frames_all / RUN + 1) * sizeof *runs);
    if (!runs) {
        voices_die("out of memory", "learn");
        return;
    }
    for (int round = 0; round < rounds; round++) {
        const int count = choose_runs(l, runs), left = rounds - round;
        double loss = 0;
        int all = 0;
        for (int s = 0; s + RUNS <= count; s += RUNS) {
            int frames = 0;
            for (int k = 0; k < RUNS; k++) loss += learn_run(l, runs[s + k], &frames);
            at++;
            step(at, at + (count - s) / RUNS + (left - 1) * (count / RUNS), frames);
            all += frames;
        }
        fprintf(stderr, "round %d: %.4f\n", round + 1, loss / all);
    }
    free(runs);
}

/* ---- into bytes ---- */

static double most_of(const float *values, int count, int stride)
{
    double most = 1e-6;
    for (int i = 0; i < count; i++) most = fmax(most, (double)fabsf(values[i * stride]));
    return most;
}

/* The largest weight of a row is 127; a scale for each row takes its outputs to bytes. */
static void first_into_bytes(ear_tables *t)
{
    for (int h = 0; h < A; h++) {
        const double row = 127 / most_of(weight + FIRST + h, N, A);
        for (int i = 0; i < N; i++) t->first[h][i] = (int8_t)lrint(weight[FIRST + i * A + h] * row);
        t->first_bias[h] = (int32_t)lrint(weight[FIRST_BIAS + h] * row / (double)INPUT_UNIT);
        t->first_scale[h] = (int32_t)lrint(65536 * 127 / (double)FIRST_MAX * (double)INPUT_UNIT / row);
    }
}

/* A hidden value may have any unit: it gets the one in which the row's largest weight is 127. All outputs have one unit,
 * the largest in which their weights fit. */
static void into_bytes(ear_tables *t)
{
    const double first_unit = 127 / (double)FIRST_MAX;
    double unit = 1e30, row[B];
    first_into_bytes(t);
    for (int h = 0; h < B; h++) {
        row[h] = 127 / most_of(weight + SECOND + h, M, B);
        unit = fmin(unit, 127 / (most_of(weight + OUTPUT + h * V, V, 1) / row[h]));
    }
    for (int h = 0; h < B; h++) {
        for (int i = 0; i < M; i++) t->second[h][i] = (int8_t)lrint(weight[SECOND + i * B + h] * row[h]);
        t->second_bias[h] = (int32_t)lrint(weight[SECOND_BIAS + h] * row[h] * first_unit);
        for (int v = 0; v < V; v++) t->output[v][h] = (int8_t)lrint(weight[OUTPUT + h * V + v] / row[h] * unit);
    }
    unit *= first_unit;
    for (int v = 0; v < V; v++) t->output_bias[v] = (int32_t)lrint(weight[OUTPUT_BIAS + v] * unit);
    t->output_bias[NOH_VISEME_PP] += (int32_t)lrint(LEAN * unit * log(2));
    t->unit = (int32_t)lrint(unit * log(2));
}

void learn(const lesson *l, int rounds, ear_tables *tables)
{
    voices_seed(SEED);
    begin_layer(FIRST, N, A);
    begin_layer(SECOND, M, B);
    begin_layer(OUTPUT, B, V);
    descend(l, rounds);
    into_bytes(tables);
}
