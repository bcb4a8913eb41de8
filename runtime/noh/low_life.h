/* low_life.h: ragdolls, springs, hair, feet and rays one by one: for engines built of parts (noh_low.h). */

#ifndef NOH_LOW_LIFE_H
#define NOH_LOW_LIFE_H

#include <stddef.h>
#include <stdint.h>

#include "base.h"
#include "pack.h"
#include "clip.h"
#include "body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== boxes, rays and capsules ========
 * Points in boxes, boxes that overlap, and a ray against a capsule.
 *
 *   noh_aabb_contains                  axis-aligned boxes
 *   noh_obb_contains, noh_obb_overlap  oriented boxes
 *   noh_ray_capsule                    a ray against a capsule
 *
 * Touching counts as overlapping. Boxes may be flat.
 * source   Ericson: Real-Time Collision Detection, 2005, sections 4.4.1 (separating axes), 5.1.9 (segments), 5.3.3
 *          (slabs); Granberg, Character Animation with Direct3D, 2009, chapter 6, with its degenerate cases added
 * Threads: no state; any thread. */

typedef struct noh_aabb {
    float min[3], max[3];
} noh_aabb;

int noh_aabb_contains(const noh_aabb *box, const float point[3]);
int noh_obb_contains(const noh_obb *box, const float point[3]);

/* Test whether two oriented boxes overlap, on 15 axes: the sides of each, and the products of edges, with a margin of
 * 1e-6 of the sides where edges are parallel and their product vanishes. Boxes closer than that margin may count as
 * overlapping. */
int noh_obb_overlap(const noh_obb *a, const noh_obb *b);

/* Intersect a ray with a capsule; a ball if `from` and `to` are equal. */
float noh_ray_capsule(const noh_ray *ray, const float from[3], const float to[3], float radius);

/* ======== ragdolls ========
 * Ragdolls: a set of dolls with one rig.
 *
 *   noh_ragdolls_size, noh_ragdolls_init   a set, asleep at the rig's rest
 *   noh_ragdoll_place                      put a doll in a pose, with velocities
 *   noh_ragdoll_follow                     drive it by animation: held bodies, joints with strength
 *   noh_ragdoll_push                       an impulse at a point
 *   noh_ragdolls_step                      advance time
 *   noh_ragdoll_bodies                     transforms of the bodies
 *
 * Bodies are capsules along their z axis. A rig (noh_ragdoll_rig_make makes one) defines how they are joined.
 * Angles and limits count from the rig's rest, so a doll placed at rest has nothing to correct.
 *
 * Extended position based dynamics in small steps. Dolls have the same bodies and joints, so each SIMD lane computes
 * one doll: no gathering, and the bits depend neither on the number of dolls nor on the processor. A set is one block
 * without pointers: a copy continues identically.
 * Far from the origin: each doll is simulated about its own origin, which moves with it, with the world relative to it,
 * so it falls at 100 km as at 0. Inputs and outputs are floats in the caller's space, with a resolution of 8 mm at 100
 * km and of 1 mm at 16 km.
 *
 * Overlaps: a body that begins a step inside the world or another body of the doll is moved out at NOH_PUSH_OUT_SPEED
 * and keeps none of that velocity. Out of obstacles that contain the axes of bodies, it leaves on the side of the first
 * body. Joints placed past their limits turn back at 2 rad/s.
 *
 * source   Mueller, Macklin, Chentanez, Jeschke, Kim: Detailed Rigid Body Simulation with Extended Position Based
 *          Dynamics, 2020; Macklin et al.: Small Steps in Physics Simulation, 2019
 * Threads: a set belongs to one thread at a time. */

#define NOH_RAGDOLL_HINGE 1u  /* rotates about z of its frame only: twist is the angle, there is no swing */
#define NOH_RAGDOLL_SLIDES 2u /* slides within linear_min..linear_max; else the anchors coincide */
#define NOH_RAGDOLL_LOOSE 4u  /* no limits of swing and twist: a ball joint */

#define NOH_RAGDOLL_STEP_TICKS 800u /* 1/60 s, each divided into desc.substeps */

/* ---- sets ---- */

typedef struct noh_ragdolls_desc {
    const noh_ragdoll_rig *rig; /* copied */
    uint32_t count;             /* dolls, 1..NOH_RAGDOLLS_MAX */
    uint32_t substeps;          /* 5..NOH_RAGDOLL_SUBSTEPS_MAX per 1/60 s; default (0) 10 */
    uint32_t asks;              /* 1: its worlds may have `physics`: 20,480 bytes more. 0: `physics` is not asked */
} noh_ragdolls_desc;

typedef struct noh_ragdolls noh_ragdolls;

typedef struct noh_ragdoll_pose {
    float position[3], rotation[4];
} noh_ragdoll_pose;

typedef struct noh_ragdoll_motion {
    float velocity[3], spin[3]; /* metres and radians per second */
} noh_ragdoll_motion;

