#include "recipe_read.h"

#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/base/text_scan.h"
#include "face/recipe.h"

#define CHANNEL_ANY "blink-left, eye-right-up, lids-down, joy-upper, joy-mouth, PP, aa and so on (noh help FORMATS)"

/* The next word of the line, or what is between quotes; of size 0 at the line's end and at a comment. */
static int take_word(text_scan *s, text_word *out)
{
    const char *close;
    *out = text_next_on_line(s);
    if (out->size > 0 && out->text[0] == '#') {
        s->at = out->text;
        (void)text_rest_of_line(s);
        out->size = 0;
    }
    if (out->size == 0 || out->text[0] != '"') return 0;
    close = out->text + 1;
    while (close < s->end && *close != '"' && *close != '\n') ++close;
    if (close == s->end || *close != '"') return text_fail(s, out->line, "a quote is not closed");
    out->text++;
    out->size = (size_t)(close - out->text);
    s->at = close + 1;
    return out->size > 0 ? 0 : text_fail(s, out->line, "a name is empty");
}

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

static int add_row(text_scan *s, recipe_text *recipe, const recipe_row *row, text_word target)
{
    recipe_row *rows;
    for (uint32_t i = 0; i < recipe->count; i++) {
        const recipe_row *other = &recipe->rows[i];
        if (strcmp(other->channel, row->channel) == 0 && strlen(other->target) == target.size &&
            memcmp(other->target, target.text, target.size) == 0) {
            return text_fail(s, row->line, "%s has this target already, in line %u", row->channel, other->line);
        }
    }
    if (recipe->count == NOH_FACE_ROWS_MAX) {
        return text_fail(s, row->line, "there are more than %u rows, which is the limit", NOH_FACE_ROWS_MAX);
    }
    rows = realloc(recipe->rows, (recipe->count + 1u) * sizeof *rows);
    if (!rows) return text_fail(s, row->line, "out of memory");
    recipe->rows = rows;
    rows[recipe->count] = *row;
    rows[recipe->count].target = text_copy(target);
    return rows[recipe->count++].target ? 0 : text_fail(s, row->line, "out of memory");
}

static int read_weight(text_scan *s, float *weight)
{
    text_word word;
    double value = 1.0;
    char shown[TEXT_SHOWN];
    if (take_word(s, &word)) return 1;
    if (word.size && text_number(s, word, &value)) return 1;
    if (!(value >= -4.0 && value <= 4.0) || value == 0.0) {
        return text_fail(s, word.line, "the weight %s is not within -4 to 4, or is 0", text_show(word, shown));
    }
    *weight = (float)value;
    if (word.size && take_word(s, &word)) return 1;
    return word.size ? text_fail(s, word.line, "'%s' is one word too many: a row is CHANNEL TARGET [WEIGHT]",
                                 text_show(word, shown))
                     : 0;
}

static int read_line(text_scan *s, recipe_text *recipe)
{
    text_word channel, target;
    uint32_t channels[2], count;
    recipe_row row = { NULL, NULL, 1.0f, 0 };
    char shown[TEXT_SHOWN];
    if (take_word(s, &channel)) return 1;
    if (!channel.size) return 0; /* a comment */
    count = find_channels(channel, channels);
    if (!count) {
        return text_fail(s, channel.line, "'%s' is no channel: they are " CHANNEL_ANY, text_show(channel, shown));
    }
    if (take_word(s, &target)) return 1;
    if (!target.size) {
        return text_fail(s, channel.line, "the target is missing: a row is CHANNEL TARGET [WEIGHT]");
    }
    if (target.size >= NOH_NAME_BYTES_MAX) {
        return text_fail(s, target.line, "the target's name is longer than %u bytes", NOH_NAME_BYTES_MAX - 1u);
    }
    row.line = channel.line;
    if (read_weight(s, &row.weight)) return 1;
    for (uint32_t i = 0; i < count; i++) {
        row.channel = noh_face_channel_name(channels[i]);
        if (add_row(s, recipe, &row, target)) return 1;
    }
    return 0;
}

int recipe_read(const char *path, recipe_text **out, uint32_t *line, model_error *error)
{
    size_t size = 0;
    text_scan s;
    char *text = input_read(path, &size, error);
    int failed = 0;
    *out = text ? calloc(1, sizeof **out) : NULL;
    if (!*out) {
        free(text);
        return 1;
    }
    text_start(&s, text, size, error);
    while (!failed && text_next_line(&s)) {
        *line = s.line;
        failed = read_line(&s, *out);
    }
    if (!failed && !(*out)->count) {
        *line = 1;
        failed = text_fail(&s, 1, "the recipe has no row: CHANNEL TARGET [WEIGHT]");
    }
    if (failed) error->where[0] = 0; /* *line says it */
    free(text);
    return failed;
}

void recipe_free(recipe_text *recipe)
{
    for (uint32_t i = 0; recipe && i < recipe->count; i++) free(recipe->rows[i].target);
    if (recipe) free(recipe->rows);
    free(recipe);
}
