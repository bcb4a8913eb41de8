/* graph_link.c: a graph made in code: its names and links, with messages that name the node. What needs no names, the
 * checker of packs sees (graph_make.c). */
#include <string.h>

#include "motion/graph/graph_make_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/graph.h"
#include "noh/low_motion.h"

/* ---- messages ---- */

static size_t say(noh_graph_maker *m, size_t at, const char *part)
{
    while (*part && at + 1u < m->text_bytes) m->text[at++] = *part++;
    if (at < m->text_bytes) m->text[at] = 0;
    return at;
}

noh_result noh_graph_refuse(noh_graph_maker *m, uint32_t where, const char *owner, const char *what, const char *name,
                            const char *advice)
{
    size_t at = say(m, say(m, say(m, 0, "'"), owner), "': ");
    at = say(m, at, what);
    if (name) at = say(m, say(m, say(m, at, " '"), name), "'");
    if (advice) (void)say(m, say(m, at, ": "), advice);
    return noh_fail(m->error, NOH_ERR_ARG, m->text_bytes ? m->text : what, where, 0);
}

/* ---- counts ---- */

static int is_name(const char *name)
{
    uint32_t bytes = 0;
    while (name && name[bytes] && bytes < NOH_NAME_BYTES_MAX) bytes++;
    return bytes > 0 && bytes < NOH_NAME_BYTES_MAX;
}

static int is_name_or_null(const char *name)
{
    return !name || is_name(name);
}

static int are_names(const char *const *names, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!is_name(names[i])) return 0;
    }
    return 1;
}

static int names_of_node(const noh_graph_node_desc *n)
{
    int good = is_name(n->name) && are_names(n->children, n->child_count) && is_name_or_null(n->param) &&
               is_name_or_null(n->param_y) && is_name_or_null(n->mask) && is_name_or_null(n->clip) &&
               is_name_or_null(n->sync);
    for (uint32_t i = 0; i < n->transition_count; i++) {
        const noh_graph_transition_desc *t = &n->transitions[i];
        good = good && is_name_or_null(t->from) && is_name(t->to) && is_name_or_null(t->param);
    }
    return good;
}

static const char *bad_nodes(const noh_graph_desc *d, uint32_t *where)
{
    uint32_t transitions = 0, clips = 0;
    for (uint32_t i = 0; i < d->node_count; i++) {
        const noh_graph_node_desc *n = &d->nodes[i];
        *where = i;
        if (n->child_count > NOH_GRAPH_CHILDREN_MAX || (n->child_count && !n->children))
            return "children of a node: NULL, or more than NOH_GRAPH_CHILDREN_MAX";
        if ((n->kind == NOH_NODE_SPACE_1D || n->kind == NOH_NODE_SPACE_2D) && !n->points)
            return "points of a blend space are NULL: give one for each child";
        if (n->transition_count > NOH_GRAPH_TRANSITIONS_MAX - transitions || (n->transition_count && !n->transitions))
            return "transitions of a graph: NULL, or more than NOH_GRAPH_TRANSITIONS_MAX";
        transitions += n->transition_count;
        clips += n->kind == NOH_NODE_CLIP;
        if (clips > NOH_TRACKS_MAX) return "a graph has more CLIP nodes than NOH_TRACKS_MAX";
        if (!names_of_node(n)) return "a name in a node is missing, empty or longer than NOH_NAME_BYTES_MAX";
    }
    return NULL;
}

static const char *bad_params(const noh_graph_desc *d, uint32_t *where, uint32_t *names)
{
    for (uint32_t i = 0; i < d->param_count; i++) {
        const noh_graph_param_desc *p = &d->params[i];
        *where = i;
        if (p->value_count > NOH_GRAPH_NAMES_MAX - *names || (p->value_count && !p->values))
            return "values of a parameter: NULL, or more names than NOH_GRAPH_NAMES_MAX in a graph";
        *names += p->value_count;
        if (!is_name(p->name) || !are_names(p->values, p->value_count))
            return "a name in a parameter is missing, empty or longer than NOH_NAME_BYTES_MAX";
    }
    return NULL;
}

