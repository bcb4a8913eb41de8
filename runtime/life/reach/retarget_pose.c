/* retarget_pose.c: a pose through a map: rotations by joint, then what moves, then the limbs. */
#include "core/base/assert_internal.h"
#include "life/reach/retarget_internal.h"

/* noh_quat_mul, in line: it is most of the work. Sums only, as there. */
static inline void product(const float a[4], const float b[4], float out[4])
{
    const float x = b[0], y = b[1], z = b[2], w = b[3], nx = -x, ny = -y, nz = -z;
    const float r0 = a[3] * x + a[0] * w + a[1] * z + a[2] * ny, r1 = a[3] * y + a[0] * nz + a[1] * w + a[2] * x;
    const float r2 = a[3] * z + a[0] * y + a[1] * nx + a[2] * w, r3 = a[3] * w + a[0] * nx + a[1] * ny + a[2] * nz;
    out[0] = r0;
    out[1] = r1;
    out[2] = r2;
    out[3] = r3;
}

/* ---- places ---- */

static void place_local(const noh_transform *local, noh_retarget_place *out)
{
    memcpy(out->rotation, local->rotation, sizeof out->rotation);
    memcpy(out->position, local->translation, sizeof out->position);
    out->scale = local->scale[0];
}

void noh_retarget_place_of(const noh_skeleton *skeleton, const noh_transform *pose, uint32_t joint, uint32_t ancestor,
                           noh_retarget_place *out)
{
    uint32_t up = skeleton->parents[joint];
    place_local(&pose[joint], out);
    for (; up != ancestor && up != NOH_JOINT_ROOT; up = skeleton->parents[up]) {
        const noh_transform *p = &pose[up];
        for (int i = 0; i < 3; i++) out->position[i] *= p->scale[i];
        noh_quat_rotate(p->rotation, out->position, out->position);
        noh_madd3(out->position, 1.0f, p->translation, out->position);
        product(p->rotation, out->rotation, out->rotation);
        out->scale *= p->scale[0];
    }
}

void noh_retarget_place_below(const noh_skeleton *skeleton, const noh_transform *pose, uint32_t joint,
                              uint32_t ancestor, const noh_retarget_place *at, noh_retarget_place *out)
{
    noh_retarget_place_of(skeleton, pose, joint, ancestor, out);
    noh_quat_rotate(at->rotation, out->position, out->position);
    noh_madd3(at->position, at->scale, out->position, out->position);
    product(at->rotation, out->rotation, out->rotation);
    out->scale *= at->scale;
}

void noh_retarget_put(const noh_skeleton *skeleton, noh_transform *pose, uint32_t joint, const float position[3])
{
    const uint32_t parent = skeleton->parents[joint];
    float *t = pose[joint].translation, back[4];
    noh_retarget_place up;
    memcpy(t, position, 3 * sizeof *t);
    if (parent == NOH_JOINT_ROOT) return;
    noh_retarget_place_of(skeleton, pose, parent, NOH_JOINT_ROOT, &up);
    noh_sub3(t, up.position, t);
    noh_quat_conjugate(up.rotation, back);
    noh_quat_rotate(back, t, t);
    for (int i = 0; i < 3; i++) t[i] /= up.scale;
}

/* ---- a pose ---- */

static void unpack(const int16_t packed[4], float q[4])
{
    for (int i = 0; i < 4; i++) q[i] = (float)packed[i] * (1.0f / 32767.0f);
}

/* A product of unit quaternions, some of them rounded to 16 bits: one step of Newton's iteration has the length. */
static void make_unit(float q[4])
{
    const float scale = 1.5f - 0.5f * noh_quat_dot(q, q);
    for (int i = 0; i < 4; i++) q[i] *= scale;
}

static void turn_joint(const noh_retarget *r, const noh_transform *from, uint32_t joint, noh_transform *to)
{
    const noh_retarget_joint *m = &r->joints[joint];
    uint32_t at = m->source;
    float q[4], part[4];
    unpack(m->after, part);
    product(from[at].rotation, part, q);
    for (uint32_t above = m->above & ~NOH_RETARGET_WHOLE; above; above--) {
        at = r->clips.source->parents[at];
        product(from[at].rotation, q, q);
    }
    unpack(m->before, part);
    product(part, q, q);
    if ((m->above & NOH_RETARGET_WHOLE) && r->clips.target->parents[joint] != NOH_JOINT_ROOT) {
        noh_retarget_place up;
        noh_retarget_place_of(r->clips.target, to, r->clips.target->parents[joint], NOH_JOINT_ROOT, &up);
        noh_quat_conjugate(up.rotation, part);
        product(part, q, q);
    }
    make_unit(q);
    memcpy(to[joint].rotation, q, sizeof q);
}

void noh_retarget_point(const noh_retarget *r, const float source[3], float out[3])
{
    float d[3];
    noh_sub3(source, r->from[1], d);
    d[1] -= r->ground;
    noh_quat_rotate(r->facing, d, d);
    noh_madd3(r->to[1], r->clips.ratio, d, out);
}

static void move_joint(const noh_retarget *r, const noh_transform *from, uint32_t moved, noh_transform *to)
{
    noh_retarget_place at;
    float d[3];
    noh_retarget_place_of(r->clips.source, from, r->moved[moved][0], NOH_JOINT_ROOT, &at);
    noh_sub3(at.position, r->from[moved], d);
    d[1] -= moved ? r->ground : 0.0f; /* a root stays on its own ground */
    noh_quat_rotate(r->facing, d, d);
    noh_madd3(r->to[moved], r->clips.ratio, d, d);
    noh_retarget_put(r->clips.target, to, r->moved[moved][1], d);
}

void noh_retarget_pose(const noh_retarget *r, const noh_transform *from, const float (*feet)[3], uint32_t joint_count,
                       noh_transform *to)
{
    NOH_ASSERT(r && from && to && joint_count <= r->clips.target->joint_count);
    memcpy(to, r->rest, joint_count * sizeof *to);
    for (uint32_t j = 0; j < joint_count; j++) {
        if (r->joints[j].source != NOH_JOINT_ROOT) turn_joint(r, from, j, to);
    }
    for (uint32_t i = 0; i < 2; i++) {
        if (r->moved[i][1] < joint_count) move_joint(r, from, i, to);
    }
    noh_retarget_bend(r, from, feet, joint_count, to);
}
