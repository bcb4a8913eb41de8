/* fbx_shape.cpp: blend shapes. A channel drives one shape, or runs through in-betweens to its shape. Each becomes a
 * target; the channel's value gives the weights. */
#include "fbx_internal.h"

#include <algorithm>
#include <cmath>

namespace fbx
{

static const double percent_max = 1e6;

/* --- the points of a shape --- */

/* mask: percent by entry, or empty */
static target_deltas read_deltas(job &j, const std::string &where, const node &shape, const std::vector<double> &mask,
                                 size_t point_count)
{
    const std::vector<double> places = list_of(shape, "Indexes").values, moves = finite_list(j, shape, "Vertices");
    target_deltas out;
    for (size_t i = 0; i < places.size() && i * 3 + 2 < moves.size(); ++i) {
        const double share = i < mask.size() ? mask[i] / 100.0 : 1.0;
        const int64_t point = whole_of(places[i], -1);
        if (static_cast<uint64_t>(point) >= point_count) {
            j.in.warn(where, " moves points that its mesh does not have, which were left out: export it again");
            continue;
        }
        out.push_back(
            { static_cast<uint32_t>(point), vec{ { moves[i * 3], moves[i * 3 + 1], moves[i * 3 + 2] } } * share });
    }
    std::stable_sort(out.begin(), out.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
    size_t kept = 0;
    for (size_t i = 0; i < out.size(); ++i) /* a point that is there twice moves by both */
        if (kept && out[kept - 1].first == out[i].first)
            out[kept - 1].second = out[kept - 1].second + out[i].second;
        else
            out[kept++] = out[i];
    out.resize(kept);
    return out;
}

/* --- channels --- */

static void add_channel(shapes &out, size_t object, const std::string &property, double rest,
                        std::vector<station> stations)
{
    stations.push_back({ 0.0, -1 });
    std::stable_sort(stations.begin(), stations.end(),
                     [](const station &a, const station &b) { return a.full < b.full; });
    out.channels.push_back({ object, property, rest, stations });
}

/* Behind the deformer's name, which Maya writes before each: "blendShape1.smile". */
static void strip_prefix(std::vector<std::string> &names)
{
    const size_t dot = names.empty() ? std::string::npos : names[0].find('.');
    if (dot == std::string::npos) return;
    for (const std::string &name : names)
        if (name.compare(0, dot + 1, names[0], 0, dot + 1) != 0 || name.size() == dot + 1) return;
    for (std::string &name : names) name.erase(0, dot + 1);
}

static std::string percent(double full)
{
    return std::to_string(std::lround(std::max(-percent_max, std::min(full, percent_max))));
}

/* Exporters write one percentage for each shape, or, where a shape is masked, one for each of its points. */
static void read_channel(job &j, size_t object, size_t point_count, shapes &out)
{
    const node &from = *j.in.objects[object].from, *deform = from.child("DeformPercent");
    const std::vector<size_t> targets = j.in.below(object, "Geometry", nullptr);
    std::vector<double> full = list_of(from, "FullWeights").values, mask;
    std::vector<station> stations;
    if (targets.empty()) return;
    if (full.size() != targets.size()) {
        const bool is_mask = targets.size() == 1 &&
                             full.size() == list_of(*j.in.objects[targets[0]].from, "Indexes").values.size();
        if (is_mask) mask = full;
        if (!is_mask && !full.empty())
            j.in.warn(place_of(j.in, object), " has percentages that fit neither its shapes nor their points: 100 "
                                              "was taken; export it again");
        full.assign(targets.size(), 100.0);
        for (size_t i = 0; i < full.size(); ++i)
            full[i] *= static_cast<double>(i + 1) / static_cast<double>(full.size());
    }
    for (double &f : full)
        if (!std::isfinite(f)) f = 100.0;
    const size_t last = static_cast<size_t>(std::max_element(full.begin(), full.end()) - full.begin());
    if (targets.size() > 1)
        j.in.warn(place_of(j.in, object), " has in-betweens, which became targets with weights of their own: clips "
                                          "follow them, but a weight set by a program does not");
    for (size_t i = 0; i < targets.size(); ++i) {
        const fbx::object &shape = j.in.objects[targets[i]], &channel = j.in.objects[object];
        const std::string &name = channel.name.empty() ? shape.name : channel.name;
        stations.push_back({ full[i], static_cast<int>(out.targets.size()) });
        out.targets.push_back(read_deltas(j, place_of(j.in, targets[i]), *shape.from, mask, point_count));
        out.names.push_back(i == last ? name : name + "_" + percent(full[i]));
    }
    const double rest = j.in.real(object, "DeformPercent", deform ? deform->number(0) : 0.0);
    add_channel(out, object, "DeformPercent", rest, stations);
}

/* Before version 7 shapes are in the model, whose property of the same name is their percentage. */
static void read_inner_shapes(job &j, size_t object, size_t point_count, shapes &out)
{
    std::set<std::string> known;
    for (const node &n : j.in.objects[object].from->children) {
        if (n.name != "Shape" || !known.insert(n.text(0)).second) continue;
        const std::string name = name_of(j.in, n.text(0)), where = "shape '" + name + "'";
        const int target = static_cast<int>(out.targets.size());
        out.targets.push_back(read_deltas(j, where, n, {}, point_count));
        out.names.push_back(name);
        add_channel(out, object, n.text(0), j.in.real(object, n.text(0).c_str(), 0.0), { { 100.0, target } });
    }
}

shapes read_shapes(job &j, size_t geometry, size_t point_count)
{
    shapes out;
    read_inner_shapes(j, geometry, point_count, out);
    for (size_t deformer : j.in.below(geometry, "Deformer", "BlendShape"))
        for (size_t channel : j.in.below(deformer, "Deformer", "BlendShapeChannel"))
            read_channel(j, channel, point_count, out);
    strip_prefix(out.names);
    return out;
}

/* --- weights --- */

/* On the line between the two stations about the percentage; the outermost lines go on. */
std::vector<double> weights_of(const std::vector<shape_channel> &channels, const std::vector<double> &percent,
                               size_t target_count)
{
    std::vector<double> out(target_count, 0.0);
    for (size_t c = 0; c < channels.size(); ++c) {
        const std::vector<station> &at = channels[c].stations;
        const double value = std::max(-percent_max, std::min(percent[c], percent_max));
        size_t k = 0;
        while (k + 2 < at.size() && value > at[k + 1].full) ++k;
        const double span = at[k + 1].full - at[k].full;
        const double x = span != 0.0 ? (value - at[k].full) / span : 0.0;
        if (at[k].target >= 0) out[static_cast<size_t>(at[k].target)] += 1.0 - x;
        if (at[k + 1].target >= 0) out[static_cast<size_t>(at[k + 1].target)] += x;
    }
    return out;
}

} // namespace fbx
