#include "alignment.h"
#include "phone_shapes.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/face.h"
#include "posteriors.h"

#define LOUDEST_MIN (14 * 256) /* 1/256 octave: a recording below this everywhere, -75 dB, has no speech */
#define PAUSE_FRAMES 3u
#define PAUSE_COST (2 * POSTERIOR_OCTAVE) /* of a pause missing in the text */
#define FRAMES_MAX 8u                     /* most that a phone must last */
#define DURATION_PART 0.6                 /* of its duration in the text as it was synthesised */
#define WIDTH 1536u                       /* states around the likeliest: a third of a minute of speech */
#define FAR (INT32_MAX / 2)

/* A frame or more of a phone, or of a pause before it. */
typedef struct path_state {
    uint32_t phone;
    uint8_t shape, pause;
    uint8_t last; /* of its phone's shape: may last */
    uint8_t skip; /* the first state behind a pause: the states of the pause, which may be left out */
} path_state;

typedef struct state_list {
    path_state *items;
    size_t count;
} state_list;

/* ---- the states of a text ---- */

static uint32_t apart(uint32_t a, uint32_t b)
{
    return a > b ? a - b : b - a;
}

/* Whether a word begins with the phone: it is the nearest to the word's own sample, which may lie somewhat before. */
static int begins_word(const synthesis *s, size_t phone)
{
    const uint32_t at = s->phones[phone].sample;
    for (size_t i = 0; i < s->word_count; i++) {
        const uint32_t word = s->words[i].sample, far = apart(word, at);
        if ((!phone || apart(word, s->phones[phone - 1u].sample) > far) &&
            (phone + 1u == s->phone_count || apart(word, s->phones[phone + 1u].sample) >= far)) {
            return 1;
        }
    }
    return 0;
}

static double duration_of(const synthesis *s, size_t phone)
{
    const size_t end = phone + 1u < s->phone_count ? s->phones[phone + 1u].sample : s->sample_count;
    return (double)(end - s->phones[phone].sample) / s->sample_rate;
}

/* The fewest frames of a shape that is expected for some seconds. */
static uint32_t frames_of(noh_viseme shape, double seconds)
{
    static const uint8_t least[NOH_VISEME_COUNT] = { 3, 4, 4, 3, 3, 3, 5, 5, 3, 3, 3, 4, 3, 4, 3 };
    const uint32_t frames = (uint32_t)(DURATION_PART * POSTERIOR_RATE * seconds + 0.5);
    return frames < least[shape] ? least[shape] : frames < FRAMES_MAX ? frames : FRAMES_MAX;
}

/* How much slower the recording is than the text as it was synthesised. */
static double slowness(const synthesis *s, const posteriors *heard)
{
    double frames = 0.0, expected = 0.0;
    for (size_t t = 0; t < heard->frames; t++) {
        uint32_t best = 0;
        for (uint32_t v = 1; v < NOH_VISEME_COUNT; v++) best = heard->cost[t][v] < heard->cost[t][best] ? v : best;
        frames += best != NOH_VISEME_SIL;
    }
    for (size_t i = 0; i < s->phone_count; i++) {
        if (phone_shape(s->phones[i].name, NULL) != NOH_VISEME_SIL) expected += duration_of(s, i);
    }
    return expected > 0.0 ? frames / POSTERIOR_RATE / expected : 1.0;
}

static void add(state_list *l, size_t phone, noh_viseme shape, uint32_t frames, int pause)
{
    for (uint32_t k = 0; k < frames; k++) {
        path_state *s = &l->items[l->count++];
        memset(s, 0, sizeof *s);
        s->phone = (uint32_t)phone;
        s->shape = (uint8_t)shape;
        s->pause = (uint8_t)pause;
        s->last = k + 1u == frames;
        if (!k && !pause && l->count > PAUSE_FRAMES && s[-1].pause) s->skip = PAUSE_FRAMES;
    }
}

/* A pause may stand before every word, and at the end. */
static int make_states(const synthesis *s, double slower, state_list *out)
{
    out->items = malloc((s->phone_count + 1u) * (PAUSE_FRAMES + 2u * FRAMES_MAX) * sizeof *out->items);
    if (!out->items) return tool_fail("speak", "out of memory");
    for (size_t i = 0; i < s->phone_count; i++) {
        const double seconds = slower * duration_of(s, i);
        noh_viseme second;
        const noh_viseme first = phone_shape(s->phones[i].name, &second);
        const int after_pause = out->count && out->items[out->count - 1u].pause;
        if (!after_pause && (!out->count || first == NOH_VISEME_SIL || begins_word(s, i))) {
            add(out, i, NOH_VISEME_SIL, PAUSE_FRAMES, 1);
        }
        if (first == NOH_VISEME_SIL || first == NOH_VISEME_COUNT) continue;
        add(out, i, first, frames_of(first, second == NOH_VISEME_COUNT ? seconds : seconds / 2.0), 0);
        if (second != NOH_VISEME_COUNT) add(out, i, second, frames_of(second, seconds / 2.0), 0);
    }
    if (out->count <= PAUSE_FRAMES) {
        return tool_fail("speak", "the text contains no words to speak");
    }
    if (!out->items[out->count - 1u].pause) add(out, s->phone_count - 1u, NOH_VISEME_SIL, PAUSE_FRAMES, 1);
    return 0;
}

