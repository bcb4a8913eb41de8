/* terrain_chunk.c: the ground, of a picture or a model. */
#include "chunk_maker.h"

#include <stdlib.h>
#include <string.h>

static int read_ground(const convert_options *options, const source *s, void **made, convert_failure *failure)
{
    terrain *read;
    (void)s;
    if (!options->texts[NOH_CHUNK_TERRAIN]) return 0;
    *made = read = calloc(1, sizeof *read);
    if (!read) return model_fail_memory(&failure->error);
    failure->file = options->texts[NOH_CHUNK_TERRAIN];
    if (terrain_read(options->texts[NOH_CHUNK_TERRAIN], &options->ground, read, &failure->error)) return 1;
    if (options->report) {
        fprintf(options->report, "terrain: %u x %u heights, %g x %g m, %.3f to %.3f m, steps of %.3g mm", read->width,
                read->depth, (double)read->spacing * (read->width - 1u), (double)read->spacing * (read->depth - 1u),
                (double)read->low, (double)read->high, 1000.0 * (double)read->scale);
        if (read->hole_count) fprintf(options->report, "; %u without ground, set to the lowest", read->hole_count);
        fprintf(options->report, "\n");
    }
    return 0;
}

static void write_ground(pack_writer *w, const void *made)
{
    const terrain *t = made;
    noh_pack_terrain_header h;
    if (!t) return;
    memset(&h, 0, sizeof h);
    h.width = t->width;
    h.depth = t->depth;
    memcpy(h.origin, t->origin, sizeof h.origin);
    h.spacing = t->spacing;
    h.scale = t->scale;
    h.heights_offset = sizeof h;
    chunk_begin(w, NOH_CHUNK_TERRAIN, "");
    buffer_append(&w->out, &h, sizeof h);
    buffer_append(&w->out, t->heights, sizeof *t->heights * t->width * t->depth);
    chunk_end(w);
}

static void free_ground(void *made)
{
    if (made) terrain_free(made);
    free(made);
}

const chunk_maker chunk_terrain = { read_ground, 0, free_ground, write_ground, NULL };
