/* noh_tool.h: what the verbs of the command line program share.
 *
 * Exit codes: 0, 1 (the input or the check failed), 2 (usage). Errors go to
 * stderr as "noh: FILE: what is wrong (where)". */
#ifndef NOH_TOOL_H
#define NOH_TOOL_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "noh.h"
#include "platform.h"

#define EXIT_FAILED 1
#define EXIT_USAGE 2

/* ---- messages ---- */

/* Print "noh: subject: text" and return EXIT_FAILED. */
int tool_fail(const char *subject, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 2, 3)))
#endif
    ;
/* The text of the last one, cut to fit; "" before any. */
const char *tool_last_failure(void);
/* Print "noh: text" and a pointer to `noh help`; return EXIT_USAGE. */
int tool_usage(const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 1, 2)))
#endif
    ;
/* The library's error as a message about `subject`. */
int tool_fail_error(const char *subject, const noh_error *error);

/* ---- arguments ---- */

typedef enum option_kind { OPTION_FLAG, OPTION_TEXT, OPTION_NUMBER, OPTION_SIZE, OPTION_LIST } option_kind;

#define OPTION_LIST_MAX 1024

typedef struct option_list {
    const char *items[OPTION_LIST_MAX];
    int count;
} option_list;

/* One option of a verb; `value` is an int (FLAG), const char * (TEXT), double
 * (NUMBER), uint32_t[2] (SIZE, as 512x512) or option_list (LIST, may repeat). */
typedef struct option {
    const char *name; /* "--size" */
    option_kind kind;
    void *value;
} option;

/* Read a verb's arguments. Positional ones go into `files` (up to file_max).
 * Returns 0, or EXIT_USAGE after printing what is wrong. */
int tool_options(int argc, char **argv, const option *options, int option_count, const char **files, int file_max, int *file_count);

/* A float out of text; 0 if all of it was one finite number. */
int tool_number(const char *text, double *value);

/* --lod: a whole number from 0, the full mesh. Returns an exit code. */
int parse_level(double value, uint32_t *level);
/* --lod of what converts: auto, or how many levels with the full one. Returns an exit code. */
int parse_levels(const char *text, uint32_t *count, int *by_error);

/* ---- files ---- */

typedef struct pack_file {
    const char *path;
    noh_file file;
    noh_pack pack;
} pack_file;

/* Map and open a pack; prints the error and returns an exit code, 0 on success. */
int pack_file_open(pack_file *file, const char *path);
void pack_file_close(pack_file *file);

/* Write a picture, atomically. rgba[height][width][4], top row first. */
int tool_write_png(const char *path, uint32_t width, uint32_t height, const uint8_t *rgba);

/* ---- JSON on stdout ---- */

typedef struct json {
    FILE *out;
    int depth, first;
} json;

json json_begin(FILE *out);
void json_open(json *j, const char *key, char bracket); /* '{' or '['; key NULL inside arrays */
void json_close(json *j, char bracket);
void json_text(json *j, const char *key, const char *value);
void json_number(json *j, const char *key, double value);
void json_integer(json *j, const char *key, uint64_t value);
void json_bool(json *j, const char *key, int value);
void json_null(json *j, const char *key);
void json_end(json *j);

/* ---- names ---- */

/* The candidate nearest to `name` by edit distance, or NULL when none is near. */
const char *nearest_name(const char *name, const char *const *candidates, size_t count);

/* What the n-th clip of a pack says of itself; prints an error about a broken one and returns an exit code. */
int tool_clip_info(const pack_file *file, uint32_t index, noh_pack_motion *motion, noh_clip_info *info);
double tool_clip_seconds(const noh_clip_info *info);

/* ---- the pose that the options ask for ---- */

/* What moves one skeleton of the pack (without any: its weights alone): a motion set, a controller for each copy of the
 * scene, and room for one pose at a time. */
typedef struct scene_player {
    noh_skeleton skeleton;       /* joint_count 0: none */
    float *joint_matrices;       /* [joint_count][12] in model space, see local_to_model.h; the bind pose until a clip is set */
    noh_motion_set *set;         /* NULL: not opened yet, or no clip fits */
    noh_controller **controllers; /* [controller_count] */
    uint32_t controller_count;
    noh_pose_scratch scratch;
    void *set_memory, *scratch_memory;
    noh_transform *pose;         /* [joint_count] */
    float *floats;               /* [set->anim.float_count] */
    uint64_t set_bytes, controller_bytes, pose_bytes; /* taken */
} scene_player;

