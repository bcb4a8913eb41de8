/* stage_gl.c: the GPU objects of a stage: measured, created, deleted, restored. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_skin_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gl/draw/gl_renderer_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "gl/draw/gl_light_internal.h"
#include "stage/character/character_internal.h"

/* ---- memory ---- */

typedef struct measure {
    const noh_stage_desc *desc;
    const noh_stage_desc *asked; /* with the `others` of its kinds */
    const noh_stage_plan *plan;
    const noh_gl_caps *caps;
    noh_arena arena;      /* CPU memory */
    noh_stage_gl *gl;     /* NULL: only measure */
    noh_stage_list *list; /* NULL: not wanted */
    uint64_t gpu_bytes;
    uint32_t morph_path;
    int direct;            /* draws sum (noh_gl_sums_in_draws) */
    uint64_t shared_bytes; /* that peers have, not in gpu_bytes */
    uint32_t next_model;   /* with gl: of the kinds that do not change */
} measure;

#define CARVE(m, count, type) ((type *)noh_arena_carve(&(m)->arena, (size_t)(count) * sizeof(type), 16))

/* Count what was carved since `from`, and GPU bytes. */
static void add(measure *m, const char *what, uint32_t kind, size_t from, uint64_t gpu_bytes)
{
    m->gpu_bytes += gpu_bytes;
    noh_stage_add_part(m->list, what, kind, m->arena.used - from, gpu_bytes);
}

static uint32_t count_models(const measure *m)
{
    noh_gl_site site = { UINT32_MAX, UINT32_MAX };
    uint32_t count = 0;
    while (noh_gl_next_site(m->plan, m->desc->kind_count, &site)) {
        const noh_gl_site owner = noh_gl_owner(m->desc, m->plan, site);
        if (m->desc->kinds[site.kind].changes) continue;
        count += owner.kind == site.kind && owner.item == site.item;
    }
    return count;
}

/* A model whose finer levels are loaded later. */
NOH_NEVER_INLINE static void set_later(const measure *m, noh_gl_site site, const noh_mesh *mesh, const noh_mesh *coarse,
                                       void *room, noh_gl_model *model)
{
    model->load_kind = noh_stage_load_kind(m->desc, site.kind);
    model->mesh_index = m->plan->kinds[site.kind].meshes[site.item];
    model->coarse = *coarse;
    model->room = noh_gl_room_make(mesh, coarse, room);
}

/* Bytes on the GPU, 0 where peers have them. */
static uint64_t own_bytes(measure *m, int peers_have, uint64_t bytes)
{
    if (peers_have) m->shared_bytes += bytes;
    return peers_have ? 0 : bytes;
}

/* peers: NOH_PEER_* */
static noh_result visit_model(measure *m, noh_gl_site site, unsigned peers, noh_gl_model *model, noh_error *error)
{
    const noh_mesh mesh = noh_gl_site_mesh(m->desc, m->plan, site);
    const size_t from = m->arena.used;
    noh_gl_tiles tiles;
    noh_gl_morph_desc d;
    noh_gl_morph_plan plan;
    noh_result result = NOH_OK;
    const noh_gl_texture *filled = NULL;
    size_t targets;
    void *memory;
    uint8_t *sides;
    noh_mesh coarse;
    const int slot = m->desc->kinds[site.kind].changes != 0;
    const int later = noh_gl_site_coarse(m->desc, m->plan, site, &coarse);
    void *room = noh_arena_carve(&m->arena, later ? noh_gl_room_size(&mesh) : 0, 16);
    add(m, "mesh buffers", site.kind, from, own_bytes(m, (peers & NOH_PEER_MESH) != 0, noh_gl_mesh_bytes(&mesh)));
    if (model) {
        model->load_kind = NOH_NONE;
        model->waits = slot;
        if (later) set_later(m, site, &mesh, &coarse, room, model);
        result = noh_gl_model_make_mesh(m->gl, model, &mesh, slot, error);
    }
    if (result != NOH_OK || mesh.header->touched_count == 0) {
        return result;
    }
    noh_gl_tiles_of(m->desc, m->plan, site, &tiles);
    d = noh_gl_site_morph(m->desc, &tiles); /* counts blocks and strips; the room below has no counts */
    if (m->direct) d.path = NOH_MORPH_DIRECT;
    d.without_direct = 1;
    for (uint32_t i = 0; later && model && i < tiles.count; i++) {
        tiles.meshes[i] = noh_mesh_at_lod(&model->room, tiles.meshes[i].header->level);
    }
    result = noh_gl_morph_plan_make(&d, m->caps, &plan, error);
    if (result != NOH_OK) {
        return result;
    }
    m->morph_path = (uint32_t)plan.path;
    targets = m->arena.used;
    memory = noh_arena_carve(&m->arena, (size_t)plan.cpu_bytes, 16);
    sides = CARVE(m, m->desc->motion ? plan.instance_count / 2u : 0, uint8_t);
    add(m, "morph targets", site.kind, targets,
        plan.gpu_bytes - plan.layer_bytes - plan.vertex_bytes - plan.delta_bytes +
            own_bytes(m, (peers & NOH_PEER_TILES) != 0, plan.delta_bytes));
    add(m, plan.vertex_ring ? "morphed vertices" : "accumulators", site.kind, m->arena.used,
        plan.layer_bytes + plan.vertex_bytes);
    if (!model) return NOH_OK;
    if (m->desc->motion) model->sides = memset(sides, 0, plan.instance_count / 2u);
    if (noh_gl_shares(m->gl) && !later) {
        const noh_gl_tiles_key key = noh_gl_morph_key(d.meshes, d.mesh_count, &plan);
        filled = noh_gl_shared_tiles(m->gl, &key);
    }
    result = noh_gl_morph_init_empty(memory, (size_t)plan.cpu_bytes, &m->gl->device, &d, slot ? m->gl->programs : NULL,
                                     filled, &model->morph, error);
    model->part_count = d.mesh_count;
    return result == NOH_OK ? noh_gl_model_set_mesh(model, error) : result;
}