static const char *bad_masks(const noh_graph_desc *d, uint32_t *where, uint32_t *names)
{
    for (uint32_t i = 0; i < d->mask_count; i++) {
        const noh_graph_mask_desc *k = &d->masks[i];
        *where = i;
        if (k->joint_count > NOH_GRAPH_NAMES_MAX - *names || (k->joint_count && !k->joints))
            return "joints of a mask: NULL, or more names than NOH_GRAPH_NAMES_MAX in a graph";
        *names += k->joint_count;
        for (uint32_t j = 0; j < k->joint_count; j++) {
            if (!is_name(k->joints[j].joint)) return "a joint of a mask has no name, or one that is too long";
        }
        if (!is_name(k->name)) return "the name of a mask is missing, empty or longer than NOH_NAME_BYTES_MAX";
    }
    return NULL;
}

const char *noh_graph_bad_desc(const noh_graph_desc *d, uint32_t *where)
{
    uint32_t names = 0;
    const char *what;
    *where = 0;
    if (!d->nodes || !d->node_count || d->node_count > NOH_GRAPH_NODES_MAX)
        return "nodes of a graph: NULL, none, or more than NOH_GRAPH_NODES_MAX";
    if (d->param_count > NOH_GRAPH_PARAMS_MAX || (d->param_count && !d->params))
        return "params of a graph: NULL, or more than NOH_GRAPH_PARAMS_MAX";
    if (d->mask_count > NOH_MASKS_MAX || (d->mask_count && !d->masks))
        return "masks of a graph: NULL, or more than NOH_MASKS_MAX";
    if (!is_name(d->name)) return "the name of a graph is missing, empty or longer than NOH_NAME_BYTES_MAX";
    what = bad_nodes(d, where);
    if (!what) what = bad_params(d, where, &names);
    return what ? what : bad_masks(d, where, &names);
}

/* ---- links ---- */

static noh_result check_unique(noh_graph_maker *m, noh_graph_names t)
{
    for (uint32_t i = 1; i < t.count; i++) {
        const uint32_t first = noh_graph_find(&t, noh_graph_name_at(&t, i));
        if (first != i)
            return noh_graph_refuse(m, i, noh_graph_name_at(&t, i), "its name is given twice", NULL,
                                    "rename one of both");
    }
    return NOH_OK;
}

static noh_result need(noh_graph_maker *m, uint32_t node, noh_graph_names t, const char *name)
{
    return !name || noh_graph_find(&t, name) != NOH_NONE
               ? NOH_OK
               : noh_graph_refuse(m, node, m->d->nodes[node].name, t.kind, name, "add it, or correct the name");
}

static noh_result link_children(noh_graph_maker *m, uint32_t node)
{
    const noh_graph_node_desc *n = &m->d->nodes[node];
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < n->child_count && !result; i++) {
        const uint32_t child = noh_graph_number_of(noh_graph_nodes_of(m->d), n->children[i]);
        result = need(m, node, noh_graph_nodes_of(m->d), n->children[i]);
        if (!result && m->parent[child] != NOH_GRAPH_NONE)
            result = noh_graph_refuse(m, node, n->name, "there is a second parent for the child", n->children[i],
                                      "add a second node for it");
        if (!result) m->parent[child] = (uint16_t)node;
    }
    return result;
}

/* Whether a parameter is of a kind that a node takes. */
static noh_result check_param(noh_graph_maker *m, uint32_t node, const char *name)
{
    const noh_graph_node_desc *n = &m->d->nodes[node];
    const noh_graph_param_desc *p;
    const noh_result result = need(m, node, noh_graph_params_of_desc(m->d), name);
    if (result || !name) return result;
    p = &m->d->params[noh_graph_number_of(noh_graph_params_of_desc(m->d), name)];
    if (n->kind == NOH_NODE_ONE_SHOT && p->kind != NOH_PARAM_TRIGGER)
        return noh_graph_refuse(m, node, n->name, "it needs a trigger, and has the parameter", name,
                                "make that NOH_PARAM_TRIGGER");
    if (n->kind == NOH_NODE_SELECT &&
        !(p->kind == NOH_PARAM_ENUM
              ? p->value_count == n->child_count
              : p->kind == NOH_PARAM_INTEGER && p->minimum >= 0.0f && p->maximum <= (float)n->child_count - 1.0f))
        return noh_graph_refuse(m, node, n->name, "it needs a value for each child, of an enum or an integer, and has",
                                name, "give it as many values as children");
    if (n->kind < NOH_NODE_MACHINE && p->kind > NOH_PARAM_INTEGER)
        return noh_graph_refuse(m, node, n->name, "it needs a number, and has the parameter", name,
                                "make that NOH_PARAM_NUMBER or NOH_PARAM_INTEGER");
    return NOH_OK;
}