/* One drawn mesh: a node that has one, with its weights. */
typedef struct scene_item {
    uint32_t node; /* index, or NOH_NONE when the pack has no nodes */
    uint32_t mesh;
    float *weights; /* [target_count of the mesh] */
} scene_item;

typedef struct scene {
    noh_mesh *meshes;   /* [pack->mesh_count] */
    scene_item *items;
    uint32_t item_count;
    const pack_file *anim;    /* whose clips are played: the pack's own, or that of --anim */
    pack_file anim_file;      /* --anim */
    scene_player *players;    /* [player_count] one for each skeleton of the pack, at least one */
    uint32_t player_count;
    noh_skeleton skeleton;    /* of the first one */
    const float *joint_matrices;
} scene;

/* Every node with a mesh (or every mesh, in a pack without nodes) at its default weights, every skeleton in its bind pose.
 * The pack must stay where it is while the scene is used. */
int scene_init(scene *s, const pack_file *file);
void scene_free(scene *s);
/* Take every mesh at a level of detail, or its coarsest; an error where no mesh has that many. */
int scene_set_level(scene *s, const pack_file *file, uint32_t level);
uint32_t scene_level_count(const scene *s, const pack_file *file);
/* What a player opened; its skeleton stays. */
void scene_close_player(scene_player *p);
/* Take the clips from another pack (NULL: do not); before any of them is played. */
int scene_open_anim(scene *s, const pack_file *file, const char *path);
/* Open the clips, and so many controllers. scene_set_clips does it for one. */
int scene_open_players(scene *s, const pack_file *file, uint32_t controllers);
/* What that will take, before; add to *clips, *controllers, *poses. */
int scene_measure_players(const scene *s, const pack_file *file, uint32_t controllers, uint64_t *clips, uint64_t *controller_bytes,
                          uint64_t *poses);
/* How many decoded segments the clips then hold at once, of how many in all. */
void scene_measure_segments(const scene *s, const pack_file *file, uint32_t controllers, uint32_t *held, uint32_t *all);
/* Weights and joint matrices of clips at a time, together; unknown names are an error that suggests the nearest. */
int scene_set_clips(scene *s, const pack_file *file, const option_list *names, double time_s);
/* A player's first controller as it was made; its pose, to its matrices and the scene's weights. */
int scene_reset_player(scene_player *p);
void scene_pose_player(scene *s, scene_player *p);

typedef enum scene_mix { SCENE_MIX_BLEND, SCENE_MIX_FADE, SCENE_MIX_INERTIA } scene_mix;

/* Two clips of one skeleton at once. */
typedef struct scene_pair {
    const char *from, *to;
    scene_mix mix;
    double weight; /* BLEND: of `to`, 0..1 */
    double lead_s; /* FADE, INERTIA: how long `from` plays alone */
    double over_s; /* and how long the transition takes */
} scene_pair;

/* time: the phase of both, 0..1, of a blend; else seconds from the start of `from`. */
int scene_set_pair(scene *s, const pack_file *file, const scene_pair *pair, double time);
/* A clip's length; an error likewise. */
int scene_clip_seconds(scene *s, const pack_file *file, const char *clip_name, double *seconds);
/* What moves the vertices of a skin's meshes, as the scene stands: matrices[the skin's joint_count][12]. */
void scene_skin_matrices(const scene *s, const noh_skin *skin, float *matrices);
/* The first `count` vertices of an item as they are drawn, on the CPU, before its node's placement (scene_world).
 * Prints an error and returns an exit code; 0 on success. */
int scene_deform(const scene *s, uint32_t item, uint32_t count, noh_vertex *vertices);
/* NAME=VALUE for every mesh that has such a target; suggests the nearest name otherwise. */
int scene_set_weights(scene *s, const pack_file *file, const option_list *assignments);
/* 0 when some mesh has the target; prints an error with the nearest name otherwise. */
int scene_check_target(const scene *s, const pack_file *file, const char *name);
/* "no clip named 'wlak' (did you mean 'walk'?)"; returns an exit code. */
int scene_fail_unknown(const pack_file *file, const char *kind, const char *name, const char *const *names, size_t count);

/* ---- verbs ---- */

int verb_build(int argc, char **argv);
int verb_clip(int argc, char **argv);
int verb_info(int argc, char **argv);
int verb_budget(int argc, char **argv);
int verb_render(int argc, char **argv);
int verb_sheet(int argc, char **argv);
int verb_zoom(int argc, char **argv);
int verb_dump(int argc, char **argv);
int verb_verify(int argc, char **argv);
int verb_crowd(int argc, char **argv);
int verb_bench(int argc, char **argv);
int verb_view(int argc, char **argv);

#endif
