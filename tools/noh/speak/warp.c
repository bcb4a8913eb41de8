#include "warp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

/* A frame of distance is about 5: the root of the number of features. */
#define STAY 0.8f   /* for a second frame in one state */
#define LEAP_1 1.0f /* over one state */
#define LEAP_2 2.5f /* over two: no phone passes at more than thrice its pace */
#define ENTER 20.0f /* for a pause: one shorter than some frames is a stop's closure */
#define LEAPS 3
#define REACH 6 /* states back that a step can come from, optional pauses among them */
#define FAR 1e30f
#define CELLS_MAX 8e6  /* of a warp without a band */
#define BAND_MIN 300u  /* states on each side of the coarse path */
#define BAND_STEPS 20u /* the same, in coarse steps */

float warp_distance(const float *a, const float *b)
{
    float sum = 0.0f;
    for (uint32_t c = 0; c < FEATURE_COUNT; c++) sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sqrtf(sum);
}

/* One warp: the possible states of each frame, and their predecessors. */
typedef struct grid {
    const reference_state *states;
    const float *means, *values, *pause_cost;
    size_t state_count, frames, width;
    const uint32_t *low; /* [frames] the first state of the band; rising */
    float *now, *next;   /* [width + REACH] costs of the band's states, at [REACH] the first */
    uint8_t *back;       /* [frames * width] how many states back it came from */
} grid;

static float cost_of(const grid *g, size_t state, size_t frame)
{
    return g->states[state].pause ? g->pause_cost[frame]
                                  : warp_distance(g->means + state * FEATURE_COUNT, g->values + frame * FEATURE_COUNT);
}

/* The cheapest step into a state; costs[-k]: of the state k before it. A pause is entered from its neighbour alone, and
 * left out for nothing. */
static float step(const grid *g, size_t state, const float *costs, uint8_t *from)
{
    static const float leap[LEAPS] = { 0.0f, LEAP_1, LEAP_2 };
    const uint32_t pause = g->states[state].pause;
    float best = costs[0] + (pause ? 0.0f : STAY);
    int spoken = 0;
    *from = 0;
    for (int k = 1; k < REACH && (size_t)k <= state && spoken < LEAPS; k++) {
        const float cost = costs[-k] + leap[spoken] + (pause ? ENTER : 0.0f);
        if (cost < best) {
            best = cost;
            *from = (uint8_t)k;
        }
        spoken += !g->states[state - (size_t)k].pause;
        if (pause) break;
    }
    return best;
}

/* The costs of the frame before at the band's states of this frame. */
static void shift(grid *g, size_t frame)
{
    const size_t by = frame ? g->low[frame] - g->low[frame - 1u] : 0u;
    for (size_t i = 0; i < g->width + REACH; i++) {
        g->next[i] = i + by < g->width + REACH ? g->now[i + by] : FAR;
    }
}

static void advance(grid *g, size_t frame)
{
    shift(g, frame);
    for (size_t i = 0; i < REACH; i++) g->now[i] = FAR; /* below the band is no way */
    for (size_t i = 0; i < g->width; i++) {
        const size_t state = g->low[frame] + i;
        float best = FAR;
        uint8_t from = 0;
        if (state < g->state_count) {
            best = frame ? step(g, state, g->next + REACH + i, &from) : state < 2u ? 0.0f : FAR;
        }
        g->now[REACH + i] = best < FAR ? best + cost_of(g, state, frame) : FAR;
        g->back[frame * g->width + i] = from;
    }
}

static int trace(const grid *g, uint32_t *at)
{
    const size_t last = g->state_count - 1u, low = g->low[g->frames - 1u];
    size_t state = last;
    if (last < low || last >= low + g->width) return 1;
    if (last > low && g->now[REACH + last - 1u - low] < g->now[REACH + last - low]) state--;
    if (g->now[REACH + state - low] >= FAR) return 1;
    for (size_t t = g->frames; t-- > 0;) {
        at[t] = (uint32_t)state;
        state -= g->back[t * g->width + (state - g->low[t])];
    }
    return 0;
}

/* 0, or 1: no way, or -1: out of memory. */
static int solve(grid *g, uint32_t *at)
{
    int result = -1;
    g->now = malloc((g->width + REACH) * sizeof *g->now);
    g->next = malloc((g->width + REACH) * sizeof *g->next);
    g->back = malloc(g->frames * g->width);
    if (g->now && g->next && g->back) {
        for (size_t i = 0; i < g->width + REACH; i++) g->now[i] = FAR;
        for (size_t t = 0; t < g->frames; t++) advance(g, t);
        result = trace(g, at);
    }
    free(g->now);
    free(g->next);
    free(g->back);
    return result;
}

/* ---- coarse steps ---- */

