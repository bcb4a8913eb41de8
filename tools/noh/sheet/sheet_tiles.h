/* sheet_tiles.h: the tiles of a contact sheet: targets, a clip in time, two clips blended,
 * a transition from one to another, people, wrinkle models. */
#ifndef NOH_NOH_SHEET_SHEET_TILES_H
#define NOH_NOH_SHEET_SHEET_TILES_H

#include "draw/figure.h"
#include "sheet_faces.h"
#include "sheet_wrinkles.h"
#include "noh/base.h"

#define SHEET_FALL_S 6.0    /* a push, a fall, and time to get up */
#define SHEET_BLEND_ROWS 5u /* weights 0, 1/4, 1/2, 3/4, 1 */

/* The contents of one tile. */
typedef struct sheet_target {
    char name[NOH_NAME_BYTES_MAX];
    double weight;
    double time_s; /* of a ping-pong; else 0 */
} sheet_target;

typedef struct sheet_tiles {
    const pack_file *file;
    option_list clips; /* the first sets the time, the others play along */
    option_list anims, emotions;
    int alive;                     /* faces live through the clip, or through `life_s`, from its beginning */
    int lives;                     /* the same of faces or bodies: clips are played from the beginning of each tile */
    const char *clip, *blend, *to; /* clip names; NULL: none */
    int inertia;                   /* the transition to `to`: 1 inertialization, 0 a cross-fade */
    double over_s;                 /* its duration */
    const char *push;              /* NULL: none */
    float impulse[3];              /* of it */
    double life_s;                 /* above 0: without a clip, faces live for so long */
    double clip_seconds;
    uint32_t clip_tiles;   /* columns in time */
    option_list only;      /* NAME or NAME=WEIGHT: targets to show instead of all */
    double half_s;         /* the only target goes there in so long, and back again; 0: it does not */
    sheet_target *targets; /* [target_count] */
    uint32_t target_count;
    uint32_t face_count, seed; /* people, of seeds from there on; 0: none */
    int expressions;           /* each in a row: at rest, and with expressions */
    sheet_faces faces;
    int wrinkled; /* the same expressions with the wrinkles of each model */
    sheet_wrinkles wrinkles;
} sheet_tiles;

/* The features that a figure needs for them. */
void sheet_tiles_want(const sheet_tiles *t, figure_desc *desc);
/* Find what was asked for. Prints an error and returns an exit code; 0 on success. */
int sheet_tiles_open(sheet_tiles *t, const pack_file *file);
void sheet_tiles_close(sheet_tiles *t);

/* The number of tiles; and of columns, where the content dictates it (else 0). */
uint32_t sheet_tiles_count(const sheet_tiles *t);
uint32_t sheet_tiles_columns(const sheet_tiles *t);

/* Look the clips up. */
int sheet_tiles_measure(sheet_tiles *t, const figure *f);
/* Put a figure into a tile's pose; after sheet_tiles_measure. */
int sheet_tiles_pose(const sheet_tiles *t, figure *f, uint32_t tile);
void sheet_tiles_label(const sheet_tiles *t, uint32_t tile, char *text, size_t bytes);

#endif
