/* view_capture.h: a captured person moves the viewer's model, as the VMC protocol sends it over UDP (capture/vmc.h).
 *
 *   view_capture_open / view_capture_close
 *   view_capture_poll     take what has arrived; before each frame
 *   view_capture_forget   before another model or stage is opened: its floats are found again */
#ifndef NOH_NOH_VIEW_VIEW_CAPTURE_H
#define NOH_NOH_VIEW_VIEW_CAPTURE_H

#include <stdio.h>

#include "capture/vmc.h"
#include "capture/vmc_rig.h"
#include "noh/face.h"
#include "noh/modules.h"
#include "view/view_model.h"
#include "view/view_presets.h"

#ifdef __cplusplus
extern "C" {
#endif

struct view_capture;

typedef struct view_captured_kind {
    const struct view_capture *capture;
    uint32_t kind;
    vmc_rig rig;
} view_captured_kind;

/* How a value moves targets: one by its name, or the targets of two channels. NOH_NONE: none. */
typedef struct view_captured_value {
    uint32_t target, channels[2];
} view_captured_value;

typedef struct view_capture {
    int is_open, socket;
    char where[64]; /* the address and port */
    vmc vmc;
    noh_modifier drivers[NOH_STAGE_KINDS_MAX]; /* for view_model_desc */
    view_captured_kind kinds[NOH_STAGE_KINDS_MAX];
    const view_model *linked; /* the model that the rest is of; NULL: none yet */
    uint32_t linked_values;
    view_captured_value values[VMC_VALUES_MAX];
    noh_face_link links[VIEW_LINKS_MAX];
    uint32_t link_count;
    float *weights; /* [linked->target_count] */
    uint8_t *moved; /* [linked->target_count] 1: some value moves it */
} view_capture;

/* where  [ADDRESS:]PORT; without an address only this machine may send. Port 0: a free one. Prints where it listens, or
 * an error, and returns an exit code. The capture must not move in memory. */
int view_capture_open(view_capture *c, const char *where);
void view_capture_close(view_capture *c);

/* Prints an error and returns an exit code when the first damaged message arrives; 0 otherwise. */
int view_capture_poll(view_capture *c, view_model *m);
void view_capture_forget(view_capture *c);

/* A line of the state; nothing where none is open. */
void view_capture_print(const view_capture *c, FILE *out);

#ifdef __cplusplus
}
#endif
#endif
