/* graph_read.c: the statements of graph texts. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "convert/base/input_file.h"
#include "graph_internal.h"

static const char *const curves[] = { "linear", "smooth", NULL };
static const char *const entries[] = { "start", "keep", NULL };
static const char *const yes_no[] = { "no", "yes", NULL };

#define FLAG_INERTIAL 1u /* NOH_TRANSITION_* of low_motion.h */
#define FLAG_KEEP 2u

static graph_ref ref_of(graph_word word)
{
    const graph_ref ref = { word.text, NOH_NONE, word.line };
    return ref;
}

static int fail_full(graph_reader *r, uint32_t limit, const char *what)
{
    return graph_fail(r, r->words[0].line, "more than %u %s in one graph", limit, what);
}

/* ---- parameters ---- */

/* Names that follow an equals sign elsewhere: by=NAME, mask=NAME, initial=NAME. */
static int check_plain(graph_reader *r, graph_word name)
{
    const char *at = name.text;
    if (strchr("+-.0123456789", *at) || strcmp(at, "ending") == 0)
        return graph_fail(r, name.line, "'%.60s' cannot be a name here: it reads as a number or a condition", at);
    if (strpbrk(at, " \t,=\""))
        return graph_fail(r, name.line, "'%.60s' cannot be a name here: it has a blank, a comma, a quote or an =", at);
    return 0;
}

static int new_param(graph_reader *r, uint32_t kind, graph_param **out)
{
    graph_word name;
    graph_param *p = &r->g->params[r->g->param_count];
    if (r->g->param_count == NOH_GRAPH_PARAMS_MAX) return fail_full(r, NOH_GRAPH_PARAMS_MAX, "parameters");
    if (graph_take_needed(r, "a name", &name) || check_plain(r, name)) return 1;
    for (uint32_t i = 0; i < r->g->param_count; ++i)
        if (strcmp(r->g->params[i].name, name.text) == 0)
            return graph_fail(r, name.line, "the parameter '%.60s' is given twice; the first is in line %u", name.text,
                              r->g->params[i].line);
    memset(p, 0, sizeof *p);
    p->name = name.text;
    p->line = name.line;
    p->kind = kind;
    ++r->g->param_count;
    *out = p;
    return 0;
}

static int take_number(graph_reader *r, const char *what, float *out)
{
    graph_word word;
    double value;
    if (graph_take_needed(r, what, &word) || graph_number(r, word.line, word.text, &value)) return 1;
    *out = (float)value;
    return isfinite(*out) ? 0 : graph_fail(r, word.line, "the number '%.60s' is too large", word.text);
}

static int read_number(graph_reader *r, uint32_t kind)
{
    graph_param *p;
    double initial;
    if (new_param(r, kind, &p) || take_number(r, "the lowest value", &p->minimum) ||
        take_number(r, "the highest value", &p->maximum))
        return 1;
    if (!(p->minimum <= p->maximum))
        return graph_fail(r, p->line, "the range of '%.60s' is empty: %.9g to %.9g", p->name, (double)p->minimum,
                          (double)p->maximum);
    initial = p->minimum > 0.0f ? (double)p->minimum : p->maximum < 0.0f ? (double)p->maximum : 0.0;
    if (graph_option_number(r, "initial", (double)p->minimum, (double)p->maximum, &initial)) return 1;
    p->initial = fminf(fmaxf((float)initial, p->minimum), p->maximum);
    if (kind == NOH_PARAM_INTEGER &&
        (floorf(p->minimum) != p->minimum || floorf(p->maximum) != p->maximum || floorf(p->initial) != p->initial))
        return graph_fail(r, p->line, "'%.60s' is an integer: its range and initial value must be whole numbers",
                          p->name);
    return graph_done(r, "initial");
}

static int new_name(graph_reader *r, graph_word word, graph_name **out)
{
    graph_name *n = &r->g->names[r->g->name_count];
    if (r->g->name_count == NOH_GRAPH_NAMES_MAX)
        return fail_full(r, NOH_GRAPH_NAMES_MAX, "values, joints and reference clips");
    ++r->g->name_count;
    n->name = word.text;
    n->line = word.line;
    n->weight = n->subtree = 0;
    *out = n;
    return 0;
}

