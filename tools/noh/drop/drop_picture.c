/* drop_picture.c: rays against the capsules of all dolls, with a shadow from above. */
#include "drop_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

typedef struct pill {
    float from[3], to[3], radius;
    uint32_t doll;
} pill;

typedef struct scene {
    pill *pills;
    uint32_t count, bodies;
    float (*balls)[4]; /* round each doll: centre, radius */
} scene;

int drop_picture_open(drop_picture *p, uint32_t side)
{
    p->side = side;
    p->drawn = 0;
    p->rgba = calloc((size_t)side * side * DROP_TILES, 4);
    return p->rgba == NULL;
}

void drop_picture_close(drop_picture *p)
{
    free(p->rgba);
    p->rgba = NULL;
}

/* ---- drawing ---- */

static float far_from(const float a[3], const float b[3])
{
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static void take_doll(const drop_scene *s, uint32_t doll, scene *out)
{
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
    float *ball = out->balls[doll];
    noh_ragdoll_bodies(s->set, doll, poses);
    memcpy(ball, poses[0].position, 3 * sizeof *ball);
    ball[3] = 0.0f;
    for (uint32_t i = 0; i < s->rig.body_count; i++) {
        static const float z[3] = { 0.0f, 0.0f, 1.0f };
        const noh_ragdoll_body *b = &s->rig.bodies[i];
        pill *c = &out->pills[doll * s->rig.body_count + i];
        float axis[3];
        noh_quat_rotate(poses[i].rotation, z, axis);
        for (int k = 0; k < 3; k++) {
            c->from[k] = poses[i].position[k] - b->half * axis[k];
            c->to[k] = poses[i].position[k] + b->half * axis[k];
        }
        c->radius = b->radius;
        c->doll = doll;
        const float reach = far_from(ball, poses[i].position) + b->half + b->radius;
        ball[3] = reach > ball[3] ? reach : ball[3];
    }
}

/* The nearest capsule on a ray; its distance, below 0 for none. */
static float hit(const scene *w, const noh_ray *ray, const pill **found)
{
    float best = -1.0f;
    for (uint32_t d = 0; d < w->count / w->bodies; d++) {
        const float *ball = w->balls[d];
        if (noh_ray_capsule(ray, ball, ball, ball[3]) < 0.0f) continue;
        for (uint32_t i = d * w->bodies; i < (d + 1u) * w->bodies; i++) {
            const pill *c = &w->pills[i];
            const float t = noh_ray_capsule(ray, c->from, c->to, c->radius);
            if (t >= 0.0f && (best < 0.0f || t < best)) {
                best = t;
                *found = c;
            }
        }
    }
    return best;
}

/* ---- light ---- */

static const float sun[3] = { 0.42f, 0.81f, 0.41f };

static int in_shadow(const scene *w, const float point[3], const float normal[3])
{
    noh_ray ray = { { 0.0f, 0.0f, 0.0f }, { sun[0], sun[1], sun[2] }, 20.0f };
    const pill *unused;
    for (int i = 0; i < 3; i++) ray.from[i] = point[i] + 2e-3f * normal[i];
    return hit(w, &ray, &unused) >= 0.0f;
}

static void shade(const scene *w, const float point[3], const float normal[3], const float colour[3], uint8_t out[4])
{
    const float facing = normal[0] * sun[0] + normal[1] * sun[1] + normal[2] * sun[2];
    const float direct = facing > 0.0f && !in_shadow(w, point, normal) ? facing : 0.0f;
    const float light = 0.28f + 0.12f * normal[1] + 0.62f * direct;
    for (int i = 0; i < 3; i++) {
        const float value = sqrtf(fminf(colour[i] * light, 1.0f));
        out[i] = (uint8_t)(value * 255.0f + 0.5f);
    }
    out[3] = 255;
}

static void normal_of(const pill *c, const float point[3], float normal[3])
{
    float axis[3], along = 0.0f, square = 0.0f;
    for (int i = 0; i < 3; i++) {
        axis[i] = c->to[i] - c->from[i];
        along += (point[i] - c->from[i]) * axis[i];
        square += axis[i] * axis[i];
    }
    along = square > 0.0f ? fminf(fmaxf(along / square, 0.0f), 1.0f) : 0.0f;
    for (int i = 0; i < 3; i++) normal[i] = (point[i] - c->from[i] - along * axis[i]) / c->radius;
}

static void draw_pixel(const scene *w, const noh_ray *ray, uint8_t out[4])
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    const pill *c = NULL;
    const float t = hit(w, ray, &c);
    const float ground = ray->direction[1] < 0.0f ? -ray->from[1] / ray->direction[1] : -1.0f;
    float point[3], normal[3];
    if (c) {
        const float hue = (float)(c->doll % 8u) * 0.7853982f;
        const float colour[3] = { 0.55f + 0.25f * cosf(hue), 0.55f + 0.25f * cosf(hue - 2.1f),
                                  0.55f + 0.25f * cosf(hue + 2.1f) };
        for (int i = 0; i < 3; i++) point[i] = ray->from[i] + t * ray->direction[i];
        normal_of(c, point, normal);
        shade(w, point, normal, colour, out);
    } else if (ground > 0.0f && ground < ray->distance_max) {
        for (int i = 0; i < 3; i++) point[i] = ray->from[i] + ground * ray->direction[i];
        const int dark = ((int)floorf(point[0]) + (int)floorf(point[2])) & 1; /* squares of a metre */
        const float colour[3] = { dark ? 0.30f : 0.38f, dark ? 0.31f : 0.39f, dark ? 0.33f : 0.41f };
        shade(w, point, up, colour, out);
    } else {
        const uint8_t sky[4] = { 205, 212, 220, 255 };
        memcpy(out, sky, sizeof sky);
    }
}

