#include "scene.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "convert/base/nearest.h"

static int add_item(scene *s, const pack_file *file, uint32_t node, uint32_t mesh)
{
    const noh_mesh *m = &s->meshes[mesh];
    scene_item *item = &s->items[s->item_count];
    const float *defaults = m->weights;
    if (node != NOH_NONE && file->pack.nodes[node].first_weight != NOH_NONE) {
        defaults = file->pack.node_weights + file->pack.nodes[node].first_weight;
    }
    item->node = node;
    item->mesh = mesh;
    item->weights = calloc(m->header->target_count + 1u, sizeof *item->weights);
    if (!item->weights) {
        return 1;
    }
    memcpy(item->weights, defaults, sizeof *defaults * m->header->target_count);
    s->item_count += 1;
    return 0;
}

static int init_player(scene_player *p, const noh_pack *pack, uint32_t skeleton)
{
    if (noh_pack_skeleton_at(pack, skeleton, &p->skeleton, NULL, NULL)) {
        return 0;
    }
    p->joint_matrices = calloc(p->skeleton.joint_count, 12 * sizeof(float));
    if (!p->joint_matrices) {
        return 1;
    }
    noh_local_to_model(&p->skeleton, p->skeleton.bind_pose, p->skeleton.joint_count, p->joint_matrices);
    return 0;
}

static int init_players(scene *s, const noh_pack *pack)
{
    int failed = 0;
    s->player_count = pack->skeleton_count ? pack->skeleton_count : 1u;
    s->players = calloc(s->player_count, sizeof *s->players);
    for (uint32_t i = 0; s->players && !failed && i < s->player_count; i++) {
        failed = init_player(&s->players[i], pack, i);
    }
    if (!s->players || failed) {
        return 1;
    }
    s->skeleton = s->players[0].skeleton;
    s->joint_matrices = s->players[0].joint_matrices;
    return 0;
}

int scene_init(scene *s, const pack_file *file)
{
    const noh_pack *pack = &file->pack;
    int failed;
    memset(s, 0, sizeof *s);
    s->meshes = calloc(pack->mesh_count + 1u, sizeof *s->meshes);
    s->items = calloc((size_t)pack->node_count + pack->mesh_count + 1u, sizeof *s->items);
    s->anim = file;
    failed = !s->meshes || !s->items || init_players(s, pack);
    for (uint32_t i = 0; !failed && i < pack->mesh_count; i++) {
        noh_pack_mesh_at(pack, i, &s->meshes[i], NULL);
    }
    for (uint32_t n = 0; !failed && n < pack->node_count; n++) {
        if (pack->nodes[n].mesh != NOH_NONE) {
            failed = add_item(s, file, n, pack->nodes[n].mesh);
        }
    }
    for (uint32_t m = 0; !failed && !pack->node_count && m < pack->mesh_count; m++) {
        failed = add_item(s, file, NOH_NONE, m);
    }
    if (failed) {
        scene_free(s);
        return tool_fail(file->path, "out of memory");
    }
    return 0;
}

void scene_free(scene *s)
{
    for (uint32_t i = 0; i < s->item_count; i++) {
        free(s->items[i].weights);
    }
    for (uint32_t i = 0; s->players && i < s->player_count; i++) {
        scene_close_player(&s->players[i]);
        free(s->players[i].joint_matrices);
    }
    if (s->anim_file.path) {
        pack_file_close(&s->anim_file);
    }
    free(s->players);
    free(s->items);
    free(s->meshes);
    memset(s, 0, sizeof *s);
}

/* "no clip 'simle' (did you mean 'smile'?)", or the list's size when nothing is near. */
int scene_fail_unknown(const pack_file *file, const char *kind, const char *name, const char *const *names,
                       size_t count)
{
    const char *near = nearest_name(name, names, count);
    if (near) {
        return tool_fail(file->path, "no %s named '%s' (did you mean '%s'?)", kind, name, near);
    }
    return tool_fail(file->path, "no %s named '%s' (it has %zu; `noh info` lists them)", kind, name, count);
}

static int fail_unknown_target(const scene *s, const pack_file *file, const char *name)
{
    size_t total = 0, count = 0;
    const char **names;
    int status;
    for (uint32_t m = 0; m < file->pack.mesh_count; m++) {
        total += s->meshes[m].header->target_count;
    }
    names = calloc(total + 1, sizeof *names);
    if (!names) {
        return tool_fail(file->path, "out of memory");
    }
    for (uint32_t m = 0; m < file->pack.mesh_count; m++) {
        for (uint32_t t = 0; t < s->meshes[m].header->target_count; t++) {
            names[count++] = noh_pack_string(&file->pack, s->meshes[m].targets[t].name);
        }
    }
    status = scene_fail_unknown(file, "target", name, names, count);
    free(names);
    return status;
}

static int set_weight(scene *s, const pack_file *file, const char *assignment)
{
    const char *equals = strrchr(assignment, '=');
    char name[NOH_NAME_BYTES_MAX];
    double value;
    int found = 0;
    if (!equals || equals == assignment || (size_t)(equals - assignment) >= sizeof name ||
        tool_number(equals + 1, &value)) {
        return tool_usage("--weight wants NAME=NUMBER, not '%s'", assignment);
    }
    memcpy(name, assignment, (size_t)(equals - assignment));
    name[equals - assignment] = 0;
    for (uint32_t i = 0; i < s->item_count; i++) {
        const noh_mesh *m = &s->meshes[s->items[i].mesh];
        uint32_t target = noh_mesh_find_target(m, name);
        if (target < m->header->target_count) {
            s->items[i].weights[target] = (float)value;
            found = 1;
        }
    }
    return found ? 0 : fail_unknown_target(s, file, name);
}

int scene_set_weights(scene *s, const pack_file *file, const option_list *assignments)
{
    for (int i = 0; i < assignments->count; i++) {
        int status = set_weight(s, file, assignments->items[i]);
        if (status) {
            return status;
        }
    }
    return 0;
}

const float *scene_world(const scene *s, const pack_file *file, uint32_t item)
{
    static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    return s->items[item].node == NOH_NONE ? identity : file->pack.nodes[s->items[item].node].world;
}
