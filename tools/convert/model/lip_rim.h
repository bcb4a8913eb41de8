/* lip_rim.h: lips, found by what the targets of an open mouth (the recipe's aa) move: skin is connected to the point
 * that they move farthest; the lower lip is skin that moves and touches skin that stays. */
#ifndef NOH_CONVERT_MODEL_LIP_RIM_H
#define NOH_CONVERT_MODEL_LIP_RIM_H

#include <stdint.h>

#include "convert/model/model.h"

#define LIP_RIM_MAX 512u

/* A share of lip_rim.size, about 35 mm for a person: lips that touch are no further apart */
#define LIP_TOUCH 0.07

typedef struct lip_rim {
    const model_mesh *mesh;
    uint32_t *island; /* [vertex_count] */
    uint32_t *work;   /* [vertex_count] */
    uint32_t *next; /* [vertex_count] of what stays, the next of its cell; of what goes along, what is nearest to it */
    float *moved;   /* [vertex_count] how far the open mouth moves it */
    float *bite;    /* [vertex_count][3] rest, and the deltas of the recipe's FF */
    double most;    /* the farthest of `moved` */
    double size;    /* of the mouth: `most`, or half its width and two fifths, whichever is more */
    uint32_t skin;  /* island */
    uint32_t rim[LIP_RIM_MAX], rim_count;
    uint32_t upper[LIP_RIM_MAX]; /* the nearest vertex of the upper lip */
    double centre[3], along[3], half;
} lip_rim;

/* Find the lips of a mesh. 1: out of memory. lip_rim_free, also then.
 * why  the reason why there are none; NULL: found */
int lip_rim_find(const model_mesh *mesh, lip_rim *h, const char **why);
void lip_rim_free(lip_rim *h);

double lip_between(const lip_rim *h, uint32_t a, uint32_t b);

/* 0 at the middle of the mouth, 1 at a corner. */
double lip_aside(const lip_rim *h, const double at[3]);

/* Measure how far each target opens the lips (model_target.lips), in all meshes by its name, and how far they are open
 * at rest. slope: 1 over the depth of the mouth
 * rest    half the gap, in depths of the mouth; untouched: no target opens lips that can be found; larger where joints
 *         open them, too
 * errors  1: out of memory */
int lip_gaps_find(model *m, float slope, float *rest);

#endif