static int read_enum(graph_reader *r)
{
    graph_param *p;
    graph_name *value;
    const char *names[GRAPH_WORDS_MAX + 1];
    uint32_t initial = 0;
    if (new_param(r, NOH_PARAM_ENUM, &p)) return 1;
    p->first_value = r->g->name_count;
    for (graph_word word = graph_take(r); word.text[0]; word = graph_take(r)) {
        for (uint32_t i = 0; i < p->value_count; ++i)
            if (strcmp(names[i], word.text) == 0)
                return graph_fail(r, word.line, "'%.60s' has the value '%.60s' twice", p->name, word.text);
        if (check_plain(r, word) || new_name(r, word, &value)) return 1;
        names[p->value_count++] = word.text;
    }
    if (!p->value_count) return graph_fail(r, p->line, "'%.60s' has no values", p->name);
    names[p->value_count] = NULL;
    if (graph_option_word(r, "initial", names, &initial)) return 1;
    p->maximum = (float)(p->value_count - 1u);
    p->initial = (float)initial;
    return graph_done(r, "initial");
}

static int read_trigger(graph_reader *r)
{
    graph_param *p;
    if (new_param(r, NOH_PARAM_TRIGGER, &p)) return 1;
    p->maximum = 1.0f;
    return graph_done(r, "");
}

/* ---- masks ---- */

static uint32_t weight_of(double value)
{
    return (uint32_t)floor(value * 255.0 + 0.5);
}

static int read_mask(graph_reader *r)
{
    graph_mask *m = &r->g->masks[r->g->mask_count];
    graph_word name;
    double floats = 0.0;
    if (r->g->mask_count == NOH_MASKS_MAX) return fail_full(r, NOH_MASKS_MAX, "masks");
    if (graph_take_needed(r, "a name", &name) || check_plain(r, name) ||
        graph_option_number(r, "floats", 0.0, 1.0, &floats))
        return 1;
    for (uint32_t i = 0; i < r->g->mask_count; ++i)
        if (strcmp(r->g->masks[i].name, name.text) == 0)
            return graph_fail(r, name.line, "the mask '%.60s' is given twice; the first is in line %u", name.text,
                              r->g->masks[i].line);
    m->name = name.text;
    m->line = name.line;
    m->floats = weight_of(floats);
    m->first_joint = r->g->name_count;
    m->joint_count = 0;
    ++r->g->mask_count;
    r->mask = m;
    return graph_done(r, "floats");
}

static int read_joint(graph_reader *r, uint32_t subtree)
{
    graph_word name;
    graph_name *joint = NULL;
    double weight = 1.0;
    if (!r->mask)
        return graph_fail(r, r->words[0].line, "'%.60s' belongs to a mask: put it directly below the line of its mask",
                          r->words[0].text);
    if (graph_take_needed(r, "a joint", &name) || graph_option_number(r, "weight", 0.0, 1.0, &weight) ||
        new_name(r, name, &joint))
        return 1;
    joint->weight = weight_of(weight);
    joint->subtree = subtree;
    ++r->mask->joint_count;
    return graph_done(r, "weight");
}

/* ---- nodes ---- */

static int new_node(graph_reader *r, uint32_t kind, graph_node **out)
{
    graph_node *n = &r->g->nodes[r->g->node_count];
    graph_word name;
    if (r->g->node_count == NOH_GRAPH_NODES_MAX) return fail_full(r, NOH_GRAPH_NODES_MAX, "nodes");
    if (graph_take_needed(r, "a name", &name)) return 1;
    if (strcmp(name.text, "any") == 0)
        return graph_fail(r, name.line, "'any' means every state: a node needs another name");
    for (uint32_t i = 0; i < r->g->node_count; ++i)
        if (strcmp(r->g->nodes[i].name, name.text) == 0)
            return graph_fail(r, name.line, "the node '%.60s' is given twice; the first is in line %u", name.text,
                              r->g->nodes[i].line);
    memset(n, 0, sizeof *n);
    n->name = name.text;
    n->line = name.line;
    n->kind = kind;
    n->parent = NOH_NONE;
    ++r->g->node_count;
    *out = n;
    return 0;
}

static int add_child(graph_reader *r, graph_node *n, graph_word word)
{
    if (n->child_count == NOH_GRAPH_CHILDREN_MAX)
        return graph_fail(r, word.line, "'%.60s' has more than %u children", n->name, NOH_GRAPH_CHILDREN_MAX);
    n->children[n->child_count++].node = ref_of(word);
    return 0;
}

