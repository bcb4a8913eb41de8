/* low_motion.h: caches, poses and blend spaces: for engines built of parts (noh_low.h). */

#ifndef NOH_LOW_MOTION_H
#define NOH_LOW_MOTION_H

#include <stdint.h>

#include "base.h"
#include "clip.h"
#include "graph.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== time ========
 * Integer time that does not drift.
 *
 * A tick is 1/48,000 s: one audio sample. A position counts 1/65,536 ticks from the start of a clip's first leg and
 * never wraps: at 2.5 durations a repeating clip is half through its third pass, a ping-pong clip half through its
 * third leg. So play is one addition per step, exact for any partition of an interval, and pose, events and root motion
 * are closed functions of the position.
 *
 *   noh_ticks_from_seconds   seconds to ticks
 *   noh_frame_clock_advance  ticks of a frame, without drift
 *
 * All functions accept every argument; results that would overflow are clamped to their range.
 *
 * Threads: pure functions of their arguments; any thread. */

#define NOH_FRAME_SECONDS_MAX 3600.0

/* Convert a frame's seconds to ticks, for noh_stage_step and similar calls. Summed over frames, the ticks are the
 * nearest to the sum of the seconds. Long pauses, such as in a debugger, are not caught up.
 * ranges  seconds 0..NOH_FRAME_SECONDS_MAX, clamped; negative values and NaN count as 0 */
uint32_t noh_frame_clock_advance(noh_frame_clock *clock, double seconds);

/* Convert whole ticks to a position.
 * ranges  |ticks| < 2^47 (93 years), clamped */
int64_t noh_position_of(int64_t ticks);

/* ======== tracks ========
 * One track of a controller: the clip it plays, position, speed and weight (Granberg 2009, chapter 5; here
 * the position is in integer ticks and cannot drift).
 *
 * Plain state without pointers. Change it through clip.h, which updates dependent state.
 *
 * Threads: a track belongs to the thread of its controller. */

/* Get the clip tick to sample, `ago` ticks before now at the present speed. */
uint32_t noh_track_clip_tick(const noh_track *track, const noh_clip_entry *clip, int64_t ago);

/* ======== skeletons ========
 * Joints, parents first, so that one pass over them computes model matrices. The arrays are borrowed.
 *
 * Threads: read-only; any number of threads may share one. */

#define NOH_JOINT_ROOT 0xffffu /* parent of a joint without one */

/* Interpolate: out = a at t = 0, b at t = 1; out may be a or b. The mask multiplies t.
 * shapes  a, b, out and mask (NULL: 1 everywhere) [joint_count]
 * ranges  t 0..1 */
void noh_pose_mix(uint32_t joint_count, const noh_transform *a, const noh_transform *b, float t, const uint8_t *mask,
                  noh_transform *out);

/* Compute the difference from a reference to a pose: rotation inverse(reference) * pose, the difference of
 * translations, the ratio of scales (1 where the reference's is 0). out may be pose, not reference. */
void noh_pose_difference(uint32_t joint_count, const noh_transform *reference, const noh_transform *pose,
                         noh_transform *out);

/* Apply a weighted difference in place: multiply the rotation on the right, add the translation, multiply the scale.
 * Weights above 1 exaggerate. */
void noh_pose_add(uint32_t joint_count, const noh_transform *difference, float weight, const uint8_t *mask,
                  noh_transform *pose);

