/* The puppet's clips: functions from time to stance and face, sampled at 30 Hz. All are loops but those that get up
 * and those that roam, which are in files of their own. */
#ifndef PUPPET_CLIPS_H
#define PUPPET_CLIPS_H

#include "stance.h"

enum {
    CLIP_COUNT = 5,
    GET_UP_COUNT = 2,
    ROAM_COUNT = 10,
    ROAM_ALL = 16,
    ROAM_STEPS = 900,
    CLIP_RATE_HZ = 30,
    CUES_MAX = 48
};

/* A callback key. */
typedef struct {
    double time_s;
    const char *name;
    int payload; /* -1: none */
} Cue;

typedef struct {
    const char *name;
    int steps;                                    /* of 1/30 s; there is one more frame than steps */
    Stance (*stance)(double time_s);              /* also a little before the start and after the end */
    void (*face)(double time_s, double *weights); /* fills zeros: a weight for each of the mask's targets */
    int (*cues)(Cue *cues);                       /* in time order; returns their number, up to CUES_MAX */
    int once;                                     /* 1: it does not end as it begins */
} Clip;

extern const Clip clip_idle, clip_walk, clip_bow, clip_look_round, clip_dance, clip_get_up_back, clip_get_up_front;

const Clip *clip_number(int number);
const Clip *get_up_number(int number);
const Clip *roam_number(int number);

/* A frame of the clip, with sleeves that trail behind the hands. The last frame of a loop equals the first to the bit,
 * except for the root displacement. */
Posed clip_frame(const Clip *clip, int frame);

/* --- for the clips --- */

/* Through the keys, resting at each. */
double glide(const Key *keys, int count, double x);

/* 0 to 1 at an even pace, with soft starts and ends that take `soft` of the way each. */
double pace(double x, double soft);

/* 1 for a moment about `at`: how far the lids are shut. */
double blink_at(double time_s, double at);

void face_add(double *weights, const char *target, double amount);

#endif
