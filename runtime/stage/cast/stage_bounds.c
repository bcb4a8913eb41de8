/* stage_bounds.c: where an actor is. Two answers, for two questions:
 *
 *   reach   where any clip may take it: whether a view sees it, before its pose of the frame is known
 *   sphere  what it shows, as it was posed last, with the weights that it shows: its distance, and what a ray hits
 *
 * Neither looks at vertices. Targets move a vertex by no more than the sum of their weighted boxes. */
#include <string.h>

#include "core/base/math_internal.h"
#include "deform/pick/bounds_internal.h"
#include "motion/anim/root_motion_internal.h"
#include "stage/character/bounds_internal.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "stage/character/character_internal.h"
#include "stage/cast/stage_internal.h"
#include "stage/character/lod_internal.h"

#define ROUNDING 1.000004f /* more than the sums and roots below can lose */
#define REACH_SAMPLES 64u  /* of each clip */
#define NEAR_RADII 2.25f   /* of its sphere, about its centre: within, an eye is measured to the figure */

/* The distance of the farthest corner of a box that contains 0. */
static float farthest_corner(const float box[6])
{
    float square = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float far = noh_larger(-box[i], box[3 + i]);
        square += far * far;
    }
    return noh_sqrt(square) * ROUNDING;
}

static void sphere_of_box(const float box[6], float sphere[4])
{
    float square = 0.0f;
    for (int i = 0; i < 3; i++) {
        sphere[i] = 0.5f * box[i] + 0.5f * box[3 + i];
        square += (box[3 + i] - sphere[i]) * (box[3 + i] - sphere[i]);
    }
    sphere[3] = noh_sqrt(square) * ROUNDING;
}

/* Grow a sphere until it holds another one: the smallest that does. */
static void unite(float sphere[4], const float other[4])
{
    float to[3], apart, radius;
    for (int i = 0; i < 3; i++) to[i] = other[i] - sphere[i];
    apart = noh_sqrt(noh_dot3(to, to)) * ROUNDING;
    if (apart + other[3] <= sphere[3]) return;
    if (apart + sphere[3] <= other[3]) {
        memcpy(sphere, other, 4 * sizeof *sphere);
        return;
    }
    radius = 0.5f * (apart + sphere[3] + other[3]);
    for (int i = 0; i < 3; i++) sphere[i] += to[i] * ((radius - sphere[3]) / apart);
    sphere[3] = radius * ROUNDING;
}

/* ---- what is shown ---- */

static int is_empty(const noh_stage_kind *k)
{
    return k->rest[0] > k->rest[3];
}

void noh_stage_sphere(const noh_stage_kind *k, uint32_t index, float sphere[4])
{
    const noh_character *ch = noh_stage_character(k, index);
    const float *floats = k->floats + (size_t)index * k->float_count;
    float box[6], rigid[4], growth = 0.0f;
    noh_box_empty(box);
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        const float *weights = mesh->mesh.header->target_count ? floats + mesh->first_float : NULL;
        float own[6], moved;
        if (!mesh->skinned) {
            noh_mesh_box(&mesh->mesh, mesh->node_world, weights, own);
            noh_box_unite(box, own, box);
        } else if (weights) {
            noh_mesh_target_box(&mesh->mesh, weights, own);
            moved = farthest_corner(own);
            growth = noh_larger(growth, moved * mesh->bind_stretch);
        }
    }
    if (is_empty(k)) {
        memset(sphere, 0, 4 * sizeof *sphere);
    } else if (ch->time.posed) {
        noh_character_sphere(ch, sphere);
        growth *= noh_character_stretch(ch);
    } else {
        sphere_of_box(k->rest, sphere);
    }
    sphere[3] += growth * ROUNDING;
    if (noh_box_is_empty(box)) return;
    sphere_of_box(box, rigid);
    if (is_empty(k)) {
        memcpy(sphere, rigid, sizeof rigid);
    } else {
        unite(sphere, rigid);
    }
}

