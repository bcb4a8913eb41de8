#include "core/base/assert_internal.h"
#include "gl/stage/stage_patch_internal.h"
#include "stage/actors/decal_grow_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"
#include "gl/stage/drawable_internal.h"

#define TRIANGLES_SENT 64u /* uploaded at a time: they are on the stack */
#define TRIANGLES_MAX (1u << 20)

/* The triangles of a decal at a level. */
struct noh_stage_patch {
    noh_decal of;          /* mesh NOH_NONE: nothing has grown. Its age and colour may be out of date */
    uint32_t mesh_level;   /* level of the mesh, as it was drawn */
    uint32_t first, count; /* in the pool, in rising order */
};

/* ---- life cycle ---- */

static size_t carve(noh_stage_patches *p, uint32_t capacity, uint32_t triangles, noh_arena *arena)
{
    const size_t bytes = triangles * sizeof(uint32_t);
    void *sorted = noh_arena_carve(arena, bytes, 16);
    if (p) p->sorted = sorted;
    for (uint32_t i = 0; i < 2; i++) {
        void *patches = noh_arena_carve(arena, capacity * sizeof(noh_stage_patch), 16);
        void *pool = noh_arena_carve(arena, bytes, 16);
        void *numbers = noh_arena_carve(arena, bytes, 16);
        if (p) p->levels[i].patches = patches, p->levels[i].pool = pool, p->levels[i].numbers = numbers;
    }
    return arena->used;
}

static uint32_t capacity_of(uint32_t capacity)
{
    return capacity ? capacity : NOH_DECALS_MAX;
}

static uint32_t triangles_of(uint32_t capacity, uint32_t triangles)
{
    return triangles ? triangles : NOH_DECAL_TRIANGLES * capacity_of(capacity);
}

size_t noh_stage_patches_size(uint32_t capacity, uint32_t triangles)
{
    noh_arena arena = noh_arena_measure();
    NOH_ASSERT(capacity <= NOH_DECALS_MAX && triangles <= TRIANGLES_MAX);
    return carve(NULL, capacity_of(capacity), triangles_of(capacity, triangles), &arena);
}

static void forget(noh_stage_patch_level *level)
{
    level->level = NOH_NONE;
    level->mark_count = level->used = 0;
}

/* Nothing has grown yet. */
static noh_gl_drawable_desc start(noh_stage_patches *p)
{
    p->kind = NOH_NONE;
    for (uint32_t i = 0; i < 2; i++) forget(&p->levels[i]);
    return (noh_gl_drawable_desc){ .texture = { .format = GL_R32UI,
                                                .width = NOH_PATCH_WIDTH,
                                                .height = 2u * NOH_PATCH_ROWS(p->capacity, p->triangle_room) },
                                   .index_bytes = (uint64_t)p->triangle_room * 2u * 3u * sizeof(uint32_t) };
}

noh_result noh_stage_patches_create(noh_stage_decals *decals, uint32_t capacity, uint32_t triangles, void *memory,
                                    size_t bytes, noh_stage_patches *out, noh_error *error)
{
    noh_arena arena;
    noh_result result;
    NOH_ASSERT(decals && decals->drawable.gl && out && capacity <= NOH_DECALS_MAX && triangles <= TRIANGLES_MAX);
    memset(out, 0, sizeof *out);
    result = noh_arena_open(&arena, memory, bytes, noh_stage_patches_size(capacity, triangles), error);
    if (result) return result;
    out->decals = decals;
    out->capacity = capacity_of(capacity);
    out->triangle_room = triangles_of(capacity, triangles);
    carve(out, out->capacity, out->triangle_room, &arena);
    const noh_gl_device device = { decals->drawable.gl, NULL, decals->drawable.ledger, NULL, 0 };
    const noh_gl_drawable_desc desc = start(out);
    return noh_gl_drawable_create(&device, &desc, &out->drawable, error);
}

void noh_stage_patches_delete(noh_stage_patches *patches)
{
    NOH_ASSERT(patches);
    noh_gl_drawable_delete(&patches->drawable);
}

noh_result noh_stage_patches_restore(noh_stage_patches *patches, noh_error *error)
{
    NOH_ASSERT(patches && patches->decals);
    const noh_gl_drawable_desc desc = start(patches);
    return noh_gl_drawable_restore(&patches->drawable, &desc, NULL, 0, error);
}

/* ---- growing ---- */

static int is_same_mark(const noh_decal *a, const noh_decal *b)
{
    return a->mesh == b->mesh && a->size == b->size && memcmp(a->centre, b->centre, sizeof a->centre) == 0 &&
           memcmp(a->normal, b->normal, sizeof a->normal) == 0;
}

