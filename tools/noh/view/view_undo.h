/* view_undo.h: undo and redo of settings: held weights, drawing options, levels, light, floor; not the camera, and not
 * playback.
 *
 *   view_undo_note     after each frame: adds a step if a setting changed
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
    void *steps[VIEW_UNDO_MAX]; /* steps[at] holds the present settings */
    uint32_t count, at;
} view_undo_list;

struct view_app;

void view_undo_note(struct view_app *a);
/* Return 1 if there was a step. */
int view_undo(struct view_app *a);
int view_redo(struct view_app *a);
void view_undo_forget(view_undo_list *u);

#ifdef __cplusplus
}
#endif
#endif
