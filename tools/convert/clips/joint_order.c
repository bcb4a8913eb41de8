#include "joint_order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CLASS_PART (1.0 / 2000.0) /* of the largest extent: extents closer than this are equal */
#define END_PART 0.125            /* of the longest chain: the most that the end of a chain counts */
#define LESS_PART 0.2             /* how far from the wanted share of joints a level may be cut */
#define MORE_PART 0.3

static const double level_shares[] = { 0.6, 0.35, 0.2, 0.1 };

static double length(const float *v)
{
    const double x = (double)v[0], y = (double)v[1], z = (double)v[2];
    return sqrt(x * x + y * y + z * z);
}

/* Extents, with the ends of chains counted as long as the bones that lead to them, up to `end`. Returns the largest. */
static double find_chains(const raw_skeleton *s, double end, double *extents)
{
    double largest = 0.0;
    for (uint32_t j = 0; j < s->joint_count; j++) {
        extents[j] = -1.0; /* nothing below it yet */
    }
    for (uint32_t j = s->joint_count; j-- > 0;) {
        const double bone = length(s->joints[j].translation);
        const uint32_t parent = s->joints[j].parent;
        extents[j] = extents[j] < 0.0 ? (parent == MODEL_NONE ? 0.0 : fmin(bone, end)) : extents[j];
        if (parent != MODEL_NONE) {
            extents[parent] = fmax(extents[parent], bone + extents[j]);
        }
        largest = fmax(largest, extents[j]);
    }
    return largest;
}

/* In the skeleton's unit. Returns the largest. */
static double find_extents(const raw_skeleton *s, double *extents)
{
    return find_chains(s, find_chains(s, 0.0, extents) * END_PART, extents);
}

/* ---- order ---- */

typedef struct ranked {
    double extent;
    uint32_t joint, rank; /* 0: without a parent; then the classes */
} ranked;

static int by_extent(const void *left, const void *right)
{
    const ranked *a = left, *b = right;
    return a->extent != b->extent ? (a->extent < b->extent ? 1 : -1) : a->joint < b->joint ? -1 : 1;
}

static int by_rank(const void *left, const void *right)
{
    const ranked *a = left, *b = right;
    return a->rank != b->rank ? (a->rank < b->rank ? -1 : 1) : a->joint < b->joint ? -1 : 1;
}

/* order [joint_count]: the joint for each place. */
static int find_order(const raw_skeleton *s, uint32_t *order)
{
    double *extents = malloc((s->joint_count + 1u) * sizeof *extents), near;
    ranked *all = malloc((s->joint_count + 1u) * sizeof *all);
    uint32_t rank = 1;
    int failed = !extents || !all;
    if (!failed) {
        near = find_extents(s, extents) * CLASS_PART;
        for (uint32_t j = 0; j < s->joint_count; j++) {
            all[j].joint = j;
            all[j].extent = extents[j];
        }
        qsort(all, s->joint_count, sizeof *all, by_extent);
        for (uint32_t i = 0; i < s->joint_count; i++) {
            rank += i && all[i - 1].extent - all[i].extent > near;
            all[i].rank = s->joints[all[i].joint].parent == MODEL_NONE ? 0 : rank;
        }
        qsort(all, s->joint_count, sizeof *all, by_rank);
        for (uint32_t i = 0; i < s->joint_count; i++) {
            order[i] = all[i].joint;
        }
    }
    free(extents);
    free(all);
    return failed;
}

/* ---- putting into order ---- */

/* rows[count][joints] of `bytes` each. */
static int permute(void *rows, size_t count, const uint32_t *order, uint32_t joints, size_t bytes)
{
    uint8_t *at = rows, *copy = malloc(joints * bytes);
    for (size_t r = 0; copy && r < count; r++, at += joints * bytes) {
        memcpy(copy, at, joints * bytes);
        for (uint32_t j = 0; j < joints; j++) {
            memcpy(at + j * bytes, copy + order[j] * bytes, bytes);
        }
    }
    free(copy);
    return !copy;
}

static int permute_clip(raw_clip *clip, const uint32_t *order)
{
    const uint32_t n = clip->joint_count;
    return n && (permute(clip->rotations, clip->frame_count, order, n, 4 * sizeof(float)) ||
                 permute(clip->translations, clip->frame_count, order, n, 3 * sizeof(float)) ||
                 permute(clip->scales, clip->frame_count, order, n, 3 * sizeof(float)));
}

