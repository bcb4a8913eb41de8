#include "lod_joints_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

#define ROUNDS 60u
#define CANDIDATES 8u /* joints of a point that are tried in all combinations */
#define RIDGE 1e-6    /* of a diagonal element */
#define LAWSON_MOST 400.0

/* One fit: the joints as numbers that are not rounded yet, and the least that any round was off by. */
typedef struct fit_state {
    const joint_fit_points *points;
    joint_fit *out;
    float *motion;      /* [joint_count][target_count][6] */
    float *best;        /* the same, of the best round */
    float *best_centre; /* [joint_count][3] */
    float *predicted;   /* [joint_count][target_count][3] what each joint alone does to a point */
    double *importance; /* [count] */
    double *off;        /* [count] the farthest off in any target, squared */
    double *matrix;     /* [6 joint_count][6 joint_count] */
    double *right;      /* [target_count][6 joint_count] */
    double best_off;
} fit_state;

static double dot(const float *a, const float *b, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += (double)a[i] * (double)b[i];
    return sum;
}

static void apply(const float *motion, const float *centre, const float *p, float out[3])
{
    const float d[3] = { p[0] - centre[0], p[1] - centre[1], p[2] - centre[2] }, *w = motion + 3;
    out[0] = motion[0] + (w[1] * d[2] - w[2] * d[1]);
    out[1] = motion[1] + (w[2] * d[0] - w[0] * d[2]);
    out[2] = motion[2] + (w[0] * d[1] - w[1] * d[0]);
}

/* ---- seeds ---- */

static float squared_apart(const joint_fit_points *p, uint32_t a, uint32_t b)
{
    const size_t width = 3u * (size_t)p->target_count;
    float sum = 0.0f;
    for (size_t i = 0; i < width; i++) {
        const float d = p->move[a * width + i] - p->move[b * width + i];
        sum += d * d;
    }
    return sum;
}

static void add_joint(fit_state *s, uint32_t seed)
{
    const joint_fit_points *p = s->points;
    joint_fit *f = s->out;
    const uint32_t j = f->joint_count++;
    f->parent[j] = p->parent[seed];
    memcpy(f->centre + 3u * j, p->place + 3u * (size_t)seed, 3u * sizeof(float));
    for (size_t t = 0; t < p->target_count; t++) {
        float *to = s->motion + 6u * (j * (size_t)p->target_count + t);
        memcpy(to, p->move + 3u * (seed * (size_t)p->target_count + t), 3u * sizeof(float));
        memset(to + 3, 0, 3u * sizeof(float));
    }
}

/* Each time the point that is moved least like those taken, or like one that rests. */
static int seed(fit_state *s, uint32_t joint_max)
{
    const joint_fit_points *p = s->points;
    float *apart = model_zeros(p->count, sizeof *apart);
    const size_t width = 3u * (size_t)p->target_count;
    if (!apart) return 1;
    for (uint32_t v = 0; v < p->count; v++) {
        apart[v] = (float)dot(p->move + v * width, p->move + v * width, width);
    }
    while (s->out->joint_count < joint_max) {
        uint32_t farthest = 0;
        for (uint32_t v = 1; v < p->count; v++) farthest = apart[v] > apart[farthest] ? v : farthest;
        if (!(apart[farthest] > 0.0f)) break;
        add_joint(s, farthest);
        for (uint32_t v = 0; v < p->count; v++) {
            const float d = p->parent[v] == p->parent[farthest] ? squared_apart(p, v, farthest) : apart[v];
            apart[v] = d < apart[v] ? d : apart[v];
        }
    }
    free(apart);
    return 0;
}

/* ---- weights of one point ---- */

typedef struct choice {
    uint32_t count, joint[CANDIDATES];
    double gram[CANDIDATES][CANDIDATES], with[CANDIDATES];
} choice;

