/* view_model.h: the viewer's model: a pack, or a model converted in memory, on a stage.
 *
 *   view_model_open / view_model_close
 *   view_model_reload          opens it again on another stage; clips keep playing
 *   view_model_step            time; view_model_hold: sliders; view_model_pose: a frame
 *   view_model_place, view_model_anchor, view_model_send_home   where it stands
 *   view_start, view_stop, view_stop_layer, view_stop_all, view_seek, ...   its clips (view_play.c) */
#ifndef NOH_NOH_VIEW_VIEW_MODEL_H
#define NOH_NOH_VIEW_VIEW_MODEL_H

#include "budget/pack_budget.h"
#include "convert/base/byte_buffer.h"
#include "draw/bones.h"
#include "draw/figure.h"
#include "draw/overlay.h"
#include "gpu/canvas.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

/* ---- drawing ---- */

/* A slider: the floats of that name. */
typedef struct view_target {
    const char *name;
    float value;
    int held;   /* the slider was moved: clips do not change these weights until it is released */
    int let_go; /* it was released, and the stage does not know yet */
    uint32_t floats[NOH_STAGE_KINDS_MAX]; /* of each kind; NOH_NONE: it has none */
} view_target;

typedef struct view_clip {
    const char *name;
    uint32_t clips[NOH_STAGE_KINDS_MAX]; /* of each kind's set; NOH_NONE: it cannot play it */
    double seconds;
} view_clip;

/* The layers of every kind. */
enum { VIEW_BODY, VIEW_PART, VIEW_FACE, VIEW_ADD, VIEW_LAYERS };
#define VIEW_BODY_TRACKS 8u
#define VIEW_OTHER_TRACKS 4u
extern const char *const view_layer_names[VIEW_LAYERS];

typedef struct view_model_desc {
    const char *path;       /* a pack, or a model that was converted */
    byte_buffer *converted; /* the pack of a model (view_load.h), taken over; NULL: the file is one */
    const char *anim;       /* a pack whose clips are played instead; NULL: none */
    const char *levels;     /* LOD levels to convert a model with, as noh build --lod; NULL: none */
    noh_morph_path morph_path;
    noh_accumulate accumulate;
    noh_debug_view view;
    int show_bones;
    int without_springs; /* springs of the pack do not swing */
    int weight_rules;    /* the pack's rules for weights are kept */
    int alive;           /* faces blink, breathe and look at the pointer */
    int root_motion;     /* clips move the figure over the ground */
    lighting *light;     /* NULL: the plain renderer's own */
    noh_shading shading;
    const noh_modifier *drivers; /* as in figure_desc */
    const char *part;       /* the layer "part" moves this joint of the first skeleton and all below; NULL, "": none */
    uint32_t width, height; /* of the canvas */
} view_model_desc;

/* The cost of each LOD level of the whole figure. */
typedef struct view_costs {
    level_cost levels[NOH_LOD_LEVELS_MAX];
    uint32_t first, count; /* the levels first to count - 1 are there */
} view_costs;

/* Drawn over the surface, or in its place. */
typedef enum view_skin { VIEW_SKIN_OFF, VIEW_SKIN_JOINTS, VIEW_SKIN_WEIGHTS } view_skin;
typedef struct view_over {
    view_skin skin;
    uint32_t joint; /* of VIEW_SKIN_WEIGHTS, of the first kind */
    int wireframe, normals, bones;
} view_over;

#define VIEW_PARTS_MAX 64u

typedef struct view_model {
    char path[1024];
    byte_buffer converted; /* the pack, where the file was a model */
    pack_file file, anim_file;
    const pack_file *clips_of; /* the packs with the clips */
    figure *figure;
    int root_motion;
    int has_graphs;                    /* actors may play the graphs of clips_of, in a figure with one kind */
    noh_frame_clock clock;             /* the rest of the frames' seconds below a tick */
    noh_error cannot_fall;             /* OK: the first skeleton can */
    int touched;                       /* a track was changed by hand: pose it even if time stands still */
    bones *bones[NOH_STAGE_KINDS_MAX]; /* of each kind with joints */
    int show_bones;
    canvas canvas;
    int has_canvas;
    view_costs costs; /* count 0 where bones are drawn, 1 in a pack without LOD levels */
    noh_stage_bytes parts[VIEW_PARTS_MAX];
    uint32_t part_count;
    noh_gl_morph_plan morph_plan; /* of the first mesh with targets */
    int is_morphed;
    float delta_max; /* how far one target moves a vertex at most, model units; over 0 */
    float *floats;   /* [the most of any kind's set] for view_model_anchor */
    view_target *targets;
    view_clip *clips;
    uint32_t target_count, clip_count;
} view_model;

