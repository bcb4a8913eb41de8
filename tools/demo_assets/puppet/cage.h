/* The cage: a coarse closed surface of four-sided faces that is grown ring by ring, and that
 * subdivision turns into the body. Joint weights of vertices and paints of faces are set here once; weights become
 * smooth with the surface. */
#ifndef PUPPET_CAGE_H
#define PUPPET_CAGE_H

#include "joints.h"
#include "paint.h"

/* How much each joint holds a vertex; the sum is 1. */
typedef struct {
    double by[JOINT_COUNT];
} Hold;

typedef struct {
    V3 at;
    Hold hold;
} CageVertex;

typedef struct {
    int corner[4]; /* counter-clockwise from outside */
    double u[4], v[4];
    Paint paint;
} CageFace;

typedef struct {
    int vertex_count, vertex_space, face_count, face_space;
    CageVertex *vertices;
    CageFace *faces;
    int mirrored; /* faces that are added now run the other way round */
} Cage;

/* A rectangle of the texture: what a part's rings and rows are spread over. */
typedef struct {
    double u, v, wide, high;
} Chart;

enum { CAP_SIDE_MAX = 4 };

Hold hold_one(int joint);
Hold hold_mix(Hold a, Hold b, double k);

int cage_vertex(Cage *cage, V3 at, Hold hold);
void cage_face(Cage *cage, const CageFace *face);

/* Faces between two rings of `count` vertices, which run counter-clockwise seen from where
 * `high` lies. row, rows: where the band lies in the chart. paints: one for each face. */
void cage_band(Cage *cage, const int *low, const int *high, int count, Chart chart, const double row[2],
               const Paint *paints);

/* Closes a ring of 4 * side vertices (side up to CAP_SIDE_MAX) with side x side faces; `first`
 * is a corner of that square. The inner vertices are pushed out by `bulge`. */
void cage_cap(Cage *cage, const int *ring, int side, int first, V3 bulge, Chart chart, Paint paint);

void cage_free(Cage *cage);

#endif
