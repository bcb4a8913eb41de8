/* gltf_json.cpp: the JSON of a glTF file, checked before tinygltf sees it.
 *
 * tinygltf silently skips optional properties of the wrong type, cuts integers to 32 bits, and recurses through
 * `extras`; so types, ranges and depth are checked first. */
#include "gltf_internal.h"

#include <cmath>
#include <cstring>

#include "json_internal.h"

using nlohmann::json;

namespace gltf
{

static const size_t depth_max = 64;
static const uint64_t array_max = 1u << 20; /* elements of a top-level array */

/* Properties that are whole numbers, and their ranges. An optional index may be -1, which some exporters write for
 * "none". */
struct integer_rule {
    const char *key;
    int64_t minimum, maximum;
};
static const int64_t int_max = 0x7fffffff, offset_max = 0xffffffff;
static const integer_rule integer_rules[] = { { "buffer", 0, int_max },
                                              { "bufferView", -1, int_max },
                                              { "byteLength", 0, offset_max },
                                              { "byteOffset", 0, offset_max },
                                              { "byteStride", 0, int_max },
                                              { "children", 0, int_max },
                                              { "componentType", 0, int_max },
                                              { "count", 0, offset_max },
                                              { "index", 0, int_max },
                                              { "indices", -1, int_max },
                                              { "inverseBindMatrices", -1, int_max },
                                              { "skeleton", -1, int_max },
                                              { "input", 0, int_max },
                                              { "magFilter", 0, int_max },
                                              { "material", -1, int_max },
                                              { "mesh", -1, int_max },
                                              { "minFilter", 0, int_max },
                                              { "mode", 0, int_max },
                                              { "node", -1, int_max },
                                              { "output", 0, int_max },
                                              { "sampler", -1, int_max },
                                              { "scene", -1, int_max },
                                              { "skin", -1, int_max },
                                              { "source", -1, int_max },
                                              { "texCoord", 0, int_max },
                                              { "wrapS", 0, int_max },
                                              { "wrapT", 0, int_max } };

/* Extensions that are understood, or may be ignored if they are not required. */
static const char *const supported[] = { "KHR_mesh_quantization",  "EXT_meshopt_compression",
                                         "KHR_animation_pointer",  "EXT_mesh_gpu_instancing",
                                         "KHR_texture_transform",  "KHR_materials_unlit",
                                         "KHR_materials_specular", "KHR_materials_pbrSpecularGlossiness",
                                         "KHR_materials_ior",      "KHR_materials_emissive_strength",
                                         "EXT_texture_webp",       "VRMC_vrm",
                                         "VRMC_vrm_animation",     "VRMC_springBone",
                                         "VRMC_materials_mtoon",   "VRM",
                                         "KHR_node_visibility",    "VRMC_node_constraint" };

bool is_supported(const std::string &name)
{
    for (const char *known : supported)
        if (name == known) return true;
    return name == "KHR_draco_mesh_compression" && reads_draco();
}

bool uses_extension(const file &f, const char *name)
{
    for (const std::string &used : f.json.extensionsUsed)
        if (used == name) return true;
    for (const std::string &required : f.json.extensionsRequired)
        if (required == name) return true;
    return false;
}

static std::string not_supported(const std::string &extension)
{
    return "the extension " + printable(extension) + " is not supported and was ignored";
}

/* Limit the depth of brackets outside strings, so that no recursive code can exhaust the stack. */
static void check_depth(const char *text_begin, size_t size)
{
    size_t depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < size; ++i) {
        char c = text_begin[i];
        if (in_string) {
            if (c == '\\') ++i;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > depth_max)
                fail(text("JSON byte %zu", i), text("arrays and objects are nested deeper than %zu", depth_max));
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
}

static json parse_text(const char *text_begin, size_t size)
{
    check_depth(text_begin, size);
    try {
        json document = json::parse(text_begin, text_begin + size);
        if (document.is_object()) return document;
    } catch (const json::exception &error) {
        /* "[json.exception.parse_error.101] parse error at ...": the part in brackets means nothing to a user */
        const char *message = strstr(error.what(), "] ");
        fail("glTF JSON", text("the JSON is broken: %.180s", message ? message + 2 : error.what()));
    }
    fail("glTF JSON", "the JSON's outermost value must be an object");
}

static const integer_rule *rule_of(const std::string &key)
{
    for (const integer_rule &rule : integer_rules)
        if (key == rule.key) return &rule;
    return nullptr;
}

/* "": it is a whole number within the range, now of the type that tinygltf wants. */
static std::string fault_of_integer(json &value, const integer_rule &rule)
{
    if (value.is_number_float()) { /* 3.0 is a whole number to JSON, but not to tinygltf */
        double number = value.get<double>();
        if (number == std::floor(number) && std::fabs(number) <= 4294967295.0) value = static_cast<int64_t>(number);
    }
    if (!value.is_number_integer()) return text("'%s' must be a whole number", rule.key);
    bool huge = value.is_number_unsigned() && value.get<uint64_t>() > static_cast<uint64_t>(rule.maximum);
    int64_t number = huge ? 0 : value.get<int64_t>();
    if (huge || number < rule.minimum || number > rule.maximum)
        return text("'%s' is out of range (%lld to %lld)", rule.key, static_cast<long long>(rule.minimum),
                    static_cast<long long>(rule.maximum));
    if (!value.is_number_unsigned() && number >= 0) value = static_cast<uint64_t>(number);
    return "";
}

static void repair_value(file &f, json &value, const std::string &key, const std::string &path);

static bool holds_accessors(const std::string &key)
{
    return key == "attributes" || key == "targets";
}

/* Whether a member of an object stays. In "attributes" and "targets" every number is an accessor's index, whatever its
 * key. null: the member is not there. */
static bool repair_member(file &f, json &value, const std::string &key, const std::string &parent,
                          const std::string &path)
{
    static const integer_rule accessor_rule = { "attribute", 0, int_max };
    if (key == "extras" || (parent == "extensions" && key != "EXT_meshopt_compression"))
        return true; /* not defined by glTF */
    if (value.is_null()) return false;
    if (parent == "EXT_meshopt_compression" && key == "mode") return true; /* there it is a string */
    const integer_rule *rule = holds_accessors(parent) ? &accessor_rule : rule_of(key);
    const bool is_list = value.is_array() && key == "children"; /* its elements are the whole numbers */
    if (!rule || is_list) {
        repair_value(f, value, key, path + "/" + printable(key));
        return true;
    }
    if (value.is_object() && key == "indices" && parent == "sparse") {
        repair_value(f, value, key, path + "/" + printable(key));
        return true;
    }
    const std::string fault = fault_of_integer(value, *rule);
    if (!fault.empty())
        leave_out(f, "glTF JSON" + path + (holds_accessors(parent) ? "/" + printable(key) : ""),
                  ": " + fault + "; it was left out");
    return fault.empty();
}

/* Elements that are no nodes: a joint becomes the first one, which keeps the numbers of the others. */
static void repair_nodes(file &f, json &list, const std::string &key, const std::string &path)
{
    static const integer_rule node_rule = { "node", 0, int_max };
    for (size_t i = 0; i < list.size(); ++i) {
        const std::string fault = fault_of_integer(list[i], node_rule);
        if (fault.empty()) continue;
        leave_out(f, "glTF JSON" + path + "/" + std::to_string(i),
                  ": " + fault + (key == "joints" ? "; the skin's first joint was used" : "; it was left out"));
        if (key == "joints" && i > 0)
            list[i] = list[0];
        else if (key == "joints" && list.size() > 1 && fault_of_integer(list[1], node_rule).empty())
            list[i] = list[1];
        else
            list.erase(i--);
    }
}

static void repair_value(file &f, json &value, const std::string &key, const std::string &path)
{
    if (value.is_object()) {
        for (auto member = value.begin(); member != value.end();) {
            if (repair_member(f, member.value(), member.key(), key, path))
                ++member;
            else
                member = value.erase(member);
        }
    } else if (value.is_array() && !path.empty() && path.find('/', 1) != std::string::npos &&
               (key == "nodes" || key == "joints" || key == "children")) {
        repair_nodes(f, value, key, path);
    } else if (value.is_array()) {
        for (size_t i = 0; i < value.size(); ++i) repair_value(f, value[i], key, path + "/" + std::to_string(i));
    }
}

/* Top-level arrays must be arrays, and small enough for tinygltf's structs. */
static void repair_top_level(file &f, json &document)
{
    static const char *const arrays[] = { "accessors", "animations", "bufferViews",    "buffers",           "images",
                                          "materials", "meshes",     "nodes",          "samplers",          "scenes",
                                          "skins",     "textures",   "extensionsUsed", "extensionsRequired" };
    for (const char *name : arrays) {
        auto found = document.find(name);
        if (found == document.end()) continue;
        if (!found->is_array()) {
            if (!found->is_null()) leave_out(f, "glTF JSON", text(": '%s' must be an array; it was left out", name));
            document.erase(found);
        } else if (found->size() > array_max) {
            fail("glTF JSON", text("'%s' has %zu elements; the limit is %llu", name, found->size(),
                                   static_cast<unsigned long long>(array_max)));
        }
    }
}

static std::string string_member(const json &object, const char *key)
{
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/* glTF 1 has objects in place of arrays, and cannot be read. */
static void check_asset(file &f, const json &document)
{
    const auto asset = document.find("asset"), meshes = document.find("meshes"), nodes = document.find("nodes");
    const bool is_first = (meshes != document.end() && meshes->is_object() && !meshes->empty()) ||
                          (nodes != document.end() && nodes->is_object() && !nodes->empty());
    const bool has_asset = asset != document.end() && asset->is_object();
    const std::string version = has_asset ? string_member(*asset, "version") : "",
                      minimum = has_asset ? string_member(*asset, "minVersion") : "";
    if (is_first || version.compare(0, 2, "1.") == 0) fail("glTF JSON/asset", old_version(version));
    if (version.compare(0, 2, "2.") != 0)
        leave_out(f, "glTF JSON",
                  has_asset ? ": this is glTF version '" + printable(version) + "'; it was read as version 2"
                            : ": there is no 'asset' object; the file was read as glTF version 2");
    if (!minimum.empty() && minimum != "2.0")
        leave_out(f, "glTF JSON",
                  ": the file needs a reader of glTF version '" + printable(minimum) + "'; it was read as version 2.0");
}

/* Draco's positions are nowhere else; of other extensions only what they add is lost. */
static void check_required(file &f, const json &document)
{
    auto required = document.find("extensionsRequired");
    if (required == document.end()) return;
    for (const json &name : *required) {
        std::string extension = name.is_string() ? name.get<std::string>() : "?";
        if (is_supported(extension)) continue;
        const std::string needs = "the file needs the extension " + printable(extension) + ", which is not supported: ";
        if (extension == "KHR_draco_mesh_compression")
            fail("extensionsRequired", needs + "export it without Draco compression (EXT_meshopt_compression is read), "
                                               "or build noh with Draco (Debian: apt install libdraco-dev)");
        leave_out(f, "extensionsRequired",
                  ": " + needs + "what depends on it was left out" +
                      (extension == "KHR_texture_basisu" ? " (PNG, JPEG and WebP are read; KTX-Software's ktx extract "
                                                           "makes PNG of KTX2 textures)"
                                                         : ""));
    }
}

/* Move an array out of the document, so that tinygltf does not see it. */
static json take(json &document, const char *key)
{
    json taken = json::array();
    auto found = document.find(key);
    if (found != document.end()) {
        taken = std::move(*found);
        document.erase(found);
    }
    return taken;
}

static bool is_fallback(const json &object)
{
    auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object()) return false;
    auto meshopt = extensions->find("EXT_meshopt_compression");
    if (meshopt == extensions->end() || !meshopt->is_object()) return false;
    auto fallback = meshopt->find("fallback");
    return fallback != meshopt->end() && fallback->is_boolean() && fallback->get<bool>();
}

/* KHR_meshopt_compression is the ratified name of EXT_meshopt_compression. */
static void rename_meshopt(json &document)
{
    const char *const old = "EXT_meshopt_compression", *const ratified = "KHR_meshopt_compression";
    for (const char *name : { "extensionsUsed", "extensionsRequired", "buffers", "bufferViews" }) {
        auto list = document.find(name);
        if (list == document.end() || !list->is_array()) continue;
        for (json &item : *list) {
            /* json's own == ends the program where memory is refused */
            if (item.is_string() && item.get_ref<const std::string &>() == ratified) item = old;
            auto extensions = item.is_object() ? item.find("extensions") : item.end();
            if (extensions == item.end() || !extensions->is_object() || !extensions->contains(ratified)) continue;
            (*extensions)[old] = (*extensions)[ratified];
            extensions->erase(ratified);
        }
    }
}

static void take_buffers(file &f, json &document)
{
    json array = take(document, "buffers");
    for (size_t i = 0; i < array.size(); ++i) {
        const json &object = array[i];
        auto length = object.find("byteLength");
        buffer b;
        if (length == object.end())
            leave_out(f, text("buffer %zu", i), ": 'byteLength' is missing; all of its bytes were taken");
        else
            b.byte_length = length->get<uint64_t>();
        b.has_uri = object.contains("uri");
        b.uri = string_member(object, "uri");
        b.fallback = is_fallback(object);
        f.buffers.push_back(std::move(b));
    }
}

/* tinygltf 2.7 insists on inverseBindMatrices, which glTF lets a skin leave out. */
static void repair_skins(json &document)
{
    auto skins = document.find("skins");
    if (skins == document.end() || !skins->is_array()) return;
    for (json &skin : *skins)
        if (skin.is_object() && !skin.contains("inverseBindMatrices")) skin["inverseBindMatrices"] = -1;
}

static void take_images(file &f, json &document)
{
    json array = take(document, "images");
    for (const json &object : array) {
        image i;
        i.name = string_member(object, "name");
        i.uri = string_member(object, "uri");
        auto view = object.find("bufferView");
        i.view = view != object.end() ? view->get<int>() : -1;
        f.images.push_back(std::move(i));
    }
}

/* tinygltf refuses a file with indices that are in no accessor, or in one without data. */
static void repair_indices(file &f, json &document)
{
    const auto meshes = document.find("meshes"), accessors = document.find("accessors"),
               views = document.find("bufferViews");
    const size_t view_count = views != document.end() ? views->size() : 0;
    for (size_t m = 0; meshes != document.end() && m < meshes->size(); ++m) {
        json &primitives = (*meshes)[m]["primitives"];
        for (size_t i = 0; i < primitives.size(); ++i) {
            const auto found = primitives[i].find("indices");
            const size_t index = found != primitives[i].end() && found->is_number_unsigned() ? found->get<size_t>()
                                                                                             : SIZE_MAX;
            const bool is_there = accessors != document.end() && index < accessors->size();
            if (index == SIZE_MAX || primitives[i].contains("extensions") ||
                (is_there && (*accessors)[index].value("bufferView", SIZE_MAX) < view_count))
                continue;
            leave_out(f, text("glTF JSON/meshes/%zu/primitives/%zu", m, i),
                      text(is_there ? ": its indices (accessor %zu) have no data; it was left out"
                                    : ": accessor %zu does not exist; it was left out",
                           index));
            primitives.erase(i--);
        }
    }
}

/* A pack has no cameras: only their names are of use. */
static void take_cameras(file &f, json &document)
{
    const json array = take(document, "cameras");
    for (size_t i = 0; array.is_array() && i < array.size(); ++i)
        f.cameras.push_back(printable(name_or(string_member(array[i], "name"), "camera", i)));
}

/* A channel without a target node is legal, but tinygltf calls it an error: -1 says "none". */
static void mark_untargeted_channels(json &document)
{
    auto animations = document.find("animations");
    if (animations == document.end()) return;
    for (json &animation : *animations) {
        auto channels = animation.find("channels");
        if (channels == animation.end() || !channels->is_array()) continue;
        for (json &channel : *channels) {
            if (!channel.is_object() || !channel.contains("target") || !channel["target"].is_object()) continue;
            if (!channel["target"].contains("node")) channel["target"]["node"] = -1;
        }
    }
}

/* tinygltf wants a buffer view for indices, also for those that Draco holds: gltf_draco.cpp gives them another. */
static void repair_draco_indices(json &document)
{
    auto meshes = document.find("meshes");
    auto accessors = document.find("accessors");
    auto views = document.find("bufferViews");
    if (meshes == document.end() || accessors == document.end() || views == document.end() || views->empty()) return;
    for (json &mesh : *meshes) {
        auto primitives = mesh.find("primitives");
        for (size_t i = 0; primitives != mesh.end() && primitives->is_array() && i < primitives->size(); ++i) {
            const json &primitive = (*primitives)[i];
            if (!primitive.is_object() || !primitive.contains("extensions") || !primitive.contains("indices")) continue;
            const json &indices = primitive["indices"];
            if (!primitive["extensions"].contains("KHR_draco_mesh_compression") || !indices.is_number_unsigned() ||
                indices.get<uint64_t>() >= accessors->size())
                continue;
            json &accessor = (*accessors)[indices.get<size_t>()];
            if (!accessor.contains("bufferView")) accessor["bufferView"] = 0;
        }
    }
}

/* Note every extension of an object that is not read, with the object's name. */
static void find_extensions(file &f, const json &value, const std::string &where)
{
    for (auto member = value.begin(); member != value.end(); ++member) {
        if (!member->is_structured() || (value.is_object() && member.key() == "extras")) continue;
        if (value.is_object() && member.key() == "extensions" && member->is_object()) {
            for (auto extension = member->begin(); extension != member->end(); ++extension)
                if (!is_supported(extension.key())) leave_out(f, where, ": " + not_supported(extension.key()));
            continue; /* the contents of an extension are not searched */
        }
        find_extensions(f, *member, where);
    }
}

static const char *const named_arrays[][2] = { { "materials", "material" },
                                               { "meshes", "mesh" },
                                               { "nodes", "node" },
                                               { "textures", "texture" },
                                               { "images", "image" },
                                               { "samplers", "sampler" },
                                               { "scenes", "scene" },
                                               { "animations", "animation" },
                                               { "skins", "skin" },
                                               { "accessors", "accessor" },
                                               { "bufferViews", "buffer view" },
                                               { "buffers", "buffer" } };

/* After repair_top_level: these are arrays. The document's own "extensions" (such as lists of lights) are used by
 * the objects searched here; an extension that no object has is noted without a name. */
static void find_unsupported(file &f, const json &document)
{
    for (const auto &array : named_arrays) {
        auto found = document.find(array[0]);
        for (size_t i = 0; found != document.end() && i < found->size(); ++i) {
            std::string name = printable(string_member((*found)[i], "name"));
            find_extensions(f, (*found)[i],
                            name.empty() ? text("%s %zu", array[1], i) : array[1] + (" '" + name + "'"));
        }
    }
    auto used = document.find("extensionsUsed");
    for (size_t i = 0; used != document.end() && used->is_array() && i < used->size(); ++i) {
        std::string name = (*used)[i].is_string() ? (*used)[i].get<std::string>() : "";
        if (!name.empty() && !is_supported(name) && f.loss_of.count(": " + not_supported(name)) == 0)
            leave_out(f, "", not_supported(name));
    }
}

/* tinygltf's message, without its line ends. */
static std::string first_line(const std::string &message)
{
    return message.substr(0, message.find('\n'));
}

static void run_tinygltf(file &f, const json &document)
{
    std::string text_form = document.dump(), error, warning;
    tinygltf::TinyGLTF loader;
    bool loaded = loader.LoadASCIIFromString(&f.json, &error, &warning, text_form.data(),
                                             static_cast<unsigned int>(text_form.size()), "");
    /* It also reports primitives and channels that it could not read, and continues. */
    if (!loaded || !error.empty()) fail("glTF JSON", error.empty() ? "the JSON is not a glTF file" : first_line(error));
}

void parse_json(file &f, const char *text_begin, size_t size)
{
    json document = parse_text(text_begin, size);
    check_asset(f, document);
    document["asset"] = { { "version", "2.0" } };
    repair_top_level(f, document);
    rename_meshopt(document);
    check_required(f, document);
    repair_value(f, document, "", "");
    repair_members(f, document);
    repair_lists(f, document);
    repair_indices(f, document);
    take_cameras(f, document);
    find_unsupported(f, document);
    take_buffers(f, document);
    take_images(f, document);
    repair_skins(document);
    mark_untargeted_channels(document);
    repair_draco_indices(document);
    run_tinygltf(f, document);
    f.decoded_views.resize(f.json.bufferViews.size());
}

} // namespace gltf
