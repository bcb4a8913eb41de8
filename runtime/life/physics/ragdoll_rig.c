/* ragdoll_rig.c: makes capsules, masses and joints of a ragdoll from a skeleton and its skin. */
#include "core/base/trig_internal.h"
#include "life/physics/ragdoll_internal.h"
#include "life/physics/ragdoll_rig_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"
#include "life/physics/shape_internal.h"

#define BINS 64u
#define DENSITY 1000.0f
#define MARGIN 0.02f /* radians that rest keeps from a hinge's limits */

/* A body while it is made. */
typedef struct bone {
    float start[3], direction[3]; /* start of its joint, metres; direction of its limb */
    float length;                 /* to the next body, or to the end of its skin */
    uint32_t child_count, child;  /* the last of them */
} bone;

typedef struct maker {
    const noh_ragdoll_source *source;
    const noh_ragdoll_row *rows;
    noh_ragdoll_rig *rig;
    bone bones[NOH_RAGDOLL_BODIES_MAX];
    float forward[3], up[3];
} maker;

/* ---- skeleton ---- */

void noh_ragdoll_bind(const noh_skeleton *skeleton, uint32_t joint, float position[3], float rotation[4])
{
    const noh_transform *bind = skeleton->bind_pose;
    memcpy(position, bind[joint].translation, 3 * sizeof *position);
    memcpy(rotation, bind[joint].rotation, 4 * sizeof *rotation);
    for (uint32_t up = skeleton->parents[joint]; up != NOH_JOINT_ROOT; up = skeleton->parents[up]) {
        for (int i = 0; i < 3; i++) position[i] *= bind[up].scale[i];
        noh_quat_rotate(bind[up].rotation, position, position);
        noh_madd3(bind[up].translation, 1.0f, position, position);
        noh_quat_mul(bind[up].rotation, rotation, rotation);
    }
    noh_quat_normalize(rotation);
}

void noh_rig_vertex(const noh_skeleton *k, const noh_mesh *mesh, const noh_skin *skin, uint32_t vertex, uint32_t slot,
                    float point[3])
{
    const float *v = mesh->positions + 3 * (size_t)vertex, *rows = skin->inverse_bind + 12 * (size_t)slot;
    float local[3], position[3], rotation[4];
    for (int i = 0; i < 3; i++) local[i] = noh_dot3(rows + 4 * i, v) + rows[4 * i + 3];
    for (uint32_t up = skin->joints[slot]; up != NOH_JOINT_ROOT; up = k->parents[up]) {
        for (int i = 0; i < 3; i++) local[i] *= k->bind_pose[up].scale[i];
    }
    noh_ragdoll_bind(k, skin->joints[slot], position, rotation);
    noh_quat_rotate(rotation, local, local);
    noh_madd3(position, 1.0f, local, point);
}

/* The body that a joint moves with: its own, or its nearest ancestor's; the first body for joints above all bodies. */
static uint32_t owner_of(const maker *m, uint32_t joint)
{
    while (joint != NOH_JOINT_ROOT) {
        for (uint32_t i = 0; i < m->rig->body_count; i++) {
            if (m->rows[i].joint == joint) return i;
        }
        joint = m->source->joints.parents[joint];
    }
    return 0;
}

/* ---- skin ---- */

/* What to measure at each vertex of a body. */
typedef struct probe {
    uint32_t body;
    const float *origin, *axis; /* axis unit */
    int across;                 /* 1: distances from the axis; 0: along it */
    float low, high;            /* range of the values, found before they are counted */
    float sum[3];
    uint32_t count, bins[BINS];
} probe;

static void take(probe *p, const float point[3], int counts)
{
    float d[3];
    noh_sub3(point, p->origin, d);
    const float along = noh_dot3(d, p->axis);
    noh_madd3(d, p->across ? -along : 0.0f, p->axis, d);
    const float value = p->across ? noh_length3(d) : along;
    if (!counts) {
        p->low = !p->count || value < p->low ? value : p->low;
        p->high = !p->count || value > p->high ? value : p->high;
        for (int i = 0; i < 3; i++) p->sum[i] += point[i];
        p->count++;
    } else if (p->high > p->low) {
        const uint32_t bin = (uint32_t)((value - p->low) / (p->high - p->low) * (float)BINS);
        p->bins[bin < BINS ? bin : BINS - 1u]++;
    }
}

