/* recipe.c: channels, and the targets that they move. */
#include "life/face/recipe_internal.h"
#include "noh/base.h"
#include "noh/face.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"
#include "life/face/face_internal.h"

#define TAKEN 0.5f /* by speech, of an emotion's mouth: NOH_MOUTH_BLEND */
#define LIKE 0.6f  /* of the emotion that is most like another one */

/* ---- channels ---- */

static float unit(float x)
{
    return x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x;
}

/* A fraction of a limit, in one direction. */
static float share(float angle, float limit)
{
    return unit(angle / limit);
}

static void eye_channels(const noh_face_pose *pose, float *channels)
{
    for (int eye = 0; eye < 2; eye++) {
        const float out = eye == 0 ? pose->eyes[0][0] : -pose->eyes[1][0];
        float *c = channels + NOH_CHANNEL_EYES + 4 * eye;
        c[0] = share(pose->eyes[eye][1], NOH_EYE_UP_MAX);
        c[1] = share(-pose->eyes[eye][1], NOH_EYE_DOWN_MAX);
        c[2] = share(out, NOH_EYE_YAW_MAX);
        c[3] = share(-out, NOH_EYE_YAW_MAX);
    }
}

static void upper_channels(const noh_face_pose *pose, float *channels)
{
    eye_channels(pose, channels);
    channels[NOH_CHANNEL_BLINK_LEFT] = channels[NOH_CHANNEL_BLINK_RIGHT] = pose->blink;
    channels[NOH_CHANNEL_LIDS_UP] = pose->lids_up * (1.0f - pose->blink);
    channels[NOH_CHANNEL_LIDS_DOWN] = pose->lids_down;
    channels[NOH_CHANNEL_BREATH] = pose->breath;
    channels[NOH_CHANNEL_BROWS] = pose->brows;
}

/* Shapes that close the lips are exempt from the shared sum: they take their share first, and the rest is divided among
 * the others so that the total is at most 1. */
static float speech_channels(const float *visemes, float *channels)
{
    const float shut = unit(unit(visemes[NOH_VISEME_PP]) + unit(visemes[NOH_VISEME_FF]));
    float sum = 0.0f, scale;
    for (int i = NOH_VISEME_TH; i < NOH_VISEME_COUNT; i++) sum += unit(visemes[i]);
    scale = sum > 1.0f - shut ? (1.0f - shut) / sum : 1.0f;
    for (int i = NOH_VISEME_PP; i < NOH_VISEME_COUNT; i++) {
        const int shuts = i == NOH_VISEME_PP || i == NOH_VISEME_FF;
        channels[NOH_CHANNEL_VISEMES + i] = unit(visemes[i]) * (shuts ? 1.0f : scale);
    }
    return unit(shut + sum);
}

void noh_face_channels(const noh_face_pose *pose, const float *visemes, noh_mouth_rule rule, float *channels)
{
    float moves = 0.0f, left, shut;
    NOH_ASSERT(channels);
    memset(channels, 0, NOH_CHANNEL_COUNT * sizeof *channels);
    if (pose) upper_channels(pose, channels);
    if (visemes) moves = speech_channels(visemes, channels);
    shut = channels[NOH_CHANNEL_VISEMES + NOH_VISEME_PP] + channels[NOH_CHANNEL_VISEMES + NOH_VISEME_FF];
    left = rule == NOH_MOUTH_NONE    ? 1.0f
           : rule == NOH_MOUTH_BLOCK ? (moves > 0.0f ? 0.0f : 1.0f)
                                     : 1.0f - TAKEN * moves;
    left = left < 1.0f - shut ? left : unit(1.0f - shut);
    for (int i = 0; pose && i < NOH_EMOTION_COUNT; i++) {
        channels[NOH_CHANNEL_UPPER + i] = pose->emotions[i];
        channels[NOH_CHANNEL_MOUTH + i] = pose->emotions[i] * left;
    }
}

/* ---- conflicts ---- */

