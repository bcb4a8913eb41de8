/* gltf_members.cpp: members of objects in a glTF file, and their types. tinygltf skips some that are wrong without a
 * word, and refuses the file because of others. Here each is a warning: an optional member is left out, and an object
 * without a required one becomes one that nothing can use, which keeps the numbers of the others. */
#include "json_internal.h"

#include "gltf_internal.h"

#include <cmath>

#include "noh/base.h"

using nlohmann::json;

namespace gltf
{

enum kind { NUMBER, NUMBERS, FLAG, TEXT, ARRAY, OBJECT };

/* `path` leads from an element of a top-level array to objects: "" is the element, a step each element of an array or
 * the object of that name, '*' every member. count: of NUMBERS; 0: any. */
struct member_rule {
    const char *array, *path, *key;
    kind what;
    size_t count;
};

/* Members that an object can do without. Before the members of a member, the member itself. How many numbers a
 * node's have is checked where they are read (gltf_scene.cpp). */
static const member_rule optional_members[] = {
    { "accessors", "", "normalized", FLAG, 0 },
    { "accessors", "", "min", NUMBERS, 0 },
    { "accessors", "", "max", NUMBERS, 0 },
    { "animations", "samplers", "interpolation", TEXT, 0 },
    { "buffers", "", "uri", TEXT, 0 },
    { "images", "", "uri", TEXT, 0 },
    { "images", "", "mimeType", TEXT, 0 },
    { "materials", "", "pbrMetallicRoughness", OBJECT, 0 },
    { "materials", "", "normalTexture", OBJECT, 0 },
    { "materials", "", "occlusionTexture", OBJECT, 0 },
    { "materials", "", "emissiveTexture", OBJECT, 0 },
    { "materials", "", "emissiveFactor", NUMBERS, 3 },
    { "materials", "", "alphaMode", TEXT, 0 },
    { "materials", "", "alphaCutoff", NUMBER, 0 },
    { "materials", "", "doubleSided", FLAG, 0 },
    { "materials", "normalTexture", "scale", NUMBER, 0 },
    { "materials", "occlusionTexture", "strength", NUMBER, 0 },
    { "materials", "pbrMetallicRoughness", "baseColorTexture", OBJECT, 0 },
    { "materials", "pbrMetallicRoughness", "metallicRoughnessTexture", OBJECT, 0 },
    { "materials", "pbrMetallicRoughness", "baseColorFactor", NUMBERS, 4 },
    { "materials", "pbrMetallicRoughness", "metallicFactor", NUMBER, 0 },
    { "materials", "pbrMetallicRoughness", "roughnessFactor", NUMBER, 0 },
    { "materials", "extensions", "KHR_materials_ior", OBJECT, 0 },
    { "materials", "extensions", "KHR_materials_specular", OBJECT, 0 },
    { "materials", "extensions", "KHR_materials_emissive_strength", OBJECT, 0 },
    { "materials", "extensions", "KHR_materials_pbrSpecularGlossiness", OBJECT, 0 },
    { "materials", "extensions/KHR_materials_ior", "ior", NUMBER, 0 },
    { "materials", "extensions/KHR_materials_emissive_strength", "emissiveStrength", NUMBER, 0 },
    { "materials", "extensions/KHR_materials_specular", "specularFactor", NUMBER, 0 },
    { "materials", "extensions/KHR_materials_specular", "specularColorFactor", NUMBERS, 3 },
    { "materials", "extensions/KHR_materials_pbrSpecularGlossiness", "diffuseFactor", NUMBERS, 4 },
    { "materials", "extensions/KHR_materials_pbrSpecularGlossiness", "specularFactor", NUMBERS, 3 },
    { "materials", "extensions/KHR_materials_pbrSpecularGlossiness", "glossinessFactor", NUMBER, 0 },
    { "materials", "*/extensions/KHR_texture_transform", "offset", NUMBERS, 2 },
    { "materials", "*/extensions/KHR_texture_transform", "scale", NUMBERS, 2 },
    { "materials", "*/extensions/KHR_texture_transform", "rotation", NUMBER, 0 },
    { "materials", "*/*/extensions/KHR_texture_transform", "offset", NUMBERS, 2 },
    { "materials", "*/*/extensions/KHR_texture_transform", "scale", NUMBERS, 2 },
    { "materials", "*/*/extensions/KHR_texture_transform", "rotation", NUMBER, 0 },
    { "meshes", "", "weights", NUMBERS, 0 },
    { "meshes", "", "extras", OBJECT, 0 },
    { "meshes", "extras", "targetNames", ARRAY, 0 },
    { "meshes", "primitives", "targets", ARRAY, 0 },
    { "nodes", "", "matrix", NUMBERS, 0 },
    { "nodes", "", "translation", NUMBERS, 0 },
    { "nodes", "", "rotation", NUMBERS, 0 },
    { "nodes", "", "scale", NUMBERS, 0 },
    { "nodes", "", "weights", NUMBERS, 0 },
    { "nodes", "", "children", ARRAY, 0 },
    { "scenes", "", "nodes", ARRAY, 0 },
};

/* Members without which an object is none: a number of its path, as below. */
static const member_rule required_members[] = {
    { "accessors", "", "componentType", NUMBER, 0 },
    { "accessors", "", "count", NUMBER, 0 },
    { "accessors", "", "type", TEXT, 0 },
    { "accessors", "sparse", "count", NUMBER, 0 },
    { "accessors", "sparse", "indices", OBJECT, 0 },
    { "accessors", "sparse", "values", OBJECT, 0 },
    { "accessors", "sparse/indices", "bufferView", NUMBER, 0 },
    { "accessors", "sparse/indices", "componentType", NUMBER, 0 },
    { "accessors", "sparse/values", "bufferView", NUMBER, 0 },
    { "animations", "", "channels", ARRAY, 0 },
    { "animations", "", "samplers", ARRAY, 0 },
    { "animations/channels", "", "sampler", NUMBER, 0 },
    { "animations/channels", "", "target", OBJECT, 0 },
    { "animations/channels", "target", "path", TEXT, 0 },
    { "animations/samplers", "", "input", NUMBER, 0 },
    { "animations/samplers", "", "output", NUMBER, 0 },
    { "bufferViews", "", "buffer", NUMBER, 0 },
    { "bufferViews", "", "byteLength", NUMBER, 0 },
    { "meshes", "", "primitives", ARRAY, 0 },
    { "meshes/primitives", "", "attributes", OBJECT, 0 },
    { "skins", "", "joints", ARRAY, 0 },
};

/* Lists of objects, and what stands for one that is damaged: NULL: it is taken out. No reader takes a MAT2, and nothing
 * has the number 2147483647. */
static const struct {
    const char *list, *stand_in;
} lists[] = {
    { "accessors", "{\"componentType\":5126,\"count\":1,\"type\":\"MAT2\"}" },
    { "bufferViews", "{\"buffer\":2147483647,\"byteLength\":0}" },
    { "meshes", "{\"primitives\":[]}" },
    { "meshes/primitives", NULL },
    { "skins", "{\"joints\":[]}" },
    { "animations", "{\"channels\":[],\"samplers\":[]}" },
    { "animations/channels", NULL },
    { "animations/samplers", "{\"input\":2147483647,\"output\":2147483647}" },
    { "buffers", "{}" },
    { "images", "{}" },
    { "materials", "{}" },
    { "nodes", "{}" },
    { "samplers", "{}" },
    { "scenes", "{}" },
    { "textures", "{}" },
};

/* Objects that name a texture. */
static const char *const texture_paths[][2] = { { "", "normalTexture" },
                                                { "", "occlusionTexture" },
                                                { "", "emissiveTexture" },
                                                { "pbrMetallicRoughness", "baseColorTexture" },
                                                { "pbrMetallicRoughness", "metallicRoughnessTexture" } };

/* --- types --- */

static bool is_number(const json &value)
{
    return value.is_number() && std::fabs(value.get<double>()) <= static_cast<double>(NOH_NUMBER_MAX);
}

static bool are_numbers(const json &value, size_t count)
{
    if (!value.is_array() || (count && value.size() != count)) return false;
    for (const json &number : value)
        if (!is_number(number)) return false;
    return true;
}

static bool is_a(const json &value, kind what, size_t count)
{
    switch (what) {
    case NUMBER: return is_number(value);
    case NUMBERS: return are_numbers(value, count);
    case FLAG: return value.is_boolean();
    case TEXT: return value.is_string();
    case ARRAY: return value.is_array();
    default: return value.is_object();
    }
}

static std::string type_of(const member_rule &rule)
{
    static const char *const names[] = {
        "a number up to 1e12", "numbers up to 1e12", "true or false", "a text", "an array", "an object"
    };
    return rule.what == NUMBERS && rule.count ? text("%zu numbers up to 1e12", rule.count)
                                              : std::string(names[rule.what]);
}

/* --- paths --- */

/* Each object at the end of a path. */
template <typename action> static void each(json &value, const std::string &path, const std::string &where, action act)
{
    if (value.is_array()) {
        for (size_t i = 0; i < value.size(); ++i) each(value[i], path, where + "/" + std::to_string(i), act);
        return;
    }
    if (!value.is_object()) return;
    if (path.empty()) {
        act(value, where);
        return;
    }
    const size_t slash = path.find('/');
    const std::string step = path.substr(0, slash), rest = slash == std::string::npos ? "" : path.substr(slash + 1);
    for (auto member = value.begin(); member != value.end(); ++member)
        if ((step == "*" && member->is_object()) || member.key() == step)
            each(*member, rest, where + "/" + printable(member.key()), act);
}

template <typename action> static void each_in(json &document, const char *array, const std::string &path, action act)
{
    const auto found = document.find(array);
    if (found != document.end()) each(*found, path, std::string("glTF JSON/") + array, act);
}

/* --- optional members --- */

static void check_optional(file &f, json &object, const member_rule &rule, const std::string &where)
{
    const auto found = object.find(rule.key);
    if (found == object.end() || is_a(*found, rule.what, rule.count)) return;
    leave_out(f, where, text(": '%s' must be %s; it was left out", rule.key, type_of(rule).c_str()));
    object.erase(found);
}

static void check_names(file &f, json &object, const std::string &where)
{
    static const member_rule rules[] = { { "", "", "name", TEXT, 0 }, { "", "", "extensions", OBJECT, 0 } };
    for (const member_rule &rule : rules) check_optional(f, object, rule, where);
}

/* Names of targets that are no texts: the others keep their places. */
static void check_target_names(file &f, json &document)
{
    each_in(document, "meshes", "extras", [&](json &object, const std::string &where) {
        const auto found = object.find("targetNames");
        for (size_t i = 0; found != object.end() && i < found->size(); ++i) {
            if ((*found)[i].is_string()) continue;
            leave_out(f, where + "/targetNames/" + std::to_string(i), ": a name must be a text; it was left out");
            (*found)[i] = "";
        }
    });
}

static void check_textures(file &f, json &document)
{
    for (const auto &path : texture_paths)
        each_in(document, "materials", path[0], [&](json &object, const std::string &where) {
            const auto found = object.find(path[1]);
            if (found == object.end() || found->contains("index")) return;
            leave_out(f, where, text(": '%s' has no 'index'; it was left out", path[1]));
            object.erase(found);
        });
}

/* --- required members --- */

/* What is wrong with an element of a list; "": nothing. */
static std::string fault_of(json &element, const std::string &list)
{
    std::string fault;
    if (!element.is_object()) return "this must be an object";
    for (const member_rule &rule : required_members) {
        if (list != rule.array) continue;
        each(element, rule.path, "", [&](json &object, const std::string &where) {
            const auto found = object.find(rule.key);
            if (!fault.empty() || (found != object.end() && is_a(*found, rule.what, 0))) return;
            fault = text("'%s' %s", (where.empty() ? rule.key : where.substr(1) + "/" + rule.key).c_str(),
                         found == object.end() ? "is missing" : ("must be " + type_of(rule)).c_str());
        });
    }
    return fault;
}

static std::string fault_of_type(const json &accessor)
{
    static const char *const types[] = { "SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4" };
    const std::string given = accessor["type"].get<std::string>();
    for (const char *type : types)
        if (given == type) return "";
    return "the type '" + printable(given) + "' must be SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4";
}

static std::string fault_of_stride(const json &view)
{
    const auto found = view.find("byteStride");
    const uint64_t stride = found == view.end() || !found->is_number_unsigned() ? 0 : found->get<uint64_t>();
    if (stride == 0 || (stride >= 4 && stride <= 252 && stride % 4 == 0)) return "";
    return text("'byteStride' is %llu: it must be a multiple of 4 from 4 to 252",
                static_cast<unsigned long long>(stride));
}

static void check_list(file &f, json &array, const std::string &list, const char *stand_in, const std::string &where)
{
    for (size_t i = 0; i < array.size(); ++i) {
        std::string fault = fault_of(array[i], list);
        if (fault.empty() && list == "accessors") fault = fault_of_type(array[i]);
        if (fault.empty() && list == "bufferViews") fault = fault_of_stride(array[i]);
        if (fault.empty()) continue;
        leave_out(f, where + "/" + std::to_string(i), ": " + fault + "; it was left out");
        if (stand_in)
            array[i] = json::parse(stand_in);
        else
            array.erase(i--);
    }
}

void repair_lists(file &f, json &document)
{
    for (const auto &row : lists) {
        const std::string list = row.list, outer = list.substr(0, list.find('/'));
        if (outer == list) {
            const auto found = document.find(list);
            if (found != document.end()) check_list(f, *found, list, row.stand_in, "glTF JSON/" + list);
            continue;
        }
        const std::string inner = list.substr(outer.size() + 1);
        each_in(document, outer.c_str(), "", [&](json &object, const std::string &where) {
            const auto found = object.find(inner);
            if (found != object.end() && found->is_array())
                check_list(f, *found, list, row.stand_in, where + "/" + inner);
        });
    }
}

void repair_members(file &f, json &document)
{
    for (const auto &row : lists) {
        const std::string list = row.list, outer = list.substr(0, list.find('/'));
        each_in(document, outer.c_str(), outer == list ? "" : list.substr(outer.size() + 1),
                [&](json &object, const std::string &where) { check_names(f, object, where); });
    }
    for (const member_rule &rule : optional_members)
        each_in(document, rule.array, rule.path,
                [&](json &object, const std::string &where) { check_optional(f, object, rule, where); });
    check_target_names(f, document);
    check_textures(f, document);
}

} // namespace gltf
