#include "targets.h"

#include <stddef.h>
#include <string.h>

enum { MAX_PULLS = 14 };

/* A target pulls some members of a Pose. */
typedef struct {
    size_t member;
    double amount;
} Pull;

typedef struct {
    const char *name;
    Pull pulls[MAX_PULLS]; /* ends with amount 0 */
} Target;

/* clang-format off */
#define ONE(name, member) { name, { { offsetof(Pose, member), 1 } } }
#define PAIR(name, member) ONE(name "Left", member[LEFT]), ONE(name "Right", member[RIGHT])
#define JUST(member, amount) { offsetof(Pose, member), amount }
#define BOTH(member, amount) JUST(member[LEFT], amount), JUST(member[RIGHT], amount)
/* clang-format on */

static const Target targets[ALL_TARGETS] = {
    /* What a user types first. */
    { "smile", { BOTH(smile, 1), BOTH(cheek_squint, 0.5), BOTH(upper_up, 0.22), JUST(grin, 1) } },
    { "frown", { BOTH(frown, 1), JUST(brow_inner_up, 0.8), JUST(shrug_lower, 0.35) } },
    { "blink", { BOTH(blink, 1) } },
    { "surprise",
      { JUST(brow_inner_up, 0.8), BOTH(brow_outer_up, 1), BOTH(wide, 1), JUST(jaw_open, 0.75), JUST(funnel, 0.35) } },
    { "anger",
      { BOTH(brow_down, 1), BOTH(sneer, 0.8), BOTH(wide, 0.45), BOTH(frown, 0.55), BOTH(upper_up, 0.6),
        BOTH(lower_down, 0.6) } },
    /* One muscle each, under the names that face trackers use. */
    PAIR("browDown", brow_down),
    ONE("browInnerUp", brow_inner_up),
    PAIR("browOuterUp", brow_outer_up),
    ONE("cheekPuff", cheek_puff),
    PAIR("cheekSquint", cheek_squint),
    PAIR("eyeBlink", blink),
    PAIR("eyeLookDown", look_down),
    PAIR("eyeLookIn", look_in),
    PAIR("eyeLookOut", look_out),
    PAIR("eyeLookUp", look_up),
    PAIR("eyeSquint", squint),
    PAIR("eyeWide", wide),
    ONE("jawForward", jaw_forward),
    ONE("jawLeft", jaw_side),
    ONE("jawOpen", jaw_open),
    { "jawRight", { JUST(jaw_side, -1) } },
    ONE("mouthClose", mouth_close),
    PAIR("mouthDimple", dimple),
    PAIR("mouthFrown", frown),
    ONE("mouthFunnel", funnel),
    ONE("mouthLeft", mouth_side),
    PAIR("mouthLowerDown", lower_down),
    PAIR("mouthPress", press),
    ONE("mouthPucker", pucker),
    { "mouthRight", { JUST(mouth_side, -1) } },
    ONE("mouthRollLower", roll_lower),
    ONE("mouthRollUpper", roll_upper),
    ONE("mouthShrugLower", shrug_lower),
    ONE("mouthShrugUpper", shrug_upper),
    PAIR("mouthSmile", smile),
    PAIR("mouthStretch", stretch),
    PAIR("mouthUpperUp", upper_up),
    PAIR("noseSneer", sneer),
    ONE("tongueOut", tongue_out),
    /* Sounds. */
    ONE("viseme_sil", nothing),
    { "viseme_PP", { BOTH(press, 0.8), JUST(roll_upper, 0.3), JUST(roll_lower, 0.35), JUST(pucker, 0.1) } },
    { "viseme_FF", { JUST(roll_lower, 0.8), BOTH(upper_up, 0.55), JUST(jaw_open, 0.10) } },
    { "viseme_TH", { JUST(jaw_open, 0.20), BOTH(upper_up, 0.3), BOTH(lower_down, 0.3), JUST(tongue_up, 0.7) } },
    { "viseme_DD", { JUST(jaw_open, 0.18), BOTH(upper_up, 0.3), BOTH(lower_down, 0.4), JUST(tongue_up, 1) } },
    { "viseme_kk", { JUST(jaw_open, 0.24), BOTH(upper_up, 0.3), BOTH(lower_down, 0.35), BOTH(stretch, 0.2) } },
    { "viseme_CH", { JUST(jaw_open, 0.12), JUST(funnel, 0.75), JUST(pucker, 0.2) } },
    { "viseme_SS", { JUST(jaw_open, 0.06), BOTH(stretch, 0.5), BOTH(upper_up, 0.45), BOTH(lower_down, 0.5) } },
    { "viseme_nn", { JUST(jaw_open, 0.16), BOTH(upper_up, 0.25), BOTH(lower_down, 0.3), JUST(tongue_up, 1) } },
    { "viseme_RR", { JUST(jaw_open, 0.14), JUST(funnel, 0.45), JUST(pucker, 0.25), JUST(tongue_up, 0.5) } },
    { "viseme_aa", { JUST(jaw_open, 0.70), BOTH(upper_up, 0.25), BOTH(stretch, 0.1) } },
    { "viseme_E", { JUST(jaw_open, 0.34), BOTH(stretch, 0.4), BOTH(upper_up, 0.3), BOTH(lower_down, 0.3) } },
    { "viseme_I",
      { JUST(jaw_open, 0.16), BOTH(stretch, 0.5), BOTH(smile, 0.25), BOTH(upper_up, 0.3), BOTH(lower_down, 0.3) } },
    { "viseme_O", { JUST(jaw_open, 0.42), JUST(funnel, 0.55), JUST(pucker, 0.35) } },
    { "viseme_U", { JUST(jaw_open, 0.14), JUST(funnel, 0.25), JUST(pucker, 0.85) } },
    /* A corrective by its name: lips that smile shut for sounds that need it. */
    { "smile_viseme_PP",
      { BOTH(smile, 1), BOTH(cheek_squint, 0.5), BOTH(upper_up, 0.22), JUST(grin, 1), JUST(mouth_close, 1) } },
};

const char *target_name(int target)
{
    return targets[target].name;
}

Pose target_pose(int target)
{
    Pose pose = { 0 };
    for (int i = 0; i < MAX_PULLS; i++) {
        Pull pull = targets[target].pulls[i];
        double *member = (double *)(void *)((char *)&pose + pull.member);
        *member += pull.amount;
    }
    return pose;
}

int target_find(const char *name)
{
    for (int i = 0; i < ALL_TARGETS; i++) {
        if (!strcmp(targets[i].name, name)) {
            return i;
        }
    }
    return -1;
}
