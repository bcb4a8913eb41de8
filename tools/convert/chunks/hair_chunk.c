/* hair_chunk.c: a haircut, of a text, grown. */
#include "chunk_maker.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/hair_grow.h"

typedef struct haircut {
    hair_text *text;
    hair_grown grown;
} haircut;

static int read_hair(const convert_options *options, const source *s, void **made, convert_failure *failure)
{
    haircut *cut;
    if (!options->texts[NOH_CHUNK_HAIR] || options->only == CONVERT_CLIPS) return 0;
    *made = cut = calloc(1, sizeof *cut);
    if (!cut) return model_fail_memory(&failure->error);
    failure->file = options->texts[NOH_CHUNK_HAIR];
    if (hair_read(options->texts[NOH_CHUNK_HAIR], &cut->text, &failure->line, &failure->error)) return 1;
    if (cut->text->joint && !source_has_joint(s, cut->text->joint)) {
        return model_fail(&failure->error, "", "no skeleton has the joint '%s'", cut->text->joint);
    }
    return hair_grow(cut->text, &cut->grown) ? model_fail_memory(&failure->error) : 0;
}

static void free_hair(void *made)
{
    haircut *cut = made;
    if (cut) {
        hair_grown_free(&cut->grown);
        hair_free(cut->text);
    }
    free(cut);
}

/* sRGB to linear. */
static float linear(float c)
{
    return c <= 0.04045f ? c / 12.92f : powf((c + 0.055f) / 1.055f, 2.4f);
}

/* All but the name and the offsets. */
static void hair_header(const hair_text *t, const hair_grown *g, noh_pack_hair_header *h)
{
    memset(h, 0, sizeof *h);
    h->hair_count = g->hair_count;
    h->point_count = g->point_count;
    h->patch_count = g->patch_count;
    h->sphere_count = g->sphere_count;
    h->strip_count = (uint32_t)t->strips;
    h->segment_count = (uint32_t)t->segments;
    h->seed = (uint32_t)t->seed;
    h->pull = t->pull[0];
    h->pull_at_tip = t->pull[1];
    h->damping = t->damping;
    h->gravity = t->gravity;
    h->width_root = t->width[0];
    h->width_tip = t->width[1];
    h->curl_radius = t->curl[0] < 1.0f ? t->curl[0] : 1.0f;
    h->curl_turns = t->curl[1];
    h->scatter = t->scatter;
    h->gloss = t->gloss;
    memcpy(h->middle, t->skull, sizeof h->middle);
    for (int i = 0; i < 3; i++) {
        h->color_root[i] = linear(t->root[i]);
        h->color_tip[i] = linear(t->tip[i]);
    }
}

static void write_hair(pack_writer *w, const void *made)
{
    const haircut *cut = made;
    noh_pack_hair_header h;
    if (!cut) return;
    const hair_text *t = cut->text;
    const hair_grown *g = &cut->grown;
    hair_header(t, g, &h);
    h.metres = w->clips->set_count ? (float)(w->clips->sets[0]->skeleton.unit_cm / 100.0) : 1.0f;
    chunk_name(w, t->joint ? t->joint : "", &h.joint, &h.joint_hash);
    chunk_begin(w, NOH_CHUNK_HAIR, "");
    const size_t start = w->out.count;
    buffer_append(&w->out, &h, sizeof h);
    h.points_offset = (uint32_t)(w->out.count - start);
    buffer_append(&w->out, g->points, (size_t)g->hair_count * g->point_count * 12u);
    buffer_align(&w->out, 16);
    h.patches_offset = (uint32_t)(w->out.count - start);
    buffer_append(&w->out, g->patches, (size_t)g->patch_count * sizeof *g->patches);
    h.spheres_offset = (uint32_t)(w->out.count - start);
    buffer_append(&w->out, g->spheres, (size_t)g->sphere_count * sizeof *g->spheres);
    if (!w->out.failed) memcpy(w->out.bytes + start, &h, sizeof h);
    chunk_end(w);
}

const chunk_maker chunk_hair = { read_hair, 0, free_hair, write_hair, NULL };
