#include "parts.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Neck and wig. The mask hides the flat front of the wig. */
typedef struct {
    double y, half_width, front, back, z;
    Paint paint; /* of the band below it */
} Girth;

static const Girth girths[] = {
    { 1.410, 0.0500, 0.050, 0.052, 0.000, PAINT_SKIN }, { 1.418, 0.0680, 0.060, 0.086, 0.006, PAINT_HAIR },
    { 1.448, 0.0860, 0.069, 0.116, 0.008, PAINT_HAIR }, { 1.540, 0.1010, 0.075, 0.134, 0.008, PAINT_HAIR },
    { 1.570, 0.0965, 0.075, 0.128, 0.008, PAINT_BAND }, { 1.611, 0.0740, 0.063, 0.100, 0.006, PAINT_HAIR },
    { 1.633, 0.0440, 0.040, 0.062, 0.000, PAINT_HAIR },
};
enum { ROWS = sizeof girths / sizeof *girths };

static V3 head_place(const Girth *g, int column)
{
    double angle = 2 * PI * column / TORSO_RING, across = sin(angle), ahead = cos(angle);
    /* The neck is round; the wig's front, behind the mask, is flat. */
    double power = g->y < 1.415 ? 1 : ahead > 0 ? 0.55 : 0.95;
    double wide = copysign(pow(fabs(across), ahead > 0 ? 0.75 : 0.95), across);
    double deep = copysign(pow(fabs(ahead), power), ahead);
    return v3(g->half_width * wide, g->y, g->z + (ahead > 0 ? g->front : g->back) * deep);
}

void head_build(Cage *cage, const int neck[TORSO_RING])
{
    static const Chart chart = { 0.5, 0, 0.5, 0.18 }, crown = { 0.5, 0.19, 0.08, 0.08 };
    int low[TORSO_RING], high[TORSO_RING];
    for (int i = 0; i < TORSO_RING; i++) {
        low[i] = neck[i];
    }
    for (int row = 0; row < ROWS; row++) {
        Paint paints[TORSO_RING];
        double rows[2] = { 1 - (double)row / ROWS, 1 - (row + 1.0) / ROWS };
        Hold hold = hold_mix(hold_one(NECK), hold_one(HEAD), row == 0 ? 0.70 : 1);
        for (int i = 0; i < TORSO_RING; i++) {
            high[i] = cage_vertex(cage, head_place(&girths[row], i), hold);
            paints[i] = girths[row].paint;
        }
        cage_band(cage, low, high, TORSO_RING, chart, rows, paints);
        for (int i = 0; i < TORSO_RING; i++) {
            low[i] = high[i];
        }
    }
    cage_cap(cage, low, 4, 2, v3(0, 0.010, 0), crown, PAINT_HAIR);
}
