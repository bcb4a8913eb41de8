/* gltf_read.cpp: from a .gltf or .glb file to a model. */
#include "gltf_internal.h"

#include <cstring>
#include <exception>
#include <memory>

#include "convert/base/curves.h"

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

/* The chunk at `offset`. One that is longer than the file ends with it. */
static chunk read_chunk(file &f, const bytes &data, size_t offset)
{
    chunk c = { offset + 8, read_u32(data, offset) };
    const size_t left = data.size() - c.offset;
    if (c.size > left) {
        leave_out(f, text("GLB chunk at byte %zu", offset),
                  text(": it says %zu bytes, but only %zu follow: the file is truncated, export or copy it again",
                       c.size, left));
        c.size = left;
    }
    return c;
}

static bool is_chunk(const bytes &data, size_t offset, const char *name)
{
    return offset <= data.size() && data.size() - offset >= 8 && memcmp(&data[offset + 4], name, 4) == 0;
}

/* The header's numbers are not needed where the first chunk is JSON, as in no file of version 1. */
static void check_header(file &f, const bytes &data)
{
    if (data.size() < 20)
        fail("GLB header", "the file ends inside its header: it is truncated, export or copy it again");
    const uint32_t version = read_u32(data, 4), length = read_u32(data, 8);
    if (!is_chunk(data, 12, "JSON"))
        fail("GLB header",
             version != 2 ? old_version(std::to_string(version))
                          : std::string("the first chunk must be JSON: the file is damaged, export or copy it again"));
    if (version != 2) leave_out(f, "GLB header", text(": this is glTF version %u; it was read as version 2", version));
    if (length > data.size())
        leave_out(f, "GLB header",
                  text(": it says %u bytes, but the file has %zu: it is truncated, export or copy it again", length,
                       data.size()));
}

/* A .glb: a header, a JSON chunk, and at most one BIN chunk that counts. Others are passed over. */
static void read_glb(file &f, const bytes &data)
{
    check_header(f, data);
    const size_t length = read_u32(data, 8), asked = size_t{ 20 } + read_u32(data, 12);
    if (asked > data.size())
        fail("GLB chunk at byte 12",
             text("the chunk says %zu bytes, but only %zu follow: the file is truncated, export or copy it again",
                  asked - 20, data.size() - 20));
    size_t next = asked;
    while (next < data.size() && !f.has_bin) {
        if (data.size() - next < 8) {
            if (next < length)
                leave_out(f, text("GLB chunk at byte %zu", next),
                          ": the file ends inside a chunk header: it is truncated, export or copy it again");
            break;
        }
        const bool is_bin = is_chunk(data, next, "BIN\0");
        if (!is_bin && next >= length) break;
        const chunk c = read_chunk(f, data, next);
        if (is_bin)
            f.bin.assign(data.begin() + static_cast<std::ptrdiff_t>(c.offset),
                         data.begin() + static_cast<std::ptrdiff_t>(c.offset + c.size));
        else
            leave_out(f, text("GLB chunk at byte %zu", next), ": it is neither JSON nor BIN, and was left out");
        f.has_bin = is_bin;
        next = c.offset + c.size;
    }
    if (next < data.size())
        leave_out(f, "GLB", text(": %zu bytes behind its chunks were left out", data.size() - next));
    parse_json(f, reinterpret_cast<const char *>(&data[0]) + 20, asked - 20);
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

/* Up to the nodes. */
void read_scene(file &f, const bytes &data)
{
    size_t slash = f.path.find_last_of('/');
    f.directory = slash == std::string::npos ? "" : f.path.substr(0, slash + 1);
    read_container(f, data);
    load_buffers(f);
    decode_draco(f);
    read_materials(f);
    read_meshes(f);
    read_nodes(f);
}

static void read_model(file &f, const bytes &data)
{
    read_scene(f, data);
    read_vrm(f);
    read_skins(f);
    read_animations(f);
    add_expressions(f);
    read_springs(f);
    find_left_out(f);
    warn_left_out(f);
    if (f.out->mesh_count == 0 && f.out->clip_count == 0) {
        const std::string nothing = "the file has no triangle meshes and no animations: there is nothing to convert";
        for (const left_out &loss : f.losses) /* nodes and cameras are no reason */
            if (loss.first.compare(0, 6, "node '") != 0 && loss.first.compare(0, 8, "camera '") != 0)
                fail(loss.first, nothing + "; " + clause_of(loss));
        fail("glTF JSON", nothing);
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

/* `given`: the file's bytes; null: they are read from the path. To a model, or to curves alone. */
static int read(const char *path, const bytes *given, const extra_list *extras, model **out, curve_list *curves,
                model_error *error)
{
    try {
        std::unique_ptr<model, model_deleter> building(model_new());
        if (!building) throw std::bad_alloc();
        {
            file f;
            f.path = path;
            f.out = building.get();
            if (extras) f.out->extras = *extras;
            const bytes data = given ? *given : read_whole_file(f.path, "");
            curves ? read_curves(f, data, *curves) : read_model(f, data);
        }
        if (curves) return 0;
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
    *out = nullptr;
    return gltf::read(path, nullptr, nullptr, out, nullptr, error);
}

extern "C" int model_read_gltf_with(const char *path, const extra_list *extras, model **out, model_error *error)
{
    *out = nullptr;
    return gltf::read(path, nullptr, extras, out, nullptr, error);
}

extern "C" int model_read_glb(const uint8_t *bytes, size_t size, const char *path, const extra_list *extras,
                              model **out, model_error *error)
{
    const gltf::bytes data(bytes, bytes + size);
    *out = nullptr;
    return gltf::read(path, &data, extras, out, nullptr, error);
}

extern "C" int curves_read(const char *path, curve_list *out, model_error *error)
{
    memset(out, 0, sizeof *out);
    return gltf::read(path, nullptr, nullptr, nullptr, out, error);
}
