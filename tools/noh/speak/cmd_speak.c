/* cmd_speak.c: text to mouth shapes, and to a clip for a face. */
#define _POSIX_C_SOURCE 200809L /* strdup */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"
#include "file/text_file.h"
#include "alignment.h"
#include "phone_shapes.h"
#include "hearing.h"
#include "labels.h"
#include "platform.h"
#include "speech_track.h"
#include "wav_file.h"

#define FRAME_RATE SPEECH_TRACK_RATE
#define TEXT_BYTES_MAX 65536u
#define TEXT_BYTES_A_SECOND 150.0 /* ten times the rate of speech, in scripts of one byte a character */
#define TEXT_BYTES_SPARE 500.0

typedef struct speak_args {
    const char *subject, *text, *text_file, *labels, *output, *face, *language, *name, *wav;
    int as_json;
    hearing how;
} speak_args;

/* The speech, from a text alone or from a recording. */
typedef struct spoken {
    char *text;
    synthesis said;
    speech_track track;
    prosody voice;
    int recorded, heard; /* heard: a recording without words */
    double score;        /* of the alignment */
    size_t clipped;
    int labelled;
    label_score against;
} spoken;

/* ---- results ---- */

static void json_phones(json *j, const synthesis *said)
{
    json_open(j, "phones", '[');
    for (size_t i = 0; i < said->phone_count; i++) {
        const size_t end = i + 1u < said->phone_count ? said->phones[i + 1u].sample : said->sample_count;
        const noh_viseme viseme = phone_shape(said->phones[i].name, NULL);
        json_open(j, NULL, '{');
        json_number(j, "start_s", (double)said->phones[i].sample / said->sample_rate);
        json_number(j, "end_s", (double)end / said->sample_rate);
        json_text(j, "phone", said->phones[i].name);
        json_text(j, "viseme", viseme_name(viseme == NOH_VISEME_COUNT ? NOH_VISEME_SIL : viseme));
        json_close(j, '}');
    }
    json_close(j, ']');
}

/* The middle of a frame. */
static int64_t tick_of(uint32_t frame)
{
    return (2 * (int64_t)frame + 1) * NOH_TICKS_PER_SECOND / (2 * FRAME_RATE);
}

static void json_curve(json *j, const char *key, const speech_track *t, uint32_t frames,
                       float (*at)(const speech_track *t, int64_t tick))
{
    json_open(j, key, '[');
    for (uint32_t f = 0; f < frames; f++) json_number(j, NULL, (double)at(t, tick_of(f)));
    json_close(j, ']');
}

/* Fields of noh_face_speech. */
static void json_voice(json *j, const prosody *voice, uint32_t frames)
{
    static const char *const keys[] = { "brows", "nod", "blink", "away" };
    for (uint32_t i = 0; i < 4u; i++) {
        json_open(j, keys[i], '[');
        for (uint32_t f = 0; f < frames; f++) {
            const noh_face_speech asked = prosody_at(voice, tick_of(f)).face;
            const float fields[4] = { asked.brows, asked.nod, asked.blink, asked.away };
            json_number(j, NULL, (double)fields[i]);
        }
        json_close(j, ']');
    }
}

static void json_frames(json *j, const speech_track *t, const prosody *voice)
{
    const uint32_t frames = (uint32_t)(t->seconds * FRAME_RATE) + 1u;
    json_open(j, "frames", '{');
    json_integer(j, "rate_hz", FRAME_RATE);
    json_open(j, "viseme", '[');
    for (uint32_t f = 0; f < frames; f++) {
        json_text(j, NULL, viseme_name(speech_track_viseme(t, tick_of(f))));
    }
    json_close(j, ']');
    json_curve(j, "open", t, frames, speech_track_open);
    json_curve(j, "round", t, frames, speech_track_round);
    json_voice(j, voice, frames);
    json_close(j, '}');
}

static void json_labels(json *j, const label_score *l)
{
    json_open(j, "labels", '{');
    json_integer(j, "frames", l->frames);
    json_integer(j, "visemes_right", l->visemes_right);
    json_integer(j, "lips_right", l->lips_right);
    json_integer(j, "closures", l->closures);
    json_integer(j, "closures_found", l->closures_found);
    json_integer(j, "phones", l->phones);
    json_integer(j, "onsets", l->onsets);
    json_number(j, "onset_median_s", l->onset_median_s);
    json_integer(j, "vowels", l->vowels);
    json_integer(j, "vowels_shut", l->vowels_shut);
    json_integer(j, "lip_changes", l->lip_changes);
    if (l->with_opening) json_number(j, "opening_correlation", l->opening_correlation);
    json_close(j, '}');
}

