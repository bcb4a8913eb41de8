/* crowd_plan.c: every byte of a crowd, before it is made.
 *
 * Bodies are spread evenly over a disc, so that the share of bodies within a distance is the share of the area. The
 * distance at which a level's error reaches the allowed pixels gives the number of bodies that may need a finer level
 * at once, and with a reserve the slots of each pool. */
#include <string.h>

#include "crowd.h"
#include "cli/message.h"

#define RESERVE 1.25       /* slots over those of an even spread: a factor, */
#define RESERVE_BODIES 4.0 /* and a number of bodies */
#define ENTERED \
    0.21 /* share of the allowed error at which a level is entered: that of meshes in lod.h, less hysteresis */
#define BODY_RADIUS_M 1.5 /* from a body's place to its nearest point, roughly */

/* The skinned mesh with the most pairs. */
static int find_mesh(crowd_plan *p, const pack_file *file)
{
    int found = 0;
    for (uint32_t i = 0; i < file->pack.mesh_count; i++) {
        noh_mesh mesh;
        noh_skin skin;
        noh_pack_mesh_at(&file->pack, i, &mesh, NULL);
        if (noh_pack_skin_at(&file->pack, mesh.header->skin, &skin, NULL) == NOH_OK &&
            (!found || mesh.header->pair_count > p->mesh.header->pair_count)) {
            found = 1;
            p->mesh = mesh;
            p->mesh_index = i;
            p->skin = skin;
            p->level_count = mesh.header->level_count;
        }
    }
    return found ? 0 : tool_fail(file->path, "a crowd needs a skinned mesh, and the pack has none");
}

/* ---- clips ---- */

/* The bank's bytes. Every segment of every clip stays decoded, since a thousand bodies play all of them. */
static int measure_bank(crowd_plan *p, const pack_file *file)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    uint32_t segments = 0;
    for (uint32_t i = 0; i < file->pack.clip_count; i++) {
        noh_pack_clip clip;
        noh_clip_info info;
        int status = tool_clip_info(file, i, &clip, &info);
        if (status) {
            return status;
        }
        segments += info.segment_count;
    }
    p->bank_desc.clips = &file->pack;
    p->bank_desc.skeleton = p->skin.header->skeleton;
    p->bank_desc.cached_segment_count = segments < NOH_CLIP_CACHE_SEGMENTS_MIN ? NOH_CLIP_CACHE_SEGMENTS_MIN : segments;
    p->bank_desc.root_axes = NOH_ROOT_X | NOH_ROOT_Z; /* bodies stay in place */
    p->bank_desc.root_up = 1;
    return noh_clip_bank_measure(&p->bank_desc, &p->bank_needs, &error) ? tool_fail_error(file->path, &error) : 0;
}

noh_character_desc crowd_character_desc(const noh_clip_set *set)
{
    noh_character_desc d;
    memset(&d, 0, sizeof d);
    d.controller.set = set;
    d.controller.track_count = 2;
    return d;
}

/* ---- pools ---- */

/* The largest error of a level, metres, as the LOD table has it. */
static float level_error(const noh_mesh *level)
{
    const noh_mesh_header *h = level->header;
    float worst = h->level_error_rest;
    worst = h->level_error_targets > worst ? h->level_error_targets : worst;
    worst = h->level_error_pairs > worst ? h->level_error_pairs : worst;
    worst = h->level_error_clip > worst ? h->level_error_clip : worst;
    return (worst + h->level_skipped) * h->world_scale;
}

/* The number of bodies that may need a finer level than this one. */
static double count_within(const crowd_plan *p, uint32_t level)
{
    const crowd_options *o = &p->options;
    const noh_mesh view = noh_mesh_at_lod(&p->mesh, level);
    double scale = ENTERED * (double)o->pixels / (double)level_error(&view);
    double distance_m = (double)noh_lod_scale(1.0f, o->field_of_view_rad, o->height) / scale + BODY_RADIUS_M;
    double share = distance_m / CROWD_FIELD_M;
    return share < 1.0 ? RESERVE * o->count * share * share + RESERVE_BODIES : o->count;
}

static void add_pool(crowd_plan *p, uint32_t level, uint32_t slots)
{
    if (slots) {
        p->pool_levels[p->pool_count] = level;
        p->views[p->pool_count] = noh_mesh_at_lod(&p->mesh, level);
        p->slots[p->pool_count++] = slots;
    }
}

/* A pool for each level, with as many slots in all as there are bodies. */
static void plan_pools(crowd_plan *p)
{
    const crowd_options *o = &p->options;
    const uint32_t first = p->mesh.header->level_first;
    uint32_t given = 0, taken = 0;
    for (uint32_t i = first; i < p->level_count; i++) {
        given += o->slots[i];
    }
    if (o->plain) {
        add_pool(p, first, o->count);
        return;
    }
    for (uint32_t i = first; i < p->level_count; i++) {
        double need = i + 1u < p->level_count ? count_within(p, i + 1u) : o->count;
        uint32_t within = need < o->count ? (uint32_t)need : o->count;
        add_pool(p, i, given ? o->slots[i] : within > taken ? within - taken : 0);
        taken = within > taken ? within : taken;
    }
}

noh_lod_pools_desc crowd_pools_desc(const crowd_plan *p)
{
    noh_lod_pools_desc d;
    d.instance_count = p->options.count;
    d.pool_count = p->pool_count;
    d.levels = p->pool_levels;
    d.slot_counts = p->slots;
    return d;
}

/* ---- bytes ---- */

static void *carve(noh_arena *arena, size_t count, size_t bytes)
{
    return noh_arena_carve(arena, count * bytes, 16);
}

