/* face.h: what a face shows and says: recipes that turn emotions and visemes into the targets of any rig, speech from
 * text or sound, people by seed, a face that blinks and breathes. Faces of actors: modules.h. */

#ifndef NOH_FACE_H
#define NOH_FACE_H

#include <stdint.h>

#include "base.h"
#include "pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== a face ========
 * Involuntary motion of a face: blinks, gaze, emotions, breath, small motions of the head.
 *
 *   noh_face_init          make a face from a seed: at rest, looking ahead
 *   noh_face_step          advance time
 *   noh_face_look_at       turn the eyes to a point, and the head if the eyes do not reach; noh_face_follow: track it
 *   noh_face_set_emotion   start an emotion, which rises, holds and fades
 *   noh_face_set_activity  resting, talking or reading: sets the blink rate and how long the gaze rests on a point
 *   noh_face_speak         what speech asks of brows, head, lids and gaze
 *   noh_face_blink         blink now
 *   noh_face_pose_of       the visible pose
 *
 * A face is 256 bytes without pointers: copy it to clone it. It depends only on the seed, the calls and the clock in
 * whole ticks: the same bits on every processor, however time is split into steps.
 *
 * Space     neck space: x to the face's left, y up, z ahead, the origin at the joint that turns the head. Metres,
 * radians.
 *           Positive yaw turns to the left, positive pitch up.
 * Time      ticks of 1/48,000 s (NOH_TICKS_PER_SECOND).
 * Threads   a face belongs to one thread at a time; a desc may be shared. */

typedef enum noh_emotion {
    NOH_EMOTION_JOY = 0,
    NOH_EMOTION_SADNESS,
    NOH_EMOTION_SURPRISE,
    NOH_EMOTION_FEAR,
    NOH_EMOTION_ANGER,
    NOH_EMOTION_DISGUST,
    NOH_EMOTION_CONTEMPT,
    NOH_EMOTION_COUNT
} noh_emotion;

/* The name of an emotion, "joy", "sadness" and so on; NULL past the last. */
const char *noh_emotion_name(noh_emotion emotion);

typedef enum noh_activity {
    NOH_ACTIVITY_REST = 0,
    NOH_ACTIVITY_TALK,
    NOH_ACTIVITY_READ,
    NOH_ACTIVITY_COUNT
} noh_activity;

#define NOH_FACE_CALM 1u     /* nothing moves by itself: no blinks, breath, wandering gaze or idle head */
#define NOH_FACE_NO_BLINK 2u /* no spontaneous blinks; calls still blink. The next flags likewise */
#define NOH_FACE_NO_WANDER 4u
#define NOH_FACE_NO_BREATH 8u
#define NOH_FACE_NO_IDLE 16u
/* Granberg's controller of four channels: one blink at even intervals, spontaneous emotions one at a time, two mouth
 * shapes; gaze, breath and head are unchanged */
#define NOH_FACE_FOUR 32u
#define NOH_FACE_FLAGS 63u

/* What faces of one kind share. */
typedef struct noh_face_desc {
    float eyes[2][3];                   /* centres of the left and the right eye, neck space; required */
    float head_yaw_max, head_pitch_max; /* how far the head turns, radians; default (0) 75 and 40 degrees */
} noh_face_desc;

typedef struct noh_face_spring {
    float from, speed, goal, omega;
    uint32_t start; /* tick, modulo 2^32 */
} noh_face_spring;

typedef struct noh_face_emotion {
    noh_face_spring amount;
    uint32_t end; /* tick at which it begins to fade, modulo 2^32 */
    float fade_omega;
    uint8_t emotion, on, holds, reserved;
} noh_face_emotion;

/* What speech asks of the face besides the mouth: each 0..1. */
typedef struct noh_face_speech {
    float brows; /* up */
    float nod;   /* of the head, down */
    float blink; /* blinks once, as it rises above one half */
    float away;  /* looks aside for as long as it is above one half */
} noh_face_speech;

