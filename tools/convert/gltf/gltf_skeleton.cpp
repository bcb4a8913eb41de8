/* gltf_skeleton.cpp: which nodes make which skeletons. The rules are in clips/model_clips.h. */
#include "clips_internal.h"

#include <algorithm>

namespace gltf
{

/* Union-find over skins that share a skeleton. */
class skin_groups
{
  public:
    explicit skin_groups(uint32_t count) : above(count)
    {
        for (uint32_t i = 0; i < count; ++i) above[i] = i;
    }
    uint32_t first_of(uint32_t skin)
    {
        while (above[skin] != skin) skin = above[skin] = above[above[skin]];
        return skin;
    }
    void unite(uint32_t a, uint32_t b)
    {
        a = first_of(a);
        b = first_of(b);
        above[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<uint32_t> above;
};

/* The nodes while skeletons are planned. */
struct survey {
    std::vector<bool> animated; /* its transform is */
    std::vector<bool> has_children;
    std::vector<bool> above_a_joint;
    std::vector<uint32_t> owner; /* a skin whose joint it is, or lies below; or MODEL_NONE */
};

static void survey_animations(const model &m, survey &s)
{
    for (uint32_t c = 0; c < m.clip_count; ++c)
        for (uint32_t i = 0; i < m.clips[c].channel_count; ++i)
            if (!is_weight(m, m.clips[c].channels[i])) s.animated[m.clips[c].channels[i].node] = true;
}

/* Assign a skin to each joint; skins that share one are united. */
static std::vector<uint32_t> survey_joints(const model &m, skin_groups &groups)
{
    std::vector<uint32_t> skin_at(m.node_count, MODEL_NONE);
    for (uint32_t s = 0; s < m.skin_count; ++s)
        for (uint32_t j = 0; j < m.skins[s].joint_count; ++j) {
            uint32_t &skin = skin_at[m.skins[s].joints[j]];
            if (skin == MODEL_NONE)
                skin = s;
            else
                groups.unite(skin, s);
        }
    return skin_at;
}

/* Pass it down the tree: parents come first in the nodes' order. */
static void survey_owners(const model &m, const std::vector<uint32_t> &skin_at, skin_groups &groups, survey &s)
{
    for (uint32_t n = 0; n < m.node_count; ++n) {
        uint32_t parent = m.nodes[n].parent, inherited = parent == MODEL_NONE ? MODEL_NONE : s.owner[parent];
        s.owner[n] = skin_at[n] != MODEL_NONE ? skin_at[n] : inherited;
        if (skin_at[n] != MODEL_NONE && inherited != MODEL_NONE) groups.unite(skin_at[n], inherited);
        if (parent != MODEL_NONE) s.has_children[parent] = true;
    }
    for (uint32_t n = m.node_count; n-- > 0;)
        if (m.nodes[n].parent != MODEL_NONE && (skin_at[n] != MODEL_NONE || s.above_a_joint[n]))
            s.above_a_joint[m.nodes[n].parent] = true;
}

static bool is_identity(const model_node &n)
{
    for (int i = 0; i < 3; ++i)
        if (n.translation[i] != 0.0f || n.rotation[i] != 0.0f || n.scale[i] != 1.0f) return false;
    return n.rotation[3] == 1.0f;
}

/* Add the nodes above the given ones that they need. Those left out are identities at all times. */
static void close_upward(const model &m, const survey &s, std::vector<uint32_t> &stamps, uint32_t stamp,
                         skeleton_plan &p)
{
    std::sort(p.nodes.begin(), p.nodes.end());
    p.nodes.erase(std::unique(p.nodes.begin(), p.nodes.end()), p.nodes.end());
    for (uint32_t n : p.nodes) stamps[n] = stamp;
    for (size_t i = 0, given = p.nodes.size(); i < given; ++i)
        for (uint32_t n = m.nodes[p.nodes[i]].parent; n != MODEL_NONE && stamps[n] != stamp; n = m.nodes[n].parent) {
            stamps[n] = stamp;
            if (s.animated[n] || !is_identity(m.nodes[n])) p.nodes.push_back(n);
        }
    std::sort(p.nodes.begin(), p.nodes.end());
}

static std::vector<skeleton_plan> plan_skins(const model &m, skin_groups &groups, std::vector<uint32_t> &plan_of_skin)
{
    std::vector<skeleton_plan> plans;
    plan_of_skin.assign(m.skin_count, MODEL_NONE);
    for (uint32_t s = 0; s < m.skin_count; ++s) {
        uint32_t first = groups.first_of(s);
        if (first == s) {
            plan_of_skin[s] = static_cast<uint32_t>(plans.size());
            plans.emplace_back();
        }
        plan_of_skin[s] = plan_of_skin[first];
        skeleton_plan &p = plans[plan_of_skin[s]];
        p.skins.push_back(s);
        p.nodes.insert(p.nodes.end(), m.skins[s].joints, m.skins[s].joints + m.skins[s].joint_count);
    }
    return plans;
}

/* The transform of a skinned mesh's node has no effect (glTF 2.0, 3.7.3.2). */
static bool shows(const model &m, const survey &s, uint32_t node)
{
    return s.has_children[node] || m.nodes[node].skin == MODEL_NONE;
}

static void plan_animated_nodes(const model &m, const survey &s, const std::vector<uint32_t> &plan_of_skin,
                                std::vector<skeleton_plan> &plans)
{
    skeleton_plan rest;
    for (uint32_t n = 0; n < m.node_count; ++n) {
        if (!s.animated[n] || !shows(m, s, n)) continue;
        if (s.owner[n] != MODEL_NONE)
            plans[plan_of_skin[s.owner[n]]].nodes.push_back(n);
        else if (!s.above_a_joint[n])
            rest.nodes.push_back(n);
    }
    if (!rest.nodes.empty()) plans.push_back(std::move(rest));
}

static std::vector<bool> nodes_with_weights(const model &m)
{
    std::vector<bool> found(m.node_count, false);
    for (uint32_t c = 0; c < m.clip_count; ++c)
        for (uint32_t i = 0; i < m.clips[c].channel_count; ++i)
            if (is_weight(m, m.clips[c].channels[i])) found[m.clips[c].channels[i].node] = true;
    return found;
}

/* Weights go to the skeleton that moves the mesh; if none does, to the first. */
static void plan_weights(const model &m, const std::vector<uint32_t> &plan_of_skin, std::vector<skeleton_plan> &plans)
{
    std::vector<bool> animated = nodes_with_weights(m);
    std::vector<node_joint> movers = find_movers(m, plans);
    for (uint32_t n = 0; n < m.node_count; ++n) {
        if (!animated[n]) continue;
        if (plans.empty()) plans.emplace_back();
        uint32_t plan = m.nodes[n].skin < m.skin_count ? plan_of_skin[m.nodes[n].skin] : movers[n].set;
        plans[plan == MODEL_NONE ? 0 : plan].weight_nodes.push_back(n);
    }
}

std::vector<skeleton_plan> plan_skeletons(const model &m)
{
    skin_groups groups(m.skin_count);
    survey s = { std::vector<bool>(m.node_count), std::vector<bool>(m.node_count), std::vector<bool>(m.node_count),
                 std::vector<uint32_t>(m.node_count, MODEL_NONE) };
    survey_animations(m, s);
    survey_owners(m, survey_joints(m, groups), groups, s);
    std::vector<uint32_t> plan_of_skin, stamps(m.node_count, 0);
    std::vector<skeleton_plan> plans = plan_skins(m, groups, plan_of_skin);
    plan_animated_nodes(m, s, plan_of_skin, plans);
    for (size_t i = 0; i < plans.size(); ++i) close_upward(m, s, stamps, static_cast<uint32_t>(i + 1), plans[i]);
    plan_weights(m, plan_of_skin, plans);
    return plans;
}

uint32_t joint_of(const skeleton_plan &p, uint32_t node)
{
    auto found = std::lower_bound(p.nodes.begin(), p.nodes.end(), node);
    return found != p.nodes.end() && *found == node ? static_cast<uint32_t>(found - p.nodes.begin()) : MODEL_NONE;
}

/* A node is a joint of several skeletons only if it is above them all: then any will do, and the first is taken. */
std::vector<node_joint> find_movers(const model &m, const std::vector<skeleton_plan> &plans)
{
    std::vector<node_joint> movers(m.node_count, { MODEL_NONE, MODEL_NONE });
    for (size_t i = plans.size(); i-- > 0;)
        for (uint32_t j = 0; j < plans[i].nodes.size(); ++j)
            movers[plans[i].nodes[j]] = { static_cast<uint32_t>(i), j };
    for (uint32_t n = 0; n < m.node_count; ++n)
        if (movers[n].set == MODEL_NONE && m.nodes[n].parent != MODEL_NONE) movers[n] = movers[m.nodes[n].parent];
    return movers;
}

static void build_joint(const model &m, const skeleton_plan &p, uint32_t node, raw_joint &out)
{
    const model_node &from = m.nodes[node];
    out.name = copy_string(from.name);
    out.node = node;
    for (uint32_t n = from.parent; n != MODEL_NONE && out.parent == MODEL_NONE; n = m.nodes[n].parent)
        out.parent = joint_of(p, n);
    std::copy_n(from.rotation, 4, out.rotation);
    std::copy_n(from.translation, 3, out.translation);
    std::copy_n(from.scale, 3, out.scale);
}

void build_skeleton(const model &m, const skeleton_plan &p, raw_skeleton &out)
{
    const char *name = !p.skins.empty()   ? m.skins[p.skins[0]].name
                       : !p.nodes.empty() ? m.nodes[p.nodes[0]].name
                                          : "none";
    if (p.nodes.size() > RAW_JOINTS_MAX)
        fail("skeleton '" + printable(name) + "'",
             text("it has %zu joints, with the nodes above them that move; the limit is %u", p.nodes.size(),
                  RAW_JOINTS_MAX));
    out.unit_cm = 100.0;
    out.name = copy_string(name);
    for (uint32_t j = 0; j < out.joint_count; ++j) build_joint(m, p, p.nodes[j], out.joints[j]);
}

} // namespace gltf