void noh_stage_widen(float reach[4], const float sphere[4])
{
    const float to[3] = { sphere[0] - reach[0], sphere[1] - reach[1], sphere[2] - reach[2] };
    reach[3] = noh_larger(reach[3], noh_sqrt(noh_dot3(to, to)) * ROUNDING + sphere[3]);
}

/* Where what was shown last, or a weight that the game holds, sticks out of where clips may take it, by that much. */
void noh_stage_reach(const noh_stage_kind *k, const float sphere[4], float reach[4])
{
    memcpy(reach, k->reach, sizeof k->reach);
    noh_stage_widen(reach, sphere);
}

/* ---- how close it is ---- */

/* The least clip-space w at which a view can see a part of a box moved by a matrix: w of the box's nearest point, or,
 * if the box is partly outside the picture or behind the eye, w of a point equally near in the picture's corner. */
static float nearest_of_box(const noh_view_planes *v, const float m[12], const float box[6])
{
    const float *w = v->eye_plane;
    float at[3], nearest = w[3], square = 0.0f;
    for (int r = 0; r < 3; r++) {
        at[r] = m[4 * r + 3];
        for (int c = 0; c < 3; c++) at[r] += m[4 * r + c] * (0.5f * box[c] + 0.5f * box[3 + c]);
        nearest += w[r] * at[r];
        at[r] = v->eye[r] - at[r];
    }
    for (int c = 0; c < 3; c++) {
        const float axis[3] = { m[c], m[4 + c], m[8 + c] }, half = 0.5f * (box[3 + c] - box[c]);
        const float length = noh_sqrt(noh_dot3(axis, axis)), along = noh_dot3(axis, w) * half;
        float off = length > 0.0f ? noh_dot3(axis, at) / length : 0.0f;
        nearest -= along < 0.0f ? -along : along;
        off = (off < 0.0f ? -off : off) - half * length;
        square += off > 0.0f ? off * off : 0.0f;
    }
    return noh_larger(nearest, noh_sqrt(square) * v->corner * v->w_slope);
}

/* The nearest of the boxes that joints move. */
static float nearest_of_joints(const noh_stage_mesh *mesh, const noh_view_planes *v, const noh_character *ch,
                               const float *weights, const float world[12], float *matrices)
{
    float nearest = FLT_MAX, deltas[6];
    noh_mesh_target_box(&mesh->mesh, weights, deltas);
    noh_character_skin(ch, &mesh->skin, matrices);
    for (uint32_t j = 0; j < mesh->skin.header->joint_count; j++) {
        const float *rest = mesh->mesh.joint_boxes + 6u * (size_t)j;
        float m[12], box[6], here;
        if (noh_box_is_empty(rest)) continue;
        for (int i = 0; i < 6; i++) box[i] = rest[i] + deltas[i];
        noh_matrix_multiply(world, matrices + 12u * (size_t)j, m);
        here = nearest_of_box(v, m, box);
        nearest = here < nearest ? here : nearest;
    }
    return nearest;
}

/* For an eye within its sphere, or near it. */
static float nearest_of_figure(const noh_stage_kind *k, uint32_t index, const noh_view_planes *v, const float world[12],
                               float *matrices)
{
    const noh_character *ch = noh_stage_character(k, index);
    const float *floats = k->floats + (size_t)index * k->float_count;
    float nearest = FLT_MAX;
    if (!is_empty(k) && (!ch->time.posed || !k->plan->mesh_count)) nearest = nearest_of_box(v, world, k->rest);
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        const float *weights = mesh->mesh.header->target_count ? floats + mesh->first_float : NULL;
        float here = FLT_MAX, box[6];
        if (!mesh->skinned) {
            noh_mesh_box(&mesh->mesh, mesh->node_world, weights, box);
            here = nearest_of_box(v, world, box);
        } else if (ch->time.posed) {
            here = nearest_of_joints(mesh, v, ch, weights, world, matrices);
        }
        nearest = here < nearest ? here : nearest;
    }
    return nearest;
}

