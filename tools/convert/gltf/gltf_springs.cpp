/* gltf_springs.cpp: springs: VRMC_springBone 1.0, secondaryAnimation of VRM 0, and lines in the extras of nodes and of
 * the file, "springs": a text, or an array of lines (springs/springs_read.h).
 *
 * A VRM 0 bone swings with all below it; its last bones are 70 mm long, straight on, and its colliders' z points the
 * other way. */
#include "gltf_internal.h"

#include <algorithm>
#include <cmath>

#include "noh/base.h"

namespace gltf
{

using value = tinygltf::Value;

static const float vrm0_end_m = 0.07f;

/* ---- values ---- */

static double number_or(const value &object, const char *key, double otherwise)
{
    return object.IsObject() && object.Get(key).IsNumber() ? object.Get(key).GetNumberAsDouble() : otherwise;
}

/* Within a range; NaN is the least. */
static float limited(const value &object, const char *key, double otherwise, double least, double most)
{
    const double number = number_or(object, key, otherwise);
    return static_cast<float>(number > least ? std::min(number, most) : least);
}

/* [x, y, z], or {"x": ...}. */
static void vector_or(const value &given, const float otherwise[3], float out[3])
{
    static const char *const names[] = { "x", "y", "z" };
    for (int i = 0; i < 3; ++i) {
        double number = static_cast<double>(otherwise[i]);
        if (given.IsArray() && given.ArrayLen() == 3 && given.Get(i).IsNumber())
            number = given.Get(i).GetNumberAsDouble();
        else if (given.IsObject())
            number = number_or(given, names[i], 0.0);
        out[i] = number > -1e6 && number < 1e6 ? static_cast<float>(number) : 0.0f;
    }
}

static const value &member_or_none(const value &object, const char *key)
{
    static const value none;
    return object.IsObject() && object.Has(key) ? object.Get(key) : none;
}

static size_t length_of(const value &array)
{
    return array.IsArray() ? array.ArrayLen() : 0;
}

static const value &item(const value &array, size_t index)
{
    return array.Get(static_cast<int>(index));
}

/* The model's node of an index in the file. */
static uint32_t node_of(const file &f, const value &index)
{
    if (!index.IsNumber()) return MODEL_NONE;
    const double at = index.GetNumberAsDouble();
    return at >= 0.0 && at < static_cast<double>(f.node_of.size()) ? f.node_of[static_cast<size_t>(at)] : MODEL_NONE;
}

/* ---- while they are read ---- */

struct springs_job {
    file &f;
    std::vector<model_collider> colliders;
    std::vector<uint32_t> bits; /* of the file's colliders, or groups of them */
    std::vector<std::vector<model_spring_joint>> chains;
    std::vector<model_spring> springs; /* without joints, as many as chains */
};

static uint32_t add_collider(springs_job &job, const model_collider &c)
{
    if (job.colliders.size() == NOH_SPRING_COLLIDERS_MAX) {
        leave_out(job.f, "springs", text(": colliders past the first %u were left out", NOH_SPRING_COLLIDERS_MAX));
        return 0;
    }
    job.colliders.push_back(c);
    return 1u << (job.colliders.size() - 1u);
}

static void add_chain(springs_job &job, std::vector<model_spring_joint> joints, uint32_t collides, const float end[3])
{
    model_spring spring = {};
    if (joints.empty()) return;
    spring.joint_count = static_cast<uint32_t>(joints.size());
    spring.collides = collides;
    std::copy(end, end + 3, spring.end);
    job.chains.push_back(std::move(joints));
    job.springs.push_back(spring);
}

static uint32_t bits_of(springs_job &job, const value &indices, const char *kind)
{
    uint32_t bits = 0;
    for (size_t i = 0; i < length_of(indices); ++i) {
        const double at = item(indices, i).IsNumber() ? item(indices, i).GetNumberAsDouble() : -1.0;
        if (at >= 0.0 && at < static_cast<double>(job.bits.size()))
            bits |= job.bits[static_cast<size_t>(at)];
        else
            leave_out(job.f, "springs", text(": a %s was ignored: the file has no such one", kind));
    }
    return bits;
}

static const char joint_lost[] = ": a joint was left out: its node does not exist, or is not in the default scene";

static void warn_center(springs_job &job, const value &spring)
{
    if (number_or(spring, "center", -1.0) >= 0.0)
        leave_out(job.f, "springs", ": a center was ignored: springs are simulated in world space");
}

/* ---- VRMC_springBone ---- */

static uint32_t read_collider(springs_job &job, const value &given)
{
    static const float zero[3] = { 0.0f, 0.0f, 0.0f };
    const value &shape = member_or_none(given, "shape"), &sphere = member_or_none(shape, "sphere"),
                &capsule = member_or_none(shape, "capsule");
    const value &round = capsule.IsObject() ? capsule : sphere;
    model_collider c = {};
    c.node = node_of(job.f, member_or_none(given, "node"));
    if (c.node == MODEL_NONE || !round.IsObject()) {
        leave_out(job.f, "springs", ": a collider was left out: it has no node, or is neither a sphere nor a capsule");
        return 0;
    }
    c.radius = limited(round, "radius", 0.0, 0.0, 1e3);
    vector_or(member_or_none(round, "offset"), zero, c.from);
    vector_or(member_or_none(capsule, "tail"), c.from, c.to);
    return add_collider(job, c);
}

/* Where a node lies in the space of another one, at rest. */
static void place_in(const model &m, uint32_t node, uint32_t above, float out[3])
{
    const double *a = m.nodes[above].world, *b = m.nodes[node].world;
    double way[3], columns[3][3], determinant;
    for (int i = 0; i < 3; ++i) way[i] = b[12 + i] - a[12 + i];
    for (int c = 0; c < 3; ++c) /* the rows of the inverse, times the determinant */
        for (int i = 0; i < 3; ++i) {
            const double *u = a + 4 * ((c + 1) % 3), *v = a + 4 * ((c + 2) % 3);
            columns[c][i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
        }
    determinant = a[0] * columns[0][0] + a[1] * columns[0][1] + a[2] * columns[0][2];
    for (int c = 0; c < 3; ++c) {
        const double dot = way[0] * columns[c][0] + way[1] * columns[c][1] + way[2] * columns[c][2];
        const double at = dot / determinant;
        out[c] = at > -1e6 && at < 1e6 ? static_cast<float>(at) : 0.0f;
    }
}

static model_spring_joint read_joint(springs_job &job, const value &given)
{
    static const float down[3] = { 0.0f, -1.0f, 0.0f };
    model_spring_joint joint = {};
    const float power = limited(given, "gravityPower", 0.0, 0.0, 1e3);
    joint.node = node_of(job.f, member_or_none(given, "node"));
    joint.radius = limited(given, "hitRadius", 0.0, 0.0, 1e3);
    joint.stiffness = limited(given, "stiffness", 1.0, 0.0, 1e3);
    joint.drag = limited(given, "dragForce", 0.5, 0.0, 1.0);
    vector_or(member_or_none(given, "gravityDir"), down, joint.gravity);
    for (float &axis : joint.gravity) axis *= power;
    return joint;
}

/* The last joint of a spring is only the end of the bone before it. */
static void read_spring(springs_job &job, const value &given)
{
    const value &listed = member_or_none(given, "joints");
    std::vector<model_spring_joint> joints;
    float end[3] = { 0.0f, 0.0f, 0.0f };
    for (size_t i = 0; i < length_of(listed); ++i) {
        const model_spring_joint joint = read_joint(job, item(listed, i));
        if (joint.node != MODEL_NONE)
            joints.push_back(joint);
        else
            leave_out(job.f, "springs", joint_lost);
    }
    if (joints.size() < 2) {
        leave_out(job.f, "springs", ": a spring was left out: it has fewer than two joints");
        return;
    }
    warn_center(job, given);
    place_in(*job.f.out, joints.back().node, joints[joints.size() - 2].node, end);
    joints.pop_back();
    uint32_t collides = bits_of(job, member_or_none(given, "colliderGroups"), "collider group");
    add_chain(job, std::move(joints), collides, end);
}

static void read_vrm1(springs_job &job, const value &extension)
{
    const value &colliders = member_or_none(extension, "colliders"),
                &groups = member_or_none(extension, "colliderGroups");
    const value &springs = member_or_none(extension, "springs");
    std::vector<uint32_t> of_groups;
    for (size_t i = 0; i < length_of(colliders); ++i) job.bits.push_back(read_collider(job, item(colliders, i)));
    for (size_t i = 0; i < length_of(groups); ++i)
        of_groups.push_back(bits_of(job, member_or_none(item(groups, i), "colliders"), "collider"));
    job.bits = of_groups;
    for (size_t i = 0; i < length_of(springs); ++i) read_spring(job, item(springs, i));
}

/* ---- VRM 0 ---- */

static uint32_t read_group0(springs_job &job, const value &group)
{
    static const float zero[3] = { 0.0f, 0.0f, 0.0f };
    const value &colliders = member_or_none(group, "colliders");
    const uint32_t node = node_of(job.f, member_or_none(group, "node"));
    uint32_t bits = 0;
    if (node == MODEL_NONE && length_of(colliders) > 0)
        leave_out(job.f, "springs", ": a collider group was left out: its node does not exist");
    for (size_t i = 0; node != MODEL_NONE && i < length_of(colliders); ++i) {
        model_collider c = {};
        c.node = node;
        c.radius = limited(item(colliders, i), "radius", 0.0, 0.0, 1e3);
        vector_or(member_or_none(item(colliders, i), "offset"), zero, c.from);
        c.from[2] = -c.from[2];
        std::copy(c.from, c.from + 3, c.to);
        bits |= add_collider(job, c);
    }
    return bits;
}

static std::vector<uint32_t> children_of(const model &m, uint32_t node)
{
    std::vector<uint32_t> children;
    for (uint32_t n = 0; n < m.node_count; ++n)
        if (m.nodes[n].parent == node) children.push_back(n);
    return children;
}

/* Straight on from the parent, in the node's space. */
static void vrm0_end(const model &m, uint32_t node, float out[3])
{
    const model_node &n = m.nodes[node];
    const float *t = n.translation, *q = n.rotation;
    const double length = std::sqrt(static_cast<double>(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]));
    double v[3], w[3];
    for (int i = 0; i < 3; ++i)
        v[i] = length > 0.0 ? static_cast<double>(vrm0_end_m) * static_cast<double>(t[i]) / length : 0.0;
    for (int i = 0; i < 3; ++i) { /* by the conjugate */
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        w[i] = 2.0 * (static_cast<double>(-q[j]) * v[k] - static_cast<double>(-q[k]) * v[j]);
    }
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = static_cast<float>(v[i] + static_cast<double>(q[3]) * w[i] + static_cast<double>(-q[j]) * w[k] -
                                    static_cast<double>(-q[k]) * w[j]);
    }
}