noh_lod_pack_desc crowd_lod_desc(const crowd_plan *p, const noh_clip_bank *bank)
{
    const noh_lod_pack_desc desc = { bank, &p->bank_desc, &p->mesh, NULL };
    return desc;
}

void crowd_carve(noh_arena *a, const crowd_plan *p, crowd *c, crowd_parts *parts)
{
    const noh_clip_set *shape = &p->bank_needs.shape;
    const size_t joints = shape->joint_count, targets = p->mesh.header->target_count, count = p->options.count;
    parts->bank = carve(a, 1, p->bank_needs.bytes);
    parts->scratch = carve(a, 1, p->scratch_bytes);
    parts->pools = carve(a, 1, p->pools_bytes);
    parts->schedule = carve(a, 1, p->schedule_bytes);
    parts->lod = carve(a, 1, p->lod_bytes);
    parts->morph = carve(a, 1, (size_t)p->morph.cpu_bytes);
    parts->palettes = carve(a, 1, (size_t)p->skin_plan.cpu_bytes);
    c->characters = carve(a, count, p->character_bytes);
    c->bodies = carve(a, count, sizeof *c->bodies);
    c->order = carve(a, count, sizeof *c->order);
    c->clips = carve(a, shape->clip_count, sizeof *c->clips);
    c->keys = carve(a, 2u * (size_t)shape->clip_count, sizeof *c->keys);
    c->update_error_m = carve(a, shape->clip_count, NOH_UPDATE_RATE_COUNT * sizeof(float));
    c->inverse_bind = carve(a, joints, 12u * sizeof(float));
    c->matrices = carve(a, p->skin.header->joint_count, 12u * sizeof(float));
    c->floats = carve(a, shape->float_count, sizeof(float));
    c->weights = carve(a, targets, sizeof(float));
    c->pictures = carve(a, p->mesh.pack->texture_count, sizeof *c->pictures);
}

static void sum_bytes(crowd_plan *p)
{
    noh_arena arena = noh_arena_measure();
    crowd measured;
    crowd_parts parts;
    crowd_carve(&arena, p, &measured, &parts);
    p->cpu_bytes = arena.used;
    p->gpu_bytes = noh_gl_mesh_bytes(&p->views[0]) + p->morph.gpu_bytes + p->skin_plan.gpu_bytes +
                   NOH_GL_RENDERER_BYTES;
    for (uint32_t i = 0; i < p->mesh.pack->texture_count; i++) {
        noh_texture texture;
        noh_pack_texture_at(p->mesh.pack, i, &texture, NULL);
        p->gpu_bytes += noh_gl_picture_bytes(&texture);
    }
}

/* ---- all of it ---- */

static int fill_options(crowd_plan *p, const crowd_options *o)
{
    p->options = *o;
    p->options.pixels = o->pixels > 0.0f ? o->pixels : 1.0f;
    p->options.budget_ns = o->budget_ns ? o->budget_ns : UINT64_MAX;
    p->options.field_of_view_rad = o->field_of_view_rad > 0.0f ? o->field_of_view_rad : 0.69813f;
    p->options.width = o->width ? o->width : 1280u;
    p->options.height = o->height ? o->height : 720u;
    return o->count && o->count <= NOH_MORPH_INSTANCES_MAX
               ? 0
               : tool_fail("crowd", "a crowd has from 1 to %u bodies", NOH_MORPH_INSTANCES_MAX);
}

/* The bank does not exist yet; its counts suffice. */
static size_t ask_lod(const crowd_plan *p)
{
    noh_clip_bank counts;
    noh_lod_pack_desc desc;
    memset(&counts, 0, sizeof counts);
    counts.clips = p->bank_needs.shape;
    counts.skeleton.joint_count = p->bank_needs.shape.joint_count;
    desc = crowd_lod_desc(p, &counts);
    return noh_lod_pack_size(&desc);
}

/* The sizes of the library's objects. */
static int ask_sizes(crowd_plan *p, const pack_file *file, const noh_gl_caps *caps)
{
    const noh_character_desc character = crowd_character_desc(&p->bank_needs.shape);
    const noh_lod_pools_desc pools = crowd_pools_desc(p);
    noh_gl_skin_desc skin = { &p->mesh, 1, &p->options.count, NOH_PALETTE_TEXTURE };
    noh_error error = { NOH_OK, "", 0, 0 };
    p->morph_desc.meshes = p->views;
    p->morph_desc.mesh_count = p->pool_count;
    p->morph_desc.instance_counts = p->slots;
    p->character_bytes = noh_character_size(&character);
    p->scratch_bytes = noh_character_scratch_size(&character);
    p->pools_bytes = noh_lod_pools_size(&pools);
    p->schedule_bytes = noh_schedule_size(p->options.count);
    p->lod_bytes = ask_lod(p);
    if (!p->pools_bytes) {
        return tool_fail(file->path, "the pools of a crowd need as many slots as it has bodies");
    }
    if (noh_gl_morph_plan_make(&p->morph_desc, caps, &p->morph, &error) ||
        noh_gl_skin_plan_make(&skin, caps, &p->skin_plan, &error)) {
        return tool_fail_error(file->path, &error);
    }
    return 0;
}

int crowd_plan_make(crowd_plan *p, const pack_file *file, const noh_gl_caps *caps, const crowd_options *options)
{
    int status;
    memset(p, 0, sizeof *p);
    status = fill_options(p, options);
    if (!status) status = find_mesh(p, file);
    if (!status) status = measure_bank(p, file);
    if (!status) {
        plan_pools(p);
        status = ask_sizes(p, file, caps);
    }
    if (!status) sum_bytes(p);
    return status;
}