/* A vertex as placed by its heaviest joint in the bind pose, metres. */
static void place_vertex(const maker *m, const noh_mesh *mesh, const noh_skin *skin, uint32_t vertex, uint32_t slot,
                         float point[3])
{
    noh_rig_vertex(&m->source->joints, mesh, skin, vertex, slot, point);
    for (int i = 0; i < 3; i++) point[i] *= m->source->metres;
}

static void probe_mesh(const maker *m, const noh_mesh *mesh, const noh_skin *skin, probe *p, int counts)
{
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX], point[3];
        (void)noh_mesh_influences(mesh, v, joints, weights);
        if (owner_of(m, skin->joints[joints[0]]) != p->body) continue;
        place_vertex(m, mesh, skin, v, joints[0], point);
        take(p, point, counts);
    }
}

static void probe_skin(const maker *m, probe *p, int counts)
{
    for (uint32_t i = 0; i < m->source->pack->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        noh_skin skin;
        if (noh_pack_mesh_at(m->source->pack, i, &mesh, NULL) ||
            noh_pack_skin_at(m->source->pack, mesh.header->skin, &skin, NULL) ||
            skin.header->skeleton != m->source->skeleton) {
            continue;
        }
        probe_mesh(m, &mesh, &skin, p, counts);
    }
}

/* The value below which a share of a body's vertices lie. */
static float percentile(const probe *p, float share)
{
    const float wanted = share * (float)p->count;
    uint32_t sum = 0, bin = 0;
    while (bin < BINS - 1u && (float)(sum + p->bins[bin]) < wanted) sum += p->bins[bin++];
    const float part = p->bins[bin] ? (wanted - (float)sum) / (float)p->bins[bin] : 0.5f;
    return p->low + (p->high - p->low) * ((float)bin + (part > 1.0f ? 1.0f : part)) / (float)BINS;
}

static probe probe_body(const maker *m, uint32_t body, const float origin[3], const float axis[3], int across)
{
    probe p;
    memset(&p, 0, sizeof p);
    p.body = body;
    p.origin = origin;
    p.axis = axis;
    p.across = across;
    probe_skin(m, &p, 0);
    probe_skin(m, &p, 1);
    return p;
}

/* ---- bones ---- */

/* Find where bodies begin, and which follows which. */
static void find_bones(maker *m)
{
    for (uint32_t i = 0; i < m->rig->body_count; i++) {
        bone *b = &m->bones[i];
        float unused[4];
        const uint32_t up = m->source->joints.parents[m->rows[i].joint];
        noh_ragdoll_bind(&m->source->joints, m->rows[i].joint, b->start, unused);
        for (int k = 0; k < 3; k++) b->start[k] *= m->source->metres;
        m->rig->bodies[i].joint = m->rows[i].joint;
        m->rig->bodies[i].parent = i ? owner_of(m, up) : NOH_NONE;
        if (i) {
            bone *parent = &m->bones[m->rig->bodies[i].parent];
            parent->child_count++;
            parent->child = i;
        }
    }
}

/* The length of a body with little or no skin of its own: three tenths of its parent's. */
static float parent_length(const maker *m, uint32_t i)
{
    const uint32_t parent = m->rig->bodies[i].parent;
    const float above = parent == NOH_NONE ? 0.0f : m->bones[parent].length;
    return above > 0.0f ? 0.3f * above : 0.1f;
}