/* A level, and the other one that is kept. */
typedef struct growth {
    noh_stage_patches *p;
    noh_stage_patch_level *to, *other;
    const noh_gl_alone *alone;
    const noh_decals *ring;
} growth;

static int has_grown(const growth *g, uint32_t mark, const noh_mesh *mesh)
{
    const noh_stage_patch *patch = &g->to->patches[mark];
    return is_same_mark(&patch->of, &g->ring->decals[mark]) && patch->mesh_level == mesh->header->level;
}

static void sort(uint32_t *values, uint32_t count)
{
    uint32_t gap = 1;
    while (gap < count / 3u) gap = 3u * gap + 1u;
    for (; gap > 0; gap /= 3u) {
        for (uint32_t i = gap; i < count; i++) {
            const uint32_t value = values[i];
            uint32_t at = i;
            for (; at >= gap && values[at - gap] > value; at -= gap) values[at] = values[at - gap];
            values[at] = value;
        }
    }
}

/* The triangle to grow from, found by the patch at the other level if there is one. */
static uint32_t first_triangle(const growth *g, uint32_t mark, uint32_t item, const noh_mesh *mesh)
{
    const noh_decal *decal = &g->ring->decals[mark];
    const noh_stage_patch *at_other = &g->other->patches[mark];
    if (g->other->level != NOH_NONE && is_same_mark(&at_other->of, decal)) {
        const noh_mesh before = noh_gl_alone_level(g->alone, item, g->other->level);
        const noh_decal_patch patch = { g->other->pool + at_other->first, at_other->count, at_other->count, 0, 0 };
        if (before.header->level == at_other->mesh_level) return noh_decal_again(decal, &patch, &before, mesh);
    }
    return NOH_NONE;
}

static void grow(const growth *g, uint32_t mark, uint32_t item, const noh_mesh *mesh)
{
    noh_stage_patch *grown = &g->to->patches[mark];
    noh_decal_patch patch;
    memset(&patch, 0, sizeof patch);
    patch.triangles = g->to->pool + g->to->used;
    patch.room = g->p->triangle_room - g->to->used;
    noh_decal_grow(&g->ring->decals[mark], mesh, first_triangle(g, mark, item, mesh), &patch);
    sort(patch.triangles, patch.count);
    grown->of = g->ring->decals[mark];
    grown->mesh_level = mesh->header->level;
    grown->first = g->to->used;
    grown->count = patch.count;
    g->to->used += patch.count;
    g->p->grown++;
    g->p->left_out += patch.left_out;
}

/* Forget patches whose decals are gone, so that they do not reappear if the same decal is struck again. */
static void forget_others(const growth *g)
{
    for (uint32_t i = 0; i < g->p->capacity; i++) {
        noh_decal *of = &g->to->patches[i].of;
        if (i >= g->ring->capacity || !is_same_mark(of, &g->ring->decals[i])) of->mesh = NOH_NONE;
    }
}

/* Keep only the patches of present decals in the pool. */
static void compact(const growth *g)
{
    uint32_t from = 0;
    forget_others(g);
    g->to->used = 0;
    for (;;) {
        noh_stage_patch *next = NULL;
        for (uint32_t i = 0; i < g->p->capacity; i++) {
            noh_stage_patch *patch = &g->to->patches[i];
            if (patch->of.mesh == NOH_NONE || patch->first < from || !patch->count) continue;
            if (!next || patch->first < next->first) next = patch;
        }
        if (!next) break;
        from = next->first + next->count;
        for (uint32_t i = 0; i < next->count; i++) g->to->pool[g->to->used + i] = g->to->pool[next->first + i];
        next->first = g->to->used;
        g->to->used += next->count;
    }
}

/* ---- index buffer and corners ---- */

/* Merge two rising lists, without duplicates, into the first one, which has room for both. */
static uint32_t merge(uint32_t *numbers, uint32_t count, const uint32_t *more, uint32_t more_count)
{
    uint32_t common = 0, at = 0, total;
    for (uint32_t i = 0; i < more_count; i++) {
        while (at < count && numbers[at] < more[i]) at++;
        common += at < count && numbers[at] == more[i];
    }
    total = count + more_count - common;
    for (uint32_t to = total; to > 0;) {
        const int take = !more_count || (count && numbers[count - 1u] >= more[more_count - 1u]);
        if (take && more_count && numbers[count - 1u] == more[more_count - 1u]) more_count--;
        to--;
        numbers[to] = take ? numbers[--count] : more[--more_count];
    }
    return total;
}

