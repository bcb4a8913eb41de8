/* fbx_pose.h: properties at a time, through the layers of a take, and where the nodes then are. */
#ifndef NOH_CONVERT_FBX_FBX_POSE_H
#define NOH_CONVERT_FBX_FBX_POSE_H

#include <string>
#include <utility>
#include <vector>

#include "fbx_scene.h"

namespace fbx
{

/* A property over time. */
struct animated {
    enum class kind { plain, rotation, scaling };
    vec rest;
    kind is = kind::plain;
    std::vector<std::pair<const layer *, const channel *>> layers; /* that change it */

    vec at(double seconds) const;
};

/* take: null: at rest. Pointers are into the scene. */
animated animate(const take *t, size_t object, const std::string &property, const vec &rest);

/* How a node's transform is made: L = T Roff Rp Rpre R Rpost^-1 Rp^-1 Soff Sp S Sp^-1. */
struct rig_node {
    size_t parent = none; /* place in the rig */
    int64_t rotation_order = 0, inherit_type = 0;
    bool has_spaces = false; /* rotation order, pre and post rotation count */
    animated translation, rotation, scaling, pre, post, rotation_offset, rotation_pivot, scaling_offset, scaling_pivot;
};

/* Where a node is. world: with all that its scale and its parents' do; turn: the product of rotations alone. */
struct placed {
    mat world, turn, shape; /* shape: turn^-1 world, without the place */
    vec local_place, local_scale;
    quat local_turn;
};

/* One for each of scene.models, in their order: parents first. */
std::vector<rig_node> make_rig(const scene &s, const take *t);
void pose_rig(const std::vector<rig_node> &rig, double seconds, std::vector<placed> &out);

/* Place, rotation and scale; `lost`: how far an axis is off that they cannot hold, over the longest axis. */
struct parts {
    vec translation, scale = { { 1.0, 1.0, 1.0 } };
    quat rotation;
    double lost = 0.0;
};

/* Of a node's world below another's. Where its own rotation and scale are the answer, exactly those. */
parts parts_below(const mat &above, const placed &node, bool is_parent);

} // namespace fbx
#endif
