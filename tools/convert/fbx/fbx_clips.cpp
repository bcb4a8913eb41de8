/* fbx_clips.cpp: one animation for each take, sampled at the file's frames: glTF has no other form for curves, layers,
 * pivots and inherited scales together. */
#include "fbx_internal.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fbx
{

/* --- channels --- */

/* The keys of one property. */
struct track {
    const char *path;
    int type;
    size_t width;
    std::vector<float> values, rest;

    bool is_constant() const
    {
        for (size_t i = width; i < values.size(); ++i)
            if (values[i] != values[i - width]) return false;
        return true;
    }
    bool is_at_rest() const
    {
        return is_constant() && std::equal(rest.begin(), rest.end(), values.begin());
    }
};

/* The accessors of the times of all frames, and of the first and the last: the same where there are no others. */
struct clip_times {
    int all, ends;
};

static int add_times(job &j, const std::vector<float> &times)
{
    const int index = add_floats(j, times, TINYGLTF_TYPE_SCALAR);
    j.out.accessors.back().minValues = { static_cast<double>(times.front()) };
    j.out.accessors.back().maxValues = { static_cast<double>(times.back()) };
    return index;
}

static void add_channel(job &j, tinygltf::Animation &a, size_t node, const track &t, const clip_times &times)
{
    tinygltf::AnimationSampler sampler;
    tinygltf::AnimationChannel channel;
    std::vector<float> values = t.values;
    const bool ends = times.all != times.ends && t.is_constant();
    const auto one = t.values.begin() + static_cast<std::ptrdiff_t>(t.width);
    if (ends) {
        values.assign(t.values.begin(), one);
        values.insert(values.end(), t.values.begin(), one);
    }
    sampler.interpolation = "LINEAR";
    sampler.input = ends ? times.ends : times.all;
    sampler.output = add_floats(j, values, t.type);
    channel.sampler = static_cast<int>(a.samplers.size());
    channel.target_node = static_cast<int>(node);
    channel.target_path = t.path;
    a.samplers.push_back(sampler);
    a.channels.push_back(channel);
}

/* --- nodes --- */

struct node_tracks {
    track translation = { "translation", TINYGLTF_TYPE_VEC3, 3, {}, {} };
    track rotation = { "rotation", TINYGLTF_TYPE_VEC4, 4, {}, {} };
    track scale = { "scale", TINYGLTF_TYPE_VEC3, 3, {}, {} };
};

static std::vector<float> floats(const std::vector<double> &values)
{
    return std::vector<float>(values.begin(), values.end());
}

static void add_sample(node_tracks &n, const parts &p)
{
    std::vector<float> &r = n.rotation.values;
    float q[4] = { static_cast<float>(p.rotation.x), static_cast<float>(p.rotation.y), static_cast<float>(p.rotation.z),
                   static_cast<float>(p.rotation.w) };
    float near = 1.0f;
    if (!r.empty()) near = std::inner_product(q, q + 4, r.end() - 4, 0.0f);
    for (float v : q) r.push_back(near < 0.0f ? -v : v); /* q and -q are one rotation */
    for (int k = 0; k < 3; ++k) {
        n.translation.values.push_back(static_cast<float>(p.translation[k]));
        n.scale.values.push_back(static_cast<float>(p.scale[k]));
    }
}

static void write_node_channels(job &j, const take &t, const clip_times &times, tinygltf::Animation &a)
{
    const std::vector<rig_node> rig = make_rig(j.in, &t);
    std::vector<node_tracks> nodes(rig.size());
    std::vector<placed> pose;
    for (double at : t.samples) {
        pose_rig(rig, at, pose);
        for (size_t i = 0; i < nodes.size(); ++i) add_sample(nodes[i], parts_of(j, pose, i));
    }
    for (size_t i = 0; i < nodes.size(); ++i) {
        nodes[i].translation.rest = floats(j.out.nodes[i].translation);
        nodes[i].rotation.rest = floats(j.out.nodes[i].rotation);
        nodes[i].scale.rest = floats(j.out.nodes[i].scale);
        for (const track *of : { &nodes[i].translation, &nodes[i].rotation, &nodes[i].scale })
            if (!of->is_at_rest()) add_channel(j, a, i, *of, times);
    }
    if (a.channels.empty() && !nodes.empty()) add_channel(j, a, 0, nodes[0].rotation, times); /* it stands still */
}

/* --- shapes --- */

static void write_shape_channels(job &j, const take &t, const clip_times &times, tinygltf::Animation &a)
{
    for (const auto &[node, d] : j.drawn) {
        std::vector<animated> channels;
        track weights = { "weights", TINYGLTF_TYPE_SCALAR, d.target_count, {}, {} };
        if (d.mesh < 0 || !d.target_count) continue;
        for (const shape_channel &c : d.channels)
            channels.push_back(animate(&t, c.object, c.property, { { c.rest, 0.0, 0.0 } }));
        for (double at : t.samples) {
            std::vector<double> percent;
            for (const animated &c : channels) percent.push_back(c.at(at)[0]);
            for (double w : weights_of(d.channels, percent, d.target_count))
                weights.values.push_back(static_cast<float>(w));
        }
        weights.rest = floats(j.out.meshes[static_cast<size_t>(d.mesh)].weights);
        if (!weights.is_at_rest()) add_channel(j, a, node, weights, times);
    }
}

/* --- clips --- */

/* Blender writes "Armature|walk", Mixamo always "mixamo.com": that is no name, and the file's is taken. */
static std::string clip_name(const take &t, std::ptrdiff_t take_count)
{
    const size_t bar = t.name.rfind('|');
    const std::string name = bar != std::string::npos && bar + 1 < t.name.size() ? t.name.substr(bar + 1) : t.name;
    return take_count == 1 && (name == "mixamo.com" || name == "Take 001") ? "" : name;
}

/* Curves of transforms, shapes and layer weights are followed, and no others. */
static bool is_followed(const job &j, size_t object, const std::string &property)
{
    static const std::set<std::string> transforms = {
        "Lcl Translation", "Lcl Rotation",  "Lcl Scaling",   "PreRotation",  "PostRotation",
        "RotationOffset",  "RotationPivot", "ScalingOffset", "ScalingPivot",
    };
    if (j.in.objects[object].kind == "Model" && transforms.count(property)) return true;
    if (j.in.objects[object].kind == "AnimationLayer") return true;
    for (const auto &d : j.drawn)
        for (const shape_channel &c : d.second.channels)
            if (c.object == object && c.property == property) return true;
    return false;
}

static void warn_of_curves(job &j, const take &t)
{
    for (const layer &l : t.layers)
        for (const auto &c : l.channels) {
            const bool moves = std::any_of(c.second.curves, c.second.curves + 3,
                                           [](const curve *of) { return of && of->changes(); });
            if (moves && !is_followed(j, c.first.first, c.first.second))
                j.in.warn(place_of(j.in, c.first.first) + " " + c.first.second,
                          ": animation of this property is not read and was left out");
        }
}

static void write_clip(job &j, const take &t, const std::string &name)
{
    std::vector<float> times;
    tinygltf::Animation a;
    clip_times of;
    for (double at : t.samples) times.push_back(static_cast<float>(at - t.samples[0]));
    of.all = of.ends = add_times(j, times);
    if (times.size() > 2) of.ends = add_times(j, { times.front(), times.back() });
    a.name = name;
    write_node_channels(j, t, of, a);
    write_shape_channels(j, t, of, a);
    if (!a.channels.empty()) j.out.animations.push_back(a);
}

void write_clips(job &j)
{
    const std::ptrdiff_t count = std::count_if(j.in.takes.begin(), j.in.takes.end(),
                                               [](const take &t) { return !t.samples.empty(); });
    for (const take &t : j.in.takes) {
        if (t.samples.empty()) continue;
        warn_of_curves(j, t);
        write_clip(j, t, clip_name(t, count));
    }
}

} // namespace fbx
