/* body.h: what bodies stand on, bump into and reach for: the ground and its obstacles, rigid bodies, inverse
 * kinematics. Bodies of actors: modules.h. */

#ifndef NOH_BODY_H
#define NOH_BODY_H

#include <stddef.h>
#include <stdint.h>

#include "base.h"
#include "format.h"
#include "pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== boxes, rays and capsules ======== */

typedef struct noh_obb {
    float centre[3], half[3]; /* half: half the sides, 0.. */
    float rotation[4];
} noh_obb;

typedef struct noh_ray {
    float from[3], direction[3]; /* of any length but 0: distances are in multiples of it */
    float distance_max;          /* 0.. */
} noh_ray;

/* ======== what bodies collide with ========
 * Static obstacles for bodies: planes, capsules, boxes and a height field.
 *
 *   noh_world_check       check a world
 *   noh_field_height      height and normal of a height field at a place
 *   noh_triangles_size    triangles as the physics of a world; noh_triangles_init
 *
 * It may also hold the game's own physics: functions that answer rays and touches. Ragdolls, rigid bodies,
 * points, springs, feet, steps, walkers and shadows ask it wherever they look at the shapes here.
 *
 * The caller owns the world's arrays and keeps them while it is used. Up is +Y.
 * Threads: read-only; any number of threads, except for `physics`. */

#define NOH_PUSH_OUT_SPEED 1.0f /* metres per second at which overlaps separate */

/* Solid below: points with normal . x < distance are inside. */
typedef struct noh_plane {
    float normal[3]; /* unit */
    float distance;
} noh_plane;

/* A sphere if `from` and `to` are equal. */
typedef struct noh_capsule {
    float from[3], to[3];
    float radius;
} noh_capsule;

/* A grid of heights with bilinear interpolation: solid below, nothing outside. */
typedef struct noh_field {
    const uint16_t *heights; /* [depth][width], rows along +X, consecutive rows along +Z */
    uint32_t width, depth;   /* 2..65536 */
    float origin[3];         /* of heights[0][0] at height 0 */
    float spacing;           /* between heights */
    float scale;             /* y per unit of height */
} noh_field;

/* ---- a game's physics ---- */

typedef struct noh_world_ray {
    float origin[3]; /* a point nearby: ray.from is relative to it, so that floats keep their digits far away */
    noh_ray ray;
} noh_world_ray;

typedef struct noh_world_hit {
    float distance;  /* in lengths of the ray's direction; below 0: no hit. Obstacles that contain the start: none */
    float normal[3]; /* unit, out of the obstacle */
} noh_world_hit;

/* A body that asks what it touches now, and until the next question. */
typedef struct noh_world_body {
    float origin[3];     /* the capsule is relative to it */
    noh_capsule capsule; /* a ball if its ends are equal */
    float reach;         /* metres from its surface to the farthest surface that matters, 0.. */
} noh_world_body;

/* The nearest point of an obstacle, as the plane through it: a point `along` the capsule's axis stays in front of it,
 * by the radius, until the next question. */
typedef struct noh_touch {
    noh_plane plane; /* relative to the body's origin; the normal leads out of the obstacle */
    float along;     /* 0: the middle, -1: `from`, 1: `to` */
} noh_touch;

typedef struct noh_touches {
    uint32_t count;
    noh_touch at[NOH_TOUCHES_MAX]; /* nearest first */
} noh_touches;

/* Functions of the game. Ragdolls ask once for each 1/60 s and doll, rigid bodies once for each 1/600 s, feet once for
 * each sole, springs once in each frame for up to eight chains of an actor, earlier if one is attached to another: in
 * batches, always in the same order. The same question must get the same answer while a step or a frame runs: then
 * results are equal for any number of jobs.
 * An answer with a number that is not finite, or a normal that is not unit, counts as none; `along` is clamped.
 * Threads: unless `threads` is set, noh never asks from two threads at once: a stage with several jobs refuses feet and
 * springs on it, which jobs would ask at once. Two stages that run at once must not share such a physics. */
typedef struct noh_world_physics {
    void (*rays)(void *user, const noh_world_ray *rays, uint32_t count, noh_world_hit *hits);
    void (*touches)(void *user, const noh_world_body *bodies, uint32_t count, noh_touches *touches);
    void *user;
    uint32_t threads; /* 1: any number of threads may call at once */
} noh_world_physics;

/* ---- triangles ---- */

