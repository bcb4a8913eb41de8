#include "parts.h"

#include <math.h>

#define PI 3.14159265358979323846

/* A ring about the foot. It is turned from lying (0 degrees, at the ankle) to standing upright
 * (90, from the heel on); `upper` is its extent to the instep, `lower` to heel and sole. */
typedef struct {
    double y, z, degrees, half_width, upper, lower;
    double foot, toes; /* weights on these joints; the rest goes to the shin */
} Slice;

/* clang-format off */
static const Slice slices[] = {
    { 0.110, -0.012, 0, 0.0370, 0.044, 0.046, 0.60, 0 },   { 0.062, -0.010, 50, 0.0390, 0.052, 0.082, 1, 0 },
    { 0.039, 0.052, 86, 0.0420, 0.046, 0.047, 1, 0 },
    { 0.027, 0.122, 90, 0.0480, 0.030, 0.035, 0.5, 0.5 },  { 0.022, 0.158, 90, 0.0450, 0.023, 0.030, 0, 1 },
    { 0.018, 0.184, 90, 0.0330, 0.016, 0.022, 0, 1 },
};
/* clang-format on */
enum { SLICES = sizeof slices / sizeof *slices };

static V3 slice_place(const Slice *s, int i)
{
    double angle = PI / 6 * (i - 1), turn = PI / 180 * s->degrees;
    double extent = cos(angle) * (cos(angle) > 0 ? s->upper : s->lower);
    double x = joint_place(side_joint(LEFT, FOOT)).x + 0.04 * (s->z + 0.012);
    return v3(x + s->half_width * sin(angle), s->y + extent * sin(turn), s->z + extent * cos(turn));
}

static Hold slice_hold(int side, const Slice *s)
{
    Hold hold = { { 0 } };
    hold.by[side_joint(side, FOOT)] = s->foot;
    hold.by[side_joint(side, TOES)] = s->toes;
    hold.by[side_joint(side, SHIN)] = 1 - s->foot - s->toes;
    return hold;
}

void foot_build(Cage *cage, int side, const int ankle[LEG_RING])
{
    const Chart chart = { 0.5 * side, 0.91, 0.4, 0.09 }, tip = { 0.5 * side + 0.42, 0.91, 0.06, 0.06 };
    int last[LEG_RING], next[LEG_RING];
    Paint paints[LEG_RING];
    for (int i = 0; i < LEG_RING; i++) {
        last[i] = ankle[i];
        paints[i] = PAINT_SOCK;
    }
    for (int s = 0; s < SLICES; s++) {
        double rows[2] = { (s + 1.0) / SLICES, (double)s / SLICES };
        for (int i = 0; i < LEG_RING; i++) {
            V3 at = slice_place(&slices[s], i);
            at.x *= side_sign(side);
            next[i] = cage_vertex(cage, at, slice_hold(side, &slices[s]));
        }
        cage_band(cage, next, last, LEG_RING, chart, rows, paints);
        for (int i = 0; i < LEG_RING; i++) {
            last[i] = next[i];
        }
    }
    /* Seen from the toes the ring runs clockwise. */
    for (int i = 0; i < LEG_RING; i++) {
        next[i] = last[LEG_RING - 1 - i];
    }
    cage_cap(cage, next, 3, 1, v3(0, 0, 0.006), tip, PAINT_SOCK);
}
