/* gltf_buffer.cpp: files, URIs and buffers. */
#include "gltf_internal.h"

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "convert/base/file_kind.h"
#include "convert/base/input_file.h"

namespace tinygltf
{
/* tinygltf defines this function, but its header declares it only for its own use. */
std::string base64_decode(std::string const &s);
} // namespace tinygltf

namespace gltf
{

/* tinygltf counts in int in many places. */
static const uint64_t file_bytes_max = 0x7fffffff;
/* The limit for all that a glTF refers to, together. */
static const uint64_t input_bytes_max = uint64_t{ 4 } << 30;

struct file_closer {
    void operator()(FILE *stream) const
    {
        fclose(stream);
    }
};

/* Adds the path, unless it is the file that was asked for: its messages begin with its name. */
[[noreturn]] static void fail_to_read(const std::string &path, const std::string &where, const char *why)
{
    fail(where, where.empty() ? why : why + (": " + path));
}

static bytes read_held(const std::string &path, const std::string &where)
{
    const input_held *file = input_find_held(path.c_str());
    inputs_note(path.c_str(), file != nullptr);
    if (!file) fail_to_read(path, where, "the file is not among the caller's");
    if (file->count > file_bytes_max) fail_to_read(path, where, "the file is larger than 2 GiB, which is the limit");
    const char *first = static_cast<const char *>(file->bytes);
    return bytes(first, first + file->count);
}

bytes read_whole_file(const std::string &path, const std::string &where)
{
    if (inputs_are_held()) return read_held(path, where);
    std::error_code ignored;
    const bool is_there = std::filesystem::exists(path, ignored);
    inputs_note(path.c_str(), is_there);
    if (!is_there) fail_to_read(path, where, "the file does not exist");
    if (!std::filesystem::is_regular_file(path, ignored)) /* a device may never end */
        fail_to_read(path, where, "this is not a file");
    std::unique_ptr<FILE, file_closer> stream(fopen(path.c_str(), "rb"));
    uint64_t size = std::filesystem::file_size(path, ignored);
    if (!stream || ignored) fail_to_read(path, where, "the file cannot be opened");
    if (size > file_bytes_max) fail_to_read(path, where, "the file is larger than 2 GiB, which is the limit");
    bytes data(static_cast<size_t>(size));
    if (fread(data.data(), 1, data.size(), stream.get()) != data.size())
        fail_to_read(path, where, "the file cannot be read");
    return data;
}

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

static std::string percent_decode(const std::string &uri)
{
    std::string out;
    for (size_t i = 0; i < uri.size(); ++i) {
        int high = uri[i] == '%' && i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
        int low = high >= 0 ? hex_digit(uri[i + 2]) : -1;
        out += low >= 0 ? static_cast<char>(high * 16 + low) : uri[i];
        i += low >= 0 ? 2 : 0;
    }
    return out;
}

static bytes decode_data_uri(const std::string &uri, const std::string &where)
{
    size_t comma = uri.find(',');
    if (comma == std::string::npos || comma < 7 || uri.compare(comma - 7, 7, ";base64") != 0)
        fail(where, "the data URI is not base64");
    std::string decoded = tinygltf::base64_decode(uri.substr(comma + 1));
    return bytes(decoded.begin(), decoded.end());
}

/* Only files in the folder of the glTF (or above it) are opened: a file from a stranger must not make the converter
 * read the user's own files. */
static std::string path_of(const file &f, const std::string &uri, const std::string &where)
{
    const std::string path = percent_decode(uri);
    if (path.empty() || path[0] == '/' || path.find(':') != std::string::npos || path.find('\0') != std::string::npos)
        fail(where,
             "the URI '" + printable(uri) + "' is not a relative path: put the file in the folder of the glTF file");
    char found[4096];
    if (input_find_any_case((f.directory + path).c_str(), found, sizeof found)) return found;
    /* some exporters write a name as it is */
    if (uri != path && input_find_any_case((f.directory + uri).c_str(), found, sizeof found)) return found;
    return f.directory + path;
}

bytes read_uri(file &f, const std::string &uri, const std::string &where)
{
    const bool is_inside = uri.compare(0, 5, "data:") == 0;
    bytes data = is_inside ? decode_data_uri(uri, where) : read_whole_file(path_of(f, uri, where), where);
    const file_kind *kind = file_kind_of_bytes(data.data(), data.size());
    if (kind && !kind->ending)
        fail(where, (is_inside ? "it" : "'" + printable(uri) + "'") + " is " + kind->what + ": " + kind->instead);
    f.input_bytes += data.size();
    if (f.input_bytes > input_bytes_max)
        fail(where, "the glTF and its files are larger than 4 GiB together, which is the limit");
    return data;
}

static void load_buffer(file &f, buffer &b, bool first, const std::string &where)
{
    if (b.has_uri) {
        if (!attempt(f, "; what it holds was left out", [&] { b.data = read_uri(f, b.uri, where); })) return;
    } else if (first && f.has_bin)
        b.data.swap(f.bin);
    /* an error only if it is used */
    else
        return;
    b.uri = std::string();
    if (b.byte_length == UINT64_MAX) b.byte_length = b.data.size();
    if (b.data.size() < b.byte_length) {
        leave_out(f, where,
                  text(": the buffer has %zu bytes, but 'byteLength' says %llu: what lies behind them was left out",
                       b.data.size(), static_cast<unsigned long long>(b.byte_length)));
        b.byte_length = b.data.size();
    }
    b.has_data = true;
}

void load_buffers(file &f)
{
    for (size_t i = 0; i < f.buffers.size(); ++i)
        if (!f.buffers[i].fallback) load_buffer(f, f.buffers[i], i == 0, text("buffer %zu", i));
}

span buffer_bytes(file &f, int index, uint64_t offset, uint64_t size, const std::string &where)
{
    if (index < 0 || static_cast<size_t>(index) >= f.buffers.size())
        fail(where, text("buffer %d does not exist: the file has %zu", index, f.buffers.size()));
    buffer &b = f.buffers[static_cast<size_t>(index)];
    if (!b.has_data)
        fail(where,
             text("buffer %d has no data: it has no 'uri', and is not the first of a .glb with a BIN chunk", index));
    const auto has = [&](uint64_t bytes) { return size <= bytes && offset <= bytes - size; };
    if (!has(b.byte_length) && has(b.data.size())) {
        leave_out(f, text("buffer %d", index),
                  text(": 'byteLength' says %llu, but it has %zu bytes, and later ones are needed: all were read",
                       static_cast<unsigned long long>(b.byte_length), b.data.size()));
        b.byte_length = b.data.size();
    }
    if (!has(b.byte_length))
        fail(where, text("bytes %llu to %llu are out of range: buffer %d has %llu",
                         static_cast<unsigned long long>(offset), static_cast<unsigned long long>(offset + size), index,
                         static_cast<unsigned long long>(b.byte_length)));
    return { b.data.data() + offset, size, 0 };
}

} // namespace gltf
