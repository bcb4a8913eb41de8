/* stage_gl_slot.c: what draws the kinds that come into a running stage (stage_slot.c).
 *
 * A slot has memory for the objects of its largest kind, and the plan counts their bytes on the GPU. GL objects differ
 * from kind to kind, so they are made when a kind comes, empty, and deleted when it goes; frames fill them in pieces.
 * Until all is there, the kind's actors are posed and given slots as ever, and not drawn: from then on the kind has the
 * sums and pictures of one that was there from the start. Programs are made with the stage, for all kinds of a plan. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_draw_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/pack.h"

/* ---- kinds of the plan ---- */

/* Not inlined: two descs lie on the stack, and callers have deep ones. */
NOH_NEVER_INLINE int noh_gl_candidate_at(const noh_stage_desc *desc, uint32_t kind, uint32_t index,
                                         noh_gl_candidate *out)
{
    const noh_kind_desc *d = &desc->kinds[kind];
    noh_stage_desc alone = *desc;
    noh_kind_desc filled;
    if (!d->changes || index > d->other_count) return 0;
    alone.kinds = index ? &d->others[index - 1u] : d;
    alone.kind_count = 1;
    filled = noh_stage_kind_desc(&alone, 0);
    out->pack = filled.mesh;
    out->actor_count = filled.actor_count;
    out->mesh_count = noh_stage_items(&filled, out->items);
    return 1;
}

noh_mesh noh_gl_candidate_mesh(const noh_stage_desc *desc, const noh_gl_candidate *of, uint32_t index)
{
    noh_mesh mesh;
    (void)noh_pack_mesh_at(of->pack, of->items[index].mesh, &mesh, NULL);
    return noh_gl_as_lit(desc, &mesh, mesh.header->level);
}

uint32_t noh_gl_candidate_meshes(const noh_stage_desc *desc, noh_mesh *meshes)
{
    noh_gl_candidate of;
    uint32_t count = 0;
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        for (uint32_t c = 0; noh_gl_candidate_at(desc, i, c, &of); c++) {
            for (uint32_t m = 0; meshes && m < of.mesh_count; m++)
                meshes[count + m] = noh_gl_candidate_mesh(desc, &of, m);
            count += of.mesh_count;
        }
    }
    return count;
}

/* The same as renderer_desc in stage_gl.c for kinds that stay. */
static void want_of(const noh_stage_desc *desc, const noh_gl_candidate *of, noh_gl_renderer_desc *want)
{
    uint32_t skinned = 0, fewer = 0;
    for (uint32_t m = 0; m < of->mesh_count && !desc->full_detail; m++) {
        const noh_mesh mesh = noh_gl_candidate_mesh(desc, of, m);
        want->fades |= mesh.header->level_count > 1u;
        if (mesh.header->skin == NOH_NONE) continue;
        skinned++;
        fewer += mesh.header->level_count > 1u && mesh.header->influence_count > 1u;
    }
    want->crowds |= of->actor_count > 1u;
    want->fewer_influences |= skinned == 1u && fewer == 1u;
}

void noh_gl_candidates_want(const noh_stage_desc *desc, noh_gl_renderer_desc *want)
{
    noh_gl_candidate of;
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        for (uint32_t c = 0; noh_gl_candidate_at(desc, i, c, &of); c++) want_of(desc, &of, want);
    }
}

void noh_gl_candidates_list(const noh_stage_desc *desc, const noh_gl_renderer_desc *want, noh_gl_variant_list *list)
{
    noh_gl_candidate of;
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        for (uint32_t c = 0; noh_gl_candidate_at(desc, i, c, &of); c++) {
            for (uint32_t m = 0; m < of.mesh_count; m++) {
                const noh_mesh mesh = noh_gl_candidate_mesh(desc, &of, m);
                (void)noh_gl_list_variants(want, &mesh, list, NULL);
            }
        }
    }
}

/* ---- programs ---- */

noh_result noh_gl_slots_recompile(noh_stage_gl *gl, const noh_stage_desc *desc, uint32_t path, noh_error *error)
{
    noh_gl_morph_desc d;
    noh_result result = NOH_OK;
    memset(&d, 0, sizeof d);
    d.accumulate = desc->halves > 0 ? NOH_ACCUMULATE_F16 : NOH_ACCUMULATE_AUTO;
    d.without_tangents = !desc->tangents;
    for (int i = 0; i < 2 && result == NOH_OK && noh_gl_morph_has_program((noh_morph_path)path); i++) {
        if (!gl->needs_program[i]) continue;
        result = noh_gl_morph_compile(&gl->device, (noh_morph_path)path, &d, i, &gl->programs[i], error);
    }
    return result;
}

