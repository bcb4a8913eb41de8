/* fbx_skin.cpp: clusters as a skin. A point moves by the sum of its clusters over the sum of their weights. Without a
 * weight, and by what is missing to 1 where the mode says so, it moves with its own node. */
#include "fbx_internal.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fbx
{

struct skin_job {
    job &j;
    size_t deformer, model; /* object; place in models */
    skin &out;
    std::map<int, std::vector<std::pair<mat, uint16_t>>> known; /* by node: transforms and their joints */
    std::vector<double> sums;                                   /* [points] */
    bool fills_up;
};

static uint16_t joint_of(skin_job &s, int node, const mat &transform)
{
    std::vector<std::pair<mat, uint16_t>> &of_node = s.known[node];
    for (const auto &k : of_node) {
        double off = 0.0;
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 3; ++r) off = std::max(off, std::fabs(k.first.column[c][r] - transform.column[c][r]));
        if (off == 0.0) return k.second;
    }
    if (s.out.joints.size() > 0xffff)
        fail(place_of(s.j.in, s.deformer), "the skin has more than 65,536 bones, which is the limit: split the mesh");
    const uint16_t joint = static_cast<uint16_t>(s.out.joints.size());
    of_node.push_back({ transform, joint });
    s.out.joints.push_back(node);
    for (int c = 0; c < 4; ++c) {
        const vec v = transform.column[c] * (c == 3 ? s.j.unit_m : 1.0);
        for (int r = 0; r < 3; ++r) s.out.inverse_bind.push_back(static_cast<float>(v[r]));
        s.out.inverse_bind.push_back(c == 3 ? 1.0f : 0.0f);
    }
    return joint;
}

static mat read_matrix(const node &of, const char *name)
{
    const std::vector<double> v = list_of(of, name).values;
    mat out;
    for (size_t i = 0; i < 16 && v.size() >= 16; ++i)
        if (i % 4 < 3) out.column[i / 4][static_cast<int>(i % 4)] = std::isfinite(v[i]) ? v[i] : 0.0;
    return out;
}

/* The node of a cluster's bone; without one, the mesh's own. */
static int bone_of(skin_job &s, size_t cluster)
{
    const std::vector<size_t> bones = s.j.in.below(cluster, "Model", nullptr);
    const auto found = bones.empty() ? s.j.in.place.end() : s.j.in.place.find(bones[0]);
    if (found != s.j.in.place.end()) return static_cast<int>(found->second);
    s.j.in.warn(place_of(s.j.in, cluster), " has no bone: what it moved follows the mesh; export it again");
    return -1;
}

static void add_cluster(skin_job &s, size_t cluster)
{
    const node &from = *s.j.in.objects[cluster].from, *mode = from.child("Mode");
    const std::vector<double> points = list_of(from, "Indexes").values, weights = list_of(from, "Weights").values;
    const int bone = bone_of(s, cluster);
    if (mode && mode->text(0) == "Additive")
        s.j.in.warn(place_of(s.j.in, cluster), " is additive, and was read as a plain one: bake it in its program");
    s.fills_up = s.fills_up || (mode && mode->text(0) == "Total1");
    if (bone < 0) return;
    const uint16_t joint = joint_of(s, bone, read_matrix(from, "Transform"));
    for (size_t i = 0; i < points.size() && i < weights.size(); ++i) {
        const int64_t point = whole_of(points[i], -1);
        if (static_cast<uint64_t>(point) >= s.sums.size() || !std::isfinite(weights[i])) {
            s.j.in.warn(
                place_of(s.j.in, cluster),
                " moves points that its mesh does not have, or by no weight: they were left out; export it again");
            continue;
        }
        if (weights[i] == 0.0) continue;
        s.sums[static_cast<size_t>(point)] += weights[i];
        s.out.points[static_cast<size_t>(point)].push_back({ joint, static_cast<float>(weights[i]) });
    }
}

/* Weights that sum to 1, the largest first. */
static void finish_point(skin_job &s, size_t point)
{
    std::vector<influence> &of = s.out.points[point];
    double sum = s.sums[point];
    const bool negative = std::any_of(of.begin(), of.end(), [](const influence &i) { return i.weight < 0.0f; });
    if (negative) {
        s.j.in.warn(place_of(s.j.in, s.deformer), " has negative weights, which were left out");
        of.erase(std::remove_if(of.begin(), of.end(), [](const influence &i) { return i.weight < 0.0f; }), of.end());
        sum = 0.0;
        for (const influence &i : of) sum += static_cast<double>(i.weight);
    }
    if (sum <= 1e-12) of.clear();
    if (of.empty() || (s.fills_up && sum < 1.0 - 1e-6)) {
        const float rest = static_cast<float>(of.empty() ? 1.0 : 1.0 - sum);
        of.push_back({ joint_of(s, static_cast<int>(s.model), mat()), rest });
        sum = of.size() == 1 ? 1.0 : sum + static_cast<double>(rest);
    }
    for (influence &i : of) i.weight = static_cast<float>(static_cast<double>(i.weight) / sum);
    std::stable_sort(of.begin(), of.end(), [](const influence &a, const influence &b) { return a.weight > b.weight; });
}

bool read_skin(job &j, size_t geometry, size_t model, size_t point_count, skin &out)
{
    const std::vector<size_t> skins = j.in.below(geometry, "Deformer", "Skin");
    if (skins.empty() || j.in.below(skins[0], "Deformer", "Cluster").empty()) return false;
    if (skins.size() > 1)
        j.in.warn(place_of(j.in, geometry), " has more than one skin; only the first was read: bake them into one");
    const node *type = j.in.objects[skins[0]].from->child("SkinningType");
    const std::string how = type ? type->text(0) : "";
    if (how == "DualQuaternion" || how == "Blend")
        j.in.warn(place_of(j.in, geometry), " has dual quaternion skinning, and linear skinning was taken: its volume "
                                            "shrinks where it twists");
    skin_job s = { j, skins[0], model, out, {}, std::vector<double>(point_count), false };
    out.points.resize(point_count);
    for (size_t cluster : j.in.below(skins[0], "Deformer", "Cluster")) add_cluster(s, cluster);
    for (size_t p = 0; p < point_count; ++p) finish_point(s, p);
    return !out.joints.empty();
}

} // namespace fbx
