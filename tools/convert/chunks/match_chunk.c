/* match_chunk.c: a table for motion matching: which clips, of a text; their features, from their frames. */
#include "chunk_maker.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/text_scan.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/source_pose.h"
#include "convert/retarget/bones.h"
#include "motion/match/match_internal.h"
#include "noh/clip.h"

#define ROWS_A_SECOND 12.0
#define VELOCITY_S (1.0 / 60.0) /* velocities are differences over twice this */
#define ENDING_S (1.0 / 3.0)    /* the end of a clip that does not loop leads nowhere: no rows */
#define DRIFT_S (1.0 / 6.0)     /* beyond its end a clip continues as it moves then */
#define FEATURES (NOH_MATCH_FEATURES - 1u)

/* ---- the text ---- */

typedef struct match_line {
    char *clips; /* a name, or the beginning of names with '*' at the end */
    uint32_t tags, line;
} match_line;

typedef struct match_table {
    match_line *lines;
    uint32_t line_count;
    char *tags[NOH_MATCH_TAGS_MAX];
    uint32_t tag_count;
    char *feet[2]; /* NULL: by the names of bones */
    double rate;
    /* what is made of it */
    const raw_set *set;
    noh_pack_match_clip *clips; /* [clip_count] without names */
    const raw_clip **raws;      /* [clip_count] */
    uint32_t clip_count, row_count;
    double (*features)[FEATURES];          /* [row_count] */
    int8_t (*numbers)[NOH_MATCH_FEATURES]; /* [row_count] */
    float means[NOH_MATCH_FEATURES], scales[NOH_MATCH_FEATURES];
    uint16_t *order; /* [row_count] */
} match_table;

static int read_tag(text_scan *s, match_table *t, text_word word, uint32_t *tags)
{
    uint32_t i = 0;
    while (i < t->tag_count && !(strlen(t->tags[i]) == word.size && !memcmp(t->tags[i], word.text, word.size))) i++;
    if (i == NOH_MATCH_TAGS_MAX) return text_fail(s, word.line, "more than %u tags", NOH_MATCH_TAGS_MAX);
    if (i == t->tag_count) {
        t->tags[i] = text_copy(word);
        if (!t->tags[i]) return text_fail(s, word.line, "out of memory");
        t->tag_count++;
    }
    *tags |= 1u << i;
    return 0;
}

static int read_clips(text_scan *s, match_table *t)
{
    match_line *lines = realloc(t->lines, (t->line_count + 1u) * sizeof *lines), *line;
    text_word word;
    if (!lines) return text_fail(s, s->line, "out of memory");
    t->lines = lines;
    if (text_take_on_line(s, &word)) return 1;
    if (!word.size) return text_fail(s, s->line, "write `clip NAME [TAG ...]`; '*' at the end matches any ending");
    line = &lines[t->line_count];
    memset(line, 0, sizeof *line);
    line->line = word.line;
    line->clips = text_copy(word);
    if (!line->clips) return text_fail(s, word.line, "out of memory");
    t->line_count++;
    do {
        if (text_take_on_line(s, &word) || (word.size && read_tag(s, t, word, &line->tags))) return 1;
    } while (word.size);
    return 0;
}

static int read_feet(text_scan *s, match_table *t)
{
    text_word word;
    for (int i = 0; i < 2; i++) {
        if (text_take_on_line(s, &word)) return 1;
        if (!word.size) return text_fail(s, s->line, "write `feet LEFT RIGHT`, the names of two joints");
        free(t->feet[i]);
        t->feet[i] = text_copy(word);
        if (!t->feet[i]) return text_fail(s, word.line, "out of memory");
    }
    return 0;
}

static int read_line(text_scan *s, match_table *t)
{
    text_word word, value;
    char shown[TEXT_SHOWN];
    if (text_take_on_line(s, &word)) return 1;
    if (!word.size) return 0;
    if (text_is(word, "clip")) return read_clips(s, t);
    if (text_is(word, "feet")) return read_feet(s, t);
    if (!text_is(word, "rows")) {
        return text_fail(s, word.line, "'%s' is no statement: write clip, feet or rows", text_show(word, shown));
    }
    if (text_take_on_line(s, &value) || text_number(s, value, &t->rate)) return 1;
    return t->rate >= 2.0 && t->rate <= 60.0 ? 0 : text_fail(s, word.line, "rows must be 2 to 60 a second");
}

