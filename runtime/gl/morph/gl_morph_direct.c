/* gl_morph_direct.c: the path direct, which keeps no sums: the vertex shader of each draw walks the lists of active
 * targets (gl_morph_lists.c) itself.
 *
 * There is no pass, and no accumulator in memory. Each draw sums again, so it is the cheapest path where few targets
 * are active and an instance is drawn once or twice a frame. An instance has a range of the table of lists that holds
 * all of its targets, and a start for each of its blocks, so changed lists leave other instances as they are. */
#include "gl/morph/gl_morph_internal.h"
#include "gl/device/gl_state_internal.h"
#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

static void upload_empty(const noh_gl_morph *m)
{
    uint32_t empty[4];
    noh_gl_morph_put_empty(empty);
    noh_gl_table_upload(m->gl, &m->record_table, 0, 1, empty);
    m->gl->BindTexture(GL_TEXTURE_2D, 0);
}

noh_result noh_gl_morph_init_direct(noh_gl_morph *m, noh_error *error)
{
    const noh_gl_morph_mesh *last = &m->meshes[m->mesh_count - 1u];
    const uint32_t entries = last->first_list + last->instance_count * last->list_count;
    uint32_t starts = last->first_start;
    noh_result result = noh_gl_table_create(m->gl, m->ledger, GL_RGBA32UI, entries, &m->record_table, error);
    if (last->mesh.header->touched_count) starts += last->instance_count * noh_gl_morph_positions(last->mesh.header);
    if (!result) result = noh_gl_table_create(m->gl, m->ledger, GL_R32UI, starts ? starts : 1u, &m->starts, error);
    if (result) return result;
    upload_empty(m);
    return noh_gl_error_check(m->gl, "the driver refused the empty list of the accumulator", 0, error);
}

/* Where an instance's starts begin, and its lists. Blocks of its mesh: as of the finest level that it may have. */
static void ranges_of(const noh_gl_morph *m, uint32_t instance, uint32_t *start, uint32_t *entry)
{
    const noh_gl_morph_mesh *mesh = &m->meshes[m->instance_mesh[instance]];
    const uint32_t i = instance - mesh->first_instance;
    *start = mesh->first_start + i * noh_gl_morph_positions(mesh->mesh.header);
    *entry = mesh->first_list + i * mesh->list_count;
}

void noh_gl_morph_set_direct(const noh_gl_morph *m, uint32_t instance, noh_gl_morph_binding *binding)
{
    uint32_t start, entry;
    ranges_of(m, instance, &start, &entry);
    binding->is_uint = NOH_LAYERS_DIRECT;
    binding->tables[0] = m->tiles.name;
    binding->tables[1] = m->record_table.texture.name;
    binding->tables[2] = m->starts.texture.name;
    binding->tile_x = (int32_t)(start & 0xffffu);
    binding->tile_y = (int32_t)(start >> 16);
    binding->width_log2 |= (int32_t)((m->record_table.width_log2 - 8u) << 4 | (m->starts.width_log2 - 8u) << 6);
}

static void update_instance(noh_gl_morph *m, uint32_t instance, noh_gl_lists *l, noh_gl_morph_stats *stats)
{
    const noh_mesh mesh = noh_gl_morph_view(m, instance);
    const uint32_t all = noh_gl_morph_positions(m->meshes[m->instance_mesh[instance]].mesh.header);
    uint32_t start, entry;
    ranges_of(m, instance, &start, &entry);
    l->first_entry = entry;
    l->entry_count = l->start_count = 0;
    if (mesh.header->touched_count) {
        (void)noh_gl_morph_count_lists(&mesh, m->weights + noh_gl_morph_first_weight(m, instance), l);
        noh_gl_morph_put_lists(m, instance, l, stats);
    }
    NOH_ASSERT(l->start_count <= all && l->entry_count <= m->batch.entries);
    while (l->start_count < all) l->starts[l->start_count++] = 0; /* of finer levels */
    noh_gl_table_put(m->gl, &m->record_table, entry, l->entry_count, l->entries);
    noh_gl_table_put(m->gl, &m->starts, start, l->start_count, l->starts);
}

void noh_gl_morph_update_direct(noh_gl_morph *m, noh_gl_morph_stats *stats)
{
    noh_gl_lists l = noh_gl_morph_lists_of(m);
    noh_gl_pixels kept;
    m->gl->ActiveTexture(GL_TEXTURE0);
    noh_gl_unpack_begin(m->gl, &kept);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const noh_gl_morph_mesh *mesh = &m->meshes[m->instance_mesh[i]];
        if (m->dirty[i] && mesh->mesh.header->touched_count) update_instance(m, i, &l, stats);
    }
    noh_gl_unpack_end(m->gl, &kept);
    noh_gl_morph_end(m, NULL);
}

void noh_gl_morph_bind(const noh_gl_api *gl, const noh_gl_morph_binding *binding)
{
    static const GLenum units[] = { GL_TEXTURE0 + NOH_UNIT_LAYERS, GL_TEXTURE0 + NOH_UNIT_LISTS,
                                    GL_TEXTURE0 + NOH_UNIT_LISTS + 1u };
    NOH_ASSERT(gl && binding);
    if (binding->texture) {
        gl->ActiveTexture(units[0]);
        gl->BindTexture(GL_TEXTURE_2D_ARRAY, binding->texture);
    }
    for (int i = 0; i < 3 && binding->tables[0]; i++) {
        gl->ActiveTexture(units[i]);
        gl->BindTexture(GL_TEXTURE_2D, binding->tables[i]);
    }
}
