#include "session_text.h"

#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/base/text_scan.h"

#define TITLE "noh-session"
#define VERSION 1u
#define NUMBER_MAX 1e30

/* ---- writing ---- */

static void write_input(const session_input *in, byte_buffer *out)
{
    const session_form *form = &session_forms[in->what];
    buffer_print(out, "%u %s %u", in->frame, form->word, in->actor);
    if (form->has_name) buffer_print(out, strpbrk(in->name, " \t#") || !in->name[0] ? " \"%s\"" : " %s", in->name);
    for (uint32_t i = 0; i < form->number_count; i++) buffer_print(out, " %.9g", (double)in->numbers[i]);
    buffer_print(out, "\n");
}

static void write_hashes(const session *s, byte_buffer *out)
{
    buffer_print(out, "hashes");
    for (uint32_t p = 0; p < SESSION_PARTS; p++) buffer_print(out, " %s", session_part_name((session_part)p));
    buffer_print(out, "\n");
    for (uint32_t f = 0; f < s->frame_count; f++) {
        buffer_print(out, "%u", f);
        for (uint32_t p = 0; p < SESSION_PARTS; p++) buffer_print(out, " %08x", s->hashes[f].part[p]);
        buffer_print(out, "\n");
    }
}

int session_write(const session *s, byte_buffer *out, size_t *input_bytes, model_error *error)
{
    size_t before;
    buffer_print(out, TITLE " %u\npack %08x\nactors %u\nframes %u\n", VERSION, s->pack_crc, s->actor_count,
                 s->frame_count);
    before = out->count;
    for (uint32_t i = 0; i < s->input_count; i++) {
        if (strpbrk(s->inputs[i].name, "\"\n")) {
            return model_fail(error, s->inputs[i].name, "a name with a quote or a line break cannot be written");
        }
        write_input(&s->inputs[i], out);
    }
    *input_bytes = out->count - before;
    if (s->hashes) write_hashes(s, out);
    return out->failed ? model_fail_memory(error) : 0;
}

/* ---- reading ---- */

static int expect(text_scan *t, const char *keyword)
{
    text_word word;
    char shown[TEXT_SHOWN];
    if (text_take_on_line(t, &word)) return 1;
    return text_is(word, keyword) ? 0
                                  : text_fail(t, t->line, "expected '%s', not '%s'", keyword, text_show(word, shown));
}

static int read_count(text_scan *t, uint32_t limit, uint32_t *out)
{
    text_word word;
    return text_take_on_line(t, &word) || text_count(t, word, limit, out);
}

/* The end of a line, and the next one that is not empty. */
static int end_line(text_scan *t)
{
    text_word word;
    char shown[TEXT_SHOWN];
    if (text_take_on_line(t, &word)) return 1;
    if (word.size) return text_fail(t, word.line, "'%s' is one word too many on this line", text_show(word, shown));
    (void)text_next_line(t);
    return 0;
}

static int read_hex(text_scan *t, uint32_t *out)
{
    text_word word;
    char digits[9], *end, shown[TEXT_SHOWN];
    if (text_take_on_line(t, &word)) return 1;
    if (word.size == 8) {
        memcpy(digits, word.text, 8);
        digits[8] = '\0';
        *out = (uint32_t)strtoul(digits, &end, 16);
        if (end == digits + 8 && digits[0] != '-' && digits[0] != '+') return 0;
    }
    return text_fail(t, t->line, "expected eight hexadecimal digits, not '%s'", text_show(word, shown));
}

static int read_head(text_scan *t, session *s)
{
    uint32_t version = 0;
    if (expect(t, TITLE) || read_count(t, 1000, &version)) return 1;
    if (version != VERSION)
        return text_fail(t, t->line, "the session has version %u, which this noh does not read", version);
    if (end_line(t) || expect(t, "pack") || read_hex(t, &s->pack_crc) || end_line(t)) return 1;
    if (expect(t, "actors") || read_count(t, SESSION_ACTORS_MAX, &s->actor_count)) return 1;
    if (!s->actor_count) return text_fail(t, t->line, "a session needs at least one actor");
    return end_line(t) || expect(t, "frames") || read_count(t, SESSION_FRAMES_MAX, &s->frame_count) || end_line(t);
}

