/* gl_morph_blend.c: the paths layered, mrt and per-layer, in which the GPU's blending adds.
 *
 * Each rectangle of an active target is drawn as a quad over its place in the instance's tile, with blending ONE, ONE.
 * The fragment decodes the delta texel under it and multiplies it by weight and scale. Alpha plays no part, so weights
 * below 0 and above 1 work. All quads of all instances are one instanced draw.
 *
 * Why the bits are those of the CPU: blending happens in the order in which primitives are submitted (OpenGL ES 3.2,
 * 2.1), and quads are submitted target by target in index order, as deform/morph.h adds. Each sum therefore has the
 * same terms in the same order, and the same bits wherever the blender adds in float32.
 *
 * Microsoft's SparseMorphTargets sample (DirectX SDK) draws targets additively, each cut to what it changes, through a
 * geometry shader that sends a triangle to three render targets. It blends by source alpha and starts from the base
 * mesh. Here only deltas are summed, so a half-float accumulator never rounds the base. */
#include <string.h>

#include "gl/gl_debug.h"
#include "gl/gl_morph_internal.h"
#include "gl/gl_program.h"
#include "light/transfer_internal.h"
#include "shaders.gen.h"

/* ---- making ---- */

/* Of what is drawn in a pass, of two layers, of occlusion. */
#define DEFINES_OF(pass)                                                                \
    {                                                                                   \
        { pass, pass "#define OCCLUSION\n" },                                           \
        {                                                                               \
            pass "#define TWO_LAYERS\n", pass "#define TWO_LAYERS\n#define OCCLUSION\n" \
        }                                                                               \
    }

static noh_result create_program(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    static const char *const samplers[] = { "u_deltas", "u_rects", "u_records" };
    static const char *const defines[3][2][2] = { DEFINES_OF(""), DEFINES_OF("#define MORPH_MRT\n"),
                                                  DEFINES_OF("#define MORPH_LAYERED\n") };
    const int pass = m->plan.path == NOH_MORPH_MRT ? 1 : m->plan.path == NOH_MORPH_LAYERED ? 2 : 0;
    noh_gl_program_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.name = noh_morph_path_name(m->plan.path);
    desc.vertex = &noh_shader_morph_rect_vert;
    desc.fragment = &noh_shader_morph_one_frag;
    desc.samplers = samplers;
    desc.sampler_count = 3;
    desc.ledger = m->ledger;
    desc.defines = defines[pass][m->plan.layer_count == 2u][m->plan.occlusion];
    if (m->plan.path == NOH_MORPH_MRT) {
        desc.fragment = &noh_shader_morph_mrt_frag;
    } else if (m->plan.path == NOH_MORPH_LAYERED) {
        desc.geometry = &noh_shader_morph_layered_geom;
        desc.version = noh_gl_geometry_version(m->gl);
        desc.geometry_defines = noh_gl_geometry_defines(m->gl);
    }
    return noh_gl_program_create(m->gl, &desc, &m->program, log, log_bytes, error);
}

static noh_result create_framebuffers(noh_gl_morph *m, noh_error *error)
{
    noh_result result = NOH_OK;
    if (m->plan.path == NOH_MORPH_MRT) {
        return noh_gl_morph_framebuffer(m, NOH_LAYERS_ALL, &m->framebuffers[0], error);
    }
    if (m->plan.path == NOH_MORPH_LAYERED) {
        return noh_gl_morph_framebuffer(m, NOH_LAYERS_LAYERED, &m->framebuffers[0], error);
    }
    for (int layer = 0; layer < (int)m->plan.layer_count && !result; layer++) {
        result = noh_gl_morph_framebuffer(m, layer, &m->framebuffers[layer], error);
    }
    return result;
}

/* Rectangles first..first+count-1 of all targets: place, size, first delta texel, and the bit widths of a texel's
 * fields. The staging memory holds NOH_RECT_CHUNK of them. to: whose part of the tables they belong to. */
static void upload_rects(noh_gl_morph *m, const noh_gl_morph_mesh *to, const noh_mesh *mesh, uint32_t first,
                         uint32_t count)
{
    uint32_t(*chunk)[4] = (uint32_t(*)[4])m->staging;
    uint32_t at = 0, texel = to->first_texel;
    for (uint32_t t = 0; t < mesh->header->target_count && at < first + count; t++) {
        const noh_target *target = &mesh->targets[t];
        for (uint32_t r = 0; r < target->rect_count; r++, at++) {
            const noh_rect *rect = &mesh->rects[target->first_rect + r];
            if (at >= first && at < first + count) {
                uint32_t *words = chunk[at - first];
                words[0] = rect->x | (uint32_t)rect->y << 16;
                words[1] = rect->w | (uint32_t)rect->h << 16;
                words[2] = texel;
                words[3] = noh_gl_morph_target_bits(target);
            }
            texel += (uint32_t)rect->w * rect->h;
        }
    }
    noh_gl_table_upload(m->gl, &m->rects, to->first_rect + first, count, m->staging);
}

