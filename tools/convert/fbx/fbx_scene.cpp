/* fbx_scene.cpp: nodes, the file's axes and its unit. */
#include "fbx_internal.h"

#include <cmath>
#include <cstring>

namespace fbx
{

/* --- bytes --- */

int add_view(job &j, const void *bytes, size_t size)
{
    if (j.out.buffers.empty()) j.out.buffers.emplace_back();
    std::vector<unsigned char> &data = j.out.buffers[0].data;
    data.resize((data.size() + 3) & ~size_t{ 3 });
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = size;
    const unsigned char *first = static_cast<const unsigned char *>(bytes);
    data.insert(data.end(), first, first + size);
    j.out.bufferViews.push_back(view);
    return static_cast<int>(j.out.bufferViews.size() - 1);
}

static int add_accessor(job &j, const void *bytes, size_t size, int component, int type, size_t values)
{
    tinygltf::Accessor a;
    a.bufferView = add_view(j, bytes, size);
    a.componentType = component;
    a.type = type;
    a.count = values / static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type)));
    j.out.accessors.push_back(a);
    return static_cast<int>(j.out.accessors.size() - 1);
}

int add_floats(job &j, const std::vector<float> &values, int type)
{
    return add_accessor(j, values.data(), values.size() * sizeof(float), TINYGLTF_COMPONENT_TYPE_FLOAT, type,
                        values.size());
}

int add_u16(job &j, const std::vector<uint16_t> &values, int type)
{
    return add_accessor(j, values.data(), values.size() * sizeof(uint16_t), TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                        type, values.size());
}

int add_u32(job &j, const std::vector<uint32_t> &values)
{
    return add_accessor(j, values.data(), values.size() * sizeof(uint32_t), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                        TINYGLTF_TYPE_SCALAR, values.size());
}

void note(job &j, const std::string &text)
{
    for (const std::string &said : j.notes)
        if (said == text) return;
    j.notes.push_back(text);
}

/* --- axes and unit --- */

static int axis_setting(const aiScene *scene, const char *name, int otherwise)
{
    int32_t value = otherwise;
    return scene->mMetaData && scene->mMetaData->Get(name, value) && value >= -1 && value <= 2 ? value : otherwise;
}

static void read_unit(job &j)
{
    double cm = 1.0;
    float single = 1.0f;
    if (j.unit > 0.0) return; /* the caller's */
    if (j.scene->mMetaData && !j.scene->mMetaData->Get("UnitScaleFactor", cm) &&
        j.scene->mMetaData->Get("UnitScaleFactor", single))
        cm = static_cast<double>(single);
    j.unit = cm > 1e-6 && cm < 1e6 ? cm / 100.0 : 0.01;
}

/* The rows of the turn are the file's right, up and front. */
static void read_axes(job &j)
{
    const char *const names[3][2] = { { "CoordAxis", "CoordAxisSign" },
                                      { "UpAxis", "UpAxisSign" },
                                      { "FrontAxis", "FrontAxisSign" } };
    aiMatrix3x3 turn(0, 0, 0, 0, 0, 0, 0, 0, 0);
    for (unsigned row = 0; row < 3; ++row) {
        const int axis = axis_setting(j.scene, names[row][0], static_cast<int>(row));
        const int sign = axis_setting(j.scene, names[row][1], 1) < 0 ? -1 : 1;
        turn[row][axis < 0 ? row : static_cast<unsigned>(axis)] = static_cast<ai_real>(sign);
    }
    const float det = turn.Determinant();
    if (det > 0.5f) {
        j.to_y_up = aiQuaternion(turn);
    } else if (det < -0.5f) {
        note(j, "the file's axes are left-handed, so left and right are swapped: export it with right-handed axes");
        turn[2][0] = -turn[2][0];
        turn[2][1] = -turn[2][1];
        turn[2][2] = -turn[2][2];
        j.to_y_up = aiQuaternion(turn);
    }
}

/* --- nodes --- */

static std::vector<double> doubles(std::initializer_list<ai_real> values)
{
    std::vector<double> out;
    for (ai_real v : values) out.push_back(static_cast<double>(v));
    return out;
}

static int add_node(job &j, const aiNode *node, bool root)
{
    aiVector3D scale, position;
    aiQuaternion rotation;
    node->mTransformation.Decompose(scale, rotation, position);
    if (root) {
        rotation = j.to_y_up * rotation;
        position = j.to_y_up.Rotate(position);
    }
    tinygltf::Node n;
    n.name = node->mName.C_Str();
    const ai_real unit = static_cast<ai_real>(j.unit);
    n.translation = doubles({ position.x * unit, position.y * unit, position.z * unit });
    n.rotation = doubles({ rotation.x, rotation.y, rotation.z, rotation.w });
    n.scale = doubles({ scale.x, scale.y, scale.z });
    j.out.nodes.push_back(n);
    const int index = static_cast<int>(j.out.nodes.size() - 1);
    j.node_of[node] = index;
    j.node_named.insert({ n.name, index });
    return index;
}

bool is_root(const job &j, int node)
{
    for (int root : j.out.scenes[0].nodes)
        if (root == node) return true;
    return false;
}

/* Without recursion: a file may be as deep as it likes. */
static void add_nodes(job &j)
{
    const aiNode *top = j.scene->mRootNode;
    std::vector<const aiNode *> open;
    j.out.scenes.emplace_back();
    j.out.defaultScene = 0;
    if (!top) return;
    const bool skip_top = top->mNumChildren && !top->mNumMeshes && top->mTransformation.IsIdentity();
    if (skip_top)
        for (unsigned i = top->mNumChildren; i-- > 0;) open.push_back(top->mChildren[i]);
    else
        open.push_back(top);
    while (!open.empty()) {
        const aiNode *node = open.back();
        open.pop_back();
        const auto above = j.node_of.find(node->mParent);
        const int index = add_node(j, node, above == j.node_of.end());
        if (above == j.node_of.end())
            j.out.scenes[0].nodes.push_back(index);
        else
            j.out.nodes[static_cast<size_t>(above->second)].children.push_back(index);
        for (unsigned i = node->mNumChildren; i-- > 0;) open.push_back(node->mChildren[i]);
    }
}

void read_scene(job &j)
{
    read_unit(j);
    read_axes(j);
    add_nodes(j);
    read_materials(j);
    read_meshes(j);
    read_animations(j);
}

} // namespace fbx
