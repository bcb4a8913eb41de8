/* weight_radius.cpp: the radius of a morph weight: how far, in the world, it moves the surface or the picture on it. */
#include "clips_internal.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "convert/base/quat.h"
#include "convert/model/model_build.h"

namespace gltf
{

static double square(const float *v)
{
    double x = static_cast<double>(v[0]), y = static_cast<double>(v[1]), z = static_cast<double>(v[2]);
    return x * x + y * y + z * z;
}

std::vector<double> target_sizes(const model_mesh &mesh)
{
    std::vector<double> sizes(mesh.target_count, 0.0);
    const double per_uv = mesh.uv && mesh.vertex_count ? model_uv_length(&mesh) : 0.0;
    for (uint32_t t = 0; t < mesh.target_count; ++t) {
        double largest = 0.0;
        for (size_t v = 0; v < mesh.vertex_count; ++v) {
            const double one = square(mesh.targets[t].position + v * 3);
            largest = one > largest ? one : largest;
        }
        sizes[t] = std::sqrt(largest);
        for (size_t v = 0; v < mesh.vertex_count && mesh.targets[t].uv; ++v) {
            const float *uv = mesh.targets[t].uv + v * 2;
            sizes[t] = std::fmax(sizes[t], per_uv * std::hypot(double{ uv[0] }, double{ uv[1] }));
        }
    }
    return sizes;
}

/* c = a * b; nine numbers each, three columns. c may be neither. */
static void multiply_3x3(const double *a, const double *b, double *c)
{
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            c[column * 3 + row] = a[row] * b[column * 3] + a[3 + row] * b[column * 3 + 1] +
                                  a[6 + row] * b[column * 3 + 2];
}

/* A bound on how much a matrix M enlarges any vector: the largest eigenvalue of M^T M is at most its largest row sum.
 * It is exact for rotations with scales along the axes. */
static double norm_bound(const double *m)
{
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
        double sum = 0.0;
        for (int k = 0; k < 3; ++k) sum += std::fabs(vec_dot(m + i * 3, m + k * 3));
        largest = std::fmax(largest, sum);
    }
    return std::sqrt(largest);
}

static void local_columns(const model_node &node, double *out)
{
    double q[4];
    std::copy_n(node.rotation, 4, q);
    (void)quat_normalize(q);
    quat_columns(q, out);
    for (int i = 0; i < 9; ++i) out[i] *= static_cast<double>(node.scale[i / 3]);
}

/* The transform before a joint's matrix: an inverse bind matrix, or the nodes in between. */
struct attachment {
    uint32_t joint; /* or MODEL_NONE */
    double columns[9];
};

static std::vector<attachment> skin_attachments(const model_skin &skin, const uint32_t *joints)
{
    std::vector<attachment> all(skin.joint_count);
    for (uint32_t j = 0; j < skin.joint_count; ++j) {
        all[j].joint = joints[j];
        for (int i = 0; i < 9; ++i)
            all[j].columns[i] = static_cast<double>(
                skin.inverse_bind[size_t{ j } * 16 + static_cast<size_t>(i / 3 * 4 + i % 3)]);
    }
    return all;
}

static attachment node_attachment(const model &m, uint32_t node, uint32_t joint, const raw_skeleton &skeleton)
{
    attachment a = { joint, { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
    uint32_t stop = joint == MODEL_NONE ? MODEL_NONE : skeleton.joints[joint].node;
    for (uint32_t n = node; n != stop && n != MODEL_NONE; n = m.nodes[n].parent) {
        double local[9], product[9];
        local_columns(m.nodes[n], local);
        multiply_3x3(local, a.columns, product);
        memcpy(a.columns, product, sizeof product);
    }
    return a;
}

static double scale_in_pose(const std::vector<attachment> &attachments, const std::vector<double> &pose)
{
    double largest = 0.0, product[9];
    for (const attachment &a : attachments) {
        if (a.joint == MODEL_NONE)
            memcpy(product, a.columns, sizeof product);
        else
            multiply_3x3(&pose[size_t{ a.joint } * 12], a.columns, product);
        largest = std::fmax(largest, norm_bound(product));
    }
    return largest;
}

double largest_scale(const model &m, uint32_t node, const uint32_t *skin, uint32_t joint, const raw_set &set,
                     const raw_clip *clip)
{
    std::vector<attachment> attachments;
    if (skin)
        attachments = skin_attachments(m.skins[m.nodes[node].skin], skin);
    else
        attachments.push_back(node_attachment(m, node, joint, set.skeleton));
    uint32_t frames = clip && clip->joint_count > 0 ? clip->frame_count : 1;
    std::vector<double> pose(size_t{ set.skeleton.joint_count } * 12 + 12);
    double largest = 0.0;
    for (uint32_t frame = 0; frame < frames; ++frame) {
        raw_pose_object(&set.skeleton, clip, frame, pose.data());
        largest = std::fmax(largest, scale_in_pose(attachments, pose));
    }
    return largest;
}

} // namespace gltf
