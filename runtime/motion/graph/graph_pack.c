#include "core/base/name_internal.h"
#include "core/base/assert_internal.h"
#include "core/pack/pack_internal.h"
#include "motion/anim/tracks_internal.h"
#include "motion/graph/graph_internal.h"
#include "motion/graph/graph_pack_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

#include <stddef.h>
#include <string.h>

#include "motion/anim/clip_set_internal.h"
#include "motion/graph/graph_weights_internal.h"

/* The pack format uses the graph's numbers. */
NOH_STATIC_ASSERT(NOH_PACK_NODE_CLIP == NOH_NODE_CLIP && NOH_PACK_NODE_BLEND == NOH_NODE_BLEND, kinds_first);
NOH_STATIC_ASSERT(NOH_PACK_NODE_ADD == NOH_NODE_ADD && NOH_PACK_NODE_MASK == NOH_NODE_MASK, kinds_layers);
NOH_STATIC_ASSERT(NOH_PACK_NODE_SPACE_1D == NOH_NODE_SPACE_1D && NOH_PACK_NODE_SPACE_2D == NOH_NODE_SPACE_2D, spaces);
NOH_STATIC_ASSERT(NOH_PACK_NODE_MACHINE == NOH_NODE_MACHINE && NOH_PACK_NODE_SELECT == NOH_NODE_SELECT, kinds_chosen);
NOH_STATIC_ASSERT(NOH_PACK_NODE_ONE_SHOT == NOH_NODE_ONE_SHOT && NOH_PACK_GRAPH_NONE == NOH_GRAPH_NONE, kinds_last);
NOH_STATIC_ASSERT(NOH_WHEN_ENDING == 3 && NOH_CURVE_SMOOTHSTEP == 1 && NOH_LOOP_PING_PONG == 3, numbers);
NOH_STATIC_ASSERT(NOH_TRANSITION_INERTIAL == 1u && NOH_TRANSITION_KEEP == 2u, transition_flags);

typedef struct parts {
    noh_graph_pack *made;
    noh_graph_node *nodes;
    noh_track_desc *clips;
    noh_graph_transition *transitions;
    noh_blend_space_2d *spaces;
    float *defaults;
    uint8_t *masks;
} parts;

noh_result noh_pack_graph_at(const noh_pack *pack, uint32_t index, noh_pack_graph *graph, noh_error *error)
{
    const uint8_t *chunk;
    const noh_pack_graph_header *h;
    noh_result result;
    NOH_ASSERT(pack && graph);
    if (index >= pack->runs[NOH_CHUNK_GRAPH].count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        pack->runs[NOH_CHUNK_GRAPH].count ? "index is past the pack's last graph"
                                                          : "the pack has no graph",
                        index, pack->runs[NOH_CHUNK_GRAPH].count);
    }
    result = noh_pack_check_graph(pack, index, error);
    if (result) {
        return result;
    }
    chunk = noh_pack_chunk_at(pack, NOH_CHUNK_GRAPH, index);
    h = (const noh_pack_graph_header *)(const void *)chunk;
    graph->pack = pack;
    graph->name = noh_pack_chunk_name(pack, pack->runs[NOH_CHUNK_GRAPH].first + index);
    graph->header = h;
    graph->nodes = (const noh_pack_graph_node *)(const void *)(chunk + h->nodes_offset);
    graph->children = (const uint16_t *)(const void *)(chunk + h->children_offset);
    graph->clips = (const noh_pack_graph_clip *)(const void *)(chunk + h->clips_offset);
    graph->transitions = (const noh_pack_graph_transition *)(const void *)(chunk + h->transitions_offset);
    graph->points = (const float *)(const void *)(chunk + h->points_offset);
    graph->spaces = (const noh_pack_graph_space *)(const void *)(chunk + h->spaces_offset);
    graph->triangles = chunk + h->triangles_offset;
    graph->params = (const noh_pack_graph_param *)(const void *)(chunk + h->params_offset);
    graph->masks = (const noh_pack_graph_mask *)(const void *)(chunk + h->masks_offset);
    graph->names = (const noh_pack_graph_name *)(const void *)(chunk + h->names_offset);
    return NOH_OK;
}

/* Whether a stored name, given with its hash, is `name`. */
static int is_named(const noh_pack *pack, uint32_t stored, uint32_t stored_hash, const char *name, uint32_t hash)
{
    return stored_hash == hash && noh_names_equal(noh_pack_string(pack, stored), name);
}

