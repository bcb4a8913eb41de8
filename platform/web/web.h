/* web.h: shared by the files of the page's program. */
#ifndef NOH_PLATFORM_WEB_WEB_H
#define NOH_PLATFORM_WEB_WEB_H

#include "cast.h"
#include "context.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/gl_device.h"
#include "noh/light.h"
#include "noh/low_core.h"
#include "noh/marks.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#define WEB_PARTS_MAX 128u
#define WEB_CHARACTERS_MAX 16u
#define WEB_ACTORS_MAX (NOH_STAGE_KINDS_MAX * WEB_CHARACTERS_MAX)
#define WEB_PLAIN (-1) /* no environment: the plain renderer's own light */

/* A character has an actor for each of its skeletons. */
typedef struct web_figure {
    noh_actor actor;
    uint32_t kind, character;
} web_figure;

/* The floats of a name, moved by a slider. */
typedef struct web_target {
    const char *name;
    uint32_t figure, index; /* the first figure that has the float */
} web_target;

typedef enum web_shadow { WEB_SHADOW_OFF, WEB_SHADOW_MAP, WEB_SHADOW_SPOTS } web_shadow;

typedef struct web_light {
    int environment;                 /* WEB_PLAIN, or an index of noh_environment_at */
    float degrees;                   /* rotation of the environment */
    int shadow, tonemap, background; /* a web_shadow; a noh_tonemap; 1 + a noh_backdrop_kind, 0: plain */
    float color[4];                  /* of a plain background, premultiplied by its alpha */
    noh_light all;                   /* not turned */
    noh_lighting told;
    noh_backdrop backdrop;
    noh_stage_blob blob;    /* spots on the floor */
    noh_stage_floor ground; /* the shadow on the floor */
    int on_floor;           /* 1: the shadow falls on the floor */
    float sphere[4];        /* bounds of the shadow casters */
    noh_blob_rig rigs[NOH_STAGE_KINDS_MAX];
    float floor; /* height of the floor */
} web_light;

typedef struct web_hair {
    noh_actor_hair *heads; /* NULL: none */
    noh_stage_hair drawn;
    int off; /* 1: not shown */
    float wind[3];
    double shake_s; /* remaining time of the head shake */
} web_hair;

struct web {
    noh_platform_context *context;
    uint8_t *block; /* the memory after the pack */
    size_t block_bytes;
    noh_gl_api gl;
    noh_gl_caps caps;
    noh_gl_ledger ledger;
    noh_error error;
    noh_pack pack;
    web_cast cast;
    noh_stage *stage;
    noh_frame_clock clock; /* clock of the stage's steps */
    noh_stage_bytes parts[WEB_PARTS_MAX];
    uint32_t part_count;
    web_figure figures[WEB_ACTORS_MAX];
    uint32_t figure_count, character_count;
    web_target targets[NOH_TARGETS_MAX];
    uint32_t target_count;
    noh_stage_view view;
    noh_stage_hit hit;
    web_light light;
    web_hair hair;
    noh_fall falls[WEB_ACTORS_MAX];
    float facing;                      /* web_cast_facing */
    float bounds[6], from[3], spacing; /* from: position of the first character when bounds were measured */
    int32_t speed;                     /* playback speed, 1/65,536 */
    uint8_t smoothed;                  /* noh_appearance.smoothed of all figures */
    int elsewhere;                     /* 1: another renderer draws (vertices.c) */
    int calm;                          /* 1: nothing moves by itself */
    uint32_t level;                    /* 1 + the shown LOD level; 0: chosen by pixels */
};

extern struct web web;

/* The address at an offset of web.cast in the block. */
void *web_block(size_t at);

/* Load and probe the canvas's context. */
noh_result web_open_context(void);

/* Open the most complete pack received so far, and use the memory after it as the block. */
noh_result web_load(noh_pack *pack);

/* Create a stage. It replaces the previous one and continues its state. */
noh_result web_open_stage(const web_wants *wants);

/* Bake the environment into the block, before creating a stage lit by it. */
noh_result web_light_bake(void);
noh_result web_light_open(
    void); /* backdrop, spots and floor, after the stage is created; call web_light_close before it is deleted */
void web_light_close(void);
noh_result web_light_restore(void);
/* Set the second view of a frame, for the shadow map. Returns 0 if there are no shadows. */
int web_light_shadow(noh_stage_view *view);
void web_light_backdrop(void);
void web_light_spots(void);
void web_light_floor(void);      /* the shadow on the floor */
void web_light_find_floor(void); /* after measuring the figures at rest */

/* The hair of all characters, if the pack has hair: created after the stage, closed before it is deleted. */
noh_result web_hair_open(void);
void web_hair_close(void);
noh_result web_hair_restore(void);
void web_hair_update(void); /* after a frame */
void web_hair_shadow(void);
noh_result web_hair_draw(void); /* with the stage's color passes */
void web_hair_shake(double seconds);

/* Advance falls: fallen figures get up. */
noh_result web_rise(uint32_t ticks);

/* For noh_sin_cos_turn: libm's functions of an angle would take 2 kB of each program, compressed. */
static inline uint32_t web_turn(double turns)
{
    return (uint32_t)(int64_t)(turns * 4294967296.0);
}

/* Shared functions of main.c and touch.c, also called by the page. */
uint32_t web_joint_count(void);
float *web_measure(void);
int web_pick(float x, float y);

/* Mouth shapes, [NOH_VISEME_COUNT]; NULL: silence. */
void web_say(const float *visemes);

#endif
