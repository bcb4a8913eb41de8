/* graph_text.h: animation graphs as text (noh build --graph FILE, noh dump --graph).
 *
 * One statement a line; names with blanks in double quotes; a word that begins with # starts a comment. The form is in
 * `noh help FORMATS`. Statements may come in any order but two: `from` lines follow their machine, `below` and `joint`
 * lines their mask. Each node is the child of one other, except the one that gives the pose.
 *
 *   graph_text_read   a file: every graph in it, checked, linked and laid out
 *   graph_text_bind   its names against the clips and joints of the inputs
 *   graph_text_warn   what waits for an end that never comes */
#ifndef NOH_CONVERT_GRAPH_GRAPH_TEXT_H
#define NOH_CONVERT_GRAPH_GRAPH_TEXT_H

#include "convert/clips/raw_clip.h"
#include "convert/model/model.h"
#include "noh/base.h"
#include "noh/pack.h"

/* A name that another statement defines. */
typedef struct graph_ref {
    const char *name; /* NULL: none */
    uint32_t index;   /* once linked */
    uint32_t line;
} graph_ref;

typedef struct graph_child {
    graph_ref node;
    float at[2]; /* in a blend space */
} graph_child;

typedef struct graph_node {
    const char *name;
    uint32_t line, kind; /* NOH_PACK_NODE_* */
    graph_child children[NOH_GRAPH_CHILDREN_MAX];
    uint32_t child_count;
    graph_ref by[2]; /* parameters; none: `value` */
    float value;
    graph_ref mask;
    uint32_t reference; /* ADD: 1 + index in names of the clip that it adds relative to; 0: the bind pose */
    uint32_t curve, flags, fade_ticks, fade_out_ticks;
    uint32_t first_transition, transition_count;
    const char *clip, *sync;
    int32_t speed;
    uint32_t start_tick, loop, paused;
    uint32_t parent; /* once linked; NOH_NONE in the root */
} graph_node;

typedef struct graph_transition {
    graph_ref from, to, param; /* from.name NULL: any; param.name NULL: ending */
    uint32_t condition, curve, flags, duration_ticks;
    float threshold;
    uint32_t machine; /* node */
} graph_transition;

typedef struct graph_param {
    const char *name;
    uint32_t line, kind; /* NOH_PARAM_* */
    float minimum, maximum, initial;
    uint32_t first_value, value_count; /* in names */
} graph_param;

typedef struct graph_mask {
    const char *name;
    uint32_t line, floats; /* 0..255 */
    uint32_t first_joint, joint_count;
} graph_mask;

typedef struct graph_name {
    const char *name;
    uint32_t line, weight, subtree;
} graph_name;

typedef struct graph_def {
    const char *name;
    uint32_t line;
    uint32_t node_count, transition_count, param_count, mask_count, name_count;
    graph_node nodes[NOH_GRAPH_NODES_MAX];
    graph_transition transitions[NOH_GRAPH_TRANSITIONS_MAX];
    graph_param params[NOH_GRAPH_PARAMS_MAX];
    graph_mask masks[NOH_MASKS_MAX];
    graph_name names[NOH_GRAPH_NAMES_MAX];
    noh_pack pack; /* with this graph alone */
    void *bytes;   /* its */
} graph_def;

#define GRAPHS_MAX 64u /* of one file */

typedef struct graph_file {
    uint32_t count;
    graph_def *graphs[GRAPHS_MAX];
    char **pool; /* [pool_count] all names */
    uint32_t pool_count, pool_room;
} graph_file;

/* 0 and *out, to be freed with graph_text_free; or 1, *error, and *line: where in the file, 0 for the file as a whole.
 */
int graph_text_read(const char *path, graph_file **out, uint32_t *line, model_error *error);
void graph_text_free(graph_file *file);

/* Whether the sets have the clips and joints that the graphs name. 0, or 1, *error and *line. */
int graph_text_bind(const graph_file *file, raw_set *const *sets, uint32_t set_count, uint32_t *line,
                    model_error *error);

/* Warn of transitions `when ending` whose states all loop or stand still, and of one-shots that do. After
 * graph_text_bind. all_loop: every clip is marked as a loop. 0, or 1: out of memory. */
int graph_text_warn(const graph_file *file, raw_set *const *sets, uint32_t set_count, int all_loop, const char *path,
                    model *m);

#endif