/* Exact size of a set in bytes: about 1.8 KB per doll and 30 KB shared. 0 if the desc is invalid. */
size_t noh_ragdolls_size(const noh_ragdolls_desc *desc);

/* Make a set.
 * errors  ARG memory NULL or misaligned, or a number of the rig out of its range (where: the body); LIMIT too many
 *         dolls, bodies, pairs or substeps; MEMORY too small */
noh_result noh_ragdolls_init(void *memory, size_t bytes, const noh_ragdolls_desc *desc, noh_ragdolls **set,
                             noh_error *error);

/* Put a doll in a pose and wake it.
 * shapes  bodies[body_count], as from noh_ragdoll_bodies; motions[body_count], or NULL: at rest
 * errors  ARG a number is not finite (where: the body); the doll is then unchanged */
noh_result noh_ragdoll_place(noh_ragdolls *set, uint32_t doll, const noh_ragdoll_pose *bodies,
                             const noh_ragdoll_motion *motions, noh_error *error);

/* Drive a doll by animation, until the next call. The velocities of held bodies follow from their present and goal
 * transforms.
 * goals   [body_count] goal transforms at the end of the next step of 1/60 s; NULL: not driven
 * held    bit i: body i moves to its goal, through any obstacle
 * hertz   [body_count] how fast the joint of body i to its parent turns to the goals' angle, critically damped: 0 limp,
 *         20 tracks; NULL: 0
 * errors  ARG a goal is not finite, or hertz is not in 0..NOH_NUMBER_MAX; nothing changes */
noh_result noh_ragdoll_follow(noh_ragdolls *set, uint32_t doll, const noh_ragdoll_pose *goals, uint32_t held,
                              const float *hertz, noh_error *error);

/* Apply an impulse at a point, and wake the doll. The nearest body takes it alone until its speed has changed by 4.6
 * doll sizes per second (noh_ragdolls_desc), 8 m/s for 1.75 m; the rest is spread over all free bodies by mass, as if
 * the doll were rigid, so four times the impulse throws it four times as fast. Spin is limited: no body gets more than
 * twice the mean speed, or more than the limit below.
 * units   impulse in newton seconds; the point in the space of the bodies
 * ranges  no body moves faster than 23 sizes per second, 40 m/s for 1.75 m: excess, beyond 2,800 Ns on 70 kg at rest,
 *         is lost. Does nothing if a number is not finite or beyond NOH_NUMBER_MAX */
void noh_ragdoll_push(noh_ragdolls *set, uint32_t doll, const float point[3], const float impulse[3]);

/* Advance time for all dolls that are awake, in pieces of any length. A doll whose bodies all moved by less than a 50th
 * of its size in half a second falls asleep, and rests until it is pushed, placed or driven.
 * world    NULL: no obstacles
 * returns  ticks dropped in this call */
uint32_t noh_ragdolls_step(noh_ragdolls *set, const noh_world *world, uint32_t ticks);

/* Get the transforms of a doll's bodies.
 * shapes  bodies[body_count] */
void noh_ragdoll_bodies(const noh_ragdolls *set, uint32_t doll, noh_ragdoll_pose *bodies);

int noh_ragdoll_sleeps(const noh_ragdolls *set, uint32_t doll);

/* ======== ragdolls out of a character ========
 * Makes a ragdoll from a character: skeleton, joint names and skin.
 *
 *   noh_ragdoll_find_rows   find the joints that begin a body, and their limits, by name
 *   noh_ragdoll_rig_make    make bodies and joints from such rows
 *
 * No dimensions are set by hand: capsules lie along bones and are as thick as the skin around them; masses follow from
 * their volumes and the height. Angles count from the bind pose.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 7, whose boxes are sized by hand
 * Threads: no state; any thread. */

/* Direction of a bone as it bends. */
typedef enum noh_ragdoll_toward {
    NOH_RAGDOLL_FORWARD = 0,
    NOH_RAGDOLL_BACKWARD,
    NOH_RAGDOLL_UPWARD
} noh_ragdoll_toward;

/* A body: it begins at a joint and includes all joints below it that have no row of their own. */
typedef struct noh_ragdoll_row {
    uint32_t joint;
    uint32_t hinge;  /* 1: it only bends, and its angles count from the straight limb, not from the bind pose */
    uint32_t toward; /* noh_ragdoll_toward */
    float bend_min, bend_max; /* radians, -pi..0 and 0..pi */
    float side;               /* to either side, 0..pi */
    float twist;              /* in either direction, 0..pi */
    float friction;           /* N m for a body of 70 kg, 0.. */
} noh_ragdoll_row;

/* Inputs of a rig. */
typedef struct noh_ragdoll_source {
    const noh_pack *pack; /* joint names and skinned meshes of the skeleton */
    uint32_t skeleton;
    noh_skeleton joints; /* noh_pack_skeleton_at */
    float metres;        /* metres per unit of the skeleton: noh_skeleton_header.unit_cm / 100 */
    float mass;          /* kilograms; default (0) 70 for a height of 1.75 m, scaled by its cube */
} noh_ragdoll_source;

