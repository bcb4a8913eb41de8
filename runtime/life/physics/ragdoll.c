/* ragdoll.c: sets of ragdolls: memory, input and output, sleep. */
#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"
#include "life/physics/ragdoll_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"
#include "life/physics/world_ask_internal.h"
#include "life/physics/shape_internal.h"

/* Steps and speeds of a doll of size 1. Times grow by the square root of the size, as falls do: in the unit of a doll
 * speeds shrink by it. */
#define STILL_STEPS 30u  /* half a second */
#define STILL_PART 0.02f /* of its size: 35 mm for 1.75 m */
#define SLOW_PART 0.15f  /* of its size per second: 0.26 m/s for 1.75 m */
/* a tenth of a second, after which slow bodies are braked, increasingly over another half second */
#define SLOW_STEPS 6u
#define BRAKE_STEPS 30u
#define BENT 0.02f          /* radians beyond a limit that are more than rounding */
#define BENT_STEPS 45.0f    /* per radian, half as long again as it takes */
#define SLACK_PART 0.00115f /* of its size: 2 mm for 1.75 m */
#define PUSH_PART 4.6f      /* of its size per second, up to which a push changes one body alone: 8 m/s for 1.75 m */
#define SPEED_PART 23.0f    /* of its size per second: 40 m/s for 1.75 m */

/* ---- rigs ---- */

static int is_unit4(const float q[4])
{
    const float square = noh_quat_dot(q, q);
    return square > 0.99f && square < 1.01f;
}

static int is_positive(float x)
{
    return x > 0.0f && noh_is_number(x);
}

static int good_body(const noh_ragdoll_rig *rig, uint32_t i)
{
    const noh_ragdoll_body *b = &rig->bodies[i];
    return (i ? b->parent < i : b->parent == NOH_NONE) && b->half >= 0.0f && noh_is_number(b->half) &&
           is_positive(b->radius) && is_positive(b->mass) && is_positive(b->inertia_across) &&
           is_positive(b->inertia_along) && noh_is_number3(b->position) && is_unit4(b->rotation);
}

/* Contains 0, and spans no more than half a turn each way. */
static int good_range(float low, float high)
{
    return low >= -3.1416f && low <= 0.0f && high >= 0.0f && high <= 3.1416f;
}

/* Where rest lies in the ellipse of swing, 0 centre to 1 edge. */
static float rest_swing(const noh_ragdoll_joint *j)
{
    float sum = 0.0f;
    for (int i = 0; i < 2; i++) {
        float middle, half, unused;
        noh_sin_cos((j->swing_max[i] + j->swing_min[i]) * 0.25f, &middle, &unused);
        noh_sin_cos((j->swing_max[i] - j->swing_min[i]) * 0.25f, &half, &unused);
        sum += middle * middle / (half * half + 1e-6f);
    }
    return sum;
}

static int good_joint(const noh_ragdoll_joint *j)
{
    int good = noh_is_number3(j->anchor) && is_unit4(j->frame) && j->friction >= 0.0f && noh_is_number(j->friction);
    if (!(j->flags & NOH_RAGDOLL_LOOSE)) {
        good = good && good_range(j->twist_min, j->twist_max);
        if (!(j->flags & NOH_RAGDOLL_HINGE)) {
            good = good && good_range(j->swing_min[0], j->swing_max[0]) &&
                   good_range(j->swing_min[1], j->swing_max[1]) && rest_swing(j) <= 1.001f;
        }
    }
    for (int i = 0; i < 3 && (j->flags & NOH_RAGDOLL_SLIDES); i++) {
        good = good && j->linear_min[i] <= 0.0f && j->linear_max[i] >= 0.0f && noh_is_number3(j->linear_min) &&
               noh_is_number3(j->linear_max);
    }
    return good;
}

noh_result noh_ragdoll_rig_check(const noh_ragdoll_rig *rig, noh_error *error)
{
    if (!rig->body_count || rig->body_count > NOH_RAGDOLL_BODIES_MAX || rig->pair_count > NOH_RAGDOLL_PAIRS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "a rig needs 1 to NOH_RAGDOLL_BODIES_MAX bodies and at most NOH_RAGDOLL_PAIRS_MAX pairs",
                        rig->body_count, NOH_RAGDOLL_BODIES_MAX);
    }
    for (uint32_t i = 0; i < rig->body_count; i++) {
        if (!good_body(rig, i)) {
            return noh_fail(error, NOH_ERR_ARG, "a body of a rig has a number out of its range", i, 0);
        }
        if (i && !good_joint(&rig->joints[i])) {
            return noh_fail(error, NOH_ERR_ARG,
                            "a joint of a rig has a number out of its range, or its limits do not contain its rest", i,
                            0);
        }
    }
    for (uint32_t i = 0; i < rig->pair_count; i++) {
        const uint8_t *pair = rig->pairs[i];
        if (pair[0] >= rig->body_count || pair[1] >= rig->body_count || pair[0] == pair[1]) {
            return noh_fail(error, NOH_ERR_ARG, "a pair of a rig is not two different bodies of it", i, 0);
        }
    }
    return NOH_OK;
}

static void set_mass(noh_ragdoll_body *b, float mass)
{
    b->inertia_across *= mass / b->mass;
    b->inertia_along *= mass / b->mass;
    b->mass = mass;
}

