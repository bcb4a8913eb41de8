/* figure_body.h: figures that look at a point, and stand on stairs, a slope or terrain, which are drawn. */
#ifndef NOH_NOH_DRAW_FIGURE_BODY_H
#define NOH_NOH_DRAW_FIGURE_BODY_H

#include "gpu/gpu.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/modules.h"
#include "noh/noh.h"

#include "file/ground_file.h"

#define FIGURE_STEPS 14u

/* --look-at and --ground. */
typedef struct body_options {
    const char *look_at, *ground; /* NULL: not given */
} body_options;

typedef struct figure_body {
    int looks;
    float point[3];   /* world */
    int has_ground;   /* 1: stairs, a slope or terrain */
    const char *name; /* of the ground */
    noh_world world;
    noh_plane planes[1];
    noh_obb boxes[FIGURE_STEPS];
    ground_file land; /* without heights: none */
    noh_field field;
    float metre; /* in the pack's unit */
    /* of each kind */
    noh_gaze_rig gazes[NOH_STAGE_KINDS_MAX];
    noh_kind_face faces[NOH_STAGE_KINDS_MAX]; /* where no joint turns: eyes that targets turn */
    int has_faces;
    noh_kind_feet feet[NOH_STAGE_KINDS_MAX];
    noh_modifier parts[NOH_STAGE_KINDS_MAX][2];
    /* the drawn ground; zeros: none */
    gpu *g;
    GLuint program, vertex_array, buffer;
    uint32_t corners;
} figure_body;

/* Parse the options. *wanted: whether any is given. Prints an error and returns an exit code; 0 on
 * success. */
int figure_body_parse(const body_options *o, figure_body *b, int *wanted);
void figure_body_free(figure_body *b); /* in any case */

/* Give each kind the modifiers for its skeleton. Prints an error and returns an exit code if no kind supports the
 * options. */
int figure_body_add(figure_body *b, const char *file, noh_kind_desc *kinds, uint32_t kind_count);

/* The height of the ground under a point; 0 without one. */
float figure_body_height(const figure_body *b, const float at[3]);

/* Each actor looks, and stands on the ground. */
int figure_body_place(const figure_body *b, noh_stage *stage, const noh_kind_desc *kinds, const noh_actor *actors,
                      uint32_t kind_count);

int figure_body_open_gl(figure_body *b, gpu *g);
void figure_body_close_gl(figure_body *b);
void figure_body_draw(const figure_body *b, const noh_stage_view *seen);

#endif
