/* train_ear.c: teaches the ear out of synthetic speech, and writes runtime/face/ear_tables.c.
 *
 *   train_ear SENTENCES.txt >ear_tables.c
 *
 * Voices are those of eSpeak NG and of flite; sound is made louder, quieter, duller, brighter and noisier at random,
 * always the same. No recording of a person is used: those are there to judge what has been learnt. */
#define _POSIX_C_SOURCE 200809L /* popen */
#include <espeak-ng/speak_lib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "face/ear_internal.h"
#include "face/speech.h"

enum { MAX_FRAMES = 600000, MAX_SAMPLES = 1 << 21, MAX_PHONES = 4096, MAX_UTTERANCES = 4096 };
enum { N = EAR_COEFFICIENTS, V = NOH_VISEME_COUNT, SHUT_N = EAR_SEEN * EAR_COEFFICIENTS };

typedef struct phone {
    double start; /* s */
    int first, second;
} phone;

static ear_tables tables;
static int32_t raw[MAX_FRAMES][N];
static int16_t clean[MAX_FRAMES][N];
static signed char label[MAX_FRAMES];
static int first_frame[MAX_UTTERANCES + 1], utterances;
static float sound[MAX_SAMPLES];
static int sound_count;
static phone phones[MAX_PHONES];
static int phone_count;
static uint64_t hash = 14695981039346656037u, seed = 1;

static double uniform(double low, double high)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

static void die(const char *what)
{
    fprintf(stderr, "train_ear: %s\n", what);
    exit(1);
}

/* ---- the numbers that are mathematics ---- */

static double mel_of(double hz)
{
    return 2595 * log10(1 + hz / 700);
}

static void make_filters(void)
{
    const double low = mel_of(80), high = mel_of(7600);
    for (int k = 0; k <= EAR_FFT / 2; k++) {
        const double at = (mel_of((double)k * EAR_RATE / EAR_FFT) - low) / (high - low) * (EAR_MELS + 1);
        const int filter = (int)floor(at);
        tables.mel[k] = at < 0 || at >= EAR_MELS + 1 ? 255 : (uint8_t)filter;
        tables.share[k] = (uint8_t)fmin(255, floor((at - filter) * 256));
    }
}

static void make_tables(void)
{
    const double pi = acos(-1);
    for (int i = 0; i < EAR_WINDOW / 2; i++) {
        tables.window[i] = (int16_t)lrint(32767 * (.54 - .46 * cos(2 * pi * i / (EAR_WINDOW - 1))));
    }
    for (int i = 0; i <= EAR_FFT / 4; i++) tables.sine[i] = (int16_t)lrint(32767 * sin(2 * pi * i / EAR_FFT));
    for (int c = 0; c < N; c++) {
        for (int m = 0; m < EAR_MELS; m++) {
            const double scale = sqrt((c ? 2.0 : 1.0) / EAR_MELS) * 16384;
            tables.cosine[c][m] = (int16_t)lrint(scale * cos(pi * c * (m + .5) / EAR_MELS));
        }
    }
    make_filters();
}

/* ---- speech ---- */

static void add_phone(double start, const char *name)
{
    noh_viseme second, first = noh_viseme_of_phone(name, &second);
    if (phone_count == MAX_PHONES) die("too many phones");
    phones[phone_count++] = (phone){ start, first == NOH_VISEME_COUNT ? -1 : (int)first,
                                     second == NOH_VISEME_COUNT ? -1 : (int)second };
}

static int take(short *samples, int count, espeak_EVENT *event)
{
    for (int i = 0; samples && i < count && sound_count < MAX_SAMPLES; i++) sound[sound_count++] = samples[i];
    for (; event && event->type != espeakEVENT_LIST_TERMINATED; event++) {
        char name[9] = { 0 };
        memcpy(name, event->id.string, 8);
        if (event->type == espeakEVENT_PHONEME) add_phone(event->sample / 22050.0, name);
    }
    return 0;
}

static void say_with_espeak(const char *text, const char *voice, int pitch, int speed)
{
    if (espeak_SetVoiceByName(voice) != EE_OK) die(voice);
    espeak_SetParameter(espeakPITCH, pitch, 0);
    espeak_SetParameter(espeakRATE, speed, 0);
    espeak_Synth(text, strlen(text) + 1, 0, POS_CHARACTER, 0, espeakCHARS_UTF8, NULL, NULL);
    espeak_Synchronize();
}

