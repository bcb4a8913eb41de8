/* wire_index.c: a mesh's triangles, and the order in which they come to its vertices.
 *
 * Most triangles share an edge with one of the last: that edge is a symbol, and only the third vertex is left, which is
 * a new one, one of the last, or rarely any. Each vertex also records the triangle beyond the edge over which it was
 * reached: the filters of vertices predict from it.
 * source  Gumhold, Strasser: Real time compression of triangle mesh connectivity, 1998; Touma, Gotsman: Triangle mesh
 *         compression, 1998 */
#include "core/wire/wire_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#include <string.h>

#define NO_EDGE 15u
#define MODEL_EDGE 0u  /* by how the triangle before was reached */
#define MODEL_TURN 16u /* which corner is the third */
#define MODEL_WHICH 32u
#define MODEL_NEW 64u
#define MODEL_OLD 80u
#define MODEL_NEXT 96u /* by the one before */

#define WHICH_NEW 0u
#define WHICH_BEHIND 1u
#define WHICH_BEFORE 2u
#define WHICH_RECENT 3u /* and on: the n-th of the last */
#define WHICH_OTHER 15u
#define NEXT_OTHER 15u   /* below it: the next behind one of these */
#define CONTEXT_ALONE 8u /* models of a vertex: 8 by its neighbouring edges, 3 for triangles without an edge */

/* cursor: level, triangle, next vertex that is expected, how the triangle before was reached. */

static uint32_t load_index(const noh_wire_filter *f, uint64_t at)
{
    const uint32_t word = noh_wire_load(f, at);
    const uint8_t *b = f->image + at;
    if (f->mesh.header.index_bytes == 4u) return word;
    return at + 2u <= f->image_bytes ? (uint32_t)b[0] | (uint32_t)b[1] << 8 : 0u;
}

static void store_index(noh_wire_filter *f, uint64_t at, uint32_t index)
{
    uint8_t *b = f->image + at;
    if (noh_wire_writes(f)) return;
    if (f->mesh.header.index_bytes == 4u) {
        noh_wire_store(f, at, index);
    } else if (at + 2u <= f->image_bytes) {
        b[0] = (uint8_t)index;
        b[1] = (uint8_t)(index >> 8);
    }
}

/* An edge that waits for the triangle on its other side. */
static void push_edge(noh_wire_filter *f, uint32_t a, uint32_t b, uint32_t across)
{
    noh_wire_edge before[NOH_WIRE_EDGES]; /* copied twice: compilers make a memmove of a loop */
    memcpy(before, f->edges, sizeof before);
    memcpy(f->edges + 1, before, (NOH_WIRE_EDGES - 1u) * sizeof *before);
    f->edges[0].a = a;
    f->edges[0].b = b;
    f->edges[0].across = across;
}

static void drop_edge(noh_wire_filter *f, uint32_t i)
{
    noh_wire_edge behind[NOH_WIRE_EDGES];
    memcpy(behind, f->edges + i, (NOH_WIRE_EDGES - i) * sizeof *behind);
    memcpy(f->edges + i, behind + 1, (NOH_WIRE_EDGES - 1u - i) * sizeof *behind);
    memset(f->edges + NOH_WIRE_EDGES - 1u, 0xff, sizeof *f->edges);
}

/* The triangle on the other side of the edge from a to b is there. */
static void close_edge(noh_wire_filter *f, uint32_t a, uint32_t b)
{
    if (a < f->mesh.header.vertex_count && f->mesh.ends[a] == b) f->mesh.ends[a] = NOH_NONE;
    if (b < f->mesh.header.vertex_count && f->mesh.starts[b] == a) f->mesh.starts[b] = NOH_NONE;
}

/* Two triangles a, b, c and b, a, across: the last met of the four is predicted from the others. */
static void relate(noh_wire_filter *f, uint32_t a, uint32_t b, uint32_t c, uint32_t across)
{
    const uint32_t *rank = f->mesh.twins, count = f->mesh.header.vertex_count;
    uint32_t last = c, of[3], *more;
    if (a >= count || b >= count || c >= count || across >= count) return;
    if (rank[across] > rank[last]) last = across;
    if (rank[a] > rank[last]) last = a;
    if (rank[b] > rank[last]) last = b;
    of[0] = last == a || last == b ? c : a;
    of[1] = last == a || last == b ? across : b;
    of[2] = last == a ? b : last == b ? a : last == c ? across : c;
    more = f->mesh.more + 6u * (size_t)last;
    if (of[0] == last || of[1] == last || of[2] == last || memcmp(of, f->mesh.around + 3u * (size_t)last, 12u) == 0)
        return;
    memcpy(more[2] == NOH_NONE ? more : more + 3, of, sizeof of);
}

/* A triangle has the edge from a to b: if that was waited for, it is closed; else its other side is waited for. */
static void pass_edge(noh_wire_filter *f, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t count = f->mesh.header.vertex_count;
    const int waited = a < count && f->mesh.ends[a] == b;
    if (waited) {
        relate(f, a, b, c, f->mesh.beyond[a]);
        close_edge(f, a, b);
    }
    for (uint32_t i = 0; i < NOH_WIRE_EDGES; i++) {
        if (f->edges[i].a == a && f->edges[i].b == b) {
            drop_edge(f, i);
            return;
        }
    }
    if (waited || a >= count || b >= count) return;
    f->mesh.ends[b] = a;
    f->mesh.starts[a] = b;
    f->mesh.beyond[b] = c;
    push_edge(f, b, a, c);
}

