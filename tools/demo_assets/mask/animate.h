/* The demo's animations: weights of the morph targets over time. */
#ifndef MASK_ANIMATE_H
#define MASK_ANIMATE_H

typedef struct {
    const char *name, *interpolation; /* as glTF spells it */
    int key_count;
    double *times;
    double *values; /* per key: all weights; for CUBICSPLINE in-slopes, weights, out-slopes */
    int value_count;
} Animation;

enum { ANIMATION_COUNT = 6 };

Animation animation_make(int number);
void animation_free(Animation *animation);

#endif
