/* play.h: what plays in a scene: for each of its skeletons a clip bank, a controller and a pose. */
#ifndef NOH_PLATFORM_WEB_PLAY_H
#define NOH_PLATFORM_WEB_PLAY_H

#include "scene.h"

#define WEB_PLAYERS_MAX 8u
#define WEB_STILL_JOINTS_MAX 256u

/* What moves one skeleton, or only weights. */
typedef struct web_player {
    noh_skeleton skeleton; /* joint_count 0: none, clips move only weights */
    noh_clip_bank *set;    /* NULL: no clip of the pack is for this skeleton */
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
    uint32_t clip; /* index in the pack of the clip that plays; NOH_NONE: none */
    float speed;
    float *matrices; /* [joints of the largest skin][12]; NULL: nothing is skinned */
    /* model-space joints of the skeletons that no clip moves, which `noh budget` does not count */
    float still[WEB_STILL_JOINTS_MAX][12];
    uint32_t still_count;
} web_playback;

/* Three steps, in this order. Each carves what one line of `noh budget` says.
 * errors  as noh_clip_bank_init, noh_controller_init, noh_pose_scratch_init; LIMIT more skeletons, or more joints that
 *         no clip moves, than the page has room for; MEMORY the arena is too small */
noh_result web_playback_open_clips(web_playback *play, web_scene *scene, noh_arena *arena, noh_error *error);
noh_result web_playback_open_controllers(web_playback *play, noh_arena *arena, noh_error *error);
noh_result web_playback_open_poses(web_playback *play, noh_arena *arena, noh_error *error);

/* Carve the matrices for noh_gl_skin_set_matrices, if anything in the scene is skinned.
 * errors  MEMORY the arena is too small */
noh_result web_playback_open_matrices(web_playback *play, noh_arena *arena, noh_error *error);

/* The duration of a clip of the pack in seconds; negative if it moves nothing in this scene. */
double web_playback_seconds(const web_playback *play, uint32_t clip);

/* Play a clip of the pack in a loop from a time in seconds; NOH_NONE: show the bind pose. With a transition in seconds,
 * inertialisation blends from the previous clip.
 * errors  as noh_controller_init, noh_controller_start and noh_controller_inertia_capture */
noh_result web_playback_start(web_playback *play, uint32_t clip, double time_s, double transition_s, noh_error *error);
/* Set the playback speed: 1 as made. */
void web_playback_set_speed(web_playback *play, float speed);

/* Advance by a time in seconds, and pose. */
void web_playback_step(web_playback *play, double seconds);

/* The position of the clip that plays, in seconds. */
double web_playback_time(const web_playback *play);

/* Write an item's skin matrices in the current pose to play->matrices. Returns 0 for a rigid item. */
int web_playback_matrices(web_playback *play, const web_item *item);

/* The scene's bounding box in the world in the current pose, without morphs: min, then max. */
void web_playback_bounds(web_playback *play, float box[6]);

#endif
