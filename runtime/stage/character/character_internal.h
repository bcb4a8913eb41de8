/* character_internal.h (private to character/): shared by character.c and skin_palette.c. */
#ifndef NOH_CHARACTER_CHARACTER_INTERNAL_H
#define NOH_CHARACTER_CHARACTER_INTERNAL_H

#include "stage/character/time_lod_internal.h"
#include "noh/low_stage.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/noh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== a character ========
 * One character: its controller, its LOD levels, and the two poses that it blends.
 *
 * A character is one block of bytes without pointers: clone, save or move it with one memcpy of its `bytes`. Hundreds
 * fit in one array. Shared data (the set, the LOD table, the scratch) is passed to
 * every call.
 *
 * A frame of a game:
 *   noh_character_step(ch, set, ticks, fn, user)              every character: clock and callback keys
 *   due = noh_character_select_lod(ch, table, settings, scale)      characters in view: chooses LOD levels
 *   noh_character_update(ch, set, skeleton, radii, &scratch)  characters that are due: samples, blends, makes matrices
 *   noh_character_skin(ch, skin, matrices)                    drawn characters: skinning matrices
 * A scheduler can spread updates within a time budget. Change tracks through noh_character_controller,
 * then call noh_character_wake. After a memcpy, give the copy its own time.instance.
 *
 * Bytes: 160 for the head, plus the controller (clip.h), plus two poses of 48 per joint and 4 per float, each
 * rounded up to 16. 31 joints, 34 floats and 4 tracks: 3,888; with inertia 5,648.
 *
 * Each instance has its own controller and poses, so updates and draws may be batched in any order. (C. Granberg,
 * "Character Animation with Direct3D", Charles River Media 2009, chapter 4, also clones controllers, but its clones
 * write one shared tree of joints, so each must be drawn before the next is updated.)
 *
 * Threads: characters and scratches belong to one thread at a time; set, skeleton, table and settings are read-only and
 * shared. Several threads may step different characters and choose their levels at once; for updates each thread needs
 * its own view of the set (clip.h). */

typedef struct noh_character_desc {
    noh_controller_desc controller; /* set is required */
    uint32_t instance;              /* update phase: give each character its own number; default 0 */
    int64_t start_clock;            /* tick of the game's clock at its start; default 0 */
} noh_character_desc;

/* The head of the block; the rest follows at byte offsets from it. Read its fields, but change them only by calls. */
typedef struct noh_character {
    int64_t start_clock;
    uint32_t bytes; /* of the whole block */
    uint32_t joint_count, float_count;
    uint32_t controller_offset;
    uint32_t palette_offsets[2]; /* the floats of a pose follow its palette */
    float stretches[2];          /* how far the two poses stretch their joints */
    uint32_t updates;            /* since init */
    uint32_t multiplied;         /* a bit for each palette: 1 if multiplied by inverse bind matrices */
    noh_lod lod;
    noh_time_lod time;
    float spheres[2][4]; /* centre and radius around the two poses */
} noh_character;

/* Working memory of updates: one per thread and set. */
typedef struct noh_character_scratch {
    noh_pose_scratch pose;
    noh_controller *ahead; /* a copy of the controller, played to the next update */
    size_t ahead_bytes;
    noh_transform *local; /* [joint_count] the pose of an update */
    float *floats;        /* [float_count] its floats */
    uint32_t joint_count; /* joints that were sampled; the others have the bind pose */
    uint32_t pose_index;  /* 0 or 1: which of the character's two poses this update writes */
    float *model;         /* [joint_count][12] model-space matrices, after _end */
} noh_character_scratch;

/* Exact bytes of a character; 0 for an invalid desc. */
size_t noh_character_size(const noh_character_desc *desc);

/* Build a character in memory[bytes], with all tracks off and no valid pose.
 * errors  ARG a field of the desc, or memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small (need: the
 *         exact bytes) */
noh_result noh_character_init(void *memory, size_t bytes, const noh_character_desc *desc, noh_character **character,
                              noh_error *error);

/* Working memory for characters of this desc, or of a desc with fewer tracks and changes.
 * errors  as noh_character_init */
