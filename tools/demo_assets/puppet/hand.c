#include "parts.h"

/* The hand in its own frame: `along` from the wrist to the finger tips, `wide` to the thumb,
 * `thick` to the back of the hand. */
typedef struct {
    V3 wrist, along, wide, thick;
} Palm;

static Palm palm_of(void)
{
    V3 wrist = joint_place(side_joint(LEFT, HAND));
    V3 along = v3_unit(v3_sub(wrist, joint_place(side_joint(LEFT, FOREARM))));
    V3 wide = v3(0, 0, 1);
    Palm palm = { wrist, along, wide, v3_cross(wide, along) };
    return palm;
}

static V3 palm_point(const Palm *palm, int side, V3 p)
{
    V3 at = v3_add(palm->wrist, v3_scale(palm->along, p.x));
    at = v3_add(v3_add(at, v3_scale(palm->wide, p.y)), v3_scale(palm->thick, p.z));
    at.x *= side_sign(side);
    return at;
}

static const Chart palm_chart = { 0, 0.51, 0.24, 0.10 };

/* Across the hand there are five vertices above and five below; four fingers grow between. In
 * the ring that begins at the top these are, from the thumb's side: */
static const int above[5] = { 2, 1, 0, 9, 8 }, below[5] = { 3, 4, 5, 6, 7 };

typedef struct {
    double along, half_width, half_thickness, to_thumb;
} Slice;

enum { SLICES = 4, THUMB_SLICE = 2 };
static const Slice slices[SLICES] = { { 0.012, 0.0300, 0.0185, 0 },
                                      { 0.032, 0.0380, 0.0180, 0.003 },
                                      { 0.058, 0.0420, 0.0165, 0.001 },
                                      { 0.086, 0.0440, 0.0135, -0.005 } };

static void slice_build(Cage *cage, int side, const Palm *palm, int s, int ring[ARM_RING])
{
    const Slice *slice = &slices[s];
    Hold hold = hold_mix(hold_one(side_joint(side, FOREARM)), hold_one(side_joint(side, HAND)), s == 0 ? 0.75 : 1);
    for (int i = 0; i < 5; i++) {
        double across = 1 - 0.5 * i, arch = 1 - 0.45 * across * across * across * across;
        double wide = slice->to_thumb + slice->half_width * across;
        V3 high = v3(slice->along, wide, slice->half_thickness * arch);
        V3 low = v3(slice->along, wide, -slice->half_thickness * arch);
        ring[above[i]] = cage_vertex(cage, palm_point(palm, side, high), hold);
        ring[below[i]] = cage_vertex(cage, palm_point(palm, side, low), hold);
    }
}

/* A finger: four vertices a ring, from its root to its tip. */
typedef struct {
    int joint;
    V3 root, way; /* of its middle, in the palm's frame */
    double length, radius;
    Chart chart;
} Finger;

static const Finger fingers[4] = {
    { INDEX, { 0.092, 0.0255, 0 }, { 0.998, 0.06, -0.04 }, 0.072, 0.0120, { 0.25, 0.51, 0.1, 0.05 } },
    { MIDDLE, { 0.094, 0.0060, 0 }, { 0.999, 0.01, -0.04 }, 0.080, 0.0123, { 0.36, 0.51, 0.1, 0.05 } },
    { RING, { 0.092, -0.0135, 0 }, { 0.998, -0.04, -0.04 }, 0.074, 0.0118, { 0.25, 0.58, 0.1, 0.05 } },
    { LITTLE, { 0.088, -0.0325, 0 }, { 0.994, -0.09, -0.04 }, 0.058, 0.0105, { 0.36, 0.58, 0.1, 0.05 } },
};
static const Finger thumb = { THUMB,  { 0.046, 0.052, -0.006 }, { 0.80, 0.58, -0.16 }, 0.054,
                              0.0135, { 0.14, 0.61, 0.1, 0.05 } };

enum { FINGER_RINGS = 4 };

