/* cmd_bisect.c: the first difference between two sessions: in their inputs, and in their hashes. */
#include <stdio.h>
#include <string.h>

#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "replay/session_text.h"

typedef struct bisect_args {
    const char *files[2];
    int file_count, as_json;
} bisect_args;

typedef struct difference {
    uint32_t frames;      /* in both sessions */
    uint32_t input_frame; /* frame of the first input that differs; NOH_NONE: all are equal */
    uint32_t frame;       /* first frame with different hashes; NOH_NONE: all are equal */
    uint32_t parts;       /* one bit per part */
} difference;

static int same_input(const session_input *a, const session_input *b)
{
    const session_form *form = &session_forms[a->what];
    return a->frame == b->frame && a->what == b->what && a->actor == b->actor && strcmp(a->name, b->name) == 0 &&
           memcmp(a->numbers, b->numbers, form->number_count * sizeof *a->numbers) == 0;
}

static uint32_t first_input(const session *a, const session *b)
{
    for (uint32_t i = 0; i < a->input_count || i < b->input_count; i++) {
        if (i >= a->input_count) return b->inputs[i].frame;
        if (i >= b->input_count) return a->inputs[i].frame;
        if (!same_input(&a->inputs[i], &b->inputs[i])) {
            return a->inputs[i].frame < b->inputs[i].frame ? a->inputs[i].frame : b->inputs[i].frame;
        }
    }
    return NOH_NONE;
}

static difference compare(const session *a, const session *b)
{
    difference d = { a->frame_count < b->frame_count ? a->frame_count : b->frame_count, NOH_NONE, NOH_NONE, 0 };
    const uint32_t frame = session_differ(a->hashes, b->hashes, d.frames, &d.parts);
    d.input_frame = first_input(a, b);
    if (d.parts) d.frame = frame;
    return d;
}

/* ---- the report ---- */

static void json_frame(json *j, const char *key, uint32_t frame)
{
    if (frame == NOH_NONE)
        json_null(j, key);
    else
        json_integer(j, key, frame);
}

static int print_json(const difference *d)
{
    json j = json_begin();
    json_integer(&j, "frames", d->frames);
    json_frame(&j, "frame", d->frame);
    json_open(&j, "parts", '[');
    for (uint32_t p = 0; p < SESSION_PARTS; p++) {
        if (d->parts >> p & 1u) json_text(&j, NULL, session_part_name((session_part)p));
    }
    json_close(&j, ']');
    json_frame(&j, "input_frame", d->input_frame);
    return json_end(&j);
}

static void print_text(const difference *d)
{
    if (d->input_frame != NOH_NONE) printf("the inputs differ from frame %u on\n", d->input_frame);
    if (d->frame == NOH_NONE) {
        printf("every part of %u frames is equal\n", d->frames);
        return;
    }
    printf("frame %u is the first that differs; the %u before it are equal\n", d->frame, d->frame);
    for (uint32_t p = 0; p < SESSION_PARTS; p++) {
        printf("  %-8s %s\n", session_part_name((session_part)p), d->parts >> p & 1u ? "differs" : "equal");
    }
}

static int report_all(const bisect_args *a, const session s[2])
{
    const difference d = compare(&s[0], &s[1]);
    int status = 0;
    if (a->as_json)
        status = print_json(&d);
    else
        print_text(&d);
    return status ? status : d.parts || d.input_frame != NOH_NONE ? EXIT_FAILED : 0;
}

static int read(const char *path, session *s)
{
    model_error error = { "", "" };
    if (session_read(s, path, &error)) return tool_fail(path, "%s (%s)", error.what, error.where);
    return s->hashes
               ? 0
               : tool_fail(path, "the session has no hashes: add them with noh lab replay PACK --play %s -o OUT", path);
}

static int run(void *args)
{
    const bisect_args *a = args;
    session s[2] = { { 0 }, { 0 } };
    int status;
    if (a->file_count != 2) return tool_usage("noh lab bisect needs two sessions");
    status = read(a->files[0], &s[0]);
    if (!status) status = read(a->files[1], &s[1]);
    if (!status && (s[0].pack_crc != s[1].pack_crc || s[0].actor_count != s[1].actor_count)) {
        status = tool_fail(
            a->files[1],
            "its pack or its number of actors differs from %s: both sessions must be of the same pack and actors",
            a->files[0]);
    }
    if (!status) status = report_all(a, s);
    session_free(&s[0]);
    session_free(&s[1]);
    return status;
}

static bisect_args arguments;

static const option options[] = { OPTION_JSON(bisect_args, as_json) };

const verb verb_bisect = {
    .name = "lab bisect",
    .files = "SESSION SESSION",
    .what = "find the first frame and the parts in which two sessions of noh lab replay differ",
    .more =
        "To compare two machines, compilers or versions, run `noh lab replay PACK -o a.session` on one and `noh lab replay PACK --play a.session -o b.session` on the other. The exit code is 1 if anything differs.",
    .example = "a.session b.session\na.session b.session --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 2,
    .files_at = offsetof(bisect_args, files),
    .file_count_at = offsetof(bisect_args, file_count),
    .args = &arguments,
    .run = run,
};
