/* gltf_scene.cpp: the node hierarchy. */
#include "gltf_internal.h"
#include "convert/base/quat.h"

#include "noh/base.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gltf
{

/* A node that is to be read, and the model's index of its parent. */
struct visit {
    size_t node;
    uint32_t parent;
};

static std::string node_where(const file &f, size_t node)
{
    return "node '" + printable(name_or(f.json.nodes[node].name, "node", node)) + "'";
}

/* --- which nodes, in which order --- */

static bool node_exists(file &f, int node, const std::string &where)
{
    if (node >= 0 && static_cast<size_t>(node) < f.json.nodes.size()) return true;
    leave_out(f, where, text(": node %d was left out: it does not exist, the file has %zu", node, f.json.nodes.size()));
    return false;
}

/* Children that do not exist, or that have another parent already, are taken out. */
static std::vector<bool> nodes_with_parent(file &f)
{
    std::vector<bool> has_parent(f.json.nodes.size(), false);
    for (size_t i = 0; i < f.json.nodes.size(); ++i) {
        std::vector<int> kept;
        for (int child : f.json.nodes[i].children) {
            if (!node_exists(f, child, node_where(f, i) + " children")) continue;
            if (has_parent[static_cast<size_t>(child)]) {
                leave_out(f, node_where(f, static_cast<size_t>(child)),
                          ": the node has two parents: it was left below the first");
                continue;
            }
            has_parent[static_cast<size_t>(child)] = true;
            kept.push_back(child);
        }
        f.json.nodes[i].children.swap(kept);
    }
    return has_parent;
}

/* The roots of the default scene, or all roots where the file has no scene. Some exporters list all nodes: those with a
 * parent come last, and are skipped where the parent has brought them in. */
static std::vector<size_t> root_nodes(file &f)
{
    std::vector<bool> has_parent = nodes_with_parent(f);
    std::vector<size_t> roots, below;
    if (f.json.scenes.empty()) {
        for (size_t i = 0; i < f.json.nodes.size(); ++i)
            if (!has_parent[i]) roots.push_back(i);
        return roots;
    }
    size_t scene = f.json.defaultScene < 0 ? 0 : static_cast<size_t>(f.json.defaultScene);
    if (scene >= f.json.scenes.size()) {
        leave_out(f, "scene",
                  text(" %zu does not exist: the file has %zu; the first was read", scene, f.json.scenes.size()));
        scene = 0;
    }
    for (int node : f.json.scenes[scene].nodes) {
        if (!node_exists(f, node, text("scene %zu", scene))) continue;
        (has_parent[static_cast<size_t>(node)] ? below : roots).push_back(static_cast<size_t>(node));
    }
    roots.insert(roots.end(), below.begin(), below.end());
    return roots;
}

/* Depth first: parents before children, children in the file's order. */
static void visit_below(file &f, const std::vector<size_t> &roots, std::vector<visit> &order)
{
    std::vector<visit> open;
    for (size_t i = roots.size(); i-- > 0;) open.push_back({ roots[i], MODEL_NONE });
    while (!open.empty()) {
        visit v = open.back();
        open.pop_back();
        if (f.node_of[v.node] != MODEL_NONE) {
            leave_out(f, node_where(f, v.node),
                      v.parent == MODEL_NONE
                          ? " is listed in the scene, and there already"
                          : " is below itself, or listed in the scene before its parent: it was left where it "
                            "came first");
            continue;
        }
        uint32_t index = static_cast<uint32_t>(order.size());
        f.node_of[v.node] = index;
        order.push_back(v);
        const std::vector<int> &children = f.json.nodes[v.node].children;
        for (size_t i = children.size(); i-- > 0;) open.push_back({ static_cast<size_t>(children[i]), index });
    }
}

/* The roots above joints that the scene forgot, of skins whose meshes it draws. */
static std::vector<size_t> forgotten_roots(file &f)
{
    std::vector<size_t> parents(f.json.nodes.size(), SIZE_MAX), roots;
    for (size_t i = 0; i < f.json.nodes.size(); ++i)
        for (int child : f.json.nodes[i].children) parents[static_cast<size_t>(child)] = i;
    for (size_t i = 0; i < f.json.nodes.size(); ++i) {
        const size_t skin = static_cast<size_t>(f.json.nodes[i].skin);
        if (f.node_of[i] == MODEL_NONE || skin >= f.json.skins.size()) continue;
        for (int joint : f.json.skins[skin].joints) {
            size_t root = static_cast<size_t>(joint), steps = 0;
            if (root >= parents.size() || f.node_of[root] != MODEL_NONE) continue;
            while (parents[root] != SIZE_MAX && steps++ < parents.size()) root = parents[root];
            if (parents[root] == SIZE_MAX && std::find(roots.begin(), roots.end(), root) == roots.end())
                roots.push_back(root);
        }
    }
    return roots;
}

static std::vector<visit> visit_order(file &f)
{
    std::vector<visit> order;
    visit_below(f, root_nodes(f), order);
    const std::vector<size_t> forgotten = forgotten_roots(f);
    f.in_scene = order.size();
    for (size_t root : forgotten)
        leave_out(f, node_where(f, root),
                  " holds joints of a skin but is not in the default scene: its joints were read, its meshes were not");
    visit_below(f, forgotten, order);
    /* every node has at most one parent, so nodes that no root leads to form a cycle */
    if (f.json.scenes.empty() && order.size() != f.json.nodes.size())
        leave_out(f, "nodes",
                  text(": %zu nodes are their own ancestors and were left out", f.json.nodes.size() - order.size()));
    return order;
}

/* --- transforms --- */

struct transform {
    double translation[3], rotation[4], scale[3];
    double matrix[16];
};

static void read_numbers(file &f, const std::vector<double> &from, size_t count, const char *name,
                         const std::string &where, double *out)
{
    if (from.empty()) return;
    (void)attempt(f, "; it was ignored", [&] {
        if (from.size() != count) fail(where, text("'%s' has %zu numbers; it needs %zu", name, from.size(), count));
        for (double number : from) (void)to_float(number, where + " " + name);
        for (size_t i = 0; i < count; ++i) out[i] = static_cast<double>(static_cast<float>(from[i]));
    });
}

static void normalize_rotation(file &f, double *q, const std::string &where)
{
    double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 1e-6)) {
        leave_out(f, where, ": the rotation is a quaternion of length 0 and was ignored");
        q[0] = q[1] = q[2] = 0.0;
        q[3] = length = 1.0;
    }
    for (int i = 0; i < 4; ++i) q[i] /= length;
}

