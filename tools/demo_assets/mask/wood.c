#include "wood.h"

#include "face.h"
#include "face_grid.h"
#include "mask.h"

#include <math.h>

enum { STEP = 2, SEGMENTS = GRID_BORDER / STEP, RIM_ROWS = 7, BACK_RINGS = 9 };

/* The rim's profile: outwards in the plane of the outline, and back. The first row lies under the paint, so that no gap
 * shows along the seam. */
static const double rim_out[RIM_ROWS] = { -0.0008, 0.0008, 0.0024, 0.0028, 0.0022, 0, -0.0040 };
static const double rim_back[RIM_ROWS] = { 0.0004, 0.0001, 0.0006, 0.0030, 0.0058, 0.0070, 0.0066 };

static V3 border_place(const Seed *seed, const Pose *pose)
{
    FacePoint point = { seed->s, seed->t, seed->t > EYE_Y ? 1 : -1, seed->t > MOUTH_Y ? 1 : -1 };
    return face_place(point, pose);
}

V3 rim_place(const Seed *seed, const Pose *pose)
{
    int row = (int)seed->k;
    V3 at = border_place(seed, pose);
    V3 out = v3_unit(
        v3(seed->s / (FACE_HALF_WIDTH * FACE_HALF_WIDTH), seed->t / (FACE_HALF_HEIGHT * FACE_HALF_HEIGHT), 0));
    at = v3_add(at, v3_scale(out, rim_out[row]));
    at.z -= rim_back[row];
    return at;
}

/* Shallow tool marks, as a gouge leaves them. */
static double gouge(double x, double y)
{
    return 0.0005 * cos(x * 700 + 2 * sin(y * 210)) * cos(y * 330 + 1.5 * sin(x * 160));
}

double back_share(const Seed *seed)
{
    return 1 - seed->k / BACK_RINGS;
}

V3 back_place(const Seed *seed, const Pose *pose)
{
    static const Pose rest;
    Seed border = *seed;
    border.k = RIM_ROWS - 1;
    V3 still = rim_place(&border, &rest), moved = rim_place(&border, pose);
    double part = back_share(seed), hollow = 1 - part * part;
    V3 at = v3(still.x * part, still.y * part, still.z);
    at.z = mix(still.z, -0.0125, hollow * (2 - hollow)) + gouge(at.x, at.y) * smooth(1, 0.8, part);
    return v3_add(at, v3_scale(v3_sub(moved, still), part * part));
}

static uint32_t wood_seed(Model *model, Region region, int k, int segment)
{
    Seed seed = face_grid_border(segment % SEGMENTS * STEP);
    static const Pose rest;
    seed.region = region;
    seed.k = k;
    V3 at = mask_place(&seed, &rest);
    seed.u = region == ON_RIM ? 4.0 * segment / SEGMENTS : 0.5 + at.x / 0.24;
    seed.v = region == ON_RIM ? 0.02 * k : 0.5 - at.y / 0.24;
    return model_seed(model, PART_WOOD, &seed);
}

/* The rim's texture runs around it, so its first and last column differ in
 * texture alone. */
static void rim_build(Model *model)
{
    uint32_t before[SEGMENTS + 1], now[SEGMENTS + 1];
    for (int k = 0; k < RIM_ROWS; k++) {
        for (int i = 0; i <= SEGMENTS; i++) {
            now[i] = wood_seed(model, ON_RIM, k, i);
        }
        for (int i = 0; i < SEGMENTS && k > 0; i++) {
            model_quad(model, PART_WOOD, now[i], now[i + 1], before[i + 1], before[i]);
        }
        for (int i = 0; i <= SEGMENTS; i++) {
            before[i] = now[i];
        }
    }
}

/* A ring with half the segments of the one outside it: every other vertex
 * of the outer ring stands over the middle of an inner segment. */
static void back_halve(Model *model, const uint32_t *outer, const uint32_t *inner, int stride)
{
    for (int i = 0; i < SEGMENTS; i += 2 * stride) {
        int middle = i + stride, next = (i + 2 * stride) % SEGMENTS;
        model_triangle(model, PART_WOOD, inner[i], inner[next], outer[middle]);
        model_triangle(model, PART_WOOD, inner[next], outer[next], outer[middle]);
        model_triangle(model, PART_WOOD, inner[i], outer[middle], outer[i]);
    }
}

/* Rings of the back shrink to one point; twice on the way they halve. */
static void back_build(Model *model)
{
    uint32_t before[SEGMENTS], now[SEGMENTS];
    int stride = 1;
    for (int i = 0; i < SEGMENTS; i++) {
        before[i] = wood_seed(model, ON_BACK, 0, i);
    }
    for (int k = 1; k < BACK_RINGS; k++) {
        int halve = k == 3 || k == 6;
        int step = halve ? 2 * stride : stride;
        for (int i = 0; i < SEGMENTS; i += step) {
            now[i] = wood_seed(model, ON_BACK, k, i);
        }
        if (halve) {
            back_halve(model, before, now, stride);
        }
        stride = step;
        for (int i = 0; i < SEGMENTS && !halve; i += stride) {
            int next = (i + stride) % SEGMENTS;
            model_quad(model, PART_WOOD, now[i], now[next], before[next], before[i]);
        }
        for (int i = 0; i < SEGMENTS; i++) {
            before[i] = now[i];
        }
    }
    uint32_t middle = wood_seed(model, ON_BACK, BACK_RINGS, 0);
    for (int i = 0; i < SEGMENTS; i += stride) {
        model_triangle(model, PART_WOOD, middle, before[(i + stride) % SEGMENTS], before[i]);
    }
}

void wood_build(Model *model)
{
    rim_build(model);
    back_build(model);
}
