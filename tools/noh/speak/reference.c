#include "reference.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/face.h"

static int is_pause(const synthesis *s, size_t phone)
{
    return noh_viseme_of_phone(s->phones[phone].name, NULL) == NOH_VISEME_SIL;
}

static double end_of(const synthesis *s, size_t phone)
{
    const size_t end = phone + 1u < s->phone_count ? s->phones[phone + 1u].sample : s->sample_count;
    return (double)end / s->sample_rate;
}

static double start_of(const synthesis *s, size_t phone)
{
    return (double)s->phones[phone].sample / s->sample_rate;
}

/* ---- states ---- */

static uint32_t apart(uint32_t a, uint32_t b)
{
    return a > b ? a - b : b - a;
}

/* Whether a word begins with the phone: it is the nearest to the word's own sample, which may lie somewhat before. */
static int begins_word(const synthesis *s, size_t phone)
{
    const uint32_t at = s->phones[phone].sample;
    for (size_t i = 0; i < s->word_count; i++) {
        const uint32_t word = s->words[i].sample, far = apart(word, at);
        if ((!phone || apart(word, s->phones[phone - 1u].sample) > far) &&
            (phone + 1u == s->phone_count || apart(word, s->phones[phone + 1u].sample) >= far)) {
            return 1;
        }
    }
    return 0;
}

static void add(reference *r, size_t phone, uint32_t pause)
{
    r->states[r->state_count].phone = (uint32_t)phone;
    r->states[r->state_count++].pause = pause;
}

static double spoken_seconds(const synthesis *s)
{
    double sum = 0.0;
    for (size_t i = 0; i < s->phone_count; i++) sum += is_pause(s, i) ? 0.0 : end_of(s, i) - start_of(s, i);
    return sum;
}

static uint32_t states_of(const synthesis *s, size_t phone, double scale)
{
    const double count = (end_of(s, phone) - start_of(s, phone)) * scale * FEATURE_RATE;
    return count < 2.5 ? 3u : (uint32_t)(count + 0.5);
}

/* A pause may stand before every word, and at the end. */
static int make_states(reference *r, double seconds)
{
    const synthesis *s = &r->said;
    const double scale = seconds / spoken_seconds(s);
    size_t room = 1u;
    for (size_t i = 0; i < s->phone_count; i++) room += 1u + states_of(s, i, scale);
    r->states = malloc(room * sizeof *r->states);
    if (!r->states) return 1;
    for (size_t i = 0; i < s->phone_count; i++) {
        const int first = !r->state_count, after_pause = !first && r->states[r->state_count - 1u].pause;
        const int pause = is_pause(s, i);
        if (!after_pause && (first || pause || begins_word(s, i))) add(r, i, 1u);
        for (uint32_t k = pause ? 0u : states_of(s, i, scale); k > 0; k--) add(r, i, 0u);
    }
    if (!r->states[r->state_count - 1u].pause) add(r, s->phone_count - 1u, 1u);
    return 0;
}

/* ---- a voice ---- */

static void value_at(const features *f, double seconds, float *out)
{
    const double at = seconds * FEATURE_RATE - 0.5;
    const double last = (double)f->frames - 1.0, t = at < 0.0 ? 0.0 : at > last ? last : at;
    const size_t a = (size_t)t, b = a + 1u < f->frames ? a + 1u : a;
    const float part = (float)(t - (double)a);
    for (uint32_t c = 0; c < FEATURE_COUNT; c++) {
        const float x = f->values[a * FEATURE_COUNT + c], y = f->values[b * FEATURE_COUNT + c];
        out[c] = x + part * (y - x);
    }
}

static void fill_means(const reference *r, const synthesis *s, const features *f, float *means)
{
    for (size_t i = 0; i < r->state_count;) {
        const size_t phone = r->states[i].phone;
        size_t count = 1;
        while (i + count < r->state_count && r->states[i + count].phone == phone &&
               r->states[i + count].pause == r->states[i].pause) {
            count++;
        }
        for (size_t k = 0; k < count; k++) {
            const double part = ((double)k + 0.5) / (double)count;
            value_at(f, start_of(s, phone) + part * (end_of(s, phone) - start_of(s, phone)),
                     means + (i + k) * FEATURE_COUNT);
        }
        i += count;
    }
}

static void spoken_frames(const synthesis *s, const features *f, unsigned char *spoken)
{
    memset(spoken, 0, f->frames);
    for (size_t i = 0; i < s->phone_count; i++) {
        if (is_pause(s, i)) continue;
        for (double t = start_of(s, i); t < end_of(s, i); t += 1.0 / FEATURE_RATE) {
            const size_t frame = (size_t)(t * FEATURE_RATE);
            if (frame < f->frames) spoken[frame] = 1;
        }
    }
}

