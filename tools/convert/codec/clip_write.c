/* clip_write.c: writes the bits of low_motion.h, in the order in which clip_open.c and clip_decode.c read them. */
#include <stdlib.h>

#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "clip_encoder.h"

#define BYTE 8u
#define LAST_AT_START 4u
#define SCALE_BIAS 128

typedef struct bit_writer {
    byte_buffer *out;
    uint64_t word;
    uint32_t count;
} bit_writer;

static void put(bit_writer *w, uint32_t value, uint32_t width)
{
    w->word |= ((uint64_t)value & (((uint64_t)1 << width) - 1u)) << w->count;
    w->count += width;
    while (w->count >= BYTE) {
        const uint8_t byte = (uint8_t)w->word;
        buffer_append(w->out, &byte, 1);
        w->word >>= BYTE;
        w->count -= BYTE;
    }
}

static void put_end(bit_writer *w)
{
    if (w->count) put(w, 0, BYTE - w->count);
}

static void put_varint(bit_writer *w, uint32_t v)
{
    do {
        put(w, v & 15u, 4);
        v >>= 4;
        put(w, v != 0u, 1);
    } while (v);
}

static void put_float(bit_writer *w, float v, uint32_t width)
{
    uint32_t word;
    memcpy(&word, &v, sizeof word);
    put(w, word >> (32u - width), width);
}

static void put_quat(bit_writer *w, const uint32_t codes[4], uint32_t width)
{
    put(w, codes[3], 2);
    for (int i = 0; i < 3; i++) put(w, codes[i], width);
}

/* A symbol's code is the lowest index of the decoding table that holds the symbol: there the bits above its length are
 * zero. */
static void put_symbol(bit_writer *w, const uint16_t *table, uint32_t bits, uint32_t symbol, uint64_t *counts)
{
    if (counts) counts[symbol]++;
    for (uint32_t i = 0; i < 1u << bits; i++) {
        if ((uint32_t)table[i] >> 4 == symbol) {
            put(w, i, table[i] & 15u);
            return;
        }
    }
}

/* ---- the header ---- */

/* Rounded up, so that the written value is never below the measured one. */
static void put_ratio(bit_writer *w, double ratio)
{
    uint32_t exponent = 0;
    double m = ceil(ratio * (double)NOH_CLIP_ERROR_ONE);
    while (m > 65535.0 && exponent < 15u) {
        exponent++;
        m = ceil(ratio * (double)NOH_CLIP_ERROR_ONE / (double)(1u << exponent));
    }
    put(w, exponent, 4);
    put(w, m > 65535.0 ? 65535u : (uint32_t)m, 16);
}

static uint32_t rounded(double v)
{
    return v < 1.0 ? 1u : v > 4294967295.0 ? 4294967295u : (uint32_t)(v + 0.5);
}

static uint32_t flags_of(const encoder *e)
{
    uint32_t flags = (e->wide ? NOH_CLIP_FLAG_WIDE : 0u) | (e->clip->loop ? NOH_CLIP_FLAG_LOOP : 0u) |
                     (e->options.open_loop ? NOH_CLIP_FLAG_OPEN : 0u) | (e->options.axes ? 0u : NOH_CLIP_FLAG_SPHERE) |
                     (e->parabola ? NOH_CLIP_FLAG_PARABOLA : 0u) | (e->splits ? NOH_CLIP_FLAG_SPLIT : 0u);
    for (uint32_t j = 0; j < e->joint_count; j++) {
        if (e->joints[j].modes[2] != NOH_CLIP_MODE_BIND) flags |= NOH_CLIP_FLAG_SCALE;
    }
    return flags;
}

static void put_rate(bit_writer *w, double hertz)
{
    const double whole = floor(hertz + 0.5);
    if (floor(hertz * (double)NOH_CLIP_MICRO + 0.5) == whole * (double)NOH_CLIP_MICRO) {
        put(w, 1, 1);
        put_varint(w, (uint32_t)whole);
    } else {
        put(w, 0, 1);
        put(w, (uint32_t)floor(hertz * (double)NOH_CLIP_MICRO + 0.5), 32);
    }
}

