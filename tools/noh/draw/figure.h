/* figure.h: a pack on a stage, as the verbs use it: all its meshes, once, in the pose of its clips.
 *
 *   figure_plan            the bytes, without a driver; figure_open makes the stage; figure_close, figure_restore
 *   figure_bytes           of its plan, including the hair, which is drawn separately
 *   figure_reset           at rest: nothing plays, nothing is held; figure_set_look
 *   figure_play            a clip; figure_clip_seconds, figure_pause
 *   figure_hold            a morph target or named float; figure_hold_all, figure_hold_options
 *   figure_pose            a frame without a view, for the functions below
 *   figure_find_faces      find the eyes; figure_feel, figure_live: live faces
 *   figure_fall            push it: it falls, and gets up
 *   figure_idle_clip       how it stands without a clip
 *   figure_bounds          bounds of the pose; figure_anchor, figure_joints, figure_deform
 *   figure_look            a frame with a camera; figure_draw draws it; figure_view
 *   figure_views           the views of such a frame; figure_frame, figure_shade: the same in steps
 *
 * A figure has a kind of the stage for each skeleton of the pack, with one actor at the origin; the first kind also has
 * the meshes that no joint moves. For all else a verb uses figure.stage and figure.actors: steps, callback keys, fades,
 * detail.
 *
 * Functions that return an int print an error and return an exit code; 0 on success. A figure must not move in memory,
 * and its pack_files must outlive it. */
#ifndef NOH_NOH_DRAW_FIGURE_H
#define NOH_NOH_DRAW_FIGURE_H

#include "camera.h"
#include "cli/args.h"
#include "drawn_hair.h"
#include "figure_body.h"
#include "lighting.h"
#include "file/pack_file.h"
#include "gpu/gpu.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/marks.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#define FIGURE_HELD_ALL UINT32_MAX
#define FIGURE_ANIM_MAX 8u /* packs of clips */

/* All fields may be zero, except file. */
/* A mark: its place in the picture, 0 to 1 from the upper left corner; half its side, 0: a share of the
 * figure's height. */
typedef struct figure_mark {
    double x, y, size;
    uint8_t color[4];
} figure_mark;

typedef struct figure_desc {
    const pack_file *file;
    const pack_file *clips;      /* the pack with the clips; may be `file`. NULL: none */
    const pack_file *more_clips; /* [more_clip_count] more packs of clips; a later one's clip replaces one of
                                  * the same name */
    uint32_t more_clip_count;
    int face_layer;       /* 1: clips that move no joint play over those that do, as a face does */
    int alive;            /* 1: faces with eyes blink, look, breathe and show emotions */
    int without_springs;  /* 1: no springs: clips move their joints */
    int weight_rules;     /* 1: the pack's rules apply to all weights */
    uint32_t level;       /* the finest LOD level to use, numbered as by `noh info` */
    int by_error;         /* 1: levels are chosen by error, and fade; 0: always `level`, with all else in full */
    noh_lod_settings lod; /* how they are chosen; zeros: the defaults of low_stage.h */
    uint32_t actor_count; /* actors of each kind; 0: 1. Only the first of each is spawned */
    uint32_t track_count; /* clips at one time, 1..NOH_LAYER_TRACKS_MAX; 0: 2, so that one fades into another */
    const noh_layer_desc *layers; /* [layer_count] in place of one for all; they must outlive the figure */
    uint32_t layer_count;
    const char *graphs;        /* as in noh_kind_desc */
    uint32_t root_axes;        /* NOH_ROOT_* axes of root motion; y is up */
    uint32_t held_float_count; /* floats held at one time, FIGURE_HELD_ALL: all targets; 0: none */
    int inertia;               /* 1: room for NOH_PLAY_INERTIA */
    int falls;                 /* 1: its first skeleton can fall, onto the ground at a height of 0 */
    int pickable;              /* 1: noh_stage_pick finds it */
    int tangents;              /* 1: accumulators with tangents, even where no view shows them */
    noh_morph_path path;
    int sums; /* 1: of the path cpu in a texture, which layers are shown from */
    noh_accumulate accumulate;
    noh_debug_view view;
    noh_shading shading;
    figure_body *body; /* NULL: it looks ahead and stands as in its clips. Must outlive the figure, at one address */
    int stands;        /* 1: it stands as noh_stand_modifier does */
    const noh_modifier *drivers; /* [NOH_STAGE_KINDS_MAX] one of each kind, after its clips; NULL: none */
    int hair;                    /* 1: with the pack's hair, if any */
    int complexions;             /* 1: noh_appearance.user is a complexion */
    float wind[3];               /* wind in the hair, as in noh_hair_carrier */
    const figure_mark *marks;    /* [mark_count] for figure_strike; NULL: none. Must stay */
    uint32_t mark_count;
    int grown;       /* 1: marks are grown as triangles */
    lighting *light; /* NULL: the plain renderer's own. Must outlive the figure, at one address */
} figure_desc;

