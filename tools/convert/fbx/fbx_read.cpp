/* fbx_read.cpp: from an FBX file to a .glb in memory, and from there to a model. */
#include "fbx_read.h"

#include "convert/base/input_file.h"
#include "convert/model/model_build.h"
#include "fbx_internal.h"

#include <cstdlib>
#include <exception>
#include <memory>
#include <sstream>

namespace fbx
{

static std::string read_bytes(const char *path)
{
    model_error error = { "", "" };
    size_t size = 0;
    const std::unique_ptr<char, void (*)(void *)> bytes(input_read(path, &size, &error), free);
    if (!bytes) fail(error.where, error.what);
    return std::string(bytes.get(), size);
}

static std::string write_glb(job &j)
{
    std::ostringstream out(std::ios::binary);
    tinygltf::TinyGLTF writer;
    writer.SetImageWriter(nullptr, nullptr); /* its own drops names that do not end in png, jpg or bmp */
    j.out.asset.version = "2.0";
    if (!writer.WriteGltfSceneToStream(&j.out, out, false, true)) fail("FBX", "the model cannot be written");
    return out.str();
}

static std::string line_of(const note &n)
{
    bool changed = false;
    std::string out = to_utf8(n.first + n.what, &changed);
    if (n.count > 1) out += " (and " + std::to_string(n.count - 1) + " more like it)";
    for (char &c : out)
        if (static_cast<unsigned char>(c) < 32) c = ' ';
    return out;
}

static std::string convert(const char *path, const fbx_options &options, std::vector<std::string> &notes)
{
    job j;
    j.path = path;
    read_scene(read_bytes(path), j.in);
    j.unit_m = (options.unit_cm > 0.0 ? options.unit_cm : j.in.unit_cm) / 100.0;
    j.extras = options.extras;
    write_nodes(j);
    write_meshes(j);
    write_clips(j);
    if (j.out.meshes.empty() && j.out.animations.empty()) {
        const std::string why = j.in.notes.empty() ? "" : " (" + line_of(j.in.notes[0]) + ")";
        fail("FBX", "the file has no polygons and no animations: there is nothing to convert" + why);
    }
    for (const note &n : j.in.notes) notes.push_back(line_of(n));
    return write_glb(j);
}

static int read(const char *path, const fbx_options &options, model **out, model_error *error)
{
    std::vector<std::string> notes;
    const std::string glb = convert(path, options, notes);
    if (model_read_glb(reinterpret_cast<const uint8_t *>(glb.data()), glb.size(), path, options.extras, out, error))
        return 1;
    for (const std::string &said : notes)
        if (model_warn(*out, "%s", said.c_str())) {
            model_free(*out);
            *out = nullptr;
            return model_fail_memory(error);
        }
    return 0;
}

} // namespace fbx

extern "C" int fbx_read(const char *path, const fbx_options *options, model **out, model_error *error)
{
    *out = nullptr;
    try {
        return fbx::read(path, *options, out, error);
    } catch (const fbx::failure &reason) {
        return model_fail(error, reason.where.c_str(), "%s", reason.what.c_str());
    } catch (const std::bad_alloc &) {
        return model_fail(error, "", "there is not enough memory to read this file");
    } catch (const std::exception &reason) {
        return model_fail(error, "FBX", "the file could not be read: %s", reason.what());
    }
}
