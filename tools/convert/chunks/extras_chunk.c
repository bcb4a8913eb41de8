/* extras_chunk.c: what the extra attributes of each mesh are; their words are in the mesh's own chunk. */
#include <string.h>

#include "chunk_maker.h"
#include "convert/model/model_extra.h"

static void write_extras_of(pack_writer *w, uint32_t index)
{
    noh_extras_header h;
    extra_plan plan;
    extras_plan(w->m, &w->m->meshes[index], &plan);
    if (!plan.word_count) return;
    memset(&h, 0, sizeof h);
    h.mesh = index;
    h.count = w->m->extras.count;
    h.word_count = plan.word_count;
    h.names_offset = sizeof h;
    h.rows_offset = h.names_offset + h.count * (uint32_t)sizeof(noh_extra_name);
    chunk_begin(w, NOH_CHUNK_EXTRAS, w->m->meshes[index].name);
    buffer_append(&w->out, &h, sizeof h);
    for (uint32_t k = 0; k < h.count; k++) {
        noh_extra_name name;
        memset(&name, 0, sizeof name);
        chunk_name(w, w->m->extras.names[k], &name.name, &name.name_hash);
        name.error = plan.errors[k];
        buffer_append(&w->out, &name, sizeof name);
    }
    buffer_append(&w->out, plan.rows, h.count * sizeof *plan.rows);
    chunk_end(w);
}

static void write_extras(pack_writer *w, const void *made)
{
    (void)made;
    for (uint32_t i = 0; i < w->m->mesh_count; i++) write_extras_of(w, i);
}

const chunk_maker chunk_extras = { .write = write_extras };
