/* recipe.h: from what a face shows to the morph targets that it has.
 *
 *   noh_face_channels       a pose, and what it says, as one number for each thing that can show
 *   noh_face_share          who owns mouth, lids and eyes
 *   noh_face_recipe_bind    a recipe's rows to the targets of a mesh, by name; noh_face_recipe_bind_by: by a function
 *   noh_face_recipe_in_pack the recipe that an artist put into a pack; noh_face_recipe_of_pack: as a table
 *   noh_face_apply          channels to weights
 *
 * A recipe is a table of rows (channel, target, weight). Three are built in: for ARKit's 52 names, for VRM's presets,
 * and for names of facial action units. Give several, the best first: each channel takes the first that the mesh has
 * all targets for, else the first that it has any for; a mouth shape without any takes that of the nearest other one.
 *
 * Threads: a binding and recipes may be shared. */
#ifndef NOH_FACE_RECIPE_H
#define NOH_FACE_RECIPE_H

#include "life/face/face.h"
#include "core/pack/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The fifteen mouth shapes of speech, of MPEG-4's facial animation as most tools name them. */
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

/* Left and right are the face's own. The eyes' are shares of how far they turn at most. */
typedef enum noh_face_channel {
    NOH_CHANNEL_BLINK_LEFT = 0,
    NOH_CHANNEL_BLINK_RIGHT,
    NOH_CHANNEL_EYES,                           /* eight: up, down, out, in of the left eye, then of the right one */
    NOH_CHANNEL_LIDS_UP = NOH_CHANNEL_EYES + 8, /* lids that follow the eyes up */
    NOH_CHANNEL_LIDS_DOWN,                      /* and down, where no target of the eyes does that */
    NOH_CHANNEL_BREATH,
    NOH_CHANNEL_UPPER,                                         /* brows, lids and nose of each emotion */
    NOH_CHANNEL_MOUTH = NOH_CHANNEL_UPPER + NOH_EMOTION_COUNT, /* its mouth, as far as speech leaves it */
    NOH_CHANNEL_VISEMES = NOH_CHANNEL_MOUTH + NOH_EMOTION_COUNT,
    NOH_CHANNEL_COUNT = NOH_CHANNEL_VISEMES + NOH_VISEME_COUNT
} noh_face_channel;

/* What speech does to the mouth that an emotion makes, as VRM's overrideMouth. */
typedef enum noh_mouth_rule {
    NOH_MOUTH_BLEND = 0, /* takes as much of it away as it moves the mouth */
    NOH_MOUTH_BLOCK,     /* takes it away while it moves the mouth at all */
    NOH_MOUTH_NONE       /* nothing: both add up, but lips that must be shut */
} noh_mouth_rule;

/* What an expression does to what it shares the face with, as VRM's overrideBlink, overrideLookAt and overrideMouth. */
typedef enum noh_override {
    NOH_OVERRIDE_NONE = 0, /* both add up */
    NOH_OVERRIDE_BLOCK,    /* it takes all of the other as soon as it shows */
    NOH_OVERRIDE_BLEND     /* it takes as much of the other as it shows */
} noh_override;

/* Who owns mouth, lids and eyes. Zeros: speech takes the mouth from an emotion as much as it moves it, and an emotion
 * leaves blinks, looks and speech as they are. Whatever the rules, lips that p, b, m, f or v shut stay shut. */
typedef struct noh_face_rules {
    uint8_t mouth[NOH_EMOTION_COUNT];  /* noh_mouth_rule: speech over the emotion's mouth */
    uint8_t lids[NOH_EMOTION_COUNT];   /* noh_override: the emotion over blinks and lids, */
    uint8_t eyes[NOH_EMOTION_COUNT];   /* over the eyes' targets, */
    uint8_t speech[NOH_EMOTION_COUNT]; /* and over the mouth shapes of speech */
} noh_face_rules;

/* Share channels that were not shared yet (noh_face_channels with NOH_MOUTH_NONE). moves, shut: how much of the mouth
 * speech moves and shuts beside the channels' own visemes, 0..1, as a clip tells it. */
void noh_face_share(const noh_face_rules *rules, float moves, float shut, float *channels);

