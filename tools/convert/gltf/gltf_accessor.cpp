/* gltf_accessor.cpp: accessors, dense and sparse, to floats and indices. */
#include "gltf_internal.h"

#include "noh/base.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gltf
{

/* An accessor without a buffer view needs no bytes in the file, so its count is limited here. */
static const uint64_t zeros_count_max = 16u << 20;

/* A checked accessor: what to read, and how. */
struct layout {
    const tinygltf::Accessor *accessor;
    uint32_t component; /* one bit */
    uint32_t components;
    uint64_t element_size; /* bytes */
    std::string where;     /* with "(accessor N)" */
};

static std::string element_of(const std::string &where, uint64_t element)
{
    return where + text(", element %llu", static_cast<unsigned long long>(element));
}

const tinygltf::Accessor &accessor_at(const file &f, int accessor, const std::string &where)
{
    if (accessor < 0 || static_cast<size_t>(accessor) >= f.json.accessors.size())
        fail(where, text("accessor %d does not exist: the file has %zu", accessor, f.json.accessors.size()));
    return f.json.accessors[static_cast<size_t>(accessor)];
}

static uint32_t component_bit(int component_type, bool normalized)
{
    const component none = static_cast<component>(0);
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return normalized ? c_i8n : c_i8;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return normalized ? c_u8n : c_u8;
    case TINYGLTF_COMPONENT_TYPE_SHORT: return normalized ? c_i16n : c_i16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return normalized ? c_u16n : c_u16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return normalized ? none : c_u32;
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return normalized ? none : c_f32;
    default: return none;
    }
}

static uint64_t component_size(uint32_t component)
{
    if (component & (c_i8 | c_i8n | c_u8 | c_u8n)) return 1;
    return component & (c_u32 | c_f32) ? 4 : 2;
}

static const char *component_name(int component_type)
{
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return "BYTE";
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return "UNSIGNED_BYTE";
    case TINYGLTF_COMPONENT_TYPE_SHORT: return "SHORT";
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return "UNSIGNED_SHORT";
    case TINYGLTF_COMPONENT_TYPE_INT: return "INT";
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return "UNSIGNED_INT";
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return "FLOAT";
    default: return "an unknown type";
    }
}

static const char *type_name(int type)
{
    switch (type) {
    case TINYGLTF_TYPE_SCALAR: return "SCALAR";
    case TINYGLTF_TYPE_VEC2: return "VEC2";
    case TINYGLTF_TYPE_VEC3: return "VEC3";
    case TINYGLTF_TYPE_VEC4: return "VEC4";
    case TINYGLTF_TYPE_MAT2: return "MAT2";
    case TINYGLTF_TYPE_MAT3: return "MAT3";
    case TINYGLTF_TYPE_MAT4: return "MAT4";
    default: return "unknown";
    }
}

/* tinygltf's values for vectors are their widths. */
static int type_of_width(uint32_t components)
{
    return components == 1    ? TINYGLTF_TYPE_SCALAR
           : components == 16 ? TINYGLTF_TYPE_MAT4
                              : static_cast<int>(components);
}

static layout check_type(const file &f, int index, uint32_t components, uint32_t accepted, const std::string &where)
{
    layout l;
    l.accessor = &accessor_at(f, index, where);
    l.where = where + text(" (accessor %d)", index);
    l.components = components;
    l.component = component_bit(l.accessor->componentType, l.accessor->normalized);
    if (l.accessor->type != type_of_width(components))
        fail(l.where, text("the accessor's type is %s, but this needs %s", type_name(l.accessor->type),
                           type_name(type_of_width(components))));
    if (!(l.component & accepted)) {
        const char *hint = uses_extension(f, "KHR_mesh_quantization")
                               ? ""
                               : " (is KHR_mesh_quantization missing from extensionsRequired?)";
        fail(l.where, text("the component type %s%s is not allowed here%s", l.accessor->normalized ? "normalised " : "",
                           component_name(l.accessor->componentType), hint));
    }
    l.element_size = component_size(l.component) * components;
    return l;
}

static void check_fits(const span &view, uint64_t offset, uint64_t stride, uint64_t count, uint64_t element_size,
                       const std::string &where)
{
    if (stride < element_size)
        fail(where, text("'byteStride' is %llu, less than an element's %llu bytes",
                         static_cast<unsigned long long>(stride), static_cast<unsigned long long>(element_size)));
    /* counts and offsets are below 2^32 and strides below 2^31, so nothing here overflows */
    uint64_t needed = offset + (count - 1) * stride + element_size;
    if (needed > view.size)
        fail(where, text("it needs %llu bytes of its buffer view, which has %llu",
                         static_cast<unsigned long long>(needed), static_cast<unsigned long long>(view.size)));
}