static void compose(transform &t)
{
    double r[9];
    quat_columns(t.rotation, r);
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) t.matrix[column * 4 + row] = r[column * 3 + row] * t.scale[column];
        t.matrix[column * 4 + 3] = 0.0;
        t.matrix[12 + column] = t.translation[column];
    }
    t.matrix[15] = 1.0;
}

/* The largest of w, x, y, z is found first, so that no division is by a small number. */
static void rotation_of_matrix(const double *m, double *q)
{
    double squares[4] = { 1.0 + m[0] - m[4] - m[8], 1.0 - m[0] + m[4] - m[8], 1.0 - m[0] - m[4] + m[8],
                          1.0 + m[0] + m[4] + m[8] }; /* 4 x^2, 4 y^2, 4 z^2, 4 w^2 */
    int largest = 3;
    for (int i = 0; i < 3; ++i)
        if (squares[i] > squares[largest]) largest = i;
    double twice = std::sqrt(squares[largest]), s = 0.5 / twice;
    double xy = (m[1] + m[3]) * s, xz = (m[2] + m[6]) * s, yz = (m[5] + m[7]) * s;
    double xw = (m[5] - m[7]) * s, yw = (m[6] - m[2]) * s, zw = (m[1] - m[3]) * s;
    const double rows[4][4] = { { 0.0, xy, xz, xw }, { xy, 0.0, yz, yw }, { xz, yz, 0.0, zw }, { xw, yw, zw, 0.0 } };
    for (int i = 0; i < 4; ++i) q[i] = i == largest ? 0.5 * twice : rows[largest][i];
}