static void say_with_flite(const char *text, const char *voice, double stretch)
{
    char command[1024], name[64];
    int16_t sample;
    double end = 0, next;
    FILE *f;
    snprintf(command, sizeof command, "flite -voice %s --setf duration_stretch=%.2f -t \"%s\" -psdur -o train_ear.wav",
             voice, stretch, text);
    f = popen(command, "r");
    while (f && fscanf(f, " %63[^:]:%lf", name, &next) == 2) {
        for (char *p = name; *p; p++) *p = (char)(*p >= 'a' && *p <= 'z' ? *p - 32 : *p);
        add_phone(end, name);
        end = next;
    }
    if (!f || pclose(f)) die("flite does not speak");
    f = fopen("train_ear.wav", "rb");
    if (!f || fseek(f, 44, SEEK_SET)) die("flite wrote nothing");
    while (sound_count < MAX_SAMPLES && fread(&sample, 2, 1, f) == 1) sound[sound_count++] = sample;
    fclose(f);
    remove("train_ear.wav");
}

/* Straight lines between samples do: what they lose at the top is what a telephone loses. */
static void resample(double rate)
{
    const int count = (int)(sound_count * EAR_RATE / rate) - 1;
    for (int i = 0; rate != EAR_RATE && i < count; i++) {
        const double at = i * rate / EAR_RATE;
        const int k = (int)at;
        sound[i] = (float)(sound[k] + (at - k) * (sound[k + 1] - sound[k]));
    }
    if (rate != EAR_RATE) sound_count = count;
}

static int viseme_at(double t)
{
    int p = phone_count - 1;
    double end;
    while (p >= 0 && phones[p].start > t) p--;
    if (p < 0) return NOH_VISEME_SIL;
    end = p + 1 < phone_count ? phones[p + 1].start : t + 1;
    return phones[p].second >= 0 && t > phones[p].start + .6 * (end - phones[p].start) ? phones[p].second
                                                                                       : phones[p].first;
}

/* The channel and the frames of what was said. */
static void learn(double rate)
{
    static int16_t heard[MAX_SAMPLES];
    const double gain = pow(10, uniform(-18, 0) / 20), noise = 32768 * pow(10, uniform(-75, -42) / 20);
    const double tilt = uniform(-.35, .35);
    int at = first_frame[utterances];
    resample(rate);
    for (int i = 0; i < sound_count; i++) {
        double s = gain * (sound[i] + tilt * (i ? sound[i - 1] : 0));
        s += noise * (uniform(-1, 1) + uniform(-1, 1) + uniform(-1, 1));
        heard[i] = (int16_t)fmax(-32768, fmin(32767, rint(s)));
    }
    for (int i = 0; i + EAR_WINDOW <= sound_count && at < MAX_FRAMES; i += EAR_HOP, at++) {
        int32_t loud;
        noh_ear_mfcc(&tables, heard + i, i ? heard[i - 1] : 0, raw[at], &loud);
        const int middle = i + EAR_WINDOW / 2;
        label[at] = (signed char)viseme_at(middle / (double)EAR_RATE);
    }
    if (utterances + 1 >= MAX_UTTERANCES) die("too many utterances");
    first_frame[++utterances] = at;
    sound_count = phone_count = 0;
}

static void say_all(const char *language, const char *text)
{
    static const char *const variants[] = { "", "+f2", "+m3", "+f4", "+m7", "+m1" };
    static const char *const english[] = { "en-us", "en", "en-us", "en", "en-us", "en" };
    static const char *const flite[] = { "rms", "slt", "awb", "kal16" };
    char voice[64];
    for (int i = 0; i < 6; i++) {
        snprintf(voice, sizeof voice, "%s%s", strcmp(language, "en") ? language : english[i], variants[i]);
        say_with_espeak(text, voice, (int)uniform(25, 70), (int)uniform(125, 215));
        learn(22050);
    }
    for (int i = 0; i < 4 && !strcmp(language, "en"); i++) {
        for (int k = 0; k < 2; k++) {
            say_with_flite(text, flite[i], uniform(.85, 1.2));
            learn(16000);
        }
    }
}

static void read_sentences(const char *path)
{
    char line[1024];
    FILE *f = fopen(path, "r");
    if (!f) die("cannot read the sentences");
    while (fgets(line, sizeof line, f)) {
        line[strcspn(line, "\n")] = 0;
        for (const char *p = line; *p; p++) hash = (hash ^ (unsigned char)*p) * 1099511628211u;
        if (strlen(line) < 4 || line[2] != ' ') die("a line is `LANGUAGE WORDS`");
        line[2] = 0;
        say_all(line, line + 3);
    }
    fclose(f);
}

/* ---- discriminants ---- */

static double *room(size_t count)
{
    double *p = calloc(count, sizeof *p);
    if (!p) die("out of memory");
    return p;
}

