#include "camera.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"
#include "cli/message.h"

#define PI 3.14159265358979

static void grow(bounds *b, const double p[3])
{
    for (int c = 0; c < 3; c++) {
        b->low[c] = fmin(b->low[c], p[c]);
        b->high[c] = fmax(b->high[c], p[c]);
    }
}

bounds bounds_union(bounds a, bounds b)
{
    grow(&a, b.low);
    grow(&a, b.high);
    return a;
}

bounds bounds_turned(bounds b, double degrees)
{
    const double s = round(sin(degrees * PI / 180.0)), c = round(cos(degrees * PI / 180.0));
    const double a[2] = { c * b.low[0] + s * b.low[2], c * b.high[0] + s * b.high[2] };
    const double d[2] = { c * b.low[2] - s * b.low[0], c * b.high[2] - s * b.high[0] };
    b.low[0] = fmin(a[0], a[1]);
    b.high[0] = fmax(a[0], a[1]);
    b.low[2] = fmin(d[0], d[1]);
    b.high[2] = fmax(d[0], d[1]);
    return b;
}

/* Column-major product of a 4x4 projection and a 4x4 view. */
static void multiply(const double a[16], const double b[16], float out[16])
{
    for (int column = 0; column < 4; column++) {
        for (int row = 0; row < 4; row++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++) {
                sum += a[4 * k + row] * b[4 * column + k];
            }
            out[4 * column + row] = (float)sum;
        }
    }
}

void orbit_axes(const orbit *o, double right[3], double up[3], double back[3])
{
    double ca = cos(o->azimuth), sa = sin(o->azimuth), ce = cos(o->elevation), se = sin(o->elevation);
    const double r[3] = { ca, 0.0, -sa }, u[3] = { -sa * se, ce, -ca * se }, b[3] = { sa * ce, se, ca * ce };
    memcpy(right, r, sizeof r);
    memcpy(up, u, sizeof u);
    memcpy(back, b, sizeof b);
}

#define FLOOR_RADII 8.0 /* shadows on a floor reach so far */

void orbit_camera(const orbit *o, noh_gl_camera *camera)
{
    double right[3], up[3], back[3], view[16] = { 0 }, projection[16] = { 0 };
    double near = fmax(o->distance - 2.0 * o->radius, o->distance * 0.02), far = o->distance + FLOOR_RADII * o->radius;
    double f = 1.0 / tan(ORBIT_VIEW_RAD / 2.0), key_length = 0.0;
    orbit_axes(o, right, up, back);
    for (int c = 0; c < 3; c++) {
        double eye = o->center[c] + back[c] * o->distance;
        camera->eye[c] = (float)eye;
        view[4 * c] = right[c];
        view[4 * c + 1] = up[c];
        view[4 * c + 2] = back[c];
        view[12] -= right[c] * eye;
        view[13] -= up[c] * eye;
        view[14] -= back[c] * eye;
    }
    view[15] = 1.0;
    projection[0] = f / o->aspect;
    projection[5] = f;
    projection[10] = -(far + near) / (far - near);
    projection[11] = -1.0;
    projection[14] = -2.0 * far * near / (far - near);
    multiply(projection, view, camera->view_projection);
    for (int c = 0; c < 3; c++) { /* over the viewer's left shoulder */
        double key = -0.45 * right[c] + 0.62 * up[c] + 0.64 * back[c];
        camera->key[c] = (float)key;
        key_length += key * key;
    }
    for (int c = 0; c < 3; c++) {
        camera->key[c] = (float)((double)camera->key[c] / sqrt(key_length));
    }
}

static const struct {
    const char *word;
    view_frame frame;
} frames[] = { { "auto", FRAME_AUTO },
               { "full", FRAME_FULL },
               { "body", FRAME_FULL },
               { "upper", FRAME_UPPER },
               { "face", FRAME_FACE } };

/* The frame that the text begins with, and what follows its word; NULL: it begins with none. */
static const char *after_frame(const char *text, view_frame *frame)
{
    for (size_t i = 0; i < sizeof frames / sizeof frames[0]; i++) {
        const size_t length = strlen(frames[i].word);
        if (strncmp(text, frames[i].word, length) == 0 && (!text[length] || text[length] == ',')) {
            *frame = frames[i].frame;
            return text + length;
        }
    }
    return NULL;
}

