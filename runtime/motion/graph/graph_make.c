/* graph_make.c: a graph made in code becomes a pack: a string chunk and the chunk of one graph.
 *
 * The same function measures the pack and writes it. Nodes are stored children first, from the root, so the same graph
 * has the same bytes whatever the order of its desc; `noh build --graph` writes its chunks here, too. Only what needs
 * names is checked here: what else a graph must be, the checker of packs says, and its message gets the name of the
 * node. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"
#include "motion/graph/graph_make_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

#define SPEED_ONE 65536
#define HEAD_BYTES (sizeof(noh_pack_header) + 2u * sizeof(noh_pack_chunk))

/* ---- the chunk ---- */

static void put(noh_graph_maker *m, const void *bytes, size_t count)
{
    if (m->chunk && count) memcpy(m->chunk + m->chunk_bytes, bytes, count);
    m->chunk_bytes += (uint32_t)count;
}

static uint32_t begin(noh_graph_maker *m)
{
    return m->chunk_bytes = (m->chunk_bytes + 15u) & ~15u;
}

static uint32_t put_string(noh_graph_maker *m, const char *text)
{
    const uint32_t at = m->string_bytes;
    do {
        if (m->strings) m->strings[m->string_bytes] = *text;
        m->string_bytes++;
    } while (*text++);
    return at;
}

/* A record after the name that it begins with. */
static void put_named(noh_graph_maker *m, void *record, size_t bytes, const char *name)
{
    const uint32_t head[2] = { put_string(m, name), noh_hash_name(name) };
    memcpy(record, head, sizeof head);
    put(m, record, bytes);
}

static const noh_graph_node_desc *node_at(const noh_graph_maker *m, uint32_t i)
{
    return &m->d->nodes[m->order[i]];
}

static int is_reference(const noh_graph_node_desc *n)
{
    return n->kind == NOH_NODE_ADD && n->clip;
}

/* What does not fit in a byte is refused as 255 by the checker. */
static uint8_t byte_of(uint32_t value)
{
    return (uint8_t)(value < 255u ? value : 255u);
}

static void set_items(noh_graph_maker *m, const noh_graph_node_desc *from, noh_pack_graph_node *to, uint32_t *reference)
{
    switch (from->kind) {
    case NOH_NODE_ADD:
        to->item_count = (uint16_t)is_reference(from);
        to->first_item = (uint16_t)(to->item_count ? (*reference)++ : 0u);
        break;
    case NOH_NODE_SPACE_1D:
        to->first_item = (uint16_t)m->h.point_count;
        to->item_count = (uint16_t)from->child_count;
        m->h.point_count += from->child_count;
        break;
    case NOH_NODE_SPACE_2D:
        to->first_item = (uint16_t)m->h.space_count++;
        to->item_count = 1;
        m->h.point_count += 2u * from->child_count;
        break;
    case NOH_NODE_MACHINE:
        to->first_item = (uint16_t)m->h.transition_count;
        to->item_count = (uint16_t)from->transition_count;
        m->h.transition_count += from->transition_count;
        break;
    default: break;
    }
}

static void put_node(noh_graph_maker *m, const noh_graph_node_desc *from, uint32_t *reference)
{
    noh_pack_graph_node to;
    memset(&to, 0, sizeof to);
    to.kind = byte_of((uint32_t)from->kind);
    to.first_child = (uint16_t)m->h.child_count;
    to.child_count = (uint16_t)from->child_count;
    m->h.child_count += from->child_count;
    to.param = noh_graph_number_of(noh_graph_params_of_desc(m->d), from->param);
    to.param_y = noh_graph_number_of(noh_graph_params_of_desc(m->d), from->param_y);
    to.mask = (uint16_t)(from->mask ? noh_graph_number_of(noh_graph_masks_of(m->d), from->mask) + 1u : 0u);
    if (from->kind == NOH_NODE_CLIP) to.index = (uint16_t)m->h.clip_count++;
    if (from->kind >= NOH_NODE_MACHINE) to.index = (uint16_t)m->h.machine_count++;
    to.curve = byte_of((uint32_t)from->curve);
    to.flags = byte_of(from->flags);
    to.value = from->value;
    to.fade_ticks = from->fade_ticks;
    to.fade_out_ticks = from->fade_out_ticks;
    set_items(m, from, &to, reference);
    put_named(m, &to, sizeof to, from->name);
}

static void put_children(noh_graph_maker *m, const noh_graph_node_desc *from)
{
    for (uint32_t i = 0; i < from->child_count; i++) {
        const uint16_t child = noh_graph_number_of(noh_graph_nodes_of(m->d), from->children[i]);
        put(m, &m->place[child % NOH_GRAPH_NODES_MAX], sizeof child);
    }
}