/* Fields are private; the type is complete so that it can be stored in an array. */
typedef struct noh_face {
    int64_t clock;
    uint32_t seed;
    uint32_t blinks, breaths, glances, tremors; /* counts that select the next random numbers */
    uint32_t next_blink, blink_start;           /* ticks modulo 2^32, as all below */
    uint32_t breath_start, next_glance, next_tremor;
    uint32_t gaze_start, gaze_ticks; /* of a saccade, or until it begins */
    float from[3];                   /* yaw, pitch and 1 / distance at the start of a saccade */
    float target[3];                 /* point, neck space */
    float away[2];                   /* yaw and pitch from the target to the gaze */
    float tremor[2];
    noh_face_spring head[2]; /* yaw, pitch */
    noh_face_emotion emotions[NOH_FACE_EMOTIONS_MAX];
    uint8_t activity, flags, gaze, blinking;
    uint32_t moods; /* number of spontaneous emotions so far */
    noh_face_speech speech;
} noh_face;

/* The visible state of a face in one frame. */
typedef struct noh_face_pose {
    float head[4];                     /* rotation of the head in the neck, quaternion */
    float head_angles[3];              /* the same rotation as yaw, pitch and roll */
    float eyes[2][2];                  /* yaw and pitch of the left and the right eye in the head */
    float blink;                       /* 0 open .. 1 closed */
    float lids_down, lids_up;          /* 0..1: how far the lids follow the eyes down and up */
    float breath;                      /* 0 exhaled .. 1 inhaled */
    float brows;                       /* 0..1: how far the brows are up */
    float emotions[NOH_EMOTION_COUNT]; /* 0..1 */
} noh_face_pose;

/* Make a face at rest.
 * flags    NOH_FACE_*
 * errors   ARG a field of the desc is negative, too large or not finite, or the eyes are at the same point (where: the
 *          index among the desc's floats) */
noh_result noh_face_init(noh_face *face, const noh_face_desc *desc, uint32_t seed, uint32_t flags, noh_error *error);

void noh_face_set_flags(noh_face *face, uint32_t flags);

/* Advance time. Everything due within the step happens at its own tick. */
void noh_face_step(noh_face *face, const noh_face_desc *desc, uint32_t ticks);

/* Look at a point from now on. The eyes follow a nearby point; to a farther one they make a saccade, after the human
 * reaction time.
 * point   neck space, metres; NULL: ahead, at 2 m
 * errors  ARG not finite, or nearer than 5 cm to the midpoint of the eyes */
noh_result noh_face_look_at(noh_face *face, const noh_face_desc *desc, const float point[3], noh_error *error);

/* Update the gaze target after it or the neck moved. The eyes stay on it without a saccade, as when a person's head is
 * turned.
 * errors  as noh_face_look_at */
noh_result noh_face_follow(noh_face *face, const noh_face_desc *desc, const float point[3], noh_error *error);

/* Start an emotion, or change a visible one. With NOH_FACE_FOUR it replaces the present one, and rises and fades in one
 * second each; hold_ticks 0 holds it as long as spontaneous ones.
 * ranges  amount 0..1; hold_ticks below 2^31, 0: until it is changed. onset_ticks, fade_ticks: time to reach 95 %; 0:
 *         0.35 and 0.8 s. A micro-expression has a hold of 0.04 to 0.2 s and an equally short onset
 * errors  ARG */
noh_result noh_face_set_emotion(noh_face *face, noh_emotion emotion, float amount, uint32_t onset_ticks,
                                uint32_t hold_ticks, uint32_t fade_ticks, noh_error *error);

void noh_face_set_activity(noh_face *face, noh_activity activity);

/* Blink now. Replaces the next spontaneous blink, so that the blink rate stays the same. */
void noh_face_blink(noh_face *face);

