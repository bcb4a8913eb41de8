/* gltf_influences.cpp: which joints move which vertices (JOINTS_n, WEIGHTS_n). */
#include "gltf_internal.h"

#include <algorithm>
#include <cmath>

namespace gltf
{

static const size_t sets_max = 16;
static const double sum_tolerance = 1e-3; /* of floats; exporters round */

struct influence {
    uint32_t joint;
    float weight;
};

/* How many sets of four influences a primitive has. */
static size_t count_sets(file &f, const tinygltf::Primitive &p, const std::string &where)
{
    size_t count = 0;
    for (;; ++count) {
        bool joints = p.attributes.count(text("JOINTS_%zu", count)) > 0,
             weights = p.attributes.count(text("WEIGHTS_%zu", count)) > 0;
        if (joints != weights)
            leave_out(f, where,
                      text(": it has %s_%zu without %s_%zu, which was ignored", joints ? "JOINTS" : "WEIGHTS", count,
                           joints ? "WEIGHTS" : "JOINTS", count));
        if (!joints || !weights) return count;
        if (count == sets_max) fail(where, text("it has more than %zu sets of joints and weights", sets_max));
    }
}

bool has_influences(const tinygltf::Primitive &p)
{
    return p.attributes.count("JOINTS_0") > 0 && p.attributes.count("WEIGHTS_0") > 0;
}

/* [vertex][set][4]; joints below 65536 are exact as floats */
static std::vector<float> read_sets(file &f, const tinygltf::Primitive &p, const char *name, uint32_t accepted,
                                    size_t sets, const vertex_list &vertices, const std::string &where)
{
    const size_t vertex_count = vertices.count();
    std::vector<float> all(vertex_count * sets * 4), one(vertex_count * 4);
    for (size_t s = 0; s < sets; ++s) {
        std::string attribute = text("%s_%zu", name, s);
        read_vertices(f, p.attributes.at(attribute), 4, accepted, vertices, where + " " + attribute, one.data());
        for (size_t v = 0; v < vertex_count; ++v) std::copy_n(&one[v * 4], 4, &all[(v * sets + s) * 4]);
    }
    return all;
}

/* Half a step of the coarsest type in which any set of weights is stored: how far rounding may change one weight. */
static double weight_rounding(const file &f, const tinygltf::Primitive &p, size_t sets)
{
    double most = 0.0;
    for (size_t s = 0; s < sets; ++s) {
        int type = accessor_at(f, p.attributes.at(text("WEIGHTS_%zu", s)), "").componentType;
        double half = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 0.5 / 255.0
                      : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 0.5 / 65535.0
                                                                       : 0.0;
        most = std::max(most, half);
    }
    return most;
}

static double sum_of(const std::vector<influence> &used)
{
    double sum = 0.0;
    for (const influence &i : used) sum += static_cast<double>(i.weight);
    return sum;
}

/* Used influences of one vertex, the strongest first. A vertex without any weight would have no position in any pose:
 * it follows the joint that it lists first. */
static std::vector<influence> sort_influences(file &f, const float *joints, const float *weights, size_t count,
                                              const std::string &where, size_t vertex)
{
    std::vector<influence> used;
    for (size_t i = 0; i < count; ++i) {
        if (weights[i] < 0.0f) leave_out(f, where + text(" vertex %zu", vertex), ": a weight below 0 was read as 0");
        if (weights[i] > 0.0f) used.push_back({ static_cast<uint32_t>(joints[i]), weights[i] });
    }
    if (used.empty()) return { { static_cast<uint32_t>(joints[0]), 1.0f } };
    std::stable_sort(used.begin(), used.end(),
                     [](const influence &a, const influence &b) { return a.weight > b.weight; });
    return used;
}

/* Keep the strongest and divide them by their sum, so that they sum to 1 whatever the file says: otherwise the missing
 * share would pull the vertex towards the origin (or push it away). Returns the share that is dropped. */
static double store_influences(const std::vector<influence> &used, size_t vertex, model_mesh &out)
{
    size_t count = std::min<size_t>(used.size(), MODEL_INFLUENCES_MAX);
    double kept = 0.0, all = sum_of(used);
    for (size_t i = 0; i < count; ++i) kept += static_cast<double>(used[i].weight);
    for (size_t i = 0; i < count; ++i) {
        out.joint_limit = std::max(out.joint_limit, used[i].joint + 1);
        out.joints[vertex * MODEL_INFLUENCES_MAX + i] = static_cast<uint16_t>(used[i].joint);
        out.joint_weights[vertex * MODEL_INFLUENCES_MAX + i] = static_cast<float>(static_cast<double>(used[i].weight) /
                                                                                  kept);
    }
    out.influence_max = std::max(out.influence_max, static_cast<uint32_t>(count));
    return 1.0 - kept / all;
}

void allocate_influences(file &f, const std::string &where, model_mesh &out)
{
    out.joints = allocate<uint16_t>(f, uint64_t{ out.vertex_count } * MODEL_INFLUENCES_MAX, where);
    out.joint_weights = allocate<float>(f, uint64_t{ out.vertex_count } * MODEL_INFLUENCES_MAX, where);
}

/* A primitive without joints, in a mesh with joints. */
void bind_to_first_joint(const model_submesh &part, model_mesh &out)
{
    for (size_t v = 0; v < part.vertex_count; ++v)
        out.joint_weights[(part.first_vertex + v) * MODEL_INFLUENCES_MAX] = 1.0f;
    out.influence_max = std::max(out.influence_max, 1u);
    out.joint_limit = std::max(out.joint_limit, 1u);
}

static void note_changes(const std::vector<influence> &used, double lost, double rounding, influence_changes &changes)
{
    double sum = sum_of(used);
    if (!(std::fabs(sum - 1.0) <= sum_tolerance + rounding * static_cast<double>(used.size()))) {
        ++changes.rescaled;
        if (std::fabs(sum - 1.0) > std::fabs(changes.farthest_sum - 1.0)) changes.farthest_sum = sum;
    }
    changes.truncated += used.size() > MODEL_INFLUENCES_MAX;
    changes.most_lost = std::fmax(changes.most_lost, lost);
}

void read_influences(file &f, const tinygltf::Primitive &p, const vertex_list &vertices, const model_submesh &part,
                     const std::string &where, model_mesh &out, influence_changes &changes)
{
    size_t sets = count_sets(f, p, where), count = part.vertex_count;
    if (sets == 0) {
        leave_out(f, where, " has no joints, but others of its mesh have: it was bound to the first joint");
        bind_to_first_joint(part, out);
        return;
    }
    charge(f, uint64_t{ count } * sets, 8 * sizeof(float), where);
    std::vector<float> joints = read_sets(f, p, "JOINTS", c_u8 | c_u16, sets, vertices, where);
    std::vector<float> weights = read_sets(f, p, "WEIGHTS", c_f32 | c_u8n | c_u16n, sets, vertices, where);
    const double rounding = weight_rounding(f, p, sets);
    for (size_t v = 0; v < count; ++v) {
        const float *given = &weights[v * sets * 4];
        const std::vector<influence> used = sort_influences(f, &joints[v * sets * 4], given, sets * 4, where,
                                                            vertices.at(v));
        changes.unbound += *std::max_element(given, given + sets * 4) <= 0.0f;
        note_changes(used, store_influences(used, part.first_vertex + v, out), rounding, changes);
    }
}

void warn_influence_changes(file &f, const influence_changes &changes, const std::string &where)
{
    if (changes.rescaled > 0)
        warn(f, "%s: the weights of %zu vertices do not sum to 1 and were divided by their sum, at worst %.4g",
             where.c_str(), changes.rescaled, changes.farthest_sum);
    if (changes.unbound > 0)
        warn(f, "%s: %zu vertices have no weight for any joint; each follows the joint that it lists first",
             where.c_str(), changes.unbound);
    if (changes.truncated > 0)
        warn(f,
             "%s: %zu vertices have more than %u joints; the strongest were kept, up to %.2g of the weight was dropped",
             where.c_str(), changes.truncated, MODEL_INFLUENCES_MAX, changes.most_lost);
}

/* A mesh refers to joints by their place in the skin of the node that draws it. A joint that the skin lacks gives its
 * weight to the vertex's others; a vertex without others follows the first joint. */
void check_influences(file &f, model_mesh &mesh, uint32_t joint_count)
{
    for (size_t v = 0; mesh.joint_limit > joint_count && v < mesh.vertex_count; ++v) {
        uint16_t *joints = mesh.joints + v * MODEL_INFLUENCES_MAX;
        float *weights = mesh.joint_weights + v * MODEL_INFLUENCES_MAX;
        std::vector<influence> kept;
        bool all = true;
        for (uint32_t i = 0; i < MODEL_INFLUENCES_MAX; ++i) {
            all = all && joints[i] < joint_count;
            if (joints[i] < joint_count && weights[i] > 0.0f) kept.push_back({ joints[i], weights[i] });
        }
        if (all) continue;
        leave_out(f, "mesh '" + printable(mesh.name) + text("' vertex %zu", v),
                  " follows a joint that its skin does not have; the joint was ignored");
        if (kept.empty()) kept.push_back({ 0, 1.0f });
        std::fill_n(joints, MODEL_INFLUENCES_MAX, uint16_t{ 0 });
        std::fill_n(weights, MODEL_INFLUENCES_MAX, 0.0f);
        store_influences(kept, v, mesh);
    }
    mesh.joint_limit = std::min(mesh.joint_limit, joint_count);
}

} // namespace gltf