static int read_text(const char *path, match_table *t, uint32_t *line, model_error *error)
{
    size_t size = 0;
    char *text = input_read_text(path, &size, error);
    text_scan s;
    int failed = !text;
    if (text) text_start(&s, text, size, error);
    while (!failed && text_next_line(&s)) {
        *line = s.line;
        failed = read_line(&s, t);
    }
    free(text);
    if (failed) error->where[0] = 0; /* *line has the line */
    return failed;
}

/* ---- which clips ---- */

static int matches(const char *pattern, const char *name)
{
    const size_t length = strlen(pattern);
    if (length && pattern[length - 1u] == '*') return strncmp(pattern, name, length - 1u) == 0;
    return strcmp(pattern, name) == 0;
}

static int find_clips(const source *s, match_table *t, uint32_t *line, model_error *error)
{
    uint8_t *is_used = calloc(t->line_count + 1u, 1);
    int failed = !is_used;
    for (uint32_t i = 0; i < s->set_count && !t->clip_count && !failed; i++) {
        const raw_set *set = s->sets[i];
        t->set = set;
        free(t->clips);
        free(t->raws);
        t->clips = calloc(set->clip_count + 1u, sizeof *t->clips);
        t->raws = calloc(set->clip_count + 1u, sizeof *t->raws);
        failed = !t->clips || !t->raws;
        for (uint32_t c = 0; c < set->clip_count && !failed; c++) {
            uint32_t tags = 0, is = 0;
            for (uint32_t k = 0; k < t->line_count; k++) {
                if (!set->clips[c].joint_count || !matches(t->lines[k].clips, set->clips[c].name)) continue;
                is = is_used[k] = 1;
                tags |= t->lines[k].tags;
            }
            if (!is) continue;
            t->clips[t->clip_count].tags = tags;
            t->raws[t->clip_count++] = &set->clips[c];
        }
    }
    if (failed) failed = model_fail_memory(error);
    for (uint32_t k = 0; k < t->line_count && !failed; k++) {
        if (is_used[k]) continue;
        *line = t->lines[k].line;
        failed = model_fail(error, "", "no clip that moves joints has the name '%.64s'", t->lines[k].clips);
    }
    if (!failed && !t->clip_count) failed = model_fail(error, "", "no clips: add a line `clip NAME`, such as `clip *`");
    free(is_used);
    return failed;
}

/* ---- where an actor is ---- */

/* A place on the ground, and a turn about +y there. */
typedef struct spot {
    double x, z, turn;
} spot;

static spot compose(spot a, spot b)
{
    const double c = cos(a.turn), s = sin(a.turn);
    const spot out = { a.x + c * b.x + s * b.z, a.z - s * b.x + c * b.z, a.turn + b.turn };
    return out;
}

/* Of b, as seen from a. */
static spot relative(spot a, spot b)
{
    const double c = cos(a.turn), s = sin(a.turn), x = b.x - a.x, z = b.z - a.z;
    const spot out = { c * x - s * z, s * x + c * z, b.turn - a.turn };
    return out;
}

typedef struct sampler {
    const raw_set *set;
    const raw_clip *clip;
    uint32_t *joints;      /* of the source's channels */
    double *locals, *pose; /* of the moment that was sampled last */
    uint32_t followed[3];  /* joints: feet and hips */
    double duration_s;
    int loops;
    spot first, pass; /* at the start, in the clip's space; from start to end */
    spot drift;       /* a second, at the end of a clip that does not loop */
} sampler;

static double heading_of(const double *local)
{
    return 2.0 * atan2(local[1], local[3]);
}

/* Sample the clip, and get the root's place in its space: what root motion is (low_motion.h) with NOH_ROOT_GROUND. */
static spot sample(sampler *s, double time_s)
{
    spot out;
    source_rest(&s->set->skeleton, s->locals);
    source_locals(s->clip, s->joints, time_s, s->locals);
    out.x = s->locals[4];
    out.z = s->locals[6];
    out.turn = heading_of(s->locals) - s->first.turn;
    return out;
}

static spot origin_of(const sampler *s)
{
    const spot out = { s->first.x, s->first.z, 0.0 };
    return out;
}

