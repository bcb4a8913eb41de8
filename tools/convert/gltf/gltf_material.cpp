/* gltf_material.cpp: materials, and the textures and images that they use. */
#include "gltf_internal.h"

#include <cstring>

#include "base/limits.h"

#include <stb/stb_image.h>

namespace gltf
{

static const uint64_t pixels_max = 64u << 20;

static std::string where_of(const file &f, size_t material)
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

/* glTF allows these two formats; stb_image's other decoders are kept from untrusted data. */
static bool is_png_or_jpeg(const bytes &data)
{
    static const uint8_t png[4] = { 0x89, 'P', 'N', 'G' }, jpeg[3] = { 0xff, 0xd8, 0xff };
    return data.size() > 8 && (memcmp(data.data(), png, 4) == 0 || memcmp(data.data(), jpeg, 3) == 0);
}

static void check_image_size(const bytes &data, const std::string &where)
{
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data.data(), static_cast<int>(data.size()), &width, &height, &channels) || width < 1 ||
        height < 1)
        fail(where, "the image data is damaged");
    if (static_cast<uint64_t>(width) * static_cast<uint64_t>(height) > pixels_max)
        fail(where, text("the image has %d x %d pixels; the limit is %llu", width, height,
                         static_cast<unsigned long long>(pixels_max)));
}

static void store_pixels(file &f, const tinygltf::Image &decoded, model_texture &out, const std::string &where)
{
    uint64_t channels = static_cast<uint64_t>(decoded.width) * static_cast<uint64_t>(decoded.height) * 4;
    bool wide = decoded.bits == 16;
    if (decoded.component != 4 || decoded.image.size() != channels * (wide ? 2 : 1))
        fail(where, "the image could not be decoded to RGBA");
    out.rgba = allocate<uint8_t>(f, channels, where);
    out.width = static_cast<uint32_t>(decoded.width);
    out.height = static_cast<uint32_t>(decoded.height);
    for (uint64_t i = 0; i < channels; ++i) {
        uint16_t value = 0;
        if (wide) memcpy(&value, &decoded.image[i * 2], sizeof value);
        out.rgba[i] = wide ? static_cast<uint8_t>((uint32_t{ value } * 255 + 32767) / 65535) : decoded.image[i];
    }
}

static void decode_image(file &f, const image &source, model_texture &out, const std::string &where)
{
    bytes data = encoded_image(f, source, where);
    if (!is_png_or_jpeg(data)) fail(where, "it is neither PNG nor JPEG");
    check_image_size(data, where);
    tinygltf::Image decoded;
    std::string error, warning;
    if (!tinygltf::LoadImageData(&decoded, 0, &error, &warning, 0, 0, data.data(), static_cast<int>(data.size()),
                                 nullptr))
        fail(where, "the image data is damaged");
    store_pixels(f, decoded, out, where);
}

/* --- textures --- */

static uint32_t wrap_of(file &f, int wrap, const std::string &where)
{
    bool known = wrap == TINYGLTF_TEXTURE_WRAP_REPEAT || wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE ||
                 wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    if (!known) leave_out(f, where, text(": the wrap mode %d is unknown and was taken as repeat", wrap));
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
        fail(where, text("sampler %d does not exist: the file has %zu", index, f.json.samplers.size()));
    if (index >= 0) sampler = f.json.samplers[static_cast<size_t>(index)];
    out.wrap_s = wrap_of(f, sampler.wrapS, where);
    out.wrap_t = wrap_of(f, sampler.wrapT, where);
    out.mag_filter = filter_of(f, sampler.magFilter, where);
    out.min_filter = filter_of(f, sampler.minFilter, where);
}

static void read_texture(file &f, size_t index, model_texture &out)
{
    const tinygltf::Texture &texture = f.json.textures[index];
    std::string where = text("texture %zu", index);
    if (texture.source < 0) fail(where, "it has no image that can be read");
    if (static_cast<size_t>(texture.source) >= f.images.size())
        fail(where, text("image %d does not exist: the file has %zu", texture.source, f.images.size()));
    const image &source = f.images[static_cast<size_t>(texture.source)];
    where += text(" image %d", texture.source);
    read_sampler(f, texture.sampler, out, where);
    decode_image(f, source, out, where);
    if (out.width > NOH_TEXTURE_SIZE_MAX || out.height > NOH_TEXTURE_SIZE_MAX)
        leave_out(f, where, text(": the image was halved until no side is above %u pixels", NOH_TEXTURE_SIZE_MAX));
    out.name = copy_string(name_or(texture.name.empty() ? source.name : texture.name, "texture", index));
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
    free(texture.rgba);
    texture = model_texture();
    --f.out->texture_count;
    return MODEL_NONE;
}

/* Only base colours are drawn, so only their textures are read, each one once. */
static uint32_t base_color_texture(file &f, const tinygltf::Material &m, const std::string &where)
{
    const uint32_t untried = MODEL_NONE - 1;
    int index = m.pbrMetallicRoughness.baseColorTexture.index;
    if (index < 0) return MODEL_NONE;
    if (static_cast<size_t>(index) >= f.json.textures.size())
        fail(where, text("texture %d does not exist: the file has %zu", index, f.json.textures.size()));
    if (f.texture_of.empty()) f.texture_of.assign(f.json.textures.size(), untried);
    uint32_t &slot = f.texture_of[static_cast<size_t>(index)];
    if (slot == untried) slot = try_texture(f, static_cast<size_t>(index), where);
    return slot;
}

/* --- materials --- */

static model_alpha alpha_of(file &f, const std::string &mode, const std::string &where)
{
    if (mode == "MASK") return MODEL_ALPHA_MASK;
    if (mode == "BLEND") return MODEL_ALPHA_BLEND;
    if (mode != "OPAQUE")
        leave_out(f, where, ": the alpha mode '" + printable(mode) + "' is unknown and was taken as OPAQUE");
    return MODEL_ALPHA_OPAQUE;
}

static void read_material(file &f, size_t index, model_material &out)
{
    const tinygltf::Material &m = f.json.materials[index];
    const tinygltf::PbrMetallicRoughness &pbr = m.pbrMetallicRoughness;
    std::string where = where_of(f, index);
    out.name = copy_string(name_or(m.name, "material", index));
    for (size_t i = 0; i < 4; ++i) out.base_color[i] = to_float(pbr.baseColorFactor[i], where + " baseColorFactor");
    out.metallic = to_float(pbr.metallicFactor, where + " metallicFactor");
    out.roughness = to_float(pbr.roughnessFactor, where + " roughnessFactor");
    out.alpha = alpha_of(f, m.alphaMode, where);
    out.alpha_cutoff = to_float(m.alphaCutoff, where + " alphaCutoff");
    out.double_sided = m.doubleSided;
    out.unlit = m.extensions.count("KHR_materials_unlit") != 0;
    out.base_color_texture = base_color_texture(f, m, where);
}

void read_materials(file &f)
{
    f.out->textures = allocate<model_texture>(f, f.json.textures.size(), "textures");
    f.out->materials = allocate<model_material>(f, f.json.materials.size(), "materials");
    for (size_t i = 0; i < f.json.materials.size(); ++i) {
        ++f.out->material_count;
        read_material(f, i, f.out->materials[i]);
    }
}

} // namespace gltf