/* All words that are left, at least one. */
static int take_children(graph_reader *r, graph_node *n)
{
    graph_word word;
    if (graph_take_needed(r, "a node", &word)) return 1;
    for (; word.text[0]; word = graph_take(r))
        if (add_child(r, n, word)) return 1;
    return 0;
}

static int take_pair(graph_reader *r, graph_node *n)
{
    graph_word a, b;
    return graph_take_needed(r, "a node", &a) || graph_take_needed(r, "a second node", &b) || add_child(r, n, a) ||
           add_child(r, n, b);
}

/* by=PARAM, or by=PARAM,PARAM where there may be two. */
static int take_by(graph_reader *r, graph_node *n, int both)
{
    char *text = (char *)(uintptr_t)graph_option(r, "by"), *comma; /* of the file's pool, which is ours */
    if (!text || !*text) return graph_fail(r, n->line, "'%.60s' needs by=PARAMETER", n->name);
    comma = both ? strchr(text, ',') : NULL;
    if (comma) {
        *comma = '\0';
        n->by[1] = (graph_ref){ comma + 1, NOH_NONE, n->line };
    }
    n->by[0] = (graph_ref){ text, NOH_NONE, n->line };
    return 0;
}

/* by= is a number, or a parameter; a number is what begins with a digit, a sign or a point. */
static int take_amount(graph_reader *r, graph_node *n)
{
    double value;
    if (take_by(r, n, 0)) return 1;
    if (!strchr("+-.0123456789", n->by[0].name[0])) return 0;
    if (graph_number(r, n->line, n->by[0].name, &value)) return 1;
    if (!(value >= 0.0 && value <= 1.0)) return graph_fail(r, n->line, "by must be 0 to 1, not %.9g", value);
    n->value = (float)value;
    n->by[0].name = NULL;
    return 0;
}

/* fade=S or inertia=S, curve= and enter=. */
static int take_change(graph_reader *r, uint32_t *ticks, uint32_t *curve, uint32_t *flags)
{
    uint32_t inertia = 0, keep = 0;
    if (graph_option_ticks(r, "fade", ticks) || graph_option_ticks(r, "inertia", &inertia) ||
        graph_option_word(r, "curve", curves, curve) || graph_option_word(r, "enter", entries, &keep))
        return 1;
    if (inertia && *ticks) return graph_fail(r, r->words[0].line, "give fade or inertia, not both");
    *ticks = inertia ? inertia : *ticks;
    *flags = (inertia ? FLAG_INERTIAL : 0u) | (keep ? FLAG_KEEP : 0u);
    return 0;
}

static int read_clip(graph_reader *r)
{
    static const char *const loops[] = { "clip", "once", "repeat", "ping-pong", NULL };
    graph_node *n;
    graph_word clip;
    double speed = 1.0;
    if (new_node(r, NOH_PACK_NODE_CLIP, &n)) return 1;
    clip = graph_take(r);
    n->clip = clip.text[0] ? clip.text : n->name;
    if (graph_option_number(r, "speed", -256.0, 256.0, &speed) || graph_option_word(r, "loop", loops, &n->loop) ||
        graph_option_ticks(r, "start", &n->start_tick) || graph_option_word(r, "paused", yes_no, &n->paused))
        return 1;
    n->speed = (int32_t)floor(speed * 65536.0 + 0.5);
    if (!n->speed) return graph_fail(r, n->line, "the speed of '%.60s' is 0: paused=yes stops a clip", n->name);
    n->sync = graph_option(r, "sync");
    return graph_done(r, "speed loop start paused sync");
}

static int read_pair(graph_reader *r, uint32_t kind)
{
    graph_node *n;
    const char *mask, *reference;
    if (new_node(r, kind, &n) || take_pair(r, n) || take_amount(r, n)) return 1;
    mask = kind == NOH_PACK_NODE_MASK ? graph_option(r, "mask") : NULL;
    if (kind == NOH_PACK_NODE_MASK && !mask) return graph_fail(r, n->line, "'%.60s' needs mask=MASK", n->name);
    n->mask = (graph_ref){ mask, NOH_NONE, n->line };
    reference = kind == NOH_PACK_NODE_ADD ? graph_option(r, "reference") : NULL;
    if (reference) {
        graph_name *name;
        n->reference = r->g->name_count + 1u;
        if (new_name(r, (graph_word){ reference, NULL, n->line }, &name)) return 1;
    }
    return graph_done(r, kind == NOH_PACK_NODE_MASK ? "by mask" : kind == NOH_PACK_NODE_ADD ? "by reference" : "by");
}