/* Delta texels of a target with what they change of occlusion, through the staging memory. */
static void upload_wide(noh_gl_morph *m, const noh_mesh *mesh, uint32_t target, uint32_t texel, uint32_t to,
                        uint32_t count)
{
    uint32_t(*chunk)[4] = (uint32_t(*)[4])m->staging;
    const float ratio = noh_transfer_ratio(mesh, target);
    while (count) {
        const uint32_t now = count < NOH_RECT_CHUNK ? count : NOH_RECT_CHUNK;
        for (uint32_t i = 0; i < now; i++) {
            const float change = (float)noh_transfer_delta(mesh, texel + i) * ratio;
            memcpy(chunk[i], mesh->texels + 3u * (size_t)(texel + i), 12);
            memcpy(&chunk[i][3], &change, 4);
        }
        noh_gl_table_upload(m->gl, &m->deltas, to, now, chunk);
        texel += now;
        to += now;
        count -= now;
    }
}

/* Delta texels first..first+count-1 of all targets, without gaps. (A coarser LOD level uses only the first texels of
 * each target.) */
static void upload_texels(noh_gl_morph *m, const noh_gl_morph_mesh *to, const noh_mesh *mesh, uint32_t first,
                          uint32_t count)
{
    uint32_t begin = 0;
    for (uint32_t t = 0; t < mesh->header->target_count && count; t++) {
        const noh_target *target = &mesh->targets[t];
        const uint32_t skip = first - begin, left = skip < target->texel_count ? target->texel_count - skip : 0;
        const uint32_t now = left < count ? left : count;
        if (now && m->plan.occlusion) {
            upload_wide(m, mesh, t, target->first_texel + skip, to->first_texel + first, now);
        } else if (now) {
            noh_gl_table_upload(m->gl, &m->deltas, to->first_texel + first, now,
                                mesh->texels + 3u * ((size_t)target->first_texel + skip));
        }
        begin += target->texel_count;
        first += now;
        count -= now;
    }
}

/* Delta texels are counted first, then rectangles. Returns 1 once all are there. */
static int fill(noh_gl_morph *m, const noh_gl_morph_mesh *to, const noh_mesh *mesh, uint32_t *at, uint32_t *bytes)
{
    const uint32_t texels = mesh->header->texel_count, all = texels + mesh->header->rect_count;
    const uint32_t texel_bytes = m->plan.occlusion ? 16u : 12u;
    if (*at < texels) {
        const uint32_t fit = *bytes / texel_bytes, count = fit < texels - *at ? fit : texels - *at;
        upload_texels(m, to, mesh, *at, count);
        *at += count;
        *bytes -= texel_bytes * count;
    }
    while (*at >= texels && *at < all && *bytes >= 16u) {
        uint32_t count = *bytes / 16u < all - *at ? *bytes / 16u : all - *at;
        count = count < NOH_RECT_CHUNK ? count : NOH_RECT_CHUNK;
        upload_rects(m, to, mesh, *at - texels, count);
        *at += count;
        *bytes -= 16u * count;
    }
    return *at == all;
}

int noh_gl_morph_fill_blend(noh_gl_morph *m, const noh_mesh *from, uint32_t *at, uint32_t *bytes)
{
    return fill(m, &m->meshes[m->meshes[0].owner], from, at, bytes);
}

static noh_result create_tables(noh_gl_morph *m, noh_error *error)
{
    const GLenum format = m->plan.occlusion ? GL_RGBA32UI : GL_RGB32UI;
    noh_result result = noh_gl_table_create(m->gl, m->ledger, format, m->plan.texel_count, &m->deltas, error);
    if (!result) {
        result = noh_gl_table_create(m->gl, m->ledger, GL_RGBA32UI, m->plan.rect_count, &m->rects, error);
    }
    for (uint32_t i = 0; !result && i < m->table_count; i++) {
        const noh_gl_morph_mesh *mesh = &m->meshes[i];
        uint32_t at = 0, bytes = UINT32_MAX;
        if (noh_gl_morph_is_there(m, i)) (void)fill(m, mesh, &mesh->mesh, &at, &bytes);
    }
    return result ? result
                  : noh_gl_error_check(m->gl, "the driver refuses the delta texels", m->plan.delta_bytes, error);
}

noh_result noh_gl_morph_init_blend(noh_gl_morph *m, char *log, size_t log_bytes, noh_error *error)
{
    noh_result result = create_program(m, log, log_bytes, error);
    if (!result) result = create_framebuffers(m, error);
    if (!result) result = create_tables(m, error);
    if (!result) {
        result = noh_gl_morph_stream(m, "a_rect_record", 2, m->wide ? GL_UNSIGNED_INT : GL_UNSIGNED_SHORT, error);
    }
    if (!result) {
        noh_gl_morph_constants(m);
        m->u_layer = m->gl->GetUniformLocation(m->program, "u_layer");
    }
    return result;
}

