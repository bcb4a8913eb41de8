#include "life/face/amplitude_internal.h"
#include "noh/base.h"
#include "noh/face.h"

#include <string.h>

#include "core/base/assert_internal.h"

enum { MIN_RATE = 1000, MAX_RATE = 192000, MAX_CHANNELS = 64, LOUD_AT_FIRST = 8192 * 16 };

noh_result noh_amplitude_init(noh_amplitude *a, uint32_t sample_rate, uint32_t channels, noh_error *error)
{
    NOH_ASSERT(a);
    if (sample_rate < MIN_RATE || sample_rate > MAX_RATE) {
        return noh_fail(error, NOH_ERR_ARG, "sample_rate must be 1000 to 192000 Hz", sample_rate, MAX_RATE);
    }
    if (!channels || channels > MAX_CHANNELS) {
        return noh_fail(error, NOH_ERR_ARG, "channels must be 1 to 64", channels, MAX_CHANNELS);
    }
    memset(a, 0, sizeof *a);
    a->rate = sample_rate;
    a->channels = channels;
    a->loud = LOUD_AT_FIRST;
    return NOH_OK;
}

void noh_amplitude_restart(noh_amplitude *a)
{
    const noh_amplitude kept = *a;
    memset(a, 0, sizeof *a);
    a->rate = kept.rate;
    a->channels = kept.channels;
    a->loud = kept.loud;
}

/* Whole numbers: the n-th window ends exactly where it should, however long the sound is. */
static int window_is_full(const noh_amplitude *a)
{
    return a->frames >= (uint64_t)(a->index + 1) * a->rate / NOH_AMPLITUDE_RATE;
}

size_t noh_amplitude_hear(noh_amplitude *a, const int16_t *samples, size_t count)
{
    size_t taken = 0;
    NOH_ASSERT(a && (samples || !count));
    while (taken < count && !a->ended && !window_is_full(a)) {
        const int32_t sample = samples[taken++];
        const uint32_t size = (uint32_t)(sample < 0 ? -sample : sample);
        a->sum += size;
        a->filled++;
        a->peak = size > a->peak ? size : a->peak;
        if (++a->channel == a->channels) {
            a->channel = 0;
            a->frames++;
        }
    }
    return taken;
}

void noh_amplitude_end(noh_amplitude *a)
{
    NOH_ASSERT(a);
    if (!a->ended) a->ended = 1;
}

/* The 95th percentile: 19 steps up for a louder window, one down for any other. */
static void hear_peak(noh_amplitude *a)
{
    const uint32_t step = a->loud / 128 + 1;
    if (a->peak * 16 > a->loud) {
        const uint32_t up = 19 * step, gap = a->peak * 16 - a->loud;
        a->loud += up < gap ? up : gap;
    } else if (a->peak * 256 > a->loud) { /* silence is not counted */
        a->loud -= step < a->loud ? step : 0;
    }
}

noh_viseme noh_amplitude_shape(uint32_t mean, uint32_t loud, float *weight)
{
    static const struct {
        noh_viseme viseme;
        float from, range;
    } steps[] = { { NOH_VISEME_IH, 0.2f, 0.2f }, { NOH_VISEME_E, 0.4f, 0.3f }, { NOH_VISEME_AA, 0.7f, 0.3f } };
    const float share = loud ? (float)mean / (0.3f * (float)loud) : 0.0f, part = share > 1.0f ? 1.0f : share;
    noh_viseme viseme = NOH_VISEME_SIL;
    *weight = 0.0f;
    for (uint32_t i = 0; i < 3; i++) {
        if (part < steps[i].from) break;
        viseme = steps[i].viseme;
        *weight = (part - steps[i].from) / steps[i].range;
        if (*weight < 0.3f) *weight = 0.3f; /* a selected shape must be visible */
        if (*weight > 1.0f) *weight = 1.0f;
    }
    return viseme;
}

int noh_amplitude_next(noh_amplitude *a, noh_amplitude_frame *frame)
{
    NOH_ASSERT(a && frame);
    if (a->ended == 2 || (!a->ended && !window_is_full(a))) return 0;
    frame->index = a->index;
    frame->mean = a->filled ? (uint32_t)(a->sum / a->filled) : 0;
    if (a->filled) {
        hear_peak(a);
    } else {
        a->ended = 2;
    }
    frame->viseme = noh_amplitude_shape(frame->mean, a->loud / 16, &frame->weight);
    a->index++;
    a->filled = a->peak = 0;
    a->sum = 0;
    return 1;
}

void noh_amplitude_between(const noh_amplitude_frame *from, const noh_amplitude_frame *to, float part, float *visemes)
{
    const float p = part > 0.0f ? (part < 1.0f ? part : 1.0f) : 0.0f;
    float sum = 0.0f;
    NOH_ASSERT(from && to && visemes);
    for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) visemes[v] = 0.0f;
    visemes[from->viseme] += (1.0f - p) * from->weight;
    visemes[to->viseme] += p * to->weight;
    for (uint32_t v = 1; v < NOH_VISEME_COUNT; v++) sum += visemes[v];
    visemes[NOH_VISEME_SIL] = 1.0f - sum;
}