/* Solves a x = b for `m` right sides: rows of b become those of x. a is symmetric and positive definite. */
static void solve(double *a, double *b, int n, int m)
{
    for (int i = 0; i < n; i++) {
        const double pivot = 1 / a[i * n + i];
        for (int k = i; k < n; k++) a[i * n + k] *= pivot;
        for (int k = 0; k < m; k++) b[k * n + i] *= pivot;
        for (int r = 0; r < n; r++) {
            const double f = a[r * n + i];
            if (r == i || f == 0) continue;
            for (int k = i; k < n; k++) a[r * n + k] -= f * a[i * n + k];
            for (int k = 0; k < m; k++) b[k * n + r] -= f * b[k * n + i];
        }
    }
}

static void learn_mean(void)
{
    const int frames = first_frame[utterances];
    double sum[N] = { 0 }, count = 0;
    for (int f = 0; f < frames; f++) {
        if (label[f] <= 0) continue;
        for (int c = 0; c < N; c++) sum[c] += raw[f][c];
        count++;
    }
    for (int c = 0; c < N; c++) tables.mean[c] = (int16_t)lrint(sum[c] / count);
    for (int u = 0; u < utterances; u++) {
        ear_mean m;
        noh_ear_mean_init(&tables, &m);
        for (int f = first_frame[u]; f < first_frame[u + 1]; f++) {
            noh_ear_mean_take(&m, raw[f]);
            for (int c = 0; c < N; c++) clean[f][c] = (int16_t)raw[f][c];
        }
    }
}

static int32_t fixed(double value, double limit)
{
    return (int32_t)lrint(fmax(-limit, fmin(limit, value)));
}

static void learn_visemes(void)
{
    const int frames = first_frame[utterances];
    double *cov = room(N * N), *mean = room(V * N), *w = room(V * N), count[V] = { 0 }, all = 0;
    for (int f = 0; f < frames; f++) {
        if (label[f] < 0) continue;
        count[label[f]]++;
        all++;
        for (int c = 0; c < N; c++) mean[label[f] * N + c] += clean[f][c] / 256.0;
    }
    for (int v = 0; v < V; v++) {
        for (int c = 0; c < N; c++) w[v * N + c] = mean[v * N + c] /= count[v] + 1e-9;
    }
    for (int f = 0; f < frames; f++) {
        for (int i = 0; label[f] >= 0 && i < N; i++) {
            const double d = clean[f][i] / 256.0 - mean[label[f] * N + i];
            for (int k = 0; k < N; k++) cov[i * N + k] += d * (clean[f][k] / 256.0 - mean[label[f] * N + k]) / all;
        }
    }
    solve(cov, w, N, V);
    for (int v = 0; v < V; v++) {
        double bias = log(count[v] / all);
        for (int c = 0; c < N; c++) {
            bias -= .5 * w[v * N + c] * mean[v * N + c];
            tables.weight[v][c] = (int16_t)fixed(w[v * N + c] / log(2) * 2048, 32767);
        }
        tables.bias[v] = fixed(bias / log(2) * 524288, 2e9);
    }
    free(cov);
    free(mean);
    free(w);
}

/* Vowels count for most of what lips must not be shut in. */
static int is_vowel(int v)
{
    return v >= NOH_VISEME_AA;
}

