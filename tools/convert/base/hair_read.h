/* hair_read.h: a haircut as text: a skull, where hair grows on it, how it is combed and how it looks. One setting a
 * line, lengths in metres, angles in degrees (noh help FORMATS). */
#ifndef NOH_CONVERT_BASE_HAIR_READ_H
#define NOH_CONVERT_BASE_HAIR_READ_H

#include <stdint.h>

#include "convert/base/curves.h"
#include "convert/base/error.h"

#define HAIR_SPHERES_MAX 3u /* of a text; the skull takes up to five more */

typedef struct hair_text {
    char *joint;       /* NULL: the model itself */
    float skull[6];    /* centre, radii */
    float hairline[3]; /* angles from the crown in front, at the sides, behind */
    float comb[3];     /* direction */
    float length[2];   /* at the crown and at the hairline */
    float lift;        /* height of hair above the hair that grows behind it */
    float around, rows, points, strips, segments, seed;
    float width[2], curl[2], scatter;
    float root[3], tip[3]; /* sRGB colours */
    float gloss, pull[2], damping, gravity;
    float spheres[HAIR_SPHERES_MAX][4];
    uint32_t sphere_count;
    curve_list curves; /* count 0: hair is combed */
} hair_text;

/* 0, or 1 with *line and *error; free in both cases. */
int hair_read(const char *path, hair_text **out, uint32_t *line, model_error *error);
void hair_free(hair_text *hair);

#endif