static int read_space(graph_reader *r)
{
    graph_node *n;
    graph_word word;
    if (new_node(r, NOH_PACK_NODE_SPACE_1D, &n) || take_by(r, n, 1)) return 1;
    n->kind = n->by[1].name ? NOH_PACK_NODE_SPACE_2D : NOH_PACK_NODE_SPACE_1D;
    if (graph_take_needed(r, "a node", &word)) return 1;
    for (; word.text[0]; word = graph_take(r)) {
        if (add_child(r, n, word) || take_number(r, "the place of a node", &n->children[n->child_count - 1].at[0]))
            return 1;
        if (n->by[1].name && take_number(r, "the second coordinate of a node", &n->children[n->child_count - 1].at[1]))
            return 1;
    }
    return graph_done(r, "by");
}

static int read_select(graph_reader *r)
{
    graph_node *n;
    return new_node(r, NOH_PACK_NODE_SELECT, &n) || take_children(r, n) || take_by(r, n, 0) ||
           take_change(r, &n->fade_ticks, &n->curve, &n->flags) || graph_done(r, "by fade inertia curve enter");
}

static int read_one_shot(graph_reader *r)
{
    graph_node *n;
    const char *on;
    if (new_node(r, NOH_PACK_NODE_ONE_SHOT, &n) || take_pair(r, n)) return 1;
    on = graph_option(r, "on");
    if (!on) return graph_fail(r, n->line, "'%.60s' needs on=TRIGGER", n->name);
    n->by[0] = (graph_ref){ on, NOH_NONE, n->line };
    n->mask = (graph_ref){ graph_option(r, "mask"), NOH_NONE, n->line };
    n->value = 0.5f;
    return graph_option_ticks(r, "in", &n->fade_ticks) || graph_option_ticks(r, "out", &n->fade_out_ticks) ||
           graph_option_word(r, "curve", curves, &n->curve) || graph_done(r, "on in out curve mask");
}

static int read_machine(graph_reader *r)
{
    graph_node *n;
    if (new_node(r, NOH_PACK_NODE_MACHINE, &n) || take_children(r, n)) return 1;
    n->first_transition = r->g->transition_count;
    r->node = n;
    return graph_done(r, "");
}

/* ---- transitions ---- */

static int take_keyword(graph_reader *r, const char *keyword)
{
    const graph_word word = graph_take(r);
    return strcmp(word.text, keyword) == 0
               ? 0
               : graph_fail(
                     r, word.line,
                     "'%s' is missing: write `from STATE to STATE when PARAM above|below V`, `when TRIGGER` or `when "
                     "ending`",
                     keyword);
}

/* PARAM above V, PARAM below V, TRIGGER, ending */
static int take_condition(graph_reader *r, graph_transition *t)
{
    graph_word param, how;
    if (graph_take_needed(r, "a parameter", &param)) return 1;
    how = graph_take(r);
    if (!how.text[0] && strcmp(param.text, "ending") == 0) {
        t->condition = 3;
        return 0;
    }
    t->param = ref_of(param);
    t->threshold = 0.5f;
    t->condition = 2;
    if (!how.text[0]) return 0;
    t->condition = strcmp(how.text, "below") == 0;
    if (!t->condition && strcmp(how.text, "above") != 0)
        return graph_fail(r, how.line, "'%.60s' is neither above nor below", how.text);
    return take_number(r, "a number", &t->threshold);
}

static int read_from(graph_reader *r)
{
    graph_transition *t = &r->g->transitions[r->g->transition_count];
    graph_word from, to;
    if (!r->node)
        return graph_fail(r, r->words[0].line,
                          "'from' belongs to a machine: put it directly below the line of its machine");
    if (r->g->transition_count == NOH_GRAPH_TRANSITIONS_MAX)
        return fail_full(r, NOH_GRAPH_TRANSITIONS_MAX, "transitions");
    memset(t, 0, sizeof *t);
    if (graph_take_needed(r, "a state, or any,", &from) || take_keyword(r, "to") ||
        graph_take_needed(r, "a state", &to) || take_keyword(r, "when") || take_condition(r, t))
        return 1;
    if (strcmp(from.text, "any") != 0) t->from = ref_of(from);
    t->to = ref_of(to);
    t->machine = (uint32_t)(r->node - r->g->nodes);
    if (take_change(r, &t->duration_ticks, &t->curve, &t->flags)) return 1;
    ++r->g->transition_count;
    ++r->node->transition_count;
    return graph_done(r, "fade inertia curve enter");
}