void noh_ragdoll_stabilize(noh_ragdoll_rig *rig)
{
    float wanted[NOH_RAGDOLL_BODIES_MAX], below[NOH_RAGDOLL_BODIES_MAX] = { 0.0f }, sum = 0.0f, total = 0.0f;
    for (uint32_t i = 0; i < rig->body_count; i++) {
        const noh_ragdoll_body *b = &rig->bodies[i];
        const float ratio = i ? b->mass / rig->bodies[b->parent].mass : 1.0f;
        wanted[i] = (i ? wanted[b->parent] : 1.0f) * (ratio < 0.8f ? 0.8f : ratio > 1.2f ? 1.2f : ratio);
        sum += wanted[i];
        total += b->mass;
    }
    for (uint32_t i = 0; i < rig->body_count; i++) set_mass(&rig->bodies[i], wanted[i] * total / sum);
    for (uint32_t i = rig->body_count; i-- > 0;) {
        noh_ragdoll_body *b = &rig->bodies[i];
        if (below[i] > 0.0f) {
            const float own = noh_larger(b->inertia_across, b->inertia_along);
            const float least = below[i] < 2.0f * own ? below[i] : 2.0f * own;
            b->inertia_across = noh_larger(b->inertia_across, least);
            b->inertia_along = noh_larger(b->inertia_along, least);
        }
        if (i) below[b->parent] += noh_larger(b->inertia_across, b->inertia_along) + below[i];
    }
}

/* ---- constants ---- */

/* Transform a point and a rotation into a body's space. */
static void point_into(const noh_ragdoll_body *b, const float point[3], float out[3])
{
    float back[4], d[3];
    noh_quat_conjugate(b->rotation, back);
    noh_sub3(point, b->position, d);
    noh_quat_rotate(back, d, out);
}

static void rotation_into(const noh_ragdoll_body *b, const float q[4], float out[4])
{
    float back[4];
    noh_quat_conjugate(b->rotation, back);
    noh_quat_mul(back, q, out);
}

static void set_joint(const noh_ragdoll_rig *rig, uint32_t i, noh_ragdoll_constants *c)
{
    const noh_ragdoll_joint *j = &rig->joints[i];
    const noh_ragdoll_body *child = &rig->bodies[i], *parent = &rig->bodies[child->parent];
    float lean[4], middle[3] = { 0.0f, 0.0f, 0.0f };
    c->flags = j->flags;
    point_into(parent, j->anchor, c->anchor_parent);
    point_into(child, j->anchor, c->anchor);
    rotation_into(parent, j->frame, c->rest_parent);
    rotation_into(child, j->frame, c->frame);
    for (int k = 0; k < 2; k++) {
        float sine, unused;
        noh_sin_cos((j->swing_max[k] - j->swing_min[k]) * 0.25f, &sine, &unused);
        c->swing[k] = 1.0f / (sine * sine + 1e-6f);
        middle[k] = (j->swing_max[k] + j->swing_min[k]) * 0.5f;
    }
    noh_quat_from_rotation(middle, lean);
    if (j->flags & NOH_RAGDOLL_HINGE) {
        memcpy(c->frame_parent, c->rest_parent, sizeof c->frame_parent);
    } else {
        noh_quat_mul(c->rest_parent, lean, c->frame_parent);
    }
    noh_sin_cos(j->twist_min * 0.5f, &c->twist_min[0], &c->twist_min[1]);
    noh_sin_cos(j->twist_max * 0.5f, &c->twist_max[0], &c->twist_max[1]);
    memcpy(c->linear_min, j->linear_min, sizeof c->linear_min);
    memcpy(c->linear_max, j->linear_max, sizeof c->linear_max);
    c->friction = j->friction;
}

static void ends_of(const float position[3], const float rotation[4], float half, float ends[2][3])
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f };
    float axis[3];
    noh_quat_rotate(rotation, z, axis);
    noh_madd3(position, half, axis, ends[0]);
    noh_madd3(position, -half, axis, ends[1]);
}

static float axes_apart(const float a[2][3], const float b[2][3])
{
    float along[2], p[3], q[3], d[3];
    noh_segments_closest(a[0], a[1], b[0], b[1], along);
    noh_sub3(a[1], a[0], d);
    noh_madd3(a[0], along[0], d, p);
    noh_sub3(b[1], b[0], d);
    noh_madd3(b[0], along[1], d, q);
    noh_sub3(p, q, d);
    return noh_length3(d);
}

static void set_pair(const noh_ragdoll_rig *rig, uint32_t i, noh_ragdoll_pair *pair)
{
    const noh_ragdoll_body *a = &rig->bodies[rig->pairs[i][0]], *b = &rig->bodies[rig->pairs[i][1]];
    float ends_a[2][3], ends_b[2][3];
    ends_of(a->position, a->rotation, a->half, ends_a);
    ends_of(b->position, b->rotation, b->half, ends_b);
    const float rest = axes_apart((const float(*)[3])ends_a, (const float(*)[3])ends_b), sum = a->radius + b->radius;
    pair->a = rig->pairs[i][0];
    pair->b = rig->pairs[i][1];
    pair->distance = rest < sum ? rest : sum;
}

/* The longest side of the box around the ends of bodies at rest. */
static float size_of(const noh_ragdoll_rig *rig)
{
    float low[3] = { 1e30f, 1e30f, 1e30f }, high[3] = { -1e30f, -1e30f, -1e30f }, size = 0.0f;
    for (uint32_t i = 0; i < rig->body_count; i++) {
        const noh_ragdoll_body *b = &rig->bodies[i];
        float ends[2][3];
        ends_of(b->position, b->rotation, b->half, ends);
        for (int k = 0; k < 6; k++) {
            const float at = ends[k / 3][k % 3];
            low[k % 3] = at - b->radius < low[k % 3] ? at - b->radius : low[k % 3];
            high[k % 3] = at + b->radius > high[k % 3] ? at + b->radius : high[k % 3];
        }
    }
    for (int k = 0; k < 3; k++) size = noh_larger(size, high[k] - low[k]);
    return size;
}

