#include "clips.h"

#include "mask/targets.h"
#include "shared/grab.h"
#include "shared/maths.h"

#include <stddef.h>

#define RATE 20.0

/* clang-format off */
#define BOTH(key, name, weight) { key, name "Left", weight }, { key, name "Right", weight }
#define GAZE(key, out, in, weight) { key, "eyeLookOut" out, weight }, { key, "eyeLookIn" in, weight }

static const WeightScript scripts[NELL_CLIPS] = {
    { "idle", "LINEAR", 14,
      { 0, 1.4, 1.5, 1.55, 1.7, 2.6, 2.7, 4.2, 4.3, 4.9, 5.0, 5.05, 5.2, 6.0 },
      { { 2, "blink", 1 }, { 3, "blink", 1 }, { 10, "blink", 1 }, { 11, "blink", 1 },
        GAZE(6, "Right", "Left", 0.35), GAZE(7, "Right", "Left", 0.35), BOTH(6, "eyeLookUp", 0.15),
        BOTH(7, "eyeLookUp", 0.15), BOTH(5, "mouthSmile", 0.05),
        BOTH(7, "mouthSmile", 0.30), BOTH(9, "mouthSmile", 0.25) } },
    { "greet", "LINEAR", 10,
      { 0, 0.25, 0.45, 0.75, 1.05, 1.4, 1.55, 1.7, 2.4, 3.2 },
      { { 1, "browInnerUp", 0.7 }, { 2, "browInnerUp", 0.8 }, { 3, "browInnerUp", 0.4 },
        BOTH(1, "browOuterUp", 0.6), BOTH(2, "browOuterUp", 0.7), BOTH(3, "browOuterUp", 0.2),
        BOTH(1, "eyeWide", 0.5), BOTH(2, "eyeWide", 0.5),
        { 1, "viseme_E", 0.5 }, { 2, "viseme_E", 0.7 }, { 3, "viseme_nn", 0.6 }, { 4, "viseme_O", 0.8 },
        { 5, "viseme_U", 0.3 }, { 3, "smile", 0.2 }, { 5, "smile", 0.6 }, { 6, "smile", 0.9 }, { 7, "smile", 0.9 },
        { 8, "smile", 0.9 }, { 6, "blink", 0.9 } } },
    { "talk", "LINEAR", 15,
      { 0, 0.1, 0.25, 0.35, 0.5, 0.6, 0.75, 0.9, 1.05, 1.2, 1.3, 1.5, 1.6, 1.8, 2.1 },
      { { 1, "viseme_PP", 1 }, { 2, "viseme_aa", 0.8 }, { 3, "viseme_nn", 0.8 }, { 4, "viseme_I", 0.8 },
        { 5, "viseme_SS", 0.8 }, { 6, "viseme_O", 0.9 }, { 7, "viseme_U", 0.8 }, { 8, "viseme_FF", 1 },
        { 9, "viseme_E", 0.8 }, { 10, "viseme_DD", 0.8 }, { 11, "viseme_aa", 0.9 }, { 12, "viseme_TH", 0.8 },
        { 13, "viseme_PP", 0.9 }, { 2, "browInnerUp", 0.4 }, { 6, "browInnerUp", 0.2 }, { 11, "browInnerUp", 0.6 },
        BOTH(11, "browOuterUp", 0.5), { 13, "blink", 1 }, { 4, "smile", 0.2 }, { 9, "smile", 0.2 } } },
    { "listen", "LINEAR", 12,
      { 0, 0.8, 1.3, 1.4, 1.45, 1.6, 2.6, 3.4, 3.5, 3.55, 3.7, 5.0 },
      { { 1, "browInnerUp", 0.35 }, { 2, "browInnerUp", 0.4 }, { 5, "browInnerUp", 0.1 }, { 6, "browInnerUp", 0.2 },
        { 3, "blink", 1 }, { 4, "blink", 1 }, { 8, "blink", 1 }, { 9, "blink", 1 },
        BOTH(6, "browOuterUp", 0.4), BOTH(7, "browOuterUp", 0.3), BOTH(6, "eyeWide", 0.2),
        BOTH(1, "mouthSmile", 0.1), BOTH(5, "mouthSmile", 0.15), BOTH(7, "mouthSmile", 0.35),
        BOTH(10, "mouthSmile", 0.3) } },
    { "laugh", "LINEAR", 12,
      { 0, 0.2, 0.4, 0.55, 0.7, 0.85, 1.0, 1.15, 1.3, 1.6, 2.0, 2.6 },
      { { 1, "smile", 0.7 }, { 2, "smile", 0.9 }, { 3, "smile", 0.9 }, { 4, "smile", 0.9 }, { 5, "smile", 0.9 },
        { 6, "smile", 0.9 }, { 7, "smile", 0.9 }, { 8, "smile", 0.9 }, { 9, "smile", 0.8 }, { 10, "smile", 0.5 },
        { 2, "jawOpen", 0.55 }, { 3, "jawOpen", 0.30 }, { 4, "jawOpen", 0.55 }, { 5, "jawOpen", 0.25 },
        { 6, "jawOpen", 0.45 }, { 7, "jawOpen", 0.15 }, { 8, "jawOpen", 0.25 },
        { 2, "blink", 0.8 }, { 3, "blink", 0.92 }, { 4, "blink", 0.95 }, { 5, "blink", 0.95 }, { 6, "blink", 0.9 },
        { 7, "blink", 0.6 }, { 8, "blink", 0.3 },
        { 2, "browInnerUp", 0.3 }, { 4, "browInnerUp", 0.5 }, { 6, "browInnerUp", 0.4 }, { 8, "browInnerUp", 0.2 } } },
    { "think", "LINEAR", 8,
      { 0, 0.4, 1.2, 2.2, 2.35, 2.5, 3.2, 4.0 },
      { GAZE(1, "Right", "Left", 0.6), GAZE(2, "Right", "Left", 0.5), GAZE(3, "Right", "Left", 0.6),
        BOTH(1, "eyeLookUp", 0.7), BOTH(2, "eyeLookUp", 0.8), BOTH(3, "eyeLookUp", 0.6),
        { 1, "mouthLeft", 0.3 }, { 2, "mouthLeft", 0.7 }, { 3, "mouthLeft", 0.6 },
        { 2, "mouthPucker", 0.25 }, { 3, "mouthPucker", 0.25 }, { 2, "browDownLeft", 0.4 }, { 3, "browDownLeft", 0.4 },
        { 1, "browOuterUpRight", 0.4 }, { 2, "browOuterUpRight", 0.6 }, { 3, "browOuterUpRight", 0.6 },
        { 4, "blink", 1 }, BOTH(5, "eyeWide", 0.5), BOTH(5, "browOuterUp", 0.7), { 5, "browInnerUp", 0.7 },
        { 5, "smile", 0.4 }, { 6, "smile", 0.6 } } },
    { "surprise", "LINEAR", 7,
      { 0, 0.2, 0.8, 0.95, 1.1, 1.7, 2.4 },
      { { 1, "surprise", 0.9 }, { 2, "surprise", 0.8 }, { 3, "blink", 1 }, { 3, "surprise", 0.2 },
        { 4, "smile", 0.4 }, { 5, "smile", 0.6 }, { 4, "browInnerUp", 0.4 } } },
    { "wink", "LINEAR", 6,
      { 0, 0.15, 0.25, 0.4, 0.6, 1.4 },
      { { 1, "eyeBlinkLeft", 0.9 }, { 2, "eyeBlinkLeft", 1 }, { 3, "eyeBlinkLeft", 1 },
        { 1, "mouthSmileLeft", 0.6 }, { 2, "mouthSmileLeft", 0.8 }, { 3, "mouthSmileLeft", 0.8 },
        { 4, "mouthSmileLeft", 0.6 }, { 2, "mouthSmileRight", 0.3 }, { 4, "mouthSmileRight", 0.5 },
        { 2, "cheekSquintLeft", 0.8 }, { 3, "cheekSquintLeft", 0.8 }, { 2, "browDownLeft", 0.3 },
        { 3, "browDownLeft", 0.3 }, { 2, "browOuterUpRight", 0.5 }, { 3, "browOuterUpRight", 0.5 } } },
    { "doubt", "LINEAR", 5,
      { 0, 0.3, 1.0, 1.6, 2.2 },
      { { 1, "browOuterUpLeft", 0.8 }, { 2, "browOuterUpLeft", 1 }, { 3, "browOuterUpLeft", 0.8 },
        { 1, "browDownRight", 0.5 }, { 2, "browDownRight", 0.7 }, { 3, "browDownRight", 0.5 },
        { 2, "eyeSquintRight", 0.6 }, { 3, "eyeSquintRight", 0.5 }, { 2, "mouthRight", 0.6 }, { 3, "mouthRight", 0.5 },
        BOTH(2, "mouthPress", 0.5), BOTH(3, "mouthPress", 0.4), { 2, "mouthFrownRight", 0.4 } } },
    { "sad", "LINEAR", 7,
      { 0, 0.6, 1.3, 1.45, 1.6, 2.6, 3.4 },
      { { 1, "frown", 0.6 }, { 2, "frown", 0.8 }, { 3, "frown", 0.8 }, { 4, "frown", 0.8 }, { 5, "frown", 0.6 },
        BOTH(2, "eyeLookDown", 0.5), BOTH(4, "eyeLookDown", 0.6), BOTH(5, "eyeLookDown", 0.3),
        { 2, "browInnerUp", 0.2 }, { 4, "browInnerUp", 0.3 }, { 5, "browInnerUp", 0.2 },
        { 3, "blink", 0.9 } } },
    { "yawn", "LINEAR", 10,
      { 0, 0.5, 1.1, 1.9, 2.3, 2.6, 2.7, 2.85, 3.0, 3.6 },
      { { 1, "jawOpen", 0.4 }, { 2, "jawOpen", 0.9 }, { 3, "jawOpen", 0.85 }, { 4, "jawOpen", 0.25 },
        { 1, "mouthFunnel", 0.2 }, { 2, "mouthFunnel", 0.35 }, { 3, "mouthFunnel", 0.3 },
        { 1, "blink", 0.5 }, { 2, "blink", 0.9 }, { 3, "blink", 0.95 }, { 4, "blink", 0.5 }, { 5, "blink", 0.15 },
        { 6, "blink", 0.9 }, { 7, "blink", 0.2 }, { 8, "blink", 0.1 },
        { 1, "browInnerUp", 0.3 }, { 2, "browInnerUp", 0.6 }, { 3, "browInnerUp", 0.5 },
        BOTH(2, "browOuterUp", 0.5), BOTH(3, "browOuterUp", 0.4), { 8, "smile", 0.15 } } },
    { "kiss", "LINEAR", 6,
      { 0, 0.35, 0.6, 0.75, 1.0, 1.8 },
      { { 1, "mouthPucker", 0.9 }, { 2, "mouthPucker", 1 }, { 3, "mouthFunnel", 0.3 }, { 3, "jawOpen", 0.08 },
        { 1, "blink", 0.5 }, { 2, "blink", 1 }, { 3, "blink", 0.5 }, { 1, "browInnerUp", 0.3 },
        { 2, "browInnerUp", 0.4 }, { 4, "smile", 0.6 }, BOTH(4, "browOuterUp", 0.3) } },
};
/* clang-format on */

/* A script's keys, with movements between them that begin and end slowly. */
Animation nell_clip(int number)
{
    Animation keys = animation_of(&scripts[number], ALL_TARGETS), eased = keys;
    eased.key_count = (int)(keys.times[keys.key_count - 1] * RATE + 0.5) + 1;
    eased.value_count = eased.key_count * ALL_TARGETS;
    eased.times = grab(NULL, eased.key_count, (int)sizeof *eased.times);
    eased.values = grab(NULL, eased.value_count, (int)sizeof *eased.values);
    for (int i = 0, before = 0; i < eased.key_count; i++) {
        double time = i / RATE;
        while (before < keys.key_count - 2 && time > keys.times[before + 1]) {
            before++;
        }
        double share = smooth(keys.times[before], keys.times[before + 1], time);
        eased.times[i] = time;
        for (int target = 0; target < ALL_TARGETS; target++) {
            const double *from = keys.values + before * ALL_TARGETS + target;
            eased.values[i * ALL_TARGETS + target] = mix(from[0], from[ALL_TARGETS], share);
        }
    }
    animation_free(&keys);
    return eased;
}