/* Sync groups are numbered in the order of the clips. 0: none; one past the limit is refused by the checker. */
static uint32_t sync_group(const noh_graph_maker *m, uint32_t place)
{
    const char *seen[NOH_SYNC_GROUPS_MAX], *sync = NULL;
    uint32_t count = 0, group = 0;
    for (uint32_t i = 0; i <= place; i++) {
        sync = node_at(m, i)->kind == NOH_NODE_CLIP ? node_at(m, i)->sync : NULL;
        for (group = 0; sync && group < count && !noh_names_equal(seen[group], sync);) group++;
        if (sync && group == count && count < NOH_SYNC_GROUPS_MAX) seen[count++] = sync;
    }
    return sync ? group + 1u : 0;
}

static void put_clip(noh_graph_maker *m, uint32_t place)
{
    const noh_graph_node_desc *from = node_at(m, place);
    noh_pack_graph_clip to;
    memset(&to, 0, sizeof to);
    to.start_tick = from->start_tick;
    to.speed = from->speed ? from->speed : SPEED_ONE;
    to.loop = byte_of((uint32_t)from->loop);
    to.sync_group = (uint8_t)sync_group(m, place);
    to.paused = byte_of(from->paused);
    put_named(m, &to, sizeof to, from->clip ? from->clip : from->name);
}

static void put_transitions(noh_graph_maker *m, const noh_graph_node_desc *machine)
{
    const noh_graph_names states = noh_graph_children_of(machine), params = noh_graph_params_of_desc(m->d);
    for (uint32_t i = 0; i < machine->transition_count; i++) {
        const noh_graph_transition_desc *from = &machine->transitions[i];
        noh_pack_graph_transition to;
        memset(&to, 0, sizeof to);
        to.from = noh_graph_number_of(states, from->from);
        to.to = noh_graph_number_of(states, from->to);
        to.condition = byte_of((uint32_t)from->condition);
        to.param = noh_graph_number_of(params, from->param);
        to.threshold = from->threshold;
        to.duration_ticks = from->duration_ticks;
        to.curve = byte_of((uint32_t)from->curve);
        to.flags = byte_of(from->flags);
        put(m, &to, sizeof to);
    }
}

static uint32_t width_of(const noh_graph_node_desc *n)
{
    return n->kind == NOH_NODE_SPACE_1D ? n->child_count : n->kind == NOH_NODE_SPACE_2D ? 2u * n->child_count : 0u;
}

static uint32_t triangles_of(const noh_graph_node_desc *n, uint8_t triangles[3 * NOH_BLEND_SPACE_TRIANGLES_MAX])
{
    uint32_t count = 0;
    if (n->kind == NOH_NODE_SPACE_2D)
        (void)noh_blend_space_2d_triangulate(n->child_count, n->points, triangles, &count, NULL);
    return count;
}

static void put_spaces(noh_graph_maker *m)
{
    uint8_t triangles[3 * NOH_BLEND_SPACE_TRIANGLES_MAX];
    uint32_t first_point = 0;
    m->h.spaces_offset = begin(m);
    for (uint32_t i = 0; i < m->d->node_count; i++) {
        const noh_graph_node_desc *n = node_at(m, i);
        const uint32_t count = triangles_of(n, triangles);
        const noh_pack_graph_space to = { (uint16_t)first_point, (uint16_t)n->child_count,
                                          (uint16_t)m->h.triangle_count, (uint16_t)count };
        first_point += width_of(n);
        m->h.triangle_count += count;
        if (n->kind == NOH_NODE_SPACE_2D) put(m, &to, sizeof to);
    }
    m->h.triangles_offset = begin(m);
    for (uint32_t i = 0; i < m->d->node_count; i++) {
        const uint32_t count = triangles_of(node_at(m, i), triangles);
        put(m, triangles, 3u * (size_t)count);
    }
}

static void put_param(noh_graph_maker *m, const noh_graph_param_desc *from)
{
    noh_pack_graph_param to;
    memset(&to, 0, sizeof to);
    to.minimum = from->kind < NOH_PARAM_ENUM ? from->minimum : 0.0f;
    to.maximum = from->kind < NOH_PARAM_ENUM    ? from->maximum
                 : from->kind == NOH_PARAM_ENUM ? (float)from->value_count - 1.0f
                                                : 1.0f;
    to.initial = from->initial;
    to.kind = byte_of(from->kind);
    to.first_value = (uint16_t)(from->value_count ? m->h.name_count : 0u);
    to.value_count = (uint16_t)from->value_count;
    m->h.name_count += from->value_count;
    put_named(m, &to, sizeof to, from->name);
}

