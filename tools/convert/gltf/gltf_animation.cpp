/* gltf_animation.cpp: animations, all channels decoded to floats. */
#include "gltf_internal.h"

#include <set>

namespace gltf
{

static const tinygltf::AnimationSampler &sampler_at(const tinygltf::Animation &a, int sampler, const std::string &where)
{
    if (sampler < 0 || static_cast<size_t>(sampler) >= a.samplers.size())
        fail(where, text("sampler %d does not exist: the animation has %zu", sampler, a.samplers.size()));
    return a.samplers[static_cast<size_t>(sampler)];
}

static bool path_of(const std::string &name, model_path &out)
{
    static const char *const names[] = { "weights", "translation", "rotation", "scale" };
    for (int i = 0; i < 4; ++i)
        if (name == names[i]) {
            out = static_cast<model_path>(i);
            return true;
        }
    return false;
}

static model_interpolation interpolation_of(const std::string &name, const std::string &where)
{
    if (name.empty() || name == "LINEAR") return MODEL_LINEAR;
    if (name == "STEP") return MODEL_STEP;
    if (name != "CUBICSPLINE") fail(where, "the interpolation '" + printable(name) + "' is unknown");
    return MODEL_CUBICSPLINE;
}

/* Why a channel cannot be kept, or null. Fills *path and *node. */
static const char *reason_to_skip(const file &f, const tinygltf::AnimationChannel &c, const std::string &where,
                                  model_path &path, uint32_t &node)
{
    if (c.target_node < 0) return "it has no target node";
    if (static_cast<size_t>(c.target_node) >= f.node_of.size())
        fail(where, text("node %d does not exist: the file has %zu", c.target_node, f.node_of.size()));
    node = f.node_of[static_cast<size_t>(c.target_node)];
    if (node == MODEL_NONE) return "its target node is not in the default scene";
    if (!path_of(c.target_path, path)) return "its path is unknown";
    /* if a mesh is not kept (points, lines), neither are its weights */
    int mesh = f.json.nodes[static_cast<size_t>(c.target_node)].mesh;
    if (path == MODEL_PATH_WEIGHTS && mesh >= 0 && f.out->nodes[node].mesh == MODEL_NONE) return "its mesh was skipped";
    return nullptr;
}

static uint32_t width_of(const file &f, const model_channel &c, const std::string &where)
{
    if (c.path != MODEL_PATH_WEIGHTS) return c.path == MODEL_PATH_ROTATION ? 4 : 3;
    const model_node &node = f.out->nodes[c.node];
    if (node.mesh == MODEL_NONE)
        fail(where, "weights are animated, but node '" + printable(node.name) + "' has no mesh");
    uint32_t targets = f.out->meshes[node.mesh].target_count;
    if (targets == 0)
        fail(where,
             "weights are animated, but mesh '" + printable(f.out->meshes[node.mesh].name) + "' has no morph targets");
    return targets;
}

static void check_times(const model_channel &c, const std::string &where)
{
    for (uint32_t i = 0; i < c.key_count; ++i) {
        if (c.times[i] < 0.0f)
            fail(where + text(", element %u", i), text("the key time %g is negative", static_cast<double>(c.times[i])));
        if (i > 0 && !(c.times[i] > c.times[i - 1]))
            fail(where + text(", element %u", i),
                 text("the key time %g does not increase", static_cast<double>(c.times[i])));
    }
}

static void read_times(file &f, int accessor, model_channel &c, const std::string &where)
{
    std::string input = where + " input";
    uint64_t count = accessor_at(f, accessor, input).count;
    if (count == 0 || count >= MODEL_NONE)
        fail(input + text(" (accessor %d)", accessor),
             text("%llu keys are not possible", static_cast<unsigned long long>(count)));
    c.times = allocate<float>(f, count, input);
    c.key_count = static_cast<uint32_t>(count);
    read_floats(f, accessor, 1, c_f32, count, input, c.times);
    check_times(c, input + text(" (accessor %d)", accessor));
}

/* Of CUBICSPLINE keys, only the values between the tangents are rotations. */
static void check_rotations(const model_channel &c, const std::string &where)
{
    const size_t per_key = c.interpolation == MODEL_CUBICSPLINE ? 3 : 1;
    for (size_t i = 0; i < c.key_count; ++i) {
        const float *q = c.values + (i * per_key + per_key / 2) * 4;
        double square = 0.0;
        for (int k = 0; k < 4; ++k) square += static_cast<double>(q[k]) * static_cast<double>(q[k]);
        if (!(square > 1e-6))
            fail(where + text(", element %zu", i * per_key + per_key / 2), "the rotation is a quaternion of length 0");
    }
}

static void read_values(file &f, int accessor, model_channel &c, const std::string &where)
{
    std::string output = where + " output";
    uint64_t values = uint64_t{ c.key_count } * (c.interpolation == MODEL_CUBICSPLINE ? 3 : 1);
    bool turns_or_morphs = c.path == MODEL_PATH_WEIGHTS || c.path == MODEL_PATH_ROTATION;
    uint32_t accepted = turns_or_morphs ? c_f32 | c_i8n | c_u8n | c_i16n | c_u16n : c_f32;
    /* weights are stored as scalars, one after another */
    uint32_t components = c.path == MODEL_PATH_WEIGHTS ? 1 : c.width;
    uint64_t elements = c.path == MODEL_PATH_WEIGHTS ? values * c.width : values;
    uint64_t given = accessor_at(f, accessor, output).count;
    if (given != elements)
        fail(output + text(" (accessor %d)", accessor),
             text("%u keys of width %u%s need %llu elements, but the accessor has %llu", c.key_count, c.width,
                  c.interpolation == MODEL_CUBICSPLINE ? " with tangents" : "",
                  static_cast<unsigned long long>(elements), static_cast<unsigned long long>(given)));
    c.values = allocate<float>(f, elements * components, output);
    read_floats(f, accessor, components, accepted, elements, output, c.values);
    if (c.path == MODEL_PATH_ROTATION) check_rotations(c, output + text(" (accessor %d)", accessor));
}

static void read_channel(file &f, const tinygltf::Animation &a, const tinygltf::AnimationChannel &source,
                         const std::string &where, model_channel &out)
{
    const tinygltf::AnimationSampler &sampler = sampler_at(a, source.sampler, where);
    out.interpolation = interpolation_of(sampler.interpolation, where);
    out.width = width_of(f, out, where);
    read_times(f, sampler.input, out, where);
    read_values(f, sampler.output, out, where);
}

static void read_channels(file &f, const tinygltf::Animation &a, const std::string &clip_where, model_clip &out)
{
    std::set<std::pair<uint32_t, int>> taken;
    out.channels = allocate<model_channel>(f, a.channels.size(), clip_where);
    for (size_t i = 0; i < a.channels.size(); ++i) {
        std::string where = clip_where + text(" channel %zu", i);
        model_path path = MODEL_PATH_WEIGHTS;
        uint32_t node = MODEL_NONE;
        const char *reason = reason_to_skip(f, a.channels[i], where, path, node);
        if (!reason && !taken.insert({ node, path }).second) reason = "another channel has the same target";
        if (reason) {
            leave_out(f, where, std::string(" was skipped: ") + reason);
            continue;
        }
        if (path != MODEL_PATH_WEIGHTS && !f.json.nodes[static_cast<size_t>(a.channels[i].target_node)].matrix.empty())
            leave_out(
                f, "node '" + printable(f.out->nodes[node].name) + "'",
                ": it has a matrix and is animated, which glTF forbids; the matrix was used for what is not animated");
        model_channel &channel = out.channels[out.channel_count++];
        channel.node = node;
        channel.path = path;
        read_channel(f, a, a.channels[i], where, channel);
        float last = channel.times[channel.key_count - 1];
        out.duration_s = last > out.duration_s ? last : out.duration_s;
    }
}

/* An animation without a name takes the file's, as clips of other formats do; the second such is called NAME_1. */
static std::string clip_name(const file &f, size_t index)
{
    const std::string &given = f.json.animations[index].name;
    if (!given.empty()) return given;
    std::string stem = f.path.substr(f.directory.size());
    size_t unnamed = 0;
    stem = stem.substr(0, stem.find_last_of('.'));
    for (size_t i = 0; i < index; ++i) unnamed += f.json.animations[i].name.empty();
    return unnamed ? stem + "_" + std::to_string(unnamed) : name_or(stem, "animation", index);
}

static bool has_clip(const file &f, uint32_t count, const std::string &name)
{
    for (uint32_t c = 0; c < count; ++c)
        if (name == f.out->clips[c].name) return true;
    return false;
}

/* Clips are found by their names: of two alike, only the first would be. */
static void number_clip(file &f, model_clip &clip)
{
    const uint32_t before = f.out->clip_count - 1;
    const std::string wanted = clip.name;
    std::string name = wanted;
    for (size_t n = 2; has_clip(f, before, name); ++n) name = wanted + "_" + std::to_string(n);
    if (name == wanted) return;
    warn(f, "two animations are named '%s': the second is clip '%s'", printable(wanted).c_str(),
         printable(name).c_str());
    free(clip.name);
    clip.name = nullptr;
    clip.name = copy_string(name);
}

static void read_clip(file &f, size_t index)
{
    const tinygltf::Animation &a = f.json.animations[index];
    std::string name = clip_name(f, index), where = "animation '" + printable(name) + "'";
    model_clip &clip = f.out->clips[f.out->clip_count++]; /* counted first, so that it is freed when reading fails */
    clip.name = copy_string(name);
    read_channels(f, a, where, clip);
    if (clip.channel_count > 0) {
        number_clip(f, clip);
        read_extras(f, a, where, clip);
        return;
    }
    leave_out(f, where, " was skipped: none of its channels is left");
    free(clip.channels);
    free(clip.name);
    clip = model_clip();
    --f.out->clip_count;
}

void read_animations(file &f)
{
    f.out->clips = allocate<model_clip>(f, f.json.animations.size(), "animations");
    for (size_t i = 0; i < f.json.animations.size(); ++i) read_clip(f, i);
}

} // namespace gltf
