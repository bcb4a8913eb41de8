/* feet_rig.c: legs by joint names, soles by the skin of feet. */
#include "core/base/assert_internal.h"
#include "core/base/quarter_internal.h"
#include "life/physics/ragdoll_rig_internal.h"
#include "life/reach/feet_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/pack.h"
#include "life/reach/rig_internal.h"
#include "core/base/vector_internal.h"

/* ---- legs ---- */

/* Find a leg from the row of a foot, the only kind that bends upwards, with a shin and a thigh above it. */
static int leg_of(const noh_ragdoll_source *s, const noh_ragdoll_row *rows, uint32_t count, uint32_t foot,
                  noh_feet_leg *leg)
{
    if (rows[foot].toward != NOH_RAGDOLL_UPWARD) return 0;
    const uint32_t shin = noh_ragdoll_row_above(s, rows, count, rows[foot].joint);
    if (shin == NOH_NONE || !rows[shin].hinge || rows[shin].toward != NOH_RAGDOLL_BACKWARD) return 0;
    const uint32_t thigh = noh_ragdoll_row_above(s, rows, count, rows[shin].joint);
    if (thigh == NOH_NONE || thigh == 0) return 0; /* the first row is the pelvis */
    leg->foot = rows[foot].joint;
    leg->shin = rows[shin].joint;
    leg->thigh = rows[thigh].joint;
    return 1;
}

/* ---- soles ---- */

/* Measurements of a foot's skin, taken in several passes: each uses the results of earlier ones. */
typedef struct sole {
    const noh_ragdoll_source *source;
    uint32_t foot, count;
    float low, high;           /* range over all of its skin */
    float sum[3], ankle[3];    /* sum of positions; start of the foot */
    float ahead[3], across[3]; /* unit, horizontal */
    float along[2];            /* heel to toes, from the ankle */
    struct third {
        float low, low_at, side[2], tip;
        uint32_t joint, count;
    } thirds[3]; /* heel, ball, toes */
} sole;

static void take_extent(sole *s, const float p[3])
{
    s->low = !s->count || p[1] < s->low ? p[1] : s->low;
    s->high = !s->count || p[1] > s->high ? p[1] : s->high;
    noh_madd3(s->sum, 1.0f, p, s->sum);
    s->count++;
}

/* Uses only low vertices: the uppers of shoes reach beyond their soles. */
static int is_low(const sole *s, const float p[3])
{
    return p[1] <= s->low + 0.25f * (s->high - s->low);
}

static void take_length(sole *s, const float p[3])
{
    float d[3];
    noh_sub3(p, s->ankle, d);
    const float at = noh_dot3(d, s->ahead);
    if (!is_low(s, p)) return;
    s->along[0] = at < s->along[0] ? at : s->along[0];
    s->along[1] = at > s->along[1] ? at : s->along[1];
}

static void take_third(sole *s, const float p[3], uint32_t joint)
{
    float d[3];
    noh_sub3(p, s->ankle, d);
    const float at = noh_dot3(d, s->ahead), side = noh_dot3(d, s->across);
    const float share = (at - s->along[0]) / (s->along[1] - s->along[0]);
    struct third *t = &s->thirds[share < 0.34f ? 0 : share < 0.75f ? 1 : 2];
    if (!is_low(s, p)) return;
    if (!t->count || p[1] < t->low) {
        t->low = p[1];
        t->low_at = at;
        t->joint = joint;
    }
    t->side[0] = !t->count || side < t->side[0] ? side : t->side[0];
    t->side[1] = !t->count || side > t->side[1] ? side : t->side[1];
    t->count++;
}

static void probe_mesh(sole *s, const noh_mesh *mesh, const noh_skin *skin, int pass)
{
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX], point[3];
        (void)noh_mesh_influences(mesh, v, joints, weights);
        const uint32_t joint = skin->joints[joints[0]];
        if (!noh_joint_is_below(&s->source->joints, joint, s->foot)) continue;
        noh_rig_vertex(&s->source->joints, mesh, skin, v, joints[0], point);
        if (pass == 0) take_extent(s, point);
        if (pass == 1) take_length(s, point);
        if (pass == 2) take_third(s, point, joint);
    }
}