/* Palettes and transform rows for one mesh of all actors of a kind. */
static noh_result visit_item(measure *m, noh_gl_site site, noh_gl_item *item, noh_error *error)
{
    const uint32_t count = noh_stage_kind_desc(m->desc, site.kind).visible_max;
    noh_mesh mesh;
    const noh_gl_skin_desc d = { &mesh, 1, &count, NOH_PALETTE_TEXTURE, m->desc->user_values, m->desc->motion };
    const size_t from = m->arena.used;
    noh_gl_skin_plan plan;
    noh_result result;
    void *memory;
    (void)noh_gl_site_coarse(m->desc, m->plan, site, &mesh); /* all levels have the same palettes */
    result = noh_gl_skin_plan_make(&d, m->caps, &plan, error);
    if (result != NOH_OK) {
        return result;
    }
    memory = noh_arena_carve(&m->arena, (size_t)plan.cpu_bytes, 16);
    add(m, "palettes", site.kind, from, plan.gpu_bytes);
    return item ? noh_gl_skin_init(memory, (size_t)plan.cpu_bytes, &m->gl->device, &d, &item->skin, error) : NOH_OK;
}

/* ---- arrays of objects ---- */

static void carve_kind(measure *m, uint32_t i, noh_gl_kind *kind)
{
    const uint32_t meshes = m->plan->kinds[i].mesh_count, cover_count = m->desc->kinds[i].cover_count;
    const uint32_t count = noh_gl_pictures_count(&m->desc->kinds[i]);
    const uint32_t last_count = m->desc->motion ? m->desc->kinds[i].actor_count : 0;
    noh_gl_item *items = CARVE(m, meshes, noh_gl_item);
    noh_gl_texture *pictures = CARVE(m, count, noh_gl_texture);
    noh_gl_cover *covers = CARVE(m, cover_count, noh_gl_cover);
    noh_gl_buffer *indices = CARVE(m, cover_count * meshes, noh_gl_buffer);
    noh_gl_last *last = CARVE(m, last_count, noh_gl_last);
    const int streams_any = !NOH_PAGE && m->desc->texture_reserve && !m->desc->kinds[i].changes;
    noh_gl_stream *streams = CARVE(m, streams_any ? count : 0, noh_gl_stream);
    if (!kind) return;
    if (streams_any) kind->streams = memset(streams, 0, count * sizeof *streams);
    kind->last = last_count ? memset(last, 0, last_count * sizeof *last) : NULL;
    kind->covers = covers;
    memset(indices, 0, cover_count * meshes * sizeof *indices);
    for (uint32_t c = 0; c < cover_count; c++) covers[c] = (noh_gl_cover){ 0, 0, indices + c * meshes };
    kind->items = items;
    kind->pictures = pictures;
    memset(items, 0, meshes * sizeof *items);
    memset(pictures, 0, count * sizeof *pictures);
}

static void carve_kinds(measure *m)
{
    noh_gl_kind *kinds = CARVE(m, m->desc->kind_count, noh_gl_kind);
    if (kinds) memset(kinds, 0, m->desc->kind_count * sizeof *kinds);
    for (uint32_t i = 0; i < m->desc->kind_count; i++) {
        if (!m->desc->kinds[i].changes) carve_kind(m, i, kinds ? &kinds[i] : NULL);
    }
    if (m->gl) m->gl->kinds = kinds;
}

/* Memory for what draws the kinds of slots, and models of their meshes, after the models of kinds that stay. */
static void carve_slots(measure *m)
{
    uint32_t model = m->gl ? m->gl->model_count : 0;
    for (uint32_t i = 0; i < m->desc->kind_count; i++) {
        const noh_kind_room *room = &m->plan->kinds[i].room;
        const size_t from = m->arena.used;
        uint8_t *slot;
        if (!m->desc->kinds[i].changes) continue;
        slot = noh_arena_carve(&m->arena, (size_t)room->drawn_bytes, 16);
        add(m, "slot", i, from, room->gpu_bytes);
        if (!m->gl) continue;
        m->gl->kinds[i].slot = slot;
        model -= (uint32_t)room->mesh_count;
        m->gl->kinds[i].first_model = model;
    }
}

/* Whether a kind's detail may choose fewer influences (open_lod of stage_kind.c): it has one skinned mesh, with levels.
 */
static int may_drop_influences(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind)
{
    noh_gl_site site = { UINT32_MAX, UINT32_MAX };
    uint32_t skinned = 0, fewer = 0;
    while (!desc->full_detail && noh_gl_next_site(plan, desc->kind_count, &site)) {
        const noh_mesh mesh = noh_gl_site_mesh(desc, plan, site);
        if (site.kind != kind || mesh.header->skin == NOH_NONE) continue;
        skinned++;
        fewer += mesh.header->level_count > 1u && mesh.header->influence_count > 1u;
    }
    return skinned == 1u && fewer == 1u;
}