/* The share that the visible emotions leave. */
static float left_by(const uint8_t *overrides, const float *shows)
{
    float left = 1.0f;
    for (int i = 0; i < NOH_EMOTION_COUNT; i++) {
        if (overrides[i] == NOH_OVERRIDE_BLOCK && shows[i] > 0.0f) left = 0.0f;
        if (overrides[i] == NOH_OVERRIDE_BLEND) left *= 1.0f - unit(shows[i]);
    }
    return left;
}

static void scale(float *channels, uint32_t first, uint32_t count, float by)
{
    for (uint32_t i = 0; i < count; i++) channels[first + i] *= by;
}

void noh_face_scale_user(uint32_t user, float by, float *channels)
{
    switch (user) {
    case 0:
        scale(channels, NOH_CHANNEL_BLINK_LEFT, 2, by);
        scale(channels, NOH_CHANNEL_LIDS_UP, 2, by);
        break;
    case 1: scale(channels, NOH_CHANNEL_EYES, 8, by); break;
    default: scale(channels, NOH_CHANNEL_VISEMES + NOH_VISEME_TH, NOH_VISEME_COUNT - NOH_VISEME_TH, by); break;
    }
}

void noh_face_share(const noh_face_rules *rules, float moves, float shut, float *channels)
{
    const float *visemes = channels + NOH_CHANNEL_VISEMES, *shows = channels + NOH_CHANNEL_UPPER;
    const float closed = unit(visemes[NOH_VISEME_PP] + visemes[NOH_VISEME_FF]);
    float spoken = 0.0f;
    NOH_ASSERT(rules && channels);
    for (int i = 0; i < NOH_EMOTION_COUNT; i++) {
        float *whole = channels + NOH_CHANNEL_UPPER + i;
        if (rules->binary >> i & 1u) *whole = *whole > 0.5f ? 1.0f : 0.0f;
    }
    noh_face_scale_user(0, left_by(rules->lids, shows), channels);
    noh_face_scale_user(1, left_by(rules->eyes, shows), channels);
    noh_face_scale_user(2, left_by(rules->speech, shows), channels);
    for (int v = NOH_VISEME_PP; v < NOH_VISEME_COUNT; v++) spoken += visemes[v];
    spoken = unit(spoken > moves ? spoken : moves);
    shut = closed > shut ? closed : unit(shut);
    for (int i = 0; i < NOH_EMOTION_COUNT; i++) {
        const uint8_t rule = rules->mouth[i];
        float left = rule == NOH_MOUTH_NONE    ? 1.0f
                     : rule == NOH_MOUTH_BLOCK ? (spoken > 0.0f ? 0.0f : 1.0f)
                                               : 1.0f - TAKEN * spoken;
        left = left < 1.0f - shut ? left : 1.0f - shut;
        channels[NOH_CHANNEL_MOUTH + i] = shows[i] * left;
    }
}

/* ---- binding ---- */

typedef struct binding {
    const noh_face_recipe *const *recipes;
    uint32_t recipe_count;
    noh_face_find_fn find;
    const void *user;
    noh_face_link *links;
    uint32_t link_max, count;
} binding;

/* Get a row of a recipe. Returns 0 if it is for another channel. */
static int row_of(const noh_face_recipe *recipe, uint32_t i, uint32_t channel, noh_face_row *row)
{
    const noh_recipe_row *from;
    if (!recipe->pack) {
        *row = recipe->rows[i];
        return row->channel == channel;
    }
    from = &recipe->pack->recipe_rows[i];
    row->target = noh_pack_string(recipe->pack, from->target);
    row->channel = (uint16_t)channel;
    row->weight = from->weight;
    return noh_names_equal(noh_pack_string(recipe->pack, from->channel), noh_face_channel_name(channel));
}

/* Count a recipe's rows of a channel, and how many of them the mesh has a target for. */
static void count_rows(const binding *b, const noh_face_recipe *recipe, uint32_t channel, uint32_t *rows,
                       uint32_t *found)
{
    noh_face_row row;
    *rows = *found = 0;
    for (uint32_t i = 0; i < recipe->row_count; i++) {
        if (!row_of(recipe, i, channel, &row)) continue;
        ++*rows;
        *found += b->find(b->user, row.target, 0) != NOH_NONE;
    }
}

