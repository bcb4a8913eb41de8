#include "anim/weight_clip.h"

noh_result noh_pack_weight_clip(const noh_pack *pack, uint32_t index, noh_weight_clip *clip)
{
    if (index >= pack->clip_count) {
        return NOH_ERR_NOT_FOUND;
    }
    clip->pack = pack;
    clip->name = noh_pack_chunk_name(pack, pack->first_clip + index);
    clip->bytes = pack->bytes + pack->chunks[pack->first_clip + index].offset;
    clip->header = (const noh_weight_clip_header *)(const void *)clip->bytes;
    clip->channels = (const noh_weight_channel *)(const void *)(clip->bytes + clip->header->channels_offset);
    return NOH_OK;
}

/* The last key at or before the time; the first key if there is none. */
static uint32_t find_key(const float *times, uint32_t count, float time_s)
{
    uint32_t low = 0, high = count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (times[middle] <= time_s) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static void copy_weights(const float *from, uint32_t width, float *to)
{
    for (uint32_t i = 0; i < width; i++) {
        to[i] = from[i];
    }
}

static void sample_linear(const float *a, const float *b, float s, uint32_t width, float *weights)
{
    for (uint32_t i = 0; i < width; i++) {
        weights[i] = a[i] * (1.0f - s) + b[i] * s;
    }
}

/* Keys are [3][width]: in-tangent, value, out-tangent; tangents are per second. */
static void sample_cubic(const float *a, const float *b, float s, float interval, uint32_t width, float *weights)
{
    float s2 = s * s, s3 = s2 * s;
    float value_a = 2.0f * s3 - 3.0f * s2 + 1.0f, tangent_a = interval * (s3 - 2.0f * s2 + s);
    float value_b = -2.0f * s3 + 3.0f * s2, tangent_b = interval * (s3 - s2);
    for (uint32_t i = 0; i < width; i++) {
        weights[i] = value_a * a[width + i] + tangent_a * a[2u * width + i] + value_b * b[width + i] + tangent_b * b[i];
    }
}

void noh_weight_clip_sample(const noh_weight_clip *clip, uint32_t channel, float time_s, float *weights)
{
    const noh_weight_channel *c = &clip->channels[channel];
    const float *times = (const float *)(const void *)(clip->bytes + c->times_offset);
    const float *values = (const float *)(const void *)(clip->bytes + c->values_offset);
    uint32_t cubic = c->interpolation == NOH_WEIGHTS_CUBIC, key = find_key(times, c->key_count, time_s);
    size_t stride = (size_t)c->width * (cubic ? 3u : 1u);
    const float *a = values + key * stride;
    float interval, s;
    if (time_s <= times[0] || key + 1 >= c->key_count || c->interpolation == NOH_WEIGHTS_STEP) {
        copy_weights(a + (cubic ? c->width : 0u), c->width, weights);
        return;
    }
    interval = times[key + 1] - times[key];
    s = (time_s - times[key]) / interval;
    if (cubic) {
        sample_cubic(a, a + stride, s, interval, c->width, weights);
    } else {
        sample_linear(a, a + stride, s, c->width, weights);
    }
}