static void put_mask(noh_graph_maker *m, const noh_graph_mask_desc *from)
{
    noh_pack_graph_mask to;
    memset(&to, 0, sizeof to);
    to.first_joint = (uint16_t)m->h.name_count;
    to.joint_count = (uint16_t)from->joint_count;
    to.floats = from->floats;
    m->h.name_count += from->joint_count;
    put_named(m, &to, sizeof to, from->name);
}

static void put_name(noh_graph_maker *m, const char *name, uint32_t weight, uint32_t subtree)
{
    noh_pack_graph_name to;
    memset(&to, 0, sizeof to);
    to.weight = (uint8_t)weight;
    to.subtree = (uint8_t)subtree;
    put_named(m, &to, sizeof to, name);
}

static void put_tables(noh_graph_maker *m)
{
    const noh_graph_desc *d = m->d;
    m->h.params_offset = begin(m);
    for (uint32_t i = 0; i < d->param_count; i++) put_param(m, &d->params[i]);
    m->h.masks_offset = begin(m);
    for (uint32_t i = 0; i < d->mask_count; i++) put_mask(m, &d->masks[i]);
    m->h.names_offset = begin(m);
    for (uint32_t i = 0; i < d->param_count; i++) {
        for (uint32_t v = 0; v < d->params[i].value_count; v++) put_name(m, d->params[i].values[v], 0, 0);
    }
    for (uint32_t i = 0; i < d->mask_count; i++) {
        for (uint32_t j = 0; j < d->masks[i].joint_count; j++) {
            const noh_graph_joint_desc *joint = &d->masks[i].joints[j];
            put_name(m, joint->joint, joint->weight, joint->subtree);
        }
    }
    for (uint32_t i = 0; i < d->node_count; i++) {
        if (!is_reference(node_at(m, i))) continue;
        put_name(m, node_at(m, i)->clip, 0, 0);
        m->h.name_count++;
    }
}

/* Both chunks: written where m->chunk is set, else measured. References are named behind values and joints. */
static void lay(noh_graph_maker *m)
{
    const uint32_t count = m->d->node_count;
    uint32_t reference = 0;
    memset(&m->h, 0, sizeof m->h);
    m->string_bytes = m->chunk_bytes = 0;
    m->h.node_count = count;
    m->h.param_count = m->d->param_count;
    m->h.mask_count = m->d->mask_count;
    for (uint32_t i = 0; i < m->d->param_count; i++) reference += m->d->params[i].value_count;
    for (uint32_t i = 0; i < m->d->mask_count; i++) reference += m->d->masks[i].joint_count;
    (void)put_string(m, "");
    put(m, &m->h, sizeof m->h);
    m->h.nodes_offset = begin(m);
    for (uint32_t i = 0; i < count; i++) put_node(m, node_at(m, i), &reference);
    m->h.children_offset = begin(m);
    for (uint32_t i = 0; i < count; i++) put_children(m, node_at(m, i));
    m->h.clips_offset = begin(m);
    for (uint32_t i = 0; i < count; i++) {
        if (node_at(m, i)->kind == NOH_NODE_CLIP) put_clip(m, i);
    }
    m->h.transitions_offset = begin(m);
    for (uint32_t i = 0; i < count; i++) put_transitions(m, node_at(m, i));
    m->h.points_offset = begin(m);
    for (uint32_t i = 0; i < count; i++) put(m, node_at(m, i)->points, width_of(node_at(m, i)) * sizeof(float));
    put_spaces(m);
    put_tables(m);
    if (m->chunk) memcpy(m->chunk, &m->h, sizeof m->h);
}

/* ---- the pack ---- */

static size_t padded(size_t bytes)
{
    return (bytes + NOH_PACK_ALIGN - 1u) & ~(size_t)(NOH_PACK_ALIGN - 1u);
}

/* The nodes in the order of the desc, which takes as many bytes as any other. */
static size_t measure(noh_graph_maker *m)
{
    for (uint32_t i = 0; i < m->d->node_count; i++) m->order[i] = (uint16_t)i;
    lay(m);
    (void)put_string(m, m->d->name);
    return padded(HEAD_BYTES) + padded(m->string_bytes) + padded(m->chunk_bytes);
}

