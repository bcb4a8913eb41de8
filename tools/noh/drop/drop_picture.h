/* drop_picture.h: what falls, as shaded capsules over a floor: tiles of a strip, drawn by rays on the CPU. */
#ifndef NOH_NOH_DROP_DROP_PICTURE_H
#define NOH_NOH_DROP_DROP_PICTURE_H

#include "drop_scene.h"

#define DROP_TILES 5u

typedef struct drop_picture {
    uint32_t side, drawn; /* pixels of a tile, tiles that are drawn */
    uint8_t *rgba;        /* [side][DROP_TILES * side][4] */
} drop_picture;

int drop_picture_open(drop_picture *p, uint32_t side); /* 0 on success */
void drop_picture_close(drop_picture *p);

/* The next tile. */
void drop_picture_draw(drop_picture *p, const drop_scene *s);

#endif