typedef struct figure {
    figure_desc desc;
    noh_stage_desc stage_desc;
    noh_kind_desc kinds[NOH_STAGE_KINDS_MAX];
    noh_layer_desc own_layers[2];                /* supported by all kinds */
    const noh_pack *packs[FIGURE_ANIM_MAX + 1u]; /* one layer per clip, if there are several */
    noh_kind_face faces[NOH_STAGE_KINDS_MAX];
    uint32_t faces_found; /* a bit for each kind */
    drawn_hair hair;
    noh_kind_stand stands[NOH_STAGE_KINDS_MAX]; /* of desc.stands */
    noh_modifier rest_parts[NOH_STAGE_KINDS_MAX]
                           [NOH_MODIFIERS_MAX]; /* of a kind: how it stands, its driver, the others */
    noh_modifier hair_parts[NOH_MODIFIERS_MAX]; /* of its kind: the others, then the hair */
    uint32_t *nodes;                            /* of all kinds, one after another */
    noh_stage_plan plan;
    /* of an open figure */
    gpu *g; /* NULL: nothing is drawn */
    void *memory, *shader_memory;
    noh_stage *stage;
    noh_stage_shader *shader; /* NULL: the library's own, lit */
    noh_backdrop backdrop;    /* zeros: no light */
    noh_stage_blob blob;      /* zeros: no spots under it */
    noh_stage_decals decals;  /* zeros: none */
    noh_decals rings[NOH_STAGE_KINDS_MAX];
    void *decal_memory;
    noh_stage_patches patches[NOH_STAGE_KINDS_MAX]; /* of desc.grown; zeros: none */
    void *patch_memory[NOH_STAGE_KINDS_MAX];
    noh_blob_rig blob_rigs[NOH_STAGE_KINDS_MAX];
    noh_stage_floor level; /* zeros: no shadow falls on a floor */
    int shows_floor;       /* 1: it casts one now */
    float floor;           /* y of the ground where the body has none */
    double height;         /* at rest */
    double facing;         /* of its first kind: pack_facing */
    noh_stage_view seen;   /* of figure_views */
    noh_actor actors[NOH_STAGE_KINDS_MAX];
    noh_appearance look; /* of all actors */
} figure;

/* --tier: full or phone. Returns an exit code. */
int figure_tier(const char *text, noh_shading *shading);

/* desc, stage_desc and plan alone.
 * caps  NULL: nothing is drawn, and packs of skeletons or clips alone are taken, too */
int figure_plan(figure *f, const figure_desc *desc, const noh_gl_caps *caps);
void figure_plan_free(figure *f); /* of a figure that is not opened */
/* The planned bytes: the stage and its hair, without lights, marks and debug views. */
void figure_bytes(const figure *f, uint64_t *cpu_bytes, uint64_t *gpu_bytes);

/* Whether a body casts a shadow on a floor, and at which height: from the start it does, at its feet. Only in a light
 * with a shadow map, and without a ground of its own (figure_desc.body). */
