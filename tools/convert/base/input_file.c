#include "input_file.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "platform.h"

#define PATH_BYTES 4096

static __thread input_list *recording;
static __thread const input_held *held;
static __thread uint32_t held_count;

void inputs_record(input_list *list)
{
    recording = list;
}

void inputs_note(const char *path, int is_there)
{
    input_list *list = recording;
    struct input_entry *grown;
    for (uint32_t i = 0; list && i < list->count; i++) {
        if (strcmp(list->entries[i].path, path) == 0) {
            list->entries[i].is_there |= is_there;
            return;
        }
    }
    if (!list || list->failed) return;
    grown = realloc(list->entries, ((size_t)list->count + 1u) * sizeof *grown);
    if (grown) list->entries = grown;
    if (!grown || !(grown[list->count].path = model_string(path))) {
        list->failed = 1;
        return;
    }
    grown[list->count++].is_there = is_there;
}

void inputs_free(input_list *list)
{
    for (uint32_t i = 0; i < list->count; i++) free(list->entries[i].path);
    free(list->entries);
    memset(list, 0, sizeof *list);
}

/* ---- files in memory ---- */

void inputs_hold(const input_held *files, uint32_t count)
{
    held = files;
    held_count = count;
}

int inputs_are_held(void)
{
    return held != NULL;
}

/* A path without ".", empty names, and names that a ".." takes back. 0: it is too long. */
static int plain_path(const char *path, char plain[PATH_BYTES])
{
    size_t count = 0;
    plain[0] = '\0';
    for (size_t length; *path; path += length + (path[length] == '/')) {
        length = strcspn(path, "/");
        if (!length || (length == 1 && path[0] == '.')) continue;
        const char *last = strrchr(plain, '/');
        last = last ? last + 1 : plain;
        if (length == 2 && memcmp(path, "..", 2) == 0 && count && strcmp(last, "..") != 0) {
            count = last == plain ? 0 : (size_t)(last - plain) - 1u;
        } else {
            const size_t slash = count != 0;
            if (count + slash + length >= PATH_BYTES) return 0;
            if (slash) plain[count++] = '/';
            memcpy(plain + count, path, length);
            count += length;
        }
        plain[count] = '\0';
    }
    plain[count] = '\0';
    return 1;
}

const input_held *input_find_held(const char *path)
{
    char wanted[PATH_BYTES], own[PATH_BYTES];
    if (!plain_path(path, wanted) || !wanted[0]) return NULL;
    for (uint32_t i = 0; i < held_count; i++) {
        if (plain_path(held[i].path, own) && strcmp(wanted, own) == 0) return &held[i];
    }
    return NULL;
}

/* What follows a folder in a held file's path, which goes to own; NULL: the file is not in the folder or below it. */
static const char *part_below(const char *folder, const char *path, char own[PATH_BYTES])
{
    char wanted[PATH_BYTES];
    if (!plain_path(folder, wanted) || !plain_path(path, own)) return NULL;
    const size_t length = strlen(wanted);
    if (length && (strncmp(own, wanted, length) != 0 || own[length] != '/')) return NULL;
    return own + length + (length != 0);
}

const char *input_next_held(const char *folder, uint32_t *at)
{
    char own[PATH_BYTES];
    while (*at < held_count) {
        const char *path = held[(*at)++].path, *slash = strrchr(path, '/'), *below = part_below(folder, path, own);
        if (below && !strchr(below, '/')) return slash ? slash + 1 : path;
    }
    return NULL;
}

/* ---- names in any case ---- */

/* A file or folder of exactly this path. */
static int is_there(const char *path)
{
    char own[PATH_BYTES];
    int found = held ? input_find_held(path) != NULL : access(path, F_OK) == 0;
    for (uint32_t i = 0; i < held_count && !found; i++) found = part_below(path, held[i].path, own) != NULL;
    return found;
}

static int lower(int c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

static int is_same_but_case(const char *a, const char *b, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        if (lower(a[i]) != lower(b[i])) return 0;
    }
    return a[length] == '\0' || (held && a[length] == '/');
}

/* The folders that a search reads at most: of names with "..", it could read the same ones for ever. */
#define FOLDERS_MAX 256u

/* Give the name at found + start, of length bytes, the next case that it has in its folder: by its bytes, after the case
 * that path has. 0: there is no further one. */
