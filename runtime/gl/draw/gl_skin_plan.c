/* gl_skin_plan.c: the layout and exact size of palettes.
 *
 * Palettes are stored mesh by mesh and instance by instance, each at a multiple of the alignment: one row in a texture,
 * the GPU's offset alignment in a uniform buffer, where each palette is bound as a range of its own. In a texture, an
 * instance of a crowd starts with four rows of its own, or five if its mesh has wrinkle regions. With motion the same
 * rows of the last frame follow. The row of user values is the last. */
#include <string.h>

#include "gl/device/gl_quirks_internal.h"
#include "gl/draw/gl_skin_internal.h"
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

NOH_STATIC_ASSERT(NOH_PALETTE_JOINTS_MAX == 256u, palette_block_of_common_skin);

#define WIDTH_LOG2_MIN 6u
#define SIDE_OF_ES3 2048u /* ES 3.0 guarantees this texture size */

static uint32_t count_of(const noh_gl_skin_desc *desc, uint32_t mesh)
{
    return desc->instance_counts ? desc->instance_counts[mesh] : 1u;
}

static noh_result check_desc(const noh_gl_skin_desc *desc, noh_error *error)
{
    uint64_t instances = 0;
    if (!desc->meshes || !desc->mesh_count) {
        return noh_fail(error, NOH_ERR_ARG, "skin desc: meshes is NULL, or mesh_count is 0", 0, 0);
    }
    if ((unsigned)desc->mode > NOH_PALETTE_TEXTURE) {
        return noh_fail(error, NOH_ERR_ARG, "skin desc: unknown mode", 0, 0);
    }
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        instances += count_of(desc, i);
    }
    if (!instances || instances > NOH_MORPH_INSTANCES_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "skin desc: instances must be 1 to NOH_MORPH_INSTANCES_MAX in all", 0,
                        instances);
    }
    return NOH_OK;
}

uint32_t noh_gl_joint_rows(const noh_mesh *mesh)
{
    return (mesh->header->flags & NOH_MESH_DUAL_QUATERNION) ? 4u : 3u;
}

/* The bytes of the largest palette_block that a mesh of the desc needs. ES 3.0 guarantees 16 KiB. */
static uint32_t block_bytes(const noh_gl_skin_desc *desc)
{
    uint32_t rows = 3;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        uint32_t own = noh_gl_joint_rows(&desc->meshes[i]);
        rows = own > rows ? own : rows;
    }
    return 16u * rows * NOH_PALETTE_JOINTS_MAX;
}

static noh_result choose_mode(const noh_gl_skin_desc *desc, const noh_gl_caps *caps, noh_gl_skin_plan *plan,
                              noh_error *error)
{
    uint32_t block = block_bytes(desc);
    const noh_gl_quirk *dear = noh_gl_quirk_find(caps->renderer, NOH_QUIRK_BLOCK_DEAR);
    int fits = caps->uniform_block_bytes_max >= block, several = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        several |= count_of(desc, i) > 1u;
    }
    if (desc->mode == NOH_PALETTE_UNIFORM && !fits) {
        return noh_fail(error, NOH_ERR_UNSUPPORTED, "uniform blocks of this GPU are smaller than a palette",
                        caps->uniform_block_bytes_max, block);
    }
    plan->mode = desc->mode ? desc->mode : several || !fits || dear ? NOH_PALETTE_TEXTURE : NOH_PALETTE_UNIFORM;
    plan->reason = desc->mode ? "chosen by the desc"
                   : several  ? "a mesh has several instances, which one draw can contain"
                   : !fits    ? "uniform blocks of this GPU are smaller than a palette"
                   : dear     ? dear->reason
                              : "one instance of each mesh";
    return NOH_OK;
}

uint32_t noh_gl_skin_align(const noh_gl_skin_plan *plan, const noh_gl_caps *caps)
{
    uint32_t bytes = caps->uniform_offset_align ? caps->uniform_offset_align : 256u; /* the most that ES 3.0 allows */
    return plan->mode == NOH_PALETTE_TEXTURE ? 1u : (bytes + 15u) / 16u;
}

/* The narrowest texture that holds the rows within the maximum height: up to 2048 x 2048, which ES 3.0 guarantees, then
 * up to the limits of this GPU. */
static noh_result shape_texture(uint64_t rows, uint32_t side_max, noh_gl_skin_plan *plan, noh_error *error)
{
    uint32_t log2 = WIDTH_LOG2_MIN;
    uint64_t height = (rows + 63u) >> log2;
    while (height > (log2 < 11u && side_max > SIDE_OF_ES3 ? SIDE_OF_ES3 : side_max) && 2u << log2 <= side_max) {
        log2++;
        height = (rows + (1u << log2) - 1u) >> log2;
    }
    if (height > side_max) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "the palettes of the instances do not fit a texture of this GPU: use fewer instances", side_max,
                        height);
    }
    plan->width = 1u << log2;
    plan->height = height ? (uint32_t)height : 1u;
    return NOH_OK;
}

