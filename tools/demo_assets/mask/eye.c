#include "eye.h"

#include "face.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Rings of the cap from the pupil's centre out. Two rings lie close together
 * wherever the paint changes, to keep its edge sharp. */
static const double rings[] = { 0.045,
                                0.09,
                                0.13,
                                PUPIL_ANGLE - 0.008,
                                PUPIL_ANGLE + 0.008,
                                0.22,
                                0.27,
                                0.31,
                                IRIS_ANGLE - 0.010,
                                IRIS_ANGLE + 0.010,
                                0.40,
                                0.47,
                                0.55,
                                0.63,
                                0.71,
                                0.80,
                                0.90,
                                1.00,
                                1.12 };
enum { RINGS = sizeof rings / sizeof rings[0], SEGMENTS = 32 };

V3 ball_centre(int side)
{
    return v3(side_sign(side) * EYE_X, EYE_Y + 0.001, 0.0056);
}

double ball_shell(int side, double x, double y, double lift)
{
    V3 centre = ball_centre(side);
    double dx = x - centre.x, dy = y - centre.y, radius = BALL_RADIUS + lift;
    double inside = 1 - (dx * dx + dy * dy) / (radius * radius);
    /* Beyond the silhouette it continues as a straight slope, so that the depth stays smooth. */
    double edge = 0.04;
    if (inside > edge) {
        return centre.z + radius * sqrt(inside);
    }
    return centre.z + radius * (sqrt(edge) + (inside - edge) / (2 * sqrt(edge)));
}

double ball_front(int side, double x, double y)
{
    return ball_shell(side, x, y, 0);
}

/* At rest the eyes look a little down and a little apart, as a mask does. */
V3 ball_place(const Seed *seed, const Pose *pose)
{
    int side = seed->eye > 0 ? LEFT : RIGHT;
    double yaw = side_sign(side) * (0.03 + 0.42 * (pose->look_out[side] - pose->look_in[side]));
    double pitch = -0.03 + 0.30 * pose->look_up[side] - 0.34 * pose->look_down[side];
    double ring = seed->s, around = seed->t;
    V3 d = v3(sin(ring) * cos(around), sin(ring) * sin(around), cos(ring));
    V3 pitched = v3(d.x, d.y * cos(pitch) + d.z * sin(pitch), d.z * cos(pitch) - d.y * sin(pitch));
    V3 turned = v3(pitched.x * cos(yaw) + pitched.z * sin(yaw), pitched.y, pitched.z * cos(yaw) - pitched.x * sin(yaw));
    return v3_add(ball_centre(side), v3_scale(turned, BALL_RADIUS));
}

static uint32_t ball_seed(Model *model, int side, double ring, double around)
{
    Seed seed = { .region = ON_BALL, .s = ring, .t = around, .eye = side == LEFT ? 1 : -1 };
    seed.u = 0.5 + 0.4 * ring * cos(around);
    seed.v = 0.5 - 0.4 * ring * sin(around);
    return model_seed(model, PART_EYES, &seed);
}

static void ball_build(Model *model, int side)
{
    uint32_t before[SEGMENTS], now[SEGMENTS];
    uint32_t pole = ball_seed(model, side, 0, 0);
    for (int r = 0; r < RINGS; r++) {
        for (int i = 0; i < SEGMENTS; i++) {
            now[i] = ball_seed(model, side, rings[r], 2 * PI * i / SEGMENTS);
        }
        for (int i = 0; i < SEGMENTS; i++) {
            int next = (i + 1) % SEGMENTS;
            if (r == 0) {
                model_triangle(model, PART_EYES, pole, now[i], now[next]);
            } else {
                model_quad(model, PART_EYES, before[i], now[i], now[next], before[next]);
            }
        }
        for (int i = 0; i < SEGMENTS; i++) {
            before[i] = now[i];
        }
    }
}

void eyes_build(Model *model)
{
    ball_build(model, LEFT);
    ball_build(model, RIGHT);
}
