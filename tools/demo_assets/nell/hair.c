/* Hair: a cap that follows the skull, and large locks that lie on it. */
#include "parts.h"

#include "shape.h"

#include <math.h>

#define PI 3.14159265358979323846
#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

/* ---- cap ---- */

/* Clumps run from the crown to the hem, each ACROSS columns wide, so that edges lie in the valleys between them. */
enum { CLUMPS = 24, ACROSS = 5, CAP_COLUMNS = CLUMPS * ACROSS, CAP_ROWS = 16 };

/* Height of the hairline at s. */
static double hairline(double s)
{
    static const Key line[] = { { 0, 0.084 },     { 0.030, 0.080 },  { 0.052, 0.064 },  { 0.066, 0.040 },
                                { 0.078, 0.014 }, { 0.087, 0.000 },  { 0.097, 0.020 },  { 0.114, 0.029 },
                                { 0.122, 0.014 }, { 0.131, -0.034 }, { 0.142, -0.060 }, { 0.158, -0.076 },
                                { 0.200, -0.084 } };
    return curve(line, COUNT(line), fabs(s));
}

double nell_hair_past(double s, double t)
{
    return t - hairline(s);
}

/* Where the clump's border `number` meets the hem, as s. */
static double border(double number)
{
    return HALF_ROUND * (2 * (number + 0.22 * sin(number * 2.4)) / CLUMPS - 1);
}

/* Height across a clump, 0 in the valleys: steep on one side, as if clumps lay on each other, and split by a groove. */
static double arch(double across)
{
    static const Key profile[] = { { 0, 0 }, { 0.2, 0.78 }, { 0.4, 1 }, { 0.6, 0.86 }, { 0.8, 0.66 }, { 1, 0 } };
    return curve(profile, COUNT(profile), across);
}

/* A place on the cap: in the plane, how far across its clump, and how far from the hem (0) to the crown (1). */
typedef struct {
    double s, t, arch, up;
    int clump;
} CapPlace;

static CapPlace cap_at(const Seed *seed)
{
    double column = fmod(seed->s, CAP_COLUMNS), up = seed->t;
    CapPlace at = { .clump = (int)(column / ACROSS), .up = up };
    double across = column / ACROSS - at.clump, hem = mix(border(at.clump), border(at.clump + 1), across);
    at.arch = arch(across);
    /* Clumps turn about the crown, and sweep back above the ears. */
    double back = smooth(0.030, 0.090, fabs(hem)) * smooth(0.200, 0.150, fabs(hem));
    double turn = 0.020 * up * up - (hem > 0 ? 1 : -1) * 0.020 * back * smooth(0, 0.8, up);
    double nape = smooth(0.148, 0.178, fabs(hem));
    double tip = mix(0.001 + 0.003 * smooth(0.05, 0.08, fabs(hem)), 0.020 + 0.007 * sin(at.clump * 1.9), nape);
    double low = hairline(hem) - 0.004 - tip * pow(1 - fabs(2 * across - 1), 0.8);
    at.s = hem + turn;
    at.t = mix(low, TOP, pow(fmax(up, 0), 1.25));
    return at;
}

V3 scalp_place(const Seed *seed)
{
    CapPlace at = cap_at(seed);
    double behind = smooth(0.060, 0.120, fabs(at.s)), crown = smooth(0.55, 0.95, at.up),
           pole = smooth(0.88, 0.99, at.up);
    double nape = smooth(0.120, 0.170, fabs(at.s)), k = clamp(at.up / mix(0.42, 0.66, nape), 0, 1),
           round = sqrt(k * (2 - k));
    double volume = mix(mix(0.0075, 0.0155, behind), 0.0115, pole);
    double high = mix(mix(0.0022, 0.0034, nape), volume, round) + 0.0012 * sin(at.clump * 2.1) * behind * (1 - crown);
    high -= mix(0.0012, 0.0048, behind) * smooth(0, 0.12, at.up) * (1 - at.arch) * (1 - crown * crown);
    return v3_add(shape_at(at.s, at.t),
                  v3_scale(shape_normal(at.s, fmin(at.t, TOP - 0.001)), at.up < 0 ? -0.004 : high));
}

double nell_hair_arch(const Seed *seed)
{
    return cap_at(seed).arch;
}

