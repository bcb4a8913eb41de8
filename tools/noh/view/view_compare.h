/* view_compare.h: a second figure next to the first, at another LOD level or by another path, and where their
 * pictures differ.
 *
 *   view_compare_fit      opens and closes the second by `how`, before a frame
 *   view_compare_step, view_compare_pose, view_compare_draw   as the first
 *   view_compare_columns  the number of pictures side by side
 *
 * The second plays the same clips as the first, tick by tick. It does not fall when the first is pushed, and its face
 * is still. */
#ifndef NOH_NOH_VIEW_VIEW_COMPARE_H
#define NOH_NOH_VIEW_VIEW_COMPARE_H

#include "view/view_lod.h"
#include "view/view_setting.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum view_compare_with { VIEW_COMPARE_OFF, VIEW_COMPARE_LEVEL, VIEW_COMPARE_PATH } view_compare_with;

typedef struct view_compare_how {
    view_compare_with with;
    uint32_t level;
    noh_morph_path path;
} view_compare_how;

typedef struct view_compare {
    view_compare_how how, is; /* is: the open one */
    setting setting;
    const figure *beside; /* the first's, when it was opened */
    canvas canvas;
    int has_canvas;
    float gain;
    uint32_t differing, most; /* pixels that differ by more than 1 of 255, and by how much at most */
} view_compare;

uint32_t view_compare_columns(const view_compare *c);

/* These print an error and return an exit code; 0 on success. After an error it is off. */
int view_compare_fit(view_compare *c, const view_model *m, gpu *g, const view_model_desc *desc);
int view_compare_pose(view_compare *c, const view_model *m, const view_lod *shown, const noh_gl_camera *camera);
int view_compare_draw(view_compare *c, view_model *m, overlay *o, const view_over *over, const noh_gl_camera *camera);

/* Before the first is stepped by as much. */
void view_compare_step(view_compare *c, const view_model *m, uint32_t ticks);
void view_compare_close(view_compare *c);

#ifdef __cplusplus
}
#endif
#endif
