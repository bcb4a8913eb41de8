/* view_undo.h: what was set, step by step, to go back to and forth: held weights, what is drawn, levels, light, floor.
 * Not the camera, and not what plays.
 *
 *   view_undo_note     after each frame: a step where something was set since
 *   view_undo, view_redo
 *   view_undo_forget   with another model */
#ifndef NOH_NOH_VIEW_VIEW_UNDO_H
#define NOH_NOH_VIEW_VIEW_UNDO_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VIEW_UNDO_MAX 100u

typedef struct view_undo_list {
    void *steps[VIEW_UNDO_MAX]; /* steps[at] is what is set now */
    uint32_t count, at;
} view_undo_list;

struct view_app;

void view_undo_note(struct view_app *a);
/* Return 1 where there was a step. */
int view_undo(struct view_app *a);
int view_redo(struct view_app *a);
void view_undo_forget(view_undo_list *u);

#ifdef __cplusplus
}
#endif
#endif