static double column_length(const double *column)
{
    return std::sqrt(vec_dot(column, column));
}

/* The unit columns of a matrix without shear; a mirrored one gets a negative x scale. */
static void split_scale(transform &t, double *unit)
{
    double cross[3];
    for (int c = 0; c < 3; ++c) {
        t.scale[c] = column_length(t.matrix + c * 4);
        for (int r = 0; r < 3; ++r)
            unit[c * 3 + r] = t.scale[c] > 0.0 ? t.matrix[c * 4 + r] / t.scale[c] : (r == c ? 1.0 : 0.0);
    }
    vec_cross(unit, unit + 3, cross);
    if (vec_dot(cross, unit + 6) >= 0.0) return;
    t.scale[0] = -t.scale[0];
    for (int r = 0; r < 3; ++r) unit[r] = -unit[r];
}

static bool differs(const double *a, const double *b, double tolerance)
{
    double size = 0.0, difference = 0.0;
    for (int i = 0; i < 12; ++i) {
        size = std::fmax(size, i % 4 == 3 ? 0.0 : std::fabs(a[i]));
        difference = std::fmax(difference, i % 4 == 3 ? 0.0 : std::fabs(a[i] - b[i]));
    }
    return difference > tolerance * size;
}

static void decompose(file &f, transform &t, const std::string &where)
{
    double unit[9];
    for (int i = 0; i < 3; ++i) t.translation[i] = t.matrix[12 + i];
    split_scale(t, unit);
    rotation_of_matrix(unit, t.rotation);
    normalize_rotation(f, t.rotation, where);
    transform again = t;
    compose(again);
    if (differs(t.matrix, again.matrix, 1e-4))
        leave_out(f, where, ": the matrix is skewed; as translation, rotation and scale it is only approximate");
}

static void check_affine(file &f, double *m, const std::string &where)
{
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0)
        leave_out(f, where, ": the matrix is not affine; its last row was taken as 0 0 0 1");
    m[3] = m[7] = m[11] = 0.0;
    m[15] = 1.0;
}

static transform read_transform(file &f, const tinygltf::Node &node, const std::string &where)
{
    transform t = { { 0.0, 0.0, 0.0 }, { 0.0, 0.0, 0.0, 1.0 }, { 1.0, 1.0, 1.0 }, { 0.0 } };
    if (!node.matrix.empty()) {
        t.matrix[0] = t.matrix[5] = t.matrix[10] = t.matrix[15] = 1.0;
        read_numbers(f, node.matrix, 16, "matrix", where, t.matrix);
        check_affine(f, t.matrix, where);
        decompose(f, t, where);
        return t;
    }
    read_numbers(f, node.translation, 3, "translation", where, t.translation);
    read_numbers(f, node.rotation, 4, "rotation", where, t.rotation);
    read_numbers(f, node.scale, 3, "scale", where, t.scale);
    normalize_rotation(f, t.rotation, where);
    compose(t);
    return t;
}

/* Half a turn about y, of a root. */
static void turn_round(transform &t)
{
    const double q[4] = { t.rotation[0], t.rotation[1], t.rotation[2], t.rotation[3] };
    const double turned[4] = { q[2], q[3], -q[0], -q[1] }; /* (0 1 0 0) times q */
    for (int i = 0; i < 4; ++i) t.rotation[i] = turned[i];
    t.translation[0] = -t.translation[0];
    t.translation[2] = -t.translation[2];
    for (int column = 0; column < 4; ++column) {
        t.matrix[column * 4] = -t.matrix[column * 4];
        t.matrix[column * 4 + 2] = -t.matrix[column * 4 + 2];
    }
}