/* ---- the file ---- */

static int read_graph(graph_reader *r)
{
    graph_word name;
    if (r->g && (graph_link(r, r->g) || graph_make(r, r->g))) return 1;
    if (r->file->count == GRAPHS_MAX) return graph_fail(r, r->words[0].line, "more than %u graphs", GRAPHS_MAX);
    if (graph_take_needed(r, "a name", &name)) return 1;
    for (uint32_t i = 0; i < r->file->count; ++i)
        if (strcmp(r->file->graphs[i]->name, name.text) == 0)
            return graph_fail(r, name.line, "the graph '%.60s' is given twice; the first is in line %u", name.text,
                              r->file->graphs[i]->line);
    r->g = calloc(1, sizeof *r->g);
    if (!r->g) return graph_fail(r, name.line, "there is not enough memory to read this file");
    r->file->graphs[r->file->count++] = r->g;
    r->g->name = name.text;
    r->g->line = name.line;
    return graph_done(r, "");
}

static const char *const statements[] = { "graph", "number", "integer",  "enum",    "trigger", "mask",
                                          "below", "joint",  "clip",     "blend",   "add",     "layer",
                                          "space", "select", "one-shot", "machine", "from" };

static int read_statement(graph_reader *r, uint32_t which)
{
    switch (which) {
    case 0: return read_graph(r);
    case 1: return read_number(r, NOH_PARAM_NUMBER);
    case 2: return read_number(r, NOH_PARAM_INTEGER);
    case 3: return read_enum(r);
    case 4: return read_trigger(r);
    case 5: return read_mask(r);
    case 6: return read_joint(r, 1);
    case 7: return read_joint(r, 0);
    case 8: return read_clip(r);
    case 9: return read_pair(r, NOH_PACK_NODE_BLEND);
    case 10: return read_pair(r, NOH_PACK_NODE_ADD);
    case 11: return read_pair(r, NOH_PACK_NODE_MASK);
    case 12: return read_space(r);
    case 13: return read_select(r);
    case 14: return read_one_shot(r);
    case 15: return read_machine(r);
    default: return read_from(r);
    }
}

static int read_line(graph_reader *r)
{
    const uint32_t count = sizeof statements / sizeof statements[0];
    graph_word keyword;
    uint32_t which = 0;
    char hint[GRAPH_HINT];
    if (graph_split(r)) return 1;
    if (!r->word_count) return 0; /* a comment */
    keyword = graph_take(r);
    while (which < count && strcmp(statements[which], keyword.text) != 0) ++which;
    if (which == count)
        return graph_fail(r, r->words[0].line, "no statement begins with '%.60s'%s",
                          keyword.text[0] ? keyword.text : r->words[0].text,
                          graph_hint(keyword.text, statements, count, hint));
    if (which != 0 && !r->g) return graph_fail(r, keyword.line, "the first statement must be: graph NAME");
    if (which != 6 && which != 7) r->mask = NULL;
    if (which != 16) r->node = NULL;
    return read_statement(r, which);
}

int graph_text_read(const char *path, graph_file **out, uint32_t *line, model_error *error)
{
    size_t size = 0;
    graph_reader r;
    int failed;
    char *text = input_read_text(path, &size, error);
    *out = NULL;
    *line = 0;
    if (!text) return 1;
    memset(&r, 0, sizeof r);
    text_start(&r.text, text, size, error);
    r.error = error;
    r.line = line;
    r.file = calloc(1, sizeof *r.file);
    failed = r.file ? 0 : graph_fail(&r, 0, "there is not enough memory to read this file");
    while (!failed && text_next_line(&r.text)) failed = read_line(&r);
    if (!failed) failed = r.g ? graph_link(&r, r.g) || graph_make(&r, r.g) : graph_fail(&r, 0, "the file has no graph");
    if (failed)
        graph_text_free(r.file);
    else
        *out = r.file;
    free(text);
    return failed;
}

void graph_text_free(graph_file *file)
{
    if (!file) return;
    for (uint32_t i = 0; i < file->count; ++i) {
        free(file->graphs[i]->bytes);
        free(file->graphs[i]);
    }
    for (uint32_t i = 0; i < file->pool_count; ++i) free(file->pool[i]);
    free(file->pool);
    free(file);
}