void figure_set_floor(figure *f, int on, float height);

/* g  NULL: nothing is drawn, as above */
int figure_open(figure *f, const figure_desc *desc, gpu *g);
void figure_close(figure *f);
/* Make everything again in a new context, with which g->gl was filled after the old one was lost. */
int figure_restore(figure *f);

/* The pack of --anim; path NULL: `file` itself. */
int figure_open_clips(pack_file *opened, const char *path, const pack_file *file, const pack_file **clips);
void figure_close_clips(pack_file *opened, const pack_file *clips);

/* The packs of several --anim. */
typedef struct figure_anims {
    pack_file files[FIGURE_ANIM_MAX];
    uint32_t count;
} figure_anims;

/* Into desc->clips and desc->more_clips; none given: `file` itself. Close them in any case. */
int figure_open_anims(figure_anims *a, const option_list *paths, const pack_file *file, figure_desc *desc);
void figure_close_anims(figure_anims *a);
/* Whether none of these clips (NULL: all) of desc->clips and desc->more_clips moves a joint, so that a body stands. */
int figure_rests(const figure_desc *desc, const option_list *clips);

/* 1 where a pack has meshes to draw. */
int figure_draws(const noh_pack *pack);
/* The LOD levels of a pack: how many, and the finest that it has, 0 but in a stripped pack. */
uint32_t figure_level_count(const noh_pack *pack);
uint32_t figure_level_first(const noh_pack *pack);
int figure_check_level(const pack_file *file, uint32_t level);
/* Counts of everything drawn at a level. */
uint32_t figure_triangles(const figure *f, uint32_t level);

int figure_reset(figure *f);
/* How all actors are drawn, from now on. */
int figure_set_look(figure *f, const noh_appearance *look);

/* Play a clip, by every kind that has it. play: as noh_actor_play, but at once where fade_ticks is 0. An unknown name
 * is an error that suggests the nearest. */
int figure_play(figure *f, const char *clip, const noh_play *play);
int figure_clip_seconds(const figure *f, const char *clip, double *seconds);
/* All --clip options together at this time. If springs swing, up to two seconds before it are played first. */
int figure_play_options(figure *f, const option_list *clips, double time_s);
/* Freeze all clips while the stage's clock runs: for fades of levels in one pose. */
void figure_pause(figure *f);

/* Hold a float of that name, in all kinds that have it. The same of all floats; --weight NAME=VALUE. */
int figure_hold(figure *f, const char *name, double value);
int figure_hold_all(figure *f, double value);
int figure_hold_options(figure *f, const option_list *assignments);
/* 0 if some mesh has the target. */
int figure_check_target(const pack_file *file, const char *name);

int figure_pose(figure *f);

/* Find a kind's eyes; 0: it has none. */
int figure_find_eyes(const noh_kind_desc *kind, noh_kind_face *face, noh_error *error);
/* A bit for each kind with a face, which needs eyes. */
uint32_t figure_find_faces(const noh_kind_desc *kinds, uint32_t kind_count, noh_kind_face *faces);
/* --feel EMOTION=AMOUNT, of all its faces. */
int figure_feel(figure *f, const option_list *emotions);
/* Advance clips, faces, hair and modifiers, 60 steps a second, while the figure turns about y, degrees a second, ending
 * where it stands without a turn. */
int figure_live(figure *f, double seconds, double turn);

/* The spots under a figure (--shadow blob, and where it stands on a floor or a ground): opened after the floor; drawn
 * before the figure. */
int figure_open_blobs(figure *f);
void figure_draw_blobs(figure *f);
int figure_open_floor(figure *f);
/* Put the floor at the lowest point of poses, if it is near. */
void figure_fit_floor(figure *f, double lowest);
void figure_draw_floor(const figure *f);

