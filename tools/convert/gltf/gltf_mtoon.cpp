/* gltf_mtoon.cpp: toon materials of VRM files (MToon): VRMC_materials_mtoon 1.0, and MToon of VRM 0.0, as UniVRM
 * converts it. */
#include "gltf_internal.h"

#include <cmath>

namespace gltf
{

using value = tinygltf::Value;

static double number_member(const value *object, const char *key, double otherwise)
{
    const value *found = object ? member(*object, key) : nullptr;
    return found && found->IsNumber() ? found->GetNumberAsDouble() : otherwise;
}

static double between(double value, double low, double high)
{
    return value >= low ? (value <= high ? value : high) : low; /* low where it is no number */
}

/* A colour of MToon, linear; black where it lacks one. Before VRM 1.0 colours are as a screen shows them: gamma 2.2. */
static void color_member(const value *object, const char *key, double gamma, double otherwise, double rgb[3])
{
    const value *list = object ? member(*object, key) : nullptr;
    for (int i = 0; i < 3; ++i) {
        const bool given = list && list->IsArray() && static_cast<int>(list->ArrayLen()) > i && list->Get(i).IsNumber();
        rgb[i] = given ? std::pow(between(list->Get(i).GetNumberAsDouble(), 0.0, 1.0), gamma) : otherwise;
    }
}

/* As noh_material.surface_more has it. */
static float color_code(const value *object, const char *key, double gamma)
{
    double rgb[3], code = 0.0;
    color_member(object, key, gamma, 0.0, rgb);
    for (int i = 2; i >= 0; --i) code = 256.0 * code + std::floor(255.0 * std::sqrt(rgb[i]) + 0.5);
    return static_cast<float>(code);
}

static int texture_member(const value *object, const char *key)
{
    const value *found = object ? member(*object, key) : nullptr;
    if (found && found->IsObject()) found = member(*found, "index");
    return found && found->IsInt() ? found->GetNumberAsInt() : -1;
}

static bool have_one_image(const file &f, int a, int b)
{
    const auto &all = f.json.textures;
    const auto count = static_cast<int>(all.size());
    return a == b || (a >= 0 && b >= 0 && a < count && b < count && all[static_cast<size_t>(a)].source >= 0 &&
                      all[static_cast<size_t>(a)].source == all[static_cast<size_t>(b)].source);
}

/* Where one image colours light and shade, the tone in shade is a share of that in light. */
static void set_tones(const file &f, size_t index, const value *from, const char *key, double gamma, toon_maps &maps,
                      model_material &out)
{
    double shade[3];
    color_member(from, key, gamma, 0.0, shade);
    out.toon_shade = !have_one_image(f, maps.shade,
                                     f.json.materials[index].pbrMetallicRoughness.baseColorTexture.index);
    if (!out.toon_shade) maps.shade = -1;
    for (int i = 0; i < 3; ++i) {
        const double lit = out.toon_shade ? 1.0 : static_cast<double>(out.base_color[i]);
        out.surface_values[i] = static_cast<float>(between(lit > 1e-4 ? shade[i] / lit : 1.0, 0.0, 1.0));
    }
}

static void set_rim(const value *numbers, const char *power, const char *lift, model_material &out)
{
    out.surface_more[2] = static_cast<float>(between(number_member(numbers, power, 5.0), 0.0, 1000.0));
    out.surface_more[3] = static_cast<float>(between(number_member(numbers, lift, 0.0), -1.0, 1.0));
}

static float outline_width(const value *numbers, const char *key, double scale)
{
    return static_cast<float>(between(number_member(numbers, key, 0.0) * scale, -1.0, 1.0));
}

static void leave_out_of_toon(file &f, const std::string &where, const std::string &key, const char *more)
{
    leave_out(f, where, ": " + key + " of its MToon shading was left out" + more);
}

static bool has_rim(const toon_maps &maps, const model_material &out)
{
    return maps.matcap >= 0 || out.surface_more[1] > 0.0f;
}

/* A share of light that is taken as none or all of it. */
static void note_share(file &f, const std::string &where, const char *key, double given, double taken)
{
    if (std::fabs(given - taken) > 0.25)
        leave_out(f, where, text(": %s of its MToon shading was taken as %g", key, taken));
}

static void note_animation(file &f, const value *from, const std::string &where,
                           std::initializer_list<const char *> speeds)
{
    for (const char *key : speeds)
        if (number_member(from, key, 0.0) != 0.0)
            leave_out_of_toon(f, where, key, ": texture coordinates do not move by themselves");
}

static void set_outline_light(file &f, const std::string &where, const char *key, double share, model_material &out)
{
    out.outline_lit = share >= 0.5;
    if (out.surface_more[4] != 0.0f) note_share(f, where, key, share, out.outline_lit);
}

/* What blends and writes depth comes before what does not, whatever the offsets. */
static int order_of(bool writes_depth, double offset)
{
    return static_cast<int>(writes_depth ? between(offset, 0.0, 80.0) - 100.0 : between(offset, -19.0, 80.0));
}

/* VRM 0.0 has them apart from the materials, in their order. Its tones begin and end at cosines of the light, 1.0's at
 * a middle and half a width; its outlines are in hundredths of a metre, or of half the picture's height (UniVRM
 * converts them in the same way). */
static toon_maps read_old_toon(file &f, const value &vrm, size_t index, const std::string &where, model_material &out)
{
    toon_maps maps;
    const value *all = array_member(vrm, "materialProperties");
    if (!all || index >= all->ArrayLen()) return maps;
    const value &m = all->Get(static_cast<int>(index));
    const value *floats = member(m, "floatProperties"), *vectors = member(m, "vectorProperties");
    const value *textures = member(m, "textureProperties");
    if (text_member(m, "shader") != "VRM/MToon") return maps;
    const double begin = between(number_member(floats, "_ShadeShift", 0.0), -1.0, 1.0);
    const double hard = between(number_member(floats, "_ShadeToony", 0.9), 0.0, 1.0), end = 1.0 + (begin - 1.0) * hard;
    const double mode = number_member(floats, "_OutlineWidthMode", 0.0);
    const bool is_mixed = number_member(floats, "_OutlineColorMode", 0.0) > 0.5;
    maps = { true,
             texture_member(textures, "_ShadeTexture"),
             texture_member(textures, "_SphereAdd"),
             texture_member(textures, "_OutlineWidthTexture"),
             -1,
             texture_member(textures, "_RimTexture") };
    set_tones(f, index, vectors, "_ShadeColor", 2.2, maps, out);
    out.surface_values[3] = static_cast<float>(-0.5 * (begin + end));
    out.surface_more[0] = static_cast<float>(between(1.0 - 0.5 * (end - begin), 1e-3, 1.0));
    out.surface_more[1] = color_code(vectors, "_RimColor", 2.2);
    set_rim(floats, "_RimFresnelPower", "_RimLift", out);
    if (mode > 0.5) out.surface_more[4] = outline_width(floats, "_OutlineWidth", mode < 1.5 ? 0.01 : -0.005);
    out.surface_more[5] = color_code(vectors, "_OutlineColor", 2.2);
    set_outline_light(f, where, "_OutlineLightingMix",
                      is_mixed ? number_member(floats, "_OutlineLightingMix", 1.0) : 0.0, out);
    for (const char *kind : { "_ShadingGrade", "_ReceiveShadow" })
        if (texture_member(textures, (std::string(kind) + "Texture").c_str()) >= 0 &&
            number_member(floats, (std::string(kind) + "Rate").c_str(), 1.0) > 0.0)
            leave_out_of_toon(f, where, std::string(kind) + "Texture", ": VRM 1.0 has none");
    note_animation(f, floats, where, { "_UvAnimScrollX", "_UvAnimScrollY", "_UvAnimRotation" });
    const bool writes_depth = number_member(floats, "_BlendMode", 0.0) > 2.5;
    const double queue = number_member(&m, "renderQueue", -1.0); /* of Unity */
    maps.priority = order_of(writes_depth, queue < 0.0 ? 0.0 : queue - (writes_depth ? 2501.0 : 3000.0));
    return maps;
}

toon_maps read_toon(file &f, size_t index, const std::string &where, model_material &out)
{
    const tinygltf::ExtensionMap &extensions = f.json.materials[index].extensions;
    const auto found = extensions.find("VRMC_materials_mtoon");
    const value *old = vrm_extension(f, "VRM");
    if (found == extensions.end() || !found->second.IsObject())
        return old ? read_old_toon(f, *old, index, where, out) : toon_maps();
    const value &m = found->second;
    const std::string mode = text_member(m, "outlineWidthMode");
    const value *writes_depth = member(m, "transparentWithZWrite"), *shift = member(m, "shadingShiftTexture");
    toon_maps maps{ true,
                    texture_member(&m, "shadeMultiplyTexture"),
                    texture_member(&m, "matcapTexture"),
                    texture_member(&m, "outlineWidthMultiplyTexture"),
                    texture_member(&m, "shadingShiftTexture"),
                    texture_member(&m, "rimMultiplyTexture") };
    maps.shift_scale = between(number_member(shift, "scale", 1.0), -100.0, 100.0);
    color_member(&m, "matcapFactor", 1.0, 1.0, maps.matcap_factor);
    set_tones(f, index, &m, "shadeColorFactor", 1.0, maps, out);
    out.surface_values[3] = static_cast<float>(between(number_member(&m, "shadingShiftFactor", 0.0), -1.0, 1.0));
    out.surface_more[0] = static_cast<float>(between(number_member(&m, "shadingToonyFactor", 0.9), 1e-3, 1.0));
    out.surface_more[1] = color_code(&m, "parametricRimColorFactor", 1.0);
    set_rim(&m, "parametricRimFresnelPowerFactor", "parametricRimLiftFactor", out);
    if (mode == "worldCoordinates") out.surface_more[4] = outline_width(&m, "outlineWidthFactor", 1.0);
    if (mode == "screenCoordinates") out.surface_more[4] = outline_width(&m, "outlineWidthFactor", -1.0);
    out.surface_more[5] = color_code(&m, "outlineColorFactor", 1.0);
    set_outline_light(f, where, "outlineLightingMixFactor", number_member(&m, "outlineLightingMixFactor", 1.0), out);
    note_share(f, where, "giEqualizationFactor", number_member(&m, "giEqualizationFactor", 0.9), 1.0);
    if (has_rim(maps, out))
        note_share(f, where, "rimLightingMixFactor", number_member(&m, "rimLightingMixFactor", 1.0), 1.0);
    note_animation(
        f, &m, where,
        { "uvAnimationScrollXSpeedFactor", "uvAnimationScrollYSpeedFactor", "uvAnimationRotationSpeedFactor" });
    maps.priority = order_of(writes_depth && writes_depth->IsBool() && writes_depth->Get<bool>(),
                             number_member(&m, "renderQueueOffsetNumber", 0.0));
    return maps;
}

} // namespace gltf
