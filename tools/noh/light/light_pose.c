#include "light_pose.h"

#include <string.h>

#define FARTHEST_COUNT 4u

/* The letters of a name, small, one after the other: "Mouth-Open_L" is "mouthopenl". */
static void letters_of(const char *name, char letters[NOH_NAME_BYTES_MAX])
{
    size_t count = 0;
    for (; *name && count + 1u < NOH_NAME_BYTES_MAX; name++) {
        const char small = *name >= 'A' && *name <= 'Z' ? (char)(*name - 'A' + 'a') : *name;
        if (small >= 'a' && small <= 'z') letters[count++] = small;
    }
    letters[count] = 0;
}

/* Words that a name must contain; if an expression has left and right targets, only these are used. */
static const char *const expressions[][2] = {
    { "mouthopen", "" }, { "jawopen", "" }, { "brow", "down" }, { "cornerpuller", "" }, { "smile", "" },
};
#define EXPRESSION_COUNT (sizeof expressions / sizeof expressions[0])

/* 0: another one; 1: this expression; 2: of one side. */
static int match(const noh_mesh *mesh, uint32_t target, const char *const words[2])
{
    char letters[NOH_NAME_BYTES_MAX];
    letters_of(noh_pack_string(mesh->pack, mesh->targets[target].name), letters);
    if (!strstr(letters, words[0]) || !strstr(letters, words[1])) {
        return 0;
    }
    return strstr(letters, "left") || strstr(letters, "right") ? 2 : 1;
}

/* Returns how many targets show the expression. */
static uint32_t pose_expression(const noh_mesh *mesh, const char *const words[2], float *weights)
{
    uint32_t found = 0;
    int best = 1;
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        best = match(mesh, t, words) > best ? 2 : best;
    }
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        if (match(mesh, t, words) == best) {
            weights[t] = 1.0f;
            found++;
        }
    }
    return found;
}

static void pose_farthest(const noh_mesh *mesh, float *weights)
{
    for (uint32_t i = 0; i < FARTHEST_COUNT && i < mesh->header->target_count; i++) {
        uint32_t best = NOH_NONE;
        for (uint32_t t = 0; t < mesh->header->target_count; t++) {
            if (weights[t] == 0.0f && (best == NOH_NONE || mesh->targets[t].radius > mesh->targets[best].radius)) {
                best = t;
            }
        }
        weights[best] = 1.0f;
    }
}

static void assign(const noh_mesh *mesh, const option_list *assignments, float *weights)
{
    for (int i = 0; i < assignments->count; i++) {
        const char *equals = strrchr(assignments->items[i], '=');
        char name[NOH_NAME_BYTES_MAX];
        double value;
        uint32_t target;
        if (!equals || (size_t)(equals - assignments->items[i]) >= sizeof name || tool_number(equals + 1, &value)) {
            continue; /* refused before */
        }
        memcpy(name, assignments->items[i], (size_t)(equals - assignments->items[i]));
        name[equals - assignments->items[i]] = 0;
        target = noh_mesh_find_target(mesh, name);
        if (target != NOH_NONE) weights[target] = (float)value;
    }
}

void light_pose(const noh_mesh *mesh, const option_list *assignments, float *weights)
{
    uint32_t found = 0;
    memset(weights, 0, mesh->header->target_count * sizeof *weights);
    if (assignments->count) {
        assign(mesh, assignments, weights);
        return;
    }
    for (size_t i = 0; i < EXPRESSION_COUNT; i++) {
        found += pose_expression(mesh, expressions[i], weights);
    }
    if (!found) {
        pose_farthest(mesh, weights);
    }
}
