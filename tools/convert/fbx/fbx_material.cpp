/* fbx_material.cpp: materials and the pictures that they name, in the file or in its folder. */
#include "fbx_internal.h"

#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace fbx
{

/* --- pictures --- */

static std::string base_name(const std::string &path)
{
    const size_t slash = path.find_last_of("/\\");
    return slash == std::string::npos ? path : path.substr(slash + 1);
}

/* Paths are from the author's machine: the picture is looked up by its name, where exporters put it. */
static std::string beside(const job &j, const std::string &path)
{
    const std::filesystem::path file(j.path);
    const std::string name = base_name(path);
    std::string as_given = path;
    std::replace(as_given.begin(), as_given.end(), '\\', '/');
    std::error_code ignored;
    for (const std::string &try_at : { as_given, name, file.stem().string() + ".fbm/" + name, "textures/" + name,
                                       "Textures/" + name, "../textures/" + name, "../Textures/" + name }) {
        const bool local = !try_at.empty() && try_at[0] != '/' && try_at.find(':') == std::string::npos;
        if (local && std::filesystem::is_regular_file(file.parent_path() / try_at, ignored)) return try_at;
    }
    return std::string();
}

static std::string percent_encode(const std::string &path)
{
    static const char digits[] = "0123456789ABCDEF";
    std::string out;
    for (char c : path) {
        const unsigned char byte = static_cast<unsigned char>(c);
        const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                           strchr("-_.~/", c);
        if (plain && c)
            out += c;
        else
            (((out += '%') += digits[byte >> 4]) += digits[byte & 15]);
    }
    return out;
}

/* A picture that is stored in the file: encoded bytes, since its height is 0. */
static const aiTexture *embedded(const job &j, const char *path)
{
    const aiTexture *t = j.scene->GetEmbeddedTexture(path);
    return t && t->mHeight == 0 && t->mWidth > 0 ? t : nullptr;
}

static bool find_image(job &j, const char *path, tinygltf::Image &out)
{
    const aiTexture *inside = embedded(j, path);
    out.name = base_name(path);
    if (inside) {
        const unsigned char *bytes = reinterpret_cast<const unsigned char *>(inside->pcData);
        out.mimeType = inside->mWidth > 1 && bytes[0] == 0xff && bytes[1] == 0xd8 ? "image/jpeg" : "image/png";
        out.bufferView = add_view(j, bytes, inside->mWidth);
        return true;
    }
    const std::string at = beside(j, path);
    if (at.empty()) {
        note(j, "the picture '" + out.name + "' is neither in the file nor in its folder and was left out");
        return false;
    }
    out.uri = percent_encode(at);
    return true;
}

/* The texture of a kind, or -1. */
static int texture_of(job &j, const aiMaterial &m, aiTextureType kind)
{
    aiString path;
    tinygltf::Image image;
    if (m.GetTexture(kind, 0, &path) != AI_SUCCESS || !path.length) return -1;
    for (size_t i = 0; i < j.out.images.size(); ++i)
        if (j.out.images[i].extras.IsString() && j.out.images[i].extras.Get<std::string>() == path.C_Str())
            return static_cast<int>(i);
    if (!find_image(j, path.C_Str(), image)) return -1;
    image.extras = tinygltf::Value(std::string(path.C_Str()));
    tinygltf::Texture texture;
    texture.source = static_cast<int>(j.out.images.size());
    j.out.images.push_back(image);
    j.out.textures.push_back(texture);
    return static_cast<int>(j.out.textures.size() - 1);
}

static int texture_of_either(job &j, const aiMaterial &m, aiTextureType kind, aiTextureType other)
{
    const int found = texture_of(j, m, kind);
    return found >= 0 ? found : texture_of(j, m, other);
}

/* --- materials --- */

/* Colours are sRGB, as in modelling programs; glTF's are linear. */
static double linear(ai_real value)
{
    const double v = std::min(std::max(static_cast<double>(value), 0.0), 1.0);
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/* Phong's exponent as GGX's roughness: their lobes are equally wide (Walter et al. 2007: n = 2 / a^2 - 2, a = r^2). */
static double roughness_of(const aiMaterial &m)
{
    float value = 0.0f;
    if (m.Get(AI_MATKEY_ROUGHNESS_FACTOR, value) == AI_SUCCESS)
        return std::min(std::max(static_cast<double>(value), 0.0), 1.0);
    if (m.Get(AI_MATKEY_SHININESS, value) != AI_SUCCESS || !(value > 0.0f)) return 0.8;
    return std::min(std::pow(2.0 / (static_cast<double>(value) + 2.0), 0.25), 1.0);
}

static void read_colors(const aiMaterial &m, tinygltf::Material &out)
{
    aiColor3D color(1.0f, 1.0f, 1.0f);
    float opacity = 1.0f;
    const bool textured = out.pbrMetallicRoughness.baseColorTexture.index >= 0;
    if (textured || m.Get(AI_MATKEY_COLOR_DIFFUSE, color) != AI_SUCCESS) color = aiColor3D(1.0f, 1.0f, 1.0f);
    if (m.Get(AI_MATKEY_OPACITY, opacity) != AI_SUCCESS || !(opacity > 0.0f && opacity < 1.0f)) opacity = 1.0f;
    out.pbrMetallicRoughness.baseColorFactor = { linear(color.r), linear(color.g), linear(color.b),
                                                 static_cast<double>(opacity) };
    if (opacity < 1.0f) out.alphaMode = "BLEND";
    if (m.Get(AI_MATKEY_COLOR_EMISSIVE, color) == AI_SUCCESS && out.emissiveTexture.index < 0)
        out.emissiveFactor = { linear(color.r), linear(color.g), linear(color.b) };
    else if (out.emissiveTexture.index >= 0)
        out.emissiveFactor = { 1.0, 1.0, 1.0 };
}

static void read_material(job &j, const aiMaterial &m)
{
    tinygltf::Material out;
    aiString name;
    float metallic = 0.0f;
    if (m.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) out.name = name.C_Str();
    out.pbrMetallicRoughness.baseColorTexture.index = texture_of_either(j, m, aiTextureType_DIFFUSE,
                                                                        aiTextureType_BASE_COLOR);
    out.normalTexture.index = texture_of_either(j, m, aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA);
    out.emissiveTexture.index = texture_of(j, m, aiTextureType_EMISSIVE);
    if (m.GetTextureCount(aiTextureType_OPACITY)) { /* exporters name the colours' own picture: its alpha cuts */
        aiString colors, opacity;
        m.GetTexture(aiTextureType_DIFFUSE, 0, &colors);
        m.GetTexture(aiTextureType_OPACITY, 0, &opacity);
        if (colors == opacity)
            out.alphaMode = "MASK";
        else
            note(j, "separate opacity textures were left out");
    }
    read_colors(m, out);
    if (m.Get(AI_MATKEY_METALLIC_FACTOR, metallic) != AI_SUCCESS) metallic = 0.0f;
    out.pbrMetallicRoughness.metallicFactor = std::min(std::max(static_cast<double>(metallic), 0.0), 1.0);
    out.pbrMetallicRoughness.roughnessFactor = roughness_of(m);
    j.out.materials.push_back(out);
}

void read_materials(job &j)
{
    for (unsigned i = 0; i < j.scene->mNumMaterials; ++i) read_material(j, *j.scene->mMaterials[i]);
    for (tinygltf::Image &image : j.out.images) image.extras = tinygltf::Value();
}

} // namespace fbx
