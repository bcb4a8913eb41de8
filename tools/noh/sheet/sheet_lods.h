/* sheet_lods.h: the LOD levels side by side. */
#ifndef NOH_NOH_SHEET_SHEET_LODS_H
#define NOH_NOH_SHEET_SHEET_LODS_H

#include "draw/picture.h"

typedef struct sheet_lods {
    const pack_file *file;
    const char *output, *camera, *driver;
    figure_desc figure;
    const option_list *faces; /* "NAME[=V][,NAME[=V]]...": a row each, below the one at rest; none: all targets with
                                 "smile" in their names */
    uint32_t tile;            /* pixels */
} sheet_lods;

/* A column for each level, finest first; a row at rest, one for each face, and one at rest at the size at which the
 * level is used: its largest error is one pixel there. Prints an error and returns an exit code; 0 on success. */
int sheet_lods_write(const sheet_lods *s);

/* Hold the targets of NAME[=V][,NAME[=V]]... */
int sheet_hold_face(figure *f, const char *face);

#endif