/* The desc of the stage's renderer and shaders, without meshes. */
static noh_gl_renderer_desc renderer_desc(const noh_stage_desc *desc, const noh_stage_plan *plan)
{
    noh_gl_renderer_desc d;
    memset(&d, 0, sizeof d);
    d.palettes = NOH_PALETTE_TEXTURE;
    d.without_tangents = !desc->tangents;
    d.encode_srgb = desc->encode_srgb;
    d.lit = desc->light != NULL;
    d.shading = desc->shading;
    d.passes = desc->without_depth ? NOH_PASSES_COLOR : NOH_PASSES_ALL;
    noh_gl_candidates_want(desc, &d);
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        if (desc->kinds[i].changes) continue;
        d.crowds |= desc->kinds[i].actor_count > 1u;
        d.fades |= plan->kinds[i].level_count > 1u && !desc->full_detail;
        d.fewer_influences |= may_drop_influences(desc, plan, i);
    }
    return d;
}

/* Variants of the renderer of all meshes. noh_gl_renderer_create reports too many. */
NOH_NEVER_INLINE static size_t variants_size(const measure *m)
{
    const noh_gl_renderer_desc d = renderer_desc(m->asked, m->plan);
    noh_gl_site site = { UINT32_MAX, UINT32_MAX };
    noh_gl_variant_list list;
    list.count = 0;
    noh_gl_candidates_list(m->asked, &d, &list);
    while (noh_gl_next_site(m->plan, m->desc->kind_count, &site)) {
        if (m->desc->kinds[site.kind].changes) continue;
        const noh_mesh mesh = noh_gl_site_mesh(m->desc, m->plan, site);
        (void)noh_gl_list_variants(&d, &mesh, &list, NULL);
    }
    return noh_gl_variants_size(&list);
}

/* Of the largest kind of each slot, in all. */
static uint32_t slots_meshes(const measure *m)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < m->desc->kind_count; i++) count += (uint32_t)m->plan->kinds[i].room.mesh_count;
    return count;
}

static void carve_head(measure *m)
{
    const uint32_t stay = count_models(m), models = stay + slots_meshes(m);
    const uint32_t mesh_count = stay + noh_gl_candidate_meshes(m->asked, NULL);
    noh_stage_gl *gl = CARVE(m, 1, noh_stage_gl);
    noh_gl_model *of = CARVE(m, models, noh_gl_model);
    noh_mesh *meshes = CARVE(m, mesh_count, noh_mesh);
    const size_t variants_bytes = variants_size(m);
    noh_gl_renderer *renderer = CARVE(m, 1, noh_gl_renderer);
    void *variants = noh_arena_carve(&m->arena, m->desc->without_shader ? 0 : variants_bytes, 16);
    noh_gl_views *views = CARVE(m, m->desc->motion ? 2u : 0, noh_gl_views);
    noh_gl_sharing *sharing = CARVE(m, !NOH_PAGE && m->desc->share, noh_gl_sharing);
    if (m->gl) { /* a real stage: init put the device into a copy */
        gl->device = m->gl->device;
        m->gl = gl;
        gl->models = of;
        gl->sharing = NULL;
        if (!NOH_PAGE && m->desc->share) {
            gl->sharing = memset(sharing, 0, sizeof *sharing);
            sharing->context = gl->device.ledger->contexts;
        }
        gl->model_count = models;
        gl->meshes = meshes;
        gl->mesh_count = mesh_count;
        (void)noh_gl_candidate_meshes(m->asked, meshes + stay);
        gl->renderer_desc = renderer_desc(m->asked, m->plan);
        gl->programs[0] = gl->programs[1] = 0;
        gl->needs_program[0] = gl->needs_program[1] = 0;
        gl->streamed = NULL;
        gl->streamed_count = 0;
        gl->renderer = renderer;
        gl->variants = variants;
        gl->variants_bytes = variants_bytes;
        memset(of, 0, models * sizeof *of);
        for (uint32_t i = stay; i < models; i++) of[i].load_kind = NOH_NONE;
        memset(renderer, 0, sizeof *renderer);
        gl->light = NULL;
        gl->lighting = NULL;
        gl->views = m->desc->motion ? memset(views, 0, 2u * sizeof *views) : NULL;
    }
    carve_kinds(m);
    add(m, "renderer", NOH_NONE, 0, m->desc->without_shader ? 0 : NOH_GL_RENDERER_BYTES);
}

static void carve_light(measure *m)
{
    const size_t from = m->arena.used;
    noh_gl_light *light;
    if (!m->desc->light) return;
    light = CARVE(m, 1, noh_gl_light);
    add(m, "light", NOH_NONE, from, noh_gl_light_bytes(m->desc->light, noh_gl_has_soft_shadows(m->caps)));
    if (!m->gl) return;
    memset(light, 0, sizeof *light);
    m->gl->light = light;
}

/* ---- the whole stage ---- */

static noh_mesh mesh_for_renderers(const measure *m, noh_gl_site site, const noh_gl_model *model)
{
    return model->load_kind == NOH_NONE ? noh_gl_site_mesh(m->desc, m->plan, site) : model->room;
}

