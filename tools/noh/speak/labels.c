#include "labels.h"
#include "phone_shapes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "convert/base/input_file.h"
#include "noh/face.h"

#define RATE 100.0
#define NEAR_S 0.15
#define LABELS_MAX 20000u
#define SAID_RATE 48000u

typedef struct label {
    double start, end;
    noh_viseme first, second; /* NOH_VISEME_COUNT: unknown; only one */
    size_t line;
    spoken_phone phone; /* its name */
} label;

typedef struct label_list {
    label *items;
    size_t count;
} label_list;

static int add(label_list *l, double start, double end, const char *phone, size_t line)
{
    label *more = l->count % 256u ? l->items : realloc(l->items, (l->count + 256u) * sizeof *more);
    if (!more) return 1;
    l->items = more;
    more[l->count].start = start;
    more[l->count].end = end;
    more[l->count].first = phone_shape(phone, &more[l->count].second);
    more[l->count].line = line;
    snprintf(more[l->count].phone.name, sizeof more->phone.name, "%s", phone);
    l->count++;
    return 0;
}

/* ---- in ---- */

static int read_line(const char *path, size_t number, const char *line, label_list *out)
{
    char phone[32];
    double start, end;
    if (sscanf(line, "%lf %lf %31s", &start, &end, phone) != 3 || !(start >= 0.0 && end >= start && end < 1e6)) {
        return tool_fail(path, "line %zu: expected \"start end phone\" with times in seconds, not: %.60s", number,
                         line);
    }
    if (out->count >= LABELS_MAX) return tool_fail(path, "line %zu: more than %u phones", number, LABELS_MAX);
    if (!strcmp(phone, "NS") || !strcmp(phone, "BREATH")) memcpy(phone, "SIL", 4); /* noise: shut lips */
    return add(out, start, end, phone, number) ? tool_fail(path, "out of memory") : 0;
}

static int read_labels(const char *path, label_list *out)
{
    model_error error;
    size_t bytes = 0, number = 1;
    char *text = input_read_text(path, &bytes, &error);
    int status = text ? 0 : tool_fail(path, "%s", error.what);
    for (char *line = text, *end; !status && line < text + bytes; line = end + 1, number++) {
        end = line + strcspn(line, "\n");
        *end = 0;
        line[strcspn(line, "\r")] = 0;
        if (line[strspn(line, " \t")]) status = read_line(path, number, line, out);
    }
    free(text);
    return status || out->count ? status : tool_fail(path, "holds no phones");
}

static int of_synthesis(const synthesis *s, label_list *out)
{
    for (size_t i = 0; i < s->phone_count; i++) {
        const size_t end = i + 1u < s->phone_count ? s->phones[i + 1u].sample : s->sample_count;
        if (add(out, (double)s->phones[i].sample / s->sample_rate, (double)end / s->sample_rate, s->phones[i].name,
                0)) {
            return tool_fail("speak", "out of memory");
        }
    }
    return 0;
}

/* ---- by frame ---- */

static noh_viseme viseme_at(const label_list *l, double seconds)
{
    for (size_t i = 0; i < l->count; i++) {
        const label *p = &l->items[i];
        if (seconds < p->start || seconds >= p->end) continue;
        return p->second == NOH_VISEME_COUNT || seconds < p->start + 0.6 * (p->end - p->start) ? p->first : p->second;
    }
    return NOH_VISEME_COUNT;
}

static int lips_of(noh_viseme v)
{
    switch (v) {
    case NOH_VISEME_SIL:
    case NOH_VISEME_PP: return 0;
    case NOH_VISEME_FF: return 1;
    case NOH_VISEME_OH:
    case NOH_VISEME_OU: return 2;
    case NOH_VISEME_AA:
    case NOH_VISEME_E: return 3;
    default: return 4;
    }
}

static void score_frames(const label_list *wanted, const label_list *got, double seconds, label_score *out)
{
    int lips = 0;
    for (uint32_t t = 0; (t + 0.5) / RATE < seconds; t++) {
        const noh_viseme w = viseme_at(wanted, (t + 0.5) / RATE), g = viseme_at(got, (t + 0.5) / RATE);
        if (w == NOH_VISEME_COUNT) continue;
        out->frames++;
        out->visemes_right += w == g;
        out->lips_right += g != NOH_VISEME_COUNT && lips_of(w) == lips_of(g);
        out->vowels += w >= NOH_VISEME_AA;
        out->vowels_shut += w >= NOH_VISEME_AA && lips_of(g) == 0;
        out->lip_changes += lips != lips_of(g);
        lips = lips_of(g);
    }
}

/* Pearson's, over frames that have a label; each value is the mean of seven frames. */
static double correlate_opening(const label_list *wanted, const speech_track *track)
{
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0, spread;
    for (uint32_t t = 3; t + 3u < track->frame_count; t++) {
        double a = 0.0, b = 0.0;
        if (viseme_at(wanted, (t + 0.5) / RATE) == NOH_VISEME_COUNT) continue;
        for (uint32_t k = t - 3u; k <= t + 3u; k++) {
            const noh_viseme v = viseme_at(wanted, (k + 0.5) / RATE);
            a += v == NOH_VISEME_COUNT ? 0.0 : (double)viseme_open((uint32_t)v) / 7.0;
            b += (double)track->frames[k].open / 7.0;
        }
        n++;
        x += a;
        y += b;
        xx += a * a;
        yy += b * b;
        xy += a * b;
    }
    spread = (n * xx - x * x) * (n * yy - y * y);
    return spread > 0.0 ? (n * xy - x * y) / sqrt(spread) : 0.0;
}