/* The actor's displacement since the clip's start; `locals` become the pose of the time in the clip. */
static spot place_at(sampler *s, double time_s)
{
    spot sum = { 0.0, 0.0, 0.0 };
    if (s->loops) {
        for (; time_s >= s->duration_s; time_s -= s->duration_s) sum = compose(sum, s->pass);
    }
    if (s->loops && time_s < 0.0) {
        const spot nowhere = { 0.0, 0.0, 0.0 };
        sum = relative(s->pass, nowhere);
        time_s += s->duration_s;
    }
    const double within = fmin(fmax(time_s, 0.0), s->duration_s);
    const spot at = sample(s, within);
    sum = compose(sum, relative(origin_of(s), at));
    for (double left = time_s - within; left > 1e-9; left -= VELOCITY_S) {
        const double dt = fmin(left, VELOCITY_S);
        const spot step = { s->drift.x * dt, s->drift.z * dt, s->drift.turn * dt };
        sum = compose(sum, step);
    }
    return sum;
}

static int open_sampler(const match_table *t, const raw_clip *clip, int loops, sampler *s)
{
    const raw_skeleton *skeleton = &t->set->skeleton;
    spot end, before;
    s->set = t->set;
    s->clip = clip;
    s->duration_s = raw_clip_duration_s(clip);
    s->loops = loops && s->duration_s > 0.1;
    s->joints = calloc((clip->source ? clip->source->channel_count : 0u) + 1u, sizeof *s->joints);
    s->locals = calloc(skeleton->joint_count + 1u, SOURCE_LOCAL * sizeof *s->locals);
    s->pose = calloc(skeleton->joint_count + 1u, 12u * sizeof *s->pose);
    if (!s->joints || !s->locals || !s->pose) return 1;
    if (clip->source) source_joints(skeleton, clip->source, s->joints);
    memset(&s->first, 0, sizeof s->first);
    s->first = sample(s, 0.0);
    end = sample(s, s->duration_s);
    s->pass = relative(origin_of(s), end);
    before = sample(s, fmax(s->duration_s - DRIFT_S, 0.0));
    s->drift = relative(before, end);
    s->drift.turn = remainder(s->drift.turn, 6.283185307179586);
    s->drift.x /= DRIFT_S;
    s->drift.z /= DRIFT_S;
    s->drift.turn /= DRIFT_S;
    return 0;
}

static void close_sampler(sampler *s)
{
    free(s->joints);
    free(s->locals);
    free(s->pose);
}

/* ---- features ---- */

/* What is followed at a time, as seen from the actor at another time. */
static void points_at(sampler *s, double time_s, spot from, double out[9])
{
    const spot place = place_at(s, time_s), seen = relative(from, place);
    spot root = { s->locals[4], s->locals[6], heading_of(s->locals) - s->first.turn };
    source_object(&s->set->skeleton, s->locals, s->pose);
    for (int i = 0; i < 3; i++) {
        const double *p = s->pose + 12u * s->followed[i] + 9;
        const spot at = { p[0], p[2], 0.0 }, moved = compose(seen, relative(root, at));
        out[3 * i] = moved.x;
        out[3 * i + 1] = p[1];
        out[3 * i + 2] = moved.z;
    }
}

static void find_features(sampler *s, double time_s, double out[FEATURES])
{
    const spot here = place_at(s, time_s);
    const double early = s->loops ? time_s - VELOCITY_S : fmax(time_s - VELOCITY_S, 0.0);
    const double late = s->loops ? time_s + VELOCITY_S : fmin(time_s + VELOCITY_S, fmax(s->duration_s, early + 1e-3));
    double now[9], before[9], after[9];
    points_at(s, time_s, here, now);
    points_at(s, early, here, before);
    points_at(s, late, here, after);
    memcpy(out, now, 6 * sizeof *out);
    for (int i = 0; i < 9; i++) out[6 + i] = (after[i] - before[i]) / (late - early);
    for (int i = 0; i < 3; i++) {
        const spot there = relative(here, place_at(s, time_s + (1 + i) / 3.0));
        out[15 + 2 * i] = there.x;
        out[16 + 2 * i] = there.z;
        out[21 + 2 * i] = sin(there.turn);
        out[22 + 2 * i] = cos(there.turn);
    }
}

static uint32_t rows_of(double duration_s, int loops, double row_s)
{
    const double end = loops ? duration_s - 1e-6 : duration_s - ENDING_S;
    return end > 0.0 ? 1u + (uint32_t)(end / row_s) : 1u;
}

static uint32_t row_ticks(const match_table *t)
{
    return (uint32_t)(NOH_TICKS_PER_SECOND / t->rate + 0.5);
}

