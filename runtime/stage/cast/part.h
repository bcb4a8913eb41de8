/* part.h: what hangs on an actor between its clips and what is drawn: a gaze, feet on the ground, springs, a ragdoll,
 * blinks.
 *
 * A part is a function that changes a pose: it is given the local pose and the floats that clips and graphs came to,
 * and leaves what is shown. A kind names its parts (noh_kind_desc.parts); they are called one after another in that
 * order, each with what the one before has left. What a part has to remember of an actor lies in the state of the
 * stage, in as many bytes as the part says: saved, restored, hashed and forked with all else. The game reads and writes
 * the same bytes between frames (noh_actor_part), and so tells the part what to do: where to look, what to fear.
 *
 *   typedef struct gaze { float target[3], turned; } gaze;
 *   static void look(noh_part_work *w) { gaze *g = w->state; ... w->local[head].rotation ... }
 *   static const noh_stage_part parts[] = { { .name = "gaze", .modify = look, .state_bytes = sizeof(gaze) } };
 *   kind.parts = parts, kind.part_count = 1;
 *   ((gaze *)noh_actor_part(stage, actor, 0))->target[0] = 1.0f;
 *
 * A part runs in the jobs of a frame, on any thread, so it keeps a contract:
 *   - it reads the work, its own state and what `user` points to, and writes local, floats, state and scratch alone;
 *   - it calls no function of the stage but those below; the rest of the library's are fine where their own comments
 *     allow it;
 *   - its result depends on these alone: no clock, no address, no random numbers but those of its state. Then results
 *     have the same bits for any number of jobs, and after a restore.
 * It is called only where the actor is posed: not out of view, and at a distance less often than once a frame, for the
 * tick that the pose will be shown at. So it moves its state on by `ticks` as they come, not by frames; time that
 * passed out of view comes as one call with `cut`.
 *
 * Threads: as above; noh_actor_part on the stage's thread, outside of steps and frames. */
#ifndef NOH_STAGE_PART_H
#define NOH_STAGE_PART_H

#include "motion/pose/skeleton.h"
#include "stage/cast/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PART_FULL_DETAIL 1e9f

/* What a part is given. */
typedef struct noh_part_work {
    noh_actor actor;
    const noh_skeleton *skeleton; /* joint_count 0 in a kind without one */
    noh_transform *local;         /* [skeleton->joint_count] read and write; parents come before their children */
    uint32_t joint_count;         /* the first so many were sampled at this detail; the others have the bind pose */
    uint32_t level;               /* of the actor, 0 the finest */
    float pixels_per_metre;       /* at the actor's nearest point; NOH_PART_FULL_DETAIL where all is shown in full */
    noh_place place;              /* of the actor after the last step. Of one that hangs on another it is the other's:
                                   * where the joint is, is not known yet */
    int64_t clock;                /* tick of the stage's clock that the pose is for: the present one, or a later one */
    uint32_t ticks;               /* since that of the pose before; 0 after a cut, or where that was for a later tick */
    uint32_t cut;                 /* 1: nothing to go on from: the actor is new, has leapt, or was out of view */
    void *state;                  /* [state_bytes] of this part and actor, aligned to 16; zeros when it is spawned */
    void *scratch;                /* [scratch_bytes] of the job, aligned to 16; undefined */
    const void *user;
    const void *kind; /* private, as are all below */
    float *floats, *model;
    double home[3]; /* a point near the actor, and its place from there, which is exact far from the origin */
    float near_place[3];
    float home_moved[3]; /* since the pose before: states count from `home`, and are less by so much */
} noh_part_work;

/* Model-space matrices of all joints, as the local pose stands now: made anew by each call, and valid until the next
 * one or the end of the part. To get to the world multiply by that of the place.
 * shapes   [skeleton->joint_count][12]
 * returns  NULL in a kind without a skeleton */
const float *noh_part_model(noh_part_work *work);

/* A float as it stands now, and a new value. Floats are counted as noh_stage_find does; one that takes its value from a
 * namesake is the namesake. In a pack without nodes whose kind has clips, weights of targets cannot be set: 0. */
float noh_part_float(const noh_part_work *work, uint32_t index);
int noh_part_set_float(noh_part_work *work, uint32_t index, float value);

/* One part of a kind. All but `modify` may be 0. */
typedef struct noh_stage_part {
    const char *name; /* for messages; borrowed */
    void (*modify)(noh_part_work *work);
    /* What is wrong with a state that comes from outside (noh_stage_set_state), a constant text; NULL: it is good.
     * Without this function any bytes are good */
    const char *(*check)(const void *user, const void *state);
    const void *user;       /* for both; read by jobs at the same time; must outlive the stage */
    uint32_t state_bytes;   /* of each actor */
    uint32_t scratch_bytes; /* of each job; parts of all kinds share it */
} noh_stage_part;

/* The state of a part of an actor, to read and to write; part: its index in noh_kind_desc.parts. Valid until the actor
 * goes. NULL: the actor is gone, has no such part, or a frame has begun. */
void *noh_actor_part(noh_stage *stage, noh_actor actor, uint32_t part);

#ifdef __cplusplus
}
#endif

#endif
