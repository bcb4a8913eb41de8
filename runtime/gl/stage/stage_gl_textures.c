/* stage_gl_textures.c: mip levels of textures by need.
 *
 * A texture begins with its small levels. Each frame compares what it has with the size at which its meshes are shown,
 * and makes at most one new object at a time: a finer one where one is needed and the reserve has room, otherwise a
 * coarser one where more is there than is needed. Frames fill it in pieces; then it takes the place of the old one, so
 * a picture never shows a level that is not complete. Storage of OpenGL ES is immutable: a base level would hide levels
 * but keep their memory, so fewer bytes need another object. */
#include <string.h>

#include "core/base/math_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_draw_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/pack.h"

#define TAIL_SIDE 64u /* levels up to this side are always there */
/* Least texels for a pixel that the finest level should have, on average over a mesh. Where the mesh is nearer, or has
 * half as many texels as on average, filtering still finds both of its levels. */
#define TEXELS_MIN 2.0f
#define WHOLE_PIXELS 1e30f /* a metre is as large as this where an actor is shown in full detail */

/* ---- which textures ---- */

/* The finest level that is always there. */
static uint32_t tail_of(const noh_texture *texture)
{
    const noh_texture_header *h = texture->header;
    uint32_t side = h->width > h->height ? h->width : h->height, level = 0;
    for (; side > TAIL_SIDE && level + 1u < h->level_count; side /= 2u) level++;
    return level;
}

/* Whether a material filters a texture at pixels. */
static int filters(const noh_material *m, uint32_t texture)
{
    return m->base_color_texture == texture || m->normal_texture == texture || m->surface_texture == texture ||
           m->emissive_texture == texture || m->wrinkle_texture == texture;
}

/* Or reads its texels where the level must not change: masks at vertices, ramps of toons. */
static int reads(const noh_material *m, uint32_t texture)
{
    return m->more_textures[0] == texture || m->more_textures[1] == texture || m->more_textures[2] == texture;
}

int noh_gl_is_streamed(const noh_stage_desc *desc, noh_gl_picture_site where, const noh_texture *texture)
{
    const noh_pack *pack, *has;
    const uint32_t index = noh_stage_worn(&desc->kinds[where.kind], where.set, where.texture, &pack);
    noh_gl_picture_site site = { 0, 0, UINT32_MAX };
    int filtered = 0, read = 0;
    if (!desc->texture_reserve || desc->kinds[where.kind].changes || texture->header->nearest || !tail_of(texture))
        return 0;
    while (noh_gl_next_picture(desc, desc->kind_count, &site)) { /* whichever kind and set shows it */
        const noh_kind_desc *kind = &desc->kinds[site.kind];
        if (kind->changes || noh_stage_worn(kind, site.set, site.texture, &has) != index || has->bytes != pack->bytes)
            continue;
        for (uint32_t i = 0; i < kind->mesh->material_count; i++) {
            filtered |= filters(&kind->mesh->materials[i], site.texture);
            read |= reads(&kind->mesh->materials[i], site.texture);
        }
    }
    return filtered && !read;
}

/* ---- texels in a metre ---- */

/* Twice the areas of a triangle: in metres, and in texture coordinates. */
static void add_triangle(const noh_mesh *mesh, uint32_t first, float *metres, float *uv)
{
    const float scale = mesh->header->world_scale;
    float a[3], b[3], c[3], u[2], v[2];
    noh_vertex corner[3];
    for (uint32_t i = 0; i < 3; i++) noh_mesh_vertex(mesh, noh_mesh_index(mesh, first + i), &corner[i]);
    for (int i = 0; i < 3; i++) {
        a[i] = scale * (corner[1].position[i] - corner[0].position[i]);
        b[i] = scale * (corner[2].position[i] - corner[0].position[i]);
    }
    for (int i = 0; i < 2; i++) {
        u[i] = corner[1].uv[i] - corner[0].uv[i];
        v[i] = corner[2].uv[i] - corner[0].uv[i];
    }
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
    *metres += noh_sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    *uv += u[0] * v[1] > u[1] * v[0] ? u[0] * v[1] - u[1] * v[0] : u[1] * v[0] - u[0] * v[1];
}

