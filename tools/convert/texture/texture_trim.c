#include "texture_trim.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "level_corners.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"

#define CELLS_MAX 64u          /* columns, and rows: bits of a word */
#define MARGIN_TEXELS 4.0      /* of the smallest map */
#define MARGIN_SHARE 0.0078125 /* of a side */
#define FAR 1e4                /* texture coordinates beyond it have no texels to speak of */

/* Materials and textures that lose the same parts. */
typedef struct trim_group {
    uint32_t cells[2];  /* columns and rows; 1: the axis stays whole */
    uint64_t used[2];   /* bit i: a triangle comes near the i-th */
    uint32_t side[2];   /* the smallest among the maps */
    uint8_t bounded[2]; /* a map does not repeat on this axis */
} trim_group;

typedef struct trim {
    model *m;
    const mesh_levels *levels;
    uint32_t *group_of; /* [material_count + texture_count] links to the representative of the group */
    trim_group *groups; /* likewise */
} trim;

/* ---- textures that are trimmed together ---- */

static uint32_t find(const trim *t, uint32_t i)
{
    while (t->group_of[i] != i) {
        t->group_of[i] = t->group_of[t->group_of[i]];
        i = t->group_of[i];
    }
    return i;
}

static void join(trim *t, uint32_t a, uint32_t b)
{
    t->group_of[find(t, a)] = find(t, b);
}

/* It is read by normals, not by texture coordinates. */
static uint32_t matcap_of(const model_material *m)
{
    return m->surface == NOH_SURFACE_TOON ? m->more_textures[NOH_TOON_MATCAP] : MODEL_NONE;
}

static void join_maps(trim *t)
{
    const uint32_t first = t->m->material_count;
    for (uint32_t i = 0; i < t->m->material_count; i++) {
        model_material *own = &t->m->materials[i];
        uint32_t *maps[MODEL_MAPS];
        model_maps(own, maps);
        for (uint32_t k = 0; k < MODEL_MAPS; k++) {
            const int is_matcap = own->surface == NOH_SURFACE_TOON && maps[k] == &own->more_textures[NOH_TOON_MATCAP];
            if (!is_matcap && *maps[k] < t->m->texture_count) join(t, i, first + *maps[k]);
        }
    }
    for (uint32_t i = 0; i < t->m->texture_count; i++) {
        for (uint32_t k = 0; k < t->m->texture_count; k++) {
            if (model_replaces_texture(&t->m->textures[k], &t->m->textures[i])) join(t, first + i, first + k);
        }
    }
}

static const mesh_levels *levels_of(const trim *t, uint32_t mesh)
{
    return t->levels ? &t->levels[mesh] : NULL;
}

/* Materials that have a vertex in common. */
static int join_vertices(trim *t, uint32_t mesh)
{
    const model_mesh *of = &t->m->meshes[mesh];
    uint32_t *owner = malloc(((size_t)of->vertex_count + 1u) * sizeof *owner);
    if (!owner) return 1;
    memset(owner, 0xff, (size_t)of->vertex_count * sizeof *owner);
    for (uint32_t s = 0; s < of->submesh_count; s++) {
        const uint32_t material = of->submeshes[s].material;
        for (uint32_t level = 0; material != MODEL_NONE && level < level_count_of(levels_of(t, mesh)); level++) {
            const level_corners c = level_corners_of(of, levels_of(t, mesh), level, s);
            for (uint32_t i = 0; i < c.count; i++) {
                uint32_t *had = &owner[c.vertices[i]];
                if (*had != MODEL_NONE && *had != material) join(t, *had, material);
                *had = material;
            }
        }
    }
    free(owner);
    return 0;
}

/* ---- columns and rows ---- */

static void keep_whole(trim *t, uint32_t material)
{
    trim_group *g = &t->groups[find(t, material)];
    g->cells[0] = g->cells[1] = 1;
}

/* Its sides as they are stored. */
static void stored_sides(const model_texture *t, uint32_t side[2])
{
    const uint32_t most = t->size_max && t->size_max < NOH_TEXTURE_SIZE_MAX ? t->size_max : NOH_TEXTURE_SIZE_MAX;
    side[0] = t->width;
    side[1] = t->height;
    while (side[0] > most || side[1] > most) {
        for (int axis = 0; axis < 2; axis++) side[axis] = side[axis] > 1u ? side[axis] / 2u : 1u;
    }
}