/* root: counter-clockwise seen from the tip; the first is above and away from the thumb. */
static void finger_build(Cage *cage, int side, const Palm *palm, const Finger *finger, const int root[4])
{
    static const double along[FINGER_RINGS] = { 0.04, 0.45, 0.82, 1.02 };
    static const double size[FINGER_RINGS] = { 0.98, 0.98, 0.88, 0.54 };
    static const double tip[FINGER_RINGS] = { 0, 0.5, 1, 1 };
    static const Paint paints[4] = { PAINT_SKIN, PAINT_SKIN, PAINT_SKIN, PAINT_SKIN };
    V3 way = v3_unit(finger->way), up = v3(0, 0, 1);
    V3 wide = v3_unit(v3_cross(up, way));
    up = v3_cross(way, wide);
    Chart chart = finger->chart;
    chart.u += 0.5 * side;
    int low[4] = { root[0], root[1], root[2], root[3] };
    for (int r = 0; r < FINGER_RINGS; r++) {
        int high[4];
        double rows[2] = { (double)r / FINGER_RINGS, (r + 1.0) / FINGER_RINGS };
        V3 middle = v3_add(finger->root, v3_scale(way, along[r] * finger->length));
        double half = finger->radius * size[r];
        Hold hold = hold_mix(hold_one(side_joint(side, finger->joint)), hold_one(side_joint(side, finger->joint + 1)),
                             tip[r]);
        hold = hold_mix(hold, hold_one(side_joint(side, HAND)), r == 0 ? 0.45 : 0);
        for (int i = 0; i < 4; i++) {
            double w = i == 0 || i == 3 ? -half : half, t = i < 2 ? half : -half;
            V3 at = v3_add(v3_add(middle, v3_scale(wide, w)), v3_scale(up, t));
            high[i] = cage_vertex(cage, palm_point(palm, side, at), hold);
        }
        cage_band(cage, low, high, 4, chart, rows, paints);
        for (int i = 0; i < 4; i++) {
            low[i] = high[i];
        }
    }
    Chart end = { chart.u + 0.04, chart.v + 0.052, 0.01, 0.01 };
    cage_cap(cage, low, 1, 0, v3(0, 0, 0), end, PAINT_SKIN);
}

/* The band before the thumb's slice, less the face that the thumb grows from. */
static void thumb_band(Cage *cage, const int *low, const int *high, Chart chart, const double row[2])
{
    Cage whole = { .mirrored = 0 };
    Paint paints[ARM_RING];
    for (int i = 0; i < ARM_RING; i++) {
        paints[i] = PAINT_SKIN;
    }
    cage_band(&whole, low, high, ARM_RING, chart, row, paints);
    for (int i = 0; i < ARM_RING; i++) {
        if (i != above[0]) {
            cage_face(cage, &whole.faces[i]);
        }
    }
    cage_free(&whole);
}

void hand_build(Cage *cage, int side, const int wrist[ARM_RING])
{
    Palm palm = palm_of();
    Chart chart = palm_chart;
    chart.u += 0.5 * side;
    int low[ARM_RING], high[ARM_RING];
    Paint paints[ARM_RING];
    for (int i = 0; i < ARM_RING; i++) {
        low[i] = wrist[i];
        paints[i] = PAINT_SKIN;
    }
    for (int s = 0; s < SLICES; s++) {
        double rows[2] = { (double)s / SLICES, (s + 1.0) / SLICES };
        slice_build(cage, side, &palm, s, high);
        if (s == THUMB_SLICE) {
            int a = above[0], b = below[0];
            int root[4] = { high[a], low[a], low[b], high[b] };
            thumb_band(cage, low, high, chart, rows);
            finger_build(cage, side, &palm, &thumb, root);
        } else {
            cage_band(cage, low, high, ARM_RING, chart, rows, paints);
        }
        for (int i = 0; i < ARM_RING; i++) {
            low[i] = high[i];
        }
    }
    for (int i = 0; i < 4; i++) {
        int root[4] = { low[above[i + 1]], low[above[i]], low[below[i]], low[below[i + 1]] };
        finger_build(cage, side, &palm, &fingers[i], root);
    }
}