static float distance_to(const float eye[3], const float at[3])
{
    const float to[3] = { at[0] - eye[0], at[1] - eye[1], at[2] - eye[2] };
    return noh_sqrt(noh_dot3(to, to));
}

/* A sphere holds more than the figure: next to it, its nearest point is near where the figure is not. So that a figure
 * that comes nearer is always shown larger, the sphere's nearest point gives way to the figure's from NEAR_RADII to 1 of
 * its radii about it: neither is farther than what can be seen. */
static float nearest_of_both(float of_sphere, float of_figure, float share)
{
    return of_figure > of_sphere ? of_sphere + (of_figure - of_sphere) * (share < 1.0f ? share : 1.0f) : of_sphere;
}

void noh_stage_measure(const noh_stage *s, const noh_stage_kind *k, uint32_t index, const float own[4], float *matrices)
{
    noh_stage_shown *shown = &s->shown[k->first_actor + index];
    float sphere[4];
    noh_stage_sphere_in_world(shown->world, own, sphere);
    shown->scale = 0.0f;
    shown->distance = FLT_MAX;
    for (uint32_t v = 0; v < s->view_count; v++) {
        const noh_view_planes *planes = &s->planes[v];
        const float *w = planes->eye_plane;
        const float apart = distance_to(planes->eye, sphere), outside = apart - sphere[3];
        float nearest = noh_dot3(w, sphere) + w[3] - sphere[3] * planes->w_slope, here;
        if (!(shown->views >> v & 1u) || planes->is_light) continue;
        if (planes->w_slope > 0.0f) {
            const float share = (NEAR_RADII * sphere[3] - apart) /
                                ((NEAR_RADII - 1.0f) * noh_larger(sphere[3], FLT_MIN));
            nearest = noh_larger(nearest, outside * planes->corner * planes->w_slope);
            if (share > 0.0f) {
                nearest = nearest_of_both(nearest, nearest_of_figure(k, index, planes, shown->world, matrices), share);
            }
        }
        here = planes->scale / noh_larger(nearest, planes->near_w);
        shown->scale = noh_larger(shown->scale, here);
        shown->distance = apart < shown->distance ? apart : shown->distance;
    }
}

void noh_stage_measure_shown(const noh_stage *s, const noh_stage_kind *k, uint32_t index, float *matrices)
{
    const noh_stage_actor *a = &k->actors[index];
    const noh_stage_shown *shown = &s->shown[k->first_actor + index];
    float own[4];
    if (!shown->views || a->look.posed) return;
    noh_stage_sphere(k, index, own);
    noh_stage_measure(s, k, index, own, matrices);
    noh_stage_character(k, index)->lod.pixels_per_metre = shown->scale * noh_stage_size(s, a);
}

float noh_stage_error_pixels(const noh_stage *s, const noh_stage_kind *k, uint32_t index)
{
    return s->shown[k->first_actor + index].views && !k->actors[index].look.posed
               ? noh_lod_error_pixels(&noh_stage_character(k, index)->lod)
               : 0.0f;
}

/* ---- made once ---- */

static void open_radii(noh_stage_kind *k)
{
    memset(k->weights, 0, k->weight_count * sizeof *k->weights);
    for (uint32_t j = 0; j < k->skeleton.joint_count; j++) {
        k->joint_radii[j] = k->plan->mesh_count ? -1.0f : 0.0f;
    }
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        noh_stage_mesh *mesh = &k->meshes[m];
        mesh->bind_stretch = 0.0f;
        if (!mesh->skinned) continue;
        noh_mesh_add_joint_radii(&mesh->mesh, k->weights, k->joint_radii);
        for (uint32_t j = 0; j < mesh->skin.header->joint_count; j++) {
            if (noh_box_is_empty(mesh->mesh.joint_boxes + 6u * (size_t)j)) continue;
            mesh->bind_stretch = noh_larger(mesh->bind_stretch, noh_stretch(mesh->skin.inverse_bind + 12u * (size_t)j));
        }
    }
}

