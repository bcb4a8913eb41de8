/* character.h: one character: its controller, its LOD levels, and the two poses that it shows a mix of.
 *
 * A character is one block of bytes without pointers: clone, save or move it with one memcpy of
 * noh_character_bytes(ch). Hundreds lie in one array. What they share (the set, the LOD table, the scratch) is passed
 * to every call.
 *
 * A frame of a game:
 *   noh_character_step(ch, set, ticks, fn, user)              every character, seen or not: clock and callback keys
 *   due = noh_character_look(ch, table, settings, scale)      those in view: chooses LOD levels
 *   noh_character_update(ch, set, skeleton, radii, &scratch)  those that are due: samples, blends, makes matrices
 *   noh_character_skin(ch, skin, matrices)                    those that are drawn: skinning matrices (skin_palette.h)
 * A scheduler can spread updates within a time budget (scheduler.h). Change tracks through noh_character_controller,
 * then call noh_character_wake. After a memcpy, noh_character_set_instance gives the copy its own place in the stagger
 * of updates.
 *
 * Bytes: 160 for the head, the controller's (controller.h), and two palettes of 48 per joint with 4 per float, each
 * rounded up to 16. 31 joints, 34 floats and 4 tracks: 3,888; with room for inertia 5,648.
 *
 * Each instance has a controller and poses of its own, so updates and draws may be batched in any order. (C. Granberg,
 * "Character Animation with Direct3D", Charles River Media 2009, chapter 4, clones controllers too, but all clones
 * write one shared tree of joints, and each must be drawn before the next is updated.)
 *
 * Threads: a character belongs to one thread at a time, and so does a scratch; set, skeleton, table and settings are
 * read-only and shared. So different characters may be stepped and looked at on several threads at once; for updates
 * each thread needs a view of the set (clip_bank.h). */
#ifndef NOH_CHARACTER_CHARACTER_H
#define NOH_CHARACTER_CHARACTER_H

#include "motion/anim/controller_pose.h"
#include "stage/character/bounds.h"
#include "stage/character/time_lod.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_character_desc {
    noh_controller_desc controller; /* set is required */
    uint32_t instance;              /* staggers updates: give each character its own number; default 0 */
    int64_t start_clock;            /* tick of the game's clock at which it begins; default 0 */
} noh_character_desc;

/* The head of the block; the rest follows at byte offsets from it. Reading the fields is fine; change them by calls. */
typedef struct noh_character {
    int64_t start_clock;
    uint32_t bytes; /* of the whole block */
    uint32_t joint_count, float_count;
    uint32_t controller_offset;
    uint32_t palette_offsets[2]; /* the floats of a pose follow its palette */
    float stretches[2];          /* noh_bounds.stretch of each of the two poses */
    uint32_t updates;            /* since init */
    uint32_t multiplied;         /* a bit for each palette: set if it was multiplied by inverse bind matrices */
    noh_lod lod;
    noh_time_lod time;
    float spheres[2][4]; /* centre and radius around each of the two poses */
} noh_character;

/* Working memory of updates: one for all characters of a set that one thread updates. */
typedef struct noh_character_scratch {
    noh_pose_scratch pose;
    noh_controller *ahead; /* a copy of the controller, played to the next update */
    size_t ahead_bytes;
    noh_transform *local; /* [joint_count] the pose, between noh_character_update_begin and _end */
    float *floats;        /* [float_count] its floats */
    uint32_t joint_count; /* the joints that were sampled; the others have the bind pose */
    uint32_t pose_index;  /* 0 or 1: which of the character's two poses this becomes */
    float *model;         /* [joint_count][12] model-space matrices, after _end */
} noh_character_scratch;

/* ---- memory ---- */

/* Exact bytes; 0 for an impossible desc. */
size_t noh_character_size(const noh_character_desc *desc);

/* Make a character in memory[bytes]: all tracks off, no valid pose.
 * errors  ARG a field of the desc, or memory NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small; need: the exact
 * bytes */
noh_result noh_character_init(void *memory, size_t bytes, const noh_character_desc *desc, noh_character **character,
                              noh_error *error);

/* Working memory for characters of this desc, or of one with fewer tracks and changes.
 * errors  as noh_character_init */
size_t noh_character_scratch_size(const noh_character_desc *desc);
noh_result noh_character_scratch_init(void *memory, size_t bytes, const noh_character_desc *desc,
                                      noh_character_scratch *scratch, noh_error *error);

/* How many bytes to copy to clone or save it. The copy must be aligned to NOH_MEMORY_ALIGN too. */
size_t noh_character_bytes(const noh_character *ch);