/* The model of an owner, which is visited before those that share it. */
static noh_gl_model *model_of(measure *m, noh_gl_site owner, int is_new)
{
    const noh_gl_kind *k = &m->gl->kinds[owner.kind];
    if (!is_new) return k->items[owner.item].model;
    return &m->gl->models[m->desc->kinds[owner.kind].changes ? k->first_model + owner.item : m->next_model++];
}

static noh_result visit_site(measure *m, noh_gl_site site, noh_error *error)
{
    const noh_gl_site owner = noh_gl_owner(m->desc, m->plan, site);
    const int owns = owner.kind == site.kind && owner.item == site.item;
    noh_gl_model *model = m->gl ? model_of(m, owner, owns) : NULL;
    noh_gl_item *item = m->gl ? &m->gl->kinds[site.kind].items[site.item] : NULL;
    noh_result result = NOH_OK;
    if (owns) {
        unsigned peers = 0;
        if (!NOH_PAGE && m->desc->share) {
            peers = noh_gl_peers_have(m->desc, m->plan, m->caps, site, m->direct);
        }
        result = visit_model(m, site, peers, model, error);
        if (model && !m->desc->kinds[site.kind].changes)
            m->gl->meshes[model - m->gl->models] = mesh_for_renderers(m, site, model);
    }
    if (item) {
        item->model = model;
        item->first_pool = noh_gl_first_pool(m->desc, m->plan, site);
    }
    return result == NOH_OK ? visit_item(m, site, item, error) : result;
}

static noh_result visit_streamed(measure *m, noh_error *error)
{
    const size_t from = m->arena.used;
    uint32_t count;
    const noh_result result = noh_gl_textures_plan(m->desc, m->caps, &count, error);
    noh_gl_streamed *streamed = CARVE(m, count, noh_gl_streamed);
    add(m, "texture reserve", NOH_NONE, from, m->desc->texture_reserve);
    if (m->gl && result == NOH_OK) {
        m->gl->streamed = streamed;
        noh_gl_textures_open(m->desc, m->gl);
    }
    return result;
}

static noh_result count_pictures(measure *m, uint32_t kind, noh_error *error)
{
    const uint64_t covers = noh_gl_covers_bytes(m->desc, m->plan, kind);
    uint64_t bytes, shared;
    const noh_result result = noh_gl_pictures_plan(m->desc, kind, m->caps, &bytes, &shared, error);
    m->shared_bytes += shared;
    if (bytes) add(m, "textures", kind, m->arena.used, bytes);
    if (covers) add(m, "covers", kind, m->arena.used, covers);
    return result;
}

static noh_result visit(measure *m, noh_error *error)
{
    noh_gl_site site = { UINT32_MAX, UINT32_MAX };
    noh_result result = NOH_OK;
    m->direct = noh_gl_sums_in_draws(m->desc, m->plan, m->caps);
    carve_head(m);
    carve_light(m);
    if (m->gl && m->desc->light) {
        result = noh_gl_light_create(&m->gl->device, m->desc->light, m->gl->light, error);
    }
    while (result == NOH_OK && noh_gl_next_site(m->plan, m->desc->kind_count, &site)) {
        if (!m->desc->kinds[site.kind].changes) result = visit_site(m, site, error);
    }
    for (uint32_t i = 0; i < m->desc->kind_count && result == NOH_OK; i++) {
        if (!m->desc->kinds[i].changes) result = count_pictures(m, i, error);
    }
    carve_slots(m);
    if (!NOH_PAGE && m->desc->texture_reserve && result == NOH_OK) result = visit_streamed(m, error);
    if (result == NOH_OK && m->gl) result = noh_gl_covers_create(m->desc, m->plan, &m->gl->device, m->gl->kinds, error);
    return result == NOH_OK && m->gl ? noh_gl_pictures_create(m->desc, m->gl, NOH_NONE, error) : result;
}

noh_result noh_gl_visit_slot(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_caps *caps,
                             noh_stage_gl *gl, uint32_t kind, void *memory, noh_kind_room *room, uint32_t *morph_path,
                             noh_error *error)
{
    measure m = { desc, desc, plan, caps, memory ? noh_arena_over(memory, SIZE_MAX) : noh_arena_measure(),
                  gl,   NULL, 0,    0,    noh_gl_sums_in_draws(desc, plan, caps),
                  0,    0 };
    noh_gl_site site = { kind, 0 };
    noh_result result = NOH_OK;
    carve_kind(&m, kind, gl ? &gl->kinds[kind] : NULL);
    for (; site.item < plan->kinds[kind].mesh_count && result == NOH_OK; site.item++) {
        result = visit_site(&m, site, error);
    }
    if (result == NOH_OK) result = count_pictures(&m, kind, error);
    room->mesh_count = plan->kinds[kind].mesh_count;
    room->drawn_bytes = (m.arena.used + 15u) & ~(size_t)15u;
    room->gpu_bytes = m.gpu_bytes;
    if (morph_path && !*morph_path) *morph_path = m.morph_path;
    return result;
}

static noh_result measure_slot(const noh_stage_desc *desc, const struct noh_gl_caps *caps, noh_stage_plan *plan,
                               noh_kind_room *room, noh_error *error)
{
    if (desc->morph_path == NOH_MORPH_STREAMS) {
        return noh_fail(error, NOH_ERR_UNSUPPORTED,
                        "morph_path of a stage in which kinds change: streams are not uploaded in pieces", 0, 0);
    }
    return noh_gl_visit_slot(desc, plan, caps, NULL, 0, NULL, room, &plan->morph_path, error);
}