/* The texture of corners of a level, sent row by row. */
typedef struct table {
    const growth *g;
    uint32_t row[NOH_PATCH_WIDTH];
    uint32_t at;
} table;

static void send_row(const table *t)
{
    const noh_stage_patches *p = t->g->p;
    const uint32_t level = (uint32_t)(t->g->to - p->levels);
    const uint32_t y = level * NOH_PATCH_ROWS(p->capacity, p->triangle_room) + (t->at - 1u) / NOH_PATCH_WIDTH;
    noh_gl_pixels kept;
    noh_gl_unpack_begin(p->drawable.gl, &kept);
    p->drawable.gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)y, NOH_PATCH_WIDTH, 1, GL_RED_INTEGER, GL_UNSIGNED_INT,
                                  t->row);
    noh_gl_unpack_end(p->drawable.gl, &kept);
}

static void put(table *t, uint32_t value)
{
    t->row[t->at++ % NOH_PATCH_WIDTH] = value;
    if (t->at % NOH_PATCH_WIDTH == 0) send_row(t);
}

/* For the decals of one mesh: the last corners of their triangles, by which fragments identify triangles. */
static void put_corners(table *t, uint32_t item, uint32_t first, uint32_t count)
{
    const growth *g = t->g;
    const noh_mesh mesh = noh_gl_alone_level(g->alone, item, g->to->level);
    for (uint32_t i = first; i < first + count; i++) {
        const noh_stage_patch *patch = &g->to->patches[g->to->marks[i]];
        for (uint32_t k = 0; k < patch->count; k++) {
            g->p->sorted[k] = noh_mesh_index(&mesh, 3u * g->to->pool[patch->first + k] + 2u);
        }
        sort(g->p->sorted, patch->count);
        for (uint32_t k = 0; k < patch->count; k++) put(t, g->p->sorted[k]);
    }
}

static void send_corners(const growth *g)
{
    const uint32_t level = (uint32_t)(g->to - g->p->levels);
    uint32_t begin = level * NOH_PATCH_ROWS(g->p->capacity, g->p->triangle_room) * NOH_PATCH_WIDTH;
    uint32_t mark = 0;
    table t;
    t.g = g;
    t.at = 0;
    g->p->drawable.gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER + 2u);
    g->p->drawable.gl->BindTexture(GL_TEXTURE_2D, g->p->drawable.texture.name);
    begin += g->p->capacity + 1u;
    for (uint32_t i = 0; i <= g->p->capacity; i++) {
        put(&t, begin);
        if (i < g->to->mark_count) begin += g->to->patches[g->to->marks[i]].count;
    }
    for (uint32_t m = 0; m < g->alone->mesh_count && mark < g->to->mark_count; m++) {
        const uint32_t first = mark;
        while (mark < g->to->mark_count && g->ring->decals[g->to->marks[mark]].mesh == noh_gl_alone_mesh(g->alone, m)) {
            mark++;
        }
        put_corners(&t, m, first, mark - first);
    }
    while (t.at % NOH_PATCH_WIDTH) put(&t, UINT32_MAX);
}

/* With vertex array 0 bound, so that the arrays of meshes keep their index buffers. */
static void send_indices(const growth *g, const noh_mesh *mesh, uint32_t first, uint32_t count)
{
    const noh_gl_api *gl = g->p->drawable.gl;
    const uint64_t begin = (uint64_t)(g->to - g->p->levels) * g->p->triangle_room + first;
    uint32_t indices[3u * TRIANGLES_SENT];
    gl->BindVertexArray(0);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, g->p->drawable.buffer.name);
    for (uint32_t sent = 0; sent < count; sent += TRIANGLES_SENT) {
        const uint32_t now = count - sent < TRIANGLES_SENT ? count - sent : TRIANGLES_SENT;
        for (uint32_t i = 0; i < 3u * now; i++) {
            indices[i] = noh_mesh_index(mesh, 3u * g->to->numbers[first + sent + i / 3u] + i % 3u);
        }
        gl->BufferSubData(GL_ELEMENT_ARRAY_BUFFER, (GLintptr)(12u * (begin + sent)), (GLsizeiptr)(12u * now), indices);
    }
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}

