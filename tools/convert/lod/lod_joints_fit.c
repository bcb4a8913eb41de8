#include "lod_joints_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "lod_joints_weights.h"

#define ROUNDS 60u
#define RIDGE 1e-3    /* of a diagonal element */
#define RESTING 0.1   /* points that rest at a joint's centre: what moves hardly anything moves little */
#define SEED_EVERY 3u /* rounds, in the first three quarters of them */

/* The results of the round that was off the least. */
typedef struct fit_round {
    double off;    /* squared */
    float *motion; /* [joint_count][target_count][6] */
    float *centre; /* [joint_count][3] */
    uint8_t *joint;
    float *weight; /* [count][JOINTS_PER_VERTEX] both */
} fit_round;

typedef struct fit_state {
    const joint_fit_points *points;
    joint_fit *out;
    fit_round best;
    float *motion;      /* [joint_count][target_count][6] as numbers that are read from the rounded ones */
    float *predicted;   /* [joint_count][target_count][6] what each joint alone does to a point and to its normal, which
                         * counts by its length */
    float *wanted;      /* [target_count][6] what targets do to it */
    float *left;        /* [target_count][6] */
    uint32_t *same;     /* [count] the first point that lies there and is moved alike */
    double *importance; /* [count] */
    float *stress;      /* [count][target_count] how much a target counts at a point */
    double *off;        /* [count] the farthest off in any target, squared */
    double *matrix;     /* [6 joint_count][6 joint_count] */
    double *right;      /* [target_count][6 joint_count] */
} fit_state;

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
        const float turn = p->normal_length * (p->turn[a * width + i] - p->turn[b * width + i]);
        sum += d * d + turn * turn;
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
        apart[v] = (float)joint_dot(p->move + v * width, p->move + v * width, width);
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

/* ---- weights of all points ---- */

static void cross(const float *a, const float *b, float times, float out[3])
{
    out[0] = times * (a[1] * b[2] - a[2] * b[1]);
    out[1] = times * (a[2] * b[0] - a[0] * b[2]);
    out[2] = times * (a[0] * b[1] - a[1] * b[0]);
}

static void fill_columns(fit_state *s, uint32_t v)
{
    const joint_fit_points *p = s->points;
    const size_t targets = p->target_count;
    const float *place = p->place + 3u * (size_t)v, *normal = p->normal + 3u * (size_t)v;
    for (size_t t = 0; t < targets; t++) {
        const size_t from = 3u * (v * targets + t);
        memcpy(s->wanted + 6u * t, p->move + from, 3u * sizeof(float));
        for (size_t k = 0; k < 3u; k++) s->wanted[6u * t + 3u + k] = p->normal_length * p->turn[from + k];
        for (size_t k = 0; k < 6u; k++) s->wanted[6u * t + k] *= s->stress[v * targets + t];
    }
    for (uint32_t j = 0; j < s->out->joint_count; j++) {
        for (size_t t = 0; t < targets; t++) {
            const size_t at = 6u * (j * targets + t);
            apply(s->motion + at, s->out->centre + 3u * j, place, s->predicted + at);
            cross(s->motion + at + 3u, normal, p->normal_length, s->predicted + at + 3u);
            for (size_t k = 0; k < 6u; k++) s->predicted[at + k] *= s->stress[v * targets + t];
        }
    }
}

/* How far a target takes a point off, squared. */
static double off_by(const fit_state *s, uint32_t v, size_t t)
{
    const size_t targets = s->points->target_count;
    double square = 0.0;
    for (size_t k = 0; k < 3u; k++) {
        double d = -(double)s->wanted[6u * t + k];
        for (size_t i = 0; i < JOINTS_PER_VERTEX; i++) {
            const size_t at = v * (size_t)JOINTS_PER_VERTEX + i;
            d += (double)s->out->weight[at] * (double)s->predicted[6u * (s->out->joint[at] * targets + t) + k];
        }
        square += d * d;
    }
    return square / ((double)s->stress[v * targets + t] * (double)s->stress[v * targets + t]);
}

