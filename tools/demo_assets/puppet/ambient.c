#include "ambient.h"

#include "shared/grab.h"

#include <math.h>
#include <stdlib.h>

/* The surface is seen from many sides; what a depth map shows is open to that side. */
enum { SIDES_LOOKED_FROM = 96, MAP = 512 };
static const double cell = 0.0042, slack = 0.012;

typedef struct {
    V3 right, up, to_viewer;
    float *depth; /* [MAP][MAP] the nearest to the viewer */
} View;

/* Evenly spread over the sphere, along a spiral. */
static View view_from(int number, float *depth)
{
    double z = 1 - (2 * number + 1.0) / SIDES_LOOKED_FROM, angle = 2.399963229728653 * number;
    double r = sqrt(1 - z * z);
    View view = { .to_viewer = v3(r * cos(angle), z, r * sin(angle)), .depth = depth };
    view.right = v3_unit(v3_cross(fabs(z) < 0.9 ? v3(0, 1, 0) : v3(1, 0, 0), view.to_viewer));
    view.up = v3_cross(view.to_viewer, view.right);
    return view;
}

static V3 seen(const View *view, V3 at)
{
    at.y -= 0.82;
    return v3(v3_dot(at, view->right) / cell + MAP / 2.0, v3_dot(at, view->up) / cell + MAP / 2.0,
              v3_dot(at, view->to_viewer));
}

static double twice_area(V3 a, V3 b, double x, double y)
{
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

static void draw(const View *view, V3 a, V3 b, V3 c)
{
    double area = twice_area(a, b, c.x, c.y);
    int x0 = (int)fmax(floor(fmin(a.x, fmin(b.x, c.x))), 0), x1 = (int)fmin(fmax(a.x, fmax(b.x, c.x)), MAP - 1);
    int y0 = (int)fmax(floor(fmin(a.y, fmin(b.y, c.y))), 0), y1 = (int)fmin(fmax(a.y, fmax(b.y, c.y)), MAP - 1);
    if (fabs(area) < 1e-12) {
        return;
    }
    for (int y = y0; y <= y1; y++) {
        for (int x = x0; x <= x1; x++) {
            double ka = twice_area(b, c, x + 0.5, y + 0.5) / area, kb = twice_area(c, a, x + 0.5, y + 0.5) / area;
            double kc = 1 - ka - kb, z = ka * a.z + kb * b.z + kc * c.z;
            float *at = &view->depth[y * MAP + x];
            if (ka >= 0 && kb >= 0 && kc >= 0 && z > (double)*at) {
                *at = (float)z;
            }
        }
    }
}

static void draw_surface(const View *view, const Cage *surface)
{
    for (int i = 0; i < MAP * MAP; i++) {
        view->depth[i] = -100;
    }
    for (int f = 0; f < surface->face_count; f++) {
        V3 corner[4];
        for (int i = 0; i < 4; i++) {
            corner[i] = seen(view, surface->vertices[surface->faces[f].corner[i]].at);
        }
        draw(view, corner[0], corner[1], corner[2]);
        draw(view, corner[0], corner[2], corner[3]);
    }
}

static int is_seen(const View *view, V3 at)
{
    V3 place = seen(view, at);
    int x = (int)clamp(place.x, 0, MAP - 1), y = (int)clamp(place.y, 0, MAP - 1);
    return place.z > (double)view->depth[y * MAP + x] - slack;
}

double *ambient_bake(const Cage *surface, const V3 *normals)
{
    int count = surface->vertex_count;
    double *open = grab(NULL, count, (int)sizeof *open), *all = grab(NULL, count, (int)sizeof *all);
    float *depth = grab(NULL, MAP * MAP, (int)sizeof *depth);
    for (int i = 0; i < count; i++) {
        open[i] = all[i] = 0;
    }
    for (int number = 0; number < SIDES_LOOKED_FROM; number++) {
        View view = view_from(number, depth);
        draw_surface(&view, surface);
        for (int i = 0; i < count; i++) {
            double facing = v3_dot(normals[i], view.to_viewer);
            V3 off = v3_add(surface->vertices[i].at, v3_scale(normals[i], 0.004));
            if (facing > 0) {
                all[i] += facing;
                open[i] += is_seen(&view, off) ? facing : 0;
            }
        }
    }
    for (int i = 0; i < count; i++) {
        open[i] /= all[i];
    }
    free(all);
    free(depth);
    return open;
}
