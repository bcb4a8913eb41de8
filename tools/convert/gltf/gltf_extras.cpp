/* gltf_extras.cpp: an animation's extras: callback keys, sync markers, loops.
 *
 *     "extras": {"loop": true}
 *
 *     "extras": {"events": [{"time": 0.5, "name": "step", "payload": 7, "weightMin": 0.1}]}
 *
 *     "extras": {"events": [{"time": 0.25, "name": "left", "marker": true}]}
 *
 * The last line is a sync marker. payload is a number, or a string as in events_read.h for values that neither a 32-bit
 * integer nor a double can hold. glTF does not define extras, so a key that is not understood is left out with a
 * warning. */
#include "gltf_internal.h"

#include <cmath>
#include <cstring>

#include "convert/clips/events_read.h"
#include "convert/clips/raw_set.h"

namespace gltf
{

static const double time_rounding_s = 1e-4;

static bool number_member(const tinygltf::Value &object, const char *key, double &out)
{
    const tinygltf::Value &value = object.Get(key);
    if (!value.IsNumber()) return false;
    out = value.GetNumberAsDouble();
    return true;
}

/* Converted to text, so that the rules of event files apply here too. */
static bool read_payload(const tinygltf::Value &value, uint8_t *out)
{
    std::string written;
    if (value.IsString())
        written = value.Get<std::string>();
    else if (value.IsInt())
        written = text("%d", value.Get<int>());
    else if (value.IsNumber())
        written = text("%.17e", value.GetNumberAsDouble());
    return event_payload(written.c_str(), written.size(), out);
}

/* Why a key cannot be kept, or null. Fills all of `out` but the name. */
static const char *read_key(const tinygltf::Value &key, double duration_s, model_event &out)
{
    double weight_min = 0.0;
    if (!key.IsObject() || !key.Get("name").IsString() || key.Get("name").Get<std::string>().empty())
        return "it has no name";
    if (!number_member(key, "time", out.time_s)) return "it has no time";
    if (!(out.time_s >= 0.0 && out.time_s <= duration_s + time_rounding_s))
        return "its time is not within the animation";
    if (key.Has("weightMin") &&
        (!number_member(key, "weightMin", weight_min) || !(weight_min >= 0.0 && weight_min <= 1e6)))
        return "its weightMin is not a number of 0 or more";
    if (key.Has("payload") && !read_payload(key.Get("payload"), out.payload))
        return "its payload is not a number that fits 8 bytes";
    if (key.Has("marker") && !key.Get("marker").IsBool()) return "its marker is neither true nor false";
    out.is_marker = key.Has("marker") && key.Get("marker").Get<bool>();
    if (out.is_marker && (key.Has("payload") || key.Has("weightMin")))
        return "a sync marker has no payload and no weight";
    out.time_s = std::fmin(out.time_s, duration_s);
    out.weight_min = static_cast<float>(weight_min);
    return nullptr;
}

static size_t count_to_read(file &f, const tinygltf::Value &keys, const std::string &where)
{
    if (keys.ArrayLen() <= RAW_EVENTS_MAX) return keys.ArrayLen();
    warn(f, "%s: only the first %u events were read, which is the limit", where.c_str(), RAW_EVENTS_MAX);
    return RAW_EVENTS_MAX;
}

void read_extras(file &f, const tinygltf::Animation &a, const std::string &where, model_clip &out)
{
    const tinygltf::Value none;
    out.loop = a.extras.IsObject() && a.extras.Get("loop").IsBool() && a.extras.Get("loop").Get<bool>();
    const tinygltf::Value &keys = a.extras.IsObject() ? a.extras.Get("events") : none;
    if (!keys.IsArray() || keys.ArrayLen() == 0) return;
    size_t count = count_to_read(f, keys, where);
    out.events = allocate<model_event>(f, count, where);
    for (size_t i = 0; i < count; ++i) {
        const tinygltf::Value &key = keys.Get(static_cast<int>(i));
        model_event event = {};
        if (const char *reason = read_key(key, static_cast<double>(out.duration_s), event)) {
            leave_out(f, where + text(" event %zu", i), std::string(" was skipped: ") + reason);
            continue;
        }
        event.name = copy_string(key.Get("name").Get<std::string>());
        out.events[out.event_count++] = event;
    }
}

} // namespace gltf
