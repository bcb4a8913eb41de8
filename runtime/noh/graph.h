/* graph.h: animation graphs of a pack, found and read by name. noh.h plays them: noh_actor_play_graph. */

#ifndef NOH_GRAPH_H
#define NOH_GRAPH_H

#include <stdint.h>

#include "base.h"
#include "format.h"
#include "pack.h"
#include "clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== blend spaces ======== */

typedef struct noh_blend_space_2d {
    uint32_t point_count;     /* 1..NOH_BLEND_SPACE_POINTS_MAX */
    uint32_t triangle_count;  /* 0: one point, or all points on a line */
    const float *points;      /* [point_count][2] */
    const uint8_t *triangles; /* [triangle_count][3], counter-clockwise */
} noh_blend_space_2d;

/* ======== graphs ======== */

#define NOH_GRAPH_NONE 0xffffu

typedef enum noh_node_kind {
    NOH_NODE_CLIP = 0,
    NOH_NODE_BLEND,
    NOH_NODE_ADD,
    NOH_NODE_MASK,
    NOH_NODE_SPACE_1D,
    NOH_NODE_SPACE_2D,
    NOH_NODE_MACHINE,
    NOH_NODE_SELECT,
    NOH_NODE_ONE_SHOT
} noh_node_kind;

typedef enum noh_condition {
    NOH_WHEN_ABOVE = 0, /* param > threshold */
    NOH_WHEN_BELOW,     /* param < threshold */
    NOH_WHEN_TRIGGERED, /* param > threshold; taking the transition sets the parameter to 0 */
    NOH_WHEN_ENDING     /* the state's first clip plays ONCE and ends within the transition's duration, or has ended */
} noh_condition;

#define NOH_TRANSITION_INERTIAL 1u /* switch immediately; the difference decays over the duration */
#define NOH_TRANSITION_KEEP 2u     /* the state's clips continue where they stopped, instead of from the beginning */

typedef struct noh_graph_node {
    uint16_t kind;
    uint16_t first_child, child_count; /* in the graph's children */
    uint16_t param;   /* t, x, SELECT's number or ONE_SHOT's trigger; t and x may be NOH_GRAPH_NONE: `value` */
    uint16_t param_y; /* SPACE_2D */
    /* SPACE_1D: its thresholds, one per child; SPACE_2D: its space; MACHINE: its transitions; ADD: item_count 1: the
     * clip of the set whose first frame is the reference, 0: the bind pose is the reference */
    uint16_t first_item, item_count;
    uint16_t mask; /* MASK, ONE_SHOT: 1 + index in the set's masks; ONE_SHOT also 0: everywhere */
    /* CLIP: its number among the clips; MACHINE, SELECT, ONE_SHOT: its number among nodes of these kinds, in stored
     * order */
    uint16_t index;
    uint8_t curve;           /* SELECT, ONE_SHOT: noh_curve of the fades */
    uint8_t flags;           /* SELECT: NOH_TRANSITION_* */
    float value;             /* constant t or x; ONE_SHOT: triggered by a parameter above this */
    uint32_t fade_ticks;     /* SELECT: duration of a change; ONE_SHOT: of the fade-in. 0: immediate, never inertial */
    uint32_t fade_out_ticks; /* ONE_SHOT */
} noh_graph_node;

/* A transition of a MACHINE. They are tested in stored order, and the first whose condition holds is taken; none is
 * taken during a cross-fade. */
typedef struct noh_graph_transition {
    uint16_t from, to;  /* children of the machine; from NOH_GRAPH_NONE: any child but `to` */
    uint16_t condition; /* noh_condition */
    uint16_t param;     /* not used by ENDING */
    float threshold;
    uint32_t duration_ticks; /* 0: immediate, never inertial */
    uint16_t curve;          /* noh_curve, of a cross-fade */
    uint16_t flags;          /* NOH_TRANSITION_* */
} noh_graph_transition;

/* Shared by all instances; borrowed and constant. */
typedef struct noh_graph {
    uint32_t node_count, child_count, clip_count;
    uint32_t machine_count; /* number of MACHINE, SELECT and ONE_SHOT nodes */
    uint32_t transition_count, threshold_count, space_count, param_count;
    const noh_graph_node *nodes; /* [node_count] */
    const uint16_t *children;    /* [child_count] indices of nodes */
    const noh_track_desc *clips; /* [clip_count]; clip, position, speed, loop, sync group and PAUSED are used */
    const noh_graph_transition *transitions; /* [transition_count] */
    const float *thresholds;                 /* [threshold_count] */
    const noh_blend_space_2d *spaces;        /* [space_count] */
    const float *param_defaults;             /* [param_count]; NULL: all 0 */
} noh_graph;

/* The head of an instance's block. */
typedef struct noh_graph_state {
    uint32_t bytes;
    uint32_t node_count, param_count, machine_count; /* of its graph */
    uint32_t params_offset, machines_offset, controller_offset;
    uint32_t inertia_ticks; /* duration of the inertial transition that begins with the next pose; 0: none */
} noh_graph_state;

/* ======== graphs of a pack ========
 * An animation graph of a pack (noh build --graph). It names clips, joints, parameters and states; noh_actor_play_graph
 * (noh.h) binds it to a stage's clips and plays it.
 *
 * Threads: read-only; any number of threads may share it. */

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

/* Get a graph by index and check it: as with compressed clips, noh_pack_open has only compared its checksum.
 * errors  NOT_FOUND index past the last graph (where: the index, need: the count); DATA a fault in the chunk (where:
 *         the byte in the pack). *graph is then unchanged */
noh_result noh_pack_graph_at(const noh_pack *pack, uint32_t index, noh_pack_graph *graph, noh_error *error);

/* Find a graph by name.
 * returns  its index, or NOH_NONE */
uint32_t noh_pack_graph_find(const noh_pack *pack, const char *name);

/* A graph bound to clips and joints (noh_actor_graph). */
typedef struct noh_graph_pack {
    noh_graph graph;
    noh_clip_set clips;    /* that it plays, with the graph's masks; with their own masks if the graph has none */
    noh_pack_graph source; /* names, in the pack's bytes */
} noh_graph_pack;

/* Get the name of a clip of a pack's graph by index; "" past the last. */
const char *noh_graph_pack_clip_name(const noh_pack_graph *graph, uint32_t clip);

#ifdef __cplusplus
}
#endif

#endif