static void probe(sole *s, int pass)
{
    for (uint32_t i = 0; i < s->source->pack->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        noh_skin skin;
        if (noh_pack_mesh_at(s->source->pack, i, &mesh, NULL) ||
            noh_pack_skin_at(s->source->pack, mesh.header->skin, &skin, NULL) ||
            skin.header->skeleton != s->source->skeleton) {
            continue;
        }
        probe_mesh(s, &mesh, &skin, pass);
    }
}

/* Two points of a third of the sole, a fifth of its width inside its edges, because feet are round. */
static void points_of(const sole *s, int third, noh_feet_point out[2])
{
    const struct third *t = &s->thirds[third];
    const float ends[3] = { s->along[0], t->low_at, s->along[1] }, inset = 0.06f * (s->along[1] - s->along[0]);
    const float at = third == 0 ? ends[0] + inset : third == 1 ? ends[1] : ends[2] - inset;
    float position[3], rotation[4], back[4];
    noh_ragdoll_bind(&s->source->joints, t->joint, position, rotation);
    noh_quat_conjugate(rotation, back);
    for (int side = 0; side < 2; side++) {
        const float width = t->side[1] - t->side[0], across = t->side[side] + (side ? -0.2f : 0.2f) * width;
        float p[3] = { s->ankle[0], 0.0f, s->ankle[2] };
        noh_madd3(p, at, s->ahead, p);
        noh_madd3(p, across, s->across, p);
        p[1] = t->low;
        noh_sub3(p, position, p);
        noh_quat_rotate(back, p, out[side].at);
        out[side].joint = t->joint;
    }
}

/* Returns 0 if there is no skin, or it has no length. */
static int find_sole(const noh_ragdoll_source *source, noh_feet_leg *leg)
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f }, up[3] = { 0.0f, 1.0f, 0.0f };
    float unused[4];
    sole s;
    memset(&s, 0, sizeof s);
    s.source = source;
    s.foot = leg->foot;
    noh_ragdoll_bind(&source->joints, leg->foot, s.ankle, unused);
    probe(&s, 0);
    if (s.count < 8) return 0;
    for (int i = 0; i < 3; i++) s.ahead[i] = i == 1 ? 0.0f : s.sum[i] / (float)s.count - s.ankle[i];
    noh_normalize3(s.ahead, z);
    noh_cross3(up, s.ahead, s.across);
    s.along[0] = 1e30f;
    s.along[1] = -1e30f;
    probe(&s, 1);
    if (!(s.along[1] > s.along[0])) return 0;
    probe(&s, 2);
    for (int t = 0; t < 3; t++) {
        if (!s.thirds[t].count) return 0;
        points_of(&s, t, &leg->points[2 * t]);
    }
    memcpy(leg->knee, s.ahead, sizeof leg->knee);
    return 1;
}

/* ---- all ---- */

/* Measure the leg's length, and the direction of its knee from the foot's, in the thigh's space. */
static float measure(const noh_ragdoll_source *s, noh_feet_leg *leg)
{
    float hip[3], knee[3], ankle[3], rotation[4], unused[4];
    noh_ragdoll_bind(&s->joints, leg->thigh, hip, rotation);
    noh_ragdoll_bind(&s->joints, leg->shin, knee, unused);
    noh_ragdoll_bind(&s->joints, leg->foot, ankle, unused);
    noh_quat_conjugate(rotation, rotation);
    noh_quat_rotate(rotation, leg->knee, leg->knee);
    return noh_apart3(hip, knee) + noh_apart3(knee, ankle);
}

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