static uint32_t joint_named(const raw_skeleton *skeleton, const char *name)
{
    uint32_t j = 0;
    while (j < skeleton->joint_count && strcmp(skeleton->joints[j].name ? skeleton->joints[j].name : "", name)) j++;
    return j < skeleton->joint_count ? j : NOH_NONE;
}

static int find_joints(const match_table *t, uint32_t followed[3], model_error *error)
{
    const raw_skeleton *skeleton = &t->set->skeleton;
    uint16_t bones[NOH_BONES];
    bones_find(skeleton, bones);
    for (int i = 0; i < 2; i++) {
        const uint16_t bone = bones[NOH_BONE_FOOT + i * (int)NOH_BONE_RIGHT];
        followed[i] = t->feet[i] ? joint_named(skeleton, t->feet[i]) : bone == NOH_JOINT_ROOT ? NOH_NONE : bone;
        if (followed[i] == NOH_NONE && t->feet[i]) {
            return model_fail(error, "", "the skeleton has no joint '%.64s'", t->feet[i]);
        }
        if (followed[i] == NOH_NONE) {
            return model_fail(error, "", "no joint has the name of a foot: add a line `feet LEFT RIGHT`");
        }
    }
    followed[2] = bones[NOH_BONE_HIPS] == NOH_JOINT_ROOT ? 0u : bones[NOH_BONE_HIPS];
    return 0;
}

static int find_rows(match_table *t, int all_loop, model_error *error)
{
    const double row_s = (double)row_ticks(t) / NOH_TICKS_PER_SECOND;
    uint32_t followed[3];
    int failed = find_joints(t, followed, error);
    for (uint32_t c = 0; c < t->clip_count && !failed; c++) {
        const int loops = all_loop || t->raws[c]->loop;
        sampler s;
        memset(&s, 0, sizeof s);
        memcpy(s.followed, followed, sizeof followed);
        t->clips[c].first_row = t->row_count;
        t->clips[c].row_count = rows_of(raw_clip_duration_s(t->raws[c]), loops, row_s);
        t->row_count += t->clips[c].row_count;
        if (t->row_count > NOH_MATCH_ROWS_MAX) {
            return model_fail(error, "", "the clips have more than %u rows: lower `rows`", NOH_MATCH_ROWS_MAX);
        }
        double(*grown)[FEATURES] = realloc(t->features, t->row_count * sizeof *grown);
        if (grown) t->features = grown;
        failed = !grown || open_sampler(t, t->raws[c], loops, &s);
        if (failed) failed = model_fail_memory(error);
        for (uint32_t r = 0; r < t->clips[c].row_count && !failed; r++) {
            find_features(&s, r * row_s, t->features[t->clips[c].first_row + r]);
        }
        close_sampler(&s);
    }
    return failed;
}

/* ---- numbers ---- */

/* Features of a group have one scale: the weight over the mean of their standard deviations. */
static void find_scales(match_table *t)
{
    static const struct group {
        uint32_t first, end;
        double weight;
    } groups[] = { { 0, 6, 0.75 }, { 6, 12, 1.0 }, { 12, 15, 1.0 }, { 15, 21, 1.0 }, { 21, 27, 1.5 } };
    for (size_t g = 0; g < sizeof groups / sizeof *groups; g++) {
        double spread = 0.0;
        for (uint32_t k = groups[g].first; k < groups[g].end; k++) {
            double sum = 0.0, squares = 0.0;
            for (uint32_t r = 0; r < t->row_count; r++) sum += t->features[r][k];
            const double mean = sum / t->row_count;
            for (uint32_t r = 0; r < t->row_count; r++) squares += pow(t->features[r][k] - mean, 2.0);
            t->means[k] = (float)mean;
            spread += sqrt(squares / t->row_count) / (groups[g].end - groups[g].first);
        }
        for (uint32_t k = groups[g].first; k < groups[g].end; k++) {
            const double unit = k < NOH_MATCH_COARSE ? NOH_MATCH_UNIT : NOH_MATCH_UNIT / 2;
            t->scales[k] = spread > 1e-5 ? (float)(unit * groups[g].weight / spread) : 0.0f;
        }
    }
}

