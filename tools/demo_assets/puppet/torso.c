#include "parts.h"

#include <math.h>

#define PI 3.14159265358979323846

/* 1 is an ellipse, less is squarer. */
#define FULLNESS 0.85

/* A ring about the body: half its width, and how far it reaches to the front and to the back
 * of z. */
typedef struct {
    double y, half_width, front, back, z;
} Girth;

/* From the hips to the neck. The cage lies outside of the surface by about 3 in 100. */
enum {
    HIP_ROW,
    SEAT_ROW,
    SASH_LOW,
    SASH_LOW_EDGE,
    SASH_HIGH_EDGE,
    SASH_HIGH,
    ARMPIT_ROW,
    BREAST_ROW,
    ARM_ROW,
    SHOULDER_ROW,
    COLLAR_ROW,
    COLLAR_TOP,
    COLLAR_INSIDE,
    NECK_ROW,
    TORSO_ROWS
};

static const Girth girths[TORSO_ROWS] = {
    { 0.800, 0.190, 0.138, 0.146, -0.005 }, { 0.885, 0.186, 0.132, 0.142, -0.005 },
    { 0.958, 0.158, 0.120, 0.122, -0.005 }, { 0.966, 0.163, 0.126, 0.128, -0.005 },
    { 1.058, 0.161, 0.125, 0.126, -0.006 }, { 1.066, 0.160, 0.122, 0.122, -0.006 },
    { 1.130, 0.173, 0.128, 0.124, -0.008 }, { 1.195, 0.178, 0.128, 0.128, -0.010 },
    { 1.265, 0.176, 0.114, 0.128, -0.012 }, { 1.332, 0.150, 0.076, 0.110, -0.014 },
    { 1.368, 0.082, 0.066, 0.084, -0.012 }, { 1.398, 0.066, 0.058, 0.072, -0.012 },
    { 1.388, 0.054, 0.050, 0.056, -0.012 }, { 1.362, 0.049, 0.046, 0.048, -0.010 },
};

static const Chart chart = { 0, 0, 0.5, 0.27 };

/* Crossed over the breast, the robe's edges make a V: columns 1 and 2 run along the collar. */
static double collar_x(int row, int column)
{
    static const double edge[TORSO_ROWS] = { 0, 0, 0, 0.001, 0.003, 0.005, 0.013, 0.026, 0.038, 0.046, 0.040 };
    static const double width[TORSO_ROWS] = { 0, 0, 0, 0.034, 0.034, 0.034, 0.035, 0.036, 0.036, 0.036, 0.030 };
    return edge[row] + (column == 2 ? width[row] : 0);
}

static V3 torso_place(int row, int column)
{
    Girth g = girths[row];
    double angle = 2 * PI * column / TORSO_RING, across = sin(angle), ahead = cos(angle);
    double wide = copysign(pow(fabs(across), FULLNESS), across), deep = copysign(pow(fabs(ahead), FULLNESS), ahead);
    V3 at = v3(g.half_width * wide, g.y, g.z + (ahead > 0 ? g.front : g.back) * deep);
    int from_front = column <= TORSO_RING / 2 ? column : TORSO_RING - column;
    if ((from_front == 1 || from_front == 2) && row >= SASH_LOW_EDGE && row <= COLLAR_ROW) {
        double x = collar_x(row, from_front), part = row < COLLAR_ROW ? x / g.half_width : fabs(wide);
        at.x = copysign(x, across);
        at.z = g.z + g.front * pow(1 - pow(part, 2 / FULLNESS), FULLNESS / 2);
        at.z += row >= SASH_HIGH && row < COLLAR_ROW ? 0.006 : 0;
    }
    if (from_front == 0 && row > SASH_HIGH && row < COLLAR_TOP) {
        at.z -= 0.006;
    }
    /* The collar stands off the neck behind and dips in front. */
    if (row >= COLLAR_ROW && row <= COLLAR_INSIDE) {
        at.y -= 0.016 * (1 + ahead) * (row == COLLAR_ROW ? 1.2 : 1);
    }
    return at;
}

static Hold torso_hold(int row, V3 at)
{
    static const struct {
        int low, high;
        double k;
    } rows[TORSO_ROWS] = {
        { HIPS, SPINE, 0 },     { HIPS, SPINE, 0.04 },  { HIPS, SPINE, 0.35 },  { HIPS, SPINE, 0.42 },
        { SPINE, CHEST, 0.35 }, { SPINE, CHEST, 0.42 }, { SPINE, CHEST, 0.80 }, { CHEST, NECK, 0 },
        { CHEST, NECK, 0 },     { CHEST, NECK, 0.03 },  { CHEST, NECK, 0.22 },  { CHEST, NECK, 0.40 },
        { CHEST, NECK, 0.55 },  { CHEST, NECK, 0.65 },
    };
    Hold hold = hold_mix(hold_one(rows[row].low), hold_one(rows[row].high), rows[row].k);
    int side = at.x > 0 ? LEFT : RIGHT;
    double out = fabs(at.x);
    if (row <= SEAT_ROW) {
        Hold thighs = hold_mix(hold_one(side_joint(LEFT, THIGH)), hold_one(side_joint(RIGHT, THIGH)),
                               0.5 - 0.5 * clamp(at.x / 0.08, -1, 1));
        hold = hold_mix(hold, thighs, row == HIP_ROW ? 0.52 : 0.14);
    }
    if (row >= BREAST_ROW && row < COLLAR_TOP) {
        double high = row == BREAST_ROW ? 0.35 : row == ARM_ROW ? 0.7 : 1;
        hold = hold_mix(hold, hold_one(side_joint(side, SHOULDER)), 0.60 * high * smooth(0.02, 0.15, out));
    }
    if (row >= ARMPIT_ROW && row <= SHOULDER_ROW) {
        hold = hold_mix(hold, hold_one(side_joint(side, UPPER_ARM)), 0.30 * smooth(0.11, 0.18, out));
    }
    return hold;
}

