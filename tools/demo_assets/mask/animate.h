/* The demo's animations: weights of the morph targets over time. */
#ifndef MASK_ANIMATE_H
#define MASK_ANIMATE_H

typedef struct {
    const char *name, *interpolation; /* as glTF spells it */
    int key_count, target_count;
    double *times;
    double *values; /* per key: all weights; for CUBICSPLINE in-slopes, weights, out-slopes */
    int value_count;
} Animation;

/* The weight of one target at one key. Targets that are not named are 0. Weights add up: targets that shut the same
 * lips or lids may have at most 1 together. */
typedef struct {
    int key;
    const char *target;
    double weight;
} WeightCue;

typedef struct {
    const char *name, *interpolation;
    int key_count;
    double times[16];
    WeightCue cues[48]; /* ends with a NULL target */
} WeightScript;

/* The animation that the script describes, of the first `target_count` targets. */
Animation animation_of(const WeightScript *script, int target_count);

enum { ANIMATION_COUNT = 6 };

Animation animation_make(int number);
void animation_free(Animation *animation);

#endif