typedef struct coarse {
    reference_state *states;
    float *means, *values, *pause_cost;
    uint32_t *fine; /* [state_count] the first fine state of each */
    uint32_t *at, *low;
    size_t state_count, frames;
} coarse;

static void coarse_free(coarse *c)
{
    free(c->states);
    free(c->means);
    free(c->values);
    free(c->pause_cost);
    free(c->fine);
    free(c->at);
    free(c->low);
}

static int coarse_alloc(coarse *c, size_t states, size_t frames)
{
    c->states = malloc(states * sizeof *c->states);
    c->means = malloc(states * FEATURE_COUNT * sizeof *c->means);
    c->fine = malloc(states * sizeof *c->fine);
    c->values = calloc(frames * FEATURE_COUNT, sizeof *c->values);
    c->pause_cost = calloc(frames, sizeof *c->pause_cost);
    c->at = malloc(frames * sizeof *c->at);
    c->low = calloc(frames, sizeof *c->low);
    return !c->states || !c->means || !c->fine || !c->values || !c->pause_cost || !c->at || !c->low;
}

/* Every `by`-th state of a phone, all pauses, and the mean of `by` frames. */
static void coarse_fill(coarse *c, const reference *r, const features *f, const float *pause_cost, size_t by)
{
    size_t since = 0;
    for (size_t i = 0; i < r->state_count; i++) {
        const int same = i && r->states[i].phone == r->states[i - 1u].phone &&
                         r->states[i].pause == r->states[i - 1u].pause;
        since = same ? since + 1u : 0u;
        if (since % by) continue;
        c->states[c->state_count] = r->states[i];
        c->fine[c->state_count] = (uint32_t)i;
        memcpy(c->means + c->state_count++ * FEATURE_COUNT, r->means + i * FEATURE_COUNT,
               FEATURE_COUNT * sizeof *r->means);
    }
    for (size_t t = 0; t < f->frames; t++) {
        const size_t count = t / by * by + by <= f->frames ? by : f->frames % by;
        for (uint32_t k = 0; k < FEATURE_COUNT; k++) {
            c->values[t / by * FEATURE_COUNT + k] += f->values[t * FEATURE_COUNT + k] / (float)count;
        }
        c->pause_cost[t / by] += pause_cost[t] / (float)count;
    }
    c->frames = (f->frames + by - 1u) / by;
}

/* low[frame] of a band of `width` around the coarse path. */
static void band(const coarse *c, size_t states, size_t by, size_t width, uint32_t *low, size_t frames)
{
    for (size_t t = 0; t < frames; t++) {
        const size_t at = c->fine[c->at[t / by]], most = states > width ? states - width : 0u;
        const size_t first = at > width / 2u ? at - width / 2u : 0u;
        low[t] = (uint32_t)(first < most ? first : most);
    }
}

static int told(int result)
{
    if (result < 0) return tool_fail("speak", "out of memory");
    return result ? tool_fail("speak",
                              "the recording is too short for these words: they need more than three times its length")
                  : 0;
}

static int warp_banded(grid *g, const reference *r, const features *f, size_t by, uint32_t *at, uint32_t *low)
{
    coarse c;
    int result = -1;
    memset(&c, 0, sizeof c);
    if (!coarse_alloc(&c, r->state_count, f->frames)) {
        grid rough;
        memset(&rough, 0, sizeof rough);
        coarse_fill(&c, r, f, g->pause_cost, by);
        rough.states = c.states;
        rough.means = c.means;
        rough.values = c.values;
        rough.pause_cost = c.pause_cost;
        rough.state_count = rough.width = c.state_count;
        rough.frames = c.frames;
        rough.low = c.low;
        result = solve(&rough, c.at);
        if (!result) {
            g->width = 2u * (BAND_MIN + BAND_STEPS * by);
            if (g->width > r->state_count) g->width = r->state_count;
            band(&c, r->state_count, by, g->width, low, f->frames);
            result = solve(g, at);
        }
    }
    coarse_free(&c);
    return result;
}

int warp_make(const reference *r, const features *f, const float *pause_cost, uint32_t *at)
{
    const double cells = (double)r->state_count * (double)f->frames;
    uint32_t *low = calloc(f->frames + 1u, sizeof *low);
    grid g;
    int result = -1;
    memset(&g, 0, sizeof g);
    g.states = r->states;
    g.means = r->means;
    g.values = f->values;
    g.pause_cost = pause_cost;
    g.state_count = g.width = r->state_count;
    g.frames = f->frames;
    g.low = low;
    if (low && cells <= CELLS_MAX) result = solve(&g, at);
    if (low && cells > CELLS_MAX) result = warp_banded(&g, r, f, (size_t)ceil(sqrt(cells / CELLS_MAX)), at, low);
    free(low);
    return told(result);
}
