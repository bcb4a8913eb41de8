#include "recipe_read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/base/text_scan.h"
#include "noh/base.h"
#include "noh/face.h"
#include "noh/format.h"

#define CHANNEL_ANY "blink-left, eye-right-up, lids-down, joy-upper, joy-mouth, PP, aa and so on (noh help FORMATS)"

const char *const recipe_joint_channels[5] = { "joint-head", "joint-neck", "joint-chest", "joint-eye-left",
                                               "joint-eye-right" };

/* The channels of a word: one, or the two of `blink`. */
static uint32_t find_channels(text_word word, uint32_t channels[2])
{
    uint32_t count = 0;
    for (uint32_t c = 0; c < NOH_CHANNEL_COUNT; c++) {
        const int both = text_is(word, "blink") && c <= NOH_CHANNEL_BLINK_RIGHT;
        if (both || text_is(word, noh_face_channel_name(c))) channels[count++] = c;
    }
    return count;
}

/* A channel whose row names a joint in place of a target; NULL: none. */
static const char *find_joint_channel(text_word word)
{
    for (size_t i = 0; i < sizeof recipe_joint_channels / sizeof recipe_joint_channels[0]; i++) {
        if (text_is(word, recipe_joint_channels[i])) return recipe_joint_channels[i];
    }
    return NULL;
}

static char *copy_of(const char *text)
{
    char *copy = malloc(strlen(text) + 1u);
    return copy ? strcpy(copy, text) : NULL;
}

int recipe_add_row(recipe_text *recipe, const char *target, const char *channel, float weight, uint32_t line)
{
    recipe_row *rows, *row;
    if (recipe->count == NOH_FACE_ROWS_MAX) return recipe->is_full = 1;
    rows = realloc(recipe->rows, (recipe->count + 1u) * sizeof *rows);
    if (!rows) return 1;
    recipe->rows = rows;
    row = &rows[recipe->count++];
    row->target = copy_of(target);
    row->channel = copy_of(channel);
    row->weight = weight;
    row->line = line;
    return !row->target || !row->channel;
}

int recipe_add_wrinkle(recipe_text *recipe, const char *target, uint32_t region, float weight, uint32_t line)
{
    wrinkle_row *rows;
    char *name;
    if (recipe->wrinkle_count == NOH_FACE_ROWS_MAX) return recipe->is_full = 1;
    rows = realloc(recipe->wrinkles, (recipe->wrinkle_count + 1u) * sizeof *rows);
    if (!rows) return 1;
    recipe->wrinkles = rows;
    name = copy_of(target);
    if (!name) return 1;
    rows[recipe->wrinkle_count++] = (wrinkle_row){ name, region, line, weight };
    return 0;
}

int recipe_fail(const recipe_text *recipe, model_error *error)
{
    if (!recipe || !recipe->is_full) return model_fail_memory(error);
    return model_fail(error, "",
                      "the face's recipe has more than %u rows, with those that names of targets and extras add: use "
                      "--no-correctives, or fewer targets whose names join others (a_b) or end in hundredths (a50)",
                      NOH_FACE_ROWS_MAX);
}

static int add_row(text_scan *s, recipe_text *recipe, uint32_t line, const char *channel, text_word word, float weight)
{
    char target[NOH_NAME_BYTES_MAX];
    memcpy(target, word.text, word.size);
    target[word.size] = '\0';
    for (uint32_t i = 0; i < recipe->count; i++) {
        const recipe_row *other = &recipe->rows[i];
        if (strcmp(other->channel, channel) == 0 && strcmp(other->target, target) == 0) {
            return text_fail(s, line, "%s has this target twice; the first is in line %u", channel, other->line);
        }
    }
    if (recipe->count == NOH_FACE_ROWS_MAX) {
        return text_fail(s, line, "too many rows: the limit is %u", NOH_FACE_ROWS_MAX);
    }
    return recipe_add_row(recipe, target, channel, weight, line) ? text_fail(s, line, "out of memory") : 0;
}