/* The limb's direction and length: to the next body; without one, or with several, to the end of its skin. */
static void aim_bone(maker *m, uint32_t i)
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    bone *b = &m->bones[i];
    if (b->child_count == 1) {
        noh_sub3(m->bones[b->child].start, b->start, b->direction);
        b->length = noh_length3(b->direction);
        noh_normalize3(b->direction, up);
    } else {
        const uint32_t parent = m->rig->bodies[i].parent;
        const float *back = parent == NOH_NONE ? up : m->bones[parent].direction;
        const probe all = probe_body(m, i, b->start, up, 0);
        memcpy(b->direction, back, sizeof b->direction);
        for (int k = 0; k < 3 && all.count; k++) b->direction[k] = all.sum[k] / (float)all.count - b->start[k];
        noh_normalize3(b->direction, back);
        const probe along = probe_body(m, i, b->start, b->direction, 0);
        b->length = along.count ? percentile(&along, 0.97f) : 0.0f;
    }
    if (!(b->length > 1e-4f) || (!b->child_count && b->length < 0.3f * parent_length(m, i))) {
        b->length = parent_length(m, i);
    }
}

/* ---- capsules ---- */

/* The line of a body with several children runs between the two that are farthest apart: hips, shoulders. */
static int widest(const maker *m, uint32_t body, float axis[3], float middle[3])
{
    float most = 0.0f;
    for (uint32_t i = 1; i < m->rig->body_count; i++) {
        for (uint32_t k = 1; k < i; k++) {
            const float far = noh_apart3(m->bones[i].start, m->bones[k].start);
            if (m->rig->bodies[i].parent == body && m->rig->bodies[k].parent == body && far > most) {
                most = far;
                noh_sub3(m->bones[i].start, m->bones[k].start, axis);
                noh_madd3(m->bones[k].start, 0.5f, axis, middle);
            }
        }
    }
    return most > 1e-4f;
}

static void place_capsule(noh_ragdoll_body *b, const float centre[3], const float axis[3], float length, float radius)
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f }, x[3] = { 1.0f, 0.0f, 0.0f };
    b->radius = radius < 0.15f * length ? 0.15f * length : radius > 0.5f * length ? 0.5f * length : radius;
    b->half = 0.5f * length - b->radius;
    b->half = b->half < 0.05f * length ? 0.05f * length : b->half;
    memcpy(b->position, centre, sizeof b->position);
    noh_quat_between(z, axis, x, b->rotation);
}

/* A trunk's body: across, as wide as its skin; from one child bone to the other if it has little skin itself. */
static int wide_capsule(const maker *m, uint32_t i)
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f };
    float axis[3] = { 0.0f, 0.0f, 0.0f }, centre[3], middle[3];
    if (m->bones[i].child_count < 2 || !widest(m, i, axis, middle)) return 0;
    const float width = noh_length3(axis);
    noh_normalize3(axis, z);
    const probe along = probe_body(m, i, m->bones[i].start, axis, 0);
    const float length = along.count < 8 ? 0.0f : percentile(&along, 0.95f) - percentile(&along, 0.05f);
    if (length < 0.5f * width) {
        place_capsule(&m->rig->bodies[i], middle, axis, width, 0.0f);
        return 1;
    }
    for (int k = 0; k < 3; k++) centre[k] = along.sum[k] / (float)along.count;
    const probe across = probe_body(m, i, centre, axis, 1);
    place_capsule(&m->rig->bodies[i], centre, axis, length, percentile(&across, 0.7f));
    return 1;
}

static void long_capsule(const maker *m, uint32_t i)
{
    const bone *b = &m->bones[i];
    float centre[3];
    const probe across = probe_body(m, i, b->start, b->direction, 1);
    noh_madd3(b->start, 0.5f * b->length, b->direction, centre);
    place_capsule(&m->rig->bodies[i], centre, b->direction, b->length,
                  across.count ? percentile(&across, 0.8f) : 0.25f * b->length);
}

/* ---- masses ---- */

/* A cylinder and two half balls, with the density of water. */
static void weigh(noh_ragdoll_body *b)
{
    const float r = b->radius, l = 2.0f * b->half, r2 = r * r;
    const float rod = DENSITY * NOH_PI * r2 * l, ball = DENSITY * NOH_PI * r2 * r * (4.0f / 3.0f);
    b->mass = rod + ball;
    b->inertia_along = rod * r2 * 0.5f + ball * r2 * 0.4f;
    b->inertia_across = rod * (l * l / 12.0f + r2 * 0.25f) + ball * (0.4f * r2 + l * l * 0.25f + 0.375f * l * r);
}

