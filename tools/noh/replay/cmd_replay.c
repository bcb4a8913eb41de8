/* cmd_replay.c: plays a session on a stage, random by seed or read from a file, hashes its frames, and replays it. */
#include <stdio.h>
#include <stdlib.h>

#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"
#include "file/pack_file.h"
#include "session.h"
#include "session_text.h"
#include "noh/low_core.h"

typedef struct replay_args {
    const char *pack, *input, *output;
    double seconds, seed, actors;
    int as_json;
} replay_args;

/* The results of a session. */
typedef struct replay_result {
    session_hashes *hashes;
    size_t input_bytes;
    uint32_t equal_frames; /* with the hashes of the file */
    uint32_t parts;        /* that differ in the frame after these */
    uint32_t refused, first_refused;
    noh_error refused_error;
} replay_result;

/* ---- the session ---- */

static int draw(const replay_args *a, const pack_file *file, session *s)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    session_stage stage;
    int failed;
    if (session_open(&stage, &file->pack, (uint32_t)a->actors, &error)) return tool_fail_error(a->pack, &error);
    failed = session_draw(s, &stage, (uint32_t)(a->seconds * 60.0 + 0.5), (uint32_t)a->seed);
    session_close(&stage);
    return failed ? tool_fail(a->pack, "out of memory") : 0;
}

static int read(const replay_args *a, uint32_t pack_crc, session *s)
{
    model_error error = { "", "" };
    if (session_read(s, a->input, &error)) return tool_fail(a->input, "%s (%s)", error.what, error.where);
    if (s->pack_crc == pack_crc) return 0;
    return tool_fail(a->input, "the session belongs to another pack: its checksum is %08x, the checksum of %s is %08x",
                     s->pack_crc, a->pack, pack_crc);
}

/* ---- the run ---- */

static int run_session(const replay_args *a, const pack_file *file, const session *s, replay_result *r)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    session_stage stage;
    int status = 0;
    r->hashes = calloc(s->frame_count + 1u, sizeof *r->hashes);
    if (!r->hashes) return tool_fail(a->pack, "out of memory");
    if (session_open(&stage, &file->pack, s->actor_count, &error)) return tool_fail_error(a->pack, &error);
    if (session_run(s, &stage, r->hashes, &error)) status = tool_fail_error(a->pack, &error);
    r->refused = stage.refused;
    r->first_refused = stage.first_refused;
    r->refused_error = stage.refused_error;
    session_close(&stage);
    r->equal_frames = s->frame_count;
    if (s->hashes) r->equal_frames = session_differ(s->hashes, r->hashes, s->frame_count, &r->parts);
    return status;
}

/* The session with its new results. */
static int write_session(const replay_args *a, const session *s, replay_result *r)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    model_error why = { "", "" };
    byte_buffer out = { NULL, 0, 0, 0 };
    session played = *s;
    int status = 0;
    played.hashes = r->hashes;
    if (session_write(&played, &out, &r->input_bytes, &why))
        status = tool_fail(a->pack, "%s (%s)", why.what, why.where);
    if (!status && a->output && noh_file_write(a->output, out.bytes, out.count, &error)) {
        status = tool_fail(a->output, "cannot write: %s", error.what);
    }
    buffer_free(&out);
    return status;
}

/* ---- the report ---- */

static uint32_t hash_all(const session *s, const replay_result *r)
{
    return noh_crc32c(0, r->hashes, s->frame_count * sizeof *r->hashes);
}

static int print_json(const session *s, const replay_result *r)
{
    json j = json_begin();
    char hash[9];
    snprintf(hash, sizeof hash, "%08x", hash_all(s, r));
    json_integer(&j, "frames", s->frame_count);
    json_integer(&j, "actors", s->actor_count);
    json_integer(&j, "inputs", s->input_count);
    json_integer(&j, "refused", r->refused);
    json_integer(&j, "input_bytes", r->input_bytes);
    json_text(&j, "hash", hash);
    json_bool(&j, "compared", s->hashes != NULL);
    json_integer(&j, "equal_frames", r->equal_frames);
    json_open(&j, "differ", '[');
    for (uint32_t p = 0; p < SESSION_PARTS; p++) {
        if (r->parts >> p & 1u) json_text(&j, NULL, session_part_name((session_part)p));
    }
    json_close(&j, ']');
    return json_end(&j);
}

static void print_text(const replay_args *a, const session *s, const replay_result *r)
{
    FILE *report = report_stream(a->output);
    fprintf(report, "%u frames, %u inputs in %zu bytes (%.1f a frame), hash %08x\n", s->frame_count, s->input_count,
            r->input_bytes, (double)r->input_bytes / s->frame_count, hash_all(s, r));
    if (r->refused) {
        const session_input *in = &s->inputs[r->first_refused];
        fprintf(report, "%u inputs were refused; the first, '%s' in frame %u: %s\n", r->refused,
                session_forms[in->what].word, in->frame, r->refused_error.what);
    }
    if (s->hashes && !r->parts) fprintf(report, "every part of every frame equals %s\n", a->input);
}