/* ======== the format of clips ========
 * The bytes of a compressed clip.
 *
 * A clip is one position-independent block: a header of bits, then its segments. Bits fill bytes from the lowest; a
 * field's lowest bit comes first. There is no alignment and no pointer. The header is a bit stream because a game clip
 * of 20 frames takes two kilobytes: a plain struct of joints would be a third of it.
 *
 * varint: groups of 4 bits, lowest first, each followed by one bit, 1 = another follows; at most 8 groups.
 * unit quaternion of width w: 2 bits index of the omitted component (the largest, made positive), then 3 x w bits:
 *         component = (v - mid) * sqrt(1/2) / mid, mid = 2^(w-1) - 1.
 * floats of width w: the highest w bits of an IEEE single, the rest zero.
 *
 * Header
 *   8        version, NOH_CLIP_VERSION
 *   8        flags, NOH_CLIP_FLAG_*; other bits are 0
 *   varint   joints
 *   varint   frames, at least 1
 *   1        1: varint sample rate in Hz;  0: 32 bits of sample rate in micro-Hz
 *   varint   segments; segment s holds frames [s * frames / segments, (s + 1) * frames / segments)
 *   5        only when segments > 1: width of a segment's byte count
 *   varint   the bound in nanometres;  varint the shell in micrometres
 *   20       largest error;  20 rms error (4 bits e, 16 bits m: bound * m * 2^e / 65536)
 *   varint   joint of the largest error;  varint its time in eighths of a frame
 *   varint   float groups; each: 32 bits name hash, varint node + 1 (0: none), varint width
 *   floats   per triple of floats (last padded): track fields, see below
 *   joints   per joint: 0 = rotation animated, rest as in the bind pose; 10 = all as bind;
 *            11, then 2 bits each for rotation, translation and (flag SCALE only) scale:
 *            0 bind, 1 constant, 2 animated. Then the fields of all that is not bind, in the
 *            order translation, scale, rotation:
 *              constant rotation   4 bits c, unit quaternion of width 11 + c
 *              constant linear     2 bits c, 3 floats of width 16, 20, 24, 32
 *              animated            track fields
 *   sizes    only when segments > 1: each segment's byte count; a single segment has the rest
 *   0..7     zeros up to a byte
 * Track fields
 *   8        step of reference (segments > 1 only)
 *   floats:  2 x 8 more: the steps of the second and third float relative to the first, + 128
 *   rotation: 1 wild: each segment has its own reference. Else as follows.
 *   1        0: the reference is the bind pose's value (floats: zero);
 *            1: rotation: unit quaternion of width 8; linear: 3 floats of width 16
 *   1        joints only. 1: mixed axes: unit quaternion of width 8, whose matrix turns
 *            decoded triples into components
 *
 * A segment is a separate bit stream: 1 bit "has raw tracks", with SPLIT 1 bit "is split", if that is 1 a varint, the
 * number of bits before the high part, then per track, in header order:
 *   1        only with raw tracks: this one is raw: frames x (4 or 3) x 32-bit floats, nothing else
 *   step     symbol of the step table: zigzag difference to the header's step (segments > 1)
 *            or to the step of the last track of its class (single); 31: 8 bits, absolute.
 *            step size = 2^(NOH_CLIP_STEP_TOP - id / 4)
 *   32 + 1   wild rotations: unit quaternion of width 10, then a sign bit
 *   last     symbol: number of frequencies, 0..frames of the segment, or 0..frames / 2 if it is split
 *   triples  frequencies last - 1 down to 1, all three components at once
 *   dc       frequency 0: per component a category symbol, then bits and sign
 * The high part of a split segment has the frequencies from frames / 2 up of each track that is not raw: their number,
 * as a symbol like `last`, then triples down to frames / 2. Playback of half of the frames skips it.
 * Values are the orthonormal DCT-II of each component, or with PARABOLA the transform whose rows are the constant, x
 * and x^2, then the rows of the DCT-II from its second on, made orthonormal in that order among rows of the same
 * symmetry. A rotation's components are the modified Rodrigues vector u = 4 xyz / (1 + w) relative to the reference; a
 * linear track's are differences from the reference.
 *
 * Threads: constants. */

#define NOH_CLIP_VERSION 5u /* also raised for new coding tables: they are part of the format */

#define NOH_CLIP_FLAG_WIDE 1u  /* cache rotations as floats: 16 bits are too few for some joint's lever */
#define NOH_CLIP_FLAG_SCALE 2u /* some joint's scale differs from its bind pose */
#define NOH_CLIP_FLAG_LOOP 4u  /* the last frame equals the first */
#define NOH_CLIP_FLAG_OPEN 8u  /* coded in an open loop, each joint separately: joints may be masked or replaced */
/* the bound holds for all points at the shell's distance; without it, for the three on each joint's axes */
#define NOH_CLIP_FLAG_SPHERE 16u
#define NOH_CLIP_FLAG_PARABOLA 32u /* the transform begins with a parabola: see above */
#define NOH_CLIP_FLAG_SPLIT 64u    /* in some segments the high frequencies are stored separately */
#define NOH_CLIP_FLAGS_ALL 127u

