/* stage_gl_pictures.c: the textures of all kinds and of their texture sets. The GPU holds each texture of a pack
 * once: the first set that has it owns it, the others copy its name. An owner of a stage that shares takes the name
 * from an owner that has it already (stage_gl_share.c). */
#include "gl/draw/gl_draw_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "noh/base.h"
#include "noh/pack.h"
#include "noh/noh.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"

typedef noh_gl_picture_site site;

/* 0: an empty slot */
static uint32_t textures_of(const noh_kind_desc *kind)
{
    return kind->mesh ? kind->mesh->runs[NOH_CHUNK_TEXTURE].count : 0;
}

uint32_t noh_gl_pictures_count(const noh_kind_desc *kind)
{
    return (1u + kind->texture_set_count) * textures_of(kind);
}

uint32_t noh_gl_picture_index(const noh_stage_desc *desc, site where)
{
    return where.set * desc->kinds[where.kind].mesh->runs[NOH_CHUNK_TEXTURE].count + where.texture;
}

static noh_gl_texture *at(noh_gl_kind *kinds, const noh_stage_desc *desc, site where)
{
    return &kinds[where.kind].pictures[noh_gl_picture_index(desc, where)];
}

/* Of a texture whose levels come by need; NULL: it is whole. */
static noh_gl_streamed *streamed(const noh_gl_kind *kinds, const noh_stage_desc *desc, site where)
{
    const noh_gl_stream *streams = NOH_PAGE ? NULL : kinds[where.kind].streams;
    const uint32_t own = streams ? streams[noh_gl_picture_index(desc, where)].own : 0;
    return own ? &kinds[where.kind].streamed[own - 1u] : NULL;
}

/* Whether a set has the texture with this index in a pack; *texture is then the one that it replaces. */
static int has(const noh_kind_desc *kind, uint32_t set, const noh_pack *pack, uint32_t index, uint32_t *texture)
{
    const noh_pack *from = set && kind->texture_sets[set - 1u].pack ? kind->texture_sets[set - 1u].pack : kind->mesh;
    *texture = index;
    if (!set || from->bytes != pack->bytes) {
        return !set && from->bytes == pack->bytes;
    }
    for (*texture = 0; *texture < kind->mesh->runs[NOH_CHUNK_TEXTURE].count; ++*texture) {
        const noh_pack *worn;
        if (noh_stage_worn(kind, set, *texture, &worn) == index && worn->bytes == pack->bytes) return 1;
    }
    return 0;
}

site noh_gl_picture_owner(const noh_stage_desc *desc, site where)
{
    const noh_pack *pack;
    const uint32_t index = noh_stage_worn(&desc->kinds[where.kind], where.set, where.texture, &pack);
    site s = { 0, 0, 0 };
    for (; s.kind < where.kind; s.kind++) { /* slots share nothing */
        if (desc->kinds[s.kind].changes || desc->kinds[where.kind].changes) continue;
        for (s.set = 0; s.set <= desc->kinds[s.kind].texture_set_count; s.set++) {
            if (has(&desc->kinds[s.kind], s.set, pack, index, &s.texture)) return s;
        }
    }
    for (s.set = 0; s.set < where.set; s.set++) {
        if (has(&desc->kinds[s.kind], s.set, pack, index, &s.texture)) return s;
    }
    (void)has(&desc->kinds[s.kind], s.set, pack, index, &s.texture); /* of two in one set, the first */
    return s;
}

int noh_gl_owns_picture(const noh_stage_desc *desc, site where, noh_texture *texture)
{
    const site owner = noh_gl_picture_owner(desc, where);
    const noh_pack *pack;
    const uint32_t index = noh_stage_worn(&desc->kinds[where.kind], where.set, where.texture, &pack);
    (void)noh_pack_texture_at(pack, index, texture, NULL);
    return owner.kind == where.kind && owner.set == where.set && owner.texture == where.texture;
}

