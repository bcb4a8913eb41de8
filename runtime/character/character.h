/* character.h: one character: its controller, its detail, and what it shows (rows C4.4, C16.4).
 *
 * A character is one block of bytes without a pointer in it: clone, save or move it with one memcpy of
 * noh_character_bytes(ch). Hundreds lie in one array. What they share (the set, the detail table, the working
 * memory) is handed to every call.
 *
 * A frame of a game:
 *   noh_character_step(ch, set, ticks, fn, user)              for every character, seen or not: clock and callback keys
 *   due = noh_character_look(ch, table, settings, scale)      for those that are seen: chooses detail
 *   noh_character_update(ch, set, skeleton, margins, &scratch)  for those that are due: samples, blends, makes matrices
 *   noh_character_skin(ch, skin, matrices)                    for those that are drawn: skinning matrices (skin_palette.h)
 * Updates can be left to a budget: see scheduler.h. Change tracks through noh_character_controller, then
 * call noh_character_wake. After a memcpy, noh_character_number gives the copy its own place among the updates.
 *
 * Bytes: 160 for the head, those of the controller (controller.h), and two palettes of 48 per joint with 4 per
 * float, each rounded up to 16. 31 joints, 34 floats and 4 tracks: 3,888; with room for inertia 5,648. */
#ifndef NOH_CHARACTER_CHARACTER_H
#define NOH_CHARACTER_CHARACTER_H

#include "anim/controller_pose.h"
#include "character/bounds.h"
#include "character/time_lod.h"

typedef struct noh_character_desc {
    noh_controller_desc controller; /* set is required */
    uint32_t instance;              /* its number among those that are updated together; default 0 */
    int64_t start_clock;            /* tick of the game's clock at which it begins; default 0 */
} noh_character_desc;

/* The head of the block; the rest follows at byte offsets from it. Read what you like. */
typedef struct noh_character {
    int64_t start_clock;
    uint32_t bytes;                 /* of the whole block */
    uint32_t joint_count, float_count;
    uint32_t controller_offset;
    uint32_t palette_offsets[2], float_offsets[2];
    uint32_t updates;               /* since init */
    uint32_t multiplied;            /* a bit per palette: it was multiplied by the skeleton's inverse bind matrices */
    noh_detail detail;
    noh_time_lod time;
    float spheres[2][4];            /* centre and radius around each of the poses */
} noh_character;

/* Working memory of updates: one for all characters of a set that are updated one after another. */
typedef struct noh_character_scratch {
    noh_pose_scratch pose;
    noh_controller *ahead; /* a controller that is played ahead of its time */
    size_t ahead_bytes;
    noh_transform *local;  /* [joint_count] between noh_character_update_begin and _end: the pose, */
    float *floats;         /* [float_count] the floats, */
    uint32_t joint_count;  /* how many joints of it were sampled, */
    uint32_t slot;         /* and where it goes */
    float *model;          /* [joint_count][12] */
} noh_character_scratch;

/* ---- memory ---- */

/* Exact bytes; 0 for an impossible desc. */
size_t noh_character_size(const noh_character_desc *desc);

/* Make a character in memory[bytes], 16-byte aligned: all tracks off, nothing posed.
 * errors  ARG names the field; MEMORY need: the bytes */
noh_result noh_character_init(void *memory, size_t bytes, const noh_character_desc *desc, noh_character **character, noh_error *error);

/* Of the working memory for characters of such a desc, or of fewer tracks and changes. errors as above */
size_t noh_character_scratch_size(const noh_character_desc *desc);
noh_result noh_character_scratch_init(void *memory, size_t bytes, const noh_character_desc *desc, noh_character_scratch *scratch, noh_error *error);

/* What to copy to clone or save it. The copy must be 16-byte aligned too. */
size_t noh_character_bytes(const noh_character *ch);

/* Give a copy its own number among the updates. */
void noh_character_number(noh_character *ch, uint32_t instance);

noh_controller *noh_character_controller(noh_character *ch);

/* ---- a frame ---- */

/* Ticks of the game's clock at which the character stands. */
int64_t noh_character_clock(const noh_character *ch);

/* Move time on and deliver callback keys: noh_controller_step, whatever the detail. */
uint32_t noh_character_step(noh_character *ch, const noh_anim_set *set, uint32_t ticks, noh_event_fn fn, void *user);

/* It is seen in this frame, a metre of it is so many pixels: choose its detail, and say whether an update is due.
 * Once a frame. The controller's lod becomes the mesh level, its joints those of the joint level. */
noh_due noh_character_look(noh_character *ch, const noh_detail_table *table, const noh_detail_settings *settings, float pixels_per_metre);

/* Ticks since an update was due, for noh_schedule_offer. */
uint32_t noh_character_late(const noh_character *ch);

/* How many joints an update samples or blends: joints times tracks, for noh_cost_of. */
uint32_t noh_character_joints(const noh_character *ch);

/* Pose it, for this frame or ahead: both of what follows. Not within a callback of noh_character_step. */
void noh_character_update(noh_character *ch, const noh_anim_set *set, const noh_skeleton *skeleton, const float *margin_m,
                          noh_character_scratch *scratch);

/* The local pose into scratch->local and scratch->floats, where a program may change it before the second half: look-at, IK. */
void noh_character_update_begin(noh_character *ch, const noh_anim_set *set, noh_character_scratch *scratch);

/* Its matrices and bounds into the character. Joints that were not sampled go where their parents go.
 * shapes  margin_m[joint_count] as bounds.h has it; NULL: no sphere is kept */
void noh_character_update_end(noh_character *ch, const noh_skeleton *skeleton, const float *margin_m, noh_character_scratch *scratch);

/* The first joint_count matrices shown in this frame, once the character was updated, in the skeleton's order: as
 * noh_model_to_palette makes them of the skeleton that update_end was given. They are model-space joint matrices unless
 * that skeleton has inverse bind matrices; to draw a mesh call noh_character_skin, which knows.
 * shapes   mixed[joint_count][12]
 * returns  `mixed`, or the character's own matrices where nothing had to be mixed: valid until the next update */
const float *noh_character_palette(const noh_character *ch, float *mixed, uint32_t joint_count);

/* The same of its floats.
 * shapes  mixed[float_count of the set] */
const float *noh_character_floats(const noh_character *ch, float *mixed);

/* A sphere around what is shown in this frame: centre x, y, z and radius, in object space. */
void noh_character_sphere(const noh_character *ch, float sphere[4]);

/* Something was changed: tracks started, sought or stopped, a weight set. What is shown goes there in half a
 * period to one from the next update on, which is due from now on. */
void noh_character_wake(noh_character *ch);

/* The camera has jumped: choose detail afresh, pose before it is shown. */
void noh_character_cut(noh_character *ch);

#endif