uint32_t noh_pack_graph_find(const noh_pack *pack, const char *name)
{
    NOH_ASSERT(pack && name);
    const uint32_t hash = noh_hash_name(name);
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_GRAPH].count; i++) {
        const noh_pack_chunk *c = &pack->chunks[pack->runs[NOH_CHUNK_GRAPH].first + i];
        if (is_named(pack, c->name, c->name_hash, name, hash)) return i;
    }
    return NOH_NONE;
}

/* ---- filling ---- */

static void fill_nodes(const noh_pack_graph *g, noh_graph_node *nodes)
{
    for (uint32_t i = 0; i < g->header->node_count; i++) {
        const noh_pack_graph_node *from = &g->nodes[i];
        noh_graph_node *to = &nodes[i];
        to->kind = from->kind;
        to->first_child = from->first_child;
        to->child_count = from->child_count;
        to->param = from->param;
        to->param_y = from->param_y;
        to->first_item = from->first_item;
        to->item_count = from->item_count;
        to->mask = from->mask;
        to->index = from->index;
        to->curve = from->curve;
        to->flags = from->flags;
        to->value = from->value;
        to->fade_ticks = from->fade_ticks;
        to->fade_out_ticks = from->fade_out_ticks;
    }
}

/* Find reference clips by name. */
static noh_result fill_references(const noh_pack_graph *g, const noh_clip_set *set, noh_graph_node *nodes,
                                  noh_error *error)
{
    for (uint32_t i = 0; i < g->header->node_count; i++) {
        uint32_t clip;
        if (nodes[i].kind != NOH_NODE_ADD || !nodes[i].item_count) continue;
        clip = noh_clip_set_find(set, g->names[g->nodes[i].first_item].name_hash);
        if (clip == NOH_NONE) {
            return noh_fail(error, NOH_ERR_NOT_FOUND,
                            "the set has no clip with the name of an ADD node's reference: add that clip to the set", i,
                            0);
        }
        nodes[i].first_item = (uint16_t)clip;
    }
    return NOH_OK;
}

static noh_result fill_clips(const noh_pack_graph *g, const noh_clip_set *set, noh_track_desc *clips, noh_error *error)
{
    for (uint32_t i = 0; i < g->header->clip_count; i++) {
        const noh_pack_graph_clip *from = &g->clips[i];
        memset(&clips[i], 0, sizeof clips[i]);
        clips[i].clip = noh_clip_set_find(set, from->name_hash);
        clips[i].position_ticks = from->start_tick;
        clips[i].speed = from->speed;
        clips[i].loop = (noh_loop)from->loop;
        clips[i].sync_group = from->sync_group;
        clips[i].flags = from->paused ? NOH_TRACK_PAUSED : 0u;
        if (clips[i].clip == NOH_NONE) {
            return noh_fail(error, NOH_ERR_NOT_FOUND,
                            "the set lacks a clip that the graph plays: noh_graph_pack_clip_name gives its name", i, 0);
        }
    }
    return NOH_OK;
}

static void fill_transitions(const noh_pack_graph *g, noh_graph_transition *transitions)
{
    for (uint32_t i = 0; i < g->header->transition_count; i++) {
        const noh_pack_graph_transition *from = &g->transitions[i];
        noh_graph_transition *to = &transitions[i];
        to->from = from->from;
        to->to = from->to;
        to->condition = from->condition;
        to->param = from->param;
        to->threshold = from->threshold;
        to->duration_ticks = from->duration_ticks;
        to->curve = from->curve;
        to->flags = from->flags;
    }
}

static void fill_spaces(const noh_pack_graph *g, noh_blend_space_2d *spaces)
{
    for (uint32_t i = 0; i < g->header->space_count; i++) {
        spaces[i].point_count = g->spaces[i].point_count;
        spaces[i].triangle_count = g->spaces[i].triangle_count;
        spaces[i].points = g->points + g->spaces[i].first_point;
        spaces[i].triangles = g->triangles + 3u * (size_t)g->spaces[i].first_triangle;
    }
}

/* ---- masks ---- */

