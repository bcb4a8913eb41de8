/* graph_ending.c: transitions `when ending`, and one-shots, whose clip never ends. */
#include <stdio.h>
#include <string.h>

#include "convert/graph/graph_text.h"
#include "convert/model/model_build.h"
#include "noh/format.h"

#define LOOP_OF_CLIP 0u /* noh_loop */
#define LOOP_ONCE 1u

typedef struct ending {
    raw_set *const *sets;
    uint32_t set_count;
    int all_loop;
} ending;

/* The clip that ends a state: the first of its nodes. */
static const graph_node *clip_of(const graph_def *g, const graph_child *state)
{
    const graph_node *n = &g->nodes[state->node.index];
    while (n->child_count) n = &g->nodes[n->children[0].node.index];
    return n;
}

/* Several skeletons may have a clip of one name: one of them that ends is enough. */
static int source_loops(const ending *e, const char *name)
{
    for (uint32_t s = 0; s < e->set_count; ++s) {
        for (uint32_t i = 0; i < e->sets[s]->clip_count; ++i) {
            const raw_clip *clip = &e->sets[s]->clips[i];
            if (clip->name && strcmp(clip->name, name) == 0 && !clip->loop && !e->all_loop) return 0;
        }
    }
    return 1;
}

/* Why a clip never ends, and what to do; NULL: it ends. */
static const char *why_never(const ending *e, const graph_node *clip)
{
    if (clip->paused) return "is paused, so it never ends: remove paused=yes";
    if (clip->loop == LOOP_OF_CLIP ? source_loops(e, clip->clip) : clip->loop != LOOP_ONCE)
        return "loops, so it never ends: give the clip loop=once";
    return NULL;
}

/* A transition from any state waits for whichever state of the machine ends. */
static int warn_transition(const ending *e, const graph_def *g, const graph_transition *t, const char *path, model *m)
{
    const graph_node *machine = &g->nodes[t->machine], *clip = NULL;
    const char *why = NULL;
    for (uint32_t i = 0; i < machine->child_count; ++i) {
        if (i == t->to.index || (t->from.name && i != t->from.index)) continue;
        clip = clip_of(g, &machine->children[i]);
        why = why_never(e, clip);
        if (!why) return 0;
    }
    return why && model_warn(m, "%s:%u: `from %s to %s when ending` is never true: '%s' %s", path, (unsigned)t->to.line,
                             t->from.name ? t->from.name : "any", t->to.name, clip->name, why);
}

static int warn_one_shot(const ending *e, const graph_def *g, const graph_node *n, const char *path, model *m)
{
    const graph_node *clip = clip_of(g, &n->children[1]);
    const char *why = why_never(e, clip);
    return why && model_warn(m, "%s:%u: the one-shot '%s' never ends: '%s' %s", path, (unsigned)n->line, n->name,
                             clip->name, why);
}

int graph_text_warn(const graph_file *file, raw_set *const *sets, uint32_t set_count, int all_loop, const char *path,
                    model *m)
{
    const ending e = { sets, set_count, all_loop };
    int failed = 0;
    for (uint32_t i = 0; i < file->count && !failed; ++i) {
        const graph_def *g = file->graphs[i];
        for (uint32_t t = 0; t < g->transition_count && !failed; ++t)
            if (!g->transitions[t].param.name) failed = warn_transition(&e, g, &g->transitions[t], path, m);
        for (uint32_t n = 0; n < g->node_count && !failed; ++n)
            if (g->nodes[n].kind == NOH_PACK_NODE_ONE_SHOT) failed = warn_one_shot(&e, g, &g->nodes[n], path, m);
    }
    return failed;
}
