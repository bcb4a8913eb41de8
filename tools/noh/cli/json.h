/* json.h: JSON on stdout. The text is kept until json_end, so that a verb that fails half-way prints none of it. */
#ifndef NOH_NOH_CLI_JSON_H
#define NOH_NOH_CLI_JSON_H

#include <stddef.h>
#include <stdint.h>

typedef struct json {
    char *text;
    size_t count, room;
    int depth, first, failed; /* failed: out of memory */
} json;

/* An object is open. End it with json_end or json_drop. */
json json_begin(void);
/* Close the object and print it. Prints an error and returns an exit code; 0 on success. */
int json_end(json *j);
/* Print nothing. */
void json_drop(json *j);
/* 1 once json_end has printed. */
int json_was_printed(void);

void json_open(json *j, const char *key,
               char bracket); /* '{' or '['; key: NULL inside arrays, also in the functions below */
void json_close(json *j, char bracket);
void json_text(json *j, const char *key, const char *value);
void json_number(json *j, const char *key, double value);
void json_integer(json *j, const char *key, uint64_t value);
void json_bool(json *j, const char *key, int value);
void json_null(json *j, const char *key);

#endif
