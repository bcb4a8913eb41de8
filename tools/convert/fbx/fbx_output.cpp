/* fbx_output.cpp: accessors of the .glb. */
#include "fbx_internal.h"

#include <algorithm>
#include <cmath>

#include "noh/base.h"

namespace fbx
{

int add_view(job &j, const void *bytes, size_t size)
{
    if (j.out.buffers.empty()) j.out.buffers.emplace_back();
    std::vector<unsigned char> &data = j.out.buffers[0].data;
    data.resize((data.size() + 3) & ~size_t{ 3 });
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = size;
    const unsigned char *first = static_cast<const unsigned char *>(bytes);
    data.insert(data.end(), first, first + size);
    j.out.bufferViews.push_back(view);
    return static_cast<int>(j.out.bufferViews.size() - 1);
}

static int add_accessor(job &j, int view, int component, int type, size_t values)
{
    tinygltf::Accessor a;
    a.bufferView = view;
    a.componentType = component;
    a.type = type;
    a.count = values / static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type)));
    j.out.accessors.push_back(a);
    return static_cast<int>(j.out.accessors.size() - 1);
}

template <class T> static void make_finite(job &j, std::vector<T> &values)
{
    for (T &v : values) {
        if (std::fabs(v) <= static_cast<T>(NOH_NUMBER_MAX)) continue;
        v = 0;
        j.in.warn("the file", " has numbers that are not finite or too large, which became 0: export it again");
    }
}

std::vector<double> finite_list(job &j, const node &parent, const char *child)
{
    std::vector<double> values = list_of(parent, child).values;
    make_finite(j, values);
    return values;
}

static int add_finite(job &j, const std::vector<float> &values, int type)
{
    return add_accessor(j, add_view(j, values.data(), values.size() * sizeof(float)), TINYGLTF_COMPONENT_TYPE_FLOAT,
                        type, values.size());
}

int add_floats(job &j, std::vector<float> values, int type)
{
    make_finite(j, values);
    return add_finite(j, values, type);
}

static void add_bounds(tinygltf::Accessor &a, const std::vector<float> &values, bool with_zero)
{
    for (size_t k = 0; k < 3; ++k) {
        double low = with_zero || values.empty() ? 0.0 : HUGE_VAL, high = with_zero || values.empty() ? 0.0 : -HUGE_VAL;
        for (size_t i = k; i < values.size(); i += 3) {
            const double v = static_cast<double>(values[i]);
            low = std::min(low, v);
            high = std::max(high, v);
        }
        a.minValues.push_back(low);
        a.maxValues.push_back(high);
    }
}

int add_positions(job &j, std::vector<float> values)
{
    make_finite(j, values);
    const int index = add_finite(j, values, TINYGLTF_TYPE_VEC3);
    add_bounds(j.out.accessors.back(), values, false);
    return index;
}

int add_sparse(job &j, const std::vector<uint32_t> &places, const std::vector<float> &values, size_t count)
{
    std::vector<uint32_t> at = places;
    std::vector<float> to = values;
    if (at.empty()) { /* there must be one */
        at.push_back(0);
        to.resize(3);
    }
    make_finite(j, to);
    const int index = add_accessor(j, -1, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, count * 3);
    const int of_places = add_view(j, at.data(), at.size() * sizeof(uint32_t));
    const int of_values = add_view(j, to.data(), to.size() * sizeof(float));
    tinygltf::Accessor &a = j.out.accessors.back();
    a.sparse.isSparse = true;
    a.sparse.count = static_cast<int>(at.size());
    a.sparse.indices.bufferView = of_places;
    a.sparse.indices.byteOffset = 0;
    a.sparse.indices.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    a.sparse.values.bufferView = of_values;
    a.sparse.values.byteOffset = 0;
    add_bounds(a, to, true);
    return index;
}

int add_u16(job &j, const std::vector<uint16_t> &values, int type)
{
    return add_accessor(j, add_view(j, values.data(), values.size() * sizeof(uint16_t)),
                        TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, type, values.size());
}

int add_u32(job &j, const std::vector<uint32_t> &values)
{
    return add_accessor(j, add_view(j, values.data(), values.size() * sizeof(uint32_t)),
                        TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, values.size());
}

} // namespace fbx
