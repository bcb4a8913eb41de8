#include "verbs.h"

#include <stdio.h>
#include <string.h>

#include "convert/base/nearest.h"
#include "message.h"

const verb *verb_at(int index)
{
    static const verb *const all[VERB_COUNT] = {
        &verb_build, &verb_strip,  &verb_pack, &verb_info,  &verb_clip,   &verb_budget, &verb_render, &verb_sheet,
        &verb_dump,  &verb_verify, &verb_view, &verb_crowd, &verb_speak,  &verb_mask,   &verb_bake,   &verb_face,
        &verb_bench, &verb_zoom,   &verb_drop, &verb_light, &verb_replay, &verb_bisect,
    };
    return all[index];
}

int verb_is_lab(const verb *v)
{
    return strncmp(v->name, LAB_PREFIX, strlen(LAB_PREFIX)) == 0;
}

static const verb *find(const char *prefix, const char *name)
{
    const size_t length = strlen(prefix);
    for (int i = 0; i < VERB_COUNT; i++) {
        const char *full = verb_at(i)->name;
        if (strncmp(full, prefix, length) == 0 && strcmp(full + length, name) == 0) return verb_at(i);
    }
    return NULL;
}

static void unknown(const char *prefix, const char *name)
{
    const char *names[VERB_COUNT], *near;
    size_t count = 0;
    if (!*prefix && find(LAB_PREFIX, name)) {
        (void)tool_usage("there is no verb '%s': use noh lab %s", name, name);
        return;
    }
    for (int i = 0; i < VERB_COUNT; i++) {
        if (verb_is_lab(verb_at(i)) == (*prefix != 0)) names[count++] = verb_at(i)->name + strlen(prefix);
    }
    near = nearest_name(name, names, count);
    (void)(near ? tool_usage("there is no verb '%s%s' (did you mean '%s%s'?)", prefix, name, prefix, near)
                : tool_usage("there is no verb '%s%s'", prefix, name));
}

const verb *verb_read(int argc, char **argv, int *count)
{
    const int lab = argc > 1 && strcmp(argv[0], "lab") == 0;
    const char *prefix = lab ? LAB_PREFIX : "", *name = argv[lab];
    const verb *v = find(prefix, name);
    *count = 1 + lab;
    if (!v) unknown(prefix, name);
    return v;
}
