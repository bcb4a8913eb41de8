/* stage_gl_draw.c: one pass of a view. */
#include <string.h>

#include "stage/character/character_internal.h"
#include "core/base/assert_internal.h"
#include "gl/draw/gl_draw_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gl/stage/stage_gl_internal.h"
#include "stage/character/lod_internal.h"
#include "gl/draw/gl_renderer_internal.h"
#include "gl/draw/gl_light_internal.h"

typedef noh_gl_drawing drawing;

static const noh_stage_shown *shown_at(const drawing *d, uint32_t place)
{
    return &d->s->shown[d->k->first_actor + d->k->order[place]];
}

static const noh_stage_actor *actor_at(const drawing *d, uint32_t place)
{
    return &d->k->actors[d->k->order[place]];
}

/* The textures of an actor. */
static const noh_gl_texture *pictures_of(const drawing *d, uint32_t place)
{
    return d->on_gl->pictures +
           (size_t)actor_at(d, place)->look.texture_set * d->k->desc->mesh->runs[NOH_CHUNK_TEXTURE].count;
}

/* Draw next what an actor's garments leave of a mesh. */
static void set_cover(const drawing *d, uint32_t mesh, uint32_t place)
{
    const uint32_t cover = shown_at(d, place)->cover;
    noh_gl_draw_cover(d->renderer, cover ? d->on_gl->covers[cover - 1u].indices[mesh].name : 0);
}

static noh_gl_skin_binding skin_of(const noh_gl_item *item, uint32_t place, uint32_t influences)
{
    noh_gl_skin_binding binding = noh_gl_skin_binding_of(item->skin, place);
    binding.influences = influences;
    return binding;
}

/* Set an actor's tint and values, and the wrinkles of its expression on a mesh, for the next draw. */
static void set_instance(const drawing *d, uint32_t mesh, uint32_t place)
{
    const noh_stage_mesh *m = &d->k->meshes[mesh];
    const noh_stage_actor *actor = actor_at(d, place);
    const noh_appearance *look = &actor->look;
    const float *weights = d->k->weights + (size_t)d->k->order[place] * d->k->weight_count + m->first_weight;
    float regions[NOH_WRINKLE_REGIONS];
    noh_wrinkles wrinkles;
    const int has_regions = noh_wrinkles_of(&m->mesh, &wrinkles, NULL) == NOH_OK;
    if (has_regions) noh_wrinkles_weights(&wrinkles, weights, regions);
    noh_gl_draw_instance(d->renderer, noh_stage_tint_of(actor), d->s->desc.user_values ? look->user : NULL,
                         has_regions ? regions : NULL);
    noh_gl_draw_wrinkle_look(d->renderer, look->wrinkle_models, look->smoothed);
}

/* Where an actor's mesh was in the last frame, for the next draw. */
static void set_before(drawing *d, uint32_t mesh, uint32_t place)
{
    noh_gl_morph_binding morph;
    memset(d->before.tile, 0, sizeof d->before.tile);
    if (noh_gl_motion_of(d->s, d->k, d->k->order[place], mesh, d->before.world, &morph)) {
        noh_gl_tile_floats(&morph, d->before.tile);
    }
}

/* Draw the mesh of one of the actors. */
static void draw_alone(drawing *d, const noh_stage_drawing *of, uint32_t place)
{
    const uint32_t mesh = of->mesh;
    const noh_gl_item *item = &d->on_gl->items[mesh];
    const noh_stage_mesh *m = &d->k->meshes[mesh];
    const noh_stage_shown *shown = shown_at(d, place);
    const noh_gl_lod lod = { noh_stage_mesh_level(d->k, mesh, of->level), of->from, of->to };
    const noh_gl_skin_binding skin = skin_of(item, place, of->influence_count);
    const float *weights = d->k->weights + (size_t)d->k->order[place] * d->k->weight_count + m->first_weight;
    const int is_morphed = noh_gl_has_tile(item, shown);
    noh_gl_morph_binding morph;
    float world[12];
    memcpy(world, shown->world, sizeof world);
    if (!m->skinned && m->node_world) noh_matrix_multiply(shown->world, m->node_world, world);
    if (is_morphed) morph = noh_gl_morph_binding_of(item->model->morph, noh_gl_item_tile(item, shown));
    if (is_morphed && !noh_gl_any_weight(weights, m->mesh.header->target_count)) morph.touched = 0; /* no deltas */
    set_instance(d, mesh, place);
    set_cover(d, mesh, place);
    if (d->s->desc.motion) set_before(d, mesh, place);
    noh_gl_draw_mesh(d->renderer, &item->model->mesh, world, is_morphed ? &morph : NULL, m->skinned ? &skin : NULL,
                     &lod, pictures_of(d, place), d->pass);
}

