/* fbx_animation.cpp: animations of nodes and of shapes. Assimp gives keys; the curves between them are read as straight
 * lines. */
#include "fbx_internal.h"

#include <algorithm>
#include <cmath>

namespace fbx
{

static const double sparse_s = 0.1; /* keys that are further apart are worth a word */

/* Where a channel's keys are written. */
struct track {
    std::vector<float> times, values;
    bool moves = false;
    double widest = 0.0; /* seconds between two keys of different values */
};

/* Times strictly increase; of keys at one time the last holds. */
static void add_key(track &t, double time_s, const std::vector<float> &value)
{
    const float time = static_cast<float>(time_s);
    if (!std::isfinite(time_s)) return;
    for (float v : value)
        if (!std::isfinite(v)) return;
    while (!t.times.empty() && t.times.back() >= time) {
        t.times.pop_back();
        t.values.resize(t.values.size() - value.size());
    }
    if (!t.times.empty()) {
        const std::vector<float> last(t.values.end() - static_cast<std::ptrdiff_t>(value.size()), t.values.end());
        if (last != value) {
            t.moves = true;
            t.widest = std::max(t.widest, time_s - static_cast<double>(t.times.back()));
        }
    }
    t.times.push_back(time);
    t.values.insert(t.values.end(), value.begin(), value.end());
}

static void add_channel(job &j, tinygltf::Animation &a, int node, const char *path, const track &t, int type)
{
    tinygltf::AnimationSampler sampler;
    tinygltf::AnimationChannel channel;
    if (t.times.empty()) return;
    sampler.interpolation = "LINEAR";
    sampler.input = add_floats(j, t.times, TINYGLTF_TYPE_SCALAR);
    j.out.accessors.back().minValues = { static_cast<double>(t.times.front()) };
    j.out.accessors.back().maxValues = { static_cast<double>(t.times.back()) };
    sampler.output = add_floats(j, t.values, type);
    channel.sampler = static_cast<int>(a.samplers.size());
    channel.target_node = node;
    channel.target_path = path;
    a.samplers.push_back(sampler);
    a.channels.push_back(channel);
    j.widest_s = std::max(j.widest_s, t.widest);
}

/* --- nodes --- */

static void add_node_channel(job &j, tinygltf::Animation &a, const aiNodeAnim &c, double second, double begin)
{
    const auto found = j.node_named.find(c.mNodeName.C_Str());
    if (found == j.node_named.end()) return;
    const bool turned = is_root(j, found->second);
    const ai_real unit = static_cast<ai_real>(j.unit);
    track positions, rotations, scales;
    for (unsigned k = 0; k < c.mNumPositionKeys; ++k) {
        aiVector3D p = c.mPositionKeys[k].mValue;
        if (turned) p = j.to_y_up.Rotate(p);
        add_key(positions, c.mPositionKeys[k].mTime * second - begin, { p.x * unit, p.y * unit, p.z * unit });
    }
    for (unsigned k = 0; k < c.mNumRotationKeys; ++k) {
        aiQuaternion q = c.mRotationKeys[k].mValue;
        if (turned) q = j.to_y_up * q;
        add_key(rotations, c.mRotationKeys[k].mTime * second - begin, { q.x, q.y, q.z, q.w });
    }
    for (unsigned k = 0; k < c.mNumScalingKeys; ++k) {
        const aiVector3D &s = c.mScalingKeys[k].mValue;
        add_key(scales, c.mScalingKeys[k].mTime * second - begin, { s.x, s.y, s.z });
    }
    add_channel(j, a, found->second, "translation", positions, TINYGLTF_TYPE_VEC3);
    add_channel(j, a, found->second, "rotation", rotations, TINYGLTF_TYPE_VEC4);
    add_channel(j, a, found->second, "scale", scales, TINYGLTF_TYPE_VEC3);
}

/* --- shapes --- */

/* Each shape has keys of its own times; a glTF key has the weights of all. */
struct shape_keys {
    std::vector<std::pair<double, float>> keys;
    float at(double time) const
    {
        if (keys.empty()) return 0.0f;
        size_t next = 0;
        while (next < keys.size() && keys[next].first < time) ++next;
        if (next == keys.size()) return keys.back().second;
        if (next == 0 || keys[next].first == time) return keys[next].second;
        const double share = (time - keys[next - 1].first) / (keys[next].first - keys[next - 1].first);
        return static_cast<float>(static_cast<double>(keys[next - 1].second) * (1.0 - share) +
                                  static_cast<double>(keys[next].second) * share);
    }
};

/* "NODE*0": the node whose shapes these are. */
static int node_of_shapes(const job &j, const aiMeshMorphAnim &c)
{
    std::string name = c.mName.C_Str();
    const size_t star = name.rfind('*');
    if (star != std::string::npos) name.resize(star);
    const auto found = j.node_named.find(name);
    return found == j.node_named.end() ? -1 : found->second;
}

static size_t target_count(const job &j, int node)
{
    const int mesh = node < 0 ? -1 : j.out.nodes[static_cast<size_t>(node)].mesh;
    return mesh < 0 ? 0 : j.out.meshes[static_cast<size_t>(mesh)].primitives[0].targets.size();
}

static void add_shape_channel(job &j, tinygltf::Animation &a, const aiMeshMorphAnim &c, double second, double begin)
{
    const int node = node_of_shapes(j, c);
    const size_t count = target_count(j, node);
    std::vector<shape_keys> shapes(count);
    std::vector<double> times;
    track weights;
    for (unsigned k = 0; k < c.mNumKeys; ++k) {
        const aiMeshMorphKey &key = c.mKeys[k];
        times.push_back(key.mTime * second - begin);
        for (unsigned i = 0; i < key.mNumValuesAndWeights; ++i)
            if (key.mValues[i] < count)
                shapes[key.mValues[i]].keys.push_back({ times.back(), static_cast<float>(key.mWeights[i]) });
    }
    if (!count) return;
    std::sort(times.begin(), times.end());
    for (shape_keys &s : shapes) std::stable_sort(s.keys.begin(), s.keys.end());
    for (double time : times) {
        std::vector<float> value;
        for (const shape_keys &s : shapes) value.push_back(s.at(time));
        add_key(weights, time, value);
    }
    add_channel(j, a, node, "weights", weights, TINYGLTF_TYPE_SCALAR);
}

/* --- clips --- */

/* Times of a clip begin at 0 or later: where they do not, all are moved. */
static double begin_of(const aiAnimation &a, double second)
{
    double first = 0.0;
    for (unsigned c = 0; c < a.mNumChannels; ++c) {
        const aiNodeAnim &n = *a.mChannels[c];
        if (n.mNumPositionKeys) first = std::min(first, n.mPositionKeys[0].mTime * second);
        if (n.mNumRotationKeys) first = std::min(first, n.mRotationKeys[0].mTime * second);
        if (n.mNumScalingKeys) first = std::min(first, n.mScalingKeys[0].mTime * second);
    }
    for (unsigned c = 0; c < a.mNumMorphMeshChannels; ++c)
        if (a.mMorphMeshChannels[c]->mNumKeys)
            first = std::min(first, a.mMorphMeshChannels[c]->mKeys[0].mTime * second);
    return first;
}

/* Blender writes "Armature|walk", Mixamo always "mixamo.com": that is no name, and the file's is taken. */
static std::string clip_name(const job &j, const aiAnimation &a)
{
    std::string name = a.mName.C_Str();
    const size_t bar = name.rfind('|');
    if (bar != std::string::npos && bar + 1 < name.size()) name.erase(0, bar + 1);
    return j.scene->mNumAnimations == 1 && (name == "mixamo.com" || name == "Take 001") ? "" : name;
}

void read_animations(job &j)
{
    for (unsigned i = 0; i < j.scene->mNumAnimations; ++i) {
        const aiAnimation &given = *j.scene->mAnimations[i];
        const double second = 1.0 / (given.mTicksPerSecond > 0.0 ? given.mTicksPerSecond : 25.0);
        const double begin = begin_of(given, second);
        tinygltf::Animation a;
        a.name = clip_name(j, given);
        for (unsigned c = 0; c < given.mNumChannels; ++c) add_node_channel(j, a, *given.mChannels[c], second, begin);
        for (unsigned c = 0; c < given.mNumMorphMeshChannels; ++c)
            add_shape_channel(j, a, *given.mMorphMeshChannels[c], second, begin);
        if (!a.channels.empty()) j.out.animations.push_back(a);
    }
    if (j.widest_s > sparse_s)
        note(j, "keys of an animation are up to " + std::to_string(j.widest_s).substr(0, 4) +
                    " s apart, and the curves between them were read as straight lines: bake animations on export");
}

} // namespace fbx