static const noh_face_recipe *choose(const binding *b, uint32_t channel)
{
    const noh_face_recipe *some = NULL;
    for (uint32_t i = 0; i < b->recipe_count; i++) {
        const noh_face_recipe *recipe = b->recipes[i];
        uint32_t rows, found;
        count_rows(b, recipe, channel, &rows, &found);
        if (rows && found == rows) return recipe;
        if (found && !some) some = recipe;
    }
    return some;
}

/* The mouth shape that looks most like one without targets; NOH_VISEME_SIL if there is none. */
static uint32_t nearest(uint32_t channel)
{
    static const uint8_t other[NOH_VISEME_COUNT] = { NOH_VISEME_SIL, NOH_VISEME_SIL, NOH_VISEME_PP,  NOH_VISEME_DD,
                                                     NOH_VISEME_NN,  NOH_VISEME_DD,  NOH_VISEME_OU,  NOH_VISEME_IH,
                                                     NOH_VISEME_IH,  NOH_VISEME_OU,  NOH_VISEME_SIL, NOH_VISEME_IH,
                                                     NOH_VISEME_AA,  NOH_VISEME_AA,  NOH_VISEME_OH };
    const uint32_t to = channel < NOH_CHANNEL_VISEMES ? 0u : other[channel - NOH_CHANNEL_VISEMES];
    return to == NOH_VISEME_SIL ? NOH_NONE : NOH_CHANNEL_VISEMES + to;
}

static void add_link(binding *b, uint32_t channel, uint32_t target, float weight)
{
    if (b->count < b->link_max) {
        b->links[b->count].channel = (uint16_t)channel;
        b->links[b->count].target = (uint16_t)target;
        b->links[b->count].weight = weight;
    }
    b->count++;
}

static void link_rows(binding *b, const noh_face_recipe *recipe, uint32_t from, uint32_t channel)
{
    const float share = from != channel && from < NOH_CHANNEL_VISEMES ? LIKE : 1.0f;
    for (uint32_t i = 0; i < recipe->row_count; i++) {
        noh_face_row row;
        uint32_t nth = 0, target;
        if (!row_of(recipe, i, from, &row)) continue;
        while ((target = b->find(b->user, row.target, nth++)) != NOH_NONE) {
            add_link(b, channel, target, share * row.weight);
        }
    }
}

uint32_t noh_emotion_like(uint32_t emotion)
{
    return emotion == NOH_EMOTION_FEAR      ? NOH_EMOTION_SURPRISE
           : emotion == NOH_EMOTION_DISGUST ? NOH_EMOTION_ANGER
                                            : NOH_EMOTION_COUNT;
}

/* The channel whose targets are used for a channel without targets of its own; NOH_NONE: none. */
static uint32_t like(const binding *b, uint32_t channel)
{
    const uint32_t emotion = channel - NOH_CHANNEL_UPPER, to = noh_emotion_like(emotion);
    if (to == NOH_EMOTION_COUNT || choose(b, NOH_CHANNEL_MOUTH + emotion)) return nearest(channel);
    return NOH_CHANNEL_UPPER + to;
}

/* Following nearest shapes always ends, at a vowel or at closed lips. */
static void find_source(const binding *b, uint32_t channel, noh_face_source *source)
{
    memset(source, 0, sizeof *source);
    for (uint32_t from = channel; from != NOH_NONE && !source->recipe; from = like(b, from)) {
        source->channel = from;
        source->recipe = choose(b, from);
        if (source->recipe) count_rows(b, source->recipe, from, &source->row_count, &source->found_count);
    }
}

static void bind_channel(binding *b, uint32_t channel)
{
    noh_face_source source;
    find_source(b, channel, &source);
    if (source.recipe) link_rows(b, source.recipe, source.channel, channel);
}

static const noh_face_recipe *const built_in[3] = { &noh_face_recipe_arkit, &noh_face_recipe_vrm,
                                                    &noh_face_recipe_units };

