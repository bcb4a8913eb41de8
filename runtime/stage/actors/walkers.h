/* walkers.h: agents of a crowd (crowd.h) as actors of a stage.
 *
 *   noh_walkers_size, noh_walkers_init   room for them, and what their clips do
 *   noh_walkers_put, noh_walkers_remove  tie an actor to an agent, and untie it
 *   noh_walkers_face                     the direction in which a standing walker turns
 *   noh_walkers_step                     places and clips follow the agents
 *   noh_walkers_feet_part                feet on the ground, for the nearest walkers
 *   noh_walkers_near                     choose the nearest walkers
 *   noh_walkers_push                     walkers near a point fall, as ragdolls from a pool
 *   noh_walkers_tend                     what fallen walkers do: wait, get up, walk on
 *
 *   noh_walkers_tend(walkers, crowd, stage, ACTS, ticks, NULL);
 *   noh_crowd_step(crowd, ticks);
 *   noh_walkers_step(walkers, crowd, stage, &ground, ticks, NULL);
 *   noh_stage_step(stage, ticks, ...);
 *   noh_walkers_near(walkers, stage, view.eye);
 *   noh_stage_frame_begin(stage, &view, 1, NULL);
 *
 * The crowd makes steps of 1/30 s; frames may have any rate. An actor follows the shown position of its agent
 * (noh_crowd_agent_at) at the pace of its own walk clip, forwards or backwards. It turns at a limited speed, about the
 * foot that it stands on, and only while the other foot is in the air, so a standing foot does not slide. Who stands
 * sets out with a step and stops with one that brings the feet together; who turns on the spot steps, too. The actor
 * then stays within a few centimetres of its agent; it may stop 0.2 m from it. It falls behind by up to 0.7 m where the
 * agent turns or is pushed faster than feet can follow: beyond that the actor is pulled along. Behind an agent slower
 * than a quarter of the walk's speed it makes a step now and then. Above the walk's speed it runs: blended where sync
 * markers show that both clips are in step, by a change of clip otherwise.
 * That wants feet_part, from which soles are known, two legs, a clip to stand by, and a walk in which each leg swings
 * past the other above the ground. Without a clip to stand by it always walks; without soles it turns about its middle,
 * at any time, and below a quarter of the walk's speed takes shorter steps, the walk blended with standing.
 *
 * The kind's clips must not move the actor themselves: set root_axes to NOH_ROOT_X | NOH_ROOT_Z (the heading of a root
 * stays in the pose), root_up to 1 and root_told to 1. Init measures how far the root moves in a pass; its sway about
 * the straight line is put back into the place. The layer is a base layer whose tracks belong to the walkers; play
 * anything else on layers over it.
 *
 * Walkers are one block without pointers. A copy of it, of the crowd and of the stage's state continues with the same
 * bits.
 * source  Granberg, Character Animation with Direct3D, 2009, chapter 13, corrected: there, clips play at one speed
 *         however fast the agent walks
 * Threads: walkers belong to the stage's thread. */
#ifndef NOH_ACTORS_WALKERS_H
#define NOH_ACTORS_WALKERS_H

#include "stage/crowd/crowd.h"
#include "stage/cast/stage_feet.h"
#include "stage/cast/stage_ragdoll.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Zero is a good value for all but walker_max and walk. */
typedef struct noh_walkers_desc {
    uint32_t walker_max;    /* 1..NOH_CROWD_AGENTS_MAX; required */
    uint32_t near_max;      /* how many have their feet put on the ground at once; 0 without feet_part */
    uint32_t feet_part;     /* 1 + the index of noh_walkers_feet_part in the kind's parts; default 0: it has none */
    uint32_t kind, layer;   /* of the stage; the layer has a track for each clip */
    const char *walk;       /* clips, played as loops: straight on, at an even speed; required */
    const char *idle, *run; /* default (NULL) none */
    float walk_speed, run_speed; /* of the clips, model units a second; default (0) that of their roots */
    float turn_speed;            /* radians a second, at most; default (0) 4 */
} noh_walkers_desc;

typedef struct noh_walkers noh_walkers;

/* The exact bytes: 8,016, 96 a walker and 8 for each that may be near; rounded up to 16. 0 for an impossible desc. */
size_t noh_walkers_size(const noh_walkers_desc *desc);

