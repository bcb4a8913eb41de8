/* fbx_scene.cpp: objects, their properties and connections, settings, and the tree of nodes. */
#include "fbx_scene.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace fbx
{

static const size_t name_max = 60; /* in messages */

/* --- notes --- */

void scene::warn(const std::string &where, const std::string &what)
{
    for (note &known : notes)
        if (known.what == what) {
            ++known.count;
            return;
        }
    notes.push_back({ where, what, 1 });
}

std::string place_of(const scene &s, size_t object)
{
    const fbx::object &o = s.objects[object];
    std::string kind = o.kind;
    if (o.kind == "Model") kind = "node";
    if (o.kind == "Geometry") kind = o.sub == "Shape" ? "shape" : "mesh";
    if (o.kind == "Deformer") kind = o.sub == "BlendShapeChannel" ? "shape" : o.sub == "Cluster" ? "bone" : "skin";
    for (char &c : kind) c = static_cast<char>(tolower(static_cast<unsigned char>(c)));
    size_t end = std::min(o.name.size(), name_max);
    while (end < o.name.size() && end && (o.name[end] & 0xc0) == 0x80) --end; /* do not cut a UTF-8 sequence */
    return kind + " '" + o.name.substr(0, end) + "'";
}

/* --- names --- */

/* The bytes of the UTF-8 sequence at `at`, or 0 where there is none (RFC 3629). */
static size_t sequence(const std::string &s, size_t at)
{
    const auto byte = [&](size_t i) { return at + i < s.size() ? static_cast<unsigned char>(s[at + i]) : 0u; };
    const unsigned first = byte(0), second = byte(1);
    const size_t size = first < 0x80   ? 1
                        : first < 0xc2 ? 0
                        : first < 0xe0 ? 2
                        : first < 0xf0 ? 3
                        : first < 0xf5 ? 4
                                       : 0;
    for (size_t i = 1; i < size; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
    const bool beyond = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
    return overlong || beyond ? 0 : size;
}

/* By their codes, names that differ still do. */
std::string to_utf8(const std::string &given, bool *changed)
{
    static const char digits[] = "0123456789ABCDEF";
    std::string out;
    for (size_t at = 0; at < given.size();) {
        const size_t size = sequence(given, at);
        const unsigned char byte = static_cast<unsigned char>(given[at]);
        if (size)
            out.append(given, at, size);
        else
            ((out += '_') += digits[byte >> 4]) += digits[byte & 15];
        *changed = *changed || !size;
        at += size ? size : 1;
    }
    return out;
}

/* "name\0\1Class" in binary files, "Class::name" in ASCII ones. */
static void split_name(const std::string &given, std::string &name, std::string &kind)
{
    const size_t zero = given.find('\0'), colons = given.find("::");
    if (zero != std::string::npos) {
        name = given.substr(0, zero);
        kind = given.substr(std::min(zero + 2, given.size()));
    } else {
        name = colons == std::string::npos ? given : given.substr(colons + 2);
        kind = colons == std::string::npos ? "" : given.substr(0, colons);
    }
}

std::string name_of(scene &s, const std::string &given)
{
    std::string name, kind;
    bool changed = false;
    split_name(given, name, kind);
    name = to_utf8(name, &changed);
    if (changed)
        s.warn("the name '" + name + "'",
               " had bytes that are not UTF-8, which became _ and their codes: rename it in its program");
    return name;
}

/* Objects have numbers from version 7 on, and before only their names, by class. */
std::string id_of(const value &v)
{
    std::string name, kind;
    if (!std::holds_alternative<std::string>(v)) return std::to_string(whole_of(v));
    split_name(text_of(v), name, kind);
    return "@" + kind + "@" + name;
}

/* --- properties --- */

static properties read_properties(const node &of)
{
    properties out;
    for (const node &list : of.children) {
        const bool is_seven = list.name == "Properties70";
        const std::ptrdiff_t first = is_seven ? 4 : 3; /* behind name, type, (label) and flags */
        if (!is_seven && list.name != "Properties60") continue;
        for (const node &p : list.children)
            if (static_cast<std::ptrdiff_t>(p.values.size()) >= first)
                out[p.text(0)].assign(p.values.begin() + first, p.values.end());
    }
    return out;
}

const std::vector<value> *scene::property(size_t object, const char *name) const
{
    const fbx::object &o = objects[object];
    const auto own = o.own.find(name);
    if (own != o.own.end() && !own->second.empty()) return &own->second;
    if (!o.defaults) return nullptr;
    const auto usual = o.defaults->find(name);
    return usual == o.defaults->end() || usual->second.empty() ? nullptr : &usual->second;
}

double scene::real(size_t object, const char *name, double otherwise) const
{
    const std::vector<value> *found = property(object, name);
    return found ? number_of((*found)[0], otherwise) : otherwise;
}

int64_t scene::whole(size_t object, const char *name, int64_t otherwise) const
{
    const std::vector<value> *found = property(object, name);
    return found ? whole_of((*found)[0], otherwise) : otherwise;
}

vec scene::vector(size_t object, const char *name, double otherwise) const
{
    const std::vector<value> *found = property(object, name);
    vec out;
    for (int k = 0; k < 3; ++k) {
        const size_t at = static_cast<size_t>(k);
        out[k] = found && at < found->size() ? number_of((*found)[at], otherwise) : otherwise;
    }
    return out;
}

std::vector<size_t> scene::below(size_t object, const char *kind, const char *sub) const
{
    std::vector<size_t> out;
    for (const link &l : objects[object].below) {
        const fbx::object &o = objects[l.other];
        if (o.kind == kind && (!sub || o.sub == sub)) out.push_back(l.other);
    }
    return out;
}

/* --- objects --- */

static void read_templates(scene &s)
{
    const node *definitions = s.file.top.child("Definitions");
    if (!definitions) return;
    for (const node &type : definitions->children)
        for (const node &t : type.children)
            if (type.name == "ObjectType" && t.name == "PropertyTemplate")
                s.templates[type.text(0)] = read_properties(t);
}

static void read_objects(scene &s)
{
    const node *list = s.file.top.child("Objects");
    if (!list) fail("FBX", "the file has no objects: it is truncated or damaged, export or copy it again");
    for (const node &n : list->children) {
        if (n.values.empty()) continue;
        const size_t name_at = std::holds_alternative<std::string>(n.values[0]) ? 0 : 1;
        const auto usual = s.templates.find(n.name);
        object o;
        o.from = &n;
        o.kind = n.name;
        o.name = name_of(s, n.text(name_at));
        o.sub = n.text(name_at + 1);
        o.own = read_properties(n);
        o.defaults = usual == s.templates.end() ? nullptr : &usual->second;
        if (s.index.count(id_of(n.values[0])))
            s.warn("the object '" + o.name + "'", " has the number of another one and took its connections");
        s.index[id_of(n.values[0])] = s.objects.size();
        s.objects.push_back(std::move(o));
    }
}

static void read_connections(scene &s)
{
    const node *links = s.file.top.child("Connections");
    if (!links) return;
    for (const node &c : links->children) {
        if (c.values.size() < 3) continue;
        const auto from = s.index.find(id_of(c.values[1])), to = s.index.find(id_of(c.values[2]));
        if (from == s.index.end() || to == s.index.end()) continue;
        s.objects[to->second].below.push_back({ from->second, c.text(3) });
        s.objects[from->second].above.push_back({ to->second, c.text(3) });
    }
}

/* --- settings --- */

/* The rows of the turn are the file's right, up and front. */
static void read_axes(scene &s, const properties &p)
{
    static const char *const names[3][2] = { { "CoordAxis", "CoordAxisSign" },
                                             { "UpAxis", "UpAxisSign" },
                                             { "FrontAxis", "FrontAxisSign" } };
    const auto get = [&](const char *name, int64_t otherwise) {
        const auto found = p.find(name);
        return found == p.end() || found->second.empty() ? otherwise : whole_of(found->second[0], otherwise);
    };
    mat turn;
    for (int row = 0; row < 3; ++row) {
        const int64_t axis = get(names[row][0], row);
        const double sign = get(names[row][1], 1) < 0 ? -1.0 : 1.0;
        for (int column = 0; column < 3; ++column) turn.column[column][row] = column == axis ? sign : 0.0;
    }
    const double det = determinant(turn);
    if (det < -0.5) {
        s.warn("the file's axes", " are left-handed, so left and right were swapped: export it with right-handed axes");
        for (int column = 0; column < 3; ++column) turn.column[column][2] = -turn.column[column][2];
    }
    if (std::fabs(det) > 0.5)
        s.to_y_up = turn;
    else
        s.warn("the file's axes", " are not three, and y was taken as up: export it again");
}

static void read_settings(scene &s)
{
    /* by TimeMode; 0 is the program's default, 14 the file's own */
    static const double rates[] = { 24.0, 120.0,        100.0,        60.0,         50.0,         48.0,   30.0,
                                    30.0, 30.0 / 1.001, 30.0 / 1.001, 25.0,         24.0,         1000.0, 24.0 / 1.001,
                                    0.0,  96.0,         72.0,         60.0 / 1.001, 120.0 / 1.001 };
    const node *objects = s.file.top.child("Objects"), *settings = s.file.top.child("GlobalSettings");
    if (!settings && objects) settings = objects->child("GlobalSettings");
    const properties p = settings ? read_properties(*settings) : properties();
    const auto get = [&](const char *name, double otherwise) {
        const auto found = p.find(name);
        return found == p.end() || found->second.empty() ? otherwise : number_of(found->second[0], otherwise);
    };
    const double unit = get("UnitScaleFactor", 1.0), mode = get("TimeMode", 0.0);
    const bool known = mode >= 0.0 && mode < static_cast<double>(sizeof rates / sizeof *rates);
    const double rate = mode == 14.0 ? get("CustomFrameRate", 24.0) : known ? rates[static_cast<size_t>(mode)] : 30.0;
    read_axes(s, p);
    s.unit_cm = unit > 1e-6 && unit < 1e6 ? unit : 1.0;
    if (s.unit_cm != unit) s.warn("the file's unit", " is impossible, and 1 cm was taken: use --unit-cm");
    s.rate_hz = rate >= 1.0 && rate <= 1000.0 ? rate : 30.0;
}

/* --- nodes --- */

/* Each model with the parent that it is connected to first. Without recursion: a file may be as deep as it likes. */
static void order_models(scene &s)
{
    std::map<size_t, size_t> parent;
    std::vector<std::pair<size_t, size_t>> open; /* object, place of its parent */
    size_t count = 0;
    for (size_t i = 0; i < s.objects.size(); ++i) {
        if (s.objects[i].kind != "Model") continue;
        ++count;
        for (const link &l : s.objects[i].above)
            if (s.objects[l.other].kind == "Model" && l.property.empty()) parent.insert({ i, l.other });
    }
    for (size_t i = s.objects.size(); i-- > 0;)
        if (s.objects[i].kind == "Model" && !parent.count(i)) open.push_back({ i, none });
    while (!open.empty()) {
        const auto [model, above] = open.back();
        const std::vector<link> &links = s.objects[model].below;
        open.pop_back();
        s.place[model] = s.models.size();
        s.models.push_back(model);
        s.parent.push_back(above);
        for (size_t k = links.size(); k-- > 0;) {
            const auto of_child = parent.find(links[k].other);
            if (of_child == parent.end() || of_child->second != model) continue;
            open.push_back({ links[k].other, s.models.size() - 1 });
            parent.erase(of_child); /* a connection may be given twice */
        }
    }
    if (s.models.size() < count) s.warn("nodes", " that are each other's parents were left out: export the file again");
}

/* --- what is not read --- */

static bool is_constraint(const object &o)
{
    return o.kind == "Constraint" && o.sub != "Character" && o.sub != "ControlSetPlug";
}

static void find_left_out(scene &s)
{
    for (size_t i = 0; i < s.objects.size(); ++i) {
        if (is_constraint(s.objects[i]))
            s.warn(place_of(s, i), " is a constraint, which moves nothing: bake animations on export");
    }
}

void read_scene(const std::string &bytes, scene &out)
{
    out.file = read_tree(bytes);
    if (out.file.cut) out.warn("the file", " ends without an end record: it may be truncated");
    read_templates(out);
    read_objects(out);
    read_connections(out);
    read_settings(out);
    order_models(out);
    find_left_out(out);
    read_takes(out);
    if (out.takes.empty()) read_takes6(out);
    plan_samples(out);
}

} // namespace fbx