/* Set what speech asks of the face, until it is set again. Blinks of speech take the place of spontaneous ones.
 * speech  NULL: nothing
 * errors  ARG a field is not in 0..1 */
noh_result noh_face_speak(noh_face *face, const noh_face_desc *desc, const noh_face_speech *speech, noh_error *error);

void noh_face_pose_of(const noh_face *face, const noh_face_desc *desc, noh_face_pose *pose);

/* ======== recipes ========
 * Maps what a face shows to the morph targets of its mesh.
 *
 *   noh_face_channels       a pose and speech as one number per channel
 *   noh_face_recipe_bind    bind a recipe's rows to a mesh's targets by name; noh_face_recipe_bind_by: by a function
 *   noh_face_recipe_in_pack an artist's recipe in a pack
 *   noh_face_rules_of_pack  a pack's rules between an emotion and blinks, looks and speech
 *   noh_face_apply          channels to weights
 *
 * A recipe is a table of rows (channel, target, weight). Three are built in: for ARKit's 52 names, for VRM's presets,
 * and for names of facial action units. Pass several, the best first: each channel uses the first recipe for which the
 * mesh has all targets, else the first for which it has any. A mouth shape without any target uses the targets of the
 * nearest other shape; fear and disgust without any use some of surprise's and anger's.
 *
 * Threads: a binding and recipes may be shared. */

/* The fifteen mouth shapes of speech, from MPEG-4 facial animation, with the names that most tools use. */
typedef enum noh_viseme {
    NOH_VISEME_SIL = 0,
    NOH_VISEME_PP, /* p b m */
    NOH_VISEME_FF, /* f v */
    NOH_VISEME_TH,
    NOH_VISEME_DD, /* t d */
    NOH_VISEME_KK, /* k g h ng */
    NOH_VISEME_CH, /* ch j sh zh */
    NOH_VISEME_SS, /* s z */
    NOH_VISEME_NN, /* n l */
    NOH_VISEME_RR,
    NOH_VISEME_AA,
    NOH_VISEME_E,
    NOH_VISEME_IH,
    NOH_VISEME_OH,
    NOH_VISEME_OU,
    NOH_VISEME_COUNT
} noh_viseme;

/* Left and right are the face's own. Eye channels are fractions of the largest turn. */
typedef enum noh_face_channel {
    NOH_CHANNEL_BLINK_LEFT = 0,
    NOH_CHANNEL_BLINK_RIGHT,
    NOH_CHANNEL_EYES,                           /* eight: up, down, out, in of the left eye, then of the right eye */
    NOH_CHANNEL_LIDS_UP = NOH_CHANNEL_EYES + 8, /* lids that follow the eyes up */
    NOH_CHANNEL_LIDS_DOWN,                      /* lids that follow the eyes down, where no eye target does that */
    NOH_CHANNEL_BREATH,
    NOH_CHANNEL_BROWS, /* brows up, at rest and with speech, in addition to what emotions do */
    NOH_CHANNEL_UPPER, /* brows, lids and nose of each emotion */
    NOH_CHANNEL_MOUTH = NOH_CHANNEL_UPPER + NOH_EMOTION_COUNT, /* its mouth, as far as speech allows */
    NOH_CHANNEL_VISEMES = NOH_CHANNEL_MOUTH + NOH_EMOTION_COUNT,
    NOH_CHANNEL_COUNT = NOH_CHANNEL_VISEMES + NOH_VISEME_COUNT
} noh_face_channel;

/* How speech affects the mouth shape of an emotion, like VRM's overrideMouth. */
typedef enum noh_mouth_rule {
    NOH_MOUTH_BLEND = 0, /* reduces it by half as much as speech moves the mouth: a smile stays below the shapes */
    NOH_MOUTH_BLOCK,     /* removes it while speech moves the mouth at all */
    NOH_MOUTH_NONE       /* both add up, except for lips that must close */
} noh_mouth_rule;

