/* view_export.h: exports the picture, frame by frame at a fixed rate, as a film (file/film_file.h): one turn about
 * the figure, or the clips that play, once.
 *
 *   view_export_start, view_export_stop
 *   view_export_step   the seconds and the turn of the next frame; 0: no export is running
 *   view_export_frame  the picture that was drawn */
#ifndef NOH_NOH_VIEW_VIEW_EXPORT_H
#define NOH_NOH_VIEW_VIEW_EXPORT_H

#include "file/film_file.h"
#include "gpu/canvas.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VIEW_EXPORT_HZ_LEAST 5
#define VIEW_EXPORT_HZ_MOST 60
#define VIEW_EXPORT_TURN_S 4.0

typedef struct view_export {
    int is_on, turns; /* turns: 0: the camera stays */
    film film;
    uint32_t frames; /* all that it will have */
    uint8_t *rgba;
} view_export;

/* These print an error and return an exit code; 0 on success. */

/* seconds: how long the film is */
int view_export_start(view_export *e, const canvas *c, const char *path, uint32_t rate_hz, double seconds, int turns);
/* Ends it after its last frame. */
int view_export_frame(view_export *e, canvas *c);

int view_export_step(const view_export *e, double *seconds, double *radians);
/* Deletes the unfinished film. */
void view_export_stop(view_export *e);

#ifdef __cplusplus
}
#endif
#endif