/* Whether lips are closed from 30 ms before a phone to 30 ms after it. */
static int is_shut(const label *p, const speech_track *track)
{
    for (uint32_t t = 0; t < track->frame_count; t++) {
        const double at = (t + 0.5) / RATE;
        if (at >= p->start - 0.03 && at <= p->end + 0.03 && !lips_of((noh_viseme)track->frames[t].shape)) return 1;
    }
    return 0;
}

static void score_closures(const label_list *wanted, const label_list *got, const speech_track *track, label_score *out)
{
    for (size_t i = 0; i < wanted->count; i++) {
        int found = 0;
        if (wanted->items[i].first != NOH_VISEME_PP) continue;
        if (track) found = is_shut(&wanted->items[i], track);
        for (size_t k = 0; !track && k < got->count; k++) {
            found |= got->items[k].first == NOH_VISEME_PP &&
                     fabs(got->items[k].start - wanted->items[i].start) <= NEAR_S;
        }
        out->closures++;
        out->closures_found += (uint32_t)found;
    }
}

/* ---- onsets ---- */

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Edits between the beginnings of both lists: a phone that is only in one costs 1. */
static void fill_edits(const label_list *a, const label_list *b, uint32_t *edits)
{
    const size_t row = b->count + 1u;
    for (size_t i = 0; i <= a->count; i++) {
        for (size_t k = 0; k <= b->count; k++) {
            uint32_t best = (uint32_t)(i + k);
            if (i && k) {
                const uint32_t up = edits[(i - 1u) * row + k] + 1u, left = edits[i * row + k - 1u] + 1u;
                best = up < left ? up : left;
                if (a->items[i - 1u].first == b->items[k - 1u].first && edits[(i - 1u) * row + k - 1u] < best) {
                    best = edits[(i - 1u) * row + k - 1u];
                }
            }
            edits[i * row + k] = best;
        }
    }
}

static int score_onsets(const label_list *a, const label_list *b, label_score *out)
{
    const size_t row = b->count + 1u;
    uint32_t *edits = calloc((a->count + 1u) * row, sizeof *edits);
    double *errors = malloc((a->count + 1u) * sizeof *errors);
    if (edits && errors) {
        size_t i = a->count, k = b->count;
        fill_edits(a, b, edits);
        while (i && k) {
            const uint32_t here = edits[i * row + k];
            if (a->items[i - 1u].first == b->items[k - 1u].first && here == edits[(i - 1u) * row + k - 1u]) {
                errors[out->onsets++] = fabs(a->items[--i].start - b->items[--k].start);
            } else if (here == edits[(i - 1u) * row + k] + 1u) {
                i--;
            } else {
                k--;
            }
        }
        qsort(errors, out->onsets, sizeof *errors, by_value);
        out->onset_median_s = out->onsets ? errors[out->onsets / 2u] : 0.0;
    }
    free(edits);
    free(errors);
    return edits && errors ? 0 : tool_fail("speak", "out of memory");
}

int labels_score(const char *path, const synthesis *said, const speech_track *track, label_score *out)
{
    label_list wanted = { NULL, 0 }, got = { NULL, 0 };
    int status = read_labels(path, &wanted);
    memset(out, 0, sizeof *out);
    if (!status) status = of_synthesis(said, &got);
    if (!status) {
        out->phones = (uint32_t)wanted.count;
        score_frames(&wanted, &got, (double)said->sample_count / said->sample_rate, out);
        score_closures(&wanted, &got, track, out);
        out->with_opening = track != NULL;
        if (track) out->opening_correlation = correlate_opening(&wanted, track);
        status = score_onsets(&wanted, &got, out);
    }
    free(wanted.items);
    free(got.items);
    return status;
}

/* ---- spoken ---- */

static uint32_t sample_of(double seconds)
{
    return (uint32_t)(seconds * SAID_RATE + 0.5);
}

static void say_phone(synthesis *s, uint32_t sample, const char *name)
{
    spoken_phone *phone = &s->phones[s->phone_count++];
    memcpy(phone->name, name, sizeof phone->name);
    phone->sample = sample;
}

static int say_labels(const char *path, const label_list *all, synthesis *out)
{
    static const spoken_phone pause;
    for (size_t i = 0; i < all->count; i++) {
        const label *l = &all->items[i];
        if (i && l->start < all->items[i - 1u].start) {
            return tool_fail(path, "line %zu: it starts before the line above: sort the lines by time", l->line);
        }
        if (l->first == NOH_VISEME_COUNT) {
            fprintf(stderr,
                    "noh: %s: warning: line %zu: the phone '%s' is neither of ARPABET nor of IPA: the mouth keeps "
                    "the shape before it\n",
                    path, l->line, l->phone.name);
        }
        if (sample_of(l->start) > out->sample_count) say_phone(out, (uint32_t)out->sample_count, pause.name);
        say_phone(out, sample_of(l->start), l->phone.name);
        if (sample_of(l->end) > out->sample_count) out->sample_count = sample_of(l->end);
    }
    return 0;
}

int labels_say(const char *path, synthesis *out)
{
    label_list all = { NULL, 0 };
    int status = read_labels(path, &all);
    memset(out, 0, sizeof *out);
    out->sample_rate = SAID_RATE;
    if (!status) {
        out->phones = calloc(2u * all.count, sizeof *out->phones);
        status = out->phones ? say_labels(path, &all, out) : tool_fail("speak", "out of memory");
    }
    free(all.items);
    return status;
}
