/* fbx_tree.h: an FBX file as a tree of named nodes with values: binary (either byte order, records of 32 and of 64
 * bits) and ASCII. */
#ifndef NOH_CONVERT_FBX_FBX_TREE_H
#define NOH_CONVERT_FBX_FBX_TREE_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace fbx
{

/* Why the file is refused; see model_error. */
struct failure {
    std::string what, where;
};
[[noreturn]] void fail(const std::string &where, const std::string &what);

struct numbers {
    std::vector<double> values;
    bool whole = true; /* all were written as integers */
};
using value = std::variant<int64_t, double, std::string, numbers>;

double number_of(const value &v, double otherwise = 0.0);
int64_t whole_of(const value &v, int64_t otherwise = 0);
const std::string &text_of(const value &v); /* "" where it is none */

struct node {
    std::string name;
    std::vector<value> values;
    std::vector<node> children;

    const node *child(const char *named) const;
    double number(size_t at, double otherwise = 0.0) const;
    int64_t whole(size_t at, int64_t otherwise = 0) const;
    const std::string &text(size_t at) const;
    /* An array, the values of the line, or the array in its child "a" (ASCII from version 7 on). */
    numbers list() const;
};

/* The values of a child as a list; empty without that child. */
numbers list_of(const node &parent, const char *child);

struct tree {
    node top;
    int64_t version = 0;
    bool ascii = false;
    bool cut = false; /* it ends without the record that ends a file */
};

static const int depth_max = 64; /* of nodes in nodes; exporters have ten */

/* All throw failure. */
tree read_tree(const std::string &bytes);
void read_binary(const std::string &bytes, tree &out);
void read_ascii(const std::string &bytes, tree &out);
bool is_binary(const std::string &bytes);

} // namespace fbx
#endif