/* Streams belong to one instance: it is drawn alone. */
static int has_streams(const noh_gl_item *item)
{
    return item->model->morph && noh_gl_morph_plan_of(item->model->morph)->path == NOH_MORPH_STREAMS;
}

/* Draw neighbours in one call. */
static void draw_crowd(const drawing *d, const noh_stage_drawing *of)
{
    const noh_gl_item *item = &d->on_gl->items[of->mesh];
    const noh_gl_lod lod = { noh_stage_mesh_level(d->k, of->mesh, of->level), of->from, of->to };
    const noh_gl_skin_binding skin = skin_of(item, of->first, of->influence_count);
    const noh_appearance *look = &actor_at(d, of->first)->look;
    noh_gl_morph_binding morph;
    if (item->model->morph) { /* of any tile: it names the texture */
        const uint32_t tile = noh_gl_morph_instance(item->model->morph, item->first_pool, 0);
        morph = noh_gl_morph_binding_of(item->model->morph, tile);
    }
    noh_gl_draw_wrinkle_look(d->renderer, look->wrinkle_models, look->smoothed);
    set_cover(d, of->mesh, of->first);
    noh_gl_draw_crowd(d->renderer, &item->model->mesh, item->model->morph ? &morph : NULL, &skin, of->count, &lod,
                      pictures_of(d, of->first), d->pass);
}

static void draw_one(void *user, const noh_stage_drawing *of)
{
    drawing *d = user;
    d->k = of->k;
    d->on_gl = &d->gl->kinds[of->k - d->s->kinds];
    if (d->pass == NOH_DRAW_BLENDED) noh_gl_draw_priority(d->renderer, of->priority);
    if (noh_gl_is_crowd(of->k) && !of->alone && !has_streams(&d->on_gl->items[of->mesh])) {
        draw_crowd(d, of);
        return;
    }
    for (uint32_t i = 0; i < of->count; i++) draw_alone(d, of, of->first + i);
}

static void draw_pass(drawing *d, int pass)
{
    const noh_stage_pass p = { d->s, d->view, pass == NOH_DRAW_BLENDED, d->renderer->fades, draw_one, d };
    d->pass = pass;
    noh_stage_draw_pass(&p);
    noh_gl_draw_priority(d->renderer, NOH_PRIORITY_ANY);
}

noh_result noh_gl_stage_check(const noh_stage *stage, noh_error *error)
{
    if (NOH_PAGE || stage->gpu) return NOH_OK;
    return noh_fail(error, NOH_ERR_ARG, "the stage draws nothing: set noh_stage_desc.gpu to &noh_stage_on_gl", 0, 0);
}

/* Check that a view can be drawn. */
static noh_result check_draw(const noh_stage *stage, uint32_t view, int is_colour, noh_error *error)
{
    if (stage->phase != NOH_STAGE_IDLE || view >= stage->view_count) {
        return noh_fail(error, NOH_ERR_ARG, "the last frame has no such view, or noh_stage_frame_end was not called",
                        view, stage->view_count);
    }
    const noh_result result = noh_gl_stage_check(stage, error);
    if (result) return result;
    if (stage->desc.light && is_colour && !((const noh_stage_gl *)stage->gpu)->lighting) {
        return noh_fail(error, NOH_ERR_ARG, "the stage has a light: call noh_stage_set_lighting before drawing", 0, 0);
    }
    return NOH_OK;
}

void noh_gl_lighting_less(const noh_lighting *lighting, const float origin[3], noh_lighting *out)
{
    *out = *lighting;
    noh_projection_less(out->shadow, origin, NULL);
    out->floor -= origin[1];
}

static void begin_draw(drawing *d, const noh_stage *stage, noh_gl_renderer *renderer, uint32_t view)
{
    noh_gl_camera camera;
    memset(d, 0, sizeof *d);
    d->s = stage;
    d->gl = stage->gpu;
    d->renderer = renderer;
    d->view = view;
    memcpy(camera.view_projection, stage->views[view].view_projection, sizeof camera.view_projection);
    memcpy(camera.eye, stage->views[view].eye, sizeof camera.eye);
    memcpy(camera.key, stage->views[view].light, sizeof camera.key);
    if (stage->desc.light && d->gl->lighting) {
        noh_lighting *near_by = &((noh_stage_gl *)stage->gpu)->lighting_less;
        noh_gl_lighting_less(d->gl->lighting, stage->origin, near_by);
        noh_gl_renderer_light(renderer, d->gl->light, near_by);
    }
    noh_gl_draw_begin(renderer, &camera);
    if (!stage->desc.motion) return;
    noh_gl_motion_view(stage, view, d->before.view_projection);
    noh_gl_draw_before(renderer, &d->before);
}

