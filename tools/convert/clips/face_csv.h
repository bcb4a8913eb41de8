/* face_csv.h: facial capture as a table: a row of weights for each frame, as Live Link Face and others write it.
 *
 * The first line names the columns, separated by ',' or ';'. A column Timecode (HOURS:MINUTES:SECONDS:FRAME, at 24, 25,
 * 30 or 60 frames a second, or a rate above) or Time (seconds) gives the time. Columns named as shapes of ARKit, in any
 * spelling that names.h knows, become scalars with ARKit's names; the others are left out, with a warning. Rows may be
 * missing: frames are interpolated between rows. */
#ifndef NOH_CONVERT_CLIPS_FACE_CSV_H
#define NOH_CONVERT_CLIPS_FACE_CSV_H

#include "raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A set without joints, with one clip named after the file. Returns 0 and *out, to be freed with raw_set_free, or 1 and
 * *error, whose `where` is a line number. */
int face_csv_read(const char *path, raw_set **out, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