/* How an expression affects another user of the face, like VRM's overrideBlink, overrideLookAt and overrideMouth. */
typedef enum noh_override {
    NOH_OVERRIDE_NONE = 0, /* both add up */
    NOH_OVERRIDE_BLOCK,    /* removes the other as soon as the expression shows */
    NOH_OVERRIDE_BLEND     /* reduces the other by as much as the expression shows */
} noh_override;

/* Conflict rules for mouth, lids and eyes. Zeros: speech reduces an emotion's mouth by half as much as it moves the
 * mouth, and an emotion leaves blinks, looks and speech unchanged. Whatever the rules, lips closed by p, b, m, f or v
 * stay closed. */
typedef struct noh_face_rules {
    uint8_t mouth[NOH_EMOTION_COUNT];  /* noh_mouth_rule: speech over the emotion's mouth */
    uint8_t lids[NOH_EMOTION_COUNT];   /* noh_override: the emotion over blinks and lids */
    uint8_t eyes[NOH_EMOTION_COUNT];   /* the emotion over the eyes' targets */
    uint8_t speech[NOH_EMOTION_COUNT]; /* the emotion over the mouth shapes of speech */
    uint8_t binary; /* bit i: emotion i shows whole above 0.5, else not at all, like VRM's isBinary */
} noh_face_rules;

/* Compute channels from a pose and mouth shapes.
 * pose    NULL: at rest
 * shapes  visemes[NOH_VISEME_COUNT], 0..1; NULL: silent. channels[NOH_CHANNEL_COUNT]
 * The lips close for p, b and m, and the lower lip touches the teeth for f and v, whatever the emotion and the other
 * mouth shapes: these two reduce all others. */
void noh_face_channels(const noh_face_pose *pose, const float *visemes, noh_mouth_rule rule, float *channels);

typedef struct noh_face_row {
    const char *target;
    uint16_t channel;
    float weight; /* at a channel of 1; -4..4 */
} noh_face_row;

typedef struct noh_face_recipe {
    const char *name;
    const noh_face_row *rows; /* [row_count] */
    uint32_t row_count;
    const noh_pack *pack; /* not NULL: the rows are in this pack, and `rows` is unused */
} noh_face_recipe;

extern const noh_face_recipe noh_face_recipe_arkit; /* browInnerUp, jawOpen, mouthSmileLeft and so on */
extern const noh_face_recipe noh_face_recipe_vrm;   /* aa, ih, ou, blinkLeft, happy, lookUp and so on */
extern const noh_face_recipe noh_face_recipe_units; /* mouth-open, eye-left-closure, eyebrows-left-down and so on */

/* Convert between a channel and its name in recipes of packs and texts: blink-left, eye-right-out, joy-mouth, PP.
 * Channels past the last give ""; unknown names give NOH_NONE. */
const char *noh_face_channel_name(uint32_t channel);
uint32_t noh_face_channel_find(const char *name);

/* Get the recipe in a pack, used in place. It has no rows if the pack has none. */
noh_face_recipe noh_face_recipe_in_pack(const noh_pack *pack);

/* Read the rules in a pack's recipe (rows `override` and `binary`, or VRM's); rules over the mouth become 0. Where fear
 * shows surprise's targets and the pack has no rule for fear, a stage applies surprise's rules, too; the same holds for
 * disgust and anger. */
void noh_face_rules_of_pack(const noh_pack *pack, noh_face_rules *rules);

typedef struct noh_face_link {
    uint16_t channel, target;
    float weight;
} noh_face_link;

/* Bind the rows for which a mesh has targets.
 * shapes   recipes[recipe_count], NULL: the three built in; names[target_count], as noh_stage_name returns them for an
 *          actor's floats; links[link_max]
 * returns  the number of links; links past link_max are not written */
uint32_t noh_face_recipe_bind(const noh_face_recipe *const *recipes, uint32_t recipe_count, const char *const *names,
                              uint32_t target_count, noh_face_link *links, uint32_t link_max);

