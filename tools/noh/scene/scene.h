/* scene.h: what a pack shows: its meshes and skeletons in a pose, by weights and clips.
 *
 *   scene.c         nodes, meshes, LOD levels, weights
 *   scene_play.c    clips
 *   scene_deform.c  vertices on the CPU */
#ifndef NOH_NOH_SCENE_SCENE_H
#define NOH_NOH_SCENE_SCENE_H

#include "cli/args.h"
#include "file/pack_file.h"

/* Plays clips on one skeleton of the pack, or only on weights in a pack without skeletons: a clip bank, a controller
 * per copy of the scene, and memory for one pose at a time. */
typedef struct scene_player {
    noh_skeleton skeleton; /* joint_count 0: none */
    /* [joint_count][12] in model space, see local_to_model.h; the bind pose until a clip is set */
    float *joint_matrices;
    noh_clip_bank *bank;          /* NULL: not opened yet, or no clip fits */
    noh_controller **controllers; /* [controller_count] */
    uint32_t controller_count;
    noh_pose_scratch scratch;
    void *set_memory, *scratch_memory;
    noh_transform *pose;                              /* [joint_count] */
    float *floats;                                    /* [bank->clips.float_count] */
    uint64_t set_bytes, controller_bytes, pose_bytes; /* taken */
} scene_player;

/* One drawn mesh: a node that has one, with its weights. */
typedef struct scene_item {
    uint32_t node; /* index, or NOH_NONE when the pack has no nodes */
    uint32_t mesh;
    float *weights; /* [target_count of the mesh] */
} scene_item;

typedef struct scene {
    noh_mesh *meshes; /* [pack->mesh_count] */
    scene_item *items;
    uint32_t item_count;
    const pack_file *anim; /* whose clips are played: the pack's own, or that of --anim */
    pack_file anim_file;   /* --anim */
    scene_player *players; /* [player_count] one for each skeleton of the pack, at least one */
    uint32_t player_count;
    noh_skeleton skeleton; /* of the first one */
    const float *joint_matrices;
} scene;

/* Every node with a mesh (or every mesh, in a pack without nodes) at its default weights, every skeleton in its bind
 * pose. The pack must not move while the scene is used. */
int scene_init(scene *s, const pack_file *file);
void scene_free(scene *s);
/* Free what scene_open_players made; the skeleton stays. */
void scene_close_player(scene_player *p);
/* Use the clips of another pack (NULL: of the same one). Call it before any is played. */
int scene_open_anim(scene *s, const pack_file *file, const char *path);
/* Open the clips and this many controllers for each player. scene_set_clips opens one. */
int scene_open_players(scene *s, const pack_file *file, uint32_t controllers);
/* Pose by clips at a time, together: weights and joint matrices. An unknown name is an error that suggests the nearest.
 */
int scene_set_clips(scene *s, const pack_file *file, const option_list *names, double time_s);
/* Reset a player's first controller; pose the player's matrices and the scene's weights by it. */
int scene_reset_player(scene_player *p);
void scene_pose_player(scene *s, scene_player *p);

/* The palette of a skin in the scene's pose: matrices[the skin's joint_count][12]. */
void scene_skin_matrices(const scene *s, const noh_skin *skin, float *matrices);
/* The first `count` vertices of an item, morphed and skinned on the CPU, before its node's transform (scene_world).
 * Prints an error and returns an exit code; 0 on success. */
int scene_deform(const scene *s, uint32_t item, uint32_t count, noh_vertex *vertices);
/* NAME=VALUE, for every mesh with such a target; an unknown name is an error that suggests the nearest. */
int scene_set_weights(scene *s, const pack_file *file, const option_list *assignments);
/* "no clip named 'wlak' (did you mean 'walk'?)"; returns an exit code. */
int scene_fail_unknown(const pack_file *file, const char *kind, const char *name, const char *const *names,
                       size_t count);

/* The item's world matrix, 3 rows of 4. */
const float *scene_world(const scene *s, const pack_file *file, uint32_t item);

#endif