/* Static triangles, as the physics of a world. Their fronts are solid (seen from there, corners go counterclockwise); a
 * body that is behind the nearest one is led out of it. Rigid bodies meet them with their corners and round ends. */
typedef struct noh_triangles_desc {
    const float *positions; /* [position_count][3] metres; both arrays are used in place, and outlive the physics */
    uint32_t position_count;
    const uint32_t *indices; /* [triangle_count][3] */
    uint32_t triangle_count; /* 1..NOH_TRIANGLES_MAX */
} noh_triangles_desc;

/* Exact size of what noh_triangles_init makes: 20 to 36 bytes a triangle. 0 if the count is out of its range. */
size_t noh_triangles_size(uint32_t triangle_count);

/* Make a tree of boxes over triangles, which answers rays and touches from any thread. It has no state.
 * errors  ARG an index is past the positions, or a corner is not finite (where: the triangle), or memory NULL or
 *         misaligned; LIMIT the count; MEMORY too small */
noh_result noh_triangles_init(void *memory, size_t bytes, const noh_triangles_desc *desc, noh_world_physics *physics,
                              noh_error *error);

typedef struct noh_world {
    const noh_plane *planes;
    const noh_capsule *capsules;
    const noh_obb *boxes;
    uint32_t plane_count, capsule_count, box_count; /* each 0..NOH_OBSTACLES_MAX */
    const noh_field *field;                         /* NULL: none */
    float friction;                                 /* 0.., of everything */
    float restitution; /* 0..1: share of its velocity towards an obstacle that a body rebounds with; 0: no bounce */
    const noh_world_physics *physics; /* NULL: none */
} noh_world;

/* Check a world.
 * errors  ARG a normal or rotation is not unit, a number is out of its range, a field has no area, a function of the
 *         physics is NULL (where: the index); LIMIT more than NOH_OBSTACLES_MAX of one kind */
noh_result noh_world_check(const noh_world *world, noh_error *error);

/* Get the height and normal of a field at a place.
 * shapes   normal[3] unit, or NULL
 * returns  0 outside the grid; nothing is written then */
int noh_field_height(const noh_field *field, float x, float z, float *height, float normal[3]);

/* ======== ragdolls ======== */

/* ---- rigs ---- */

/* A capsule: z is its axis, its centre the centre of mass. */
typedef struct noh_ragdoll_body {
    uint32_t parent;                     /* a lower index; NOH_NONE for the first body only */
    uint32_t joint;                      /* the joint of a skeleton that it moves; unused here */
    float half;                          /* half the axis between the centres of its round ends, metres, 0.. */
    float radius;                        /* above 0 */
    float mass;                          /* above 0, kilograms */
    float inertia_across, inertia_along; /* about its centre: perpendicular to z, and about z; kg m^2, above 0 */
    float position[3], rotation[4];      /* at rest */
} noh_ragdoll_body;

/* The joint between a body and its parent. One record for ball joint, hinge, swing-twist cone and six degrees of
 * freedom. Angles count from rest. */
typedef struct noh_ragdoll_joint {
    uint32_t flags;
    float anchor[3];                    /* at rest, in the space of the bodies' positions */
    float frame[4];                     /* at rest: z along the child's bone or the hinge, x and y the two swing axes */
    float swing_min[2], swing_max[2];   /* radians about x and y: an ellipse about their middle; -pi..0, 0..pi */
    float twist_min, twist_max;         /* radians, -pi..0 and 0..pi */
    float linear_min[3], linear_max[3]; /* metres along the frame's axes, with SLIDES; 0 and 0: locked */
    float friction;                     /* N m, 0.. */
} noh_ragdoll_joint;