static int next_case(const char *path, char *found, size_t start, size_t length)
{
    char own[PATH_BYTES], best[PATH_BYTES];
    char *name = found + start;
    const char *exact = path + start;
    const int is_first = memcmp(name, exact, length) == 0;
    int any = 0;
    if (start) found[start - 1u] = '\0';
    const char *folder = start > 1u ? found : start ? "/" : ".";
    DIR *open = held ? NULL : opendir(folder);
    for (uint32_t i = 0; held ? i < held_count : open != NULL; i++) {
        const struct dirent *entry = open ? readdir(open) : NULL;
        if (open && !entry) break;
        const char *at = entry ? entry->d_name : part_below(folder, held[i].path, own);
        if (!at || !is_same_but_case(at, name, length) || memcmp(at, exact, length) == 0) continue;
        if ((!is_first && memcmp(at, name, length) <= 0) || (any && memcmp(at, best, length) >= 0)) continue;
        memcpy(best, at, length);
        any = 1;
    }
    if (open) (void)closedir(open);
    if (start) found[start - 1u] = '/';
    if (any) memcpy(name, best, length);
    return any;
}

/* Find the names from path + start on below the folders that found has before: of each, first as it is. */
static int find_below(const char *path, char *found, size_t start, uint32_t *folders_left)
{
    start += strspn(path + start, "/");
    const size_t length = strcspn(path + start, "/"), end = start + length;
    if (!length) return 1;
    memcpy(found + start, path + start, length);
    found[end] = '\0';
    const int is_exact = is_there(found);
    found[end] = path[end];
    if (is_exact && find_below(path, found, end, folders_left)) return 1;
    while (*folders_left) {
        --*folders_left;
        if (!next_case(path, found, start, length)) return 0;
        if (find_below(path, found, end, folders_left)) return 1;
    }
    return 0;
}

int input_find_any_case(const char *path, char *found, size_t size)
{
    const size_t length = strlen(path);
    uint32_t folders_left = FOLDERS_MAX;
    if (length >= size || length >= PATH_BYTES) return 0;
    memcpy(found, path, length + 1u);
    return is_there(path) || find_below(path, found, 0, &folders_left);
}

int input_map(const char *path, const void **bytes, size_t *count, const char **what)
{
    const input_held *found = input_find_held(path);
    noh_file file = { found ? found->bytes : NULL, found ? found->count : 0 };
    noh_error reason = { NOH_OK, "there is no file of this name among the caller's", 0, 0 };
    const int failed = !found && (held || noh_file_map(path, &file, &reason) != NOH_OK);
    *bytes = file.data;
    *count = file.bytes;
    if (failed && what) *what = reason.what;
    return failed;
}

void input_unmap(const void *bytes, size_t count)
{
    noh_file file = { bytes, count };
    if (!held) noh_file_unmap(&file);
}

char *input_read(const char *path, size_t *bytes, model_error *error)
{
    const void *data;
    const char *reason;
    size_t count;
    const int failed = input_map(path, &data, &count, &reason);
    inputs_note(path, !failed);
    if (failed) {
        model_fail(error, "", "the file cannot be read: %s", reason);
        return NULL;
    }
    char *copy = malloc(count + 1);
    if (copy) {
        if (count) memcpy(copy, data, count);
        copy[count] = '\0';
        *bytes = count;
    } else {
        model_fail(error, "", "there is not enough memory to read this file");
    }
    input_unmap(data, count);
    return copy;
}

char *input_read_text(const char *path, size_t *bytes, model_error *error)
{
    char *text = input_read(path, bytes, error);
    if (!text) return NULL;
    if (*bytes >= 2 && (memcmp(text, "\xff\xfe", 2) == 0 || memcmp(text, "\xfe\xff", 2) == 0)) {
        free(text);
        model_fail(error, "", "this is a text in UTF-16: save it as UTF-8");
        return NULL;
    }
    while (*bytes && !text[*bytes - 1]) --*bytes; /* some exporters fill up a block */
    const char *zero = *bytes ? memchr(text, 0, *bytes) : NULL;
    if (zero) {
        model_fail(error, "", "this is not a text: byte %zu is 0; save it as a text in UTF-8", (size_t)(zero - text));
        free(text);
        return NULL;
    }
    for (size_t i = 0; i < *bytes; i++) {
        if (text[i] == '\r' && text[i + 1] != '\n') text[i] = '\n';
    }
    return text;
}

int input_fail_at(const char *path, model_error *error)
{
    char place[sizeof error->where];
    memcpy(place, error->where, sizeof place);
    const size_t own = strlen(place) + 3u, length = strlen(path), room = sizeof place > own ? sizeof place - own : 0;
    const char *end = path + (length > room ? length - room : 0); /* a long path loses its beginning */
    const int cut = snprintf(error->where, sizeof error->where, "%s%s%s", end, place[0] ? ", " : "", place);
    if (cut < 0) error->where[0] = '\0';
    return 1;
}

char *input_stem(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    char *stem = model_string(name);
    if (stem && dot && dot != name) stem[dot - name] = '\0';
    return stem;
}