/* Bind recipes to names that are not in one array. `find` returns the nth target with a name, NOH_NONE past the last;
 * it may be called repeatedly for a name. */
typedef uint32_t (*noh_face_find_fn)(const void *user, const char *name, uint32_t nth);

uint32_t noh_face_recipe_bind_by(const noh_face_recipe *const *recipes, uint32_t recipe_count, noh_face_find_fn find,
                                 const void *user, noh_face_link *links, uint32_t link_max);

/* The source of a channel's links. */
typedef struct noh_face_source {
    const noh_face_recipe *recipe;   /* NULL: the channel has no effect */
    uint32_t channel;                /* itself, or the mouth shape whose targets it uses */
    uint32_t row_count, found_count; /* rows for that recipe and channel; how many of them have a target in the mesh */
} noh_face_source;

/* Get the source that noh_face_recipe_bind chooses for a channel.
 * ranges  channel below NOH_CHANNEL_COUNT */
void noh_face_recipe_source(const noh_face_recipe *const *recipes, uint32_t recipe_count, const char *const *names,
                            uint32_t target_count, uint32_t channel, noh_face_source *source);

/* Add the channels to weights. Weights that they move are clamped to 0..1, or to the largest link weight of the target
 * if that is more.
 * shapes  channels[NOH_CHANNEL_COUNT], weights[as many as names were bound] */
void noh_face_apply(const noh_face_link *links, uint32_t link_count, const float *channels, float *weights);

/* ======== mouths by loudness ========
 * Mouth shapes from loudness alone, ten times a second, as early games did it.
 *
 *   noh_amplitude_init     start in the caller's memory
 *   noh_amplitude_hear     add samples, in chunks of any size, with any number of channels
 *   noh_amplitude_end      end the sound: the last partial window counts, and the mouth closes
 *   noh_amplitude_next     get finished windows
 *   noh_amplitude_between  interpolate the shapes between two windows
 *
 * The mean of |sample| over a tenth of a second, relative to 0.3 of the recent peak level, selects one of three shapes
 * and its weight (Granberg, "Character Animation with Direct3D", 2009, ch. 10, with its errors corrected: a partial
 * window is divided by its own length, there is no division by silence, windows do not drift, and the peak level is a
 * percentile of peaks, which one click does not change). noh_ear recognises shapes; this needs one addition per sample.
 *
 * Threads: one thread at a time. */

enum {
    NOH_AMPLITUDE_RATE = 10,       /* windows per second */
    NOH_AMPLITUDE_LATENCY_MS = 100 /* a window is complete at its end */
};

typedef struct noh_amplitude_frame {
    uint32_t index;    /* window: starts at index / 10 s */
    uint32_t mean;     /* of |sample|: 0..32768 */
    noh_viseme viseme; /* NOH_VISEME_SIL: weight is 0 */
    float weight;      /* 0.3..1 */
} noh_amplitude_frame;

/* Private: only its size is of use. */
typedef struct noh_amplitude {
    uint32_t rate, channels, channel; /* channel: of the next sample */
    uint32_t index, filled;           /* windows done; samples in the present window */
    uint32_t peak, loud;              /* of the present window; a percentile of recent peaks, 1/16 */
    uint32_t ended;                   /* 1: no more samples; 2: the closing window was returned too */
    uint64_t sum, frames;             /* |samples| of the present window; samples per channel since the start */
} noh_amplitude;

/* Start.
 * errors  ARG a sample rate outside 1000..192000 Hz; channels not 1..64 */
noh_result noh_amplitude_init(noh_amplitude *a, uint32_t sample_rate, uint32_t channels, noh_error *error);

/* Start a new sound and keep the peak level: for a speaker's next line, or to run a recording twice. */
void noh_amplitude_restart(noh_amplitude *a);

/* Add samples. count is the number of samples, channels interleaved.
 * returns  the number of samples taken; if less than `count`, a window is ready: call noh_amplitude_next first */
