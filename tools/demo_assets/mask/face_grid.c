#include "face_grid.h"

#include "axis.h"
#include "face.h"
#include "relief.h"
#include "hair.h"
#include "mask.h"

#include <math.h>

enum { COLUMN_ANCHORS = 6, ROW_ANCHORS = 2 };
enum { EYE_RIGHT_OUTER, MOUTH_RIGHT, EYE_RIGHT_INNER, EYE_LEFT_INNER, MOUTH_LEFT, EYE_LEFT_OUTER };
enum { MOUTH_ROW, EYE_ROW };

typedef struct {
    Axis column, row;
    uint32_t above[GRID_ROWS][GRID_COLUMNS]; /* the copy used by the quads above */
    uint32_t below[GRID_ROWS][GRID_COLUMNS]; /* the same vertex except on a slit */
} Grid;

static double column_spacing(double x)
{
    double edge = fabs(x) / FACE_HALF_WIDTH;
    return 1.0 + 0.5 * smooth(0.64, 0.85, edge) - 0.9 * smooth(0.85, 1, edge);
}

static double row_spacing(double y)
{
    double edge = fabs(y) / FACE_HALF_HEIGHT;
    double fine = bump((y - MOUTH_Y) / 0.030) + bump((y - EYE_Y) / 0.030) + 0.42 * bump((y - 0.061) / 0.024) +
                  0.7 * bump((y + 0.028) / 0.016);
    return 1.7 - 1.1 * clamp(fine, 0, 1) - 0.8 * smooth(0.8, 1, edge);
}

static Axis make_columns(void)
{
    static const double anchors[COLUMN_ANCHORS] = { -EYE_X - EYE_HALF, -MOUTH_HALF, -EYE_X + EYE_HALF,
                                                    EYE_X - EYE_HALF,  MOUTH_HALF,  EYE_X + EYE_HALF };
    Axis axis = { 0 };
    axis_spread(&axis, GRID_COLUMNS, FACE_HALF_WIDTH, column_spacing);
    axis_snap(&axis, anchors, COLUMN_ANCHORS);
    return axis;
}

static Axis make_rows(void)
{
    static const double anchors[ROW_ANCHORS] = { MOUTH_Y, EYE_Y };
    Axis axis = { 0 };
    axis_spread(&axis, GRID_ROWS, FACE_HALF_HEIGHT, row_spacing);
    axis_snap(&axis, anchors, ROW_ANCHORS);
    return axis;
}

/* Crowds rows together towards the corners of the mouth, so that one row runs
 * along the edge of the red: paint that follows a row has a clean edge. */
static double crowd_row(double s, double from_line)
{
    int side = from_line > 0 ? 1 : -1;
    double widest = fabs(lip_edge(0.3 * MOUTH_HALF, side)), away = fabs(s) / MOUTH_HALF;
    double scale = fmax(fabs(lip_edge(s, side)) / widest, 0.22);
    scale = mix(scale, 1, smooth(1, 2, away));
    return from_line * mix(scale, 1, smooth(widest, 0.028, fabs(from_line)));
}

/* Bends rows along the line where lids meet, or lips. */
static double bend_row(double s, double t)
{
    double to_eye = t - EYE_Y, to_mouth = crowd_row(s, t - MOUTH_Y);
    return MOUTH_Y + to_mouth + (eye_line(s) - EYE_Y) * bump(to_eye / 0.025) +
           (mouth_line(s) - MOUTH_Y) * bump(to_mouth / 0.025);
}

/* Crowds the grid towards the hairline, which gives the ink a sharp edge. */
static void crowd_hair(double *s, double *t, double share)
{
    double past = hair_past(*s, *t), near = bump(past / 0.0070);
    if (near > 0) {
        hair_shift(s, t, -0.60 * share * near * past);
    }
}

/* A plain rectangle in the middle, drawn out to the mask's oval towards the border (the rectangle's corners end up on
 * the oval's diagonals). */
static void grid_point(const Grid *grid, int i, int j, double *s, double *t)
{
    double x = grid->column.at[i], y = grid->row.at[j];
    double p = x / FACE_HALF_WIDTH, q = y / FACE_HALF_HEIGHT;
    double oval = smooth(0.45, 1, p * p + q * q);
    double oval_y = y * sqrt(1 - p * p / 2);
    double oval_x = x * sqrt(1 - q * q / 2) * outline_width(oval_y);
    *s = mix(x, oval_x, oval);
    *t = mix(bend_row(x, y), oval_y, oval);
    double inner = smooth(1, 0.9, p * p) * smooth(1, 0.9, q * q);
    crowd_hair(s, t, inner);
}

static int between(const Axis *axis, int line, int from, int to)
{
    return line > axis->anchor[from] && line < axis->anchor[to];
}

static int on_eye_slit(const Grid *grid, int i, int j)
{
    return j == grid->row.anchor[EYE_ROW] && (between(&grid->column, i, EYE_RIGHT_OUTER, EYE_RIGHT_INNER) ||
                                              between(&grid->column, i, EYE_LEFT_INNER, EYE_LEFT_OUTER));
}

