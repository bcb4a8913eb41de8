#define _POSIX_C_SOURCE 200809L /* popen */
#include "voices.h"

#include <espeak-ng/speak_lib.h>
#include <iconv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/face.h"

enum { LINES_MAX = 512, LINE_BYTES = 1024, SHAPES_MAX = 512, ESPEAK_RATE = 22050 };

typedef struct phone_shape {
    char language[4], phone[12];
    int shape;
} phone_shape;

static char lines[LINES_MAX][LINE_BYTES];
static int line_count;
static phone_shape shapes[SHAPES_MAX];
static int shape_count;
static float samples[VOICE_SAMPLES_MAX];
static voice_phone phones[VOICE_PHONES_MAX];
static utterance said;
static uint64_t seed = 1;

void voices_seed(uint64_t from)
{
    seed = from;
}

double voices_random(double low, double high)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

void voices_die(const char *what, const char *which)
{
    fprintf(stderr, "train_ear: %s: %s\n", which, what);
    exit(1);
}

static void begin(int voice, double rate)
{
    memset(&said, 0, sizeof said);
    said.voice = voice;
    said.rate = rate;
    said.samples = samples;
    said.phones = phones;
}

static void add_sample(double value)
{
    if (said.count < VOICE_SAMPLES_MAX) samples[said.count++] = (float)value;
}

static void add_shape(double start, int first, int second)
{
    if (said.phone_count == VOICE_PHONES_MAX) voices_die("too many phones", "a sentence");
    phones[said.phone_count++] = (voice_phone){ start, first, second };
}

static void add_phone(double start, const char *name)
{
    noh_viseme second, first = noh_viseme_of_phone(name, &second);
    add_shape(start, first == NOH_VISEME_COUNT ? -1 : (int)first, second == NOH_VISEME_COUNT ? -1 : (int)second);
}

/* ---- what is read ---- */

static void hash_line(const char *line, uint64_t *hash)
{
    for (; *line; line++) *hash = (*hash ^ (unsigned char)*line) * 1099511628211u;
}

static void read_lines(const char *path, uint64_t *hash)
{
    FILE *f = fopen(path, "r");
    if (!f) voices_die("cannot be read", path);
    while (line_count < LINES_MAX && fgets(lines[line_count], LINE_BYTES, f)) {
        char *line = lines[line_count++];
        line[strcspn(line, "\n")] = 0;
        hash_line(line, hash);
        if (strlen(line) < 4 || line[2] != ' ' || strchr(line, '"')) voices_die("a line is LANGUAGE WORDS", path);
        line[2] = 0;
    }
    fclose(f);
}

static int shape_named(const char *name)
{
    static const char *const names[NOH_VISEME_COUNT] = { "sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS",
                                                         "nn",  "RR", "aa", "E",  "ih", "oh", "ou" };
    for (int v = 0; v < NOH_VISEME_COUNT; v++) {
        if (!strcmp(name, names[v])) return v;
    }
    voices_die("no such shape", name);
    return 0;
}

static void read_shapes(const char *path, uint64_t *hash)
{
    char line[LINE_BYTES];
    FILE *f = fopen(path, "r");
    if (!f) voices_die("cannot be read", path);
    while (fgets(line, sizeof line, f)) {
        char *word, *rest = line, *language, *shape;
        hash_line(line, hash);
        if (line[0] == '#') continue;
        language = strtok_r(line, " \n", &rest);
        shape = strtok_r(NULL, " \n", &rest);
        while (shape && (word = strtok_r(NULL, " \n", &rest))) {
            phone_shape *s = &shapes[shape_count++];
            if (shape_count == SHAPES_MAX) voices_die("too many phones", path);
            snprintf(s->language, sizeof s->language, "%s", language);
            snprintf(s->phone, sizeof s->phone, "%s", word);
            s->shape = shape_named(shape);
        }
    }
    fclose(f);
}

/* ---- eSpeak NG ---- */

