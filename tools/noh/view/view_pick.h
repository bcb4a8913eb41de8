/* view_pick.h: picking: a clicked point of a mesh, which then moves with its joint.
 *
 *   view_pick_at     under a point of the window
 *   view_pick_text   in words
 *   view_pick_point  where it is now */
#ifndef NOH_NOH_VIEW_VIEW_PICK_H
#define NOH_NOH_VIEW_VIEW_PICK_H

#include "view/view_model.h"
#include "noh/noh.h"

typedef struct view_pick {
    int is_on;
    uint32_t kind;
    noh_stage_hit hit;
    float local[3]; /* the point, in its joint or its actor */
} view_pick;

/* x, y: pixels of the canvas, y down. Nothing there: nothing is picked. */
void view_pick_at(view_pick *p, view_model *m, const orbit *o, float x, float y);

/* Mesh, submesh with its material, triangle, joint, point: "body, submesh 1 'skin', triangle 30, joint 'head', at ..."
 */
void view_pick_text(const view_pick *p, const view_model *m, char *text, size_t bytes);

void view_pick_point(const view_pick *p, const view_model *m, float point[3]);

#endif