static int hear(const synthesis *s, float top_hz, features *out)
{
    sound pcm, at_rate;
    unsigned char *spoken;
    int status = sound_from_pcm(s->samples, s->sample_count, s->sample_rate, &pcm);
    if (status) return status;
    status = sound_resample(&pcm, FEATURE_SOUND_RATE, &at_rate);
    sound_free(&pcm);
    if (status) return status;
    status = features_make(&at_rate, top_hz, out);
    sound_free(&at_rate);
    if (status) return status;
    spoken = malloc(out->frames + 1u);
    if (!spoken) return tool_fail("speak", "out of memory");
    spoken_frames(s, out, spoken);
    features_normalise(out, spoken);
    free(spoken);
    return 0;
}

static int same_phones(const synthesis *a, const synthesis *b)
{
    if (a->phone_count != b->phone_count) return 0;
    for (size_t i = 0; i < a->phone_count; i++) {
        if (strcmp(a->phones[i].name, b->phones[i].name)) return 0;
    }
    return 1;
}

/* ---- all voices ---- */

/* Variants of a language's voice say the same phones by other throats. */
static const char *const variants[] = { "", "+f2", "+m3", "+klatt2", "+f5", "+m7", "+klatt4", "+steph" };

#define VARIANTS (sizeof variants / sizeof variants[0])

/* A voice with other phones is left out: *means is NULL. */
static int hear_voice(const reference *r, const char *text, const char *language, const char *variant, float top_hz,
                      float **means)
{
    char name[128];
    synthesis s;
    features f;
    int status;
    *means = NULL;
    snprintf(name, sizeof name, "%s%s", language, variant);
    status = synthesis_make(text, name, &s);
    if (status) return status;
    if (same_phones(&s, &r->said)) {
        *means = malloc(r->state_count * FEATURE_COUNT * sizeof **means);
        status = *means ? hear(&s, top_hz, &f) : tool_fail("speak", "out of memory");
        if (!status) {
            fill_means(r, &s, &f, *means);
            features_free(&f);
        }
    }
    synthesis_free(&s);
    return status;
}

static void add_outer(const float *x, const float *mean, double *sum)
{
    for (uint32_t a = 0; a < FEATURE_COUNT; a++) {
        for (uint32_t b = 0; b <= a; b++) {
            sum[a * FEATURE_COUNT + b] += (double)(x[a] - mean[a]) * (double)(x[b] - mean[b]);
        }
    }
}

/* The mean of all voices, and their differences. */
static void pool(reference *r, float *const *voices, size_t count)
{
    double degrees = 0.0;
    for (size_t k = 0; k < r->state_count * FEATURE_COUNT; k++) {
        float sum = 0.0f;
        for (size_t v = 0; v < count; v++) sum += voices[v][k];
        r->means[k] = sum / (float)count;
    }
    for (size_t i = 0; i < r->state_count; i++) {
        if (r->states[i].pause) continue;
        for (size_t v = 0; v < count; v++) {
            add_outer(voices[v] + i * FEATURE_COUNT, r->means + i * FEATURE_COUNT, r->within);
        }
        degrees += (double)count - 1.0;
    }
    for (uint32_t k = 0; k < FEATURE_COUNT * FEATURE_COUNT; k++) r->within[k] /= degrees > 0.0 ? degrees : 1.0;
}

static int hear_all(reference *r, const char *text, const char *language, float top_hz)
{
    const size_t own = strchr(language, '+') ? 1u : VARIANTS; /* a variant that was asked for is the only one */
    float *voices[VARIANTS] = { NULL };
    size_t count = 0;
    int status = 0;
    for (size_t i = 0; i < own && !status; i++) {
        status = hear_voice(r, text, language, variants[i], top_hz, &voices[count]);
        count += voices[count] != NULL;
    }
    if (!status) pool(r, voices, count);
    for (size_t i = 0; i < count; i++) free(voices[i]);
    return status;
}

int reference_make(const char *text, const char *language, double seconds, float top_hz, reference *out)
{
    int status;
    memset(out, 0, sizeof *out);
    status = synthesis_make(text, language, &out->said);
    if (status) return status;
    if (spoken_seconds(&out->said) <= 0.0) {
        status = tool_fail("speak", "the text contains no words to speak");
    } else if (make_states(out, seconds)) {
        status = tool_fail("speak", "out of memory");
    } else {
        out->means = malloc(out->state_count * FEATURE_COUNT * sizeof *out->means);
        status = out->means ? hear_all(out, text, language, top_hz) : tool_fail("speak", "out of memory");
    }
    if (status) reference_free(out);
    return status;
}

void reference_free(reference *r)
{
    synthesis_free(&r->said);
    free(r->states);
    free(r->means);
    memset(r, 0, sizeof *r);
}
