/* graph.h: animation graphs: of a pack, found and read by name, and made in code. noh.h plays them:
 * noh_actor_play_graph. */

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

/* ======== graphs made in code ========
 * What a .graph text says (noh help FORMATS), as structs. Nodes, parameters and masks refer to each other by name. A
 * graph becomes a pack of its own, which goes into noh_kind_desc.clip_packs with the packs of the clips that it
 * plays: from there on nothing tells it from a graph that noh build has made. */

typedef struct noh_graph_param_desc {
    const char *name;          /* required */
    uint32_t kind;             /* NOH_PARAM_*; default (0) NOH_PARAM_NUMBER */
    float minimum, maximum;    /* NUMBER, INTEGER */
    float initial;             /* not TRIGGER */
    const char *const *values; /* ENUM: [value_count] names of the numbers from 0 */
    uint32_t value_count;
} noh_graph_param_desc;

/* Of a MACHINE; tested in their order. */
typedef struct noh_graph_transition_desc {
    const char *from, *to; /* states: names of children; from NULL: any but `to` */
    noh_condition condition;
    const char *param; /* NULL with NOH_WHEN_ENDING */
    float threshold;
    uint32_t duration_ticks; /* default (0) immediate, never inertial */
    noh_curve curve;         /* of a cross-fade */
    uint32_t flags;          /* NOH_TRANSITION_* */
} noh_graph_transition_desc;

/* Fields that a kind does not have are 0. */
typedef struct noh_graph_node_desc {
    const char *name; /* required; a state has the name of its node */
    noh_node_kind kind;
    const char *const
        *children;        /* [child_count] names of nodes; not CLIP. A node is a child of one other; the root, which
                                  * gives the pose, of none */
    uint32_t child_count; /* 1..NOH_GRAPH_CHILDREN_MAX; BLEND, ADD, MASK, ONE_SHOT: 2 */
    const float *points;  /* SPACE_1D: [child_count], increasing; SPACE_2D: [child_count][2] */
    const char *param, *param_y; /* t or x, and y of SPACE_2D; default (NULL) the constant `value` and 0. SELECT,
                                  * ONE_SHOT: required */
    float value;                 /* constant t or x; ONE_SHOT: triggered by a parameter above this */
    const char *mask;            /* MASK: required; ONE_SHOT: default (NULL) everywhere */
    const char *clip;            /* CLIP: default (NULL) `name`; ADD: the reference, default (NULL) the bind pose */
    const char *sync;            /* CLIP: name of its sync group; default (NULL) none */
    int32_t speed;               /* CLIP: 1/65,536; default (0) 65,536 */
    uint32_t start_tick;         /* CLIP */
    noh_loop loop;               /* CLIP: default the clip's own */
    uint32_t paused;             /* CLIP: 1: starts at speed 0 */
    const noh_graph_transition_desc *transitions; /* MACHINE: [transition_count] */
    uint32_t transition_count;
    noh_curve curve;                     /* SELECT, ONE_SHOT */
    uint32_t flags;                      /* SELECT: NOH_TRANSITION_* */
    uint32_t fade_ticks, fade_out_ticks; /* SELECT: fade_ticks; ONE_SHOT: in and out */
} noh_graph_node_desc;

typedef struct noh_graph_joint_desc {
    const char *joint; /* required */
    uint8_t weight;    /* 255: full */
    uint8_t subtree;   /* 1: with all its descendants */
} noh_graph_joint_desc;

/* Joints start at weight 0, then entries apply in order. */
typedef struct noh_graph_mask_desc {
    const char *name; /* required */
    const noh_graph_joint_desc *joints;
    uint32_t joint_count;
    uint8_t floats; /* weight of all floats */
} noh_graph_mask_desc;

typedef struct noh_graph_desc {
    const char *name;                   /* required */
    const noh_graph_node_desc *nodes;   /* [node_count], in any order */
    const noh_graph_param_desc *params; /* [param_count] */
    const noh_graph_mask_desc *masks;   /* [mask_count] */
    uint32_t node_count;                /* 1..NOH_GRAPH_NODES_MAX */
    uint32_t param_count, mask_count;
} noh_graph_desc;

/* Size and make a pack with one graph. The desc may go afterwards; the memory must outlive the pack. Clips and joints
 * are looked up by noh_stage_plan_make and noh_stage_init, with the errors of a graph that noh build made.
 * memory  aligned to NOH_MEMORY_ALIGN; some 60 bytes a node, and all names. The size is 0 where init says LIMIT
 * errors  ARG a field (where: index of the node, parameter or mask; `what` is then text in `memory` that names it);
 *         LIMIT a count, or a name that is missing or too long; MEMORY need: the bytes */
size_t noh_graph_size(const noh_graph_desc *desc);
noh_result noh_graph_init(void *memory, size_t bytes, const noh_graph_desc *desc, noh_pack *pack, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
