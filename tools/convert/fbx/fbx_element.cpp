/* fbx_element.cpp: layer elements of a mesh: what its corners, points or polygons have. */
#include "fbx_internal.h"

namespace fbx
{

const double *element::at(size_t corner, size_t point, size_t polygon) const
{
    size_t place = by == mapping::corner ? corner : by == mapping::point ? point : by == mapping::polygon ? polygon : 0;
    if (!index.empty()) {
        if (place >= index.size() || !(index[place] >= 0.0)) return nullptr;
        place = static_cast<size_t>(whole_of(index[place]));
    }
    return place < values.size() / width ? &values[place * width] : nullptr;
}

static bool mapping_of(const std::string &name, element::mapping *out)
{
    static const std::map<std::string, element::mapping> known = {
        { "ByPolygonVertex", element::mapping::corner },
        { "ByVertex", element::mapping::point },
        { "ByVertice", element::mapping::point },
        { "ByPolygon", element::mapping::polygon },
        { "AllSame", element::mapping::all },
    };
    const auto found = known.find(name);
    if (found == known.end()) return false;
    *out = found->second;
    return true;
}

static std::string plain_name(const char *layer)
{
    return std::string(layer).substr(sizeof "LayerElement" - 1);
}

static std::vector<const node *> layers_of(const job &j, size_t geometry, const char *name)
{
    std::vector<const node *> out;
    for (const node &n : j.in.objects[geometry].from->children)
        if (n.name == name) out.push_back(&n);
    return out;
}

static bool read_layer(job &j, size_t geometry, const node &layer, const char *const names[3], size_t width,
                       element &out)
{
    const node *by = layer.child("MappingInformationType"), *reference = layer.child("ReferenceInformationType");
    const std::string how = by ? by->text(0) : "";
    if (how == "NoMappingInformation") return false;
    if (!mapping_of(how, &out.by)) {
        j.in.warn(place_of(j.in, geometry),
                  " has a layer of " + plain_name(names[0]) + " by " + how + ", which was left out");
        return false;
    }
    out.width = width;
    out.values = finite_list(j, layer, names[1]);
    if (!reference || reference->text(0) != "Direct") out.index = list_of(layer, names[2]).values;
    return out.values.size() >= width;
}

bool read_element(job &j, size_t geometry, const char *const names[3], size_t width, element &out)
{
    const std::vector<const node *> layers = layers_of(j, geometry, names[0]);
    if (layers.size() > 1)
        j.in.warn(place_of(j.in, geometry),
                  " has more than one layer of " + plain_name(names[0]) + ": the first is read");
    return !layers.empty() && read_layer(j, geometry, *layers[0], names, width, out);
}

/* --- texture coordinates --- */

bool uv_layers::has(size_t layer) const
{
    return layer < all.size() && all[layer].is_read;
}

size_t uv_layers::of_material(job &j, size_t model, size_t material) const
{
    const std::vector<size_t> materials = j.in.below(model, "Material", nullptr);
    if (all.size() < 2 || material >= materials.size()) return 0;
    size_t found = none;
    for (const std::string &wanted : uv_layers_of(j, materials[material], model))
        for (size_t i = 0; i < all.size(); ++i) {
            if (all[i].name != wanted) continue;
            if (found != none && found != i)
                j.in.warn(place_of(j.in, materials[material]),
                          " has pictures on different sets of texture coordinates, and all use '" + all[found].name +
                              "': put them on one set");
            if (found == none) found = i;
        }
    return found == none ? 0 : found;
}

size_t uv_layers::further(size_t n, size_t shown) const
{
    return n <= shown ? n - 1 : n;
}

void uv_layers::fill(size_t layer, size_t corner, size_t point, size_t polygon, float uv[2]) const
{
    const double *found = has(layer) ? all[layer].of.at(corner, point, polygon) : nullptr;
    if (!found) return;
    uv[0] = static_cast<float>(found[0]);
    uv[1] = static_cast<float>(1.0 - found[1]);
}

uv_layers read_uvs(job &j, size_t geometry)
{
    static const char *const names[3] = { "LayerElementUV", "UV", "UVIndex" };
    uv_layers out;
    for (const node *layer : layers_of(j, geometry, names[0])) {
        const node *name = layer->child("Name");
        out.all.push_back(uv_layer());
        out.all.back().name = name ? name->text(0) : "";
        out.all.back().is_read = read_layer(j, geometry, *layer, names, 2, out.all.back().of);
    }
    for (size_t i = 1; i < out.all.size(); ++i)
        for (uint32_t k = 0; j.extras && k < j.extras->count; ++k)
            if ("TEXCOORD_" + std::to_string(i) == j.extras->names[k]) out.kept.push_back(i);
    if (out.all.size() > out.kept.size() + 1)
        j.in.warn(place_of(j.in, geometry),
                  " has " + std::to_string(out.all.size()) +
                      " sets of texture coordinates, and only what its pictures use is kept; --attributes "
                      "TEXCOORD_1 keeps the next");
    return out;
}

} // namespace fbx