static void set_shape(noh_ragdolls *set, const noh_ragdolls_desc *desc)
{
    const noh_ragdoll_rig *rig = desc->rig;
    noh_ragdoll_shape *shape = &set->shape;
    set->size = size_of(rig);
    shape->body_count = rig->body_count;
    shape->pair_count = rig->pair_count;
    shape->substeps = desc->substeps ? desc->substeps : 10u;
    shape->speed_max = SPEED_PART * set->size;
    shape->slack = SLACK_PART * set->size;
    for (uint32_t i = 0; i < rig->body_count; i++) {
        noh_ragdoll_constants *c = &shape->bodies[i];
        const noh_ragdoll_body *b = &rig->bodies[i];
        c->half = b->half;
        c->radius = b->radius;
        c->mass = b->mass;
        c->inertia_across = b->inertia_across;
        c->inertia_along = b->inertia_along;
        c->parent = b->parent;
        if (i) set_joint(rig, i, c);
    }
    for (uint32_t i = 0; i < rig->pair_count; i++) set_pair(rig, i, &shape->pairs[i]);
}

/* ---- size and init ---- */

typedef struct layout {
    noh_ragdolls *set;
    noh_ragdoll_doll *dolls;
    uint32_t *asks; /* noh_ragdolls_desc */
    float *scratch;
} layout;

/* Shared memory comes last: it may begin 16 bytes later, at a multiple of 32. */
static layout carve(noh_arena *arena, uint32_t count, uint32_t asks)
{
    layout l;
    l.set = noh_arena_carve(arena, sizeof *l.set, 16);
    l.dolls = noh_arena_carve(arena, count * sizeof *l.dolls, 16);
    l.asks = noh_arena_carve(arena, sizeof *l.asks, 16);
    l.scratch = noh_arena_carve(arena, NOH_RAGDOLL_SCRATCH_FLOATS(asks) * sizeof(float) + 32u, 16);
    return l;
}

static int good_desc(const noh_ragdolls_desc *desc)
{
    return desc->rig && desc->count && desc->count <= NOH_RAGDOLLS_MAX &&
           (!desc->substeps || (desc->substeps >= 5u && desc->substeps <= NOH_RAGDOLL_SUBSTEPS_MAX));
}

size_t noh_ragdolls_size(const noh_ragdolls_desc *desc)
{
    noh_arena arena = noh_arena_measure();
    if (!good_desc(desc)) return 0;
    (void)carve(&arena, desc->count, desc->asks);
    return arena.used;
}

noh_ragdoll_doll *noh_ragdoll_dolls(noh_ragdolls *set)
{
    noh_arena arena = noh_arena_over(set, SIZE_MAX);
    return carve(&arena, set->count, 0).dolls;
}

static const noh_ragdoll_doll *doll_of(const noh_ragdolls *set, uint32_t doll)
{
    NOH_ASSERT(set && doll < set->count);
    return (const noh_ragdoll_doll *)(const void *)((const uint8_t *)set + ((sizeof *set + 15u) & ~(size_t)15u)) + doll;
}

float *noh_ragdoll_scratch(noh_ragdolls *set)
{
    noh_arena arena = noh_arena_over(set, SIZE_MAX);
    uint8_t *scratch = (uint8_t *)carve(&arena, set->count, 0).scratch;
    return (float *)(void *)(scratch + (32u - (uintptr_t)scratch % 32u) % 32u);
}

static uint32_t *asks_of(noh_ragdolls *set)
{
    noh_arena arena = noh_arena_over(set, SIZE_MAX);
    return carve(&arena, set->count, 0).asks;
}

/* ---- origins ---- */

static float whole(float x)
{
    return x > -8388608.0f && x < 8388608.0f ? (float)(int32_t)(x < 0.0f ? x - 0.5f : x + 0.5f) : x;
}

void noh_ragdoll_origin_near(const float at[3], float origin[3])
{
    for (int k = 0; k < 3; k++) origin[k] = whole(at[k]);
}

/* ---- sizes ---- */

#define SIZE_ONE 0x3f800000u /* the bits of 1 */

float noh_ragdoll_size(const noh_ragdoll_doll *doll)
{
    const uint32_t bits = ((uint32_t)doll->size_high << 16 | doll->size_low) ^ SIZE_ONE;
    float size;
    memcpy(&size, &bits, sizeof size);
    return size;
}

static void set_size(noh_ragdoll_doll *doll, float size)
{
    uint32_t bits;
    memcpy(&bits, &size, sizeof bits);
    bits ^= SIZE_ONE;
    doll->size_low = (uint16_t)bits;
    doll->size_high = (uint16_t)(bits >> 16);
}

/* Convert a point from metres about an origin to a doll's unit and origin. */
static void enter(const noh_ragdoll_doll *doll, const float point[3], const float origin[3], float out[3])
{
    const float size = noh_ragdoll_size(doll);
    for (int k = 0; k < 3; k++) {
        const double at = (double)origin[k] + (double)point[k];
        out[k] = size == 1.0f ? point[k] - (doll->origin[k] - origin[k])
                              : (float)(at / (double)size - (double)doll->origin[k]);
    }
}

