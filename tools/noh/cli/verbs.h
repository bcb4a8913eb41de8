/* verbs.h: the verbs of `noh`. Each is a file, VERB/cmd_VERB.c, which ends with the table of its options. */
#ifndef NOH_NOH_CLI_VERBS_H
#define NOH_NOH_CLI_VERBS_H

#include "args.h"

#define VERB_COUNT 22

extern const verb verb_build, verb_strip, verb_pack, verb_info, verb_clip, verb_budget, verb_light, verb_render,
    verb_sheet, verb_zoom, verb_dump, verb_verify, verb_view, verb_crowd, verb_drop, verb_speak, verb_mask, verb_bake,
    verb_face, verb_replay, verb_bisect, verb_bench;

/* In the order of the help. */
const verb *verb_at(int index);
/* NULL if there is none of that name. */
const verb *verb_find(const char *name);

#endif