/* Check a block from outside, such as a saved game, before any other call. With a block that passes, no call overruns
 * its memory; its poses are not looked at, so what is shown until the next update may be nonsense.
 * shapes  table: of the LOD levels that it will be looked at with
 * errors  ARG memory NULL or misaligned; DATA not a character for this set and table */
noh_result noh_character_check(const void *memory, size_t bytes, const noh_clip_set *set, const noh_lod_table *table,
                               noh_error *error);

/* What the next frames show lies so many ticks behind the clock: a frame between two steps of a game. At most the last
 * step; 0 to begin with. */
void noh_character_set_behind(noh_character *ch, uint32_t ticks);

/* Give a copy its own place in the stagger of updates. */
void noh_character_set_instance(noh_character *ch, uint32_t instance);

noh_controller *noh_character_controller(noh_character *ch);

/* ---- a frame ---- */

/* The game's clock, as far as the character was stepped; ticks. */
int64_t noh_character_clock(const noh_character *ch);

/* Move time on and deliver callback keys: noh_controller_step. LOD levels make no difference to it. */
uint32_t noh_character_step(noh_character *ch, const noh_clip_set *set, uint32_t ticks, noh_event_fn fn, void *user);

/* The character is in view: choose its LOD levels and say whether an update is due. At most once a frame. The
 * controller then plays for the chosen mesh level, and samples the joints of the chosen joint level.
 * units   pixels_per_metre at its nearest point (noh_lod_scale) */
noh_due noh_character_look(noh_character *ch, const noh_lod_table *table, const noh_lod_settings *settings,
                           float pixels_per_metre);

/* The same where more plays than the controller knows.
 * shapes  update_error_m[NOH_UPDATE_RATE_COUNT] of all that plays (noh_time_lod_error); NULL: full update rate */
noh_due noh_character_look_given(noh_character *ch, const noh_lod_table *table, const noh_lod_settings *settings,
                                 float pixels_per_metre, const float *update_error_m);

/* Ticks since an update was due, for noh_schedule_offer. */
uint32_t noh_character_late(const noh_character *ch);

/* How many joints an update samples: joints times tracks in the pose, for noh_cost_ns. */
uint32_t noh_character_joint_work(const noh_character *ch);

/* The tick of the game's clock that an update begun now poses it for: the present one, or that of the next update. */
int64_t noh_character_pose_clock(const noh_character *ch);

/* Pose it, for this frame or for the next update: _begin and _end. Not within a callback of noh_character_step. */
void noh_character_update(noh_character *ch, const noh_clip_set *set, const noh_skeleton *skeleton,
                          const float *joint_radius_m, noh_character_scratch *scratch);

/* First half: the local pose into scratch->local and scratch->floats, where you may change it (look-at, IK). */
void noh_character_update_begin(noh_character *ch, const noh_clip_set *set, noh_character_scratch *scratch);

/* Second half: matrices and bounds into the character. Joints that were not sampled move with their parents.
 * shapes  joint_radius_m[joint_count] (bounds.h); NULL: no sphere is kept
 * ranges  the same skeleton in all updates of a character */
void noh_character_update_end(noh_character *ch, const noh_skeleton *skeleton, const float *joint_radius_m,
                              noh_character_scratch *scratch);

/* The first joint_count matrices shown in this frame, once the character was updated, in the skeleton's order: as
 * noh_model_to_palette makes them for the skeleton that update_end was given. They are the joints' model-space matrices
 * unless that skeleton has inverse bind matrices; to draw a mesh, call noh_character_skin, which takes care of both.
 * shapes   mixed[joint_count][12]
 * returns  `mixed`, or the character's own matrices where nothing had to be mixed: valid until the next update */
const float *noh_character_palette(const noh_character *ch, float *mixed, uint32_t joint_count);

/* The same of its floats.
 * shapes  mixed[float_count of the set] */
const float *noh_character_floats(const noh_character *ch, float *mixed);

/* A sphere around what is shown in this frame: centre x, y, z and radius, in object space. Updates must be given the
 * joint radii. */
void noh_character_sphere(const noh_character *ch, float sphere[4]);

/* Call after changing tracks or weights. An update is due from now on; what is shown moves to the changed pose within
 * half an update period to one. */
void noh_character_wake(noh_character *ch);

/* Call when the camera has jumped: LOD levels are chosen afresh, and the character is posed before it is shown. */
void noh_character_cut(noh_character *ch);

#ifdef __cplusplus
}
#endif

#endif
