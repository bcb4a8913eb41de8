/* gl_morph_gather.c: the path gather, which sums without blending.
 *
 * Each vertex that any target moves has a list of its delta texels in target order. The lists lie one behind another,
 * as the rows of a sparse matrix in compressed-row form: those of vertex v are entries starts[v] to starts[v + 1] - 1.
 * One fragment per vertex walks its list, adds delta * weight in registers, and writes the three layers once. The
 * additions are those of the CPU in the same order, so the bits are the same. Every entry is read whatever its weight
 * is, so the cost does not depend on how many targets are active. */
#include <string.h>

#include "gl/gl_morph_internal.h"
#include "gl/gl_program.h"
#include "light/transfer_internal.h"
#include "shaders.gen.h"

/* ---- making ---- */

static noh_result create_program(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    static const char *const samplers[] = { "u_entries", "u_starts", "u_records" };
    static const char *const defines[2][2][2] = {
        { { NULL, "#define OCCLUSION\n" }, { "#define LAYERS_UINT\n", "#define LAYERS_UINT\n#define OCCLUSION\n" } },
        { { "#define TWO_LAYERS\n", "#define TWO_LAYERS\n#define OCCLUSION\n" },
          { "#define LAYERS_UINT\n#define TWO_LAYERS\n",
            "#define LAYERS_UINT\n#define TWO_LAYERS\n#define OCCLUSION\n" } }
    };
    noh_gl_program_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.name = "gather";
    desc.vertex = &noh_shader_morph_gather_vert;
    desc.fragment = &noh_shader_morph_gather_frag;
    desc.samplers = samplers;
    desc.sampler_count = 3;
    desc.defines = defines[m->plan.layer_count == 2u][m->plan.layer_format == GL_RGBA32UI][m->plan.occlusion];
    desc.ledger = m->ledger;
    return noh_gl_program_create(m->gl, &desc, &m->program, log, log_bytes, error);
}

typedef void (*visit_pair)(void *context, uint32_t vertex, uint32_t target, const uint32_t words[3]);

/* Visit every delta texel that is not zero, targets in index order. */
static void visit_pairs(const noh_mesh *mesh, visit_pair visit, void *context)
{
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const noh_rect *rect = mesh->rects + mesh->targets[t].first_rect;
        const uint32_t *words = mesh->texels + 3u * (size_t)mesh->targets[t].first_texel;
        for (uint32_t r = 0; r < mesh->targets[t].rect_count; r++, rect++) {
            for (uint32_t y = rect->y; y < (uint32_t)rect->y + rect->h; y++) {
                uint32_t vertex = (y << mesh->header->morph_width_log2) + rect->x;
                for (uint32_t x = 0; x < rect->w; x++, words += 3) {
                    if (words[0] | words[1] | words[2]) {
                        visit(context, vertex + x, t, words);
                    }
                }
            }
        }
    }
}

static void count_pair(void *context, uint32_t vertex, uint32_t target, const uint32_t words[3])
{
    (void)target;
    (void)words;
    ((uint32_t *)context)[vertex + 1u] += 1u;
}

typedef struct chunk_filler {
    uint32_t *cursors;      /* [touched] the next entry of each vertex */
    uint32_t first;         /* the entry that the chunk begins with */
    uint32_t (*entries)[4]; /* [NOH_GATHER_CHUNK] */
    const noh_mesh *mesh;
} chunk_filler;

static void fill_pair(void *context, uint32_t vertex, uint32_t target, const uint32_t words[3])
{
    chunk_filler *f = (chunk_filler *)context;
    uint32_t at = f->cursors[vertex]++ - f->first; /* an entry before the chunk wraps to a large number */
    if (at < NOH_GATHER_CHUNK) {
        memcpy(f->entries[at], words, 12);
        f->entries[at][3] = target;
        if (f->mesh->transfer) {
            const uint32_t texel = (uint32_t)((size_t)(words - f->mesh->texels) / 3u);
            f->entries[at][3] |= (uint32_t)noh_transfer_delta(f->mesh, texel) << 24;
        }
    }
}

