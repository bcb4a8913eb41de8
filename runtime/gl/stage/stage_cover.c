/* stage_cover.c: what garments hide of their wearers is not drawn. A set of garments that hides triangles has index
 * buffers of its own for the meshes of its wearers' kind: with the same levels at the same places, but hidden triangles
 * have their three corners at one vertex, so that they cover no pixel. Actors with the same set share them and are drawn
 * together. A kind has room for cover_count sets; one that nobody has shown since the last frame makes way. */
#include "gl/device/gl_names_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "core/mesh/mesh_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#define FILL_TRIANGLES 128u /* made at once */

/* What garments of a kind hide of a mesh of another kind's pack; NULL: nothing. */
static const noh_pack_cover_header *cover_of(const noh_stage_desc *desc, uint32_t garment, uint32_t kind,
                                             const noh_mesh *mesh)
{
    return desc->kinds[garment].worn_by >> kind & 1u ? noh_stage_cover_of(desc->kinds[garment].mesh, mesh) : NULL;
}

/* A mesh with all levels of its pack. */
static noh_mesh whole_mesh(const noh_stage_desc *desc, noh_gl_site site)
{
    const noh_kind_desc kind = noh_stage_kind_desc(desc, site.kind);
    noh_stage_item items[NOH_STAGE_MESHES_MAX];
    noh_mesh mesh;
    (void)noh_stage_items(&kind, items);
    (void)noh_pack_mesh_at(kind.mesh, items[site.item].mesh, &mesh, NULL);
    return mesh;
}

static uint64_t index_count(const noh_mesh_header *h, uint32_t end)
{
    uint64_t count = 0;
    for (uint32_t k = h->level; k < end; k++) count += h[k - h->level].index_count;
    return count;
}

/* The bytes of a mesh's indices in one cover; 0: no garment hides any part of it. */
static uint64_t bytes_of(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site)
{
    const noh_mesh drawn = noh_gl_site_mesh(desc, plan, site), mesh = whole_mesh(desc, site);
    if (!desc->kinds[site.kind].cover_count || desc->kinds[site.kind].finer) return 0;
    for (uint32_t g = 0; g < desc->kind_count; g++) {
        if (desc->kinds[g].changes || cover_of(desc, g, site.kind, &mesh)) /* in a slot any garment may come */
            return index_count(drawn.header, drawn.header->level_count) * drawn.header->index_bytes;
    }
    return 0;
}

uint64_t noh_gl_covers_bytes(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind)
{
    uint64_t bytes = 0;
    for (uint32_t m = 0; desc->kinds[kind].cover_count && m < plan->kinds[kind].mesh_count; m++) {
        bytes += bytes_of(desc, plan, (noh_gl_site){ kind, m });
    }
    return bytes * desc->kinds[kind].cover_count;
}

noh_result noh_gl_covers_create(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_device *device,
                                noh_gl_kind *kinds, noh_error *error)
{
    noh_result result = NOH_OK;
    device->api->BindVertexArray(0);
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        for (uint32_t m = 0; kinds[i].covers && desc->kinds[i].cover_count && m < plan->kinds[i].mesh_count; m++) {
            const uint64_t bytes = bytes_of(desc, plan, (noh_gl_site){ i, m });
            for (uint32_t c = 0; bytes && c < desc->kinds[i].cover_count && result == NOH_OK; c++) {
                if (kinds[i].covers[c].indices[m].name) continue; /* another kind came into a slot */
                result = noh_gl_buffer_create(device->api, device->ledger, GL_ELEMENT_ARRAY_BUFFER, bytes, NULL,
                                              GL_DYNAMIC_DRAW, &kinds[i].covers[c].indices[m], error);
            }
        }
    }
    return result;
}

void noh_gl_covers_delete(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_device *device,
                          noh_gl_kind *kinds, uint32_t kind)
{
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        for (uint32_t c = 0; kinds[i].covers && c < desc->kinds[i].cover_count; c++) {
            noh_gl_cover *cover = &kinds[i].covers[c];
            if (kind != NOH_NONE && i != kind) { /* what it hid of others does not count for the next kind */
                if (cover->garments >> kind & 1u) cover->garments = 0;
                continue;
            }
            cover->garments = 0;
            for (uint32_t m = 0; m < plan->kinds[i].mesh_count; m++) {
                if (cover->indices[m].name) noh_gl_buffer_delete(device->api, device->ledger, &cover->indices[m]);
            }
        }
    }
}