/* Those that come nearest alone. */
static void choose(const fit_state *s, uint32_t v, double share, choice *c)
{
    const size_t width = 3u * (size_t)s->points->target_count;
    const float *move = s->points->move + v * width;
    double gain[CANDIDATES];
    c->count = 0;
    for (uint32_t j = 0; j < s->out->joint_count; j++) {
        const float *own = s->predicted + j * width;
        double with, length, w, least;
        uint32_t at;
        if (s->out->parent[j] != s->points->parent[v]) continue;
        with = dot(own, move, width);
        length = dot(own, own, width);
        w = length > 0.0 && with > 0.0 ? with / length : 0.0;
        w = w < share ? w : share;
        least = w * (w * length - 2.0 * with);
        at = c->count < CANDIDATES ? c->count++ : CANDIDATES;
        while (at && least < gain[at - 1u]) {
            if (at < CANDIDATES) {
                gain[at] = gain[at - 1u];
                c->joint[at] = c->joint[at - 1u];
            }
            at--;
        }
        if (at < CANDIDATES) {
            gain[at] = least;
            c->joint[at] = j;
        }
    }
    for (uint32_t i = 0; i < c->count; i++) {
        const float *own = s->predicted + c->joint[i] * width;
        c->with[i] = dot(own, move, width);
        for (uint32_t k = 0; k <= i; k++) {
            c->gram[i][k] = c->gram[k][i] = dot(own, s->predicted + c->joint[k] * width, width);
        }
    }
}

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
static void weigh_point(fit_state *s, uint32_t v)
{
    const double share = (double)s->points->share[v];
    uint8_t *joint = s->out->joint + v * (size_t)JOINTS_PER_VERTEX;
    float *weight = s->out->weight + v * (size_t)JOINTS_PER_VERTEX;
    double best = 0.0;
    choice c;
    choose(s, v, share, &c);
    memset(joint, 0, JOINTS_PER_VERTEX);
    memset(weight, 0, JOINTS_PER_VERTEX * sizeof *weight);
    for (uint32_t bits = 1; bits < 1u << c.count; bits++) {
        uint32_t set[JOINTS_PER_VERTEX], n = 0, count = 0;
        double w[JOINTS_PER_VERTEX], change;
        for (uint32_t i = 0; i < c.count; i++) count += bits >> i & 1u;
        if (count > s->points->slots[v]) continue;
        for (uint32_t i = 0; i < c.count; i++) {
            if (bits >> i & 1u) set[n++] = i;
        }
        change = weigh(&c, set, n, share, n == s->points->slots[v], w);
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

static double farthest_off(const fit_state *s, uint32_t v)
{
    const joint_fit_points *p = s->points;
    const size_t width = 3u * (size_t)p->target_count;
    double most = 0.0;
    for (size_t t = 0; t < p->target_count; t++) {
        double square = 0.0;
        for (size_t k = 0; k < 3u; k++) {
            double d = -(double)p->move[v * width + 3u * t + k];
            for (size_t i = 0; i < JOINTS_PER_VERTEX; i++) {
                const size_t at = v * (size_t)JOINTS_PER_VERTEX + i;
                d += (double)s->out->weight[at] * (double)s->predicted[s->out->joint[at] * width + 3u * t + k];
            }
            square += d * d;
        }
        most = square > most ? square : most;
    }
    return most;
}

/* Returns the farthest that any point is off, squared. */
static double weigh_all(fit_state *s)
{
    const joint_fit_points *p = s->points;
    double most = 0.0;
    for (uint32_t v = 0; v < p->count; v++) {
        for (uint32_t j = 0; j < s->out->joint_count; j++) {
            for (size_t t = 0; t < p->target_count; t++) {
                const size_t at = j * (size_t)p->target_count + t;
                apply(s->motion + 6u * at, s->out->centre + 3u * j, p->place + 3u * (size_t)v, s->predicted + 3u * at);
            }
        }
        weigh_point(s, v);
        s->off[v] = farthest_off(s, v);
        most = s->off[v] > most ? s->off[v] : most;
    }
    return most;
}

/* ---- motions of all joints ---- */

/* Each joint's centre: the mean of what it moves. */
static void place_centres(fit_state *s)
{
    const joint_fit_points *p = s->points;
    for (uint32_t j = 0; j < s->out->joint_count; j++) {
        double sum[4] = { 0.0, 0.0, 0.0, 0.0 };
        for (size_t i = 0; i < p->count * (size_t)JOINTS_PER_VERTEX; i++) {
            const double w = s->out->joint[i] == j ? (double)s->out->weight[i] : 0.0;
            for (size_t k = 0; k < 3u; k++) sum[k] += w * (double)p->place[i / JOINTS_PER_VERTEX * 3u + k];
            sum[3] += w;
        }
        for (uint32_t k = 0; k < 3u && sum[3] > 0.0; k++) s->out->centre[3u * j + k] = (float)(sum[k] / sum[3]);
    }
}

/* What a joint's six numbers do to a point, and to its normal: [6][6]. */
static void rows_of(const fit_state *s, uint32_t v, uint32_t j, double weight, double rows[6][6])
{
    const float *p = s->points->place + 3u * (size_t)v, *n = s->points->normal + 3u * (size_t)v;
    const float *c = s->out->centre + 3u * j;
    const double length = weight * (double)s->points->normal_length;
    const double d[3] = { weight * (double)(p[0] - c[0]), weight * (double)(p[1] - c[1]),
                          weight * (double)(p[2] - c[2]) };
    memset(rows, 0, 36u * sizeof(double));
    for (uint32_t k = 0; k < 3u; k++) {
        const uint32_t x = (k + 1u) % 3u, y = (k + 2u) % 3u;
        rows[k][k] = weight;
        rows[k][3u + x] = d[y];
        rows[k][3u + y] = -d[x];
        rows[3u + k][3u + x] = length * (double)n[y];
        rows[3u + k][3u + y] = -length * (double)n[x];
    }
}

static void add_point(fit_state *s, uint32_t v)
{
    const joint_fit_points *p = s->points;
    const size_t size = 6u * (size_t)s->out->joint_count, targets = p->target_count;
    const float *weight = s->out->weight + v * (size_t)JOINTS_PER_VERTEX;
    const uint8_t *joint = s->out->joint + v * (size_t)JOINTS_PER_VERTEX;
    double rows[JOINTS_PER_VERTEX][6][6];
    for (uint32_t i = 0; i < JOINTS_PER_VERTEX; i++) rows_of(s, v, joint[i], (double)weight[i], rows[i]);
    for (uint32_t i = 0; i < 6u * JOINTS_PER_VERTEX; i++) {
        const size_t row = 6u * (size_t)joint[i / 6u] + i % 6u;
        if (!(weight[i / 6u] > 0.0f)) continue;
        for (uint32_t k = 0; k < 6u * JOINTS_PER_VERTEX; k++) {
            double sum = 0.0;
            for (uint32_t r = 0; r < 6u; r++) sum += rows[i / 6u][r][i % 6u] * rows[k / 6u][r][k % 6u];
            s->matrix[row * size + 6u * (size_t)joint[k / 6u] + k % 6u] += s->importance[v] * sum;
        }
        for (size_t t = 0; t < targets; t++) {
            const float *move = p->move + 3u * (v * targets + t), *turn = p->turn + 3u * (v * targets + t);
            double sum = 0.0;
            for (uint32_t r = 0; r < 3u; r++) {
                sum += rows[i / 6u][r][i % 6u] * (double)move[r] +
                       rows[i / 6u][3u + r][i % 6u] * (double)p->normal_length * (double)turn[r];
            }
            s->right[t * size + row] += s->importance[v] * sum;
        }
    }
}

/* Cholesky's, in place: the lower half. */
static void factor(double *a, size_t size)
{
    for (size_t i = 0; i < size; i++) a[i * size + i] += a[i * size + i] > 0.0 ? RIDGE * a[i * size + i] : 1.0;
    for (size_t i = 0; i < size; i++) {
        for (size_t k = 0; k <= i; k++) {
            double sum = a[i * size + k];
            for (size_t n = 0; n < k; n++) sum -= a[i * size + n] * a[k * size + n];
            a[i * size + k] = k == i ? sqrt(sum > 1e-30 ? sum : 1e-30) : sum / a[k * size + k];
        }
    }
}

static void solve(const double *a, size_t size, double *b)
{
    for (size_t i = 0; i < size; i++) {
        for (size_t k = 0; k < i; k++) b[i] -= a[i * size + k] * b[k];
        b[i] /= a[i * size + i];
    }
    for (size_t i = size; i-- > 0u;) {
        for (size_t k = i + 1u; k < size; k++) b[i] -= a[k * size + i] * b[k];
        b[i] /= a[i * size + i];
    }
}

static void move_joints(fit_state *s)
{
    const size_t size = 6u * (size_t)s->out->joint_count, targets = s->points->target_count;
    place_centres(s);
    memset(s->matrix, 0, size * size * sizeof *s->matrix);
    memset(s->right, 0, targets * size * sizeof *s->right);
    for (uint32_t v = 0; v < s->points->count; v++) add_point(s, v);
    factor(s->matrix, size);
    for (size_t t = 0; t < targets; t++) {
        solve(s->matrix, size, s->right + t * size);
        for (size_t i = 0; i < size; i++) {
            s->motion[6u * (i / 6u * targets + t) + i % 6u] = (float)s->right[t * size + i];
        }
    }
}

/* ---- rounds ---- */

/* A point that is farther off than others counts more in the next round. */
static void weigh_importance(fit_state *s)
{
    const uint32_t count = s->points->count;
    double mean = 0.0, sum = 0.0;
    for (uint32_t v = 0; v < count; v++) mean += sqrt(s->off[v]) / count;
    for (uint32_t v = 0; v < count && mean > 0.0; v++) {
        s->importance[v] *= 0.5 + 0.5 * sqrt(s->off[v]) / mean;
        sum += s->importance[v] / count;
    }
    for (uint32_t v = 0; v < count && sum > 0.0; v++) {
        s->importance[v] /= sum;
        s->importance[v] = s->importance[v] < LAWSON_MOST ? s->importance[v] : LAWSON_MOST;
        s->importance[v] = s->importance[v] > 1.0 / LAWSON_MOST ? s->importance[v] : 1.0 / LAWSON_MOST;
    }
}

/* Round a joint's numbers, and use them as they will be read. */
static void round_joint(fit_state *s, uint32_t j)
{
    const size_t targets = s->points->target_count, first = 6u * j * targets;
    float most[2] = { 0.0f, 0.0f };
    for (size_t i = 0; i < 6u * targets; i++) {
        const float size = fabsf(s->motion[first + i]);
        most[i % 6u / 3u] = size > most[i % 6u / 3u] ? size : most[i % 6u / 3u];
    }
    for (uint32_t k = 0; k < 2u; k++) s->out->scale[2u * j + k] = most[k] / (float)JOINT_MOTION_MAX;
    for (size_t i = 0; i < 6u * targets; i++) {
        const float scale = s->out->scale[2u * j + i % 6u / 3u];
        s->out->motion[first + i] = scale > 0.0f ? (int16_t)floorf(s->motion[first + i] / scale + 0.5f) : 0;
        s->motion[first + i] = (float)s->out->motion[first + i] * scale;
    }
}

static void run(fit_state *s)
{
    const size_t numbers = 6u * (size_t)s->out->joint_count * s->points->target_count * sizeof *s->motion;
    const size_t centres = 3u * (size_t)s->out->joint_count * sizeof(float);
    for (uint32_t v = 0; v < s->points->count; v++) s->importance[v] = 1.0;
    s->best_off = HUGE_VAL;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        const double off = weigh_all(s);
        if (round && off < s->best_off) {
            s->best_off = off;
            memcpy(s->best, s->motion, numbers);
            memcpy(s->best_centre, s->out->centre, centres);
        }
        if (round) weigh_importance(s);
        move_joints(s);
    }
    memcpy(s->motion, s->best, numbers);
    memcpy(s->out->centre, s->best_centre, centres);
    for (uint32_t j = 0; j < s->out->joint_count; j++) round_joint(s, j);
    (void)weigh_all(s);
}

static int allocate(fit_state *s, uint32_t joint_max)
{
    const size_t joints = joint_max, targets = s->points->target_count, count = s->points->count;
    joint_fit *f = s->out;
    f->target_count = s->points->target_count;
    f->parent = model_zeros(joints, sizeof *f->parent);
    f->centre = model_zeros(joints, 3u * sizeof *f->centre);
    f->scale = model_zeros(joints, 2u * sizeof *f->scale);
    f->motion = model_zeros(joints * targets, 6u * sizeof *f->motion);
    f->joint = model_zeros(count, JOINTS_PER_VERTEX * sizeof *f->joint);
    f->weight = model_zeros(count, JOINTS_PER_VERTEX * sizeof *f->weight);
    s->motion = model_zeros(joints * targets, 6u * sizeof *s->motion);
    s->best = model_zeros(joints * targets, 6u * sizeof *s->best);
    s->best_centre = model_zeros(joints, 3u * sizeof *s->best_centre);
    s->predicted = model_zeros(joints * targets, 3u * sizeof *s->predicted);
    s->importance = model_zeros(count, sizeof *s->importance);
    s->off = model_zeros(count, sizeof *s->off);
    s->matrix = model_zeros(36u * joints * joints, sizeof *s->matrix);
    s->right = model_zeros(6u * joints * targets, sizeof *s->right);
    return !f->parent || !f->centre || !f->scale || !f->motion || !f->joint || !f->weight || !s->motion || !s->best ||
           !s->best_centre || !s->predicted || !s->importance || !s->off || !s->matrix || !s->right;
}

int joint_fit_make(const joint_fit_points *points, uint32_t joint_max, joint_fit *out)
{
    fit_state s;
    int failed;
    memset(out, 0, sizeof *out);
    memset(&s, 0, sizeof s);
    s.points = points;
    s.out = out;
    failed = allocate(&s, joint_max) || seed(&s, joint_max);
    if (!failed && out->joint_count) run(&s);
    free(s.motion);
    free(s.best);
    free(s.best_centre);
    free(s.predicted);
    free(s.importance);
    free(s.off);
    free(s.matrix);
    free(s.right);
    return failed;
}

void joint_fit_free(joint_fit *f)
{
    free(f->parent);
    free(f->centre);
    free(f->scale);
    free(f->motion);
    free(f->joint);
    free(f->weight);
    memset(f, 0, sizeof *f);
}

void joint_fit_motion(const joint_fit_points *points, const joint_fit *f, uint32_t point, uint32_t target,
                      float move[3], float turn[3])
{
    const float *place = points->place + 3u * (size_t)point;
    memset(move, 0, 3u * sizeof *move);
    memset(turn, 0, 3u * sizeof *turn);
    for (size_t i = point * (size_t)JOINTS_PER_VERTEX; i < (point + (size_t)1) * JOINTS_PER_VERTEX; i++) {
        const size_t j = f->joint[i];
        const int16_t *from = f->motion + 6u * (j * f->target_count + target);
        float motion[6], own[3];
        for (uint32_t k = 0; k < 6u; k++) motion[k] = (float)from[k] * f->scale[2u * j + k / 3u];
        apply(motion, f->centre + 3u * j, place, own);
        for (uint32_t k = 0; k < 3u; k++) {
            move[k] += f->weight[i] * own[k];
            turn[k] += f->weight[i] * motion[3u + k];
        }
    }
}