static Paint torso_paint(int row, int column)
{
    int from_front = column < TORSO_RING / 2 ? column : TORSO_RING - 1 - column;
    if (row < SASH_LOW) {
        return PAINT_SKIRT;
    }
    if (row == SASH_LOW || row == SASH_HIGH_EDGE) {
        return PAINT_CORD;
    }
    if (row < SASH_HIGH) {
        return PAINT_SASH;
    }
    if (row >= COLLAR_INSIDE) {
        return PAINT_SKIN;
    }
    if (row == COLLAR_TOP || from_front == 0) {
        return PAINT_UNDER;
    }
    if (row == COLLAR_ROW || from_front == 1) {
        return PAINT_COLLAR;
    }
    return (row / 2 + column / 2) % 2 ? PAINT_RED : PAINT_IVORY;
}

/* Two columns of faces on each side, from the armpit to the shoulder, are left out. */
static int is_arm_hole(int row, int column)
{
    int from_side = column % (TORSO_RING / 2);
    return row >= ARMPIT_ROW && row < SHOULDER_ROW && (from_side == 3 || from_side == 4);
}

static void band_build(Cage *cage, int row, int low[TORSO_RING], int high[TORSO_RING])
{
    for (int i = 0; i < TORSO_RING; i++) {
        int next = (i + 1) % TORSO_RING;
        double u0 = chart.u + chart.wide * i / TORSO_RING, u1 = u0 + chart.wide / TORSO_RING;
        double v1 = chart.v + chart.high * (TORSO_ROWS - row) / TORSO_ROWS;
        double v0 = v1 - chart.high / TORSO_ROWS;
        CageFace face = {
            { low[i], low[next], high[next], high[i] }, { u0, u1, u1, u0 }, { v1, v1, v0, v0 }, torso_paint(row, i)
        };
        if (!is_arm_hole(row, i)) {
            cage_face(cage, &face);
        }
    }
}

static void arm_borders(int rows[TORSO_ROWS][TORSO_RING], Borders *borders)
{
    static const struct {
        int row, column;
    } around[ARM_RING] = { { SHOULDER_ROW, 4 }, { SHOULDER_ROW, 3 }, { ARM_ROW, 3 },    { BREAST_ROW, 3 },
                           { ARMPIT_ROW, 3 },   { ARMPIT_ROW, 4 },   { ARMPIT_ROW, 5 }, { BREAST_ROW, 5 },
                           { ARM_ROW, 5 },      { SHOULDER_ROW, 5 } };
    for (int i = 0; i < ARM_RING; i++) {
        borders->arm[LEFT][i] = rows[around[i].row][around[i].column];
        borders->arm[RIGHT][i] = rows[around[i].row][TORSO_RING - around[i].column];
    }
}

/* Three vertices between the legs, from back to front, close the two borders. */
static void leg_borders(Cage *cage, int rows[TORSO_ROWS][TORSO_RING], Borders *borders)
{
    Hold legs = hold_mix(hold_one(side_joint(LEFT, THIGH)), hold_one(side_joint(RIGHT, THIGH)), 0.5);
    Hold hold = hold_mix(hold_one(HIPS), legs, 0.55);
    int half = TORSO_RING / 2;
    for (int i = 0; i <= half; i++) {
        borders->leg[LEFT][i] = rows[HIP_ROW][i];
        borders->leg[RIGHT][i] = rows[HIP_ROW][(TORSO_RING - i) % TORSO_RING];
    }
    for (int i = 0; i < 3; i++) {
        int middle = cage_vertex(cage, v3(0, i == 1 ? 0.680 : 0.695, 0.065 * (i - 1) - 0.005), hold);
        borders->leg[LEFT][half + 1 + i] = borders->leg[RIGHT][half + 1 + i] = middle;
    }
}

void torso_build(Cage *cage, Borders *borders)
{
    int rows[TORSO_ROWS][TORSO_RING];
    for (int row = 0; row < TORSO_ROWS; row++) {
        for (int i = 0; i < TORSO_RING; i++) {
            V3 at = torso_place(row, i);
            /* The arm holes have an inner vertex on each side, which no face needs. */
            int inner = (row == BREAST_ROW || row == ARM_ROW) && i % (TORSO_RING / 2) == TORSO_RING / 4;
            rows[row][i] = inner ? -1 : cage_vertex(cage, at, torso_hold(row, at));
        }
        if (row > 0) {
            band_build(cage, row - 1, rows[row - 1], rows[row]);
        }
    }
    arm_borders(rows, borders);
    leg_borders(cage, rows, borders);
    for (int i = 0; i < TORSO_RING; i++) {
        borders->neck[i] = rows[NECK_ROW][i];
    }
}