/* places [joint_count]: where each joint went. */
static int permute_set(raw_set *set, const uint32_t *order, const uint32_t *places)
{
    raw_skeleton *s = &set->skeleton;
    int failed = permute(s->joints, 1, order, s->joint_count, sizeof *s->joints);
    for (uint32_t j = 0; j < s->joint_count; j++) {
        s->joints[j].parent = s->joints[j].parent == MODEL_NONE ? MODEL_NONE : places[s->joints[j].parent];
    }
    for (uint32_t c = 0; c < set->clip_count && !failed; c++) {
        failed = permute_clip(&set->clips[c], order);
    }
    return failed;
}

static int order_set(raw_set *set, uint32_t index, model *m)
{
    const uint32_t n = set->skeleton.joint_count;
    uint32_t *order = malloc((n + 1u) * sizeof *order), *places = malloc((n + 1u) * sizeof *places);
    int failed = !order || !places || find_order(&set->skeleton, order);
    for (uint32_t i = 0; i < n && !failed; i++) {
        places[order[i]] = i;
    }
    failed = failed || (n && permute_set(set, order, places));
    for (uint32_t s = 0; s < m->skin_count && !failed; s++) {
        model_skin *skin = &m->skins[s];
        for (uint32_t j = 0; skin->set == index && skin->skeleton_joints && j < skin->joint_count; j++) {
            skin->skeleton_joints[j] = places[skin->skeleton_joints[j]];
        }
    }
    free(order);
    free(places);
    return failed;
}

int joint_order_sets(raw_set **sets, uint32_t set_count, model *m)
{
    int failed = 0;
    for (uint32_t i = 0; i < set_count && !failed; i++) {
        failed = order_set(sets[i], i, m);
    }
    return failed;
}

/* ---- levels ---- */

/* How much the extent falls at a place between joints, as a part of the extent before it; 0 where no level may be cut.
 */
typedef struct cuts {
    double *falls; /* [joint_count]: before each joint */
    uint32_t joint_count;
} cuts;

static void find_cuts(const raw_skeleton *s, const double *extents, double near, cuts *c)
{
    double above = HUGE_VAL;
    uint32_t roots = 0;
    for (uint32_t j = 0; j < s->joint_count; j++) {
        const int is_root = s->joints[j].parent == MODEL_NONE;
        c->falls[j] = j ? above : 0.0;
        roots = is_root ? j + 1u : roots;
        above = is_root ? above : fmin(above, extents[j]);
    }
    above = 0.0; /* from here on: the joints after the place */
    for (uint32_t j = s->joint_count; j-- > 0;) {
        const int is_root = s->joints[j].parent == MODEL_NONE;
        above = is_root ? above : fmax(above, extents[j]);
        c->falls[j] = j < roots || !(c->falls[j] - above > near) ? 0.0
                      : c->falls[j] == HUGE_VAL                  ? 1.0
                                                                 : 1.0 - above / c->falls[j];
    }
}

/* The best place near a share of the joints, below `most`; 0: there is none. */
static uint32_t choose_cut(const cuts *c, double share, uint32_t most)
{
    const double wanted = share * c->joint_count;
    const double least = wanted - fmax(LESS_PART * wanted, 1.0), greatest = wanted + fmax(MORE_PART * wanted, 1.0);
    uint32_t best = 0;
    for (uint32_t j = 1; j < most; j++) {
        if ((double)j >= least && (double)j <= greatest && c->falls[j] > 0.0 &&
            (!best || c->falls[j] > c->falls[best])) {
            best = j;
        }
    }
    return best;
}

uint32_t joint_levels(const raw_skeleton *s, uint32_t *counts)
{
    double *extents = malloc((s->joint_count + 1u) * sizeof *extents);
    cuts c = { malloc((s->joint_count + 1u) * sizeof *c.falls), s->joint_count };
    uint32_t level_count = 0;
    if (extents && c.falls) {
        const double near = find_extents(s, extents) * CLASS_PART;
        find_cuts(s, extents, near, &c);
        counts[level_count++] = s->joint_count;
        for (size_t i = 0; i < sizeof level_shares / sizeof *level_shares; i++) {
            const uint32_t cut = choose_cut(&c, level_shares[i], counts[level_count - 1u]);
            if (cut) {
                counts[level_count++] = cut;
            }
        }
    }
    free(extents);
    free(c.falls);
    return level_count;
}
