/* crowd_scene.h: agents that cross a circle, leave through a door, walk among each other, in a maze or from stall to
 * stall, and their measurements (crowd.h). Starts follow from a seed, and are the same on every processor. */
#ifndef NOH_NOH_CROWD_CROWD_SCENE_H
#define NOH_NOH_CROWD_CROWD_SCENE_H

#include "noh/crowd.h"

typedef struct crowd_scene_options {
    const char *name; /* circle250, door200, dense1000, open10000, maze400, stalls600 */
    uint32_t agents;  /* 0: the number in the name */
    double seconds;   /* 0: the scene's own: 300 for circle250, 120 for door200, maze400 and
                         stalls600, 30 */
    uint32_t seed, job_count;
    uint32_t flags; /* of all agents: NOH_CROWD_ORCA */
} crowd_scene_options;

/* Over all agents and all steps so far. */
typedef struct crowd_measures {
    double overlap_max;  /* of the sum of two radii */
    uint64_t overlapped; /* agent-steps with more than a twentieth of it */
    uint64_t agent_steps;
    double progress;    /* sum of the speed towards the goal, of the speed that an agent likes */
    uint64_t under_way; /* agent-steps of agents that want to walk and have not arrived */
    uint32_t stuck_max; /* most steps in a row in which an agent hardly moves although there is room in front of it */
    uint32_t held_max;  /* the same, with or without agents in front */
    double done, half;  /* seconds until all agents, half of them, had arrived; below 0: not yet */
} crowd_measures;

typedef struct crowd_scene crowd_scene;

/* Prints an error and returns an exit code; 0 on success. */
int crowd_scene_open(const crowd_scene_options *options, crowd_scene **scene);
void crowd_scene_close(crowd_scene *s);

/* One step of 1/30 s. returns 0 when the scene is over: its time has passed, or all have arrived */
int crowd_scene_step(crowd_scene *s);

const crowd_measures *crowd_scene_measures(const crowd_scene *s);
noh_crowd *crowd_scene_crowd(const crowd_scene *s);
uint32_t crowd_scene_agents(const crowd_scene *s);
uint32_t crowd_scene_steps(const crowd_scene *s); /* so far */
size_t crowd_scene_bytes(const crowd_scene *s);   /* of the crowd, without its flow fields */
size_t crowd_scene_field_bytes(const crowd_scene *s);
double crowd_scene_cpu_ns(const crowd_scene *s); /* that its steps took */
/* An agent as of the last step. */
const noh_crowd_agent *crowd_scene_agent(const crowd_scene *s, uint32_t index);

#endif
