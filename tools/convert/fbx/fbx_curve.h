/* fbx_curve.h: the keys of an animation curve and the values between them. */
#ifndef NOH_CONVERT_FBX_FBX_CURVE_H
#define NOH_CONVERT_FBX_FBX_CURVE_H

#include <vector>

#include "fbx_tree.h"

namespace fbx
{

static const double ticks_per_second = 46186158000.0;

enum class interpolation { constant, constant_next, linear, cubic }; /* constant_next: the next key's value */

/* Slopes are per second. `left` is where the curve arrives at the next key; weights are shares of the span, where the
 * two handles of a Bezier curve stand in time. */
struct key {
    double time_s, value;
    interpolation mode;
    double right, left, right_weight, left_weight;
};

/* Outside of its keys: Constant, Repeat, Mirror, slope K, A repeat and add. */
struct extrapolation {
    char how = 'C';
    int64_t count = -1; /* of repetitions; negative: without end */
};

struct curve {
    std::vector<key> keys; /* their times strictly increase */
    extrapolation before, after;

    double at(double seconds) const;
    double inside(double seconds) const;
    bool changes() const;
};

/* Reads an AnimationCurve. `ascii`: attributes are written as the bits of floats. *biased: it has velocities or biased
 * tangents, which are not read. */
curve read_curve(const node &n, bool ascii, bool *biased);
void read_extrapolation(const node &n, curve &out);

/* How a key's slope is found. */
enum slope_flags : unsigned {
    SLOPE_FLAT_LIKE_NEIGHBOUR = 0x1000,
    SLOPE_THROUGH_NEIGHBOURS = 0x2000, /* else the mean of both chords */
    SLOPE_CLAMPED = 0x4000             /* flat at extremes, and never beyond the keys */
};
double automatic_slope(const std::vector<key> &keys, size_t at, unsigned flags);

} // namespace fbx
#endif
