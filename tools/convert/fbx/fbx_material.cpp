/* fbx_material.cpp: materials: Lambert and Phong, and physical ones of 3ds Max and Maya, whose properties have a path
 * before their name ("3dsMax|main|base_color_map"). */
#include "fbx_internal.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace fbx
{

/* --- names of properties --- */

/* "3dsMax|main|base_color_map" and "Maya|baseColor" as "basecolormap" and "basecolor"; others as they are. */
static std::string plain_property(const std::string &name)
{
    const size_t bar = name.rfind('|');
    std::string out;
    if (bar == std::string::npos) return name;
    for (size_t i = bar + 1; i < name.size(); ++i)
        if (name[i] != '_') out += static_cast<char>(tolower(static_cast<unsigned char>(name[i])));
    return out;
}

struct source {
    const scene &s;
    size_t object;
    std::map<std::string, const std::vector<value> *> physical; /* by plain name */

    source(const scene &given, size_t material) : s(given), object(material)
    {
        for (const auto &p : s.objects[material].own)
            if (p.first.find('|') != std::string::npos && !p.second.empty())
                physical.insert({ plain_property(p.first), &p.second });
    }
    /* The first of these that there is; physical ones are in lower case. */
    const std::vector<value> *find(std::initializer_list<const char *> names) const
    {
        for (const char *name : names) {
            const auto found = physical.find(name);
            if (found != physical.end()) return found->second;
            const std::vector<value> *plain = isupper(static_cast<unsigned char>(name[0])) ? s.property(object, name)
                                                                                           : nullptr;
            if (plain) return plain;
        }
        return nullptr;
    }
    double real(std::initializer_list<const char *> names, double otherwise) const
    {
        const std::vector<value> *found = find(names);
        return found ? number_of((*found)[0], otherwise) : otherwise;
    }
    vec color(std::initializer_list<const char *> names, double otherwise) const
    {
        const std::vector<value> *found = find(names);
        vec out = { { otherwise, otherwise, otherwise } };
        for (size_t k = 0; found && k < 3 && k < found->size(); ++k)
            out[static_cast<int>(k)] = number_of((*found)[k], otherwise);
        return out;
    }
};

static double share(double value)
{
    return std::min(std::max(value, 0.0), 1.0);
}

/* Colours are sRGB, as in modelling programs; glTF's are linear. */
static double linear(double value)
{
    const double v = share(value);
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/* --- textures --- */

enum use { USE_COLOR, USE_NORMAL, USE_EMISSIVE, USE_OPACITY, USE_COUNT };

static bool use_of(const std::string &property, use *out)
{
    static const std::map<std::string, use> known = {
        { "DiffuseColor", USE_COLOR },
        { "basecolormap", USE_COLOR },
        { "basecolor", USE_COLOR },
        { "texcolormap", USE_COLOR },
        { "colormap", USE_COLOR },
        { "NormalMap", USE_NORMAL },
        { "normmap", USE_NORMAL },
        { "normalmap", USE_NORMAL },
        { "texnormalmap", USE_NORMAL },
        { "normalcamera", USE_NORMAL },
        { "EmissiveColor", USE_EMISSIVE },
        { "emitcolormap", USE_EMISSIVE },
        { "texemissivemap", USE_EMISSIVE },
        { "emissivemap", USE_EMISSIVE },
        { "emissioncolor", USE_EMISSIVE },
        { "emissioncolormap", USE_EMISSIVE },
        { "TransparentColor", USE_OPACITY },
        { "opacitymap", USE_OPACITY },
        { "TransparencyFactor", USE_OPACITY },
        { "opacity", USE_OPACITY },
    };
    const auto found = known.find(plain_property(property));
    if (found == known.end()) return false;
    *out = found->second;
    return true;
}

/* uses: [USE_COUNT] texture objects, or none */
static void find_textures(job &j, size_t material, size_t *uses)
{
    std::fill_n(uses, static_cast<size_t>(USE_COUNT), none);
    for (const link &l : j.in.objects[material].below) {
        const std::string &kind = j.in.objects[l.other].kind;
        use u;
        if ((kind != "Texture" && kind != "LayeredTexture") || l.property == "AmbientColor") continue;
        if (use_of(l.property, &u)) {
            if (uses[u] == none) uses[u] = l.other;
            continue;
        }
        j.in.warn(place_of(j.in, material) + " " + l.property, ": a picture of this kind is not read and was left out");
    }
}

static bool same_picture(const scene &s, size_t a, size_t b)
{
    return a == b || (a != none && b != none && picture_path(s, a) == picture_path(s, b));
}

/* --- one material --- */

/* Exporters disagree about what a transparent colour of 0 means; the product is 0 in all that are opaque. */
static double opacity_of(const source &m)
{
    const vec color = m.color({ "TransparentColor" }, 0.0);
    const auto own = m.s.objects[m.object].own.find("Opacity");
    double out = 1.0 - m.real({ "TransparencyFactor" }, 0.0) * (color[0] + color[1] + color[2]) / 3.0;
    if (own != m.s.objects[m.object].own.end() && !own->second.empty()) out = number_of(own->second[0], 1.0);
    if (m.find({ "opacity" })) out = m.color({ "opacity" }, 1.0)[0];
    return out > 0.0 && out < 1.0 ? out : 1.0;
}

static bool is_blender(const scene &s)
{
    const node *header = s.file.top.child("FBXHeaderExtension"), *creator = s.file.top.child("Creator");
    if (!creator && header) creator = header->child("Creator");
    return creator && creator->text(0).find("Blender") != std::string::npos;
}

/* Phong's exponent as GGX's roughness: their lobes are equally wide (Walter et al. 2007: n = 2 / a^2 - 2, a = r^2).
 * Blender writes its roughness as an exponent of its own, (10 - 10 r)^2. */
static double roughness_of(const source &m)
{
    if (m.find({ "glossiness" }) && m.real({ "useglossiness" }, 1.0) == 1.0)
        return share(1.0 - m.real({ "glossiness" }, 0.0));
    if (m.find({ "roughness", "specularroughness" })) return share(m.real({ "roughness", "specularroughness" }, 0.5));
    const double exponent = m.real({ "ShininessExponent", "Shininess" }, 0.0);
    if (is_blender(m.s) && m.find({ "ShininessExponent", "Shininess" }))
        return share(1.0 - std::sqrt(std::max(exponent, 0.0)) / 10.0);
    return exponent > 0.0 ? share(std::pow(2.0 / (exponent + 2.0), 0.25)) : 0.8;
}

static double metallic_of(const source &m)
{
    return share(m.real({ "metalness", "metallic" }, is_blender(m.s) ? m.real({ "ReflectionFactor" }, 0.0) : 0.0));
}

/* Where a material has a picture, its colour is ignored, even if the picture was not found: it is often black. */
static void read_colors(const source &m, bool textured, tinygltf::Material &out)
{
    const double strength = m.real({ "base" }, 1.0), opacity = opacity_of(m);
    const vec color = textured ? vec{ { 1.0, 1.0, 1.0 } }
                               : m.color({ "basecolor", "color", "DiffuseColor", "Diffuse" }, 1.0);
    const double factor = textured ? 1.0 : m.find({ "basecolor" }) ? strength : m.real({ "DiffuseFactor" }, 1.0);
    const vec glow = m.color({ "emitcolor", "emissioncolor", "emissive", "EmissiveColor", "Emissive" }, 0.0);
    const double glow_factor = m.real({ "emission", "EmissiveFactor" }, 1.0);
    out.pbrMetallicRoughness.baseColorFactor = { linear(color[0] * factor), linear(color[1] * factor),
                                                 linear(color[2] * factor), opacity };
    if (opacity < 1.0) out.alphaMode = "BLEND";
    if (out.emissiveTexture.index >= 0)
        out.emissiveFactor = { 1.0, 1.0, 1.0 };
    else
        out.emissiveFactor = { linear(glow[0] * glow_factor), linear(glow[1] * glow_factor),
                               linear(glow[2] * glow_factor) };
}

/* Before version 7 textures belong to the node, one for each material or one for all. */
static size_t texture_of_node(const scene &s, size_t material, size_t model)
{
    const std::vector<size_t> textures = s.below(model, "Texture", nullptr), all = s.below(model, "Material", nullptr);
    const size_t place = static_cast<size_t>(std::find(all.begin(), all.end(), material) - all.begin());
    return textures.empty() ? none : textures[std::min(place, textures.size() - 1)];
}

std::vector<std::string> uv_layers_of(job &j, size_t material, size_t model)
{
    std::vector<std::string> out;
    const auto add = [&](size_t picture) {
        const std::vector<value> *name = j.in.property(picture, "UVSet");
        if (name && !name->empty()) out.push_back(text_of((*name)[0]));
    };
    const size_t of_node = texture_of_node(j.in, material, model);
    for (int colors = 1; colors >= 0; --colors)
        for (const link &l : j.in.objects[material].below) {
            use u;
            if (j.in.objects[l.other].kind == "Texture" && use_of(l.property, &u) && (u == USE_COLOR) == (colors == 1))
                add(l.other);
        }
    if (out.empty() && of_node != none) add(of_node);
    return out;
}

int material_of(job &j, size_t material, size_t model)
{
    size_t uses[USE_COUNT];
    tinygltf::Material out;
    find_textures(j, material, uses);
    if (uses[USE_COLOR] == none) uses[USE_COLOR] = texture_of_node(j.in, material, model);
    const std::pair<size_t, size_t> key = { material, uses[USE_COLOR] };
    const auto known = j.material_of.find(key);
    if (known != j.material_of.end()) return known->second;
    const source m(j.in, material);
    const auto index = [&](use u) { return uses[u] == none ? -1 : texture_of(j, uses[u]); };
    out.name = j.in.objects[material].name;
    out.pbrMetallicRoughness.baseColorTexture.index = index(USE_COLOR);
    out.normalTexture.index = index(USE_NORMAL);
    out.emissiveTexture.index = index(USE_EMISSIVE);
    read_colors(m, uses[USE_COLOR] != none, out);
    if (uses[USE_OPACITY] != none) { /* exporters name the colours' own picture: its alpha cuts */
        if (same_picture(j.in, uses[USE_COLOR], uses[USE_OPACITY]))
            out.alphaMode = "MASK";
        else
            j.in.warn(place_of(j.in, material), " has a picture of its opacity, which was left out: put it in the "
                                                "alpha of its colours");
    }
    out.pbrMetallicRoughness.metallicFactor = metallic_of(m);
    out.pbrMetallicRoughness.roughnessFactor = roughness_of(m);
    j.out.materials.push_back(out);
    return j.material_of[key] = static_cast<int>(j.out.materials.size() - 1);
}

} // namespace fbx
