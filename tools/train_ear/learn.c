#include "learn.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "voices.h"

enum { N = EAR_INPUTS, H = EAR_HIDDEN, V = NOH_VISEME_COUNT, BATCH = 1024 };
enum {
    HIDDEN = 0,
    HIDDEN_BIAS = H * N,
    OUTPUT = HIDDEN_BIAS + H,
    OUTPUT_BIAS = OUTPUT + V * H,
    COUNT = OUTPUT_BIAS + V
};

/* Inputs are features, of which 32 are a standard deviation. */
#define INPUT_UNIT (1.0f / 32)

static float weight[COUNT], gradient[COUNT], first[COUNT], second[COUNT];

static void begin(void)
{
    for (int i = 0; i < COUNT; i++) {
        const int inputs = i < HIDDEN_BIAS ? N : H;
        const int bias = (i >= HIDDEN_BIAS && i < OUTPUT) || i >= OUTPUT_BIAS;
        const double around_0 = voices_random(-1, 1) + voices_random(-1, 1) + voices_random(-1, 1);
        weight[i] = bias ? 0.0f : (float)(around_0 * sqrt(1.0 / inputs));
    }
}

static void gather(const lesson *l, int frame, float *x)
{
    for (int n = 0; n < EAR_TAPS; n++) {
        const int8_t *f = l->features[frame - EAR_BEFORE + (int)noh_ear_tap((uint32_t)n)];
        for (int i = 0; i < EAR_FEATURES; i++) x[n * EAR_FEATURES + i] = f[i] * INPUT_UNIT;
    }
}

static float dot(const float *a, const float *b, int count)
{
    float sum[8] = { 0 };
    int i = 0;
    for (; i + 8 <= count; i += 8) {
        for (int k = 0; k < 8; k++) sum[k] += a[i + k] * b[i + k];
    }
    for (; i < count; i++) sum[0] += a[i] * b[i];
    return sum[0] + sum[1] + sum[2] + sum[3] + sum[4] + sum[5] + sum[6] + sum[7];
}

static void add(float *to, float share, const float *from, int count)
{
    for (int i = 0; i < count; i++) to[i] += share * from[i];
}

/* The hidden layer, and the probabilities of shapes. */
static void forward(const float *x, float *hidden, float *p)
{
    float most = -1e30f, sum = 0;
    for (int h = 0; h < H; h++) hidden[h] = fmaxf(0, weight[HIDDEN_BIAS + h] + dot(weight + HIDDEN + h * N, x, N));
    for (int v = 0; v < V; v++) {
        p[v] = weight[OUTPUT_BIAS + v] + dot(weight + OUTPUT + v * H, hidden, H);
        most = fmaxf(most, p[v]);
    }
    for (int v = 0; v < V; v++) sum += p[v] = expf(p[v] - most);
    for (int v = 0; v < V; v++) p[v] /= sum;
}

static void backward(const float *x, const float *hidden, float *p, int shape)
{
    float back[H] = { 0 };
    p[shape] -= 1;
    for (int v = 0; v < V; v++) {
        gradient[OUTPUT_BIAS + v] += p[v];
        add(gradient + OUTPUT + v * H, p[v], hidden, H);
        add(back, p[v], weight + OUTPUT + v * H, H);
    }
    for (int h = 0; h < H; h++) {
        if (hidden[h] <= 0) continue;
        gradient[HIDDEN_BIAS + h] += back[h];
        add(gradient + HIDDEN + h * N, back[h], x, N);
    }
}

static void step(int at, int all)
{
    const double rate = 2e-3 * .5 * (1 + cos(3.14159265358979 * at / all));
    const double fade1 = 1 - pow(.9, at), fade2 = 1 - pow(.999, at);
    for (int i = 0; i < COUNT; i++) {
        const float g = gradient[i] / BATCH;
        first[i] = .9f * first[i] + .1f * g;
        second[i] = .999f * second[i] + .001f * g * g;
        weight[i] -= (float)(rate * (first[i] / fade1 / (sqrt(second[i] / fade2) + 1e-8) + 1e-4 * weight[i]));
    }
    memset(gradient, 0, sizeof gradient);
}

static void shuffle(int *order, int count)
{
    for (int i = count - 1; i > 0; i--) {
        const int k = (int)voices_random(0, i + 1), kept = order[i];
        order[i] = order[k];
        order[k] = kept;
    }
}

static void descend(const lesson *l, int rounds)
{
    const int steps = l->count / BATCH;
    int *order = malloc((size_t)l->count * sizeof *order);
    if (!order) {
        voices_die("out of memory", "learn");
        return;
    }
    memcpy(order, l->middles, (size_t)l->count * sizeof *order);
    for (int round = 0, at = 0; round < rounds; round++) {
        double loss = 0;
        shuffle(order, l->count);
        for (int s = 0; s < steps; s++) {
            for (int b = 0; b < BATCH; b++) {
                const int frame = order[s * BATCH + b];
                float x[N], hidden[H], p[V];
                gather(l, frame, x);
                forward(x, hidden, p);
                loss -= log(p[(int)l->shapes[frame]] + 1e-9);
                backward(x, hidden, p, l->shapes[frame]);
            }
            step(++at, rounds * steps);
        }
        fprintf(stderr, "round %d: %.4f\n", round + 1, loss / steps / BATCH);
    }
    free(order);
}

static double most_of(const float *values, int count, int stride)
{
    double most = 1e-6;
    for (int i = 0; i < count; i++) most = fmax(most, (double)fabsf(values[i * stride]));
    return most;
}

/* A hidden value may have any unit: that of a row in which the largest weight is 127. One unit for all outputs: the
 * largest in which every output's weights fit. */
static void into_bytes(ear_tables *t)
{
    double unit = 1e30, row[H];
    for (int h = 0; h < H; h++) {
        row[h] = 127 / most_of(weight + HIDDEN + h * N, N, 1);
        unit = fmin(unit, 127 / (most_of(weight + OUTPUT + h, V, H) / row[h]));
    }
    for (int h = 0; h < H; h++) {
        for (int i = 0; i < N; i++) t->hidden[h][i] = (int8_t)lrint(weight[HIDDEN + h * N + i] * row[h]);
        t->hidden_bias[h] = (int32_t)lrint(weight[HIDDEN_BIAS + h] * row[h] / (double)INPUT_UNIT);
        for (int v = 0; v < V; v++) t->output[v][h] = (int8_t)lrint(weight[OUTPUT + v * H + h] / row[h] * unit);
    }
    unit /= (double)INPUT_UNIT;
    for (int v = 0; v < V; v++) t->output_bias[v] = (int32_t)lrint(weight[OUTPUT_BIAS + v] * unit);
    t->unit = (int32_t)lrint(unit * log(2));
}

void learn(const lesson *l, int rounds, ear_tables *tables)
{
    begin();
    descend(l, rounds);
    into_bytes(tables);
}