noh_result noh_gl_slots_compile(const noh_stage_desc *asked, noh_stage_gl *gl, uint32_t path, noh_error *error)
{
    const noh_mesh *meshes = gl->meshes + (gl->mesh_count - noh_gl_candidate_meshes(asked, NULL));
    for (; meshes < gl->meshes + gl->mesh_count; meshes++) {
        if (meshes->header->touched_count) gl->needs_program[meshes->transfer != NULL] = 1;
    }
    return noh_gl_slots_recompile(gl, asked, path, error);
}

void noh_gl_slots_forget_programs(noh_stage_gl *gl, const noh_gl_device *device)
{
    for (int i = 0; i < 2; i++) noh_gl_program_delete(device->api, device->ledger, &gl->programs[i]);
}

/* What the stage's renderer was asked for, and what a kind needs in addition. Not inlined, as the next: both have large
 * frames. */
NOH_NEVER_INLINE static noh_gl_renderer_desc want_with(const noh_stage *s, uint32_t kind)
{
    const noh_stage_gl *gl = s->gpu;
    noh_gl_renderer_desc want = gl->renderer_desc;
    noh_gl_candidate of;
    if (gl->renderer->gl) want.lit = gl->renderer->lit; /* with soft shadows or without */
    if (noh_gl_candidate_at(&s->desc, kind, 0, &of)) want_of(&s->desc, &of, &want);
    return want;
}

/* Whether the renderer's programs draw a kind. */
NOH_NEVER_INLINE static noh_result check_programs(const noh_stage *s, uint32_t kind, const noh_gl_renderer_desc *want,
                                                  noh_error *error)
{
    const noh_stage_gl *gl = s->gpu;
    const noh_gl_renderer *r = gl->renderer;
    noh_gl_site site = { kind, 0 };
    noh_gl_variant_list list;
    noh_result result = NOH_OK;
    uint32_t before;
    list.count = 0;
    if (r->gl) {
        for (uint32_t i = 0; i < r->variant_count; i++) list.keys[list.count++] = r->variants[i].key;
    }
    for (uint32_t i = 0; i < gl->mesh_count && !r->gl; i++) {
        (void)noh_gl_list_variants(&gl->renderer_desc, &gl->meshes[i], &list, NULL);
    }
    before = list.count;
    for (; site.item < s->plan->kinds[kind].mesh_count && result == NOH_OK; site.item++) {
        const noh_mesh mesh = noh_gl_site_mesh(&s->desc, s->plan, site);
        result = noh_gl_list_variants(want, &mesh, &list, NULL);
    }
    return result == NOH_OK && list.count == before
               ? NOH_OK
               : noh_fail(error, NOH_ERR_UNSUPPORTED,
                          "a kind needs programs that no kind of the plan needs: add it to `others` of its slot", kind,
                          0);
}

/* ---- in and out ---- */

static noh_result check_room(const noh_kind_room *asked, const noh_kind_room *had, noh_error *error)
{
    if (asked->mesh_count > had->mesh_count)
        return noh_fail(error, NOH_ERR_MEMORY, "a kind has more meshes than its slot", had->mesh_count,
                        asked->mesh_count);
    if (asked->drawn_bytes > had->drawn_bytes)
        return noh_fail(error, NOH_ERR_MEMORY, "what draws a kind takes more bytes on the CPU than its slot has",
                        had->drawn_bytes, asked->drawn_bytes);
    return asked->gpu_bytes <= had->gpu_bytes
               ? NOH_OK
               : noh_fail(error, NOH_ERR_MEMORY, "a kind takes more bytes on the GPU than its slot has", had->gpu_bytes,
                          asked->gpu_bytes);
}

noh_result noh_gl_slot_open(noh_stage *s, uint32_t kind, noh_error *error)
{
    noh_stage_gl *gl = s->gpu;
    const noh_gl_caps *caps = gl->device.caps;
    noh_gl_kind *k = &gl->kinds[kind];
    noh_kind_room room;
    noh_result result = noh_gl_visit_slot(&s->desc, s->plan, caps, NULL, kind, NULL, &room, NULL, error);
    if (result == NOH_OK) result = check_room(&room, &s->plan->kinds[kind].room, error);
    if (result == NOH_OK) {
        memset(&k->filling, 0, sizeof k->filling);
        result = noh_gl_visit_slot(&s->desc, s->plan, caps, gl, kind, k->slot, &room, NULL, error);
    }
    if (result == NOH_OK) result = noh_gl_pictures_create(&s->desc, gl, kind, error);
    return result == NOH_OK ? noh_gl_covers_create(&s->desc, s->plan, &gl->device, gl->kinds, error) : result;
}

