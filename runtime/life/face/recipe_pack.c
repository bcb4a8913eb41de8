/* recipe_pack.c: recipes in packs, and the names of channels. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"
#include "life/face/recipe_internal.h"
#include "noh/base.h"
#include "noh/face.h"
#include "noh/format.h"
#include "noh/pack.h"

static const char *const names[NOH_CHANNEL_COUNT] = {
    "blink-left",
    "blink-right",
    "eye-left-up",
    "eye-left-down",
    "eye-left-out",
    "eye-left-in",
    "eye-right-up",
    "eye-right-down",
    "eye-right-out",
    "eye-right-in",
    "lids-up",
    "lids-down",
    "breath",
    "brows",
    "joy-upper",
    "sadness-upper",
    "surprise-upper",
    "fear-upper",
    "anger-upper",
    "disgust-upper",
    "contempt-upper",
    "joy-mouth",
    "sadness-mouth",
    "surprise-mouth",
    "fear-mouth",
    "anger-mouth",
    "disgust-mouth",
    "contempt-mouth",
    "sil",
    "PP",
    "FF",
    "TH",
    "DD",
    "kk",
    "CH",
    "SS",
    "nn",
    "RR",
    "aa",
    "E",
    "ih",
    "oh",
    "ou",
};

const char *noh_face_channel_name(uint32_t channel)
{
    return channel < NOH_CHANNEL_COUNT ? names[channel] : "";
}

uint32_t noh_face_channel_find(const char *name)
{
    NOH_ASSERT(name);
    for (uint32_t i = 0; i < NOH_CHANNEL_COUNT; i++) {
        if (noh_names_equal(names[i], name)) return i;
    }
    return NOH_NONE;
}

noh_face_recipe noh_face_recipe_in_pack(const noh_pack *pack)
{
    noh_face_recipe recipe = { "pack", NULL, 0, NULL };
    NOH_ASSERT(pack);
    recipe.row_count = pack->recipe_row_count;
    recipe.pack = pack;
    return recipe;
}

uint32_t noh_recipe_overrides(const noh_pack *pack, const noh_recipe_row *row, noh_override *how)
{
    static const char *const overrides[NOH_FACE_USERS] = { "override-lids", "override-eyes", "override-speech" };
    for (uint32_t user = 0; user < NOH_FACE_USERS; user++) {
        if (!noh_names_equal(noh_pack_string(pack, row->channel), overrides[user])) continue;
        *how = row->weight > 1.5f ? NOH_OVERRIDE_BLEND : row->weight > 0.5f ? NOH_OVERRIDE_BLOCK : NOH_OVERRIDE_NONE;
        return user;
    }
    return NOH_NONE;
}

static int has_rows(const noh_pack *pack, uint32_t emotion)
{
    for (uint32_t i = 0; i < pack->recipe_row_count; i++) {
        const char *channel = noh_pack_string(pack, pack->recipe_rows[i].channel);
        if (noh_names_equal(channel, names[NOH_CHANNEL_UPPER + emotion])) return 1;
        if (noh_names_equal(channel, names[NOH_CHANNEL_MOUTH + emotion])) return 1;
    }
    return 0;
}

/* An emotion that shows another's targets has the other's rules. */
static void share_rules(const noh_pack *pack, noh_face_rules *rules)
{
    for (uint32_t e = 0; e < NOH_EMOTION_COUNT; e++) {
        const uint32_t other = noh_emotion_like(e);
        if (other == NOH_EMOTION_COUNT || has_rows(pack, e) || !has_rows(pack, other)) continue;
        rules->lids[e] = rules->lids[other];
        rules->eyes[e] = rules->eyes[other];
        rules->speech[e] = rules->speech[other];
        rules->binary = (uint8_t)(rules->binary | (rules->binary >> other & 1u) << e);
    }
}

void noh_face_rules_of_pack(const noh_pack *pack, noh_face_rules *rules)
{
    uint8_t *to[NOH_FACE_USERS];
    NOH_ASSERT(pack && rules);
    to[0] = rules->lids;
    to[1] = rules->eyes;
    to[2] = rules->speech;
    memset(rules, 0, sizeof *rules);
    for (uint32_t i = 0; i < pack->recipe_row_count; i++) {
        const noh_recipe_row *row = &pack->recipe_rows[i];
        const uint32_t emotion = noh_face_channel_find(noh_pack_string(pack, row->target)) - NOH_CHANNEL_UPPER;
        noh_override how;
        uint32_t user;
        if (emotion < NOH_EMOTION_COUNT && noh_names_equal(noh_pack_string(pack, row->channel), "binary")) {
            rules->binary = (uint8_t)(rules->binary | 1u << emotion);
        }
        user = emotion < NOH_EMOTION_COUNT ? noh_recipe_overrides(pack, row, &how) : NOH_NONE;
        if (user != NOH_NONE) to[user][emotion] = (uint8_t)how;
    }
    share_rules(pack, rules);
}