noh_result noh_feet_rig_make(const noh_ragdoll_source *source, noh_feet_rig *rig, noh_error *error)
{
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    uint32_t count;
    NOH_ASSERT(source && source->pack && rig);
    const noh_result result = noh_ragdoll_find_rows(source, rows, &count, error);
    if (result != NOH_OK) return result;
    memset(rig, 0, sizeof *rig);
    for (uint32_t i = 0; i < count && rig->leg_count < NOH_FEET_LEGS_MAX; i++) {
        noh_feet_leg *leg = &rig->legs[rig->leg_count];
        if (!leg_of(source, rows, count, i, leg) || !find_sole(source, leg)) continue;
        const float length = measure(source, leg);
        if (!(length > 0.0f)) continue;
        rig->length = length > rig->length ? length : rig->length;
        rig->last = larger(rig->last, leg->foot);
        for (uint32_t p = 0; p < NOH_FEET_POINTS; p++) rig->last = larger(rig->last, leg->points[p].joint);
        rig->leg_count++;
    }
    if (!rig->leg_count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        "no thigh of this skeleton has a shin and a skinned foot: its feet cannot be placed", 0, 0);
    }
    rig->top = rows[0].joint;
    while (source->joints.parents[rig->top] != NOH_JOINT_ROOT) rig->top = source->joints.parents[rig->top];
    return NOH_OK;
}

/* ---- the front ---- */

/* Where the joints of its toes lie, as the direction of the knee. Returns 0 without toes. */
static int find_toes(const noh_ragdoll_source *source, noh_feet_leg *leg)
{
    static const float none[3] = { 0.0f, 0.0f, 0.0f };
    const noh_skeleton *joints = &source->joints;
    float ankle[3], toe[3], unused[4];
    memset(leg->knee, 0, sizeof leg->knee);
    noh_ragdoll_bind(joints, leg->foot, ankle, unused);
    for (uint32_t j = leg->foot + 1u; j < joints->joint_count; j++) {
        if (joints->parents[j] != leg->foot) continue;
        noh_ragdoll_bind(joints, j, toe, unused);
        noh_sub3(toe, ankle, toe);
        noh_madd3(leg->knee, 1.0f, toe, leg->knee);
    }
    leg->knee[1] = 0.0f;
    noh_normalize3(leg->knee, none);
    (void)measure(source, leg);
    return noh_dot3(leg->knee, leg->knee) > 0.0f;
}

static void find_legs(const noh_ragdoll_source *source, noh_feet_rig *rig)
{
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    uint32_t count;
    memset(rig, 0, sizeof *rig);
    if (noh_ragdoll_find_rows(source, rows, &count, NULL) != NOH_OK) return;
    for (uint32_t i = 0; i < count && rig->leg_count < NOH_FEET_LEGS_MAX; i++) {
        noh_feet_leg *leg = &rig->legs[rig->leg_count];
        if (leg_of(source, rows, count, i, leg) && find_toes(source, leg)) rig->leg_count++;
    }
}

uint32_t noh_feet_front(const noh_ragdoll_source *source, const noh_feet_rig *rig)
{
    float ahead[3] = { 0.0f, 0.0f, 0.0f }, hips[2][3] = { { 0.0f } };
    noh_feet_rig without_skin;
    if (!rig->leg_count) {
        find_legs(source, &without_skin);
        rig = &without_skin;
    }
    for (uint32_t i = 0; i < rig->leg_count; i++) {
        float knee[3], rotation[4];
        noh_ragdoll_bind(&source->joints, rig->legs[i].thigh, hips[i % 2u], rotation);
        noh_quat_rotate(rotation, rig->legs[i].knee, knee);
        noh_madd3(ahead, 1.0f, knee, ahead);
    }
    const uint32_t front = noh_quarter_of(ahead[0], ahead[2]);
    if (rig->leg_count != 2u) return front;
    noh_sub3(hips[0], hips[1], hips[0]);
    return noh_quarter_of(hips[0][0], hips[0][2]) % 2u == front % 2u ? 0u : front; /* along the hips: not known */
}

uint32_t noh_front_of(const noh_ragdoll_source *source)
{
    noh_feet_rig rig;
    if (noh_feet_rig_make(source, &rig, NULL) != NOH_OK) rig.leg_count = 0;
    return noh_feet_front(source, &rig);
}