noh_result noh_stage_draw(noh_stage *stage, noh_pass pass, uint32_t view, noh_stage_shader *shader, noh_error *error)
{
    drawing d;
    noh_result result;
    NOH_ASSERT(stage && (uint32_t)pass <= NOH_PASS_DEPTH);
    if ((stage->desc.without_shader && !shader) || (stage->desc.without_depth && pass == NOH_PASS_DEPTH)) {
        return noh_fail(error, NOH_ERR_ARG,
                        "this draw needs shaders that noh_stage_desc excludes: without_shader or without_depth",
                        (uint64_t)pass, 0);
    }
    result = check_draw(stage, view, pass != NOH_PASS_DEPTH, error);
    if (result) return result;
    begin_draw(&d, stage, shader ? &shader->renderer : ((noh_stage_gl *)stage->gpu)->renderer, view);
    if (pass == NOH_PASS_DEPTH) {
        draw_pass(&d, NOH_DRAW_DEPTH);
    } else {
        if (pass != NOH_PASS_BLENDED) draw_pass(&d, NOH_DRAW_OPAQUE);
        if (pass != NOH_PASS_OPAQUE) draw_pass(&d, NOH_DRAW_BLENDED);
    }
    noh_gl_draw_end(d.renderer);
    return NOH_OK;
}

/* ---- one actor ---- */

noh_result noh_gl_begin_alone(const noh_stage *stage, noh_gl_renderer *renderer, uint32_t view, noh_actor actor,
                              noh_gl_alone *alone, noh_error *error)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const noh_stage_shown *shown;
    noh_result result = check_draw(stage, view, 1, error);
    if (result) return result;
    shown = a ? &stage->shown[a - stage->actors] : NULL;
    if (!a || k->finer.hidden || shown->frame != stage->frame || !(shown->views >> view & 1u)) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the actor is gone, or the view did not see it in the last frame",
                        actor.id, 0);
    }
    begin_draw(&alone->drawing, stage, renderer, view);
    alone->drawing.k = k;
    alone->drawing.on_gl = &alone->drawing.gl->kinds[k - stage->kinds];
    alone->drawing.pass = NOH_DRAW_OPAQUE;
    alone->place = shown->place;
    alone->mesh_count = k->plan->mesh_count;
    return NOH_OK;
}

uint32_t noh_gl_alone_mesh(const noh_gl_alone *alone, uint32_t index)
{
    return alone->drawing.k->meshes[index].item.mesh;
}

uint32_t noh_gl_alone_shares(const noh_gl_alone *alone, uint32_t index, noh_stage_part shares[2])
{
    const drawing *d = &alone->drawing;
    return noh_stage_parts_of(d->k, shown_at(d, alone->place), index, d->renderer->fades, shares);
}

noh_mesh noh_gl_alone_level(const noh_gl_alone *alone, uint32_t index, uint32_t level)
{
    const drawing *d = &alone->drawing;
    size_t first;
    return noh_gl_mesh_lod(&d->on_gl->items[index].model->mesh, noh_stage_mesh_level(d->k, index, level), &first);
}

void noh_gl_draw_alone(noh_gl_alone *alone, uint32_t index, const noh_stage_part *share)
{
    drawing *d = &alone->drawing;
    const noh_stage_drawing of = noh_stage_drawing_alone(d->k, index, alone->place, *share);
    if (!(actor_at(d, alone->place)->look.hidden_meshes >> index & 1u)) draw_alone(d, &of, alone->place);
}

void noh_stage_set_lighting(noh_stage *stage, const noh_lighting *lighting)
{
    NOH_ASSERT(stage);
    if (NOH_PAGE || stage->gpu) ((noh_stage_gl *)stage->gpu)->lighting = lighting;
}

const noh_gl_light *noh_stage_light_of(const noh_stage *stage)
{
    NOH_ASSERT(stage);
    return NOH_PAGE || stage->gpu ? ((const noh_stage_gl *)stage->gpu)->light : NULL;
}

noh_result noh_stage_draw_shadow(noh_stage *stage, uint32_t view, noh_error *error)
{
    const noh_stage_gl *gl = stage->gpu;
    noh_result result = noh_gl_stage_check(stage, error);
    if (result) return result;
    if (!gl->light || !gl->light->framebuffer) {
        return noh_fail(error, NOH_ERR_ARG, "the stage has no shadow map: set noh_gl_light_desc.shadow_px", 0, 0);
    }
    noh_gl_light_begin_shadow(gl->light);
    result = noh_stage_draw(stage, NOH_PASS_DEPTH, view, NULL, error);
    noh_gl_light_end_shadow(gl->light, stage->views[view].view_projection, gl->lighting ? &gl->lighting_less : NULL);
    return result;
}