/* On average over the coarsest level of all meshes that show it, along one axis of the finest level; 0: the smallest
 * part of it fills them; < 0: none shows it. */
static float texels_in_metre(const noh_stage_desc *desc, noh_gl_picture_site where, const noh_texture *texture)
{
    const noh_kind_desc kind = noh_stage_kind_desc(desc, where.kind);
    noh_stage_item items[NOH_STAGE_MESHES_MAX];
    const uint32_t count = noh_stage_items(&kind, items);
    float metres = 0.0f, uv = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        noh_mesh mesh;
        (void)noh_pack_mesh_at(kind.mesh, items[i].mesh, &mesh, NULL);
        mesh = noh_mesh_at_lod(&mesh, mesh.header->level_count - 1u);
        for (uint32_t s = 0; s < mesh.header->submesh_count; s++) {
            const noh_submesh *part = &mesh.submeshes[s];
            if (part->material == NOH_NONE || !filters(&kind.mesh->materials[part->material], where.texture)) continue;
            for (uint32_t t = 0; t + 2u < part->index_count; t += 3u) {
                add_triangle(&mesh, part->first_index + t, &metres, &uv);
            }
        }
    }
    return metres > 0.0f ? noh_sqrt(uv / metres * (float)texture->header->width * (float)texture->header->height)
                         : -1.0f;
}

/* ---- plan and begin ---- */

noh_result noh_gl_textures_plan(const noh_stage_desc *desc, const noh_gl_caps *caps, uint32_t *count, noh_error *error)
{
    noh_gl_picture_site where = { 0, 0, UINT32_MAX };
    uint64_t tails = 0, whole = 0, tail = 0;
    *count = 0;
    while (desc->texture_reserve && noh_gl_next_picture(desc, desc->kind_count, &where)) {
        noh_texture texture;
        uint64_t bytes;
        if (!noh_gl_owns_picture(desc, where, &texture) || !noh_gl_is_streamed(desc, where, &texture)) continue;
        bytes = noh_gl_picture_bytes_from(&texture, caps->etc2, tail_of(&texture));
        tails += bytes;
        tail = bytes > tail ? bytes : tail;
        bytes = noh_gl_picture_bytes(&texture, caps->etc2);
        whole = bytes > whole ? bytes : whole;
        ++*count;
    }
    return tails + whole + tail <= desc->texture_reserve
               ? NOH_OK
               : noh_fail(
                     error, NOH_ERR_ARG,
                     "texture_reserve of a stage is too small for the small levels of all textures and the largest "
                     "texture once: raise it to `need` bytes",
                     0, tails + whole + tail);
}

void noh_gl_textures_open(const noh_stage_desc *desc, noh_stage_gl *gl)
{
    noh_gl_picture_site where = { 0, 0, UINT32_MAX };
    uint32_t count = 0;
    while (noh_gl_next_picture(desc, desc->kind_count, &where)) {
        const noh_gl_picture_site owner = noh_gl_picture_owner(desc, where);
        noh_gl_stream *to;
        noh_texture texture;
        const int owns = noh_gl_owns_picture(desc, where, &texture);
        if (desc->kinds[where.kind].changes) continue;
        gl->kinds[where.kind].streamed = gl->streamed;
        to = &gl->kinds[where.kind].streams[noh_gl_picture_index(desc, where)];
        if (owns && noh_gl_is_streamed(desc, where, &texture)) {
            noh_gl_streamed *r = &gl->streamed[count++];
            memset(r, 0, sizeof *r);
            r->kind = where.kind;
            r->picture = noh_gl_picture_index(desc, where);
            r->texture = texture;
            r->first = r->tail = tail_of(&texture);
            to->own = (uint16_t)count;
        } else if (!owns) {
            to->own = gl->kinds[owner.kind].streams[noh_gl_picture_index(desc, owner)].own;
        }
        if (to->own) to->texels = texels_in_metre(desc, where, &texture);
    }
    gl->streamed_count = count;
}

