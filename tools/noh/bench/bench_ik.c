/* bench_ik.c: rows sim/two-bone: a leg by the closed form of body.h against the book's, which takes arc cosines and
 * makes rotations of axes and angles; sim/feet: both feet of the first pack's figure on a slope, in two-bone
 * solves; and sim/retarget: a pose of that figure on itself, by joint against the model matrices of as many, and its legs
 * and arms. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "life/reach/feet_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

#define SOLVES BENCH_TWO_BONE_SOLVES
#define SAMPLE_NS 5e6
#define RETARGETS 100u

/* ---- the book's way ---- */

static void cross(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* A quaternion that turns about an axis, which need not be unit. */
static void turn_about(const float axis[3], float angle, float q[4])
{
    const float length = sqrtf(dot(axis, axis)), s = length > 1e-12f ? sinf(0.5f * angle) / length : 0.0f;
    for (int i = 0; i < 3; i++) q[i] = axis[i] * s;
    q[3] = cosf(0.5f * angle);
}

/* out = a b; out may be neither. */
static void turn_both(const float a[4], const float b[4], float out[4])
{
    float c[3];
    cross(a, b, c);
    for (int i = 0; i < 3; i++) out[i] = a[3] * b[i] + b[3] * a[i] + c[i];
    out[3] = a[3] * b[3] - dot(a, b);
}

static float angle_of(float opposite, float a, float b)
{
    const float c = (a * a + b * b - opposite * opposite) / (2.0f * a * b);
    return acosf(c < -1.0f ? -1.0f : c > 1.0f ? 1.0f : c);
}

static float angle_between(const float a[3], const float b[3])
{
    const float c = dot(a, b) / sqrtf(dot(a, a) * dot(b, b));
    return acosf(c < -1.0f ? -1.0f : c > 1.0f ? 1.0f : c);
}

/* v turned by q. */
static void turned(const float q[4], const float v[3], float out[3])
{
    float c[3], d[3];
    cross(q, v, c);
    for (int i = 0; i < 3; i++) c[i] += q[3] * v[i];
    cross(q, c, d);
    for (int i = 0; i < 3; i++) out[i] = v[i] + 2.0f * d[i];
}

/* The part of v that is perpendicular to an axis. */
static void across(const float v[3], const float axis[3], float out[3])
{
    const float along = dot(v, axis) / dot(axis, axis);
    for (int i = 0; i < 3; i++) out[i] = v[i] - along * axis[i];
}

/* Bend the elbow until the hand is as far away as the target, by the law of cosines; turn the shoulder until it points
 * there; then turn the arm about that line until the elbow lies towards the pole. */
static void book_two_bone(const noh_ik_limb *limb, const float target[3], const float pole[3], noh_ik_bend *bend)
{
    float upper[3], lower[3], hand[3], to[3], axis[3], first[4], second[4], third[4], both[4], elbow[3], side[3];
    for (int i = 0; i < 3; i++) {
        upper[i] = limb->middle[i] - limb->start[i];
        lower[i] = limb->end[i] - limb->middle[i];
        hand[i] = limb->end[i] - limb->start[i];
        to[i] = target[i] - limb->start[i];
    }
    const float a = sqrtf(dot(upper, upper)), b = sqrtf(dot(lower, lower)), now = sqrtf(dot(hand, hand));
    const float wanted = fminf(sqrtf(dot(to, to)), a + b);
    cross(upper, lower, axis);
    turn_about(axis, angle_of(now, a, b) - angle_of(wanted, a, b), bend->middle);
    turn_about(axis, angle_of(b, a, now) - angle_of(b, a, wanted), first);
    cross(hand, to, axis);
    turn_about(axis, angle_between(hand, to), second);
    turn_both(second, first, both);
    turned(both, upper, elbow);
    across(elbow, to, elbow);
    across(pole, to, side);
    cross(elbow, side, axis);
    turn_about(axis, angle_between(elbow, side), third);
    turn_both(third, both, bend->start);
    bend->missed = 0.0f;
}

static void solve_as_the_book(void *self, uint32_t frame)
{
    static const noh_ik_limb limb = {
        { 0.0f, 1.4f, 0.0f }, { 0.0f, 1.1f, 0.02f }, { 0.0f, 0.82f, 0.0f }, 0.0f, 0.0f, 0.0f
    };
    static const float pole[3] = { 0.0f, 0.0f, 1.0f };
    static volatile float seen; /* keeps the results alive */
    (void)self;
    for (uint32_t i = 0; i < SOLVES; i++) {
        const float target[3] = { 0.001f * (float)(i % 300u), 1.0f + 0.001f * (float)(frame % 50u), 0.2f };
        noh_ik_bend bend;
        book_two_bone(&limb, target, pole, &bend);
        seen = bend.start[0];
    }
    (void)seen;
}

/* ---- feet ---- */

typedef struct feet_work {
    noh_feet_rig rig;
    noh_skeleton skeleton;
    noh_feet feet;
    noh_ground ground;
    noh_world world;
    noh_plane slope;
    float metre;
    noh_transform *pose; /* [joint_count] */
} feet_work;

/* 0: the pack has no legs, or there is no memory. */
static int open_feet(feet_work *w, const noh_pack *pack)
{
    noh_ragdoll_source source;
    const noh_skeleton_header *header;
    memset(w, 0, sizeof *w);
    memset(&source, 0, sizeof source);
    source.pack = pack;
    if (noh_pack_skeleton_at(pack, 0, &source.joints, &header, NULL) != NOH_OK) return 0;
    source.metres = (float)header->unit_cm / 100.0f;
    if (noh_feet_rig_make(&source, &w->rig, NULL) != NOH_OK) return 0;
    w->skeleton = source.joints;
    w->metre = 1.0f / source.metres;
    w->slope.normal[1] = 0.98f;
    w->slope.normal[2] = 0.19899749f;
    w->world.planes = &w->slope;
    w->world.plane_count = 1;
    w->ground.world = &w->world;
    w->pose = malloc(w->skeleton.joint_count * sizeof *w->pose);
    noh_feet_init(&w->feet);
    return w->pose != NULL;
}

static void stand(void *self, uint32_t frame)
{
    feet_work *w = self;
    const noh_feet_place place = {
        { 0.0f, 0.0f, 0.01f * w->metre * (float)(frame % 100u) }, { 0.0f, 0.0f, 0.0f, 1.0f }, 1.0f, 0
    };
    memcpy(w->pose, w->skeleton.bind_pose, w->skeleton.joint_count * sizeof *w->pose);
    noh_feet_step(&w->feet, &w->rig, &w->skeleton, w->pose, &place, &w->ground, 1.0f / 60.0f, 0);
}

/* ---- retargeting ---- */

typedef struct retarget_work {
    noh_ragdoll_source source;
    noh_retarget map;
    noh_retarget_joint *joints;
    noh_transform *pose;
    float *model;
} retarget_work;

/* 0: the pack has no person, or there is no memory. */
static int open_retarget(retarget_work *w, const noh_pack *pack)
{
    noh_retarget_rig rig;
    memset(w, 0, sizeof *w);
    w->source.pack = pack;
    if (noh_pack_skeleton_at(pack, 0, &w->source.joints, NULL, NULL) || noh_retarget_rig_make(&w->source, &rig, NULL)) {
        return 0;
    }
    w->joints = malloc(w->source.joints.joint_count * sizeof *w->joints);
    w->pose = malloc(w->source.joints.joint_count * sizeof *w->pose);
    w->model = malloc(w->source.joints.joint_count * 12u * sizeof *w->model);
    return w->joints && w->pose && w->model && !noh_retarget_init(&w->map, &rig, &rig, 0, w->joints, NULL);
}

static void retarget(retarget_work *w, uint32_t flags)
{
    w->map.flags = flags;
    for (uint32_t i = 0; i < RETARGETS; i++) {
        noh_retarget_pose(&w->map, w->source.joints.bind_pose, NULL, w->source.joints.joint_count, w->pose);
    }
}

static void retarget_joints(void *self, uint32_t frame)
{
    (void)frame;
    retarget(self, 0);
}

static void retarget_limbs(void *self, uint32_t frame)
{
    (void)frame;
    retarget(self, NOH_RETARGET_FEET | NOH_RETARGET_HANDS);
}

static void model_matrices(void *self, uint32_t frame)
{
    const retarget_work *w = self;
    (void)frame;
    for (uint32_t i = 0; i < RETARGETS; i++) {
        noh_local_to_model(&w->source.joints, w->source.joints.bind_pose, w->source.joints.joint_count, w->model);
    }
}

static int bench_retarget(bench_job *job)
{
    retarget_work work;
    bench_cells cells;
    int status = 0;
    memset(&cells, 0, sizeof cells);
    if (open_retarget(&work, &job->files[0].pack)) {
        const double joints = work.source.joints.joint_count;
        bench_add_cell(&cells, model_matrices, &work);
        bench_add_cell(&cells, retarget_joints, &work);
        bench_add_cell(&cells, retarget_limbs, &work);
        status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "sim/retarget");
        if (!status) {
            const double model = bench_median(&cells, 0) / RETARGETS, ours = bench_median(&cells, 1) / RETARGETS;
            bench_add_row(&job->rows, "sim/retarget", "model-matrices", model / joints, ours / joints, "ns/joint",
                          cells.rounds);
            bench_add_row(&job->rows, "sim/retarget_limbs", "model-matrices", model,
                          bench_median(&cells, 2) / RETARGETS - ours, "ns/legs and arms", cells.rounds);
        }
    }
    bench_free_cells(&cells);
    free(work.joints);
    free(work.pose);
    free(work.model);
    return status;
}

int bench_ik(bench_job *job)
{
    feet_work work;
    bench_cells cells;
    const int has_feet = open_feet(&work, &job->files[0].pack);
    int status;
    memset(&cells, 0, sizeof cells);
    bench_add_cell(&cells, solve_as_the_book, NULL);
    bench_add_cell(&cells, bench_two_bone, NULL);
    if (has_feet) bench_add_cell(&cells, stand, &work);
    status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "sim/two-bone");
    if (!status) {
        const double ours = bench_median(&cells, 1) / SOLVES;
        bench_add_row(&job->rows, "sim/two-bone", "arc-cosines", bench_median(&cells, 0) / SOLVES, ours, "ns/limb",
                      cells.rounds);
        if (has_feet)
            bench_add_row(&job->rows, "sim/feet", "two-bone", ours, bench_median(&cells, 2) / work.rig.leg_count,
                          "ns/foot and step", cells.rounds);
    }
    bench_free_cells(&cells);
    free(work.pose);
    return status ? status : bench_retarget(job);
}
