/* gltf_vrm.cpp: the figure of a VRM file: the nodes that are bones of a person, its expressions, and, before VRM 1.0,
 * that it faces -z. gltf_mtoon.cpp reads its toon materials.
 *
 * The bones take VRM's names for them, which are the same in every file: hips, leftUpperArm. Expressions become lines
 * of a face's recipe (base/recipe_read.h); those that a face has no channel for, such as an author's own, are moved by
 * a target with their name, which games hold as any float. Sources: VRMC_vrm-1.0 and VRM 0.0 of the VRM Consortium's specifications. */
#include "gltf_internal.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "convert/base/vrm_expression.h"
#include "convert/model/target_append.h"
#include "noh/base.h"

namespace gltf
{

using value = tinygltf::Value;

#define LINES_MAX (NOH_FACE_ROWS_MAX / 2u) /* the rest is for rows by names of targets and joints */

const value *member(const value &object, const char *key)
{
    return object.IsObject() && object.Has(key) ? &object.Get(key) : nullptr;
}

const value *array_member(const value &object, const char *key)
{
    const value *found = member(object, key);
    return found && found->IsArray() ? found : nullptr;
}

std::string text_member(const value &object, const char *key)
{
    const value *found = member(object, key);
    return found && found->IsString() ? found->Get<std::string>() : std::string();
}

/* A whole number below `limit`, or `limit`. */
static size_t index_member(const value &object, const char *key, size_t limit)
{
    const value *found = member(object, key);
    const int index = found && found->IsInt() ? found->Get<int>() : -1;
    return index >= 0 && static_cast<size_t>(index) < limit ? static_cast<size_t>(index) : limit;
}

const value *vrm_extension(const file &f, const char *name)
{
    const auto found = f.json.extensions.find(name);
    return found != f.json.extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

bool faces_back(const file &f)
{
    return vrm_extension(f, "VRM") && !vrm_extension(f, "VRMC_vrm");
}

/* --- bones --- */

static std::set<std::string> names_taken(const file &f)
{
    std::set<std::string> taken;
    for (uint32_t i = 0; i < f.out->node_count; ++i) taken.insert(f.out->nodes[i].name);
    return taken;
}

/* A node keeps its own name if another node already has the bone's name. 0.0 gives bones that are not there -1. */
static void name_bone(file &f, const std::string &bone, const value &from, std::set<std::string> &taken,
                      std::set<uint32_t> &bones)
{
    const value *given = member(from, "node");
    const size_t node = index_member(from, "node", f.node_of.size());
    const std::string where = "VRM bone '" + printable(bone) + "'";
    if (bone.empty() || (given && given->IsInt() && given->Get<int>() < 0)) return;
    if (node >= f.node_of.size() || f.node_of[node] == MODEL_NONE) {
        leave_out(f, where, ": its node does not exist");
        return;
    }
    model_node &out = f.out->nodes[f.node_of[node]];
    if (!bones.insert(f.node_of[node]).second)
        leave_out(f, where, ": its node is another bone, too");
    else if (out.name != bone && !taken.insert(bone).second)
        leave_out(f, where, ": its node '" + printable(out.name) + "' keeps its name: another node has the bone's");
    else if (out.name != bone) {
        char *name = copy_string(bone);
        free(out.name);
        out.name = name;
    }
}

static void name_bones(file &f, const value &vrm)
{
    const value *humanoid = member(vrm, "humanoid"), *list = humanoid ? member(*humanoid, "humanBones") : nullptr;
    std::set<std::string> taken = names_taken(f);
    std::set<uint32_t> bones;
    if (!list) return;
    for (size_t i = 0; list->IsArray() && i < list->ArrayLen(); ++i) { /* 0.0 */
        const value &bone = list->Get(static_cast<int>(i));
        name_bone(f, text_member(bone, "bone"), bone, taken, bones);
    }
    if (!list->IsObject()) return;
    for (const std::string &bone : list->Keys()) name_bone(f, bone, list->Get(bone), taken, bones);
}

/* --- expressions --- */

/* The lines of each mesh's recipe, and all lines: meshes may have targets of the same name. */
struct recipes {
    std::map<uint32_t, std::string> of_mesh;
    std::set<std::string> lines;
};

static std::string lower(std::string word)
{
    for (char &c : word)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return word;
}

/* A word of a recipe: those with blanks are quoted. */
static std::string in_quotes(const std::string &name)
{
    return "\"" + name + "\"";
}

static bool is_word(const std::string &name)
{
    return !name.empty() && name.size() < NOH_NAME_BYTES_MAX - 2u && name.find_first_of("\"\n\r;") == std::string::npos;
}

/* An expression: its channel, or NULL and the name by which a game calls it. */
struct expression {
    const char *channel;
    std::string name, where;
    uint32_t mesh; /* of its first bind; MODEL_NONE: it has none */
};

static void add_line(file &f, expression &e, uint32_t mesh, size_t target, double weight, recipes &r)
{
    const std::string name = f.out->meshes[mesh].targets[target].name;
    if (!is_word(name) || weight == 0.0 || !(weight >= -4.0 && weight <= 4.0)) {
        leave_out(f, e.where + ", target '" + printable(name) + "'",
                  is_word(name) ? ": left out of it: its weight is 0, or beyond 4"
                                : ": left out of it: a recipe cannot hold its name");
        return;
    }
    if (r.lines.size() >= LINES_MAX) {
        leave_out(f, e.where, text(": a bind was left out: a pack has %u rows of expressions", LINES_MAX));
        return;
    }
    if (!e.channel && name == e.name && weight != 1.0)
        leave_out(f, e.where, ": its target of the same name moves by all of its weight");
    const std::string start = e.channel ? std::string(e.channel) : "expression " + in_quotes(e.name);
    const std::string line = start + text(" %s %.6g\n", in_quotes(name).c_str(), weight);
    if (r.lines.insert(line).second) r.of_mesh[mesh] += line;
    if (e.mesh == MODEL_NONE) e.mesh = mesh;
    if (!e.channel) f.expressions[mesh].insert(e.name);
}

/* One bind: 1.0 names the node that draws the mesh, and weights to 1; 0.0 the mesh, and weights to 100. */
static void add_bind(file &f, expression &e, const value &bind, bool old, recipes &r)
{
    const value *weight = member(bind, "weight");
    uint32_t mesh = MODEL_NONE;
    if (old) {
        const size_t source = index_member(bind, "mesh", f.mesh_of.size());
        if (source < f.mesh_of.size()) mesh = f.mesh_of[source];
    } else {
        const size_t node = index_member(bind, "node", f.node_of.size());
        if (node < f.node_of.size() && f.node_of[node] != MODEL_NONE) mesh = f.out->nodes[f.node_of[node]].mesh;
    }
    const size_t count = mesh == MODEL_NONE ? 0 : f.out->meshes[mesh].target_count;
    const size_t target = index_member(bind, "index", count);
    if (target < count && weight && weight->IsNumber())
        add_line(f, e, mesh, target, weight->GetNumberAsDouble() / (old ? 100.0 : 1.0), r);
    else
        leave_out(f, e.where,
                  ": a bind was left out: its mesh or target does not exist or is hidden, or it has no weight");
}

static bool has_items(const value &object, const char *key)
{
    const value *found = array_member(object, key);
    return found && found->ArrayLen() > 0;
}

/* Rules of an expression become lines of the recipe, for emotions and for expressions that are called by name. */
static void add_rules(file &f, const expression &e, const value &from, recipes &r)
{
    static const char *const rules[][2] = { { "overrideBlink", "lids" },
                                            { "overrideLookAt", "eyes" },
                                            { "overrideMouth", "speech" } };
    const bool has_rules = e.channel ? strstr(e.channel, "-upper") && f.out->mesh_count : e.mesh != MODEL_NONE;
    const std::string who = e.channel ? std::string(e.channel) : in_quotes(e.name);
    const value *binary = member(from, "isBinary");
    std::vector<std::string> lines;
    if (binary && binary->IsBool() && binary->Get<bool>()) {
        if (has_rules)
            lines.push_back("binary " + who + "\n");
        else
            leave_out(f, e.where, ": isBinary was left out: it shows by degrees");
    }
    for (const auto &rule : rules) {
        const std::string how = text_member(from, rule[0]);
        if (how.empty() || how == "none") continue;
        if (has_rules && (how == "block" || how == "blend"))
            lines.push_back("override " + who + " " + rule[1] + " " + how + "\n");
        else
            leave_out(f, e.where, text(": %s '%s' was left out", rule[0], printable(how).c_str()));
    }
    for (const std::string &line : lines)
        if (r.lines.insert(line).second) r.of_mesh[e.mesh == MODEL_NONE ? 0 : e.mesh] += line;
}

static void add_expression(file &f, const std::string &name, const char *channel, const value &from, bool old,
                           recipes &r)
{
    expression e = { channel, name, "VRM expression '" + printable(name) + "'", MODEL_NONE };
    const value *binds = array_member(from, old ? "binds" : "morphTargetBinds");
    if (has_items(from, old ? "materialValues" : "materialColorBinds") || has_items(from, "textureTransformBinds"))
        leave_out(f, e.where, ": its changes to materials were left out");
    if (!channel && !is_word(name)) {
        if (binds && binds->ArrayLen() > 0) leave_out(f, e.where, " was left out: a game cannot call it by this name");
        return;
    }
    for (size_t i = 0; binds && i < binds->ArrayLen(); ++i) add_bind(f, e, binds->Get(static_cast<int>(i)), old, r);
    add_rules(f, e, from, r);
}

/* Both lids at once, unless each has its own: else they would shut twice. */
static bool is_double(const std::string &name, bool both_lids)
{
    return both_lids && lower(name) == "blink";
}

static void add_new(file &f, const value &vrm, recipes &r)
{
    const value *all = member(vrm, "expressions"), *presets = all ? member(*all, "preset") : nullptr;
    const value *customs = all ? member(*all, "custom") : nullptr;
    const bool both = presets && presets->IsObject() && presets->Has("blinkLeft") && presets->Has("blinkRight");
    for (size_t i = 0; presets && presets->IsObject() && i < presets->Keys().size(); ++i) {
        const std::string name = presets->Keys()[i];
        if (!is_double(name, both))
            add_expression(f, name, vrm_expression_channel(name.c_str(), 0), presets->Get(name), false, r);
    }
    for (size_t i = 0; customs && customs->IsObject() && i < customs->Keys().size(); ++i)
        add_expression(f, customs->Keys()[i], nullptr, customs->Get(customs->Keys()[i]), false, r);
}

static void add_old(file &f, const value &vrm, recipes &r)
{
    const value *master = member(vrm, "blendShapeMaster");
    const value *groups = master ? array_member(*master, "blendShapeGroups") : nullptr;
    int lids = 0;
    for (size_t i = 0; groups && i < groups->ArrayLen(); ++i)
        lids += lower(text_member(groups->Get(static_cast<int>(i)), "presetName")).compare(0, 6, "blink_") == 0;
    for (size_t i = 0; groups && i < groups->ArrayLen(); ++i) {
        const value &group = groups->Get(static_cast<int>(i));
        const std::string name = text_member(group, "presetName");
        const bool custom = name.empty() || lower(name) == "unknown";
        const std::string own = custom ? text_member(group, "name") : name;
        const bool has_channel = !custom || lower(own) == "surprised"; /* VRM 0.0 has no preset for it */
        if (!is_double(name, lids >= 2))
            add_expression(f, own, has_channel ? vrm_expression_channel(own.c_str(), 1) : nullptr, group, true, r);
    }
}

/* An artist's own recipe in a mesh's extras comes first. */
static void store_recipes(file &f, const recipes &r)
{
    for (const auto &entry : r.of_mesh) {
        model_mesh &mesh = f.out->meshes[entry.first];
        if (mesh.recipe) {
            leave_out(f, "mesh '" + printable(mesh.name) + "'",
                      ": its VRM expressions were left out: its extras have a recipe");
            f.expressions.erase(entry.first);
            continue;
        }
        mesh.recipe = copy_string(entry.second);
        mesh.recipe_is_made = 1;
    }
}

static bool has_target(const model_mesh &mesh, const std::string &name)
{
    for (uint32_t t = 0; t < mesh.target_count; ++t)
        if (name == mesh.targets[t].name) return true;
    return false;
}

static void add_empty_target(file &f, uint32_t mesh, const std::string &name)
{
    const size_t values = static_cast<size_t>(f.out->meshes[mesh].vertex_count) * 3;
    model_target target{};
    model_mesh from{};
    target.name = copy_string(name);
    target.position = static_cast<float *>(model_zeros(values, sizeof(float)));
    target.normal = static_cast<float *>(model_zeros(values, sizeof(float)));
    target.has_position = target.has_normal = target.has_tangent = 1;
    from.targets = &target;
    from.target_count = 1;
    const bool failed = !target.position || !target.normal || model_append_targets(f.out, mesh, &from);
    if (!failed) return;
    if (!from.target_count) throw std::bad_alloc(); /* the mesh has it */
    free(target.name);
    free(target.position);
    free(target.normal);
    throw std::bad_alloc();
}

void add_expressions(file &f)
{
    for (const auto &entry : f.expressions)
        for (const std::string &name : entry.second) {
            if (has_target(f.out->meshes[entry.first], name)) continue;
            if (f.out->meshes[entry.first].target_count < NOH_TARGETS_MAX)
                add_empty_target(f, entry.first, name);
            else
                leave_out(f, "VRM expression '" + printable(name) + "'",
                          text(" was left out: its mesh has %u targets", NOH_TARGETS_MAX));
        }
}

/* --- all of it --- */

/* Curves of expressions and of the gaze lie in nodes of their own. */
static void read_vrm_animation(file &f, const value &animation)
{
    const value *expressions = member(animation, "expressions");
    f.out->for_any_body = 1;
    name_bones(f, animation);
    for (const char *kind : { "preset", "custom" }) {
        const value *all = expressions ? member(*expressions, kind) : nullptr;
        if (!all || !all->IsObject()) continue;
        for (const std::string &name : all->Keys()) {
            const size_t node = index_member(all->Get(name), "node", f.node_of.size());
            const char *channel = vrm_expression_channel(name.c_str(), 0);
            if (node >= f.node_of.size() || f.node_of[node] == MODEL_NONE) {
                leave_out(f, "VRM expression '" + printable(name) + "'",
                          ": its animation was left out: its node does not exist, or is not in the default scene");
                continue;
            }
            model_node &out = f.out->nodes[f.node_of[node]];
            free(out.expression);
            out.expression = nullptr;
            out.expression = copy_string(channel && *kind == 'p' ? channel : name);
        }
    }
    if (member(animation, "lookAt")) leave_out(f, "VRM lookAt", ": its animation was left out: clips have no gaze");
}

/* No joint of a pack follows another one: a node with a constraint keeps its place on its parent. */
static void note_constraints(file &f)
{
    for (size_t i = 0; i < f.json.nodes.size(); ++i) {
        const auto found = f.json.nodes[i].extensions.find("VRMC_node_constraint");
        const value *of = found == f.json.nodes[i].extensions.end() ? nullptr : member(found->second, "constraint");
        for (const char *kind : { "roll", "aim", "rotation" })
            if (of && member(*of, kind))
                leave_out(f, "node '" + printable(name_or(f.json.nodes[i].name, "node", i)) + "'",
                          text(": its VRM constraint (%s) was left out, so it moves with its parent alone: bake "
                               "constraints into the animations",
                               kind));
    }
}

void read_vrm(file &f)
{
    recipes r;
    note_constraints(f);
    const value *now = vrm_extension(f, "VRMC_vrm"), *old = vrm_extension(f, "VRM");
    if (const value *animation = vrm_extension(f, "VRMC_vrm_animation")) read_vrm_animation(f, *animation);
    if (!now && !old) return;
    name_bones(f, now ? *now : *old);
    if (now)
        add_new(f, *now, r);
    else
        add_old(f, *old, r);
    store_recipes(f, r);
}

} // namespace gltf
