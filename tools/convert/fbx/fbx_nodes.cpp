/* fbx_nodes.cpp: nodes of the .glb. glTF's have translation, rotation and scale below their parent; FBX's inherit scale
 * in three ways. So each node is written under the nearest ancestor that never shears it, in any take. */
#include "fbx_internal.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "noh/base.h"

namespace fbx
{

static const double shear_max = 1e-5; /* of the longest axis */

static double lost_below(const scene &s, const std::vector<placed> &pose, size_t model, size_t holder)
{
    const mat above = holder == none ? mat() : pose[holder].world;
    return parts_below(above, pose[model], holder == s.parent[model]).lost;
}

/* Ancestors under which a node shears in this pose are passed over. sheared: nodes that shear even below none. */
static void pass_over(const scene &s, const std::vector<placed> &pose, std::vector<size_t> &holder,
                      std::vector<bool> &sheared)
{
    for (size_t i = 0; i < holder.size(); ++i) {
        while (holder[i] != none && lost_below(s, pose, i, holder[i]) > shear_max) holder[i] = s.parent[holder[i]];
        if (holder[i] == none && lost_below(s, pose, i, none) > shear_max) sheared[i] = true;
    }
}

static void find_holders(job &j)
{
    std::vector<placed> pose;
    std::vector<bool> sheared(j.in.models.size());
    j.holder = j.in.parent;
    pose_rig(make_rig(j.in, nullptr), 0.0, pose);
    pass_over(j.in, pose, j.holder, sheared);
    for (const take &t : j.in.takes) {
        const std::vector<rig_node> rig = make_rig(j.in, &t);
        for (double seconds : t.samples) {
            pose_rig(rig, seconds, pose);
            pass_over(j.in, pose, j.holder, sheared);
        }
    }
    for (size_t i = 0; i < sheared.size(); ++i) {
        /* what is written of a sheared node is not where it is: nothing is written under it */
        while (j.holder[i] != none && sheared[j.holder[i]]) j.holder[i] = j.in.parent[j.holder[i]];
        if (sheared[i])
            j.in.warn(place_of(j.in, j.in.models[i]),
                      " is sheared by the scales of its parents, which a joint cannot be: it is drawn without the "
                      "shear; freeze the scales in its program");
    }
}

static bool is_usable(const parts &p)
{
    const double all[] = { p.translation[0], p.translation[1], p.translation[2], p.scale[0],   p.scale[1],
                           p.scale[2],       p.rotation.x,     p.rotation.y,     p.rotation.z, p.rotation.w };
    return std::all_of(std::begin(all), std::end(all),
                       [](double v) { return std::fabs(v) <= static_cast<double>(NOH_NUMBER_MAX); });
}

parts parts_of(job &j, const std::vector<placed> &pose, size_t model)
{
    const size_t holder = j.holder[model];
    parts out = parts_below(holder == none ? mat() : pose[holder].world, pose[model], holder == j.in.parent[model]);
    if (holder == none) {
        out.translation = j.in.to_y_up.point(out.translation);
        out.rotation = quaternion(j.in.to_y_up) * out.rotation;
    }
    out.translation = out.translation * j.unit_m;
    if (is_usable(out)) return out;
    j.in.warn(place_of(j.in, j.in.models[model]), " has a transform that is not finite or too large, and was left in "
                                                  "its parent's: export the file again");
    return parts();
}

/* --- visibility --- */

static bool blinks(const scene &s, size_t model)
{
    for (const take &t : s.takes)
        for (const layer &l : t.layers)
            if (l.channels.count({ model, "Visibility" })) return true;
    return false;
}

/* What a take moves is seen at some time. Without inheritance a node is shown whatever its parent is. */
static std::vector<bool> hidden_models(const scene &s)
{
    std::vector<bool> hidden(s.models.size());
    for (size_t i = 0; i < hidden.size(); ++i) {
        const size_t model = s.models[i], parent = s.parent[i];
        const bool own = s.real(model, "Visibility", 1.0) == 0.0 && !blinks(s, model);
        hidden[i] = own || (parent != none && hidden[parent] && s.whole(model, "Visibility Inheritance", 1) != 0);
    }
    return hidden;
}

/* glTF's mark would hide all that is below it, too. */
static tinygltf::Value not_visible()
{
    const tinygltf::Value alone(tinygltf::Value::Object{ { "alone", tinygltf::Value(true) } });
    return tinygltf::Value(tinygltf::Value::Object{ { "visible", tinygltf::Value(false) }, { "extras", alone } });
}

void write_nodes(job &j)
{
    const std::vector<bool> hidden = hidden_models(j.in);
    std::vector<placed> pose;
    find_holders(j);
    pose_rig(make_rig(j.in, nullptr), 0.0, pose);
    j.out.scenes.emplace_back();
    j.out.defaultScene = 0;
    for (size_t i = 0; i < pose.size(); ++i) {
        const parts p = parts_of(j, pose, i);
        tinygltf::Node n;
        n.name = j.in.objects[j.in.models[i]].name;
        n.translation = { p.translation[0], p.translation[1], p.translation[2] };
        n.rotation = { p.rotation.x, p.rotation.y, p.rotation.z, p.rotation.w };
        n.scale = { p.scale[0], p.scale[1], p.scale[2] };
        if (hidden[i] && j.in.objects[j.in.models[i]].sub == "Mesh")
            n.extensions["KHR_node_visibility"] = not_visible();
        j.out.nodes.push_back(n);
    }
    for (size_t i = 0; i < pose.size(); ++i) {
        std::vector<int> &list = j.holder[i] == none ? j.out.scenes[0].nodes : j.out.nodes[j.holder[i]].children;
        list.push_back(static_cast<int>(i));
    }
}

} // namespace fbx
