/* stage_gl_share.c: what stages of one ledger share (noh_gl.h).
 *
 * The ledger links these stages. No table counts users: an object has as many as there are stages whose models and
 * pictures hold its name. A stage that makes one looks through the others for it; a stage that lets it go deletes it
 * where no other holds it. That takes two words in the block of each stage, no limit of its own, and a few comparisons
 * at load.
 *
 * Names of a lost context may belong to other objects in the new one, so a stage compares names only with stages of its
 * own context: the ledger numbers contexts, and a stage has the number of the context in which it was made or restored.
 */
#include <string.h>

#include "core/base/compiler_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

/* ---- members ---- */

void noh_gl_share_join(noh_stage *stage)
{
    const noh_stage_gl *gl = stage->gpu;
    noh_gl_sharing *own = gl->sharing;
    own->stage = stage;
    own->next = gl->device.ledger->sharing;
    gl->device.ledger->sharing = own;
}

void noh_gl_share_leave(const noh_stage *stage)
{
    const noh_stage_gl *gl = stage->gpu;
    noh_gl_sharing **link = &gl->device.ledger->sharing;
    while (*link && *link != gl->sharing) link = &(*link)->next;
    if (*link) *link = gl->sharing->next;
}

noh_result noh_gl_share_check_restore(const noh_stage_gl *gl, noh_error *error)
{
    return gl->sharing->context != gl->device.ledger->contexts
               ? NOH_OK
               : noh_fail(
                     error, NOH_ERR_ARG,
                     "a stage that shares was made or restored in this context already: after a lost context add 1 "
                     "to noh_gl_ledger.contexts, then restore",
                     gl->sharing->context, 0);
}

/* ---- models ---- */

typedef struct walk {
    const noh_gl_sharing *at;
    uint32_t model;
} walk;

static walk begin(const noh_stage_gl *gl)
{
    return (walk){ gl->device.ledger->sharing, 0 };
}

/* The next model of all stages of this one's context; NULL at the end. */
static noh_gl_model *next_model(const noh_stage_gl *gl, walk *w)
{
    for (; w->at; w->at = w->at->next, w->model = 0) {
        const noh_stage_gl *other = w->at->stage->gpu;
        if (w->at->context == gl->sharing->context && w->model < other->model_count) return &other->models[w->model++];
    }
    return NULL;
}

/* Whether others may use its objects: all of it is uploaded, and nothing comes later. */
static int is_whole(const noh_gl_model *model)
{
    return model->mesh.positions.name && !model->waits && model->load_kind == NOH_NONE;
}

const noh_gl_mesh *noh_gl_shared_mesh(const noh_stage_gl *gl, const noh_mesh *mesh)
{
    walk w = begin(gl);
    const noh_gl_model *model;
    while ((model = next_model(gl, &w)) != NULL) {
        const noh_mesh *has = &model->mesh.mesh;
        if (is_whole(model) && has->header == mesh->header && has->transfer == mesh->transfer) return &model->mesh;
    }
    return NULL;
}

const noh_gl_texture *noh_gl_shared_tiles(const noh_stage_gl *gl, const noh_gl_tiles_key *key)
{
    walk w = begin(gl);
    const noh_gl_model *model;
    while (key->mesh && (model = next_model(gl, &w)) != NULL) {
        noh_gl_tiles_key has;
        if (!is_whole(model) || !model->morph || !model->morph->tiles.name) continue;
        has = noh_gl_morph_key_of(model->morph);
        if (memcmp(&has, key, sizeof has) == 0) return &model->morph->tiles;
    }
    return NULL;
}

void noh_gl_share_let_go(const noh_stage_gl *gl, noh_gl_model *model)
{
    static const noh_gl_buffer none = { 0, 0 };
    noh_gl_mesh *mesh = &model->mesh;
    walk w = begin(gl);
    const noh_gl_model *other;
    while ((other = next_model(gl, &w)) != NULL) {
        if (other == model) continue;
        if (model->morph && other->morph && other->morph->tiles.name == model->morph->tiles.name) {
            memset(&model->morph->tiles, 0, sizeof model->morph->tiles);
        }
        if (other->mesh.positions.name != mesh->positions.name) continue;
        mesh->positions = mesh->attributes = mesh->influences = mesh->indices = mesh->transfer = none;
    }
}

/* ---- plans ---- */

/* The key of a site's delta tiles. Its tiles take kilobytes of stack, so it is never inlined. */
NOH_NEVER_INLINE static noh_gl_tiles_key key_at(const noh_stage_desc *desc, const noh_stage_plan *plan,
                                                const noh_gl_caps *caps, noh_gl_site site, int direct)
{
    noh_gl_tiles_key none;
    noh_gl_tiles tiles;
    noh_gl_morph_desc d;
    noh_gl_morph_plan p;
    memset(&none, 0, sizeof none);
    if (!noh_gl_site_mesh(desc, plan, site).header->touched_count) return none;
    noh_gl_tiles_of(desc, plan, site, &tiles);
    d = noh_gl_site_morph(desc, &tiles);
    if (direct) d.path = NOH_MORPH_DIRECT;
    d.without_direct = 1;
    return noh_gl_morph_plan_make(&d, caps, &p, NULL) == NOH_OK ? noh_gl_morph_key(d.meshes, d.mesh_count, &p) : none;
}

/* A site of a kind that stays, which owns its model, all of it in the kind's pack. */
static int may_lend(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_gl_site site)
{
    const noh_gl_site owner = noh_gl_owner(desc, plan, site);
    noh_mesh coarse;
    return !desc->kinds[site.kind].changes && owner.kind == site.kind && owner.item == site.item &&
           !noh_gl_site_coarse(desc, plan, site, &coarse);
}

NOH_NEVER_INLINE static unsigned peer_has(const noh_stage_peer *peer, const noh_gl_caps *caps, const noh_mesh *mesh,
                                          const noh_gl_tiles_key *key)
{
    noh_stage_desc d = *peer->desc;
    noh_gl_site site = { UINT32_MAX, UINT32_MAX };
    unsigned has = 0;
    int direct;
    noh_stage_desc_by_plan(&d, peer->plan);
    direct = noh_gl_sums_in_draws(&d, peer->plan, caps);
    while (noh_gl_next_site(peer->plan, d.kind_count, &site)) {
        const noh_mesh other = noh_gl_site_mesh(&d, peer->plan, site);
        noh_gl_tiles_key tiles;
        if (other.header != mesh->header || other.transfer != mesh->transfer) continue;
        if (!may_lend(&d, peer->plan, site)) continue;
        has |= NOH_PEER_MESH;
        if (!key->mesh) continue;
        tiles = key_at(&d, peer->plan, caps, site, direct);
        if (memcmp(&tiles, key, sizeof tiles) == 0) has |= NOH_PEER_TILES;
    }
    return has;
}

unsigned noh_gl_peers_have(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_caps *caps,
                           noh_gl_site site, int direct)
{
    const noh_stage_peers *share = desc->share;
    unsigned has = 0;
    if (share->peer_count && may_lend(desc, plan, site)) {
        const noh_mesh mesh = noh_gl_site_mesh(desc, plan, site);
        const noh_gl_tiles_key key = key_at(desc, plan, caps, site, direct);
        for (uint32_t i = 0; i < share->peer_count; i++) has |= peer_has(&share->peers[i], caps, &mesh, &key);
    }
    return has;
}