static int make_numbers(match_table *t)
{
    t->numbers = calloc(t->row_count, sizeof *t->numbers);
    t->order = calloc(t->row_count, sizeof *t->order);
    if (!t->numbers || !t->order) return 1;
    find_scales(t);
    for (uint32_t r = 0; r < t->row_count; r++) {
        for (uint32_t k = 0; k < FEATURES; k++) {
            const double v = (t->features[r][k] - (double)t->means[k]) * (double)t->scales[k];
            t->numbers[r][k] = (int8_t)floor(fmin(fmax(v, -127.0), 127.0) + 0.5);
        }
    }
    return 0;
}

/* ---- the order ---- */

typedef struct keyed_row {
    int key;
    uint16_t row;
} keyed_row;

static int by_key(const void *a, const void *b)
{
    const keyed_row *x = a, *y = b;
    return x->key != y->key ? (x->key > y->key) - (x->key < y->key) : (x->row > y->row) - (x->row < y->row);
}

/* The feature that varies most, as costs count it. */
static uint32_t widest(const match_table *t, const uint16_t *rows, uint32_t count)
{
    uint32_t best = 0;
    int64_t most = -1;
    for (uint32_t k = 0; k < FEATURES; k++) {
        int64_t sum = 0, squares = 0;
        for (uint32_t i = 0; i < count; i++) {
            const int v = t->numbers[rows[i]][k];
            sum += v;
            squares += v * v;
        }
        const int64_t spread = (squares * count - sum * sum) * (k < NOH_MATCH_COARSE ? 1 : 4);
        if (spread > most) {
            most = spread;
            best = k;
        }
    }
    return best;
}

/* Sort along the widest feature, cut in the middle, where boxes end, and go on with both halves. */
static void sort_rows(const match_table *t, uint16_t *rows, uint32_t count, keyed_row *keyed)
{
    const uint32_t unit = count > 512u ? 512u : count > 64u ? 64u : 16u;
    if (count <= 16u) return;
    const uint32_t k = widest(t, rows, count), half = (count / 2u + unit - 1u) / unit * unit;
    for (uint32_t i = 0; i < count; i++) {
        keyed[i].key = t->numbers[rows[i]][k];
        keyed[i].row = rows[i];
    }
    qsort(keyed, count, sizeof *keyed, by_key);
    for (uint32_t i = 0; i < count; i++) rows[i] = keyed[i].row;
    sort_rows(t, rows, half, keyed);
    sort_rows(t, rows + half, count - half, keyed);
}

static int make_order(match_table *t)
{
    keyed_row *keyed = calloc(t->row_count, sizeof *keyed);
    for (uint32_t r = 0; r < t->row_count; r++) t->order[r] = (uint16_t)r;
    if (keyed) sort_rows(t, t->order, t->row_count, keyed);
    free(keyed);
    return !keyed;
}

/* ---- the chunk ---- */

static size_t place_of(uint32_t index, uint32_t feature)
{
    return (size_t)(feature / 2u) * 16u + index % 8u * 2u + feature % 2u;
}

static void append_rows(const match_table *t, byte_buffer *out)
{
    for (uint32_t first = 0; first < t->row_count; first += 8u) {
        int8_t group[NOH_MATCH_GROUP_BYTES];
        for (uint32_t i = first; i < first + 8u; i++) {
            const uint32_t row = t->order[i < t->row_count ? i : t->row_count - 1u];
            for (uint32_t k = 0; k < NOH_MATCH_FEATURES; k++) group[place_of(i, k)] = t->numbers[row][k];
        }
        buffer_append(out, group, sizeof group);
    }
}

static void append_boxes(const match_table *t, uint32_t size, byte_buffer *out)
{
    const uint32_t count = (t->row_count + size - 1u) / size;
    for (uint32_t first = 0; first < count; first += 8u) {
        int8_t group[2][NOH_MATCH_GROUP_BYTES];
        memset(group[0], 127, sizeof group[0]);
        memset(group[1], -127, sizeof group[1]);
        for (uint32_t b = first; b < first + 8u && b < count; b++) {
            for (uint32_t i = b * size; i < (b + 1u) * size && i < t->row_count; i++) {
                for (uint32_t k = 0; k < NOH_MATCH_FEATURES; k++) {
                    const int8_t v = t->numbers[t->order[i]][k];
                    int8_t *low = &group[0][place_of(b, k)], *high = &group[1][place_of(b, k)];
                    *low = v < *low ? v : *low;
                    *high = v > *high ? v : *high;
                }
            }
        }
        buffer_append(out, group, sizeof group);
    }
}

static uint32_t next_array(byte_buffer *out, size_t base)
{
    buffer_align(out, 16);
    return (uint32_t)(out->count - base);
}

