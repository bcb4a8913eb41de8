/* fbx_curve.cpp: keys, their slopes, and values at any time. */
#include "fbx_curve.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fbx
{

/* --- slopes --- */

static double chord(const std::vector<key> &keys, size_t from)
{
    return (keys[from + 1].value - keys[from].value) / (keys[from + 1].time_s - keys[from].time_s);
}

double automatic_slope(const std::vector<key> &keys, size_t at, unsigned flags)
{
    const size_t count = keys.size();
    if (count < 2) return 0.0;
    if (at == 0 || at + 1 == count) return flags & SLOPE_CLAMPED ? 0.0 : chord(keys, at == 0 ? 0 : count - 2);
    const key &last = keys[at - 1], &here = keys[at], &next = keys[at + 1];
    const double left = chord(keys, at - 1), right = chord(keys, at);
    double slope = flags & SLOPE_THROUGH_NEIGHBOURS ? (next.value - last.value) / (next.time_s - last.time_s)
                                                    : (left + right) / 2.0;
    if (flags & SLOPE_CLAMPED) {
        const double most = 3.0 * std::min(std::fabs(left), std::fabs(right));
        if (left * right <= 0.0) return 0.0;
        slope = std::max(-most, std::min(most, slope));
    }
    return flags & SLOPE_FLAT_LIKE_NEIGHBOUR && (here.value == last.value || here.value == next.value) ? 0.0 : slope;
}

/* Kochanek and Bartels, Interpolating Splines with Local Tension, Continuity, and Bias Control, 1984. tcb: those three.
 */
static double tcb_slope(const std::vector<key> &keys, size_t at, const float *tcb, bool right)
{
    const size_t count = keys.size();
    if (count < 2) return 0.0;
    const double before = chord(keys, at == 0 ? 0 : at - 1), after = chord(keys, at + 1 == count ? count - 2 : at);
    const double tension = static_cast<double>(tcb[0]), bias = static_cast<double>(tcb[2]);
    const double continuity = static_cast<double>(right ? tcb[1] : -tcb[1]);
    return (1.0 - tension) / 2.0 *
           ((1.0 + continuity) * (1.0 + bias) * before + (1.0 - continuity) * (1.0 - bias) * after);
}

/* --- keys of version 7 --- */

enum key_flags : uint32_t {
    KEY_CONSTANT = 0x2,
    KEY_LINEAR = 0x4,
    KEY_CUBIC = 0x8,
    KEY_AUTOMATIC = 0x100, /* of a constant key: it takes the next key's value */
    KEY_TCB = 0x200,
    KEY_USER = 0x400,
    KEY_WEIGHT_RIGHT = 0x01000000,
    KEY_WEIGHT_LEFT = 0x02000000,
    KEY_VELOCITIES = 0x30000000
};

/* Consecutive keys share them. data: the right slope, the next key's left slope, packed weights; or tension,
 * continuity and bias. */
struct attributes {
    uint32_t flags = KEY_LINEAR;
    bool stored = false;
    float data[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
};

static std::vector<attributes> read_attributes(const node &n, bool ascii)
{
    const numbers flags = list_of(n, "KeyAttrFlags"), data = list_of(n, "KeyAttrDataFloat");
    std::vector<attributes> out(flags.values.size());
    for (size_t a = 0; a < out.size(); ++a) {
        out[a].flags = static_cast<uint32_t>(whole_of(flags.values[a]));
        out[a].stored = a * 4 + 3 < data.values.size();
        for (size_t k = 0; out[a].stored && k < 4; ++k) {
            const double given = data.values[a * 4 + k];
            const uint32_t bits = static_cast<uint32_t>(whole_of(given));
            out[a].data[k] = static_cast<float>(given);
            if (ascii && data.whole) memcpy(&out[a].data[k], &bits, sizeof bits);
            if (k < 2 && !std::isfinite(out[a].data[k])) out[a].data[k] = 0.0f;
        }
    }
    return out;
}

/* [key] which attributes it has. */
static std::vector<size_t> attribute_of_keys(const node &n, size_t key_count)
{
    std::vector<size_t> out;
    size_t attribute = 0;
    for (double count : list_of(n, "KeyAttrRefCount").values) {
        for (int64_t i = 0; i < whole_of(count) && out.size() < key_count; ++i) out.push_back(attribute);
        ++attribute;
    }
    out.resize(key_count, attribute ? attribute - 1 : 0);
    return out;
}

static void fill_slopes(curve &c, size_t i, const attributes &a, const attributes &next)
{
    key &k = c.keys[i];
    const size_t j = std::min(i + 1, c.keys.size() - 1);
    if (a.flags & KEY_TCB && a.stored)
        k.right = tcb_slope(c.keys, i, a.data, true);
    else if (a.flags & KEY_USER && a.stored)
        k.right = static_cast<double>(a.data[0]);
    else if (a.flags & KEY_AUTOMATIC)
        k.right = automatic_slope(c.keys, i, a.flags);
    if (next.flags & KEY_TCB && next.stored)
        k.left = tcb_slope(c.keys, j, next.data, false);
    else if (!(next.flags & KEY_USER) && next.flags & KEY_AUTOMATIC && next.flags & KEY_CUBIC)
        k.left = automatic_slope(c.keys, j, next.flags);
    else if (a.stored)
        k.left = static_cast<double>(a.data[1]);
    if (a.stored && !(a.flags & KEY_TCB)) {
        uint32_t weights;
        memcpy(&weights, &a.data[2], sizeof weights);
        if (a.flags & KEY_WEIGHT_RIGHT) k.right_weight = std::min(static_cast<double>(weights & 0xffff) / 9999.0, 1.0);
        if (a.flags & KEY_WEIGHT_LEFT) k.left_weight = std::min(static_cast<double>(weights >> 16) / 9999.0, 1.0);
    }
}

static interpolation mode_of(uint32_t flags)
{
    if (flags & KEY_CONSTANT) return flags & KEY_AUTOMATIC ? interpolation::constant_next : interpolation::constant;
    return flags & KEY_LINEAR ? interpolation::linear : interpolation::cubic;
}

void read_extrapolation(const node &n, curve &out)
{
    for (const bool is_after : { false, true }) {
        const node *given = n.child(is_after ? "Post-Extrapolation" : "Pre-Extrapolation");
        const node *type = given ? given->child("Type") : nullptr,
                   *count = given ? given->child("Repetition") : nullptr;
        extrapolation &e = is_after ? out.after : out.before;
        if (!type || type->values.empty()) continue;
        e.how = type->text(0).empty() ? static_cast<char>(type->whole(0)) : type->text(0)[0];
        if (count) e.count = count->whole(0, -1);
    }
}

curve read_curve(const node &n, bool ascii, bool *biased)
{
    const numbers times = list_of(n, "KeyTime"), values = list_of(n, "KeyValueFloat");
    const std::vector<attributes> all = read_attributes(n, ascii);
    const size_t count = std::min(times.values.size(), values.values.size());
    const std::vector<size_t> attribute_of = attribute_of_keys(n, count);
    std::vector<std::pair<key, attributes>> given;
    curve out;
    for (size_t i = 0; i < count; ++i) {
        const attributes a = attribute_of[i] < all.size() ? all[attribute_of[i]] : attributes();
        const key k = {
            times.values[i] / ticks_per_second, values.values[i], mode_of(a.flags), 0, 0, 1.0 / 3, 1.0 / 3
        };
        if (std::isfinite(k.time_s) && std::isfinite(k.value)) given.push_back({ k, a });
    }
    std::stable_sort(given.begin(), given.end(),
                     [](const auto &a, const auto &b) { return a.first.time_s < b.first.time_s; });
    std::vector<attributes> kept;
    for (size_t i = 0; i < given.size(); ++i) {
        if (i + 1 < given.size() && given[i + 1].first.time_s <= given[i].first.time_s) continue; /* the last holds */
        out.keys.push_back(given[i].first);
        kept.push_back(given[i].second);
    }
    for (size_t i = 0; i < out.keys.size(); ++i) {
        if (out.keys[i].mode != interpolation::cubic) continue;
        *biased = *biased || kept[i].flags & KEY_VELOCITIES;
        fill_slopes(out, i, kept[i], kept[std::min(i + 1, kept.size() - 1)]);
    }
    read_extrapolation(n, out);
    return out;
}

/* --- values --- */

/* A key this close ahead counts as reached: frame times are rounded, and at a step a rounding would show. */
static const double near_s = 1e-9;

/* Where on a Bezier curve from 0 to 1 with handles at `a` and 1 - `b` the time is x: it grows with the parameter. */
static double parameter_at(double x, double a, double b)
{
    double low = 0.0, high = 1.0;
    if (std::fabs(a - 1.0 / 3) < 1e-6 && std::fabs(b - 1.0 / 3) < 1e-6) return x;
    for (int i = 0; i < 60; ++i) {
        const double u = (low + high) / 2.0, v = 1.0 - u;
        const double time = 3.0 * v * v * u * a + 3.0 * v * u * u * (1.0 - b) + u * u * u;
        (time < x ? low : high) = u;
    }
    return (low + high) / 2.0;
}

double curve::inside(double seconds) const
{
    const auto after_it = std::upper_bound(keys.begin(), keys.end(), seconds + near_s,
                                           [](double t, const key &k) { return t < k.time_s; });
    if (keys.empty()) return 0.0;
    if (after_it == keys.begin()) return keys[0].value;
    if (after_it == keys.end()) return keys.back().value;
    const key &a = *(after_it - 1), &b = *after_it;
    const double span = b.time_s - a.time_s, x = (seconds - a.time_s) / span;
    switch (a.mode) {
    case interpolation::constant: return a.value;
    case interpolation::constant_next: return b.value;
    case interpolation::linear: return a.value + (b.value - a.value) * x;
    case interpolation::cubic: break;
    }
    const double u = parameter_at(x, a.right_weight, a.left_weight), v = 1.0 - u;
    return v * v * v * a.value + 3.0 * v * v * u * (a.value + a.right * a.right_weight * span) +
           3.0 * v * u * u * (b.value - a.left * a.left_weight * span) + u * u * u * b.value;
}

/* The slope at the first or the last key. */
static double end_slope(const curve &c, bool early)
{
    const size_t at = early ? 0 : c.keys.size() - 2;
    if (c.keys[at].mode == interpolation::cubic) return early ? c.keys[at].right : c.keys[at].left;
    return c.keys[at].mode == interpolation::linear ? chord(c.keys, at) : 0.0;
}

double curve::at(double seconds) const
{
    if (keys.size() < 2) return inside(seconds);
    const key &first = keys.front(), &last = keys.back();
    const bool early = seconds < first.time_s - near_s;
    const double span = last.time_s - first.time_s;
    const extrapolation &e = early ? before : after;
    if ((!early && seconds <= last.time_s + near_s) || !(e.how && strchr("KRMA", e.how))) return inside(seconds);
    if (e.how == 'K') {
        const key &end = early ? first : last;
        return end.value + (seconds - end.time_s) * end_slope(*this, early);
    }
    double turns = std::floor((seconds - first.time_s + near_s) / span); /* which copy of the curve */
    double x = seconds - first.time_s - turns * span;
    if (e.count >= 0 && std::fabs(turns) > static_cast<double>(e.count)) {
        turns = static_cast<double>(early ? -e.count : e.count);
        x = early ? 0.0 : span;
    }
    const bool mirrored = e.how == 'M' && std::fmod(std::fabs(turns), 2.0) == 1.0;
    const double value = inside(first.time_s + (mirrored ? span - x : x));
    return e.how == 'A' ? value + turns * (last.value - first.value) : value;
}

bool curve::changes() const
{
    for (const key &k : keys)
        if (k.value != keys[0].value || k.right != 0.0 || k.left != 0.0) return true;
    return false;
}

} // namespace fbx
