#include "events_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/model/model_build.h"
#include "raw_set.h"
#include "convert/base/text_scan.h"

#define TIME_ROUNDING_S 1e-4 /* a tool that rounds may place a key for the last frame this far after it */

typedef struct events_reader {
    text_scan text;
    event_list *list;
    uint32_t capacity;
} events_reader;

static int out_of_memory(text_scan *s)
{
    return model_fail(s->error, "", "there is not enough memory to read this file");
}

/* The next word of the line, or the text between quotes; of size 0 at the line's end and at a comment. */
static int take_word(text_scan *s, text_word *out)
{
    const char *before;
    *out = text_next_on_line(s);
    if (out->size > 0 && out->text[0] == '#') {
        s->at = out->text;
        (void)text_rest_of_line(s);
        out->size = 0;
    }
    if (out->size == 0 || out->text[0] != '"') return 0;
    before = out->text + 1;
    const char *close = before;
    while (close < s->end && *close != '"' && *close != '\n') ++close;
    if (close == s->end || *close != '"') return text_fail(s, out->line, "a quote is not closed");
    out->text = before;
    out->size = (size_t)(close - before);
    s->at = close + 1;
    return out->size > 0 ? 0 : text_fail(s, out->line, "a name is empty");
}

static int take_needed(text_scan *s, const char *what, text_word *out)
{
    if (take_word(s, out)) return 1;
    return out->size > 0
               ? 0
               : text_fail(s, out->line,
                           "%s is missing: write CLIP TIME_S NAME [PAYLOAD] [min=WEIGHT] or CLIP TIME_S NAME marker",
                           what);
}

/* a payload and min=WEIGHT, each at most once and in any order; or `marker` alone */
static int take_options(text_scan *s, raw_event *event)
{
    text_word word;
    char shown[TEXT_SHOWN];
    int has_payload = 0, has_minimum = 0;
    while (!take_word(s, &word)) {
        double minimum = 0.0;
        if (word.size == 0) return 0;
        if (event->is_marker)
            return text_fail(s, word.line, "'%s' follows marker: a marker has no payload and no weight",
                             text_show(word, shown));
        if (!has_minimum && !has_payload && word.size == 6 && memcmp(word.text, "marker", 6) == 0) {
            event->is_marker = 1;
            continue;
        }
        if (!has_minimum && word.size > 4 && memcmp(word.text, "min=", 4) == 0) {
            const text_word number = { word.text + 4, word.size - 4, word.line };
            if (text_number(s, number, &minimum)) return 1;
            if (!(minimum >= 0.0 && minimum <= 1e6))
                return text_fail(s, word.line, "min must be 0 or more, not %g", minimum);
            event->weight_min = (float)minimum;
            has_minimum = 1;
        } else if (!has_payload && event_payload(word.text, word.size, event->payload)) {
            has_payload = 1;
        } else {
            return text_fail(s, word.line, "'%s' must be a payload (a number), min=WEIGHT or marker, each at most once",
                             text_show(word, shown));
        }
    }
    return 1;
}

static event_entry *add_entry(events_reader *r)
{
    event_list *list = r->list;
    if (list->count == r->capacity) {
        uint32_t wanted = r->capacity ? r->capacity * 2 : 64;
        event_entry *larger = realloc(list->entries, wanted * sizeof *larger);
        if (!larger) return NULL;
        list->entries = larger;
        r->capacity = wanted;
    }
    memset(&list->entries[list->count], 0, sizeof *list->entries);
    return &list->entries[list->count++];
}

static int read_line(events_reader *r)
{
    text_scan *s = &r->text;
    text_word clip, time, name;
    if (take_word(s, &clip)) return 1;
    if (clip.size == 0) return 0; /* a comment */
    if (r->list->count == RAW_EVENTS_MAX)
        return text_fail(s, clip.line, "too many keys: the limit is %u", RAW_EVENTS_MAX);
    event_entry *entry = add_entry(r);
    if (!entry) return out_of_memory(s);
    entry->line = clip.line;
    if (take_needed(s, "the time", &time) || text_number(s, time, &entry->event.time_s) ||
        take_needed(s, "the name", &name) || take_options(s, &entry->event))
        return 1;
    if (entry->event.time_s < 0.0) return text_fail(s, time.line, "the time %g is negative", entry->event.time_s);
    entry->clip = text_copy(clip);
    entry->event.name = text_copy(name);
    return entry->clip && entry->event.name ? 0 : out_of_memory(s);
}

int events_read(const char *path, event_list **out, model_error *error)
{
    size_t size = 0;
    events_reader r = { 0 };
    *out = NULL;
    char *text = input_read_text(path, &size, error);
    if (!text) return 1;
    text_start(&r.text, text, size, error);
    r.list = model_zeros(1, sizeof *r.list);
    int failed = r.list ? 0 : out_of_memory(&r.text);
    while (!failed && text_next_line(&r.text)) failed = read_line(&r);
    if (failed)
        events_free(r.list);
    else
        *out = r.list;
    free(text);
    return failed;
}

void events_free(event_list *list)
{
    if (!list) return;
    for (uint32_t i = 0; i < list->count; ++i) {
        free(list->entries[i].clip);
        free(list->entries[i].event.name);
    }
    free(list->entries);
    free(list);
}

static raw_clip *find_clip(raw_set *const *sets, uint32_t set_count, const char *name)
{
    for (uint32_t s = 0; s < set_count; ++s)
        for (uint32_t c = 0; c < sets[s]->clip_count; ++c)
            if (sets[s]->clips[c].name && strcmp(sets[s]->clips[c].name, name) == 0) return &sets[s]->clips[c];
    return NULL;
}

static int apply_entry(const event_entry *entry, raw_set *const *sets, uint32_t set_count, text_scan *s)
{
    raw_event event = entry->event;
    raw_clip *clip = find_clip(sets, set_count, entry->clip);
    if (!clip) return text_fail(s, entry->line, "there is no clip '%.100s'", entry->clip);
    double duration_s = raw_clip_duration_s(clip);
    if (event.time_s > duration_s + TIME_ROUNDING_S)
        return text_fail(s, entry->line, "the time %g is past the end of clip '%.100s' at %g s", event.time_s,
                         entry->clip, duration_s);
    event.time_s = fmin(event.time_s, duration_s);
    if (clip->event_count >= RAW_EVENTS_MAX)
        return text_fail(s, entry->line, "clip '%.100s' has more than %u keys, which is the limit", entry->clip,
                         RAW_EVENTS_MAX);
    return raw_clip_add_event(clip, &event) ? out_of_memory(s) : 0;
}

int events_apply(const event_list *list, raw_set *const *sets, uint32_t set_count, model_error *error)
{
    text_scan s = { NULL, NULL, 0, error };
    for (uint32_t i = 0; i < list->count; ++i)
        if (apply_entry(&list->entries[i], sets, set_count, &s)) return 1;
    return 0;
}
