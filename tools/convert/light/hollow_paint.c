#include "hollow_paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/model/surface_kind.h"
#include "light_rays.h"
#include "light_surface.h"
#include "noh/format.h"

#define RAYS 64u  /* over the whole sphere */
#define HELD 0.9f /* of a vertex's weights: one joint moves it alone */
#define NOT_HELD UINT32_MAX
#define TRACED_MAX (1u << 21) /* at most half a minute; a mesh that needs more stays as it is */
#define SHUT 0.10f
#define OPEN 0.40f /* shares of the light: darkest at one, unchanged at the other */

/* Light that skin has reflected several times is red. */
static const float deep[3] = { 0.15f, 0.08f, 0.07f };

/* The skin of a mesh, or what one joint moves alone of it: no pose opens its hollows. */
typedef struct skin {
    model_mesh *mesh;
    uint32_t held_by;  /* joint; without joints 0 */
    uint32_t *corners; /* [count][3] */
    uint32_t count;
    float *triangles; /* [count][9] in the pose */
    float *open;      /* [vertex_count] the largest share of light of the poses so far; 1: not of the skin */
    float least;
    uint32_t traced; /* rays so far */
    ray_tree tree;
} skin;

static int is_skin(const model *m, const model_mesh *mesh, const model_submesh *part)
{
    const model_material *of = part->material == MODEL_NONE ? NULL : &m->materials[part->material];
    return of && of->surface == NOH_SURFACE_SKIN && !of->surface_given && of->alpha == MODEL_ALPHA_OPAQUE &&
           of->base_color_texture == MODEL_NONE && surface_is_white(mesh, part);
}

static uint32_t holder_of(const model_mesh *mesh, uint32_t v)
{
    const size_t first = (size_t)v * MODEL_INFLUENCES_MAX;
    if (!mesh->joints) return 0;
    return mesh->joint_weights[first] >= HELD ? mesh->joints[first] : NOT_HELD;
}

/* The place of a vertex, or its normal, in the pose of a target; NULL: at rest. */
static void posed(const float *base, const float *delta, uint32_t v, float out[3])
{
    for (size_t c = 0; c < 3; c++) out[c] = base[3 * (size_t)v + c] + (delta ? delta[3 * (size_t)v + c] : 0.0f);
}

static void pose(skin *s, const model_target *target)
{
    for (uint32_t i = 0; i < 3u * s->count; i++) {
        posed(s->mesh->position, target ? target->position : NULL, s->corners[i], s->triangles + 3u * (size_t)i);
    }
}

static float cosine_of(const float n[3], const light_rays *rays, uint32_t ray)
{
    const float *d = rays->directions + 3u * (size_t)ray;
    return n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
}

/* The share of even light that reaches a vertex; 1 from OPEN on. */
static float light_at(skin *s, const light_rays *rays, const model_target *target, uint32_t v)
{
    float at[3], n[3], all = 0.0f, seen = 0.0f;
    uint32_t last = 0;
    posed(s->mesh->position, target ? target->position : NULL, v, at);
    posed(s->mesh->normal, target ? target->normal : NULL, v, n);
    const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int c = 0; c < 3; c++) {
        n[c] = length > 0.0f ? n[c] / length : 0.0f;
        at[c] += s->least * n[c];
    }
    for (uint32_t i = 0; i < rays->count; i++) all += fmaxf(cosine_of(n, rays, i), 0.0f);
    for (uint32_t i = 0; i < rays->count && seen < OPEN * all; i++) {
        const float cosine = cosine_of(n, rays, i);
        const float *d = rays->directions + 3u * (size_t)i;
        s->traced += cosine > 0.0f;
        if (cosine > 0.0f && !ray_tree_hit(&s->tree, at, d, s->least, &last)) seen += cosine;
    }
    return seen < OPEN * all ? seen / all : 1.0f;
}

/* How many vertices are dark in this pose and all before. */
static uint32_t light(skin *s, const light_rays *rays, const model_target *target)
{
    uint32_t dark = 0;
    for (uint32_t v = 0; v < s->mesh->vertex_count && s->traced < TRACED_MAX; v++) {
        if (s->open[v] >= OPEN || holder_of(s->mesh, v) != s->held_by) continue;
        s->open[v] = fmaxf(s->open[v], light_at(s, rays, target, v));
        dark += s->open[v] < OPEN;
    }
    return dark;
}

