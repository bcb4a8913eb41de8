/* gltf_curves.cpp: lines of a glTF file as curves (base/curves.h). */
#include "gltf_internal.h"

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "convert/base/curves.h"

namespace gltf
{

/* Curves as lists of points. */
using curve = std::vector<std::array<float, 3>>;

static void add_curve(std::vector<curve> &curves, curve &points, const std::string &where)
{
    if (points.size() > 1) {
        if (curves.size() == CURVES_MAX) fail(where, text("more than %u curves", CURVES_MAX));
        curves.push_back(points);
    }
    points.clear();
}

/* A point of a primitive in the scene. 0: it is not finite, and the curve ends before it. */
static bool place(const std::vector<float> &positions, size_t i, const double *world, std::array<float, 3> &out)
{
    for (size_t k = 0; k < 3; ++k) {
        double sum = world[12 + k];
        for (size_t c = 0; c < 3; ++c) sum += world[4 * c + k] * static_cast<double>(positions[3 * i + c]);
        out[k] = static_cast<float>(sum);
        if (!std::isfinite(out[k])) return false;
    }
    return true;
}

static void read_lines(file &f, const tinygltf::Primitive &p, const double *world, const std::string &where,
                       std::vector<curve> &curves)
{
    const auto found = p.attributes.find("POSITION");
    if (found == p.attributes.end()) fail(where, "it has no POSITION");
    const uint64_t count = accessor_at(f, found->second, where).count;
    charge(f, count, 3 * sizeof(float), where);
    std::vector<float> positions(static_cast<size_t>(count) * 3);
    read_floats(f, found->second, 3, c_f32, count, where, positions.data());
    std::vector<uint32_t> order;
    if (p.indices >= 0) order = read_indices(f, p.indices, where);
    const size_t length = p.indices >= 0 ? order.size() : static_cast<size_t>(count);
    const bool is_strip = p.mode == TINYGLTF_MODE_LINE_STRIP;
    curve points;
    size_t last = SIZE_MAX;
    for (size_t i = 0; i < length; ++i) {
        const size_t at = p.indices >= 0 ? order[i] : i;
        std::array<float, 3> point;
        const bool is_there = at < count && place(positions, at, world, point);
        const bool starts = !is_strip && i % 2 == 0;
        if (starts && at == last && !points.empty()) continue; /* the segment goes on where the last one ended */
        if (starts || !is_there) add_curve(curves, points, where);
        if (is_there) points.push_back(point);
        last = at;
    }
    add_curve(curves, points, where);
}

static void read_all(file &f, std::vector<curve> &curves)
{
    for (size_t n = 0; n < f.json.nodes.size(); ++n) {
        const int mesh = f.json.nodes[n].mesh;
        if (f.node_of[n] == MODEL_NONE || mesh < 0 || static_cast<size_t>(mesh) >= f.json.meshes.size()) continue;
        for (const tinygltf::Primitive &p : f.json.meshes[static_cast<size_t>(mesh)].primitives)
            if (p.mode == TINYGLTF_MODE_LINE || p.mode == TINYGLTF_MODE_LINE_STRIP)
                attempt(f, "; its lines were left out", [&] {
                    read_lines(f, p, f.out->nodes[f.node_of[n]].world,
                               "mesh '" +
                                   printable(name_or(f.json.meshes[static_cast<size_t>(mesh)].name, "mesh",
                                                     static_cast<size_t>(mesh))) +
                                   "'",
                               curves);
                });
    }
}

static void store(const std::vector<curve> &curves, curve_list &out)
{
    size_t total = 0;
    for (const curve &c : curves) total += c.size();
    out.points = static_cast<float *>(model_zeros(total, 3 * sizeof(float)));
    out.starts = static_cast<uint32_t *>(model_zeros(curves.size() + 1, sizeof(uint32_t)));
    if (!out.points || !out.starts) throw std::bad_alloc();
    for (const curve &c : curves) {
        memcpy(out.points + size_t{ out.starts[out.count] } * 3, c.data(), c.size() * 3 * sizeof(float));
        out.starts[out.count + 1] = out.starts[out.count] + static_cast<uint32_t>(c.size());
        ++out.count;
    }
}

void read_curves(file &f, const bytes &data, curve_list &out)
{
    std::vector<curve> curves;
    read_scene(f, data);
    read_all(f, curves);
    if (curves.empty()) {
        const std::string nothing = "the file has no curves: export them as lines";
        if (f.losses.empty()) fail("glTF JSON", nothing);
        fail(f.losses.back().first, nothing + "; " + clause_of(f.losses.back())); /* behind what is said of meshes */
    }
    store(curves, out);
}

} // namespace gltf

extern "C" void curves_free(curve_list *curves)
{
    free(curves->points);
    free(curves->starts);
    memset(curves, 0, sizeof *curves);
}
