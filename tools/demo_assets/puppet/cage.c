#include "cage.h"

#include "shared/grab.h"

#include <stdlib.h>

Hold hold_one(int joint)
{
    Hold hold = { { 0 } };
    hold.by[joint] = 1;
    return hold;
}

Hold hold_mix(Hold a, Hold b, double k)
{
    for (int i = 0; i < JOINT_COUNT; i++) {
        a.by[i] = mix(a.by[i], b.by[i], k);
    }
    return a;
}

int cage_vertex(Cage *cage, V3 at, Hold hold)
{
    if (cage->vertex_count == cage->vertex_space) {
        cage->vertex_space = cage->vertex_space ? 2 * cage->vertex_space : 256;
        cage->vertices = grab(cage->vertices, cage->vertex_space, (int)sizeof *cage->vertices);
    }
    cage->vertices[cage->vertex_count].at = at;
    cage->vertices[cage->vertex_count].hold = hold;
    return cage->vertex_count++;
}

void cage_face(Cage *cage, const CageFace *face)
{
    if (cage->face_count == cage->face_space) {
        cage->face_space = cage->face_space ? 2 * cage->face_space : 256;
        cage->faces = grab(cage->faces, cage->face_space, (int)sizeof *cage->faces);
    }
    CageFace *added = &cage->faces[cage->face_count++];
    *added = *face;
    for (int i = 0; i < 4 && cage->mirrored; i++) {
        added->corner[i] = face->corner[3 - i];
        added->u[i] = face->u[3 - i];
        added->v[i] = face->v[3 - i];
    }
}

void cage_band(Cage *cage, const int *low, const int *high, int count, Chart chart, const double row[2],
               const Paint *paints)
{
    for (int i = 0; i < count; i++) {
        int next = (i + 1) % count;
        double u0 = chart.u + chart.wide * i / count, u1 = chart.u + chart.wide * (i + 1) / count;
        double v0 = chart.v + chart.high * row[0], v1 = chart.v + chart.high * row[1];
        CageFace face = {
            { low[i], low[next], high[next], high[i] }, { u0, u1, u1, u0 }, { v0, v0, v1, v1 }, paints[i]
        };
        cage_face(cage, &face);
    }
}

typedef struct {
    int at[CAP_SIDE_MAX + 1][CAP_SIDE_MAX + 1];
} Grid;

static void grid_border(Grid *grid, const int *ring, int side, int first)
{
    for (int i = 0; i < side; i++) {
        grid->at[0][i] = ring[(first + i) % (4 * side)];
        grid->at[i][side] = ring[(first + side + i) % (4 * side)];
        grid->at[side][side - i] = ring[(first + 2 * side + i) % (4 * side)];
        grid->at[side - i][0] = ring[(first + 3 * side + i) % (4 * side)];
    }
}

/* The mean of two interpolations: of the left and right borders, and of the lower and upper ones. */
static int grid_inner(Cage *cage, const Grid *grid, int side, int row, int column, V3 bulge)
{
    const CageVertex *all = cage->vertices;
    CageVertex left = all[grid->at[row][0]], right = all[grid->at[row][side]];
    CageVertex low = all[grid->at[0][column]], high = all[grid->at[side][column]];
    double across = (double)column / side, up = (double)row / side;
    V3 at = v3_mix(v3_mix(left.at, right.at, across), v3_mix(low.at, high.at, up), 0.5);
    Hold hold = hold_mix(hold_mix(left.hold, right.hold, across), hold_mix(low.hold, high.hold, up), 0.5);
    return cage_vertex(cage, v3_add(at, bulge), hold);
}

void cage_cap(Cage *cage, const int *ring, int side, int first, V3 bulge, Chart chart, Paint paint)
{
    Grid grid;
    grid_border(&grid, ring, side, first);
    for (int row = 1; row < side; row++) {
        for (int column = 1; column < side; column++) {
            grid.at[row][column] = grid_inner(cage, &grid, side, row, column, bulge);
        }
    }
    for (int row = 0; row < side; row++) {
        for (int column = 0; column < side; column++) {
            double u0 = chart.u + chart.wide * column / side, u1 = u0 + chart.wide / side;
            double v0 = chart.v + chart.high * row / side, v1 = v0 + chart.high / side;
            CageFace face = { { grid.at[row][column], grid.at[row][column + 1], grid.at[row + 1][column + 1],
                                grid.at[row + 1][column] },
                              { u0, u1, u1, u0 },
                              { v0, v0, v1, v1 },
                              paint };
            cage_face(cage, &face);
        }
    }
}

void cage_free(Cage *cage)
{
    free(cage->vertices);
    free(cage->faces);
}