/* A world as dolls of some size see it; its physics is asked in metres. */
typedef struct sized_world {
    noh_world world;
    noh_field field;
    noh_plane planes[NOH_OBSTACLES_MAX];
    noh_capsule capsules[NOH_OBSTACLES_MAX];
    noh_obb boxes[NOH_OBSTACLES_MAX];
} sized_world;

static void divide3(const float v[3], float size, float out[3])
{
    for (int k = 0; k < 3; k++) out[k] = v[k] / size;
}

static const noh_world *sized(const noh_world *w, float size, sized_world *out)
{
    if (!w || size == 1.0f) return w;
    out->world = *w;
    for (uint32_t i = 0; i < w->plane_count; i++) {
        out->planes[i] = w->planes[i];
        out->planes[i].distance /= size;
    }
    for (uint32_t i = 0; i < w->capsule_count; i++) {
        divide3(w->capsules[i].from, size, out->capsules[i].from);
        divide3(w->capsules[i].to, size, out->capsules[i].to);
        out->capsules[i].radius = w->capsules[i].radius / size;
    }
    for (uint32_t i = 0; i < w->box_count; i++) {
        out->boxes[i] = w->boxes[i];
        divide3(w->boxes[i].centre, size, out->boxes[i].centre);
        divide3(w->boxes[i].half, size, out->boxes[i].half);
    }
    out->world.planes = out->planes;
    out->world.capsules = out->capsules;
    out->world.boxes = out->boxes;
    if (!w->field) return &out->world;
    out->field = *w->field;
    divide3(w->field->origin, size, out->field.origin);
    out->field.spacing /= size;
    out->field.scale /= size;
    out->world.field = &out->field;
    return &out->world;
}

static void rest_doll(noh_ragdoll_doll *doll, const noh_ragdoll_rig *rig)
{
    memset(doll, 0, sizeof *doll);
    noh_ragdoll_origin_near(rig->bodies[0].position, doll->origin);
    for (uint32_t i = 0; i < rig->body_count; i++) {
        noh_ragdoll_state *s = &doll->bodies[i];
        noh_sub3(rig->bodies[i].position, doll->origin, s->position);
        memcpy(s->rotation, rig->bodies[i].rotation, sizeof s->rotation);
        s->goal_rotation[3] = 1.0f;
    }
    doll->asleep = 1;
}

void noh_ragdoll_rest(noh_ragdolls *set, uint32_t doll, const noh_ragdoll_rig *rig)
{
    rest_doll(&noh_ragdoll_dolls(set)[doll], rig);
}

int noh_ragdoll_rests(const noh_ragdolls *set, uint32_t doll, const noh_ragdoll_rig *rig)
{
    noh_ragdoll_doll rest;
    rest_doll(&rest, rig);
    return memcmp(doll_of(set, doll), &rest, sizeof rest) == 0;
}

noh_result noh_ragdolls_init(void *memory, size_t bytes, const noh_ragdolls_desc *desc, noh_ragdolls **set,
                             noh_error *error)
{
    noh_arena arena;
    NOH_ASSERT(desc && set);
    if (!good_desc(desc)) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "a set of ragdolls needs a rig, 1 to NOH_RAGDOLLS_MAX dolls and 5 to 20 substeps", desc->count,
                        NOH_RAGDOLLS_MAX);
    }
    noh_result result = noh_ragdoll_rig_check(desc->rig, error);
    if (!result) result = noh_arena_open(&arena, memory, bytes, noh_ragdolls_size(desc), error);
    if (result) return result;
    memset(memory, 0, noh_ragdolls_size(desc));
    *set = noh_ragdolls_begin(memory, desc);
    *asks_of(*set) = desc->asks ? 1u : 0u;
    return NOH_OK;
}

size_t noh_ragdolls_state_size(uint32_t count)
{
    return ((sizeof(noh_ragdolls) + 15u) & ~(size_t)15u) + count * sizeof(noh_ragdoll_doll);
}

noh_ragdolls *noh_ragdolls_begin(void *memory, const noh_ragdolls_desc *desc)
{
    noh_ragdolls *set = memory;
    memset(memory, 0, noh_ragdolls_state_size(desc->count));
    set->count = desc->count;
    set_shape(set, desc);
    for (uint32_t i = 0; i < desc->count; i++) rest_doll(&noh_ragdoll_dolls(set)[i], desc->rig);
    return set;
}

static int good_state(const noh_ragdoll_state *s)
{
    return noh_are_sound(s->position, sizeof *s / sizeof(float)) && is_unit4(s->rotation) && is_unit4(s->goal_rotation);
}

const char *noh_ragdolls_check(const noh_ragdolls *set, const noh_ragdolls *copy)
{
    if (copy->count != set->count || copy->size != set->size ||
        memcmp(&copy->shape, &set->shape, sizeof set->shape) != 0) {
        return "state: ragdolls were made with another rig";
    }
    for (uint32_t d = 0; d < set->count; d++) {
        const noh_ragdoll_doll *doll = doll_of(copy, d);
        if (!noh_are_sound(doll->origin, 3) || !noh_are_sound(doll->lain[0], sizeof doll->lain / sizeof(float)))
            return "state: a ragdoll's position is not a number";
        if (!noh_ragdoll_is_size(noh_ragdoll_size(doll))) return "state: a ragdoll's size is out of range";
        for (uint32_t i = 0; i < set->shape.body_count; i++) {
            if (!good_state(&doll->bodies[i]) || !(doll->hertz[i] >= 0.0f && noh_is_number(doll->hertz[i])))
                return "state: a ragdoll's body is not a number";
        }
    }
    return NULL;
}

