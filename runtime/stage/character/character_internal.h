/* character_internal.h (private to character/): shared by character.c and skin_palette.c. */
#ifndef NOH_CHARACTER_CHARACTER_INTERNAL_H
#define NOH_CHARACTER_CHARACTER_INTERNAL_H

#include "noh/low_stage.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/noh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The bounding sphere in this frame: centre x, y, z and radius, in object space. Updates must be given the joint
 * radii. */
void noh_character_sphere(const noh_character *ch, float sphere[4]);

/* Call when the camera has jumped: LOD levels are chosen again, and the character is posed before it is shown. */
void noh_character_cut(noh_character *ch);

/* The bytes to copy to clone or save a character. The copy must also be aligned to NOH_MEMORY_ALIGN. */
size_t noh_character_bytes(const noh_character *ch);

/* ---- memory ---- */

/* Check a block from outside, such as a saved game, before any other call. If it passes, no call overruns its memory.
 * Its poses are not checked, so until the next update the character may look wrong.
 * shapes  table: the LOD levels that will be used with it
 * errors  ARG memory is NULL or misaligned; DATA not a character for this set and table */
noh_result noh_character_check(const void *memory, size_t bytes, const noh_clip_set *set, const noh_lod_table *table,
                               noh_error *error);

/* Show the next frames this many ticks behind the clock, for frames between two steps of a game. At most the length of
 * the last step; initially 0. */
void noh_character_set_behind(noh_character *ch, uint32_t ticks);

/* ---- a frame ---- */

/* The game's clock up to which the character was stepped, in ticks. */
int64_t noh_character_clock(const noh_character *ch);

/* As noh_character_select_lod, when more plays than the controller has.
 * shapes  update_error_m[NOH_UPDATE_RATE_COUNT] of everything that plays (noh_time_lod_error); NULL: full update
 *         rate */
noh_due noh_character_select_lod_for(noh_character *ch, const noh_lod_table *table, const noh_lod_settings *settings,
                                     float pixels_per_metre, const float *update_error_m);

/* Ticks since an update was due, for noh_schedule_offer. */
uint32_t noh_character_late(const noh_character *ch);

/* Joints that an update samples: joints times tracks in the pose, for noh_cost_ns. */
uint32_t noh_character_joint_work(const noh_character *ch);

/* The tick of the game's clock that an update begun now poses the character for: the current tick, or the next
 * update's. */
int64_t noh_character_pose_clock(const noh_character *ch);

/* First half of an update: write the local pose to scratch->local and scratch->floats, where you may change it
 * (look-at, IK). */
void noh_character_update_begin(noh_character *ch, const noh_clip_set *set, noh_character_scratch *scratch);

/* Second half of an update: write matrices and bounds to the character. Joints that were not sampled move with their
 * parents.
 * shapes  joint_radius_m[joint_count] (deform.h); NULL: no sphere is stored
 * ranges  skeleton: the same in all updates of a character */
void noh_character_update_end(noh_character *ch, const noh_skeleton *skeleton, const float *joint_radius_m,
                              noh_character_scratch *scratch);

#ifdef __cplusplus
}
#endif

/* The palette of pose 0 or 1: [joint_count][12]. */
const float *noh_character_pose_palette(const noh_character *ch, uint32_t pose);

/* The largest factor by which a matrix of the shown pose stretches a length, at the time of noh_character_sphere. */
float noh_character_stretch(const noh_character *ch);

/* out = a + (b - a) * part, four floats at a time, so that compilers vectorise it. out may be a. */
void noh_mix_fours(const float *a, const float *b, float part, size_t fours, float *out);

#endif
