/* clip_bank_reserve.c: the bytes of clips that are in memory only while they are needed.
 *
 * What a clip's header says (durations, keys, floats, which joints move) is opened with the bank and stays. Its
 * segments, most of its bytes, are read when they are decoded. They lie in the reserve one after another; a clip that
 * goes lets those behind it move down, so the free bytes are always in one piece. Which clips are there depends on
 * calls alone. */
#include <string.h>

#include "core/base/arena_internal.h"
#include "core/base/assert_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "motion/bank/clip_bank_internal.h"
#include "motion/clip/clip_cache_internal.h"
#include "motion/clip/clip_internal.h"
#include "noh/base.h"
#include "noh/clip.h"

/* Clips are opened in the bank's own memory; only others read them. */
static noh_clip *clip_of(const noh_clip_bank *bank, uint32_t clip)
{
    return (noh_clip *)(uintptr_t)noh_clip_cache_clip(bank->cache, clip);
}

static uint32_t bytes_of(const noh_clip_bank *bank, uint32_t clip)
{
    const noh_clip *c = clip_of(bank, clip);
    return c->segment_offsets[c->info.segment_count];
}

static void leave(noh_clip_bank *bank, uint32_t clip)
{
    clip_of(bank, clip)->bytes = NULL;
    bank->clips.reserve->clips[clip].absent = 1;
    bank->clips.reserve->clips[clip].bytes = 0;
    noh_clip_cache_forget(bank->cache, clip);
}

void noh_clip_bank_empty(noh_clip_bank *bank)
{
    if (NOH_PAGE || !bank->clips.reserve) return;
    /* root_ends point into the packs too: only what makes sets reads them, and that is done */
    for (uint32_t i = 0; i < bank->clips.clip_count; i++) leave(bank, i);
}

void noh_clip_bank_tick(noh_clip_bank *bank)
{
    if (bank->clips.reserve) bank->clips.reserve->clock++;
}

void noh_clip_bank_touch(noh_clip_bank *bank, uint32_t clip)
{
    if (bank->clips.reserve && clip < bank->clips.clip_count)
        bank->clips.reserve->clips[clip].used = bank->clips.reserve->clock;
}

uint64_t noh_clip_bank_touched(const noh_clip_bank *bank, uint32_t *absent)
{
    const noh_clip_reserve *r = bank->clips.reserve;
    uint64_t bytes = 0;
    *absent = 0;
    for (uint32_t i = 0; i < bank->clips.clip_count; i++) {
        if (r->clips[i].used != r->clock) continue;
        bytes += noh_aligned(bytes_of(bank, i));
        *absent += r->clips[i].absent;
    }
    return bytes;
}

/* ---- room ---- */

/* Move bytes down. Pieces are no longer than the way, so none lies over the place that it goes to. */
static void move_down(uint8_t *to, const uint8_t *from, size_t bytes)
{
    const size_t way = (size_t)(from - to);
    for (size_t at = 0; at < bytes; at += way) memcpy(to + at, from + at, bytes - at < way ? bytes - at : way);
}

static void evict(noh_clip_bank *bank, uint32_t clip)
{
    noh_clip_reserve *r = bank->clips.reserve;
    const noh_reserved_clip gone = r->clips[clip];
    leave(bank, clip);
    move_down(r->bytes + gone.at, r->bytes + gone.at + gone.bytes, r->filled - gone.at - gone.bytes);
    r->filled -= gone.bytes;
    for (uint32_t i = 0; i < bank->clips.clip_count; i++) {
        if (!r->clips[i].bytes || r->clips[i].at < gone.at) continue;
        r->clips[i].at -= gone.bytes;
        clip_of(bank, i)->bytes = r->bytes + r->clips[i].at;
    }
}

static int may_go(const noh_clip_reserve *r, uint32_t clip)
{
    return r->clips[clip].bytes && r->clips[clip].used != r->clock;
}

static uint32_t oldest(const noh_clip_bank *bank)
{
    const noh_clip_reserve *r = bank->clips.reserve;
    uint32_t found = NOH_NONE;
    for (uint32_t i = 0; i < bank->clips.clip_count; i++) {
        if (may_go(r, i) && (found == NOH_NONE || r->clips[i].used < r->clips[found].used)) found = i;
    }
    return found;
}

noh_result noh_clip_bank_bring(noh_clip_bank *bank, uint32_t clip, const uint8_t *bytes, uint32_t byte_count,
                               noh_error *error)
{
    noh_clip_reserve *r = bank->clips.reserve;
    const uint32_t need = (uint32_t)noh_aligned(byte_count);
    uint32_t stays = 0;
    NOH_ASSERT(r && clip < bank->clips.clip_count && r->clips[clip].absent);
    if (byte_count != bytes_of(bank, clip)) {
        return noh_fail(error, NOH_ERR_DATA, "the bytes of a clip have another size", clip, bytes_of(bank, clip));
    }
    for (uint32_t i = 0; i < bank->clips.clip_count; i++) stays += may_go(r, i) ? 0 : r->clips[i].bytes;
    if (need > r->room - stays) {
        return noh_fail(error, NOH_ERR_MEMORY, "clips that play fill the reserve: raise clip_reserve of the kind",
                        stays, stays + need);
    }
    while (r->room - r->filled < need) evict(bank, oldest(bank));
    memcpy(r->bytes + r->filled, bytes, byte_count);
    r->clips[clip].at = r->filled;
    r->clips[clip].bytes = need;
    r->clips[clip].used = r->clock;
    r->filled += need;
    r->clips[clip].absent = 0;
    clip_of(bank, clip)->bytes = r->bytes + r->clips[clip].at;
    return NOH_OK;
}