/* ---- the likeliest path (Viterbi, 1967) ---- */

/* A frame counts by how much likelier it makes a shape (Bourlard and Morgan, "Connectionist Speech Recognition", 1994).
 * A band of states rises with the likeliest one, so that memory grows with the recording's length alone. */
typedef struct grid {
    const state_list *states;
    const posteriors *heard;
    size_t width;
    int32_t *now, *before; /* [width] costs of paths to the band's states */
    uint32_t *low;         /* [frames] the band's first state */
    uint8_t *back;         /* [frames * width] how many states back the path came from */
} grid;

static int32_t cost_before(const grid *g, size_t frame, size_t state)
{
    const size_t low = g->low[frame - 1u];
    return state < low || state >= low + g->width ? FAR : g->before[state - low];
}

static int32_t step(const grid *g, size_t frame, size_t state, uint8_t *from)
{
    const path_state *s = &g->states->items[state];
    int32_t best = s->last ? cost_before(g, frame, state) : FAR;
    *from = 0;
    for (size_t k = 1; k <= 1u + s->skip && k <= state; k += s->skip ? s->skip : 1u) {
        const int32_t enter = s->pause && s[-1].phone != s->phone ? PAUSE_COST : 0;
        const int32_t cost = cost_before(g, frame, state - k) + enter;
        if (cost >= best) continue;
        best = cost;
        *from = (uint8_t)k;
    }
    return best;
}

/* The band's place for the next frame: around the likeliest state, never falling. */
static uint32_t band_of(const grid *g, size_t frame)
{
    const size_t most = g->states->count - g->width;
    size_t best = 0, low;
    for (size_t i = 1; i < g->width; i++) best = g->now[i] < g->now[best] ? i : best;
    low = g->low[frame] + best;
    low = low < g->width / 2u ? 0u : low - g->width / 2u;
    if (low < g->low[frame]) low = g->low[frame];
    return (uint32_t)(low < most ? low : most);
}

static void advance(grid *g, size_t frame)
{
    int32_t *kept = g->before, least = FAR;
    g->before = g->now;
    g->now = kept;
    for (size_t i = 0; i < g->width; i++) {
        const size_t state = g->low[frame] + i;
        uint8_t *from = &g->back[frame * g->width + i];
        int32_t cost = state == 0u || state == PAUSE_FRAMES ? 0 : FAR;
        *from = 0;
        if (frame) cost = step(g, frame, state, from);
        const uint32_t shape = g->states->items[state].shape;
        g->now[i] = cost >= FAR ? FAR : cost + g->heard->cost[frame][shape] - g->heard->prior[shape];
        least = g->now[i] < least ? g->now[i] : least;
    }
    for (size_t i = 0; i < g->width; i++) g->now[i] -= g->now[i] < FAR ? least : 0;
    if (frame + 1u < g->heard->frames) g->low[frame + 1u] = band_of(g, frame);
}

/* returns  1: no path leads to the end */
static int trace(const grid *g, uint32_t *at)
{
    const size_t frames = g->heard->frames, count = g->states->count, low = g->low[frames - 1u];
    size_t state = count - 1u;
    if (low + g->width < count) return 1;
    if (g->now[state - PAUSE_FRAMES - low] <= g->now[state - low]) state -= PAUSE_FRAMES;
    if (g->now[state - low] >= FAR) return 1;
    for (size_t t = frames; t-- > 0;) {
        at[t] = (uint32_t)state;
        state -= g->back[t * g->width + (state - g->low[t])];
    }
    return 0;
}

/* at[frame]: the state of each frame. */
static int find_path(const state_list *states, const posteriors *heard, uint32_t *at)
{
    grid g;
    int status = -1;
    memset(&g, 0, sizeof g);
    g.states = states;
    g.heard = heard;
    g.width = states->count < WIDTH ? states->count : WIDTH;
    g.now = malloc(g.width * sizeof *g.now);
    g.before = malloc(g.width * sizeof *g.before);
    g.low = calloc(heard->frames + 1u, sizeof *g.low);
    g.back = malloc(heard->frames * g.width + 1u);
    if (g.now && g.before && g.low && g.back) {
        for (size_t t = 0; t < heard->frames; t++) advance(&g, t);
        status = trace(&g, at);
    }
    free(g.now);
    free(g.before);
    free(g.low);
    free(g.back);
    if (status < 0) return tool_fail("speak", "out of memory");
    return status ? tool_fail("speak", "the recording is too short for these words") : 0;
}

/* ---- how well it fits ---- */

#define TURN 0.38 /* of the states, which go from the beginning to the end: what repeats itself seldom does so there */