static int check_target(text_scan *s, text_word target)
{
    return target.size < NOH_NAME_BYTES_MAX - 1u
               ? 0
               : text_fail(s, target.line, "the target's name is longer than %u bytes", NOH_NAME_BYTES_MAX - 2u);
}

static int read_weight(text_scan *s, float *weight)
{
    text_word word;
    double value = 1.0;
    char shown[TEXT_SHOWN];
    if (text_take_on_line(s, &word)) return 1;
    if (word.size && text_number(s, word, &value)) return 1;
    if (!(value >= -4.0 && value <= 4.0) || value == 0.0) {
        return text_fail(s, word.line, "the weight %s must be -4 to 4, and not 0", text_show(word, shown));
    }
    *weight = (float)value;
    if (word.size && text_take_on_line(s, &word)) return 1;
    return word.size ? text_fail(s, word.line, "'%s' is one word too many: a row is CHANNEL TARGET [WEIGHT]",
                                 text_show(word, shown))
                     : 0;
}

/* ---- correctives ---- */

/* A driver's peak, if the next word is a number: it is taken then, and *next is the word behind it. */
static int read_peak(text_scan *s, text_word *next, float *peak)
{
    double value;
    char shown[TEXT_SHOWN];
    *peak = 1.0f;
    if (text_take_on_line(s, next)) return 1;
    if (!next->size || !((next->text[0] >= '0' && next->text[0] <= '9') || next->text[0] == '.')) return 0;
    if (text_number(s, *next, &value)) return 1;
    if (!(value > 0.0 && value <= 1.0)) {
        return text_fail(s, next->line, "the peak %s must be above 0 and at most 1", text_show(*next, shown));
    }
    *peak = (float)value;
    return text_take_on_line(s, next);
}

/* Behind the word `corrective`. */
static int read_corrective(text_scan *s, recipe_text *recipe)
{
    const uint32_t first = recipe->count, line = s->line;
    text_word target, driver, next;
    char channel[NOH_NAME_BYTES_MAX] = "+";
    float peak;
    if (text_take_on_line(s, &target) || text_take_on_line(s, &driver)) return 1;
    if (!target.size || !driver.size) {
        return text_fail(s, line, "write `corrective TARGET DRIVER [PEAK] [DRIVER [PEAK]] ...`");
    }
    if (check_target(s, target)) return 1;
    for (uint32_t i = 0; i < first; i++) {
        if (recipe->rows[i].channel[0] == '+' && strlen(recipe->rows[i].target) == target.size &&
            memcmp(recipe->rows[i].target, target.text, target.size) == 0)
            return text_fail(s, line, "this corrective is given twice; the first is in line %u", recipe->rows[i].line);
    }
    for (; driver.size; driver = next) {
        if (recipe->count - first == NOH_CORRECTIVE_DRIVERS_MAX) {
            return text_fail(s, line, "a corrective has more than %u drivers", NOH_CORRECTIVE_DRIVERS_MAX);
        }
        if (driver.size == target.size && memcmp(driver.text, target.text, target.size) == 0) {
            return text_fail(s, line, "a corrective cannot drive itself");
        }
        if (check_target(s, driver) || read_peak(s, &next, &peak)) return 1;
        memcpy(channel + 1, driver.text, driver.size);
        channel[1 + driver.size] = '\0';
        if (add_row(s, recipe, line, channel, target, peak)) return 1;
    }
    return 0;
}

/* ---- rules ---- */

static int take_target(text_scan *s, uint32_t line, const char *form, text_word *target)
{
    if (text_take_on_line(s, target)) return 1;
    return target->size ? check_target(s, *target) : text_fail(s, line, "write the rule as `%s`", form);
}

