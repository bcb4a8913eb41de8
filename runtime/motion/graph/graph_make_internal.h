/* graph_make_internal.h (private to graph/): a graph made in code: what checks it and what writes it share. */
#ifndef NOH_GRAPH_GRAPH_MAKE_INTERNAL_H
#define NOH_GRAPH_GRAPH_MAKE_INTERNAL_H

#include <string.h>

#include "core/base/name_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/graph.h"

typedef struct noh_graph_maker {
    const noh_graph_desc *d;
    noh_pack_graph_header h;
    uint16_t order[NOH_GRAPH_NODES_MAX];  /* of the desc's nodes, children first */
    uint16_t place[NOH_GRAPH_NODES_MAX];  /* of each node in `order` */
    uint16_t parent[NOH_GRAPH_NODES_MAX]; /* NOH_GRAPH_NONE: the root */
    char *strings;                        /* NULL: they are counted */
    uint8_t *chunk;                       /* NULL: it is measured */
    uint32_t string_bytes, chunk_bytes;
    char *text; /* for messages; text_bytes may be 0 */
    size_t text_bytes;
    noh_error *error;
} noh_graph_maker;

/* Where names lie: the name is the first field of a record. */
typedef struct noh_graph_names {
    const char *kind;
    const void *records;
    size_t stride;
    uint32_t count;
} noh_graph_names;

static inline const char *noh_graph_name_at(const noh_graph_names *t, uint32_t i)
{
    const char *name;
    memcpy(&name, (const uint8_t *)t->records + i * t->stride, sizeof name);
    return name;
}

static inline uint32_t noh_graph_find(const noh_graph_names *t, const char *name)
{
    for (uint32_t i = 0; i < t->count; i++) {
        if (noh_names_equal(noh_graph_name_at(t, i), name)) return i;
    }
    return NOH_NONE;
}

static inline noh_graph_names noh_graph_nodes_of(const noh_graph_desc *d)
{
    return (noh_graph_names){ "there is no node", d->nodes, sizeof *d->nodes, d->node_count };
}

static inline noh_graph_names noh_graph_params_of_desc(const noh_graph_desc *d)
{
    return (noh_graph_names){ "there is no parameter", d->params, sizeof *d->params, d->param_count };
}

static inline noh_graph_names noh_graph_masks_of(const noh_graph_desc *d)
{
    return (noh_graph_names){ "there is no mask", d->masks, sizeof *d->masks, d->mask_count };
}

static inline noh_graph_names noh_graph_children_of(const noh_graph_node_desc *n)
{
    return (noh_graph_names){ "it has no child", n->children, sizeof *n->children, n->child_count };
}

/* In the pack's numbers; NOH_GRAPH_NONE for NULL, and for a name that is not there. */
static inline uint16_t noh_graph_number_of(noh_graph_names t, const char *name)
{
    return (uint16_t)(name ? noh_graph_find(&t, name) & 0xffffu : NOH_GRAPH_NONE);
}

/* Why a desc cannot be measured, and the node, parameter or mask; NULL: it can. */
const char *noh_graph_bad_desc(const noh_graph_desc *d, uint32_t *where);

/* Resolve all names and order the nodes. */
noh_result noh_graph_link(noh_graph_maker *m);

/* "'OWNER': WHAT 'NAME': ADVICE" in the maker's text; name, advice may be NULL. */
noh_result noh_graph_refuse(noh_graph_maker *m, uint32_t where, const char *owner, const char *what, const char *name,
                            const char *advice);

#endif