static uint32_t common_divisor(uint32_t a, uint32_t b)
{
    while (b) {
        const uint32_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* A group's maps are to be divided into whole blocks: `cells` takes what their sides have in common, in blocks. */
static void measure_map(trim *t, uint32_t texture)
{
    const model_texture *map = &t->m->textures[texture];
    const uint32_t wrap[2] = { map->wrap_s, map->wrap_t };
    trim_group *g = &t->groups[find(t, t->m->material_count + texture)];
    uint32_t side[2];
    stored_sides(map, side);
    for (int axis = 0; axis < 2; axis++) {
        const int is_of_blocks = side[axis] % 4u == 0 && (map->mag_filter != 9728 || map->use == MODEL_TEXTURE_CODES);
        g->cells[axis] = is_of_blocks ? common_divisor(side[axis] / 4u, g->cells[axis]) : 1;
        g->side[axis] = side[axis] < g->side[axis] ? side[axis] : g->side[axis];
        if (wrap[axis] == 33071 || wrap[axis] == 33648) g->bounded[axis] = 1;
    }
}

static void measure_groups(trim *t)
{
    const uint32_t count = t->m->material_count + t->m->texture_count;
    for (uint32_t i = 0; i < count; i++) {
        t->groups[i] = (trim_group){ { 0, 0 }, { 0, 0 }, { NOH_TEXTURE_SIZE_MAX, NOH_TEXTURE_SIZE_MAX }, { 0, 0 } };
    }
    for (uint32_t i = 0; i < t->m->texture_count; i++) measure_map(t, i);
    for (uint32_t i = 0; i < count; i++) {
        for (int axis = 0; axis < 2; axis++) {
            const uint32_t blocks = t->groups[i].cells[axis];
            uint32_t cells = blocks < CELLS_MAX ? blocks : CELLS_MAX;
            while (cells > 1u && blocks % cells != 0) cells--;
            t->groups[i].cells[axis] = cells > 1u ? cells : 1u;
        }
    }
}

/* The range that a triangle reads on one axis, from `low` to `high`. Beyond 0..1 it wraps around. */
static void use(trim_group *g, int axis, double low, double high)
{
    const double cells = g->cells[axis], texels = MARGIN_TEXELS / g->side[axis];
    const double margin = texels > MARGIN_SHARE ? texels : MARGIN_SHARE;
    if (g->bounded[axis] && (low < 0.0 || high > 1.0)) g->cells[axis] = 1;
    if (g->cells[axis] < 2u) return;
    if (high - low + 2.0 * margin >= 1.0) {
        g->used[axis] = UINT64_MAX;
        return;
    }
    const int64_t first = (int64_t)floor((low - margin) * cells), last = (int64_t)floor((high + margin) * cells);
    for (int64_t i = first; i <= last; i++) {
        const int64_t in = i % (int64_t)g->cells[axis];
        g->used[axis] |= (uint64_t)1 << (in < 0 ? in + (int64_t)g->cells[axis] : in);
    }
}

static void use_triangle(trim_group *g, const float *uv, const uint32_t *corner)
{
    for (int axis = 0; axis < 2; axis++) {
        double low = FAR, high = -FAR;
        for (int k = 0; k < 3; k++) {
            const double at = (double)uv[2 * (size_t)corner[k] + (size_t)axis];
            if (!(at > -FAR && at < FAR)) g->cells[axis] = 1; /* or no number at all */
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
        use(g, axis, low, high);
    }
}

static void use_mesh(trim *t, uint32_t mesh)
{
    const model_mesh *of = &t->m->meshes[mesh];
    const int is_still = of->uv && !model_moves_uv(of);
    for (uint32_t s = 0; s < of->submesh_count; s++) {
        const uint32_t material = of->submeshes[s].material;
        if (material == MODEL_NONE) continue;
        const uint32_t matcap = matcap_of(&t->m->materials[material]);
        if (matcap < t->m->texture_count) keep_whole(t, t->m->material_count + matcap);
        if (!is_still || t->m->materials[material].surface == NOH_SURFACE_EYE) {
            keep_whole(t, material);
            continue;
        }
        for (uint32_t level = 0; level < level_count_of(levels_of(t, mesh)); level++) {
            const level_corners c = level_corners_of(of, levels_of(t, mesh), level, s);
            for (uint32_t i = 0; i + 2u < c.count; i += 3u) {
                use_triangle(&t->groups[find(t, material)], of->uv, c.vertices + i);
            }
        }
    }
}

static uint32_t bits_of(uint64_t word)
{
    uint32_t count = 0;
    for (; word; word &= word - 1u) count++;
    return count;
}

static uint64_t all_of(uint32_t cells)
{
    return cells < 64u ? ((uint64_t)1 << cells) - 1u : UINT64_MAX;
}

/* The smallest gain. */
static void settle(trim_group *g)
{
    uint32_t kept = 1, whole = 1;
    for (int axis = 0; axis < 2; axis++) {
        g->used[axis] &= all_of(g->cells[axis]);
        if (g->cells[axis] < 2u || !g->used[axis]) g->used[axis] = all_of(g->cells[axis]);
        kept *= bits_of(g->used[axis]);
        whole *= g->cells[axis];
    }
    for (int axis = 0; axis < 2; axis++) {
        if (kept * 16u > whole * 15u || g->used[axis] == all_of(g->cells[axis])) g->cells[axis] = 1;
    }
}

/* ---- what changes ---- */

static float moved(float at, uint32_t cells, uint64_t kept)
{
    const double turn = floor((double)at), in = ((double)at - turn) * cells;
    const uint32_t cell = in < cells ? (uint32_t)in : cells - 1u;
    const uint32_t gone = cell - bits_of(kept & all_of(cell));
    return (float)(turn + (in - gone) / bits_of(kept));
}

static void move_corners(const trim_group *g, level_corners c, float *uv, uint8_t *done)
{
    for (uint32_t i = 0; i < c.count; i++) {
        const uint32_t v = c.vertices[i];
        for (size_t axis = 0; axis < 2 && !done[v]; axis++) {
            float *at = uv + 2 * (size_t)v + axis;
            if (g->cells[axis] > 1u) *at = moved(*at, g->cells[axis], g->used[axis]);
        }
        done[v] = 1;
    }
}

static void move_mesh(const trim *t, uint32_t mesh, uint8_t *done)
{
    const model_mesh *of = &t->m->meshes[mesh];
    for (uint32_t s = 0; s < of->submesh_count; s++) {
        const uint32_t material = of->submeshes[s].material;
        if (material == MODEL_NONE || !of->uv) continue;
        for (uint32_t level = 0; level < level_count_of(levels_of(t, mesh));
             level++) { /* some have vertices of their own */
            move_corners(&t->groups[find(t, material)], level_corners_of(of, levels_of(t, mesh), level, s), of->uv,
                         done);
        }
    }
}

static void set_texture(const trim *t, uint32_t texture, texture_trimmed *done)
{
    model_texture *to = &t->m->textures[texture];
    const trim_group *g = &t->groups[find(t, t->m->material_count + texture)];
    uint64_t texels = 1, whole = 1;
    uint32_t side[2];
    stored_sides(to, side);
    for (int axis = 0; axis < 2; axis++) {
        to->cells[axis] = g->cells[axis] > 1u ? g->cells[axis] : 0;
        to->kept[axis] = g->cells[axis] > 1u ? g->used[axis] : 0;
        texels *= to->cells[axis] ? side[axis] / to->cells[axis] * bits_of(to->kept[axis]) : side[axis];
        whole *= side[axis];
    }
    if (texels == whole) return;
    done->count++;
    done->texels += texels;
    done->whole += whole;
}

static uint32_t most_vertices(const model *m)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (m->meshes[i].vertex_count > most) most = m->meshes[i].vertex_count;
    }
    return most;
}

static int trim_groups(trim *t, uint8_t *moved_yet, texture_trimmed *done)
{
    const uint32_t count = t->m->material_count + t->m->texture_count;
    for (uint32_t i = 0; i < count; i++) t->group_of[i] = i;
    join_maps(t);
    for (uint32_t i = 0; i < t->m->mesh_count; i++) {
        if (join_vertices(t, i)) return 1;
    }
    measure_groups(t);
    for (uint32_t i = 0; i < t->m->mesh_count; i++) use_mesh(t, i);
    for (uint32_t i = 0; i < count; i++) settle(&t->groups[i]);
    for (uint32_t i = 0; i < t->m->texture_count; i++) set_texture(t, i, done);
    for (uint32_t i = 0; i < t->m->mesh_count; i++) {
        memset(moved_yet, 0, t->m->meshes[i].vertex_count);
        move_mesh(t, i, moved_yet);
    }
    return 0;
}

int texture_trim(model *m, const mesh_levels *levels, texture_trimmed *done)
{
    const size_t count = (size_t)m->material_count + m->texture_count + 1u;
    trim t = { m, levels, calloc(count, sizeof *t.group_of), calloc(count, sizeof *t.groups) };
    uint8_t *moved_yet = malloc((size_t)most_vertices(m) + 1u);
    int failed = !t.group_of || !t.groups || !moved_yet;
    *done = (texture_trimmed){ 0, 0, 0 };
    failed = failed || trim_groups(&t, moved_yet, done);
    free(t.group_of);
    free(t.groups);
    free(moved_yet);
    return failed;
}

/* ---- texels ---- */

void texture_trim_texels(const model_texture *t, void *texels, size_t texel_bytes, uint32_t *width, uint32_t *height)
{
    const uint32_t columns = t->cells[0] ? t->cells[0] : 1u, rows = t->cells[1] ? t->cells[1] : 1u;
    const uint64_t kept[2] = { t->cells[0] ? t->kept[0] : 1u, t->cells[1] ? t->kept[1] : 1u };
    const uint32_t wide = *width / columns, high = *height / rows;
    const size_t part = wide * texel_bytes;
    const uint8_t *from = texels;
    uint8_t *to = texels;
    for (uint32_t y = 0; y < *height; y++, from += *width * texel_bytes) {
        for (uint32_t x = 0; x < columns && kept[1] >> y / high & 1u; x++) {
            if (!(kept[0] >> x & 1u)) continue;
            memmove(to, from + x * part, part);
            to += part;
        }
    }
    *width = wide * bits_of(kept[0]);
    *height = high * bits_of(kept[1]);
}

uint32_t texture_trim_word(const model_texture *t)
{
    const uint64_t words[4] = { t->cells[0], t->kept[0], t->cells[1], t->kept[1] };
    uint8_t bytes[32];
    uint32_t word;
    if (!t->cells[0] && !t->cells[1]) return 0;
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = (uint8_t)(words[i / 8] >> (8 * (i % 8)));
    word = noh_crc32c(0, bytes, sizeof bytes);
    return word ? word : 1u;
}