#define NOH_CLIP_JOINTS_MAX 4096u
#define NOH_CLIP_FLOATS_MAX 4096u
#define NOH_CLIP_GROUPS_MAX 1024u
#define NOH_CLIP_FRAMES_MAX (1u << 20)
#define NOH_CLIP_SEGMENT_FRAMES_MAX 64u

#define NOH_CLIP_TICKS_PER_SECOND 48000u
#define NOH_CLIP_MICRO 1000000u

#define NOH_CLIP_STEP_TOP 16    /* the largest step is 2^16 ... */
#define NOH_CLIP_STEP_IDS 256u  /* ... and the smallest 2^-47.75 */
#define NOH_CLIP_STEP_FIRST 112 /* the reference for the first track of a single segment */
#define NOH_CLIP_STEP_ESCAPE 31u

#define NOH_CLIP_MODE_BIND 0u
#define NOH_CLIP_MODE_CONSTANT 1u
#define NOH_CLIP_MODE_ANIMATED 2u

#define NOH_CLIP_CONSTANT_BITS 11u /* smallest width of a constant rotation */
#define NOH_CLIP_REFERENCE_BITS 8u
#define NOH_CLIP_WILD_BITS 10u
#define NOH_CLIP_MIX_BITS 8u
#define NOH_CLIP_ERROR_ONE 65536u
#define NOH_CLIP_TIME_PARTS 8u /* a certificate's time is in eighths of a frame */

#define NOH_CLIP_MAGNITUDE_BITS 23u /* of a coefficient */

/* ======== compressed clips ========
 * A compressed clip, opened for playing.
 *
 * The clip's bytes are used in place; its header, a few bits per joint, is expanded once into the caller's memory.
 * Frames are decoded through a noh_clip_cache.
 *
 *   noh_clip_measure   counts, duration, certificate and memory size, before it is opened
 *   noh_clip_size      the bytes that noh_clip_init needs
 *   noh_clip_init      check a clip and expand its header
 *   noh_clip_info_of   counts, duration and certificate
 *
 * Threads: an open clip is read-only; any number of threads may share it. */

typedef struct noh_clip_desc {
    const void *bytes; /* the clip, any alignment; must outlive the noh_clip */
    size_t byte_count;
    /* [joint_count] the skeleton's bind pose that the clip was built with; used by init only */
    const noh_transform *bind;
    uint32_t joint_count; /* joints of the skeleton; must equal the clip's; 0 for a clip that animates floats only */
    /* sample rate, in frames per second, that suffices; default (0) the full rate. A clip with at least twice this rate
     * (less 1%) is halved: about every second frame is decoded and cached, and frames between are interpolated. Its
     * certificate does not hold then. Split segments (NOH_CLIP_FLAG_SPLIT) also lose the higher half of their
     * frequencies */
    uint32_t sample_rate_needed;
} noh_clip_desc;

typedef struct noh_clip noh_clip;

/* Contents of a clip's header. Distances in centimetres. */
typedef struct noh_clip_info {
    uint32_t joint_count, frame_count, segment_count, float_count, group_count;
    uint32_t track_count;     /* animated rotations, translations, scales and triples of floats */
    uint32_t sample_rate_uhz; /* frames per second, times 10^6 */
    uint64_t duration_ticks;  /* 1/48,000 s; frame_count - 1 frames: the last frame is shown at the end */
    uint32_t flags;           /* NOH_CLIP_FLAG_* */
    /* the error bound that it was built for, and the distance in the bind pose from a joint to the points that the
     * bound covers: with NOH_CLIP_FLAG_SPHERE all points at that distance, without it the three on the joint's axes.
     * Where the model has vertices that the joint moves, the bound covers these, too */
    double error_cm, shell_cm;
    double max_error_cm, rms_error_cm; /* certificate: measured errors, at frames and between them */
    uint32_t max_error_joint;
    double max_error_time_s;
    uint32_t segment_frames_max;
    uint32_t halved;          /* 1: half of its frames suffice (noh_clip_desc.sample_rate_needed) */
    size_t segment_bytes_max; /* of the longest segment, decoded in the cache */
} noh_clip_info;

