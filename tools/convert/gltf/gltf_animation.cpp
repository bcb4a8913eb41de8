/* gltf_animation.cpp: animations, all channels decoded to floats. */
#include "gltf_internal.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "noh/low_motion.h"

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

static model_interpolation interpolation_of(file &f, const std::string &name, const std::string &where)
{
    if (name == "STEP") return MODEL_STEP;
    if (name == "CUBICSPLINE") return MODEL_CUBICSPLINE;
    if (!name.empty() && name != "LINEAR")
        leave_out(f, where, ": the interpolation '" + printable(name) + "' is unknown; LINEAR was used");
    return MODEL_LINEAR;
}

/* --- what a channel moves --- */

/* A channel's target: a node's path, written out or as a pointer (KHR_animation_pointer). */
struct target {
    int node;
    std::string path;
};

std::string pointer_of(const tinygltf::AnimationChannel &c)
{
    const auto found = c.target_extensions.find("KHR_animation_pointer");
    if (found == c.target_extensions.end() || !found->second.Has("pointer")) return "";
    const tinygltf::Value &pointer = found->second.Get("pointer");
    return pointer.IsString() ? pointer.Get<std::string>() : "";
}

/* Nodes from this one on are instances (gltf_scene.cpp): each draws the mesh of the node above it, which draws none. */
static uint32_t first_instance(const file &f)
{
    uint32_t first = 0;
    for (uint32_t node : f.node_of)
        if (node != MODEL_NONE) first = std::max(first, node + 1);
    return first;
}

/* The nodes that draw a mesh, themselves or by instances. */
static std::vector<bool> drawing_nodes(const file &f)
{
    const uint32_t instances = first_instance(f);
    std::vector<bool> out(f.out->node_count);
    for (uint32_t n = 0; n < f.out->node_count; ++n)
        if (f.out->nodes[n].mesh != MODEL_NONE) out[n < instances ? n : f.out->nodes[n].parent] = true;
    return out;
}

/* "/nodes/2/rotation"; "/meshes/1/weights" is of the first node that draws the mesh; where none does, of the last that
 * has it. */
static target target_of(const file &f, const tinygltf::AnimationChannel &c)
{
    char path[16] = "";
    unsigned index = 0;
    int end = 0;
    const std::string pointer = c.target_path == "pointer" ? pointer_of(c) : "";
    if (pointer.empty()) return { c.target_node, c.target_path };
    if (sscanf(pointer.c_str(), "/nodes/%9u/%15[a-z]%n", &index, path, &end) == 2 &&
        static_cast<size_t>(end) == pointer.size())
        return { static_cast<int>(index), path };
    target found = { c.target_node, "pointer" };
    if (sscanf(pointer.c_str(), "/meshes/%9u/weights%n", &index, &end) != 1 ||
        static_cast<size_t>(end) != pointer.size())
        return found;
    const std::vector<bool> draws = drawing_nodes(f);
    for (size_t n = 0; n < f.json.nodes.size(); ++n) {
        if (f.json.nodes[n].mesh != static_cast<int>(index) || f.node_of[n] == MODEL_NONE) continue;
        found = { static_cast<int>(n), "weights" };
        if (draws[f.node_of[n]]) break;
    }
    return found;
}

/* The node that has a node's weights: its first instance, which the others follow by the names of their targets. */
static uint32_t node_of_weights(const file &f, uint32_t node)
{
    if (f.out->nodes[node].mesh != MODEL_NONE) return node;
    for (uint32_t n = first_instance(f); n < f.out->node_count; ++n)
        if (f.out->nodes[n].parent == node && f.out->nodes[n].mesh != MODEL_NONE) return n;
    return node;
}