/* Find pelvis, spine, chest, head, upper arms, forearms, hands, thighs, shins and feet by joint names such as
 * 'LeftUpLeg', 'thigh.L', 'L_UpperArm', or 'L_Hip' above a knee, 'L_Shoulder' above an elbow. The pelvis is where the
 * thighs meet, the chest where the upper arms meet. Limits are human. If the pack has its own table (noh build
 * --ragdoll), its rows are used for a skeleton with its joints.
 * shapes  rows[NOH_RAGDOLL_BODIES_MAX]; *count of them, by increasing joint
 * source  limits after clinical ranges of motion, rounded
 * errors  NOT_FOUND there are no two thighs: make rows by hand */
noh_result noh_ragdoll_find_rows(const noh_ragdoll_source *source, noh_ragdoll_row *rows, uint32_t *count,
                                 noh_error *error);

/* Make the rig, in metres, at rest in the bind pose, with stabilised masses.
 * errors  ARG rows are not one tree: the first is not above all others, a joint does not exist or is out of order, or a
 *         number is out of its range (where: the row); LIMIT more than NOH_RAGDOLL_BODIES_MAX */
noh_result noh_ragdoll_rig_make(const noh_ragdoll_source *source, const noh_ragdoll_row *rows, uint32_t count,
                                noh_ragdoll_rig *rig, noh_error *error);

/* ======== feet ========
 * Foot placement on the ground: stairs, slopes, rough terrain.
 *
 *   noh_ground_below        the ground below a point: from a world, or a function of the game
 *   noh_feet_rig_make       legs and soles of any skeleton, by joint names and skin
 *
 * Clips are made on a flat floor: the model's plane y = 0 at its place. A foot keeps its clip's height above that floor
 * as its height above the ground, and leans with the ground where that is flat enough to stand on. A foot is planted
 * while its clip holds it still on the floor: the lowest part of its sole (heel, ball or toes) is then locked in place
 * until the clip lifts it or moves it away. The pelvis follows the foot that is lowest or is about to be, with an
 * acceleration of at most 20 leg lengths per second squared, and immediately if a planted leg would be too short.
 *
 * Soles do not enter the ground where the legs reach. Heights are stored in world space, so a place that jumps from
 * step to step moves the body smoothly. Without ground within reach below a sole, that foot keeps its clip.
 * source   ozz-animation, sample_foot_ik (rays, the pelvis by the foot that needs most, the ankle by the normal)
 * Threads: no state; any thread, if the ground's function allows it. */

/* ---- the ground ---- */

/* Find the ground straight below a point. Obstacles that contain the point are ignored.
 * shapes   normal[3] unit
 * returns  the distance, at most depth; below 0: no ground */
float noh_ground_below(const noh_ground *ground, const float from[3], float depth, float normal[3]);

/* ---- legs ---- */

/* Find thigh, shin and foot by the names that noh_ragdoll_find_rows knows; a sole is the lowest skin of a foot.
 * source   as for a ragdoll; metres and mass are unused
 * errors   NOT_FOUND no thighs, or no thigh with a shin and a skinned foot */
noh_result noh_feet_rig_make(const noh_ragdoll_source *source, noh_feet_rig *rig, noh_error *error);

#define NOH_HAIR_STEP_TICKS 800u /* 1/60 s */

/* ======== hair of a pack ========
 * The hair in a pack: control hairs, and the strips drawn between them.
 *
 *   noh_haircut_open     the haircut of a pack
 *
 * A strip lies in a patch of four control hairs, at some point between their curves. Its place, length and curl follow
 * from its number alone: the GPU receives the control hairs, and no data per strip.
 *
 * Threads: constant data; any thread.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 15: patches of four control hairs; Nguyen,
 *          Donnelly: Hair Animation and Rendering in the Nalu Demo, GPU Gems 2, 2005, chapter 23 */

/* Get the haircut of a pack. The pack must outlive it.
 * errors  NOT_FOUND the pack has none */
noh_result noh_haircut_open(const noh_pack *pack, noh_haircut *out, noh_error *error);

/* ======== correctives ========
 * Correctives and in-betweens: targets whose weights follow from other targets.
 *
 *   noh_correctives_bind   get the correctives of a mesh from its pack
 *   noh_correctives_apply  compute their weights
 *
 * An open mouth that smiles is more than an open mouth plus a smile: a corrective is a target that is added while both
 * show. Its weight is the product of one factor per driver (a target that drives it). The factor is 0 at a driver
 * weight of 0 and 1 at the driver weight at which the corrective was modelled, its peak. With a peak of 1 the factor is
 * the driver's weight. A peak below 1 makes an in-between: the factor falls to 0 again at the next peak of correctives
 * with the same drivers, or at 1, and rises from the previous peak. So a corrective has weight 1 where all drivers are
 * at their peaks, 0 where any driver is at 0 or at another peak, and is continuous.
 *
 * Deltas of correctives are what is missing from the sum of all other targets, as modelling tools export them. Drivers
 * come from a recipe (`corrective TARGET DRIVER [PEAK] ...`, `noh build --recipe`, or glTF extras), or from names: with
 * targets jawOpen, smile and jawOpen_smile, the last is a corrective of the others, and jawOpen50 is an in-between. A
 * stage applies correctives after clips, faces and held floats.
 *
 * source   Lewis and others, "Practice and Theory of Blendshape Facial Models", Eurographics 2014, section 4.2 and 4.3
 * Threads  no state; any thread */

