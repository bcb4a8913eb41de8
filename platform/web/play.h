/* play.h: what moves a scene: for each of its skeletons a clip bank, a controller and a pose. */
#ifndef NOH_PLATFORM_WEB_PLAY_H
#define NOH_PLATFORM_WEB_PLAY_H

#include "scene.h"

#define WEB_PLAYERS_MAX 8u
#define WEB_STILL_JOINTS_MAX 256u

typedef struct web_player {
    noh_skeleton skeleton; /* joint_count 0: none, only weights are moved */
    noh_clip_bank *set;    /* NULL: no clip fits */
    noh_controller *controller;
    noh_pose_scratch scratch;
    noh_transform *pose; /* [joint_count] */
    float *floats;       /* [set->clips.float_count] */
    float *model;        /* [joint_count][12] model space */
} web_player;

typedef struct web_playback {
    web_scene *scene;
    web_player players[WEB_PLAYERS_MAX];
    uint32_t player_count;
    uint32_t clip; /* that plays: its index in the pack; NOH_NONE: none does */
    float speed;
    float *matrices; /* [joints of the largest skin][12]; NULL: nothing is skinned */
    float still[WEB_STILL_JOINTS_MAX]
               [12]; /* the joints of skeletons that no clip moves: `noh budget` does not count them */
    uint32_t still_count;
} web_playback;

/* Three steps, in this order, each of which carves what one line of `noh budget` says.
 * errors  as noh_clip_bank_init, noh_controller_init, noh_pose_scratch_init; LIMIT more skeletons, or more joints
 *         that nothing moves, than the page has room for; MEMORY */
noh_result web_playback_open_clips(web_playback *play, web_scene *scene, noh_arena *arena, noh_error *error);
noh_result web_playback_open_controllers(web_playback *play, noh_arena *arena, noh_error *error);
noh_result web_playback_open_poses(web_playback *play, noh_arena *arena, noh_error *error);

/* Room for what is handed to noh_gl_skin_set_matrices, where the scene is skinned. errors  MEMORY */
noh_result web_playback_open_matrices(web_playback *play, noh_arena *arena, noh_error *error);

/* The seconds of the pack's n-th clip; negative where it moves nothing here. */
double web_playback_seconds(const web_playback *play, uint32_t clip);

/* Play a clip in a loop, from a time in seconds; NOH_NONE: stop, in the bind pose. A transition in seconds blends from
 * the previous clip by inertialisation. */
noh_result web_playback_start(web_playback *play, uint32_t clip, double time_s, double transition_s, noh_error *error);
void web_playback_set_speed(web_playback *play, float speed);

/* Advance by a time. */
void web_playback_step(web_playback *play, double seconds);

/* The clip's time, in seconds. */
double web_playback_time(const web_playback *play);

/* Compute the item's skin matrices in the current pose into play->matrices. Returns 0 for a rigid item. */
int web_playback_matrices(web_playback *play, const web_item *item);

/* The scene's current bounding box in the world, without morphs. */
void web_playback_bounds(web_playback *play, float box[6]);

#endif
