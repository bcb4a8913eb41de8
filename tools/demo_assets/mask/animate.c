#include "animate.h"

#include "shared/grab.h"
#include "model.h"
#include "targets.h"

#include <stdlib.h>
#include <string.h>

/* clang-format off */
static const WeightScript scripts[] = {
    { "blink",
      "LINEAR",
      6,
      { 0, 2.0, 2.08, 2.14, 2.30, 3.5 },
      { { 2, "blink", 1 }, { 3, "blink", 1 } } },
    { "smile",
      "CUBICSPLINE",
      5,
      { 0, 0.5, 1.1, 2.4, 3.2 },
      { { 1, "smile", 0.35 },
        { 2, "smile", 1 },
        { 3, "smile", 1 },
        { 2, "browInnerUp", 0.25 },
        { 3, "browInnerUp", 0.2 } } },
    { "speak",
      "LINEAR",
      13,
      { 0, 0.15, 0.30, 0.45, 0.60, 0.72, 0.88, 1.05, 1.20, 1.36, 1.55, 1.75, 2.0 },
      { { 1, "jawOpen", 0.55 },          { 1, "mouthStretchLeft", 0.2 },
        { 1, "mouthStretchRight", 0.2 }, { 2, "mouthPressLeft", 0.3 },
        { 2, "mouthPressRight", 0.3 },   { 3, "jawOpen", 0.35 },          { 3, "mouthFunnel", 0.7 },
        { 4, "jawOpen", 0.12 },          { 4, "mouthPucker", 0.9 },
        { 5, "jawOpen", 0.25 },          { 5, "mouthStretchLeft", 0.6 },
        { 5, "mouthStretchRight", 0.6 }, { 6, "jawOpen", 0.75 },
        { 6, "browInnerUp", 0.5 },       { 7, "mouthRollLower", 0.8 },
        { 7, "mouthUpperUpLeft", 0.3 },  { 7, "mouthUpperUpRight", 0.3 },
        { 8, "jawOpen", 0.3 },           { 8, "mouthSmileLeft", 0.4 },
        { 8, "mouthSmileRight", 0.4 },   { 8, "tongueOut", 0.1 },
        { 9, "jawOpen", 0.4 },           { 9, "mouthFunnel", 0.9 },
        { 10, "blink", 0.3 },
        { 11, "jawOpen", 0.2 },          { 11, "mouthSmileLeft", 0.3 },
        { 11, "mouthSmileRight", 0.3 } } },
    { "wonder",
      "CUBICSPLINE",
      8,
      { 0, 0.4, 0.8, 1.6, 2.1, 2.6, 4.0, 5.0 },
      { { 1, "surprise", 0.7 },
        { 2, "surprise", 1 },
        { 3, "surprise", 0.9 },
        { 4, "surprise", 0.3 },
        { 4, "smile", 0.4 },
        { 4, "blink", 0.6 },
        { 5, "smile", 1 },
        { 6, "smile", 1 } } },
    /* A mask changes its face from one moment to the next. */
    { "masks",
      "STEP",
      6,
      { 0, 0.8, 1.6, 2.4, 3.2, 4.0 },
      { { 1, "smile", 1 }, { 2, "frown", 1 }, { 3, "anger", 1 }, { 4, "surprise", 1 } } },
};
/* clang-format on */

static double *weight_at(Animation *animation, int key, int target)
{
    int cubic = !strcmp(animation->interpolation, "CUBICSPLINE");
    int row = cubic ? 3 * key + 1 : key;
    return &animation->values[row * animation->target_count + target];
}

static Animation animation_blank(const char *name, const char *interpolation, int key_count, int target_count)
{
    Animation animation = { .name = name, .interpolation = interpolation, .key_count = key_count };
    animation.target_count = target_count;
    int rows = strcmp(interpolation, "CUBICSPLINE") ? key_count : 3 * key_count;
    animation.value_count = rows * target_count;
    animation.times = grab(NULL, key_count, (int)sizeof(double));
    animation.values = grab(NULL, animation.value_count, (int)sizeof(double));
    for (int i = 0; i < animation.value_count; i++) {
        animation.values[i] = 0;
    }
    return animation;
}

/* Slopes through the neighbouring keys, but flat at every extreme, so that no weight overshoots its keys. */
static void ease(Animation *animation)
{
    int targets = animation->target_count;
    for (int key = 1; key + 1 < animation->key_count; key++) {
        for (int target = 0; target < targets; target++) {
            double last = *weight_at(animation, key - 1, target), now = *weight_at(animation, key, target);
            double next = *weight_at(animation, key + 1, target);
            if ((now - last) * (next - now) <= 0) {
                continue;
            }
            double slope = (next - last) / (animation->times[key + 1] - animation->times[key - 1]);
            double *middle = weight_at(animation, key, target);
            middle[-targets] = middle[targets] = slope;
        }
    }
}

Animation animation_of(const WeightScript *script, int target_count)
{
    Animation animation = animation_blank(script->name, script->interpolation, script->key_count, target_count);
    for (int i = 0; i < script->key_count; i++) {
        animation.times[i] = script->times[i];
    }
    for (const WeightCue *cue = script->cues; cue->target; cue++) {
        int target = target_find(cue->target);
        if (target >= 0) {
            *weight_at(&animation, cue->key, target) = cue->weight;
        }
    }
    if (!strcmp(script->interpolation, "CUBICSPLINE")) {
        ease(&animation);
    }
    return animation;
}

/* Each target in turn: up, held for a moment, and down again. */
static Animation play_tour(void)
{
    int targets = MASK_TARGETS;
    Animation animation = animation_blank("tour", "LINEAR", 3 * targets + 1, targets);
    for (int target = 0; target < targets; target++) {
        animation.times[3 * target] = target;
        animation.times[3 * target + 1] = target + 0.3;
        animation.times[3 * target + 2] = target + 0.7;
        *weight_at(&animation, 3 * target + 1, target) = 1;
        *weight_at(&animation, 3 * target + 2, target) = 1;
    }
    animation.times[3 * targets] = targets;
    return animation;
}

Animation animation_make(int number)
{
    return number < ANIMATION_COUNT - 1 ? animation_of(&scripts[number], MASK_TARGETS) : play_tour();
}

void animation_free(Animation *animation)
{
    free(animation->times);
    free(animation->values);
}