size_t noh_amplitude_hear(noh_amplitude *a, const int16_t *samples, size_t count);
void noh_amplitude_end(noh_amplitude *a);

/* Get the next window. After noh_amplitude_end the last window closes the mouth.
 * returns  1 if *frame was filled, else 0 */
int noh_amplitude_next(noh_amplitude *a, noh_amplitude_frame *frame);

/* Interpolate the weights of shapes at `part` (clamped to 0..1) of the way between two windows:
 * visemes[NOH_VISEME_COUNT]. */
void noh_amplitude_between(const noh_amplitude_frame *from, const noh_amplitude_frame *to, float part, float *visemes);

/* ======== live speech ========
 * Live sound to mouth shapes: weights of the fifteen visemes, a hundred times a second.
 *
 *   noh_ear_init     start in the caller's memory; no pointers, so memcpy clones it
 *   noh_ear_hear     add samples, in chunks of any size
 *   noh_ear_next     get finished frames
 *   noh_ear_restart  start the next line of the same speaker
 *
 * Windows of 25 ms every 10 ms become thirteen mel-frequency cepstral coefficients (Davis and Mermelstein, 1980), minus
 * their running mean, and loudness relative to recent loudness. A time-delay network of 16 KB, trained on synthetic
 * speech, reads the probabilities of shapes from fourteen such frames. Lips (closed, lip on teeth, rounded, open,
 * narrow) follow the likeliest path (Viterbi, 1967). All arithmetic is in integers: the same bits on every processor,
 * whatever the size of the chunks.
 *
 * A frame is ready latency_ms after its middle: a program that plays the sound itself can delay it by the same time.
 * More latency decides on lips with more of the sound known, and misses fewer closures.
 *
 * Threads: an ear belongs to one thread at a time. */

enum {
    NOH_EAR_MIN_RATE = 8000, /* Hz */
    NOH_EAR_MAX_RATE = 48000,
    NOH_EAR_FRAME_RATE = 100,    /* Hz */
    NOH_EAR_LATENCY_MIN_MS = 40, /* sound needed after the middle of a frame */
    NOH_EAR_LATENCY_MAX_MS = 80,
    NOH_EAR_BYTES = 2048
};

/* Private: only its size is of use. */
typedef struct noh_ear {
    uint64_t state[NOH_EAR_BYTES / 8];
} noh_ear;

typedef struct noh_ear_frame {
    uint32_t index;                  /* 0, 1, ...; its middle is at 10 * index + 12.5 ms */
    noh_viseme shape;                /* the visible shape */
    float visemes[NOH_VISEME_COUNT]; /* 0..1, sum 1: as from noh_speech_visemes */
    float open, round, closed;       /* 0..1: the jaw from all shapes and loudness, lips forward, lips closed */
} noh_ear_frame;

/* Start. latency_ms: NOH_EAR_LATENCY_MIN_MS..NOH_EAR_LATENCY_MAX_MS, in steps of 10 (rounded down).
 * errors  ARG a sample rate outside NOH_EAR_MIN_RATE..NOH_EAR_MAX_RATE, or a latency outside its range */
noh_result noh_ear_init(noh_ear *ear, uint32_t sample_rate, uint32_t latency_ms, noh_error *error);

/* Start a new sound with frame 0. Keeps the adaptation to speaker and room. */
void noh_ear_restart(noh_ear *ear);

/* Add samples of one channel until a frame is ready.
 * returns  the number of samples taken; if less than `count`, a frame is ready: call noh_ear_next first */
size_t noh_ear_hear(noh_ear *ear, const int16_t *samples, size_t count);

/* Get the next frame.
 * returns  1 if *frame was filled; 0: add more samples */
int noh_ear_next(noh_ear *ear, noh_ear_frame *frame);

