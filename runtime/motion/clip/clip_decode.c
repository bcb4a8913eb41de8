#include "motion/clip/clip_decode_internal.h"

#include <string.h>

#include "motion/clip/clip_coefs_internal.h"
#include "core/base/assert_internal.h"
#include "noh/low_motion.h"

#define ROTATION_NARROW 8u
#define ROTATION_WIDE 16u
#define LINEAR_BYTES 12u
#define LAST_AT_START 4u /* the context of the first track: as if the previous one had 4 frequencies */

noh_clip_cursor noh_clip_cursor_at(const noh_clip *clip, uint32_t segment)
{
    noh_clip_cursor c;
    noh_bits b = noh_bits_over(clip->bytes, clip->segment_offsets[segment], clip->segment_offsets[segment + 1u]);
    memset(&c, 0, sizeof c);
    c.segment = segment;
    c.raw_tracks = (uint8_t)noh_bits_get(&b, 1u);
    if ((clip->info.flags & NOH_CLIP_FLAG_SPLIT) && noh_bits_get(&b, 1u)) {
        const uint32_t low_bits = noh_bits_varint(&b);
        c.high = noh_bits_position(&b) + low_bits;
    }
    c.position = noh_bits_position(&b);
    for (uint32_t i = 0; i < NOH_CLIP_CLASSES; i++) {
        c.last_before[i] = LAST_AT_START;
        c.step_before[i] = NOH_CLIP_STEP_FIRST;
    }
    return c;
}

static float raw_float(noh_bits *b)
{
    const uint32_t word = noh_bits_get(b, 32u);
    float v;
    memcpy(&v, &word, sizeof v);
    return v - v == 0.0f ? v : 0.0f; /* NaN and infinity become 0 */
}

/* A raw track stores its frames as floats: the encoder's last resort if coefficients exceed the error bound. */
static void decode_raw(noh_bits *b, const noh_clip *clip, const noh_clip_track *track, const noh_clip_basis *basis,
                       uint8_t *out)
{
    const int wide = (clip->info.flags & NOH_CLIP_FLAG_WIDE) != 0u;
    const uint32_t components = track->kind == NOH_CLIP_ROTATION ? 4u : 3u, frames = basis->frames;
    for (uint32_t f = 0, slot = 0; f < frames; f++) {
        float v[4];
        for (uint32_t i = 0; i < components; i++) {
            v[i] = raw_float(b);
        }
        if (noh_clip_slot_frame(slot, frames, basis->halved) != f) continue;
        if (track->kind == NOH_CLIP_ROTATION) {
            noh_clip_store_rotation(v, wide, out);
        } else {
            memcpy(out, v, LINEAR_BYTES);
        }
        out += clip->frame_bytes;
        slot++;
    }
}

/* The quantiser step of a track. In a clip of several segments the header has a step for each track, and a segment only
 * the difference from it; in a clip of a single segment it is the difference from the previous track's step. */
static uint32_t read_step(noh_bits *b, const noh_clip *clip, const noh_clip_track *track, int16_t before)
{
    const uint32_t single = clip->info.segment_count == 1u;
    uint32_t symbol;
    noh_bits_refill(b);
    symbol = noh_clip_symbol(b, noh_clip_step_table[single], NOH_CLIP_STEP_BITS);
    if (symbol == NOH_CLIP_STEP_ESCAPE) {
        return noh_bits_take(b, 8u);
    } else {
        const int32_t difference = symbol & 1u ? -(int32_t)((symbol + 1u) / 2u) : (int32_t)(symbol / 2u);
        return (uint32_t)((single ? before : track->step) + difference) % NOH_CLIP_STEP_IDS;
    }
}

static void read_wild(noh_bits *b, float reference[4])
{
    uint32_t codes[3];
    const uint32_t left_out = noh_clip_read_quat_codes(b, NOH_CLIP_WILD_BITS, codes);
    noh_clip_quat_expand(codes, left_out, NOH_CLIP_WILD_BITS, reference);
    if (noh_bits_get(b, 1u)) {
        for (uint32_t i = 0; i < 4u; i++) {
            reference[i] = -reference[i];
        }
    }
}

/* Read the coefficients of a track. In a split segment the high ones come from its second part, which halved playback
 * skips. `high`: a reader of that part, NULL if it is not read. Returns their number. */
