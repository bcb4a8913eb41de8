/* gltf_file.cpp: used by every part of the reader: failures, warnings, names, and the limit on a model's size. */
#include "gltf_internal.h"

#include <cfloat>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace gltf
{

/* A model may be this much larger than its file: sparse targets become dense ones. */
static const uint64_t expansion_base = 256u << 20, expansion_factor = 256;

void fail(const std::string &where, const std::string &what)
{
    throw failure{ what, where };
}

std::string text(const char *format, ...)
{
    char line[512];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    return line;
}

static uint64_t charge_limit(const file &f)
{
    return expansion_base + expansion_factor * f.input_bytes;
}

uint64_t uncharged(const file &f)
{
    return charge_limit(f) - f.output_bytes;
}

void charge(file &f, uint64_t count, uint64_t element_size, const std::string &where)
{
    const uint64_t limit = charge_limit(f);
    if (count > limit / element_size || f.output_bytes + count * element_size > limit)
        fail(where, text("the decoded model would need more than %llu MiB, which a file of this size cannot honestly "
                         "hold",
                         static_cast<unsigned long long>(limit >> 20)));
    f.output_bytes += count * element_size;
}

char *copy_string(const std::string &string)
{
    char *copy = model_string(string.c_str());
    if (!copy) throw std::bad_alloc();
    return copy;
}

std::string printable(const std::string &name)
{
    const size_t limit = 40;
    std::string out = name.substr(0, limit);
    /* do not cut a UTF-8 sequence */
    while (name.size() > out.size() && !out.empty() && (static_cast<unsigned char>(name[out.size()]) & 0xc0) == 0x80)
        out.pop_back();
    for (char &c : out)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return out;
}

std::string name_or(const std::string &name, const char *kind, size_t index)
{
    return name.empty() || name[0] == '\0' ? kind + ("_" + std::to_string(index)) : name;
}

float to_float(double value, const std::string &where)
{
    if (!(std::fabs(value) <= static_cast<double>(FLT_MAX)))
        fail(where, text("the number %g is too large for a float", value));
    return static_cast<float>(value);
}

void leave_out(file &f, const std::string &where, const std::string &what)
{
    auto known = f.loss_of.emplace(what, f.losses.size());
    if (known.second) f.losses.push_back({ where, what, 0 });
    ++f.losses[known.first->second].count;
}

std::string clause_of(const left_out &loss)
{
    return loss.what[0] == ' ' ? "a part" + loss.what : loss.what.substr(loss.what[0] == ':' ? 2 : 0);
}

std::string old_version(const std::string &version)
{
    return "this is glTF version '" + printable(version) +
           "', and only version 2 is read: convert version 1 with gltf-pipeline (gltf-pipeline -i OLD -o NEW)";
}

void warn_left_out(file &f)
{
    for (const left_out &loss : f.losses) {
        std::string others = loss.count > 1 ? text(" (and %zu more like it)", loss.count - 1) : "";
        warn(f, "%s%s%s", loss.first.c_str(), loss.what.c_str(), others.c_str());
    }
}

} // namespace gltf