/* ======== people by seed ========
 * Random faces: weights of the morph targets that make one person's face differ from another.
 *
 *   noh_identity_init     group a mesh's identity targets and find the range of each
 *   noh_identity_random   make a person from a seed
 *   noh_identity_bind     adjust blinks so that the person's lids close
 *   noh_actor_set_identity  (modules.h) give an actor an identity
 *   noh_complexion_random make the colours of a person's skin, hair and eyes from a seed
 *
 * A person is one vector of weights. Deltas of expressions are added to the person's face as to the rest face, so all
 * people share the targets of one mesh, and nothing is copied per person.
 *
 * Targets are grouped by names and deltas. Two targets are opposite (nose-width-decr, nose-width-incr) if their names
 * differ in one word and their deltas point against each other, and mirrored (l-ear-lobe-incr, r-ear-lobe-incr) if one
 * moves the mirror image of what the other moves. A person uses one of two opposite targets; mirrored targets get
 * similar weights. Targets that move the whole mesh without changing its shape are ignored. If a name contains age,
 * weight, muscle or gender, targets that move the same vertices in the same way are correlated with it. To keep faces
 * intact, targets that stretch the same place share a bound.
 *
 * Space    of the mesh: x to either side of a face that is symmetric about the middle of its bounds
 * Threads  read-only after init: any number of threads
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 9, where every person has a copy of every target,
 *          with weights that are independent and uniformly distributed */

#define NOH_IDENTITY_NONE 0xffffu

#define NOH_IDENTITY_CLOSINGS 4u /* most targets whose closing is tracked */

/* Zero is a good value for all. */
typedef struct noh_identity_desc {
    /* [target_count] 1: identity, 0: expression. NULL: as marked in the pack; without marks, all targets that no recipe
     * names */
    const uint8_t *is_identity;
    const noh_face_recipe *const *recipes; /* [recipe_count] NULL: the three built in */
    uint32_t recipe_count;
    float range; /* weight of one standard deviation, before bounds; above 0, at most 1; default (0) 0.6 */
    /* largest relative change of an edge's length at one standard deviation; above 0, at most 1; default (0) 0.18 */
    float strain;
    float asymmetry; /* difference of mirrored targets, in standard deviations; 0..1; default (0) 0.12 */
} noh_identity_desc;

/* Data of one target. */
typedef struct noh_identity_target {
    uint16_t opposite, mirror; /* targets, or NOH_IDENTITY_NONE */
    /* the target of age, weight and so on that it is correlated with, or NOH_IDENTITY_NONE */
    uint16_t leader;
    uint8_t used, negative; /* used: 1 if it varies between people. negative: 1 if negative samples select it */
    float range;            /* weight of one standard deviation; 0: unused */
    float along;            /* correlation with the leader, -1..1 */
    /* change, per unit of its weight, of the weight at which each lid is closed */
    float closing[NOH_IDENTITY_CLOSINGS];
} noh_identity_target;

/* A view into the memory passed to init. */
typedef struct noh_identity {
    const noh_identity_target *targets; /* [target_count] */
    uint32_t target_count, used_count;
    float asymmetry;
    uint16_t closings[NOH_IDENTITY_CLOSINGS]; /* targets that close lids */
    uint32_t closing_count;
} noh_identity;

/* Get the exact size in bytes of the identity, and of the scratch for init. */
size_t noh_identity_size(const noh_mesh *mesh);
size_t noh_identity_scratch_size(const noh_mesh *mesh);

/* Make an identity.
 * desc    NULL: zeros
 * errors  ARG a field of the desc is out of range, the mesh has no identity target, or memory or scratch is NULL or
 *         misaligned; MEMORY either is too small (need: its bytes) */
noh_result noh_identity_init(void *memory, size_t bytes, void *scratch, size_t scratch_bytes, const noh_mesh *mesh,
                             const noh_identity_desc *desc, noh_identity *identity, noh_error *error);

/* Make a person. Writes only weights of identity targets.
 * shapes  weights[target_count]
 * ranges  amount 0..2: 0 the mesh's own face, 1 natural variation; resulting weights are 0..1 */
