/* fbx_mesh.cpp: meshes, their shapes as morph targets, and skins.
 *
 * Assimp gives a vertex for each corner; those that are alike in everything become one. The meshes of a node, one for
 * each material, become the primitives of one mesh. */
#include "fbx_internal.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <unordered_map>

namespace fbx
{

struct influence {
    uint16_t joint;
    float weight;
};

/* One of Assimp's meshes while it becomes a primitive. */
struct part {
    const aiMesh *mesh;
    std::vector<std::vector<influence>> influences; /* [vertex] or empty */
    std::vector<unsigned> first;                    /* [kept vertex] the first corner like it */
    std::vector<uint32_t> indices;
};

/* A node's skin: the bones of its meshes. */
struct skin {
    std::vector<int> joints; /* nodes */
    std::vector<float> inverse_bind;
    std::map<int, uint16_t> place;
};

/* --- skins --- */

static void push_inverse_bind(const job &j, const aiMatrix4x4 &m, std::vector<float> &out)
{
    const float unit = static_cast<float>(j.unit);
    for (unsigned column = 0; column < 4; ++column)
        for (unsigned row = 0; row < 4; ++row)
            out.push_back(column == 3 && row < 3 ? m[row][column] * unit
                          : row == 3             ? (column == 3 ? 1.0f : 0.0f)
                                                 : m[row][column]);
}

static void add_bone(job &j, const aiBone &bone, part &p, skin &s)
{
    const auto node = j.node_named.find(bone.mName.C_Str());
    if (node == j.node_named.end()) {
        note(j, "no node has the name of a bone, which moves nothing: '" + std::string(bone.mName.C_Str()) + "'");
        return;
    }
    auto place = s.place.find(node->second);
    if (place == s.place.end()) {
        if (s.joints.size() > 0xffff) throw std::runtime_error("a skin has more than 65,536 bones");
        place = s.place.insert({ node->second, static_cast<uint16_t>(s.joints.size()) }).first;
        s.joints.push_back(node->second);
        push_inverse_bind(j, bone.mOffsetMatrix, s.inverse_bind);
    }
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        const aiVertexWeight &given = bone.mWeights[w];
        if (given.mVertexId < p.mesh->mNumVertices && given.mWeight > 0.0f)
            p.influences[given.mVertexId].push_back({ place->second, given.mWeight });
    }
}

static void add_bones(job &j, part &p, skin &s)
{
    if (!p.mesh->mNumBones) return;
    p.influences.resize(p.mesh->mNumVertices);
    for (unsigned b = 0; b < p.mesh->mNumBones; ++b) add_bone(j, *p.mesh->mBones[b], p, s);
    for (std::vector<influence> &of : p.influences)
        std::stable_sort(of.begin(), of.end(),
                         [](const influence &a, const influence &b) { return a.weight > b.weight; });
}

/* --- equal corners --- */

static uint64_t mix(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *b = static_cast<const unsigned char *>(bytes);
    for (size_t i = 0; i < size; ++i) hash = (hash ^ b[i]) * 0x100000001b3ull;
    return hash;
}

template <class T> static bool same(const T *array, unsigned a, unsigned b)
{
    return !array || memcmp(&array[a], &array[b], sizeof *array) == 0;
}

static bool same_corner(const part &p, unsigned a, unsigned b)
{
    const aiMesh &m = *p.mesh;
    if (!same(m.mVertices, a, b) || !same(m.mNormals, a, b) || !same(m.mTextureCoords[0], a, b) ||
        !same(m.mColors[0], a, b))
        return false;
    if (!p.influences.empty()) {
        const std::vector<influence> &of_a = p.influences[a], &of_b = p.influences[b];
        if (of_a.size() != of_b.size()) return false;
        for (size_t i = 0; i < of_a.size(); ++i)
            if (of_a[i].joint != of_b[i].joint || of_a[i].weight != of_b[i].weight) return false;
    }
    for (unsigned t = 0; t < m.mNumAnimMeshes; ++t)
        if (!same(m.mAnimMeshes[t]->mVertices, a, b) || !same(m.mAnimMeshes[t]->mNormals, a, b)) return false;
    return true;
}

static uint64_t hash_corner(const part &p, unsigned v)
{
    const aiMesh &m = *p.mesh;
    uint64_t hash = mix(0xcbf29ce484222325ull, &m.mVertices[v], sizeof m.mVertices[v]);
    if (m.mNormals) hash = mix(hash, &m.mNormals[v], sizeof m.mNormals[v]);
    if (m.mTextureCoords[0]) hash = mix(hash, &m.mTextureCoords[0][v], sizeof m.mTextureCoords[0][v]);
    return hash;
}

