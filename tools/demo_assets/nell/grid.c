/* The grid of Nell's skin: rows along lids and lips, columns that close behind the head. */
#include "parts.h"
#include "skin.h"

#include "mask/axis.h"
#include "shape.h"

#include <math.h>

enum { COLUMNS = 77, ROWS = 73, COLUMN_ANCHORS = 6, ROW_ANCHORS = 2 };
enum { EYE_RIGHT_OUTER, MOUTH_RIGHT, EYE_RIGHT_INNER, EYE_LEFT_INNER, MOUTH_LEFT, EYE_LEFT_OUTER };
enum { MOUTH_ROW, EYE_ROW };

static const double middle = (TOP + BOTTOM) / 2;

typedef struct {
    Axis column, row;
    uint32_t above[ROWS][COLUMNS]; /* the copy used by the quads above */
    uint32_t below[ROWS][COLUMNS]; /* the same vertex except on a slit */
} Grid;

static double column_spacing(double x)
{
    return 1 + 6 * smooth(0.050, 0.120, fabs(x));
}

static double row_spacing(double y)
{
    double t = y + middle;
    double fine = bump((t - MOUTH_T) / 0.034) + bump((t - EYE_T - 0.004) / 0.040) + 0.8 * bump((t + 0.026) / 0.016);
    return 3.4 - 2.6 * clamp(fine, 0, 1) + 3 * smooth(0.06, 0.10, t) + 2 * smooth(-0.10, -0.13, t);
}

static void make_lines(Grid *grid)
{
    static const double columns[COLUMN_ANCHORS] = { -EYE_S - EYE_REACH, -MOUTH_REACH, -EYE_S + EYE_REACH,
                                                    EYE_S - EYE_REACH,  MOUTH_REACH,  EYE_S + EYE_REACH };
    static const double rows[ROW_ANCHORS] = { MOUTH_T - (TOP + BOTTOM) / 2, EYE_T - (TOP + BOTTOM) / 2 };
    axis_spread(&grid->column, COLUMNS, HALF_ROUND, column_spacing);
    axis_snap(&grid->column, columns, COLUMN_ANCHORS);
    axis_spread(&grid->row, ROWS, (TOP - BOTTOM) / 2, row_spacing);
    axis_snap(&grid->row, rows, ROW_ANCHORS);
}

/* Rows crowd together towards the corners of the mouth, so that one runs along the edge of the red. */
static double crowd_row(double s, double from_line)
{
    int side = from_line > 0 ? 1 : -1;
    double widest = fabs(red_edge(0.3 * MOUTH_REACH, side)), away = fabs(s) / MOUTH_REACH;
    double scale = mix(fmax(fabs(red_edge(s, side)) / widest, 0.25), 1, smooth(1, 2, away));
    return from_line * mix(scale, 1, smooth(widest, 0.022, fabs(from_line)));
}

static Seed grid_seed(const Grid *grid, int i, int j, int side)
{
    Seed seed = { .region = ON_SKIN };
    int eye_row = grid->row.anchor[EYE_ROW], mouth_row = grid->row.anchor[MOUTH_ROW];
    double s = grid->column.at[i], t = grid->row.at[j] + middle;
    double to_mouth = crowd_row(s, t - MOUTH_T);
    seed.s = s;
    seed.t = MOUTH_T + to_mouth + (lids_line(s) - EYE_T) * bump((t - EYE_T) / 0.028) +
             (lips_line(s) - MOUTH_T) * bump(to_mouth / 0.022);
    /* Exactly, so that upper and lower side meet. */
    seed.t = j == eye_row ? lids_line(s) : j == mouth_row ? lips_line(s) : seed.t;
    seed.eye = j == eye_row ? side : j > eye_row ? 1 : -1;
    seed.mouth = j == mouth_row ? side : j > mouth_row ? 1 : -1;
    seed.u = 0.5 + s / (2 * HALF_ROUND);
    seed.v = 0.5 - t / (TOP - BOTTOM);
    return seed;
}

static int between(const Axis *axis, int line, int from, int to)
{
    return line > axis->anchor[from] && line < axis->anchor[to];
}

static int on_slit(const Grid *grid, int i, int j)
{
    if (j == grid->row.anchor[EYE_ROW]) {
        return between(&grid->column, i, EYE_RIGHT_OUTER, EYE_RIGHT_INNER) ||
               between(&grid->column, i, EYE_LEFT_INNER, EYE_LEFT_OUTER);
    }
    return j == grid->row.anchor[MOUTH_ROW] && between(&grid->column, i, MOUTH_RIGHT, MOUTH_LEFT);
}