/* The dense part: where element 0 lies and how far it is to the next. data is null
 * where the accessor has no buffer view and all is zero. */
static span dense_part(file &f, const layout &l)
{
    const tinygltf::Accessor &a = *l.accessor;
    if (a.count == 0) fail(l.where, "the accessor has no elements");
    if (a.bufferView < 0) {
        if (a.count > zeros_count_max)
            fail(l.where, text("%zu elements without a buffer view; the limit is %llu", a.count,
                               static_cast<unsigned long long>(zeros_count_max)));
        return { nullptr, 0, 0 };
    }
    span view = view_bytes(f, a.bufferView, l.where);
    uint64_t stride = view.stride ? view.stride : l.element_size;
    check_fits(view, a.byteOffset, stride, a.count, l.element_size, l.where);
    return { view.data + a.byteOffset, view.size - a.byteOffset, stride };
}

template <class T> static T load(const uint8_t *bytes_at)
{
    T value;
    memcpy(&value, bytes_at, sizeof value); /* it may be misaligned */
    return value;
}

/* Integers, as the specification decodes them (3.11 "Animations", KHR_mesh_quantization). */
static float load_component(uint32_t component, const uint8_t *at)
{
    switch (component) {
    case c_i8: return load<int8_t>(at);
    case c_i8n: return std::fmax(static_cast<float>(load<int8_t>(at)) / 127.0f, -1.0f);
    case c_u8: return load<uint8_t>(at);
    case c_u8n: return static_cast<float>(load<uint8_t>(at)) / 255.0f;
    case c_i16: return load<int16_t>(at);
    case c_i16n: return std::fmax(static_cast<float>(load<int16_t>(at)) / 32767.0f, -1.0f);
    case c_u16: return load<uint16_t>(at);
    case c_u16n: return static_cast<float>(load<uint16_t>(at)) / 65535.0f;
    default: return load<float>(at);
    }
}

static uint32_t load_index(uint32_t component, const uint8_t *at)
{
    switch (component) {
    case c_u8: return load<uint8_t>(at);
    case c_u16: return load<uint16_t>(at);
    default: return load<uint32_t>(at);
    }
}

/* What is infinite or too large becomes NaN. */
static void load_element(const layout &l, const uint8_t *at, float *out)
{
    for (uint32_t i = 0; i < l.components; ++i) {
        out[i] = load_component(l.component, at + i * component_size(l.component));
        if (!(std::fabs(out[i]) <= NOH_NUMBER_MAX)) out[i] = NAN;
    }
}

/* The sparse part: the replaced elements and their values. */
struct sparse_part {
    uint64_t count;
    uint32_t index_component;
    span indices, values;
};

static sparse_part read_sparse(file &f, const layout &l)
{
    const tinygltf::Accessor &a = *l.accessor;
    sparse_part s;
    if (a.sparse.count < 0 || static_cast<uint64_t>(a.sparse.count) > a.count)
        fail(l.where, text("the sparse count %d is more than the accessor's %zu elements", a.sparse.count, a.count));
    s.count = static_cast<uint64_t>(a.sparse.count);
    s.index_component = component_bit(a.sparse.indices.componentType, false);
    if (!(s.index_component & (c_u8 | c_u16 | c_u32)))
        fail(l.where + " sparse indices",
             text("the component type %s is not allowed here", component_name(a.sparse.indices.componentType)));
    if (s.count == 0) return s;
    uint64_t index_size = component_size(s.index_component);
    /* offsets have passed through int: above 2^31 they are negative, and fail below as huge numbers */
    uint64_t index_offset = static_cast<uint32_t>(a.sparse.indices.byteOffset);
    uint64_t value_offset = static_cast<uint32_t>(a.sparse.values.byteOffset);
    s.indices = view_bytes(f, a.sparse.indices.bufferView, l.where + " sparse indices");
    s.values = view_bytes(f, a.sparse.values.bufferView, l.where + " sparse values");
    check_fits(s.indices, index_offset, index_size, s.count, index_size, l.where + " sparse indices");
    check_fits(s.values, value_offset, l.element_size, s.count, l.element_size, l.where + " sparse values");
    s.indices.data += index_offset;
    s.values.data += value_offset;
    return s;
}