static uint32_t read_frequencies(noh_bits *b, noh_bits *high, const noh_clip_basis *basis, uint32_t class,
                                 noh_clip_cursor *cursor, int32_t coefs[][4])
{
    const uint32_t split = cursor->high != 0u, low = split ? basis->frames / 2u : basis->frames;
    const uint32_t context = split ? NOH_CLIP_LAST_LOW : noh_clip_last_context(cursor->last_before[class]);
    uint32_t last = noh_clip_read_coefs(b, 0, low, context, coefs);
    if (!split) {
        cursor->last_before[class] = (uint8_t)last;
    }
    if (high) {
        const uint32_t more = noh_clip_read_coefs(high, low, basis->frames - low,
                                                  noh_clip_last_context(cursor->last_before[class]), coefs + low);
        cursor->last_before[class] = (uint8_t)more;
        if (more) {
            memset(coefs + last, 0, (low - last) * sizeof *coefs);
            last = low + more;
        }
    }
    return last;
}

/* Decode one track of a segment: read its coefficients, multiply by the step, undo mixed axes, and sum the cosines into
 * frames. A rotation is the reference times the rotation given by the components; a linear value is the reference plus
 * the components. */
static void decode_track(noh_bits *b, noh_bits *high, const noh_clip *clip, const noh_clip_track *track,
                         const noh_clip_basis *basis, noh_clip_cursor *cursor, uint8_t *out)
{
    int32_t coefs[NOH_CLIP_SEGMENT_FRAMES_MAX][4];
    float components[NOH_CLIP_SEGMENT_FRAMES_MAX][4], reference[4];
    const uint32_t class = track->kind == NOH_CLIP_ROTATION;
    const uint32_t step = read_step(b, clip, track, cursor->step_before[class]);
    uint32_t last;
    memcpy(reference, track->reference, sizeof reference);
    if (track->flags & NOH_CLIP_TRACK_WILD) {
        read_wild(b, reference);
    }
    last = read_frequencies(b, high, basis, class, cursor, coefs);
    cursor->step_before[class] = (int16_t)step;
    noh_clip_dequantise((const int32_t(*)[4])coefs, last, noh_clip_step(step),
                        track->flags & NOH_CLIP_TRACK_MIX ? track->mix : NULL, components);
    if (class) {
        noh_clip_synth_rotation(basis, (const float(*)[4])components, last, reference,
                                (clip->info.flags & NOH_CLIP_FLAG_WIDE) != 0u, out, clip->frame_bytes);
    } else {
        noh_clip_synth_linear(basis, (const float(*)[4])components, last, reference, out, clip->frame_bytes);
    }
}

void noh_clip_decode(const noh_clip *clip, const noh_clip_basis *basis, noh_clip_cursor *cursor, uint32_t track_end,
                     uint8_t *frames)
{
    NOH_ASSERT(track_end <= clip->info.track_count && cursor->segment < clip->info.segment_count);
    NOH_ASSERT(basis->frames == noh_clip_segment_frames(clip, cursor->segment));
    const uint32_t rotation_bytes = clip->info.flags & NOH_CLIP_FLAG_WIDE ? ROTATION_WIDE : ROTATION_NARROW;
    const uint32_t reads_high = cursor->high && !basis->halved;
    noh_bits b = noh_bits_over(clip->bytes, 0, clip->segment_offsets[cursor->segment + 1u]), high = b;
    noh_bits_seek(&b, cursor->position);
    if (reads_high) {
        noh_bits_seek(&high, cursor->high);
    }
    for (; cursor->track < track_end; cursor->track++) {
        const noh_clip_track *track = &clip->tracks[cursor->track];
        uint8_t *out = frames + (track->kind == NOH_CLIP_ROTATION ? track->entry * rotation_bytes
                                                                  : clip->linear_offset + track->entry * LINEAR_BYTES);
        if (cursor->raw_tracks && noh_bits_get(&b, 1u)) {
            decode_raw(&b, clip, track, basis, out);
        } else {
            decode_track(&b, reads_high ? &high : NULL, clip, track, basis, cursor, out);
        }
    }
    cursor->position = noh_bits_position(&b);
    if (reads_high) {
        cursor->high = noh_bits_position(&high);
    }
}
