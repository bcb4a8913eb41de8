/* verbs.h: the verbs of `noh`. Each is a file, VERB/cmd_VERB.c, which ends with the table of its options. Verbs for the
 * library's developers are named "lab VERB": they measure the library itself. */
#ifndef NOH_NOH_CLI_VERBS_H
#define NOH_NOH_CLI_VERBS_H

#include "args.h"

#define VERB_COUNT 22
#define LAB_PREFIX "lab "

extern const verb verb_build, verb_strip, verb_pack, verb_info, verb_clip, verb_budget, verb_render, verb_sheet,
    verb_dump, verb_verify, verb_view, verb_crowd, verb_speak, verb_mask, verb_bake, verb_face, verb_bench, verb_zoom,
    verb_drop, verb_light, verb_replay, verb_bisect;

/* In the order of the help. */
const verb *verb_at(int index);
/* 1 for a "lab VERB". */
int verb_is_lab(const verb *v);

/* The verb that begins argv: "render", "lab zoom". *count: how many arguments its name takes, 1 or 2. NULL after
 * printing that there is none. */
const verb *verb_read(int argc, char **argv, int *count);

#endif