static int hear_espeak(short *heard, int count, espeak_EVENT *event)
{
    for (int i = 0; heard && i < count; i++) add_sample(heard[i]);
    for (; event && event->type != espeakEVENT_LIST_TERMINATED; event++) {
        char name[9] = { 0 };
        memcpy(name, event->id.string, 8);
        if (event->type == espeakEVENT_PHONEME) add_phone((double)event->sample / ESPEAK_RATE, name);
    }
    return 0;
}

static void say_with_espeak(const char *text, const char *name, int voice)
{
    begin(voice, ESPEAK_RATE);
    if (espeak_SetVoiceByName(name) != EE_OK) voices_die("no such voice", name);
    espeak_SetParameter(espeakPITCH, (int)voices_random(25, 70), 0);
    espeak_SetParameter(espeakRATE, (int)voices_random(125, 215), 0);
    espeak_Synth(text, strlen(text) + 1, 0, POS_CHARACTER, 0, espeakCHARS_UTF8, NULL, NULL);
    espeak_Synchronize();
}

/* ---- flite and Festival: programs that write files ---- */

/* A WAV of 16 bits and one channel, whose header is 44 bytes: theirs are. */
static void read_sound(const char *path)
{
    unsigned char header[44];
    int16_t sample;
    FILE *f = fopen(path, "rb");
    if (!f || fread(header, 1, 44, f) != 44) voices_die("was not written", path);
    said.rate = header[24] | header[25] << 8 | header[26] << 16;
    while (fread(&sample, 2, 1, f) == 1) add_sample(sample);
    fclose(f);
    remove(path);
}

static void say_with_flite(const char *text, const char *name, int voice)
{
    char command[2 * LINE_BYTES], phone[64];
    double end = 0, next;
    FILE *f;
    begin(voice, 0);
    snprintf(command, sizeof command, "flite -voice %s --setf duration_stretch=%.2f -t \"%s\" -psdur -o train_ear.wav",
             name, voices_random(.85, 1.2), text);
    f = popen(command, "r");
    while (f && fscanf(f, " %63[^:]:%lf", phone, &next) == 2) {
        for (char *p = phone; *p; p++) *p = (char)(*p >= 'a' && *p <= 'z' ? *p - 32 : *p);
        add_phone(end, phone);
        end = next;
    }
    if (!f || pclose(f)) voices_die("does not speak", "flite");
    read_sound("train_ear.wav");
}

static void add_festival_phone(const char *language, double start, char *phone)
{
    int shape = -1;
    if (!strcmp(language, "en")) {
        for (char *p = phone; *p; p++) *p = (char)(*p >= 'a' && *p <= 'z' ? *p - 32 : *p);
        add_phone(start, phone);
        return;
    }
    for (int i = 0; i < shape_count; i++) {
        if (!strcmp(shapes[i].language, language) && !strcmp(shapes[i].phone, phone)) shape = shapes[i].shape;
    }
    if (shape < 0) fprintf(stderr, "train_ear: %s: no shape for phone %s\n", language, phone);
    add_shape(start, shape, -1);
}

/* The end, a colour and the phone in each line, after one of '#'. */
static int read_segments(const char *language, const char *path)
{
    char phone[64];
    double start = 0, end;
    FILE *f = fopen(path, "r");
    if (!f) return 0;
    (void)!fscanf(f, " #");
    while (fscanf(f, "%lf %*s %63s", &end, phone) == 2) {
        add_festival_phone(language, start, phone);
        start = end;
    }
    fclose(f);
    remove(path);
    return said.phone_count > 0;
}

static void recode(char *text, const char *encoding)
{
    char out[LINE_BYTES], *from = text, *to = out;
    size_t left = strlen(text), room = sizeof out - 1;
    iconv_t c = iconv_open(encoding, "UTF-8");
    if (c == (iconv_t)-1 || iconv(c, &from, &left, &to, &room) == (size_t)-1)
        voices_die("cannot be written so", encoding);
    *to = 0;
    memcpy(text, out, (size_t)(to - out) + 1u);
    iconv_close(c);
}