static void multiply(const double *a, const double *b, double *out)
{
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) {
            double sum = 0.0;
            for (int k = 0; k < 4; ++k) sum += a[k * 4 + row] * b[column * 4 + k];
            out[column * 4 + row] = sum;
        }
}

static void store_transform(file &f, const transform &t, model_node &out, const std::string &where)
{
    for (int i = 0; i < 4; ++i) out.rotation[i] = static_cast<float>(t.rotation[i]);
    for (int i = 0; i < 3; ++i) {
        out.translation[i] = static_cast<float>(t.translation[i]);
        out.scale[i] = to_float(t.scale[i], where + " scale");
    }
    if (out.parent == MODEL_NONE)
        memcpy(out.world, t.matrix, sizeof out.world);
    else
        multiply(f.out->nodes[out.parent].world, t.matrix, out.world);
    for (double number : out.world)
        if (!(std::fabs(number) <= NOH_NUMBER_MAX))
            fail(where,
                 "the world matrix is not finite, or larger than 1e12: the scales of its ancestors are too large");
}

/* --- a node's mesh, skin and weights --- */

static void read_mesh_of_node(file &f, const tinygltf::Node &node, model_node &out, const std::string &where)
{
    out.mesh = MODEL_NONE;
    if (node.mesh < 0) return;
    if (static_cast<size_t>(node.mesh) < f.mesh_of.size())
        out.mesh = f.mesh_of[static_cast<size_t>(node.mesh)];
    else
        leave_out(
            f, where,
            text(": its mesh was left out: mesh %d does not exist, the file has %zu", node.mesh, f.mesh_of.size()));
}

static void read_weights(file &f, const tinygltf::Node &node, model_node &out, const std::string &where)
{
    if (node.weights.empty()) return;
    if (out.mesh == MODEL_NONE) {
        leave_out(f, where, " has weights but no mesh; they were ignored");
        return;
    }
    const model_mesh &mesh = f.out->meshes[out.mesh];
    out.weights = allocate<float>(f, mesh.target_count, where);
    read_target_weights(f, node.weights, where, mesh.target_count, out.weights);
}

static void read_node(file &f, const visit &v, model_node &out)
{
    const tinygltf::Node &node = f.json.nodes[v.node];
    std::string where = node_where(f, v.node);
    out.name = copy_string(name_or(node.name, "node", v.node));
    out.parent = v.parent;
    out.skin = MODEL_NONE;
    read_mesh_of_node(f, node, out, where);
    if (f.node_of[v.node] >= f.in_scene) out.mesh = MODEL_NONE;
    read_weights(f, node, out, where);
    transform t = read_transform(f, node, where);
    if (out.parent == MODEL_NONE && faces_back(f)) turn_round(t);
    store_transform(f, t, out, where);
}

/* --- EXT_mesh_gpu_instancing: a node for each instance, below the node that has them --- */

struct instances {
    size_t node; /* in the file */
    uint64_t count;
    std::vector<float> translation, rotation, scale; /* empty: none of them given */
};

static std::vector<float> read_instance_numbers(file &f, const tinygltf::Value &attributes, const char *name,
                                                uint32_t width, const std::string &where, uint64_t &count)
{
    if (!attributes.IsObject() || !attributes.Has(name) || !attributes.Get(name).IsInt()) return {};
    const int accessor = attributes.Get(name).Get<int>();
    const uint64_t given = accessor_at(f, accessor, where).count;
    if (count && given != count) fail(where, "its attributes differ in their counts");
    count = given;
    charge(f, count, width * sizeof(float) + sizeof(model_node), where);
    std::vector<float> out(static_cast<size_t>(count) * width);
    vertex_list all;
    all.total = count;
    read_vertices(f, accessor, width, width == 4 ? c_f32 | c_i8n | c_i16n : c_f32, all, where + " " + name, out.data());
    return out;
}

