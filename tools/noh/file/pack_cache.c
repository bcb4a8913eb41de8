#define _POSIX_C_SOURCE 200809L /* stat, mkdir, utimensat */

#include "pack_cache.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "noh/pack.h"
#include "platform.h"

#define PATH_BYTES 4096
#define NAME_BYTES 48    /* 32 hexadecimal digits and an ending */
#define BLUR_NS 20000000 /* a file's time may lag behind the clock by a tick of the kernel */

/* ---- hashes ---- */

/* Two chains of multiplications by odd constants, each reversible in every step: 128 bits together. */
static void add_word(content_hash *h, uint64_t word)
{
    h->a = (h->a ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    h->a ^= h->a >> 32;
    h->b = (h->b + word) * UINT64_C(0xd6e8feb86659fd93);
    h->b ^= h->b >> 29;
}

void content_hash_add(content_hash *h, const void *data, size_t bytes)
{
    const uint8_t *at = data;
    uint64_t word;
    add_word(h, bytes);
    for (; bytes >= sizeof word; bytes -= sizeof word, at += sizeof word) {
        memcpy(&word, at, sizeof word);
        add_word(h, word);
    }
    word = 0;
    if (bytes) memcpy(&word, at, bytes);
    add_word(h, word);
}

void content_hash_add_text(content_hash *h, const char *text)
{
    content_hash_add(h, text, strlen(text));
}

int content_hash_add_file(content_hash *h, const char *path)
{
    noh_file file;
    const int is_there = noh_file_map(path, &file, NULL) == NOH_OK;
    add_word(h, (uint64_t)is_there);
    if (!is_there) return 0;
    content_hash_add(h, file.data, file.bytes);
    noh_file_unmap(&file);
    return 1;
}

/* ---- the folder ---- */

static uint64_t limit_bytes(void)
{
    const char *text = getenv("NOH_CACHE_MB");
    char *end;
    const unsigned long long mb = text && *text ? strtoull(text, &end, 10) : 1024u;
    return mb < (UINT64_C(1) << 40) ? (uint64_t)mb << 20 : UINT64_MAX;
}

/* 0, or why there is none. */
static const char *find_folder(char folder[PATH_BYTES])
{
    static const char *const names[] = { "NOH_CACHE", "XDG_CACHE_HOME", "HOME" }, *const below[] = { "", "/noh",
                                                                                                     "/.cache/noh" };
    for (int i = 0; i < 3; i++) {
        const char *value = getenv(names[i]);
        if (!value || !*value) continue;
        return snprintf(folder, PATH_BYTES, "%s%s", value, below[i]) < PATH_BYTES - NAME_BYTES ? NULL
                                                                                               : "the path is too long";
    }
    return "HOME is not set";
}

static void make_folder(char *folder)
{
    for (char *at = folder + 1; *at; at++) {
        if (*at != '/') continue;
        *at = '\0';
        (void)mkdir(folder, 0777);
        *at = '/';
    }
    (void)mkdir(folder, 0777); /* a failure shows when the first file is written */
}

static void path_in(char path[PATH_BYTES], const char *folder, const content_hash *h, const char *ending)
{
    (void)snprintf(path, PATH_BYTES, "%.4000s/%016llx%016llx.%s", folder, (unsigned long long)h->a,
                   (unsigned long long)h->b, ending);
}

/* A name that a model refers to, as a path: from the model's folder, as the model. */
static void path_of_input(char path[PATH_BYTES], const char *model, const char *name)
{
    const char *slash = strrchr(model, '/');
    const int folder = slash && name[0] != '/' ? (int)(slash + 1 - model) : 0;
    (void)snprintf(path, PATH_BYTES, "%.*s%s", folder, model, name);
}

/* What path_of_input makes a path of. */
static const char *name_of_input(const char *model, const char *path)
{
    const char *slash = strrchr(model, '/');
    const size_t folder = slash ? (size_t)(slash + 1 - model) : 0;
    return strncmp(path, model, folder) == 0 ? path + folder : path;
}

static void add_input(content_hash *h, const char *model, const char *name)
{
    char path[PATH_BYTES];
    path_of_input(path, model, name);
    content_hash_add_text(h, name);
    (void)content_hash_add_file(h, path);
}

/* ---- reading ---- */

static int read_whole(const char *path, byte_buffer *out)
{
    noh_file file;
    memset(out, 0, sizeof *out);
    if (noh_file_map(path, &file, NULL) != NOH_OK) return 1;
    buffer_append(out, file.data, file.bytes);
    buffer_append(out, "", 1); /* an end for lists */
    noh_file_unmap(&file);
    if (out->failed) {
        buffer_free(out);
        return 1;
    }
    out->count--;
    return 0;
}

/* The files that the model referred to when it was last built; a model without a list refers to none. */
static void add_listed(content_hash *h, const char *folder, const char *model, content_hash begun)
{
    char path[PATH_BYTES];
    byte_buffer list;
    path_in(path, folder, &begun, "files");
    if (read_whole(path, &list)) return;
    for (char *line = (char *)list.bytes, *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
        *end = '\0';
        add_input(h, model, line);
    }
    (void)utimensat(AT_FDCWD, path, NULL, 0);
    buffer_free(&list);
}

int pack_cache_find(const char *model, content_hash begun, byte_buffer *pack)
{
    char folder[PATH_BYTES], path[PATH_BYTES];
    content_hash whole = begun;
    noh_pack opened;
    if (!limit_bytes() || find_folder(folder)) return 0;
    add_listed(&whole, folder, model, begun);
    path_in(path, folder, &whole, "noh");
    if (read_whole(path, pack)) return 0;
    if (noh_pack_open(pack->bytes, pack->count, &opened, NULL)) {
        buffer_free(pack);
        return 0;
    }
    (void)utimensat(AT_FDCWD, path, NULL, 0); /* used now */
    return 1;
}

/* ---- keeping ---- */

typedef struct kept {
    char name[NAME_BYTES];
    uint64_t bytes;
    int64_t used_ns;
} kept;

static int64_t time_of(const struct stat *s)
{
    return (int64_t)s->st_mtim.tv_sec * 1000000000 + (int64_t)s->st_mtim.tv_nsec;
}

static int by_use(const void *a, const void *b)
{
    const int64_t x = ((const kept *)a)->used_ns, y = ((const kept *)b)->used_ns;
    return (x > y) - (x < y);
}

/* Files of the cache, and what a killed process left of one: nothing else in the folder is touched. */
static int is_ours(const char *name)
{
    const size_t digits = strspn(name, "0123456789abcdef");
    return (digits == 32 && (strcmp(name + 32, ".noh") == 0 || strcmp(name + 32, ".files") == 0)) ||
           (strncmp(name, ".noh-", 5) == 0 && strlen(name) < NAME_BYTES);
}

static uint32_t list_kept(int folder, DIR *open, kept **all)
{
    const struct dirent *entry;
    uint32_t count = 0;
    *all = NULL;
    while ((entry = readdir(open)) != NULL) {
        struct stat s;
        kept *grown;
        if (!is_ours(entry->d_name) || fstatat(folder, entry->d_name, &s, 0)) continue;
        grown = realloc(*all, ((size_t)count + 1u) * sizeof *grown);
        if (!grown) break;
        *all = grown;
        strcpy(grown[count].name, entry->d_name);
        grown[count].bytes = (uint64_t)s.st_size;
        grown[count++].used_ns = time_of(&s);
    }
    return count;
}

/* Remove what was not used for longest, but not the last. */
static void trim(const char *path_of_folder)
{
    const uint64_t limit = limit_bytes();
    DIR *open = opendir(path_of_folder);
    uint64_t sum = 0;
    uint32_t count;
    kept *all;
    if (!open) return;
    count = list_kept(dirfd(open), open, &all);
    if (count) qsort(all, count, sizeof *all, by_use);
    for (uint32_t i = 0; i < count; i++) sum += all[i].bytes;
    for (uint32_t i = 0; i + 1 < count && sum > limit; i++) {
        if (unlinkat(dirfd(open), all[i].name, 0) == 0) sum -= all[i].bytes;
    }
    free(all);
    closedir(open);
}

/* The names of a build's inputs but the model, one a line, and their hash. 1: nothing can be kept. */
static int list_inputs(const char *model, const input_list *inputs, int64_t start_ns, content_hash *h,
                       byte_buffer *list)
{
    for (uint32_t i = 0; i < inputs->count; i++) {
        const char *path = inputs->entries[i].path, *name = name_of_input(model, path);
        struct stat s;
        if (stat(path, &s) == 0 && time_of(&s) > start_ns - BLUR_NS) return 1;
        if (strcmp(path, model) == 0) continue;
        if (strchr(name, '\n')) return 1;
        add_input(h, model, name);
        buffer_append(list, name, strlen(name));
        buffer_append(list, "\n", 1);
    }
    return inputs->failed || list->failed;
}

static const char *keep(const char *folder, const content_hash *begun, const content_hash *whole,
                        const byte_buffer *list, const byte_buffer *pack)
{
    char path[PATH_BYTES];
    noh_error error = { NOH_OK, "", 0, 0 };
    path_in(path, folder, begun, "files");
    if (list->count && noh_file_write(path, list->bytes, list->count, &error)) return error.what;
    if (!list->count) (void)unlink(path);
    path_in(path, folder, whole, "noh");
    return noh_file_write(path, pack->bytes, pack->count, &error) ? error.what : NULL;
}

void pack_cache_keep(const char *model, content_hash begun, const input_list *inputs, int64_t start_ns,
                     const byte_buffer *pack)
{
    static int has_warned;
    char folder[PATH_BYTES] = "";
    content_hash whole = begun;
    byte_buffer list = { NULL, 0, 0, 0 };
    const char *why = NULL;
    if (!limit_bytes()) return;
    if (list_inputs(model, inputs, start_ns, &whole, &list) == 0) {
        why = find_folder(folder);
        if (!why) {
            make_folder(folder);
            why = keep(folder, &begun, &whole, &list, pack);
        }
        if (!why) trim(folder);
    }
    if (why && !has_warned) {
        fprintf(stderr,
                "noh: %s: warning: the built pack cannot be kept for the next run: %s; set NOH_CACHE to a folder that "
                "can be written, or NOH_CACHE_MB=0\n",
                *folder ? folder : "cache", why);
        has_warned = 1;
    }
    buffer_free(&list);
}