static void push_recent(noh_wire_filter *f, uint32_t vertex)
{
    uint32_t before[NOH_WIRE_EDGES];
    memcpy(before, f->recent, sizeof before);
    memcpy(f->recent + 1, before, (NOH_WIRE_EDGES - 1u) * sizeof *before);
    f->recent[0] = vertex;
}

/* A vertex that no triangle came to before gets its place in the order. */
static void meet(noh_wire_filter *f, uint32_t vertex, uint32_t a, uint32_t b, uint32_t across)
{
    uint32_t *around = f->mesh.around + 3u * (size_t)vertex;
    if (around[0] != vertex) return; /* its own number: not met */
    if (a == NOH_NONE && f->mesh.order_count) a = f->mesh.order[f->mesh.order_count - 1u];
    around[0] = a;
    around[1] = b;
    around[2] = across;
    f->mesh.next[vertex] = vertex + 1u;
    f->mesh.twins[vertex] = f->mesh.order_count;
    f->mesh.order[f->mesh.order_count++] = vertex;
}

static int is_met(const noh_wire_filter *f, uint32_t vertex)
{
    return f->mesh.around[3u * (size_t)vertex] != vertex;
}

/* The first vertex from v on that no triangle came to; the count of vertices where there is none. */
static uint32_t unmet_from(noh_wire_filter *f, uint32_t v)
{
    uint32_t *next = f->mesh.next;
    if (v >= f->mesh.header.vertex_count) return f->mesh.header.vertex_count;
    while (next[v] != v) {
        next[v] = next[next[v]];
        v = next[v];
    }
    return v;
}

/* Candidates for the third vertex of a triangle: the far ends of the edges next to the shared edge. */
typedef struct third {
    uint32_t behind, before; /* NOH_NONE: no edge is known */
    noh_wire_edge edge;
} third;

static third third_of(const noh_wire_filter *f, const noh_wire_edge *e)
{
    third r = { NOH_NONE, NOH_NONE, *e };
    if (e->b < f->mesh.header.vertex_count) r.behind = f->mesh.ends[e->b];
    if (e->a < f->mesh.header.vertex_count) r.before = f->mesh.starts[e->a];
    return r;
}

static uint32_t which_of(const noh_wire_filter *f, const third *r, uint32_t vertex)
{
    if (!is_met(f, vertex)) return WHICH_NEW;
    if (vertex == r->behind) return WHICH_BEHIND;
    if (vertex == r->before) return WHICH_BEFORE;
    for (uint32_t i = WHICH_RECENT; i < WHICH_OTHER; i++) {
        if (f->recent[i - WHICH_RECENT] == vertex) return i;
    }
    return WHICH_OTHER;
}

/* A vertex that was not met: the next one behind the last new one, or behind one of the edge, or any. */
static uint32_t code_new(noh_wire_filter *f, const third *r, uint32_t vertex)
{
    const uint32_t count = f->mesh.header.vertex_count;
    const uint32_t of[4] = { f->cursor[2], r->edge.a, r->edge.b, r->edge.across };
    uint32_t next[NEXT_OTHER], symbol = NEXT_OTHER;
    for (uint32_t i = NEXT_OTHER; i > 0; i--) {
        const uint32_t from = i <= 4u ? of[i - 1u] : f->recent[i - 5u];
        next[i - 1u] = unmet_from(f, from == NOH_NONE ? 0u : from);
        if (next[i - 1u] == vertex) symbol = i - 1u;
    }
    symbol = noh_wire_symbol(&f->coder, &f->models[MODEL_NEXT + (uint32_t)f->last[1]], symbol);
    f->last[1] = (int32_t)symbol;
    if (symbol < NEXT_OTHER) return next[symbol] < count ? next[symbol] : count - 1u;
    {
        const int32_t off = noh_wire_residual(f, MODEL_NEW, (uint32_t)f->last[0], (int32_t)(vertex - next[0]));
        const uint32_t size = noh_wire_magnitude(off) > 255u ? 255u : noh_wire_magnitude(off);
        f->last[0] = (int32_t)(size + (uint32_t)f->last[0]) / 2;
        vertex = next[0] + (uint32_t)off;
    }
    return vertex < count ? vertex : count - 1u;
}

static uint32_t code_vertex(noh_wire_filter *f, const third *r, uint32_t vertex, uint32_t near, uint32_t context)
{
    const uint32_t count = f->mesh.header.vertex_count;
    const uint32_t which = noh_wire_symbol(&f->coder, &f->models[MODEL_WHICH + context], which_of(f, r, vertex));
    if (which == WHICH_NEW) {
        vertex = code_new(f, r, vertex);
        f->cursor[2] = vertex + 1u;
        return vertex;
    }
    if (which < WHICH_RECENT) {
        vertex = which == WHICH_BEHIND ? r->behind : r->before;
    } else if (which < WHICH_OTHER) {
        vertex = f->recent[which - WHICH_RECENT];
    } else {
        vertex = near + (uint32_t)noh_wire_residual(f, MODEL_OLD, 0, (int32_t)(vertex - near));
    }
    return vertex < count ? vertex : count - 1u;
}

