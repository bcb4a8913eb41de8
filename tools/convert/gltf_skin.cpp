/* gltf_skin.cpp: where a skinned mesh stands while it is drawn unskinned.
 *
 * A skinned mesh's own node does not place it; its joints do (glTF 2.0, 3.7.3).
 * In the rest pose that is joint matrix times inverse bind matrix, the same for
 * every joint when the rest pose is the bind pose. Until skinning is applied at
 * run time the first joint's product stands for all: it also carries the
 * dequantisation that packers put into inverse bind matrices. */
#include "gltf_internal.h"

#include <cmath>
#include <cstring>

namespace gltf {

static void multiply(const double *a, const float *b, double *out)
{
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) {
            double sum = 0.0;
            for (int k = 0; k < 4; ++k)
                sum += a[k * 4 + row] * static_cast<double>(b[column * 4 + k]);
            out[column * 4 + row] = sum;
        }
}

/* The first inverse bind matrix; the identity where the skin has none. */
static void read_first_bind(file &f, const tinygltf::Skin &skin, const std::string &where, float *out)
{
    static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    memcpy(out, identity, sizeof identity);
    if (skin.inverseBindMatrices < 0)
        return;
    uint64_t count = accessor_at(f, skin.inverseBindMatrices, where).count;
    if (count < skin.joints.size())
        fail(where, text("%zu joints but %llu inverse bind matrices", skin.joints.size(), static_cast<unsigned long long>(count)));
    charge(f, count, 64, where);
    std::vector<float> matrices(static_cast<size_t>(count) * 16);
    read_floats(f, skin.inverseBindMatrices, 16, c_f32, count, where, matrices.data());
    memcpy(out, matrices.data(), 64);
}

static void place(file &f, size_t node, model_node &out)
{
    const tinygltf::Node &from = f.json.nodes[node];
    if (static_cast<size_t>(from.skin) >= f.json.skins.size())
        fail("node '" + printable(out.name) + "'", text("skin %d does not exist: the file has %zu", from.skin, f.json.skins.size()));
    const tinygltf::Skin &skin = f.json.skins[static_cast<size_t>(from.skin)];
    std::string where = text("skin %d", from.skin);
    if (skin.joints.empty())
        fail(where, "the skin has no joints");
    int joint = skin.joints[0];
    if (joint < 0 || static_cast<size_t>(joint) >= f.json.nodes.size())
        fail(where, text("joint node %d does not exist: the file has %zu nodes", joint, f.json.nodes.size()));
    uint32_t index = f.node_of[static_cast<size_t>(joint)];
    if (index == MODEL_NONE) {
        warn(f, "%s: its first joint is not in the scene; the mesh stays where its node is", where.c_str());
        return;
    }
    float bind[16];
    double world[16];
    read_first_bind(f, skin, where, bind);
    multiply(f.out->nodes[index].world, bind, world);
    for (double number : world)
        if (!std::isfinite(number))
            fail(where, "the rest matrix of the first joint is not finite");
    memcpy(out.world, world, sizeof world);
}

void place_skinned_nodes(file &f)
{
    for (size_t i = 0; i < f.json.nodes.size(); ++i)
        if (f.node_of[i] != MODEL_NONE && f.json.nodes[i].skin >= 0)
            place(f, i, f.out->nodes[f.node_of[i]]);
}

} // namespace gltf
