/* fbx_binary.cpp: binary files. A record is its end, its values' count and size, its name, its values and its children;
 * an empty record ends a list. */
#include "fbx_tree.h"

#include <cstring>
#include <limits>
#include <stb/stb_image.h>

namespace fbx
{

static const char magic[] = "Kaydara FBX Binary  "; /* with its zero: 21 bytes; then 0x1a and the byte order */
static const size_t magic_size = 21, header_size = 27;
static const int64_t wide_version = 7500; /* from here on records have 64 bits */

static const uint64_t array_bytes_max = uint64_t{ 1 } << 30; /* of all arrays, unpacked */
static const uint64_t deflate_ratio_max = 1032;

static const char truncated[] = "the file ends inside a value: it is truncated or damaged, export or copy it again";

struct binary_reader {
    const std::string &bytes;
    size_t at;
    bool big_endian, wide;
    uint64_t array_bytes;

    [[noreturn]] void refuse(size_t place, const char *what) const;
    const char *take(uint64_t size);
    template <class T> T turned(const char *from) const;
    template <class T> T get();
    uint64_t offset();
    std::string unpack(uint64_t size, uint64_t packed_size);
    template <class T> value array();
    value read_value();
    bool record(node &out, size_t limit, int depth);
};

void binary_reader::refuse(size_t place, const char *what) const
{
    fail("byte " + std::to_string(place), what);
}

const char *binary_reader::take(uint64_t size)
{
    if (size > bytes.size() - at) refuse(at, truncated);
    at += static_cast<size_t>(size);
    return bytes.data() + at - size;
}

template <class T> T binary_reader::turned(const char *from) const
{
    char in_order[sizeof(T)];
    T out;
    const uint16_t probe = 1;
    char first;
    memcpy(&first, &probe, 1);
    const bool turn = big_endian == (first == 1); /* the file's order is not this machine's */
    for (size_t i = 0; i < sizeof(T); ++i) in_order[i] = from[turn ? sizeof(T) - 1 - i : i];
    memcpy(&out, in_order, sizeof(T));
    return out;
}

template <class T> T binary_reader::get()
{
    return turned<T>(take(sizeof(T)));
}

uint64_t binary_reader::offset()
{
    return wide ? get<uint64_t>() : get<uint32_t>();
}

std::string binary_reader::unpack(uint64_t size, uint64_t packed_size)
{
    const size_t place = at;
    const char *packed = take(packed_size);
    if (size / deflate_ratio_max > packed_size + 64) refuse(place, "a packed array is too short for its count");
    std::string out(static_cast<size_t>(size), '\0');
    const uint64_t most = std::numeric_limits<int>::max();
    if (size > most || packed_size > most ||
        stbi_zlib_decode_buffer(&out[0], static_cast<int>(size), packed, static_cast<int>(packed_size)) !=
            static_cast<int>(size))
        refuse(place, "a packed array cannot be unpacked: the file is damaged, export or copy it again");
    return out;
}

template <class T> value binary_reader::array()
{
    const size_t place = at;
    const uint64_t count = get<uint32_t>(), packed = get<uint32_t>(), packed_size = get<uint32_t>();
    const uint64_t size = count * sizeof(T);
    numbers out;
    array_bytes += count * sizeof(double);
    if (array_bytes > array_bytes_max) refuse(place, "the file's arrays need more than 1 GiB, which is the limit");
    const std::string unpacked = packed ? unpack(size, packed_size) : std::string();
    const char *from = packed ? unpacked.data() : take(size);
    out.whole = static_cast<T>(0.5) == static_cast<T>(0);
    out.values.resize(static_cast<size_t>(count));
    for (size_t i = 0; i < out.values.size(); ++i) out.values[i] = static_cast<double>(turned<T>(from + i * sizeof(T)));
    return out;
}

value binary_reader::read_value()
{
    const size_t place = at;
    switch (*take(1)) {
    case 'C':
    case 'B':
    case 'Z': return int64_t{ *take(1) };
    case 'Y': return int64_t{ get<int16_t>() };
    case 'I': return int64_t{ get<int32_t>() };
    case 'L': return get<int64_t>();
    case 'F': return static_cast<double>(get<float>());
    case 'D': return get<double>();
    case 'S':
    case 'R': {
        const uint32_t size = get<uint32_t>();
        const char *from = take(size);
        return std::string(from, size);
    }
    case 'b':
    case 'c': return array<int8_t>();
    case 'i': return array<int32_t>();
    case 'l': return array<int64_t>();
    case 'f': return array<float>();
    case 'd': return array<double>();
    default: refuse(place, "a value of unknown type: the file is damaged, export or copy it again");
    }
}

/* limit: where the parent ends. False: the empty record that ends a list. */
bool binary_reader::record(node &out, size_t limit, int depth)
{
    const size_t place = at;
    const uint64_t end = offset(), count = offset(), size = offset();
    const uint8_t letters = static_cast<uint8_t>(*take(1));
    if (!end) return false;
    const char *name = take(letters);
    out.name.assign(name, letters);
    if (end > limit || end < at || size > end - at || count > size)
        refuse(place, "a record ends outside of its parent: the file is truncated or damaged, export or copy it again");
    if (depth > depth_max) refuse(place, "records are nested too deeply: the file is damaged");
    const size_t values_end = at + static_cast<size_t>(size);
    out.values.reserve(static_cast<size_t>(count));
    for (uint64_t i = 0; i < count; ++i) out.values.push_back(read_value());
    if (at > values_end) refuse(place, "a record's values are longer than it says: the file is damaged");
    at = values_end;
    while (at < end) {
        node child;
        if (!record(child, static_cast<size_t>(end), depth + 1)) break;
        out.children.push_back(std::move(child));
    }
    at = static_cast<size_t>(end);
    return true;
}

bool is_binary(const std::string &bytes)
{
    return bytes.size() >= header_size && memcmp(bytes.data(), magic, magic_size) == 0;
}

void read_binary(const std::string &bytes, tree &out)
{
    binary_reader reader{ bytes, header_size - 4, bytes[header_size - 5] != 0, false, 0 };
    out.version = reader.get<uint32_t>();
    reader.wide = out.version >= wide_version;
    for (;;) {
        node n;
        out.cut = bytes.size() - reader.at < (reader.wide ? 25u : 13u);
        if (out.cut || !reader.record(n, bytes.size(), 0)) return;
        out.top.children.push_back(std::move(n));
    }
}

} // namespace fbx