/* ---- input ---- */

static void wake(noh_ragdoll_doll *doll)
{
    doll->asleep = 0;
    doll->still = 0;
    doll->slow = 0;
}

static const float world_origin[3] = { 0.0f, 0.0f, 0.0f };

static uint32_t first_bad_pose(const noh_ragdoll_pose *bodies, uint32_t count)
{
    uint32_t i = 0;
    while (i < count && noh_are_sound(bodies[i].position, 3) && is_unit4(bodies[i].rotation)) i++;
    return i;
}

noh_result noh_ragdoll_place(noh_ragdolls *set, uint32_t doll, const noh_ragdoll_pose *bodies,
                             const noh_ragdoll_motion *motions, noh_error *error)
{
    return noh_ragdoll_place_about(set, doll, world_origin, 1.0f, bodies, motions, error);
}

noh_result noh_ragdoll_place_about(noh_ragdolls *set, uint32_t doll, const float origin[3], float size,
                                   const noh_ragdoll_pose *bodies, const noh_ragdoll_motion *motions, noh_error *error)
{
    const uint32_t count = set->shape.body_count;
    noh_ragdoll_measures m;
    uint32_t bad = first_bad_pose(bodies, count);
    noh_ragdoll_doll *d = &noh_ragdoll_dolls(set)[doll];
    NOH_ASSERT(doll < set->count);
    for (uint32_t i = 0; motions && i < count && bad == count; i++) {
        if (!noh_are_sound(motions[i].velocity, 3) || !noh_are_sound(motions[i].spin, 3)) bad = i;
    }
    if (bad < count) {
        return noh_fail(error, NOH_ERR_ARG, "a placed body's position is not finite, or its rotation is not unit", bad,
                        0);
    }
    NOH_ASSERT(noh_ragdoll_is_size(size));
    set_size(d, size);
    noh_ragdoll_origin_near(bodies[0].position, d->origin);
    noh_madd3(d->origin, 1.0f, origin, d->origin);
    if (size != 1.0f) {
        divide3(d->origin, size, d->origin);
        noh_ragdoll_origin_near(d->origin, d->origin);
    }
    for (uint32_t i = 0; i < count; i++) {
        noh_ragdoll_state *s = &d->bodies[i];
        enter(d, bodies[i].position, origin, s->position);
        memcpy(s->rotation, bodies[i].rotation, sizeof s->rotation);
        memset(s->velocity, 0, sizeof s->velocity);
        memset(s->spin, 0, sizeof s->spin);
        if (motions) {
            divide3(motions[i].velocity, size, s->velocity);
            memcpy(s->spin, motions[i].spin, sizeof s->spin);
        }
    }
    noh_ragdoll_measure(set, doll, NULL, &m);
    d->bent = m.limit > BENT ? (uint32_t)(m.limit * BENT_STEPS) + 6u : 0;
    wake(d);
    return NOH_OK;
}

noh_result noh_ragdoll_follow(noh_ragdolls *set, uint32_t doll, const noh_ragdoll_pose *goals, uint32_t held,
                              const float *hertz, noh_error *error)
{
    return noh_ragdoll_follow_about(set, doll, world_origin, goals, held, hertz, error);
}

noh_result noh_ragdoll_follow_about(noh_ragdolls *set, uint32_t doll, const float origin[3],
                                    const noh_ragdoll_pose *goals, uint32_t held, const float *hertz, noh_error *error)
{
    const uint32_t count = set->shape.body_count;
    uint32_t bad = goals ? first_bad_pose(goals, count) : count;
    noh_ragdoll_doll *d = &noh_ragdoll_dolls(set)[doll];
    NOH_ASSERT(doll < set->count);
    for (uint32_t i = 0; goals && hertz && i < count && bad == count; i++) {
        if (!(hertz[i] >= 0.0f && noh_is_number(hertz[i]))) bad = i;
    }
    if (bad < count) {
        return noh_fail(error, NOH_ERR_ARG, "a goal of a body is not finite, or its hertz is below 0", bad, 0);
    }
    memset(d->hertz, 0, sizeof d->hertz);
    d->held = goals ? held : 0;
    for (uint32_t i = 0; goals && i < count; i++) {
        enter(d, goals[i].position, origin, d->bodies[i].goal_position);
        memcpy(d->bodies[i].goal_rotation, goals[i].rotation, sizeof goals[i].rotation);
        if (hertz) d->hertz[i] = hertz[i];
    }
    if (goals) wake(d);
    return NOH_OK;
}

/* The body whose surface is nearest to a point relative to the doll's origin. */
static uint32_t nearest_body(const noh_ragdoll_shape *shape, const noh_ragdoll_doll *d, const float point[3])
{
    uint32_t nearest = 0;
    float best = 1e30f;
    for (uint32_t i = 0; i < shape->body_count; i++) {
        float ends[2][3], at[2][3];
        ends_of(d->bodies[i].position, d->bodies[i].rotation, shape->bodies[i].half, ends);
        memcpy(at[0], point, sizeof at[0]);
        memcpy(at[1], point, sizeof at[1]);
        const float far = axes_apart((const float(*)[3])ends, (const float(*)[3])at) - shape->bodies[i].radius;
        if (far < best) {
            best = far;
            nearest = i;
        }
    }
    return nearest;
}

