/* ragdoll_chunk.c: the bodies of a ragdoll, of a text. */
#include "chunk_maker.h"

#include <string.h>

#include "convert/base/ragdoll_read.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_life.h"
#include "noh/pack.h"

/* A joint that is not there is an error: the body would lack it. */
static int read_ragdoll(const convert_options *options, const source *s, void **made, convert_failure *failure)
{
    ragdoll_text *text = NULL;
    if (!options->texts[NOH_CHUNK_RAGDOLL] || options->only == CONVERT_CLIPS) return 0;
    failure->file = options->texts[NOH_CHUNK_RAGDOLL];
    const int failed = ragdoll_read(options->texts[NOH_CHUNK_RAGDOLL], &text, &failure->line, &failure->error);
    *made = text;
    for (uint32_t i = 0; !failed && i < text->count; i++) {
        if (source_has_joint(s, text->rows[i].joint)) continue;
        failure->line = text->rows[i].line;
        return model_fail(&failure->error, "", "no skeleton has the joint '%s'", text->rows[i].joint);
    }
    return failed;
}

static void write_ragdoll(pack_writer *w, const void *made)
{
    const ragdoll_text *ragdoll = made;
    noh_pack_ragdoll_header h;
    if (!ragdoll) return;
    memset(&h, 0, sizeof h);
    h.row_count = ragdoll->count;
    h.rows_offset = sizeof h;
    chunk_begin(w, NOH_CHUNK_RAGDOLL, "");
    buffer_append(&w->out, &h, sizeof h);
    for (uint32_t i = 0; i < ragdoll->count; i++) {
        const ragdoll_line *from = &ragdoll->rows[i];
        noh_pack_ragdoll_row row;
        memset(&row, 0, sizeof row);
        chunk_name(w, from->joint, &row.joint, &row.joint_hash);
        row.hinge = from->hinge;
        row.toward = from->toward;
        row.bend_min = from->bend_min;
        row.bend_max = from->bend_max;
        row.side = from->side;
        row.twist = from->twist;
        row.friction = from->friction;
        buffer_append(&w->out, &row, sizeof row);
    }
    chunk_end(w);
}

/* Whether the rows of its table hang together. */
static int check_ragdoll(const noh_pack *pack, model_error *error)
{
    for (uint32_t i = 0; pack->ragdoll_row_count && i < pack->runs[NOH_CHUNK_SKELETON].count; i++) {
        noh_ragdoll_source s = { .pack = pack, .skeleton = i };
        const noh_skeleton_header *header;
        noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
        noh_ragdoll_rig rig;
        noh_error refusal = { NOH_OK, "", 0, 0 };
        uint32_t count;
        if (noh_pack_skeleton_at(pack, i, &s.joints, &header, NULL)) continue;
        s.metres = header->unit_cm / 100.0f;
        if (noh_ragdoll_find_rows(&s, rows, &count, NULL) || count != pack->ragdoll_row_count) continue;
        if (!noh_ragdoll_rig_make(&s, rows, count, &rig, &refusal)) continue;
        (void)snprintf(error->what, sizeof error->what, "--ragdoll: %s ('%s')", refusal.what,
                       noh_pack_joint_name(pack, i, rows[refusal.where < count ? refusal.where : 0].joint));
        error->where[0] = 0;
        return 1;
    }
    return 0;
}

static void free_ragdoll(void *made)
{
    ragdoll_free(made);
}

const chunk_maker chunk_ragdoll = { read_ragdoll, 0, free_ragdoll, write_ragdoll, check_ragdoll };