/* ---- a frame ---- */

typedef struct hider {
    const noh_pack_cover_header *of[NOH_STAGE_KINDS_MAX]; /* of each garment; NULL: none */
    uint32_t count;
} hider;

static int is_hidden(const hider *h, uint64_t triangle)
{
    for (uint32_t i = 0; i < h->count; i++) {
        const uint32_t *bits = (const void *)((const uint8_t *)h->of[i] + h->of[i]->bits_offset);
        if (bits[triangle / 32u] >> triangle % 32u & 1u) return 1;
    }
    return 0;
}

/* mesh: with all levels of its pack; first, end: its triangles in the buffer */
static void fill(const noh_gl_api *gl, const noh_mesh *mesh, const hider *h, uint64_t first, uint64_t end)
{
    const uint32_t each = mesh->header->index_bytes;
    uint32_t made[3u * FILL_TRIANGLES];
    for (uint64_t from = first; from < end; from += FILL_TRIANGLES) {
        const uint32_t count = end - from < FILL_TRIANGLES ? (uint32_t)(end - from) : FILL_TRIANGLES;
        for (uint32_t i = 0; i < 3u * count; i++) {
            const uint64_t triangle = from + i / 3u;
            const uint32_t index = noh_mesh_index_of_all(mesh, 3u * triangle + (is_hidden(h, triangle) ? 0 : i % 3u));
            if (each == 2) {
                ((uint16_t *)(void *)made)[i] = (uint16_t)index;
            } else {
                made[i] = index;
            }
        }
        gl->BufferSubData(GL_ELEMENT_ARRAY_BUFFER, (GLintptr)(3u * (from - first) * each),
                          (GLsizeiptr)(3u * (uint64_t)count * each), made);
    }
}

static void fill_cover(const noh_stage *s, uint32_t kind, noh_gl_cover *cover, uint32_t garments)
{
    const noh_gl_api *gl = ((const noh_stage_gl *)s->gpu)->device.api;
    cover->garments = garments;
    gl->BindVertexArray(0);
    for (uint32_t m = 0; m < s->plan->kinds[kind].mesh_count; m++) {
        const noh_gl_site site = { kind, m };
        const noh_mesh mesh = whole_mesh(&s->desc, site), drawn = noh_gl_site_mesh(&s->desc, s->plan, site);
        hider h;
        if (!cover->indices[m].name) continue;
        h.count = 0;
        for (uint32_t g = 0; g < s->desc.kind_count; g++) {
            if (garments >> g & 1u) h.of[h.count] = cover_of(&s->desc, g, kind, &mesh);
            if (garments >> g & 1u && h.of[h.count]) h.count++;
        }
        gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, cover->indices[m].name);
        fill(gl, &mesh, &h, index_count(mesh.header, drawn.header->level) / 3u,
             index_count(mesh.header, mesh.header->level_count) / 3u);
    }
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}

static uint8_t find_cover(const noh_stage *s, uint32_t kind, uint32_t garments, int fills)
{
    noh_gl_cover *covers = ((const noh_stage_gl *)s->gpu)->kinds[kind].covers;
    const uint32_t count = s->desc.kinds[kind].cover_count;
    uint32_t c = 0;
    while (c < count && covers[c].garments != garments) c++;
    if (c == count && fills) {
        for (c = 0; c < count && covers[c].frame == s->frame && covers[c].garments;) c++;
        if (c < count) fill_cover(s, kind, &covers[c], garments);
    }
    if (c == count) return 0;
    covers[c].frame = s->frame;
    return (uint8_t)(c + 1u);
}

/* First those that are there, so that none of them makes way for another of this frame. */
void noh_gl_choose_covers(noh_stage *s)
{
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        for (uint32_t p = 0; k->desc->cover_count && p < 2u * noh_stage_seen(k); p++) {
            const uint32_t index = k->first_actor + k->order[p % noh_stage_seen(k)];
            const uint32_t garments = noh_stage_garments_on(s, index);
            s->shown[index].cover = garments ? find_cover(s, i, garments, p >= noh_stage_seen(k)) : 0;
        }
    }
}