static int end_rule(text_scan *s, const char *form)
{
    text_word word;
    char shown[TEXT_SHOWN];
    if (text_take_on_line(s, &word)) return 1;
    return word.size ? text_fail(s, word.line, "'%s' is one word too many: write the rule as `%s`",
                                 text_show(word, shown), form)
                     : 0;
}

/* Behind the word `range`. */
static int read_range(text_scan *s, recipe_text *recipe)
{
    static const char form[] = "range TARGET MIN MAX";
    const uint32_t line = s->line;
    text_word target, low, high;
    double from, to;
    if (take_target(s, line, form, &target) || text_take_on_line(s, &low) || text_take_on_line(s, &high)) return 1;
    if (!low.size || !high.size) return text_fail(s, line, "write the rule as `%s`", form);
    if (text_number(s, low, &from) || text_number(s, high, &to)) return 1;
    if (!(from >= -4.0 && from <= 0.0 && to >= 0.0 && to <= 4.0)) {
        return text_fail(s, line, "a range needs MIN from -4 to 0 and MAX from 0 to 4");
    }
    return end_rule(s, form) || add_row(s, recipe, line, "range-min", target, (float)from) ||
           add_row(s, recipe, line, "range-max", target, (float)to);
}

static void name_channel(char channel[NOH_NAME_BYTES_MAX], char sign, text_word name)
{
    channel[0] = sign;
    memcpy(channel + 1, name.text, name.size);
    channel[1 + name.size] = '\0';
}

/* Behind the word `oppose`. */
static int read_opposites(text_scan *s, recipe_text *recipe)
{
    static const char form[] = "oppose TARGET TARGET";
    const uint32_t line = s->line;
    char channel[NOH_NAME_BYTES_MAX];
    text_word a, b;
    if (take_target(s, line, form, &a) || take_target(s, line, form, &b) || end_rule(s, form)) return 1;
    if (a.size == b.size && memcmp(a.text, b.text, a.size) == 0) {
        return text_fail(s, line, "a target cannot exclude itself");
    }
    name_channel(channel, '-', b);
    return add_row(s, recipe, line, channel, a, 1.0f);
}

/* Behind the word `share`. */
static int read_shares(text_scan *s, recipe_text *recipe)
{
    static const char form[] = "share TARGET TARGET ...";
    const uint32_t line = s->line;
    char channel[NOH_NAME_BYTES_MAX];
    text_word target, next;
    if (take_target(s, line, form, &target) || take_target(s, line, form, &next)) return 1;
    name_channel(channel, '=', target);
    for (uint32_t i = 0; i < recipe->count; i++) {
        if (strcmp(recipe->rows[i].channel, channel) == 0)
            return text_fail(s, line, "a group with this first target is already in line %u", recipe->rows[i].line);
    }
    if (add_row(s, recipe, line, channel, target, 1.0f)) return 1;
    for (; next.size;) {
        if (check_target(s, next) || add_row(s, recipe, line, channel, next, 1.0f) || text_take_on_line(s, &next))
            return 1;
    }
    return 0;
}

/* Behind the word `expression`. */
static int read_expression(text_scan *s, recipe_text *recipe)
{
    static const char form[] = "expression NAME TARGET [WEIGHT]";
    const uint32_t line = s->line;
    char channel[NOH_NAME_BYTES_MAX];
    text_word name, target;
    float weight = 1.0f;
    if (take_target(s, line, form, &name) || take_target(s, line, form, &target) || read_weight(s, &weight)) return 1;
    name_channel(channel, ':', name);
    return add_row(s, recipe, line, channel, target, weight);
}

/* Whether a word names the upper channel of an emotion, or an expression above. */
static int has_rules(const recipe_text *recipe, text_word word)
{
    uint32_t channels[2] = { 0, 0 };
    if (find_channels(word, channels) == 1 && channels[0] - NOH_CHANNEL_UPPER < NOH_EMOTION_COUNT) return 1;
    for (uint32_t i = 0; i < recipe->count; i++) {
        if (recipe->rows[i].channel[0] == ':' && text_is(word, recipe->rows[i].channel + 1)) return 1;
    }
    return 0;
}

