/* view_fall.h: pushes: the first figure falls, gets up, and resumes its clips.
 *
 *   view_fall_push    where it was clicked, or at its chest
 *   view_fall_step    before time moves on
 *   view_fall_lasts   whether the fall is still going on */
#ifndef NOH_NOH_VIEW_VIEW_FALL_H
#define NOH_NOH_VIEW_VIEW_FALL_H

#include "noh/modules.h"
#include "view/view_pad.h"
#include "view/view_pick.h"

typedef struct view_fall {
    noh_fall fall;
    uint32_t clip, graph;   /* the body's clip that played when it began to get up; NOH_NONE: none */
    uint32_t rise;          /* the clip by which it gets up */
    int had_pad, has_risen; /* has_risen: it resumes them */
} view_fall;

/* These print an error and return an exit code; 0 on success. */

/* pick: what was hit; NULL: its chest. eye[3]: away from it */
int view_fall_push(view_model *m, const view_pick *pick, const float eye[3]);
int view_fall_step(view_fall *f, view_model *m, view_pad *pad, uint32_t ticks);

int view_fall_lasts(const view_fall *f, const view_model *m);

#endif
