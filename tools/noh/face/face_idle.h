/* face_idle.h: how often a live face stands still. */
#ifndef NOH_NOH_FACE_FACE_IDLE_H
#define NOH_NOH_FACE_FACE_IDLE_H

#include <stdint.h>

#include "cli/args.h"
#include "file/pack_file.h"

#define FACE_IDLE_RATE 30u /* pictures a second */

typedef enum face_region { FACE_OUTLINE, FACE_BROWS, FACE_LIDS, FACE_EYES, FACE_MOUTH, FACE_REGIONS } face_region;

extern const char *const face_region_names[FACE_REGIONS];

typedef struct face_idle_desc {
    const pack_file *file;
    double seconds;
    const option_list *anims, *clips, *feels; /* as in noh sheet; may be empty */
} face_idle_desc;

typedef struct face_idle {
    uint32_t pairs;               /* of one picture and the next */
    uint32_t still[FACE_REGIONS]; /* pairs in which no part of a region moves */
    int is_there[FACE_REGIONS];   /* 0: no target moves it, which leaves it out */
} face_idle;

/* Let the face of a pack live, with an emotion and while clips play, and compare each picture with the next, 512 pixels
 * high: a region moves where a vertex of it does by a fiftieth of a pixel, an outline where one of eight tangents does.
 * A region is what the targets of its channels move. Prints an error and returns an exit code; 0 on success. */
int face_idle_measure(const face_idle_desc *desc, face_idle *out);

#endif
