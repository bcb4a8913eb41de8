#include "vrm_expression.h"

#include <stddef.h>
#include <string.h>

/* Expressions of VRM 1.0 and 0.0. Others are called by their names. */
static const struct {
    const char *name, *old_name, *channel;
} expressions[] = {
    { "blinkLeft", "blink_l", "blink-left" },
    { "blinkRight", "blink_r", "blink-right" },
    { "blink", "blink", "blink" },
    { "aa", "a", "aa" },
    { "ih", "i", "ih" },
    { "ou", "u", "ou" },
    { "ee", "e", "E" },
    { "oh", "o", "oh" },
    { "happy", "joy", "joy-upper" },
    { "angry", "angry", "anger-upper" },
    { "sad", "sorrow", "sadness-upper" },
    { "surprised", "surprised", "surprise-upper" },
    { "lookUp", "lookup", "eye-left-up" }, /* one target turns both eyes: the left one's channels lead */
    { "lookDown", "lookdown", "eye-left-down" },
    { "lookLeft", "lookleft", "eye-left-out" },
    { "lookRight", "lookright", "eye-right-out" },
};

/* Whether a word is this one, which has small letters, in any case. */
static int is_any_case(const char *word, const char *small)
{
    for (; *word && *small; word++, small++) {
        if ((*word >= 'A' && *word <= 'Z' ? *word - 'A' + 'a' : *word) != *small) return 0;
    }
    return !*word && !*small;
}

const char *vrm_expression_channel(const char *name, int old)
{
    for (size_t i = 0; i < sizeof expressions / sizeof expressions[0]; i++) {
        if (old ? is_any_case(name, expressions[i].old_name) : strcmp(name, expressions[i].name) == 0)
            return expressions[i].channel;
    }
    return NULL;
}
