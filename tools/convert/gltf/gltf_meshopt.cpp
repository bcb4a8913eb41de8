/* gltf_meshopt.cpp: EXT_meshopt_compression, by meshoptimizer's decoders.
 *
 * The decoders check the compressed data, but assert on impossible sizes; so
 * every size is checked here first. */
#include "gltf_internal.h"

#include <meshoptimizer.h>

namespace gltf
{

/* The densest stream (all attributes equal) packs 64 bytes into one; this allows some more. */
static const uint64_t expansion_max = 256;

struct stream {
    uint64_t stride, count;
    std::string mode, filter;
    span source;
};

static uint64_t integer_member(const tinygltf::Value &object, const char *key, bool required, const std::string &where)
{
    const tinygltf::Value &value = object.Get(key);
    if (!value.IsInt() && !required) return 0;
    if (!value.IsInt() || value.Get<int>() < 0)
        fail(where, text("EXT_meshopt_compression: '%s' must be a whole number from 0 to 2147483647", key));
    return static_cast<uint64_t>(value.Get<int>());
}

static std::string string_member(const tinygltf::Value &object, const char *key, const char *otherwise)
{
    const tinygltf::Value &value = object.Get(key);
    return value.IsString() ? value.Get<std::string>() : otherwise;
}

static void check_sizes(const stream &s, const std::string &where)
{
    bool attributes = s.mode == "ATTRIBUTES";
    if (!attributes && s.mode != "TRIANGLES" && s.mode != "INDICES")
        fail(where, "EXT_meshopt_compression: unknown mode '" + printable(s.mode) + "'");
    if (attributes && (s.stride == 0 || s.stride > 256 || s.stride % 4 != 0))
        fail(where, "EXT_meshopt_compression: 'byteStride' of attributes must be a multiple of 4 up to 256");
    if (!attributes && s.stride != 2 && s.stride != 4)
        fail(where, "EXT_meshopt_compression: 'byteStride' of indices must be 2 or 4");
    if (s.mode == "TRIANGLES" && s.count % 3 != 0)
        fail(where, "EXT_meshopt_compression: 'count' of triangle indices must be a multiple of 3");
    if (s.count == 0 || s.count * s.stride / expansion_max > s.source.size)
        fail(where, text("EXT_meshopt_compression: %llu bytes cannot hold %llu elements",
                         static_cast<unsigned long long>(s.source.size), static_cast<unsigned long long>(s.count)));
}

static void check_filter(const stream &s, const std::string &where)
{
    if (s.filter == "NONE") return;
    if (s.mode != "ATTRIBUTES") fail(where, "EXT_meshopt_compression: filters are for attributes only");
    bool fits = (s.filter == "OCTAHEDRAL" && (s.stride == 4 || s.stride == 8)) ||
                (s.filter == "QUATERNION" && s.stride == 8) || s.filter == "EXPONENTIAL";
    if (!fits)
        fail(where,
             "EXT_meshopt_compression: filter '" + printable(s.filter) + "' is unknown or does not fit 'byteStride'");
}

static stream read_stream(file &f, const tinygltf::Value &extension, const std::string &where)
{
    if (!extension.IsObject()) fail(where, "EXT_meshopt_compression must be an object");
    stream s;
    uint64_t buffer_index = integer_member(extension, "buffer", true, where);
    uint64_t offset = integer_member(extension, "byteOffset", false, where);
    uint64_t length = integer_member(extension, "byteLength", true, where);
    s.stride = integer_member(extension, "byteStride", true, where);
    s.count = integer_member(extension, "count", true, where);
    s.mode = string_member(extension, "mode", "");
    s.filter = string_member(extension, "filter", "NONE");
    s.source = buffer_bytes(f, static_cast<int>(buffer_index), offset, length, where + " (compressed)");
    return s;
}

static int decode(const stream &s, bytes &out)
{
    size_t count = static_cast<size_t>(s.count), stride = static_cast<size_t>(s.stride);
    size_t source_size = static_cast<size_t>(s.source.size);
    if (s.mode == "ATTRIBUTES")
        return meshopt_decodeVertexBuffer(out.data(), count, stride, s.source.data, source_size);
    if (s.mode == "TRIANGLES") return meshopt_decodeIndexBuffer(out.data(), count, stride, s.source.data, source_size);
    return meshopt_decodeIndexSequence(out.data(), count, stride, s.source.data, source_size);
}

static void apply_filter(const stream &s, bytes &out)
{
    size_t count = static_cast<size_t>(s.count), stride = static_cast<size_t>(s.stride);
    if (s.filter == "OCTAHEDRAL")
        meshopt_decodeFilterOct(out.data(), count, stride);
    else if (s.filter == "QUATERNION")
        meshopt_decodeFilterQuat(out.data(), count, stride);
    else if (s.filter == "EXPONENTIAL")
        meshopt_decodeFilterExp(out.data(), count, stride);
}

bytes decode_meshopt(file &f, const tinygltf::Value &extension, const std::string &where)
{
    stream s = read_stream(f, extension, where);
    check_sizes(s, where);
    check_filter(s, where);
    charge(f, s.count, s.stride, where);
    bytes out(static_cast<size_t>(s.count * s.stride));
    if (s.mode == "ATTRIBUTES" && s.source.size && s.source.data[0] == 0xa1)
        fail(where, "EXT_meshopt_compression: codec version 1 is not read: compress the file with version 0");
    if (decode(s, out) != 0) fail(where, "EXT_meshopt_compression: the compressed data is damaged");
    apply_filter(s, out);
    return out;
}

} // namespace gltf
