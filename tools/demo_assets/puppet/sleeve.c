#include "parts.h"

/* A ring about the arm: it stands upright at x, reaches `up` above the arm and `down` below it,
 * and is `half` as thick to the front and to the back. */
typedef struct {
    double x, up, down, half;
    Paint paint; /* of the band before it; red and ivory follow each other in blocks */
} Station;

/* Out along the cloth, round the hem, and back inside to the wrist. */
static const Station stations[] = {
    { 0.225, 0.054, 0.118, 0.076, PAINT_RED },    { 0.290, 0.054, 0.163, 0.066, PAINT_IVORY },
    { 0.355, 0.054, 0.208, 0.060, PAINT_RED },    { 0.425, 0.055, 0.258, 0.055, PAINT_IVORY },
    { 0.490, 0.056, 0.275, 0.050, PAINT_RED },    { 0.501, 0.055, 0.270, 0.048, PAINT_LINING },
    { 0.488, 0.043, 0.246, 0.035, PAINT_LINING }, { 0.440, 0.030, 0.080, 0.023, PAINT_LINING },
    { 0.455, 0.021, 0.023, 0.024, PAINT_LINING }, { 0.505, 0.021, 0.023, 0.027, PAINT_SKIN },
};
enum { STATIONS = sizeof stations / sizeof *stations, BARE = STATIONS - 2 };

/* Places about a ring, from the top by way of the front: part of its thickness, and height from
 * -1 at the bottom over 0 at the arm to 1 at the top. */
static const struct {
    double out, height;
} around[ARM_RING] = { { 0, 1 },     { 0.75, 0.80 },   { 1, 0.05 },   { 1, -0.50 }, { 0.75, -0.95 },
                       { 0, -1.04 }, { -0.75, -0.95 }, { -1, -0.50 }, { -1, 0.05 }, { -0.75, 0.80 } };

static V3 station_place(const Station *station, int i)
{
    V3 at = arm_line(station->x);
    at.z += station->half * around[i].out;
    at.y += around[i].height * (around[i].height > 0 ? station->up : station->down);
    return at;
}

/* The arm's own share runs along it; what hangs below follows the sleeve's joint. */
static Hold cloth_hold(int side, V3 at)
{
    Hold upper = hold_mix(hold_one(side_joint(side, SHOULDER)), hold_one(side_joint(side, UPPER_ARM)),
                          smooth(0.14, 0.25, at.x));
    Hold arm = hold_mix(upper, hold_one(side_joint(side, FOREARM)), smooth(0.300, 0.402, at.x));
    double below = arm_line(at.x).y - at.y;
    double hangs = smooth(0.02, 0.20, below) * smooth(0.29, 0.43, at.x);
    return hold_mix(arm, hold_one(side_joint(side, SLEEVE)), hangs);
}

static Hold station_hold(int side, int station, V3 at)
{
    if (station < BARE) {
        return cloth_hold(side, at);
    }
    return hold_mix(hold_one(side_joint(side, FOREARM)), hold_one(side_joint(side, HAND)), station == BARE ? 0 : 0.35);
}

void sleeve_build(Cage *cage, int side, const int border[ARM_RING], int wrist[ARM_RING])
{
    const Chart chart = { 0.5 * side, 0.28, 0.5, 0.22 };
    for (int i = 0; i < ARM_RING; i++) {
        wrist[i] = border[i];
    }
    for (int s = 0; s < STATIONS; s++) {
        int next[ARM_RING];
        Paint paints[ARM_RING];
        double rows[2] = { (double)s / STATIONS, (s + 1.0) / STATIONS };
        for (int i = 0; i < ARM_RING; i++) {
            V3 at = station_place(&stations[s], i);
            Hold hold = station_hold(side, s, at);
            at.x *= side_sign(side);
            next[i] = cage_vertex(cage, at, hold);
            /* The blocks change half way down. */
            int low = i >= 2 && i <= 7, block = stations[s].paint <= PAINT_IVORY;
            paints[i] = block && low ? (Paint)(PAINT_IVORY - stations[s].paint) : stations[s].paint;
        }
        cage_band(cage, wrist, next, ARM_RING, chart, rows, paints);
        for (int i = 0; i < ARM_RING; i++) {
            wrist[i] = next[i];
        }
    }
}
