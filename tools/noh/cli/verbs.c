#include "verbs.h"

#include <string.h>

const verb *verb_at(int index)
{
    static const verb *const all[VERB_COUNT] = {
        &verb_build, &verb_strip, &verb_pack, &verb_info,   &verb_clip,   &verb_budget, &verb_light, &verb_render,
        &verb_sheet, &verb_zoom,  &verb_dump, &verb_verify, &verb_view,   &verb_crowd,  &verb_drop,  &verb_speak,
        &verb_mask,  &verb_bake,  &verb_face, &verb_replay, &verb_bisect, &verb_bench,
    };
    return all[index];
}

const verb *verb_find(const char *name)
{
    for (int i = 0; i < VERB_COUNT; i++) {
        if (strcmp(verb_at(i)->name, name) == 0) {
            return verb_at(i);
        }
    }
    return NULL;
}