/* One run of the program says all sentences of the voice's language. */
static void say_with_festival(const char *language, const char *name, const char *encoding, int voice,
                              void (*take)(const utterance *))
{
    FILE *f = fopen("train_ear.scm", "w");
    if (!f) voices_die("cannot be written", "train_ear.scm");
    fprintf(f, "(voice_%s)\n", name);
    for (int i = 0; i < line_count; i++) {
        char text[LINE_BYTES];
        if (strcmp(lines[i], language)) continue;
        snprintf(text, sizeof text, "%s", lines[i] + 3);
        if (encoding) recode(text, encoding);
        fprintf(f, "(Parameter.set 'Duration_Stretch %.2f)\n(set! u (Utterance Text \"%s\"))\n(utt.synth u)\n",
                voices_random(.85, 1.2), text);
        fprintf(f, "(utt.save.segs u \"train_ear.%d.lab\")\n(utt.save.wave u \"train_ear.%d.wav\" 'riff)\n", i, i);
    }
    fclose(f);
    if (system("festival -b train_ear.scm 2>/dev/null") == -1) voices_die("cannot be run", "festival");
    for (int i = 0; i < line_count; i++) {
        char path[64];
        if (strcmp(lines[i], language)) continue;
        begin(voice, 0);
        snprintf(path, sizeof path, "train_ear.%d.lab", i);
        if (!read_segments(language, path)) voices_die("has said nothing", name);
        snprintf(path, sizeof path, "train_ear.%d.wav", i);
        read_sound(path);
        take(&said);
    }
    remove("train_ear.scm");
}

/* ---- all of them ---- */

/* eSpeak NG says each of them once, for its formants are further from people than what is cut out of recordings. */
static void say_lines(void (*take)(const utterance *))
{
    static const char *const variants[] = { "", "+f2", "+m3", "+f4", "+m7", "+m1", "+f5", "+m5" };
    static const char *const english[] = { "en-us", "en", "en-us", "en", "en-us", "en", "en", "en-us" };
    static const char *const flite[] = { "rms", "slt", "awb", "kal16" };
    for (int i = 0; i < line_count; i++) {
        const int in_english = !strcmp(lines[i], "en");
        char name[64];
        snprintf(name, sizeof name, "%.8s%s", in_english ? english[i % 8] : lines[i], variants[i % 8]);
        say_with_espeak(lines[i] + 3, name, VOICE_ESPEAK + i % 8);
        take(&said);
        for (int v = 0; v < 4 && in_english; v++) {
            say_with_flite(lines[i] + 3, flite[v], VOICE_FLITE + v);
            take(&said);
        }
    }
}

void voices_say(const char *sentences, const char *phone_file, void (*take)(const utterance *), uint64_t *hash)
{
    static const struct {
        const char *language, *name, *encoding;
    } festival[] = {
        { "en", "kal_diphone", NULL },
        { "en", "ked_diphone", NULL },
        { "en", "cmu_us_slt_arctic_hts", NULL },
        { "it", "lp_diphone", "ISO-8859-1" },
        { "it", "pc_diphone", "ISO-8859-1" },
        { "cs", "czech_dita", "ISO-8859-2" },
        { "cs", "czech_krb", "ISO-8859-2" },
        { "cs", "czech_machac", "ISO-8859-2" },
        { "cs", "czech_ph", "ISO-8859-2" },
        { "fi", "suo_fi_lj_diphone", "ISO-8859-1" },
        { "fi", "hy_fi_mv_diphone", "ISO-8859-1" },
        { "ru", "msu_ru_nsh_clunits", NULL },
        { "ca", "upc_ca_ona_hts", "ISO-8859-1" },
    };
    read_lines(sentences, hash);
    read_shapes(phone_file, hash);
    for (size_t i = 0; i < sizeof festival / sizeof festival[0]; i++) {
        say_with_festival(festival[i].language, festival[i].name, festival[i].encoding, VOICE_FESTIVAL + (int)i, take);
    }
    if (espeak_Initialize(AUDIO_OUTPUT_SYNCHRONOUS, 200, NULL,
                          espeakINITIALIZE_PHONEME_EVENTS | espeakINITIALIZE_PHONEME_IPA) <= 0) {
        voices_die("does not start", "eSpeak NG");
    }
    espeak_SetSynthCallback(hear_espeak);
    say_lines(take);
    espeak_Terminate();
}