static uint32_t find_joint(const noh_graph_pack_desc *desc, const noh_pack *mesh, const char *name)
{
    for (uint32_t j = 0; j < desc->set->joint_count; j++) {
        if (noh_names_equal(noh_pack_joint_name(mesh, desc->skeleton, j), name)) return j;
    }
    return NOH_NONE;
}

static noh_result fill_mask(const noh_pack_graph *g, const noh_graph_pack_desc *desc, const noh_skeleton *skeleton,
                            const noh_pack_graph_mask *m, uint8_t *mask, noh_error *error)
{
    const noh_pack *mesh = desc->mesh ? desc->mesh : desc->pack;
    noh_mask_fill(mask, desc->set->joint_count, 0);
    noh_mask_fill(mask + desc->set->joint_count, desc->set->float_count, m->floats);
    for (uint32_t i = m->first_joint; i < (uint32_t)m->first_joint + m->joint_count; i++) {
        const uint32_t joint = find_joint(desc, mesh, noh_pack_string(g->pack, g->names[i].name));
        if (joint == NOH_NONE) {
            return noh_fail(error, NOH_ERR_NOT_FOUND, "the skeleton lacks a joint that a mask of the graph names", i,
                            0);
        }
        if (g->names[i].subtree) {
            noh_mask_subtree(mask, skeleton, joint, g->names[i].weight);
        } else {
            mask[joint] = g->names[i].weight;
        }
    }
    return NOH_OK;
}

static noh_result fill_masks(const noh_pack_graph *g, const noh_graph_pack_desc *desc, uint8_t *masks, noh_error *error)
{
    const size_t width = (size_t)desc->set->joint_count + desc->set->float_count;
    noh_skeleton skeleton;
    noh_result result = NOH_OK;
    memset(&skeleton, 0, sizeof skeleton);
    if (g->header->mask_count && desc->set->joint_count) {
        result = noh_pack_skeleton_at(desc->mesh ? desc->mesh : desc->pack, desc->skeleton, &skeleton, NULL, error);
    }
    for (uint32_t i = 0; i < g->header->mask_count && !result; i++) {
        result = fill_mask(g, desc, &skeleton, &g->masks[i], masks + i * width, error);
    }
    return result;
}

/* ---- memory ---- */

static noh_result check_desc(const noh_graph_pack_desc *desc, noh_pack_graph *g, noh_error *error)
{
    noh_skeleton skeleton;
    noh_result result;
    const char *excess;
    if (!desc->pack) return noh_fail(error, NOH_ERR_ARG, "pack of a graph is NULL", 0, 0);
    if (!desc->set) return noh_fail(error, NOH_ERR_ARG, "set of a graph is NULL", 0, 0);
    excess = noh_clip_set_excess(desc->set);
    if (excess) return noh_fail(error, NOH_ERR_ARG, excess, 0, 0);
    result = noh_pack_graph_at(desc->pack, desc->graph, g, error);
    if (result != NOH_OK) return result;
    if (!g->header->mask_count || !desc->set->joint_count) return NOH_OK;
    result = noh_pack_skeleton_at(desc->mesh ? desc->mesh : desc->pack, desc->skeleton, &skeleton, NULL, NULL);
    if (result || skeleton.joint_count != desc->set->joint_count) {
        return noh_fail(error, NOH_ERR_ARG,
                        "mesh and skeleton differ from the set's: a graph with masks needs them to find joints by name",
                        desc->skeleton, desc->set->joint_count);
    }
    return NOH_OK;
}

static size_t carve(noh_arena *arena, const noh_pack_graph_header *h, const noh_clip_set *set, parts *p)
{
    const size_t width = (size_t)set->joint_count + set->float_count;
    p->made = noh_arena_carve(arena, sizeof *p->made, 16u);
    p->clips = noh_arena_carve(arena, h->clip_count * sizeof *p->clips, 8u);
    p->spaces = noh_arena_carve(arena, h->space_count * sizeof *p->spaces, 8u);
    p->nodes = noh_arena_carve(arena, h->node_count * sizeof *p->nodes, 4u);
    p->transitions = noh_arena_carve(arena, h->transition_count * sizeof *p->transitions, 4u);
    p->defaults = noh_arena_carve(arena, h->param_count * sizeof *p->defaults, 4u);
    p->masks = noh_arena_carve(arena, h->mask_count * width, 1u);
    return arena->used;
}