/* false: the accessor has no such element. */
static bool sparse_index(file &f, const layout &l, const sparse_part &s, uint64_t i, uint32_t &index)
{
    uint64_t size = component_size(s.index_component);
    index = load_index(s.index_component, s.indices.data + i * size);
    const bool exists = index < l.accessor->count;
    if (!exists)
        leave_out(f, element_of(l.where + " sparse indices", i),
                  text(": its value was left out: the accessor has %zu elements", l.accessor->count));
    else if (i > 0 && index <= load_index(s.index_component, s.indices.data + (i - 1) * size))
        leave_out(f, element_of(l.where + " sparse indices", i),
                  ": the index does not increase; of values for one element the last was read");
    return exists;
}

/* Where an element lies among those that are read; false: it is not. */
static bool place_of(const vertex_list &vertices, uint32_t element, size_t &place)
{
    place = element;
    if (vertices.used.empty()) return true;
    auto found = std::lower_bound(vertices.sorted.begin(), vertices.sorted.end(), element);
    if (found == vertices.sorted.end() || *found != element) return false;
    place = vertices.place[static_cast<size_t>(found - vertices.sorted.begin())];
    return true;
}

static void apply_sparse(file &f, const layout &l, const vertex_list &vertices, float *out)
{
    sparse_part s = read_sparse(f, l);
    for (uint64_t i = 0; i < s.count; ++i) {
        uint32_t element;
        size_t place;
        if (sparse_index(f, l, s, i, element) && place_of(vertices, element, place))
            load_element(l, s.values.data + i * l.element_size, out + place * l.components);
    }
}

static layout read_elements(file &f, int accessor, uint32_t components, uint32_t accepted, const vertex_list &vertices,
                            const std::string &where, float *out)
{
    layout l = check_type(f, accessor, components, accepted, where);
    if (l.accessor->count != vertices.total)
        fail(l.where, text("the accessor has %zu elements, but %llu are needed here", l.accessor->count,
                           static_cast<unsigned long long>(vertices.total)));
    span dense = dense_part(f, l);
    for (size_t i = 0; i < vertices.count(); ++i) {
        if (dense.data)
            load_element(l, dense.data + vertices.at(i) * dense.stride, out + i * components);
        else
            memset(out + i * components, 0, components * sizeof(float));
    }
    if (l.accessor->sparse.isSparse) apply_sparse(f, l, vertices, out);
    return l;
}

void read_vertices(file &f, int accessor, uint32_t components, uint32_t accepted, const vertex_list &vertices,
                   const std::string &where, float *out)
{
    const layout l = read_elements(f, accessor, components, accepted, vertices, where, out);
    for (size_t i = 0; i < vertices.count() * components; ++i)
        if (std::isnan(out[i])) {
            leave_out(f, element_of(l.where, vertices.at(i / components)),
                      ": the value is NaN, infinite or above 1e12; it was read as 0");
            out[i] = 0.0f;
        }
}

void read_floats(file &f, int accessor, uint32_t components, uint32_t accepted, uint64_t count,
                 const std::string &where, float *out)
{
    vertex_list all;
    all.total = count;
    (void)read_elements(f, accessor, components, accepted, all, where, out);
}

static void apply_sparse_indices(file &f, const layout &l, std::vector<uint32_t> &out)
{
    sparse_part s = read_sparse(f, l);
    uint32_t element;
    for (uint64_t i = 0; i < s.count; ++i)
        if (sparse_index(f, l, s, i, element))
            out[element] = load_index(l.component, s.values.data + i * l.element_size);
}

std::vector<uint32_t> read_indices(file &f, int accessor, const std::string &where)
{
    layout l = check_type(f, accessor, 1, c_u8 | c_u16 | c_u32, where);
    span dense = dense_part(f, l);
    charge(f, l.accessor->count, sizeof(uint32_t), l.where);
    std::vector<uint32_t> out(l.accessor->count, 0);
    for (size_t i = 0; dense.data && i < out.size(); ++i)
        out[i] = load_index(l.component, dense.data + i * dense.stride);
    if (l.accessor->sparse.isSparse) apply_sparse_indices(f, l, out);
    const uint32_t largest = l.component == c_u8 ? 0xffu : l.component == c_u16 ? 0xffffu : MODEL_NONE;
    for (uint32_t &index : out) index = index == largest ? MODEL_NONE : index;
    return out;
}

} // namespace gltf