/* Prints an error (tool_last_failure has it) and returns an exit code; 0 and *out on success. */
int view_model_open(gpu *g, const view_model_desc *desc, view_model **out);
void view_model_close(view_model *m);

/* Another stage by other options; tracks, places and sliders stay. On failure the old one stays. */
int view_model_reload(view_model *m, gpu *g, const view_model_desc *desc);

/* The context was lost: forget its object names. Then restore in another context, or close. */
void view_model_lost(view_model *m, gpu *g);
int view_model_restore(view_model *m, gpu *g);

/* Another size of the canvas. */
int view_model_fit(view_model *m, gpu *g, uint32_t width, uint32_t height);

/* The bounds of the drawn figure in its pose. */
bounds view_model_bounds(const view_model *m);

/* ---- where it stands ---- */

noh_place view_model_place(const view_model *m);
/* The camera's target: the first joint's next place over the ground. */
void view_model_anchor(view_model *m, double anchor[3]);
/* Back to the origin. */
void view_model_send_home(view_model *m);

/* ---- a frame ---- */

/* Send held sliders to the stage, and set the others from the last pose. */
void view_model_hold(view_model *m);
/* A frame up to its GPU work: prints an error and returns an exit code; 0 on success. noh_stage_frame_end follows. */
int view_model_pose(view_model *m, const noh_gl_camera *camera, int cut);
int view_model_draw(view_model *m, canvas *c, overlay *o, const view_over *over, const noh_gl_camera *camera);
void view_model_draw_bones(view_model *m, const noh_gl_camera *camera);

/* ---- its clips ---- */

/* How the next clip is played. */
typedef struct view_how {
    uint32_t layer; /* 1 + a layer; 0: the face for clips without joints, else the body */
    float fade_s, weight, speed;
    noh_loop loop;
    uint32_t sync_group;
    int inertia;
} view_how;

/* Play a clip on its layer, in place of the clips there or in addition to them. Prints an error and returns an exit
 * code if no track is free. */
int view_start(view_model *m, uint32_t clip, const view_how *how, int beside);
void view_stop_track(view_model *m, uint32_t kind, uint32_t track);
void view_stop_layer(view_model *m, uint32_t layer, float fade_s);
void view_stop_all(view_model *m);
/* Whether any track is on. */
int view_plays(const view_model *m);
/* A kind's controller, and its set. */
noh_controller *view_controller(const view_model *m, uint32_t kind, const noh_clip_set **set);
uint32_t view_layer_of(uint32_t track);
/* Whether a track plays a clip: 0 if it stands for a graph. */
int view_clip_of(const view_model *m, uint32_t kind, const noh_track *track);
const char *view_clip_name(const view_model *m, uint32_t kind, uint32_t clip);
/* These take effect at once, also while nothing moves. */
void view_set_weight(view_model *m, uint32_t kind, uint32_t track, float weight);
void view_set_speed(view_model *m, uint32_t kind, uint32_t track, float speed);
void view_set_mode(view_model *m, uint32_t kind, uint32_t track, noh_track_mode mode);
/* Seek a track to a time of its clip without firing callbacks. */
void view_seek(view_model *m, uint32_t kind, uint32_t track, double seconds);
/* The track of a layer that was started last. */
void view_seek_newest(view_model *m, uint32_t kind, uint32_t layer, double seconds);
/* Where a track is in its clip. */
double view_position(const view_model *m, uint32_t kind, uint32_t track);
/* Change to another weight or speed within this time, seconds. */
int view_ramp(view_model *m, uint32_t kind, uint32_t track, noh_change_kind what, float to, float seconds);

/* ---- graphs ---- */

/* Play the n-th graph of clips_of on the body; the one that plays, NOH_NONE: none. Prints an error and returns an exit
 * code. */
int view_graph_play(view_model *m, uint32_t n, float fade_s);
uint32_t view_graph_playing(const view_model *m);
/* A parameter of the graph that plays, by noh_stage_find. */
float view_graph_parameter(const view_model *m, uint32_t parameter);
void view_graph_set(view_model *m, uint32_t parameter, float value);

/* ---- time ---- */

typedef struct view_passed {
    double clock_s;
    const char *layer, *clip, *key; /* of the pack */
    float weight;
} view_passed;

typedef void (*view_event_fn)(void *user, const view_passed *event);

/* Advance time; fn gets every callback key that fires. */
void view_step(view_model *m, uint32_t ticks, view_event_fn fn, void *user);

#endif
