/* gltf_mesh.cpp: meshes, their primitives and their morph targets. */
#include "gltf_internal.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

namespace gltf
{

using attributes = std::map<std::string, int>;

/* A primitive that is kept, and its place in the mesh. */
struct part {
    const tinygltf::Primitive *source;
    size_t number;                 /* in the file, for messages */
    std::vector<uint32_t> indices; /* of triangles, within `vertices` */
    uint32_t first_vertex;
    vertex_list vertices;
    std::vector<float> position;
};

struct mesh_job {
    const tinygltf::Mesh *source;
    std::string where; /* "mesh 'head'" */
    std::vector<part> parts;
    model_mesh *out;
};

static int find(const attributes &map, const std::string &name)
{
    auto found = map.find(name);
    return found == map.end() ? -1 : found->second;
}

static bool has(const attributes &map, const std::string &name)
{
    return map.find(name) != map.end();
}

static std::string where_of(const mesh_job &job, const part &p)
{
    return job.where + text(" primitive %zu", p.number);
}

/* --- the component types that each attribute may have --- */

static uint32_t with_quantization(const file &f, uint32_t core, uint32_t quantized)
{
    return uses_extension(f, "KHR_mesh_quantization") ? core | quantized : core;
}

static const uint32_t signed_bits = c_i8 | c_i8n | c_i16 | c_i16n, unsigned_bits = c_u8 | c_u8n | c_u16 | c_u16n;

static uint32_t accepted_position(const file &f)
{
    return with_quantization(f, c_f32, signed_bits | unsigned_bits);
}

static uint32_t accepted_normal(const file &f) /* and tangents, and their deltas */
{
    return with_quantization(f, c_f32, c_i8n | c_i16n);
}

static uint32_t accepted_uv(const file &f)
{
    return with_quantization(f, c_f32 | c_u8n | c_u16n, signed_bits | unsigned_bits);
}

static uint32_t accepted_position_delta(const file &f)
{
    return with_quantization(f, c_f32, signed_bits);
}

static uint32_t accepted_uv_delta(const file &f)
{
    return with_quantization(f, c_f32 | c_i8n | c_u8n | c_i16n | c_u16n, signed_bits | unsigned_bits);
}

/* --- triangles --- */

static std::vector<uint32_t> listed_vertices(file &f, const mesh_job &job, const part &p)
{
    if (p.source->indices >= 0) return read_indices(f, p.source->indices, where_of(job, p) + " indices");
    charge(f, p.vertices.total, sizeof(uint32_t), where_of(job, p));
    std::vector<uint32_t> list(p.vertices.total);
    for (size_t i = 0; i < list.size(); ++i) list[i] = static_cast<uint32_t>(i);
    return list;
}

static void push_triangle(std::vector<uint32_t> &out, uint32_t a, uint32_t b, uint32_t c)
{
    out.push_back(a);
    out.push_back(b);
    out.push_back(c);
}

/* Strips and fans as triangles, wound as the specification says (3.7.2.1). */
static std::vector<uint32_t> unroll(file &f, const std::vector<uint32_t> &list, int mode, const std::string &where)
{
    std::vector<uint32_t> out;
    size_t count = list.size() < 3 ? 0 : list.size() - 2, first = 0;
    charge(f, count, 3 * sizeof(uint32_t), where);
    out.reserve(count * 3);
    for (size_t end = 0; end <= list.size(); ++end) {
        if (end < list.size() && list[end] != MODEL_NONE) continue;
        if (end < list.size())
            leave_out(f, where, ": an index ends a strip, which glTF does not allow; it was cut there");
        for (size_t i = 0; first + i + 2 < end; ++i) {
            const uint32_t *at = &list[first + i];
            if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
                push_triangle(out, at[1], at[2], list[first]);
            else
                push_triangle(out, at[0], at[1 + i % 2], at[2 - i % 2]);
        }
        first = end + 1;
    }
    return out;
}

static void drop_bad_triangles(file &f, const std::string &where, uint64_t vertex_count, std::vector<uint32_t> &list)
{
    size_t kept = 0;
    for (size_t i = 0; i + 2 < list.size(); i += 3) {
        const uint32_t a = list[i], b = list[i + 1], c = list[i + 2];
        if (std::max({ a, b, c }) >= vertex_count) {
            leave_out(f, where + text(" triangle %zu", i / 3), " was left out: the primitive has no such vertex");
            continue;
        }
        list[kept++] = a;
        list[kept++] = b;
        list[kept++] = c;
    }
    list.resize(kept);
}

static void read_triangles(file &f, const mesh_job &job, part &p)
{
    std::vector<uint32_t> list = listed_vertices(f, job, p);
    if (p.source->mode != TINYGLTF_MODE_TRIANGLES)
        list = unroll(f, list, p.source->mode, where_of(job, p));
    else if (list.size() % 3 != 0) {
        leave_out(f, where_of(job, p), ": its last corners are no whole triangle and were left out");
    }
    drop_bad_triangles(f, where_of(job, p), p.vertices.total, list);
    p.indices.swap(list);
}

/* Many exporters give all primitives of a mesh one set of accessors: each keeps the vertices that its triangles use, in
 * the order in which they use them, as if it had accessors of its own. */
static void keep_used_vertices(part &p)
{
    std::vector<uint32_t> sorted(p.indices);
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    if (sorted.size() == p.vertices.total) return;
    std::vector<uint32_t> place(sorted.size(), MODEL_NONE);
    p.vertices.used.reserve(sorted.size());
    for (uint32_t &i : p.indices) {
        uint32_t &at = place[static_cast<size_t>(std::lower_bound(sorted.begin(), sorted.end(), i) - sorted.begin())];
        if (at == MODEL_NONE) {
            at = static_cast<uint32_t>(p.vertices.used.size());
            p.vertices.used.push_back(i);
        }
        i = at;
    }
    p.vertices.sorted.swap(sorted);
    p.vertices.place.swap(place);
}

/* --- which primitives are kept --- */

static const char *reason_to_skip(const tinygltf::Primitive &p)
{
    if (p.mode < TINYGLTF_MODE_POINTS || p.mode > TINYGLTF_MODE_TRIANGLE_FAN) return "its mode is unknown";
    if (p.mode >= TINYGLTF_MODE_POINTS && p.mode <= TINYGLTF_MODE_LINE_STRIP)
        return "it holds points or lines, not triangles";
    return has(p.attributes, "POSITION") ? nullptr : "it has no POSITION";
}

static void check_vertex_total(const mesh_job &job, uint64_t vertices, uint64_t indices)
{
    if (vertices >= MODEL_NONE || indices >= MODEL_NONE)
        fail(job.where, "the mesh has more than 4294967294 vertices or indices");
}

static void find_parts(file &f, mesh_job &job)
{
    uint64_t vertices = 0, indices = 0;
    for (size_t i = 0; i < job.source->primitives.size(); ++i) {
        const tinygltf::Primitive &source = job.source->primitives[i];
        part p = { &source, i, {}, static_cast<uint32_t>(vertices), {}, {} };
        std::string where = where_of(job, p);
        if (const char *reason = reason_to_skip(source)) {
            leave_out(f, where, std::string(" was skipped: ") + reason);
            continue;
        }
        int position = find(source.attributes, "POSITION");
        p.vertices.total = accessor_at(f, position, where + " POSITION").count;
        if (p.vertices.total == 0) {
            leave_out(f, where, " was skipped: it has no vertices");
            continue;
        }
        check_vertex_total(job, p.vertices.total, indices);
        if (!attempt(f, "; the primitive was left out", [&] { read_triangles(f, job, p); })) continue;
        if (p.indices.empty()) {
            leave_out(f, where, " was skipped: it has no triangle");
            continue;
        }
        keep_used_vertices(p);
        charge(f, p.vertices.count(), 12 * sizeof(float), where); /* about what its vertices will need */
        if (!attempt(f, "; the primitive was left out", [&] {
                p.position.resize(p.vertices.count() * 3);
                read_vertices(f, position, 3, accepted_position(f), p.vertices, where + " POSITION", p.position.data());
            }))
            continue;
        check_vertex_total(job, vertices + p.vertices.count(), indices + p.indices.size());
        vertices += p.vertices.count();
        indices += p.indices.size();
        job.parts.push_back(std::move(p));
    }
}

/* glTF wants the same targets in all primitives of a mesh. One with fewer of them stays where it is in the others. */
static uint32_t count_targets(file &f, const mesh_job &job)
{
    const auto fewer = [](const part &a, const part &b) { return a.source->targets.size() < b.source->targets.size(); };
    const part &most = *std::max_element(job.parts.begin(), job.parts.end(), fewer);
    const size_t count = most.source->targets.size();
    for (const part &p : job.parts)
        if (p.source->targets.size() != count)
            leave_out(f, where_of(job, p),
                      text(" has %zu morph targets and primitive %zu has %zu: the others do not move it",
                           p.source->targets.size(), most.number, count));
    if (count >= MODEL_NONE) fail(job.where, text("%zu morph targets are not possible", count));
    return static_cast<uint32_t>(count);
}

/* --- base attributes --- */

static const tinygltf::Material *material_of(const file &f, const tinygltf::Primitive &p)
{
    return static_cast<size_t>(p.material) < f.json.materials.size()
               ? &f.json.materials[static_cast<size_t>(p.material)]
               : nullptr;
}

static uv_use uv_use_of(const file &f, const tinygltf::Primitive &p)
{
    const tinygltf::Material *material = material_of(f, p);
    return material ? gltf::uv_use_of(*material) : uv_use();
}

std::string uv_name(const file &f, const tinygltf::Primitive &p)
{
    std::string wanted = text("TEXCOORD_%d", uv_use_of(f, p).set);
    return has(p.attributes, wanted) ? wanted : "TEXCOORD_0";
}

/* The transform is applied to the UVs: a model has no place for it. They are scaled, then rotated, then moved by
 * `moved` of its offset: differences are not. */
static void transform_uvs(const file &f, const mesh_job &job, const part &p, double moved, float *uv)
{
    const uv_use use = uv_use_of(f, *p.source);
    const double sine = std::sin(use.rotation), cosine = std::cos(use.rotation);
    const std::string where = where_of(job, p) + " KHR_texture_transform";
    if (use.offset[0] == 0.0 && use.offset[1] == 0.0 && use.scale[0] == 1.0 && use.scale[1] == 1.0 &&
        use.rotation == 0.0)
        return;
    for (size_t i = 0; i < p.vertices.count(); ++i) {
        const double u = static_cast<double>(uv[i * 2]) * use.scale[0];
        const double v = static_cast<double>(uv[i * 2 + 1]) * use.scale[1];
        uv[i * 2] = to_float(cosine * u + sine * v + moved * use.offset[0], where);
        uv[i * 2 + 1] = to_float(cosine * v - sine * u + moved * use.offset[1], where);
    }
}

static bool any_part_has(const mesh_job &job, const char *name)
{
    for (const part &p : job.parts)
        if (has(p.source->attributes, name)) return true;
    return false;
}

static bool any_part_has_uvs(const file &f, const mesh_job &job)
{
    for (const part &p : job.parts)
        if (has(p.source->attributes, uv_name(f, *p.source))) return true;
    return false;
}

static void allocate_base(file &f, mesh_job &job)
{
    model_mesh &m = *job.out;
    bool uvs = any_part_has_uvs(f, job);
    m.position = allocate<float>(f, uint64_t{ m.vertex_count } * 3, job.where);
    m.normal = allocate<float>(f, uint64_t{ m.vertex_count } * 3, job.where);
    if (uvs || any_part_has(job, "TANGENT")) m.tangent = allocate<float>(f, uint64_t{ m.vertex_count } * 4, job.where);
    if (uvs) m.uv = allocate<float>(f, uint64_t{ m.vertex_count } * 2, job.where);
    if (any_part_has(job, "COLOR_0")) m.color = allocate<float>(f, uint64_t{ m.vertex_count } * 4, job.where);
    for (uint32_t k = 0; k < f.out->extras.count; ++k)
        if (!m.extra && any_part_has(job, f.out->extras.names[k]))
            m.extra = allocate<float>(f, uint64_t{ m.vertex_count } * NOH_EXTRAS_MAX * 4, job.where);
    m.indices = allocate<uint32_t>(f, m.index_count, job.where);
    m.submeshes = allocate<model_submesh>(f, m.submesh_count, job.where);
}

/* --- extra attributes, for shaders of a game's own --- */

/* How a file's integers are read. */
static model_extra kind_of(const tinygltf::Accessor &a, uint32_t width)
{
    const bool n = a.normalized;
    const uint8_t w = static_cast<uint8_t>(width);
    switch (a.componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return { w, 8, 0.0f, n ? 1.0f / 255.0f : 1.0f };
    case TINYGLTF_COMPONENT_TYPE_BYTE: return { w, 8, n ? -1.0f : -128.0f, n ? 1.0f / 127.0f : 1.0f };
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return { w, 16, 0.0f, n ? 1.0f / 65535.0f : 1.0f };
    case TINYGLTF_COMPONENT_TYPE_SHORT: return { w, 16, n ? -1.0f : -32768.0f, n ? 1.0f / 32767.0f : 1.0f };
    default: return { w, 0, 0.0f, 0.0f };
    }
}

static void read_extra(file &f, const mesh_job &job, const part &p, uint32_t k, model_mesh &m)
{
    const std::string name = f.out->extras.names[k], where = where_of(job, p) + " " + printable(name);
    const int index = find(p.source->attributes, name);
    const tinygltf::Accessor &a = accessor_at(f, index, where);
    const uint32_t width = a.type == TINYGLTF_TYPE_SCALAR ? 1u : static_cast<uint32_t>(a.type);
    if (width < 1 || width > 4) fail(where, "it is neither a scalar nor a vector");
    const model_extra kind = kind_of(a, width);
    model_extra &all = m.extras[k];
    std::vector<float> values(p.vertices.count() * width);
    read_vertices(f, index, width, signed_bits | unsigned_bits | c_f32, p.vertices, where, values.data());
    for (size_t v = 0; v < p.vertices.count(); ++v)
        memcpy(m.extra + 4 * ((p.first_vertex + v) * NOH_EXTRAS_MAX + k), &values[v * width], width * sizeof(float));
    const bool same = kind.bits == all.bits && kind.least == all.least && kind.step == all.step;
    const uint8_t widest = std::max(kind.width, all.width);
    all = !all.width || same ? kind : model_extra{ 0, 0, 0.0f, 0.0f };
    all.width = widest;
}

static void read_extras(file &f, mesh_job &job, const part &p)
{
    model_mesh &m = *job.out;
    for (uint32_t k = 0; m.extra && k < f.out->extras.count; ++k) {
        const char *name = f.out->extras.names[k];
        if (has(p.source->attributes, name))
            (void)attempt(f, "; its values are 0", [&] { read_extra(f, job, p, k, m); });
        else if (any_part_has(job, name))
            leave_out(f, where_of(job, p), std::string(": it has no ") + printable(name) + ", as others do; it is 0");
    }
}

static void read_color(file &f, const mesh_job &job, const part &p, float *out)
{
    int index = find(p.source->attributes, "COLOR_0");
    std::string where = where_of(job, p) + " COLOR_0";
    const uint32_t accepted = c_f32 | c_u8n | c_u16n;
    for (size_t i = 0; i < p.vertices.count() * 4; ++i) out[i] = 1.0f;
    if (index < 0) return;
    if (accessor_at(f, index, where).type == TINYGLTF_TYPE_VEC4) {
        read_vertices(f, index, 4, accepted, p.vertices, where, out);
        return;
    }
    std::vector<float> rgb(p.vertices.count() * 3);
    read_vertices(f, index, 3, accepted, p.vertices, where, rgb.data());
    for (size_t v = 0; v < p.vertices.count(); ++v) memcpy(out + v * 4, &rgb[v * 3], 3 * sizeof(float));
}

static void read_tangent(file &f, const mesh_job &job, const part &p, float *out)
{
    read_vertices(f, find(p.source->attributes, "TANGENT"), 4, accepted_normal(f), p.vertices,
                  where_of(job, p) + " TANGENT", out);
    bool others = false;
    for (size_t v = 0; v < p.vertices.count(); ++v) {
        float sign = out[v * 4 + 3] < 0.0f ? -1.0f : 1.0f;
        others = others || out[v * 4 + 3] != sign;
        out[v * 4 + 3] = sign;
    }
    if (others)
        leave_out(f, where_of(job, p), ": its tangents have signs that are neither 1 nor -1; they were rounded");
}

static void read_base(file &f, mesh_job &job, const part &p, model_submesh &submesh)
{
    model_mesh &m = *job.out;
    const attributes &a = p.source->attributes;
    const std::string where = where_of(job, p);
    const size_t first = p.first_vertex;
    memcpy(m.position + first * 3, p.position.data(), p.position.size() * sizeof(float));
    if (!has(a, "NORMAL") || !attempt(f, "; normals were computed", [&] {
            read_vertices(f, find(a, "NORMAL"), 3, accepted_normal(f), p.vertices, where + " NORMAL",
                          m.normal + first * 3);
        }))
        submesh.missing |= MODEL_MISSING_NORMAL;
    if (m.tangent && (!has(a, "TANGENT") ||
                      !attempt(f, "; tangents were computed", [&] { read_tangent(f, job, p, m.tangent + first * 4); })))
        submesh.missing |= MODEL_MISSING_TANGENT;
    std::string uv = uv_name(f, *p.source);
    if (has(a, uv)) {
        if (uv != text("TEXCOORD_%d", uv_use_of(f, *p.source).set))
            leave_out(f, where, ": it lacks the UV set that its texture uses; TEXCOORD_0 was used");
        (void)attempt(f, "; texture coordinates are 0", [&] {
            read_vertices(f, find(a, uv), 2, accepted_uv(f), p.vertices, where + " " + uv, m.uv + first * 2);
            transform_uvs(f, job, p, 1.0, m.uv + first * 2);
        });
    }
    read_extras(f, job, p);
    if (m.color) (void)attempt(f, "; colours are white", [&] { read_color(f, job, p, m.color + first * 4); });
}

static void read_submesh(file &f, mesh_job &job, const part &p, uint32_t first_index, model_submesh &out)
{
    out.first_index = first_index;
    out.index_count = static_cast<uint32_t>(p.indices.size());
    out.first_vertex = p.first_vertex;
    out.vertex_count = static_cast<uint32_t>(p.vertices.count());
    out.material = material_of(f, *p.source) ? static_cast<uint32_t>(p.source->material) : MODEL_NONE;
    if (p.source->material >= 0 && out.material == MODEL_NONE)
        leave_out(f, where_of(job, p), ": its material does not exist; glTF's default was used");
    for (size_t i = 0; i < p.indices.size(); ++i) job.out->indices[first_index + i] = p.indices[i] + p.first_vertex;
}

/* --- targets --- */

/* Deltas are used only if the base has the attribute: else they belong to a surface that the file does not have. */
static bool gives(const part &p, size_t target, const char *name)
{
    return target < p.source->targets.size() && has(p.source->targets[target], name) && has(p.source->attributes, name);
}

static bool any_part_gives(const mesh_job &job, size_t target, const char *name)
{
    for (const part &p : job.parts)
        if (gives(p, target, name)) return true;
    return false;
}

static bool any_part_gives_uvs(const file &f, const mesh_job &job, size_t target)
{
    for (const part &p : job.parts)
        if (gives(p, target, uv_name(f, *p.source).c_str())) return true;
    return false;
}

static void allocate_target(file &f, mesh_job &job, size_t t)
{
    const model_mesh &m = *job.out;
    model_target &target = job.out->targets[t];
    uint64_t floats = uint64_t{ m.vertex_count } * 3;
    target.has_position = any_part_gives(job, t, "POSITION");
    target.has_normal = any_part_gives(job, t, "NORMAL");
    target.has_tangent = any_part_gives(job, t, "TANGENT");
    target.position = allocate<float>(f, floats, job.where);
    target.normal = allocate<float>(f, floats, job.where);
    if (m.tangent) target.tangent = allocate<float>(f, floats, job.where);
    if (any_part_gives_uvs(f, job, t)) target.uv = allocate<float>(f, uint64_t{ m.vertex_count } * 2, job.where);
    target.missing = allocate<uint8_t>(f, m.submesh_count, job.where);
}

/* A target of another mesh is a mistake that its author has to mend. */
static void check_vertex_count(const file &f, int accessor, const part &p, const std::string &where)
{
    if (static_cast<size_t>(accessor) >= f.json.accessors.size()) return;
    const size_t count = f.json.accessors[static_cast<size_t>(accessor)].count;
    if (count != p.vertices.total)
        fail(where + text(" (accessor %d)", accessor), text("the accessor has %zu elements, but %zu are needed here",
                                                            count, static_cast<size_t>(p.vertices.total)));
}

/* false: they cannot be read, and are zeros. */
static bool read_delta(file &f, const part &p, size_t t, const std::string &name, size_t width, uint32_t accepted,
                       const std::string &where, float *deltas)
{
    const int index = find(p.source->targets[t], name);
    float *out = deltas + size_t{ p.first_vertex } * width;
    check_vertex_count(f, index, p, where + " " + name);
    if (!attempt(f, "; the deltas were left out",
                 [&] { read_vertices(f, index, width, accepted, p.vertices, where + " " + name, out); })) {
        memset(out, 0, p.vertices.count() * width * sizeof *out);
        return false;
    }
    for (size_t i = 0; i < p.vertices.count() * width; ++i)
        out[i] += 0.0f; /* -0 becomes 0, so that dense and sparse files give the same model */
    return true;
}

/* For the UV set that the primitive's texture uses. */
static void read_uv_delta(file &f, const mesh_job &job, const part &p, size_t t, const std::string &where,
                          float *deltas)
{
    const std::string name = uv_name(f, *p.source);
    if (!gives(p, t, name.c_str())) return;
    if (read_delta(f, p, t, name, 2, accepted_uv_delta(f), where, deltas))
        transform_uvs(f, job, p, 0.0, deltas + size_t{ p.first_vertex } * 2);
}

static void warn_unused_deltas(file &f, const part &p, size_t t, const std::string &where)
{
    if (t >= p.source->targets.size()) return;
    for (const auto &delta : p.source->targets[t]) {
        bool known = delta.first == "POSITION" || delta.first == "NORMAL" || delta.first == "TANGENT" ||
                     delta.first == uv_name(f, *p.source);
        if (known && gives(p, t, delta.first.c_str())) continue;
        const char *why = known ? " because the primitive has no such attribute"
                          : delta.first.compare(0, 6, "COLOR_") == 0
                              ? ": noh build --color-map makes colours that fade in"
                              : " which cannot be morphed";
        leave_out(f, where, ": the deltas of " + printable(delta.first) + " were ignored" + why);
    }
}

static void read_target_part(file &f, mesh_job &job, const part &p, size_t part_index, size_t t)
{
    model_target &target = job.out->targets[t];
    std::string where = where_of(job, p) + text(" target %zu", t);
    warn_unused_deltas(f, p, t, where);
    if (gives(p, t, "POSITION"))
        (void)read_delta(f, p, t, "POSITION", 3, accepted_position_delta(f), where, target.position);
    if (!gives(p, t, "NORMAL") || !read_delta(f, p, t, "NORMAL", 3, accepted_normal(f), where, target.normal))
        target.missing[part_index] |= MODEL_MISSING_NORMAL;
    if (target.tangent &&
        (!gives(p, t, "TANGENT") || !read_delta(f, p, t, "TANGENT", 3, accepted_normal(f), where, target.tangent)))
        target.missing[part_index] |= MODEL_MISSING_TANGENT;
    if (target.uv) read_uv_delta(f, job, p, t, where, target.uv);
}

static const tinygltf::Value *names_in(const tinygltf::Value &extras)
{
    if (!extras.IsObject() || !extras.Get("targetNames").IsArray()) return nullptr;
    return &extras.Get("targetNames");
}

/* By convention mesh.extras.targetNames; some exporters put it on the primitives. */
static const tinygltf::Value *target_names(const mesh_job &job)
{
    const tinygltf::Value *names = names_in(job.source->extras);
    for (const part &p : job.parts)
        if (!names) names = names_in(p.source->extras);
    return names;
}

/* A face's recipe: a text, or an array of lines. */
static void read_recipe(file &f, mesh_job &job)
{
    if (!job.source->extras.IsObject() || !job.source->extras.Has("recipe")) return;
    const tinygltf::Value &given = job.source->extras.Get("recipe");
    std::string lines;
    if (given.IsString()) lines = given.Get<std::string>();
    for (size_t i = 0; given.IsArray() && i < given.ArrayLen(); ++i) {
        const tinygltf::Value &line = given.Get(static_cast<int>(i));
        if (line.IsString()) lines += line.Get<std::string>() + "\n";
    }
    if (lines.empty())
        leave_out(f, job.where + ": the recipe in its extras",
                  " was skipped: it is neither a text nor an array of lines");
    else
        job.out->recipe = copy_string(lines);
}

static std::string given_name(const tinygltf::Value *names, size_t t)
{
    if (!names || t >= names->ArrayLen() || !names->Get(static_cast<int>(t)).IsString()) return "";
    std::string name = names->Get(static_cast<int>(t)).Get<std::string>();
    return name.c_str(); /* up to a NUL: names are C strings from here on */
}

static std::string unique_name(const std::set<std::string> &taken, const std::string &name)
{
    std::string candidate = name;
    for (size_t n = 2; taken.count(candidate); ++n) candidate = name + "_" + std::to_string(n);
    return candidate;
}

static void name_targets(file &f, mesh_job &job)
{
    read_recipe(f, job);
    const tinygltf::Value *names = target_names(job);
    std::set<std::string> taken;
    if (names && names->ArrayLen() != job.out->target_count)
        warn(f, "%s has %zu target names for %u targets", job.where.c_str(), names->ArrayLen(), job.out->target_count);
    for (uint32_t t = 0; t < job.out->target_count; ++t) {
        std::string wanted = name_or(given_name(names, t), "target", t), name = unique_name(taken, wanted);
        if (name != wanted)
            leave_out(f, job.where + ": two targets are named '" + printable(wanted) + "'",
                      "; a number was added to the second name");
        taken.insert(name);
        job.out->targets[t].name = copy_string(name);
    }
}

void read_target_weights(file &f, const std::vector<double> &given, const std::string &where, uint32_t target_count,
                         float *out)
{
    if (!given.empty() && given.size() != target_count)
        leave_out(f, where, " has another number of weights than of morph targets; those without one are 0");
    for (size_t i = 0; i < given.size() && i < target_count; ++i) out[i] = to_float(given[i], where + " weights");
}

static void read_default_weights(file &f, mesh_job &job)
{
    job.out->weights = allocate<float>(f, job.out->target_count, job.where);
    read_target_weights(f, job.source->weights, job.where, job.out->target_count, job.out->weights);
}

static void read_targets(file &f, mesh_job &job)
{
    const uint32_t count = count_targets(f, job);
    job.out->targets = allocate<model_target>(f, count, job.where);
    job.out->target_count = count;
    for (size_t t = 0; t < count; ++t) {
        allocate_target(f, job, t);
        for (size_t i = 0; i < job.parts.size(); ++i) read_target_part(f, job, job.parts[i], i, t);
    }
    name_targets(f, job);
    read_default_weights(f, job);
}

/* --- a mesh --- */

static void count_mesh(mesh_job &job)
{
    model_mesh &m = *job.out;
    for (const part &p : job.parts) {
        m.vertex_count += static_cast<uint32_t>(p.vertices.count());
        m.index_count += static_cast<uint32_t>(p.indices.size());
        ++m.submesh_count;
    }
}

static void read_skinning(file &f, mesh_job &job)
{
    bool any = false;
    for (const part &p : job.parts) any = any || has_influences(*p.source);
    if (!any) return;
    allocate_influences(f, job.where, *job.out);
    influence_changes changes;
    for (size_t i = 0; i < job.parts.size(); ++i)
        if (!attempt(f, "; the primitive was bound to the first joint", [&] {
                read_influences(f, *job.parts[i].source, job.parts[i].vertices, job.out->submeshes[i],
                                where_of(job, job.parts[i]), *job.out, changes);
            }))
            bind_to_first_joint(job.out->submeshes[i], *job.out);
    warn_influence_changes(f, changes, job.where);
}

static void fill_mesh(file &f, mesh_job &job)
{
    uint32_t first_index = 0;
    count_mesh(job);
    allocate_base(f, job);
    for (size_t i = 0; i < job.parts.size(); ++i) {
        model_submesh &submesh = job.out->submeshes[i];
        read_submesh(f, job, job.parts[i], first_index, submesh);
        read_base(f, job, job.parts[i], submesh);
        first_index += submesh.index_count;
    }
    read_targets(f, job);
    read_skinning(f, job);
}

/* Returns false when the mesh has no triangles at all. */
static bool read_mesh(file &f, size_t index, model_mesh *out)
{
    mesh_job job;
    std::string name = name_or(f.json.meshes[index].name, "mesh", index);
    job.source = &f.json.meshes[index];
    job.where = "mesh '" + printable(name) + "'";
    job.out = out;
    find_parts(f, job);
    if (job.parts.empty()) {
        leave_out(f, job.where, " was skipped: it has no triangles");
        return false;
    }
    out->name = copy_string(name);
    fill_mesh(f, job);
    return true;
}

void read_meshes(file &f)
{
    f.mesh_of.assign(f.json.meshes.size(), MODEL_NONE);
    f.out->meshes = allocate<model_mesh>(f, f.json.meshes.size(), "meshes");
    for (size_t i = 0; i < f.json.meshes.size(); ++i) {
        uint32_t slot = f.out->mesh_count++; /* counted first, so that a half-read mesh is freed with the model */
        if (read_mesh(f, i, &f.out->meshes[slot]))
            f.mesh_of[i] = slot;
        else
            --f.out->mesh_count;
    }
}

} // namespace gltf