static int find_dark(skin *s, const light_rays *rays, uint32_t *dark)
{
    pose(s, NULL);
    s->least = light_least(s->mesh->position, s->corners, s->count);
    if (ray_tree_make(s->triangles, s->count, &s->tree)) return 1;
    *dark = light(s, rays, NULL);
    for (uint32_t t = 0; t < s->mesh->target_count && *dark; t++) {
        pose(s, &s->mesh->targets[t]);
        ray_tree_fit(&s->tree, s->triangles);
        *dark = light(s, rays, &s->mesh->targets[t]);
    }
    return 0;
}

static int room_for_skin(skin *s)
{
    const model_mesh *mesh = s->mesh;
    s->corners = model_zeros(mesh->index_count, sizeof *s->corners);
    s->triangles = model_zeros(mesh->index_count, 3 * sizeof *s->triangles);
    s->open = model_zeros(mesh->vertex_count, sizeof *s->open);
    if (!s->corners || !s->triangles || !s->open) return 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) s->open[v] = 1.0f;
    return 0;
}

static void take_skin(const model *m, skin *s)
{
    const model_mesh *mesh = s->mesh;
    s->count = 0;
    for (uint32_t i = 0; i < mesh->submesh_count; i++) {
        const model_submesh *part = &mesh->submeshes[i];
        if (!is_skin(m, mesh, part)) continue;
        for (uint32_t k = 0; k + 2u < part->index_count; k += 3u) {
            const uint32_t *corner = mesh->indices + part->first_index + k;
            uint32_t held = 0;
            for (uint32_t c = 0; c < 3u; c++) held += holder_of(mesh, corner[c]) == s->held_by;
            if (held < 3u) continue;
            for (uint32_t c = 0; c < 3u; c++) s->open[corner[c]] = 0.0f;
            memcpy(s->corners + 3u * (size_t)s->count++, corner, 3 * sizeof *corner);
        }
    }
}

static float shade_of(float open)
{
    const float t = fminf(fmaxf((open - SHUT) / (OPEN - SHUT), 0.0f), 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

static int paint(const skin *s)
{
    model_mesh *mesh = s->mesh;
    if (!mesh->color) {
        mesh->color = model_zeros(4 * (size_t)mesh->vertex_count, sizeof *mesh->color);
        for (size_t i = 0; mesh->color && i < 4 * (size_t)mesh->vertex_count; i++) mesh->color[i] = 1.0f;
    }
    for (size_t v = 0; mesh->color && v < mesh->vertex_count; v++) {
        const float shade = shade_of(s->open[v]);
        for (size_t c = 0; c < 3; c++) mesh->color[4 * v + c] *= 1.0f - (1.0f - shade) * (1.0f - deep[c]);
    }
    return !mesh->color;
}

static int paint_mesh(model *m, model_mesh *mesh, const light_rays *rays)
{
    skin s = { .mesh = mesh };
    uint32_t dark = 0;
    int failed = room_for_skin(&s);
    for (; s.held_by < (mesh->joints ? mesh->joint_limit : 1u) && !failed; s.held_by++) {
        uint32_t more = 0;
        take_skin(m, &s);
        failed = s.count && find_dark(&s, rays, &more);
        ray_tree_free(&s.tree);
        dark += more;
    }
    if (s.traced >= TRACED_MAX) dark = 0;
    failed = failed || (dark && paint(&s));
    if (dark && !failed) {
        failed = model_warn(m,
                            "mesh '%s': no texture shades the hollows of its skin, such as nostrils, so their vertices "
                            "became dark (--surface MATERIAL=skin keeps them)",
                            mesh->name);
    }
    free(s.corners);
    free(s.triangles);
    free(s.open);
    return failed;
}

int hollow_paint(model *m)
{
    light_rays rays = { 0 };
    int failed = light_rays_make(RAYS, &rays);
    for (uint32_t i = 0; i < m->mesh_count && !failed; i++) failed = paint_mesh(m, &m->meshes[i], &rays);
    light_rays_free(&rays);
    return failed;
}