/* Why a channel cannot be kept, or an empty text. Fills c.path and c.node. */
static std::string reason_to_skip(const file &f, const target &t, const tinygltf::AnimationChannel &source,
                                  model_channel &c)
{
    if (t.path == "pointer")
        return "its pointer '" + printable(pointer_of(source)) + "' is to nothing that a clip moves";
    if (t.node < 0) return "it has no target node";
    if (static_cast<size_t>(t.node) >= f.node_of.size()) return "its target node does not exist";
    c.node = f.node_of[static_cast<size_t>(t.node)];
    if (c.node == MODEL_NONE) return "its target node is not in the default scene";
    if (!path_of(t.path, c.path)) return "its path is unknown";
    if (c.path != MODEL_PATH_WEIGHTS) return "";
    c.node = node_of_weights(f, c.node);
    /* of a hidden node, and of a mesh that is not kept (points, lines), neither are the weights */
    const uint32_t mesh = f.out->nodes[c.node].mesh;
    if (mesh == MODEL_NONE && f.json.nodes[static_cast<size_t>(t.node)].mesh >= 0) return "its mesh is not drawn";
    if (mesh == MODEL_NONE) return "it animates weights of a node without a mesh";
    return f.out->meshes[mesh].target_count ? "" : "it animates weights of a mesh without morph targets";
}

static uint32_t width_of(const file &f, const model_channel &c)
{
    if (c.path == MODEL_PATH_WEIGHTS) return f.out->meshes[f.out->nodes[c.node].mesh].target_count;
    return c.path == MODEL_PATH_ROTATION ? 4 : 3;
}

/* --- keys --- */

/* Floats of one key: of CUBICSPLINE in-tangent, value, out-tangent. */
static size_t key_width(const model_channel &c)
{
    return size_t{ c.width } * (c.interpolation == MODEL_CUBICSPLINE ? 3 : 1);
}

static void read_times(file &f, int accessor, model_channel &c, const std::string &where)
{
    std::string input = where + " input";
    uint64_t count = accessor_at(f, accessor, input).count;
    if (count >= MODEL_NONE)
        fail(input + text(" (accessor %d)", accessor),
             text("%llu keys are not possible", static_cast<unsigned long long>(count)));
    c.times = allocate<float>(f, count, input);
    c.key_count = static_cast<uint32_t>(count);
    read_floats(f, accessor, 1, c_f32, count, input, c.times);
}

static void read_values(file &f, int accessor, model_channel &c, const std::string &where)
{
    std::string output = where + " output";
    bool turns_or_morphs = c.path == MODEL_PATH_WEIGHTS || c.path == MODEL_PATH_ROTATION;
    uint32_t accepted = turns_or_morphs ? c_f32 | c_i8n | c_u8n | c_i16n | c_u16n : c_f32;
    /* weights are stored as scalars, one after another */
    uint32_t components = c.path == MODEL_PATH_WEIGHTS ? 1 : c.width;
    uint64_t given = accessor_at(f, accessor, output).count, per_key = key_width(c) / components;
    if (given != c.key_count * per_key)
        leave_out(f, output + text(" (accessor %d)", accessor),
                  ": the number of values does not fit the number of keys; what has no partner was left out");
    c.key_count = static_cast<uint32_t>(std::min<uint64_t>(c.key_count, given / per_key));
    c.values = allocate<float>(f, given * components, output);
    read_floats(f, accessor, components, accepted, given, output, c.values);
}

/* Of CUBICSPLINE keys, only the values between the tangents are rotations. */
static const char *fault_of_key(const model_channel &c, size_t key)
{
    const size_t width = key_width(c);
    const float *values = c.values + key * width, *q = values + (width / c.width / 2) * 4;
    double square = 0.0;
    bool numbers = !std::isnan(c.times[key]);
    for (size_t i = 0; i < width; ++i) numbers = numbers && !std::isnan(values[i]);
    if (!numbers) return ": a key with a number that is NaN, infinite or above 1e12 was left out";
    for (int k = 0; k < 4 && c.path == MODEL_PATH_ROTATION; ++k)
        square += static_cast<double>(q[k]) * static_cast<double>(q[k]);
    return c.path == MODEL_PATH_ROTATION && !(square > 1e-6)
               ? ": a key whose rotation is a quaternion of length 0 was left out"
               : nullptr;
}