static void put_groups(bit_writer *w, const encoder *e)
{
    put_varint(w, e->group_count);
    for (uint32_t g = 0; g < e->group_count; g++) {
        const raw_floats *group = &e->clip->floats[g];
        char name[NOH_NAME_BYTES_MAX]; /* cut as names in packs are */
        string_cut(group->name ? group->name : "", name);
        put(w, noh_hash_name(name), 32);
        put_varint(w, group->node + 1u);
        put_varint(w, group->width);
    }
}

static void put_track(bit_writer *w, const encoder *e, const enc_track *t)
{
    const int rotation = t->track.kind == NOH_CLIP_ROTATION;
    if (!e->single) put(w, (uint32_t)t->track.step, 8);
    if (t->track.kind == NOH_CLIP_FLOATS) {
        put(w, (uint32_t)(t->scale_ids[1] + SCALE_BIAS), 8);
        put(w, (uint32_t)(t->scale_ids[2] + SCALE_BIAS), 8);
    }
    if (rotation) put(w, (t->track.flags & NOH_CLIP_TRACK_WILD) != 0, 1);
    if (!(t->track.flags & NOH_CLIP_TRACK_WILD)) {
        put(w, t->explicit_reference, 1);
        if (t->explicit_reference && rotation) put_quat(w, t->reference_codes, NOH_CLIP_REFERENCE_BITS);
        for (int i = 0; i < 3 && t->explicit_reference && !rotation; i++) put_float(w, t->track.reference[i], 16);
    }
    if (t->track.kind != NOH_CLIP_FLOATS) {
        put(w, (t->track.flags & NOH_CLIP_TRACK_MIX) != 0, 1);
        if (t->track.flags & NOH_CLIP_TRACK_MIX) put_quat(w, t->mix_codes, NOH_CLIP_MIX_BITS);
    }
}

static void put_linear(bit_writer *w, const encoder *e, const enc_joint *t, int what)
{
    static const uint8_t widths[4] = { 16, 20, 24, 32 };
    const double *rest = what == 2 ? t->rest.s : t->rest.t;
    if (t->modes[what] == NOH_CLIP_MODE_ANIMATED) put_track(w, e, &e->tracks[t->tracks[what]]);
    if (t->modes[what] != NOH_CLIP_MODE_CONSTANT) return;
    put(w, t->linear_width[what - 1], 2);
    for (int i = 0; i < 3; i++) put_float(w, (float)rest[i], widths[t->linear_width[what - 1]]);
}

static void put_joint(bit_writer *w, const encoder *e, const enc_joint *t, uint32_t flags)
{
    if (t->modes[1] == NOH_CLIP_MODE_BIND && t->modes[2] == NOH_CLIP_MODE_BIND &&
        t->modes[0] != NOH_CLIP_MODE_CONSTANT) {
        const uint32_t still = t->modes[0] == NOH_CLIP_MODE_BIND;
        put(w, still, still ? 2u : 1u);
    } else {
        put(w, 3, 2);
        put(w, t->modes[0], 2);
        put(w, t->modes[1], 2);
        if (flags & NOH_CLIP_FLAG_SCALE) put(w, t->modes[2], 2);
    }
    put_linear(w, e, t, 1);
    put_linear(w, e, t, 2);
    if (t->modes[0] == NOH_CLIP_MODE_ANIMATED) put_track(w, e, &e->tracks[t->tracks[0]]);
    if (t->modes[0] == NOH_CLIP_MODE_CONSTANT) {
        put(w, t->constant_width - NOH_CLIP_CONSTANT_BITS, 4);
        put_quat(w, t->constant_codes, t->constant_width);
    }
}

/* ---- segments ---- */

