/* fuzz_pack.c: any bytes, opened as a pack and, where they open, used whole.
 *
 * With libFuzzer (make fuzz) LLVMFuzzerTestOneInput is called with mutated bytes. Without
 * (make check) the main below replays the files and folders that it is given, tells each as a
 * test, and damages each in a few thousand seeded ways.
 *
 * Each input is tried as it is, then with its length and checksums made right: a fuzzer cannot
 * guess a CRC, so only the second way reaches the structural checks. */
#define _XOPEN_SOURCE 700

#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "noh.h"
#include "pack_walk.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);

static int opened; /* of the last input, for the replay */

/* A failed open has to say what and where. */
static void try_bytes(const uint8_t *bytes, size_t count)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_pack pack;
    noh_result result = noh_pack_open(bytes, count, &pack, &error);
    opened = result == NOH_OK;
    if (opened) {
        pack_walk(&pack, (uint32_t)count);
    } else if (error.result != result || !error.what || !error.what[0] || error.where > count) {
        fprintf(stderr, "an error without a what or a where: %d\n", (int)result);
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
    void *copy;
    if (posix_memalign(&copy, 64, count ? count : 1)) {
        return 0;
    }
    memcpy(copy, data, count);
    try_bytes(copy, count);
    if (count >= sizeof(noh_pack_header)) {
        noh_pack_header *header = copy;
        header->magic = NOH_PACK_MAGIC;
        header->version = NOH_PACK_VERSION;
        header->byte_count = (uint32_t)count;
        pack_repair(copy, count);
        try_bytes(copy, count);
    }
    free(copy);
    return 0;
}

#ifndef NOH_LIBFUZZER

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

static void replay(const char *path, const uint8_t *bytes, size_t count)
{
    uint8_t *copy = malloc(count + 1);
    uint32_t state = 0x6e6f68u;
    int survived = 0;
    if (!copy) {
        abort();
    }
    LLVMFuzzerTestOneInput(bytes, count);
    for (uint32_t i = 0; i < DAMAGES; i++) {
        size_t left = count;
        memcpy(copy, bytes, count);
        damage(copy, &left, &state);
        LLVMFuzzerTestOneInput(copy, left);
        survived += opened;
    }
    printf("ok %u - %s (%d of %u damaged ones open)\n", ++tests, path, survived, DAMAGES);
    free(copy);
}

static void replay_file(const char *path)
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
    replay(path, bytes, (size_t)count);
    free(bytes);
}

static void replay_folder(const char *path)
{
    struct dirent **names;
    int count = scandir(path, &names, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        char file[4096];
        snprintf(file, sizeof file, "%s/%s", path, names[i]->d_name);
        if (names[i]->d_name[0] != '.') {
            replay_file(file);
        }
        free(names[i]);
    }
    if (count >= 0) {
        free(names);
    }
}

int main(int argument_count, char **arguments)
{
    for (int i = 1; i < argument_count; i++) {
        struct stat s;
        if (stat(arguments[i], &s) == 0 && S_ISDIR(s.st_mode)) {
            replay_folder(arguments[i]);
        } else {
            replay_file(arguments[i]);
        }
    }
    printf("1..%u\n", tests ? tests : 1u); /* an empty corpus is a failure */
    return 0;
}

#endif
