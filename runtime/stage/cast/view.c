#include "core/base/assert_internal.h"
#include "noh/low_core.h"
#include "noh/noh.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"
#include "stage/cast/stage_internal.h"

#define HALF_VIEW_RAD 0.349066f

/* out = a * b; both column-major 4 x 4. */
static void multiply(const float a[16], const float b[16], float out[16])
{
    for (int c = 0; c < 4; c++) {
        for (int r = 0; r < 4; r++) {
            out[4 * c + r] = (a[r] * b[4 * c] + a[4 + r] * b[4 * c + 1]) +
                             (a[8 + r] * b[4 * c + 2] + a[12 + r] * b[4 * c + 3]);
        }
    }
}

/* ---- far from the origin ---- */

void noh_projection_less(float m[16], const float origin[3], const float rest[4])
{
    if (origin[0] == 0.0f && origin[1] == 0.0f && origin[2] == 0.0f) return;
    for (int r = 0; r < 4; r++) {
        double column = (double)m[12 + r] + (rest ? (double)rest[r] : 0.0);
        for (int c = 0; c < 3; c++) column += (double)m[4 * c + r] * (double)origin[c];
        m[12 + r] = (float)column;
    }
}

void noh_view_less(const noh_stage_view *view, const float origin[3], noh_stage_view *out)
{
    *out = *view;
    noh_projection_less(out->view_projection, origin, view->height_px ? view->column_rest : NULL);
    for (int i = 0; i < 3; i++) {
        if (origin[i] != 0.0f) {
            out->eye[i] = (float)((double)view->eye[i] - (double)origin[i] + (double)view->eye_rest[i]);
        }
    }
}

/* World to eye: the axes are rows. */
static void eye_matrix(const float axes[3][3], const float eye[3], float out[16])
{
    memset(out, 0, 16 * sizeof *out);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            out[4 * c + r] = axes[r][c];
            out[12 + r] -= axes[r][c] * eye[c];
        }
    }
    out[15] = 1.0f;
}