static void put_triple(bit_writer *w, encoder *e, const int32_t c[3], const uint32_t sums[3], int first)
{
    clip_histogram *h = e->options.histogram;
    uint32_t symbol = 0, context = 0, magnitudes[3], shifts[3];
    for (uint32_t i = 0; i < 3u; i++) {
        uint32_t quotient;
        magnitudes[i] = (uint32_t)abs(c[i]);
        shifts[i] = noh_clip_shift(sums[i]);
        quotient = magnitudes[i] >> shifts[i];
        symbol |= (quotient < NOH_CLIP_QUOTIENT_MAX ? quotient : NOH_CLIP_QUOTIENT_MAX) << (2u * i);
        context |= (uint32_t)(sums[i] >= NOH_CLIP_BUSY) << i;
    }
    if (first) context = NOH_CLIP_TRIPLE_FIRST;
    put_symbol(w, noh_clip_triple_table[context], NOH_CLIP_TRIPLE_BITS, symbol, h ? h->triple[context] : NULL);
    for (uint32_t i = 0; i < 3u; i++) {
        const uint32_t quotient = magnitudes[i] >> shifts[i];
        if (quotient >= NOH_CLIP_QUOTIENT_MAX) {
            const uint32_t v = quotient - NOH_CLIP_QUOTIENT_MAX + 1u, zeros = noh_clip_bit_length(v) - 1u;
            put(w, 0, zeros);
            put(w, 1, 1);
            put(w, v & ((1u << zeros) - 1u), zeros);
        }
    }
    for (uint32_t i = 0; i < 3u; i++) put(w, magnitudes[i] & ((1u << shifts[i]) - 1u), shifts[i]);
    for (uint32_t i = 0; i < 3u; i++) {
        if (magnitudes[i]) put(w, c[i] < 0, 1);
    }
}

static void put_mean(bit_writer *w, encoder *e, const int32_t c[3], const uint32_t sums[3], uint32_t last)
{
    clip_histogram *h = e->options.histogram;
    for (uint32_t i = 0; i < 3u; i++) {
        const uint32_t magnitude = (uint32_t)abs(c[i]), category = noh_clip_bit_length(magnitude);
        const uint32_t context = noh_clip_dc_context(sums[i], last);
        put_symbol(w, noh_clip_dc_table[context], NOH_CLIP_DC_BITS, category, h ? h->dc[context] : NULL);
        if (category) {
            put(w, magnitude & ((1u << (category - 1u)) - 1u), category - 1u);
            put(w, c[i] < 0, 1);
        }
    }
}

static int is_zero(const int32_t c[3])
{
    return !c[0] && !c[1] && !c[2];
}

/* What the coefficients above frequency k, below `end`, say of it; `neighbour`: what stands at `end`. */
static void sum_above(const enc_piece *p, uint32_t k, uint32_t end, uint32_t neighbour, uint32_t sums[3])
{
    for (int c = 0; c < 3; c++) {
        sums[c] = end <= k + 3u ? neighbour : 0u;
        for (uint32_t i = k + 1u; i < end && i <= k + 3u; i++) sums[c] += (uint32_t)abs(p->coefs[i][c]);
    }
}

/* The frequencies from `first` up to `end`, without zeros at their upper end. Returns how many there are. */
static uint32_t put_coefs(bit_writer *w, encoder *e, const enc_piece *p, uint32_t first, uint32_t end, uint32_t context)
{
    clip_histogram *h = e->options.histogram;
    const uint32_t all = end;
    uint32_t sums[3], neighbour;
    if (end > p->last) end = p->last;
    while (end > first && is_zero(p->coefs[end - 1u])) end--;
    if (end < first) end = first;
    put_symbol(w, noh_clip_last_table[context], NOH_CLIP_LAST_BITS, end - first, h ? h->last[context] : NULL);
    neighbour = context == NOH_CLIP_LAST_LOW && end == all ? NOH_CLIP_LOW_NEIGHBOUR : 0u;
    for (uint32_t k = end; k-- > first;) {
        sum_above(p, k, end, neighbour, sums);
        if (k) {
            put_triple(w, e, p->coefs[k], sums, k == end - 1u && !neighbour);
        } else {
            put_mean(w, e, p->coefs[0], sums, end);
        }
    }
    return end - first;
}

