/* fbx_ascii.cpp: ASCII files: `Name: value, value {` children `}`, comments from a semicolon to the line's end. Long
 * arrays are written `Name: *COUNT { a: ... }` from version 7 on, and as plain lists before. */
#include "fbx_tree.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace fbx
{

struct ascii_reader {
    const std::string &bytes;
    size_t at;

    [[noreturn]] void refuse(const char *what) const;
    char now() const;
    void skip_spaces();
    void skip_blank();
    bool skip_comma();
    std::string token();
    bool read_number(value &out);
    bool skip_no_number();
    std::string read_quoted();
    value read_array();
    value read_value();
    bool has_values();
    void read_values(node &out);
    void read_list(node &parent, int depth);
};

void ascii_reader::refuse(const char *what) const
{
    const std::ptrdiff_t before = static_cast<std::ptrdiff_t>(std::min(at, bytes.size()));
    fail("line " + std::to_string(std::count(bytes.begin(), bytes.begin() + before, '\n') + 1), what);
}

/* 0 behind the end. */
char ascii_reader::now() const
{
    return at < bytes.size() ? bytes[at] : '\0';
}

static bool is_in(char c, const char *set)
{
    return c && strchr(set, c);
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_word(char c)
{
    return isalnum(static_cast<unsigned char>(c)) || is_in(c, "_-.+|") || (c & 0x80);
}

void ascii_reader::skip_spaces()
{
    while (is_in(now(), " \t")) ++at;
}

/* Spaces, line ends and comments. */
void ascii_reader::skip_blank()
{
    while (is_in(now(), " \t\r\n;")) {
        if (bytes[at] == ';')
            at = std::min(bytes.find('\n', at), bytes.size());
        else
            ++at;
    }
}

/* A list goes on behind a comma, which may begin the next line. */
bool ascii_reader::skip_comma()
{
    const size_t was = at;
    skip_blank();
    if (now() == ',') {
        ++at;
        skip_blank();
        return true;
    }
    at = was;
    return false;
}

std::string ascii_reader::token()
{
    const size_t from = at;
    while (is_word(now())) ++at;
    return bytes.substr(from, at - from);
}

static const double no_number = std::numeric_limits<double>::quiet_NaN();

/* A word in place of a number, such as snan, or what is left of one; false: there is none. */
bool ascii_reader::skip_no_number()
{
    const size_t from = at;
    while (is_word(now()) || is_in(now(), "()#")) ++at;
    return at > from;
}

bool ascii_reader::read_number(value &out)
{
    const char *from = bytes.c_str() + at;
    char *end = nullptr, *real_end = nullptr;
    const int64_t whole = strtoll(from, &end, 10);
    out = whole;
    if (end == from || is_word(*end)) {
        const double real = strtod(from, &real_end);
        if (real_end == from) return false;
        if (real_end > end) {
            out = real;
            end = real_end;
        }
        if (*end == '#' || !std::isfinite(real)) { /* Windows: 1.#IND, 1.#INF; others: nan(ind), infty */
            at = static_cast<size_t>(end - bytes.c_str());
            (void)skip_no_number();
            out = no_number;
            return true;
        }
    }
    at = static_cast<size_t>(end - bytes.c_str());
    return true;
}

std::string ascii_reader::read_quoted()
{
    static const char mark[] = "&quot;";
    const size_t from = at + 1, end = bytes.find('"', from);
    if (end == std::string::npos) refuse("a text has no closing quotation mark: the file is truncated or damaged");
    std::string out;
    for (size_t i = from; i < end;) {
        const bool quote = bytes.compare(i, sizeof mark - 1, mark) == 0;
        out += quote ? '"' : bytes[i];
        i += quote ? sizeof mark - 1 : 1;
    }
    at = end + 1;
    return out;
}

value ascii_reader::read_array()
{
    numbers out;
    value one;
    skip_blank();
    while (at < bytes.size()) {
        if (!read_number(one)) {
            if (!skip_no_number()) break;
            one = no_number;
        }
        const int64_t *whole = std::get_if<int64_t>(&one);
        out.values.push_back(whole ? static_cast<double>(*whole) : std::get<double>(one));
        out.whole = out.whole && whole;
        if (!skip_comma()) break;
    }
    return out;
}

value ascii_reader::read_value()
{
    value out;
    if (now() == '"') return read_quoted();
    if (now() == ',' || (is_word(now()) && read_number(out))) return out; /* `Content: , "..."`: the first is empty */
    const std::string word = token();
    if (word.empty()) refuse("a value is missing: the file is truncated or damaged");
    return word;
}

/* Whether the line has values. Blender 2.7 begins the keys of a curve on the next line. */
bool ascii_reader::has_values()
{
    skip_spaces();
    if (at < bytes.size() && !is_in(now(), "\r\n{;}")) return true;
    skip_blank();
    return is_digit(now()) || now() == '-' || now() == '"';
}

void ascii_reader::read_values(node &out)
{
    if (out.name == "a") {
        out.values.push_back(read_array());
        return;
    }
    if (!has_values()) return;
    if (now() == '*') { /* the count of the array in the braces */
        ++at;
        (void)token();
    } else {
        do {
            out.values.push_back(read_value());
        } while (skip_comma());
    }
    skip_blank();
}

/* The children of a node up to its brace; of the top, all. */
void ascii_reader::read_list(node &parent, int depth)
{
    if (depth > depth_max) refuse("nodes are nested too deeply: the file is damaged");
    for (skip_blank(); at < bytes.size() && bytes[at] != '}'; skip_blank()) {
        node child;
        child.name = token();
        if (at >= bytes.size()) refuse("the file ends inside a name: it is truncated, export or copy it again");
        if (now() != ':') refuse("a name with a colon is missing: the file is damaged, or no FBX");
        ++at;
        read_values(child);
        if (now() == '{') {
            ++at;
            read_list(child, depth + 1);
            if (now() != '}') refuse("a brace is not closed: the file is truncated, export or copy it again");
            ++at;
        }
        parent.children.push_back(std::move(child));
    }
    if (depth == 0 && at < bytes.size()) refuse("a brace is closed twice: the file is damaged");
}

void read_ascii(const std::string &bytes, tree &out)
{
    if (bytes.compare(0, 18, "Kaydara FBX Binary") == 0)
        fail("byte 0",
             "this is a binary FBX file that was changed when it was copied as text: copy it again as binary");
    if (bytes.find("FBXHeaderExtension") == std::string::npos)
        fail("byte 0", "this is not an FBX file: it is neither binary nor has the header of an ASCII one");
    ascii_reader reader{ bytes, bytes.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3u : 0u }; /* a byte order mark */
    out.ascii = true;
    reader.read_list(out.top, 0);
    const node *header = out.top.child("FBXHeaderExtension");
    const node *version = header ? header->child("FBXVersion") : nullptr;
    out.version = version ? version->whole(0) : 0;
}

} // namespace fbx
