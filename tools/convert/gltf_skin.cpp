/* gltf_skin.cpp: skins, and where a skinned mesh stands while it is drawn unskinned.
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

/* --- inverse bind matrices --- */

/* Exporters that invert in floats miss the last row by rounding: that is repaired. */
static void repair_last_row(float *m, const std::string &where)
{
    const float expected[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    for (int i = 0; i < 4; ++i) {
        if (!(std::fabs(m[i * 4 + 3] - expected[i]) <= 1e-4f))
            fail(where, "the inverse bind matrix is not affine: its last row must be 0 0 0 1");
        m[i * 4 + 3] = expected[i];
    }
}

/* Against the lengths of the columns, so that small scales are no error. */
static void check_invertible(const float *m, const std::string &where)
{
    double columns[3][3], cross[3], size = 1.0;
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r)
            columns[c][r] = static_cast<double>(m[c * 4 + r]);
        size *= std::sqrt(vec_dot(columns[c], columns[c]));
    }
    vec_cross(columns[0], columns[1], cross);
    if (!(std::fabs(vec_dot(cross, columns[2])) > 1e-6 * size) || size == 0.0)
        fail(where, "the inverse bind matrix is singular: no pose has such an inverse");
}

static void fill_identities(model_skin &out)
{
    for (size_t j = 0; j < out.joint_count; ++j)
        for (size_t i = 0; i < 4; ++i)
            out.inverse_bind[j * 16 + i * 5] = 1.0f;
}

static void read_inverse_binds(file &f, const tinygltf::Skin &skin, const std::string &where, model_skin &out)
{
    out.inverse_bind = allocate<float>(f, uint64_t{out.joint_count} * 16, where);
    if (skin.inverseBindMatrices < 0) {
        fill_identities(out);
        return;
    }
    uint64_t count = accessor_at(f, skin.inverseBindMatrices, where).count;
    if (count < out.joint_count)
        fail(where, text("%u joints but %llu inverse bind matrices", out.joint_count, static_cast<unsigned long long>(count)));
    charge(f, count, 64, where);
    std::vector<float> matrices(static_cast<size_t>(count) * 16);
    read_floats(f, skin.inverseBindMatrices, 16, c_f32, count, where, matrices.data());
    memcpy(out.inverse_bind, matrices.data(), size_t{out.joint_count} * 64);
    for (uint32_t j = 0; j < out.joint_count; ++j) {
        std::string element = where + text(" (accessor %d), element %u", skin.inverseBindMatrices, j);
        repair_last_row(out.inverse_bind + size_t{j} * 16, element);
        check_invertible(out.inverse_bind + size_t{j} * 16, element);
    }
}

/* --- joints --- */

static void check_joints(const file &f, const tinygltf::Skin &skin, const std::string &where)
{
    if (skin.joints.empty())
        fail(where, "the skin has no joints");
    if (skin.joints.size() >= MODEL_NONE / 16)
        fail(where, text("%zu joints are too many", skin.joints.size()));
    for (int joint : skin.joints)
        if (joint < 0 || static_cast<size_t>(joint) >= f.json.nodes.size())
            fail(where, text("joint node %d does not exist: the file has %zu nodes", joint, f.json.nodes.size()));
}

/* Joints in no scene move nothing that is drawn. */
static bool all_in_scene(const file &f, const tinygltf::Skin &skin)
{
    for (int joint : skin.joints)
        if (f.node_of[static_cast<size_t>(joint)] == MODEL_NONE)
            return false;
    return true;
}

static void read_skin(file &f, size_t index)
{
    const tinygltf::Skin &skin = f.json.skins[index];
    std::string where = text("skin %zu", index);
    check_joints(f, skin, where);
    if (!all_in_scene(f, skin)) {
        warn(f, "%s was skipped: a joint of it is not in the default scene; its meshes stay where their nodes are", where.c_str());
        return;
    }
    model_skin &out = f.out->skins[f.out->skin_count]; /* counted first, so that it is freed when reading fails */
    f.skin_of[index] = f.out->skin_count++;
    out.name = copy_string(name_or(skin.name, "skin", index));
    out.joint_count = static_cast<uint32_t>(skin.joints.size());
    out.joints = allocate<uint32_t>(f, out.joint_count, where);
    for (uint32_t j = 0; j < out.joint_count; ++j)
        out.joints[j] = f.node_of[static_cast<size_t>(skin.joints[j])];
    read_inverse_binds(f, skin, where, out);
}

/* --- the meshes that skins move --- */

static void bind_node(file &f, size_t node, model_node &out)
{
    size_t skin = static_cast<size_t>(f.json.nodes[node].skin);
    if (skin >= f.json.skins.size())
        fail("node '" + printable(out.name) + "'", text("skin %zu does not exist: the file has %zu", skin, f.json.skins.size()));
    out.skin = f.skin_of[skin];
}

static std::vector<uint32_t> bind_nodes(file &f)
{
    std::vector<uint32_t> bound;
    for (size_t i = 0; i < f.json.nodes.size(); ++i) {
        uint32_t node = f.node_of[i];
        if (node == MODEL_NONE || f.json.nodes[i].skin < 0)
            continue;
        bind_node(f, i, f.out->nodes[node]);
        if (f.out->nodes[node].skin == MODEL_NONE)
            continue;
        if (f.out->nodes[node].mesh != MODEL_NONE)
            check_influences(f.out->meshes[f.out->nodes[node].mesh], f.out->skins[f.out->nodes[node].skin].joint_count);
        bound.push_back(node);
    }
    return bound;
}

/* Found for all before any is changed: a skinned mesh's node may be a joint too. */
static void place_nodes(file &f, const std::vector<uint32_t> &bound)
{
    std::vector<double> worlds(bound.size() * 16);
    for (size_t i = 0; i < bound.size(); ++i) {
        const model_skin &skin = f.out->skins[f.out->nodes[bound[i]].skin];
        multiply(f.out->nodes[skin.joints[0]].world, skin.inverse_bind, &worlds[i * 16]);
        for (size_t k = 0; k < 16; ++k)
            if (!std::isfinite(worlds[i * 16 + k]))
                fail("skin '" + printable(skin.name) + "'", "the rest matrix of the first joint is not finite");
    }
    for (size_t i = 0; i < bound.size(); ++i)
        memcpy(f.out->nodes[bound[i]].world, &worlds[i * 16], 16 * sizeof(double));
}

void read_skins(file &f)
{
    f.skin_of.assign(f.json.skins.size(), MODEL_NONE);
    f.out->skins = allocate<model_skin>(f, f.json.skins.size(), "skins");
    for (size_t i = 0; i < f.json.skins.size(); ++i)
        read_skin(f, i);
    place_nodes(f, bind_nodes(f));
}

} // namespace gltf