static noh_result measure_stage(const noh_stage_desc *desc, const struct noh_gl_caps *caps, noh_stage_plan *plan,
                                uint64_t *cpu_bytes, uint64_t *gpu_bytes, noh_error *error)
{
    measure m = { desc, desc, plan, caps, noh_arena_measure(), NULL, NULL, 0, 0, 0, 0, 0 };
    if (!NOH_PAGE && !caps->version) {
        return noh_fail(error, NOH_ERR_ARG, "the capabilities of the GPU are empty: call noh_gl_open before the plan",
                        0, 0);
    }
    const noh_result result = visit(&m, error);
    *cpu_bytes = m.arena.used;
    *gpu_bytes = m.gpu_bytes;
    plan->shared_bytes = m.shared_bytes;
    if (m.morph_path || !noh_stage_has_slots(desc)) plan->morph_path = m.morph_path;
    return result;
}

static void list_parts(const noh_stage_desc *desc, const struct noh_gl_caps *caps, const noh_stage_plan *plan,
                       noh_stage_list *list)
{
    measure m = { desc, desc, plan, caps, noh_arena_measure(), NULL, list, 0, 0, 0, 0, 0 };
    (void)visit(&m, NULL);
}

/* ---- life cycle ---- */

static noh_result make_renderer(const noh_stage_gl *gl, const noh_stage *s, const noh_gl_shader_desc *own,
                                const noh_gl_device *device, void *memory, size_t bytes, noh_gl_renderer *out,
                                noh_error *error)
{
    static const noh_gl_shader_desc library = { .defines = NULL };
    noh_gl_shader_desc complexions = own ? *own : library;
    noh_gl_renderer_desc d = gl->renderer_desc;
    if (!complexions.defines) complexions.defines = "#define NOH_COMPLEXION\n";
    d.meshes = gl->meshes;
    d.mesh_count = gl->mesh_count;
    d.shaders = s->desc.user_values == NOH_USER_COMPLEXION ? &complexions : own;
    return noh_gl_renderer_create(device, &d, memory, bytes, out, error);
}

static void let_go_meshes(noh_stage *stage, const noh_gl_device *d)
{
    noh_stage_gl *gl = stage->gpu;
    noh_gl_pictures_delete(&stage->desc, d, gl, NOH_NONE);
    noh_gl_covers_delete(&stage->desc, stage->plan, d, gl->kinds, NOH_NONE);
    noh_gl_slots_forget_programs(gl, d);
    for (uint32_t i = 0; i < gl->model_count; i++) {
        if (gl->models[i].mesh.vertex_array) noh_gl_mesh_delete(d->api, d->ledger, &gl->models[i].mesh);
    }
}

static void let_go_shared(const noh_stage_gl *gl)
{
    for (uint32_t i = 0; i < gl->model_count && noh_gl_shares(gl); i++) noh_gl_share_let_go(gl, &gl->models[i]);
}

static void delete_all(noh_stage *stage)
{
    noh_stage_gl *gl = stage->gpu;
    let_go_shared(gl);
    if (gl->renderer->gl) noh_gl_renderer_delete(gl->renderer);
    if (gl->light && gl->light->gl) noh_gl_light_delete(gl->light);
    for (uint32_t i = 0; i < stage->desc.kind_count; i++) {
        for (uint32_t m = 0; gl->kinds[i].items && m < stage->kinds[i].plan->mesh_count; m++) {
            if (gl->kinds[i].items[m].skin) noh_gl_skin_delete(gl->kinds[i].items[m].skin);
        }
    }
    for (uint32_t i = 0; i < gl->model_count; i++) {
        if (gl->models[i].morph) noh_gl_morph_delete(gl->models[i].morph);
    }
    let_go_meshes(stage, &gl->device);
}

static void destroy(noh_stage *stage)
{
    delete_all(stage);
    if (noh_gl_shares(stage->gpu)) noh_gl_share_leave(stage);
}

/* The context is lost with its objects: only update the ledger. */
static void forget(noh_stage *stage)
{
    noh_stage_gl *gl = stage->gpu;
    noh_gl_device lost = gl->device;
    lost.api = noh_gl_lost_api();
    let_go_shared(gl);
    if (gl->renderer->gl) noh_gl_renderer_forget(gl->renderer);
    if (gl->light) noh_gl_light_forget(gl->light);
    for (uint32_t i = 0; i < stage->desc.kind_count; i++) {
        for (uint32_t m = 0; m < stage->kinds[i].plan->mesh_count; m++) {
            noh_gl_skin_forget(gl->kinds[i].items[m].skin);
        }
    }
    for (uint32_t i = 0; i < gl->model_count; i++) {
        if (gl->models[i].morph) noh_gl_morph_forget(gl->models[i].morph);
    }
    let_go_meshes(stage, &lost);
}

/* What sums the targets is known to the models, and of slots by the plan. */
static int layers_of(const noh_stage *s, const noh_stage_gl *gl)
{
    const uint32_t path = s->plan->morph_path;
    int layers = path == NOH_MORPH_DIRECT
                     ? NOH_LAYERS_DIRECT
                     : path == NOH_MORPH_GATHER && s->desc.halves <= 0 && !gl->device.caps->render_f32;
    if (!s->slots) layers = 0;
    for (uint32_t i = 0; i < gl->model_count; i++) {
        if (gl->models[i].morph) layers = noh_gl_morph_binding_of(gl->models[i].morph, 0).is_uint;
    }
    return layers;
}