static float height_of(const maker *m)
{
    float low = 1e30f, high = -1e30f;
    for (uint32_t i = 0; i < m->rig->body_count; i++) {
        const noh_ragdoll_body *b = &m->rig->bodies[i];
        const float at = noh_dot3(b->position, m->up), reach = b->half + b->radius;
        low = at - reach < low ? at - reach : low;
        high = at + reach > high ? at + reach : high;
    }
    return high - low;
}

static float scale_masses(maker *m)
{
    const float height = height_of(m) / 1.75f;
    const float wanted = m->source->mass > 0.0f ? m->source->mass : 70.0f * height * height * height;
    float sum = 0.0f;
    for (uint32_t i = 0; i < m->rig->body_count; i++) {
        weigh(&m->rig->bodies[i]);
        sum += m->rig->bodies[i].mass;
    }
    for (uint32_t i = 0; i < m->rig->body_count; i++) {
        noh_ragdoll_body *b = &m->rig->bodies[i];
        b->mass *= wanted / sum;
        b->inertia_across *= wanted / sum;
        b->inertia_along *= wanted / sum;
    }
    return wanted;
}

/* ---- joints ---- */

/* Up is from the first body to its farthest descendant above; forward is where the feet point: the bodies that bend
 * upwards. */
static void find_directions(maker *m)
{
    static const float y[3] = { 0.0f, 1.0f, 0.0f }, z[3] = { 0.0f, 0.0f, 1.0f };
    float feet[3] = { 0.0f, 0.0f, 0.0f };
    memcpy(m->up, y, sizeof m->up);
    for (uint32_t i = 0; i < m->rig->body_count; i++) {
        if (m->rows[i].toward == NOH_RAGDOLL_UPWARD) noh_madd3(feet, 1.0f, m->bones[i].direction, feet);
    }
    noh_reject3(feet, m->up, m->forward);
    noh_normalize3(m->forward, z);
}

/* The axis about which a bone turns as it bends. */
static void bend_axis(const maker *m, uint32_t i, float axis[3])
{
    const bone *b = &m->bones[i], *parent = &m->bones[m->rig->bodies[i].parent];
    const uint32_t toward = m->rows[i].toward;
    const float sign = toward == NOH_RAGDOLL_BACKWARD ? -1.0f : 1.0f;
    const float *to = toward == NOH_RAGDOLL_UPWARD ? m->up : m->forward;
    float bent[3], hint[3];
    noh_cross3(b->direction, to, hint);
    for (int k = 0; k < 3; k++) hint[k] *= sign;
    noh_perpendicular3(b->direction, hint, axis);
    noh_cross3(parent->direction, b->direction, bent);
    if (m->rows[i].hinge && noh_length3(bent) > 0.17f && noh_dot3(bent, axis) > 0.5f * noh_length3(bent)) {
        noh_perpendicular3(b->direction, bent, axis); /* already bent in the bind pose: that way */
    }
}

/* A rotation whose z axis is `z` and whose x axis is `x`, both unit and perpendicular. */
static void frame_of(const float x[3], const float z[3], float q[4])
{
    static const float unit_z[3] = { 0.0f, 0.0f, 1.0f }, unit_x[3] = { 1.0f, 0.0f, 0.0f };
    float first[4], turned[3], second[4];
    noh_quat_between(unit_z, z, unit_x, first);
    noh_quat_rotate(first, unit_x, turned);
    noh_quat_between(turned, x, z, second);
    noh_quat_mul(second, first, q);
    noh_quat_normalize(q);
}

/* Limits of a hinge count from the straight limb: subtract its bend in the bind pose. */
static void hinge_limits(const maker *m, uint32_t i, const float axis[3], noh_ragdoll_joint *j)
{
    const bone *b = &m->bones[i], *parent = &m->bones[m->rig->bodies[i].parent];
    float cross[3];
    noh_cross3(parent->direction, b->direction, cross);
    const float bent = noh_atan2(noh_dot3(cross, axis), noh_dot3(parent->direction, b->direction));
    j->twist_min = m->rows[i].bend_min - bent;
    j->twist_max = m->rows[i].bend_max - bent;
    j->twist_min = j->twist_min > -MARGIN ? -MARGIN : j->twist_min < -3.1f ? -3.1f : j->twist_min;
    j->twist_max = j->twist_max < MARGIN ? MARGIN : j->twist_max > 3.1f ? 3.1f : j->twist_max;
}