/* Where each vertex's entries begin, into the staging memory. */
static uint32_t *find_starts(noh_gl_morph *m, const noh_gl_morph_mesh *to, const noh_mesh *mesh)
{
    const uint32_t touched = mesh->header->touched_count;
    uint32_t *starts = (uint32_t *)m->staging;
    memset(starts, 0, sizeof *starts * (touched + 1u));
    visit_pairs(mesh, count_pair, starts);
    starts[0] = to->first_pair;
    for (uint32_t v = 1; v <= touched; v++) {
        starts[v] += starts[v - 1];
    }
    return starts;
}

/* Numbers from..from+count-1 in front of the starts: of the last target first. */
static void upload_ratios(noh_gl_morph *m, const noh_gl_morph_mesh *to, const noh_mesh *mesh, uint32_t from,
                          uint32_t count)
{
    float ratios[64];
    const uint32_t ratio_count = mesh->header->target_count;
    for (uint32_t done = 0; done < count;) {
        const uint32_t at = from + done, left = count - done, now = left < 64u ? left : 64u;
        for (uint32_t i = 0; i < now; i++) ratios[i] = noh_transfer_ratio(mesh, ratio_count - 1u - (at + i));
        noh_gl_table_upload(m->gl, &m->rects, to->first_start - ratio_count + at, now, ratios);
        done += now;
    }
}

/* Turn rectangles by target into lists by vertex: a counting sort in fixed memory. The first walk over the mesh counts
 * each vertex's entries, and their running sum gives the starts. A copy of the starts, as cursors, then gives each
 * delta texel its place. Only NOH_GATHER_CHUNK entries fit into the staging memory, so this walk is repeated for each
 * chunk and keeps the entries that fall into it. Targets are visited in index order, so each list is in target order.
 * Ratios are counted first, with occlusion, then starts, then entries. to: whose part of the tables they belong to.
 * Returns 1 once all are there. */
static int fill(noh_gl_morph *m, const noh_gl_morph_mesh *to, const noh_mesh *mesh, uint32_t *at, uint32_t *bytes)
{
    const uint32_t ratios = noh_gl_morph_ratio_count(mesh->header, m->plan.occlusion);
    const uint32_t own = mesh->header->touched_count + 1u, first = ratios + own;
    const uint32_t all = first + mesh->header->pair_count;
    uint32_t *starts = find_starts(m, to, mesh);
    chunk_filler f;
    f.cursors = starts + own;
    f.entries = (uint32_t(*)[4])(void *)(f.cursors + own);
    f.mesh = mesh;
    if (*at < ratios) {
        const uint32_t fit = *bytes / 4u, count = fit < ratios - *at ? fit : ratios - *at;
        upload_ratios(m, to, mesh, *at, count);
        *at += count;
        *bytes -= 4u * count;
    }
    if (*at >= ratios && *at < first) {
        const uint32_t fit = *bytes / 4u, count = fit < first - *at ? fit : first - *at;
        noh_gl_table_upload(m->gl, &m->rects, to->first_start + *at - ratios, count, starts + *at - ratios);
        *at += count;
        *bytes -= 4u * count;
    }
    while (*at >= first && *at < all && *bytes >= 16u) {
        uint32_t count = *bytes / 16u < all - *at ? *bytes / 16u : all - *at;
        count = count < NOH_GATHER_CHUNK ? count : NOH_GATHER_CHUNK;
        memcpy(f.cursors, starts, sizeof *starts * own);
        f.first = to->first_pair + *at - first;
        visit_pairs(mesh, fill_pair, &f);
        noh_gl_table_upload(m->gl, &m->deltas, f.first, count, f.entries);
        *at += count;
        *bytes -= 16u * count;
    }
    return *at == all;
}

int noh_gl_morph_fill_gather(noh_gl_morph *m, const noh_mesh *from, uint32_t *at, uint32_t *bytes)
{
    return fill(m, &m->meshes[m->meshes[0].owner], from, at, bytes);
}