/* Check a clip completely; get its info and the size of its noh_clip.
 * errors  as noh_clip_init, except MEMORY */
noh_result noh_clip_measure(const noh_clip_desc *desc, noh_clip_info *info, size_t *bytes, noh_error *error);

/* Exact size of a noh_clip in bytes; 0 for a clip that noh_clip_measure rejects. */
size_t noh_clip_size(const noh_clip_desc *desc, noh_error *error);

/* Check a clip completely and expand its header into memory[noh_clip_size()], aligned to NOH_MEMORY_ALIGN.
 * errors  ARG bytes or bind NULL, joint_count not the clip's (need: the clip's), memory NULL or misaligned; MEMORY
 *         need: the bytes; VERSION need: the version read; LIMIT need: the clip's count; DATA where: the byte in the
 *         clip */
noh_result noh_clip_init(void *memory, size_t bytes, const noh_clip_desc *desc, noh_clip **out, noh_error *error);

void noh_clip_info_of(const noh_clip *clip, noh_clip_info *info);

/* ======== the clip cache ========
 * Decoded segments of clips in a fixed block, and poses sampled from them.
 *
 * A clip is stored in segments of up to NOH_CLIP_SEGMENT_FRAMES_MAX frames; a pose is sampled from one or two of them.
 * One cache serves all instances that play its clips. In each frame of a game call
 *   noh_clip_cache_begin_frame(cache);                     once
 *   noh_clip_cache_want(cache, clip, soon, joints);        per playing track: what it needs next
 *   noh_clip_cache_work(cache, budget);                    once: decodes requested segments within the budget
 *   noh_clip_sample(cache, clip, ticks, joints, out, f);   per playing track
 * A sample whose segments are missing (not requested, budget too small, track jumped) decodes them immediately: the
 * same bits, at the cost of up to two segments, counted in `decoded_late`. If nothing is requested and a clip plays
 * steadily, forwards or backwards, each sample decodes part of the next segment if there is room, so no single frame
 * decodes all of it.
 *
 *   noh_clip_cache_size, _init                    for clips that are open
 *   noh_clip_cache_begin_frame, _want, _want_frames, _work   decode ahead
 *   noh_clip_sample                               a pose
 *
 * Threads: every call that takes a non-const cache is for one thread at a time, with no other call on that cache at the
 * same time. To sample on several threads between those calls, give each a noh_clip_view.
 *
 * Memory: a cached segment takes the bytes of its frames. A cache of n segments has room for the n largest segments of
 * its clips: segments are sorted into size classes (four per doubling), and each class has as many entries as it has
 * segments among those n, each entry as large as the largest segment of the class. A segment is stored in its own
 * class, or in the next larger class with a free entry. */

/* Most segments that a playing track needs when it looks ahead by up to one segment: its current segment, the next one,
 * and the previous one, used for root motion across their border. */
#define NOH_CLIP_CACHE_SEGMENTS_PER_TRACK 3u

typedef struct noh_clip_cache_desc {
    const noh_clip *const *clips; /* [clip_count], copied; the clips must outlive the cache */
    uint32_t clip_count;          /* 1..NOH_CLIP_CACHE_CLIPS_MAX */
    /* segments held at the same time, 2..NOH_CLIP_CACHE_SEGMENTS_MAX; default (0) NOH_CLIP_CACHE_SEGMENTS_PER_TRACK for
     * each clip, as if one track played each. Never more than the clips have */
    uint32_t cached_segment_count;
} noh_clip_cache_desc;

/* Exact size of a cache in bytes; 0 if the desc is invalid (see the error). */
size_t noh_clip_cache_size(const noh_clip_cache_desc *desc, noh_error *error);

/* Make a cache in memory[bytes], aligned to NOH_MEMORY_ALIGN.
 * errors  ARG a field of desc, or memory NULL or misaligned; MEMORY need: the bytes */
noh_result noh_clip_cache_init(void *memory, size_t bytes, const noh_clip_cache_desc *desc, noh_clip_cache **out,
                               noh_error *error);