/* The keys that can be used, by time; of several at one time the last. */
static std::vector<size_t> usable_keys(file &f, const model_channel &c, const std::string &where)
{
    std::vector<size_t> keys, kept;
    for (size_t k = 0; k < c.key_count; ++k) {
        if (const char *fault = fault_of_key(c, k))
            leave_out(f, where + text(" key %zu", k), fault);
        else
            keys.push_back(k);
    }
    const auto earlier = [&c](size_t a, size_t b) { return c.times[a] < c.times[b]; };
    if (!std::is_sorted(keys.begin(), keys.end(), earlier)) {
        leave_out(f, where, ": its keys are not in the order of their times; they were sorted");
        std::stable_sort(keys.begin(), keys.end(), earlier);
    }
    for (size_t k : keys) {
        if (kept.empty() || c.times[kept.back()] < c.times[k]) {
            kept.push_back(k);
            continue;
        }
        leave_out(f, where + text(" key %zu at %g s", k, static_cast<double>(c.times[k])),
                  " has the time of the key before it; the later one was kept");
        kept.back() = k;
    }
    return kept;
}

static void keep_usable_keys(file &f, model_channel &c, const std::string &where)
{
    const std::vector<size_t> keys = usable_keys(f, c, where);
    const size_t width = key_width(c);
    const std::vector<float> times(c.times, c.times + c.key_count);
    const std::vector<float> values(c.values, c.values + c.key_count * width);
    if (keys.empty()) fail(where, "it has no key that can be used");
    for (size_t i = 0; i < keys.size(); ++i) {
        c.times[i] = times[keys[i]];
        std::copy_n(&values[keys[i] * width], width, c.values + i * width);
    }
    c.key_count = static_cast<uint32_t>(keys.size());
}

/* --- channels --- */

static void read_channel(file &f, const tinygltf::Animation &a, const tinygltf::AnimationChannel &source,
                         const std::string &where, model_channel &out)
{
    const tinygltf::AnimationSampler &sampler = sampler_at(a, source.sampler, where);
    out.interpolation = interpolation_of(f, sampler.interpolation, where);
    out.width = width_of(f, out);
    read_times(f, sampler.input, out, where);
    read_values(f, sampler.output, out, where);
    keep_usable_keys(f, out, where);
}

/* A channel that cannot be read is left out: the character moves without it. */
static void try_channel(file &f, const tinygltf::Animation &a, const tinygltf::AnimationChannel &source,
                        const std::string &where, model_clip &out)
{
    model_channel &channel = out.channels[out.channel_count++]; /* counted first, so that it is freed */
    const model_channel found = channel;
    if (attempt(f, "; the channel was left out", [&] { read_channel(f, a, source, where, channel); })) return;
    free(channel.times);
    free(channel.values);
    channel = found;
    --out.channel_count;
}

/* --- weights that stay --- */

/* A float that no clip moves follows the float of its name that one moves: teeth follow the jaw of a face. Names that
 * this reader made, and nodes with the same mesh, mean no such thing. */
static bool would_follow(const model &m, const model_channel &moved, uint32_t node)
{
    const uint32_t from = m.nodes[moved.node].mesh, mesh = m.nodes[node].mesh;
    if (moved.path != MODEL_PATH_WEIGHTS || mesh == MODEL_NONE || !m.meshes[mesh].target_count) return false;
    for (uint32_t t = 0; from != mesh && t < m.meshes[mesh].target_count; ++t) {
        const std::string made = name_or("", "target", t);
        if (t < m.meshes[from].target_count && made == m.meshes[from].targets[t].name &&
            made == m.meshes[mesh].targets[t].name)
            return true;
    }
    return from == mesh;
}

