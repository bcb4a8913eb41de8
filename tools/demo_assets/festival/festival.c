#include "festival.h"

#include <math.h>
#include <stddef.h>

#define PI 3.14159265358979323846

enum { SIDES_ROUND = 24 };

typedef enum { SAND, STONE, WOOD, DARK_WOOD, PAPER, RED, INDIGO, SKIN_OF_DRUM, MATERIALS } Material;

static const struct {
    const char *name;
    double color[3]; /* sRGB */
} materials[MATERIALS] = {
    { "sand", { 0.66, 0.58, 0.45 } },      { "stone", { 0.52, 0.50, 0.47 } },    { "wood", { 0.55, 0.36, 0.20 } },
    { "dark_wood", { 0.30, 0.18, 0.11 } }, { "paper", { 0.96, 0.86, 0.62 } },    { "red", { 0.70, 0.10, 0.08 } },
    { "indigo", { 0.12, 0.16, 0.36 } },    { "drumskin", { 0.90, 0.82, 0.66 } },
};

typedef struct {
    Buffer *out;
    FestivalCensus census;
} Writer;

/* ---- shapes ---- */

static void vertex(Writer *w, double x, double y, double z)
{
    buffer_print(w->out, "v %.4f %.4f %.4f\n", x, y, z);
    w->census.vertices++;
}

static void use(Writer *w, Material m)
{
    buffer_print(w->out, "usemtl %s\n", materials[m].name);
}

/* Four corners of eight, counter-clockwise from outside. Each face has corners of its own, for edges are sharp. */
static void face(Writer *w, double corners[8][3], int a, int b, int c, int d)
{
    const int which[4] = { a, b, c, d };
    for (int i = 0; i < 4; i++) vertex(w, corners[which[i]][0], corners[which[i]][1], corners[which[i]][2]);
    buffer_print(w->out, "f -4 -3 -2 -1\n");
    w->census.faces++;
}

/* About x, z, turned to the left by an angle. */
static void box(Writer *w, Material m, double x, double z, double turn, double wide, double deep, double low,
                double high)
{
    const double c = cos(turn), s = sin(turn);
    double corners[8][3];
    use(w, m);
    for (int i = 0; i < 8; i++) {
        const double u = (i & 1 ? 0.5 : -0.5) * wide, v = (i & 2 ? 0.5 : -0.5) * deep;
        corners[i][0] = x + u * c + v * s;
        corners[i][1] = i & 4 ? high : low;
        corners[i][2] = z - u * s + v * c;
    }
    face(w, corners, 4, 6, 7, 5);
    face(w, corners, 0, 1, 3, 2);
    face(w, corners, 2, 3, 7, 6);
    face(w, corners, 1, 0, 4, 5);
    face(w, corners, 3, 1, 5, 7);
    face(w, corners, 0, 2, 6, 4);
}

static void ring(Writer *w, double x, double z, const double at[2])
{
    for (int i = 0; i < SIDES_ROUND; i++) {
        const double angle = 2 * PI * i / SIDES_ROUND;
        vertex(w, x + at[0] * cos(angle), at[1], z - at[0] * sin(angle));
    }
}

/* Rings of radii at heights, closed at both ends. */
static void turned(Writer *w, Material m, double x, double z, double (*rings)[2], int count)
{
    const int first = w->census.vertices + 1;
    use(w, m);
    for (int r = 0; r < count; r++) ring(w, x, z, rings[r]);
    for (int r = 0; r + 1 < count; r++) {
        for (int i = 0; i < SIDES_ROUND; i++) {
            const int a = first + r * SIDES_ROUND + i, b = first + r * SIDES_ROUND + (i + 1) % SIDES_ROUND;
            buffer_print(w->out, "f %d %d %d %d\n", a, b, b + SIDES_ROUND, a + SIDES_ROUND);
            w->census.faces++;
        }
    }
    for (int end = 0; end < 2; end++) {
        ring(w, x, z, rings[end ? count - 1 : 0]);
        buffer_print(w->out, "f");
        for (int i = 0; i < SIDES_ROUND; i++) buffer_print(w->out, " %d", end ? i - SIDES_ROUND : -1 - i);
        buffer_print(w->out, "\n");
        w->census.faces++;
    }
}

/* ---- things ---- */

/* A counter under a roof with a curtain; at turn 0 customers stand on the side of +z. */
static void stall(Writer *w, double x, double z, double turn, Material roof)
{
    const double c = cos(turn), s = sin(turn);
    box(w, WOOD, x + 0.9 * s, z + 0.9 * c, turn, 3.0, 0.5, 0.0, 0.95);
    for (int i = 0; i < 4; i++) {
        const double u = i & 1 ? 1.5 : -1.5, v = i & 2 ? 1.2 : -1.2;
        box(w, DARK_WOOD, x + u * c + v * s, z - u * s + v * c, turn, 0.12, 0.12, 0.0, 2.5);
    }
    box(w, roof, x, z, turn, 3.5, 3.0, 2.5, 2.62);
    box(w, roof, x, z, turn, 2.6, 2.0, 2.62, 2.85);
    box(w, PAPER, x + 1.27 * s, z + 1.27 * c, turn, 3.0, 0.03, 2.1, 2.5);
    for (int i = -2; i <= 2; i++) { /* what is sold */
        double rings[][2] = { { 0.10, 0.95 }, { 0.15, 1.02 }, { 0.05, 1.12 } };
        turned(w, i & 1 ? RED : PAPER, x + 0.55 * i * c + 0.9 * s, z - 0.55 * i * s + 0.9 * c, rings, 3);
    }
}