/* Which of the last edges a triangle has, and which of its corners that edge starts at. */
static uint32_t find_edge(const noh_wire_filter *f, const uint32_t t[3], uint32_t *turn)
{
    for (uint32_t i = 0; i < NO_EDGE; i++) {
        for (uint32_t r = 0; r < 3u; r++) {
            if (f->edges[i].a == t[r] && f->edges[i].b == t[(r + 1u) % 3u]) {
                *turn = r;
                return i;
            }
        }
    }
    *turn = 0;
    return NO_EDGE;
}

static void code_alone(noh_wire_filter *f, uint32_t t[3])
{
    third r = { NOH_NONE, NOH_NONE, { NOH_NONE, NOH_NONE, NOH_NONE } };
    for (uint32_t i = 0; i < 3u; i++) {
        t[i] = code_vertex(f, &r, t[i], i ? t[i - 1u] : f->recent[0], CONTEXT_ALONE + i);
        meet(f, t[i], i ? t[0] : NOH_NONE, i > 1u ? t[1] : NOH_NONE, NOH_NONE);
        push_recent(f, t[i]);
        r.edge.a = t[i];
    }
}

static void code_beside(noh_wire_filter *f, uint32_t t[3], uint32_t edge, uint32_t turn)
{
    const noh_wire_edge e = f->edges[edge];
    const uint32_t corner = (turn + 2u) % 3u;
    third r;
    drop_edge(f, edge);
    close_edge(f, e.a, e.b);
    r = third_of(f, &e);
    t[turn] = e.a;
    t[(turn + 1u) % 3u] = e.b;
    t[corner] = code_vertex(f, &r, t[corner], e.b,
                            (edge ? 4u : 0u) + (r.behind != NOH_NONE ? 1u : 0u) + (r.before != NOH_NONE ? 2u : 0u));
    meet(f, t[corner], e.a, e.b, e.across);
    relate(f, e.a, e.b, t[corner], e.across);
    push_recent(f, t[corner]);
}

static void code_triangle(noh_wire_filter *f, uint32_t t[3])
{
    uint32_t turn = 0, edge = noh_wire_writes(f) ? find_edge(f, t, &turn) : 0u;
    edge = noh_wire_symbol(&f->coder, &f->models[MODEL_EDGE + f->cursor[3]], edge);
    if (edge == NO_EDGE) {
        code_alone(f, t);
        pass_edge(f, t[0], t[1], t[2]);
    } else {
        turn = noh_wire_symbol(&f->coder, &f->models[MODEL_TURN + (edge ? 1u : 0u)], turn) % 3u;
        code_beside(f, t, edge, turn);
    }
    pass_edge(f, t[(turn + 2u) % 3u], t[turn], t[(turn + 1u) % 3u]);
    pass_edge(f, t[(turn + 1u) % 3u], t[(turn + 2u) % 3u], t[turn]);
    f->cursor[3] = edge < 4u ? edge : edge == NO_EDGE ? 5u : 4u;
}

/* Vertices of no triangle come last. */
static void meet_rest(noh_wire_filter *f)
{
    for (uint32_t v = 0; v < f->mesh.header.vertex_count; v++) meet(f, v, NOH_NONE, NOH_NONE, NOH_NONE);
}

/* Coarse levels come first, and a finer one goes on in their order. */
int noh_wire_run_indices(noh_wire_filter *f)
{
    const uint32_t count = f->mesh.level_count;
    while (f->cursor[0] < count) {
        const uint64_t header = f->mesh.chunk + (uint64_t)(count - 1u - f->cursor[0]) * sizeof(noh_mesh_header);
        const uint32_t indices = noh_wire_load(f, header + offsetof(noh_mesh_header, index_count));
        const uint64_t at = (uint64_t)f->mesh.chunk +
                            noh_wire_load(f, header + offsetof(noh_mesh_header, indices_offset));
        const uint32_t bytes = f->mesh.header.index_bytes;
        for (; f->cursor[1] < indices / 3u; f->cursor[1]++) {
            const uint64_t to = at + 3u * (uint64_t)f->cursor[1] * bytes;
            uint32_t t[3] = { 0, 0, 0 };
            if (to + 3u * (uint64_t)bytes > f->image_bytes) return noh_wire_wrong(f, "triangles lie outside the pack");
            if (!noh_wire_item(&f->coder)) return 0;
            for (uint32_t i = 0; i < 3u && noh_wire_writes(f); i++) t[i] = load_index(f, to + i * bytes);
            code_triangle(f, t);
            for (uint32_t i = 0; i < 3u; i++) store_index(f, to + i * bytes, t[i]);
        }
        f->cursor[1] = 0;
        f->cursor[0]++;
    }
    meet_rest(f);
    return 1;
}
