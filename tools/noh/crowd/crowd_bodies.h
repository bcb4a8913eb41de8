/* crowd_bodies.h: bodies of one pack, spread over a field, on a stage (noh.h), for `noh crowd` and `noh bench`. Each
 * has its own place, clip, phase and playback speed, and a clip of the face over it.
 *
 *   crowd_open      plan, make, place
 *   crowd_frame     a frame of the stage
 *   crowd_draw      draws the last frame's view
 *
 * The baseline, without LOD (crowd_options.plain), is the same stage with an error of a millionth of a pixel and a slot
 * of the finest level for every body: all joints, all targets, in every frame.
 *
 * Clips that end by themselves play ping-pong, so that every body keeps moving. Root motion on the ground is removed,
 * so that bodies stay in place. One unit of the pack is a metre; y is up. */
#ifndef NOH_NOH_CROWD_CROWD_BODIES_H
#define NOH_NOH_CROWD_CROWD_BODIES_H

#include "file/pack_file.h"
#include "gpu/gpu.h"
#include "draw/drawn_hair.h"
#include "draw/lighting.h"
#include "noh/gl_device.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#define CROWD_FIELD_M 100.0f /* radius of the field around the first camera */

typedef struct crowd_options {
    uint32_t count;                    /* bodies; 1..NOH_MORPH_INSTANCES_MAX */
    int plain;                         /* 1: without LOD */
    float pixels;                      /* the largest error on screen; default (0) 1 */
    uint64_t budget_ns;                /* of pose updates per frame; default (0) no limit */
    uint32_t width, height;            /* of the view, pixels; default (0) 1280 x 720 */
    uint32_t near_count, middle_count; /* as in noh_kind_desc */
    noh_debug_view view;
    const light_options *light; /* of view lit; "none" or default (NULL) one plain lamp */
    int spots;                  /* 1: soft spots under the bodies */
    int people;                 /* 1: each body has a size, clothes and, in packs with skin, a complexion of its own */
} crowd_options;

typedef struct crowd_events {
    uint64_t count, sum; /* sum of hashes of body, key and time: equal for the same events in any order */
} crowd_events;

/* A number of 0 to 1 for a person, another for each `which`. */
float crowd_share(uint32_t person, uint32_t which);
/* Of all of a person, 1 +- 6 %. */
float crowd_size(uint32_t person);
/* A person's colours: a pale tint for the materials that take one, and a complexion. */
noh_appearance crowd_look(uint32_t person);

/* NOH_USER_COMPLEXION for a pack with skin, 0 for others: of noh_stage_desc.user_values. */
int crowd_user_values(const noh_pack *pack);

/* Do not move it: the stage points into it. */
typedef struct crowd {
    crowd_options options; /* with the defaults filled in */
    noh_kind_desc kind;
    noh_stage_desc desc;
    noh_stage_plan plan;
    drawn_hair hair;
    noh_gl_ledger ledger; /* of all below but the backdrop */
    lighting light;       /* of options.light; name NULL: none */
    noh_backdrop backdrop;
    noh_gl_ledger behind; /* of the backdrop */
    noh_stage *stage;
    noh_stage_shader *shader; /* NULL: the library's, lit */
    void *memory, *shader_memory;
    noh_actor *actors;   /* [options.count] */
    noh_stage_blob blob; /* of options.spots */
    noh_blob_rig rig;
    noh_stage_view seen; /* of the last frame */
    crowd_events events; /* so far */
} crowd;

/* The pack must outlive the crowd. Prints an error and returns an exit code, with nothing left open; 0 on success. */
int crowd_open(crowd *c, gpu *g, const pack_file *file, const crowd_options *options);
void crowd_close(crowd *c);

/* A camera at `eye`; heading 0 looks along -z, down_rad tilts it down. */
noh_stage_view crowd_camera_at(const crowd *c, const float eye[3], float heading_rad, float down_rad);
/* 4 m above the middle of the field. */
noh_stage_view crowd_camera_start(const crowd *c);

/* With a GPU it also accumulates and uploads. */
void crowd_frame(crowd *c, uint32_t ticks, const noh_stage_view *view);
/* Draw into the current framebuffer and viewport. */
void crowd_draw(crowd *c);

#endif