/* Without a walker at first.
 * stage   its clips are measured; the pointer is not kept
 * errors  ARG memory NULL or misaligned, a number is out of its range, the kind, layer or part is not one, its root
 *         moves the actor, or a clip moves no root and no speed is given; NOT_FOUND no such clip (where: 0 walk, 1
 * idle, 2 run); LIMIT; MEMORY */
noh_result noh_walkers_init(void *memory, size_t bytes, const noh_walkers_desc *desc, noh_stage *stage,
                            noh_walkers **walkers, noh_error *error);

/* Tie an actor of the desc's kind to an agent. It is placed there at once, on the ground at most 2 m above its place,
 * and stands, at a phase of its clips that depends on the index, so that many walkers do not breathe and step as one.
 * index   below walker_max; the actor that had this index is untied
 * heading [2] unit vector x, z that it faces at first; NULL: +z
 * errors  NOT_FOUND the actor is gone; ARG the index, or another kind's actor */
noh_result noh_walkers_put(noh_walkers *walkers, uint32_t index, noh_stage *stage, noh_actor actor, uint32_t agent,
                           const float heading[2], noh_error *error);
void noh_walkers_remove(noh_walkers *walkers, uint32_t index);

/* The direction in which a standing walker turns.
 * direction [2] x, z of any length; NULL: the one in which it arrived */
void noh_walkers_face(noh_walkers *walkers, uint32_t index, const float direction[2]);

/* The direction in which a walker faces: a unit vector x, z.
 * returns  0 if there is no such walker */
int noh_walkers_heading(const noh_walkers *walkers, uint32_t index, float heading[2]);

/* Move the origin of the world, with noh_crowd_shift_origin and noh_stage_shift_origin: walkers are less by `by` then.
 * In x and z they count from where their crowd counts, so they walk as exactly at 100 km as at the origin. Heights are
 * floats of the world. */
void noh_walkers_shift_origin(noh_walkers *walkers, const float by[3]);

/* Move actors and their clips after their agents. Call it before noh_stage_step, with the same ticks. An actor that is
 * gone is untied; one that falls (stage_ragdoll.h) is left alone until it stands again.
 * ground  what they stand on; NULL: the plane y = 0
 * errors  ARG within a step or a frame of the stage */
noh_result noh_walkers_step(noh_walkers *walkers, const noh_crowd *crowd, noh_stage *stage, const noh_ground *ground,
                            uint32_t ticks, noh_error *error);

/* A part of the kind that puts the feet of the walkers that noh_walkers_near chose on the ground. It fades in and out
 * within a quarter of a second. For all other walkers it costs one comparison.
 * feet    must outlive the stage */
noh_stage_part noh_walkers_feet_part(const noh_kind_feet *feet);

/* Choose the near_max walkers that are nearest to a point. One that was chosen before counts as a tenth nearer, so that
 * two do not take turns. Within a step or a frame it does nothing.
 * returns  how many were chosen */
uint32_t noh_walkers_near(noh_walkers *walkers, noh_stage *stage, const float eye[3]);

/* ---- falling ---- */

/* Push standing walkers within a radius of a point (measured in x and z) away from it. They fall, the nearest first,
 * as long as their kind has a ragdoll left (noh_kind_ragdoll.count); the others stay on their feet.
 * shapes   point[3] in the stage's unit; y is the height at which they are hit
 * impulse  newton seconds on each, away from the point; a walker at the point itself falls in the direction it faces
 * returns  how many fell; 0 for a kind without ragdolls, and within a step or a frame */
uint32_t noh_walkers_push(noh_walkers *walkers, noh_stage *stage, const float point[3], float radius, float impulse);

/* Tend fallen walkers; call it before noh_crowd_step, with the same ticks. The agent of a fallen walker stays under it,
 * so that others walk around it. The walker gets up (fall.h), gives its ragdoll back and walks on at its former
 * pace; a dead one (noh_actor_kill) stays down. This covers walkers that fell by noh_actor_fall or noh_actor_hit, too.
 * layer    on which the clip for getting up plays; not the walkers' own layer
 * returns  how many are not on their feet
 * errors   those of noh_fall_step, which is tried again at the next call; ARG the layer, or within a step or a frame */
uint32_t noh_walkers_tend(noh_walkers *walkers, noh_crowd *crowd, noh_stage *stage, uint32_t layer, uint32_t ticks,
                          noh_error *error);

/* Whether a walker has fallen and is not on its feet again. */
int noh_walkers_is_down(const noh_walkers *walkers, uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