/* ---- what is needed ---- */

static uint32_t level_for(const noh_gl_streamed *r, float texels, float pixels)
{
    uint32_t level = texels < 0.0f ? r->tail : 0;
    for (; level < r->tail && texels >= 2.0f * TEXELS_MIN * pixels; texels *= 0.5f) level++;
    return level;
}

/* The most pixels that a metre of an actor of each texture set takes. */
static void measure_sets(const noh_stage *s, const noh_stage_kind *k, float *pixels)
{
    for (uint32_t set = 0; set <= k->desc->texture_set_count; set++) pixels[set] = 0.0f;
    for (uint32_t p = 0; p < noh_stage_seen(k); p++) {
        const noh_stage_actor *a = &k->actors[k->order[p]];
        const float own = noh_stage_is_full(s, a) ? WHOLE_PIXELS
                                                  : s->shown[k->first_actor + k->order[p]].scale * noh_stage_size(s, a);
        if (own > pixels[a->look.texture_set]) pixels[a->look.texture_set] = own;
    }
}

static void choose_wanted(const noh_stage *s, noh_stage_gl *gl)
{
    for (uint32_t i = 0; i < gl->streamed_count; i++) gl->streamed[i].wanted = gl->streamed[i].tail;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        const uint32_t textures = gl->kinds[i].streams ? k->desc->mesh->runs[NOH_CHUNK_TEXTURE].count : 0;
        float pixels[NOH_TEXTURE_SETS_MAX + 1u];
        if (textures) measure_sets(s, k, pixels);
        for (uint32_t at = 0; at < textures * (1u + k->desc->texture_set_count); at++) {
            const noh_gl_stream *of = &gl->kinds[i].streams[at];
            noh_gl_streamed *r = of->own ? &gl->streamed[of->own - 1u] : NULL;
            const uint32_t level = r ? level_for(r, of->texels, pixels[at / textures]) : 0;
            if (r && level < r->wanted) r->wanted = level;
        }
    }
}

/* ---- one object at a time ---- */

static noh_gl_texture *picture_of(const noh_stage_gl *gl, const noh_gl_streamed *r)
{
    return &gl->kinds[r->kind].pictures[r->picture];
}

static uint64_t bytes_from(const noh_stage_gl *gl, const noh_gl_streamed *r, uint32_t level)
{
    return noh_gl_picture_bytes_from(&r->texture, gl->device.api->etc2, level);
}

/* Bytes for another object; after it one of small levels still fits, without which nothing could shrink. */
static uint64_t room_of(const noh_stage *s, const noh_stage_gl *gl)
{
    uint64_t held = 0, tail = 0;
    for (uint32_t i = 0; i < gl->streamed_count; i++) {
        const uint64_t bytes = bytes_from(gl, &gl->streamed[i], gl->streamed[i].tail);
        held += picture_of(gl, &gl->streamed[i])->bytes;
        tail = bytes > tail ? bytes : tail;
    }
    return held + tail < s->desc.texture_reserve ? s->desc.texture_reserve - held - tail : 0;
}

static noh_gl_streamed *start(const noh_stage_gl *gl, noh_gl_streamed *r, uint32_t level)
{
    r->next_first = level;
    r->at = 0;
    return noh_gl_picture_create_empty(gl->device.api, gl->device.ledger, &r->texture, level, &r->next, NULL) == NOH_OK
               ? r
               : NULL; /* the driver is out of memory: the next frame tries again */
}

static uint32_t lack_of(const noh_gl_streamed *r)
{
    return r->wanted < r->first ? r->first - r->wanted : 0;
}

