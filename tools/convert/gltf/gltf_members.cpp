/* gltf_members.cpp: required members of objects in a glTF file, and their allowed values. tinygltf would reject the
 * file too, but without the place. */
#include "json_internal.h"

#include "gltf_internal.h"

using nlohmann::json;

namespace gltf
{

enum kind { NUMBER, TEXT, ARRAY, OBJECT };

/* `path` leads from an element of a top-level array to objects: "" is the element, a step each element of an array or
 * the object of that name. */
static const struct {
    const char *array, *path, *key;
    kind what;
} required[] = {
    { "accessors", "", "componentType", NUMBER },
    { "accessors", "", "count", NUMBER },
    { "accessors", "", "type", TEXT },
    { "accessors", "sparse", "count", NUMBER },
    { "accessors", "sparse", "indices", OBJECT },
    { "accessors", "sparse", "values", OBJECT },
    { "accessors", "sparse/indices", "bufferView", NUMBER },
    { "accessors", "sparse/indices", "componentType", NUMBER },
    { "accessors", "sparse/values", "bufferView", NUMBER },
    { "animations", "", "channels", ARRAY },
    { "animations", "", "samplers", ARRAY },
    { "animations", "channels", "sampler", NUMBER },
    { "animations", "channels", "target", OBJECT },
    { "animations", "channels/target", "path", TEXT },
    { "animations", "samplers", "input", NUMBER },
    { "animations", "samplers", "output", NUMBER },
    { "bufferViews", "", "buffer", NUMBER },
    { "bufferViews", "", "byteLength", NUMBER },
    { "cameras", "", "type", TEXT },
    { "meshes", "", "primitives", ARRAY },
    { "meshes", "primitives", "attributes", OBJECT },
    { "skins", "", "joints", ARRAY },
};

static bool is_a(const json &value, kind what)
{
    switch (what) {
    case NUMBER: return value.is_number();
    case TEXT: return value.is_string();
    case ARRAY: return value.is_array();
    default: return value.is_object();
    }
}

static const char *name_of(kind what)
{
    static const char *const names[] = { "a number", "a text", "an array", "an object" };
    return names[what];
}

static void check_object(const json &object, const char *key, kind what, const std::string &where)
{
    const auto found = object.find(key);
    if (found == object.end()) fail(where, text("'%s' is missing", key));
    if (!is_a(*found, what)) fail(where, text("'%s' must be %s", key, name_of(what)));
}

/* Follow the rest of the path. A missing member is checked by the row that requires it, if any. */
static void follow(const json &value, const std::string &path, const char *key, kind what, const std::string &where)
{
    if (value.is_array()) {
        for (size_t i = 0; i < value.size(); ++i) follow(value[i], path, key, what, where + "/" + std::to_string(i));
        return;
    }
    if (!value.is_object()) fail(where, "this must be an object");
    if (path.empty()) {
        check_object(value, key, what, where);
        return;
    }
    const size_t slash = path.find('/');
    const std::string step = path.substr(0, slash);
    const auto found = value.find(step);
    if (found != value.end() && found->is_structured())
        follow(*found, slash == std::string::npos ? "" : path.substr(slash + 1), key, what, where + "/" + step);
}

static void check_accessor_type(const json &accessor, const std::string &where)
{
    static const char *const types[] = { "SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4" };
    const std::string given = accessor["type"].get<std::string>();
    for (const char *type : types)
        if (given == type) return;
    fail(where, "the type '" + printable(given) + "' must be SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
}

static void check_stride(const json &view, const std::string &where)
{
    const auto found = view.find("byteStride");
    if (found == view.end()) return;
    const uint64_t stride = found->get<uint64_t>();
    if (stride != 0 && (stride < 4 || stride > 252 || stride % 4 != 0))
        fail(where, text("'byteStride' is %llu: it must be a multiple of 4 from 4 to 252",
                         static_cast<unsigned long long>(stride)));
}

static void check_each(const json &document, const char *array, void (*check)(const json &, const std::string &))
{
    const auto found = document.find(array);
    for (size_t i = 0; found != document.end() && i < found->size(); ++i)
        check((*found)[i], text("glTF JSON/%s/%zu", array, i));
}

void check_members(const json &document)
{
    for (const auto &row : required) {
        const auto found = document.find(row.array);
        if (found != document.end()) follow(*found, row.path, row.key, row.what, std::string("glTF JSON/") + row.array);
    }
    check_each(document, "accessors", check_accessor_type);
    check_each(document, "bufferViews", check_stride);
}

} // namespace gltf
