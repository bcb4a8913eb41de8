#include "lod_joints_weights.h"

#include "lod_joints.h"

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

/* Of one column with three others, with the bits of joint_dot: each addition waits for the last one of its sum, so that
 * three sums take the time of one. */
static void three_dots(const float *a, const float *const others[3], size_t count, double out[3])
{
    const float *b = others[0], *c = others[1], *d = others[2];
    double with_b = 0.0, with_c = 0.0, with_d = 0.0;
    for (size_t i = 0; i < count; i++) {
        with_b += (double)a[i] * (double)b[i];
        with_c += (double)a[i] * (double)c[i];
        with_d += (double)a[i] * (double)d[i];
    }
    out[0] = with_b;
    out[1] = with_c;
    out[2] = with_d;
}

/* ---- candidates ---- */

/* Of each joint's column: with what is wanted, with what the last round left, with itself. */
enum { WANTED, LEFT, ITSELF, DOTS };

static void measure(const joint_columns *of, const float *left, double dots[LOD_JOINTS_MAX][DOTS])
{
    for (uint32_t j = 0; j < of->joint_count; j++) {
        const float *own = of->predicted + j * of->width;
        const float *const others[DOTS] = { of->wanted, left, own };
        three_dots(own, others, of->width, dots[j]);
    }
}

static int is_candidate(const choice *c, uint32_t joint)
{
    for (uint32_t i = 0; i < c->count; i++) {
        if (c->joint[i] == joint) return 1;
    }
    return 0;
}

/* Add the joints that alone come nearest to a column, WANTED or LEFT, until there are `most`. */
static void add_nearest(const joint_columns *of, double dots[LOD_JOINTS_MAX][DOTS], int to, uint32_t most, choice *c)
{
    double gain[CANDIDATES];
    uint32_t nearest[CANDIDATES], count = 0;
    const uint32_t room = most - c->count;
    for (uint32_t j = 0; j < of->joint_count; j++) {
        double with, length, w, least;
        uint32_t at;
        if (of->parent[j] != of->of || is_candidate(c, j)) continue;
        with = dots[j][to];
        length = dots[j][ITSELF];
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
    double dots[LOD_JOINTS_MAX][DOTS], three[3];
    memcpy(left, of->wanted, of->width * sizeof *left);
    c->count = 0;
    for (uint32_t i = 0; i < JOINTS_PER_VERTEX; i++) {
        const float *own = of->predicted + joint[i] * of->width;
        if (!(weight[i] > 0.0f)) continue;
        c->joint[c->count++] = joint[i];
        for (size_t k = 0; k < of->width; k++) left[k] -= weight[i] * own[k];
    }
    measure(of, left, dots);
    add_nearest(of, dots, WANTED, (c->count + CANDIDATES) / 2u, c);
    add_nearest(of, dots, LEFT, CANDIDATES, c);
    for (uint32_t i = 0; i < c->count; i++) {
        const float *own = of->predicted + c->joint[i] * of->width;
        c->with[i] = dots[c->joint[i]][WANTED];
        c->gram[i][i] = dots[c->joint[i]][ITSELF];
        for (uint32_t k = 0; k < i; k++) {
            if (k % 3u == 0) {
                const float *others[3];
                for (uint32_t n = 0; n < 3u; n++)
                    others[n] = of->predicted + c->joint[k + n < i ? k + n : k] * of->width;
                three_dots(own, others, of->width, three);
            }
            c->gram[i][k] = c->gram[k][i] = three[k % 3u];
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