/* Append the decals of one mesh. first: index in the numbers of the level. Returns the number of triangles. */
static uint32_t add_mesh(const growth *g, uint32_t item, const uint8_t *marks, uint32_t count, uint32_t first)
{
    const noh_mesh mesh = noh_gl_alone_level(g->alone, item, g->to->level);
    const uint32_t at = g->to->mark_count;
    uint32_t total = 0;
    for (uint32_t i = 0; i < count; i++) {
        const noh_stage_patch *patch = &g->to->patches[marks[i]];
        if (!has_grown(g, marks[i], &mesh)) grow(g, marks[i], item, &mesh);
        total = merge(g->to->numbers + first, total, g->to->pool + patch->first, patch->count);
        g->to->marks[at + i] = marks[i];
        g->to->counts[at + i] = 0;
    }
    g->to->counts[at] = total;
    g->to->mark_count += count;
    send_indices(g, &mesh, first, total);
    return total;
}

/* Whether an earlier node draws the same mesh of the pack, so that its decals are already in the buffer. */
static int came_before(const noh_gl_alone *alone, uint32_t item)
{
    for (uint32_t i = 0; i < item; i++) {
        if (noh_gl_alone_mesh(alone, i) == noh_gl_alone_mesh(alone, item)) return 1;
    }
    return 0;
}

/* Whether the buffer has everything to draw. */
static int is_current(const growth *g)
{
    uint8_t marks[NOH_DECALS_MAX];
    uint32_t at = 0;
    for (uint32_t m = 0; m < g->alone->mesh_count; m++) {
        const uint32_t count = came_before(g->alone, m)
                                   ? 0
                                   : noh_gl_decals_of(g->ring, noh_gl_alone_mesh(g->alone, m), marks);
        noh_mesh mesh;
        if (!count) continue;
        mesh = noh_gl_alone_level(g->alone, m, g->to->level);
        if (at + count > g->to->mark_count || memcmp(marks, g->to->marks + at, count) != 0) return 0;
        for (uint32_t i = 0; i < count; i++) {
            if (!has_grown(g, marks[i], &mesh)) return 0;
        }
        at += count;
    }
    return at == g->to->mark_count;
}

static void make_current(const growth *g)
{
    uint32_t first = 0;
    compact(g);
    g->to->mark_count = 0;
    for (uint32_t m = 0; m < g->alone->mesh_count; m++) {
        uint8_t marks[NOH_DECALS_MAX];
        const uint32_t count = noh_gl_decals_of(g->ring, noh_gl_alone_mesh(g->alone, m), marks);
        if (count && !came_before(g->alone, m)) first += add_mesh(g, m, marks, count, first);
    }
    send_corners(g);
}

/* The index in levels[] for a level of the actor. The level drawn last is not replaced. */
static uint32_t place_of(noh_stage_patches *p, uint32_t level)
{
    uint32_t at = p->levels[0].level == level ? 0u : 1u;
    if (p->levels[at].level != level) {
        at = 1u - p->last;
        forget(&p->levels[at]);
        for (uint32_t i = 0; i < p->capacity; i++) p->levels[at].patches[i].of.mesh = NOH_NONE;
        p->levels[at].level = level;
    }
    p->last = at;
    return at;
}

void noh_gl_patches_begin(noh_stage_patches *patches, const noh_gl_alone *alone)
{
    const uint32_t kind = (uint32_t)(alone->drawing.k - alone->drawing.s->kinds);
    if (patches->kind != kind) {
        for (uint32_t i = 0; i < 2; i++) forget(&patches->levels[i]);
    }
    patches->kind = kind;
}

int noh_gl_patches_grow(noh_stage_patches *patches, const noh_gl_alone *alone, uint32_t mesh, uint32_t level,
                        const noh_decals *ring, noh_gl_triangles *out, uint32_t *row)
{
    const uint32_t at = place_of(patches, level), number = noh_gl_alone_mesh(alone, mesh);
    noh_stage_patch_level *to = &patches->levels[at];
    const growth g = { patches, to, &patches->levels[1u - at], alone, ring };
    uint32_t mark = 0, first = 0;
    if (!is_current(&g)) make_current(&g);
    while (mark < to->mark_count && ring->decals[to->marks[mark]].mesh != number) first += to->counts[mark++];
    if (mark == to->mark_count || !to->counts[mark]) return 0;
    out->buffer = patches->drawable.buffer.name;
    out->first = at * patches->triangle_room + first;
    out->numbers = to->numbers + first;
    out->count = to->counts[mark];
    *row = at * NOH_PATCH_ROWS(patches->capacity, patches->triangle_room) * NOH_PATCH_WIDTH + mark;
    return 1;
}

noh_result noh_stage_patches_draw(noh_stage_patches *patches, uint32_t view, noh_actor actor, const noh_decals *ring,
                                  noh_error *error)
{
    NOH_ASSERT(patches && patches->decals && patches->drawable.buffer.name && ring &&
               ring->capacity <= patches->capacity);
    return noh_gl_decals_draw(patches->decals, patches, view, actor, ring, error);
}