static int on_mouth_slit(const Grid *grid, int i, int j)
{
    return j == grid->row.anchor[MOUTH_ROW] && between(&grid->column, i, MOUTH_RIGHT, MOUTH_LEFT);
}

/* Texture coordinates are a plain view from the front of the mask at rest. */
static void seed_texture(Seed *seed)
{
    static const Pose rest;
    V3 at = mask_place(seed, &rest);
    seed->u = 0.5 + at.x / 0.24;
    seed->v = 0.5 - at.y / 0.24;
}

static Seed grid_seed(const Grid *grid, int i, int j, int side)
{
    Seed seed = { .region = ON_SKIN };
    int eye_row = grid->row.anchor[EYE_ROW], mouth_row = grid->row.anchor[MOUTH_ROW];
    grid_point(grid, i, j, &seed.s, &seed.t);
    seed.eye = j == eye_row ? side : j > eye_row ? 1 : -1;
    seed.mouth = j == mouth_row ? side : j > mouth_row ? 1 : -1;
    return seed;
}

static void add_vertices(Model *model, Grid *grid)
{
    for (int j = 0; j < GRID_ROWS; j++) {
        for (int i = 0; i < GRID_COLUMNS; i++) {
            Seed seed = grid_seed(grid, i, j, 1);
            seed_texture(&seed);
            grid->above[j][i] = grid->below[j][i] = model_seed(model, PART_PAINT, &seed);
            if (!on_eye_slit(grid, i, j) && !on_mouth_slit(grid, i, j)) {
                continue;
            }
            seed = grid_seed(grid, i, j, -1);
            seed_texture(&seed);
            grid->below[j][i] = model_seed(model, PART_PAINT, &seed);
        }
    }
}

/* Diagonals are mirrored left to right, and at the oval's corners they lead into the corner: the other choice would
 * leave a flat triangle there. */
static void add_faces(Model *model, const Grid *grid)
{
    for (int j = 0; j + 1 < GRID_ROWS; j++) {
        for (int i = 0; i + 1 < GRID_COLUMNS; i++) {
            uint32_t a = grid->above[j][i], b = grid->above[j][i + 1];
            uint32_t c = grid->below[j + 1][i + 1], d = grid->below[j + 1][i];
            int left = i >= GRID_COLUMNS / 2, top = j >= GRID_ROWS / 2;
            if (left == top) {
                model_quad(model, PART_PAINT, a, b, c, d);
            } else {
                model_quad(model, PART_PAINT, b, c, d, a);
            }
        }
    }
}

/* One strip that folds inwards from a slit's edge, `depth` rows deep. The
 * corner columns are shared by both folds of a slit, which closes the ends. */
static void add_fold(Model *model, const Grid *grid, Region region, int row, int from, int to, int side, int depth)
{
    uint32_t before[MAX_LINES], now[MAX_LINES];
    for (int i = from; i <= to; i++) {
        before[i] = side > 0 ? grid->above[row][i] : grid->below[row][i];
    }
    for (int k = 1; k <= depth; k++) {
        for (int i = from; i <= to; i++) {
            Seed seed = grid_seed(grid, i, row, side);
            seed_texture(&seed);
            seed.region = region;
            seed.k = k;
            seed.v += side * 0.0015 * k;
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

static void add_folds(Model *model, const Grid *grid)
{
    enum { LID_ROWS = 4, LIP_ROWS = 6 };
    const int *column = grid->column.anchor, *row = grid->row.anchor;
    for (int side = -1; side <= 1; side += 2) {
        add_fold(model, grid, ON_LID_FOLD, row[EYE_ROW], column[EYE_RIGHT_OUTER], column[EYE_RIGHT_INNER], side,
                 LID_ROWS);
        add_fold(model, grid, ON_LID_FOLD, row[EYE_ROW], column[EYE_LEFT_INNER], column[EYE_LEFT_OUTER], side,
                 LID_ROWS);
        add_fold(model, grid, ON_LIP_FOLD, row[MOUTH_ROW], column[MOUTH_RIGHT], column[MOUTH_LEFT], side, LIP_ROWS);
    }
}

void face_grid_build(Model *model)
{
    static Grid grid;
    grid.column = make_columns();
    grid.row = make_rows();
    add_vertices(model, &grid);
    add_faces(model, &grid);
    add_folds(model, &grid);
}

Seed face_grid_border(int i)
{
    static Grid grid;
    if (grid.column.count == 0) {
        grid.column = make_columns();
        grid.row = make_rows();
    }
    int right = GRID_COLUMNS - 1, top = GRID_ROWS - 1;
    if (i < right) {
        return grid_seed(&grid, i, 0, 1);
    }
    i -= right;
    if (i < top) {
        return grid_seed(&grid, right, i, 1);
    }
    i -= top;
    if (i < right) {
        return grid_seed(&grid, right - i, top, 1);
    }
    return grid_seed(&grid, 0, top - (i - right), 1);
}
