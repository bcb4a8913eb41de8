#include "json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "message.h"

static int printed;

static void put(json *j, const char *text, size_t count)
{
    if (j->count + count > j->room) {
        size_t room = 2 * (j->count + count) + 4096;
        char *grown = j->failed ? NULL : realloc(j->text, room);
        if (!grown) {
            j->failed = 1;
            return;
        }
        j->text = grown;
        j->room = room;
    }
    memcpy(j->text + j->count, text, count);
    j->count += count;
}

static void put_text(json *j, const char *text)
{
    put(j, text, strlen(text));
}

/* The bytes of the UTF-8 sequence at c; 0: it is invalid. JSON is UTF-8, but names are read from files and may hold
 * any bytes. Ranges: RFC 3629, section 4. */
static size_t utf8_length(const unsigned char *c)
{
    const unsigned char low = c[0] == 0xe0 ? 0xa0 : c[0] == 0xf0 ? 0x90 : 0x80;
    const unsigned char high = c[0] == 0xed ? 0x9f : c[0] == 0xf4 ? 0x8f : 0xbf;
    const size_t count = c[0] < 0x80 ? 1 : c[0] < 0xc2 ? 0 : c[0] < 0xe0 ? 2 : c[0] < 0xf0 ? 3 : c[0] < 0xf5 ? 4 : 0;
    if (count > 1 && (c[1] < low || c[1] > high)) {
        return 0;
    }
    for (size_t i = 2; i < count; i++) {
        if (c[i] < 0x80 || c[i] > 0xbf) {
            return 0;
        }
    }
    return count;
}

static void put_string(json *j, const char *text)
{
    put(j, "\"", 1);
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        const size_t length = utf8_length(c);
        char escape[8];
        if (*c == '"' || *c == '\\') {
            snprintf(escape, sizeof escape, "\\%c", *c);
            put_text(j, escape);
        } else if (*c < 32) {
            snprintf(escape, sizeof escape, "\\u%04x", *c);
            put_text(j, escape);
        } else if (!length) {
            put_text(j, "\\ufffd");
        } else {
            put(j, (const char *)c, length);
        }
        c += length ? length : 1;
    }
    put(j, "\"", 1);
}

static void new_line(json *j)
{
    put(j, "\n", 1);
    for (int i = 0; i < j->depth; i++) {
        put(j, "  ", 2);
    }
}

static void begin_value(json *j, const char *key)
{
    if (!j->first) {
        put(j, ",", 1);
    }
    if (j->depth) {
        new_line(j);
    }
    if (key) {
        put_string(j, key);
        put(j, ": ", 2);
    }
    j->first = 0;
}

json json_begin(void)
{
    json j = { NULL, 0, 0, 0, 1, 0 };
    json_open(&j, NULL, '{');
    return j;
}

void json_open(json *j, const char *key, char bracket)
{
    begin_value(j, key);
    put(j, &bracket, 1);
    j->depth += 1;
    j->first = 1;
}

void json_close(json *j, char bracket)
{
    j->depth -= 1;
    if (!j->first) {
        new_line(j);
    }
    put(j, &bracket, 1);
    j->first = 0;
}

void json_text(json *j, const char *key, const char *value)
{
    begin_value(j, key);
    put_string(j, value);
}

void json_number(json *j, const char *key, double value)
{
    char text[32] = "null"; /* JSON has no infinity */
    if (isfinite(value)) {
        snprintf(text, sizeof text, "%.9g", value);
    }
    begin_value(j, key);
    put_text(j, text);
}

void json_integer(json *j, const char *key, uint64_t value)
{
    char text[32];
    snprintf(text, sizeof text, "%llu", (unsigned long long)value);
    begin_value(j, key);
    put_text(j, text);
}

void json_bool(json *j, const char *key, int value)
{
    begin_value(j, key);
    put_text(j, value ? "true" : "false");
}

void json_null(json *j, const char *key)
{
    begin_value(j, key);
    put_text(j, "null");
}

void json_drop(json *j)
{
    free(j->text);
    j->text = NULL;
    j->count = j->room = 0;
}

int json_end(json *j)
{
    int failed;
    json_close(j, '}');
    put(j, "\n", 1);
    failed = j->failed;
    if (!failed) {
        fwrite(j->text, 1, j->count, stdout); /* main checks the stream */
        printed = 1;
    }
    json_drop(j);
    return failed ? tool_fail("--json", "out of memory") : 0;
}

int json_was_printed(void)
{
    return printed;
}
