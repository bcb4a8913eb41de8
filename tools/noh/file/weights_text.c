#include "weights_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* Between items: blanks, lines, commas, braces, comments, the option that a shell takes. */
static void skip(weights_reader *r)
{
    for (;;) {
        if (*r->at == '\n') {
            r->line++;
            r->at++;
        } else if (is_blank(*r->at) || (*r->at && strchr(",;{}\\", *r->at))) {
            r->at++;
        } else if (*r->at == '#') {
            r->at += strcspn(r->at, "\n");
        } else if (strncmp(r->at, "--weight", 8) == 0 && (is_blank(r->at[8]) || r->at[8] == '=')) {
            r->at += 9;
        } else {
            return;
        }
    }
}

/* Up to `end`, without blanks before it and quotes around it. */
static void take_name(weights_item *item, const char *from, const char *end)
{
    size_t length;
    while (from < end && (is_blank(*from) || *from == '"' || *from == '\'')) from++;
    while (end > from && (is_blank(end[-1]) || end[-1] == '"' || end[-1] == '\'')) end--;
    length = (size_t)(end - from);
    length = length < sizeof item->name ? length : sizeof item->name - 1u;
    memcpy(item->name, from, length);
    item->name[length] = 0;
}

static weights_kind take_preset(weights_reader *r, weights_item *item)
{
    const char *end = r->at + strcspn(r->at, "]\n");
    take_name(item, r->at + 1, end);
    r->at = *end == ']' ? end + 1 : end;
    return *end == ']' && item->name[0] ? WEIGHTS_PRESET : WEIGHTS_BAD;
}

weights_kind weights_next(weights_reader *r, weights_item *item)
{
    const char *sign, *line_end;
    char *end;
    if (!r->line) r->line = 1;
    skip(r);
    item->line = r->line;
    item->value = 0.0;
    item->name[0] = 0;
    if (!*r->at) return WEIGHTS_END;
    if (*r->at == '[') return take_preset(r, item);
    line_end = r->at + strcspn(r->at, "\n");
    sign = r->at + strcspn(r->at, "=:\n");
    if (sign == line_end) {
        take_name(item, r->at, line_end);
        r->at = line_end;
        return WEIGHTS_BAD;
    }
    take_name(item, r->at, sign);
    for (sign++; is_blank(*sign) || *sign == '"' || *sign == '\''; sign++) {}
    item->value = *sign == '\n' ? 0.0 : strtod(sign, &end);
    if (*sign == '\n' || end == sign || !isfinite(item->value) || !item->name[0]) {
        r->at = line_end;
        return WEIGHTS_BAD;
    }
    r->at = end + (*end == '"' || *end == '\'');
    return WEIGHTS_VALUE;
}

size_t weights_line(char *text, size_t bytes, const char *name, float value)
{
    char number[32];
    int length;
    for (int digits = 1; digits <= 9; digits++) {
        snprintf(number, sizeof number, "%.*g", digits, (double)value);
        if (strtof(number, NULL) == value) break;
    }
    length = snprintf(NULL, 0, "%s = %s\n", name, number);
    if (length < 0 || (size_t)length >= bytes) return 0;
    snprintf(text, bytes, "%s = %s\n", name, number);
    return (size_t)length;
}