/* The one that lacks most levels, or the next after another one; NULL at the end. */
static noh_gl_streamed *poorest(noh_stage_gl *gl, const noh_gl_streamed *after)
{
    noh_gl_streamed *found = NULL;
    for (uint32_t i = 0; i < gl->streamed_count; i++) {
        noh_gl_streamed *r = &gl->streamed[i];
        const uint32_t lack = lack_of(r);
        if (after && (lack > lack_of(after) || (lack == lack_of(after) && r <= after))) continue;
        if (lack > (found ? lack_of(found) : 0)) found = r;
    }
    return found;
}

/* The one with the most bytes that nothing needs. */
static noh_gl_streamed *richest(noh_stage_gl *gl)
{
    noh_gl_streamed *found = NULL;
    uint64_t most = 0;
    for (uint32_t i = 0; i < gl->streamed_count; i++) {
        noh_gl_streamed *r = &gl->streamed[i];
        const uint64_t bytes = r->wanted > r->first ? picture_of(gl, r)->bytes - bytes_from(gl, r, r->wanted) : 0;
        if (bytes > most) found = r;
        if (bytes > most) most = bytes;
    }
    return found;
}

static noh_gl_streamed *begin(const noh_stage *s, noh_stage_gl *gl)
{
    const uint64_t room = room_of(s, gl);
    noh_gl_streamed *spare = richest(gl), *r = NULL;
    while ((r = poorest(gl, r)) != NULL) { /* one without room must not keep the others waiting */
        if (bytes_from(gl, r, r->wanted) <= room) return start(gl, r, r->wanted);
        if (spare) return start(gl, spare, bytes_from(gl, spare, spare->wanted) <= room ? spare->wanted : spare->tail);
        for (uint32_t level = r->wanted + 1u; level < r->first; level++) {
            if (bytes_from(gl, r, level) <= room) return start(gl, r, level);
        }
    }
    return NULL;
}

/* The new object in place of the old one, wherever it is shown. */
static void put(const noh_stage *s, noh_stage_gl *gl, noh_gl_streamed *r)
{
    const uint32_t own = gl->kinds[r->kind].streams[r->picture].own;
    noh_gl_texture old = *picture_of(gl, r);
    r->next.premultiplied = old.premultiplied;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const uint32_t count = gl->kinds[i].streams ? noh_gl_pictures_count(s->kinds[i].desc) : 0;
        for (uint32_t at = 0; at < count; at++) {
            if (gl->kinds[i].streams[at].own == own) gl->kinds[i].pictures[at] = r->next;
        }
    }
    noh_gl_texture_delete(gl->device.api, gl->device.ledger, &old);
    r->first = r->next_first;
    memset(&r->next, 0, sizeof r->next);
}

static noh_gl_streamed *under_way(noh_stage_gl *gl)
{
    for (uint32_t i = 0; i < gl->streamed_count; i++) {
        if (gl->streamed[i].next.name) return &gl->streamed[i];
    }
    return NULL;
}

/* Send a piece. Without memory for it in the driver a later frame begins again. Returns 1 once all is there. */
static int fill(const noh_stage_gl *gl, noh_gl_streamed *r, uint32_t *bytes)
{
    const noh_gl_api *api = gl->device.api;
    int done;
    noh_gl_error_take(api);
    done = noh_gl_picture_fill(api, &r->texture, r->next_first, &r->next, &r->at, bytes);
    if (noh_gl_error_check(api, "the driver refused the pixels of a texture", 0, NULL) == NOH_OK) return done;
    noh_gl_texture_delete(api, gl->device.ledger, &r->next);
    return 0;
}

void noh_gl_textures_stream(noh_stage *s, uint32_t *bytes)
{
    noh_stage_gl *gl = s->gpu;
    noh_gl_streamed *r;
    if (!gl->streamed_count) return;
    choose_wanted(s, gl);
    r = under_way(gl);
    if (!r) r = begin(s, gl);
    if (r && fill(gl, r, bytes)) put(s, gl, r);
    s->stats.textures_coarser = 0;
    for (uint32_t i = 0; i < gl->streamed_count; i++) {
        s->stats.textures_coarser += gl->streamed[i].wanted < gl->streamed[i].first;
    }
}