/* Behind the word `override`. */
static int read_override(text_scan *s, recipe_text *recipe)
{
    static const char form[] = "override EMOTION-upper lids|eyes|speech block|blend";
    static const char *const users[] = { "lids", "eyes", "speech" };
    const uint32_t line = s->line;
    text_word emotion, user, how;
    char channel[NOH_NAME_BYTES_MAX] = "";
    if (take_target(s, line, form, &emotion) || text_take_on_line(s, &user) || text_take_on_line(s, &how)) return 1;
    for (int i = 0; i < 3; i++) {
        if (text_is(user, users[i])) (void)snprintf(channel, sizeof channel, "override-%s", users[i]);
    }
    if (!has_rules(recipe, emotion) || !channel[0] || !(text_is(how, "block") || text_is(how, "blend"))) {
        return text_fail(s, line, "write the rule as `%s`, such as `override joy-upper lids block`", form);
    }
    return end_rule(s, form) || add_row(s, recipe, line, channel, emotion,
                                        (float)(text_is(how, "block") ? NOH_OVERRIDE_BLOCK : NOH_OVERRIDE_BLEND));
}

/* Behind the word `binary`. */
static int read_binary(text_scan *s, recipe_text *recipe)
{
    static const char form[] = "binary EMOTION-upper";
    const uint32_t line = s->line;
    text_word emotion;
    if (take_target(s, line, form, &emotion)) return 1;
    if (!has_rules(recipe, emotion)) {
        return text_fail(s, line, "write the rule as `%s`, such as `binary joy-upper`", form);
    }
    return end_rule(s, form) || add_row(s, recipe, line, "binary", emotion, 1.0f);
}

/* Behind the word `phone`: the mouth shapes of a phone of a language, in place of the usual ones. */
static int read_phone(text_scan *s, recipe_text *recipe)
{
    static const char form[] = "phone PHONE SHAPE [SHAPE]";
    const uint32_t line = s->line;
    char channel[NOH_NAME_BYTES_MAX] = "phone";
    text_word phone, shape;
    uint32_t count = 0;
    if (take_target(s, line, form, &phone)) return 1;
    for (; count < 3u; count++) {
        uint32_t channels[2] = { 0, 0 };
        if (text_take_on_line(s, &shape)) return 1;
        if (!shape.size) break;
        if (count == 2u || find_channels(shape, channels) != 1 || channels[0] < NOH_CHANNEL_VISEMES) count = 3u;
        if (count == 3u) break;
        (void)snprintf(channel + strlen(channel), sizeof channel - strlen(channel), "-%s",
                       noh_face_channel_name(channels[0]));
    }
    if (count != 1u && count != 2u) {
        return text_fail(s, line,
                         "write the phone as `%s`, such as `phone ai aa ih`: shapes are sil, PP, FF, TH, DD, kk, CH, "
                         "SS, nn, RR, aa, E, ih, oh and ou",
                         form);
    }
    for (uint32_t i = 0; i < recipe->count; i++) {
        if (strncmp(recipe->rows[i].channel, "phone-", 6) == 0 && text_is(phone, recipe->rows[i].target)) {
            return text_fail(s, line, "the phone is already in line %u", recipe->rows[i].line);
        }
    }
    return add_row(s, recipe, line, channel, phone, 1.0f);
}

/* ---- wrinkles ---- */

static int add_wrinkle(text_scan *s, recipe_text *recipe, uint32_t line, text_word word, uint32_t region, float weight)
{
    char target[NOH_NAME_BYTES_MAX];
    memcpy(target, word.text, word.size);
    target[word.size] = '\0';
    for (uint32_t i = 0; i < recipe->wrinkle_count; i++) {
        const wrinkle_row *other = &recipe->wrinkles[i];
        if (other->region == region && strcmp(other->target, target) == 0) {
            return text_fail(s, line, "%s has the region twice; the first is in line %u", target, other->line);
        }
    }
    if (recipe->wrinkle_count == NOH_FACE_ROWS_MAX) {
        return text_fail(s, line, "too many rows of wrinkles: the limit is %u", NOH_FACE_ROWS_MAX);
    }
    return recipe_add_wrinkle(recipe, target, region, weight, line) ? text_fail(s, line, "out of memory") : 0;
}