int noh_gl_next_picture(const noh_stage_desc *desc, uint32_t end, site *where)
{
    where->texture++;
    while (where->kind < end && where->texture >= textures_of(&desc->kinds[where->kind])) {
        where->texture = 0;
        if (++where->set > desc->kinds[where->kind].texture_set_count) {
            where->set = 0;
            where->kind++;
        }
    }
    return where->kind < end;
}

/* ---- stages that share ---- */

/* The next owner of a texture, in all stages of this one's context, and what it has; NULL at the end. Textures whose
 * levels come by need are each stage's own. `whole`: of kinds that are uploaded. */
typedef struct walk {
    const noh_gl_sharing *at;
    site where;
} walk;

static walk begin(const noh_stage_gl *gl)
{
    return (walk){ gl->device.ledger->sharing, { 0, 0, UINT32_MAX } };
}

static const noh_gl_texture *next_owner(const noh_stage_gl *gl, walk *w, int whole)
{
    for (; w->at; w->at = w->at->next, w->where = (site){ 0, 0, UINT32_MAX }) {
        const noh_stage *s = w->at->stage;
        const noh_stage_gl *other = s->gpu;
        while (w->at->context == gl->sharing->context && noh_gl_next_picture(&s->desc, s->desc.kind_count, &w->where)) {
            noh_texture texture;
            if (!other->kinds[w->where.kind].pictures || !noh_gl_owns_picture(&s->desc, w->where, &texture)) continue;
            if (streamed(other->kinds, &s->desc, w->where)) continue;
            if (!whole || !s->kinds[w->where.kind].finer.hidden) return at(other->kinds, &s->desc, w->where);
        }
    }
    return NULL;
}

static const noh_gl_texture *find_shared(const noh_stage_desc *desc, const noh_stage_gl *gl, site where)
{
    const noh_pack *pack, *has;
    const uint32_t index = noh_stage_worn(&desc->kinds[where.kind], where.set, where.texture, &pack);
    walk w = begin(gl);
    const noh_gl_texture *found;
    while ((found = next_owner(gl, &w, 1)) != NULL) {
        const noh_kind_desc *kind = &w.at->stage->desc.kinds[w.where.kind];
        if (!found->name || noh_stage_worn(kind, w.where.set, w.where.texture, &has) != index) continue;
        if (has->bytes == pack->bytes) return found;
    }
    return NULL;
}

static int others_have(const noh_stage_gl *gl, const noh_gl_texture *own)
{
    walk w = begin(gl);
    const noh_gl_texture *other;
    while ((other = next_owner(gl, &w, 0)) != NULL) {
        if (other != own && other->name == own->name) return 1;
    }
    return 0;
}

/* Whether the owner of a texture in a peer lends it. */
static int lends(const noh_stage_desc *peer, const noh_pack *pack, uint32_t index, const noh_texture *of)
{
    site s = { 0, 0, 0 };
    for (; s.kind < peer->kind_count; s.kind++) {
        if (peer->kinds[s.kind].changes) continue;
        for (s.set = 0; s.set <= peer->kinds[s.kind].texture_set_count; s.set++) {
            if (has(&peer->kinds[s.kind], s.set, pack, index, &s.texture))
                return NOH_PAGE || !noh_gl_is_streamed(peer, s, of);
        }
    }
    return 0;
}

static int peers_have(const noh_stage_desc *desc, site where, const noh_texture *of)
{
    const noh_pack *pack;
    const uint32_t index = noh_stage_worn(&desc->kinds[where.kind], where.set, where.texture, &pack);
    const uint32_t count = desc->share && !desc->kinds[where.kind].changes ? desc->share->peer_count : 0;
    for (uint32_t p = 0; p < count; p++) {
        if (lends(desc->share->peers[p].desc, pack, index, of)) return 1;
    }
    return 0;
}

/* ---- all kinds ---- */