/* Inputs of a cache's size, for clips that are measured but not open yet. Zero it, add each clip, then get the size. */
#define NOH_CLIP_CACHE_SIZES 120u
typedef struct noh_clip_cache_needs {
    uint32_t clip_count, segment_count;
    uint32_t size_segments[NOH_CLIP_CACHE_SIZES];      /* segments in each size class */
    uint32_t size_bytes[NOH_CLIP_CACHE_SIZES];         /* bytes of the largest segment in each class */
    uint8_t lengths[NOH_CLIP_SEGMENT_FRAMES_MAX + 1u]; /* bit b: some segment of transform b has this many frames */
} noh_clip_cache_needs;

/* Begin a frame of the game. Until the next call no request evicts a segment that this frame has requested or
 * sampled. */
void noh_clip_cache_begin_frame(noh_clip_cache *cache);

/* Request the first `joint_count` joints of the segment at a time. Decodes nothing.
 * units    ticks, clamped to the clip
 * returns  1 if the segment is cached or will be; 0 if there is no room because this frame uses every cached segment */
int noh_clip_cache_want(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count);

/* Decode requested segments, in the order of the requests, until `budget` track-frames are spent (the last track may
 * exceed it).
 * returns  the track-frames spent */
uint32_t noh_clip_cache_work(noh_clip_cache *cache, uint32_t budget);

/* Sample a pose. Between frames, translations, scales and floats are interpolated linearly; rotations linearly, then
 * normalised. At sample rates whose frames are not a whole number of ticks, rotations are taken at a time within
 * 1/65,000 of a frame of the requested one.
 * shapes  out[joint_count], floats[float_count of the clip] (NULL: not wanted)
 * ranges  clip below clip_count; joint_count up to the clip's: only these first joints are decoded and sampled */
void noh_clip_sample(noh_clip_cache *cache, uint32_t clip, int64_t ticks, uint32_t joint_count, noh_transform *out,
                     float *floats);

/* ======== blend spaces ========
 * Weights of clips placed along one or two parameters.
 *
 * 1-D: linear between two neighbours. 2-D: a Delaunay triangulation, made once with the space, and barycentric weights
 * in the triangle that contains the point: at most three clips are sampled, the weights are continuous, and at a clip's
 * own point it has full weight. A point outside uses the nearest point of the hull. (Inverse distance weighting needs
 * no triangles, but samples every clip and gives each some weight everywhere.)
 *
 * Threads: pure functions of their arguments; any thread. */

/* Triangulate the points. They are first rounded to 1/4096 of their extent, so that all geometric tests are exact in
 * integers and the result is the same on every machine.
 * shapes  points[count][2], triangles[NOH_BLEND_SPACE_TRIANGLES_MAX][3]
 * errors  ARG count; DATA (where: the point) not finite, beyond NOH_BLEND_SPACE_COORDINATE_MAX, or equal to another
 *         point */
noh_result noh_blend_space_2d_triangulate(uint32_t count, const float *points, uint8_t *triangles,
                                          uint32_t *triangle_count, noh_error *error);

/* Compute the weights of clips over two parameters.
 * shapes  weights[point_count]; the sum is 1, at most three are not zero
 * ranges  x, y are clamped to NOH_BLEND_SPACE_COORDINATE_MAX; NaN counts as 0 */
void noh_blend_space_2d_weights(const noh_blend_space_2d *space, float x, float y, float *weights);

/* ======== poses to matrices ========
 * From a pose to matrices.
 *
 * A matrix has 3 rows of 4, stored by row: position = rows * (x, y, z, 1), the layout of noh_node.world and of palettes
 * in uniform buffers or textures; 48 bytes per joint. Column vectors: model = parent's model * local.
 *
 * source  C. Granberg, "Character Animation with Direct3D", Charles River Media 2009, chapter 3
 *
 * Threads: pure functions of their arguments; any thread. */

/* Compute translation * rotation * scale of one joint. */
void noh_transform_matrix(const noh_transform *t, float matrix[12]);

/* Multiply: out = a * b; out may be a or b. */
void noh_matrix_multiply(const float a[12], const float b[12], float out[12]);

#ifdef __cplusplus
}
#endif

#endif