static int take_region(text_scan *s, uint32_t line, text_word word, uint32_t *region)
{
    double number;
    char shown[TEXT_SHOWN];
    if (text_number(s, word, &number)) return 1;
    if (!(number >= 0.0 && number < NOH_WRINKLE_FOLDS) || number != (double)(uint32_t)number) {
        return text_fail(s, line, "'%s' is not a region: regions are 0 to %u, numbered as by noh mask",
                         text_show(word, shown), NOH_WRINKLE_FOLDS - 1u);
    }
    *region = (uint32_t)number;
    return 0;
}

/* A channel of the colour map. */
static int take_channel(text_scan *s, uint32_t line, text_word word, uint32_t *channel)
{
    static const char names[NOH_WRINKLE_COLORS] = { 'r', 'g', 'b', 'a' };
    char shown[TEXT_SHOWN];
    for (uint32_t c = 0; c < NOH_WRINKLE_COLORS; c++) {
        *channel = c;
        if (word.size == 1 && word.text[0] == names[c]) return 0;
    }
    return text_fail(s, line, "'%s' is not a channel of the colour map: channels are r, g, b and a",
                     text_show(word, shown));
}

/* Behind the word `wrinkle` or `color`. */
static int read_wrinkle(text_scan *s, recipe_text *recipe, int is_color)
{
    const char *form = is_color ? "color TARGET CHANNEL [WEIGHT]" : "wrinkle TARGET REGION [WEIGHT]";
    const uint32_t line = s->line;
    text_word target, word;
    uint32_t region;
    double weight = 1.0;
    char shown[TEXT_SHOWN];
    if (take_target(s, line, form, &target) || text_take_on_line(s, &word)) return 1;
    if (!word.size) return text_fail(s, line, "the region is missing: the row is `%s`", form);
    if (is_color ? take_channel(s, line, word, &region) : take_region(s, line, word, &region)) return 1;
    if (text_take_on_line(s, &word)) return 1;
    if (word.size) {
        if (text_number(s, word, &weight)) return 1;
        if (!(weight >= 0.0 && weight <= 1.0)) {
            return text_fail(s, line, "the weight %s must be 0 to 1", text_show(word, shown));
        }
        if (end_rule(s, form)) return 1;
    }
    return add_wrinkle(s, recipe, line, target, region + (is_color ? NOH_WRINKLE_FOLDS : 0u), (float)weight);
}

/* Behind the word `tint`. */
static int read_tint(text_scan *s, recipe_text *recipe)
{
    static const char form[] = "tint CHANNEL RRGGBB", digits[] = "0123456789abcdef";
    const uint32_t line = s->line;
    text_word channel, word;
    uint32_t region, value = 1;
    char shown[TEXT_SHOWN];
    if (text_take_on_line(s, &channel) || text_take_on_line(s, &word)) return 1;
    if (!word.size) return text_fail(s, line, "write the colour of a region as `%s`, such as `tint r c03030`", form);
    if (take_channel(s, line, channel, &region)) return 1;
    for (size_t i = 0; i < word.size && value; i++) {
        const int c = word.text[i] | (word.text[i] >= 'A' ? 32 : 0);
        const char *digit = c ? strchr(digits, c) : NULL;
        value = digit && value < 1u << 24 ? value << 4 | (uint32_t)(digit - digits) : 0;
    }
    if (value >> 24 != 1u) {
        return text_fail(s, line, "'%s' is not a colour: six hexadecimal digits, RRGGBB, as in `tint r c03030`",
                         text_show(word, shown));
    }
    if (recipe->tints[region]) {
        return text_fail(s, line, "the channel %s has a colour already", text_show(channel, shown));
    }
    recipe->tints[region] = value;
    return end_rule(s, form);
}

