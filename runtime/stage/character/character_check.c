/* character_check.c: whether a block of bytes is a character. */
#include "core/base/arena_internal.h"
#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "motion/anim/controller_internal.h"
#include "stage/character/character_internal.h"
#include "stage/character/time_lod_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_stage.h"

static const char *bad_lod(const noh_lod *d, const noh_lod_table *table)
{
    const uint32_t levels = table->mesh_level_count ? table->mesh_level_count : 1u;
    if (d->mesh >= levels || d->mesh_before >= levels || d->mesh_wanted >= levels)
        return "character: its mesh level is not in the LOD table";
    if (d->joints >= (table->joint_level_count ? table->joint_level_count : 1u))
        return "character: its joint level is not in the LOD table";
    if (d->influences >= (table->influence_level_count ? table->influence_level_count : 1u))
        return "character: its influence level is not in the LOD table";
    if (d->update_rate >= NOH_UPDATE_RATE_COUNT) return "character: unknown update rate";
    if (!(d->pixels_per_metre >= 0.0f)) return "character: pixels_per_metre is negative or NaN";
    return NULL;
}

static const char *bad_time(const noh_time_lod *t)
{
    if (t->chosen_rate >= NOH_UPDATE_RATE_COUNT || t->shown_rate >= NOH_UPDATE_RATE_COUNT)
        return "character: unknown update rate";
    return t->to_pose > 1u || t->posed > 1u ? "character: a pose index is not 0 or 1" : NULL;
}

/* Compare the head with the head of a new character with the same controller. */
static const char *bad_head(const noh_character *ch, size_t bytes, const noh_clip_set *set)
{
    uint64_t at;
    if (bytes < sizeof *ch || ch->bytes > bytes) return "character: its size does not match its counts";
    if (ch->joint_count != set->joint_count || ch->float_count != set->float_count)
        return "character: made for another clip set";
    if (ch->controller_offset != sizeof *ch || ch->palette_offsets[0] < sizeof *ch || ch->palette_offsets[0] > bytes ||
        ch->palette_offsets[0] % sizeof(float))
        return "character: an offset does not match its counts";
    at = ch->palette_offsets[0];
    for (int i = 0; i < 2; i++) {
        if (ch->palette_offsets[i] != at) return "character: an offset does not match its counts";
        at += 48u * (uint64_t)set->joint_count;
        at = (at + 4u * (uint64_t)set->float_count + 15u) & ~(uint64_t)15;
    }
    if (!(ch->stretches[0] >= 0.0f && ch->stretches[1] >= 0.0f) || !noh_are_sound(ch->stretches, 2))
        return "character: the stretch of a pose is negative, or not a number";
    if (!noh_are_sound(ch->spheres[0], 8)) return "character: a sphere is not a number";
    if (ch->multiplied > 3u) return "character: unknown palette flags";
    return ch->bytes != at ? "character: its size does not match its counts" : NULL;
}

/* Palettes and floats fill the block from the first palette on. */
static const char *bad_poses(const noh_character *ch)
{
    const float *poses = (const float *)(const void *)((const uint8_t *)ch + ch->palette_offsets[0]);
    return noh_are_sound(poses, (ch->bytes - ch->palette_offsets[0]) / sizeof(float))
               ? NULL
               : "character: a pose is not a number";
}

noh_result noh_character_check(const void *memory, size_t bytes, const noh_clip_set *set, const noh_lod_table *table,
                               noh_error *error)
{
    const noh_character *ch = (const noh_character *)memory;
    const noh_result result = noh_arena_check(memory, 0, error);
    const char *what;
    NOH_ASSERT(set && table);
    if (result) {
        return result;
    }
    what = bad_head(ch, bytes, set);
    if (!what) what = bad_poses(ch);
    if (!what) what = bad_lod(&ch->lod, table);
    if (!what) what = bad_time(&ch->time);
    if (what) {
        return noh_fail(error, NOH_ERR_DATA, what, 0, 0);
    }
    return noh_controller_check((const uint8_t *)memory + ch->controller_offset,
                                ch->palette_offsets[0] - ch->controller_offset, set, error);
}
