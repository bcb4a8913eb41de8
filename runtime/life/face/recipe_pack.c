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

/* The emotion that a row is a rule of, if it is one: past the last, it is not. */
static uint32_t ruled_by(const noh_pack *pack, const noh_recipe_row *row, uint32_t *user, noh_override *how)
{
    const uint32_t emotion = noh_face_channel_find(noh_pack_string(pack, row->target)) - NOH_CHANNEL_UPPER;
    if (emotion >= NOH_EMOTION_COUNT) return NOH_NONE;
    *user = noh_recipe_overrides(pack, row, how);
    return *user != NOH_NONE || noh_names_equal(noh_pack_string(pack, row->channel), "binary") ? emotion : NOH_NONE;
}

void noh_face_share_rules(const noh_pack *pack, uint32_t taken, noh_face_rules *rules)
{
    NOH_ASSERT(pack && rules);
    for (uint32_t i = 0; i < pack->recipe_row_count; i++) {
        noh_override how;
        uint32_t user;
        const uint32_t emotion = ruled_by(pack, &pack->recipe_rows[i], &user, &how);
        if (emotion != NOH_NONE) taken &= ~(1u << emotion); /* it has rules of its own */
    }
    for (uint32_t e = 0; e < NOH_EMOTION_COUNT; e++) {
        const uint32_t other = noh_emotion_like(e);
        if (other == NOH_EMOTION_COUNT || !(taken >> e & 1u)) continue;
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
        noh_override how;
        uint32_t user;
        const uint32_t emotion = ruled_by(pack, row, &user, &how);
        if (emotion == NOH_NONE) continue;
        if (user == NOH_NONE) {
            rules->binary = (uint8_t)(rules->binary | 1u << emotion);
        } else {
            to[user][emotion] = (uint8_t)how;
        }
    }
}