static void bench(Writer *w, double x, double z, double turn)
{
    const double c = cos(turn), s = sin(turn);
    box(w, WOOD, x, z, turn, 2.4, 0.45, 0.38, 0.45);
    box(w, DARK_WOOD, x + 1.0 * c, z - 1.0 * s, turn, 0.1, 0.4, 0.0, 0.38);
    box(w, DARK_WOOD, x - 1.0 * c, z + 1.0 * s, turn, 0.1, 0.4, 0.0, 0.38);
}

static void lantern(Writer *w, double x, double z)
{
    double rings[][2] = { { 0.14, 2.55 }, { 0.28, 2.70 }, { 0.32, 2.92 }, { 0.28, 3.14 }, { 0.14, 3.28 } };
    box(w, DARK_WOOD, x, z, 0, 0.12, 0.12, 0.0, 3.5);
    turned(w, RED, x, z, rings, 5);
}

static void drum(Writer *w, double x, double z, double floor)
{
    double body[][2] = { { 0.70, floor + 0.35 },
                         { 0.85, floor + 0.60 },
                         { 0.92, floor + 0.90 },
                         { 0.85, floor + 1.20 },
                         { 0.70, floor + 1.45 } };
    double skin[][2] = { { 0.72, floor + 1.44 }, { 0.72, floor + 1.48 } };
    turned(w, RED, x, z, body, 5);
    turned(w, SKIN_OF_DRUM, x, z, skin, 2);
    for (int i = 0; i < 4; i++) {
        box(w, DARK_WOOD, x + (i & 1 ? 0.6 : -0.6), z + (i & 2 ? 0.6 : -0.6), 0, 0.14, 0.14, floor, floor + 0.7);
    }
}

static void stage(Writer *w)
{
    box(w, DARK_WOOD, 0, -11, 0, 9.0, 4.4, 0.0, 0.55);
    box(w, WOOD, 0, -11, 0, 9.2, 4.6, 0.55, 0.62);
    for (int i = 0; i < 4; i++) box(w, DARK_WOOD, i & 1 ? 4.2 : -4.2, i & 2 ? -9.1 : -12.9, 0, 0.2, 0.2, 0.62, 3.9);
    box(w, INDIGO, 0, -11, 0, 10.0, 5.2, 3.9, 4.05);
    box(w, INDIGO, 0, -11, 0, 7.6, 3.6, 4.05, 4.4);
    drum(w, 0, -11, 0.62);
}

/* Three steps up to a terrace, open to the front alone. */
static void terrace(Writer *w)
{
    box(w, STONE, 16, -12.0, 0, 8.0, 6.0, 0.0, 0.48);
    box(w, STONE, 16, -8.75, 0, 4.0, 0.5, 0.0, 0.32);
    box(w, STONE, 16, -8.25, 0, 4.0, 0.5, 0.0, 0.16);
    box(w, DARK_WOOD, 13, -9.06, 0, 2.0, 0.12, 0.48, 1.3);
    box(w, DARK_WOOD, 19, -9.06, 0, 2.0, 0.12, 0.48, 1.3);
    box(w, DARK_WOOD, 12.06, -12.0, 0, 0.12, 6.0, 0.48, 1.3);
    box(w, DARK_WOOD, 19.94, -12.0, 0, 0.12, 6.0, 0.48, 1.3);
}

FestivalCensus festival_write(Buffer *obj, Buffer *mtl, const char *library)
{
    Writer w = { obj, { 0, 0 } };
    for (int m = 0; m < MATERIALS; m++) {
        const double *c = materials[m].color;
        buffer_print(mtl, "newmtl %s\nKd %.3f %.3f %.3f\n", materials[m].name, pow(c[0], 2.2), pow(c[1], 2.2),
                     pow(c[2], 2.2));
    }
    buffer_print(obj, "mtllib %s\no festival\n", library);
    box(&w, SAND, 0, 0, 0, 90, 90, -0.2, 0.0);
    stage(&w);
    terrace(&w);
    for (int i = 0; i < 4; i++) stall(&w, -18.0, -8.0 + 5.5 * i, 0.5 * PI, i & 1 ? INDIGO : RED);
    stall(&w, 18.0, 9.0, -0.5 * PI, RED);
    stall(&w, 18.0, 3.0, -0.5 * PI, INDIGO);
    bench(&w, -6, 6, 0);
    bench(&w, 6, 6, 0);
    bench(&w, 0, 10, 0);
    for (int i = 0; i < 6; i++) lantern(&w, -12.5 + 5 * i, i & 1 ? 13.0 : 2.0);
    lantern(&w, -7, -8);
    lantern(&w, 7, -8);
    return w.census;
}
