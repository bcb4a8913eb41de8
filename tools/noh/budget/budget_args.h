/* budget_args.h: the options of `noh budget`, and its functions for stages. */
#ifndef NOH_NOH_BUDGET_BUDGET_ARGS_H
#define NOH_NOH_BUDGET_BUDGET_ARGS_H

#include "cli/args.h"
#include "budget_phone.h"
#include "draw/figure.h"
#include "noh/gl_device.h"

/* Options that are whole numbers. */
enum { ACTORS, NEAR, MIDDLE, FINEST, BYTES, CPU_BYTES, GPU_BYTES, HEIGHT, JOBS, RAGDOLLS, COUNT_OPTIONS };

typedef struct budget_args {
    const char *pack, *anim, *path, *accumulate, *driver;
    double instances, lod;
    int as_json, nominal, why, strict;
    figure_desc figure;
    const char *gpu, *tier; /* gpu: NULL, no phone */
    budget_phone phone;
    /* of a stage */
    const char *desc, *place, *ground;
    const char *texts[COUNT_OPTIONS]; /* NULL: not given */
    uint64_t counts[COUNT_OPTIONS];   /* 0: not given */
    const char *pixels_text;
    double pixels;
    int halves, without_gpu;
    option_list clips;
} budget_args;

/* The capabilities of the driver, or of a nominal device: also for what draws nothing, a pack of clips alone. */
int budget_caps(const budget_args *a, int draws, noh_gl_caps *caps);

/* These print errors and return an exit code. */
int stage_args_check(budget_args *a);
int budget_of_actors(const budget_args *a); /* --actors: one kind, the pack's characters */
int budget_of_desc(const budget_args *a);   /* --desc */

#endif
