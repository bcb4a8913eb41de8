/* fbx_takes.cpp: takes from version 7 on: stacks of layers of curve nodes. */
#include "fbx_scene.h"

#include <algorithm>
#include <cmath>

namespace fbx
{

static const double rate_max_hz = 120.0, usual_rate_hz = 60.0; /* the second for files with a finer clock */
static const double rate_min_hz = 24.0;                        /* files of fewer frames are sampled between them, too */
static const double samples_max = 1e7;                         /* of all takes: frames times nodes */

static const curve *curve_at(scene &s, size_t object)
{
    const auto known = s.curve_of.find(object);
    bool biased = false;
    if (known != s.curve_of.end()) return known->second;
    s.curves.push_back(read_curve(*s.objects[object].from, s.file.ascii, &biased));
    if (biased)
        s.warn("a curve",
               " has velocities or biased tangents, which were read as plain ones: bake animations on export");
    return s.curve_of[object] = &s.curves.back();
}

/* The constants of a curve node: d|X, d|Y, d|Z, or of a single value d|NAME. */
static vec constants_of(const scene &s, size_t object)
{
    static const char *const axes[3] = { "d|X", "d|Y", "d|Z" };
    vec out = channel().constant;
    bool is_vector = false;
    for (int k = 0; k < 3; ++k) {
        out[k] = s.real(object, axes[k], out[k]);
        is_vector = is_vector || s.objects[object].own.count(axes[k]);
    }
    for (const auto &p : s.objects[object].own)
        if (!is_vector && p.first.compare(0, 2, "d|") == 0 && !p.second.empty()) out[0] = number_of(p.second[0]);
    return out;
}

static void read_curve_node(scene &s, size_t object, layer &out)
{
    const fbx::object &o = s.objects[object];
    channel c;
    c.constant = constants_of(s, object);
    for (const link &l : o.below) {
        const int axis = l.property == "d|Y" ? 1 : l.property == "d|Z" ? 2 : 0;
        if (s.objects[l.other].kind == "AnimationCurve") c.curves[axis] = curve_at(s, l.other);
    }
    for (const link &l : o.above)
        if (!l.property.empty()) out.channels[{ l.other, l.property }] = c;
}

static layer read_layer(scene &s, size_t object)
{
    layer out;
    out.object = object;
    out.mode = s.real(object, "BlendMode", 0.0) == 0.0 ? blending::add : blending::override;
    out.rotation_by_channel = s.real(object, "RotationAccumulationMode", 0.0) != 0.0;
    out.scaling_added = s.real(object, "ScaleAccumulationMode", 0.0) != 0.0;
    out.weight = s.real(object, "Weight", 100.0) / 100.0;
    for (size_t curve_node : s.below(object, "AnimationCurveNode", nullptr)) read_curve_node(s, curve_node, out);
    return out;
}

/* The weight of a layer may be animated by any. */
static void find_weights(take &t)
{
    for (layer &l : t.layers)
        for (const layer &other : t.layers) {
            const auto found = other.channels.find({ l.object, "Weight" });
            if (found != other.channels.end() && found->second.curves[0]) l.weight_curve = found->second.curves[0];
        }
}

void read_takes(scene &s)
{
    for (size_t i = 0; i < s.objects.size(); ++i) {
        if (s.objects[i].kind != "AnimationStack") continue;
        take t;
        t.name = s.objects[i].name;
        t.from_s = s.real(i, "LocalStart", 0.0) / ticks_per_second;
        t.to_s = s.real(i, "LocalStop", 0.0) / ticks_per_second;
        for (size_t l : s.below(i, "AnimationLayer", nullptr))
            if (s.real(l, "Mute", 0.0) == 0.0) t.layers.push_back(read_layer(s, l));
        if (!t.layers.empty()) t.layers[0].is_base = true;
        find_weights(t);
        s.takes.push_back(std::move(t));
    }
}

/* --- the times at which takes are read --- */

/* False: it has no keys. */
static bool find_keys(const take &t, double *from_s, double *to_s)
{
    *from_s = HUGE_VAL;
    *to_s = -HUGE_VAL;
    for (const layer &l : t.layers)
        for (const auto &c : l.channels)
            for (const curve *of : c.second.curves)
                if (of && !of->keys.empty()) {
                    *from_s = std::min(*from_s, of->keys.front().time_s);
                    *to_s = std::max(*to_s, of->keys.back().time_s);
                }
    return *from_s <= *to_s;
}

/* The frames of what the take says it spans; where that cannot be, from the first key to the last. */
static void plan_take(scene &s, take &t, double rate_hz, double *left)
{
    const double nodes = static_cast<double>(s.models.size() + 1);
    double from, to;
    if (!find_keys(t, &from, &to)) return;
    if (t.to_s > t.from_s && (t.to_s - t.from_s) * rate_hz * nodes <= *left) {
        from = t.from_s;
        to = t.to_s;
    }
    *left -= ((to - from) * rate_hz + 2.0) * nodes;
    if (*left < 0.0) {
        s.warn("take '" + t.name + "'", " is too long and was left out: cut it in its program");
        *left = 0.0;
        return;
    }
    const size_t frames = static_cast<size_t>((to - from) * rate_hz + 1e-3);
    for (size_t i = 0; i <= frames; ++i) t.samples.push_back(from + static_cast<double>(i) / rate_hz);
    if (to - t.samples.back() > 1e-3 / rate_hz) t.samples.push_back(to);
}

void plan_samples(scene &s)
{
    const double rate_hz = s.rate_hz > rate_max_hz ? usual_rate_hz
                                                   : s.rate_hz * std::ceil(rate_min_hz / s.rate_hz - 1e-9);
    double left = samples_max;
    for (take &t : s.takes) plan_take(s, t, rate_hz, &left);
}

} // namespace fbx