size_t noh_graph_pack_size(const noh_graph_pack_desc *desc, noh_error *error)
{
    noh_arena arena = noh_arena_measure();
    noh_pack_graph g;
    parts p;
    NOH_ASSERT(desc);
    return check_desc(desc, &g, error) ? 0u : carve(&arena, g.header, desc->set, &p);
}

/* A node in a pack is its name followed by a noh_graph_node. */
NOH_STATIC_ASSERT(sizeof(noh_pack_graph_node) == 8u + sizeof(noh_graph_node), graph_node_of_pack);
NOH_STATIC_ASSERT(offsetof(noh_pack_graph_node, kind) == 8u, graph_node_kind);
NOH_STATIC_ASSERT(offsetof(noh_pack_graph_node, value) == 8u + offsetof(noh_graph_node, value), graph_node_value);

static int is_inertial(const noh_pack_graph *g)
{
    uint32_t any = 0;
    for (uint32_t i = 0; i < g->header->transition_count; i++) {
        any |= g->transitions[i].flags & NOH_TRANSITION_INERTIAL;
    }
    for (uint32_t i = 0; i < g->header->node_count; i++) {
        any |= g->nodes[i].kind == NOH_NODE_SELECT ? g->nodes[i].flags & NOH_TRANSITION_INERTIAL : 0u;
    }
    return any != 0;
}

noh_result noh_graph_pack_measure(const noh_graph_pack_desc *desc, noh_graph_pack_needs *needs, noh_error *error)
{
    NOH_ASSERT(desc && needs);
    noh_arena arena = noh_arena_measure();
    noh_pack_graph g;
    noh_graph_nodes nodes;
    noh_graph_shape shape;
    parts p;
    const noh_result result = check_desc(desc, &g, error);
    if (result != NOH_OK) {
        return result;
    }
    nodes.first = (const uint8_t *)g.nodes + 8;
    nodes.stride = sizeof *g.nodes;
    nodes.count = g.header->node_count;
    shape.clip_count = g.header->clip_count;
    shape.param_count = g.header->param_count;
    shape.machine_count = g.header->machine_count;
    shape.inertial = is_inertial(&g);
    shape.buffer_count = noh_graph_count_buffers(&nodes, g.children);
    needs->bytes = carve(&arena, g.header, desc->set, &p);
    needs->state_bytes = noh_graph_shape_state_size(&shape, desc->set);
    needs->scratch_bytes = noh_graph_shape_scratch_size(&shape, desc->set);
    return needs->state_bytes && needs->scratch_bytes
               ? NOH_OK
               : noh_fail(error, NOH_ERR_LIMIT, "a graph plays more clips than NOH_TRACKS_MAX", desc->graph,
                          NOH_TRACKS_MAX);
}

/* Everything except the clips and the masks, which may fail. */
static void join(const noh_pack_graph *g, const noh_clip_set *set, const parts *p)
{
    const noh_pack_graph_header *h = g->header;
    noh_graph *graph = &p->made->graph;
    graph->node_count = h->node_count;
    graph->child_count = h->child_count;
    graph->clip_count = h->clip_count;
    graph->machine_count = h->machine_count;
    graph->transition_count = h->transition_count;
    graph->threshold_count = h->point_count;
    graph->space_count = h->space_count;
    graph->param_count = h->param_count;
    graph->nodes = p->nodes;
    graph->children = g->children;
    graph->clips = p->clips;
    graph->transitions = p->transitions;
    graph->thresholds = g->points;
    graph->spaces = p->spaces;
    graph->param_defaults = p->defaults;
    p->made->source = *g;
    p->made->clips = *set;
    if (h->mask_count) {
        p->made->clips.masks = p->masks;
        p->made->clips.mask_count = h->mask_count;
    }
    for (uint32_t i = 0; i < h->param_count; i++) {
        p->defaults[i] = g->params[i].initial;
    }
}

noh_result noh_graph_pack_init(void *memory, size_t bytes, const noh_graph_pack_desc *desc, noh_graph_pack **made,
                               noh_error *error)
{
    noh_arena arena = noh_arena_measure();
    noh_pack_graph g;
    parts p;
    noh_result result;
    NOH_ASSERT(desc && made);
    result = check_desc(desc, &g, error);
    if (!result) result = noh_arena_open(&arena, memory, bytes, carve(&arena, g.header, desc->set, &p), error);
    if (result) return result;
    (void)carve(&arena, g.header, desc->set, &p);
    fill_nodes(&g, p.nodes);
    fill_transitions(&g, p.transitions);
    fill_spaces(&g, p.spaces);
    join(&g, desc->set, &p);
    result = fill_clips(&g, desc->set, p.clips, error);
    if (!result) result = fill_references(&g, desc->set, p.nodes, error);
    if (!result) result = fill_masks(&g, desc, p.masks, error);
    if (!result) result = noh_graph_check(&p.made->graph, &p.made->clips, error);
    if (!result) *made = p.made;
    return result;
}

