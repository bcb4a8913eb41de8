#include "lod_joints_weights.h"

#include <string.h>

#define CANDIDATES 8u /* joints of a point that are tried in all combinations */
#define RIDGE 1e-6    /* of a diagonal element */

typedef struct choice {
    uint32_t count, joint[CANDIDATES];
    double gram[CANDIDATES][CANDIDATES], with[CANDIDATES];
} choice;

double joint_dot(const float *a, const float *b, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += (double)a[i] * (double)b[i];
    return sum;
}

/* ---- candidates ---- */

static int is_candidate(const choice *c, uint32_t joint)
{
    for (uint32_t i = 0; i < c->count; i++) {
        if (c->joint[i] == joint) return 1;
    }
    return 0;
}

/* Add the joints that alone come nearest to a column, until there are `most`. */
static void add_nearest(const joint_columns *of, const float *to, uint32_t most, choice *c)
{
    double gain[CANDIDATES];
    uint32_t nearest[CANDIDATES], count = 0;
    const uint32_t room = most - c->count;
    for (uint32_t j = 0; j < of->joint_count; j++) {
        const float *own = of->predicted + j * of->width;
        double with, length, w, least;
        uint32_t at;
        if (of->parent[j] != of->of || is_candidate(c, j)) continue;
        with = joint_dot(own, to, of->width);
        length = joint_dot(own, own, of->width);
        w = length > 0.0 && with > 0.0 ? with / length : 0.0;
        w = w < of->share ? w : of->share;
        least = w * (w * length - 2.0 * with);
        at = count < room ? count++ : room;
        while (at && least < gain[at - 1u]) {
            if (at < room) {
                gain[at] = gain[at - 1u];
                nearest[at] = nearest[at - 1u];
            }
            at--;
        }
        if (at < room) {
            gain[at] = least;
            nearest[at] = j;
        }
    }
    for (uint32_t i = 0; i < count; i++) c->joint[c->count++] = nearest[i];
}

/* The joints of the last round, so that a round is no worse than the one before; half of the others are nearest alone,
 * the rest nearest to what the last round left. */
static void choose(const joint_columns *of, const uint8_t *joint, const float *weight, float *left, choice *c)
{
    memcpy(left, of->wanted, of->width * sizeof *left);
    c->count = 0;
    for (uint32_t i = 0; i < JOINTS_PER_VERTEX; i++) {
        const float *own = of->predicted + joint[i] * of->width;
        if (!(weight[i] > 0.0f)) continue;
        c->joint[c->count++] = joint[i];
        for (size_t k = 0; k < of->width; k++) left[k] -= weight[i] * own[k];
    }
    add_nearest(of, of->wanted, (c->count + CANDIDATES) / 2u, c);
    add_nearest(of, left, CANDIDATES, c);
    for (uint32_t i = 0; i < c->count; i++) {
        const float *own = of->predicted + c->joint[i] * of->width;
        c->with[i] = joint_dot(own, of->wanted, of->width);
        for (uint32_t k = 0; k <= i; k++) {
            c->gram[i][k] = c->gram[k][i] = joint_dot(own, of->predicted + c->joint[k] * of->width, of->width);
        }
    }
}

/* ---- weights ---- */

/* Two right sides at once, by elimination; the matrix is positive once its diagonal has grown a little. */
static void solve_small(double a[JOINTS_PER_VERTEX][JOINTS_PER_VERTEX], double b[JOINTS_PER_VERTEX][2], uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t r = i + 1u; r < n; r++) {
            const double times = a[r][i] / a[i][i];
            for (uint32_t k = i; k < n; k++) a[r][k] -= times * a[i][k];
            b[r][0] -= times * b[i][0];
            b[r][1] -= times * b[i][1];
        }
    }
    for (uint32_t i = n; i-- > 0u;) {
        for (uint32_t e = 0; e < 2u; e++) {
            for (uint32_t k = i + 1u; k < n; k++) b[i][e] -= a[i][k] * b[k][e];
            b[i][e] /= a[i][i];
        }
    }
}

/* Weights of a set of candidates that come nearest: none below 0, their sum at most the share, or all of it where no
 * slot is left for the parent. Returns the change of the squared distance; above 0: another set is better. */
static double weigh(const choice *c, const uint32_t *set, uint32_t n, double share, int whole,
                    double w[JOINTS_PER_VERTEX])
{
    double a[JOINTS_PER_VERTEX][JOINTS_PER_VERTEX], b[JOINTS_PER_VERTEX][2], sum = 0.0, ones = 0.0, change = 0.0;
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t k = 0; k < n; k++) a[i][k] = c->gram[set[i]][set[k]];
        a[i][i] += RIDGE * a[i][i] + 1e-20;
        b[i][0] = c->with[set[i]];
        b[i][1] = 1.0;
    }
    solve_small(a, b, n);
    for (uint32_t i = 0; i < n; i++) {
        sum += b[i][0];
        ones += b[i][1];
    }
    for (uint32_t i = 0; i < n; i++) {
        w[i] = sum > share || whole ? b[i][0] - (sum - share) / ones * b[i][1] : b[i][0];
        if (!(w[i] >= 0.0)) return 1.0;
    }
    for (uint32_t i = 0; i < n; i++) {
        change -= 2.0 * w[i] * c->with[set[i]];
        for (uint32_t k = 0; k < n; k++) change += w[i] * w[k] * c->gram[set[i]][set[k]];
    }
    return change;
}

/* All sets of candidates are tried: with eight there are 162 of at most four. */
void joint_weigh(const joint_columns *of, uint8_t joint[JOINTS_PER_VERTEX], float weight[JOINTS_PER_VERTEX],
                 float *left)
{
    double best = 0.0;
    choice c;
    choose(of, joint, weight, left, &c);
    memset(joint, 0, JOINTS_PER_VERTEX);
    memset(weight, 0, JOINTS_PER_VERTEX * sizeof *weight);
    for (uint32_t bits = 1; bits < 1u << c.count; bits++) {
        uint32_t set[JOINTS_PER_VERTEX], n = 0, count = 0;
        double w[JOINTS_PER_VERTEX], change;
        for (uint32_t i = 0; i < c.count; i++) count += bits >> i & 1u;
        if (count > of->slots) continue;
        for (uint32_t i = 0; i < c.count; i++) {
            if (bits >> i & 1u) set[n++] = i;
        }
        change = weigh(&c, set, n, of->share, n == of->slots, w);
        if (change < best) {
            best = change;
            memset(weight, 0, JOINTS_PER_VERTEX * sizeof *weight);
            for (uint32_t i = 0; i < n; i++) {
                joint[i] = (uint8_t)c.joint[set[i]];
                weight[i] = (float)w[i];
            }
        }
    }
}