static binding binding_of(const noh_face_recipe *const *recipes, uint32_t recipe_count, noh_face_find_fn find,
                          const void *user)
{
    binding b = { NULL, 0, NULL, NULL, NULL, 0, 0 };
    NOH_ASSERT(find);
    b.recipes = recipes ? recipes : built_in;
    b.recipe_count = recipes ? recipe_count : 3u;
    b.find = find;
    b.user = user;
    return b;
}

uint32_t noh_face_recipe_bind_by(const noh_face_recipe *const *recipes, uint32_t recipe_count, noh_face_find_fn find,
                                 const void *user, noh_face_link *links, uint32_t link_max)
{
    binding b = binding_of(recipes, recipe_count, find, user);
    NOH_ASSERT(links || !link_max);
    b.links = links;
    b.link_max = link_max;
    for (uint32_t channel = 0; channel < NOH_CHANNEL_COUNT; channel++) bind_channel(&b, channel);
    return b.count;
}

uint32_t noh_face_taken(const noh_face_recipe *const *recipes, uint32_t recipe_count, noh_face_find_fn find,
                        const void *user)
{
    const binding b = binding_of(recipes, recipe_count, find, user);
    uint32_t taken = 0;
    for (uint32_t e = 0; e < NOH_EMOTION_COUNT; e++) {
        noh_face_source source;
        find_source(&b, NOH_CHANNEL_UPPER + e, &source);
        if (source.recipe && source.channel != NOH_CHANNEL_UPPER + e) taken |= 1u << e;
    }
    return taken;
}

typedef struct name_list {
    const char *const *names;
    uint32_t count;
} name_list;

/* Finds only the first target with a name. */
static uint32_t find_listed(const void *user, const char *name, uint32_t nth)
{
    const name_list *list = user;
    for (uint32_t i = 0; i < list->count && !nth; i++) {
        if (list->names[i] && noh_names_equal(list->names[i], name)) return i;
    }
    return NOH_NONE;
}

uint32_t noh_face_recipe_bind(const noh_face_recipe *const *recipes, uint32_t recipe_count, const char *const *names,
                              uint32_t target_count, noh_face_link *links, uint32_t link_max)
{
    name_list list = { NULL, 0 };
    NOH_ASSERT((names || !target_count) && target_count <= NOH_FLOATS_MAX);
    list.names = names;
    list.count = target_count;
    return noh_face_recipe_bind_by(recipes, recipe_count, find_listed, &list, links, link_max);
}

void noh_face_recipe_source(const noh_face_recipe *const *recipes, uint32_t recipe_count, const char *const *names,
                            uint32_t target_count, uint32_t channel, noh_face_source *source)
{
    name_list list = { NULL, 0 };
    binding b;
    NOH_ASSERT((names || !target_count) && channel < NOH_CHANNEL_COUNT && source);
    list.names = names;
    list.count = target_count;
    b = binding_of(recipes, recipe_count, find_listed, &list);
    find_source(&b, channel, source);
}

/* ---- weights ---- */

/* The maximum of a target: 1, or the largest link weight if that is more. */
static float most_of(const noh_face_link *links, uint32_t link_count, uint32_t target)
{
    float most = 1.0f;
    for (uint32_t i = 0; i < link_count; i++) {
        if (links[i].target == target && links[i].weight > most) most = links[i].weight;
    }
    return most;
}

/* Rows of one target are added before the sum is clamped, so that their order does not matter. Targets that no channel
 * moves keep their weights, even beyond 0..1. */
void noh_face_apply(const noh_face_link *links, uint32_t link_count, const float *channels, float *weights)
{
    NOH_ASSERT((links || !link_count) && channels && weights);
    for (uint32_t i = 0; i < link_count; i++) {
        weights[links[i].target] += links[i].weight * channels[links[i].channel];
    }
    for (uint32_t i = 0; i < link_count; i++) {
        float *weight = &weights[links[i].target], most;
        if (channels[links[i].channel] == 0.0f) continue;
        if (*weight < 0.0f) *weight = 0.0f;
        if (*weight <= 1.0f) continue;
        most = most_of(links, link_count, links[i].target);
        *weight = *weight < most ? *weight : most;
    }
}
