/* wire_skin.c: the joints that move each vertex, and their weights.
 *
 * A joint is coded as one of the joints of nearby vertices. Its weight is predicted from its weights there.
 */
#include "core/wire/wire_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#include <string.h>

#define CHOICES 14u
#define SAME_AS_FIRST 14u
#define NEW_JOINT 15u
#define MODEL_JOINT 0u
#define MODEL_WEIGHT 16u

typedef struct influences {
    uint32_t joints[NOH_INFLUENCES_MAX];
    int32_t weights[NOH_INFLUENCES_MAX];
} influences;

static uint64_t words_at(const noh_wire_filter *f, uint32_t v)
{
    const noh_mesh_header *h = &f->mesh.header;
    return (uint64_t)f->mesh.chunk + h->influences_offset + 4u * (uint64_t)v * NOH_INFLUENCE_WORDS(h->influence_count);
}

/* Bits of the words from `bit` on. */
static uint32_t bits_of(const noh_wire_filter *f, uint64_t words, uint32_t bit, uint32_t size)
{
    const uint64_t at = words + 4u * (bit / 32u);
    uint64_t pair = noh_wire_load(f, at);
    if (bit % 32u + size > 32u) pair |= (uint64_t)noh_wire_load(f, at + 4u) << 32;
    return (uint32_t)(pair >> bit % 32u) & ((1u << size) - 1u);
}

static uint32_t weight_bit(uint32_t i)
{
    return i == 1u ? 0u : 22u + 21u * (i - 2u);
}

static influences load(const noh_wire_filter *f, uint32_t v)
{
    const uint32_t count = f->mesh.header.influence_count;
    const uint64_t words = words_at(f, v), weights = words + (count == 8u ? 8u : 4u);
    influences in;
    memset(&in, 0, sizeof in);
    in.weights[0] = (int32_t)NOH_WEIGHT_ONE;
    for (uint32_t i = 0; i < count; i++) {
        in.joints[i] = bits_of(f, words, 8u * i, 8u);
        if (i) in.weights[i] = (int32_t)bits_of(f, weights, weight_bit(i), i == 1u ? 22u : 21u);
        if (i) in.weights[0] -= in.weights[i];
    }
    return in;
}

static void store(noh_wire_filter *f, uint32_t v, const influences *in)
{
    const uint32_t count = f->mesh.header.influence_count, first = count == 8u ? 2u : 1u;
    const uint64_t at = words_at(f, v);
    uint32_t words[8] = { 0, 0, 0, 0, 0, 0, 0, 0 };
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t bit = 32u * first + weight_bit(i);
        words[i / 4u] |= (in->joints[i] & 255u) << 8u * (i % 4u);
        if (i) {
            const uint64_t weight = (uint64_t)((uint32_t)in->weights[i] & (i == 1u ? 0x3fffffu : 0x1fffffu))
                                    << bit % 32u;
            words[bit / 32u] |= (uint32_t)weight;
            if (weight >> 32) words[bit / 32u + 1u] |= (uint32_t)(weight >> 32);
        }
    }
    for (uint32_t i = 0; i < NOH_INFLUENCE_WORDS(count); i++) noh_wire_store(f, at + 4u * i, words[i]);
}

typedef struct choice {
    uint32_t joints[CHOICES];
    uint32_t count;
    influences near[3];
    noh_wire_near at;
} choice;

static void add_choice(choice *c, uint32_t joint)
{
    for (uint32_t i = 0; i < c->count; i++) {
        if (c->joints[i] == joint) return;
    }
    if (c->count < CHOICES) c->joints[c->count++] = joint;
}

/* The joints near by, the heaviest first. */
static void gather(const noh_wire_filter *f, uint32_t v, choice *c)
{
    uint32_t of[3];
    memset(c, 0, sizeof *c);
    c->at = noh_wire_near_of(f, v);
    of[0] = c->at.a;
    of[1] = c->at.b;
    of[2] = c->at.across;
    for (uint32_t k = 0; k < 3u; k++) {
        if (of[k] != NOH_NONE) c->near[k] = load(f, of[k]);
    }
    for (uint32_t i = 0; i < f->mesh.header.influence_count; i++) {
        for (uint32_t k = 0; k < 3u; k++) {
            if (of[k] != NOH_NONE) add_choice(c, c->near[k].joints[i]);
        }
    }
}

static int32_t weight_of(const influences *in, uint32_t count, uint32_t joint)
{
    for (uint32_t i = 0; i < count; i++) {
        if (in->joints[i] == joint) return in->weights[i];
    }
    return 0;
}

/* A joint that was chosen is out of the choice: the places of those behind it are lower by one. */
static uint32_t code_joint(noh_wire_filter *f, choice *c, const influences *in, uint32_t i)
{
    uint32_t symbol = NEW_JOINT, joint = in->joints[i], behind[CHOICES];
    for (uint32_t k = c->count; k > 0; k--) {
        if (c->joints[k - 1u] == joint) symbol = k - 1u;
    }
    if (i && joint == in->joints[0]) symbol = SAME_AS_FIRST;
    symbol = noh_wire_symbol(&f->coder, &f->models[MODEL_JOINT + i], symbol);
    if (symbol == NEW_JOINT) return noh_wire_bits(&f->coder, joint, 8u);
    if (symbol == SAME_AS_FIRST) return in->joints[0];
    if (symbol >= c->count) return 0;
    joint = c->joints[symbol];
    c->count--;
    memcpy(behind, c->joints, sizeof behind);
    memcpy(c->joints + symbol, behind + symbol + 1u, (c->count - symbol) * sizeof *behind);
    return joint;
}

static int32_t code_weight(noh_wire_filter *f, const choice *c, const influences *in, uint32_t i)
{
    const uint32_t count = f->mesh.header.influence_count, shift = f->section.params[0] & 31u;
    const uint32_t joint = in->joints[i], same = joint == in->joints[0];
    int32_t guess = same ? 0
                         : noh_wire_predict(&c->at, weight_of(&c->near[0], count, joint),
                                            weight_of(&c->near[1], count, joint), weight_of(&c->near[2], count, joint));
    int32_t residual;
    guess = (guess < 0 ? 0 : guess > (int32_t)NOH_WEIGHT_ONE / 2 ? (int32_t)NOH_WEIGHT_ONE / 2 : guess) >> shift;
    residual = noh_wire_residual(f, MODEL_WEIGHT + 16u * i + 8u * same, same ? 0u : noh_wire_activity(f, i),
                                 (in->weights[i] >> shift) - guess);
    if (!same) noh_wire_note(f, i, residual);
    return (int32_t)((uint32_t)(guess + residual) << shift);
}

static void code_vertex(noh_wire_filter *f, uint32_t v)
{
    influences in = load(f, v);
    choice c;
    gather(f, v, &c);
    for (uint32_t i = 0; i < f->mesh.header.influence_count; i++) in.joints[i] = code_joint(f, &c, &in, i);
    for (uint32_t i = 1; i < f->mesh.header.influence_count; i++) in.weights[i] = code_weight(f, &c, &in, i);
    store(f, v, &in);
}

/* params: bits of a weight that are 0 in all */
int noh_wire_run_influences(noh_wire_filter *f)
{
    for (; f->cursor[0] < f->mesh.order_count; f->cursor[0]++) {
        if (!noh_wire_item(&f->coder)) return 0;
        code_vertex(f, f->mesh.order[f->cursor[0]]);
    }
    return 1;
}