/* One driver of one corrective. The terms of a corrective are consecutive. */
typedef struct noh_corrective_term {
    uint16_t target, driver;
    float from, peak, to; /* driver weights: 0 up to `from`, 1 at the peak, 0 from `to` on; to = peak: stays 1 */
} noh_corrective_term;

/* Get the terms of a mesh's correctives. Skips correctives for which the mesh lacks a target.
 * shapes   terms[term_max]
 * returns  the number of terms; terms past term_max are not written */
uint32_t noh_correctives_bind(const noh_mesh *mesh, noh_corrective_term *terms, uint32_t term_max);

/* Set the weights of correctives from the weights of their drivers, which are clamped to 0..1.
 * shapes  weights[as many as the terms refer to] */
void noh_correctives_apply(const noh_corrective_term *terms, uint32_t term_count, float *weights);

/* ======== rules for weights ========
 * Limits that the author of a face sets on its morph targets: ranges and mutual exclusion.
 *
 *   noh_weight_rules_bind   get the rules of a mesh from its pack
 *   noh_weight_rules_apply  apply them to weights
 *
 * By default a weight is any finite number and nothing is clamped. But a mouth that smiles at 0.8 and frowns at 0.6
 * shows neither, and an eye that closes by 1.4 turns its lid inside out. So the recipe of a pack (`noh build --recipe`,
 * or glTF extras) may contain:
 *
 *   range TARGET MIN MAX     clamp the target to MIN, at most 0, to MAX, at least 0
 *   oppose TARGET TARGET     two targets that exclude each other: subtract the smaller weight from both, so that at
 *                            most one remains, and a fade from one to the other is continuous
 *   share TARGET TARGET ...  the sum of a group is at most 1: above that, all are scaled down
 *   expression NAME TARGET [WEIGHT]
 *                            add WEIGHT times the weight of the target NAME, which is clamped to 0..1, and clamp the
 *                            sum to 0..1, or to WEIGHT if that is more. NAME may have no deltas of its own: VRM's
 *                            expressions are such targets
 *   binary NAME              the weight of NAME becomes 1 if it is above 0.5, else 0
 *
 * Expressions are applied first, then ranges, opposites and groups. The last two ignore negative weights. A stage
 * always applies expressions, and the other rules for kinds that request it (noh_kind_desc.weight_rules), whatever the
 * source of the weights. Correctives follow from other targets and have no rules.
 *
 * source   Lewis and others, "Practice and Theory of Blendshape Facial Models", Eurographics 2014, section 3.1
 *          (limits); combining opposites by their difference is the two-ended slider of facial rigs
 * Threads  no state; any thread */

typedef enum noh_weight_rule_kind {
    NOH_WEIGHT_RANGE = 0,
    NOH_WEIGHT_OPPOSE,
    NOH_WEIGHT_SHARE,
    NOH_WEIGHT_BINARY,
    NOH_WEIGHT_ADD
} noh_weight_rule_kind;

typedef struct noh_weight_rule {
    uint16_t kind;   /* noh_weight_rule_kind */
    uint16_t target; /* the rules of a group's targets are consecutive */
    uint16_t other;  /* OPPOSE: the other target; SHARE: the group's first target in the mesh; ADD: the expression's
                      * target; else 0 */
    uint16_t reserved;
    float low, high; /* RANGE: low at most 0, high at least 0; ADD: low 0, high the weight to add; else 0 */
} noh_weight_rule;

/* Get the rules for targets of the mesh, in the order in which they are applied. A group contains
 * only its targets in the mesh.
 * shapes   rules[rule_max]
 * returns  the number of rules; rules past rule_max are not written */
uint32_t noh_weight_rules_bind(const noh_mesh *mesh, noh_weight_rule *rules, uint32_t rule_max);

/* Apply the rules to weights. Weights that break no rule keep their bits. NaN of a target with a range becomes its
 * lowest weight.
 * shapes  weights[as many as the rules refer to] */
void noh_weight_rules_apply(const noh_weight_rule *rules, uint32_t rule_count, float *weights);