static int print_json(const speak_args *a, const spoken *s)
{
    json j = json_begin();
    json_number(&j, "seconds", s->track.seconds);
    json_text(&j, "source",
              s->heard      ? "recording"
              : s->recorded ? "recording and text"
              : a->labels   ? "labels"
                            : "text");
    json_number(&j, "latency_ms", s->heard ? hearing_latency_ms(&a->how) : 0.0);
    if (s->heard) {
        json_text(&j, "method", a->how.amplitude ? "amplitude" : "ear");
        json_integer(&j, "clipped_samples", s->clipped);
    } else if (s->recorded) {
        json_number(&j, "score", s->score);
        json_bool(&j, "words_match", s->score >= ALIGNMENT_SCORE_POOR);
        json_integer(&j, "clipped_samples", s->clipped);
    }
    if (s->labelled) json_labels(&j, &s->against);
    json_phones(&j, &s->said);
    json_frames(&j, &s->track, &s->voice);
    return json_end(&j);
}

static double part(uint32_t of, uint32_t all)
{
    return all ? (double)of / all : 0.0;
}

static void print_text(const speak_args *a, const spoken *s)
{
    FILE *out = report_stream(a->output);
    if (s->heard) {
        fprintf(out, "%.2f s, heard %s, %zu mouth shapes:", s->track.seconds,
                a->how.amplitude ? "by loudness alone" : "by ear", s->said.phone_count);
    } else {
        fprintf(out, "%.2f s, %zu words, %zu phones:", s->track.seconds, s->said.word_count, s->said.phone_count);
    }
    for (size_t i = 0; i < s->said.phone_count; i++) {
        fprintf(out, " %s", s->said.phones[i].name[0] ? s->said.phones[i].name : "_");
    }
    fprintf(out, "\n");
    fprintf(out, "face: %u stresses raise the brows and nod the head, %u pauses blink\n", s->voice.stresses,
            s->voice.pauses);
    if (s->recorded && !s->heard)
        fprintf(out, "alignment score %.2f (%.2f or less: other words)\n", s->score, ALIGNMENT_SCORE_POOR);
    if (s->labelled) {
        const label_score *l = &s->against;
        fprintf(out,
                "against %s: visemes %.3f, lips %.3f of %u frames; p, b, m %u of %u; onsets %.1f ms (median of %u)\n",
                a->labels, part(l->visemes_right, l->frames), part(l->lips_right, l->frames), l->frames,
                l->closures_found, l->closures, 1000.0 * l->onset_median_s, l->onsets);
        fprintf(out, "vowels shut %.3f of %u frames; %.1f changes of lips a second", part(l->vowels_shut, l->vowels),
                l->vowels, FRAME_RATE * part(l->lip_changes, l->frames));
        if (l->with_opening) fprintf(out, "; correlation of the opening %.3f", l->opening_correlation);
        fprintf(out, "\n");
    }
}

/* ---- the text ---- */

static int read_words(const char *path, char **text)
{
    const int status = text_file_read(path, 0, TEXT_BYTES_MAX, text);
    return status || (*text)[0] ? status : tool_fail(path, "is empty: write the words to speak");
}

static int is_sound_file(const char *name)
{
    static const char *const ends[] = { ".wav", ".WAV", ".flac", ".ogg", ".aiff", ".aif", ".au", ".caf" };
    const size_t length = strlen(name);
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        const size_t n = strlen(ends[i]);
        if (length > n && !strcmp(name + length - n, ends[i])) return 1;
    }
    return 0;
}

static int take_text(const speak_args *a, spoken *s)
{
    const char *text = a->text ? a->text : a->subject;
    s->recorded = a->text || a->text_file;
    s->heard = !s->recorded && is_sound_file(a->subject);
    if (a->how.latency_ms < NOH_EAR_LATENCY_MIN_MS || a->how.latency_ms > NOH_EAR_LATENCY_MAX_MS) {
        return tool_usage("speak: --latency must be 40 to 80 ms");
    }
    if ((a->how.live || a->how.amplitude) && !s->heard) {
        return tool_usage("speak: --live and --amplitude need a recording without words");
    }
    if ((s->recorded || s->heard) && a->wav) return tool_usage("speak: --wav has no effect with a recording");
    if (!s->recorded && !s->heard && a->labels && a->wav) {
        return tool_usage("speak: --wav has no effect with --labels, which have no sound");
    }
    if (s->heard) text = "";
    if (a->text_file) return read_words(a->text_file, &s->text);
    if (strlen(text) > TEXT_BYTES_MAX) return tool_fail("speak", "the text is longer than %u bytes", TEXT_BYTES_MAX);
    s->text = strdup(text);
    return s->text ? 0 : tool_fail("speak", "out of memory");
}