static noh_result check_transition(noh_graph_maker *m, uint32_t node, const noh_graph_transition_desc *t)
{
    const noh_graph_node_desc *n = &m->d->nodes[node];
    noh_result result = need(m, node, noh_graph_children_of(n), t->from);
    if (!result) result = need(m, node, noh_graph_children_of(n), t->to);
    if (!result) result = need(m, node, noh_graph_params_of_desc(m->d), t->param);
    if (result || !t->param) return result;
    return (m->d->params[noh_graph_number_of(noh_graph_params_of_desc(m->d), t->param)].kind == NOH_PARAM_TRIGGER) ==
                   (t->condition == NOH_WHEN_TRIGGERED)
               ? NOH_OK
               : noh_graph_refuse(m, node, n->name, "a transition's condition does not suit the parameter", t->param,
                                  "NOH_WHEN_TRIGGERED is for triggers, ABOVE and BELOW are for the others");
}

static noh_result check_space(noh_graph_maker *m, uint32_t node)
{
    const noh_graph_node_desc *n = &m->d->nodes[node];
    uint8_t triangles[3 * NOH_BLEND_SPACE_TRIANGLES_MAX];
    noh_error error = { NOH_OK, "", 0, 0 };
    uint32_t count;
    if (n->kind != NOH_NODE_SPACE_2D ||
        !noh_blend_space_2d_triangulate(n->child_count, n->points, triangles, &count, &error))
        return NOH_OK;
    return noh_graph_refuse(m, node, n->name, error.what, NULL,
                            error.where < n->child_count ? n->children[error.where] : NULL);
}

static noh_result link_node(noh_graph_maker *m, uint32_t node)
{
    const noh_graph_node_desc *n = &m->d->nodes[node];
    noh_result result = link_children(m, node);
    if (!result) result = check_param(m, node, n->param);
    if (!result) result = check_param(m, node, n->param_y);
    if (!result) result = need(m, node, noh_graph_masks_of(m->d), n->mask);
    for (uint32_t i = 0; i < n->transition_count && !result; i++)
        result = check_transition(m, node, &n->transitions[i]);
    return result ? result : check_space(m, node);
}

/* Children first, from the root down and along parents back. */
static void walk(noh_graph_maker *m, uint32_t root)
{
    uint8_t done[NOH_GRAPH_NODES_MAX] = { 0 };
    for (uint32_t node = root; node != NOH_GRAPH_NONE;) {
        const noh_graph_node_desc *n = &m->d->nodes[node];
        if (done[node] < n->child_count) {
            node = noh_graph_number_of(noh_graph_nodes_of(m->d), n->children[done[node]++]);
            continue;
        }
        m->place[node] = (uint16_t)m->h.node_count;
        m->order[m->h.node_count++] = (uint16_t)node;
        node = m->parent[node];
    }
}

static noh_result order_nodes(noh_graph_maker *m)
{
    const noh_graph_desc *d = m->d;
    uint32_t root = NOH_NONE;
    for (uint32_t i = 0; i < d->node_count; i++) {
        if (m->parent[i] != NOH_GRAPH_NONE) continue;
        if (root != NOH_NONE)
            return noh_graph_refuse(m, i, d->nodes[i].name, "it is the child of no node, and neither is",
                                    d->nodes[root].name, "only the root may be without a parent");
        root = i;
    }
    m->h.node_count = 0;
    memset(m->place, 0xff, sizeof m->place);
    if (root != NOH_NONE) walk(m, root);
    for (uint32_t i = 0; i < d->node_count; i++) {
        uint32_t on = i; /* the circle, after as many parents as there are nodes */
        if (m->place[i] != NOH_GRAPH_NONE) continue;
        for (uint32_t k = 0; k < d->node_count; k++) on = m->parent[on];
        return noh_graph_refuse(m, on, d->nodes[on].name, "it is its own descendant", NULL, "remove the circle");
    }
    return NOH_OK;
}

noh_result noh_graph_link(noh_graph_maker *m)
{
    noh_result result = check_unique(m, noh_graph_nodes_of(m->d));
    if (!result) result = check_unique(m, noh_graph_params_of_desc(m->d));
    if (!result) result = check_unique(m, noh_graph_masks_of(m->d));
    memset(m->parent, 0xff, sizeof m->parent);
    for (uint32_t i = 0; i < m->d->node_count && !result; i++) result = link_node(m, i);
    return result ? result : order_nodes(m);
}
