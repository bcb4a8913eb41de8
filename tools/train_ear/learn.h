/* learn.h: a network of two hidden layers, learnt by gradients (Kingma and Ba, "Adam", 2015), and put into bytes. */
#ifndef NOH_TRAIN_EAR_LEARN_H
#define NOH_TRAIN_EAR_LEARN_H

#include "life/face/ear_internal.h"

/* Frames of utterances, one after the other: the features of each, and its shape (-1: not known). */
typedef struct lesson {
    const int8_t (*features)[EAR_FEATURES];
    const signed char *shapes;
    const int (*spans)[2]; /* [count] first frame of an utterance to learn, and the frame after its last */
    int count;
} lesson;

/* Fills both hidden layers, the output, their biases and scales and the unit of `tables`. */
void learn(const lesson *l, int rounds, ear_tables *tables);

#endif