typedef struct noh_ragdoll_rig {
    uint32_t body_count; /* 1..NOH_RAGDOLL_BODIES_MAX */
    uint32_t pair_count; /* 0..NOH_RAGDOLL_PAIRS_MAX */
    noh_ragdoll_body bodies[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_joint joints[NOH_RAGDOLL_BODIES_MAX]; /* [i] joins bodies[i] to its parent; [0] is unused */
    uint8_t pairs[NOH_RAGDOLL_PAIRS_MAX][2];          /* pairs of bodies that collide with each other */
} noh_ragdoll_rig;

/* ======== feet ======== */

#define NOH_FEET_POINTS 6u /* per sole: heel, ball and toes, inner and outer side of each */

/* ---- the ground ---- */

typedef struct noh_ground {
    const noh_world *world; /* checked by noh_world_check; NULL: none */
    /* Instead of a world: returns the distance from a point straight down to the ground, at most `depth`, and its unit
     * normal; below 0: no ground. Must be a pure function */
    float (*below)(const void *user, const float from[3], float depth, float normal[3]);
    const void *user;
} noh_ground;

/* ---- legs ---- */

typedef struct noh_feet_point {
    uint32_t joint; /* of the foot or below it */
    float at[3];    /* in the joint's space */
} noh_feet_point;

typedef struct noh_feet_leg {
    uint32_t thigh, shin, foot;
    float knee[3];                          /* unit, in the thigh's space: direction of the knee */
    noh_feet_point points[NOH_FEET_POINTS]; /* heel, heel, ball, ball, toes, toes */
} noh_feet_leg;

typedef struct noh_feet_rig {
    noh_feet_leg legs[NOH_FEET_LEGS_MAX];
    uint32_t leg_count; /* 1..NOH_FEET_LEGS_MAX */
    uint32_t top;       /* the joint that moves with the pelvis, with all its descendants */
    uint32_t last;      /* the highest index of all joints above: a pose without it is not changed */
    float length;       /* of the longest leg, in the skeleton's unit */
} noh_feet_rig;

/* ======== hair ======== */

typedef struct noh_hair_sphere {
    float centre[3];
    float radius; /* including half the width of a hair strip, 0.. */
} noh_hair_sphere;

/* Data shared by hair of one kind. */
typedef struct noh_hair_desc {
    /* [hair_count][point_count][3], from the root to the tip; no two points of a hair are equal */
    const float *rest;
    uint32_t hair_count;  /* 1..NOH_HAIRS_MAX */
    uint32_t point_count; /* per hair, 2..NOH_HAIR_POINTS_MAX */
    /* [sphere_count]; for a hair with its root inside a sphere, the sphere shrinks to that root */
    const noh_hair_sphere *spheres;
    uint32_t sphere_count; /* 0..NOH_HAIR_SPHERES_MAX */
    uint32_t seed;         /* for gusts */
    float pull;            /* share of the distance to rest that a point moves per step, 0..1; usually 0.02 */
    float pull_at_tip;     /* pull at the tip; linear in between */
    float damping;         /* of velocity, per second, 0..; usually 2 to 4 */
    float gravity;         /* metres per second squared not yet included in `rest`, 0.. */
} noh_hair_desc;

/* ======== hair of a pack ======== */

typedef struct noh_haircut {
    const noh_pack_hair_header *header;
    const char *joint;       /* the joint that carries it; "": the actor itself */
    const uint32_t *patches; /* [header->patch_count][4] */
    noh_hair_desc desc;      /* of the control hairs */
} noh_haircut;

/* ======== levels of a terrain ========
 * A height field in square blocks, each drawn at the coarsest level that its screen error allows.
 *
 * A block has NOH_TERRAIN_BLOCK cells per side; level k uses every 2^k-th height. Along an edge to a coarser block the
 * finer one uses only the coarser one's heights, so that there is no crack between any two levels. Cells are split from
 * the corner of the next row to the corner of the next column.
 * source   de Boer: Fast Terrain Rendering Using Geometrical MipMapping, 2000 (levels by the error of blocks)
 * Threads: pure functions of their arguments; a block of memory belongs to one thread at a time. */

#define NOH_TERRAIN_BLOCK 32u
#define NOH_TERRAIN_LEVELS 6u /* the last has one cell per block */

typedef struct noh_terrain_lod {
    noh_field field;       /* a view: heights are used in place */
    uint32_t width, depth; /* blocks along x and z; the last ones may extend beyond the field */
    float *errors;         /* [width * depth][NOH_TERRAIN_LEVELS] largest height error, in the field's unit */
    uint16_t *bounds;      /* [width * depth][2] lowest and highest */
    uint8_t *levels;       /* [width * depth] chosen levels */
    uint8_t *seen;         /* [width * depth] 0: not visible */
} noh_terrain_lod;

/* ======== fixed steps ======== */

#define NOH_GRAVITY 9.82f /* metres per second squared */

/* ---- time ---- */

/* Time left over from frame to frame. Initialise to zero. */
typedef struct noh_steps {
    uint32_t left;    /* ticks (1/48,000 s) short of a full step */
    uint32_t dropped; /* ticks dropped by all calls; saturates */
} noh_steps;

/* ======== rigid bodies ========
 * A free rigid body moved by forces, torques and impulses: a box, capsule, ball or rounded box.
 *
 *   noh_rigid_init          a body at rest
 *   noh_rigid_set_motion    set velocity and spin
 *   noh_rigid_force         a force at a point, for the next step
 *   noh_rigid_torque        a torque, for the next step
 *   noh_rigid_push          an impulse at a point
 *   noh_rigid_step          advance time
 *   noh_rigid_place         position and rotation; noh_rigid_motion: velocity, spin and momentum
 *   noh_rigid_shift         move the origin of its space
 *   noh_point_touch         collide a point mass with a world, with bounce and friction
 *
 * A force F at a point p accelerates the body by F / mass and applies the torque (p - x) x F about its centre x. The
 * state is angular momentum, not spin, so free rotation conserves momentum to the last bits, and energy within a bound:
 * rotation is composed of exact turns about the three principal axes. Steps are 1/600 s. Free flight under constant
 * forces is exact.
 *
 * It collides with a noh_world through up to 24 contacts, with that world's friction and restitution: corners, edges
 * and round ends; with a height field only where corners touch. Bodies do not collide with each other or with ragdolls.
 * Overlaps separate at NOH_PUSH_OUT_SPEED. A body that moves by more than its own thickness in 1/600 s can pass through
 * a thin obstacle. A body that touches something and is slower than 0.08 m/s at its rim for half a second falls asleep
 * until a call changes it.
 *
 * A noh_rigid is the caller's, 144 bytes without pointers: a copy continues identically, with the same bits everywhere.
 * It is simulated about its own origin, like ragdolls (low_life.h). Read its fields with the functions below.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 6 (rigid bodies, which it leaves to a library);
 *          Dullweber, Leimkuhler, McLachlan: Symplectic splitting methods for rigid body molecular dynamics, 1997;
 *          Catto: Iterative Dynamics with Temporal Coherence, 2005 (impulses of contacts)
 * Threads: a body belongs to one thread at a time. */

#define NOH_RIGID_STEP_TICKS 80u /* 1/600 s */

typedef struct noh_rigid_desc {
    float half[3];     /* half the box's sides, 0..: all 0 a ball; 0, 0, z a capsule */
    float radius;      /* thickness added all around, 0..; half or radius above 0 */
    float mass;        /* kilograms, above 0 */
    float inertia[3];  /* kg m^2 about x, y, z of the body, above 0; all 0: of a solid of this shape and mass */
    float position[3]; /* of its centre of mass and of the box */
    float rotation[4]; /* unit; all 0: identity */
} noh_rigid_desc;

typedef struct noh_rigid {
    float half[3], radius;
    float mass, inertia[3];
    float origin[3], position[3]; /* position: relative to the origin */
    float rotation[4];
    float velocity[3], momentum[3]; /* momentum: angular, about its centre */
    float force[3], torque[3];
    noh_steps steps;
    uint32_t still; /* substeps since it became slow */
    uint32_t reserved[3];
} noh_rigid;

/* Make a body at rest.
 * errors  ARG a number out of its range (where: 0 a side, 1 the mass, 2 the inertia, 3 the place) */
noh_result noh_rigid_init(noh_rigid *body, const noh_rigid_desc *desc, noh_error *error);

/* Set velocity and spin.
 * shapes  velocity[3] m/s of its centre; spin[3] rad/s about the world's axes
 * errors  ARG a number beyond NOH_NUMBER_MAX; nothing changes */
noh_result noh_rigid_set_motion(noh_rigid *body, const float velocity[3], const float spin[3], noh_error *error);

/* Apply a force at a point, a torque, or an impulse at a point. Forces and torques add up, act during the whole next
 * noh_rigid_step, and are then cleared. Gravity is separate. Calls with values that are not finite do nothing. Sums,
 * speed and spin stay below NOH_NUMBER_MAX.
 * units  force newtons, torque newton metres, impulse newton seconds; points in world space */
void noh_rigid_force(noh_rigid *body, const float point[3], const float force[3]);
void noh_rigid_torque(noh_rigid *body, const float torque[3]);
void noh_rigid_push(noh_rigid *body, const float point[3], const float impulse[3]);

/* Advance time, in pieces of any length, by up to a quarter of a second per call.
 * world    NULL: no obstacles
 * gravity  m/s^2; NULL: NOH_GRAVITY downwards
 * returns  ticks dropped in this call */
uint32_t noh_rigid_step(noh_rigid *body, const noh_world *world, const float gravity[3], uint32_t ticks);

void noh_rigid_place(const noh_rigid *body, float position[3], float rotation[4]);

/* Get the motion.
 * shapes  velocity[3], spin[3] as set; momentum[3] angular, about its centre, kg m^2/s. Each may be NULL */
void noh_rigid_motion(const noh_rigid *body, float velocity[3], float spin[3], float momentum[3]);

int noh_rigid_sleeps(const noh_rigid *body);

/* Move the origin: each point p of its space becomes p + by, metres. Precise to what floats at the new place can
 * hold. */
void noh_rigid_shift(noh_rigid *body, const float by[3]);

/* Collide a point mass, moved by noh_point_move, with a world. It leaves an overlap by the depth that its velocity
 * caused, and any further depth at NOH_PUSH_OUT_SPEED. Its velocity towards an obstacle is reversed by the world's
 * restitution; its velocity along it is reduced by friction. For noh_verlet_move: velocity = (position - before) /
 * seconds, and afterwards before = position - seconds * velocity. Use it for the ends of springs and rods
 * (noh_distance_keep).
 * ranges   radius 0.., seconds above 0: of the preceding move
 * returns  whether it touched something */
int noh_point_touch(const noh_world *world, float radius, float position[3], float velocity[3], float seconds);

/* ======== the height field of a pack ========
 * The height field in a pack, used in place.
 *
 *   noh_terrain_of        get the height field: heights, normals, and the ground of a world
 *
 * Threads: no state; any thread. */

/* Get the height field: a view, valid as long as the pack and its bytes.
 * units   metres
 * errors  NOT_FOUND  the pack has no terrain (build it with --terrain); *field is then unchanged */
noh_result noh_terrain_of(const noh_pack *pack, noh_field *field, noh_error *error);

/* ======== two bones, and a head that looks ========
 * Closed-form inverse kinematics of an arm or a leg that reaches a point; the limits of a head that looks at one
 * (noh_gaze_modifier, modules.h).
 *
 *   noh_ik_two_bone     turn two bones so that their end meets a target
 *
 * For chains of more bones see noh_ik_chain_solve. All positions and directions of a call are in the same space, which
 * may be any; rotations are applied in that space, on the left of a joint's rotation.
 *
 * No solution uses an arc cosine: bends come from lengths, and rotations from sums of vectors, so targets out of reach,
 * at the root or in line with the pole give a pose and never NaN.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 11 (law of cosines, a look-at with a limit), with
 *          its degenerate cases added
 * Threads: no state; any thread. */

/* ---- two bones ---- */

/* Shoulder, elbow and hand, or hip, knee and ankle. */
typedef struct noh_ik_limb {
    float start[3], middle[3], end[3]; /* present positions of the joints */
    float bend_min, bend_max;          /* radians between the bones: 0 straight, pi folded. Default (0, 0): no limit */
    float soft; /* share of its length beyond which a stretching limb slows down, 0.5..1; default (0) 1: never */
} noh_ik_limb;

typedef struct noh_ik_bend {
    float start[4];  /* turns the start joint with its descendants */
    float middle[4]; /* then turns the middle joint with its descendants */
    float missed;    /* distance from the target to the end; 0 within rounding if reached */
} noh_ik_bend;

/* Turn two bones so that their end meets the target. A target out of reach is approached as near as lengths and limits
 * allow, in its direction.
 * ranges  any finite positions; bones may have no length. soft 0 or 0.5..1, 0 <= bend_min <= bend_max <= pi
 * pole    the direction, perpendicular to the line from start to target, in which the middle joint should lie; any
 *         length. NULL, or along that line: it stays on its present side
 * weight  0..1: fraction of both rotations
 * errors  the end is off by at most 2e-5 of the limb's length; continuous in target and pole, except where they are in
 *         line
 * source  law of cosines; softness as in ozz-animation's two-bone job: d' = s + (1 - s) (1 - 81 / (3 + t)^4), t = (d -
 *         s) / (1 - s), in lengths of the limb */
void noh_ik_two_bone(const noh_ik_limb *limb, const float target[3], const float pole[3], float weight,
                     noh_ik_bend *bend);

/* ---- looking ---- */

/* The state of a look. May be copied. */
typedef struct noh_ik_look {
    float direction[3]; /* unit, the present direction */
    /* 0: no target; 1: a target; 2, 3: a target behind, over the left or the right shoulder */
    uint32_t follows;
} noh_ik_look;

/* ======== gaze ======== */

/* The joints that turn. May also be filled in by hand. */
typedef struct noh_gaze_rig {
    uint32_t joints[NOH_GAZE_JOINTS_MAX]; /* each below the previous one; the last is the head */
    float shares[NOH_GAZE_JOINTS_MAX];    /* of the turn, 0..1; their sum is 1 */
    uint32_t joint_count;                 /* 1..NOH_GAZE_JOINTS_MAX */
    uint32_t eyes[2];                     /* below the head; NOH_NONE: the head turns all the way */
    float ahead[3];                       /* unit, in the head's space: direction of the face */
    float middle[3];                      /* midpoint of the eyes, in the head's space */
    float eyes_ahead[2][3];               /* unit, in the eyes' spaces */
    float size;                           /* from the first joint to `middle`, in the skeleton's unit, above 0 */
    uint32_t last;                        /* the highest index of all joints above */
} noh_gaze_rig;

/* ======== chains of joints ========
 * Inverse kinematics of chains of any length: tails, tentacles, a reaching spine.
 *
 * Three solvers, all iterative, all with limits:
 *   NOH_IK_CCD      turns one joint after the other, the last first. Curls the end of the chain most
 *   NOH_IK_FABRIK   drags the joints along, to and from the target. Fewest iterations: tails
 *   NOH_IK_DLS      damped least squares: the smallest change of all joints together. Spines
 *
 * The best pose so far is kept: more iterations never make it worse. A chain points at a target out of reach.
 * source   Wang, Chen: A combined optimization method for solving the inverse kinematics problem of mechanical
 *          manipulators, 1991 (CCD); Aristidou, Lasenby: FABRIK, Graphical Models 73, 2011; Buss: Introduction to
 *          inverse kinematics with Jacobian transpose, pseudoinverse and damped least squares methods, 2004
 * Threads: no state; any thread. */

#define NOH_IK_LIMIT_SWING 1u
#define NOH_IK_LIMIT_TWIST 2u

typedef enum noh_ik_solver { NOH_IK_CCD = 0, NOH_IK_FABRIK, NOH_IK_DLS } noh_ik_solver;

/* Limits of a joint from its bind rotation: swing away from the bone's direction, and twist about it. */
typedef struct noh_ik_limit {
    uint32_t flags;             /* NOH_IK_LIMIT_*: the limits in use */
    float swing_max;            /* radians, in all directions, 0..pi */
    float twist_min, twist_max; /* radians, -pi..0 and 0..pi */
} noh_ik_limit;

typedef struct noh_ik_chain {
    uint32_t count;             /* joints that turn, 1..NOH_IK_JOINTS_MAX */
    const float *root;          /* [3] position of the first joint */
    const float *root_rotation; /* [4] rotation of its parent; NULL: the identity */
    const float *bones; /* [count][3] from each joint to the next, and from the last to the end, in the joint's space */
    const float *binds; /* [count][4] local rotations from which limits count; NULL: identities */
    const noh_ik_limit *limits; /* [count]; NULL: none */
} noh_ik_chain;

typedef struct noh_ik_chain_result {
    uint32_t iterations; /* iterations used */
    float missed;        /* distance from the target to the end */
} noh_ik_chain_result;

/* Turn the joints of a chain until its end is within `tolerance` of the target.
 * ranges     iterations 1..1000, the most to run; tolerance > 0, in the chain's unit
 * rotations  [count][4] local, in and out; input is the start pose. Joints beyond their limits are clamped to them
 * errors     ARG a count of 0 or above NOH_IK_JOINTS_MAX, or a target that is not finite; nothing is written */
noh_result noh_ik_chain_solve(const noh_ik_chain *chain, noh_ik_solver solver, const float target[3], float tolerance,
                              uint32_t iterations, float *rotations, noh_ik_chain_result *result, noh_error *error);

/* ======== reach ======== */

typedef struct noh_reach_arm {
    uint32_t upper, fore, hand;
    float elbow[3]; /* unit, in the upper arm's space: direction of the elbow */
    /* the point of the hand to put on the target, in the hand's space; rigs from noh_reach_rig_make have 0: the
     * wrist */
    float palm[3];
} noh_reach_arm;

typedef struct noh_reach_rig {
    noh_reach_arm arms[NOH_REACH_ARMS_MAX]; /* the left one first, as seen from the body */
    uint32_t arm_count;                     /* 1..NOH_REACH_ARMS_MAX */
    uint32_t last;                          /* the highest index of all joints above */
} noh_reach_rig;

#ifdef __cplusplus
}
#endif

#endif
