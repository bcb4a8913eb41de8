/* fbx_scene.h: what a file says: objects with properties and connections, settings, nodes, takes. */
#ifndef NOH_CONVERT_FBX_FBX_SCENE_H
#define NOH_CONVERT_FBX_FBX_SCENE_H

#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fbx_curve.h"
#include "fbx_math.h"
#include "fbx_tree.h"

namespace fbx
{

static const size_t none = static_cast<size_t>(-1);

using properties = std::map<std::string, std::vector<value>>;

/* `property`: that it is connected to; empty where the objects themselves are. */
struct link {
    size_t other;
    std::string property;
};

struct object {
    std::string name, kind, sub; /* kind: Model, Geometry, ...; sub: Mesh, Skin, ... */
    const node *from = nullptr;
    properties own;
    const properties *defaults = nullptr; /* the template of its kind, or null */
    std::vector<link> below, above;       /* what is connected to it; what it is connected to */
};

/* What a layer of a take does to one property of one object: curves, or constants where they are null. NaN: nothing. */
struct channel {
    const curve *curves[3] = { nullptr, nullptr, nullptr };
    vec constant = { { NAN, NAN, NAN } };
};

enum class blending { add, override };

struct layer {
    size_t object = none;
    bool is_base = false; /* the first: it replaces the rest value, whatever its blending */
    blending mode = blending::add;
    bool rotation_by_channel = false, scaling_added = false;
    double weight = 1.0;
    const curve *weight_curve = nullptr; /* percent */
    std::map<std::pair<size_t, std::string>, channel> channels;
};

struct take {
    std::string name;
    double from_s = 0.0, to_s = 0.0;
    std::vector<double> samples; /* the times at which it is read; none: it has no keys, or is too long */
    std::vector<layer> layers;
};

/* Something that was left out or changed: `what` continues the sentence that `first` begins. */
struct note {
    std::string first, what;
    size_t count;
};

struct scene {
    tree file;
    std::vector<object> objects;
    std::map<std::string, size_t> index; /* by id */
    std::map<std::string, properties> templates;
    std::deque<curve> curves;
    std::map<size_t, const curve *> curve_of;
    std::vector<take> takes;
    std::vector<size_t> models;     /* objects that are nodes: parents first, depth first */
    std::vector<size_t> parent;     /* [models] place in models, or none */
    std::map<size_t, size_t> place; /* in models, by object */
    double unit_cm = 1.0, rate_hz = 30.0;
    mat to_y_up;
    std::vector<note> notes;

    /* One warning for each `what`, which names the first place and counts the others. */
    void warn(const std::string &where, const std::string &what);
    /* A property of an object or of its template; null: neither has it. */
    const std::vector<value> *property(size_t object, const char *name) const;
    double real(size_t object, const char *name, double otherwise) const;
    int64_t whole(size_t object, const char *name, int64_t otherwise) const;
    vec vector(size_t object, const char *name, double otherwise) const;
    /* Objects of this kind connected to it, of this sub kind if it is not null. */
    std::vector<size_t> below(size_t object, const char *kind, const char *sub) const;
};

/* --- fbx_scene.cpp --- */
/* Throws failure. Takes are read, too. */
void read_scene(const std::string &bytes, scene &out);
std::string id_of(const value &v);
/* Bytes that are not UTF-8 become _ and their codes. */
std::string to_utf8(const std::string &given, bool *changed);
/* The name without its class, in UTF-8. */
std::string name_of(scene &s, const std::string &given);
/* "kind 'name'", for messages. */
std::string place_of(const scene &s, size_t object);

/* --- fbx_takes.cpp: stacks and layers; fbx_takes6.cpp: takes of version 6 --- */
void read_takes(scene &s);
void plan_samples(scene &s);
void read_takes6(scene &s);

} // namespace fbx
#endif
