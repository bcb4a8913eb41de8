/* springs_chunk.c: what swings: of a text, of lines of the command, of extras. */
#include "chunk_maker.h"

#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/springs/springs_bind.h"

/* A line of the command line; it has no number. */
static int read_spring_line(const char *given, springs_text *text, convert_failure *failure)
{
    const uint32_t chains = text->chain_count, colliders = text->collider_count;
    uint32_t line;
    if (springs_text_add(text, given, strlen(given), &line, &failure->error)) {
        failure->file = given;
        failure->error.where[0] = 0;
        return 1;
    }
    for (uint32_t i = chains; i < text->chain_count; i++) text->chains[i].line = 0;
    for (uint32_t i = colliders; i < text->collider_count; i++) text->colliders[i].line = 0;
    return 0;
}

/* Read the springs of the file's extras and of its extension. */
static int bind_own_springs(const source *s, set_springs *out, convert_failure *failure)
{
    springs_text *text = springs_text_new();
    const char *lines = s->m->spring_lines;
    uint32_t line = 0;
    int failed = !text;
    for (; !failed && lines && *lines; lines += strcspn(lines, "\n") + 1u) {
        const size_t size = strcspn(lines, "\n");
        if (springs_text_add(text, lines, size, &line, &failure->error)) {
            failed = model_warn(s->m, "springs in extras: '%.*s' was left out: %s", (int)(size < 60u ? size : 60u),
                                lines, failure->error.what);
        }
    }
    memset(&failure->error, 0, sizeof failure->error);
    if (failed || springs_bind_nodes(s->m, s->sets, s->set_count, out)) {
        springs_text_free(text);
        return model_fail_memory(&failure->error);
    }
    failed = springs_bind_text(text, s->m, s->sets, s->set_count, 1, out, &line, &failure->error);
    springs_text_free(text);
    return failed;
}

static int read_given_springs(const convert_options *options, springs_text *text, convert_failure *failure)
{
    if (options->texts[NOH_CHUNK_SPRINGS] &&
        springs_text_read(text, options->texts[NOH_CHUNK_SPRINGS], &failure->line, &failure->error)) {
        failure->file = options->texts[NOH_CHUNK_SPRINGS];
        return 1;
    }
    for (uint32_t i = 0; i < options->spring_line_count; i++) {
        if (read_spring_line(options->spring_lines[i], text, failure)) return 1;
    }
    return 0;
}

static int bind_given_springs(const convert_options *options, const source *s, set_springs *out,
                              convert_failure *failure)
{
    springs_text *text = springs_text_new();
    int failed = text ? read_given_springs(options, text, failure) : model_fail_memory(&failure->error);
    if (!failed && springs_bind_text(text, s->m, s->sets, s->set_count, 0, out, &failure->line, &failure->error)) {
        failure->file = failure->line ? options->texts[NOH_CHUNK_SPRINGS] : "--spring";
        failed = 1;
    }
    springs_text_free(text);
    return failed;
}

typedef struct all_springs {
    uint32_t set_count;
    set_springs *sets; /* [set_count] */
} all_springs;

static int read_springs(const convert_options *options, const source *s, void **made, convert_failure *failure)
{
    all_springs *all;
    int failed;
    if (options->only == CONVERT_CLIPS) return 0;
    *made = all = calloc(1, sizeof *all);
    if (all) all->sets = calloc(s->set_count + 1u, sizeof *all->sets);
    if (!all || !all->sets) return model_fail_memory(&failure->error);
    all->set_count = s->set_count;
    failed = options->texts[NOH_CHUNK_SPRINGS] || options->spring_line_count
                 ? bind_given_springs(options, s, all->sets, failure)
                 : bind_own_springs(s, all->sets, failure);
    return failed || (springs_sort(all->sets, s->set_count) && model_fail_memory(&failure->error));
}

static void free_springs(void *made)
{
    all_springs *all = made;
    if (all) springs_free(all->sets, all->set_count);
    free(all);
}

static void write_springs(pack_writer *w, const void *made)
{
    const all_springs *all = made;
    for (uint32_t i = 0; all && i < all->set_count; i++) {
        const set_springs *s = &all->sets[i];
        noh_springs_header h;
        if (!s->row_count) continue;
        memset(&h, 0, sizeof h);
        h.skeleton = i;
        h.joint_count = w->clips->sets[i]->skeleton.joint_count;
        h.row_count = s->row_count;
        h.rows_offset = sizeof h;
        h.chain_count = s->chain_count;
        h.chains_offset = (h.rows_offset + h.row_count * (uint32_t)sizeof *s->rows + 15u) & ~15u;
        h.collider_count = s->collider_count;
        h.colliders_offset = (h.chains_offset + h.chain_count * (uint32_t)sizeof *s->chains + 15u) & ~15u;
        chunk_begin(w, NOH_CHUNK_SPRINGS, w->clips->sets[i]->skeleton.name);
        buffer_append(&w->out, &h, sizeof h);
        buffer_append(&w->out, s->rows, s->row_count * sizeof *s->rows);
        buffer_align(&w->out, 16);
        buffer_append(&w->out, s->chains, s->chain_count * sizeof *s->chains);
        buffer_align(&w->out, 16);
        buffer_append(&w->out, s->colliders, s->collider_count * sizeof *s->colliders);
        chunk_end(w);
    }
}

const chunk_maker chunk_springs = { read_springs, 1, free_springs, write_springs, NULL };
