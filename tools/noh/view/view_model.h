/* view_model.h: the viewer's model: a pack, or a model converted in memory, ready to draw and to play.
 *
 *   view_model_open / view_model_close
 *   view_model_pose            the scene's weights and joints for this frame
 *   view_start, view_add, view_stop, view_stop_all, view_seek, view_step   its clips */
#ifndef NOH_NOH_VIEW_VIEW_MODEL_H
#define NOH_NOH_VIEW_VIEW_MODEL_H

#include "convert/lod/lod_levels.h"
#include "convert/base/byte_buffer.h"
#include "budget/level_costs.h"
#include "draw/scene_lod.h"
#include "draw/drawing.h"

/* A slider: all targets of one name. */
typedef struct view_target {
    const char *name;
    float value;
    int held; /* the slider was moved: clips do not change these weights until it is released */
} view_target;

/* A weight of the scene, and the slider that it belongs to. */
typedef struct view_weight {
    uint32_t target, item, index;
    float initial;
} view_weight;

typedef struct view_clip {
    const char *name;
    uint32_t player, clip;
    double seconds;
} view_clip;

typedef struct view_model {
    char path[1024];
    byte_buffer converted; /* the pack, where the file was a model */
    pack_file file;
    scene scene;
    drawing drawing;
    load_budget budget; /* parts NULL where bones are drawn: nothing is loaded then */
    level_costs costs;  /* count 0 where bones are drawn, 1 in a pack without LOD levels */
    scene_lod lod;
    float delta_max; /* how far one target moves a vertex at most, model units; over 0 */
    view_target *targets;
    view_weight *weights;
    view_clip *clips;
    uint32_t target_count, weight_count, clip_count;
} view_model;

typedef struct view_model_desc {
    const char *path;  /* a pack, or .gltf, .glb, .bvh, .rcl */
    const char *anim;  /* a pack whose clips are played instead; NULL: none */
    lod_settings lod;  /* LOD levels to convert a model with; level_count 0: none. A pack has its own */
    load_options load; /* `fades` is set by the model */
    int show_bones;
    uint32_t width, height; /* of the canvas */
} view_model_desc;

/* Prints an error (tool_last_failure has it) and returns an exit code; 0 and *out on success. */
int view_model_open(gpu *g, const view_model_desc *desc, view_model **out);
void view_model_close(view_model *m);

/* Remake the drawing with other options. On failure the old one stays. */
int view_model_reload(view_model *m, gpu *g, const view_model_desc *desc);

/* The context was lost: forget its object names. Then restore in another context, or close. */
void view_model_lost(view_model *m, gpu *g);
int view_model_restore(view_model *m, gpu *g);

/* The bounds of what is drawn, in its pose. */
bounds view_model_bounds(const view_model *m);

/* Weights are the asset's, overridden by clips, overridden by held sliders. */
void view_model_pose(view_model *m);

/* Play one clip alone, or beside those playing. Prints an error and returns an exit code when no track is free. */
int view_start(view_model *m, uint32_t clip);
int view_add(view_model *m, uint32_t clip);
void view_stop(view_model *m, uint32_t player, uint32_t track);
void view_stop_all(view_model *m);
/* Whether any track is on. */
int view_plays(const view_model *m);
/* Seek a track to a time of its clip without firing callbacks. */
void view_seek(view_model *m, uint32_t player, uint32_t track, double seconds);
/* Where a track is in its clip. */
double view_position(const view_model *m, uint32_t player, uint32_t track);
/* The name of a player's clip. */
const char *view_clip_name(const view_model *m, uint32_t player, uint32_t clip);

typedef struct view_passed {
    double clock_s;
    const char *clip, *key; /* of the pack */
    uint32_t track;
    float weight;
} view_passed;

typedef void (*view_event_fn)(void *user, const view_passed *event);

/* Advance time; fn gets every callback key that fires. */
void view_step(view_model *m, double seconds, view_event_fn fn, void *user);

#endif