static void make_joint(maker *m, uint32_t i, float mass)
{
    const noh_ragdoll_row *row = &m->rows[i];
    noh_ragdoll_joint *j = &m->rig->joints[i];
    float axis[3];
    memcpy(j->anchor, m->bones[i].start, sizeof j->anchor);
    bend_axis(m, i, axis);
    j->friction = row->friction * mass / 70.0f * height_of(m) / 1.75f;
    if (row->hinge) {
        j->flags = NOH_RAGDOLL_HINGE;
        frame_of(m->bones[i].direction, axis, j->frame);
        hinge_limits(m, i, axis, j);
        return;
    }
    frame_of(axis, m->bones[i].direction, j->frame);
    j->swing_min[0] = row->bend_min;
    j->swing_max[0] = row->bend_max;
    j->swing_min[1] = -row->side;
    j->swing_max[1] = row->side;
    j->twist_min = -row->twist;
    j->twist_max = row->twist;
}

/* A small body with distant joints would be spun by them in each correction: its inertia is at least a tenth of its
 * mass at the farthest one, about each axis. */
static void spread_inertia(noh_ragdoll_rig *rig)
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f };
    for (uint32_t i = 1; i < rig->body_count; i++) {
        noh_ragdoll_body *both[2] = { &rig->bodies[i], &rig->bodies[rig->bodies[i].parent] };
        for (int k = 0; k < 2; k++) {
            noh_ragdoll_body *b = both[k];
            float axis[3], arm[3], aside[3];
            noh_quat_rotate(b->rotation, z, axis);
            noh_sub3(rig->joints[i].anchor, b->position, arm);
            noh_reject3(arm, axis, aside);
            const float across = 0.1f * b->mass * noh_dot3(arm, arm), along = 0.1f * b->mass * noh_dot3(aside, aside);
            b->inertia_across = across > b->inertia_across ? across : b->inertia_across;
            b->inertia_along = along > b->inertia_along ? along : b->inertia_along;
        }
    }
}

/* A small body gets a good part of its parent's mass, and would turn far more easily than that: in a fall it spins more
 * in a substep than its limits can correct. Its inertia is at least a twelfth of its parent's, about each axis. */
static void stabilize_inertia(noh_ragdoll_rig *rig)
{
    for (uint32_t i = 1; i < rig->body_count; i++) {
        noh_ragdoll_body *b = &rig->bodies[i];
        const noh_ragdoll_body *parent = &rig->bodies[b->parent];
        const float across = parent->inertia_across / 12.0f, along = parent->inertia_along / 12.0f;
        b->inertia_across = across > b->inertia_across ? across : b->inertia_across;
        b->inertia_along = along > b->inertia_along ? along : b->inertia_along;
    }
}

/* ---- pairs ---- */

/* The distance of two capsules at rest. */
static float gap(const noh_ragdoll_body *a, const noh_ragdoll_body *b)
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f };
    float axis[3], ends[4][3], along[2], p[3], q[3], d[3];
    noh_quat_rotate(a->rotation, z, axis);
    noh_madd3(a->position, -a->half, axis, ends[0]);
    noh_madd3(a->position, a->half, axis, ends[1]);
    noh_quat_rotate(b->rotation, z, axis);
    noh_madd3(b->position, -b->half, axis, ends[2]);
    noh_madd3(b->position, b->half, axis, ends[3]);
    noh_segments_closest(ends[0], ends[1], ends[2], ends[3], along);
    noh_sub3(ends[1], ends[0], d);
    noh_madd3(ends[0], along[0], d, p);
    noh_sub3(ends[3], ends[2], d);
    noh_madd3(ends[2], along[1], d, q);
    return noh_apart3(p, q) - a->radius - b->radius;
}