/* A bone and all below it: straight down by first children, every other child begins a chain of its own. */
static void read_bone0(springs_job &job, uint32_t top, const model_spring_joint &values, uint32_t collides)
{
    const model &m = *job.f.out;
    std::vector<uint32_t> begins = { top };
    for (size_t b = 0; b < begins.size(); ++b) {
        std::vector<model_spring_joint> joints;
        float end[3];
        for (uint32_t node = begins[b]; node != MODEL_NONE;) {
            const std::vector<uint32_t> below = children_of(m, node);
            joints.push_back(values);
            joints.back().node = node;
            if (!below.empty()) begins.insert(begins.end(), below.begin() + 1, below.end());
            if (below.empty()) vrm0_end(m, node, end);
            node = below.empty() ? MODEL_NONE : below[0];
        }
        add_chain(job, std::move(joints), collides, end);
    }
}

static void read_vrm0(springs_job &job, const value &extension)
{
    static const float down[3] = { 0.0f, -1.0f, 0.0f };
    const value &secondary = member_or_none(extension, "secondaryAnimation");
    const value &groups = member_or_none(secondary, "boneGroups"),
                &colliders = member_or_none(secondary, "colliderGroups");
    for (size_t i = 0; i < length_of(colliders); ++i) job.bits.push_back(read_group0(job, item(colliders, i)));
    for (size_t i = 0; i < length_of(groups); ++i) {
        const value &group = item(groups, i), &bones = member_or_none(group, "bones");
        model_spring_joint values = {};
        const float power = limited(group, "gravityPower", 0.0, 0.0, 1e3);
        values.stiffness = limited(group, "stiffiness", 1.0, 0.0, 1e3); /* spelt so in the format */
        values.drag = limited(group, "dragForce", 0.4, 0.0, 1.0);
        values.radius = limited(group, "hitRadius", 0.02, 0.0, 1e3);
        vector_or(member_or_none(group, "gravityDir"), down, values.gravity);
        for (float &axis : values.gravity) axis *= power;
        warn_center(job, group);
        for (size_t k = 0; k < length_of(bones); ++k) {
            const uint32_t top = node_of(job.f, item(bones, k));
            if (top != MODEL_NONE)
                read_bone0(job, top, values, bits_of(job, member_or_none(group, "colliderGroups"), "collider group"));
            else
                leave_out(job.f, "springs", joint_lost);
        }
    }
}