/* The mean improbability of speech on the path. */
static double cost_of(const state_list *states, const posteriors *heard, const uint32_t *at)
{
    double sum = 0.0, count = 0.0;
    for (size_t t = 0; t < heard->frames; t++) {
        const path_state *s = &states->items[at[t]];
        if (s->pause) continue;
        sum += heard->cost[t][s->shape];
        count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

/* The path's cost against the cost of the best path through the same words in another order. */
static int score(const state_list *states, const posteriors *heard, uint32_t *at, double *out)
{
    const double own = cost_of(states, heard, at);
    state_list turned = { malloc(states->count * sizeof *turned.items), states->count };
    size_t first = (size_t)(TURN * (double)states->count);
    double other;
    int status;
    if (!turned.items) return tool_fail("speak", "out of memory");
    while (first && !(states->items[first].pause && !states->items[first - 1u].pause)) first--;
    memcpy(turned.items, states->items + first, (states->count - first) * sizeof *turned.items);
    memcpy(turned.items + states->count - first, states->items, first * sizeof *turned.items);
    status = find_path(&turned, heard, at);
    other = status ? 0.0 : cost_of(&turned, heard, at);
    *out = own < other ? 1.0 - own / other : 0.0;
    free(turned.items);
    return status;
}

/* ---- phones and words of the recording ---- */

static uint32_t sample_of(const synthesis *s, size_t frame)
{
    return frame ? (uint32_t)(((double)frame / POSTERIOR_RATE + POSTERIOR_OFFSET) * s->sample_rate) : 0u;
}

/* Words begin with the first phone at or behind their place in the text as it was synthesised. */
static void place_words(const synthesis *from, const uint32_t *start, synthesis *out)
{
    size_t phone = 0;
    for (size_t i = 0; i < from->word_count; i++) {
        const uint32_t near = from->sample_rate / 200u;
        while (phone + 1u < from->phone_count &&
               (from->phones[phone].sample + near < from->words[i].sample || start[phone] == UINT32_MAX)) {
            phone++;
        }
        if (start[phone] == UINT32_MAX) break;
        out->words[out->word_count] = from->words[i];
        out->words[out->word_count++].sample = start[phone];
    }
}

static void place_phones(const state_list *states, const uint32_t *at, size_t frames, const synthesis *from,
                         uint32_t *start, synthesis *out)
{
    for (size_t t = 0; t < frames; t++) {
        const path_state *now = &states->items[at[t]], *before = t ? &states->items[at[t - 1u]] : NULL;
        spoken_phone *p = &out->phones[out->phone_count];
        if (before && now->phone == before->phone && now->pause == before->pause) continue;
        memset(p, 0, sizeof *p);
        p->sample = sample_of(out, t);
        if (!now->pause) {
            memcpy(p->name, from->phones[now->phone].name, sizeof p->name);
            start[now->phone] = p->sample;
        }
        out->phone_count++;
    }
}

static int place(const state_list *states, const uint32_t *at, size_t frames, const synthesis *from,
                 const sound *recording, synthesis *out)
{
    uint32_t *start = malloc((from->phone_count + 1u) * sizeof *start);
    out->sample_rate = recording->rate;
    out->sample_count = recording->count;
    out->phones = calloc(2u * from->phone_count + 2u, sizeof *out->phones);
    out->words = calloc(from->word_count + 1u, sizeof *out->words);
    if (!start || !out->phones || !out->words) {
        free(start);
        return tool_fail("speak", "out of memory");
    }
    for (size_t i = 0; i < from->phone_count; i++) start[i] = UINT32_MAX;
    place_phones(states, at, frames, from, start, out);
    place_words(from, start, out);
    free(start);
    return 0;
}

/* ---- all of it ---- */

static int align(const sound *recording, const synthesis *said, const posteriors *heard, alignment *out)
{
    state_list states = { NULL, 0 };
    uint32_t *at = malloc((heard->frames + 1u) * sizeof *at);
    int status = at ? make_states(said, slowness(said, heard), &states) : tool_fail("speak", "out of memory");
    if (!status) status = find_path(&states, heard, at);
    if (!status) status = place(&states, at, heard->frames, said, recording, &out->said);
    if (!status) status = score(&states, heard, at, &out->score);
    free(states.items);
    free(at);
    return status;
}

int alignment_make(const sound *recording, const char *text, const char *language, alignment *out)
{
    posteriors heard;
    synthesis said;
    int status = posteriors_make(recording, &heard);
    memset(out, 0, sizeof *out);
    memset(&said, 0, sizeof said);
    if (!status && (!heard.frames || heard.loudest < LOUDEST_MIN)) {
        status = tool_fail("speak", "the recording is silent: it never exceeds -75 dB");
    }
    if (!status) status = synthesis_make(text, language, &said);
    if (!status) status = align(recording, &said, &heard, out);
    synthesis_free(&said);
    posteriors_free(&heard);
    if (status) alignment_free(out);
    return status;
}

void alignment_free(alignment *a)
{
    synthesis_free(&a->said);
    memset(a, 0, sizeof *a);
}