/* --decal X,Y[,SIZE[,RRGGBB]] and --decal-kind rest|grown. marks: [NOH_DECALS_MAX], that desc has afterwards */
int figure_read_marks(const option_list *texts, const char *kind, figure_mark *marks, figure_desc *desc);
/* The marks of a figure: opened, closed and restored with it; struck as seen by a camera; drawn over opaque meshes. */
int figure_open_decals(figure *f);
void figure_close_decals(figure *f);
noh_result figure_restore_decals(figure *f, char *log, size_t log_bytes, noh_error *error);
int figure_strike(figure *f, const noh_gl_camera *camera, uint32_t width, uint32_t height);
int figure_draw_decals(figure *f);

/* The first clip of joints with "idle" in its name; NULL: none. */
const char *figure_idle_clip(const noh_pack *pack);
/* How it stands (figure_desc.stands), called while its kinds are made. */
void figure_add_rest(figure *f);

/* The hair of a figure: planned, opened on a driver, updated after a frame. */
int figure_add_hair(figure *f);
/* In addition to the stage; 0 without hair. */
void figure_hair_bytes(const figure *f, uint64_t *cpu_bytes, uint64_t *gpu_bytes);
int figure_open_hair(figure *f);
void figure_update_hair(figure *f);

/* --push X,Y,Z, newton seconds. */
int figure_read_push(const char *text, float impulse[3]);
/* Whether a pack's first skeleton can fall, or why not. */
int figure_can_fall(const noh_pack *pack, noh_error *why);
/* Called while its kinds are made. */
void figure_want_fall(figure *f);
/* Advance: half a second in it is pushed at its chest and falls; once it lies still, it gets up by clips whose names
 * begin with get_up. */
int figure_fall(figure *f, const float impulse[3], double seconds);

/* The world bounds of the part of the pose that a camera frames, by the coarsest levels, whichever is shown: pictures
 * of all levels can be compared, also with a stripped pack. A face is what targets move, with room for its hair. */
bounds figure_bounds(const figure *f, view_frame frame);
/* 1 where a face is most of it. */
int figure_is_head(const figure *f);
/* A clip of a kind; NULL: it has none of this name. */
const noh_clip_entry *figure_clip(const figure *f, uint32_t kind, const char *name);
/* FRAME_FACE for `auto` while clips play that move no joints; otherwise `frame`. */
view_frame figure_framed(const figure *f, view_frame frame, const option_list *clips);
/* The first joint's place over the ground, which a camera follows. 0 without joints. */
void figure_anchor(const figure *f, double anchor[3]);
/* The joints of a kind: matrices[joint_count][12], by malloc; NULL: it has none. */
float *figure_joints(const figure *f, uint32_t kind, noh_skeleton *skeleton);
/* The vertices of a kind's mesh as posed, morphed and skinned on the CPU, of an LOD level or its coarsest: by malloc.
 * *mesh: that level; shown: where it is. NULL after printing an error. */
noh_vertex *figure_deform(const figure *f, uint32_t kind, uint32_t index, uint32_t level, noh_mesh *mesh,
                          noh_actor_mesh *shown);

/* A camera as a stage takes it. height: of the picture, pixels */
noh_stage_view figure_view(const noh_gl_camera *camera, uint32_t height);
/* The views of a frame: the camera and the light's shadow map, by the last pose. Returns their number. */
uint32_t figure_views(figure *f, const noh_gl_camera *camera, uint32_t height, noh_stage_view views[2]);
/* A frame with these views. */
int figure_frame(figure *f, const noh_stage_view *views, uint32_t view_count);
/* After a frame of these views: draw the shadow map, if there is one. */
int figure_shade(figure *f);
/* height: of the picture, pixels. Accumulates, and draws the shadow map: bind the framebuffer to draw into afterwards
 */
int figure_look(figure *f, const noh_gl_camera *camera, uint32_t height);
/* With the background. */
int figure_draw(figure *f);

/* "no clip named 'wlak' (did you mean 'walk'?)" */
int figure_fail_unknown(const char *subject, const char *kind, const char *name, const char *const *names,
                        size_t count);

#endif