/* ---- lines ---- */

static int read_line(text_scan *s, recipe_text *recipe)
{
    text_word channel, target;
    uint32_t channels[2], count;
    const char *joint;
    float weight = 1.0f;
    char shown[TEXT_SHOWN];
    if (text_take_on_line(s, &channel)) return 1;
    if (!channel.size) return 0; /* a comment */
    if (text_is(channel, "corrective")) return read_corrective(s, recipe);
    if (text_is(channel, "range")) return read_range(s, recipe);
    if (text_is(channel, "oppose")) return read_opposites(s, recipe);
    if (text_is(channel, "share")) return read_shares(s, recipe);
    if (text_is(channel, "expression")) return read_expression(s, recipe);
    if (text_is(channel, "override")) return read_override(s, recipe);
    if (text_is(channel, "binary")) return read_binary(s, recipe);
    if (text_is(channel, "phone")) return read_phone(s, recipe);
    if (text_is(channel, "wrinkle")) return read_wrinkle(s, recipe, 0);
    if (text_is(channel, "color")) return read_wrinkle(s, recipe, 1);
    if (text_is(channel, "tint")) return read_tint(s, recipe);
    count = find_channels(channel, channels);
    joint = find_joint_channel(channel);
    if (!count && !joint) {
        return text_fail(s, channel.line, "'%s' is not a channel: channels are " CHANNEL_ANY,
                         text_show(channel, shown));
    }
    if (text_take_on_line(s, &target)) return 1;
    if (!target.size) {
        return text_fail(s, channel.line, "the target is missing: a row is CHANNEL TARGET [WEIGHT]");
    }
    if (check_target(s, target)) return 1;
    if (joint) return end_rule(s, "joint-head JOINT") || add_row(s, recipe, channel.line, joint, target, weight);
    if (read_weight(s, &weight)) return 1;
    for (uint32_t i = 0; i < count; i++) {
        if (add_row(s, recipe, channel.line, noh_face_channel_name(channels[i]), target, weight)) return 1;
    }
    return 0;
}

recipe_text *recipe_new(void)
{
    return calloc(1, sizeof(recipe_text));
}

int recipe_add_text(recipe_text *recipe, const char *text, size_t size, uint32_t *line, model_error *error)
{
    text_scan s;
    text_start(&s, text, size, error);
    while (text_next_line(&s)) {
        *line = s.line;
        if (read_line(&s, recipe)) return 1;
    }
    return 0;
}

int recipe_read(const char *path, recipe_text **out, uint32_t *line, model_error *error)
{
    size_t size = 0;
    char *text = input_read_text(path, &size, error);
    int failed;
    *out = text ? recipe_new() : NULL;
    if (!*out) {
        free(text);
        return 1;
    }
    failed = recipe_add_text(*out, text, size, line, error);
    if (!failed && !(*out)->count && !(*out)->wrinkle_count) {
        text_scan s;
        *line = 1;
        text_start(&s, text, size, error);
        failed = text_fail(&s, 1, "the recipe is empty: add a row CHANNEL TARGET [WEIGHT]");
    }
    if (failed) error->where[0] = 0; /* *line has the line */
    free(text);
    return failed;
}

void recipe_free(recipe_text *recipe)
{
    for (uint32_t i = 0; recipe && i < recipe->count; i++) {
        free(recipe->rows[i].target);
        free(recipe->rows[i].channel);
    }
    for (uint32_t i = 0; recipe && i < recipe->wrinkle_count; i++) {
        free(recipe->wrinkles[i].target);
    }
    if (recipe) free(recipe->rows);
    if (recipe) free(recipe->wrinkles);
    free(recipe);
}