/* I^-1 v of a body. */
static void turn_by(const noh_ragdoll_constants *c, const noh_ragdoll_state *s, const float v[3], float out[3])
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f };
    float axis[3];
    noh_quat_rotate(s->rotation, z, axis);
    const float extra = (1.0f / c->inertia_along - 1.0f / c->inertia_across) * noh_dot3(axis, v);
    for (int i = 0; i < 3; i++) out[i] = v[i] / c->inertia_across + extra * axis[i];
}

/* The free bodies of a doll, as one rigid body. */
typedef struct whole_doll {
    float mass, centre[3], reach; /* reach: distance of the farthest body's centre */
    float inertia[3][3];          /* about the centre; rows and columns */
} whole_doll;

static int is_free(const noh_ragdoll_doll *d, uint32_t i)
{
    return !(d->held >> i & 1u);
}

static void add_inertia(whole_doll *w, const noh_ragdoll_constants *c, const noh_ragdoll_state *s)
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f };
    float axis[3], arm[3];
    noh_quat_rotate(s->rotation, z, axis);
    noh_sub3(s->position, w->centre, arm);
    const float square = noh_dot3(arm, arm);
    w->reach = noh_larger(w->reach, noh_sqrt(square));
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            w->inertia[i][k] += (c->inertia_along - c->inertia_across) * axis[i] * axis[k] - c->mass * arm[i] * arm[k];
        }
        w->inertia[i][i] += c->inertia_across + c->mass * square;
    }
}

static whole_doll whole_of(const noh_ragdoll_shape *shape, const noh_ragdoll_doll *d)
{
    whole_doll w;
    memset(&w, 0, sizeof w);
    for (uint32_t i = 0; i < shape->body_count; i++) {
        if (is_free(d, i)) w.mass += shape->bodies[i].mass;
    }
    for (uint32_t i = 0; i < shape->body_count; i++) {
        if (is_free(d, i)) noh_madd3(w.centre, shape->bodies[i].mass / w.mass, d->bodies[i].position, w.centre);
    }
    for (uint32_t i = 0; i < shape->body_count; i++) {
        if (is_free(d, i)) add_inertia(&w, &shape->bodies[i], &d->bodies[i]);
    }
    return w;
}

/* I^-1 v, by cross products of its columns. */
static void spin_by(const whole_doll *w, const float v[3], float out[3])
{
    float minors[3][3];
    for (int i = 0; i < 3; i++) noh_cross3(w->inertia[(i + 1) % 3], w->inertia[(i + 2) % 3], minors[i]);
    const float determinant = noh_dot3(w->inertia[0], minors[0]);
    for (int i = 0; i < 3; i++) out[i] = determinant > 0.0f ? noh_dot3(minors[i], v) / determinant : 0.0f;
}

/* Push all free bodies as if they were one: by mass, with a spin limited so that none gets more than twice the mean
 * speed, or more than a doll may have. */
static void push_whole(const noh_ragdoll_shape *shape, noh_ragdoll_doll *d, const float point[3],
                       const float impulse[3])
{
    const whole_doll w = whole_of(shape, d);
    float speed[3] = { 0.0f, 0.0f, 0.0f }, arm[3], twist[3], spin[3];
    if (!(w.mass > 0.0f)) return;
    noh_madd3(speed, 1.0f / w.mass, impulse, speed);
    noh_sub3(point, w.centre, arm);
    noh_cross3(arm, impulse, twist);
    spin_by(&w, twist, spin);
    const float fast = noh_length3(speed), left = noh_larger(shape->speed_max - fast, 0.0f);
    const float rim = noh_length3(spin) * w.reach, most = left < fast ? left : fast;
    if (rim > most) noh_madd3(spin, most / rim - 1.0f, spin, spin);
    for (uint32_t i = 0; i < shape->body_count; i++) {
        noh_ragdoll_state *s = &d->bodies[i];
        float around[3];
        if (!is_free(d, i)) continue;
        noh_sub3(s->position, w.centre, arm);
        noh_cross3(spin, arm, around);
        noh_madd3(s->velocity, 1.0f, speed, s->velocity);
        noh_madd3(s->velocity, 1.0f, around, s->velocity);
        noh_madd3(s->spin, 1.0f, spin, s->spin);
    }
}

/* Push one body. */
static void push_body(const noh_ragdoll_constants *c, noh_ragdoll_state *s, const float point[3],
                      const float impulse[3])
{
    float arm[3], twist[3], spin[3];
    noh_sub3(point, s->position, arm);
    noh_cross3(arm, impulse, twist);
    turn_by(c, s, twist, spin);
    noh_madd3(s->velocity, 1.0f / c->mass, impulse, s->velocity);
    noh_madd3(s->spin, 1.0f, spin, s->spin);
}

/* Scale a vector so that none of its numbers is larger than `most`. */
static void shorten3(float v[3], float most)
{
    float largest = 0.0f;
    for (int k = 0; k < 3; k++) largest = noh_larger(largest, v[k] < 0.0f ? -v[k] : v[k]);
    for (int k = 0; k < 3 && largest > most; k++) v[k] *= most / largest;
}

