/* cmd_speak.c: text to mouth shapes, and to a clip for a face. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"
#include "speech_track.h"
#include "wav_file.h"

#define FRAME_RATE 100u

typedef struct speak_args {
    const char *text, *output, *face, *language, *name, *wav;
    int as_json;
} speak_args;

/* ---- what it found ---- */

static uint32_t strongest(const float *visemes)
{
    uint32_t best = 0;
    for (uint32_t i = 1; i < NOH_VISEME_COUNT; i++) best = visemes[i] > visemes[best] ? i : best;
    return best;
}

static void json_phones(json *j, const synthesis *said)
{
    json_open(j, "phones", '[');
    for (size_t i = 0; i < said->phone_count; i++) {
        const size_t end = i + 1u < said->phone_count ? said->phones[i + 1u].sample : said->sample_count;
        const noh_viseme viseme = noh_viseme_of_phone(said->phones[i].name, NULL);
        json_open(j, NULL, '{');
        json_number(j, "start_s", (double)said->phones[i].sample / said->sample_rate);
        json_number(j, "end_s", (double)end / said->sample_rate);
        json_text(j, "phone", said->phones[i].name);
        json_text(j, "viseme", viseme_name(viseme == NOH_VISEME_COUNT ? NOH_VISEME_SIL : viseme));
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void visemes_of_frame(const speech_track *t, uint32_t frame, float *visemes)
{
    noh_speech_visemes(&t->speech, (int64_t)frame * NOH_TICKS_PER_SECOND / FRAME_RATE, visemes);
}

static void json_curve(json *j, const char *key, const speech_track *t, uint32_t frames, float (*of)(uint32_t viseme))
{
    json_open(j, key, '[');
    for (uint32_t f = 0; f < frames; f++) {
        float visemes[NOH_VISEME_COUNT], sum = 0.0f;
        visemes_of_frame(t, f, visemes);
        for (uint32_t v = 0; v < NOH_VISEME_COUNT; v++) sum += visemes[v] * of(v);
        json_number(j, NULL, (double)sum);
    }
    json_close(j, ']');
}

static void json_frames(json *j, const speech_track *t)
{
    const uint32_t frames = (uint32_t)(t->seconds * FRAME_RATE) + 1u;
    json_open(j, "frames", '{');
    json_integer(j, "rate_hz", FRAME_RATE);
    json_open(j, "viseme", '[');
    for (uint32_t f = 0; f < frames; f++) {
        float visemes[NOH_VISEME_COUNT];
        visemes_of_frame(t, f, visemes);
        json_text(j, NULL, viseme_name(strongest(visemes)));
    }
    json_close(j, ']');
    json_curve(j, "open", t, frames, viseme_open);
    json_curve(j, "round", t, frames, viseme_round);
    json_close(j, '}');
}

static int print_json(const synthesis *said, const speech_track *t)
{
    json j = json_begin();
    json_number(&j, "seconds", t->seconds);
    json_text(&j, "source", "text");
    json_number(&j, "latency_ms", 0.0);
    json_phones(&j, said);
    json_frames(&j, t);
    return json_end(&j);
}

static void print_text(const speak_args *a, const synthesis *said, const speech_track *t)
{
    FILE *out = report_stream(a->output);
    fprintf(out, "%.2f s, %zu words, %zu phones:", t->seconds, said->word_count, said->phone_count);
    for (size_t i = 0; i < said->phone_count; i++) {
        fprintf(out, " %s", said->phones[i].name[0] ? said->phones[i].name : "_");
    }
    fprintf(out, "\n");
}

/* ---- running ---- */

static int write_pack(const speak_args *a, const synthesis *said, const speech_track *t)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    byte_buffer out = { NULL, 0, 0, 0 };
    pack_file face;
    int status = pack_file_open(&face, a->face);
    if (status) return status;
    status = speech_track_pack(t, said, a->text, &face, a->name, &out);
    if (!status && noh_file_write(a->output, out.bytes, out.count, &error)) {
        status = tool_fail(a->output, "cannot write: %s", error.what);
    }
    buffer_free(&out);
    pack_file_close(&face);
    return status;
}

static int run(void *args)
{
    const speak_args *a = args;
    synthesis said;
    speech_track track;
    int status = synthesis_make(a->text, a->language, &said);
    if (status) return status;
    status = speech_track_make(&said, &track);
    if (!status) {
        if (a->output) status = write_pack(a, &said, &track);
        if (!status && a->wav) status = wav_write(a->wav, said.samples, said.sample_count, said.sample_rate);
        if (!status && a->as_json) status = print_json(&said, &track);
        if (!status && !a->as_json) print_text(a, &said, &track);
        speech_track_free(&track);
    }
    synthesis_free(&said);
    return status;
}

static speak_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(speak_args, output),
      .value = "OUT.noh",
      .what = "a pack with the clip, to be played beside others (--anim OUT.noh --clip speech)",
      .example = "line.noh",
      .needs = "--face" },
    { .name = "--face",
      .kind = OPTION_INPUT,
      .at = offsetof(speak_args, face),
      .value = "PACK",
      .what = "whose face speaks: its targets have names of ARKit, of VRM or of facial units",
      .example = "face.noh",
      .needs = "-o" },
    { .name = "--name",
      .kind = OPTION_TEXT,
      .at = offsetof(speak_args, name),
      .value = "NAME",
      .initial = "speech",
      .what = "of the clip",
      .example = "greeting" },
    { .name = "--lang",
      .kind = OPTION_TEXT,
      .at = offsetof(speak_args, language),
      .value = "LANG",
      .initial = "en-us",
      .what = "the language, as eSpeak NG names it",
      .example = "de" },
    { .name = "--wav",
      .kind = OPTION_OUTPUT,
      .at = offsetof(speak_args, wav),
      .value = "OUT.wav",
      .what = "the sound, 16 bits, one channel",
      .example = "line.wav" },
    OPTION_JSON(speak_args, as_json),
};

const verb verb_speak = {
    .name = "speak",
    .files = "TEXT",
    .what = "say a text: its sound, its phones, and a clip of the mouth for a face",
    .more =
        "eSpeak NG says it (Debian: libespeak-ng1, espeak-ng-data); phones begin at its samples, to the sample. Mouth "
        "shapes run into each other as they do in speech, and lips meet for every p, b and m. Words are callback "
        "keys of the clip.",
    .example =
        "\"Hello, my name is Noh.\" --face face.noh -o line.noh --wav line.wav\n\"Guten Morgen\" --lang de --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(speak_args, text),
    .args = &arguments,
    .run = run,
};
