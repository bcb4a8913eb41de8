/* gltf_read.cpp: from a .gltf or .glb file to a model. */
#include "gltf_internal.h"

#include <cstring>
#include <exception>
#include <memory>

namespace gltf
{

static uint32_t read_u32(const bytes &data, size_t offset)
{
    return static_cast<uint32_t>(data[offset]) | static_cast<uint32_t>(data[offset + 1]) << 8 |
           static_cast<uint32_t>(data[offset + 2]) << 16 | static_cast<uint32_t>(data[offset + 3]) << 24;
}

struct chunk {
    size_t offset, size;
};

/* The chunk at `offset`, which must have this type. */
static chunk read_chunk(const bytes &data, size_t length, size_t offset, const char *name)
{
    std::string where = text("GLB chunk at byte %zu", offset);
    if (length - offset < 8)
        fail(where, "the file ends inside a chunk header: it is truncated, export or copy it again");
    chunk c = { offset + 8, read_u32(data, offset) };
    if (c.size > length - c.offset)
        fail(where,
             text("the chunk says %zu bytes, but only %zu follow: the file is truncated, export or copy it again",
                  c.size, length - c.offset));
    if (memcmp(&data[offset + 4], name, 4) != 0) fail(where, text("this chunk must be %.4s", name));
    return c;
}

static size_t glb_length(const bytes &data)
{
    if (data.size() < 12)
        fail("GLB header", "the file ends inside its header: it is truncated, export or copy it again");
    uint32_t version = read_u32(data, 4), length = read_u32(data, 8);
    if (version != 2) fail("GLB header", text("this is glTF version %u; only version 2 is read", version));
    if (length > data.size())
        fail("GLB header", text("the header says %u bytes, but the file has %zu: it is truncated, export or copy it "
                                "again",
                                length, data.size()));
    if (length < 12)
        fail("GLB header", text("the header says %u bytes, which is shorter than the header itself", length));
    return length;
}

/* A .glb: a header, a JSON chunk, and at most one BIN chunk that counts. */
static void read_glb(file &f, const bytes &data)
{
    size_t length = glb_length(data);
    if (length < data.size())
        leave_out(f, "GLB header",
                  text(": %zu bytes behind the end that it gives were left out", data.size() - length));
    chunk json = read_chunk(data, length, 12, "JSON");
    size_t next = json.offset + json.size;
    if (next < length) {
        chunk bin = read_chunk(data, length, next, "BIN\0");
        f.bin.assign(data.begin() + static_cast<std::ptrdiff_t>(bin.offset),
                     data.begin() + static_cast<std::ptrdiff_t>(bin.offset + bin.size));
        f.has_bin = true;
    }
    parse_json(f, reinterpret_cast<const char *>(&data[0]) + json.offset, json.size);
}

static bool looks_like_json(const bytes &data)
{
    size_t i = 0;
    if (data.size() >= 3 && data[0] == 0xef && data[1] == 0xbb && data[2] == 0xbf) i = 3; /* a byte order mark */
    while (i < data.size() && strchr(" \t\r\n", data[i]) && data[i]) ++i;
    return i < data.size() && data[i] == '{';
}

static void read_container(file &f, const bytes &data)
{
    f.input_bytes = data.size();
    if (data.size() >= 4 && memcmp(&data[0], "glTF", 4) == 0)
        read_glb(f, data);
    else if (looks_like_json(data))
        parse_json(f, reinterpret_cast<const char *>(data.data()), data.size());
    else
        fail("byte 0", "this is not a glTF file: it starts neither with 'glTF' (.glb) nor with a JSON object (.gltf)");
}

static void read_model(file &f, const bytes &data)
{
    size_t slash = f.path.find_last_of('/');
    f.directory = slash == std::string::npos ? "" : f.path.substr(0, slash + 1);
    read_container(f, data);
    load_buffers(f);
    decode_draco(f);
    read_materials(f);
    read_meshes(f);
    read_nodes(f);
    read_vrm(f);
    read_skins(f);
    read_animations(f);
    add_expressions(f);
    read_springs(f);
    find_left_out(f);
    warn_left_out(f);
    if (f.out->mesh_count == 0 && f.out->clip_count == 0) {
        const std::string nothing = "the file has no triangle meshes and no animations: there is nothing to convert";
        if (f.losses.empty()) fail("glTF JSON", nothing);
        const left_out &loss = f.losses[0];
        fail(loss.first, nothing + "; " + loss.what.substr(loss.what.find(' ') + 1));
    }
}

struct model_deleter {
    void operator()(::model *m) const
    {
        model_free(m);
    }
};

static int refuse(model_error *error, const std::string &where, const std::string &what)
{
    return model_fail(error, where.c_str(), "%s", what.c_str());
}

/* `given`: the file's bytes; null: they are read from the path. */
static int read(const char *path, const bytes *given, model **out, model_error *error)
{
    *out = nullptr;
    try {
        std::unique_ptr<model, model_deleter> building(model_new());
        if (!building) throw std::bad_alloc();
        {
            file f;
            f.path = path;
            f.out = building.get();
            read_model(f, given ? *given : read_whole_file(f.path, ""));
        }
        if (model_complete(building.get(), error)) return 1;
        *out = building.release();
        return 0;
    } catch (const failure &reason) {
        return refuse(error, reason.where, reason.what);
    } catch (const std::bad_alloc &) {
        return refuse(error, "", "there is not enough memory to read this file");
    } catch (const std::exception &reason) {
        return refuse(error, "glTF JSON", text("the file could not be read: %s", reason.what()));
    }
}

} // namespace gltf

extern "C" int model_read_gltf(const char *path, model **out, model_error *error)
{
    return gltf::read(path, nullptr, out, error);
}

extern "C" int model_read_glb(const uint8_t *bytes, size_t size, const char *path, model **out, model_error *error)
{
    const gltf::bytes data(bytes, bytes + size);
    return gltf::read(path, &data, out, error);
}