static void append_names(pack_writer *w, const match_table *t, size_t base, noh_pack_match_header *h)
{
    h->clips_offset = next_array(&w->out, base);
    for (uint32_t c = 0; c < t->clip_count; c++) {
        noh_pack_match_clip clip = t->clips[c];
        chunk_name(w, t->raws[c]->name, &clip.name, &clip.name_hash);
        buffer_append(&w->out, &clip, sizeof clip);
    }
    h->tags_offset = next_array(&w->out, base);
    for (uint32_t i = 0; i < t->tag_count; i++) {
        noh_pack_match_tag tag;
        chunk_name(w, t->tags[i], &tag.name, &tag.name_hash);
        buffer_append(&w->out, &tag, sizeof tag);
    }
}

static void write_match(pack_writer *w, const void *made)
{
    static const uint32_t boxes[NOH_MATCH_LEVELS] = { 16, 64, 512 };
    const match_table *t = made;
    noh_pack_match_header h;
    if (!t) return;
    memset(&h, 0, sizeof h);
    h.root_axes = NOH_ROOT_GROUND;
    h.root_up = 1;
    h.row_count = t->row_count;
    h.row_ticks = row_ticks(t);
    h.clip_count = t->clip_count;
    h.tag_count = t->tag_count;
    chunk_begin(w, NOH_CHUNK_MATCH, "");
    const size_t base = w->out.count;
    buffer_append(&w->out, NULL, sizeof h);
    append_names(w, t, base, &h);
    h.numbers_offset = next_array(&w->out, base);
    buffer_append(&w->out, t->means, sizeof t->means);
    buffer_append(&w->out, t->scales, sizeof t->scales);
    h.order_offset = next_array(&w->out, base);
    buffer_append(&w->out, t->order, t->row_count * sizeof *t->order);
    h.rows_offset = next_array(&w->out, base);
    append_rows(t, &w->out);
    for (uint32_t i = 0; i < NOH_MATCH_LEVELS; i++) {
        h.boxes_offset[i] = next_array(&w->out, base);
        append_boxes(t, boxes[i], &w->out);
    }
    if (!w->out.failed) memcpy(w->out.bytes + base, &h, sizeof h);
    chunk_end(w);
}

/* ---- the maker ---- */

static void report(FILE *out, FILE *warnings, const match_table *t)
{
    const double seconds = t->row_count * (double)row_ticks(t) / NOH_TICKS_PER_SECOND;
    double moves = 0.0;
    for (uint32_t r = 0; r < t->row_count; r++) {
        moves = fmax(moves, hypot(t->features[r][19], t->features[r][20]));
    }
    if (out) {
        fprintf(out, "motion matching: %u rows of %u clips (%.1f s), %u tags\n", t->row_count, t->clip_count, seconds,
                t->tag_count);
    }
    if (warnings && moves < 1e-3) {
        fprintf(warnings, "warning: no clip for motion matching moves its root: the actor will stay where it is\n");
    }
}

static int read_match(const convert_options *options, const source *s, void **made, convert_failure *failure)
{
    match_table *t;
    int failed;
    if (!options->texts[NOH_CHUNK_MATCH] || options->only == CONVERT_MESH) return 0;
    failure->file = options->texts[NOH_CHUNK_MATCH];
    *made = t = calloc(1, sizeof *t);
    if (!t) return model_fail_memory(&failure->error);
    t->rate = ROWS_A_SECOND;
    failed = read_text(failure->file, t, &failure->line, &failure->error);
    if (!failed) failure->line = 0;
    failed = failed || find_clips(s, t, &failure->line, &failure->error) ||
             find_rows(t, options->clip.check_loops, &failure->error);
    if (!failed && (make_numbers(t) || make_order(t))) failed = model_fail_memory(&failure->error);
    if (!failed) report(options->report, convert_warnings(options), t);
    return failed;
}

static void free_match(void *made)
{
    match_table *t = made;
    if (!t) return;
    for (uint32_t i = 0; i < t->line_count; i++) free(t->lines[i].clips);
    for (uint32_t i = 0; i < t->tag_count; i++) free(t->tags[i]);
    free(t->lines);
    free(t->feet[0]);
    free(t->feet[1]);
    free(t->clips);
    free(t->raws);
    free(t->features);
    free(t->numbers);
    free(t->order);
    free(t);
}

const chunk_maker chunk_match = { read_match, 1, free_match, write_match, NULL };
