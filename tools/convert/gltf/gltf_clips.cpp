/* gltf_clips.cpp: a model's animations as sampled clips. */
#include "clips_internal.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <memory>

#include "convert/clips/channel_sample.h"
#include "convert/model/affine.h"
#include "convert/base/quat.h"

namespace gltf
{

static const double tolerance_part = 1e-3; /* of the skeleton's size */
static const double shell_cm = 3.0;        /* around a joint that moves nothing, ... */
static const double shell_part = 0.02;     /* ... but no more than this of the size of what others move */

struct clip_deleter {
    void operator()(model_clips *made) const
    {
        model_clips_free(made);
    }
};
using clips_pointer = std::unique_ptr<model_clips, clip_deleter>;

/* Shared by the clips of one skeleton. */
struct set_job {
    model *m;
    const skeleton_plan *plan;
    const model_clips *made;
    uint32_t index;
    raw_set *set;
    moved_vertices vertices;
    std::vector<double> lever_cm; /* [joints] of a rotation: the radius of its descendants and of what they move */
    std::vector<double> parent_scale_cm; /* [joints] centimetres per unit of its translation */
    std::vector<bool> seen;              /* [joints] it or one below it moves vertices */
    double shell_cm;
    ~set_job()
    {
        moved_vertices_free(&vertices);
    }
};

template <class T> static T *zeros(size_t count)
{
    T *array = static_cast<T *>(model_zeros(count, sizeof(T)));
    if (!array) throw std::bad_alloc();
    return array;
}

static void check_memory(int failed)
{
    if (failed) throw std::bad_alloc();
}

/* --- the effect of errors --- */

static double longest_column(const double *m)
{
    return std::fmax(std::fmax(std::sqrt(vec_dot(m, m)), std::sqrt(vec_dot(m + 3, m + 3))),
                     std::sqrt(vec_dot(m + 6, m + 6)));
}

/* From the node's mesh to the joint's own space; the nodes between do not move. */
static bool rigid_place(const model &m, uint32_t node, uint32_t joint_node, double *out)
{
    double inverse[16], product[16];
    if (joint_node == MODEL_NONE || affine_invert(m.nodes[joint_node].world, inverse)) return false;
    affine_multiply(inverse, m.nodes[node].world, product);
    for (int i = 0; i < 12; ++i) out[i] = product[i / 3 * 4 + i % 3];
    return true;
}

static void find_vertices(set_job &job)
{
    const model &m = *job.m;
    const raw_skeleton &skeleton = job.set->skeleton;
    for (uint32_t n = 0; n < m.node_count; ++n) {
        const model_node &node = m.nodes[n];
        const node_joint &mover = job.made->nodes[n];
        double place[12];
        if (node.mesh == MODEL_NONE) continue;
        if (node.skin != MODEL_NONE) {
            const clip_skin &skin = job.made->skins[node.skin];
            if (skin.joints && skin.set == job.index)
                check_memory(moved_vertices_add(&job.vertices, &m.meshes[node.mesh], &m.skins[node.skin], skin.joints));
        } else if (mover.set == job.index && mover.joint != MODEL_NONE &&
                   rigid_place(m, n, skeleton.joints[mover.joint].node, place)) {
            check_memory(moved_vertices_add_rigid(&job.vertices, &m.meshes[node.mesh], mover.joint, place));
        }
    }
    check_memory(moved_vertices_close(&job.vertices, skeleton.joint_count));
}

static void find_levers(set_job &job)
{
    const raw_skeleton &skeleton = job.set->skeleton;
    std::vector<double> pose(size_t{ skeleton.joint_count } * 12 + 12);
    double size_cm = 0.0;
    job.lever_cm.assign(skeleton.joint_count + 1, 0.0);
    job.parent_scale_cm.assign(skeleton.joint_count + 1, skeleton.unit_cm);
    std::vector<double> reach(skeleton.joint_count + 1, 0.0);
    check_memory(raw_skeleton_radius(&skeleton, job.lever_cm.data(), &size_cm));
    raw_pose_object(&skeleton, nullptr, 0, pose.data());
    moved_vertices_reach(&job.vertices, &skeleton, pose.data(), 0, reach.data());
    for (size_t j = 0; j < reach.size(); ++j) {
        job.seen.push_back(reach[j] > 0.0);
        job.lever_cm[j] = std::fmax(job.lever_cm[j], reach[j]);
    }
    const double size = *std::max_element(job.lever_cm.begin(), job.lever_cm.end());
    job.shell_cm = job.vertices.vertex_count ? std::fmin(shell_cm, size * shell_part) : shell_cm;
    for (uint32_t j = 0; j < skeleton.joint_count; ++j) {
        job.lever_cm[j] = std::fmax(job.lever_cm[j], job.shell_cm);
        if (skeleton.joints[j].parent != MODEL_NONE)
            job.parent_scale_cm[j] = skeleton.unit_cm * longest_column(&pose[size_t{ skeleton.joints[j].parent } * 12]);
    }
}

static double lever_of(const set_job &job, const model_channel &c, uint32_t joint)
{
    if (c.path == MODEL_PATH_TRANSLATION) return job.parent_scale_cm[joint];
    if (c.path == MODEL_PATH_ROTATION) return job.lever_cm[joint];
    const float *s = job.set->skeleton.joints[joint].scale; /* levers hold the bind scale already */
    double largest = static_cast<double>(std::fmax(std::fmax(std::fabs(s[0]), std::fabs(s[1])), std::fabs(s[2])));
    return job.lever_cm[joint] / std::fmax(largest, 1e-3);
}

/* The joints of a node's skin in the skeleton, or null. */
static const uint32_t *skin_joints(const set_job &job, uint32_t node)
{
    uint32_t skin = job.m->nodes[node].skin;
    return skin < job.m->skin_count ? job.made->skins[skin].joints : nullptr;
}

static std::vector<double> radius_of(const set_job &job, uint32_t node, const raw_clip *clip)
{
    const node_joint &mover = job.made->nodes[node];
    uint32_t joint = mover.set == job.index ? mover.joint : MODEL_NONE;
    std::vector<double> radius = target_sizes(job.m->meshes[job.m->nodes[node].mesh]);
    double scale_cm = 100.0 * largest_scale(*job.m, node, skin_joints(job, node), joint, *job.set, clip);
    for (double &r : radius) r *= scale_cm;
    return radius;
}

/* --- the tracks of one clip --- */

const double expression_cm = 1.0; /* how far an expression at weight 1 moves a face, to choose a rate by */

static std::vector<track> find_tracks(const set_job &job, const model_clip &clip)
{
    std::vector<track> tracks;
    const std::vector<uint32_t> &weight_nodes = job.plan->weight_nodes;
    for (uint32_t i = 0; i < clip.channel_count; ++i) {
        const model_channel &c = clip.channels[i];
        uint32_t joint = joint_of(*job.plan, c.node);
        if (!is_weight(*job.m, c) && joint != MODEL_NONE)
            tracks.push_back({ &c, joint, lever_of(job, c, joint), {}, job.seen[joint] });
        if (!is_weight(*job.m, c) || !std::binary_search(weight_nodes.begin(), weight_nodes.end(), c.node)) continue;
        if (c.path == MODEL_PATH_WEIGHTS)
            tracks.push_back({ &c, MODEL_NONE, 0.0, radius_of(job, c.node, nullptr), false });
        else
            tracks.push_back({ &c, MODEL_NONE, 0.0, { expression_cm, 0.0, 0.0 }, false });
    }
    return tracks;
}

static double largest_value(const model_channel &c)
{
    float largest = 0.0f;
    for (uint32_t key = 0; key < c.key_count; ++key)
        for (uint32_t i = 0; i < c.width; ++i) largest = std::fmax(largest, std::fabs(channel_key(&c, key)[i]));
    return static_cast<double>(largest);
}

/* How far playing may be off the curves: a share of the size of all that moves. */
static double tolerance_of(const set_job &job, const std::vector<track> &tracks)
{
    double size_cm = *std::max_element(job.lever_cm.begin(), job.lever_cm.end());
    size_cm = std::fmax(size_cm, job.shell_cm);
    for (const track &t : tracks) {
        if (t.channel->path == MODEL_PATH_TRANSLATION)
            size_cm = std::fmax(size_cm, largest_value(*t.channel) * t.lever_cm);
        for (double r : t.radius_cm) size_cm = std::fmax(size_cm, r);
    }
    return size_cm * tolerance_part;
}

static uint64_t frame_bytes(const set_job &job, const std::vector<track> &tracks)
{
    uint64_t floats = 1; /* never zero */
    bool moves = false;
    for (const track &t : tracks) {
        moves = moves || t.joint != MODEL_NONE;
        floats += t.joint == MODEL_NONE ? t.channel->width : 0;
    }
    return floats * sizeof(float) + (moves ? uint64_t{ job.set->skeleton.joint_count } * RAW_JOINT_BYTES : 0);
}

/* --- filling frames --- */

static void fill_bind_pose(const raw_skeleton &skeleton, raw_clip &clip)
{
    for (size_t i = 0; i < size_t{ clip.frame_count } * clip.joint_count; ++i) {
        const raw_joint &joint = skeleton.joints[i % clip.joint_count];
        std::copy_n(joint.rotation, 4, clip.rotations + i * 4);
        std::copy_n(joint.translation, 3, clip.translations + i * 3);
        std::copy_n(joint.scale, 3, clip.scales + i * 3);
    }
}

/* stride: floats from one frame to the next */
static void sample_track(const set_job &job, const track &t, const timing &when, float *out, size_t stride,
                         const std::string &where)
{
    const model_channel &c = *t.channel;
    std::vector<double> value(c.width), before(c.width, 0.0);
    uint32_t lost = 0;
    if (c.path == MODEL_PATH_ROTATION) std::copy_n(out, 4, before.begin()); /* the bind pose */
    for (uint32_t frame = 0; frame < when.frame_count; ++frame) {
        double time_s = frame_time_s(when, frame);
        if (channel_sample(&c, time_s, when.near_s, value.data()) && !lost++)
            check_memory(model_warn(job.m,
                                    "%s: a rotation passes through zero at %g s and has no direction there; the "
                                    "key before was kept",
                                    where.c_str(), time_s));
        if (c.path == MODEL_PATH_ROTATION) quat_align(value.data(), before.data());
        for (size_t i = 0; i < c.width; ++i)
            out[frame * stride + i] = std::fabs(value[i]) <= static_cast<double>(FLT_MAX)
                                          ? static_cast<float>(value[i]) /* the place is text: made if it is needed */
                                          : to_float(value[i], where + text(" at %g s", time_s));
        before = value;
    }
}

static float *values_of(raw_clip &clip, const track &t, size_t &stride)
{
    stride = size_t{ clip.joint_count } * t.channel->width;
    float *all = t.channel->path == MODEL_PATH_ROTATION      ? clip.rotations
                 : t.channel->path == MODEL_PATH_TRANSLATION ? clip.translations
                                                             : clip.scales;
    return all + size_t{ t.joint } * t.channel->width;
}

static void fill_joints(const set_job &job, const std::vector<track> &tracks, const timing &when, raw_clip &clip,
                        const std::string &where)
{
    bool moves = std::any_of(tracks.begin(), tracks.end(), [](const track &t) { return t.joint != MODEL_NONE; });
    check_memory(raw_clip_alloc(&clip, when.frame_count, moves ? job.set->skeleton.joint_count : 0));
    fill_bind_pose(job.set->skeleton, clip);
    for (const track &t : tracks) {
        size_t stride = 0;
        if (t.joint == MODEL_NONE) continue;
        float *out = values_of(clip, t, stride);
        sample_track(job, t, when, out, stride,
                     where + " node '" + printable(job.m->nodes[t.channel->node].name) + "'");
    }
}

static void fill_weights(const set_job &job, const track &t, const timing &when, raw_clip &clip,
                         const std::string &where)
{
    const uint32_t node = t.channel->node, width = t.channel->width;
    raw_floats &floats = clip.floats[clip.float_count++];
    check_memory(raw_floats_alloc(&floats, clip.frame_count, width));
    floats.node = node;
    floats.name = copy_string(job.m->nodes[node].name);
    floats.radius = zeros<float>(width);
    std::vector<double> radius = radius_of(job, node, &clip);
    std::string place = where + " weights of node '" + printable(floats.name) + "'";
    for (uint32_t i = 0; i < width; ++i) floats.radius[i] = to_float(radius[i], place);
    sample_track(job, t, when, floats.values, width, place);
}

/* The weight of a VRM animation's expression. */
static void fill_expression(const set_job &job, const track &t, const timing &when, raw_clip &clip,
                            const std::string &where)
{
    raw_floats &floats = clip.floats[clip.float_count++];
    std::vector<float> moved(size_t{ clip.frame_count } * 3);
    check_memory(raw_floats_alloc(&floats, clip.frame_count, 1));
    floats.node = MODEL_NONE;
    floats.name = copy_string(job.m->nodes[t.channel->node].expression);
    sample_track(job, t, when, moved.data(), 3, where + " expression '" + printable(floats.name) + "'");
    for (size_t k = 0; k < clip.frame_count; ++k) floats.values[k] = moved[3 * k];
}

static void copy_events(const model_clip &from, raw_clip &clip)
{
    for (uint32_t i = 0; i < from.event_count; ++i) {
        raw_event event = { from.events[i].name,
                            std::fmin(from.events[i].time_s, raw_clip_duration_s(&clip)),
                            { 0 },
                            from.events[i].weight_min,
                            from.events[i].is_marker };
        memcpy(event.payload, from.events[i].payload, sizeof event.payload);
        check_memory(raw_clip_add_event(&clip, &event));
    }
}

/* --- clips --- */

static void warn_of_error(const set_job &job, const raw_clip &clip, double tolerance_cm, const std::string &where)
{
    const double usual_hz = 119.0;
    if (clip.source_error_cm > tolerance_cm && clip.sample_rate_hz >= usual_hz)
        check_memory(model_warn(job.m, "%s: sampled at %g Hz it is up to %.3g cm off its curves between frames",
                                where.c_str(), clip.sample_rate_hz, clip.source_error_cm));
}

/* More frames than keys take more bytes, which users who do not need the curves should know. */
static void warn_of_rate(const set_job &job, const timing &when, const std::string &where)
{
    if (when.keys_hz > 0.0 && when.sample_rate_hz > 1.5 * when.keys_hz && when.keys_hz >= 15.0)
        check_memory(model_warn(
            job.m, "%s: it has %g keys a second, and its curves need %g frames a second; --rate %g keeps only the keys",
            where.c_str(), when.keys_hz, when.sample_rate_hz, when.keys_hz));
}

static void make_clip(const set_job &job, const model_clip &from, const std::vector<track> &tracks,
                      double sample_rate_hz, uint64_t &bytes_left)
{
    std::string where = "animation '" + printable(from.name) + "'";
    raw_clip &clip = job.set->clips[job.set->clip_count++]; /* counted first, so that it is freed when sampling fails */
    double tolerance_cm = tolerance_of(job, tracks);
    uint64_t per_frame = frame_bytes(job, tracks),
             frames_max = std::min<uint64_t>(bytes_left / per_frame, RAW_FRAMES_MAX);
    timing when = choose_timing(tracks, { &job.set->skeleton, &job.vertices }, static_cast<double>(from.duration_s),
                                sample_rate_hz, tolerance_cm, frames_max, where);
    bytes_left -= std::min(bytes_left, when.frame_count * per_frame);
    clip.name = copy_string(from.name);
    clip.sample_rate_hz = when.sample_rate_hz;
    clip.loop = from.loop;
    clip.source_error_cm = when.error_cm;
    clip.source = &from;
    fill_joints(job, tracks, when, clip, where);
    clip.floats = zeros<raw_floats>(tracks.size());
    for (const track &t : tracks)
        if (t.joint == MODEL_NONE && t.channel->path == MODEL_PATH_WEIGHTS)
            fill_weights(job, t, when, clip, where);
        else if (t.joint == MODEL_NONE)
            fill_expression(job, t, when, clip, where);
    warn_of_error(job, clip, tolerance_cm, where);
    if (!(sample_rate_hz > 0.0)) warn_of_rate(job, when, where);
}

/* A clip that cannot be made is left out: the character moves without it. */
static bool try_clip(const set_job &job, const model_clip &from, const std::vector<track> &tracks,
                     double sample_rate_hz, uint64_t &bytes_left)
{
    const uint32_t before = job.set->clip_count;
    try {
        make_clip(job, from, tracks, sample_rate_hz, bytes_left);
        return true;
    } catch (const failure &reason) {
        check_memory(model_warn(job.m, "%s was left out: %s", reason.where.c_str(), reason.what.c_str()));
    }
    if (job.set->clip_count > before) raw_clip_clear(&job.set->clips[before]);
    job.set->clip_count = before;
    return false;
}

static void make_clips(set_job &job, double sample_rate_hz, std::vector<bool> &used, uint64_t &bytes_left)
{
    for (uint32_t c = 0; c < job.m->clip_count; ++c) {
        const model_clip &from = job.m->clips[c];
        std::vector<track> tracks = find_tracks(job, from);
        if (tracks.empty()) continue;
        const bool made = try_clip(job, from, tracks, sample_rate_hz, bytes_left);
        if (made && !used[c]) /* a key in several sets would fire several times */
            copy_events(from, job.set->clips[job.set->clip_count - 1]);
        used[c] = true;
    }
}

/* --- what lies before the first key --- */

static float first_key_s(const model_clip &clip)
{
    float first = clip.duration_s;
    for (uint32_t i = 0; i < clip.channel_count; ++i)
        if (clip.channels[i].key_count) first = std::fmin(first, clip.channels[i].times[0]);
    return first;
}

/* Editors that count frames from 1 put the first key one frame after 0: each loop would stand still for that time. A
 * longer wait may be meant. A key before 0 is never reached. */
static void trim_start(model &m, model_clip &clip)
{
    const float first = first_key_s(clip), most = 0.1f;
    if (!(first < 0.0f || (first > 0.0f && first <= most && first < clip.duration_s))) return;
    for (uint32_t i = 0; i < clip.channel_count; ++i)
        for (uint32_t k = 0; k < clip.channels[i].key_count; ++k) clip.channels[i].times[k] -= first;
    for (uint32_t i = 0; i < clip.event_count; ++i)
        clip.events[i].time_s = std::fmax(clip.events[i].time_s - static_cast<double>(first), 0.0);
    clip.duration_s -= first;
    check_memory(model_warn(&m, "animation '%s': its first key is at %.3g s; the clip begins there",
                            printable(clip.name).c_str(), static_cast<double>(first)));
}

/* --- sets --- */

static void make_set(const model &m, const skeleton_plan &plan, model_clips &made)
{
    raw_set *set = raw_set_new(static_cast<uint32_t>(plan.nodes.size()), m.clip_count);
    if (!set) throw std::bad_alloc();
    made.sets[made.set_count++] = set;
    set->clip_count = 0;
    build_skeleton(m, plan, set->skeleton);
}

static void bind_skins(const model &m, const std::vector<skeleton_plan> &plans, model_clips &made)
{
    for (uint32_t p = 0; p < plans.size(); ++p)
        for (uint32_t s : plans[p].skins) {
            made.skins[s].set = p;
            made.skins[s].joints = zeros<uint32_t>(m.skins[s].joint_count);
            for (uint32_t j = 0; j < m.skins[s].joint_count; ++j)
                made.skins[s].joints[j] = joint_of(plans[p], m.skins[s].joints[j]);
        }
}

static void bind_nodes(const model &m, const std::vector<skeleton_plan> &plans, model_clips &made)
{
    std::vector<node_joint> movers = find_movers(m, plans);
    made.nodes = zeros<node_joint>(m.node_count);
    std::copy(movers.begin(), movers.end(), made.nodes);
}

static clips_pointer make_sets(const model &m, const std::vector<skeleton_plan> &plans)
{
    clips_pointer made(zeros<model_clips>(1));
    made->sets = zeros<raw_set *>(plans.size());
    made->skins = zeros<clip_skin>(m.skin_count);
    made->skin_count = m.skin_count;
    for (const skeleton_plan &plan : plans) make_set(m, plan, *made);
    bind_skins(m, plans, *made);
    bind_nodes(m, plans, *made);
    return made;
}

static model_clips *make_model_clips(model &m, double sample_rate_hz)
{
    for (uint32_t c = 0; c < m.clip_count; ++c) trim_start(m, m.clips[c]);
    std::vector<skeleton_plan> plans = plan_skeletons(m);
    clips_pointer made = make_sets(m, plans);
    std::vector<bool> used(m.clip_count, false);
    uint64_t bytes_left = RAW_BYTES_MAX;
    for (uint32_t p = 0; p < plans.size(); ++p) {
        set_job job = { &m, &plans[p], made.get(), p, made->sets[p], {}, {}, {}, {}, 0.0 };
        find_vertices(job);
        find_levers(job);
        make_clips(job, sample_rate_hz, used, bytes_left);
    }
    for (uint32_t c = 0; c < m.clip_count; ++c)
        if (!used[c])
            check_memory(model_warn(&m, "animation '%s' was skipped: it animates nothing that the pack holds",
                                    printable(m.clips[c].name).c_str()));
    return made.release();
}

} // namespace gltf

extern "C" int clips_from_model(model *m, const sample_options *options, model_clips **out, model_error *error)
{
    double sample_rate_hz = options ? options->sample_rate_hz : 0.0;
    *out = nullptr;
    if (!(sample_rate_hz >= 0.0 && sample_rate_hz <= 1e6))
        return model_fail(error, "", "the sample rate must be above 0, not %g Hz", sample_rate_hz);
    try {
        *out = gltf::make_model_clips(*m, sample_rate_hz);
        return 0;
    } catch (const gltf::failure &reason) {
        return model_fail(error, reason.where.c_str(), "%s", reason.what.c_str());
    } catch (const std::exception &) {
        return model_fail(error, "", "there is not enough memory for these animations");
    }
}

extern "C" void model_clips_free(model_clips *made)
{
    if (!made) return;
    for (uint32_t i = 0; made->sets && i < made->set_count; ++i) raw_set_free(made->sets[i]);
    for (uint32_t i = 0; made->skins && i < made->skin_count; ++i) free(made->skins[i].joints);
    free(made->sets);
    free(made->skins);
    free(made->nodes);
    free(made);
}
