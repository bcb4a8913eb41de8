/* main.c: teaches the ear out of synthetic speech, and writes ear_tables.c.
 *
 *   train_ear SENTENCES.txt PHONES.txt [four|espeak|flite|festival] >ear_tables.c
 *
 * Every sentence is heard as it was said, and four times more as bad rooms and microphones have it, always the same. No
 * recording of a person's speech is used: those are there to judge what has been learnt. With a last argument four
 * speakers, or a whole synthesiser, are kept back, and how well they are read is printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "learn.h"
#include "spoil.h"

enum { MAX_FRAMES = 2500000, MAX_UTTERANCES = 16384, ROUNDS = 10, SPOILED = 4, N = EAR_FEATURES, V = NOH_VISEME_COUNT };

static const int kept_back[] = { VOICE_FLITE + 2, VOICE_FESTIVAL + 1, VOICE_FESTIVAL + 4, VOICE_FESTIVAL + 6 };

static ear_tables tables;
static int16_t cepstra[MAX_FRAMES][EAR_CEPSTRA], loudness[MAX_FRAMES];
static int8_t features[MAX_FRAMES][N];
static signed char shapes[MAX_FRAMES];
static int first_frame[MAX_UTTERANCES + 1], voices[MAX_UTTERANCES], spans[MAX_UTTERANCES][2], utterances;

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
        tables.share[k] = at < 0 || at >= EAR_MELS + 1 ? 0 : (uint8_t)fmin(255, floor((at - filter) * 256));
    }
}

static void make_tables(void)
{
    const double pi = acos(-1);
    for (int i = 0; i < EAR_WINDOW / 2; i++) {
        tables.window[i] = (int16_t)lrint(32767 * (.54 - .46 * cos(2 * pi * i / (EAR_WINDOW - 1))));
    }
    for (int i = 0; i <= EAR_FFT / 4; i++) tables.sine[i] = (int16_t)lrint(32767 * sin(2 * pi * i / EAR_FFT));
    make_filters();
}

/* ---- frames ---- */

static int shape_at(const utterance *u, double t)
{
    int p = u->phone_count - 1;
    double end;
    while (p >= 0 && u->phones[p].start > t) p--;
    if (p < 0) return NOH_VISEME_SIL;
    end = p + 1 < u->phone_count ? u->phones[p + 1].start : t + 1;
    return u->phones[p].second >= 0 && t > u->phones[p].start + .6 * (end - u->phones[p].start) ? u->phones[p].second
                                                                                                : u->phones[p].first;
}

static void hear(const utterance *said, double warp, int hard)
{
    int count, at = first_frame[utterances];
    const int16_t *heard = spoil(said, warp, hard, &count);
    if (utterances + 1 >= MAX_UTTERANCES) voices_die("too many", "sentences");
    for (int i = EAR_SKIP; i + EAR_WINDOW <= count && at < MAX_FRAMES; i += EAR_HOP, at++) {
        int32_t c[EAR_CEPSTRA], loud;
        noh_ear_cepstra(&tables, heard + i, heard[i - 1], c, &loud);
        for (int k = 0; k < EAR_CEPSTRA; k++) cepstra[at][k] = (int16_t)c[k];
        loudness[at] = (int16_t)loud;
        shapes[at] = (signed char)shape_at(said, warp * (i - EAR_SKIP + EAR_WINDOW / 2.0) / EAR_RATE);
    }
    voices[utterances] = said->voice;
    first_frame[++utterances] = at;
}

static void hear_often(const utterance *said)
{
    hear(said, 1, 0);
    for (int i = 0; i < SPOILED; i++) hear(said, voices_random(.85, 1.18), 1);
}

static void learn_mean(void)
{
    double sum[EAR_CEPSTRA] = { 0 }, count = 0;
    for (int f = 0; f < first_frame[utterances]; f++) {
        if (shapes[f] <= 0) continue;
        for (int c = 0; c < EAR_CEPSTRA; c++) sum[c] += cepstra[f][c];
        count++;
    }
    for (int c = 0; c < EAR_CEPSTRA; c++) tables.mean[c] = (int16_t)lrint(sum[c] / count);
}

/* What the network is shown of an utterance: into features, or their sums and squares. */
static void measure(int u, double *sum, double *squares)
{
    ear_voice v;
    noh_ear_voice_init(&tables, &v);
    for (int f = first_frame[u]; f < first_frame[u + 1]; f++) {
        int32_t c[EAR_CEPSTRA], measured[N];
        for (int k = 0; k < EAR_CEPSTRA; k++) c[k] = cepstra[f][k];
        noh_ear_measure(&v, c, loudness[f], measured);
        for (int k = 0; sum && k < N; k++) {
            sum[k] += measured[k];
            squares[k] += (double)measured[k] * measured[k];
        }
        if (!sum) noh_ear_scale(&tables, measured, features[f]);
    }
}

static void learn_scale(void)
{
    double sum[N] = { 0 }, squares[N] = { 0 };
    const double count = first_frame[utterances];
    for (int u = 0; u < utterances; u++) measure(u, sum, squares);
    for (int k = 0; k < N; k++) {
        const double mean = sum[k] / count, deviation = sqrt(squares[k] / count - mean * mean);
        tables.scale[k] = (uint16_t)lrint(32 * 4096 / deviation);
    }
    for (int u = 0; u < utterances; u++) measure(u, NULL, NULL);
}

static void learn_prior(void)
{
    double count[V] = { 0 }, all = 0;
    for (int f = 0; f < first_frame[utterances]; f++) {
        if (shapes[f] < 0) continue;
        count[(int)shapes[f]]++;
        all++;
    }
    for (int v = 0; v < V; v++) tables.prior[v] = (int16_t)lrint(256 * log2(all / count[v]));
}

