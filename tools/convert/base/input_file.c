#include "input_file.h"

#include <stdlib.h>
#include <string.h>

#include "platform.h"

static __thread input_list *recording;

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

char *input_read(const char *path, size_t *bytes, model_error *error)
{
    noh_file file;
    noh_error reason;
    const noh_result result = noh_file_map(path, &file, &reason);
    inputs_note(path, result == NOH_OK);
    if (result != NOH_OK) {
        model_fail(error, "", "the file cannot be read: %s", reason.what);
        return NULL;
    }
    char *copy = malloc(file.bytes + 1);
    if (copy) {
        if (file.bytes) memcpy(copy, file.data, file.bytes);
        copy[file.bytes] = '\0';
        *bytes = file.bytes;
    } else {
        model_fail(error, "", "there is not enough memory to read this file");
    }
    noh_file_unmap(&file);
    return copy;
}

char *input_stem(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    char *stem = model_string(name);
    if (stem && dot && dot != name) stem[dot - name] = '\0';
    return stem;
}