/* The farthest that any target takes the point off, squared. Those that take it far count more in the next round: a
 * point whose targets all but one suit no joint would stay where it is in that one, too. */
static double farthest_off(fit_state *s, uint32_t v)
{
    const size_t targets = s->points->target_count;
    double most = 0.0;
    for (size_t t = 0; t < targets; t++) {
        const double square = off_by(s, v, t);
        s->left[t] = (float)sqrt(square);
        most = square > most ? square : most;
    }
    for (size_t t = 0; t < targets && most > 0.0; t++) {
        float *stress = &s->stress[v * targets + t];
        *stress = sqrtf(*stress * (0.1f + s->left[t] / (float)sqrt(most)));
    }
    return most;
}

static void weigh_point(fit_state *s, uint32_t v)
{
    uint8_t *joint = s->out->joint + v * (size_t)JOINTS_PER_VERTEX;
    float *weight = s->out->weight + v * (size_t)JOINTS_PER_VERTEX;
    const size_t first = s->same[v] * (size_t)JOINTS_PER_VERTEX;
    if (s->same[v] != v) { /* whose normal may be another: the surface stays closed */
        memcpy(joint, s->out->joint + first, JOINTS_PER_VERTEX);
        memcpy(weight, s->out->weight + first, JOINTS_PER_VERTEX * sizeof *weight);
        s->off[v] = s->off[s->same[v]];
        return;
    }
    fill_columns(s, v);
    const joint_columns columns = {
        s->out->joint_count,  6u * (size_t)s->points->target_count, s->predicted,       s->wanted, s->out->parent,
        s->points->parent[v], (double)s->points->share[v],          s->points->slots[v]
    };
    joint_weigh(&columns, joint, weight, s->left);
    s->off[v] = farthest_off(s, v);
}

