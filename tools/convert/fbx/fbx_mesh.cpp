/* fbx_mesh.cpp: geometry as meshes. Corners that are alike in everything become one vertex; the triangles of each
 * material become a primitive. What moves a mesh under its node alone (Geometric...) is applied to its points. */
#include "fbx_internal.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace fbx
{

struct corner {
    uint32_t point;
    float normal[3], uv[2], color[4];
    float more[NOH_EXTRAS_MAX][2]; /* sets of texture coordinates that the build keeps */
};

struct corner_hash {
    size_t operator()(const corner &c) const
    {
        unsigned char bytes[sizeof c];
        uint64_t hash = 0xcbf29ce484222325ull; /* FNV-1a */
        memcpy(bytes, &c, sizeof c);
        for (unsigned char b : bytes) hash = (hash ^ b) * 0x100000001b3ull;
        return static_cast<size_t>(hash);
    }
};

struct corner_equal {
    bool operator()(const corner &a, const corner &b) const
    {
        return memcmp(&a, &b, sizeof a) == 0;
    }
};

/* The triangles of one material. */
struct part {
    size_t uvs = 0; /* the layer that its picture uses */
    std::vector<corner> vertices;
    std::vector<uint32_t> indices;
    std::unordered_map<corner, uint32_t, corner_hash, corner_equal> known;
};

struct mesh_job {
    job &j;
    size_t geometry, model; /* object; place in models */
    mat pivot;
    std::vector<float> points; /* by three, in the file's unit, moved by the pivot */
    shapes targets;
    skin bound;
    bool is_skinned = false;
    std::vector<uint32_t> joined; /* [points] the first point that is alike */
    element normals, colors, materials;
    uv_layers uvs;
    bool has_normals = false, has_colors = false, has_materials = false;
    std::map<int, part> parts; /* by place among the node's materials */

    mesh_job(job &of, size_t drawn, size_t by, const mat &moved) : j(of), geometry(drawn), model(by), pivot(moved) {}
};

/* --- corners --- */

static void fill_corner(const mesh_job &m, size_t uvs, size_t place, uint32_t point, size_t polygon, corner &out)
{
    memset(&out, 0, sizeof out);
    out.point = m.joined[point];
    const double *n = m.has_normals ? m.normals.at(place, point, polygon) : nullptr;
    const double *color = m.has_colors ? m.colors.at(place, point, polygon) : nullptr;
    if (n) { /* the cofactors keep it upright on the surface */
        vec turned;
        for (int k = 0; k < 3; ++k)
            turned = turned + cross(m.pivot.column[(k + 1) % 3], m.pivot.column[(k + 2) % 3]) * n[k];
        const double length = std::sqrt(dot(turned, turned));
        const double sign = determinant(m.pivot) < 0.0 ? -1.0 : 1.0;
        for (int k = 0; k < 3; ++k) out.normal[k] = static_cast<float>(length > 0.0 ? sign * turned[k] / length : 0.0);
    }
    m.uvs.fill(uvs, place, point, polygon, out.uv);
    for (size_t k = 0; k < m.uvs.kept.size(); ++k)
        m.uvs.fill(m.uvs.further(m.uvs.kept[k], uvs), place, point, polygon, out.more[k]);
    for (size_t k = 0; color && k < 4; ++k) out.color[k] = static_cast<float>(std::min(std::max(color[k], 0.0), 1.0));
    if (m.has_colors && !color) std::fill_n(out.color, 4, 1.0f);
}

static void add_triangle(part &p, const corner *corners, bool turn_over)
{
    for (size_t c = 0; c < 3; ++c) {
        const corner &at = corners[turn_over ? 2 - c : c];
        const auto kept = p.known.insert({ at, static_cast<uint32_t>(p.vertices.size()) });
        if (kept.second) p.vertices.push_back(at);
        p.indices.push_back(kept.first->second);
    }
}

/* The part of a polygon, begun with its material's layer of texture coordinates. */
static part &part_of(mesh_job &m, size_t first, uint32_t point, size_t polygon)
{
    const double *material = m.has_materials ? m.materials.at(first, point, polygon) : nullptr;
    const int64_t given = material ? whole_of(*material) : 0;
    const int place = static_cast<int>(std::min(std::max(given, int64_t{ 0 }), int64_t{ 65535 }));
    const auto known = m.parts.find(place);
    if (known != m.parts.end()) return known->second;
    part &p = m.parts[place];
    p.uvs = m.uvs.of_material(m.j, m.j.in.models[m.model], static_cast<size_t>(place));
    return p;
}

/* points: of one polygon; first: the place of its first corner */
static void add_polygon(mesh_job &m, const std::vector<uint32_t> &points, size_t first, size_t polygon)
{
    std::vector<float> places;
    std::vector<uint32_t> triangles;
    std::vector<corner> corners(points.size());
    if (points.size() < 3) {
        m.j.in.warn(place_of(m.j.in, m.geometry), " has points and lines, which were left out");
        return;
    }
    part &p = part_of(m, first, points[0], polygon);
    for (size_t c = 0; c < points.size(); ++c) {
        fill_corner(m, p.uvs, first + c, points[c], polygon, corners[c]);
        places.insert(places.end(), &m.points[size_t{ points[c] } * 3], &m.points[size_t{ points[c] } * 3] + 3);
    }
    triangles.resize((points.size() - 2) * 3);
    const int failed = obj_polygon_cut(places.data(), static_cast<uint32_t>(points.size()), triangles.data(),
                                       &m.j.steps);
    if (failed == 1) throw std::bad_alloc();
    if (failed)
        fail(place_of(m.j.in, m.geometry), "the concave polygons up to this one, which has " +
                                               std::to_string(points.size()) +
                                               " corners, take too long to cut into triangles: triangulate them");
    for (size_t t = 0; t < triangles.size(); t += 3) {
        const corner of[3] = { corners[triangles[t]], corners[triangles[t + 1]], corners[triangles[t + 2]] };
        add_triangle(p, of, determinant(m.pivot) < 0.0);
    }
}

/* A polygon ends with the complement of a point's place. */
static void add_polygons(mesh_job &m)
{
    const size_t point_count = m.points.size() / 3;
    std::vector<uint32_t> points;
    size_t polygon = 0, place = 0;
    bool damaged = false;
    for (double given : list_of(*m.j.in.objects[m.geometry].from, "PolygonVertexIndex").values) {
        const int64_t index = whole_of(given), point = index < 0 ? -(index + 1) : index;
        ++place;
        damaged = damaged || static_cast<uint64_t>(point) >= point_count;
        points.push_back(static_cast<uint32_t>(point));
        if (index >= 0) continue;
        if (damaged)
            m.j.in.warn(place_of(m.j.in, m.geometry),
                        " has polygons with points that are missing, which were left out: export it again");
        else
            add_polygon(m, points, place - points.size(), polygon);
        ++polygon;
        damaged = false;
        points.clear();
    }
    if (!points.empty())
        m.j.in.warn(place_of(m.j.in, m.geometry), " ends inside a polygon, which was left out: export it again");
}

template <class T> static void append(std::string &to, const T &value)
{
    to.append(reinterpret_cast<const char *>(&value), sizeof value);
}

/* Points that are alike in place, influences and every target are one. */
static void join_points(mesh_job &m)
{
    std::vector<std::string> looks(m.points.size() / 3);
    std::unordered_map<std::string, uint32_t> first;
    for (size_t p = 0; p < looks.size(); ++p) {
        for (size_t k = 0; k < 3; ++k) append(looks[p], m.points[p * 3 + k]);
        for (size_t i = 0; m.is_skinned && i < m.bound.points[p].size(); ++i) {
            append(looks[p], m.bound.points[p][i].joint);
            append(looks[p], m.bound.points[p][i].weight);
        }
    }
    for (size_t t = 0; t < m.targets.targets.size(); ++t)
        for (const auto &[point, delta] : m.targets.targets[t]) {
            append(looks[point], t);
            append(looks[point], delta);
        }
    for (size_t p = 0; p < looks.size(); ++p)
        m.joined.push_back(first.insert({ looks[p], static_cast<uint32_t>(p) }).first->second);
}

static void read_geometry(mesh_job &m)
{
    static const char *const normals[3] = { "LayerElementNormal", "Normals", "NormalsIndex" };
    static const char *const colors[3] = { "LayerElementColor", "Colors", "ColorIndex" };
    static const char *const materials[3] = { "LayerElementMaterial", "Materials", "" };
    const std::vector<double> points = finite_list(m.j, *m.j.in.objects[m.geometry].from, "Vertices");
    m.has_normals = read_element(m.j, m.geometry, normals, 3, m.normals);
    m.uvs = read_uvs(m.j, m.geometry);
    m.has_colors = read_element(m.j, m.geometry, colors, 4, m.colors);
    m.has_materials = read_element(m.j, m.geometry, materials, 1, m.materials);
    for (size_t i = 0; i + 2 < points.size(); i += 3) {
        const vec moved = m.pivot.point({ { points[i], points[i + 1], points[i + 2] } });
        for (int k = 0; k < 3; ++k) m.points.push_back(static_cast<float>(moved[k]));
    }
    m.targets = read_shapes(m.j, m.geometry, m.points.size() / 3);
    m.is_skinned = read_skin(m.j, m.geometry, m.model, m.points.size() / 3, m.bound);
    join_points(m);
    add_polygons(m);
}

/* --- primitives --- */

static std::vector<float> values_of(const part &p, size_t offset, size_t width)
{
    std::vector<float> out(p.vertices.size() * width);
    for (size_t v = 0; v < p.vertices.size(); ++v)
        memcpy(&out[v * width], reinterpret_cast<const char *>(&p.vertices[v]) + offset, width * sizeof(float));
    return out;
}

static void add_influences(job &j, const part &p, const skin &s, tinygltf::Primitive &out)
{
    size_t most = 1;
    for (const corner &c : p.vertices) most = std::max(most, s.points[c.point].size());
    for (size_t set = 0; set * 4 < most && set < 4; ++set) {
        std::vector<uint16_t> joints;
        std::vector<float> weights;
        for (const corner &c : p.vertices)
            for (size_t i = set * 4; i < set * 4 + 4; ++i) {
                const bool there = i < s.points[c.point].size();
                joints.push_back(there ? s.points[c.point][i].joint : 0);
                weights.push_back(there ? s.points[c.point][i].weight : 0.0f);
            }
        out.attributes["JOINTS_" + std::to_string(set)] = add_u16(j, joints, TINYGLTF_TYPE_VEC4);
        out.attributes["WEIGHTS_" + std::to_string(set)] = add_floats(j, weights, TINYGLTF_TYPE_VEC4);
    }
}

static void add_targets(const mesh_job &m, const part &p, tinygltf::Primitive &out)
{
    for (const target_deltas &target : m.targets.targets) {
        std::vector<uint32_t> places;
        std::vector<float> deltas;
        for (size_t v = 0; v < p.vertices.size(); ++v) {
            const uint32_t point = p.vertices[v].point;
            const auto found = std::lower_bound(target.begin(), target.end(), point,
                                                [](const auto &of, uint32_t at) { return of.first < at; });
            if (found == target.end() || found->first != point) continue;
            const vec moved = m.pivot.direction(found->second) * m.j.unit_m;
            places.push_back(static_cast<uint32_t>(v));
            for (int k = 0; k < 3; ++k) deltas.push_back(static_cast<float>(moved[k]));
        }
        out.targets.push_back({ { "POSITION", add_sparse(m.j, places, deltas, p.vertices.size()) } });
    }
}

static tinygltf::Primitive primitive_of(const mesh_job &m, const part &p)
{
    std::vector<float> positions;
    tinygltf::Primitive out;
    for (const corner &c : p.vertices)
        for (size_t k = 0; k < 3; ++k)
            positions.push_back(
                static_cast<float>(static_cast<double>(m.points[size_t{ c.point } * 3 + k]) * m.j.unit_m));
    out.mode = TINYGLTF_MODE_TRIANGLES;
    out.indices = add_u32(m.j, p.indices);
    out.attributes["POSITION"] = add_positions(m.j, positions);
    if (m.has_normals)
        out.attributes["NORMAL"] = add_floats(m.j, values_of(p, offsetof(corner, normal), 3), TINYGLTF_TYPE_VEC3);
    if (m.uvs.has(p.uvs))
        out.attributes["TEXCOORD_0"] = add_floats(m.j, values_of(p, offsetof(corner, uv), 2), TINYGLTF_TYPE_VEC2);
    for (size_t k = 0; k < m.uvs.kept.size(); ++k)
        out.attributes["TEXCOORD_" + std::to_string(m.uvs.kept[k])] = add_floats(
            m.j, values_of(p, offsetof(corner, more) + k * sizeof(float[2]), 2), TINYGLTF_TYPE_VEC2);
    if (m.has_colors)
        out.attributes["COLOR_0"] = add_floats(m.j, values_of(p, offsetof(corner, color), 4), TINYGLTF_TYPE_VEC4);
    if (m.is_skinned) add_influences(m.j, p, m.bound, out);
    add_targets(m, p, out);
    return out;
}

static int add_skin(job &j, const std::string &name, const skin &s)
{
    tinygltf::Skin out;
    out.name = name;
    out.joints = s.joints;
    out.inverseBindMatrices = add_floats(j, s.inverse_bind, TINYGLTF_TYPE_MAT4);
    j.out.skins.push_back(out);
    return static_cast<int>(j.out.skins.size() - 1);
}

/* --- a node's mesh --- */

static mat pivot_of(const scene &s, size_t model)
{
    return translation(s.vector(model, "GeometricTranslation", 0.0)) *
           rotation(euler(s.vector(model, "GeometricRotation", 0.0), 0)) *
           scaling(s.vector(model, "GeometricScaling", 1.0));
}

static tinygltf::Value names_of(const std::vector<std::string> &names)
{
    tinygltf::Value::Array values;
    for (const std::string &name : names) values.push_back(tinygltf::Value(name));
    return tinygltf::Value(tinygltf::Value::Object{ { "targetNames", tinygltf::Value(values) } });
}

static drawn_mesh write_mesh(job &j, size_t geometry, size_t model)
{
    const size_t object = j.in.models[model];
    const std::vector<size_t> materials = j.in.below(object, "Material", nullptr);
    mesh_job m{ j, geometry, model, pivot_of(j.in, object) };
    tinygltf::Mesh mesh;
    drawn_mesh out;
    read_geometry(m);
    for (const auto &of : m.parts) {
        if (of.second.indices.empty()) continue;
        const size_t place = static_cast<size_t>(of.first);
        mesh.primitives.push_back(primitive_of(m, of.second));
        mesh.primitives.back().material = place < materials.size() ? material_of(j, materials[place], object) : -1;
    }
    if (mesh.primitives.empty()) return out;
    mesh.name = j.in.objects[object].name;
    if (!m.targets.names.empty()) {
        std::vector<double> rest;
        for (const shape_channel &c : m.targets.channels) rest.push_back(c.rest);
        mesh.extras = names_of(m.targets.names);
        mesh.weights = weights_of(m.targets.channels, rest, m.targets.targets.size());
    }
    j.out.meshes.push_back(mesh);
    out.mesh = static_cast<int>(j.out.meshes.size() - 1);
    out.target_count = m.targets.targets.size();
    out.channels = m.targets.channels;
    if (m.is_skinned) out.skin = add_skin(j, mesh.name, m.bound);
    return out;
}

/* --- what is drawn --- */

/* Programs smooth such a mesh; what is drawn is its cage. */
static void warn_of_geometry(job &j, size_t geometry)
{
    const node &from = *j.in.objects[geometry].from;
    const node *smoothness = from.child("Smoothness"), *preview = from.child("PreviewDivisionLevels");
    if (smoothness && smoothness->whole(0) > 0 && (!preview || preview->whole(0) > 0))
        j.in.warn(place_of(j.in, geometry), " is a subdivision surface, and only its cage is drawn: apply the "
                                            "subdivision on export");
    if (!j.in.below(geometry, "Deformer", "VertexCacheDeformer").empty())
        j.in.warn(place_of(j.in, geometry), " is moved by a point cache, which was left out: export a skin or shapes");
}

static bool is_mesh(job &j, size_t object)
{
    const fbx::object &o = j.in.objects[object];
    if (o.kind != "Geometry" && o.kind != "Model") return false;
    if (o.kind == "Geometry" ? o.sub != "Mesh" && o.sub != "Shape" : o.sub.compare(0, 4, "Nurb") == 0)
        j.in.warn(place_of(j.in, object),
                  " is a surface or a curve, not a mesh, and was left out: convert it to polygons");
    return o.sub != "Shape" && o.from->child("Vertices") && o.from->child("PolygonVertexIndex");
}

/* A node's mesh: connected to it, or before version 7 in it. */
static size_t geometry_of(job &j, size_t object)
{
    size_t found = is_mesh(j, object) ? object : none;
    for (const link &l : j.in.objects[object].below) {
        if (j.in.objects[l.other].kind != "Geometry" || !is_mesh(j, l.other)) continue;
        if (found != none)
            j.in.warn(place_of(j.in, object), " has more than one mesh; only the first is drawn: give each a node");
        else
            found = l.other;
    }
    return found;
}

void write_meshes(job &j)
{
    using same = std::pair<std::vector<size_t>, std::vector<double>>; /* geometry and materials; pivot */
    std::map<same, size_t> known;
    for (size_t i = 0; i < j.in.models.size(); ++i) {
        const size_t object = j.in.models[i], geometry = geometry_of(j, object);
        if (geometry == none) continue;
        same key;
        key.first = j.in.below(object, "Material", nullptr);
        key.first.push_back(geometry);
        for (const vec &column : pivot_of(j.in, object).column)
            key.second.insert(key.second.end(), column.at, column.at + 3);
        const auto found = known.find(key);
        if (found == known.end()) {
            warn_of_geometry(j, geometry);
            known[key] = j.drawn.size();
            j.drawn.push_back({ i, write_mesh(j, geometry, i) });
        } else {
            const drawn_mesh again = j.drawn[found->second].second;
            j.drawn.push_back({ i, again });
        }
        const drawn_mesh &d = j.drawn.back().second;
        j.out.nodes[i].mesh = d.mesh;
        j.out.nodes[i].skin = d.skin;
    }
}

} // namespace fbx