/* The kinds that are there from the start. */
static noh_result open_slots(noh_stage *s, const noh_stage_desc *asked, noh_error *error)
{
    noh_result result = s->slots ? noh_gl_slots_compile(asked, s->gpu, s->plan->morph_path, error) : NOH_OK;
    for (uint32_t i = 0; i < s->desc.kind_count && result == NOH_OK; i++) {
        if (!s->desc.kinds[i].changes || !s->plan->kinds[i].mesh_count) continue;
        result = noh_gl_slot_open(s, i, error);
        if (result == NOH_OK) result = noh_gl_slot_fill_all(s, i, error);
    }
    return result;
}

static noh_result init(void *memory, size_t bytes, const void *device, const noh_stage_desc *desc, noh_stage *stage,
                       noh_error *error)
{
    measure m = { &stage->desc, desc, stage->plan, NULL, noh_arena_over(memory, bytes), NULL, NULL, 0, 0, 0, 0, 0 };
    noh_stage_gl first;
    noh_result result;
    result = noh_gl_device_check(device, 1, error);
    if (result) return result;
    first.device = *(const noh_gl_device *)device;
    m.caps = first.device.caps;
    m.gl = &first;
    result = visit(&m, error);
    stage->gpu = m.gl;
    if (noh_gl_shares(m.gl)) noh_gl_share_join(stage);
    if (result == NOH_OK) result = open_slots(stage, desc, error);
    if (result == NOH_OK) {
        m.gl->renderer_desc.layers_uint = layers_of(stage, m.gl);
        if (!stage->desc.without_shader) {
            result = make_renderer(m.gl, stage, NULL, &m.gl->device, m.gl->variants, m.gl->variants_bytes,
                                   m.gl->renderer, error);
        }
    }
    if (result != NOH_OK) {
        destroy(stage);
        stage->gpu = NULL;
    }
    m.gl->device.log = NULL;
    m.gl->device.log_bytes = 0;
    return result;
}

static noh_result restore_kind(const noh_stage *s, uint32_t kind, noh_error *error)
{
    const noh_stage_gl *gl = s->gpu;
    noh_result result = NOH_OK;
    for (uint32_t m = 0; m < s->kinds[kind].plan->mesh_count && result == NOH_OK; m++) {
        result = noh_gl_skin_restore(gl->kinds[kind].items[m].skin, error);
    }
    return result;
}

/* Whether a model belongs to a slot: its models and pictures are made empty, and filled again if they are shown. */
static int is_of_slot(const noh_stage *stage, uint32_t model)
{
    const noh_stage_gl *gl = stage->gpu;
    int is = 0;
    for (uint32_t i = 0; i < stage->desc.kind_count; i++) {
        is |= gl->kinds[i].slot && model - gl->kinds[i].first_model < stage->plan->kinds[i].room.mesh_count;
    }
    return is;
}

/* Each is filled before the next one is made: only textures that are filled may be taken. */
static noh_result restore_slots(noh_stage *stage, int hidden, noh_error *error)
{
    const noh_stage_gl *gl = stage->gpu;
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < stage->desc.kind_count && result == NOH_OK; i++) {
        noh_gl_kind *k = &gl->kinds[i];
        if (!k->slot || !k->items || stage->kinds[i].finer.hidden != hidden) continue;
        memset(&k->filling, 0, sizeof k->filling);
        result = noh_gl_pictures_create(&stage->desc, gl, i, error);
        if (result == NOH_OK && !hidden) result = noh_gl_slot_fill_all(stage, i, error);
    }
    return result;
}

static noh_result restore_all(noh_stage *stage, noh_error *error)
{
    noh_stage_gl *gl = stage->gpu;
    noh_result result = NOH_OK;
    if (stage->slots) result = noh_gl_slots_recompile(gl, &stage->desc, stage->plan->morph_path, error);
    for (uint32_t i = 0; i < gl->model_count && result == NOH_OK; i++) {
        noh_gl_model *model = &gl->models[i];
        if (model->mesh.mesh.header) result = noh_gl_model_restore(stage, model, is_of_slot(stage, i), error);
    }
    for (uint32_t i = 0; i < stage->desc.kind_count && result == NOH_OK; i++) {
        result = restore_kind(stage, i, error);
    }
    if (result == NOH_OK && gl->light) result = noh_gl_light_restore(gl->light, error);
    if (result == NOH_OK) result = noh_gl_pictures_create(&stage->desc, gl, NOH_NONE, error);
    if (result == NOH_OK) result = noh_gl_covers_create(&stage->desc, stage->plan, &gl->device, gl->kinds, error);
    for (int hidden = 0; hidden < 2 && result == NOH_OK; hidden++) result = restore_slots(stage, hidden, error);
    return result == NOH_OK && gl->renderer->gl ? noh_gl_renderer_restore(gl->renderer, NULL, 0, error) : result;
}

/* All or nothing: where one object cannot be made, those before it are deleted, and no name of the old context is left
 * to be deleted in the new one. */
