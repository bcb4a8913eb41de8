/* clip_search.c: chooses the rounding of each coefficient of a rotation.
 *
 * Rounding to the nearest is best for the mean error; the bound is on the largest. Near a solution errors are linear in
 * the coefficients: a joint's rotation is off by a small vector w, which is the target's own error plus, for
 * each coefficient, its error times its row of the transform times a matrix of that frame. A point at `arm` from the
 * joint is then off by base + w x arm, so the effect of a step of a coefficient on every frame is known without
 * decoding. Two searches use that:
 *
 *   settle  steps that bring the worst frame down, until all frames hold
 *   thin    coefficients towards zero wherever that breaks no bound: room that no frame needs becomes bytes
 *
 * Their result is decoded and judged by the exact check like every other attempt. */
#include <stdlib.h>

#include "clip_encoder.h"

#define AIM 0.996      /* the target share, squared: the rest is for nonlinear parts and 16 bits */
#define CANDIDATES 24u /* of the steps that help the worst frame most, how many are weighed in all frames */
#define SETTLE_MAX 100
#define SETTLE_FROM 9.0  /* squared violation above which no search helps */
#define THIN_COST 0.7    /* of a step squared: a coefficient is not moved where that adds more to the error's square */
#define THIN_MAGNITUDE 3 /* larger coefficients save hardly anything by one step */

/* The state of a fit: the error of every frame with the current coefficients. */
typedef struct search {
    const enc_model *m;
    const double *rows; /* [count][count] */
    uint32_t count;
    double turns[ENC_FRAMES_MAX][3];
    double squares[ENC_FRAMES_MAX]; /* violations, squared */
    double step;
} search;

/* The squared violation of a frame whose rotation is off by w. */
static double square_at(const enc_model *m, uint32_t f, const double w[3])
{
    const enc_probe *p = m->probes + (size_t)f * ENC_PROBES;
    const double ww = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    double worst = 0.0;
    for (uint32_t i = 0; i < m->probe_count; i++, p++) {
        const double x = p->base[0] + w[1] * p->arm[2] - w[2] * p->arm[1];
        const double y = p->base[1] + w[2] * p->arm[0] - w[0] * p->arm[2];
        const double z = p->base[2] + w[0] * p->arm[1] - w[1] * p->arm[0];
        double square = x * x + y * y + z * z;
        if (p->shell > 0.0) {
            const double xw = x * w[0] + y * w[1] + z * w[2], across = square * ww - xw * xw;
            square += 2.0 * p->shell * sqrt(across > 0.0 ? across : 0.0) + p->shell * p->shell * ww;
        }
        square *= p->weight;
        if (!(square <= worst)) worst = square;
    }
    return worst * m->weights[f];
}

static void turn_of(const search *s, uint32_t f, uint32_t k, uint32_t c, double by, double w[3])
{
    const double *j = s->m->turns_by[f], at = s->rows[k * s->count + f] * by * s->step;
    for (int i = 0; i < 3; i++) w[i] = s->turns[f][i] + at * j[3 * i + (int)c];
}

/* Errors of all frames from the coefficients' errors. */
static void begin(search *s, double (*spectrum)[3], const enc_piece *piece)
{
    double off[ENC_FRAMES_MAX][3];
    memset(off, 0, sizeof off);
    for (uint32_t k = 0; k < s->count; k++) {
        const double *row = s->rows + k * s->count;
        double d[3];
        for (int c = 0; c < 3; c++) d[c] = (double)piece->coefs[k][c] * s->step - spectrum[k][c];
        for (uint32_t f = 0; f < s->count; f++) {
            for (int c = 0; c < 3; c++) off[f][c] += row[f] * d[c];
        }
    }
    for (uint32_t f = 0; f < s->count; f++) {
        const double *j = s->m->turns_by[f];
        for (int i = 0; i < 3; i++) {
            s->turns[f][i] = s->m->turns[f][i] + j[3 * i] * off[f][0] + j[3 * i + 1] * off[f][1] +
                             j[3 * i + 2] * off[f][2];
        }
        s->squares[f] = square_at(s->m, f, s->turns[f]);
    }
}

static void move(search *s, enc_piece *piece, uint32_t k, uint32_t c, int by)
{
    piece->coefs[k][c] += by;
    for (uint32_t f = 0; f < s->count; f++) {
        double w[3];
        turn_of(s, f, k, c, (double)by, w);
        memcpy(s->turns[f], w, sizeof w);
        s->squares[f] = square_at(s->m, f, w);
    }
}

/* The cost of a set of errors: large powers, so that the largest count. */
static double cost_of(double square)
{
    return square * square;
}