/* The range of clips. Weights of targets are between `low` [weight_count] and `high` [float_count]. Both use the memory
 * of the first actor's weights. */
typedef struct range {
    float roots[6];
    float *low, *high;
    float *model; /* [joint_count][12], only the first two are used: the longest way to the joint from its parent,
                   * and the largest scale */
    uint32_t root_count;
} range;

static void widen_joint(const noh_transform *t, float *most)
{
    float scale = 0.0f;
    for (int i = 0; i < 3; i++) scale = noh_larger(scale, t->scale[i] < 0.0f ? -t->scale[i] : t->scale[i]);
    most[0] = noh_larger(most[0], noh_sqrt(noh_dot3(t->translation, t->translation)));
    most[1] = noh_larger(most[1], scale);
}

static void widen_pose(const noh_stage_kind *k, const noh_transform *pose, range *r)
{
    for (uint32_t j = 0; j < k->skeleton.joint_count; j++) {
        float at[6];
        widen_joint(&pose[j], r->model + 12u * (size_t)j);
        if (j >= r->root_count) continue;
        for (int i = 0; i < 6; i++) at[i] = pose[j].translation[i % 3];
        noh_box_unite(r->roots, at, r->roots);
    }
}

static void widen_weights(const noh_stage_kind *k, const float *floats, range *r)
{
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        for (uint32_t t = 0; t < mesh->mesh.header->target_count; t++) {
            const uint32_t at = mesh->first_float + t, from = k->named.sources[at];
            float *low = &r->low[mesh->first_weight + t], *high = &r->high[at];
            if (from >= k->set.float_count) continue;
            *high = noh_larger(*high, floats[from]);
            *low = floats[from] < *low ? floats[from] : *low;
        }
    }
}

static void widen_clip(const noh_stage_kind *k, uint32_t clip, noh_character_scratch *scratch, range *r)
{
    const uint32_t duration = k->set.clips[clip].duration_ticks;
    const int moves = !(k->set.clips[clip].flags & NOH_CLIP_FLOATS_ONLY) && k->skeleton.joint_count;
    for (uint32_t i = 0; i <= REACH_SAMPLES; i++) {
        const uint32_t tick = (uint32_t)((uint64_t)duration * i / REACH_SAMPLES);
        if (moves) {
            noh_root_sample_rest(&k->set, clip, tick, k->skeleton.joint_count, scratch->local, scratch->floats);
            widen_pose(k, scratch->local, r);
        } else if (k->set.float_count) {
            k->set.sample(k->set.user, clip, tick, 0, scratch->local, k->set.float_count, scratch->floats);
        }
        widen_weights(k, scratch->floats, r);
    }
}

/* With targets at 1 where clips take them no farther: faces and the game move them as well. */
static void find_range(const noh_stage_kind *k, noh_character_scratch *scratch, range *r)
{
    noh_box_empty(r->roots);
    r->low = k->weights;
    r->high = k->floats;
    r->model = scratch->model;
    r->root_count = 0;
    memset(r->model, 0, 12u * k->skeleton.joint_count * sizeof *r->model);
    memset(r->low, 0, k->weight_count * sizeof *r->low);
    for (uint32_t f = 0; f < k->float_count; f++) r->high[f] = 1.0f;
    while (r->root_count < k->skeleton.joint_count && k->skeleton.parents[r->root_count] == NOH_JOINT_ROOT) {
        r->root_count++;
    }
    if (k->skeleton.joint_count) widen_pose(k, k->skeleton.bind_pose, r);
    for (uint32_t c = 0; k->bank && c < k->set.clip_count; c++) widen_clip(k, c, scratch, r);
}

