/* graph_pack.h: an animation graph out of a pack, played by names.
 *
 * The pack's graph (noh build --graph) names clips, joints, parameters and states. noh_graph_pack_init binds it to a
 * clip set: clips by name, the joints of its masks by name. What it makes is a noh_graph like any other, for any number
 * of instances:
 *
 *   desc.pack = &pack;  desc.set = &bank->clips;
 *   bytes = noh_graph_pack_size(&desc, &error);
 *   noh_graph_pack_init(memory, bytes, &desc, &made, &error);
 *   noh_graph_state_init(..., &made->graph, &made->clips, &state, &error);
 *   noh_graph_pack_set_param(made, state, noh_graph_pack_find_param(made, "speed"), 1.4f);
 *   noh_graph_step(state, &made->graph, &made->clips, ticks, fn, user);
 *   noh_graph_pose(state, &made->graph, &made->clips, &scratch, pose, floats);
 *
 * made->clips is the set with the masks of the graph. To pose on several threads, give each a copy of its view's set
 * (noh_clip_bank_view.clips) with made's `masks` and `mask_count`.
 *
 * Threads: what is made is read-only and shared; filling it reads the pack and the set. */
#ifndef NOH_GRAPH_GRAPH_PACK_H
#define NOH_GRAPH_GRAPH_PACK_H

#include "motion/graph/graph.h"
#include "motion/clip/pack_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A graph in a pack, as pointers into its bytes. */
typedef struct noh_pack_graph {
    const noh_pack *pack;
    const char *name;
    const noh_pack_graph_header *header;
    const noh_pack_graph_node *nodes;             /* [header->node_count] */
    const uint16_t *children;                     /* [header->child_count] */
    const noh_pack_graph_clip *clips;             /* [header->clip_count] */
    const noh_pack_graph_transition *transitions; /* [header->transition_count] */
    const float *points;                          /* [header->point_count] */
    const noh_pack_graph_space *spaces;           /* [header->space_count] */
    const uint8_t *triangles;                     /* [header->triangle_count][3] */
    const noh_pack_graph_param *params;           /* [header->param_count] */
    const noh_pack_graph_mask *masks;             /* [header->mask_count] */
    const noh_pack_graph_name *names;             /* [header->name_count] */
} noh_pack_graph;

/* The n-th graph, checked: as with a compressed clip, noh_pack_open has seen its checksum only.
 * errors  NOT_FOUND  past graph_count (where: the index, need: the count); DATA what is wrong in the chunk (where: the
 *         byte in the pack). *graph is then untouched */
noh_result noh_pack_graph_at(const noh_pack *pack, uint32_t index, noh_pack_graph *graph, noh_error *error);

/* The index of the graph of that name; NOH_NONE when there is none. */
uint32_t noh_pack_graph_find(const noh_pack *pack, const char *name);

typedef struct noh_graph_pack_desc {
    const noh_pack *pack; /* holds the graph; required */
    uint32_t graph;       /* its index there; default 0 */
    /* the clips that it plays: &bank->clips, or a set of your own; required. Before there is a bank,
     * noh_graph_pack_size needs only its counts: those of noh_clip_bank_needs.shape */
    const noh_clip_set *set;
    /* The skeleton that the set moves, for the names of joints in masks: a pack, default (NULL) `pack`, and its index
     * there. Not used by a graph without masks. */
    const noh_pack *mesh;
    uint32_t skeleton;
} noh_graph_pack_desc;

typedef struct noh_graph_pack {
    noh_graph graph;       /* for noh_graph_*, with: */
    noh_clip_set clips;    /* desc.set with the masks of the graph; its own where the graph has none */
    noh_pack_graph source; /* names, in the pack's bytes */
} noh_graph_pack;

/* Exact bytes; 0 on error.
 * errors  those of noh_graph_pack_init that need no clips: ARG, and those of noh_pack_graph_at */
size_t noh_graph_pack_size(const noh_graph_pack_desc *desc, noh_error *error);

/* What a graph and its instances will need, told by counts alone, before there are clips. */
typedef struct noh_graph_pack_needs {
    size_t bytes;         /* noh_graph_pack_size */
    size_t state_bytes;   /* noh_graph_state_size */
    size_t scratch_bytes; /* noh_graph_scratch_size */
} noh_graph_pack_needs;

/* errors  as noh_graph_pack_size */
noh_result noh_graph_pack_measure(const noh_graph_pack_desc *desc, noh_graph_pack_needs *needs, noh_error *error);

/* Make a graph in memory[bytes], aligned to NOH_MEMORY_ALIGN, and check it (noh_graph_check). The pack's bytes and the
 * set must outlive it.
 * errors  ARG a field of desc, named, a set over the limits, or memory NULL or misaligned; MEMORY need: the bytes;
 *         those of noh_pack_graph_at; NOT_FOUND the set has no clip of a name (where: its index in source.clips, see
 *         noh_graph_pack_clip_name), or none that a node adds relative to (where: the node); the skeleton has no joint
 *         of a name (where: its index in source.names); DATA a node that these clips do not suit (where: its index),
 *         such as a one-shot whose clip is a loop; LIMIT more pose buffers than NOH_GRAPH_BUFFERS_MAX */
noh_result noh_graph_pack_init(void *memory, size_t bytes, const noh_graph_pack_desc *desc, noh_graph_pack **made,
                               noh_error *error);

/* ---- names ---- */

/* The index of a parameter, for noh_graph_set_param; NOH_NONE when there is none of that name. */
uint32_t noh_graph_pack_find_param(const noh_graph_pack *made, const char *name);

/* The name of a parameter, and of a machine, select or one-shot; "" past the last. */
const char *noh_graph_pack_param_name(const noh_graph_pack *made, uint32_t param);
const char *noh_graph_pack_machine_name(const noh_graph_pack *made, uint32_t machine);

/* The number of a value of an ENUM parameter; NOH_NONE when it has none of that name. */
uint32_t noh_graph_pack_find_value(const noh_graph_pack *made, uint32_t param, const char *name);

/* The number of a machine, select or one-shot, for noh_graph_machine_state; NOH_NONE when there is none of that name.
 */
uint32_t noh_graph_pack_find_machine(const noh_graph_pack *made, const char *name);

/* The state of a machine, as a child of its node, by the name of the child; NOH_NONE when it has none of that name. */
uint32_t noh_graph_pack_find_state(const noh_graph_pack *made, uint32_t machine, const char *name);

/* The name of a state, as noh_graph_machine_state counts them; "" where there is no such machine or state. */
const char *noh_graph_pack_state_name(const noh_graph_pack *made, uint32_t machine, uint32_t state);

/* The track that plays the clip node of that name, for noh_controller_track and noh_event.track; NOH_NONE when there is
 * none of that name. */
uint32_t noh_graph_pack_find_track(const noh_graph_pack *made, const char *name);

/* The name of the n-th clip of a pack's graph; "" past the last. */
const char *noh_graph_pack_clip_name(const noh_pack_graph *graph, uint32_t clip);

/* Set a parameter within its range: a value outside is held at its end; whole numbers and values of an ENUM are
 * rounded. A trigger is 1 to fire, and 0 again once it is taken.
 * errors  ARG param, NOH_NONE too, or a value that is not finite */
noh_result noh_graph_pack_set_param(const noh_graph_pack *made, noh_graph_state *state, uint32_t param, float value);

#ifdef __cplusplus
}
#endif

#endif