void noh_ragdoll_push(noh_ragdolls *set, uint32_t doll, const float point[3], const float impulse[3])
{
    NOH_ASSERT(doll < set->count);
    noh_ragdoll_doll *d = &noh_ragdoll_dolls(set)[doll];
    const float unit = noh_ragdoll_size(d);
    float from[3], own[3], rest[3], sized_impulse[3];
    if (!noh_is_number3(point) || !noh_is_number3(impulse)) return;
    divide3(impulse, unit * unit * unit * unit, sized_impulse); /* its mass, and its metres */
    shorten3(sized_impulse, NOH_NUMBER_MAX);
    impulse = sized_impulse;
    enter(d, point, world_origin, from);
    const uint32_t i = nearest_body(&set->shape, d, from);
    const float alone = PUSH_PART * set->size * set->shape.bodies[i].mass, size = noh_length3(impulse);
    const float part = !is_free(d, i) ? 0.0f : size > alone ? alone / size : 1.0f;
    for (int k = 0; k < 3; k++) {
        own[k] = part * impulse[k];
        rest[k] = impulse[k] - own[k];
    }
    if (part > 0.0f) push_body(&set->shape.bodies[i], &d->bodies[i], from, own);
    if (part < 1.0f) push_whole(&set->shape, d, from, rest);
    wake(d);
}

/* ---- steps ---- */

/* Upper bound on how far an end of a body is from its stored place. */
static float strayed(const noh_ragdoll_constants *c, const noh_ragdoll_state *s, const float lain[7])
{
    float ends[2][3], before[2][3], most = 0.0f;
    ends_of(s->position, s->rotation, c->half + c->radius, ends);
    ends_of(lain, lain + 3, c->half + c->radius, before);
    for (int k = 0; k < 2; k++) {
        float d[3];
        noh_sub3(ends[k], before[k], d);
        most = noh_larger(most, noh_dot3(d, d));
    }
    return most;
}

static int is_fast(const noh_ragdoll_constants *c, const noh_ragdoll_state *s, float most)
{
    const float reach = c->half + c->radius;
    const float square = noh_dot3(s->velocity, s->velocity) + reach * reach * noh_dot3(s->spin, s->spin);
    return !(square < most * most);
}

static uint32_t sized_steps(uint32_t steps, float time)
{
    const uint32_t own = (uint32_t)((float)steps * time + 0.5f);
    return own ? own : 1u;
}

/* A position-based solver makes a resting doll creep for seconds. So the velocities of a doll that has been slow for a
 * while are reduced, until each step begins from zero. Without ground below it nothing stays slow. */
static void brake(const noh_ragdolls *set, noh_ragdoll_doll *d)
{
    const float time = noh_sqrt(noh_ragdoll_size(d));
    const uint32_t slow = sized_steps(SLOW_STEPS, time), braked = sized_steps(BRAKE_STEPS, time);
    int fast = d->held != 0;
    for (uint32_t i = 0; i < set->shape.body_count && !fast; i++) {
        fast = is_fast(&set->shape.bodies[i], &d->bodies[i], SLOW_PART * set->size / time);
    }
    d->slow = fast ? 0 : (uint16_t)(d->slow < slow + braked ? d->slow + 1u : d->slow);
    if (d->slow <= slow) return;
    const float part = d->slow < slow + braked ? (float)(d->slow - slow) / (float)braked : 1.0f;
    for (uint32_t i = 0; i < set->shape.body_count; i++) {
        noh_ragdoll_state *s = &d->bodies[i];
        noh_madd3(s->velocity, -part, s->velocity, s->velocity);
        noh_madd3(s->spin, -part, s->spin, s->spin);
    }
}

static void rest_or_go_on(const noh_ragdolls *set, noh_ragdoll_doll *d)
{
    const float reach = STILL_PART * set->size;
    int moves = d->still == 0 || d->held;
    for (uint32_t i = 0; i < set->shape.body_count && !moves; i++) {
        moves = !(strayed(&set->shape.bodies[i], &d->bodies[i], d->lain[i]) < reach * reach);
    }
    if (moves) {
        for (uint32_t i = 0; i < set->shape.body_count; i++) {
            memcpy(d->lain[i], d->bodies[i].position, sizeof d->lain[i]);
        }
    }
    d->still = (uint16_t)(moves ? 1u : d->still + 1u);
    if (d->still > sized_steps(STILL_STEPS, noh_sqrt(noh_ragdoll_size(d)))) {
        d->asleep = 1;
        for (uint32_t i = 0; i < set->shape.body_count; i++) {
            memset(d->bodies[i].velocity, 0, sizeof d->bodies[i].velocity + sizeof d->bodies[i].spin);
        }
    }
}

/* Move its origin with its first body. */
static void follow_origin(const noh_ragdolls *set, noh_ragdoll_doll *d)
{
    for (int k = 0; k < 3; k++) {
        const float at = d->bodies[0].position[k], to = d->origin[k] + whole(at), by = to - d->origin[k];
        if ((at >= -1.0f && at <= 1.0f) || !noh_is_finite(to)) continue;
        d->origin[k] = to;
        for (uint32_t i = 0; i < set->shape.body_count; i++) {
            d->bodies[i].position[k] -= by;
            d->bodies[i].goal_position[k] -= by;
            d->lain[i][k] -= by;
        }
    }
}

/* Dolls of one size. */
static void step_some(noh_ragdolls *set, const noh_world *world, noh_ragdoll_doll *const *dolls, uint32_t count,
                      float *scratch)
{
    const float size = noh_ragdoll_size(dolls[0]);
    sized_world own;
    noh_ragdoll_step_dolls(&set->shape, sized(world, size, &own), dolls, count, scratch, size);
    for (uint32_t k = 0; k < count; k++) {
        if (dolls[k]->bent) dolls[k]->bent--;
        brake(set, dolls[k]);
        rest_or_go_on(set, dolls[k]);
    }
}