/* ---- running ---- */

static void warn(const speak_args *a, const spoken *s)
{
    if (s->score < ALIGNMENT_SCORE_POOR) {
        fprintf(stderr,
                "noh: %s: warning: the words do not seem to match the recording (alignment score %.2f, expected "
                "%.2f): check the text and the language (--lang)\n",
                a->subject, s->score, ALIGNMENT_SCORE_POOR);
    }
    if (s->clipped) {
        fprintf(stderr, "noh: %s: warning: %zu samples are clipped at full scale: times are less exact\n", a->subject,
                s->clipped);
    }
}

/* A text too long for its recording: the alignment would take minutes to fail. */
static int check_length(const speak_args *a, const spoken *s, const sound *recording)
{
    const double seconds = (double)recording->count / recording->rate;
    const size_t bytes = strlen(s->text);
    if ((double)bytes <= TEXT_BYTES_SPARE + TEXT_BYTES_A_SECOND * seconds) return 0;
    return tool_fail(a->subject,
                     "%zu bytes of text are too many for %.1f s of sound: give only the words of this recording", bytes,
                     seconds);
}

static int read_recording(const speak_args *a, sound *recording)
{
    const int status = sound_read(a->subject, recording);
    if (!status && recording->only_channel) {
        fprintf(
            stderr,
            "noh: %s: warning: its channels cancel each other out, as with opposite phase: only channel %u is used\n",
            a->subject, (unsigned)recording->only_channel);
    }
    return status;
}

static int align(const speak_args *a, spoken *s)
{
    sound recording;
    alignment aligned;
    int status = read_recording(a, &recording);
    if (status) return status;
    status = check_length(a, s, &recording);
    if (!status) status = prosody_make(&recording, &s->voice);
    if (!status) status = alignment_make(&recording, s->text, a->language, &aligned);
    s->clipped = recording.clipped;
    sound_free(&recording);
    if (status) return status;
    s->said = aligned.said;
    s->score = aligned.score;
    warn(a, s);
    if (a->labels) status = labels_score(a->labels, &s->said, NULL, &s->against);
    s->labelled = a->labels != NULL;
    return status;
}

static int hear(const speak_args *a, spoken *s)
{
    sound recording;
    int status = read_recording(a, &recording);
    if (status) return status;
    status = hearing_make(&recording, &a->how, &s->said, &s->track);
    if (!status) status = prosody_make(&recording, &s->voice);
    s->clipped = recording.clipped;
    sound_free(&recording);
    if (!status && a->labels) status = labels_score(a->labels, &s->said, &s->track, &s->against);
    s->labelled = a->labels != NULL;
    return status;
}

static int write_pack(const speak_args *a, const spoken *s, const pack_file *face)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    byte_buffer out = { NULL, 0, 0, 0 };
    int status = speech_track_pack(&s->track, &s->voice, &s->said, s->text, face, a->name, &out);
    if (!status && noh_file_write(a->output, out.bytes, out.count, &error)) {
        status = tool_fail(a->output, "cannot write: %s", error.what);
    }
    buffer_free(&out);
    return status;
}

static int synthesize(const speak_args *a, spoken *s)
{
    sound voice;
    int status = synthesis_make(s->text, a->language, &s->said);
    if (!status) status = sound_from_pcm(s->said.samples, s->said.sample_count, s->said.sample_rate, &voice);
    if (status) return status;
    status = prosody_make(&voice, &s->voice);
    sound_free(&voice);
    return status;
}

static int say(const speak_args *a, spoken *s)
{
    int status = take_text(a, s);
    if (!status && s->heard) return hear(a, s);
    if (!status) {
        status = s->recorded ? align(a, s) : a->labels ? labels_say(a->labels, &s->said) : synthesize(a, s);
    }
    synthesis_end();
    if (!status) status = speech_track_make(&s->said, &s->track);
    return status;
}

