/* walkers.h: agents of a crowd (crowd/crowd.h) as actors of a stage.
 *
 *   noh_walkers_size, noh_walkers_init   room for them, and what their clips do
 *   noh_walkers_put, noh_walkers_remove  an actor goes where an agent goes
 *   noh_walkers_face                     where one who stands turns to
 *   noh_walkers_step                     places and clips follow the agents
 *   noh_walkers_feet_part                feet on the ground, for the nearest
 *   noh_walkers_near                     who these are
 *   noh_walkers_push                     who is near a point falls, out of a pool of ragdolls
 *   noh_walkers_tend                     agents of those who have fallen; they get up, and go on
 *
 *   noh_walkers_tend(walkers, crowd, stage, ACTS, ticks, NULL);
 *   noh_crowd_step(crowd, ticks);
 *   noh_walkers_step(walkers, crowd, stage, &ground, ticks, NULL);
 *   noh_stage_step(stage, ticks, ...);
 *   noh_walkers_near(walkers, stage, view.eye);
 *   noh_stage_frame_begin(stage, &view, 1, NULL);
 *
 * The crowd makes steps of 1/30 s, frames may have any rate: an actor goes where its agent is shown
 * (noh_crowd_agent_at), on its feet. Its walk leads it, straight on, back or in place while it turns at a limited
 * speed, and it turns about the foot that it stands on: so a foot of a clip that stands, stands, and the actor is a few
 * centimetres from its agent, at most 0.4 m where that turns or is pushed faster than feet can follow: only then is an
 * actor pulled. Slower than a quarter of its walk it takes shorter steps, which are the walk blended with standing;
 * faster than the walk it becomes a run: blended, where sync markers tell that both clips are in step, else by a
 * change. Where soles are is known from feet_part; without one actors turn about their middle.
 *
 * The kind's clips must not move the actor themselves: root_axes NOH_ROOT_X | NOH_ROOT_Z (what the heading of a root
 * does belongs to the pose), root_up 1, root_told 1. How far the root moves in a pass is measured by init; what it
 * sways about the straight way is put back into the place. The layer is a base layer whose tracks belong to the
 * walkers: what else an actor does is played on layers over it.
 *
 * Walkers are one block without pointers: with a copy of the crowd, and of the stage's state, they go on as they
 * would, with the same bits.
 * source  Granberg, Character Animation with Direct3D, 2009, chapter 13, corrected: its clips play at their own speed
 *         whatever the agent's is
 * Threads: walkers belong to the stage's thread. */
#ifndef NOH_STAGE_WALKERS_H
#define NOH_STAGE_WALKERS_H

#include "crowd/crowd.h"
#include "stage/stage_feet.h"
#include "stage/stage_ragdoll.h"

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

/* Nobody walks yet.
 * stage   its clips are measured; it is not kept
 * errors  ARG memory NULL or misaligned, a number is out of its range, the kind, layer or part is not one, its root
 *         moves the actor, or a clip moves no root and no speed is given; NOT_FOUND no such clip (where: 0 walk, 1
 * idle, 2 run); LIMIT; MEMORY */
noh_result noh_walkers_init(void *memory, size_t bytes, const noh_walkers_desc *desc, noh_stage *stage,
                            noh_walkers **walkers, noh_error *error);

/* From now on an actor, of the desc's kind, goes where an agent goes. It leaps there, on the ground that is at most 2 m
 * above its place, and begins to stand, at a phase of its clips that its index chooses, so that many do not breathe and
 * step as one.
 * index   below walker_max; whoever was there is let go
 * heading [2] unit vector x, z that it faces at first; NULL: +z
 * errors  NOT_FOUND the actor is gone; ARG the index, or another kind's actor */
noh_result noh_walkers_put(noh_walkers *walkers, uint32_t index, noh_stage *stage, noh_actor actor, uint32_t agent,
                           const float heading[2], noh_error *error);
void noh_walkers_remove(noh_walkers *walkers, uint32_t index);

/* Where one who stands turns to.
 * direction [2] x, z of any length; NULL: as it came */
void noh_walkers_face(noh_walkers *walkers, uint32_t index, const float direction[2]);

/* The way that a walker faces: a unit vector x, z. returns 0 where there is none */
int noh_walkers_heading(const noh_walkers *walkers, uint32_t index, float heading[2]);

/* Actors and their clips follow their agents, before noh_stage_step by as many ticks. An actor that is gone is let go;
 * one that falls (stage/stage_ragdoll.h) is left alone until it stands again.
 * ground  what they stand on; NULL: the plane y = 0
 * errors  ARG within a step or a frame of the stage */
noh_result noh_walkers_step(noh_walkers *walkers, const noh_crowd *crowd, noh_stage *stage, const noh_ground *ground,
                            uint32_t ticks, noh_error *error);

/* A part of the kind that puts feet on the ground, of those that noh_walkers_near has chosen: it takes their feet in
 * and out of that within a quarter of a second. Others cost a comparison.
 * feet    must outlive the stage */
noh_stage_part noh_walkers_feet_part(const noh_kind_feet *feet);

/* Choose the near_max walkers that are nearest to a point. Who is near counts as a tenth nearer, so that two do not
 * take turns. Not within a step or a frame: nothing happens then.
 * returns  how many they are */
uint32_t noh_walkers_near(noh_walkers *walkers, noh_stage *stage, const float eye[3]);

/* ---- falling ---- */

/* Walkers who stand within a radius of a point, on the ground of x and z, are pushed away from it and fall, the nearest
 * first, as long as their kind has a ragdoll left (noh_kind_ragdoll.count): the others stay on their feet.
 * shapes   point[3] in the stage's unit: y is the height at which they are hit
 * impulse  newton seconds on each, away from the point; who is right there falls the way that it faces
 * returns  how many fell; 0 in a kind without ragdolls, and within a step or a frame */
uint32_t noh_walkers_push(noh_walkers *walkers, noh_stage *stage, const float point[3], float radius, float impulse);

/* Before noh_crowd_step by as many ticks: agents of those who fall stay under them, so that others go around; they get
 * up (stage/fall.h), which gives their ragdoll back, and then go on at the pace that they had. One that is dead
 * (noh_actor_kill) is left to lie. Also of who fell by noh_actor_fall or noh_actor_hit.
 * layer    on which the clip plays by which one gets up; not that of the walkers, whose tracks are theirs
 * returns  how many are not on their feet
 * errors   those of noh_fall_step: who it is of tries again; ARG the layer, or within a step or a frame */
uint32_t noh_walkers_tend(noh_walkers *walkers, noh_crowd *crowd, noh_stage *stage, uint32_t layer, uint32_t ticks,
                          noh_error *error);

/* Whether one has fallen and does not stand yet: what it wants is not done now. */
int noh_walkers_is_down(const noh_walkers *walkers, uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