/* Deep below the hair or inside the collar. Columns behind are wide: so is what is looked at. */
static int hidden(const Grid *grid, int i, int j)
{
    double s = grid->column.at[i], t = grid->row.at[j] + middle, wide = 0.018 * smooth(0.060, 0.100, fabs(s));
    return t < -0.180 || (nell_hair_past(s, t) > 0.024 && nell_hair_past(fabs(s) - wide, t) > 0.018);
}

static int has_face(const Grid *grid, int i, int j)
{
    return j >= 0 && j + 1 < ROWS && !hidden(grid, i, j) && !hidden(grid, i + 1, j) && !hidden(grid, i, j + 1) &&
           !hidden(grid, i + 1, j + 1);
}

/* A vertex of no face would have no normal. The last column is the first. */
static int is_used(const Grid *grid, int i, int j)
{
    int before = i ? i - 1 : COLUMNS - 2;
    return has_face(grid, i, j) || has_face(grid, i, j - 1) || has_face(grid, before, j) ||
           has_face(grid, before, j - 1);
}

static void add_vertices(Model *model, Grid *grid)
{
    for (int j = 0; j < ROWS; j++) {
        for (int i = 0; i + 1 < COLUMNS; i++) {
            if (!is_used(grid, i, j)) {
                continue;
            }
            Seed seed = grid_seed(grid, i, j, 1);
            grid->above[j][i] = grid->below[j][i] = model_seed(model, PART_PAINT, &seed);
            if (on_slit(grid, i, j)) {
                seed = grid_seed(grid, i, j, -1);
                grid->below[j][i] = model_seed(model, PART_PAINT, &seed);
            }
        }
        grid->above[j][COLUMNS - 1] = grid->above[j][0];
        grid->below[j][COLUMNS - 1] = grid->below[j][0];
    }
}

static void add_faces(Model *model, const Grid *grid)
{
    for (int j = 0; j + 1 < ROWS; j++) {
        for (int i = 0; i + 1 < COLUMNS; i++) {
            if (!has_face(grid, i, j)) {
                continue;
            }
            uint32_t a = grid->above[j][i], b = grid->above[j][i + 1];
            uint32_t c = grid->below[j + 1][i + 1], d = grid->below[j + 1][i];
            if (i >= COLUMNS / 2) {
                model_quad(model, PART_PAINT, a, b, c, d);
            } else {
                model_quad(model, PART_PAINT, b, c, d, a);
            }
        }
    }
}

/* A strip that folds inwards from a slit's edge. The corners are shared by both folds of a slit. */
static void add_fold(Model *model, const Grid *grid, Region region, int row, int from, int to, int side, int depth)
{
    uint32_t before[COLUMNS], now[COLUMNS];
    for (int i = from; i <= to; i++) {
        before[i] = side > 0 ? grid->above[row][i] : grid->below[row][i];
    }
    for (int k = 1; k <= depth; k++) {
        for (int i = from; i <= to; i++) {
            Seed seed = grid_seed(grid, i, row, side);
            seed.region = region;
            seed.k = k;
            seed.v += side * 0.002 * k;
            now[i] = model_seed(model, PART_PAINT, &seed);
        }
        for (int i = from; i < to; i++) {
            if (side > 0) {
                model_quad(model, PART_PAINT, now[i], now[i + 1], before[i + 1], before[i]);
            } else {
                model_quad(model, PART_PAINT, before[i], before[i + 1], now[i + 1], now[i]);
            }
        }
        for (int i = from; i <= to; i++) {
            before[i] = now[i];
        }
    }
}

void skin_build(Model *model)
{
    static Grid grid;
    make_lines(&grid);
    add_vertices(model, &grid);
    add_faces(model, &grid);
    const int *column = grid.column.anchor, *row = grid.row.anchor;
    for (int side = -1; side <= 1; side += 2) {
        add_fold(model, &grid, ON_LID_FOLD, row[EYE_ROW], column[EYE_RIGHT_OUTER], column[EYE_RIGHT_INNER], side, 2);
        add_fold(model, &grid, ON_LID_FOLD, row[EYE_ROW], column[EYE_LEFT_INNER], column[EYE_LEFT_OUTER], side, 2);
        add_fold(model, &grid, ON_LIP_FOLD, row[MOUTH_ROW], column[MOUTH_RIGHT], column[MOUTH_LEFT], side, 4);
    }
}
