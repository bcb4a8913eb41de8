/* gltf_material.cpp: materials, and the textures and images that they use. */
#include "gltf_internal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include "noh/base.h"
#include "noh/format.h"
#include "convert/base/image_file.h"
#include "convert/model/surface_kind.h"

namespace gltf
{

static const int SPECULAR_KEY = -1, MATCAP_KEY = -2, MASKS_KEY = -3; /* in file.texture_of, in place of a use */

static std::string material_where(const file &f, size_t material)
{
    return "material '" + printable(name_or(f.json.materials[material].name, "material", material)) + "'";
}

/* --- images --- */

static bytes encoded_image(file &f, const image &source, const std::string &where)
{
    if (source.view >= 0) {
        span s = view_bytes(f, source.view, where);
        return bytes(s.data, s.data + s.size);
    }
    if (source.uri.empty()) fail(where, "it has neither a 'uri' nor a 'bufferView'");
    return read_uri(f, source.uri, where);
}

/* Charges the pixels of damaged images as well, and an image once for each texture that has it. */
static void decode_image(file &f, const image &source, model_texture &out, const std::string &where)
{
    const bytes data = encoded_image(f, source, where);
    const uint64_t before = uncharged(f) / 4;
    uint64_t pixels_left = before;
    image_file decoded;
    model_error error = { "", "" };
    const int failed = image_decode(data.data(), data.size(), &pixels_left, &decoded, &error);
    f.output_bytes += (before - pixels_left) * 4;
    if (failed) fail(where, error.what);
    out.rgba = decoded.rgba;
    out.width = decoded.width;
    out.height = decoded.height;
    if (decoded.has_no_end) warn(f, "%s: %s", where.c_str(), error.what);
}

/* --- textures --- */

static uint32_t wrap_of(file &f, int wrap, const std::string &where)
{
    bool known = wrap == TINYGLTF_TEXTURE_WRAP_REPEAT || wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE ||
                 wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    if (!known) leave_out(f, where, text(": the wrap mode %d is unknown; repeat was used", wrap));
    return static_cast<uint32_t>(known ? wrap : TINYGLTF_TEXTURE_WRAP_REPEAT);
}

static uint32_t filter_of(file &f, int filter, const std::string &where)
{
    bool known = filter == -1 || filter == TINYGLTF_TEXTURE_FILTER_NEAREST ||
                 filter == TINYGLTF_TEXTURE_FILTER_LINEAR ||
                 (filter >= TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST &&
                  filter <= TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR);
    if (!known) leave_out(f, where, text(": the filter %d is unknown and was ignored", filter));
    return known && filter != -1 ? static_cast<uint32_t>(filter) : 0;
}

static void read_sampler(file &f, int index, model_texture &out, const std::string &where)
{
    tinygltf::Sampler sampler; /* with glTF's defaults */
    if (index >= 0 && static_cast<size_t>(index) >= f.json.samplers.size())
        leave_out(f, where, ": its sampler does not exist; glTF's default was used");
    else if (index >= 0)
        sampler = f.json.samplers[static_cast<size_t>(index)];
    out.wrap_s = wrap_of(f, sampler.wrapS, where);
    out.wrap_t = wrap_of(f, sampler.wrapT, where);
    out.mag_filter = filter_of(f, sampler.magFilter, where);
    out.min_filter = filter_of(f, sampler.minFilter, where);
}

/* The image of a texture: the one that every reader understands, or else the image of EXT_texture_webp. */
static size_t image_of(const file &f, const tinygltf::Texture &texture, const std::string &where)
{
    int index = texture.source;
    const auto webp = texture.extensions.find("EXT_texture_webp");
    if (index < 0 && webp != texture.extensions.end() && webp->second.Has("source") &&
        webp->second.Get("source").IsInt())
        index = webp->second.Get("source").Get<int>();
    if (index < 0 && texture.extensions.count("KHR_texture_basisu"))
        fail(where, "its only image uses KHR_texture_basisu (KTX2), which is not supported: export PNG, JPEG or WebP, "
                    "or convert it to PNG with ktx extract of KTX-Software");
    for (const auto &other : texture.extensions)
        if (index < 0 && other.second.Has("source") && other.second.Get("source").IsInt())
            index = other.second.Get("source").Get<int>(); /* what is not read says so */
    if (index < 0) fail(where, "it has no image that can be read");
    if (static_cast<size_t>(index) >= f.images.size())
        fail(where, text("image %d does not exist: the file has %zu", index, f.images.size()));
    return static_cast<size_t>(index);
}

static void read_texture(file &f, size_t index, model_texture &out)
{
    std::string where = text("texture %zu", index);
    if (index >= f.json.textures.size())
        fail(where, text("it does not exist: the file has %zu", f.json.textures.size()));
    const tinygltf::Texture &texture = f.json.textures[index];
    const size_t place = image_of(f, texture, where);
    const image &source = f.images[place];
    where += text(" image %zu", place);
    read_sampler(f, texture.sampler, out, where);
    decode_image(f, source, out, where);
    if (out.width > NOH_TEXTURE_SIZE_MAX || out.height > NOH_TEXTURE_SIZE_MAX)
        leave_out(f, where, text(": the image was halved until no side is above %u pixels", NOH_TEXTURE_SIZE_MAX));
    out.name = copy_string(name_or(texture.name.empty() ? source.name : texture.name, "texture", index));
}

static void drop_last_texture(file &f)
{
    model_texture &texture = f.out->textures[--f.out->texture_count];
    free(texture.name);
    free(texture.rgba);
    texture = model_texture();
}

/* A material works without its texture, so a bad image is a warning. */
static uint32_t try_texture(file &f, size_t index, const std::string &material)
{
    model_texture &texture = f.out->textures[f.out->texture_count++]; /* counted first: see read_meshes */
    try {
        read_texture(f, index, texture);
        return f.out->texture_count - 1;
    } catch (const failure &reason) {
        warn(f, "%s: %s (%s); the texture was left out", material.c_str(), reason.what.c_str(), reason.where.c_str());
    }
    drop_last_texture(f);
    return MODEL_NONE;
}

/* A texture for one use, read once: an image of colours that is data as well is there twice. */
static uint32_t texture_for(file &f, int index, model_texture_use use, const std::string &where)
{
    if (index < 0) return MODEL_NONE;
    const std::array<int, 4> key = { static_cast<int>(use), index, -1, -1 };
    auto found = f.texture_of.find(key);
    if (found != f.texture_of.end()) return found->second;
    const uint32_t slot = try_texture(f, static_cast<size_t>(index), where);
    if (slot != MODEL_NONE) f.out->textures[slot].use = use;
    return f.texture_of[key] = slot;
}

/* --- maps of several images: occlusion in red, roughness in green, metallic in blue, the weight of reflections in
 * alpha; and colours of reflections with such a weight, or roughness, in alpha --- */

static uint8_t between(const uint8_t *rgba, size_t stride, uint32_t x0, uint32_t x1, uint32_t y0, uint32_t y1,
                       uint64_t fx, uint64_t fy)
{
    const uint64_t top = rgba[y0 * stride + x0 * 4] * (256 - fx) + rgba[y0 * stride + x1 * 4] * fx;
    const uint64_t bottom = rgba[y1 * stride + x0 * 4] * (256 - fx) + rgba[y1 * stride + x1 * 4] * fx;
    return static_cast<uint8_t>((top * (256 - fy) + bottom * fy + 32768) / 65536);
}

/* The centre of texel i of `to` among the texels of `from`: its two neighbours, and 256ths from the first. */
static uint64_t place(uint32_t i, uint32_t from, uint32_t to, uint32_t *low, uint32_t *high)
{
    const int64_t at = (static_cast<int64_t>(2 * i + 1) * from * 256 / to - 256) / 2;
    const int64_t held = at < 0 ? 0 : at;
    *low = static_cast<uint32_t>(held / 256);
    if (*low >= from) *low = from - 1;
    *high = *low + 1 < from ? *low + 1 : *low;
    return static_cast<uint64_t>(held % 256);
}

/* A channel of `from`, bilinear, into the same one of `to`: of red 0, of alpha 3. */
static void put_channel(const model_texture &from, model_texture &to, size_t channel)
{
    for (uint32_t y = 0; y < to.height; ++y) {
        uint32_t y0, y1, x0, x1;
        const uint64_t fy = place(y, from.height, to.height, &y0, &y1);
        for (uint32_t x = 0; x < to.width; ++x) {
            const uint64_t fx = place(x, from.width, to.width, &x0, &x1);
            to.rgba[(size_t{ y } * to.width + x) * 4 + channel] = between(from.rgba + channel, size_t{ from.width } * 4,
                                                                          x0, x1, y0, y1, fx, fy);
        }
    }
}

static void fill_channel(model_texture &t, size_t channel, uint8_t byte = 255)
{
    const size_t count = size_t{ t.width } * t.height;
    for (size_t i = 0; i < count; ++i) t.rgba[i * 4 + channel] = byte;
}

/* Put a channel of another image into a map. */
static void add_channel(file &f, uint32_t slot, int index, size_t channel, const std::string &where)
{
    const uint32_t other = index < 0 ? MODEL_NONE : try_texture(f, static_cast<size_t>(index), where);
    if (other == MODEL_NONE) return;
    put_channel(f.out->textures[other], f.out->textures[slot], channel);
    drop_last_texture(f);
}

/* Images become one, so that a pixel reads one texture: added images take its size and sampling. */
static uint32_t make_surface_texture(file &f, int occlusion, int roughness, int weight, const std::string &where)
{
    int first = roughness;
    uint32_t slot = MODEL_NONE;
    for (int index : { roughness, occlusion, weight }) {
        if (slot != MODEL_NONE || index < 0) continue;
        slot = try_texture(f, static_cast<size_t>(index), where);
        first = index;
    }
    if (slot == MODEL_NONE) return slot;
    model_texture &map = f.out->textures[slot];
    if (first != roughness) fill_channel(map, 1), fill_channel(map, 2);
    if (first != occlusion) fill_channel(map, 0);
    if (first != weight) fill_channel(map, 3);
    if (first != occlusion) add_channel(f, slot, occlusion, 0, where);
    if (first != weight) add_channel(f, slot, weight, 3, where);
    map.use = MODEL_TEXTURE_DATA;
    return slot;
}

static uint32_t surface_texture(file &f, int occlusion, int roughness, int weight, const std::string &where)
{
    if (occlusion < 0 && roughness < 0 && weight < 0) return MODEL_NONE;
    const std::array<int, 4> key = { static_cast<int>(MODEL_TEXTURE_DATA), occlusion, roughness, weight };
    auto found = f.texture_of.find(key);
    if (found != f.texture_of.end()) return found->second;
    return f.texture_of[key] = make_surface_texture(f, occlusion, roughness, weight, where);
}

/* The colour of reflections with their weight in alpha. */
static uint32_t specular_texture(file &f, int color, int weight, const std::string &where)
{
    const std::array<int, 4> key = { SPECULAR_KEY, color, weight, -1 };
    auto found = f.texture_of.find(key);
    if (found != f.texture_of.end()) return found->second;
    const uint32_t slot = try_texture(f, static_cast<size_t>(color), where);
    if (slot == MODEL_NONE) return f.texture_of[key] = slot;
    model_texture &map = f.out->textures[slot];
    if (color != weight) fill_channel(map, 3);
    if (color != weight) add_channel(f, slot, weight, 3, where);
    map.with_alpha = weight >= 0; /* where nothing reflects, colours do not count */
    return f.texture_of[key] = slot;
}

/* --- materials --- */

static model_alpha alpha_of(file &f, const std::string &mode, const std::string &where)
{
    if (mode == "MASK") return MODEL_ALPHA_MASK;
    if (mode == "BLEND") return MODEL_ALPHA_BLEND;
    if (mode != "OPAQUE") leave_out(f, where, ": the alpha mode '" + printable(mode) + "' is unknown; OPAQUE was used");
    return MODEL_ALPHA_OPAQUE;
}

/* --- which texture coordinates --- */

static void read_pair(const tinygltf::Value &object, const char *key, double *out)
{
    const tinygltf::Value &pair = object.Get(key);
    for (int i = 0; pair.IsArray() && pair.ArrayLen() == 2 && i < 2; ++i)
        if (pair.Get(i).IsNumber()) out[i] = pair.Get(i).GetNumberAsDouble();
}

static uv_use uv_use_of(int set, const tinygltf::ExtensionMap &extensions)
{
    uv_use use;
    use.set = set;
    auto found = extensions.find("KHR_texture_transform");
    if (found == extensions.end() || !found->second.IsObject()) return use;
    const tinygltf::Value &transform = found->second;
    read_pair(transform, "offset", use.offset);
    read_pair(transform, "scale", use.scale);
    if (transform.Get("rotation").IsNumber()) use.rotation = transform.Get("rotation").GetNumberAsDouble();
    if (transform.Get("texCoord").IsInt()) use.set = transform.Get("texCoord").Get<int>();
    return use;
}

/* A texture of a material, and its field in the model. */
struct texture_use {
    int index;
    uv_use uv;
    const char *name;
};

static const tinygltf::Value *extension_of(const tinygltf::Material &m, const char *name)
{
    auto found = m.extensions.find(name);
    return found == m.extensions.end() || !found->second.IsObject() ? nullptr : &found->second;
}

static const char gloss_name[] = "KHR_materials_pbrSpecularGlossiness";

/* A texture that an extension names. */
static tinygltf::TextureInfo texture_in(const tinygltf::Value &extension, const char *key)
{
    tinygltf::TextureInfo info;
    const tinygltf::Value &texture = extension.Get(key);
    if (!texture.IsObject()) return info;
    if (texture.Get("index").IsInt()) info.index = texture.Get("index").Get<int>();
    if (texture.Get("texCoord").IsInt()) info.texCoord = texture.Get("texCoord").Get<int>();
    const tinygltf::Value &more = texture.Get("extensions");
    for (const std::string &name : more.IsObject() ? more.Keys() : std::vector<std::string>())
        info.extensions[name] = more.Get(name);
    return info;
}

static std::array<texture_use, 7> textures_of(const tinygltf::Material &m)
{
    const tinygltf::Value *gloss = extension_of(m, gloss_name);
    const tinygltf::TextureInfo base = gloss ? texture_in(*gloss, "diffuseTexture")
                                             : m.pbrMetallicRoughness.baseColorTexture;
    const tinygltf::TextureInfo roughness = gloss ? texture_in(*gloss, "specularGlossinessTexture")
                                                  : m.pbrMetallicRoughness.metallicRoughnessTexture;
    const tinygltf::Value *specular = gloss ? nullptr : extension_of(m, "KHR_materials_specular");
    const tinygltf::TextureInfo weight = specular ? texture_in(*specular, "specularTexture") : tinygltf::TextureInfo();
    const tinygltf::TextureInfo color = specular ? texture_in(*specular, "specularColorTexture")
                                                 : tinygltf::TextureInfo();
    return { { { base.index, uv_use_of(base.texCoord, base.extensions), "base colour" },
               { m.normalTexture.index, uv_use_of(m.normalTexture.texCoord, m.normalTexture.extensions), "normal" },
               { roughness.index, uv_use_of(roughness.texCoord, roughness.extensions),
                 gloss ? "specular-glossiness" : "metallic-roughness" },
               { m.occlusionTexture.index, uv_use_of(m.occlusionTexture.texCoord, m.occlusionTexture.extensions),
                 "occlusion" },
               { m.emissiveTexture.index, uv_use_of(m.emissiveTexture.texCoord, m.emissiveTexture.extensions),
                 "emissive" },
               { weight.index, uv_use_of(weight.texCoord, weight.extensions), "specular" },
               { color.index, uv_use_of(color.texCoord, color.extensions), "specular colour" } } };
}

uv_use uv_use_of(const tinygltf::Material &m)
{
    for (const texture_use &t : textures_of(m))
        if (t.index >= 0) return t.uv;
    return uv_use();
}

static bool same_use(const uv_use &a, const uv_use &b)
{
    return a.set == b.set && a.offset[0] == b.offset[0] && a.offset[1] == b.offset[1] && a.scale[0] == b.scale[0] &&
           a.scale[1] == b.scale[1] && a.rotation == b.rotation;
}

/* A vertex has one pair of texture coordinates, for the first texture. Textures that use others are left out. */
static int index_of(file &f, const tinygltf::Material &m, size_t which, const std::string &where)
{
    const texture_use t = textures_of(m)[which];
    if (t.index < 0 || same_use(t.uv, uv_use_of(m))) return t.index;
    leave_out(
        f, where,
        text(": the %s texture was left out: its texture coordinates or their transform differ from the material's "
             "other textures",
             t.name));
    return -1;
}

/* --- extensions of materials --- */

static double number_in(const tinygltf::Value *object, const char *key, double otherwise)
{
    return object && object->Get(key).IsNumber() ? object->Get(key).GetNumberAsDouble() : otherwise;
}

/* KHR_materials_ior and KHR_materials_specular: what reflects straight on, and at grazing angles. */
static void read_f0(const tinygltf::Material &m, model_material &out, const std::string &where)
{
    const tinygltf::Value *specular = extension_of(m, "KHR_materials_specular");
    const double ior = number_in(extension_of(m, "KHR_materials_ior"), "ior", 1.5);
    const double straight = ior >= 1.0 ? (ior - 1.0) / (ior + 1.0) : 1.0; /* ior 0: all is reflected */
    const double factor = number_in(specular, "specularFactor", 1.0);
    const double weight = factor < 0.0 ? 0.0 : factor > 1.0 ? 1.0 : factor;
    const bool has_map = specular && specular->Has("specularColorTexture");
    for (size_t i = 0; i < 3; ++i) {
        double color = 1.0;
        if (specular) {
            const tinygltf::Value &list = specular->Get("specularColorFactor");
            if (list.IsArray() && list.ArrayLen() == 3 && list.Get(static_cast<int>(i)).IsNumber())
                color = list.Get(static_cast<int>(i)).GetNumberAsDouble();
        }
        const double f0 = straight * straight * weight * color;
        out.f0[i] = to_float(f0 < 0.0 ? 0.0 : f0 > weight && !has_map ? weight : f0, where + " KHR_materials_specular");
    }
    out.f90_loss = static_cast<float>(1.0 - weight);
}

/* KHR_materials_pbrSpecularGlossiness: diffuse and specular colours, and a glossiness that is 1 where roughness is 0.
 * The specular colour is what reflects straight on. */

static double factor_in(const tinygltf::Value &extension, const char *key, size_t i)
{
    const tinygltf::Value &list = extension.Get(key);
    const int at = static_cast<int>(i);
    return list.IsArray() && list.ArrayLen() > i && list.Get(at).IsNumber() ? list.Get(at).GetNumberAsDouble() : 1.0;
}

static double light_of(uint8_t byte)
{
    const double s = static_cast<double>(byte) / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

/* Whether all texels have one colour, so that it needs no map. */
static bool has_one_color(const model_texture &t)
{
    for (size_t i = 1; i < size_t{ t.width } * t.height; ++i)
        if (memcmp(t.rgba, t.rgba + i * 4, 3) != 0) return false;
    return true;
}

static void set_roughness(model_texture &t, size_t channel, double gloss)
{
    for (size_t i = 0; i < size_t{ t.width } * t.height; ++i) {
        uint8_t *texel = t.rgba + i * 4;
        texel[channel] = static_cast<uint8_t>(255.0 - gloss * texel[3] + 0.5);
    }
}

/* Its colours become a map with roughness in alpha, one texture as before. An occlusion map is another one, which may
 * as well have the roughness where all colours are the same. */
static void read_gloss_map(file &f, int index, int occlusion, double gloss, model_material &out,
                           const std::string &where)
{
    const uint32_t slot = try_texture(f, static_cast<size_t>(index), where);
    if (slot == MODEL_NONE) {
        out.surface_texture = surface_texture(f, occlusion, -1, -1, where);
        return;
    }
    model_texture &t = f.out->textures[slot];
    out.roughness = 1.0f;
    if (has_one_color(t)) {
        for (size_t c = 0; c < 3; ++c) out.f0[c] *= static_cast<float>(light_of(t.rgba[c]));
        t.use = MODEL_TEXTURE_DATA;
        set_roughness(t, 1, gloss);
        for (size_t c : { 0, 2, 3 }) fill_channel(t, c);
        add_channel(f, slot, occlusion, 0, where);
        out.surface_texture = slot;
        return;
    }
    set_roughness(t, 3, gloss);
    t.alpha_is_data = 1;
    out.specular_texture = slot;
    out.specular_roughness = 1;
    out.surface_texture = surface_texture(f, occlusion, -1, -1, where);
}

/* A factor of 0 to 1: others, which light would be more than there is, become the nearer end. */
static float share_of(file &f, double value, const std::string &where, const char *name)
{
    const float given = to_float(value, where + " " + name), share = std::min(std::max(given, 0.0f), 1.0f);
    if (std::fabs(given - share) > 1e-4f) leave_out(f, where, text(": its %s of %g became %g", name, value, share));
    return share;
}

static void read_gloss(file &f, const tinygltf::Value &e, model_material &out, const std::string &where)
{
    const double gloss = number_in(&e, "glossinessFactor", 1.0);
    for (size_t i = 0; i < 4; ++i)
        out.base_color[i] = share_of(f, factor_in(e, "diffuseFactor", i), where, "diffuseFactor");
    for (size_t i = 0; i < 3; ++i) {
        const double f0 = factor_in(e, "specularFactor", i);
        out.f0[i] = to_float(f0 < 0.0 ? 0.0 : f0 > 1.0 ? 1.0 : f0, where + " specularFactor");
    }
    out.metallic = 0.0f;
    out.roughness = to_float(gloss < 0.0 ? 1.0 : gloss > 1.0 ? 0.0 : 1.0 - gloss, where + " glossinessFactor");
}

static void read_emissive(const tinygltf::Material &m, model_material &out, const std::string &where)
{
    const double strength = number_in(extension_of(m, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0);
    for (size_t i = 0; i < 3; ++i)
        out.emissive[i] = to_float(std::max(m.emissiveFactor[i] * strength, 0.0), where + " emissiveFactor");
}

/* --- materials --- */

/* By "extras": {"surface": "skin", "unitMm": 10}, else by name. */
static toon_maps read_surface(file &f, size_t index, model_material &out, const std::string &where)
{
    const tinygltf::Material &m = f.json.materials[index];
    const char *name = m.name.c_str();
    uint32_t kind = surface_is_of_vroid(name) ? NOH_SURFACE_TOON : surface_kind_by_name(name, out.alpha);
    if (m.extras.IsObject() && m.extras.Has("surface")) {
        const tinygltf::Value &word = m.extras.Get("surface");
        const uint32_t named = word.IsString() ? surface_kind_named(word.Get<std::string>().c_str()) : MODEL_NONE;
        if (named == MODEL_NONE)
            leave_out(f, where, ": the extra 'surface' must be plain, skin, eye, teeth, hair or toon, and was ignored");
        else
            kind = named;
        out.surface_given = named != MODEL_NONE;
    }
    const bool is_named = m.extras.IsObject() && m.extras.Has("surface");
    const toon_maps toon = is_named && kind != NOH_SURFACE_TOON ? toon_maps() : read_toon(f, index, where, out);
    surface_kind_set(&out, toon.given ? NOH_SURFACE_TOON : kind);
    if (out.surface != NOH_SURFACE_SKIN || !m.extras.IsObject() || !m.extras.Has("unitMm")) return toon;
    const double mm = number_in(&m.extras, "unitMm", 0.0);
    if (mm >= 1e-6 && mm <= 1e9)
        out.surface_values[0] = static_cast<float>(mm);
    else
        leave_out(f, where, ": the extra 'unitMm' must be 1e-6 to 1e9 millimetres, and was ignored");
    return toon;
}

/* The light that a matcap adds; none if all of it is black. A factor is put into the texture. */
static uint32_t matcap_texture(file &f, const toon_maps &toon, const std::string &where)
{
    double gain[3];
    for (int c = 0; c < 3; ++c) gain[c] = std::pow(toon.matcap_factor[c], 1.0 / 2.2); /* of bytes, not of light */
    const std::array<int, 4> key = { MATCAP_KEY, toon.matcap, static_cast<int>(255.0 * gain[0] + 0.5),
                                     static_cast<int>(255.0 * gain[1] + 0.5) * 256 +
                                         static_cast<int>(255.0 * gain[2] + 0.5) };
    if (toon.matcap < 0) return MODEL_NONE;
    auto found = f.texture_of.find(key);
    if (found != f.texture_of.end()) return found->second;
    uint32_t slot = try_texture(f, static_cast<size_t>(toon.matcap), where);
    if (slot == MODEL_NONE) return f.texture_of[key] = slot;
    model_texture &t = f.out->textures[slot];
    uint32_t brightest = 0;
    for (size_t i = 0; i < size_t{ t.width } * t.height * 4; ++i) {
        if (i % 4 == 3) continue;
        t.rgba[i] = static_cast<uint8_t>(t.rgba[i] * gain[i % 4] + 0.5);
        if (t.rgba[i] > brightest) brightest = t.rgba[i];
    }
    t.use = MODEL_TEXTURE_COLOR;
    if (brightest < 2u) drop_last_texture(f), slot = MODEL_NONE;
    return f.texture_of[key] = slot;
}

/* Masks of a toon: how far the edge moves, in red, the outline's width, in green, and the light of the rim, in blue. A
 * channel that changes nothing has this byte. */
static const uint8_t no_mask[3] = { 128, 255, 255 };

static double mask_of(const uint8_t *rgba, size_t channel, double scale)
{
    const double shift = std::min(std::max(scale * rgba[0] / 255.0, -1.0), 1.0);
    if (channel == 0) return 128.0 + 127.0 * shift;
    if (channel == 1) return rgba[1];
    return 255.0 * (0.2126 * light_of(rgba[0]) + 0.7152 * light_of(rgba[1]) + 0.0722 * light_of(rgba[2]));
}

/* Put the mask that an image is into its channel. Returns whether it changes anything. */
static bool make_mask(file &f, model_texture &t, size_t channel, double scale, const std::string &where)
{
    bool counts = false, has_hue = false;
    for (size_t i = 0; i < size_t{ t.width } * t.height; ++i) {
        uint8_t *rgba = t.rgba + i * 4;
        has_hue |= channel == 2 && std::abs(rgba[0] - rgba[1]) + std::abs(rgba[1] - rgba[2]) > 64;
        rgba[channel] = static_cast<uint8_t>(mask_of(rgba, channel, scale) + 0.5);
        counts |= rgba[channel] != no_mask[channel];
    }
    if (has_hue) leave_out(f, where, ": the hue of rimMultiplyTexture of its MToon shading was left out");
    return counts;
}

static uint32_t make_masks(file &f, const int images[3], double scale, const std::string &where)
{
    uint32_t slot = MODEL_NONE;
    for (size_t c = 0; c < 3; ++c) {
        const uint32_t own = images[c] < 0 ? MODEL_NONE : try_texture(f, static_cast<size_t>(images[c]), where);
        if (own == MODEL_NONE) continue;
        const bool counts = make_mask(f, f.out->textures[own], c, scale, where);
        if (counts && slot == MODEL_NONE) {
            slot = own;
            for (size_t other = 0; other < 3; ++other)
                if (other != c) fill_channel(f.out->textures[slot], other, no_mask[other]);
            fill_channel(f.out->textures[slot], 3);
            f.out->textures[slot].use = MODEL_TEXTURE_DATA;
            continue;
        }
        if (counts) put_channel(f.out->textures[own], f.out->textures[slot], c);
        drop_last_texture(f);
    }
    return slot;
}

/* Whether pixels need it; vertices read the width. */
static bool is_for_pixels(const model_texture &masks)
{
    for (size_t i = 0; i < size_t{ masks.width } * masks.height * 4; i += 4)
        if (masks.rgba[i] != no_mask[0] || masks.rgba[i + 2] != no_mask[2]) return true;
    return false;
}

/* Images of masks become one texture, which takes the size and sampling of the first. */
static void read_masks(file &f, const toon_maps &toon, model_material &out, const std::string &where)
{
    const bool has_rim = out.surface_more[1] > 0.0f || out.more_textures[NOH_TOON_MATCAP] != MODEL_NONE;
    const int images[3] = { toon.shift_scale == 0.0 ? -1 : toon.shift, out.surface_more[4] == 0.0f ? -1 : toon.width,
                            has_rim ? toon.rim : -1 };
    uint32_t &slot = out.more_textures[NOH_TOON_WIDTH];
    if (images[0] < 0 && images[2] < 0) {
        slot = texture_for(f, images[1], MODEL_TEXTURE_DATA, where);
        return;
    }
    const int scale = static_cast<int>(std::lround(toon.shift_scale * 1000.0)); /* within 100 either way */
    const std::array<int, 4> key = { MASKS_KEY - 100000 - scale, images[0], images[1], images[2] };
    auto found = f.texture_of.find(key);
    slot = found != f.texture_of.end() ? found->second
                                       : f.texture_of[key] = make_masks(f, images, toon.shift_scale, where);
    out.toon_masks = slot != MODEL_NONE && is_for_pixels(f.out->textures[slot]);
}

static void read_toon_maps(file &f, const toon_maps &toon, model_material &out, const std::string &where)
{
    out.more_textures[NOH_TOON_SHADE] = texture_for(f, toon.shade, MODEL_TEXTURE_COLOR, where);
    out.more_textures[NOH_TOON_MATCAP] = matcap_texture(f, toon, where);
    read_masks(f, toon, out, where);
}

/* By "extras": {"tint": false}. */
static void read_tint(file &f, const tinygltf::Material &m, model_material &out, const std::string &where)
{
    if (!m.extras.IsObject() || !m.extras.Has("tint")) return;
    const tinygltf::Value &taken = m.extras.Get("tint");
    if (taken.IsBool())
        out.tint = taken.Get<bool>() ? MODEL_TINT_ON : MODEL_TINT_OFF;
    else
        leave_out(f, where, ": the extra 'tint' must be true or false, and was ignored");
}

/* A weight alone goes into the surface map; with colours it goes to these: a fetch less either way. */
static void read_specular_maps(file &f, const tinygltf::Material &m, int occlusion, int roughness, model_material &out,
                               const std::string &where)
{
    const int weight = index_of(f, m, 5, where), color = index_of(f, m, 6, where);
    if (color >= 0) out.specular_texture = specular_texture(f, color, weight, where);
    const bool is_alone = out.specular_texture == MODEL_NONE;
    out.surface_texture = surface_texture(f, occlusion, roughness, is_alone ? weight : -1, where);
}

/* By "extras": {"priority": 1}, or VRM's order of what blends. */
static void read_priority(file &f, const tinygltf::Material &m, const toon_maps &toon, model_material &out,
                          const std::string &where)
{
    if (out.alpha == MODEL_ALPHA_BLEND) out.priority = static_cast<int16_t>(toon.priority);
    if (!m.extras.IsObject() || !m.extras.Has("priority")) return;
    const tinygltf::Value &value = m.extras.Get("priority");
    const double number = value.IsNumber() ? value.GetNumberAsDouble() : 1000.0;
    if (number >= -128.0 && number <= 127.0 && number == static_cast<double>(static_cast<int>(number)))
        out.priority = static_cast<int16_t>(number);
    else
        leave_out(f, where, ": the extra 'priority' must be a whole number from -128 to 127, and was ignored");
}

static void read_maps(file &f, const tinygltf::Material &m, const toon_maps &toon, model_material &out,
                      const std::string &where)
{
    out.base_color_texture = texture_for(f, index_of(f, m, 0, where), MODEL_TEXTURE_COLOR, where);
    if (out.base_color_texture != MODEL_NONE && out.alpha != MODEL_ALPHA_OPAQUE) {
        model_texture &texture = f.out->textures[out.base_color_texture];
        texture.with_alpha = 1;
        if (out.alpha == MODEL_ALPHA_MASK) texture.alpha_cutoff = out.alpha_cutoff;
    }
    if (out.unlit) return;
    out.normal_texture = texture_for(f, index_of(f, m, 1, where), MODEL_TEXTURE_NORMAL, where);
    const int roughness = index_of(f, m, 2, where), occlusion = index_of(f, m, 3, where);
    if (toon.given)
        read_toon_maps(f, toon, out, where);
    else if (roughness >= 0 && extension_of(m, gloss_name))
        read_gloss_map(f, roughness, occlusion, 1.0 - static_cast<double>(out.roughness), out, where);
    else
        read_specular_maps(f, m, occlusion, roughness, out, where);
    if (out.emissive[0] > 0.0f || out.emissive[1] > 0.0f || out.emissive[2] > 0.0f)
        out.emissive_texture = texture_for(f, index_of(f, m, 4, where), MODEL_TEXTURE_COLOR, where);
}

static void read_material(file &f, size_t index, model_material &out)
{
    const tinygltf::Material &m = f.json.materials[index];
    const tinygltf::PbrMetallicRoughness &pbr = m.pbrMetallicRoughness;
    std::string where = material_where(f, index);
    out = model_material_default();
    out.name = copy_string(name_or(m.name, "material", index));
    for (size_t i = 0; i < 4; ++i) out.base_color[i] = share_of(f, pbr.baseColorFactor[i], where, "baseColorFactor");
    out.metallic = share_of(f, pbr.metallicFactor, where, "metallicFactor");
    out.roughness = share_of(f, pbr.roughnessFactor, where, "roughnessFactor");
    out.alpha = alpha_of(f, m.alphaMode, where);
    out.alpha_cutoff = to_float(m.alphaCutoff, where + " alphaCutoff");
    out.normal_scale = to_float(m.normalTexture.scale, where + " normalTexture scale");
    out.occlusion_strength = share_of(f, m.occlusionTexture.strength, where, "occlusionTexture strength");
    out.double_sided = m.doubleSided;
    out.unlit = m.extensions.count("KHR_materials_unlit") != 0;
    read_emissive(m, out, where);
    read_f0(m, out, where);
    if (const tinygltf::Value *gloss = extension_of(m, gloss_name)) read_gloss(f, *gloss, out, where);
    const toon_maps toon = read_surface(f, index, out, where);
    read_tint(f, m, out, where);
    read_priority(f, m, toon, out, where);
    read_maps(f, m, toon, out, where);
}

void read_materials(file &f)
{
    /* each texture as colours, normals and data; a surface and a specular map, or a matcap and masks, a material, and an
     * image that is put into one */
    f.out->textures = allocate<model_texture>(f, f.json.textures.size() * 3 + f.json.materials.size() * 2 + 1,
                                              "textures");
    f.out->materials = allocate<model_material>(f, f.json.materials.size(), "materials");
    for (size_t i = 0; i < f.json.materials.size(); ++i) {
        ++f.out->material_count;
        read_material(f, i, f.out->materials[i]);
    }
}

} // namespace gltf
