/* clip_tables: derives the prefix codes of the clip codec from raw clips.
 *
 *   clip_tables > clip_tables.c                 flat codes, to start from
 *   clip_tables CLIP.rcl... > clip_tables.c     codes for these clips
 *
 * Every clip is encoded at 0.01 cm with a 3 cm shell and at 0.1 cm with a 10 cm shell; clips
 * above 60 Hz also with every 4th frame. Symbols are counted per context, each clip weighted so
 * that long ones do not drown short ones (by 1 / sqrt of its bytes), a little is added to every
 * symbol, and lengths limited to the look-up's bits are found by package-merge (Larmore and
 * Hirschberg, 1990). What is coded does not depend on the tables, so one pass is enough. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/codec/clip_encoder.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"

#define SYMBOLS_MAX 65u
#define ITEMS_MAX (2u * SYMBOLS_MAX)
#define SMOOTHING 0.02 /* of an average symbol's count, for symbols that did not occur */
#define FAST_HZ 60.0
#define DECIMATE 4u

typedef struct totals {
    double triple[NOH_CLIP_TRIPLE_CONTEXTS][NOH_CLIP_TRIPLE_SYMBOLS];
    double last[NOH_CLIP_LAST_CONTEXTS][NOH_CLIP_LAST_SYMBOLS];
    double dc[NOH_CLIP_DC_CONTEXTS][NOH_CLIP_DC_SYMBOLS];
    double step[NOH_CLIP_STEP_CONTEXTS][NOH_CLIP_STEP_SYMBOLS];
} totals;

typedef struct item {
    double weight;
    uint8_t counts[SYMBOLS_MAX];
} item;

static int by_weight(const void *a, const void *b)
{
    const item *x = a, *y = b;
    if (x->weight != y->weight) return x->weight < y->weight ? -1 : 1;
    return memcmp(x->counts, y->counts, sizeof x->counts); /* so that the order does not depend on qsort */
}

/* Code lengths of at most `limit` bits. */
static void code_lengths(const double *weights, uint32_t count, uint32_t limit, uint8_t *lengths)
{
    static item list[ITEMS_MAX], packed[ITEMS_MAX];
    uint32_t size = 0;
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) sum += weights[i];
    memset(lengths, 0, count);
    for (uint32_t l = 0; l < limit; l++) {
        uint32_t pairs = 0;
        for (; 2u * pairs + 1u < size; pairs++) {
            packed[pairs] = list[2u * pairs];
            packed[pairs].weight += list[2u * pairs + 1u].weight;
            for (uint32_t i = 0; i < count; i++)
                packed[pairs].counts[i] = (uint8_t)(packed[pairs].counts[i] + list[2u * pairs + 1u].counts[i]);
        }
        memcpy(list, packed, pairs * sizeof *list);
        for (uint32_t i = 0; i < count; i++) {
            memset(&list[pairs + i], 0, sizeof *list);
            list[pairs + i].weight = weights[i] + SMOOTHING * (sum + 1.0) / (double)count;
            list[pairs + i].counts[i] = 1;
        }
        size = pairs + count;
        qsort(list, size, sizeof *list, by_weight);
    }
    for (uint32_t k = 0; k < 2u * count - 2u; k++) {
        for (uint32_t i = 0; i < count; i++) lengths[i] = (uint8_t)(lengths[i] + list[k].counts[i]);
    }
}

static uint32_t reversed(uint32_t v, uint32_t bits)
{
    uint32_t r = 0;
    for (uint32_t i = 0; i < bits; i++) r |= ((v >> i) & 1u) << (bits - 1u - i);
    return r;
}

/* The look-up of a canonical code whose first bit is the lowest. */
static void print_table(const double *weights, uint32_t symbols, uint32_t bits)
{
    uint8_t lengths[SYMBOLS_MAX];
    uint16_t table[1u << NOH_CLIP_TRIPLE_BITS];
    uint32_t code = 0;
    code_lengths(weights, symbols, bits, lengths);
    memset(table, 0, sizeof table);
    for (uint32_t l = 1; l <= bits; l++, code <<= 1) {
        for (uint32_t s = 0; s < symbols; s++) {
            if (lengths[s] != l) continue;
            for (uint32_t i = reversed(code, l); i < 1u << bits; i += 1u << l) table[i] = (uint16_t)(s << 4 | l);
            code++;
        }
    }
    printf("    {\n");
    for (uint32_t i = 0; i < 1u << bits; i++)
        printf("%s%u,%s", i % 16u ? " " : "        ", (unsigned)table[i], i % 16u == 15u ? "\n" : "");
    printf("    },\n");
}