/* Returns the farthest that any point is off, squared. */
static double weigh_all(fit_state *s)
{
    double most = 0.0;
    for (uint32_t v = 0; v < s->points->count; v++) {
        weigh_point(s, v);
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

/* Cholesky's, in place: the lower half. length: what a turn of 1 counts as */
static void factor(double *a, size_t size, double length)
{
    for (size_t i = 0; i < size; i++) {
        a[i * size + i] += RIDGE * a[i * size + i] + RESTING * (i % 6u < 3u ? 1.0 : length * length);
    }
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
    factor(s->matrix, size, (double)s->points->normal_length);
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
        const double off = 0.05 + sqrt(s->off[v]) / mean, root = sqrt(s->importance[v]);
        s->importance[v] = root * sqrt(root) * off * sqrt(off);
        sum += s->importance[v] / count;
    }
    for (uint32_t v = 0; v < count && sum > 0.0; v++) s->importance[v] /= sum;
}

/* How much a joint does. */
static double use_of(const fit_state *s, uint32_t j)
{
    const size_t width = 3u * (size_t)s->points->target_count;
    double use = 0.0;
    for (size_t i = 0; i < s->points->count * (size_t)JOINTS_PER_VERTEX; i++) {
        const float *move = s->points->move + i / JOINTS_PER_VERTEX * width;
        if (s->out->joint[i] == j) use += (double)s->out->weight[i] * joint_dot(move, move, width);
    }
    return use;
}

/* The joint that does least becomes what moves the point that is farthest off. */
static void seed_again(fit_state *s)
{
    joint_fit *f = s->out;
    const uint32_t count = f->joint_count;
    uint32_t worst = 0, least = count;
    double least_use = HUGE_VAL;
    for (uint32_t v = 1; v < s->points->count; v++) worst = s->off[v] > s->off[worst] ? v : worst;
    for (uint32_t j = 0; j < count; j++) {
        const double use = f->parent[j] == s->points->parent[worst] ? use_of(s, j) : HUGE_VAL;
        if (!(use < least_use)) continue;
        least_use = use;
        least = j;
    }
    if (least == count) return;
    for (size_t i = 0; i < s->points->count * (size_t)JOINTS_PER_VERTEX; i++) {
        if (f->joint[i] == least) f->weight[i] = 0.0f;
    }
    f->joint_count = least;
    add_joint(s, worst);
    f->joint_count = count;
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

static void find_same(fit_state *s)
{
    const joint_fit_points *p = s->points;
    const size_t width = 3u * (size_t)p->target_count;
    for (uint32_t v = 0; v < p->count; v++) {
        uint32_t u = 0;
        while (u < v && (!model_same_floats(p->place + 3u * u, p->place + 3u * v, 3) ||
                         !model_same_floats(p->move + u * width, p->move + v * width, width) ||
                         p->parent[u] != p->parent[v] || p->share[u] != p->share[v] || p->slots[u] != p->slots[v])) {
            u++;
        }
        s->same[v] = u;
    }
}

/* Copy a round's results from or to the best ones. */
static void copy_round(fit_state *s, int restore)
{
    const size_t joints = s->out->joint_count, count = s->points->count;
    const struct {
        void *now, *best;
        size_t bytes;
    } arrays[] = { { s->motion, s->best.motion, 6u * joints * s->points->target_count * sizeof *s->motion },
                   { s->out->centre, s->best.centre, 3u * joints * sizeof *s->out->centre },
                   { s->out->joint, s->best.joint, count * JOINTS_PER_VERTEX },
                   { s->out->weight, s->best.weight, count * JOINTS_PER_VERTEX * sizeof *s->out->weight } };
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
        memcpy(restore ? arrays[i].now : arrays[i].best, restore ? arrays[i].best : arrays[i].now, arrays[i].bytes);
    }
}

static void round_joints(fit_state *s)
{
    for (uint32_t j = 0; j < s->out->joint_count; j++) round_joint(s, j);
}

static void run(fit_state *s)
{
    find_same(s);
    for (uint32_t v = 0; v < s->points->count; v++) s->importance[v] = 1.0;
    for (size_t i = 0; i < s->points->count * (size_t)s->points->target_count; i++) s->stress[i] = 1.0f;
    s->best.off = HUGE_VAL;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        const double off = weigh_all(s);
        if (round && off < s->best.off) {
            s->best.off = off;
            copy_round(s, 0);
        }
        if (round) weigh_importance(s);
        move_joints(s);
        if (round % SEED_EVERY == 1u && round < ROUNDS / 4u * 3u) seed_again(s);
        round_joints(s);
    }
    copy_round(s, 1);
    round_joints(s);
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
    s->best.motion = model_zeros(joints * targets, 6u * sizeof *s->best.motion);
    s->best.centre = model_zeros(joints, 3u * sizeof *s->best.centre);
    s->best.joint = model_zeros(count, JOINTS_PER_VERTEX * sizeof *s->best.joint);
    s->best.weight = model_zeros(count, JOINTS_PER_VERTEX * sizeof *s->best.weight);
    s->predicted = model_zeros(joints * targets, 6u * sizeof *s->predicted);
    s->wanted = model_zeros(targets, 6u * sizeof *s->wanted);
    s->left = model_zeros(targets, 6u * sizeof *s->left);
    s->same = model_zeros(count, sizeof *s->same);
    s->importance = model_zeros(count, sizeof *s->importance);
    s->off = model_zeros(count, sizeof *s->off);
    s->stress = model_zeros(count * targets, sizeof *s->stress);
    s->matrix = model_zeros(36u * joints * joints, sizeof *s->matrix);
    s->right = model_zeros(6u * joints * targets, sizeof *s->right);
    return !f->parent || !f->centre || !f->scale || !f->motion || !f->joint || !f->weight || !s->motion ||
           !s->best.motion || !s->best.centre || !s->best.joint || !s->best.weight || !s->predicted || !s->wanted ||
           !s->left || !s->same || !s->importance || !s->off || !s->stress || !s->matrix || !s->right;
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
    free(s.best.motion);
    free(s.best.centre);
    free(s.best.joint);
    free(s.best.weight);
    free(s.predicted);
    free(s.wanted);
    free(s.left);
    free(s.same);
    free(s.importance);
    free(s.off);
    free(s.stress);
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