/* ---- names ---- */

const char *noh_graph_pack_clip_name(const noh_pack_graph *graph, uint32_t clip)
{
    NOH_ASSERT(graph);
    return clip < graph->header->clip_count ? noh_pack_string(graph->pack, graph->clips[clip].name) : "";
}

uint32_t noh_graph_pack_find_param(const noh_graph_pack *made, const char *name)
{
    const noh_pack_graph *g = &made->source;
    const uint32_t hash = noh_hash_name(name);
    for (uint32_t i = 0; i < g->header->param_count; i++) {
        if (is_named(g->pack, g->params[i].name, g->params[i].name_hash, name, hash)) return i;
    }
    return NOH_NONE;
}

uint32_t noh_graph_pack_find_value(const noh_graph_pack *made, uint32_t param, const char *name)
{
    const noh_pack_graph *g = &made->source;
    const uint32_t hash = noh_hash_name(name);
    for (uint32_t i = 0; param < g->header->param_count && i < g->params[param].value_count; i++) {
        const noh_pack_graph_name *value = &g->names[g->params[param].first_value + i];
        if (is_named(g->pack, value->name, value->name_hash, name, hash)) return i;
    }
    return NOH_NONE;
}

uint32_t noh_graph_pack_find_machine(const noh_graph_pack *made, const char *name)
{
    const noh_pack_graph *g = &made->source;
    const uint32_t hash = noh_hash_name(name);
    for (uint32_t i = 0; i < g->header->node_count; i++) {
        const noh_pack_graph_node *n = &g->nodes[i];
        if (n->kind >= NOH_PACK_NODE_MACHINE && n->kind <= NOH_PACK_NODE_ONE_SHOT &&
            is_named(g->pack, n->name, n->name_hash, name, hash))
            return n->index;
    }
    return NOH_NONE;
}

static const noh_pack_graph_node *machine_at(const noh_pack_graph *g, uint32_t machine)
{
    for (uint32_t i = 0; i < g->header->node_count; i++) {
        const noh_pack_graph_node *n = &g->nodes[i];
        if (n->kind >= NOH_PACK_NODE_MACHINE && n->index == machine) return n;
    }
    return NULL;
}

const char *noh_graph_pack_machine_name(const noh_graph_pack *made, uint32_t machine)
{
    const noh_pack_graph_node *n = machine_at(&made->source, machine);
    return n ? noh_pack_string(made->source.pack, n->name) : "";
}

const char *noh_graph_pack_param_name(const noh_graph_pack *made, uint32_t param)
{
    const noh_pack_graph *g = &made->source;
    return param < g->header->param_count ? noh_pack_string(g->pack, g->params[param].name) : "";
}

const char *noh_graph_pack_state_name(const noh_graph_pack *made, uint32_t machine, uint32_t state)
{
    const noh_pack_graph *g = &made->source;
    const noh_pack_graph_node *n = machine_at(g, machine);
    return n && state < n->child_count ? noh_pack_string(g->pack, g->nodes[g->children[n->first_child + state]].name)
                                       : "";
}

noh_result noh_graph_pack_set_param(const noh_graph_pack *made, noh_graph_state *state, uint32_t param, float value)
{
    const noh_pack_graph_param *p = made->source.params + param;
    if (param >= made->source.header->param_count || value - value != 0.0f) {
        return NOH_ERR_ARG;
    }
    value = value < p->minimum ? p->minimum : value > p->maximum ? p->maximum : value;
    if ((p->kind == NOH_PARAM_INTEGER || p->kind == NOH_PARAM_ENUM) && value > -8388608.0f && value < 8388608.0f) {
        value = (float)(int32_t)(value < 0.0f ? value - 0.5f : value + 0.5f); /* larger floats are whole already */
    }
    return noh_graph_set_param(state, param, value);
}