static noh_result restore(noh_stage *stage, noh_error *error)
{
    const noh_stage_gl *gl = stage->gpu;
    const int shares = noh_gl_shares(gl);
    noh_result result = shares ? noh_gl_share_check_restore(gl, error) : NOH_OK;
    if (result != NOH_OK) return result;
    forget(stage);
    if (shares) gl->sharing->context = gl->device.ledger->contexts;
    result = restore_all(stage, error);
    if (result == NOH_OK) return result;
    delete_all(stage);
    if (shares) gl->sharing->context--; /* it has no object of this context */
    return result;
}

/* ---- upload ---- */

int noh_gl_any_weight(const float *weights, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (weights[i] != 0.0f) return 1;
    }
    return 0;
}

void noh_gl_upload_regions(const noh_stage_mesh *mesh, const noh_gl_item *item, uint32_t place, const float *weights)
{
    float regions[NOH_WRINKLE_REGIONS];
    noh_wrinkles wrinkles;
    if (noh_wrinkles_of(&mesh->mesh, &wrinkles, NULL) == NOH_OK) {
        noh_wrinkles_weights(&wrinkles, weights, regions);
        (void)noh_gl_skin_set_wrinkles(item->skin, place, regions, NULL);
    }
}

/* Upload one actor's mesh: its weights and transform. */
static void upload_place(const noh_stage_mesh *mesh, const noh_gl_item *item, const noh_stage_actor *actor,
                         const noh_stage_shown *shown, int has_user, const float *weights)
{
    noh_gl_morph_binding morph;
    float world[12];
    int moved = 0;
    memcpy(world, shown->world, sizeof world);
    if (!mesh->skinned && mesh->node_world) noh_matrix_multiply(shown->world, mesh->node_world, world);
    if (noh_gl_has_tile(item, shown)) {
        uint32_t tile;
        if (item->model->sides) noh_gl_motion_turn(item, shown, weights, mesh->mesh.header->target_count);
        tile = noh_gl_item_tile(item, shown);
        moved = noh_gl_any_weight(weights, mesh->mesh.header->target_count);
        (void)noh_gl_morph_set_weights(item->model->morph, tile, weights, NULL);
        morph = noh_gl_morph_binding_of(item->model->morph, tile);
    }
    if (!noh_stage_is_mirrored(mesh, actor, shown)) {
        (void)noh_gl_skin_set_place(item->skin, shown->place, world, moved ? &morph : NULL, NULL);
        (void)noh_gl_skin_set_tint(item->skin, shown->place, noh_stage_tint_of(actor), NULL);
        if (has_user) (void)noh_gl_skin_set_user(item->skin, shown->place, actor->look.user, NULL);
        noh_gl_upload_regions(mesh, item, shown->place, weights);
    }
}

/* Upload palettes for all meshes of one actor. Meshes with the same skin share matrices. */
static void pose(noh_stage *s, noh_stage_kind *k, uint32_t index, float *matrices)
{
    const noh_gl_item *items = ((const noh_stage_gl *)s->gpu)->kinds[k - s->kinds].items;
    noh_stage_shown *shown = &s->shown[k->first_actor + index];
    const noh_skin_header *ready = NULL;
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        if (!mesh->skinned || k->actors[index].look.hidden_meshes >> m & 1u) continue;
        if (mesh->skin.header != ready) noh_character_skin(noh_stage_character(k, index), &mesh->skin, matrices);
        ready = mesh->skin.header;
        noh_stage_move_far_joints(k, index, m, shown->level > shown->level_before ? shown->level : shown->level_before,
                                  matrices);
        if (noh_gl_skin_write_matrices(items[m].skin, shown->place, matrices)) shown->updates |= NOH_STAGE_MOVED;
    }
    if (s->desc.motion && noh_gl_motion_pose(s, k, index)) shown->updates |= NOH_STAGE_MOVED;
}

static void upload_actor(const noh_stage *s, const noh_stage_kind *k, const noh_gl_item *items, uint32_t index)
{
    const noh_stage_shown *shown = &s->shown[k->first_actor + index];
    const float *weights = k->weights + (size_t)index * k->weight_count;
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        if (k->actors[index].look.hidden_meshes >> m & 1u) continue;
        upload_place(mesh, &items[m], &k->actors[index], shown, s->desc.user_values, weights + mesh->first_weight);
        if (s->desc.motion) noh_gl_motion_upload(s, k, index, m);
        if (mesh->skinned && (shown->updates & NOH_STAGE_MOVED)) noh_gl_skin_touch(items[m].skin, shown->place);
    }
}

static void upload(noh_stage *s)
{
    noh_stage_gl *gl = s->gpu;
    noh_gl_slots_show(s);
    noh_gl_choose_covers(s);
    if (s->desc.motion) noh_gl_motion_begin(s);
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        for (uint32_t p = 0; p < noh_stage_seen(k); p++) upload_actor(s, k, gl->kinds[i].items, k->order[p]);
        for (uint32_t m = 0; m < k->plan->mesh_count; m++) noh_gl_skin_update(gl->kinds[i].items[m].skin);
    }
    for (uint32_t i = 0; i < gl->model_count; i++) {
        if (gl->models[i].morph && !gl->models[i].waits) noh_gl_morph_update(gl->models[i].morph, NULL);
    }
    if (s->desc.motion) noh_gl_motion_end(s);
}

/* ---- access to GPU objects ---- */