/* From above and before, so that the whole floor of 8 m is seen; two rays each way in a pixel. */
static noh_ray ray_at(float x, float y)
{
    noh_ray ray = { { 0.0f, 7.0f, 7.5f }, { 0.0f, 0.0f, 0.0f }, 100.0f };
    const float pitch = 0.72f, zoom = 0.50f;
    ray.direction[0] = x * zoom;
    ray.direction[1] = y * zoom * cosf(pitch) - sinf(pitch);
    ray.direction[2] = -y * zoom * sinf(pitch) - cosf(pitch);
    return ray;
}

static void draw_tile(const scene *w, drop_picture *p)
{
    const float step = 2.0f / (float)p->side;
    for (uint32_t k = 0; k < p->side * p->side; k++) {
        const uint32_t row = k / p->side, column = k % p->side;
        uint32_t sum[3] = { 0, 0, 0 };
        uint8_t *out = p->rgba + 4 * ((size_t)row * DROP_TILES * p->side + p->drawn * p->side + column), one[4];
        for (uint32_t n = 0; n < 4; n++) {
            const uint32_t right = n % 2u, below = n / 2u;
            const float x = (float)column + 0.25f + 0.5f * (float)right;
            const float y = (float)row + 0.25f + 0.5f * (float)below;
            const noh_ray ray = ray_at(x * step - 1.0f, 1.0f - y * step);
            draw_pixel(w, &ray, one);
            for (int i = 0; i < 3; i++) sum[i] += one[i];
        }
        for (int i = 0; i < 3; i++) out[i] = (uint8_t)(sum[i] / 4u);
        out[3] = 255;
    }
}

void drop_picture_draw(drop_picture *p, const drop_scene *s)
{
    scene w = { NULL, s->dolls * s->rig.body_count, s->rig.body_count, NULL };
    w.pills = malloc(w.count * sizeof *w.pills);
    w.balls = malloc(s->dolls * sizeof *w.balls);
    if (w.pills && w.balls && p->drawn < DROP_TILES) {
        for (uint32_t i = 0; i < s->dolls; i++) take_doll(s, i, &w);
        draw_tile(&w, p);
        p->drawn++;
    }
    free(w.balls);
    free(w.pills);
}