view_frame view_frame_of(const view_options *o)
{
    view_frame frame = FRAME_FULL;
    if (o->camera) (void)after_frame(o->camera, &frame);
    return frame;
}

int view_frames(const view_options *o)
{
    view_frame frame;
    return !o->camera || after_frame(o->camera, &frame);
}

/* "AZ,EL,DIST": three numbers; the distance may be left out. */
static int parse_orbit(const char *text, orbit *o)
{
    char buffer[128], *part[3] = { buffer, NULL, NULL };
    double values[3] = { 0.0, 0.0, 0.0 };
    int count = 1;
    if (strlen(text) >= sizeof buffer) {
        return 1;
    }
    strcpy(buffer, text);
    for (char *c = buffer; *c; c++) {
        if (*c == ',') {
            if (count == 3) {
                return 1;
            }
            *c = 0;
            part[count++] = c + 1;
        }
    }
    for (int i = 0; i < count; i++) {
        if (tool_number(part[i], &values[i])) {
            return 1;
        }
    }
    o->azimuth = values[0] * PI / 180.0;
    o->elevation = values[1] * PI / 180.0;
    o->distance = count == 3 ? values[2] : o->distance;
    return count < 2 || fabs(values[1]) > 89.9 || o->distance <= 0.0;
}

void orbit_frame(orbit *o, const bounds *box, double margin)
{
    const double half_view = tan(ORBIT_VIEW_RAD / 2.0) * (1.0 - 2.0 * margin);
    double axes[3][3], half[3], distance = 0.0, radius = 0.0;
    for (int c = 0; c < 3; c++) {
        o->center[c] = (box->low[c] + box->high[c]) / 2.0;
        half[c] = (box->high[c] - box->low[c]) / 2.0;
        radius += half[c] * half[c];
    }
    o->radius = fmax(sqrt(radius), 1e-6);
    orbit_axes(o, axes[0], axes[1], axes[2]);
    for (int corner = 0; corner < 8; corner++) {
        double at[3] = { 0.0, 0.0, 0.0 };
        for (int c = 0; c < 3; c++) {
            const double side = corner >> c & 1 ? half[c] : -half[c];
            for (int a = 0; a < 3; a++) at[a] += side * axes[a][c];
        }
        distance = fmax(distance, at[2] + fmax(fabs(at[1]), fabs(at[0]) / o->aspect) / half_view);
    }
    o->distance = fmax(distance, o->radius * 1.02);
}

orbit orbit_fit(const bounds *box, double aspect, double facing)
{
    orbit at = { facing * PI / 180.0, 0.05, 0.0, { 0.0, 0.0, 0.0 }, 0.0, aspect };
    const bounds own = bounds_turned(*box, -facing);
    double half[3], need;
    for (int c = 0; c < 3; c++) {
        at.center[c] = (box->low[c] + box->high[c]) / 2.0;
        half[c] = (own.high[c] - own.low[c]) / 2.0;
    }
    at.radius = fmax(sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]), 1e-6);
    need = fmax(half[1], fmax(half[0], half[2] * 0.7) / at.aspect) * 1.05;
    at.distance = fmax(need / tan(ORBIT_VIEW_RAD / 2.0) + half[2], at.radius * 1.02);
    return at;
}

/* Without a direction of their own: from the side and a little above, where a face shows its shape. */
#define AUTO_DIRECTION "15,6"

int view_camera(const view_options *o, const bounds *box, noh_gl_camera *camera)
{
    view_frame frame = FRAME_FULL;
    const char *rest = o->camera ? after_frame(o->camera, &frame) : "";
    orbit at = orbit_fit(box, (double)o->width / (double)o->height, rest ? o->facing : 0.0);
    const char *direction = !rest ? o->camera : *rest ? rest + 1 : frame == FRAME_AUTO ? AUTO_DIRECTION : NULL;
    const double fitted = at.distance;
    if (direction && (parse_orbit(direction, &at) || (rest && at.distance != fitted))) {
        return tool_usage("--camera must be face, upper or full, each alone or with ,AZIMUTH,ELEVATION, or "
                          "AZIMUTH,ELEVATION[,DISTANCE] (degrees, elevation -89 to 89; distance over 0), not '%s'",
                          o->camera);
    }
    if (rest && direction) {
        at.azimuth += o->facing * PI / 180.0;
        orbit_frame(&at, box, ORBIT_MARGIN);
    }
    if (o->around) at.radius *= 8.0;
    orbit_camera(&at, camera);
    return 0;
}