uint32_t noh_gl_crowd_rows(const noh_mesh *mesh)
{
    noh_wrinkles wrinkles;
    if (!mesh->pack || noh_wrinkles_of(mesh, &wrinkles, NULL) != NOH_OK) return NOH_CROWD_ROWS;
    return wrinkles.colors ? NOH_CROWD_COLORS + 1u : NOH_CROWD_REGIONS + 1u;
}

uint32_t noh_gl_palette_row(const noh_gl_skin_binding *binding, const noh_mesh *mesh, uint32_t palette)
{
    NOH_ASSERT(binding->align && palette <= mesh->header->palette_count);
    uint32_t row = binding->mode == NOH_PALETTE_TEXTURE ? noh_gl_crowd_rows(mesh) : 0;
    for (uint32_t i = 0; i < palette; i++) {
        row += (noh_gl_joint_rows(mesh) * mesh->palettes[i].joint_count + binding->align - 1u) / binding->align *
               binding->align;
    }
    return row;
}

uint64_t noh_gl_skin_layout(const noh_gl_skin_desc *desc, noh_palette_mode mode, uint32_t align,
                            noh_gl_skin_mesh *meshes)
{
    const noh_gl_skin_binding shape = { .mode = mode, .align = align };
    const uint32_t user_rows = desc->user_values && mode == NOH_PALETTE_TEXTURE;
    const uint32_t frames = desc->motion && mode == NOH_PALETTE_TEXTURE ? 2u : 1u;
    uint64_t row = 0;
    uint32_t instance = 0, kept = 0;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const uint32_t count = count_of(desc, i),
                       own = noh_gl_palette_row(&shape, &desc->meshes[i], desc->meshes[i].header->palette_count),
                       stride = frames * own + user_rows;
        if (meshes) {
            meshes[i].mesh = desc->meshes[i];
            meshes[i].instance_count = count;
            meshes[i].first_instance = instance;
            meshes[i].first_row = (uint32_t)row;
            meshes[i].stride = stride;
            meshes[i].before_row = frames == 2u ? own : 0;
            meshes[i].first_kept = kept;
        }
        kept += count * own;
        row += (uint64_t)count * stride;
        instance += count;
    }
    return row;
}

void noh_gl_skin_carve(noh_arena *arena, uint32_t mesh_count, const noh_gl_skin_plan *plan, noh_gl_skin *skin)
{
    size_t rows = plan->mode == NOH_PALETTE_TEXTURE ? (size_t)plan->width * plan->height : plan->texel_count;
    void *meshes = noh_arena_carve(arena, sizeof *skin->meshes * mesh_count, 16);
    void *staging = noh_arena_carve(arena, 16u * rows, 16);
    void *kept = noh_arena_carve(arena, 16u * (size_t)plan->kept_count, 16);
    if (skin) {
        skin->meshes = (noh_gl_skin_mesh *)meshes;
        skin->rows = (float *)staging;
        skin->kept = plan->kept_count ? (float *)kept : NULL;
    }
}

static void set_bytes(const noh_gl_skin_desc *desc, noh_gl_skin_plan *plan)
{
    noh_arena arena = noh_arena_measure();
    noh_arena_carve(&arena, sizeof(noh_gl_skin), 16);
    noh_gl_skin_carve(&arena, desc->mesh_count, plan, NULL);
    plan->cpu_bytes = arena.used;
    if (plan->mode == NOH_PALETTE_TEXTURE) {
        plan->gpu_bytes = 16u * (uint64_t)plan->width * plan->height;
    } else if (plan->texel_count) { /* a whole block is bound at the start of every palette, the last one included */
        plan->gpu_bytes = 16u * (uint64_t)plan->texel_count + block_bytes(desc);
    }
}

noh_result noh_gl_skin_plan_make(const noh_gl_skin_desc *desc, const noh_gl_caps *caps, noh_gl_skin_plan *plan,
                                 noh_error *error)
{
    noh_gl_skin_plan p;
    uint64_t rows;
    noh_result result;
    NOH_ASSERT(desc && caps && plan);
    result = check_desc(desc, error);
    memset(&p, 0, sizeof p);
    if (!result) {
        result = choose_mode(desc, caps, &p, error);
    }
    if (result) {
        return result;
    }
    rows = noh_gl_skin_layout(desc, p.mode, noh_gl_skin_align(&p, caps), NULL);
    if (rows > NOH_SKIN_ROWS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "the palettes of the instances have more rows than the limit: use fewer instances",
                        NOH_SKIN_ROWS_MAX, rows);
    }
    if (p.mode == NOH_PALETTE_TEXTURE) {
        result = shape_texture(rows, caps->texture_size_max, &p, error);
    }
    if (result) {
        return result;
    }
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        p.instance_count += count_of(desc, i);
    }
    if (desc->motion && p.mode == NOH_PALETTE_TEXTURE) {
        p.kept_count = (uint32_t)(rows - (desc->user_values ? p.instance_count : 0)) / 2u;
    }
    p.texel_count = (uint32_t)rows;
    set_bytes(desc, &p);
    *plan = p;
    return NOH_OK;
}
