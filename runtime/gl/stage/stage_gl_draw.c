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

static int is_seen(const drawing *d, uint32_t place)
{
    return (int)(shown_at(d, place)->views >> d->view & 1u);
}

/* Whether the view sees an actor and the actor has the mesh on. */
static int shows(const drawing *d, uint32_t mesh, uint32_t place)
{
    return is_seen(d, place) && !(actor_at(d, place)->look.hidden_meshes >> mesh & 1u);
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

static uint32_t mesh_level(const drawing *d, uint32_t mesh, uint32_t level)
{
    return d->k->plan->levels[level].mesh_levels[mesh];
}

/* Set the wrinkles of an actor's expression on a mesh, for the next draw. */
static void set_wrinkles(const drawing *d, uint32_t mesh, uint32_t place)
{
    const noh_stage_mesh *m = &d->k->meshes[mesh];
    const noh_appearance *look = &actor_at(d, place)->look;
    const float *weights = d->k->weights + (size_t)d->k->order[place] * d->k->weight_count + m->first_weight;
    float regions[NOH_WRINKLE_REGIONS];
    noh_wrinkles wrinkles;
    const int has_regions = noh_wrinkles_of(&m->mesh, &wrinkles, NULL) == NOH_OK;
    if (has_regions) noh_wrinkles_weights(&wrinkles, weights, regions);
    noh_gl_draw_wrinkles(d->renderer, has_regions ? regions : NULL);
    noh_gl_draw_wrinkle_look(d->renderer, look->wrinkle_models, look->smoothed);
}

/* Draw one actor's mesh at one level, in a share of the pixels. */
static void draw_alone(const drawing *d, uint32_t mesh, uint32_t place, uint32_t level, float from, float to)
{
    const noh_gl_item *item = &d->on_gl->items[mesh];
    const noh_stage_mesh *m = &d->k->meshes[mesh];
    const noh_stage_shown *shown = shown_at(d, place);
    const noh_gl_lod lod = { mesh_level(d, mesh, level), from, to };
    const noh_character *ch = noh_stage_character(d->k, d->k->order[place]);
    const noh_gl_skin_binding skin = skin_of(item, place, noh_lod_influence_count(&ch->lod, &d->k->table));
    const float *weights = d->k->weights + (size_t)d->k->order[place] * d->k->weight_count + m->first_weight;
    const int is_morphed = noh_gl_has_tile(item, shown);
    noh_gl_morph_binding morph;
    float world[12];
    memcpy(world, shown->world, sizeof world);
    if (!m->skinned && m->node_world) noh_matrix_multiply(shown->world, m->node_world, world);
    if (is_morphed) morph = noh_gl_morph_binding_of(item->model->morph, noh_gl_item_tile(item, shown));
    if (is_morphed && !noh_gl_any_weight(weights, m->mesh.header->target_count)) morph.touched = 0; /* no deltas */
    noh_gl_draw_tint(d->renderer, noh_stage_tint_of(actor_at(d, place)));
    noh_gl_draw_user(d->renderer, d->s->desc.user_values ? actor_at(d, place)->look.user : NULL);
    set_wrinkles(d, mesh, place);
    set_cover(d, mesh, place);
    noh_gl_draw_mesh(d->renderer, &item->model->mesh, world, is_morphed ? &morph : NULL, m->skinned ? &skin : NULL,
                     &lod, pictures_of(d, place), d->pass);
}

/* Draw a fading actor: the new level and the old one, each in its share of the pixels. */
static uint32_t shares_of(const drawing *d, uint32_t mesh, uint32_t place, noh_gl_share shares[2])
{
    const noh_stage_shown *shown = shown_at(d, place);
    const noh_character *ch = noh_stage_character(d->k, d->k->order[place]);
    const float part = noh_lod_fade(&ch->lod, ch->time.clock);
    const int fades = d->renderer->fades &&
                      mesh_level(d, mesh, shown->level) != mesh_level(d, mesh, shown->level_before);
    shares[0] = (noh_gl_share){ shown->level, 0.0f, fades ? part : 1.0f };
    shares[1] = (noh_gl_share){ shown->level_before, part, 1.0f };
    return fades ? 2u : 1u;
}

static void draw_fading(const drawing *d, uint32_t mesh, uint32_t place)
{
    noh_gl_share shares[2];
    const uint32_t count = shares_of(d, mesh, place, shares);
    for (uint32_t i = 0; i < count; i++) draw_alone(d, mesh, place, shares[i].level, shares[i].from, shares[i].to);
}

/* Streams belong to one instance: it is drawn alone. */
static int has_streams(const noh_gl_item *item)
{
    return item->model->morph && noh_gl_morph_plan_of(item->model->morph)->path == NOH_MORPH_STREAMS;
}

/* Draw visible neighbours of a run with the same textures in one call. */
static void draw_together(const drawing *d, uint32_t mesh, uint32_t run, uint32_t first, uint32_t count)
{
    const uint32_t caps = noh_stage_influence_levels(d->k);
    const noh_gl_item *item = &d->on_gl->items[mesh];
    const uint32_t influences = d->k->table.influence_level_count ? d->k->table.influences[run % caps].influence_count
                                                                  : 0;
    const noh_gl_lod lod = { mesh_level(d, mesh, run / caps), 0.0f, 1.0f };
    const noh_gl_skin_binding skin = skin_of(item, first, influences);
    noh_gl_morph_binding morph;
    if (!noh_gl_is_crowd(d->k) || has_streams(item)) {
        for (uint32_t i = 0; i < count; i++) draw_alone(d, mesh, first + i, run / caps, 0.0f, 1.0f);
        return;
    }
    if (item->model->morph) { /* of any tile: it names the texture */
        const uint32_t tile = noh_gl_morph_instance(item->model->morph, item->first_pool, 0);
        morph = noh_gl_morph_binding_of(item->model->morph, tile);
    }
    noh_gl_draw_wrinkle_look(d->renderer, actor_at(d, first)->look.wrinkle_models, actor_at(d, first)->look.smoothed);
    set_cover(d, mesh, first);
    noh_gl_draw_crowd(d->renderer, &item->model->mesh, item->model->morph ? &morph : NULL, &skin, count, &lod,
                      pictures_of(d, first), d->pass);
}

/* Whether two actors can be drawn together. */
static int wear_the_same(const drawing *d, uint32_t a, uint32_t b)
{
    const noh_appearance *of_a = &actor_at(d, a)->look, *of_b = &actor_at(d, b)->look;
    return of_a->texture_set == of_b->texture_set && of_a->wrinkle_models == of_b->wrinkle_models &&
           of_a->smoothed == of_b->smoothed && shown_at(d, a)->cover == shown_at(d, b)->cover;
}

static int is_mirrored(const drawing *d, uint32_t mesh, uint32_t place)
{
    return noh_gl_is_mirrored(&d->on_gl->items[mesh], actor_at(d, place), shown_at(d, place));
}

static void draw_run(const drawing *d, uint32_t mesh, uint32_t run)
{
    const uint32_t caps = noh_stage_influence_levels(d->k);
    const uint32_t end = d->k->runs[run + 1u];
    uint32_t at = d->k->runs[run];
    while (at < end) {
        uint32_t first;
        while (at < end && !shows(d, mesh, at)) at++;
        first = at;
        while (at < end && shows(d, mesh, at) && wear_the_same(d, at, first) && !is_mirrored(d, mesh, at)) at++;
        if (at > first) {
            draw_together(d, mesh, run, first, at - first);
        } else if (at < end) {
            draw_alone(d, mesh, at++, run / caps, 0.0f, 1.0f);
        }
    }
}

/* ---- blended meshes, from far to near ---- */

static void move_point(const float *matrix, const float *p, float out[3])
{
    for (int i = 0; i < 3; i++) {
        const float *row = matrix + 4 * i;
        out[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
    }
}

/* The centre of a mesh's bounds, moved by the mean of its joints. */
static void move_skinned(const noh_character *ch, const noh_skin *skin, const float middle[3], float out[3])
{
    const float *palette = noh_character_pose_palette(ch, ch->time.to_pose);
    const int multiplied = (int)(ch->multiplied >> ch->time.to_pose & 1u);
    const uint32_t count = skin->header->joint_count;
    float sum[3] = { 0.0f, 0.0f, 0.0f };
    for (size_t k = 0; k < count; k++) {
        float bound[3], p[3];
        memcpy(bound, middle, sizeof bound);
        if (!multiplied) move_point(skin->inverse_bind + 12u * k, middle, bound);
        move_point(palette + 12u * skin->joints[k], bound, p);
        for (int i = 0; i < 3; i++) sum[i] += p[i];
    }
    for (int i = 0; i < 3; i++) out[i] = sum[i] / (float)count;
}

/* The squared distance of a mesh from the eye. */
static float distance_of(const drawing *d, uint32_t mesh, uint32_t place)
{
    const noh_stage_mesh *m = &d->k->meshes[mesh];
    const noh_mesh_header *h = m->mesh.header;
    const float *eye = d->s->views[d->view].eye, *world = shown_at(d, place)->world;
    float p[3], at[3], square = 0.0f;
    for (int i = 0; i < 3; i++) p[i] = 0.5f * (h->bounds_min[i] + h->bounds_max[i]);
    if (m->skinned) {
        move_skinned(noh_stage_character(d->k, d->k->order[place]), &m->skin, p, at);
    } else if (m->node_world) {
        move_point(m->node_world, p, at);
    } else {
        memcpy(at, p, sizeof at);
    }
    move_point(world, at, p);
    for (int i = 0; i < 3; i++) square += (p[i] - eye[i]) * (p[i] - eye[i]);
    return square;
}

/* Draw one actor's meshes of a priority. At equal distance the first in the pack is drawn first. */
static void draw_sorted(const drawing *d, const uint8_t *meshes, uint32_t count, uint32_t place, uint32_t run)
{
    float distances[NOH_STAGE_MESHES_MAX];
    uint8_t sorted[NOH_STAGE_MESHES_MAX];
    for (uint32_t i = 0; i < count; i++) {
        const float distance = distance_of(d, meshes[i], place);
        uint32_t at = i;
        for (; at && distances[at - 1u] < distance; at--) {
            distances[at] = distances[at - 1u];
            sorted[at] = sorted[at - 1u];
        }
        distances[at] = distance;
        sorted[at] = meshes[i];
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!shows(d, sorted[i], place)) continue;
        if (run == NOH_NONE) {
            draw_fading(d, sorted[i], place);
        } else {
            draw_together(d, sorted[i], run, place, 1);
        }
    }
}

static void draw_meshes(const drawing *d, const uint8_t *meshes, uint32_t count)
{
    const uint32_t runs = noh_stage_run_count(d->k);
    for (uint32_t run = 0; run < runs; run++) {
        if (count == 1u) {
            draw_run(d, meshes[0], run);
            continue;
        }
        for (uint32_t p = d->k->runs[run]; p < d->k->runs[run + 1u]; p++) {
            if (is_seen(d, p)) draw_sorted(d, meshes, count, p, run);
        }
    }
    for (uint32_t p = d->k->runs[runs]; p < d->k->runs[runs + 1u]; p++) {
        if (is_seen(d, p)) draw_sorted(d, meshes, count, p, NOH_NONE);
    }
}

/* Draw by priority, and within a priority each actor's meshes from far to near. A priority with one mesh is drawn for
 * all actors of a run at once. */
static void draw_blended(const drawing *d)
{
    int priority = -NOH_PRIORITY_ANY;
    for (;;) {
        uint8_t meshes[NOH_STAGE_MESHES_MAX];
        uint32_t count = 0;
        int next = NOH_PRIORITY_ANY;
        for (uint32_t m = 0; m < d->k->plan->mesh_count; m++) {
            const int p = noh_gl_next_priority(&d->on_gl->items[m].model->mesh.mesh, priority);
            if (p > next || p == NOH_PRIORITY_ANY) continue;
            if (p < next) count = 0;
            next = p;
            meshes[count++] = (uint8_t)m;
        }
        if (!count) break;
        noh_gl_draw_priority(d->renderer, next);
        draw_meshes(d, meshes, count);
        priority = next;
    }
    noh_gl_draw_priority(d->renderer, NOH_PRIORITY_ANY);
}

static void draw_kind(const drawing *d)
{
    const uint32_t runs = noh_stage_run_count(d->k);
    for (uint32_t m = 0; m < d->k->plan->mesh_count; m++) {
        for (uint32_t run = 0; run < runs; run++) draw_run(d, m, run);
        for (uint32_t p = d->k->runs[runs]; p < d->k->runs[runs + 1u]; p++) {
            if (shows(d, m, p)) draw_fading(d, m, p);
        }
    }
}

static void draw_pass(drawing *d, int pass)
{
    d->pass = pass;
    for (uint32_t i = 0; i < d->s->desc.kind_count; i++) {
        d->k = &d->s->kinds[i];
        d->on_gl = &d->gl->kinds[i];
        if (pass == NOH_DRAW_BLENDED) {
            draw_blended(d);
        } else {
            draw_kind(d);
        }
    }
}

/* Check that a view can be drawn. */
static noh_result check_draw(const noh_stage *stage, uint32_t view, int is_colour, noh_error *error)
{
    if (stage->phase != NOH_STAGE_IDLE || view >= stage->view_count) {
        return noh_fail(error, NOH_ERR_ARG, "the last frame has no such view, or noh_stage_frame_end was not called",
                        view, stage->view_count);
    }
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
}

noh_result noh_stage_draw(noh_stage *stage, noh_pass pass, uint32_t view, noh_stage_shader *shader, noh_error *error)
{
    drawing d;
    noh_result result;
    NOH_ASSERT(stage && stage->gpu);
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
    if (!a || shown->frame != stage->frame || !(shown->views >> view & 1u)) {
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

uint32_t noh_gl_alone_shares(const noh_gl_alone *alone, uint32_t index, noh_gl_share shares[2])
{
    return shares_of(&alone->drawing, index, alone->place, shares);
}

noh_mesh noh_gl_alone_level(const noh_gl_alone *alone, uint32_t index, uint32_t level)
{
    const drawing *d = &alone->drawing;
    size_t first;
    return noh_gl_mesh_lod(&d->on_gl->items[index].model->mesh, mesh_level(d, index, level), &first);
}

void noh_gl_draw_alone(const noh_gl_alone *alone, uint32_t index, const noh_gl_share *share)
{
    if (!shows(&alone->drawing, index, alone->place)) return;
    draw_alone(&alone->drawing, index, alone->place, share->level, share->from, share->to);
}

void noh_stage_set_lighting(noh_stage *stage, const noh_lighting *lighting)
{
    NOH_ASSERT(stage && stage->gpu && stage->desc.light);
    ((noh_stage_gl *)stage->gpu)->lighting = lighting;
}

const noh_gl_light *noh_stage_light_of(const noh_stage *stage)
{
    NOH_ASSERT(stage && stage->gpu);
    return ((const noh_stage_gl *)stage->gpu)->light;
}

noh_result noh_stage_draw_shadow(noh_stage *stage, uint32_t view, noh_error *error)
{
    const noh_stage_gl *gl = stage->gpu;
    noh_result result;
    NOH_ASSERT(gl);
    if (!gl->light || !gl->light->framebuffer) {
        return noh_fail(error, NOH_ERR_ARG, "the stage has no shadow map: set noh_gl_light_desc.shadow_px", 0, 0);
    }
    noh_gl_light_begin_shadow(gl->light);
    result = noh_stage_draw(stage, NOH_PASS_DEPTH, view, NULL, error);
    noh_gl_light_end_shadow(gl->light, stage->views[view].view_projection, gl->lighting ? &gl->lighting_less : NULL);
    return result;
}