size_t noh_character_scratch_size(const noh_character_desc *desc);
noh_result noh_character_scratch_init(void *memory, size_t bytes, const noh_character_desc *desc,
                                      noh_character_scratch *scratch, noh_error *error);

noh_controller *noh_character_controller(noh_character *ch);

/* Advance time and deliver callback keys, as noh_controller_step. LOD levels do not affect it. */
uint32_t noh_character_step(noh_character *ch, const noh_clip_set *set, uint32_t ticks, noh_event_fn fn, void *user);

/* Choose the LOD levels of a character in view, and return whether an update is due. Call at most once a frame. The
 * controller then plays for the chosen mesh level and samples the joints of the chosen joint level.
 * units   pixels_per_metre at its nearest point (noh_lod_scale) */
noh_due noh_character_select_lod(noh_character *ch, const noh_lod_table *table, const noh_lod_settings *settings,
                                 float pixels_per_metre);

/* Pose a character for this frame or for the next update; calls _begin and _end. Not within a callback of
 * noh_character_step. */
void noh_character_update(noh_character *ch, const noh_clip_set *set, const noh_skeleton *skeleton,
                          const float *joint_radius_m, noh_character_scratch *scratch);

/* The first joint_count matrices shown in this frame, after an update, in the skeleton's order: as from
 * noh_model_to_palette for the skeleton passed to update_end. They are the joints' model-space matrices unless this
 * skeleton has inverse bind matrices; to draw a mesh, call noh_character_skin, which handles both cases.
 * shapes   mixed[joint_count][12]
 * returns  `mixed`, or the character's own matrices if no blend was needed; valid until the next update */
const float *noh_character_palette(const noh_character *ch, float *mixed, uint32_t joint_count);

/* The floats shown in this frame, returned as noh_character_palette does.
 * shapes  mixed[float_count of the set] */
const float *noh_character_floats(const noh_character *ch, float *mixed);

/* Call after changing tracks or weights. An update is then due, and the character moves to the changed pose within half
 * to one update period. */
void noh_character_wake(noh_character *ch);

/* Get the skin's matrices of a character in this frame, after an update.
 * shapes  matrices[joint_count of the skin][12]
 * ranges  skin: of the skeleton that updates the character; if the skeleton has inverse bind matrices, they must be
 *         this skin's (noh_skin_skeleton) */
void noh_character_skin(const noh_character *ch, const noh_skin *skin, float *matrices);

/* Give a skeleton the inverse bind matrices of a skin, if only meshes of this skin are drawn. Updates then multiply by
 * them, and noh_character_skin only blends and gathers. If the skin contains a joint twice, this is impossible: `out`
 * then has no inverse bind matrices, which noh_character_skin also accepts.
 * shapes   inverse_bind[joint_count of the skeleton][12], borrowed by `out`; out may be skeleton
 * returns  1: `out` has inverse bind matrices; 0: it has none */
int noh_skin_skeleton(const noh_skin *skin, const noh_skeleton *skeleton, float *inverse_bind, noh_skeleton *out);

/* The bounding sphere in this frame: centre x, y, z and radius, in object space. Updates must be given the joint
 * radii. */
void noh_character_sphere(const noh_character *ch, float sphere[4]);

/* Call when the camera has jumped: LOD levels are chosen again, and the character is posed before it is shown. */
void noh_character_cut(noh_character *ch);

/* ---- memory ---- */

/* Check a block from outside, such as a saved game, before any other call. If it passes, no call overruns its memory.
 * Its poses are checked to be numbers, so until the next update the character may look wrong.
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

/* Before an update of `on`, or in a frame without one: `ch` is posed and shown at the same times. */
void noh_character_keep_time(noh_character *ch, const noh_character *on);

/* After the updates of both: the joints of `ch` that follow others have their matrices, and those that do not follow
 * have stayed with `ch`.
 * shapes  joints[joint_count of ch]: of `on`, or NOH_JOINT_ROOT; both skeletons without inverse bind matrices
 * ranges  fresh: 1: `ch` was not posed when `on` was posed before */
void noh_character_follow(noh_character *ch, const noh_character *on, const uint16_t *joints, int fresh);

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