static void put_step(bit_writer *w, encoder *e, uint32_t step, int before)
{
    clip_histogram *h = e->options.histogram;
    const uint32_t context = (uint32_t)e->single;
    const int d = (int)step - before;
    uint32_t symbol = d < 0 ? (uint32_t)(-2 * d - 1) : (uint32_t)(2 * d);
    if (symbol > NOH_CLIP_STEP_ESCAPE) symbol = NOH_CLIP_STEP_ESCAPE;
    put_symbol(w, noh_clip_step_table[context], NOH_CLIP_STEP_BITS, symbol, h ? h->step[context] : NULL);
    if (symbol == NOH_CLIP_STEP_ESCAPE) put(w, step, 8);
}

/* The tracks of a segment; `low`: of how many frequencies. */
static void put_tracks(bit_writer *w, encoder *e, const enc_segment *s, uint32_t any_raw, uint32_t low)
{
    uint32_t last[2] = { LAST_AT_START, LAST_AT_START };
    int step[2] = { NOH_CLIP_STEP_FIRST, NOH_CLIP_STEP_FIRST };
    for (uint32_t i = 0; i < e->track_count; i++) {
        const enc_track *t = &e->tracks[i];
        const enc_piece *p = &s->pieces[i];
        const uint32_t class = t->track.kind == NOH_CLIP_ROTATION;
        if (any_raw) put(w, p->raw, 1);
        if (p->raw) {
            for (uint32_t k = 0; k < s->count * (class ? 4u : 3u); k++) put_float(w, p->values[k], 32);
            e->report.raw_track_segments++;
            continue;
        }
        put_step(w, e, p->step, e->single ? step[class] : t->track.step);
        if (t->track.flags & NOH_CLIP_TRACK_WILD) {
            put_quat(w, p->wild_codes, NOH_CLIP_WILD_BITS);
            put(w, p->negative, 1);
        }
        last[class] = put_coefs(w, e, p, 0, low, s->split ? NOH_CLIP_LAST_LOW : noh_clip_last_context(last[class]));
        step[class] = p->step;
    }
}

/* The parts that put_tracks leaves out. */
static void put_high(bit_writer *w, encoder *e, const enc_segment *s, uint32_t low)
{
    uint32_t last[2] = { LAST_AT_START, LAST_AT_START };
    for (uint32_t i = 0; i < e->track_count; i++) {
        const uint32_t class = e->tracks[i].track.kind == NOH_CLIP_ROTATION;
        if (!s->pieces[i].raw)
            last[class] = put_coefs(w, e, &s->pieces[i], low, s->count, noh_clip_last_context(last[class]));
    }
}

/* All that another writer has written. */
static void put_bits_of(bit_writer *w, const bit_writer *from)
{
    for (size_t i = 0; i < from->out->count; i++) put(w, from->out->bytes[i], BYTE);
    put(w, (uint32_t)from->word, from->count);
    if (from->out->failed) w->out->failed = 1;
}

static void put_segment(bit_writer *w, encoder *e, const enc_segment *s)
{
    uint32_t any_raw = 0;
    byte_buffer bytes;
    bit_writer low = { &bytes, 0, 0 };
    for (uint32_t i = 0; i < e->track_count; i++) any_raw |= s->pieces[i].raw;
    put(w, any_raw, 1);
    if (e->splits) put(w, s->split, 1);
    if (!s->split) {
        put_tracks(w, e, s, any_raw, s->count);
        put_end(w);
        return;
    }
    memset(&bytes, 0, sizeof bytes);
    put_tracks(&low, e, s, any_raw, s->count / 2u);
    put_varint(w, (uint32_t)bytes.count * BYTE + low.count);
    put_bits_of(w, &low);
    put_high(w, e, s, s->count / 2u);
    put_end(w);
    buffer_free(&bytes);
}

/* The size of a segment, found by writing it. */
int enc_segment_cost(encoder *e, const enc_segment *s, size_t *bytes)
{
    clip_histogram *histogram = e->options.histogram;
    const uint32_t raw = e->report.raw_track_segments;
    byte_buffer out;
    bit_writer w = { &out, 0, 0 };
    memset(&out, 0, sizeof out);
    e->options.histogram = NULL;
    for (uint32_t i = 0; i < e->track_count; i++)
        e->tracks[i].track.step = (int16_t)e->tracks[i].step_guess; /* not known yet; this is near */
    put_segment(&w, e, s);
    e->options.histogram = histogram;
    e->report.raw_track_segments = raw;
    *bytes = out.count;
    buffer_free(&out);
    return out.failed ? enc_fail(e, "out of memory") : 0;
}