static int report_all(const replay_args *a, const session *s, const replay_result *r)
{
    char parts[128] = "";
    size_t used = 0;
    int status = 0;
    if (a->as_json)
        status = print_json(s, r);
    else
        print_text(a, s, r);
    if (status || !r->parts) return status;
    for (uint32_t p = 0; p < SESSION_PARTS; p++) {
        if (r->parts >> p & 1u) {
            used += (size_t)snprintf(parts + used, sizeof parts - used, "%s%s", used ? ", " : "",
                                     session_part_name((session_part)p));
        }
    }
    return tool_fail(a->input, "frame %u is the first that differs, in: %s", r->equal_frames, parts);
}

static int replay(const replay_args *a, const pack_file *file)
{
    replay_result r = { 0 };
    session s = { 0 };
    const uint32_t pack_crc = noh_crc32c(0, file->pack.bytes, file->pack.byte_count);
    int status = a->input ? read(a, pack_crc, &s) : draw(a, file, &s);
    s.pack_crc = pack_crc;
    if (!status) status = run_session(a, file, &s, &r);
    if (!status) status = write_session(a, &s, &r);
    if (!status) status = report_all(a, &s, &r);
    free(r.hashes);
    session_free(&s);
    return status;
}

static int check_args(const replay_args *a)
{
    if (!(a->seconds >= 1.0 / 60.0 && a->seconds <= (double)SESSION_FRAMES_MAX / 60.0)) {
        return tool_usage("--seconds must be a number from 0.02 to %u", SESSION_FRAMES_MAX / 60u);
    }
    if (!(a->actors >= 1.0 && a->actors <= SESSION_ACTORS_MAX && a->actors == (double)(uint32_t)a->actors)) {
        return tool_usage("--actors must be a whole number from 1 to %u", SESSION_ACTORS_MAX);
    }
    if (!(a->seed >= 0.0 && a->seed <= 4294967295.0 && a->seed == (double)(uint32_t)a->seed)) {
        return tool_usage("--seed must be a whole number below 2^32");
    }
    return a->as_json && report_stream(a->output) != stdout ? tool_usage("--json and -o both write to stdout") : 0;
}

static int run(void *args)
{
    const replay_args *a = args;
    pack_file file;
    int status = check_args(a);
    if (!status) status = pack_file_open(&file, a->pack);
    if (!status) {
        status = replay(a, &file);
        pack_file_close(&file);
    }
    return status;
}

static replay_args arguments;

static const option options[] = {
    { .name = "--play",
      .kind = OPTION_INPUT,
      .at = offsetof(replay_args, input),
      .value = "SESSION",
      .what = "play the inputs of this file, and compare each frame with its hashes, if it has any",
      .example = "run.session",
      .excludes = "--seconds --seed --actors" },
    { .name = "--seconds",
      .kind = OPTION_NUMBER,
      .at = offsetof(replay_args, seconds),
      .value = "S",
      .initial = "10",
      .what = "length of the session, seconds, at 60 frames a second",
      .example = "60" },
    { .name = "--seed",
      .kind = OPTION_NUMBER,
      .at = offsetof(replay_args, seed),
      .value = "N",
      .initial = "1",
      .what = "seed of the random inputs",
      .example = "7" },
    { .name = "--actors",
      .kind = OPTION_NUMBER,
      .at = offsetof(replay_args, actors),
      .value = "N",
      .initial = "4",
      .what = "number of actors, 1 to 64",
      .example = "8" },
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(replay_args, output),
      .value = "OUT.session",
      .what = "the inputs, and the hashes of each frame (noh help FORMATS)",
      .example = "run.session" },
    OPTION_JSON(replay_args, as_json),
};

const verb verb_replay = {
    .name = "lab replay",
    .files = "PACK|MODEL",
    .what = "play inputs to a stage and hash every frame, or replay a session and compare its hashes",
    .more =
        "Without --play the inputs are random: characters spawn, play clips and graphs, show emotions, look at points, are hit, fall and get up, as far as the pack allows. This tests a pack on a new processor or compiler, and a new version of the library. Each frame's hashes cover the stage's state, callback keys, positions, floats, joints, palettes, and every half second the vertices of one actor. noh lab bisect compares two files.",
    .example = "body.noh -o run.session\nbody.noh --play run.session\nbody.noh --seed 7 --seconds 60 --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(replay_args, pack),
    .args = &arguments,
    .run = run,
};
