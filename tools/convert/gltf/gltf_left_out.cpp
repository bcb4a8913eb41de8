/* gltf_left_out.cpp: warnings about features that the model does not store, one for each kind. */
#include "gltf_internal.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>

namespace gltf
{

/* --- textures --- */

/* A pack filters a texture in one way: nearest or linear. */
static void find_in_samplers(file &f)
{
    std::set<int> used;
    for (const tinygltf::Material &m : f.json.materials) {
        for (int texture : { m.pbrMetallicRoughness.baseColorTexture.index, m.normalTexture.index,
                             m.pbrMetallicRoughness.metallicRoughnessTexture.index, m.occlusionTexture.index,
                             m.emissiveTexture.index })
            if (texture >= 0 && static_cast<size_t>(texture) < f.json.textures.size())
                used.insert(f.json.textures[static_cast<size_t>(texture)].sampler);
    }
    for (int index : used) {
        if (index < 0 || static_cast<size_t>(index) >= f.json.samplers.size()) continue;
        const tinygltf::Sampler &s = f.json.samplers[static_cast<size_t>(index)];
        bool nearest = s.minFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ||
                       s.minFilter == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
                       s.minFilter == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
        if (s.minFilter != -1 && nearest != (s.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST))
            leave_out(f, text("sampler %d", index), ": 'minFilter' was ignored: a pack filters as 'magFilter' says");
    }
}

/* --- meshes --- */

static bool begins_with(const std::string &name, const char *beginning)
{
    return name.compare(0, strlen(beginning), beginning) == 0;
}

/* Joints and weights are read whole, in sets of four, or the file is refused. */
static bool is_read(const file &f, const std::string &name, const std::string &uv)
{
    for (uint32_t k = 0; k < f.out->extras.count; ++k)
        if (name == f.out->extras.names[k]) return true;
    return name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name == "COLOR_0" || name == uv ||
           begins_with(name, "JOINTS_") || begins_with(name, "WEIGHTS_");
}

static void find_in_primitive(file &f, const tinygltf::Primitive &p, const std::string &where)
{
    const std::string uv = uv_name(f, p);
    for (const auto &attribute : p.attributes)
        if (!is_read(f, attribute.first, uv))
            leave_out(f, where,
                      ": the attribute " + printable(attribute.first) + " was left out" +
                          (begins_with(attribute.first, "_") || begins_with(attribute.first, "TEXCOORD_")
                               ? "; --attributes keeps it"
                               : ""));
    if (p.material < 0 || static_cast<size_t>(p.material) >= f.json.materials.size()) return;
    const tinygltf::Material &m = f.json.materials[static_cast<size_t>(p.material)];
    const bool textured = m.pbrMetallicRoughness.baseColorTexture.index >= 0 || m.normalTexture.index >= 0 ||
                          m.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0 || m.occlusionTexture.index >= 0 ||
                          m.emissiveTexture.index >= 0;
    if (textured && p.attributes.count(uv) == 0)
        leave_out(f, where, text(": its material has a texture, but the primitive has no %s", uv.c_str()));
}

/* --- the scene --- */

static void find_in_scene(file &f)
{
    for (const std::string &camera : f.cameras) leave_out(f, "camera '" + camera + "'", ": cameras are not kept");
    for (size_t i = 0; i < f.json.nodes.size(); ++i)
        if (f.node_of[i] == MODEL_NONE)
            leave_out(f, "node '" + printable(name_or(f.json.nodes[i].name, "node", i)) + "'",
                      " was left out: it is not in the default scene");
}

/* Nodes that an animation shows and hides are seen at some time. */
static std::set<size_t> nodes_that_blink(const file &f)
{
    std::set<size_t> out;
    for (const tinygltf::Animation &animation : f.json.animations)
        for (const tinygltf::AnimationChannel &c : animation.channels) {
            unsigned index = 0;
            int end = 0;
            const std::string pointer = c.target_path == "pointer" ? pointer_of(c) : "";
            if (sscanf(pointer.c_str(), "/nodes/%9u/extensions/KHR_node_visibility/visible%n", &index, &end) == 1 &&
                end && static_cast<size_t>(end) == pointer.size())
                out.insert(index);
        }
    return out;
}

/* KHR_node_visibility: a node and what is below it; of FBX, where a node below may be shown, it alone
 * (fbx_nodes.cpp). */
static std::vector<bool> hidden_nodes(const file &f)
{
    const std::set<size_t> blink = nodes_that_blink(f);
    std::vector<bool> hidden(f.out->node_count), below(f.out->node_count);
    for (size_t i = 0; i < f.json.nodes.size(); ++i) {
        const auto said = f.json.nodes[i].extensions.find("KHR_node_visibility");
        if (f.node_of[i] == MODEL_NONE || said == f.json.nodes[i].extensions.end() || !said->second.IsObject())
            continue;
        const tinygltf::Value &visible = said->second.Get("visible"), &extras = said->second.Get("extras");
        hidden[f.node_of[i]] = visible.IsBool() && !visible.Get<bool>() && !blink.count(i);
        below[f.node_of[i]] = hidden[f.node_of[i]] && !(extras.IsObject() && extras.Has("alone"));
    }
    for (size_t i = 0; i < hidden.size(); ++i) { /* parents first */
        const uint32_t parent = f.out->nodes[i].parent;
        if (parent != MODEL_NONE && below[parent]) hidden[i] = below[i] = true;
    }
    return hidden;
}

static std::array<uint32_t *, MODEL_MAPS> maps_of(model_material &m)
{
    std::array<uint32_t *, MODEL_MAPS> maps;
    model_maps(&m, maps.data());
    return maps;
}

static std::set<uint32_t> materials_of(const model &m)
{
    std::set<uint32_t> all;
    for (uint32_t i = 0; i < m.mesh_count; ++i)
        for (uint32_t k = 0; k < m.meshes[i].submesh_count; ++k) all.insert(m.meshes[i].submeshes[k].material);
    return all;
}

static bool replaces_a_used_one(const model &m, const std::vector<bool> &used, uint32_t texture)
{
    for (uint32_t i = 0; i < m.texture_count; ++i)
        if (used[i] && model_replaces_texture(&m.textures[texture], &m.textures[i])) return true;
    return false;
}

static void forget_maps(model &m, const std::set<uint32_t> &materials)
{
    std::vector<bool> used(m.texture_count);
    for (uint32_t i = 0; i < m.material_count; ++i)
        for (const uint32_t *map : maps_of(m.materials[i]))
            if (*map != MODEL_NONE && !materials.count(i)) used[*map] = true;
    for (uint32_t i : materials)
        for (uint32_t *map : maps_of(m.materials[i]))
            if (*map != MODEL_NONE && (used[*map] || !replaces_a_used_one(m, used, *map))) *map = MODEL_NONE;
}

/* Textures that only materials of dropped meshes have. Those materials stay, without maps: numbers of materials do not
 * change. had: the materials of meshes before */
static void drop_textures(model &m, const std::set<uint32_t> &had)
{
    const std::set<uint32_t> has = materials_of(m);
    std::set<uint32_t> gone;
    for (uint32_t i : had)
        if (i < m.material_count && !has.count(i)) gone.insert(i);
    if (gone.empty()) return;
    forget_maps(m, gone);
    std::vector<uint32_t> moved(m.texture_count, MODEL_NONE);
    for (uint32_t i = 0; i < m.material_count; ++i)
        for (const uint32_t *map : maps_of(m.materials[i]))
            if (*map != MODEL_NONE) moved[*map] = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < m.texture_count; ++i) {
        if (moved[i] != MODEL_NONE) {
            std::swap(m.textures[moved[i] = kept++], m.textures[i]);
            continue;
        }
        free(m.textures[i].name);
        free(m.textures[i].rgba);
        m.textures[i] = {};
    }
    m.texture_count = kept;
    for (uint32_t i = 0; i < m.material_count; ++i)
        for (uint32_t *map : maps_of(m.materials[i]))
            if (*map != MODEL_NONE) *map = moved[*map];
}

