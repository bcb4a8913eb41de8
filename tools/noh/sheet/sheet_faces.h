/* sheet_faces.h: people by seed (face.h), one a tile. */
#ifndef NOH_NOH_SHEET_SHEET_FACES_H
#define NOH_NOH_SHEET_SHEET_FACES_H

#include "draw/figure.h"
#include "noh/face.h"
#include "noh/pack.h"

typedef struct sheet_faces {
    noh_identity identity;
    noh_mesh mesh;
    void *memory;
    float *weights;     /* [target_count] */
    const char **names; /* [target_count] */
} sheet_faces;

#define SHEET_FACES_SHOWN 6u /* at rest, and five expressions */

/* Of the first mesh that has targets; without identity targets, people differ by their colours alone. Prints an error and returns an exit code; 0 on success. */
int sheet_faces_open(sheet_faces *s, const pack_file *file);
void sheet_faces_close(sheet_faces *s);
/* Hold the weights of the person of a seed, at rest (0) or with an expression (below SHEET_FACES_SHOWN). */
int sheet_faces_hold(const sheet_faces *s, figure *f, uint32_t seed, uint32_t shown);
const char *sheet_faces_name(uint32_t shown);

#endif