/* What the targets of a mesh add, with weights in the range. */
static void range_box(const noh_stage_mesh *mesh, const range *r, float box[6])
{
    memset(box, 0, 6 * sizeof *box);
    for (uint32_t t = 0; t < mesh->mesh.header->target_count; t++) {
        const float low = r->low[mesh->first_weight + t], high = r->high[mesh->first_float + t];
        const float *b = mesh->mesh.target_boxes + 6u * (size_t)t;
        for (int i = 0; i < 3; i++) { /* low is at most 0 */
            box[i] += noh_larger(high * -b[i], low * -b[3 + i]) * -ROUNDING;
            box[3 + i] += noh_larger(high * b[3 + i], low * b[i]) * ROUNDING;
        }
    }
}

/* The farthest that a vertex can be from a root, however joints turn, with the longest bones and the largest scales of
 * all clips. */
static float bones_radius(const noh_stage_kind *k, const range *r)
{
    float farthest = 0.0f;
    for (uint32_t j = 0; j < k->skeleton.joint_count; j++) {
        float *own = r->model + 12u * (size_t)j, way = 0.0f, scale = own[1];
        if (k->skeleton.parents[j] != NOH_JOINT_ROOT) {
            const float *parent = r->model + 12u * (size_t)k->skeleton.parents[j];
            way = parent[0] + parent[1] * own[0];
            scale *= parent[1];
        }
        own[0] = way * ROUNDING;
        own[1] = scale;
        if (k->joint_radii[j] >= 0.0f) farthest = noh_larger(farthest, own[0] + k->joint_radii[j] * scale);
    }
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        float box[6], moved;
        if (!mesh->skinned || !mesh->mesh.header->target_count) continue;
        range_box(mesh, r, box);
        moved = farthest_corner(box);
        for (uint32_t j = 0; j < mesh->skin.header->joint_count; j++) {
            const uint32_t joint = mesh->skin.joints[j];
            const float *own = r->model + 12u * (size_t)joint, *bind = mesh->skin.inverse_bind + 12u * (size_t)j;
            if (k->joint_radii[joint] < 0.0f) continue;
            farthest = noh_larger(farthest, own[0] + (k->joint_radii[joint] + moved * noh_stretch(bind)) * own[1]);
        }
    }
    return farthest * ROUNDING;
}

static void unite_rigid(const noh_stage_kind *k, const range *r, float box[6])
{
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        float own[6];
        if (mesh->skinned) continue;
        range_box(mesh, r, own);
        noh_mesh_moved_box(&mesh->mesh, mesh->node_world, own, own);
        noh_box_unite(box, own, box);
    }
}

void noh_stage_open_bounds(noh_stage_kind *k, noh_character_scratch *scratch)
{
    noh_bounds rest;
    range r;
    float box[6];
    open_radii(k);
    noh_box_empty(k->rest);
    noh_box_empty(box);
    if (k->skeleton.joint_count) {
        noh_local_to_model(&k->skeleton, k->skeleton.bind_pose, k->skeleton.joint_count, scratch->model);
        noh_joint_bounds(&k->skeleton, scratch->model, k->joint_radii, k->skeleton.joint_count, &rest);
        memcpy(k->rest, rest.low, sizeof rest.low);
        memcpy(k->rest + 3, rest.high, sizeof rest.high);
    }
    find_range(k, scratch, &r);
    if (k->skeleton.joint_count) {
        const float radius = bones_radius(k, &r);
        for (int i = 0; i < 6; i++) box[i] = r.roots[i] + (i < 3 ? -radius : radius);
    }
    unite_rigid(k, &r, box);
    memset(k->reach, 0, sizeof k->reach);
    if (!noh_box_is_empty(box)) sphere_of_box(box, k->reach);
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        memcpy(k->floats + (size_t)i * k->float_count, k->named.defaults, k->float_count * sizeof *k->floats);
    }
}