noh_result noh_gl_pictures_plan(const noh_stage_desc *desc, uint32_t kind, const noh_gl_caps *caps, uint64_t *bytes,
                                uint64_t *shared, noh_error *error)
{
    site where = { kind, 0, UINT32_MAX };
    noh_result result = NOH_OK;
    *bytes = *shared = 0;
    while (result == NOH_OK && noh_gl_next_picture(desc, kind + 1u, &where)) {
        noh_texture texture;
        if (!noh_gl_owns_picture(desc, where, &texture)) continue;
        result = noh_gl_picture_check(&texture, caps->astc, error);
        if (!NOH_PAGE && noh_gl_is_streamed(desc, where, &texture)) continue;
        *(!NOH_PAGE && peers_have(desc, where, &texture) ? shared : bytes) += noh_gl_picture_bytes(&texture,
                                                                                                   caps->etc2);
    }
    return result;
}

noh_result noh_gl_pictures_create(const noh_stage_desc *desc, const noh_stage_gl *gl, uint32_t kind, noh_error *error)
{
    const noh_gl_device *d = &gl->device;
    noh_gl_kind *kinds = gl->kinds;
    site where = { kind == NOH_NONE ? 0 : kind, 0, UINT32_MAX };
    const uint32_t end = kind == NOH_NONE ? desc->kind_count : kind + 1u;
    noh_result result = NOH_OK;
    while (result == NOH_OK && noh_gl_next_picture(desc, end, &where)) {
        const noh_gl_texture *shared = NULL;
        const noh_gl_streamed *r;
        noh_gl_texture *to;
        noh_texture texture;
        int is_owner;
        if (kind == NOH_NONE && desc->kinds[where.kind].changes) continue;
        to = at(kinds, desc, where);
        r = streamed(kinds, desc, where);
        is_owner = noh_gl_owns_picture(desc, where, &texture);
        if (is_owner && !r && noh_gl_shares(gl)) shared = find_shared(desc, gl, where);
        if (!is_owner) {
            *to = *at(kinds, desc, noh_gl_picture_owner(desc, where));
        } else if (shared) {
            *to = *shared;
        } else {
            result = kind == NOH_NONE
                         ? noh_gl_picture_create_from(d->api, d->ledger, &texture, r ? r->first : 0, to, error)
                         : noh_gl_picture_create_empty(d->api, d->ledger, &texture, 0, to, error);
        }
    }
    return result;
}

int noh_gl_pictures_fill(const noh_stage_desc *desc, const noh_stage_gl *gl, uint32_t kind, noh_gl_filling *f,
                         uint32_t *bytes)
{
    site where = { kind, 0, UINT32_MAX };
    uint32_t index = 0;
    for (; noh_gl_next_picture(desc, kind + 1u, &where); index++) {
        const noh_gl_texture *to = at(gl->kinds, desc, where);
        noh_texture texture;
        if (index < f->picture) continue;
        if (noh_gl_owns_picture(desc, where, &texture) &&
            !(noh_gl_shares(gl) && others_have(gl, to)) && /* theirs are filled */
            !noh_gl_picture_fill(gl->device.api, &texture, 0, to, &f->at, bytes))
            return 0;
        f->at = 0;
        f->picture = index + 1u;
    }
    return 1;
}

void noh_gl_pictures_delete(const noh_stage_desc *desc, const noh_gl_device *device, const noh_stage_gl *gl,
                            uint32_t kind)
{
    site where = { kind == NOH_NONE ? 0 : kind, 0, UINT32_MAX };
    const uint32_t end = kind == NOH_NONE ? desc->kind_count : kind + 1u;
    while (noh_gl_next_picture(desc, end, &where)) {
        noh_gl_streamed *r;
        noh_gl_texture *of;
        noh_texture texture;
        if (!gl->kinds[where.kind].pictures || !noh_gl_owns_picture(desc, where, &texture)) continue;
        of = at(gl->kinds, desc, where);
        if (noh_gl_shares(gl) && others_have(gl, of)) of->name = 0;
        noh_gl_texture_delete(device->api, device->ledger, of);
        r = streamed(gl->kinds, desc, where);
        if (r) noh_gl_texture_delete(device->api, device->ledger, &r->next);
    }
}
