/* clips_internal.h: shared by the files that implement clips/model_clips.h. They read a model, not the glTF file, but
 * use the glTF reader's messages.
 *
 *   gltf_clips.cpp     clips_from_model: sets, clips
 *   gltf_skeleton.cpp  which nodes make which skeletons
 *   sample_rate.cpp    how many frames a clip needs, by the vertices that it moves
 *   weight_radius.cpp  how far a morph weight moves the surface */
#ifndef NOH_CONVERT_GLTF_CLIPS_INTERNAL_H
#define NOH_CONVERT_GLTF_CLIPS_INTERNAL_H

#include "gltf_internal.h"
#include "convert/clips/model_clips.h"
#include "convert/clips/moved_vertices.h"
#include "convert/clips/raw_set.h"

namespace gltf
{

/* --- gltf_skeleton.cpp --- */

/* A skeleton that is to be built. */
struct skeleton_plan {
    std::vector<uint32_t> nodes; /* ascending, so parents first: the joints */
    std::vector<uint32_t> skins;
    std::vector<uint32_t> weight_nodes; /* ascending: nodes whose morph weights its clips animate */
};
std::vector<skeleton_plan> plan_skeletons(const model &m);
/* The joint that a node is, or MODEL_NONE. */
uint32_t joint_of(const skeleton_plan &p, uint32_t node);
/* For every node, the joint at it or the next one above. */
std::vector<node_joint> find_movers(const model &m, const std::vector<skeleton_plan> &plans);
void build_skeleton(const model &m, const skeleton_plan &p, raw_skeleton &out);

/* Whether a channel moves no joint: weights of targets, or of an expression. */
inline bool is_weight(const model &m, const model_channel &c)
{
    return c.path == MODEL_PATH_WEIGHTS || (c.path == MODEL_PATH_TRANSLATION && m.nodes[c.node].expression);
}

/* --- sample_rate.cpp --- */

/* A channel, and what an error of it is worth. */
struct track {
    const model_channel *channel;
    uint32_t joint;                /* MODEL_NONE for weights */
    double lever_cm;               /* of a joint's: centimetres per radian, unit of translation or unit of scale */
    std::vector<double> radius_cm; /* of weights: centimetres per unit of each */
    bool seen;                     /* its joint moves vertices, on which it is judged with all others */
};
struct timing {
    double sample_rate_hz;
    uint32_t frame_count;
    double near_s;   /* a key at most this far from a frame counts as on it, so that a rounded time does not cost its
                        exact value */
    double error_cm; /* the largest distance between the played frames and the curves: of vertices, and of morph
                        weights, each judged alone */
    double keys_hz;  /* of the grid that all keys lie on; 0: there is none */
};
double frame_time_s(const timing &t, uint32_t frame);
/* What the tracks of joints move. */
struct moved {
    const raw_skeleton *skeleton;
    const moved_vertices *vertices;
};
/* sample_rate_hz 0: choose one. Throws failure if more than frames_max would be needed. */
timing choose_timing(const std::vector<track> &tracks, const moved &what, double duration_s, double sample_rate_hz,
                     double tolerance_cm, uint64_t frames_max, const std::string &where);

/* --- weight_radius.cpp --- */

/* The largest motion of a vertex by each target at weight 1, in the mesh's own units. */
std::vector<double> target_sizes(const model_mesh &mesh);
/* The largest factor by which the poses of a clip (NULL: the bind pose) enlarge a node's mesh.
 * skin  the joints of the node's skin in the set's skeleton, or NULL */
double largest_scale(const model &m, uint32_t node, const uint32_t *skin, uint32_t joint, const raw_set &set,
                     const raw_clip *clip);

} // namespace gltf

#endif
