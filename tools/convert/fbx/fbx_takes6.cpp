/* fbx_takes6.cpp: takes of version 6: channels below a model, each key a run of values and letters. */
#include "fbx_scene.h"

#include <algorithm>
#include <cmath>

namespace fbx
{

/* The values of a `Key:` line, one after the other. Letters are codes in binary files. */
struct key_reader {
    const std::vector<value> &values;
    size_t at;
    char letter(char otherwise)
    {
        if (at >= values.size()) return otherwise;
        const value &v = values[at++];
        if (!std::holds_alternative<std::string>(v)) return static_cast<char>(whole_of(v));
        return text_of(v).empty() ? otherwise : text_of(v)[0];
    }
    double real()
    {
        if (at >= values.size() || std::holds_alternative<std::string>(values[at])) return 0.0;
        return number_of(values[at++]);
    }
};

/* False: a kind of key that is not known. *is_automatic: its slopes follow from its neighbours. */
static bool read_tangents(key_reader &from, key &k, bool *is_automatic)
{
    const char slope = from.letter('s');
    if (slope == 's' || slope == 'b') {
        k.right = from.real();
        k.left = from.real();
    }
    *is_automatic = slope == 'a';
    if (slope != 's' && slope != 'b' && slope != 'a') return false;
    const char weighted = from.letter('n');
    if (weighted == 'a' || weighted == 'r') k.right_weight = from.real();
    if (weighted == 'a' || weighted == 'l') k.left_weight = from.real();
    return true;
}

static bool read_key(key_reader &from, key &k, bool *is_automatic)
{
    k = { 0, 0, interpolation::cubic, 0, 0, 1.0 / 3, 1.0 / 3 };
    k.time_s = from.real() / ticks_per_second;
    k.value = from.real();
    *is_automatic = false;
    switch (from.letter('L')) {
    case 'C': k.mode = from.letter('s') == 'n' ? interpolation::constant_next : interpolation::constant; return true;
    case 'L': k.mode = interpolation::linear; return true;
    case 'U': return read_tangents(from, k, is_automatic);
    default: return false;
    }
}

/* Null: the channel has no keys. */
static const curve *read_keys(scene &s, const node &channel)
{
    const node *line = channel.child("Key");
    std::vector<bool> automatic;
    curve c;
    if (!line) return nullptr;
    key_reader from{ line->values, 0 };
    while (from.at + 2 < line->values.size()) {
        key k;
        bool is_automatic;
        if (!read_key(from, k, &is_automatic)) {
            s.warn("a curve", " has keys of an unknown kind, and ends before them: bake animations on export");
            break;
        }
        while (!c.keys.empty() && c.keys.back().time_s >= k.time_s) {
            c.keys.pop_back();
            automatic.pop_back();
        }
        c.keys.push_back(k);
        automatic.push_back(is_automatic);
    }
    for (size_t i = 0; i < c.keys.size(); ++i) {
        if (!automatic[i]) continue;
        c.keys[i].right = automatic_slope(c.keys, i, SLOPE_THROUGH_NEIGHBOURS);
        if (i) c.keys[i - 1].left = c.keys[i].right;
    }
    if (c.keys.empty()) return nullptr;
    read_extrapolation(channel, c);
    s.curves.push_back(std::move(c));
    return &s.curves.back();
}

static bool read_axis(scene &s, const node &n, int axis, channel &out)
{
    const node *constant = n.child("Default");
    if (constant) out.constant[axis] = constant->number(0);
    out.curves[axis] = read_keys(s, n);
    return constant || out.curves[axis];
}

static void read_channel(scene &s, size_t object, const std::string &property, const node &n, layer &out)
{
    channel c;
    bool any = false;
    if (n.child("Channel")) {
        for (const node &axis : n.children)
            if (axis.name == "Channel")
                any = read_axis(s, axis, axis.text(0) == "Y" ? 1 : axis.text(0) == "Z" ? 2 : 0, c) || any;
    } else {
        any = read_axis(s, n, 0, c);
    }
    if (any) out.channels[{ object, property }] = c;
}

static void read_model(scene &s, const node &n, layer &out)
{
    const auto object = n.values.empty() ? s.index.end() : s.index.find(id_of(n.values[0]));
    if (object == s.index.end()) return;
    for (const node &c : n.children) {
        if (c.name != "Channel") continue;
        if (c.text(0) != "Transform") {
            read_channel(s, object->second, c.text(0), c, out);
            continue;
        }
        for (const node &part : c.children) {
            const std::string &name = part.text(0);
            const char *property = name == "T"   ? "Lcl Translation"
                                   : name == "R" ? "Lcl Rotation"
                                   : name == "S" ? "Lcl Scaling"
                                                 : nullptr;
            if (property) read_channel(s, object->second, property, part, out);
        }
    }
}

void read_takes6(scene &s)
{
    const node *takes = s.file.top.child("Takes");
    if (!takes) return;
    for (const node &n : takes->children) {
        if (n.name != "Take") continue;
        const node *span = n.child("LocalTime");
        take t;
        t.name = name_of(s, n.text(0));
        if (span) {
            t.from_s = span->number(0) / ticks_per_second;
            t.to_s = span->number(1) / ticks_per_second;
        }
        t.layers.emplace_back();
        t.layers[0].is_base = true;
        for (const node &model : n.children) read_model(s, model, t.layers[0]);
        s.takes.push_back(std::move(t));
    }
}

} // namespace fbx