static void step_all(noh_ragdolls *set, const noh_world *world, float *scratch)
{
    noh_ragdoll_doll *dolls = noh_ragdoll_dolls(set), *awake[NOH_RAGDOLL_LANES_MAX];
    uint32_t count = 0;
    for (uint32_t i = 0; i < set->count; i++) {
        if (dolls[i].asleep) continue;
        if (count == NOH_RAGDOLL_LANES_MAX || (count && noh_ragdoll_size(awake[0]) != noh_ragdoll_size(&dolls[i]))) {
            step_some(set, world, awake, count, scratch);
            count = 0;
        }
        follow_origin(set, &dolls[i]);
        awake[count++] = &dolls[i];
    }
    if (count) step_some(set, world, awake, count, scratch);
}

uint32_t noh_ragdolls_step(noh_ragdolls *set, const noh_world *world, uint32_t ticks)
{
    const uint32_t dropped = set->steps.dropped;
    for (uint32_t left = noh_ragdolls_take(set, ticks); left; left--) {
        noh_ragdolls_step_once(set, world, noh_ragdoll_scratch(set), *asks_of(set));
    }
    return set->steps.dropped - dropped;
}

uint32_t noh_ragdolls_take(noh_ragdolls *set, uint32_t ticks)
{
    return noh_steps_take(&set->steps, ticks, NOH_RAGDOLL_STEP_TICKS, NOH_RAGDOLL_STEPS_MAX);
}

void noh_ragdolls_step_once(noh_ragdolls *set, const noh_world *world, float *scratch, uint32_t asks)
{
    noh_world quiet;
    if (world && noh_world_asks(world) && !asks) { /* there is no room for answers */
        quiet = *world;
        quiet.physics = NULL;
        world = &quiet;
    }
    step_all(set, world, scratch);
}

/* ---- output ---- */

void noh_ragdoll_bodies(const noh_ragdolls *set, uint32_t doll, noh_ragdoll_pose *bodies)
{
    float origin[3];
    noh_ragdoll_bodies_local(set, doll, origin, bodies);
    for (uint32_t i = 0; i < set->shape.body_count; i++) {
        noh_madd3(bodies[i].position, 1.0f, origin, bodies[i].position);
    }
}

void noh_ragdoll_bodies_local(const noh_ragdolls *set, uint32_t doll, float origin[3], noh_ragdoll_pose *bodies)
{
    const noh_ragdoll_doll *d = doll_of(set, doll);
    const float size = noh_ragdoll_size(d);
    for (int k = 0; k < 3; k++) origin[k] = size == 1.0f ? d->origin[k] : whole(size * d->origin[k]);
    for (uint32_t i = 0; i < set->shape.body_count; i++) {
        const float *at = d->bodies[i].position;
        for (int k = 0; k < 3; k++) {
            const double real = (double)size * ((double)d->origin[k] + (double)at[k]) - (double)origin[k];
            bodies[i].position[k] = size == 1.0f ? at[k] : (float)real;
        }
        memcpy(bodies[i].rotation, d->bodies[i].rotation, sizeof bodies[i].rotation);
    }
}

/* source  Knuth: The Art of Computer Programming, volume 2, section 4.2.2 (the error of a sum) */
void noh_ragdoll_origin_shift(float origin[3], const float by[3], float lost[3])
{
    for (int k = 0; k < 3; k++) {
        const float old = origin[k], to = old + by[k], kept = to - by[k];
        lost[k] = (old - kept) + (by[k] - (to - kept));
        origin[k] = to;
    }
}

void noh_ragdolls_shift(noh_ragdolls *set, const float by[3])
{
    noh_ragdoll_doll *dolls = noh_ragdoll_dolls(set);
    NOH_ASSERT(noh_is_finite3(by));
    for (uint32_t d = 0; d < set->count; d++) {
        const float size = noh_ragdoll_size(&dolls[d]);
        float lost[3], own[3], rest[3];
        for (int k = 0; k < 3; k++) {
            own[k] = by[k] / size;
            rest[k] = (float)((double)by[k] / (double)size - (double)own[k]);
        }
        noh_ragdoll_origin_shift(dolls[d].origin, own, lost);
        if (size != 1.0f) noh_madd3(lost, 1.0f, rest, lost);
        for (uint32_t i = 0; i < set->shape.body_count; i++) {
            noh_ragdoll_state *s = &dolls[d].bodies[i];
            noh_madd3(s->position, 1.0f, lost, s->position);
            noh_madd3(s->goal_position, 1.0f, lost, s->goal_position);
            noh_madd3(dolls[d].lain[i], 1.0f, lost, dolls[d].lain[i]);
        }
    }
}

void noh_ragdoll_motions(const noh_ragdolls *set, uint32_t doll, noh_ragdoll_motion *motions)
{
    const noh_ragdoll_doll *d = doll_of(set, doll);
    for (uint32_t i = 0; i < set->shape.body_count; i++) {
        for (int k = 0; k < 3; k++) motions[i].velocity[k] = noh_ragdoll_size(d) * d->bodies[i].velocity[k];
        memcpy(motions[i].spin, d->bodies[i].spin, sizeof motions[i].spin);
    }
}

int noh_ragdoll_sleeps(const noh_ragdolls *set, uint32_t doll)
{
    return doll_of(set, doll)->asleep != 0;
}