/* pose    NULL: at rest; desc is not used then
 * shapes  visemes[NOH_VISEME_COUNT], 0..1; NULL: says nothing. channels[NOH_CHANNEL_COUNT]
 * The lips are shut for p, b and m, and the lower one is at the teeth for f and v, whatever the emotion and the other
 * mouth shapes: these two take their share from all the others. */
void noh_face_channels(const noh_face_pose *pose, const noh_face_desc *desc, const float *visemes, noh_mouth_rule rule,
                       float *channels);

typedef struct noh_face_row {
    const char *target;
    uint16_t channel;
    float weight; /* at a channel of 1; -4..4 */
} noh_face_row;

typedef struct noh_face_recipe {
    const char *name;
    const noh_face_row *rows; /* [row_count] */
    uint32_t row_count;
    const noh_pack *pack; /* not NULL: the rows are those of this pack, and `rows` is not used */
} noh_face_recipe;

extern const noh_face_recipe noh_face_recipe_arkit; /* browInnerUp, jawOpen, mouthSmileLeft and so on */
extern const noh_face_recipe noh_face_recipe_vrm;   /* aa, ih, ou, blinkLeft, happy, lookUp and so on */
extern const noh_face_recipe noh_face_recipe_units; /* mouth-open, eye-left-closure, eyebrows-left-down and so on */

/* The name of a channel, as recipes in packs and texts have it: blink-left, eye-right-out, joy-mouth, PP; "" past the
 * last. And the channel of a name; NOH_NONE: there is none of it. */
const char *noh_face_channel_name(uint32_t channel);
uint32_t noh_face_channel_find(const char *name);

/* The recipe that a pack brings, read where it lies in the pack. Without any row where the pack brings none. */
noh_face_recipe noh_face_recipe_in_pack(const noh_pack *pack);

/* The recipe that a pack brings (`noh build --recipe`) as a table. Rows of unknown channels are left out.
 * shapes  rows[row_max]; they refer to the pack's strings
 * errors  NOT_FOUND the pack has none; MEMORY more rows than row_max (need: how many). *recipe is then untouched */
noh_result noh_face_recipe_of_pack(const noh_pack *pack, noh_face_row *rows, uint32_t row_max, noh_face_recipe *recipe,
                                   noh_error *error);

typedef struct noh_face_link {
    uint16_t channel, target;
    float weight;
} noh_face_link;

/* The rows that a mesh has targets for.
 * shapes   recipes[recipe_count], NULL: the three built in; names[target_count], as noh_stage_name gives those of an
 *          actor's floats; links[link_max]
 * returns  how many links there are; those past link_max are not written */
uint32_t noh_face_recipe_bind(const noh_face_recipe *const *recipes, uint32_t recipe_count, const char *const *names,
                              uint32_t target_count, noh_face_link *links, uint32_t link_max);

/* The same for names that are not in one list: find gives the nth target of a name, NOH_NONE past the last, and is
 * called for one name any number of times. */
typedef uint32_t (*noh_face_find_fn)(const void *user, const char *name, uint32_t nth);

uint32_t noh_face_recipe_bind_by(const noh_face_recipe *const *recipes, uint32_t recipe_count, noh_face_find_fn find,
                                 const void *user, noh_face_link *links, uint32_t link_max);

/* Where a channel's links come from. */
typedef struct noh_face_source {
    const noh_face_recipe *recipe;   /* NULL: the channel shows nothing */
    uint32_t channel;                /* itself, or the mouth shape whose targets it takes */
    uint32_t row_count, found_count; /* of that recipe and channel; and how many of these the mesh has targets for */
} noh_face_source;

/* As noh_face_recipe_bind chooses it.
 * ranges  channel below NOH_CHANNEL_COUNT */
void noh_face_recipe_source(const noh_face_recipe *const *recipes, uint32_t recipe_count, const char *const *names,
                            uint32_t target_count, uint32_t channel, noh_face_source *source);

/* Add the channels to weights, and hold those that they move within 0..1, or up to the largest weight of a target's
 * links where that is more.
 * shapes  channels[NOH_CHANNEL_COUNT], weights[as many as names were bound] */
void noh_face_apply(const noh_face_link *links, uint32_t link_count, const float *channels, float *weights);

#ifdef __cplusplus
}
#endif

#endif
