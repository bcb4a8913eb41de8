#include "channel_sample.h"

#include <math.h>

#include "convert/base/quat.h"

/* CUBICSPLINE keys hold in-tangent, value, out-tangent. */
static const float *key_part(const model_channel *c, uint32_t key, uint32_t part)
{
    return c->values + ((size_t)key * 3 + part) * c->width;
}

const float *channel_key(const model_channel *c, uint32_t key)
{
    return c->interpolation == MODEL_CUBICSPLINE ? key_part(c, key, 1) : c->values + (size_t)key * c->width;
}

/* The last key at or before a time; 0 before the first. */
static uint32_t key_before(const model_channel *c, double time_s)
{
    uint32_t low = 0, high = c->key_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if ((double)c->times[middle] <= time_s)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void copy_key(const model_channel *c, uint32_t key, double *out)
{
    const float *value = channel_key(c, key);
    for (uint32_t i = 0; i < c->width; ++i) out[i] = (double)value[i];
}

static int take_key(const model_channel *c, uint32_t key, double *out)
{
    copy_key(c, key, out);
    return c->path == MODEL_PATH_ROTATION && !quat_normalize(out);
}

static int slerp_keys(const model_channel *c, uint32_t key, double t, double *out)
{
    double a[4], b[4];
    if (take_key(c, key, a) || take_key(c, key + 1, b)) return 1;
    quat_slerp(a, b, t, out);
    return 0;
}

static void lerp_keys(const model_channel *c, uint32_t key, double t, double *out)
{
    const float *a = channel_key(c, key), *b = channel_key(c, key + 1);
    for (uint32_t i = 0; i < c->width; ++i) out[i] = (double)a[i] + ((double)b[i] - (double)a[i]) * t;
}

static int spline_keys(const model_channel *c, uint32_t key, double t, double *out)
{
    const double step = (double)c->times[key + 1] - (double)c->times[key], t2 = t * t, t3 = t2 * t;
    const float *a = key_part(c, key, 1), *leave = key_part(c, key, 2);
    const float *b = key_part(c, key + 1, 1), *arrive = key_part(c, key + 1, 0);
    for (uint32_t i = 0; i < c->width; ++i)
        out[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * (double)a[i] + step * (t3 - 2.0 * t2 + t) * (double)leave[i] +
                 (3.0 * t2 - 2.0 * t3) * (double)b[i] + step * (t3 - t2) * (double)arrive[i];
    return c->path == MODEL_PATH_ROTATION && !quat_normalize(out);
}

static int between_keys(const model_channel *c, uint32_t key, double t, double *out)
{
    if (c->interpolation == MODEL_CUBICSPLINE) return spline_keys(c, key, t, out);
    if (c->path == MODEL_PATH_ROTATION) return slerp_keys(c, key, t, out);
    lerp_keys(c, key, t, out);
    return 0;
}

int channel_sample(const model_channel *c, double time_s, double snap_s, double *out)
{
    const uint32_t key = key_before(c, time_s);
    const double before = (double)c->times[key];
    if (time_s <= before + snap_s || key + 1 == c->key_count) return take_key(c, key, out);
    const double after = (double)c->times[key + 1];
    if (after - time_s <= snap_s) return take_key(c, key + 1, out);
    if (c->interpolation == MODEL_STEP) return take_key(c, key, out);
    if (!between_keys(c, key, (time_s - before) / (after - before), out)) return 0;
    (void)take_key(c, key, out);
    return 1;
}