/* ======== fixed steps ========
 * Point masses: fixed time steps, two integrators, and distance constraints.
 *
 *   noh_steps_take       number of fixed steps in a frame's time
 *   noh_point_move       semi-implicit Euler: first velocity, then position
 *   noh_verlet_move      from the last two positions, steps of any length
 *   noh_distance_keep    a rod or a spring between two points
 *
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 6, corrected: its Euler gains energy, its Verlet
 *          lacks a square, its spring has neither stiffness nor mass; Hairer, Lubich, Wanner: Geometric Numerical
 *          Integration, 2006, section I.1; Macklin, Mueller, Chentanez: XPBD, 2016
 * Threads: no state; any thread. */

/* ---- time ---- */

/* Convert elapsed time to steps of step_ticks; the remainder is kept for the next call. More than `limit` steps in a
 * call are dropped and counted: the simulation then runs slow, but the next frame does not get slower still.
 * ranges   step_ticks and limit above 0
 * returns  steps to make now, 0..limit */
uint32_t noh_steps_take(noh_steps *steps, uint32_t ticks, uint32_t step_ticks, uint32_t limit);

/* ---- points ---- */

/* Advance a point by semi-implicit Euler, which keeps energy bounded; updating the position first lets it grow.
 * shapes  position[3], velocity[3] in and out; acceleration[3] */
void noh_point_move(float position[3], float velocity[3], const float acceleration[3], float seconds);

/* Advance a point by Verlet: x + (x - before) keep h / h' + a h (h + h') / 2, h' the previous step. Afterwards `before`
 * is the old x.
 * ranges  seconds and seconds_before above 0; keep 0..1 is the share of its velocity that a point keeps per step */
void noh_verlet_move(float position[3], float before[3], const float acceleration[3], float seconds,
                     float seconds_before, float keep);

/* Move two points towards a distance, in proportion to their inverse masses. Points closer than 1e-6 have no direction
 * and stay, as do two points without inverse mass.
 * ranges    inverse_mass 0 (pinned).., compliance in metres per newton: 0 a rod, else 1 / stiffness
 * lambda    of this constraint, 0 at the start of a step; NULL for a single iteration
 * returns   the error in distance before the move */
float noh_distance_keep(float a[3], float inverse_mass_a, float b[3], float inverse_mass_b, float distance,
                        float compliance, float seconds, float *lambda);

/* ======== between bodies and a pose ========
 * Converts between poses of a skeleton and bodies of a ragdoll, to fall and to get up.
 *
 *   noh_ragdoll_fit_make     how the bodies of a rig lie on the joints of its skeleton
 *   noh_ragdoll_from_pose    bodies from a pose: to place a doll, and goals to drive it
 *   noh_ragdoll_to_pose      a pose from bodies
 *
 * To fall: place the bodies from the last visible pose, with velocities from the pose before it; then each step's
 * bodies make the pose. To get up: choose the clip whose first pose lies most like the doll, place the character under
 * the doll, and let the remaining difference of the two poses decay.
 *
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 7, "Updating the Character Mesh", which sets
 *          bones to their bodies: they then stretch as far as joints are apart
 * Threads: no state; any thread. */

/* How bodies lie on joints: the same for all poses. */
typedef struct noh_ragdoll_fit {
    uint32_t body_count;
    uint32_t joints[NOH_RAGDOLL_BODIES_MAX];         /* the joint where each body begins */
    noh_ragdoll_pose bodies[NOH_RAGDOLL_BODIES_MAX]; /* in the space of the joint, metres */
    float metres;                                    /* of one unit of the skeleton */
} noh_ragdoll_fit;

/* Transform from model space to the space of bodies: position + rotation * (metres * point). */
typedef struct noh_ragdoll_frame {
    float position[3], rotation[4]; /* rotation: unit */
    float metres;                   /* the fit's, times the size of the figure; above 0 */
} noh_ragdoll_frame;

/* Make a fit.
 * rig  from noh_ragdoll_rig_make, with this skeleton and unit */
void noh_ragdoll_fit_make(const noh_ragdoll_rig *rig, const noh_skeleton *skeleton, float metres, noh_ragdoll_fit *fit);

/* Compute the bodies from a pose.
 * shapes  local[skeleton->joint_count]; bodies[fit->body_count] */
void noh_ragdoll_from_pose(const noh_ragdoll_fit *fit, const noh_skeleton *skeleton, const noh_transform *local,
                           const noh_ragdoll_frame *frame, noh_ragdoll_pose *bodies);

/* Turn joints so that bodies have the given orientations, and move the joint of the first body to it. Bones keep their
 * lengths; joints without a body keep their pose.
 * shapes  bodies, weights: [fit->body_count]; weights 0..1: 0 keeps the pose; NULL: all 1. local[skeleton->joint_count]
 *         read and written */
void noh_ragdoll_to_pose(const noh_ragdoll_fit *fit, const noh_skeleton *skeleton, const noh_ragdoll_frame *frame,
                         const noh_ragdoll_pose *bodies, const float *weights, noh_transform *local);

