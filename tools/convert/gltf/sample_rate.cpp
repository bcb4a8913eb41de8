/* sample_rate.cpp: how many frames a clip needs.
 *
 * Frames are played with linear interpolation at a constant sample rate; the source's curves need not be linear, and
 * its keys lie at any time. So sample rates are tried, from the rate of the keys upwards, until the played frames stay
 * within a tolerance of the curves. */
#include "clips_internal.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "noh/clip.h"

#include "convert/clips/channel_sample.h"
#include "convert/clips/source_pose.h"
#include "convert/base/quat.h"

namespace gltf
{

static const double rate_max_hz = 120.0;       /* the highest that is chosen; keys on a denser grid keep theirs */
static const double sparse_rate_max_hz = 60.0; /* of a grid on which most frames have no key */
static const double rounding_s = 1e-6;         /* of key times, which are floats */

double frame_time_s(const timing &t, uint32_t frame)
{
    return static_cast<double>(frame) / t.sample_rate_hz;
}

static timing timing_at(double duration_s, double sample_rate_hz, uint64_t frames_max, const std::string &where)
{
    double steps = std::fmax(std::floor(duration_s * sample_rate_hz + 0.5), 1.0);
    if (!(steps + 1.0 <= static_cast<double>(frames_max)))
        fail(where,
             text("it lasts %g s: at %g Hz that is more than %llu frames, which is the limit; ask for a lower sample "
                  "rate",
                  duration_s, sample_rate_hz, static_cast<unsigned long long>(frames_max)));
    double exact_hz = steps / duration_s;
    /* the last key's time is a rounded float */
    bool whole = std::fabs(exact_hz - sample_rate_hz) <= 1e-6 * sample_rate_hz;
    return { whole ? sample_rate_hz : exact_hz, static_cast<uint32_t>(steps) + 1, 0.0, 0.0, 0.0 };
}

/* --- the sample rate of the keys --- */

static std::vector<double> key_times(const std::vector<track> &tracks)
{
    std::vector<double> times;
    for (const track &t : tracks) times.insert(times.end(), t.channel->times, t.channel->times + t.channel->key_count);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

static bool on_grid(const std::vector<double> &times, double sample_rate_hz)
{
    for (double time : times) {
        double frame = time * sample_rate_hz;
        if (std::fabs(frame - std::floor(frame + 0.5)) > 2e-3 + 1.2e-7 * frame) return false;
    }
    return true;
}

static bool worth_its_frames(const std::vector<double> &times, double sample_rate_hz)
{
    return sample_rate_hz <= sparse_rate_max_hz ||
           static_cast<double>(times.size()) * 2.0 > times.back() * sample_rate_hz;
}

/* The coarsest grid on which all keys lie: whole numbers of Hz are tried first, then television's rates, then any. 0 if
 * there is none. */
static double grid_rate(const std::vector<double> &times)
{
    static const double television_hz[] = { 24.0, 30.0, 60.0, 120.0 };
    for (double rate = 1.0; rate <= rate_max_hz; rate += 1.0)
        if (on_grid(times, rate)) return worth_its_frames(times, rate) ? rate : 0.0;
    for (double rate : television_hz)
        if (on_grid(times, rate / 1.001) && worth_its_frames(times, rate)) return rate / 1.001;
    double uniform = static_cast<double>(times.size() - 1) / (times.back() - times.front());
    return times.size() > 2 && on_grid(times, uniform) ? uniform : 0.0;
}

/* Whether at least half of the steps from key to key are no longer than one at this sample rate. */
static double median_rate(const std::vector<double> &times)
{
    std::vector<double> steps;
    for (size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
    return 1.0 / steps[steps.size() / 2];
}

/* Whether frames lie at whole ticks, at which the runtime samples. */
static bool on_ticks(double sample_rate_hz)
{
    const double ticks = NOH_TICKS_PER_SECOND / sample_rate_hz;
    return std::fabs(ticks - std::floor(ticks + 0.5)) < 1e-6;
}

static std::vector<double> rates_to_try(const std::vector<double> &times, double grid)
{
    std::vector<double> rates;
    if (grid > 0.0) {
        rates.push_back(grid);
        for (double factor : { 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 24.0, 30.0, 40.0, 60.0, 120.0 })
            if (grid * factor <= rate_max_hz * 1.001 && (on_ticks(grid * factor) || !on_ticks(grid)))
                rates.push_back(grid * factor);
        return rates;
    }
    rates = { 30.0, 60.0, rate_max_hz };
    if (times.size() > 2) rates.push_back(std::fmin(std::fmax(median_rate(times), 10.0), rate_max_hz));
    std::sort(rates.begin(), rates.end());
    return rates;
}

/* --- the error of a sample rate --- */

static void sample(const track &t, double time_s, double near_s, std::vector<double> &out)
{
    out.resize(t.channel->width);
    (void)channel_sample(t.channel, time_s, near_s, out.data()); /* gltf_clips.cpp warns of what has no direction */
}

static double difference_cm(const track &t, const std::vector<double> &a, const std::vector<double> &b)
{
    if (t.channel->path == MODEL_PATH_ROTATION) return quat_angle(a.data(), b.data()) * t.lever_cm;
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
        double d = std::fabs(a[i] - b[i]) * (t.radius_cm.empty() ? 1.0 : t.radius_cm[i]);
        sum += t.radius_cm.empty() ? d * d : d; /* a distance, or else weights, which may all push in one direction */
    }
    return t.radius_cm.empty() ? std::sqrt(sum) * t.lever_cm : sum;
}

static std::vector<double> played(const track &t, const std::vector<double> &a, const std::vector<double> &b, double at)
{
    std::vector<double> out(a.size());
    if (t.channel->path == MODEL_PATH_ROTATION)
        quat_nlerp(a.data(), b.data(), at, out.data());
    else
        for (size_t i = 0; i < a.size(); ++i) out[i] = a[i] + (b[i] - a[i]) * at;
    return out;
}

static void add_keys_between(const model_channel &c, double from_s, double to_s, double near_s,
                             std::vector<double> &places)
{
    const float *key = std::upper_bound(c.times, c.times + c.key_count, static_cast<float>(from_s + near_s));
    for (; key < c.times + c.key_count && static_cast<double>(*key) < to_s - near_s; ++key)
        if (static_cast<double>(*key) > from_s)
            places.push_back((static_cast<double>(*key) - from_s) / (to_s - from_s));
}

/* The times between two frames at which errors are measured: three, and the keys in between. */
static std::vector<double> places_between(const std::vector<track> &tracks, double from_s, double to_s, double near_s)
{
    std::vector<double> places = { 0.2113, 0.5,
                                   0.7887 }; /* between linear keys rotations stray most at the outer two */
    for (const track &t : tracks) add_keys_between(*t.channel, from_s, to_s, near_s, places);
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
}

/* Stops above the limit. */
static double track_error(const track &track, const timing &t, double limit_cm)
{
    std::vector<double> a, b, curve;
    double worst = 0.0;
    sample(track, 0.0, t.near_s, b);
    for (uint32_t frame = 1; frame < t.frame_count && worst <= limit_cm; ++frame) {
        double from = frame_time_s(t, frame - 1), to = frame_time_s(t, frame);
        a.swap(b);
        sample(track, to, t.near_s, b);
        for (double at : places_between({ track }, from, to, t.near_s)) {
            sample(track, from + (to - from) * at, 0.0, curve);
            worst = std::fmax(worst, difference_cm(track, played(track, a, b, at), curve));
        }
    }
    return worst;
}

/* --- whole poses --- */

static void sample_pose(const std::vector<track> &tracks, double time_s, double near_s, std::vector<double> &locals)
{
    for (const track &t : tracks)
        if (t.joint != MODEL_NONE) source_channel(t.channel, t.joint, time_s, near_s, locals.data());
}

/* The frames and the times between them of all tracks together. Stops above the limit. */
static double vertex_error(const std::vector<track> &tracks, const moved &what, const timing &t, double limit_cm)
{
    const raw_skeleton &skeleton = *what.skeleton;
    const uint32_t count = skeleton.joint_count;
    std::vector<double> a(size_t{ count } * SOURCE_LOCAL), from(size_t{ count } * 12), to(from), scratch(count);
    double worst = 0.0;
    source_rest(&skeleton, a.data());
    std::vector<double> b = a, curve = a, shown = a;
    sample_pose(tracks, 0.0, t.near_s, b);
    for (uint32_t frame = 1; frame < t.frame_count && worst <= limit_cm / skeleton.unit_cm; ++frame) {
        const double begin = frame_time_s(t, frame - 1), end = frame_time_s(t, frame);
        a.swap(b);
        sample_pose(tracks, end, t.near_s, b);
        for (double at : places_between(tracks, begin, end, t.near_s)) {
            sample_pose(tracks, begin + (end - begin) * at, 0.0, curve);
            source_blend(count, a.data(), b.data(), at, shown.data());
            source_object(&skeleton, curve.data(), from.data());
            source_object(&skeleton, shown.data(), to.data());
            worst = moved_vertices_apart(what.vertices, from.data(), to.data(), worst, scratch.data());
        }
    }
    return worst * skeleton.unit_cm;
}

static double error_of(const std::vector<track> &tracks, const moved &what, const timing &t, double limit_cm)
{
    double worst = 0.0;
    for (const track &track : tracks)
        if (track.channel->key_count > 1 && !track.seen && worst <= limit_cm)
            worst = std::fmax(worst, track_error(track, t, limit_cm));
    if (what.vertices->vertex_count > 0 && worst <= limit_cm)
        worst = std::fmax(worst, vertex_error(tracks, what, t, limit_cm));
    return worst;
}

/* A shorter animation is one frame, without a rate. */
static const double shortest_s = 1e-6;

timing choose_timing(const std::vector<track> &tracks, const moved &what, double duration_s, double sample_rate_hz,
                     double tolerance_cm, uint64_t frames_max, const std::string &where)
{
    const double no_limit = std::numeric_limits<double>::infinity();
    if (!(duration_s >= shortest_s)) return { sample_rate_hz > 0.0 ? sample_rate_hz : 30.0, 1, 0.0, 0.0, 0.0 };
    std::vector<double> times = key_times(tracks);
    const double grid = grid_rate(times);
    std::vector<double> rates = sample_rate_hz > 0.0 ? std::vector<double>{ sample_rate_hz }
                                                     : rates_to_try(times, grid);
    timing t = { 0.0, 0, 0.0, 0.0, grid };
    for (double rate : rates) {
        t = timing_at(duration_s, rate, frames_max, where);
        t.keys_hz = grid;
        t.near_s = on_grid(times, t.sample_rate_hz) ? 2.5e-3 / t.sample_rate_hz : rounding_s;
        t.error_cm = error_of(tracks, what, t, tolerance_cm);
        if (t.error_cm <= tolerance_cm) return t;
    }
    t.error_cm = error_of(tracks, what, t, no_limit);
    return t;
}

} // namespace gltf
