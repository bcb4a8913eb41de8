#include "parts.h"

#include <math.h>

#define PI 3.14159265358979323846

/* A ring about a leg of the hakama, the wide pleated trousers. */
typedef struct {
    double y, x, half_width, half_depth, z, pleat;
    Paint paint; /* of the band above it */
} Girth;

/* Down the cloth, round the hem, and back up inside to the ankle. */
static const Girth girths[] = {
    { 0.630, 0.109, 0.102, 0.142, 0.002, 0.030, PAINT_SKIRT },
    { 0.460, 0.120, 0.112, 0.148, 0.005, 0.058, PAINT_SKIRT },
    { 0.290, 0.128, 0.120, 0.155, 0.002, 0.072, PAINT_SKIRT },
    { 0.135, 0.133, 0.125, 0.162, -0.002, 0.078, PAINT_SKIRT },
    { 0.098, 0.134, 0.126, 0.163, -0.003, 0.078, PAINT_SKIRT_HEM },
    { 0.103, 0.134, 0.115, 0.152, -0.003, 0.074, PAINT_SKIRT_INSIDE },
    { 0.170, 0.110, 0.052, 0.060, -0.008, 0.006, PAINT_SKIRT_INSIDE },
    { 0.150, 0.106, 0.039, 0.044, -0.010, 0, PAINT_SOCK },
};
enum { ROWS = sizeof girths / sizeof *girths, FIRST_INSIDE = ROWS - 2 };

static V3 skirt_place(const Girth *g, int i)
{
    double angle = PI / 6 * (i - 1), ahead = cos(angle);
    /* Every other fold lies deeper; none on the inside, where the legs meet. */
    double fold = i > 8 ? 0 : i % 2 ? 0.5 * g->pleat : -g->pleat;
    return v3(g->x + (g->half_width + fold) * sin(angle), g->y, g->z + (g->half_depth + fold) * ahead);
}

static Hold skirt_hold(int side, int row, V3 at)
{
    Hold thigh = hold_one(side_joint(side, THIGH)), shin = hold_one(side_joint(side, SHIN));
    /* Of what follows the shin most swings. */
    Hold swings = hold_mix(shin, hold_one(side_joint(side, SKIRT)), 0.9 * smooth(0.44, 0.14, at.y));
    Hold hold = hold_mix(thigh, swings, smooth(0.60, 0.32, at.y));
    if (row >= FIRST_INSIDE) {
        return hold_mix(shin, hold_one(side_joint(side, FOOT)), row == FIRST_INSIDE ? 0.1 : 0.25);
    }
    /* The hem falls level, as the foot stands. */
    hold = hold_mix(hold, hold_one(side_joint(side, FOOT)), 0.6 * smooth(0.34, 0.10, at.y));
    return row == 0 ? hold_mix(hold, hold_one(HIPS), 0.20) : hold;
}

void skirt_build(Cage *cage, int side, const int border[LEG_RING], int ankle[LEG_RING])
{
    const Chart chart = { 0.5 * side, 0.68, 0.5, 0.22 };
    for (int i = 0; i < LEG_RING; i++) {
        ankle[i] = border[i];
    }
    for (int row = 0; row < ROWS; row++) {
        int next[LEG_RING];
        Paint paints[LEG_RING];
        double rows[2] = { (row + 1.0) / ROWS, (double)row / ROWS };
        for (int i = 0; i < LEG_RING; i++) {
            V3 at = skirt_place(&girths[row], i);
            Hold hold = skirt_hold(side, row, at);
            at.x *= side_sign(side);
            next[i] = cage_vertex(cage, at, hold);
            paints[i] = girths[row].paint;
        }
        cage_band(cage, next, ankle, LEG_RING, chart, rows, paints);
        for (int i = 0; i < LEG_RING; i++) {
            ankle[i] = next[i];
        }
    }
}
