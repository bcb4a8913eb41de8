/* place_scene.h: a place (place_file.h) on a stage: its agents as characters of a pack, on its ground and steps.
 * place_draw.h draws pictures of it, and a web page shows it.
 *
 *   place_scene_open     plan, make, place
 *   place_scene_step     1/30 s
 *   place_scene_show     pose and upload the actors in a view
 *   place_scene_shadow   draw its shadows, into a map
 *   place_scene_draw     draw it, into the current framebuffer and viewport */
#ifndef NOH_NOH_CROWD_PLACE_SCENE_H
#define NOH_NOH_CROWD_PLACE_SCENE_H

#include "draw/drawn_hair.h"
#include "draw/lighting.h"
#include "file/pack_file.h"
#include "gpu/gpu.h"
#include "place_life.h"
#include "place_people.h"
#include "noh/crowd.h"
#include "noh/gl_device.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

/* A push: bodies within `radius` metres of x, z fall away from that point. */
typedef struct place_hit {
    int is_given;
    float time_s, at[2], radius, impulse; /* newton seconds */
} place_hit;

typedef struct place_draw_options {
    uint32_t agents, seed;
    float pixels;        /* the largest error of LOD levels */
    double time_s;       /* when the first picture is taken */
    uint32_t count;      /* of pictures, 1 or more, */
    double apart_s;      /* seconds from one picture to the next */
    const char *camera;  /* "AZ,EL,DIST[,X,Z]": about the place's middle, or about X, Z; NULL: over the whole place */
    const char *scenery; /* a pack drawn where it is; NULL: none */
    light_options light;
    uint32_t width, height;
    place_hit hit;
    int encode_srgb; /* 1: the target does not */
} place_draw_options;

enum { PLACE_PEOPLE, PLACE_SCENERY, PLACE_KINDS };

/* Do not move it: the stage points into it. */
typedef struct place_scene {
    const pack_file *file;
    const place_file *place;
    const place_draw_options *options;
    place_life *life;
    lighting light;
    noh_stage_view shadow_view;
    pack_file scenery;
    noh_kind_desc kinds[PLACE_KINDS];
    place_people people;
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_gl_ledger ledger;
    noh_stage *stage;
    noh_walkers *walkers;
    void *memory, *walkers_memory;
    noh_backdrop backdrop;
    noh_stage_floor floor;     /* where the place has neither scenery nor ground */
    noh_stage_terrain terrain; /* drawn where the place has a ground */
    void *terrain_memory;
    drawn_hair hair;
    noh_actor *actors;
    noh_smart_phase *phases; /* as they are shown */
    size_t walkers_bytes;
    uint32_t near_count, step, fell, down;
} place_scene;

/* file, place and options must outlive it. Prints an error and returns an exit code, 0 on success; close it then, too.
 */
int place_scene_open(place_scene *s, gpu *g, const pack_file *file, const place_file *place,
                     const place_draw_options *o);
void place_scene_close(place_scene *s);

/* Advance by 1/30 s: the agents' decisions, walking and clips. */
void place_scene_step(place_scene *s);

/* Prepare the view for the next draws. Functions that draw print an error and return an exit code; 0 on success. */
int place_scene_show(place_scene *s, const noh_stage_view *view);
int place_scene_shadow(place_scene *s, const noh_stage_view *view);
int place_scene_draw(place_scene *s, const noh_stage_view *view);

/* The height of the ground there; 0 without a ground. */
float place_scene_height(const place_file *place, const float at[2]);

#endif