static double cost_after(const search *s, uint32_t k, uint32_t c, int by, double most)
{
    double cost = 0.0;
    for (uint32_t f = 0; f < s->count && cost < most; f++) {
        double w[3];
        turn_of(s, f, k, c, (double)by, w);
        cost += cost_of(square_at(s->m, f, w));
    }
    return cost;
}

typedef struct step {
    double gain;
    uint32_t k, c;
    int by;
} step;

/* The steps that bring frame f down most by its slope, best first. Returns how many. */
static uint32_t find_steps(const search *s, const enc_piece *piece, uint32_t f, step *out)
{
    double slope[3], w[3];
    const double here = s->squares[f], tiny = 1e-3 * s->step;
    uint32_t count = 0, end = piece->last + 2u < s->count ? piece->last + 2u : s->count;
    for (uint32_t c = 0; c < 3u; c++) {
        for (int i = 0; i < 3; i++) w[i] = s->turns[f][i] + tiny * s->m->turns_by[f][3 * i + (int)c];
        slope[c] = (square_at(s->m, f, w) - here) * 1e3;
    }
    for (uint32_t k = 0; k < end; k++) {
        for (uint32_t c = 0; c < 3u; c++) {
            const double change = slope[c] * s->rows[k * s->count + f];
            const int by = change > 0.0 ? -1 : 1;
            const int32_t v = piece->coefs[k][c];
            /* what makes a coefficient larger costs bits, and most where it was zero */
            const double gain = fabs(change) * (v == 0 ? 0.6 : (v < 0) == (by < 0) ? 0.9 : 1.1);
            uint32_t at = count < CANDIDATES ? count++ : CANDIDATES - 1u;
            if (out[at].gain >= gain) continue;
            for (; at > 0u && out[at - 1u].gain < gain; at--) out[at] = out[at - 1u];
            out[at].gain = gain;
            out[at].k = k;
            out[at].c = c;
            out[at].by = by;
        }
    }
    return count;
}

static void trim(enc_piece *piece, uint32_t count)
{
    uint32_t last = count;
    while (last > 0u && !piece->coefs[last - 1u][0] && !piece->coefs[last - 1u][1] && !piece->coefs[last - 1u][2])
        last--;
    piece->last = (uint8_t)last;
}

/* Bring all frames within the bound. Returns whether they are. */
static int settle(search *s, enc_piece *piece)
{
    for (int i = 0; i < SETTLE_MAX; i++) {
        step steps[CANDIDATES] = { { 0.0, 0, 0, 0 } };
        uint32_t worst = 0, count, best = CANDIDATES;
        double cost = 0.0, least;
        for (uint32_t f = 0; f < s->count; f++) {
            if (s->squares[f] > s->squares[worst]) worst = f;
            cost += cost_of(s->squares[f]);
        }
        if (s->squares[worst] <= AIM) return 1;
        if (!(s->squares[worst] <= SETTLE_FROM)) return 0;
        count = find_steps(s, piece, worst, steps);
        least = cost * 0.999;
        for (uint32_t n = 0; n < count; n++) {
            const double after = cost_after(s, steps[n].k, steps[n].c, steps[n].by, least);
            if (after < least) {
                least = after;
                best = n;
            }
        }
        if (best == CANDIDATES) return 0;
        move(s, piece, steps[best].k, steps[best].c, steps[best].by);
        trim(piece, s->count);
    }
    return 0;
}

static int holds_after(const search *s, uint32_t k, uint32_t c, int by)
{
    for (uint32_t f = 0; f < s->count; f++) {
        double w[3];
        turn_of(s, f, k, c, (double)by, w);
        if (!(square_at(s->m, f, w) <= AIM)) return 0;
    }
    return 1;
}

/* Move coefficients towards zero, those first whose error grows least by it, as long as all frames hold. */
static void thin(search *s, double (*spectrum)[3], enc_piece *piece)
{
    for (double most = 0.1; most <= THIN_COST; most += 0.2) {
        for (uint32_t k = piece->last; k-- > 1u;) {
            for (uint32_t c = 0; c < 3u; c++) {
                const int32_t v = piece->coefs[k][c];
                const int by = v > 0 ? -1 : 1;
                const double off = (double)v - spectrum[k][c] / s->step, growth = 2.0 * off * (double)by + 1.0;
                if (v == 0 || abs(v) > THIN_MAGNITUDE || growth > most) continue;
                if (holds_after(s, k, c, by)) move(s, piece, k, c, by);
            }
        }
    }
    trim(piece, s->count);
}

int enc_search(const encoder *e, const enc_model *m, uint32_t count, double (*spectrum)[3], enc_piece *piece,
               double size)
{
    search s;
    s.m = m;
    s.rows = e->transforms[count];
    s.count = count;
    s.step = size;
    begin(&s, spectrum, piece);
    if (!settle(&s, piece)) return 0;
    if (e->tuning.thins) thin(&s, spectrum, piece);
    return 1;
}