static void cap_build(Model *model)
{
    uint32_t before[CAP_COLUMNS], now[CAP_COLUMNS];
    for (int k = -1; k <= CAP_ROWS; k++) {
        for (int i = 0; i < CAP_COLUMNS; i++) {
            /* The lowest row turns the edge inwards. */
            Seed seed = { .region = ON_SCALP, .s = i, .t = k < 0 ? -0.001 : pow((double)k / CAP_ROWS, 1.3) };
            seed.u = (double)i / CAP_COLUMNS;
            seed.v = 1 - seed.t;
            now[i] = model_seed(model, PART_HAIR, &seed);
        }
        for (int i = 0; i < CAP_COLUMNS && k >= 0; i++) {
            int next = (i + 1) % CAP_COLUMNS;
            model_quad(model, PART_HAIR, before[i], before[next], now[next], now[i]);
        }
        for (int i = 0; i < CAP_COLUMNS; i++) {
            before[i] = now[i];
        }
    }
}

/* ---- locks ---- */

enum { LOCK_SIDES = 8 };

/* A curve over the head through four points (s, t, height above the skin; millimetres), half its width, and its
 * thickness where it stands free, 0: it lies on the cap. */
typedef struct {
    double s[4], t[4], high[4];
    double width, thick;
} Lock;

static const Lock locks[] = {
    /* the fringe: from the parting on her right over the forehead to her left; neighbours differ in height */
    { { -30, -12, 16, 48 }, { 112, 88, 70, 60 }, { 8, 14, 14, 11 }, 16, 0 },
    { { -28, 0, 36, 68 }, { 124, 104, 80, 44 }, { 9, 19, 17, 12 }, 21, 0 },
    { { -22, 14, 52, 80 }, { 138, 124, 94, 26 }, { 9, 23, 20, 13 }, 23, 0 },
    { { -10, 34, 70, 85 }, { 150, 140, 98, 22 }, { 9, 18, 18, 13 }, 24, 0 },
    /* the other side of the parting; the first one covers the cap where the parting meets the forehead */
    { { -29, -25, -26, -40 }, { 117, 104, 88, 64 }, { 8, 13, 14, 11 }, 17, 0 },
    { { -32, -46, -62, -74 }, { 118, 104, 78, 26 }, { 8, 15, 15, 11 }, 18, 0 },
    { { -26, -54, -76, -86 }, { 142, 126, 86, 20 }, { 11, 21, 18, 13 }, 23, 0 },
    { { -16, -56, -99, -104 }, { 160, 150, 82, 18 }, { 10, 17, 15, 14 }, 24, 0 },
    /* over her left ear */
    { { 16, 62, 98, 104 }, { 160, 144, 80, 18 }, { 8, 15, 15, 14 }, 25, 0 },
    /* one that will not lie down */
    { { -6, 6, 18, 26 }, { 168, 164, 156, 142 }, { 8, 24, 29, 30 }, 6, 5 },
};

static double spline(const double p[4], double u)
{
    double v = 1 - u;
    return v * v * v * p[0] + 3 * v * v * u * p[1] + 3 * v * u * u * p[2] + u * u * u * p[3];
}

/* The angle around a lock: all points but one lie on its upper half. */
static double lock_turn(const Seed *seed)
{
    double around = fabs(seed->t) / (2 * PI), upper = 1 - 2.0 / LOCK_SIDES;
    return around <= upper ? PI * around / upper : PI + PI * (around - upper) / (1 - upper);
}

V3 lock_place(const Seed *seed)
{
    const Lock *lock = &locks[(int)seed->k];
    double u = seed->s, step = 0.01;
    double ds = spline(lock->s, u + step) - spline(lock->s, u - step);
    double dt = spline(lock->t, u + step) - spline(lock->t, u - step), length = sqrt(ds * ds + dt * dt);
    double turn = lock_turn(seed), end = u <= 0 || u >= 1 ? 0 : 1, a = cos(turn), b = sin(turn);
    double taper = end * (1 - pow(u, 2.2)) * smooth(-0.06, 0.42, u);
    double across = lock->width * taper * a;
    double s = spline(lock->s, u) - across * dt / length, t = spline(lock->t, u) + across * ds / length;
    /* The edges of locks that lie are below the cap. */
    double high = spline(lock->high, u), low = lock->thick > 0 ? high - lock->thick * taper : 3,
           round = end * sqrt(fabs(b)) * (1 - 0.06 * bump(a / 0.5));
    high = b > 0 ? mix(low, high, round * (lock->thick > 0 ? 1 : smooth(0, 0.4, taper))) : low - 2 * round;
    s *= 0.001;
    t = fmin(0.001 * t, TOP - 0.001);
    return v3_add(shape_at(s, t), v3_scale(shape_normal(s, t), 0.001 * high));
}

void nell_hair_build(Model *model)
{
    cap_build(model);
    for (int i = 0; i < COUNT(locks); i++) {
        Seed seed = { .region = ON_LOCK, .k = i, .eye = 1 };
        stroke_build(model, PART_HAIR, seed, 17, LOCK_SIDES);
    }
}
