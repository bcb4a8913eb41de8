/* fbx_tree.cpp: values of nodes, and which of the two forms a file has. */
#include "fbx_tree.h"

#include <cmath>

namespace fbx
{

static const int64_t version_min = 6000, version_max = 7999;

void fail(const std::string &where, const std::string &what)
{
    throw failure{ what, where };
}

/* --- values --- */

/* A file may give any number where a whole one belongs. */
static int64_t rounded(double x)
{
    return std::fabs(x) < 9e18 ? static_cast<int64_t>(x) : 0;
}

double number_of(const value &v, double otherwise)
{
    if (const int64_t *i = std::get_if<int64_t>(&v)) return static_cast<double>(*i);
    if (const double *d = std::get_if<double>(&v)) return std::isfinite(*d) ? *d : otherwise;
    return otherwise;
}

int64_t whole_of(const value &v, int64_t otherwise)
{
    if (const int64_t *i = std::get_if<int64_t>(&v)) return *i;
    if (const double *d = std::get_if<double>(&v)) return rounded(*d);
    return otherwise;
}

const std::string &text_of(const value &v)
{
    static const std::string none;
    const std::string *s = std::get_if<std::string>(&v);
    return s ? *s : none;
}

const node *node::child(const char *named) const
{
    for (const node &c : children)
        if (c.name == named) return &c;
    return nullptr;
}

double node::number(size_t at, double otherwise) const
{
    return at < values.size() ? number_of(values[at], otherwise) : otherwise;
}

int64_t node::whole(size_t at, int64_t otherwise) const
{
    return at < values.size() ? whole_of(values[at], otherwise) : otherwise;
}

const std::string &node::text(size_t at) const
{
    static const std::string none;
    return at < values.size() ? text_of(values[at]) : none;
}

numbers node::list() const
{
    numbers out;
    if (const node *a = child("a")) return a->list();
    if (values.size() == 1)
        if (const numbers *all = std::get_if<numbers>(&values[0])) return *all;
    out.values.reserve(values.size());
    for (const value &v : values) {
        out.values.push_back(number_of(v));
        out.whole = out.whole && std::holds_alternative<int64_t>(v);
    }
    return out;
}

numbers list_of(const node &parent, const char *child)
{
    const node *found = parent.child(child);
    return found ? found->list() : numbers();
}

/* --- the file --- */

tree read_tree(const std::string &bytes)
{
    tree t;
    if (is_binary(bytes))
        read_binary(bytes, t);
    else
        read_ascii(bytes, t);
    if (t.version < version_min)
        fail(
            "FBX header",
            "this is FBX of version " + std::to_string(t.version) +
                ", which is not read: export it again as FBX 2011 or later, or convert it by Autodesk's FBX Converter");
    if (t.version > version_max)
        fail("FBX header", "this is FBX of version " + std::to_string(t.version) +
                               ", which is newer than any that is read: export it as FBX 2020, or as glTF");
    return t;
}

} // namespace fbx