static int read_name(text_scan *t, char name[NOH_NAME_BYTES_MAX])
{
    text_word word;
    if (text_take_on_line(t, &word)) return 1;
    if (!word.size || word.size >= NOH_NAME_BYTES_MAX) {
        return text_fail(t, t->line, "expected a name of up to %u bytes", (unsigned)NOH_NAME_BYTES_MAX - 1u);
    }
    memcpy(name, word.text, word.size);
    return 0;
}

static int read_what(text_scan *t, session_input *in)
{
    text_word word;
    char shown[TEXT_SHOWN];
    if (text_take_on_line(t, &word)) return 1;
    for (in->what = 0; in->what < SESSION_WHATS; in->what++) {
        if (text_is(word, session_forms[in->what].word)) return 0;
    }
    return text_fail(t, t->line, "there is no input '%s'", text_show(word, shown));
}

static int read_input(text_scan *t, session *s, text_word frame)
{
    session_input in = { 0 };
    uint32_t actor = 0;
    const uint32_t before = s->input_count ? s->inputs[s->input_count - 1u].frame : 0u;
    if (text_count(t, frame, SESSION_FRAMES_MAX, &in.frame)) return 1;
    if (in.frame >= s->frame_count) return text_fail(t, t->line, "frame %u is past the last frame", in.frame);
    if (in.frame < before)
        return text_fail(t, t->line, "frame %u follows frame %u: frames must be in order", in.frame, before);
    if (read_what(t, &in) || read_count(t, s->actor_count - 1u, &actor)) return 1;
    in.actor = (uint16_t)actor;
    if (session_forms[in.what].has_name && read_name(t, in.name)) return 1;
    for (uint32_t i = 0; i < session_forms[in.what].number_count; i++) {
        text_word word;
        double value;
        if (text_take_on_line(t, &word) || text_number(t, word, &value)) return 1;
        if (!(value >= -NUMBER_MAX && value <= NUMBER_MAX)) return text_fail(t, t->line, "a number is too large");
        in.numbers[i] = (float)value;
    }
    return session_add(s, &in) ? text_fail(t, t->line, "out of memory") : 0;
}

/* The columns are named, so that files of another set of parts are refused. */
static int read_hash_head(text_scan *t, session *s)
{
    for (uint32_t p = 0; p < SESSION_PARTS; p++) {
        if (expect(t, session_part_name((session_part)p))) return 1;
    }
    s->hashes = calloc(s->frame_count + 1u, sizeof *s->hashes);
    return s->hashes ? 0 : text_fail(t, t->line, "out of memory");
}

static int read_hashes(text_scan *t, session *s)
{
    if (read_hash_head(t, s) || end_line(t)) return 1;
    for (uint32_t f = 0; f < s->frame_count; f++) {
        uint32_t frame;
        if (read_count(t, SESSION_FRAMES_MAX, &frame)) return 1;
        if (frame != f) return text_fail(t, t->line, "expected the hashes of frame %u, not of %u", f, frame);
        for (uint32_t p = 0; p < SESSION_PARTS; p++) {
            if (read_hex(t, &s->hashes[f].part[p])) return 1;
        }
        if (end_line(t)) return 1;
    }
    return 0;
}

static int read_body(text_scan *t, session *s)
{
    text_word word;
    for (;;) {
        if (text_take_on_line(t, &word)) return 1;
        if (!word.size) {
            if (!text_next_line(t)) return 0;
        } else if (text_is(word, "hashes")) {
            return s->hashes ? text_fail(t, word.line, "the hashes are given twice") : read_hashes(t, s);
        } else if (read_input(t, s, word) || end_line(t)) {
            return 1;
        }
    }
}

int session_read(session *s, const char *path, model_error *error)
{
    size_t bytes;
    char *text = input_read_text(path, &bytes, error);
    text_scan t;
    int failed;
    memset(s, 0, sizeof *s);
    if (!text) return 1;
    text_start(&t, text, bytes, error);
    failed = read_head(&t, s) || read_body(&t, s);
    free(text);
    if (failed) session_free(s);
    return failed;
}