static int is_kept_back(int voice, const char *synthesiser)
{
    const char *of = voice < VOICE_FLITE ? "espeak" : voice < VOICE_FESTIVAL ? "flite" : "festival";
    if (!synthesiser) return 0;
    if (strcmp(synthesiser, "four") != 0) return !strcmp(synthesiser, of);
    for (size_t i = 0; i < sizeof kept_back / sizeof kept_back[0]; i++) {
        if (kept_back[i] == voice) return 1;
    }
    return 0;
}

/* The utterances to learn from, or those that are kept back. */
static int choose_spans(int kept, const char *synthesiser)
{
    int count = 0;
    for (int u = 0; u < utterances; u++) {
        if (is_kept_back(voices[u], synthesiser) != kept) continue;
        spans[count][0] = first_frame[u];
        spans[count++][1] = first_frame[u + 1];
    }
    return count;
}

static int likeliest(int8_t (*past)[EAR_FIRST], int frame)
{
    int32_t weights[V];
    int best = 0;
    memmove(past, past + 1, EAR_BEFORE * sizeof *past);
    noh_ear_see(&tables, (const int8_t(*)[N])features[frame - EAR_AFTER], past[EAR_BEFORE]);
    noh_ear_read(&tables, (const int8_t(*)[EAR_FIRST])past, weights);
    for (int v = 1; v < V; v++) best = weights[v] > weights[best] ? v : best;
    return best;
}

static int lips_of(int shape)
{
    static const char lips[V + 1] = "001444444433422";
    return lips[shape];
}

static void judge(int count)
{
    static int8_t past[EAR_BEFORE + 1][EAR_FIRST];
    double right = 0, lips = 0, all = 0;
    for (int i = 0; i < count; i++) {
        for (int f = spans[i][0] + EAR_AFTER; f < spans[i][1] - EAR_AFTER; f++) {
            const int best = likeliest(past, f);
            const int8_t is = shapes[f];
            if (is < 0 || f < spans[i][0] + EAR_BEFORE + EAR_AFTER) continue;
            right += best == is;
            lips += lips_of(best) == lips_of(is);
            all++;
        }
    }
    fprintf(stderr, "kept back: %.3f of shapes, %.3f of lips right in %.0f frames\n", right / all, lips / all, all);
}

/* ---- what is written ---- */

static void put(const char *name, const void *data, int count, int bytes)
{
    int column = 0;
    printf("    .%s = {", name);
    for (int i = 0; i < count; i++) {
        const long v = bytes == 1    ? ((const uint8_t *)data)[i]
                       : bytes == 2  ? ((const int16_t *)data)[i]
                       : bytes == -2 ? ((const uint16_t *)data)[i]
                                     : ((const int32_t *)data)[i];
        if (column++ % 16 == 0) printf("\n        ");
        printf("%ld,%s", v, column % 16 && i + 1 < count ? " " : "");
    }
    printf("\n    },\n");
}

static void put_rows(const char *name, const int8_t *data, int rows, int columns)
{
    printf("    .%s = {\n", name);
    for (int r = 0; r < rows; r++) {
        printf("        {");
        for (int c = 0; c < columns; c++) {
            printf("%d%s", data[r * columns + c], c + 1 == columns ? "},\n" : c % 18 == 17 ? ",\n         " : ", ");
        }
    }
    printf("    },\n");
}

static void write_tables(uint64_t hash)
{
    printf("/* ear_tables.c: written by tools/train_ear (`make ear-tables`); sentences and phones %016llx. */\n",
           (unsigned long long)hash);
    printf("/* clang-format off */\n#include \"life/face/ear_internal.h\"\n\nconst ear_tables noh_ear_tables = {\n");
    put("window", tables.window, EAR_WINDOW / 2, 2);
    put("sine", tables.sine, EAR_FFT / 4 + 1, 2);
    put("mel", tables.mel, EAR_FFT / 2 + 1, 1);
    put("share", tables.share, EAR_FFT / 2 + 1, 1);
    put("mean", tables.mean, EAR_CEPSTRA, 2);
    put("scale", tables.scale, N, -2);
    put_rows("first", tables.first[0], EAR_FIRST, EAR_INPUTS);
    put("first_bias", tables.first_bias, EAR_FIRST, 4);
    put("first_scale", tables.first_scale, EAR_FIRST, 4);
    put_rows("second", tables.second[0], EAR_SECOND, EAR_TAPS * EAR_FIRST);
    put("second_bias", tables.second_bias, EAR_SECOND, 4);
    put_rows("output", tables.output[0], V, EAR_SECOND);
    put("output_bias", tables.output_bias, V, 4);
    put("prior", tables.prior, V, 2);
    printf("    .unit = %ld,\n};\n", (long)tables.unit);
}

int main(int argc, char **argv)
{
    const char *synthesiser = argc == 4 ? argv[3] : NULL;
    uint64_t hash = 14695981039346656037u;
    lesson l;
    if (argc != 3 && argc != 4) voices_die("SENTENCES.txt PHONES.txt [four|espeak|flite|festival] >ear_tables.c", "usage");
    make_tables();
    voices_say(argv[1], argv[2], hear_often, &hash);
    fprintf(stderr, "%d sentences, %d frames\n", utterances, first_frame[utterances]);
    learn_mean();
    learn_scale();
    learn_prior();
    l = (lesson){ (const int8_t(*)[N])features, shapes, (const int(*)[2])spans, choose_spans(0, synthesiser) };
    learn(&l, ROUNDS, &tables);
    if (synthesiser) judge(choose_spans(1, synthesiser));
    write_tables(hash);
    return 0;
}