/* ======== springs ========
 * A swinging chain of joints: hair, sleeves, skirts, tails.
 *
 *   noh_spring_size, noh_spring_init   a chain at rest
 *   noh_spring_step                    advance time, for any number of chains
 *   noh_spring_rotations               local rotations of the joints
 *
 * Each joint's end is a point with inertia, pulled towards its rest direction, at a fixed distance from the joint. At
 * any frame rate it moves like the reference implementation of VRMC_springBone 1.0 at 60 Hz: the chain advances
 * in steps of 1/60 s, with carrier and colliders interpolated, and the result is interpolated between the last two
 * steps. The reference itself settles in 0.37 to 1.33 s as frame rates change from 15 to 240 Hz, because its drag is
 * per frame.
 *
 * Chains are stepped in parallel, one per SIMD lane, so several in one call take less time than one by one; the bits
 * are the same.
 *
 * A spring is one block without pointers: a copy continues identically, with the same bits on every processor.
 * source   VRM Consortium: VRMC_springBone-1.0, "Spring Bone Algorithm"; Jakobsen: Advanced Character Physics, GDC 2001
 *          (Verlet integration with fixed lengths)
 * Threads: a spring belongs to one thread at a time; a desc may be shared. */

#define NOH_SPRING_STEP_TICKS 800u /* 1/60 s */

typedef struct noh_spring_joint {
    float bone[3];    /* from the joint to the next one, or to the chain's end, in the joint's space; length above 0, up
                       * to 1e9 */
    float rest[4];    /* local rotation at rest */
    float stiffness;  /* metres per second of pull towards the rest direction, 0..; as in VRM, usually 0..4 */
    float drag;       /* share of its velocity lost per step, 0..1 */
    float radius;     /* of its end, for collisions */
    float gravity[3]; /* metres per second of pull by gravity, world */
} noh_spring_joint;

/* Data shared by springs of one kind. */
typedef struct noh_spring_desc {
    const noh_spring_joint *joints; /* [joint_count] from the first to the last */
    uint32_t joint_count;           /* 1..NOH_SPRING_JOINTS_MAX */
    uint32_t collider_count;        /* 0..NOH_SPRING_COLLIDERS_MAX */
    float restitution; /* 0..1: share of its velocity towards a collider that an end rebounds with; 0 as in VRM */
} noh_spring_desc;

/* The position of the first joint and the rotation of its carrier: world space. */
typedef struct noh_spring_carrier {
    float position[3];
    float rotation[4];
} noh_spring_carrier;

/* A capsule in world space that joint ends stay out of; a sphere if `from` and `to` are equal. */
typedef struct noh_spring_collider {
    float from[3], to[3];
    float radius;
} noh_spring_collider;

typedef struct noh_spring noh_spring;

/* A chain with the data of one call. */
typedef struct noh_spring_move {
    noh_spring *spring;
    const noh_spring_desc *desc;
    const noh_spring_carrier *carrier;    /* at the end of the call's time; interpolated in between. Out of the range
                                           * of noh_spring_init: the last one stays */
    const noh_spring_collider *colliders; /* [desc->collider_count], likewise; NULL if there are none */
    float *rotations;                     /* [desc->joint_count][4]: output of noh_spring_rotations */
    const noh_touches *touches;           /* [desc->joint_count] planes that an end stays in front of by its radius,
                                           * relative to carrier->position; NULL: none */
} noh_spring_move;

/* Floats of scratch to step chains with at most this many colliders. */
#define NOH_SPRING_SCRATCH_FLOATS(colliders) (72u * (size_t)(colliders) + 8u)

/* Exact size of a spring in bytes: 104, 28 per joint and 28 per collider, rounded up to 16. 0 if the desc is
 * invalid. */
size_t noh_spring_size(const noh_spring_desc *desc);

/* Make a chain at rest; after a teleport of its carrier, in the same memory again.
 * errors  ARG memory NULL or misaligned, a bone of length 0, or a number out of its range (where: the joint), also of
 *         the carrier; LIMIT too many joints or colliders; MEMORY too small */
noh_result noh_spring_init(void *memory, size_t bytes, const noh_spring_desc *desc, const noh_spring_carrier *carrier,
                           noh_spring **spring, noh_error *error);

/* Advance time, in pieces of any length; frames may take up to one second (NOH_SPRING_STEPS_MAX). Of a longer time only
 * the last second is simulated, from rest at the carrier's new place.
 * moves    [count], no spring twice; `rotations` is unused
 * scratch  [NOH_SPRING_SCRATCH_FLOATS] of the largest collider count; NULL if there are none; contents undefined before
 *          and after
 * returns  ticks dropped, 0 up to a second: the most of any chain */
uint32_t noh_spring_step(const noh_spring_move *moves, uint32_t count, uint32_t ticks, float *scratch);

/* Get the local rotations that replace the rest rotations in a pose. `carrier` and `colliders` are unused.
 * moves  [count], their `rotations` must not overlap */
void noh_spring_rotations(const noh_spring_move *moves, uint32_t count);

