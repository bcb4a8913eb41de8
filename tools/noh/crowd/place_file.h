/* place_file.h: a place for a crowd, as text (noh help FORMATS): walls, posts, steps, spawn areas, goals, and the
 * objects that agents use (crowd.h). */
#ifndef NOH_NOH_CROWD_PLACE_FILE_H
#define NOH_NOH_CROWD_PLACE_FILE_H

#include "convert/base/error.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/crowd.h"

#define PLACE_SPAWNS_MAX 64u
#define PLACE_GOALS_MAX 64u
#define PLACE_STEPS_MAX 64u
#define PLACE_CLIPS_MAX 32u
#define PLACE_AGENTS 100u /* the default number */

typedef struct place_area {
    float low[2], high[2]; /* x, z */
} place_area;

typedef struct place_step {
    place_area area;
    float height; /* of the ground there, metres */
} place_step;

typedef struct place_goal {
    float at[2], radius;
} place_goal;

typedef struct place_file {
    place_area area;
    uint32_t spawn_count, goal_count, step_count, clip_count;
    place_area spawns[PLACE_SPAWNS_MAX];
    place_goal goals[PLACE_GOALS_MAX];
    place_step steps[PLACE_STEPS_MAX];
    float radius, speed[2];  /* of agents: the slowest and the fastest */
    const noh_field *ground; /* the terrain below it, not from the text; borrowed. NULL: y = 0 */
    uint32_t obstacle_count;
    noh_crowd_obstacle *obstacles;
    noh_smart_desc smart; /* agent_max 0; object_count 0: agents have no needs. Points to: */
    noh_smart_object *objects;
    noh_smart_slot *slots; /* their clips: 1 + an index of clips, 0 none */
    char *need_names[NOH_SMART_NEEDS_MAX];
    char *clips[PLACE_CLIPS_MAX];
} place_file;

/* 0, or 1 with *line (0: of no line) and *error. *out is to be freed by place_free. */
int place_parse(const char *text, size_t size, place_file **out, uint32_t *line, model_error *error);
/* Read a file; prints an error, "FILE:LINE: ...", and returns an exit code. */
int place_read(const char *path, place_file **out);
void place_free(place_file *place);

#endif