static int by_value(const void *a, const void *b)
{
    return (int)*(const uint8_t *)a - (int)*(const uint8_t *)b;
}

/* A track's step in the header: the median of its segments'. */
static int find_steps(encoder *e)
{
    uint8_t *steps = enc_alloc(e, e->segment_count, 1);
    if (!steps) return 1;
    for (uint32_t i = 0; i < e->track_count; i++) {
        uint32_t n = 0;
        for (uint32_t s = 0; s < e->segment_count; s++) {
            if (!e->segments[s].pieces[i].raw) steps[n++] = e->segments[s].pieces[i].step;
        }
        qsort(steps, n, 1, by_value);
        e->tracks[i].track.step = n ? steps[n / 2u] : 0;
    }
    free(steps);
    return 0;
}

static int put_segments(encoder *e, byte_buffer *segments, uint32_t *sizes)
{
    for (uint32_t s = 0; s < e->segment_count; s++) {
        const size_t begin = segments->count;
        bit_writer w = { segments, 0, 0 };
        put_segment(&w, e, &e->segments[s]);
        sizes[s] = (uint32_t)(segments->count - begin);
    }
    return segments->failed;
}

static void put_header(bit_writer *w, const encoder *e, double max_error, double rms_error, uint32_t joint,
                       uint32_t time_parts, const uint32_t *sizes)
{
    const uint32_t flags = flags_of(e);
    const double bound_cm = e->options.error_cm;
    uint32_t width = 0;
    put(w, NOH_CLIP_VERSION, 8);
    put(w, flags, 8);
    put_varint(w, e->joint_count);
    put_varint(w, e->frame_count);
    put_rate(w, e->clip->sample_rate_hz);
    put_varint(w, e->segment_count);
    for (uint32_t s = 0; s < e->segment_count; s++) {
        if (noh_clip_bit_length(sizes[s]) > width) width = noh_clip_bit_length(sizes[s]);
    }
    if (!e->single) put(w, width, 5);
    put_varint(w, rounded(bound_cm * 1e7));
    put_varint(w, rounded(e->options.shell_cm * 1e4));
    put_ratio(w, max_error / ((double)rounded(bound_cm * 1e7) * 1e-7));
    put_ratio(w, rms_error / ((double)rounded(bound_cm * 1e7) * 1e-7));
    put_varint(w, joint);
    put_varint(w, time_parts);
    put_groups(w, e);
    for (uint32_t i = 0; i < e->track_count && e->tracks[i].track.kind == NOH_CLIP_FLOATS; i++)
        put_track(w, e, &e->tracks[i]);
    for (uint32_t j = 0; j < e->joint_count; j++) put_joint(w, e, &e->joints[j], flags);
    for (uint32_t s = 0; s < e->segment_count && !e->single; s++) put(w, sizes[s], width);
    put_end(w);
}

int enc_write(encoder *e, double max_error, double rms_error, uint32_t joint, uint32_t time_parts, byte_buffer *out)
{
    byte_buffer segments;
    bit_writer w = { out, 0, 0 };
    uint32_t *sizes = enc_alloc(e, e->segment_count, sizeof *sizes);
    const size_t begin = out->count;
    memset(&segments, 0, sizeof segments);
    e->report.raw_track_segments = 0;
    if (!sizes || find_steps(e)) {
        free(sizes);
        return 1;
    }
    if (!put_segments(e, &segments, sizes)) {
        put_header(&w, e, max_error, rms_error, joint, time_parts, sizes);
        e->report.header_bytes = out->count - begin;
        buffer_append(out, segments.count ? segments.bytes : (const uint8_t *)"", segments.count);
    }
    buffer_free(&segments);
    free(sizes);
    return out->failed || segments.failed ? enc_fail(e, "out of memory") : 0;
}
