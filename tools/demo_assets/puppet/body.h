/* The body: one closed surface, cut into a piece for each material and along the seams of the
 * texture only where the file format asks for it. */
#ifndef PUPPET_BODY_H
#define PUPPET_BODY_H

#include "cage.h"

#include <stdint.h>

enum { HELD_BY = 4 };

/* Four joints at most, the strongest first. The weights are whole multiples of 1/65536, so that
 * as floats too they sum to exactly 1. */
typedef struct {
    int joint[HELD_BY];
    double weight[HELD_BY];
} Grip;

typedef struct {
    int count, index_count;
    V3 *position, *normal, *colour;
    double *texture; /* two for each vertex */
    Grip *grip;
    uint32_t *indices;
} Piece;

typedef struct {
    Piece pieces[MATERIAL_COUNT];
} Body;

Body body_build(void);
void body_free(Body *body);
Grip grip_of(const Hold *hold);

/* The subdivided surface before it is cut; directions of its vertices; a piece of it; room for one of four-sided faces
 * with this many corners. */
Cage body_surface(void);
V3 *surface_normals(const Cage *surface);
Piece piece_build(const Cage *surface, const V3 *normals, const double *open, int material);
void piece_grab(Piece *piece, int corners);
void piece_free(Piece *piece);

#endif
