#define _XOPEN_SOURCE 700 /* realpath */

#include "stage_desc_reader.h"

#include <errno.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "convert/base/input_file.h"
#include "convert/base/nearest.h"

int desc_fail_at(const reader *r, uint32_t line, const char *format, ...)
{
    char subject[512], what[512];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    (void)snprintf(subject, sizeof subject, "%s:%u", r->path, line);
    return tool_fail(subject, "%s", what);
}

int desc_out_of_memory(const char *path)
{
    return tool_fail(path, "out of memory while reading this file");
}

hint desc_hint(const char *name, const char *const *candidates, size_t count)
{
    const char *near = nearest_name(name, candidates, count);
    hint h = { "" };
    if (near) (void)snprintf(h.text, sizeof h.text, "; did you mean '%.60s'?", near);
    return h;
}

/* ---- words ---- */

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* A word at *at: blanks end it, except between quotes, which are taken out. */
static int take_word(const reader *r, char **at, word *out)
{
    char *to = *at, *from = *at;
    int quoted = 0;
    out->text = to;
    out->value = NULL;
    for (; *from && (quoted || !is_blank(*from)); from++) {
        if (*from == '"') {
            quoted = !quoted;
        } else if (*from == '=' && !quoted && !out->value) {
            *to++ = '\0';
            out->value = to;
        } else {
            *to++ = *from;
        }
    }
    *at = *from ? from + 1 : from;
    *to = '\0';
    return quoted ? desc_fail_at(r, r->line, "a quote is not closed") : 0;
}

/* The words of the next line, none in one that is empty or a comment. */
static int split_line(reader *r)
{
    char *at = r->at, *end = strchr(at, '\n');
    r->at = end ? end + 1 : NULL;
    if (end) *end = '\0';
    r->line++;
    r->word_count = 0;
    for (;;) {
        while (is_blank(*at)) at++;
        if (!*at || *at == '#') {
            return 0;
        }
        if (r->word_count == WORDS_MAX) {
            return desc_fail_at(r, r->line, "a line has more than %u words", WORDS_MAX);
        }
        if (take_word(r, &at, &r->words[r->word_count++])) {
            return EXIT_FAILED;
        }
    }
}

/* ---- packs ---- */

char *desc_path(const char *text, const char *path)
{
    const char *slash = strrchr(text, '/');
    const size_t folder = slash && path[0] != '/' ? (size_t)(slash - text) + 1u : 0, length = strlen(path) + 1u;
    char *joined = malloc(folder + length);
    if (joined) {
        memcpy(joined, text, folder);
        memcpy(joined + folder, path, length);
    }
    return joined;
}

static int open_pack(const reader *r, char *path, const noh_pack **out)
{
    stage_desc_file *f = r->file;
    char subject[512], *real = realpath(path, NULL);
    int status;
    while (f->reader_of) f = f->reader_of;
    for (uint32_t i = 0; real && i < f->pack_count; i++) {
        if (strcmp(f->pack_paths[i], real) == 0) {
            *out = &f->packs[i].pack;
            free(real);
            return 0;
        }
    }
    if (f->pack_count == STAGE_DESC_PACKS_MAX) {
        free(real);
        return desc_fail_at(r, r->line, "this file and its peers name more than %u packs", STAGE_DESC_PACKS_MAX);
    }
    (void)snprintf(subject, sizeof subject, "%s:%u: %s", r->path, r->line, path);
    status = pack_file_open_as(&f->packs[f->pack_count], path, subject);
    if (!status && !real) status = desc_out_of_memory(r->path);
    if (status) {
        pack_file_close(&f->packs[f->pack_count]);
        free(real);
        return status;
    }
    f->packs[f->pack_count].path = f->pack_paths[f->pack_count] = real;
    *out = &f->packs[f->pack_count++].pack;
    return 0;
}

int desc_pack(const reader *r, const char *text, const noh_pack **out)
{
    char *path = desc_path(r->path, text);
    const int status = path ? open_pack(r, path, out) : desc_out_of_memory(r->path);
    free(path);
    return status;
}

/* ---- kinds ---- */