static void write(noh_graph_maker *m, uint8_t *to, size_t bytes)
{
    const size_t strings_at = padded(HEAD_BYTES), chunk_at = strings_at + padded(m->string_bytes);
    noh_pack_header h;
    noh_pack_chunk table[2];
    memset(to, 0, bytes);
    memset(&h, 0, sizeof h);
    memset(table, 0, sizeof table);
    m->strings = (char *)to + strings_at;
    m->chunk = to + chunk_at;
    lay(m);
    table[0].type = NOH_TAG_STRINGS;
    table[1].type = NOH_TAG_GRAPH;
    table[0].name_hash = noh_hash_name("");
    table[1].name_hash = noh_hash_name(m->d->name);
    table[1].name = put_string(m, m->d->name);
    table[0].offset = (uint32_t)strings_at;
    table[1].offset = (uint32_t)chunk_at;
    table[0].bytes = m->string_bytes;
    table[1].bytes = m->chunk_bytes;
    for (int i = 0; i < 2; i++) table[i].crc = noh_crc32c(0, to + table[i].offset, table[i].bytes);
    h.magic = NOH_PACK_MAGIC;
    h.version = NOH_PACK_VERSION;
    h.byte_count = (uint32_t)bytes;
    h.chunk_count = 2;
    h.library_version = noh_version_number();
    h.crc = noh_crc32c(noh_crc32c(0, &h, sizeof h), table, sizeof table);
    memcpy(to, &h, sizeof h);
    memcpy(to + sizeof h, table, sizeof table);
}

/* The machine or blend space of a transition or point, by its number. */
static uint32_t owner_of(const noh_graph_maker *m, noh_node_kind kind, uint32_t item)
{
    for (uint32_t i = 0; i < m->d->node_count; i++) {
        const noh_graph_node_desc *n = node_at(m, i);
        const uint32_t count = kind == NOH_NODE_MACHINE ? n->transition_count : width_of(n);
        if (item < count) return m->order[i];
        item -= count;
    }
    return 0;
}

/* What the checker of packs says, with the name of the node, parameter or mask. at: a byte of the chunk. */
static noh_result refuse_record(noh_graph_maker *m, const char *what, uint32_t at)
{
    const noh_pack_graph_header *h = &m->h;
    const uint32_t records[3] = { h->nodes_offset, h->params_offset, h->masks_offset };
    const uint32_t strides[3] = { sizeof(noh_pack_graph_node), sizeof(noh_pack_graph_param),
                                  sizeof(noh_pack_graph_mask) };
    const uint32_t counts[3] = { h->node_count, h->param_count, h->mask_count };
    const noh_graph_names tables[3] = { noh_graph_nodes_of(m->d), noh_graph_params_of_desc(m->d),
                                        noh_graph_masks_of(m->d) };
    uint32_t node = 0;
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t index = at < records[i] ? counts[i] : (at - records[i]) / strides[i];
        if (index >= counts[i]) continue;
        if (i == 0) index = m->order[index];
        return noh_graph_refuse(m, index, noh_graph_name_at(&tables[i], index), what, NULL, NULL);
    }
    if (at >= h->points_offset) {
        node = owner_of(m, NOH_NODE_SPACE_1D, (at - h->points_offset) / (uint32_t)sizeof(float));
    } else if (at >= h->transitions_offset) {
        node = owner_of(m, NOH_NODE_MACHINE,
                        (at - h->transitions_offset) / (uint32_t)sizeof(noh_pack_graph_transition));
    } else if (at >= h->clips_offset) {
        uint32_t clip = (at - h->clips_offset) / (uint32_t)sizeof(noh_pack_graph_clip);
        while (node < h->node_count && (node_at(m, node)->kind != NOH_NODE_CLIP || clip--)) node++;
        node = m->order[node % NOH_GRAPH_NODES_MAX];
    }
    return noh_graph_refuse(m, node, m->d->nodes[node].name, what, NULL, NULL);
}

size_t noh_graph_size(const noh_graph_desc *desc)
{
    noh_graph_maker m;
    uint32_t where;
    NOH_ASSERT(desc);
    memset(&m, 0, sizeof m);
    m.d = desc;
    return noh_graph_bad_desc(desc, &where) ? 0 : measure(&m);
}

noh_result noh_graph_init(void *memory, size_t bytes, const noh_graph_desc *desc, noh_pack *pack, noh_error *error)
{
    noh_arena arena = noh_arena_measure();
    noh_error why = { NOH_OK, "", 0, 0 };
    noh_pack made;
    noh_pack_graph graph;
    noh_result result;
    noh_graph_maker m;
    const char *what;
    uint32_t where;
    NOH_ASSERT(desc && pack);
    what = noh_graph_bad_desc(desc, &where);
    if (what) return noh_fail(error, NOH_ERR_LIMIT, what, where, 0);
    memset(&m, 0, sizeof m);
    m.d = desc;
    m.error = error;
    const size_t need_bytes = measure(&m);
    result = noh_arena_open(&arena, memory, bytes, need_bytes, error);
    if (result) return result;
    m.text = memory;
    m.text_bytes = need_bytes;
    result = noh_graph_link(&m);
    if (result) return result;
    write(&m, memory, need_bytes);
    result = noh_pack_open(memory, need_bytes, &made, error);
    if (result) return result;
    if (noh_pack_graph_at(&made, 0, &graph, &why))
        return refuse_record(&m, why.what, (uint32_t)why.where - made.chunks[1].offset);
    *pack = made;
    return NOH_OK;
}