static noh_result create_tables(noh_gl_morph *m, noh_error *error)
{
    uint32_t starts = 0;
    noh_result result;
    for (uint32_t i = 0; i < m->table_count; i++) {
        const noh_mesh_header *h = m->meshes[i].mesh.header;
        if (m->meshes[i].owner == i) starts += noh_gl_morph_ratio_count(h, m->plan.occlusion) + h->touched_count + 1u;
    }
    result = noh_gl_table_create(m->gl, m->ledger, GL_RGBA32UI, m->plan.pair_count, &m->deltas, error);
    if (!result) {
        result = noh_gl_table_create(m->gl, m->ledger, GL_R32UI, starts, &m->rects, error);
    }
    for (uint32_t i = 0; !result && i < m->table_count; i++) {
        uint32_t at = 0, bytes = UINT32_MAX;
        if (noh_gl_morph_is_there(m, i)) (void)fill(m, &m->meshes[i], &m->meshes[i].mesh, &at, &bytes);
    }
    return result ? result
                  : noh_gl_error_check(m->gl, "the driver refuses the delta texels", m->plan.delta_bytes, error);
}

noh_result noh_gl_morph_init_gather(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    noh_result result = create_program(m, log, log_bytes, error);
    if (!result) result = noh_gl_morph_framebuffer(m, NOH_LAYERS_ALL, &m->framebuffers[0], error);
    if (!result) result = create_tables(m, error);
    if (!result) result = noh_gl_morph_stream(m, "a_tile", 4, GL_UNSIGNED_INT, error);
    if (!result) noh_gl_morph_constants(m);
    return result;
}

/* ---- updating ---- */

/* The weights of all targets of an instance, and its tile. The lists may belong to a finer LOD level and name targets
 * that this level leaves out: those get the weight 0. */
static void list_instance(noh_gl_morph *m, uint32_t instance, uint32_t *tile, noh_gl_morph_stats *stats)
{
    const noh_mesh mesh = noh_gl_morph_view(m, instance);
    const noh_mesh_header *h = mesh.header;
    uint32_t first = noh_gl_morph_first_weight(m, instance), x, y;
    for (uint32_t t = 0; t < h->target_count; t++) {
        const noh_target *target = &mesh.targets[t];
        const float weight = target->rect_count ? m->weights[first + t] : 0.0f;
        noh_gl_morph_put_record(m->records + 4u * (size_t)(first + t), target, weight,
                                noh_gl_morph_target_bits(target));
        stats->targets += weight != 0.0f;
    }
    noh_gl_morph_tile(m, instance, &x, &y);
    tile[0] = x | y << 16;
    tile[1] = first;
    tile[2] = noh_gl_morph_tables(m, instance)->first_start;
    tile[3] = h->touched_count | h->morph_width_log2 << 24;
    stats->pairs += h->pair_count;
    stats->texels += h->touched_count;
    stats->rects += 1;
    noh_gl_table_upload(m->gl, &m->record_table, first, h->target_count, m->records + 4u * (size_t)first);
}

void noh_gl_morph_update_gather(noh_gl_morph *m, noh_gl_morph_stats *stats)
{
    uint32_t tiles = 0;
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        if (m->dirty[i] && noh_gl_morph_view(m, i).header->touched_count) {
            list_instance(m, i, (uint32_t *)m->staging + 4u * (size_t)tiles, stats);
            tiles += 1;
        }
    }
    if (!tiles) {
        return;
    }
    m->gl->BindBuffer(GL_ARRAY_BUFFER, m->stream.name);
    m->gl->BufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)(16u * (size_t)tiles), m->staging);
    m->gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    noh_gl_morph_begin(m);
    m->gl->BindFramebuffer(GL_FRAMEBUFFER, m->framebuffers[0]);
    m->gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)tiles);
    stats->draws += 1;
    noh_gl_morph_end(m);
}