noh_result noh_stage_morph_plan(const noh_stage_desc *desc, const noh_gl_caps *caps, const noh_stage_plan *plan,
                                noh_gl_morph_plan *out, noh_error *error)
{
    noh_gl_site site = { UINT32_MAX, UINT32_MAX }, first = { 0, 0 };
    noh_stage_desc d = *desc;
    int in_draws;
    NOH_ASSERT(plan && caps && out);
    noh_stage_desc_by_plan(&d, plan);
    while (noh_gl_next_site(plan, d.kind_count, &site)) {
        if (noh_gl_site_mesh(&d, plan, site).header->touched_count) {
            first = noh_gl_owner(&d, plan, site);
            break;
        }
    }
    in_draws = noh_gl_sums_in_draws(&d, plan, caps);
    return noh_gl_site_plan(&d, plan, first, caps, !in_draws, out, error);
}

/* The last frame; without motion, this one. */
static void take_before(const noh_stage *s, const noh_stage_kind *k, const noh_stage_actor *a, uint32_t mesh,
                        noh_stage_drawn *out)
{
    const noh_stage_mesh *m = &k->meshes[mesh];
    out->morph_before = out->morph;
    if (s->desc.motion) {
        (void)noh_gl_motion_of(s, k, noh_stage_index(k, a), mesh, out->world_before, &out->morph_before);
        return;
    }
    memcpy(out->world_before, s->shown[a - s->actors].world, sizeof out->world_before);
    if (!m->skinned && m->node_world) noh_matrix_multiply(out->world_before, m->node_world, out->world_before);
}

noh_result noh_actor_on_gl(noh_stage *stage, noh_actor actor, uint32_t index, noh_stage_drawn *out, noh_error *error)
{
    NOH_ASSERT(stage && out);
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const noh_stage_shown *shown;
    const noh_gl_item *item;
    const noh_result result = noh_gl_stage_check(stage, error);
    if (result) return result;
    if (!a) {
        return noh_stage_gone(error, actor);
    }
    shown = &stage->shown[a - stage->actors];
    if (index >= k->plan->mesh_count || k->finer.hidden || shown->frame != stage->frame || !shown->views) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        "the actor has no such mesh, no view of the last frame saw it, or its kind is not uploaded yet",
                        index, k->plan->mesh_count);
    }
    item = &((const noh_stage_gl *)stage->gpu)->kinds[k - stage->kinds].items[index];
    memset(out, 0, sizeof *out);
    out->mesh = &item->model->mesh;
    out->pictures = ((const noh_stage_gl *)stage->gpu)->kinds[k - stage->kinds].pictures +
                    (size_t)a->look.texture_set * k->desc->mesh->runs[NOH_CHUNK_TEXTURE].count;
    out->is_morphed = noh_gl_has_tile(item, shown);
    if (out->is_morphed) out->morph = noh_gl_morph_binding_of(item->model->morph, noh_gl_item_tile(item, shown));
    take_before(stage, k, a, index, out);
    out->is_skinned = k->meshes[index].skinned;
    if (out->is_skinned) out->skin = noh_gl_skin_binding_of(item->skin, shown->place);
    return NOH_OK;
}

const noh_stage_gpu noh_stage_on_gl = { measure_stage,
                                        list_parts,
                                        init,
                                        destroy,
                                        restore,
                                        pose,
                                        upload,
                                        noh_gl_load,
                                        noh_gl_use,
                                        measure_slot,
                                        noh_gl_slot_come,
                                        noh_gl_slot_fill,
                                        noh_gl_slot_close,
                                        NOH_PAGE ? NULL : noh_gl_textures_stream };

/* ---- shaders of your own ---- */

size_t noh_stage_shader_size(const noh_stage *stage)
{
    NOH_ASSERT(stage);
    const noh_stage_gl *gl = stage->gpu;
    noh_arena arena = noh_arena_measure();
    if (!NOH_PAGE && !gl) return 0;
    (void)noh_arena_carve(&arena, sizeof(noh_stage_shader), 16);
    (void)noh_arena_carve(&arena, gl->variants_bytes, 16);
    return arena.used;
}

noh_result noh_stage_shader_create(noh_stage *stage, void *memory, size_t bytes, const noh_gl_shader_desc *desc,
                                   char *log, size_t log_bytes, noh_stage_shader **shader, noh_error *error)
{
    NOH_ASSERT(stage && desc && shader);
    const noh_stage_gl *gl = stage->gpu;
    noh_gl_device device;
    noh_arena arena;
    noh_stage_shader *made;
    void *variants;
    noh_result result = noh_gl_stage_check(stage, error);
    if (result == NOH_OK) result = noh_arena_open(&arena, memory, bytes, noh_stage_shader_size(stage), error);
    if (result != NOH_OK) {
        return result;
    }
    made = noh_arena_carve(&arena, sizeof *made, 16);
    variants = noh_arena_carve(&arena, gl->variants_bytes, 16);
    memset(made, 0, sizeof *made);
    device = gl->device;
    device.log = log;
    device.log_bytes = log_bytes;
    result = make_renderer(gl, stage, desc, &device, variants, gl->variants_bytes, &made->renderer, error);
    if (result == NOH_OK) {
        *shader = made;
    }
    return result;
}

void noh_stage_shader_delete(noh_stage_shader *shader)
{
    NOH_ASSERT(shader);
    noh_gl_renderer_delete(&shader->renderer);
}

noh_result noh_stage_shader_restore(noh_stage_shader *shader, char *log, size_t log_bytes, noh_error *error)
{
    NOH_ASSERT(shader);
    return noh_gl_renderer_restore(&shader->renderer, log, log_bytes, error);
}
