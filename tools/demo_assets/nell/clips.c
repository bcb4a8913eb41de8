#include "clips.h"

#include "mask/animate.h"
#include "mask/targets.h"

/* clang-format off */
static const WeightScript scripts[NELL_CLIPS] = {
    { "idle",
      "LINEAR",
      14,
      { 0, 1.4, 1.5, 1.55, 1.7, 2.6, 2.7, 4.2, 4.3, 4.9, 5.0, 5.05, 5.2, 6.0 },
      { { 2, "blink", 1 }, { 3, "blink", 1 }, { 10, "blink", 1 }, { 11, "blink", 1 },
        { 6, "eyeLookInLeft", 0.35 }, { 7, "eyeLookInLeft", 0.35 },
        { 6, "eyeLookOutRight", 0.35 }, { 7, "eyeLookOutRight", 0.35 },
        { 6, "eyeLookUpLeft", 0.15 }, { 7, "eyeLookUpLeft", 0.15 },
        { 6, "eyeLookUpRight", 0.15 }, { 7, "eyeLookUpRight", 0.15 },
        { 5, "smile", 0.05 }, { 7, "smile", 0.30 }, { 9, "smile", 0.25 } } },
    { "greet",
      "CUBICSPLINE",
      10,
      { 0, 0.25, 0.45, 0.75, 1.05, 1.4, 1.55, 1.7, 2.4, 3.2 },
      { { 1, "browInnerUp", 0.7 }, { 2, "browInnerUp", 0.8 }, { 3, "browInnerUp", 0.4 },
        { 1, "browOuterUpLeft", 0.6 }, { 2, "browOuterUpLeft", 0.7 }, { 3, "browOuterUpLeft", 0.2 },
        { 1, "browOuterUpRight", 0.6 }, { 2, "browOuterUpRight", 0.7 }, { 3, "browOuterUpRight", 0.2 },
        { 1, "eyeWideLeft", 0.5 }, { 2, "eyeWideLeft", 0.5 }, { 1, "eyeWideRight", 0.5 }, { 2, "eyeWideRight", 0.5 },
        { 1, "viseme_E", 0.5 }, { 2, "viseme_E", 0.7 }, { 3, "viseme_nn", 0.6 }, { 4, "viseme_O", 0.8 },
        { 5, "viseme_U", 0.3 }, { 3, "smile", 0.2 }, { 5, "smile", 0.6 }, { 6, "smile", 0.9 }, { 7, "smile", 0.9 },
        { 8, "smile", 0.9 }, { 6, "blink", 0.9 } } },
    { "talk",
      "LINEAR",
      15,
      { 0, 0.1, 0.25, 0.35, 0.5, 0.6, 0.75, 0.9, 1.05, 1.2, 1.3, 1.5, 1.6, 1.8, 2.1 },
      { { 1, "viseme_PP", 1 }, { 2, "viseme_aa", 0.8 }, { 3, "viseme_nn", 0.8 }, { 4, "viseme_I", 0.8 },
        { 5, "viseme_SS", 0.8 }, { 6, "viseme_O", 0.9 }, { 7, "viseme_U", 0.8 }, { 8, "viseme_FF", 1 },
        { 9, "viseme_E", 0.8 }, { 10, "viseme_DD", 0.8 }, { 11, "viseme_aa", 0.9 }, { 12, "viseme_TH", 0.8 },
        { 13, "viseme_PP", 0.9 }, { 2, "browInnerUp", 0.4 }, { 6, "browInnerUp", 0.2 }, { 11, "browInnerUp", 0.6 },
        { 11, "browOuterUpLeft", 0.5 }, { 11, "browOuterUpRight", 0.5 }, { 13, "blink", 1 },
        { 4, "smile", 0.2 }, { 9, "smile", 0.2 } } },
};
/* clang-format on */

Animation nell_clip(int number)
{
    return animation_of(&scripts[number], ALL_TARGETS);
}
