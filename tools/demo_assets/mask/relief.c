#include "relief.h"

#include <math.h>

#define MM 0.001
#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

double head_depth(double x, double y)
{
    double p = x / (FACE_HALF_WIDTH * outline_width(y)), q = y / FACE_HALF_HEIGHT;
    double square = p * p + q * q, radius = 0.965 * sqrt(square);
    /* Flatter from top to bottom than from ear to ear. */
    double power = mix(2.2, 3.6, square > 0 ? q * q / square : 0);
    double inside = 1 - pow(radius, power);
    return 0.064 * sqrt(inside > 0.01 ? inside : 0.01) - 0.035;
}

/* Soft hills and hollows, mirrored left and right. Millimetres. */
typedef struct {
    double x, y, rx, ry, height;
} Hill;

static const Hill hills[] = {
    { 30, 31, 30, 14, 2.0 },        /* brow ridge */
    { 16, 25, 14, 12, 0.4 },        /* its inner end */
    { 31, 11, 25, 17, -3.6 },       /* eye socket */
    { 19, 10, 11, 12, -2.4 },       /* inner corner */
    { 38, -24, 32, 34, 5.6 },       /* cheek */
    { 44, -6, 24, 16, 1.6 },        /* cheekbone */
    { 0, -52, 36, 30, 2.3 },        /* the round of the teeth (counts twice) */
    { 24, -34, 9, 16, -1.2 },       /* next to the nose */
    { 29, -56, 10, 16, -1.0 },      /* beyond the corner of the mouth */
    { 24, -54, 7, 6, -0.7 },        /* corner of the mouth */
    { 0, -86, 24, 20, 2.6 },        /* chin (twice) */
    { 0, -70, 22, 7, -0.7 },        /* hollow under the lip (twice) */
    { 60, 36, 22, 34, -1.0 },       /* temple */
    { 0, -22.5, 11, 10.5, 1.1 },    /* tip of the nose (twice) */
    { 12.3, -23.8, 7.5, 7.5, 4.4 }, /* wing of the nose */
    { 18.5, -24, 5, 9, -0.8 },      /* groove behind the wing */
    { 5.9, -28.6, 4.2, 3.8, -2.6 }  /* nostril */
};

static double hill(const Hill *h, double s, double t)
{
    double x = h->x * MM, y = h->y * MM, rx = h->rx * MM, ry = h->ry * MM;
    return h->height * MM * (bump2(s - x, t - y, rx, ry) + bump2(s + x, t - y, rx, ry));
}

static double nose(double s, double t)
{
    static const Key height[] = { { -0.0355, 0 },      { -0.0325, 0.0012 }, { -0.0296, 0.0052 }, { -0.0264, 0.0099 },
                                  { -0.0228, 0.0122 }, { -0.0180, 0.0127 }, { -0.0080, 0.0108 }, { 0.0060, 0.0072 },
                                  { 0.0210, 0.0036 },  { 0.0360, 0 } };
    static const Key width[] = { { -0.0320, 0.0150 }, { -0.0220, 0.0170 }, { -0.0110, 0.0146 },
                                 { 0.0060, 0.0124 },  { 0.0200, 0.0126 },  { 0.0360, 0.0180 } };
    /* The tip hangs lower than the wings. */
    double hang = t - 26 * s * s * bump((t + 0.030) / 0.022);
    return curve(height, COUNT(height), hang) * bump(s / curve(width, COUNT(width), t));
}

double lip_edge(double s, int side)
{
    double sigma = s / MOUTH_HALF, width = mouth_almond(s);
    if (side < 0) {
        return -0.0095 * pow(width, 0.8);
    }
    double bow = 0.0016 * bump(sigma / 0.22) - 0.0008 * bump((fabs(sigma) - 0.24) / 0.25);
    return (0.0084 - bow) * width;
}

static double lips(double s, double t, int side)
{
    static const Key upper[] = { { 0, -0.0012 },     { 0.0015, 0.0008 }, { 0.0045, 0.0025 },
                                 { 0.0085, 0.0017 }, { 0.0125, 0.0003 }, { 0.0160, 0 } };
    static const Key lower[] = { { 0, -0.0012 },     { 0.0015, 0.0010 },  { 0.0052, 0.0033 },
                                 { 0.0100, 0.0020 }, { 0.0145, -0.0003 }, { 0.0190, 0 } };
    double from_line = fabs(t - mouth_line(s)), wide = bump(s / 0.034);
    return wide * (side > 0 ? curve(upper, COUNT(upper), from_line) : curve(lower, COUNT(lower), from_line));
}

static double philtrum(double s, double t)
{
    return -0.0009 * bump2(s, t + 0.0395, 0.0042, 0.0085) +
           0.0006 * (bump2(s - 0.005, t + 0.040, 0.004, 0.009) + bump2(s + 0.005, t + 0.040, 0.004, 0.009));
}

/* The crease above the upper lid. */
static double lid_crease(double s, double t)
{
    double sigma = (fabs(s) - EYE_X) / (1.35 * EYE_HALF);
    double arch = 0.0075 * (1 - sigma * sigma);
    return -0.0011 * bump((t - eye_line(s) - arch) / 0.0028) * bump(sigma);
}

/* Two upright folds between drawn brows. */
static double furrow(double s, double t, const Pose *pose)
{
    double depth = 0.5 * (pose->brow_down[LEFT] + pose->brow_down[RIGHT]);
    if (depth == 0) {
        return 0;
    }
    double ridge = bump2(s, t - 0.034, 0.0055, 0.018) - 0.8 * bump2(s - 0.008, t - 0.034, 0.004, 0.016) -
                   0.8 * bump2(s + 0.008, t - 0.034, 0.004, 0.016);
    return 0.0020 * depth * ridge;
}

double relief(FacePoint point, const Pose *pose)
{
    double s = point.s, t = point.t, sum = 0;
    for (int i = 0; i < COUNT(hills); i++) {
        sum += hill(&hills[i], s, t);
    }
    return sum + nose(s, t) + lips(s, t, point.mouth) + philtrum(s, t) + lid_crease(s, t) + furrow(s, t, pose);
}
