#include <math.h>

#include "noh_tool.h"

json json_begin(FILE *out)
{
    json j = { out, 0, 1 };
    json_open(&j, NULL, '{');
    return j;
}

static void print_string(FILE *out, const char *text)
{
    fputc('"', out);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        if (*c == '"' || *c == '\\') {
            fprintf(out, "\\%c", *c);
        } else if (*c < 32) {
            fprintf(out, "\\u%04x", *c);
        } else {
            fputc(*c, out);
        }
    }
    fputc('"', out);
}

static void begin_value(json *j, const char *key)
{
    if (!j->first) {
        fputc(',', j->out);
    }
    if (j->depth) {
        fprintf(j->out, "\n%*s", 2 * j->depth, "");
    }
    if (key) {
        print_string(j->out, key);
        fputs(": ", j->out);
    }
    j->first = 0;
}

void json_open(json *j, const char *key, char bracket)
{
    begin_value(j, key);
    fputc(bracket, j->out);
    j->depth += 1;
    j->first = 1;
}

void json_close(json *j, char bracket)
{
    j->depth -= 1;
    if (!j->first) {
        fprintf(j->out, "\n%*s", 2 * j->depth, "");
    }
    fputc(bracket, j->out);
    j->first = 0;
}

void json_text(json *j, const char *key, const char *value)
{
    begin_value(j, key);
    print_string(j->out, value);
}

void json_number(json *j, const char *key, double value)
{
    begin_value(j, key);
    if (isfinite(value)) {
        fprintf(j->out, "%.9g", value);
    } else {
        fputs("null", j->out); /* JSON has no infinity */
    }
}

void json_integer(json *j, const char *key, uint64_t value)
{
    begin_value(j, key);
    fprintf(j->out, "%llu", (unsigned long long)value);
}

void json_bool(json *j, const char *key, int value)
{
    begin_value(j, key);
    fputs(value ? "true" : "false", j->out);
}

void json_null(json *j, const char *key)
{
    begin_value(j, key);
    fputs("null", j->out);
}

void json_end(json *j)
{
    json_close(j, '}');
    fputc('\n', j->out);
}