/* Only triangles are kept; lines and points are noted. */
static void join_corners(job &j, part &p)
{
    std::unordered_multimap<uint64_t, uint32_t> kept;
    for (unsigned f = 0; f < p.mesh->mNumFaces; ++f) {
        const aiFace &face = p.mesh->mFaces[f];
        if (face.mNumIndices != 3) {
            note(j, "points and lines of the file were left out");
            continue;
        }
        for (unsigned c = 0; c < 3; ++c) {
            const unsigned corner = face.mIndices[c];
            if (corner >= p.mesh->mNumVertices) throw std::runtime_error("a triangle refers to a missing vertex");
            const uint64_t hash = hash_corner(p, corner);
            const auto range = kept.equal_range(hash);
            auto found = range.first;
            while (found != range.second && !same_corner(p, p.first[found->second], corner)) ++found;
            if (found == range.second) {
                found = kept.insert({ hash, static_cast<uint32_t>(p.first.size()) });
                p.first.push_back(corner);
            }
            p.indices.push_back(found->second);
        }
    }
}

/* --- attributes --- */

static std::vector<float> vectors(const part &p, const aiVector3D *of, const aiVector3D *less, float scale)
{
    std::vector<float> out;
    out.reserve(p.first.size() * 3);
    for (unsigned v : p.first)
        for (unsigned k = 0; k < 3; ++k) out.push_back((of[v][k] - (less ? less[v][k] : 0.0f)) * scale);
    return out;
}

/* Bounds are required of positions. */
static int add_positions(job &j, const std::vector<float> &values)
{
    const int index = add_floats(j, values, TINYGLTF_TYPE_VEC3);
    tinygltf::Accessor &a = j.out.accessors.back();
    for (size_t k = 0; k < 3; ++k) {
        double low = 0.0, high = 0.0;
        for (size_t i = k; i < values.size(); i += 3) {
            const double v = static_cast<double>(values[i]);
            low = i == k ? v : std::min(low, v);
            high = i == k ? v : std::max(high, v);
        }
        a.minValues.push_back(low);
        a.maxValues.push_back(high);
    }
    return index;
}

static void add_influences(job &j, const part &p, tinygltf::Primitive &out)
{
    size_t most = 1;
    for (unsigned v : p.first) most = std::max(most, p.influences[v].size());
    for (size_t set = 0; set * 4 < most && set < 4; ++set) {
        std::vector<uint16_t> joints;
        std::vector<float> weights;
        for (unsigned v : p.first)
            for (size_t i = set * 4; i < set * 4 + 4; ++i) {
                const bool there = i < p.influences[v].size();
                joints.push_back(there ? p.influences[v][i].joint : 0);
                weights.push_back(there ? p.influences[v][i].weight : 0.0f);
            }
        out.attributes["JOINTS_" + std::to_string(set)] = add_u16(j, joints, TINYGLTF_TYPE_VEC4);
        out.attributes["WEIGHTS_" + std::to_string(set)] = add_floats(j, weights, TINYGLTF_TYPE_VEC4);
    }
}

static void add_targets(job &j, const part &p, size_t target_count, tinygltf::Primitive &out)
{
    const float unit = static_cast<float>(j.unit);
    for (size_t t = 0; t < target_count; ++t) {
        std::map<std::string, int> target;
        const aiAnimMesh *shape = t < p.mesh->mNumAnimMeshes ? p.mesh->mAnimMeshes[t] : nullptr;
        if (shape && shape->mVertices && shape->mNumVertices == p.mesh->mNumVertices) {
            target["POSITION"] = add_positions(j, vectors(p, shape->mVertices, p.mesh->mVertices, unit));
            if (shape->mNormals && p.mesh->mNormals)
                target["NORMAL"] = add_floats(j, vectors(p, shape->mNormals, p.mesh->mNormals, 1.0f),
                                              TINYGLTF_TYPE_VEC3);
        } else {
            target["POSITION"] = add_positions(j, std::vector<float>(p.first.size() * 3));
        }
        out.targets.push_back(target);
    }
}

