#define _XOPEN_SOURCE 700

#include "fuzz_replay.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define DAMAGES 3000u

static unsigned tests;

static uint32_t next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

/* Words overwritten, bytes flipped, the end cut: what a fuzzer would begin with. */
static void damage(uint8_t *bytes, size_t *count, uint32_t *state)
{
    static const uint32_t words[] = { 0, 1, 0xffffffffu, 0x7fffffffu, 0x80000000u, 0x7fc00000u, 0x7f800000u, 0xffffu };
    for (uint32_t i = 0; i <= next(state) % 3u && *count >= 4; i++) {
        size_t at = next(state) % (*count - 3u);
        switch (next(state) % 4u) {
        case 0: bytes[at] ^= (uint8_t)(1u << next(state) % 8u); break;
        case 1: memcpy(bytes + at / 4u * 4u, &words[next(state) % 8u], 4); break;
        case 2: bytes[at] = (uint8_t)next(state); break;
        default: *count -= next(state) % 8u ? 0 : next(state) % *count; break;
        }
    }
}

static void replay(const char *path, const uint8_t *bytes, size_t count, fuzz_try try_input)
{
    uint8_t *copy = malloc(count + 1);
    uint32_t state = 0x6e6f68u;
    int survived = 0;
    if (!copy) {
        abort();
    }
    try_input(bytes, count);
    for (uint32_t i = 0; i < DAMAGES; i++) {
        size_t left = count;
        memcpy(copy, bytes, count);
        damage(copy, &left, &state);
        survived += try_input(copy, left);
    }
    printf("ok %u - %s (%d of %u damaged ones accepted)\n", ++tests, path, survived, DAMAGES);
    free(copy);
}

static void replay_file(const char *path, fuzz_try try_input)
{
    FILE *f = fopen(path, "rb");
    uint8_t *bytes;
    long count;
    if (!f || fseek(f, 0, SEEK_END) || (count = ftell(f)) < 0) {
        printf("not ok %u - cannot read %s\n", ++tests, path);
        exit(1);
    }
    rewind(f);
    bytes = malloc((size_t)count + 1);
    if (!bytes || fread(bytes, 1, (size_t)count, f) != (size_t)count) {
        abort();
    }
    fclose(f);
    replay(path, bytes, (size_t)count, try_input);
    free(bytes);
}

static void replay_folder(const char *path, fuzz_try try_input)
{
    struct dirent **names;
    int count = scandir(path, &names, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        char file[4096];
        snprintf(file, sizeof file, "%s/%s", path, names[i]->d_name);
        if (names[i]->d_name[0] != '.') {
            replay_file(file, try_input);
        }
        free(names[i]);
    }
    if (count >= 0) {
        free(names);
    }
}

int fuzz_replay(int argument_count, char **arguments, fuzz_try try_input)
{
    for (int i = 1; i < argument_count; i++) {
        struct stat s;
        if (stat(arguments[i], &s) == 0 && S_ISDIR(s.st_mode)) {
            replay_folder(arguments[i], try_input);
        } else {
            replay_file(arguments[i], try_input);
        }
    }
    printf("1..%u\n", tests ? tests : 1u); /* an empty corpus is a failure */
    return 0;
}