static int run(void *args)
{
    const speak_args *a = args;
    pack_file face;
    spoken s;
    int status = a->face ? pack_file_open(&face, a->face) : 0;
    if (status) return status;
    memset(&s, 0, sizeof s);
    phone_shapes_of(a->face ? &face.pack : NULL);
    status = say(a, &s);
    if (!status && a->output) status = write_pack(a, &s, &face);
    if (!status && a->wav) status = wav_write(a->wav, s.said.samples, s.said.sample_count, s.said.sample_rate);
    if (!status && a->as_json) status = print_json(a, &s);
    if (!status && !a->as_json) print_text(a, &s);
    if (a->face) pack_file_close(&face);
    speech_track_free(&s.track);
    prosody_free(&s.voice);
    synthesis_free(&s.said);
    free(s.text);
    return status;
}

static speak_args arguments;

static const option options[] = {
    { .name = "--text",
      .kind = OPTION_TEXT,
      .at = offsetof(speak_args, text),
      .value = "WORDS",
      .what = "the words spoken in the recording IN.wav",
      .example = "Hello.",
      .excludes = "--text-file" },
    { .name = "--text-file",
      .kind = OPTION_INPUT,
      .at = offsetof(speak_args, text_file),
      .value = "FILE",
      .what = "the same, from a UTF-8 text file",
      .example = "line.txt" },
    { .name = "--labels",
      .kind = OPTION_INPUT,
      .at = offsetof(speak_args, labels),
      .value = "FILE",
      .what =
          "phones and their times: lines of start, end (s) and phone, of ARPABET or IPA. With a text: the mouth says these, without a voice; with a recording: the result is measured against them",
      .example = "line.phones" },
    { .name = "--live",
      .kind = OPTION_FLAG,
      .at = offsetof(speak_args, how.live),
      .what = "process a recording without words like a live microphone (JSON has the latency)",
      .excludes = "--text --text-file" },
    { .name = "--latency",
      .kind = OPTION_NUMBER,
      .at = offsetof(speak_args, how.latency_ms),
      .value = "MS",
      .initial = "40",
      .what = "how late the ear may be, 40 to 80 ms: more misses fewer closures",
      .example = "80",
      .needs = "--live",
      .excludes = "--amplitude" },
    { .name = "--amplitude",
      .kind = OPTION_FLAG,
      .at = offsetof(speak_args, how.amplitude),
      .what = "use only the loudness of a recording without words: three shapes, ten times a second",
      .excludes = "--text --text-file" },
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(speak_args, output),
      .value = "OUT.noh",
      .what = "a pack with the clip, to play along with other clips (--anim OUT.noh --clip speech)",
      .example = "line.noh",
      .needs = "--face" },
    { .name = "--face",
      .kind = OPTION_INPUT,
      .at = offsetof(speak_args, face),
      .value = "PACK",
      .what =
          "the face that speaks: its targets need names of ARKit, VRM or facial units; rows `phone` of its recipe give "
          "the mouth shapes of a language's phones",
      .example = "face.noh" },
    { .name = "--name",
      .kind = OPTION_TEXT,
      .at = offsetof(speak_args, name),
      .value = "NAME",
      .initial = "speech",
      .what = "name of the clip",
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
    .files = "TEXT|IN.wav",
    .what = "make phones and a mouth clip for a face from a text, a recording, or both",
    .more =
        "eSpeak NG speaks a text (Debian: libespeak-ng1, espeak-ng-data), and phones are exact to the sample. [[h@l'oU]] in a text is phones in its own spelling. To edit phones, write the lines that --labels reads from the phones of --json. Mouth shapes blend as they do in speech, and the lips meet for every p, b and m. Words become callback keys of the clip. Pitch and loudness tell a live face (--face on) when to raise its brows and to nod, and pauses when to blink and to look aside. With --text, the words are found in a recording (8 to 32 bits or floats, any rate, up to ten minutes; Debian: libsndfile1) by eSpeak NG's phones, in any of its languages, and the ear's network; a warning says if the words do not seem to match. A recording without words goes through the same ear as a microphone: fewer shapes are right, but any language works.",
    .example =
        "\"Hello, my name is Noh.\" --face face.noh -o line.noh --wav line.wav\n\"Guten Morgen\" --lang de --json\n"
        "line.wav --text \"Hello.\" --face face.noh -o line.noh\nline.wav --face face.noh -o line.noh",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(speak_args, subject),
    .args = &arguments,
    .run = run,
};
