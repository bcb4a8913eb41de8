/* gltf_skin.cpp: skins, and the nodes whose meshes they move. */
#include "convert/model/affine.h"
#include "gltf_internal.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gltf
{

/* --- inverse bind matrices --- */

/* Exporters that invert in floats leave rounding errors in the last row: it is repaired. */
static bool repair_last_row(float *m)
{
    const float expected[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    for (int i = 0; i < 4; ++i) {
        if (!(std::fabs(m[i * 4 + 3] - expected[i]) <= 1e-4f)) return false;
        m[i * 4 + 3] = expected[i];
    }
    return true;
}

/* The determinant is compared with the product of the columns' lengths, so that small scales are not an error. */
static bool is_invertible(const float *m)
{
    double columns[3][3], cross[3], size = 1.0;
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) columns[c][r] = static_cast<double>(m[c * 4 + r]);
        size *= std::sqrt(vec_dot(columns[c], columns[c]));
    }
    vec_cross(columns[0], columns[1], cross);
    return std::fabs(vec_dot(cross, columns[2])) > 1e-6 * size && size > 0.0;
}

/* Why an inverse bind matrix cannot be one, or null. Exporters that run out of time leave zeros. */
static const char *fault_of(float *m)
{
    bool zeros = true, numbers = true;
    for (int i = 0; i < 16; ++i) {
        zeros = zeros && m[i] == 0.0f;
        numbers = numbers && !std::isnan(m[i]);
    }
    if (!numbers) return "has a number that is NaN, infinite or above 1e12";
    if (zeros) return "is all zeros";
    if (!repair_last_row(m)) return "is not affine: its last row must be 0 0 0 1";
    return is_invertible(m) ? nullptr : "is singular";
}

/* The joint is bound where it rests; without a size there, at its place alone. */
static void bind_at_rest(const model_node &node, float *m)
{
    double inverse[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    if (affine_invert(node.world, inverse))
        for (int i = 0; i < 16; ++i) inverse[i] = i >= 12 && i < 15 ? -node.world[i] : i % 5 == 0 ? 1.0 : 0.0;
    for (int i = 0; i < 16; ++i) m[i] = static_cast<float>(inverse[i]);
}

static void fill_identities(model_skin &out)
{
    for (size_t j = 0; j < out.joint_count; ++j)
        for (size_t i = 0; i < 4; ++i) out.inverse_bind[j * 16 + i * 5] = 1.0f;
}

/* Matrices that the file does not have stay zeros. */
static void read_given_binds(file &f, int accessor, const std::string &where, model_skin &out)
{
    const uint64_t count = accessor_at(f, accessor, where).count;
    charge(f, count, 64, where);
    std::vector<float> matrices(static_cast<size_t>(count) * 16);
    read_floats(f, accessor, 16, c_f32, count, where, matrices.data());
    memcpy(out.inverse_bind, matrices.data(), static_cast<size_t>(std::min<uint64_t>(out.joint_count, count)) * 64);
    if (count < out.joint_count)
        leave_out(f, where,
                  text(": %u joints but %llu inverse bind matrices", out.joint_count,
                       static_cast<unsigned long long>(count)));
}

static void read_inverse_binds(file &f, const tinygltf::Skin &skin, const std::string &where, model_skin &out)
{
    out.inverse_bind = allocate<float>(f, uint64_t{ out.joint_count } * 16, where);
    if (skin.inverseBindMatrices < 0) {
        fill_identities(out);
        return;
    }
    (void)attempt(f, "", [&] { read_given_binds(f, skin.inverseBindMatrices, where, out); });
    for (uint32_t j = 0; j < out.joint_count; ++j) {
        const model_node &node = f.out->nodes[out.joints[j]];
        float *matrix = out.inverse_bind + size_t{ j } * 16;
        if (const char *fault = fault_of(matrix)) {
            bind_at_rest(node, matrix);
            leave_out(f, where + ": the inverse bind matrix of joint '" + printable(node.name) + "'",
                      text(" %s; the joint was bound at its rest transform", fault));
        }
    }
}

/* --- joints --- */

static void check_joints(const file &f, const tinygltf::Skin &skin, const std::string &where)
{
    if (skin.joints.empty()) fail(where, "the skin has no joints");
    if (skin.joints.size() >= MODEL_NONE / 16)
        fail(where, text("the skin has %zu joints, which are too many", skin.joints.size()));
    for (int joint : skin.joints)
        if (joint < 0 || static_cast<size_t>(joint) >= f.json.nodes.size())
            fail(where, text("joint node %d does not exist: the file has %zu nodes", joint, f.json.nodes.size()));
}

/* Joints outside the scene were read where a mesh of the scene needs them (gltf_scene.cpp). */
static bool all_in_scene(const file &f, const tinygltf::Skin &skin)
{
    for (int joint : skin.joints)
        if (f.node_of[static_cast<size_t>(joint)] == MODEL_NONE) return false;
    return true;
}

static void read_skin(file &f, size_t index)
{
    const tinygltf::Skin &skin = f.json.skins[index];
    std::string where = text("skin %zu", index);
    if (!attempt(f, "; the skin was left out", [&] { check_joints(f, skin, where); })) return;
    if (!all_in_scene(f, skin)) {
        leave_out(f, where, " was skipped: its joints are not in the default scene, and no mesh there follows them");
        return;
    }
    model_skin &out = f.out->skins[f.out->skin_count]; /* counted first, so that it is freed when reading fails */
    f.skin_of[index] = f.out->skin_count++;
    out.name = copy_string(name_or(skin.name, "skin", index));
    out.joint_count = static_cast<uint32_t>(skin.joints.size());
    out.joints = allocate<uint32_t>(f, out.joint_count, where);
    for (uint32_t j = 0; j < out.joint_count; ++j) out.joints[j] = f.node_of[static_cast<size_t>(skin.joints[j])];
    read_inverse_binds(f, skin, where, out);
}

/* --- the meshes that skins move --- */

/* A mesh without joints has nothing for a skin to move. */
static void bind_nodes(file &f)
{
    for (size_t i = 0; i < f.json.nodes.size(); ++i) {
        uint32_t node = f.node_of[i];
        if (node == MODEL_NONE || f.json.nodes[i].skin < 0) continue;
        model_node &out = f.out->nodes[node];
        const size_t skin = static_cast<size_t>(f.json.nodes[i].skin);
        if (skin < f.skin_of.size())
            out.skin = f.skin_of[skin];
        else
            leave_out(f, "node '" + printable(out.name) + "'", ": its skin does not exist; the node alone places it");
        if (out.skin == MODEL_NONE || out.mesh == MODEL_NONE) continue;
        if (f.out->meshes[out.mesh].joints) {
            check_influences(f, f.out->meshes[out.mesh], f.out->skins[out.skin].joint_count);
            continue;
        }
        out.skin = MODEL_NONE;
        leave_out(f, "node '" + printable(out.name) + "'",
                  " has a skin, but its mesh lacks JOINTS_0 or WEIGHTS_0; the node alone places it");
    }
}

void read_skins(file &f)
{
    f.skin_of.assign(f.json.skins.size(), MODEL_NONE);
    f.out->skins = allocate<model_skin>(f, f.json.skins.size(), "skins");
    for (size_t i = 0; i < f.json.skins.size(); ++i) read_skin(f, i);
    bind_nodes(f);
}

} // namespace gltf
