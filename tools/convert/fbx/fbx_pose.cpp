/* fbx_pose.cpp: layers blended, and transforms of nodes with pivots, offsets and inherit types. */
#include "fbx_pose.h"

#include <algorithm>
#include <cmath>

namespace fbx
{

/* --- a property at a time --- */

/* otherwise: of axes that the channel says nothing about */
static vec channel_at(const channel &c, double seconds, const vec &otherwise)
{
    vec out = otherwise;
    for (int k = 0; k < 3; ++k)
        if (c.curves[k])
            out[k] = c.curves[k]->at(seconds);
        else if (std::isfinite(c.constant[k]))
            out[k] = c.constant[k];
    return out;
}

/* a^share, of the magnitude, with the sign of b. */
static double power(double a, double share, double sign_of)
{
    return std::copysign(std::pow(std::fabs(a), share), sign_of);
}

/* Rotations blend as quaternions, in XYZ whatever the order of the node is. */
static vec add_layer(const vec &below, const vec &value, const layer &l, double weight, animated::kind is)
{
    vec out = below;
    if (is == animated::kind::rotation && !l.rotation_by_channel)
        return angles(euler(value * weight, 0) * euler(below, 0));
    if (is == animated::kind::scaling && !l.scaling_added)
        for (int k = 0; k < 3; ++k) out[k] *= power(value[k], weight, value[k]);
    else
        out = out + value * weight;
    return out;
}

static vec override_layer(const vec &below, const vec &value, const layer &l, double weight, animated::kind is)
{
    vec out = below * (1.0 - weight) + value * weight;
    if (is == animated::kind::rotation && !l.rotation_by_channel)
        return angles(slerp(euler(below, 0), euler(value, 0), weight));
    if (is == animated::kind::scaling && !l.scaling_added)
        for (int k = 0; k < 3; ++k)
            out[k] = power(below[k], 1.0 - weight, value[k]) * std::fabs(power(value[k], weight, 1.0));
    return out;
}

vec animated::at(double seconds) const
{
    vec out = rest;
    if (layers.empty()) return out;
    for (const auto &[l, c] : layers) {
        const bool adds = !l->is_base && l->mode == blending::add;
        const double same = is == kind::scaling && !l->scaling_added ? 1.0 : 0.0;
        const vec value = channel_at(*c, seconds, adds ? vec{ { same, same, same } } : out);
        double weight = l->weight_curve ? l->weight_curve->at(seconds) / 100.0 : l->weight;
        weight = std::max(0.0, std::min(1.0, weight));
        if (l->is_base)
            out = value;
        else
            out = adds ? add_layer(out, value, *l, weight, is) : override_layer(out, value, *l, weight, is);
    }
    for (int k = 0; k < 3; ++k)
        if (!std::isfinite(out[k])) out[k] = rest[k];
    return out;
}

animated animate(const take *t, size_t object, const std::string &property, const vec &rest)
{
    animated out;
    out.rest = rest;
    out.is = property == "Lcl Rotation"  ? animated::kind::rotation
             : property == "Lcl Scaling" ? animated::kind::scaling
                                         : animated::kind::plain;
    if (!t) return out;
    for (const layer &l : t->layers) {
        const auto found = l.channels.find({ object, property });
        if (found != l.channels.end()) out.layers.push_back({ &l, &found->second });
    }
    return out;
}

/* --- nodes --- */

std::vector<rig_node> make_rig(const scene &s, const take *t)
{
    std::vector<rig_node> out;
    for (size_t i = 0; i < s.models.size(); ++i) {
        const size_t m = s.models[i];
        const auto get = [&](const char *name, double otherwise) {
            return animate(t, m, name, s.vector(m, name, otherwise));
        };
        rig_node n;
        n.parent = s.parent[i];
        n.has_spaces = s.real(m, "RotationActive", 0.0) != 0.0 && s.real(m, "RotationSpaceForLimitOnly", 0.0) == 0.0;
        n.rotation_order = n.has_spaces ? s.whole(m, "RotationOrder", 0) : 0;
        n.inherit_type = s.whole(m, "InheritType", 0);
        n.translation = get("Lcl Translation", 0.0);
        n.rotation = get("Lcl Rotation", 0.0);
        n.scaling = get("Lcl Scaling", 1.0);
        n.pre = get("PreRotation", 0.0);
        n.post = get("PostRotation", 0.0);
        n.rotation_offset = get("RotationOffset", 0.0);
        n.rotation_pivot = get("RotationPivot", 0.0);
        n.scaling_offset = get("ScalingOffset", 0.0);
        n.scaling_pivot = get("ScalingPivot", 0.0);
        out.push_back(std::move(n));
    }
    return out;
}

static void place_locally(const rig_node &n, double seconds, placed &out)
{
    const vec pivot = n.rotation_pivot.at(seconds), scaling_pivot = n.scaling_pivot.at(seconds);
    out.local_turn = euler(n.rotation.at(seconds), n.rotation_order);
    if (n.has_spaces)
        out.local_turn = euler(n.pre.at(seconds), 0) * out.local_turn * conjugate(euler(n.post.at(seconds), 0));
    out.local_scale = n.scaling.at(seconds);
    const mat moved = translation(n.translation.at(seconds) + n.rotation_offset.at(seconds) + pivot) *
                      rotation(out.local_turn) * translation(n.scaling_offset.at(seconds) + scaling_pivot - pivot) *
                      scaling(out.local_scale);
    out.local_place = moved.point(scaling_pivot * -1.0);
}

/* What a node inherits of its parent's scale: 0 after its own rotation, 1 as is, 2 without the parent's own. */
static void place_below(const rig_node &n, const placed &above, placed &out)
{
    const mat turn = rotation(out.local_turn), scale = scaling(out.local_scale);
    mat axes;
    out.turn = above.turn * turn;
    if (n.inherit_type == 0) {
        out.shape = above.shape * scale;
        axes = out.turn * out.shape;
    } else {
        mat parent = above.turn * above.shape;
        vec undone;
        for (int k = 0; k < 3; ++k) undone[k] = above.local_scale[k] != 0.0 ? 1.0 / above.local_scale[k] : 1.0;
        if (n.inherit_type == 2) parent = parent * scaling(undone);
        axes = parent * turn * scale;
        out.shape = inverse(out.turn) * axes;
    }
    axes.column[3] = above.world.point(out.local_place);
    out.world = axes;
}

void pose_rig(const std::vector<rig_node> &rig, double seconds, std::vector<placed> &out)
{
    out.resize(rig.size());
    for (size_t i = 0; i < rig.size(); ++i) {
        placed &p = out[i];
        place_locally(rig[i], seconds, p);
        if (rig[i].parent != none) {
            place_below(rig[i], out[rig[i].parent], p);
            continue;
        }
        p.turn = rotation(p.local_turn);
        p.shape = scaling(p.local_scale);
        p.world = p.turn * p.shape;
        p.world.column[3] = p.local_place;
    }
}

/* --- translation, rotation and scale --- */

/* How far the axes of `m` are from what rotation and scale give below `above`, over the longest axis. */
static double distance_of(const mat &above, const mat &m, const quat &q, const vec &scale)
{
    const mat got = rotation(q);
    double off = 0.0, longest = 0.0;
    for (int k = 0; k < 3; ++k) {
        const vec d = above.direction(got.column[k] * scale[k]) - m.column[k];
        off = std::max(off, dot(d, d));
        longest = std::max(longest, dot(m.column[k], m.column[k]));
    }
    return longest > 0.0 ? std::sqrt(off / longest) : 0.0;
}

static vec unit(const vec &v)
{
    const double length = std::sqrt(dot(v, v));
    return length > 1e-30 ? v * (1.0 / length) : v;
}

parts parts_below(const mat &above, const placed &node, bool is_parent)
{
    static const double exact = 1e-9;
    parts out;
    out.rotation = node.local_turn;
    out.scale = node.local_scale;
    out.translation = node.local_place;
    out.lost = distance_of(above, node.world, out.rotation, out.scale);
    if (is_parent && out.lost < exact) return out;
    if (std::fabs(determinant(above)) < 1e-60) { /* it cannot be seen: a scale is 0 */
        out.lost = 0.0;
        return out;
    }
    const mat m = inverse(above) * node.world;
    if (!is_parent) out.translation = m.column[3];
    if (out.lost < exact) return out;
    mat axes;
    axes.column[0] = unit(m.column[0]);
    axes.column[1] = unit(m.column[1] - axes.column[0] * dot(axes.column[0], m.column[1]));
    axes.column[2] = cross(axes.column[0], axes.column[1]);
    if (std::fabs(determinant(axes)) < 0.5) return out; /* no area: its own rotation is as good */
    out.rotation = quaternion(axes);
    for (int k = 0; k < 3; ++k) out.scale[k] = dot(axes.column[k], m.column[k]);
    out.lost = distance_of(mat(), m, out.rotation, out.scale);
    return out;
}

} // namespace fbx