static tinygltf::Primitive primitive_of(job &j, const part &p, size_t target_count)
{
    const aiMesh &m = *p.mesh;
    tinygltf::Primitive out;
    out.mode = TINYGLTF_MODE_TRIANGLES;
    out.material = m.mMaterialIndex < j.out.materials.size() ? static_cast<int>(m.mMaterialIndex) : -1;
    out.indices = add_u32(j, p.indices);
    out.attributes["POSITION"] = add_positions(j, vectors(p, m.mVertices, nullptr, static_cast<float>(j.unit)));
    if (m.mNormals) out.attributes["NORMAL"] = add_floats(j, vectors(p, m.mNormals, nullptr, 1.0f), TINYGLTF_TYPE_VEC3);
    if (m.mTextureCoords[0]) {
        std::vector<float> uvs;
        for (unsigned v : p.first) {
            uvs.push_back(m.mTextureCoords[0][v].x);
            uvs.push_back(1.0f - m.mTextureCoords[0][v].y); /* FBX counts from the bottom of the picture */
        }
        out.attributes["TEXCOORD_0"] = add_floats(j, uvs, TINYGLTF_TYPE_VEC2);
    }
    if (m.mColors[0]) {
        std::vector<float> colors;
        for (unsigned v : p.first)
            for (unsigned k = 0; k < 4; ++k) colors.push_back(std::min(std::max(m.mColors[0][v][k], 0.0f), 1.0f));
        out.attributes["COLOR_0"] = add_floats(j, colors, TINYGLTF_TYPE_VEC4);
    }
    if (!p.influences.empty()) add_influences(j, p, out);
    add_targets(j, p, target_count, out);
    return out;
}

/* --- names of targets --- */

/* Maya writes the deformer before each: "blendShape1.smile". */
static void strip_prefix(std::vector<std::string> &names)
{
    const size_t dot = names.empty() ? std::string::npos : names[0].find('.');
    if (dot == std::string::npos) return;
    for (const std::string &name : names)
        if (name.compare(0, dot + 1, names[0], 0, dot + 1) != 0 || name.size() == dot + 1) return;
    for (std::string &name : names) name.erase(0, dot + 1);
}

static tinygltf::Value names_of(const aiMesh &m, size_t count)
{
    std::vector<std::string> names;
    for (size_t t = 0; t < count; ++t) names.push_back(t < m.mNumAnimMeshes ? m.mAnimMeshes[t]->mName.C_Str() : "");
    strip_prefix(names);
    tinygltf::Value::Array values;
    for (const std::string &name : names) values.push_back(tinygltf::Value(name));
    return tinygltf::Value(tinygltf::Value::Object{ { "targetNames", tinygltf::Value(values) } });
}

/* --- a node's mesh --- */

static int add_skin(job &j, const std::string &name, const skin &s)
{
    tinygltf::Skin out;
    out.name = name;
    out.joints = s.joints;
    out.inverseBindMatrices = add_floats(j, s.inverse_bind, TINYGLTF_TYPE_MAT4);
    j.out.skins.push_back(out);
    return static_cast<int>(j.out.skins.size() - 1);
}

static void read_node(job &j, const aiNode &node, int index)
{
    tinygltf::Mesh mesh;
    skin s;
    size_t targets = 0;
    const aiMesh *named = nullptr;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        const aiMesh *m = j.scene->mMeshes[node.mMeshes[i]];
        if (!named || m->mNumAnimMeshes > targets) named = m;
        targets = std::max(targets, static_cast<size_t>(m->mNumAnimMeshes));
    }
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        part p{ j.scene->mMeshes[node.mMeshes[i]], {}, {}, {} };
        add_bones(j, p, s);
        join_corners(j, p);
        if (!p.indices.empty()) mesh.primitives.push_back(primitive_of(j, p, targets));
    }
    if (mesh.primitives.empty()) return;
    mesh.name = node.mName.C_Str();
    if (targets) mesh.extras = names_of(*named, targets);
    j.out.meshes.push_back(mesh);
    j.out.nodes[static_cast<size_t>(index)].mesh = static_cast<int>(j.out.meshes.size() - 1);
    if (!s.joints.empty()) j.out.nodes[static_cast<size_t>(index)].skin = add_skin(j, mesh.name, s);
}

void read_meshes(job &j)
{
    std::map<std::vector<unsigned>, int> drawn; /* instances: nodes of the same meshes without bones */
    std::vector<std::pair<int, const aiNode *>> nodes;
    for (const auto &of : j.node_of)
        if (of.first->mNumMeshes) nodes.push_back({ of.second, of.first });
    std::sort(nodes.begin(), nodes.end());
    for (const auto &of : nodes) {
        const std::vector<unsigned> key(of.second->mMeshes, of.second->mMeshes + of.second->mNumMeshes);
        const auto before = drawn.find(key);
        tinygltf::Node &node = j.out.nodes[static_cast<size_t>(of.first)];
        if (before != drawn.end()) {
            node.mesh = j.out.nodes[static_cast<size_t>(before->second)].mesh;
            node.skin = j.out.nodes[static_cast<size_t>(before->second)].skin;
            continue;
        }
        read_node(j, *of.second, of.first);
        drawn[key] = of.first;
    }
}

} // namespace fbx
