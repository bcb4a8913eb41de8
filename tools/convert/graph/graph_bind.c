/* graph_bind.c: the clips and joints that a graph names, looked for among the inputs. */
#include <stdlib.h>
#include <string.h>

#include "graph_internal.h"

/* All names of clips, or of joints, of some sets. */
typedef struct name_list {
    const char **names;
    size_t count;
} name_list;

static size_t count_names(raw_set *const *sets, uint32_t set_count, int joints)
{
    size_t count = 0;
    for (uint32_t s = 0; s < set_count; ++s) count += joints ? sets[s]->skeleton.joint_count : sets[s]->clip_count;
    return count;
}

static int list_names(raw_set *const *sets, uint32_t set_count, int joints, name_list *list)
{
    list->count = 0;
    list->names = malloc((count_names(sets, set_count, joints) + 1) * sizeof *list->names);
    if (!list->names) return 1;
    for (uint32_t s = 0; s < set_count; ++s) {
        const uint32_t count = joints ? sets[s]->skeleton.joint_count : sets[s]->clip_count;
        for (uint32_t i = 0; i < count; ++i) {
            const char *name = joints ? sets[s]->skeleton.joints[i].name : sets[s]->clips[i].name;
            if (name) list->names[list->count++] = name;
        }
    }
    return 0;
}

static int find_name(graph_reader *r, const name_list *list, const char *kind, const char *name, uint32_t line)
{
    char hint[GRAPH_HINT];
    for (size_t i = 0; i < list->count; ++i)
        if (strcmp(list->names[i], name) == 0) return 0;
    return graph_fail(r, line, "no input has a %s '%.60s'%s", kind, name,
                      graph_hint(name, list->names, list->count, hint));
}

static int bind_graph(graph_reader *r, const graph_def *g, const name_list *clips, const name_list *joints)
{
    for (uint32_t i = 0; i < g->node_count; ++i)
        if (g->nodes[i].clip && find_name(r, clips, "clip", g->nodes[i].clip, g->nodes[i].line)) return 1;
    for (uint32_t i = 0; i < g->node_count; ++i) {
        const graph_name *name = g->nodes[i].reference ? &g->names[g->nodes[i].reference - 1u] : NULL;
        if (name && find_name(r, clips, "clip", name->name, name->line)) return 1;
    }
    for (uint32_t m = 0; m < g->mask_count; ++m) {
        for (uint32_t i = 0; i < g->masks[m].joint_count; ++i) {
            const graph_name *joint = &g->names[g->masks[m].first_joint + i];
            if (find_name(r, joints, "joint", joint->name, joint->line)) return 1;
        }
    }
    return 0;
}

int graph_text_bind(const graph_file *file, raw_set *const *sets, uint32_t set_count, uint32_t *line,
                    model_error *error)
{
    name_list clips = { NULL, 0 }, joints = { NULL, 0 };
    graph_reader *r = calloc(1, sizeof *r);
    int failed = !r || list_names(sets, set_count, 0, &clips) || list_names(sets, set_count, 1, &joints);
    *line = 0;
    if (failed) (void)model_fail_memory(error);
    if (r) {
        r->error = error;
        r->line = line;
    }
    for (uint32_t i = 0; i < file->count && !failed; ++i) failed = bind_graph(r, file->graphs[i], &clips, &joints);
    free(clips.names);
    free(joints.names);
    free(r);
    return failed;
}