static int end_kind(reader *r)
{
    noh_kind_desc *k = r->kind;
    if (!k) {
        return 0;
    }
    if (!k->mesh) return desc_fail_at(r, r->kind_line, "kind '%.60s' has no mesh: add a line 'mesh PATH'", k->name);
    if (!k->actor_count)
        return desc_fail_at(r, r->kind_line, "kind '%.60s' has no actor_count: add a line 'actor_count N'", k->name);
    if (r->file->ragdolls[k - r->file->kinds].world && !k->ragdoll.type)
        return desc_fail_at(r, r->kind_line, "kind '%.60s' has a ragdoll_world: add a line 'ragdolls N'", k->name);
    return desc_make_map(r);
}

static int begin_kind(reader *r)
{
    noh_stage_desc *d = &r->file->desc;
    if (end_kind(r) || desc_check_words(r, "kind", DESC_ONE_WORD)) {
        return EXIT_FAILED;
    }
    if (d->kind_count == NOH_STAGE_KINDS_MAX) {
        return desc_fail_at(r, r->line, "there are more than %u kinds", NOH_STAGE_KINDS_MAX);
    }
    for (uint32_t i = 0; i < d->kind_count; i++) {
        if (strcmp(r->file->kinds[i].name, r->words[1].text) == 0) {
            return desc_fail_at(r, r->line, "the kind '%.60s' is given twice", r->words[1].text);
        }
    }
    memset(r->given, 0, sizeof r->given);
    r->kind = &r->file->kinds[d->kind_count++];
    r->kind_line = r->line;
    r->kind->name = r->words[1].text;
    r->kind->springs = noh_springs_module(NULL);
    return 0;
}

static int read_line(reader *r)
{
    if (split_line(r)) {
        return EXIT_FAILED;
    }
    if (!r->word_count) {
        return 0;
    }
    if (strcmp(r->words[0].text, "kind") == 0) {
        return begin_kind(r);
    }
    return desc_read_key(r);
}

/* Move the kinds that take slots of others out of the list. What they point to stays. */
static void sort_kinds(stage_desc_file *f)
{
    const uint32_t count = f->desc.kind_count;
    uint32_t others = 0, kinds = 0;
    for (uint32_t i = 0; i < count; i++) {
        noh_kind_desc *k = &f->kinds[i];
        if (f->slot_of[i]) continue;
        for (uint32_t o = i + 1u; o < count; o++) {
            if (f->slot_of[o] != 1u + i) continue;
            if (!k->other_count++) k->others = &f->others[others];
            f->others[others++] = f->kinds[o];
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!f->slot_of[i]) f->kinds[kinds++] = f->kinds[i];
    }
    f->desc.kind_count = kinds;
    f->desc.kinds = f->kinds;
}

/* ---- the file ---- */

static int read_all(reader *r)
{
    stage_desc_file *f = r->file;
    model_error error = { "", "" };
    size_t bytes = 0;
    int status = 0;
    f->text = input_read_text(r->path, &bytes, &error);
    if (!f->text) {
        return tool_fail(r->path, "%s", error.what);
    }
    if (memchr(f->text, 0, bytes)) {
        return tool_fail(r->path, "this is not a text file: it contains a zero byte");
    }
    r->at = f->text + (strncmp(f->text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0); /* a byte order mark */
    while (r->at && !status) {
        status = read_line(r);
    }
    if (!status) status = end_kind(r);
    if (!status && !f->desc.kind_count) status = tool_fail(r->path, "the file has no kind: add a line 'kind NAME'");
    sort_kinds(f);
    return status;
}

int desc_read_file(const char *path, stage_desc_file *reader_of, stage_desc_file **out)
{
    reader r;
    int status;
    memset(&r, 0, sizeof r);
    r.path = path;
    r.file = calloc(1, sizeof *r.file);
    *out = NULL;
    if (!r.file) {
        return desc_out_of_memory(path);
    }
    r.file->reader_of = reader_of;
    status = read_all(&r);
    if (status) {
        stage_desc_file_free(r.file);
        return status;
    }
    *out = r.file;
    return 0;
}

int stage_desc_file_read(const char *path, stage_desc_file **out)
{
    return desc_read_file(path, NULL, out);
}

void stage_desc_file_free(stage_desc_file *file)
{
    if (!file) {
        return;
    }
    for (uint32_t i = 0; i < file->share.peer_count; i++) stage_desc_file_free(file->peer_files[i]);
    for (uint32_t i = 0; i < file->pack_count; i++) {
        pack_file_close(&file->packs[i]);
        free(file->pack_paths[i]);
    }
    free(file->text);
    free(file);
}