/* A mesh that only hidden nodes have is not kept, nor are textures that only such meshes have, other than replacements
 * for textures that are kept. */
static void drop_hidden_meshes(file &f, std::vector<bool> &was_hidden)
{
    const std::set<uint32_t> had = materials_of(*f.out);
    for (size_t i = 0; i < f.out->node_count; ++i)
        if (f.out->nodes[i].mesh != MODEL_NONE) was_hidden[f.out->nodes[i].mesh] = false;
    for (uint32_t mesh = f.out->mesh_count; mesh-- > 0;) {
        if (!was_hidden[mesh]) continue;
        model_drop_mesh(f.out, mesh);
        for (uint32_t &own : f.mesh_of)
            if (own != MODEL_NONE && own >= mesh) own = own == mesh ? MODEL_NONE : own - 1;
    }
    drop_textures(*f.out, had);
}

/* A file that shows nothing is drawn whole. */
void hide_nodes(file &f)
{
    const std::vector<bool> hidden = hidden_nodes(f);
    std::vector<bool> has_hidden(f.out->mesh_count);
    bool any_shown = false;
    for (size_t i = 0; i < hidden.size(); ++i) any_shown |= f.out->nodes[i].mesh != MODEL_NONE && !hidden[i];
    for (size_t i = 0; i < hidden.size(); ++i) {
        model_node &node = f.out->nodes[i];
        if (!hidden[i] || node.mesh == MODEL_NONE) continue;
        leave_out(f, std::string("node '") + node.name + "'",
                  any_shown ? " is hidden in the file and is not drawn: to draw it, unhide it in the program that made "
                              "the file"
                            : " is hidden in the file, as are all that have a mesh: they are drawn");
        if (!any_shown) continue;
        has_hidden[node.mesh] = true;
        node.mesh = MODEL_NONE;
        free(node.weights);
        node.weights = nullptr;
    }
    drop_hidden_meshes(f, has_hidden);
}

void find_left_out(file &f)
{
    find_in_samplers(f);
    for (size_t m = 0; m < f.json.meshes.size(); ++m)
        for (size_t i = 0; f.mesh_of[m] != MODEL_NONE && i < f.json.meshes[m].primitives.size(); ++i)
            find_in_primitive(f, f.json.meshes[m].primitives[i],
                              "mesh '" + printable(name_or(f.json.meshes[m].name, "mesh", m)) + "'" +
                                  text(" primitive %zu", i));
    find_in_scene(f);
}

} // namespace gltf