static const int16_t *seen_at(int f)
{
    return clean[f - EAR_BEFORE];
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The bias at which `share` of all vowel frames are taken for shut lips. */
static void learn_threshold(double share)
{
    double *scores = room(MAX_FRAMES);
    int count = 0, hit = 0, lips = 0;
    tables.shut_bias = 0;
    for (int u = 0; u < utterances; u++) {
        for (int f = first_frame[u] + EAR_BEFORE; f < first_frame[u + 1] - EAR_AFTER; f++) {
            if (label[f] < 0 || !is_vowel(label[f])) continue;
            scores[count++] = (double)noh_ear_shut_score(&tables, (const int16_t(*)[N])seen_at(f));
        }
    }
    qsort(scores, (size_t)count, sizeof *scores, compare);
    tables.shut_bias = fixed(-scores[(int)(count * (1 - share))], 2e9);
    for (int u = 0; u < utterances; u++) {
        for (int f = first_frame[u] + EAR_BEFORE; f < first_frame[u + 1] - EAR_AFTER; f++) {
            lips += label[f] == NOH_VISEME_PP;
            hit += label[f] == NOH_VISEME_PP && noh_ear_shut_score(&tables, (const int16_t(*)[N])seen_at(f)) > 0;
        }
    }
    fprintf(stderr, "lips shut in %.2f of their frames at %.3f of vowels\n", (double)hit / lips, share);
    free(scores);
}

static void learn_shut(double share)
{
    double *cov = room(SHUT_N * SHUT_N), *mean = room(2 * SHUT_N), *w = room(SHUT_N), count[2] = { 0 }, largest = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int u = 0; u < utterances; u++) {
            for (int f = first_frame[u] + EAR_BEFORE; f < first_frame[u + 1] - EAR_AFTER; f++) {
                const int16_t *x = seen_at(f);
                const int shut = label[f] == NOH_VISEME_PP;
                if (label[f] <= 0 || (pass && !shut && f % 3)) continue;
                if (!pass) count[shut]++;
                for (int i = 0; i < SHUT_N; i++) {
                    if (!pass) mean[shut * SHUT_N + i] += x[i] / 256.0;
                    for (int k = 0; pass && k < SHUT_N; k++) {
                        cov[i * SHUT_N + k] += (x[i] / 256.0 - mean[shut * SHUT_N + i]) *
                                               (x[k] / 256.0 - mean[shut * SHUT_N + k]) * (shut ? 4 : 1);
                    }
                }
            }
        }
        for (int i = 0; !pass && i < 2 * SHUT_N; i++) mean[i] /= count[i / SHUT_N] + 1e-9;
    }
    for (int i = 0; i < SHUT_N; i++) cov[i * SHUT_N + i] *= 1.3; /* held back: it must not learn the synthesiser */
    for (int i = 0; i < SHUT_N; i++) w[i] = mean[SHUT_N + i] - mean[i];
    solve(cov, w, SHUT_N, 1);
    for (int i = 0; i < SHUT_N; i++) largest = fmax(largest, fabs(w[i]));
    for (int i = 0; i < SHUT_N; i++) tables.shut_weight[i / N][i % N] = (int16_t)lrint(w[i] / largest * 2047);
    learn_threshold(share);
    free(cov);
    free(mean);
    free(w);
}

/* ---- what is written ---- */

static void put(const char *name, const void *data, int count, int bytes)
{
    int column = 0;
    printf("    .%s = {", name);
    for (int i = 0; i < count; i++) {
        long v = bytes == 1   ? ((const uint8_t *)data)[i]
                 : bytes == 2 ? ((const int16_t *)data)[i]
                              : ((const int32_t *)data)[i];
        if (column++ % 16 == 0) printf("\n        ");
        printf("%ld,%s", v, column % 16 && i + 1 < count ? " " : "");
    }
    printf("\n    },\n");
}

static void put_rows(const char *name, const int16_t *data, int rows, int columns)
{
    printf("    .%s = {\n", name);
    for (int r = 0; r < rows; r++) {
        printf("        {");
        for (int c = 0; c < columns; c++) {
            printf("%d%s", data[r * columns + c], c + 1 == columns ? "},\n" : c % 14 == 13 ? ",\n         " : ", ");
        }
    }
    printf("    },\n");
}

static void write_tables(void)
{
    printf("/* ear_tables.c: written by tools/train_ear; sentences %016llx. */\n/* clang-format off */\n",
           (unsigned long long)hash);
    printf("#include \"face/ear_internal.h\"\n\nconst ear_tables noh_ear_tables = {\n");
    put("window", tables.window, EAR_WINDOW / 2, 2);
    put("sine", tables.sine, EAR_FFT / 4 + 1, 2);
    put("mel", tables.mel, EAR_FFT / 2 + 1, 1);
    put("share", tables.share, EAR_FFT / 2 + 1, 1);
    put_rows("cosine", tables.cosine[0], N, EAR_MELS);
    put("mean", tables.mean, N, 2);
    put_rows("weight", tables.weight[0], V, N);
    put("bias", tables.bias, V, 4);
    put_rows("shut_weight", tables.shut_weight[0], EAR_SEEN, N);
    printf("    .shut_bias = %ld,\n};\n", (long)tables.shut_bias);
}

int main(int argc, char **argv)
{
    if (argc < 2) die("usage: train_ear SENTENCES.txt [SHARE] >ear_tables.c");
    make_tables();
    if (espeak_Initialize(AUDIO_OUTPUT_SYNCHRONOUS, 200, NULL,
                          espeakINITIALIZE_PHONEME_EVENTS | espeakINITIALIZE_PHONEME_IPA) <= 0) {
        die("eSpeak NG does not start");
    }
    espeak_SetSynthCallback(take);
    read_sentences(argv[1]);
    fprintf(stderr, "%d sentences, %d frames\n", utterances, first_frame[utterances]);
    learn_mean();
    learn_visemes();
    learn_shut(argc > 2 ? atof(argv[2]) : .012);
    write_tables();
    espeak_Terminate();
    return 0;
}