/* ======== gaze ========
 * Turns a body to look at a point: spine, neck, head and eyes together.
 *
 *   noh_gaze_rig_make   find the joints that turn, by name
 *
 * The head turns towards a target outside its cone as far as it can. Spine and neck take their shares of the turn.
 * Eyes are faster: they are on the target while the head still turns, and take a quarter of the angle themselves.
 * Animation of eye joints in clips is overwritten.
 *
 * For bodies without an animated face: faces (face.h, modules.h) have their own gaze.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 11, "Look-At Inverse Kinematics", which turns
 *          only the head
 * Threads: no state; any thread. */

/* Find spine, neck, head and eyes by joint names such as 'mixamorig:Spine1', 'neck.x', 'b_Head_05', 'LeftEye'; joints
 * of the spine have no legs below them. Ahead is where the soles of the feet point in the bind pose, in quarter turns;
 * +z without feet. Without eye joints, the eyes are at the middle of the head's skin.
 * pack     joint names, and skinned meshes of that skeleton
 * errors   NOT_FOUND no joint has a name with the word 'head', or as noh_pack_skeleton_at */
noh_result noh_gaze_rig_make(const noh_pack *pack, uint32_t skeleton, noh_gaze_rig *rig, noh_error *error);

/* The state of a gaze. A copy continues identically; zeros look ahead. */
typedef struct noh_gaze {
    noh_ik_look head, eyes;
    float point[3]; /* world: the target (modules.h); up to NOH_NUMBER_MAX */
    uint32_t looks; /* 1: at the point; likewise */
    float near;     /* 1 / distance of the target */
    uint32_t begun, unused[2];
} noh_gaze;

/* ======== reach ========
 * Hands that reach for moving points.
 *
 *   noh_reach_rig_make   find arms by joint names
 *
 * An arm is two bones (noh_ik_two_bone) that slow down before they are straight; its elbow keeps its side. A hand moves
 * to its point within 0.35 s, and back as smoothly; once there it stays on the point as it moves. The arm points at a
 * point out of reach. The hand keeps its angle to the forearm.
 * Threads: no state; any thread. */

/* Find upper arm, forearm and hand by the names that noh_ragdoll_find_rows knows.
 * errors   NOT_FOUND no upper arm has a forearm and a hand, or there are no thighs */
noh_result noh_reach_rig_make(const noh_ragdoll_source *source, noh_reach_rig *rig, noh_error *error);

typedef struct noh_reach_hand {
    float point[3]; /* world: the target (modules.h); up to NOH_NUMBER_MAX */
    float part;     /* 0..1 fraction of the time to reach, before easing */
    uint32_t wants; /* 1: it reaches, while set */
    uint32_t unused[3];
} noh_reach_hand;

/* The state of both arms. A copy continues identically; zeros reach for nothing. */
typedef struct noh_reach {
    noh_reach_hand hands[NOH_REACH_ARMS_MAX];
} noh_reach;

/* ======== retargeting ========
 * Clips of one humanoid on another: a map from a source skeleton to a target one, and poses through it.
 *
 *   noh_retarget_rig_make   find the bones of a pack's skeleton
 *   noh_retarget_init       make the map from both reference poses
 *   noh_retarget_pose       a pose of the source as a pose of the target
 *
 * A joint turns as its counterpart does, from a target's reference pose whose arms and legs point along the source's. So
 * limbs have the source's directions, whatever the two bind poses are. Hands take the source's twist by their knuckles,
 * or thumbs; half of it is given to the forearms. Soles and spine keep their angles. The hips move by the ratio of
 * legs, and each foot is put where the source's foot is by that ratio, in a stance as wide as the target's hips: feet
 * slide no more than the source's. Where a leg does not reach, the hips go down or towards the foot. Hands reach as far
 * from the shoulders as the source's, and meet where those meet. Knees and elbows keep the side of their bend.
 * source   directions of limbs as in Monzani et al., Using an intermediate skeleton and inverse kinematics for motion
 *          retargeting, 2000
 * Threads: a map is constant; any number of threads. */

/* Bones of a person, by VRM's names; bones of one side follow in the same order for left and right. */
typedef enum noh_bone {
    NOH_BONE_ROOT = 0, /* what is above the hips, such as a root on the ground */
    NOH_BONE_HIPS,
    NOH_BONE_SPINE,
    NOH_BONE_CHEST,
    NOH_BONE_UPPER_CHEST,
    NOH_BONE_NECK,
    NOH_BONE_HEAD,
    NOH_BONE_SHOULDER, /* of the left side; NOH_BONE_RIGHT later of the right */
    NOH_BONE_UPPER_ARM,
    NOH_BONE_LOWER_ARM,
    NOH_BONE_HAND,
    NOH_BONE_UPPER_LEG,
    NOH_BONE_LOWER_LEG,
    NOH_BONE_FOOT,
    NOH_BONE_TOES,
    NOH_BONE_THUMB,                      /* three: metacarpal, proximal, distal */
    NOH_BONE_INDEX = NOH_BONE_THUMB + 3, /* three each: proximal, intermediate, distal */
    NOH_BONE_MIDDLE = NOH_BONE_INDEX + 3,
    NOH_BONE_RING = NOH_BONE_MIDDLE + 3,
    NOH_BONE_LITTLE = NOH_BONE_RING + 3,
    NOH_BONE_RIGHT = NOH_BONE_LITTLE + 3 - NOH_BONE_SHOULDER,
    NOH_BONES = NOH_BONE_SHOULDER + 2 * NOH_BONE_RIGHT
} noh_bone;

