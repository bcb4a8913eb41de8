/* graph_root.c: the root displacement of a graph. */
#include "motion/graph/graph_weights_internal.h"

#include "core/base/assert_internal.h"
#include "motion/anim/root_motion_internal.h"
#include "motion/graph/graph_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_motion.h"

/* Find the nodes with a clip in the pose that animates joints. */
static void find_movers(const noh_graph_view *v, const noh_clip_set *set, const noh_controller *c, const float *weights,
                        uint8_t *moves)
{
    const noh_graph *g = v->graph;
    for (uint32_t i = 0; i < g->node_count; i++) {
        const noh_graph_node *n = &g->nodes[i];
        moves[i] = 0;
        if (n->kind == NOH_NODE_CLIP) {
            const noh_track *t = noh_controller_track(c, n->index);
            moves[i] = weights[i] > 0.0f && !(set->clips[t->clip].flags & NOH_CLIP_FLOATS_ONLY);
        }
        for (uint32_t k = 0; k < n->child_count; k++) moves[i] |= moves[g->children[n->first_child + k]];
    }
}

/* The shares of a node's children in its root displacement: they add up to 1 if any child moves the root. */
static void shares(const noh_graph_view *v, const noh_clip_set *set, const noh_graph_node *n, const uint8_t *moves,
                   float *local)
{
    const uint16_t *children = v->graph->children + n->first_child;
    float sum = 0.0f;
    noh_graph_child_weights(v, n, local);
    if (n->kind == NOH_NODE_ADD) {
        local[1] = 0.0f;
    } else if (n->kind == NOH_NODE_MASK || n->kind == NOH_NODE_ONE_SHOT) {
        const noh_mask_view mask = noh_clip_set_mask(set, n->mask);
        local[1] = moves[children[1]] ? local[1] * (mask.joints ? (float)mask.joints[0] / 255.0f : 1.0f) : 0.0f;
        local[0] = 1.0f - local[1];
    } else {
        for (uint32_t k = 0; k < n->child_count; k++) {
            if (!moves[children[k]]) local[k] = 0.0f;
            sum += local[k];
        }
        for (uint32_t k = 0; k < n->child_count && sum > 0.0f; k++) local[k] /= sum;
    }
}

static void add_move(const noh_clip_set *set, const noh_track *t, double weight, double translation[3], double *turn)
{
    const noh_root_track *root = &set->roots[t->clip];
    if (weight > 0.0 && root->axes) {
        const noh_root_pose move = noh_root_between(set, root, t->clip, (noh_loop)t->loop, t->root_position,
                                                    t->position);
        for (int i = 0; i < 3; i++) translation[i] += weight * move.translation[i];
        *turn += weight * (double)(int32_t)move.turn;
    }
}

noh_root_pose noh_graph_root_motion(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set)
{
    noh_root_pose out = { { 0.0, 0.0, 0.0 }, 0, 0 };
    const noh_graph_view v = { graph, noh_graph_params_of(state), noh_graph_machines_of(state), 0 };
    noh_controller *c = noh_graph_controller(state);
    float weights[NOH_GRAPH_NODES_MAX], local[NOH_GRAPH_CHILDREN_MAX];
    uint8_t moves[NOH_GRAPH_NODES_MAX];
    double turn = 0.0;
    NOH_ASSERT(state && graph && set && state->node_count == graph->node_count);
    if (!set->roots) {
        return out;
    }
    noh_graph_weights(&v, weights, moves); /* which nodes are in play does not matter here */
    find_movers(&v, set, c, weights, moves);
    weights[graph->node_count - 1u] = 1.0f;
    for (uint32_t i = graph->node_count; i-- > 0;) { /* parents come after their children */
        const noh_graph_node *n = &graph->nodes[i];
        if (n->kind == NOH_NODE_CLIP) {
            noh_track *t = &noh_controller_tracks(c)[n->index];
            add_move(set, t, (double)weights[i] * moves[i], out.translation, &turn);
            t->root_position = t->position;
            continue;
        }
        shares(&v, set, n, moves, local);
        for (uint32_t k = 0; k < n->child_count; k++)
            weights[graph->children[n->first_child + k]] = weights[i] * local[k];
    }
    out.turn = (uint32_t)(uint64_t)(int64_t)(turn < 0.0 ? turn - 0.5 : turn + 0.5);
    return out;
}