noh_result noh_gl_slot_come(noh_stage *s, uint32_t kind, noh_error *error)
{
    const noh_gl_renderer_desc want = want_with(s, kind);
    const noh_result result = check_programs(s, kind, &want, error);
    return result == NOH_OK ? noh_gl_slot_open(s, kind, error) : result;
}

/* The models of a slot, as many as its largest kind has. */
static noh_gl_model *model_of(const noh_stage *s, uint32_t kind, uint32_t item)
{
    const noh_stage_gl *gl = s->gpu;
    return item < s->plan->kinds[kind].room.mesh_count ? &gl->models[gl->kinds[kind].first_model + item] : NULL;
}

void noh_gl_slot_close(noh_stage *s, uint32_t kind)
{
    noh_stage_gl *gl = s->gpu;
    const noh_gl_device *d = &gl->device;
    noh_gl_kind *k = &gl->kinds[kind], none;
    noh_gl_model *model;
    noh_gl_pictures_delete(&s->desc, d, gl, kind);
    noh_gl_covers_delete(&s->desc, s->plan, d, gl->kinds, kind);
    for (uint32_t m = 0; k->items && m < s->plan->kinds[kind].mesh_count; m++) {
        if (k->items[m].skin) noh_gl_skin_delete(k->items[m].skin);
    }
    for (uint32_t m = 0; (model = model_of(s, kind, m)) != NULL; m++) {
        if (noh_gl_shares(gl)) noh_gl_share_let_go(gl, model);
        if (model->morph) noh_gl_morph_delete(model->morph);
        noh_gl_mesh_delete(d->api, d->ledger, &model->mesh);
        memset(model, 0, sizeof *model);
        model->load_kind = NOH_NONE;
    }
    memset(&none, 0, sizeof none);
    none.slot = k->slot;
    none.first_model = k->first_model;
    *k = none;
}

/* ---- pieces ---- */

static int fill_meshes(const noh_stage *s, uint32_t kind, noh_gl_filling *f, uint32_t *bytes)
{
    const noh_gl_device *d = &((const noh_stage_gl *)s->gpu)->device;
    noh_gl_model *model;
    for (; (model = model_of(s, kind, f->item)) != NULL; f->item++) {
        if (model->mesh.mesh.header) { /* else another item owns its model */
            if (!model->taken && !noh_gl_mesh_fill(d->api, &model->mesh, &model->mesh.mesh, &f->mesh_at, bytes))
                return 0;
            if (model->morph && !noh_gl_morph_fill(model->morph, &model->mesh.mesh, &f->at, bytes)) return 0;
        }
        f->mesh_at = 0;
        f->at = 0;
    }
    return 1;
}

static noh_result fill(noh_stage *s, uint32_t kind, uint32_t *bytes, noh_error *error)
{
    noh_stage_gl *gl = s->gpu;
    noh_gl_kind *k = &gl->kinds[kind];
    const noh_gl_filling before = k->filling;
    noh_result result;
    if (before.done) return NOH_OK;
    noh_gl_error_take(gl->device.api);
    k->filling.done = fill_meshes(s, kind, &k->filling, bytes) &&
                      noh_gl_pictures_fill(&s->desc, gl, kind, &k->filling, bytes);
    result = noh_gl_error_check(gl->device.api, "the driver refused the data of a kind", kind, error);
    if (result != NOH_OK) k->filling = before;
    return result;
}

int noh_gl_slot_fill(noh_stage *s, uint32_t kind, uint32_t *bytes)
{
    (void)fill(s, kind, bytes, NULL); /* after an error the next frame sends the piece again */
    return ((const noh_stage_gl *)s->gpu)->kinds[kind].filling.done;
}

static void show(noh_stage *s, uint32_t kind)
{
    noh_gl_model *model;
    s->kinds[kind].finer.hidden = 0;
    for (uint32_t m = 0; (model = model_of(s, kind, m)) != NULL; m++) model->waits = 0;
}

noh_result noh_gl_slot_fill_all(noh_stage *s, uint32_t kind, noh_error *error)
{
    noh_result result = NOH_OK;
    while (result == NOH_OK && !((const noh_stage_gl *)s->gpu)->kinds[kind].filling.done) {
        uint32_t bytes = UINT32_MAX;
        result = fill(s, kind, &bytes, error);
    }
    if (result == NOH_OK) show(s, kind);
    return result;
}

void noh_gl_slots_show(noh_stage *s)
{
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        if (s->kinds[i].finer.hidden && ((const noh_stage_gl *)s->gpu)->kinds[i].filling.done) show(s, i);
    }
}