/* ---- extras ---- */

static void read_lines(file &f, const value &extras, const std::string &where, std::string &lines)
{
    if (!extras.IsObject() || !extras.Has("springs")) return;
    const value &given = extras.Get("springs");
    std::string own;
    if (given.IsString()) own = given.Get<std::string>() + "\n";
    for (size_t i = 0; given.IsArray() && i < given.ArrayLen(); ++i)
        if (item(given, i).IsString()) own += item(given, i).Get<std::string>() + "\n";
    if (own.empty())
        leave_out(f, where + ": the springs in its extras",
                  " were skipped: they are neither a text nor an array of lines");
    std::replace(own.begin(), own.end(), ';', '\n');
    lines += own;
}

/* ---- all ---- */

static void keep(springs_job &job)
{
    file &f = job.f;
    model *m = f.out;
    m->colliders = allocate<model_collider>(f, job.colliders.size(), "springs");
    std::copy(job.colliders.begin(), job.colliders.end(), m->colliders);
    m->collider_count = static_cast<uint32_t>(job.colliders.size());
    m->springs = allocate<model_spring>(f, job.springs.size(), "springs");
    for (size_t i = 0; i < job.springs.size(); ++i) {
        m->springs[i] = job.springs[i];
        m->spring_count = static_cast<uint32_t>(i + 1);
        m->springs[i].joints = allocate<model_spring_joint>(f, job.chains[i].size(), "springs");
        std::copy(job.chains[i].begin(), job.chains[i].end(), m->springs[i].joints);
    }
}

void read_springs(file &f)
{
    springs_job job = { f, {}, {}, {}, {} };
    std::string lines;
    const auto vrm1 = f.json.extensions.find("VRMC_springBone"), vrm0 = f.json.extensions.find("VRM");
    if (vrm1 != f.json.extensions.end())
        read_vrm1(job, vrm1->second);
    else if (vrm0 != f.json.extensions.end())
        read_vrm0(job, vrm0->second);
    keep(job);
    read_lines(f, f.json.extras, "the file", lines);
    for (size_t i = 0; i < f.json.nodes.size(); ++i)
        read_lines(f, f.json.nodes[i].extras, "node '" + printable(name_or(f.json.nodes[i].name, "node", i)) + "'",
                   lines);
    if (!lines.empty()) f.out->spring_lines = copy_string(lines);
}

} // namespace gltf