/* Instances that cannot be read leave the node as it is. */
static bool read_instances(file &f, size_t node, instances &out)
{
    const auto extension = f.json.nodes[node].extensions.find("EXT_mesh_gpu_instancing");
    const uint32_t index = f.node_of[node];
    const std::string where = node_where(f, node) + " EXT_mesh_gpu_instancing";
    if (extension == f.json.nodes[node].extensions.end() || index == MODEL_NONE) return false;
    if (f.out->nodes[index].mesh == MODEL_NONE || f.json.nodes[node].skin >= 0) {
        leave_out(f, where, " was ignored: its node has no mesh, or a skin");
        return false;
    }
    return attempt(f, "; the node was drawn once", [&] {
        const tinygltf::Value &attributes = extension->second.Get("attributes");
        out.node = node;
        out.count = 0;
        out.translation = read_instance_numbers(f, attributes, "TRANSLATION", 3, where, out.count);
        out.rotation = read_instance_numbers(f, attributes, "ROTATION", 4, where, out.count);
        out.scale = read_instance_numbers(f, attributes, "SCALE", 3, where, out.count);
        if (!out.count) fail(where, "it has no instances");
    });
}

static void copy_numbers(const std::vector<float> &from, size_t instance, size_t width, double *out)
{
    for (size_t i = 0; i < width && !from.empty(); ++i) out[i] = static_cast<double>(from[instance * width + i]);
}

static void add_instance(file &f, const instances &all, size_t i)
{
    const uint32_t parent = f.node_of[all.node];
    const std::string where = node_where(f, all.node) + text(" instance %zu", i);
    model_node &out = f.out->nodes[f.out->node_count++];
    transform t = { { 0.0, 0.0, 0.0 }, { 0.0, 0.0, 0.0, 1.0 }, { 1.0, 1.0, 1.0 }, { 0.0 } };
    out.name = copy_string(f.out->nodes[parent].name + text("_%zu", i));
    out.parent = parent;
    out.skin = MODEL_NONE;
    out.mesh = f.mesh_of[static_cast<size_t>(f.json.nodes[all.node].mesh)];
    if (f.out->nodes[parent].weights) read_weights(f, f.json.nodes[all.node], out, where);
    copy_numbers(all.translation, i, 3, t.translation);
    copy_numbers(all.rotation, i, 4, t.rotation);
    copy_numbers(all.scale, i, 3, t.scale);
    normalize_rotation(f, t.rotation, where);
    compose(t);
    store_transform(f, t, out, where);
}

static void add_instances(file &f)
{
    std::vector<instances> found;
    uint64_t count = f.out->node_count;
    for (size_t n = 0; n < f.json.nodes.size(); ++n) {
        instances one;
        if (!read_instances(f, n, one)) continue;
        count += one.count;
        found.push_back(std::move(one));
    }
    if (found.empty()) return;
    model_node *nodes = allocate<model_node>(f, count, "instances");
    memcpy(nodes, f.out->nodes, f.out->node_count * sizeof *nodes);
    free(f.out->nodes);
    f.out->nodes = nodes;
    for (const instances &one : found) {
        for (size_t i = 0; i < one.count; ++i) add_instance(f, one, i);
        f.out->nodes[f.node_of[one.node]].mesh = MODEL_NONE;
    }
}

void read_nodes(file &f)
{
    f.node_of.assign(f.json.nodes.size(), MODEL_NONE);
    std::vector<visit> order = visit_order(f);
    f.out->nodes = allocate<model_node>(f, order.size(), "nodes");
    f.out->node_count = static_cast<uint32_t>(order.size());
    for (size_t i = 0; i < order.size(); ++i) read_node(f, order[i], f.out->nodes[i]);
    add_instances(f);
    hide_nodes(f);
}

} // namespace gltf