typedef struct noh_retarget_rig {
    const noh_skeleton *skeleton;
    /* [joint_count] local: stands upright on flat soles, +y is up; arms anywhere. Default (NULL) the bind pose */
    const noh_transform *reference;
    uint16_t bones[NOH_BONES]; /* the joint of each, or NOH_JOINT_ROOT: none. Hips are needed */
} noh_retarget_rig;

/* Find bones by names, as the converter does, in packs with or without meshes: of Unity, Mixamo, Unreal, VRM, Daz and
 * others. Hips are above both thighs. Where names give no two thighs, the rows of noh_ragdoll_find_rows give hips,
 * spine, upper chest, head (or the neck below it), arms, legs and toes; left is then at +x.
 * errors   NOT_FOUND there are no two thighs: fill in `bones` by hand */
noh_result noh_retarget_rig_make(const noh_ragdoll_source *source, noh_retarget_rig *rig, noh_error *error);

#define NOH_RETARGET_FEET 1u  /* solve the legs */
#define NOH_RETARGET_HANDS 2u /* solve the arms */

/* Of one joint of the target: 20 bytes. */
typedef struct noh_retarget_joint {
    int16_t before[4], after[4]; /* quaternions in 1/32,767: local rotation = before * the source's * after */
    uint16_t source;             /* joint of the source, or NOH_JOINT_ROOT: keeps the reference pose */
    uint16_t above;              /* joints above `source` whose rotations come first */
} noh_retarget_joint;

/* An arm or a leg. Positions are of reference poses, in the model's space and the target's unit. */
typedef struct noh_retarget_limb {
    uint16_t source[3], target[3]; /* thigh, shin and foot, or upper arm, forearm and hand */
    uint16_t exists;
    uint16_t is_apart;         /* 1: the target's foot is not below its shin, as in rigs with feet as handles */
    float ratio;               /* target's length / source's */
    float length;              /* of the target's */
    float bend[3];             /* where the middle joint of a straight limb goes, in the space of its first joint */
    float rest[4];             /* inverse rotation of the foot */
    float height;              /* of the target's foot */
    float stance[3];           /* what is added to the scaled place of the source's foot */
    float sole[3], shorter[3]; /* from foot to toes, and by how much that is longer than the source's, scaled */
    float tip[3];              /* the foot's place in the space of the shin */
} noh_retarget_limb;

typedef struct noh_retarget {
    noh_clip_map clips; /* for noh_kind_desc.map and noh_clip_bank_desc.map: they then play clips of the source */
    const noh_transform *rest;        /* [target->joint_count] borrowed: the target's reference pose */
    const noh_retarget_joint *joints; /* [target->joint_count] borrowed */
    uint32_t flags;                   /* NOH_RETARGET_*; may be changed, but not while a bank plays the map */
    uint32_t bone_count;              /* bones that both have */
    /* how much higher than the source's reference pose its clips' ground is, in its unit; 0 unless changed. A bank
     * and a stage measure root motion and bounds when they are made: set it before that, and leave it */
    float ground;
    float facing[4];            /* turns the source's reference pose to face as the target's does */
    uint16_t moved[2][2];       /* root and hips: joint of source and target, or NOH_JOINT_ROOT */
    float from[2][3], to[2][3]; /* where they rest */
    noh_retarget_limb limbs[4]; /* left and right leg, left and right arm */
} noh_retarget;

/* Make a map. Skeletons, joints and target->reference must outlive it.
 * shapes   joints[target->skeleton->joint_count]
 * ranges   flags of NOH_RETARGET_*; a limb that either rig lacks is not solved
 * errors   NOT_FOUND  a rig lacks the hips, or both have no bone in common below them;
 *          DATA       a reference pose does not stand upright (where: 0 the source's, 1 the target's) */
noh_result noh_retarget_init(noh_retarget *retarget, const noh_retarget_rig *source, const noh_retarget_rig *target,
                             uint32_t flags, noh_retarget_joint *joints, noh_error *error);

/* Turn a pose of the source into one of the target. Other joints than the bones keep the reference pose.
 * shapes   from[source->joint_count], to[joint_count]; local
 * feet     [2] added to the places of the left and the right foot, in the target's unit and space; NULL: nothing
 * ranges   joint_count at most the target's: a LOD level uses the first joints only */
void noh_retarget_pose(const noh_retarget *retarget, const noh_transform *from, const float (*feet)[3],
                       uint32_t joint_count, noh_transform *to);

#ifdef __cplusplus
}
#endif

#endif