/* Neighbours overlap by nature, as do bodies joined by a third one, except two children of the same parent. */
static int may_collide(const noh_ragdoll_rig *rig, uint32_t a, uint32_t b)
{
    const uint32_t pa = rig->bodies[a].parent, pb = rig->bodies[b].parent;
    if (pa == b || pb == a) return 0;
    return (pa == NOH_NONE || rig->bodies[pa].parent != b) && (pb == NOH_NONE || rig->bodies[pb].parent != a);
}

/* The pairs nearest to each other at rest, relative to their sizes. */
static void find_pairs(noh_ragdoll_rig *rig)
{
    float taken = -1.0f; /* the last one taken; the next one is no nearer */
    uint32_t last = 0;
    while (rig->pair_count < NOH_RAGDOLL_PAIRS_MAX) {
        float best = 1e30f;
        uint32_t found = NOH_NONE;
        for (uint32_t k = 0; k < rig->body_count * rig->body_count; k++) {
            const uint32_t a = k / rig->body_count, b = k % rig->body_count;
            if (a >= b || !may_collide(rig, a, b)) continue;
            const float near = gap(&rig->bodies[a], &rig->bodies[b]) / (rig->bodies[a].radius + rig->bodies[b].radius);
            const int is_next = near > taken || (near == taken && k > last);
            if (near > -0.5f && is_next && near < best) {
                best = near;
                found = k;
            }
        }
        if (found == NOH_NONE) return;
        rig->pairs[rig->pair_count][0] = (uint8_t)(found / rig->body_count);
        rig->pairs[rig->pair_count++][1] = (uint8_t)(found % rig->body_count);
        taken = best;
        last = found;
    }
}

/* ---- all ---- */

static int good_row(const noh_ragdoll_source *s, const noh_ragdoll_row *rows, uint32_t i)
{
    const noh_ragdoll_row *r = &rows[i];
    return r->joint < s->joints.joint_count && (!i || r->joint > rows[i - 1u].joint) &&
           noh_joint_is_above(&s->joints, rows[0].joint, r->joint) && r->toward <= NOH_RAGDOLL_UPWARD &&
           r->bend_min <= 0.0f && r->bend_min >= -NOH_PI && r->bend_max >= 0.0f && r->bend_max <= NOH_PI &&
           r->side >= 0.0f && r->side <= NOH_PI && r->twist >= 0.0f && r->twist <= NOH_PI && r->friction >= 0.0f &&
           noh_is_finite(r->friction);
}

noh_result noh_ragdoll_rig_make(const noh_ragdoll_source *source, const noh_ragdoll_row *rows, uint32_t count,
                                noh_ragdoll_rig *rig, noh_error *error)
{
    maker m;
    NOH_ASSERT(source && source->pack && rows && rig);
    if (!count || count > NOH_RAGDOLL_BODIES_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "a ragdoll needs 1 to NOH_RAGDOLL_BODIES_MAX rows", count,
                        NOH_RAGDOLL_BODIES_MAX);
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!good_row(source, rows, i)) {
            return noh_fail(error, NOH_ERR_ARG,
                            "a ragdoll row has a number out of its range, or its joint is not a descendant of "
                            "the first row's, in order",
                            i, 0);
        }
    }
    memset(&m, 0, sizeof m);
    memset(rig, 0, sizeof *rig);
    m.source = source;
    m.rows = rows;
    m.rig = rig;
    rig->body_count = count;
    find_bones(&m);
    for (uint32_t i = 0; i < count; i++) aim_bone(&m, i);
    find_directions(&m);
    for (uint32_t i = 0; i < count; i++) {
        if (!wide_capsule(&m, i)) long_capsule(&m, i);
    }
    const float mass = scale_masses(&m);
    for (uint32_t i = 1; i < count; i++) make_joint(&m, i, mass);
    noh_ragdoll_stabilize(rig);
    spread_inertia(rig);
    stabilize_inertia(rig);
    find_pairs(rig);
    return noh_ragdoll_rig_check(rig, error);
}
