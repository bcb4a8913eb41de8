#include "springs_chain.h"

#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"

#define SHORTEST 1e-5f /* bones below this have no direction, in the skeleton's unit */

static int has_length(const float v[3])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2] > SHORTEST * SHORTEST;
}

void springs_place(const raw_skeleton *skeleton, uint32_t joint, uint32_t above, float out[3])
{
    memset(out, 0, 3 * sizeof *out);
    for (uint32_t j = joint; j != above && j != MODEL_NONE; j = skeleton->joints[j].parent) {
        const raw_joint *r = &skeleton->joints[j];
        for (int i = 0; i < 3; i++) out[i] *= r->scale[i];
        noh_quat_rotate(r->rotation, out, out);
        for (int i = 0; i < 3; i++) out[i] += r->translation[i];
    }
}

int springs_swings(const set_springs *springs, uint32_t joint)
{
    for (uint32_t i = 0; i < springs->row_count; i++) {
        if (springs->rows[i].joint == joint) return 1;
    }
    return 0;
}

int springs_add_collider(set_springs *out, const noh_spring_capsule *collider, uint32_t *bit)
{
    noh_spring_capsule *grown;
    *bit = 0;
    if (out->collider_count == NOH_SPRING_COLLIDERS_MAX) return 0;
    grown = realloc(out->colliders, (out->collider_count + 1u) * sizeof *grown);
    if (!grown) return 1;
    out->colliders = grown;
    *bit = 1u << out->collider_count;
    grown[out->collider_count++] = *collider;
    return 0;
}

static int add_chain(set_springs *out, const noh_spring_row *rows, uint32_t count, const float end[3],
                     uint32_t collides)
{
    noh_spring_row *more = realloc(out->rows, (out->row_count + count) * sizeof *more);
    noh_spring_chain *chains;
    if (more) out->rows = more;
    chains = more ? realloc(out->chains, (out->chain_count + 1u) * sizeof *chains) : NULL;
    if (!chains) return 1;
    out->chains = chains;
    memset(&chains[out->chain_count], 0, sizeof *chains);
    chains[out->chain_count].first_row = out->row_count;
    chains[out->chain_count].row_count = count;
    chains[out->chain_count].collides = collides;
    memcpy(chains[out->chain_count].end, end, sizeof chains->end);
    memcpy(more + out->row_count, rows, count * sizeof *rows);
    out->row_count += count;
    out->chain_count++;
    return 0;
}

/* How many joints from `first` on are one chain, and where its last bone ends; 0: that joint cannot begin one. */
static uint32_t take_run(const set_springs *out, const springs_path *p, uint32_t first, float end[3])
{
    uint32_t n = first;
    if (p->skeleton->joints[p->rows[first].joint].parent == MODEL_NONE || springs_swings(out, p->rows[first].joint)) {
        return 0;
    }
    for (n = first + 1u; n < p->count && n - first < NOH_SPRING_JOINTS_MAX; n++) {
        const raw_joint *joint = &p->skeleton->joints[p->rows[n].joint];
        if (joint->parent != p->rows[n - 1u].joint || !has_length(joint->translation) ||
            springs_swings(out, p->rows[n].joint))
            break;
    }
    if (n < p->count) {
        springs_place(p->skeleton, p->rows[n].joint, p->rows[n - 1u].joint, end);
    } else {
        memcpy(end, p->end, 3 * sizeof *end);
    }
    if (has_length(end)) return n - first;
    if (n - first < 2u) return 0;
    memcpy(end, p->skeleton->joints[p->rows[n - 1u].joint].translation, 3 * sizeof *end);
    return n - first - 1u; /* a last bone without length does not swing */
}

int springs_add_path(set_springs *out, const springs_path *path, uint32_t *left_out)
{
    for (uint32_t first = 0; first < path->count;) {
        float end[3];
        const uint32_t count = take_run(out, path, first, end);
        if (count) {
            if (add_chain(out, path->rows + first, count, end, path->collides)) return 1;
        } else if (!springs_swings(out, path->rows[first].joint)) {
            ++*left_out;
        }
        first += count ? count : 1u;
    }
    return 0;
}

/* ---- order ---- */

static int by_first_joint(const void *left, const void *right)
{
    const uint32_t *a = left, *b = right;
    return a[0] < b[0] ? -1 : a[0] > b[0];
}

static int sort(set_springs *s)
{
    uint32_t(*order)[2] = malloc((s->chain_count + 1u) * sizeof *order), next = 0;
    noh_spring_row *rows = malloc((s->row_count + 1u) * sizeof *rows);
    noh_spring_chain *chains = malloc((s->chain_count + 1u) * sizeof *chains);
    const int failed = !order || !rows || !chains;
    for (uint32_t i = 0; !failed && i < s->chain_count; i++) {
        order[i][0] = s->rows[s->chains[i].first_row].joint;
        order[i][1] = i;
    }
    if (!failed && s->chain_count) qsort(order, s->chain_count, sizeof *order, by_first_joint);
    for (uint32_t i = 0; !failed && i < s->chain_count; i++) {
        chains[i] = s->chains[order[i][1]];
        memcpy(rows + next, s->rows + chains[i].first_row, chains[i].row_count * sizeof *rows);
        chains[i].first_row = next;
        next += chains[i].row_count;
    }
    if (!failed && s->chain_count) {
        memcpy(s->rows, rows, s->row_count * sizeof *rows);
        memcpy(s->chains, chains, s->chain_count * sizeof *chains);
    }
    free(order);
    free(rows);
    free(chains);
    return failed;
}

/* Joints come after their parents, so chains sorted by their first joints follow the chains they are attached to. */
int springs_sort(set_springs *springs, uint32_t set_count)
{
    for (uint32_t i = 0; i < set_count; i++) {
        if (sort(&springs[i])) return 1;
    }
    return 0;
}

void springs_free(set_springs *springs, uint32_t set_count)
{
    for (uint32_t i = 0; springs && i < set_count; i++) {
        free(springs[i].rows);
        free(springs[i].chains);
        free(springs[i].colliders);
    }
    free(springs);
}