void noh_identity_random(const noh_identity *identity, uint32_t seed, float amount, float *weights);

/* Scale a binding's links for a person, so that blinks close that person's lids, whatever the size of the eyes.
 * shapes  weights[target_count] of the person; links[link_count] as made by noh_face_recipe_bind for the same
 *         targets */
void noh_identity_bind(const noh_identity *identity, const float *weights, noh_face_link *links, uint32_t link_count);

/* Make the colours of a person, as noh_appearance.user of a stage with NOH_USER_COMPLEXION: what a head's own colours
 * change by, 0 by nothing. Each float holds three bytes, b0 + 256 b1 + 65536 b2; signed bytes are two's complement:
 *   user[0]  melanin, in 32nds of optical density, signed; blood, in 64ths, signed; freckles, in 255ths of all
 *   user[1]  of hair: melanin in 32nds, red in 64ths, signed; of lips: blood in 64ths, signed
 *   user[2]  the iris: square roots of linear red, green, blue, in 255ths
 *   user[3]  how much of that colour the iris takes, in 255ths; which freckles, 0..255; of brows: melanin beyond hair's,
 *            in 32nds, signed
 * The material's surface says what is skin, eye or hair; hair and brows are also found by its name. Seeds are drawn for
 * a head of light skin and brown hair.
 * ranges   amount 0..1: of the changes; 1: natural variation
 * source   Tsumura et al., "Independent-component analysis of skin color image", JOSA A 16, 1999: melanin and
 *          haemoglobin as densities that add; Jimenez et al., "A practical appearance model for dynamic facial color",
 *          2010 */
void noh_complexion_random(uint32_t seed, float amount, float user[4]);

/* ======== speech from phones ========
 * Mouth shapes of speech from timed phones.
 *
 *   noh_speech_visemes     the weights of the fifteen shapes at a tick
 *   noh_viseme_of_phone    the shape of a phone: ARPABET, or the International Phonetic Alphabet in UTF-8
 *
 * A mouth moves to the next sound before the last one has ended, and lips round long before the vowel that needs it. So
 * each phone dominates a stretch of time around its middle, rising and falling at the rates of its class, and shapes
 * are weighted by dominance (Cohen and Massaro, "Modeling coarticulation in synthetic visual speech", 1993). Closed
 * lips are applied last, after all smoothing: p, b and m for at least 34 ms, one frame at 30 Hz, whatever their
 * neighbours; then the lip on the teeth of f and v, in the time that p, b and m leave. Lips close a wide open mouth in
 * 80 ms, a narrow one in 30 ms.
 *
 * Threads: no state; any thread. */

typedef struct noh_phone {
    uint32_t start;  /* tick */
    uint32_t viseme; /* noh_viseme */
} noh_phone;

/* An utterance: consecutive phones, the last one until `end`. Silent before the first and after the last. */
typedef struct noh_speech {
    const noh_phone *phones; /* [phone_count] by increasing start */
    uint32_t phone_count;
    uint32_t end; /* tick */
} noh_speech;

/* Check an utterance.
 * errors  ARG no phones, or too many; DATA starts that do not increase, an end before the last start, an unknown viseme
 *         (where: the phone) */
noh_result noh_speech_check(const noh_speech *speech, noh_error *error);

/* Compute the weights at a tick: visemes[NOH_VISEME_COUNT], each 0..1, sum 1. Requires a checked utterance.
 * ranges  any tick; silent outside the utterance */
void noh_speech_visemes(const noh_speech *speech, int64_t tick, float *visemes);

/* Get the shape of a phone. *second is the second shape of a diphthong such as "ai", else NOH_VISEME_COUNT.
 * returns  NOH_VISEME_COUNT for an unknown phone */
noh_viseme noh_viseme_of_phone(const char *phone, noh_viseme *second);

#ifdef __cplusplus
}
#endif

#endif
