/* graph_pack_internal.h: the private part of low_motion.h. */
#ifndef NOH_GRAPH_GRAPH_PACK_INTERNAL_H
#define NOH_GRAPH_GRAPH_PACK_INTERNAL_H

#include "noh/base.h"
#include "noh/graph.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_graph_pack_desc {
    const noh_pack *pack; /* contains the graph; required */
    uint32_t graph;       /* its index there; default 0 */
    /* the clips it plays: &bank->clips, or a set of your own; required. Without a bank, noh_graph_pack_size needs only
     * the counts: noh_clip_bank_needs.shape */
    const noh_clip_set *set;
    /* The skeleton that the set moves, for joint names in masks: a pack, default (NULL) `pack`, and the skeleton's
     * index there. Unused by a graph without masks. */
    const noh_pack *mesh;
    uint32_t skeleton;
} noh_graph_pack_desc;

/* Exact size in bytes; 0 on error.
 * errors  as noh_pack_graph_at; ARG as noh_graph_pack_init */
size_t noh_graph_pack_size(const noh_graph_pack_desc *desc, noh_error *error);

/* Make a graph in memory[bytes], aligned to NOH_MEMORY_ALIGN, and check it (noh_graph_check). The pack's bytes and the
 * set must outlive it.
 * errors  ARG a field of desc, named, a set over the limits, or memory NULL or misaligned; MEMORY need: the bytes;
 *         errors of noh_pack_graph_at; NOT_FOUND the set lacks a named clip (where: its index in source.clips, see
 *         noh_graph_pack_clip_name) or the reference clip of an ADD node (where: the node), or the skeleton lacks a
 *         named joint (where: its index in source.names); DATA a node that these clips do not suit (where: its index),
 *         such as a one-shot whose clip loops; LIMIT more pose buffers than NOH_GRAPH_BUFFERS_MAX */
noh_result noh_graph_pack_init(void *memory, size_t bytes, const noh_graph_pack_desc *desc, noh_graph_pack **made,
                               noh_error *error);

/* Find a parameter by name, for noh_graph_set_param.
 * returns  its index, or NOH_NONE */
uint32_t noh_graph_pack_find_param(const noh_graph_pack *made, const char *name);

/* Get the name of a parameter, or of a machine, select or one-shot; "" past the last. */
const char *noh_graph_pack_param_name(const noh_graph_pack *made, uint32_t param);
const char *noh_graph_pack_machine_name(const noh_graph_pack *made, uint32_t machine);

/* Find a value of an ENUM parameter by name.
 * returns  its number, or NOH_NONE */
uint32_t noh_graph_pack_find_value(const noh_graph_pack *made, uint32_t param, const char *name);

/* Find a machine, select or one-shot by name, for noh_graph_machine_state.
 * returns  its number, or NOH_NONE */
uint32_t noh_graph_pack_find_machine(const noh_graph_pack *made, const char *name);

/* Get the name of a state, numbered as by noh_graph_machine_state; "" if there is no such machine or state. */
const char *noh_graph_pack_state_name(const noh_graph_pack *made, uint32_t machine, uint32_t state);

/* Set a parameter, clamped to its range; whole numbers and ENUM values are rounded. Set a trigger to 1 to fire it;
 * taking it resets it to 0.
 * errors  ARG param (also NOH_NONE), or a value that is not finite */
noh_result noh_graph_pack_set_param(const noh_graph_pack *made, noh_graph_state *state, uint32_t param, float value);

/* Sizes of a graph and its instances, computed from counts before there are clips. */
typedef struct noh_graph_pack_needs {
    size_t bytes;         /* noh_graph_pack_size */
    size_t state_bytes;   /* noh_graph_state_size */
    size_t scratch_bytes; /* noh_graph_scratch_size */
} noh_graph_pack_needs;

/* Get the sizes of a graph and its instances.
 * errors  as noh_graph_pack_size */
noh_result noh_graph_pack_measure(const noh_graph_pack_desc *desc, noh_graph_pack_needs *needs, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