static void cross(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

/* What eye and last column are short of: the column takes the eye, by the matrix's own floats, to 0. */
static void keep_rests(noh_stage_view *view, const float target[3], float distance, const float back[3], float depth)
{
    const float *m = view->view_projection;
    double eye[3];
    for (int i = 0; i < 3; i++) {
        eye[i] = (double)target[i] + (double)distance * (double)back[i];
        view->eye_rest[i] = (float)(eye[i] - (double)view->eye[i]);
    }
    for (int r = 0; r < 4; r++) {
        double column = r == 2 ? (double)depth : 0.0;
        for (int c = 0; c < 3; c++) column -= (double)m[4 * c + r] * eye[c];
        view->column_rest[r] = (float)(column - (double)m[12 + r]);
    }
}

void noh_view_orbit(noh_stage_view *view, const float target[3], float yaw_rad, float pitch_rad, float distance,
                    uint32_t width, uint32_t height)
{
    const float near = 0.01f * distance, far = 100.0f * distance;
    float axes[3][3], world_to_eye[16], projection[16], sy, cy, sp, cp, sh, ch, slope;
    NOH_ASSERT(view && target && distance > 0.0f && width && height);
    memset(view, 0, sizeof *view);
    noh_sin_cos(yaw_rad, &sy, &cy);
    noh_sin_cos(pitch_rad, &sp, &cp);
    noh_sin_cos(HALF_VIEW_RAD, &sh, &ch);
    slope = sh / ch;
    axes[0][0] = cy, axes[0][1] = 0.0f, axes[0][2] = -sy;
    axes[2][0] = sy * cp, axes[2][1] = sp, axes[2][2] = cy * cp; /* back, from the target to the eye */
    cross(axes[2], axes[0], axes[1]);
    for (int i = 0; i < 3; i++) {
        view->eye[i] = target[i] + distance * axes[2][i];
        view->light[i] = 0.5f * axes[2][i] - 0.45f * axes[0][i] + (i == 1 ? 0.8f : 0.0f);
    }
    noh_normalize3(view->light, view->light);
    eye_matrix((const float(*)[3])axes, view->eye, world_to_eye);
    memset(projection, 0, sizeof projection);
    projection[0] = (float)height / (slope * (float)width);
    projection[5] = 1.0f / slope;
    projection[10] = (near + far) / (near - far);
    projection[11] = -1.0f;
    projection[14] = 2.0f * near * far / (near - far);
    multiply(projection, world_to_eye, view->view_projection);
    keep_rests(view, target, distance, axes[2], projection[14]);
    view->height_px = height;
}

void noh_view_shadow(noh_stage_view *view, const float sphere[4], const float light[3])
{
    float axes[3][3], world_to_eye[16], projection[16], up[3] = { 0.0f, 1.0f, 0.0f };
    NOH_ASSERT(view && sphere && light && sphere[3] > 0.0f);
    memset(view, 0, sizeof *view);
    memcpy(axes[2], light, sizeof axes[2]);
    if (light[0] * light[0] + light[2] * light[2] < 1e-6f) {
        up[1] = 0.0f, up[2] = 1.0f;
    }
    cross(up, axes[2], axes[0]);
    noh_normalize3(axes[0], axes[0]);
    cross(axes[2], axes[0], axes[1]);
    for (int i = 0; i < 3; i++) {
        view->eye[i] = sphere[i] + 3.0f * sphere[3] * light[i];
        view->light[i] = light[i];
    }
    eye_matrix((const float(*)[3])axes, view->eye, world_to_eye);
    memset(projection, 0, sizeof projection);
    projection[0] = projection[5] = 1.0f / sphere[3];
    projection[10] = -0.5f / sphere[3]; /* from the eye to four radii away */
    projection[14] = -1.0f;
    projection[15] = 1.0f;
    multiply(projection, world_to_eye, view->view_projection);
}

/* ---- rays ---- */

/* Solve m * x = b by elimination with pivots; 0: m is singular. */
static int solve(float m[4][5], float x[4])
{
    for (int c = 0; c < 4; c++) {
        int best = c;
        for (int r = c + 1; r < 4; r++) {
            if (m[r][c] * m[r][c] > m[best][c] * m[best][c]) best = r;
        }
        if (!(m[best][c] * m[best][c] > 0.0f)) return 0;
        for (int k = 0; k < 5; k++) {
            const float t = m[c][k];
            m[c][k] = m[best][k];
            m[best][k] = t;
        }
        for (int r = 0; r < 4; r++) {
            const float f = r == c ? 0.0f : m[r][c] / m[c][c];
            for (int k = 0; k < 5; k++) m[r][k] -= f * m[c][k];
        }
    }
    for (int r = 0; r < 4; r++) x[r] = m[r][4] / m[r][r];
    return 1;
}

static int unproject(const noh_stage_view *view, float x, float y, float z, float out[3])
{
    const float clip[4] = { x, y, z, 1.0f };
    float m[4][5], at[4];
    for (int r = 0; r < 4; r++) {
        for (int c = 0; c < 4; c++) m[r][c] = view->view_projection[4 * c + r];
        m[r][4] = clip[r];
    }
    if (!solve(m, at) || !(at[3] * at[3] > 0.0f)) return 0;
    for (int i = 0; i < 3; i++) out[i] = at[i] / at[3];
    return 1;
}

void noh_view_origin(const noh_stage_view *view, float origin[3])
{
    const float *e = view->eye;
    float at[3];
    memcpy(at, e, sizeof at);
    if (e[0] == 0.0f && e[1] == 0.0f && e[2] == 0.0f && !unproject(view, 0.0f, 0.0f, 0.0f, at)) {
        memset(at, 0, sizeof at); /* a view without an eye: what is in its middle */
    }
    for (int i = 0; i < 3; i++) origin[i] = noh_on_grid(at[i]);
}

int noh_view_ray(const noh_stage_view *view, float x, float y, uint32_t width, uint32_t height, float origin[3],
                 float direction[3])
{
    const float cx = 2.0f * (x + 0.5f) / (float)width - 1.0f, cy = 1.0f - 2.0f * (y + 0.5f) / (float)height;
    noh_stage_view near_by;
    float far[3], from[3];
    NOH_ASSERT(view && width && height && origin && direction);
    noh_view_origin(view, from);
    noh_view_less(view, from, &near_by);
    if (!unproject(&near_by, cx, cy, -1.0f, origin) || !unproject(&near_by, cx, cy, 0.5f, far)) {
        return 0;
    }
    for (int i = 0; i < 3; i++) direction[i] = far[i] - origin[i];
    for (int i = 0; i < 3; i++) origin[i] += from[i];
    noh_normalize3(direction, direction);
    return 1;
}

/* ---- planes ---- */

static float gradient(const float p[4])
{
    return noh_sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}

static double cross_dot(const double a[3], const double b[3], const double c[3])
{
    return (a[1] * b[2] - a[2] * b[1]) * c[0] + (a[2] * b[0] - a[0] * b[2]) * c[1] + (a[0] * b[1] - a[1] * b[0]) * c[2];
}

/* Where x, y and w of clip space are 0 at once, by Cramer's rule; 0: nowhere. */
static int find_eye(const float m[16], float eye[3])
{
    double rows[3][4], columns[4][3], determinant;
    for (int c = 0; c < 4; c++) {
        for (int r = 0; r < 3; r++) columns[c][r] = rows[r][c] = (double)m[4 * c + (r < 2 ? r : 3)];
    }
    determinant = cross_dot(columns[0], columns[1], columns[2]);
    if (!(determinant * determinant > 0.0)) return 0;
    for (int i = 0; i < 3; i++) {
        eye[i] = (float)(-cross_dot(columns[3], columns[(i + 1) % 3], columns[(i + 2) % 3]) / determinant);
    }
    return 1;
}

/* w of the near plane, whatever the clip space: z is -w there, or 0, or with z reversed w, and of these places it is
 * the nearest in front of the eye. */
static float find_near(const float m[16], const noh_view_planes *v)
{
    double at_eye = (double)m[14], along = 0.0, nearest = 0.0;
    for (int i = 0; i < 3; i++) {
        at_eye += (double)m[4 * i + 2] * (double)v->eye[i];
        along += (double)m[4 * i + 2] * (double)v->eye_plane[i] / (double)v->w_slope;
    }
    for (int clip = -1; clip <= 1; clip++) {
        const double rest = clip * (double)v->w_slope - along, w = at_eye / rest * (double)v->w_slope;
        if (rest * rest > 0.0 && w > 0.0 && (nearest <= 0.0 || w < nearest)) nearest = w;
    }
    return nearest > 1e-6 ? (float)nearest : 1e-6f;
}

/* A corner of the picture is where x and y are w, or -w: along the normal of both planes. */
static float find_corner(const float planes[4][4], const noh_view_planes *v)
{
    float least = 1.0f;
    for (int i = 0; i < 4; i++) {
        float ray[3], along, length;
        cross(planes[i & 1], planes[2 + (i >> 1)], ray);
        along = noh_dot3(ray, v->eye_plane);
        length = noh_sqrt(noh_dot3(ray, ray)) * v->w_slope;
        along = along < 0.0f ? -along : along;
        if (length > 0.0f && along < least * length) least = along / length;
    }
    return least;
}

/* source  G. Gribb and K. Hartmann, "Fast Extraction of Viewing Frustum Planes from the World-View-Projection Matrix"
 *         (2001). The far and near planes are left out: what lies beyond the far one is rare, and cheap. */
void noh_view_planes_of(const noh_stage_view *view, noh_view_planes *out)
{
    const float *m = view->view_projection;
    float up[4];
    memset(out, 0, sizeof *out);
    for (int i = 0; i < 4; i++) {
        const float x = m[4 * i], y = m[4 * i + 1], w = m[4 * i + 3];
        out->planes[0][i] = w + x;
        out->planes[1][i] = w - x;
        out->planes[2][i] = w + y;
        out->planes[3][i] = w - y;
        out->eye_plane[i] = w;
        up[i] = y;
    }
    for (int p = 0; p < 4; p++) {
        const float length = gradient(out->planes[p]);
        for (int i = 0; i < 4 && length > 0.0f; i++) out->planes[p][i] /= length;
    }
    out->w_slope = gradient(out->eye_plane);
    out->scale = 0.5f * (float)view->height_px * gradient(up);
    memcpy(out->eye, view->eye, sizeof out->eye);
    out->near_w = 1e-6f;
    out->corner = 1.0f;
    if (out->w_slope > 0.0f && find_eye(m, out->eye)) {
        out->near_w = find_near(m, out);
        out->corner = find_corner((const float(*)[4])out->planes, out);
    }
    out->is_light = view->height_px == 0;
}