/* The channel whose weights a node would follow, or null. */
static const model_channel *follows(const file &f, const model_clip &clip, uint32_t node)
{
    const model &m = *f.out;
    const uint32_t instances = first_instance(f);
    const model_channel *found = nullptr;
    for (uint32_t i = 0; i < clip.channel_count; ++i) {
        const model_channel &c = clip.channels[i];
        if (c.path == MODEL_PATH_WEIGHTS && c.node == node) return nullptr;
        if (c.path == MODEL_PATH_WEIGHTS && std::min(c.node, node) >= instances &&
            m.nodes[c.node].parent == m.nodes[node].parent)
            return nullptr;
        if (!found && would_follow(m, c, node)) found = &c;
    }
    return found;
}

static void hold_weights(file &f, uint32_t node, float time_s, const std::string &where, model_channel &out)
{
    const model_node &n = f.out->nodes[node];
    const model_mesh &mesh = f.out->meshes[n.mesh];
    out.node = node;
    out.path = MODEL_PATH_WEIGHTS;
    out.interpolation = MODEL_STEP;
    out.key_count = 1;
    out.width = mesh.target_count;
    out.times = allocate<float>(f, 1, where);
    out.times[0] = time_s;
    out.values = allocate<float>(f, mesh.target_count, where);
    std::copy_n(n.weights ? n.weights : mesh.weights, mesh.target_count, out.values);
}

/* Nodes that would follow others by name keep their own weights, if a clip can hold them all. */
static void hold_others(file &f, const std::string &where, model_clip &out)
{
    std::vector<std::pair<uint32_t, float>> held;
    size_t floats = 0;
    for (uint32_t i = 0; i < out.channel_count; ++i)
        if (out.channels[i].path == MODEL_PATH_WEIGHTS) floats += out.channels[i].width;
    for (uint32_t n = 0; floats && n < f.out->node_count; ++n)
        if (const model_channel *c = follows(f, out, n)) {
            floats += f.out->meshes[f.out->nodes[n].mesh].target_count;
            if (floats > NOH_CLIP_FLOATS_MAX || held.size() >= NOH_CLIP_GROUPS_MAX / 2)
                return leave_out(
                    f, where,
                    ": it moves the weights of a node, and too many others have the same targets for a clip "
                    "to hold: they move along. Give the targets of each mesh names of their own");
            held.push_back({ n, c->times[0] });
        }
    if (held.empty()) return;
    model_channel *channels = allocate<model_channel>(f, out.channel_count + held.size(), where);
    std::copy_n(out.channels, out.channel_count, channels);
    free(out.channels);
    out.channels = channels;
    for (const auto &h : held) hold_weights(f, h.first, h.second, where, out.channels[out.channel_count++]);
}

static void read_channels(file &f, const tinygltf::Animation &a, const std::string &clip_where, model_clip &out)
{
    std::set<std::pair<uint32_t, int>> taken;
    out.channels = allocate<model_channel>(f, a.channels.size(), clip_where);
    for (size_t i = 0; i < a.channels.size(); ++i) {
        const std::string where = clip_where + text(" channel %zu", i);
        const target t = target_of(f, a.channels[i]);
        model_channel &channel = out.channels[out.channel_count];
        std::string reason = reason_to_skip(f, t, a.channels[i], channel);
        if (reason.empty() && !taken.insert({ channel.node, channel.path }).second)
            reason = "another channel has the same target";
        if (!reason.empty()) {
            leave_out(f, where, " was skipped: " + reason);
            continue;
        }
        if (channel.path != MODEL_PATH_WEIGHTS && !f.json.nodes[static_cast<size_t>(t.node)].matrix.empty())
            leave_out(
                f, "node '" + printable(f.out->nodes[channel.node].name) + "'",
                ": it has a matrix and is animated, which glTF forbids; the matrix was used for what is not animated");
        try_channel(f, a, a.channels[i], where, out);
    }
    hold_others(f, clip_where, out);
    for (uint32_t i = 0; i < out.channel_count; ++i) {
        const float last = out.channels[i].times[out.channels[i].key_count - 1];
        out.duration_s = i == 0 || last > out.duration_s ? last : out.duration_s;
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