static void print_all(const totals *t)
{
    printf("const uint16_t noh_clip_triple_table[NOH_CLIP_TRIPLE_CONTEXTS][1u << NOH_CLIP_TRIPLE_BITS] = {\n");
    for (uint32_t i = 0; i < NOH_CLIP_TRIPLE_CONTEXTS; i++)
        print_table(t->triple[i], NOH_CLIP_TRIPLE_SYMBOLS, NOH_CLIP_TRIPLE_BITS);
    printf("};\n\nconst uint16_t noh_clip_last_table[NOH_CLIP_LAST_CONTEXTS][1u << NOH_CLIP_LAST_BITS] = {\n");
    for (uint32_t i = 0; i < NOH_CLIP_LAST_CONTEXTS; i++)
        print_table(t->last[i], NOH_CLIP_LAST_SYMBOLS, NOH_CLIP_LAST_BITS);
    printf("};\n\nconst uint16_t noh_clip_dc_table[NOH_CLIP_DC_CONTEXTS][1u << NOH_CLIP_DC_BITS] = {\n");
    for (uint32_t i = 0; i < NOH_CLIP_DC_CONTEXTS; i++) print_table(t->dc[i], NOH_CLIP_DC_SYMBOLS, NOH_CLIP_DC_BITS);
    printf("};\n\nconst uint16_t noh_clip_step_table[NOH_CLIP_STEP_CONTEXTS][1u << NOH_CLIP_STEP_BITS] = {\n");
    for (uint32_t i = 0; i < NOH_CLIP_STEP_CONTEXTS; i++)
        print_table(t->step[i], NOH_CLIP_STEP_SYMBOLS, NOH_CLIP_STEP_BITS);
    printf("};\n");
}

static void add_counts(const uint64_t *counts, size_t n, double weight, double *sums)
{
    for (size_t i = 0; i < n; i++) sums[i] += weight * (double)counts[i];
}

static int count_clip(const raw_skeleton *skeleton, const raw_clip *clip, double error_cm, double shell_cm, totals *t)
{
    clip_histogram *h = calloc(1, sizeof *h);
    clip_options options;
    byte_buffer out;
    model_error error;
    int failed = 1;
    memset(&options, 0, sizeof options);
    memset(&out, 0, sizeof out);
    options.error_cm = error_cm;
    options.shell_cm = shell_cm;
    options.histogram = h;
    if (h && !clip_encode(skeleton, clip, &options, &out, NULL, &error)) {
        const double weight = 1.0 / sqrt((double)out.count + 1.0);
        add_counts(h->triple[0], sizeof h->triple / sizeof(uint64_t), weight, t->triple[0]);
        add_counts(h->last[0], sizeof h->last / sizeof(uint64_t), weight, t->last[0]);
        add_counts(h->dc[0], sizeof h->dc / sizeof(uint64_t), weight, t->dc[0]);
        add_counts(h->step[0], sizeof h->step / sizeof(uint64_t), weight, t->step[0]);
        failed = 0;
    }
    buffer_free(&out);
    free(h);
    return failed;
}

/* Keep every n-th frame, in place. */
static void decimate(raw_clip *clip, uint32_t n)
{
    const uint32_t count = (clip->frame_count - 1u) / n + 1u;
    for (uint32_t f = 1; f < count; f++) {
        const size_t from = (size_t)f * n * clip->joint_count, to = (size_t)f * clip->joint_count;
        memmove(clip->rotations + 4u * to, clip->rotations + 4u * from, 4u * clip->joint_count * sizeof(float));
        memmove(clip->translations + 3u * to, clip->translations + 3u * from, 3u * clip->joint_count * sizeof(float));
        memmove(clip->scales + 3u * to, clip->scales + 3u * from, 3u * clip->joint_count * sizeof(float));
    }
    clip->frame_count = count;
    clip->sample_rate_hz /= n;
}

static int count_file(const char *path, totals *t)
{
    raw_set *set = NULL;
    model_error error;
    int failed;
    if (rcl_read(path, &set, &error)) {
        fprintf(stderr, "%s: %s\n", path, error.what);
        return 1;
    }
    failed = count_clip(&set->skeleton, set->clips, 0.01, 3.0, t) ||
             count_clip(&set->skeleton, set->clips, 0.1, 10.0, t);
    if (set->clips[0].sample_rate_hz > FAST_HZ) {
        decimate(set->clips, DECIMATE);
        failed = failed || count_clip(&set->skeleton, set->clips, 0.01, 3.0, t) ||
                 count_clip(&set->skeleton, set->clips, 0.1, 10.0, t);
    }
    raw_set_free(set);
    return failed;
}

int main(int argc, char **argv)
{
    static totals t;
    int failed = 0;
    for (int i = 1; i < argc; i++) failed |= count_file(argv[i], &t);
    printf("/* Made by tools/clip_tables; do not edit.%s */\n#include \"motion/clip/clip_coefs_internal.h\"\n\n",
           argc > 1 ? " From:" : " Flat codes.");
    for (int i = 1; i < argc; i++) {
        const char *name = strrchr(argv[i], '/');
        printf("/* %s */\n", name ? name + 1 : argv[i]);
    }
    printf("\n");
    print_all(&t);
    return failed;
}
