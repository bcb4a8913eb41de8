/* crowd_draw.c: a frame of a crowd on the GPU, and its camera. */
#include <math.h>
#include <string.h>

#include "crowd.h"

#define NEAR_M 0.2f
#define FAR_M 250.0f

void crowd_send(crowd *c)
{
    noh_gl_morph_update(c->morph, &c->stats.morph);
    noh_gl_skin_update(c->palettes);
}

/* ---- drawing ---- */

/* One run: one instanced draw per submesh. */
static void draw_run(crowd *c, uint32_t run, int pass)
{
    const uint32_t first = c->runs[run], count = c->runs[run + 1u] - first, caps = c->table.influence_level_count;
    const noh_gl_lod lod = { run / caps, 0.0f, 1.0f };
    const noh_gl_morph_binding morph = noh_gl_morph_binding_of(c->morph, 0); /* any instance: they share a texture */
    noh_gl_skin_binding skin = noh_gl_skin_binding_of(c->palettes, first);
    skin.influences = c->table.influences[run % caps].influence_count;
    noh_gl_draw_crowd(&c->renderer, &c->gl_mesh, &morph, &skin, count, &lod, c->pictures, pass);
}

/* A fading body: the incoming and the outgoing level, each with its share of the pixels. */
static void draw_fading(crowd *c, uint32_t i, int pass)
{
    const noh_character *ch = crowd_character(c, i);
    const crowd_body *b = &c->bodies[i];
    const float part = noh_lod_fade(&ch->lod, noh_character_clock(ch));
    const noh_gl_lod lods[2] = { { b->level, 0.0f, part }, { b->level_before, part, 1.0f } };
    const noh_gl_morph_binding morph = noh_gl_morph_binding_of(
        c->morph, noh_gl_morph_instance(c->morph, b->slot.pool, b->slot.slot));
    noh_gl_skin_binding skin = noh_gl_skin_binding_of(c->palettes, b->place);
    skin.influences = noh_lod_influence_count(&ch->lod, &c->table);
    for (int k = 0; k < 2; k++) {
        noh_gl_draw_mesh(&c->renderer, &c->gl_mesh, b->world, &morph, &skin, &lods[k], c->pictures, pass);
    }
}

void crowd_draw(crowd *c, const crowd_camera *camera)
{
    const uint32_t runs = crowd_run_count(c);
    noh_gl_draw_begin(&c->renderer, &camera->gl);
    for (int pass = NOH_DRAW_OPAQUE; pass <= NOH_DRAW_BLENDED; pass++) {
        for (uint32_t run = 0; run < runs; run++) {
            if (c->runs[run + 1u] > c->runs[run]) {
                draw_run(c, run, pass);
            }
        }
        for (uint32_t k = c->runs[runs]; k < c->stats.seen; k++) {
            draw_fading(c, c->order[k], pass);
        }
    }
    noh_gl_draw_end(&c->renderer);
}

/* ---- the camera ---- */

/* Column-major: clip = projection * view * (position, 1). */
static void fill_matrix(crowd_camera *v, float slope_x, float slope_y)
{
    const float a = -(FAR_M + NEAR_M) / (FAR_M - NEAR_M), b = -2.0f * FAR_M * NEAR_M / (FAR_M - NEAR_M);
    float along[3] = { 0.0f, 0.0f, 0.0f };
    float *m = v->gl.view_projection;
    for (int i = 0; i < 3; i++) {
        m[4 * i] = v->right[i] / slope_x;
        m[4 * i + 1] = v->up[i] / slope_y;
        m[4 * i + 2] = -a * v->forward[i];
        m[4 * i + 3] = v->forward[i];
        along[0] += v->right[i] * v->eye[i];
        along[1] += v->up[i] * v->eye[i];
        along[2] += v->forward[i] * v->eye[i];
    }
    m[12] = -along[0] / slope_x;
    m[13] = -along[1] / slope_y;
    m[14] = a * along[2] + b;
    m[15] = -along[2];
}

crowd_camera crowd_camera_at(const crowd *c, const float eye[3], float heading_rad, float down_rad)
{
    const crowd_options *o = &c->plan->options;
    const float slope_y = tanf(0.5f * o->field_of_view_rad), slope_x = slope_y * (float)o->width / (float)o->height;
    const float angles[2] = { atanf(slope_x), 0.5f * o->field_of_view_rad };
    const float forward[3] = { sinf(heading_rad) * cosf(down_rad), -sinf(down_rad),
                               -cosf(heading_rad) * cosf(down_rad) };
    const float right[3] = { cosf(heading_rad), 0.0f, sinf(heading_rad) };
    const float key[3] = { -0.424f, 0.778f, 0.463f };
    crowd_camera v;
    memset(&v, 0, sizeof v);
    memcpy(v.eye, eye, sizeof v.eye);
    memcpy(v.gl.eye, eye, sizeof v.gl.eye);
    memcpy(v.gl.key, key, sizeof key);
    memcpy(v.forward, forward, sizeof forward);
    memcpy(v.right, right, sizeof right);
    for (int i = 0; i < 3; i++) {
        v.up[i] = right[(i + 1) % 3] * forward[(i + 2) % 3] - right[(i + 2) % 3] * forward[(i + 1) % 3];
    }
    for (int i = 0; i < 2; i++) {
        v.sine[i] = sinf(angles[i]);
        v.cosine[i] = cosf(angles[i]);
    }
    fill_matrix(&v, slope_x, slope_y);
    return v;
}

crowd_camera crowd_camera_start(const crowd *c)
{
    static const float eye[3] = { 0.0f, 4.0f, 0.0f };
    return crowd_camera_at(c, eye, 0.0f, 0.14f);
}
