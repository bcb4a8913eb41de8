/* learn.h: a network of one hidden layer, learnt by gradients (Kingma and Ba, "Adam", 2015), and put into bytes. */
#ifndef NOH_TRAIN_EAR_LEARN_H
#define NOH_TRAIN_EAR_LEARN_H

#include "life/face/ear_internal.h"

/* Frames that follow each other: what is seen of each, and its shape (-1: not known). */
typedef struct lesson {
    const int8_t (*features)[EAR_FEATURES];
    const signed char *shapes;
    const int *middles; /* [count] frames to learn: those before and after it are there, and of the same utterance */
    int count;
} lesson;

/* Fills hidden, output, their biases and the unit of `tables`. */
void learn(const lesson *l, int rounds, ear_tables *tables);

#endif
