/* recipe.h: maps what a face shows to the morph targets of its mesh.
 *
 *   noh_face_channels       a pose and speech as one number per channel
 *   noh_face_share          resolve conflicts over mouth, lids and eyes
 *   noh_face_recipe_bind    bind a recipe's rows to a mesh's targets by name; noh_face_recipe_bind_by: by a function
 *   noh_face_recipe_in_pack an artist's recipe in a pack; noh_face_recipe_of_pack: the same as a table
 *   noh_face_apply          channels to weights
 *
 * A recipe is a table of rows (channel, target, weight). Three are built in: for ARKit's 52 names, for VRM's presets,
 * and for names of facial action units. Pass several, the best first: each channel uses the first recipe for which the
 * mesh has all targets, else the first for which it has any. A mouth shape without any target uses the targets of the
 * nearest other shape.
 *
 * Threads: a binding and recipes may be shared. */
#ifndef NOH_FACE_RECIPE_H
#define NOH_FACE_RECIPE_H

#include "life/face/face.h"
#include "core/pack/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

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
    NOH_CHANNEL_UPPER,                                         /* brows, lids and nose of each emotion */
    NOH_CHANNEL_MOUTH = NOH_CHANNEL_UPPER + NOH_EMOTION_COUNT, /* its mouth, as far as speech allows */
    NOH_CHANNEL_VISEMES = NOH_CHANNEL_MOUTH + NOH_EMOTION_COUNT,
    NOH_CHANNEL_COUNT = NOH_CHANNEL_VISEMES + NOH_VISEME_COUNT
} noh_face_channel;

/* How speech affects the mouth shape of an emotion, like VRM's overrideMouth. */
typedef enum noh_mouth_rule {
    NOH_MOUTH_BLEND = 0, /* reduces it by as much as speech moves the mouth */
    NOH_MOUTH_BLOCK,     /* removes it while speech moves the mouth at all */
    NOH_MOUTH_NONE       /* both add up, except for lips that must close */
} noh_mouth_rule;

/* How an expression affects another user of the face, like VRM's overrideBlink, overrideLookAt and overrideMouth. */
typedef enum noh_override {
    NOH_OVERRIDE_NONE = 0, /* both add up */
    NOH_OVERRIDE_BLOCK,    /* removes the other as soon as the expression shows */
    NOH_OVERRIDE_BLEND     /* reduces the other by as much as the expression shows */
} noh_override;

/* Conflict rules for mouth, lids and eyes. Zeros: speech reduces an emotion's mouth by as much as it moves the mouth,
 * and an emotion leaves blinks, looks and speech unchanged. Whatever the rules, lips closed by p, b, m, f or v stay
 * closed. */
typedef struct noh_face_rules {
    uint8_t mouth[NOH_EMOTION_COUNT];  /* noh_mouth_rule: speech over the emotion's mouth */
    uint8_t lids[NOH_EMOTION_COUNT];   /* noh_override: the emotion over blinks and lids */
    uint8_t eyes[NOH_EMOTION_COUNT];   /* the emotion over the eyes' targets */
    uint8_t speech[NOH_EMOTION_COUNT]; /* the emotion over the mouth shapes of speech */
} noh_face_rules;

/* Apply the rules to channels made with NOH_MOUTH_NONE. moves, shut: how much speech from a clip moves and closes the
 * mouth in addition to the channels' own visemes, 0..1. */
void noh_face_share(const noh_face_rules *rules, float moves, float shut, float *channels);

/* Compute channels from a pose and mouth shapes.
 * pose    NULL: at rest; desc is then unused
 * shapes  visemes[NOH_VISEME_COUNT], 0..1; NULL: silent. channels[NOH_CHANNEL_COUNT]
 * The lips close for p, b and m, and the lower lip touches the teeth for f and v, whatever the emotion and the other
 * mouth shapes: these two reduce all others. */
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

/* Get the recipe in a pack (`noh build --recipe`) as a table. Skips rows of unknown channels.
 * shapes  rows[row_max]; they refer to the pack's strings
 * errors  NOT_FOUND the pack has none; MEMORY more rows than row_max (need: the count). *recipe is then unchanged */
noh_result noh_face_recipe_of_pack(const noh_pack *pack, noh_face_row *rows, uint32_t row_max, noh_face_recipe *recipe,
                                   noh_error *error);

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

#ifdef __cplusplus
}
#endif

#endif