/* ---- updating ---- */

static void put_rect_records(noh_gl_morph *m, uint32_t first_rect, uint32_t rect_count, uint32_t record,
                             uint32_t *count)
{
    if (m->wide) {
        uint32_t *to = (uint32_t *)m->staging + 2u * (size_t)*count;
        for (uint32_t r = 0; r < rect_count; r++) {
            *to++ = first_rect + r;
            *to++ = record;
        }
    } else {
        uint16_t *to = (uint16_t *)m->staging + 2u * (size_t)*count;
        for (uint32_t r = 0; r < rect_count; r++) {
            *to++ = (uint16_t)(first_rect + r);
            *to++ = (uint16_t)record;
        }
    }
    *count += rect_count;
}

/* The active targets of one instance, in index order: the order of a sum decides its last bit. The table may belong to
 * a finer LOD level, so a target's first rectangle is counted by that level's numbers. */
static void list_instance(noh_gl_morph *m, uint32_t instance, uint32_t *records, uint32_t *rect_records,
                          noh_gl_morph_stats *stats)
{
    const noh_mesh mesh = noh_gl_morph_view(m, instance);
    const noh_gl_morph_mesh *tables = noh_gl_morph_tables(m, instance);
    const float *weights = m->weights + noh_gl_morph_first_weight(m, instance);
    uint32_t x, y, first_rect = tables->first_rect;
    noh_gl_morph_tile(m, instance, &x, &y);
    for (uint32_t t = 0; t < mesh.header->target_count; first_rect += tables->mesh.targets[t++].rect_count) {
        const noh_target *target = &mesh.targets[t];
        if (weights[t] != 0.0f && target->rect_count) {
            noh_gl_morph_put_record(m->records + 4u * (size_t)*records, target, weights[t], x | y << 16);
            put_rect_records(m, first_rect, target->rect_count, *records, rect_records);
            *records += 1;
            stats->targets += 1;
            stats->rects += target->rect_count;
            stats->texels += target->texel_count;
            stats->pairs += target->pair_count;
        }
    }
}

static void clear_bound(noh_gl_morph *m)
{
    static const float zero[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
    GLint buffers = m->plan.path == NOH_MORPH_MRT ? (GLint)m->plan.layer_count
                                                  : 1; /* clearing a layered framebuffer clears all layers */
    for (GLint i = 0; i < buffers; i++) {
        m->gl->ClearBufferfv(GL_COLOR, i, zero);
    }
}

/* Clear the tiles of changed instances: the others keep their sums. */
static void clear_tiles(noh_gl_morph *m)
{
    if (m->dirty_count == m->plan.instance_count) {
        clear_bound(m);
        return;
    }
    m->gl->Enable(GL_SCISSOR_TEST);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const noh_mesh_header *h = m->dirty[i] ? noh_gl_morph_view(m, i).header : NULL;
        if (h && h->morph_height) {
            uint32_t x, y;
            noh_gl_morph_tile(m, i, &x, &y);
            m->gl->Scissor((GLint)x, (GLint)y, (GLsizei)(1u << h->morph_width_log2), (GLsizei)h->morph_height);
            clear_bound(m);
        }
    }
    m->gl->Disable(GL_SCISSOR_TEST);
}

void noh_gl_morph_update_blend(noh_gl_morph *m, noh_gl_morph_stats *stats)
{
    static const char *const pass_names[3] = { "position", "normal", "tangent" };
    uint32_t records = 0, rect_records = 0;
    int passes = m->plan.path == NOH_MORPH_PER_LAYER ? (int)m->plan.layer_count : 1;
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        if (m->dirty[i]) {
            list_instance(m, i, &records, &rect_records, stats);
        }
    }
    if (rect_records) {
        noh_gl_table_upload(m->gl, &m->record_table, 0, records, m->records);
        m->gl->BindBuffer(GL_ARRAY_BUFFER, m->stream.name);
        m->gl->BufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)((size_t)rect_records * (m->wide ? 8u : 4u)), m->staging);
        m->gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    }
    noh_gl_morph_begin(m);
    m->gl->BlendEquation(GL_FUNC_ADD);
    m->gl->BlendFunc(GL_ONE, GL_ONE);
    for (int pass = 0; pass < passes; pass++) {
        noh_gl_group_begin(m->gl, "pass", passes > 1 ? pass_names[pass] : "all layers");
        m->gl->BindFramebuffer(GL_FRAMEBUFFER, m->framebuffers[pass]);
        clear_tiles(m);
        if (rect_records) {
            m->gl->Uniform1i(m->u_layer, pass);
            m->gl->Enable(GL_BLEND);
            m->gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)rect_records);
            m->gl->Disable(GL_BLEND);
            stats->draws += 1;
        }
        noh_gl_group_end(m->gl);
    }
    noh_gl_morph_end(m);
}
