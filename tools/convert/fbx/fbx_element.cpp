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

bool read_element(job &j, size_t geometry, const char *const names[3], size_t width, element &out)
{
    const node &from = *j.in.objects[geometry].from;
    const node *first = nullptr;
    const std::string plain = std::string(names[0]).substr(sizeof "LayerElement" - 1);
    for (const node &n : from.children) {
        if (n.name != names[0]) continue;
        if (first) j.in.warn(place_of(j.in, geometry), " has more than one layer of " + plain + ": the first is read");
        if (!first) first = &n;
    }
    if (!first) return false;
    const node *by = first->child("MappingInformationType"), *reference = first->child("ReferenceInformationType");
    const std::string how = by ? by->text(0) : "";
    if (how == "NoMappingInformation") return false;
    if (!mapping_of(how, &out.by)) {
        j.in.warn(place_of(j.in, geometry), " has a layer of " + plain + " by " + how + ", which was left out");
        return false;
    }
    out.width = width;
    out.values = finite_list(j, *first, names[1]);
    if (!reference || reference->text(0) != "Direct") out.index = list_of(*first, names[2]).values;
    return out.values.size() >= width;
}

} // namespace fbx
