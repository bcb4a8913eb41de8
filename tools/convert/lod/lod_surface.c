/* lod_surface.c: points, the corners around them, islands, and the points that may not move. */
#include "lod_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

#define MINOR_SHARE 8u /* a submesh with less than 1/8 of the triangles is a minor part */

#define FACETS_LEAST 3u

/* ---- points ---- */

static int same_skin(const model_mesh *mesh, uint32_t a, uint32_t b)
{
    size_t bytes = MODEL_INFLUENCES_MAX;
    return !mesh->joint_weights ||
           (!memcmp(mesh->joint_weights + a * bytes, mesh->joint_weights + b * bytes,
                    bytes * sizeof *mesh->joint_weights) &&
            !memcmp(mesh->joints + a * bytes, mesh->joints + b * bytes, bytes * sizeof *mesh->joints));
}

static int same_in_all_poses(const lod_surface *s, uint32_t a, uint32_t b)
{
    size_t row = (size_t)s->poses.count * 3u * sizeof(float);
    return !memcmp(lod_posed(&s->poses, a, 0), lod_posed(&s->poses, b, 0), row) && same_skin(s->mesh, a, b);
}

/* Vertices of one place that some pose takes apart cannot be simplified together: each is a point of its own, locked.
 */
static void split_torn_points(lod_surface *s)
{
    uint32_t count = s->mesh->vertex_count;
    uint8_t *torn = s->removed; /* borrowed as scratch: not used yet */
    for (uint32_t v = 0; v < count; v++) {
        if (!same_in_all_poses(s, v, s->point_of[v])) {
            torn[s->point_of[v]] = 1;
        }
    }
    for (uint32_t v = 0; v < count; v++) {
        if (torn[s->point_of[v]]) {
            s->locked[v] = 1;
        }
    }
    for (uint32_t v = 0; v < count; v++) {
        if (s->locked[v]) {
            s->point_of[v] = v;
        }
    }
    memset(torn, 0, count);
}

static void note_faces(lod_surface *s)
{
    for (uint32_t t = 0; t < s->mesh->target_count; t++) {
        for (uint32_t v = 0; v < s->mesh->vertex_count; v++) {
            if (lod_set_has(s->poses.moves + (size_t)v * s->poses.words, 1u + t)) {
                s->face[s->point_of[v]] = 1;
            }
        }
    }
}

/* ---- triangles ---- */

static void join_islands(const model_mesh *mesh, uint32_t *parent, uint32_t *island, uint32_t triangle_count)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        parent[v] = v;
    }
    for (uint32_t i = 0; i < triangle_count * 3u; i++) {
        uint32_t a = mesh->indices[i], b = mesh->indices[lod_next(i)];
        while (parent[a] != a) {
            a = parent[a] = parent[parent[a]];
        }
        while (parent[b] != b) {
            b = parent[b] = parent[parent[b]];
        }
        parent[a < b ? b : a] = a < b ? a : b;
    }
    for (uint32_t t = 0; t < triangle_count; t++) {
        uint32_t a = mesh->indices[t * 3u];
        while (parent[a] != a) {
            a = parent[a];
        }
        island[t] = a;
    }
}

/* A triangle that touches one point twice draws nothing and is left out. */
static void hang_corners(lod_surface *s)
{
    memset(s->first, 0xff, s->mesh->vertex_count * sizeof *s->first);
    for (uint32_t t = s->triangle_count; t-- > 0;) {
        uint32_t c = t * 3u, a = lod_point(s, c), b = lod_point(s, c + 1u), d = lod_point(s, c + 2u);
        if (a == b || b == d || d == a) {
            s->dead[t] = 1;
            continue;
        }
        s->live[s->submesh[t]]++;
        for (uint32_t k = 3; k-- > 0;) {
            s->next[c + k] = s->first[lod_point(s, c + k)];
            s->first[lod_point(s, c + k)] = c + k;
            s->part[lod_point(s, c + k)] = s->submesh[t];
        }
    }
}

static float mean_edge(const lod_surface *s)
{
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t c = 0; c < s->triangle_count * 3u; c++) {
        const float *a = lod_posed(&s->poses, lod_point(s, c), 0),
                    *b = lod_posed(&s->poses, lod_point(s, lod_next(c)), 0);
        double d[3] = { (double)b[0] - a[0], (double)b[1] - a[1], (double)b[2] - a[2] };
        if (!s->dead[c / 3u]) {
            sum += sqrt(vec_dot(d, d));
            count++;
        }
    }
    return count ? (float)(sum / count) : 0.0f;
}

static void number_submeshes(lod_surface *s)
{
    for (uint32_t i = 0; i < s->mesh->submesh_count; i++) {
        const model_submesh *sub = &s->mesh->submeshes[i];
        for (uint32_t t = sub->first_index / 3u; t < (sub->first_index + sub->index_count) / 3u; t++) {
            s->submesh[t] = i;
        }
    }
}

static void note_minor_parts(lod_surface *s, uint32_t total)
{
    uint32_t live = 0;
    for (uint32_t i = 0; !total && i < s->mesh->submesh_count; i++) {
        live += s->live[i];
    }
    total = total ? total : live;
    for (uint32_t i = 0; i < s->mesh->submesh_count; i++) {
        s->minor[i] = s->live[i] < total / MINOR_SHARE;
    }
}

/* ---- locked points ---- */

/* Find the edges that are not shared by exactly two triangles running along them in opposite directions. */
static int edge_is_complex(lod_surface *s, const lod_fan *fan, uint32_t neighbour)
{
    int forwards = 0, backwards = 0;
    for (uint32_t i = 0; i < fan->count; i++) {
        forwards += lod_point(s, lod_next(fan->corner[i])) == neighbour;
        backwards += lod_point(s, lod_previous(fan->corner[i])) == neighbour;
    }
    return forwards > 1 || backwards > 1;
}

/* Flat shading splits a point into as many vertices as it has facets. */
static int is_faceted(const lod_surface *s, const lod_fan *fan)
{
    uint32_t vertices[LOD_FAN_MAX], count = 0;
    for (uint32_t i = 0; i < fan->count; i++) {
        uint32_t k = 0;
        while (k < count && vertices[k] != s->corner[fan->corner[i]]) {
            k++;
        }
        if (k == count) {
            vertices[count++] = s->corner[fan->corner[i]];
        }
    }
    return count >= FACETS_LEAST && count * 2u >= fan->count;
}

static void lock_complex_points(lod_surface *s, uint8_t *border)
{
    lod_fan fan;
    for (uint32_t p = 0; p < s->mesh->vertex_count; p++) {
        uint32_t borders = 0;
        if (s->first[p] == LOD_NONE) {
            continue;
        }
        if (lod_fan_gather(s, p, &fan)) {
            s->locked[p] = 1;
            continue;
        }
        for (uint32_t i = 0; i < fan.ring_count; i++) {
            borders += fan.ring_use[i] == 1u;
            s->locked[p] |= (uint8_t)edge_is_complex(s, &fan, fan.ring[i]);
        }
        border[p] = borders > 0;
        s->faceted[p] = (uint8_t)is_faceted(s, &fan);
        s->locked[p] |= borders > 2u; /* two fans meet in this point */
    }
}

static int lock_points(lod_surface *s)
{
    uint8_t *border = calloc(s->mesh->vertex_count + 1u, 1);
    int failed;
    if (!border) {
        return 1;
    }
    lock_complex_points(s, border);
    failed = lod_contacts_make(s) || lod_cards_make(s, border);
    free(border);
    return failed;
}

/* ---- all of it ---- */

static int allocate(lod_surface *s)
{
    size_t vertices = s->mesh->vertex_count + 1u, triangles = s->triangle_count + 1u;
    s->point_of = calloc(vertices, sizeof *s->point_of);
    s->corner = calloc(triangles * 3u, sizeof *s->corner);
    s->first = calloc(vertices, sizeof *s->first);
    s->next = calloc(triangles * 3u, sizeof *s->next);
    s->submesh = calloc(triangles, sizeof *s->submesh);
    s->island = calloc(triangles, sizeof *s->island);
    s->live = calloc(s->mesh->submesh_count + 1u, sizeof *s->live);
    s->dead = calloc(triangles, 1);
    s->locked = calloc(vertices, 1);
    s->removed = calloc(vertices, 1);
    s->face = calloc(vertices, 1);
    s->minor = calloc((size_t)s->mesh->submesh_count + 1u, 1);
    s->part = calloc(vertices, sizeof *s->part);
    s->mark = calloc(vertices, sizeof *s->mark);
    s->faceted = calloc(vertices, 1);
    return !s->point_of || !s->corner || !s->first || !s->next || !s->submesh || !s->island || !s->live || !s->dead ||
           !s->locked || !s->removed || !s->face || !s->minor || !s->part || !s->mark || !s->faceted;
}

int lod_surface_make(const model_mesh *mesh, const lod_options *o, lod_surface *s)
{
    memset(s, 0, sizeof *s);
    s->mesh = mesh;
    s->triangle_count = mesh->index_count / 3u;
    if (allocate(s) || lod_poses_make(mesh, o, &s->poses) || weld_vertices(mesh, s->point_of)) {
        return 1;
    }
    memcpy(s->corner, mesh->indices, (size_t)s->triangle_count * 3u * sizeof *s->corner);
    join_islands(mesh, s->mark, s->island, s->triangle_count);
    memset(s->mark, 0, mesh->vertex_count * sizeof *s->mark);
    split_torn_points(s);
    note_faces(s);
    number_submeshes(s);
    hang_corners(s);
    note_minor_parts(s, o->asset_triangles);
    s->edge = mean_edge(s);
    return lock_points(s) || lod_attributes_make(s, o) || lod_rims_mark(s);
}

void lod_surface_free(lod_surface *s)
{
    lod_poses_free(&s->poses);
    free(s->point_of);
    free(s->corner);
    free(s->first);
    free(s->next);
    free(s->submesh);
    free(s->island);
    free(s->live);
    free(s->dead);
    free(s->locked);
    free(s->removed);
    free(s->face);
    free(s->minor);
    free(s->shows);
    free(s->part);
    free(s->mark);
    free(s->faceted);
    free(s->other);
    free(s->card);
    free(s->cards);
    free(s->attribute);
}

int lod_fan_gather(lod_surface *s, uint32_t point, lod_fan *fan)
{
    uint32_t *link = &s->first[point];
    fan->point = point;
    fan->count = fan->ring_count = 0;
    while (*link != LOD_NONE) {
        uint32_t c = *link, others[2] = { lod_point(s, lod_next(c)), lod_point(s, lod_previous(c)) };
        if (s->dead[c / 3u]) {
            *link = s->next[c]; /* unlink a vanished triangle */
            continue;
        }
        if (fan->count == LOD_FAN_MAX) {
            return 1;
        }
        fan->corner[fan->count++] = c;
        for (uint32_t k = 0; k < 2u; k++) {
            uint32_t i = 0;
            while (i < fan->ring_count && fan->ring[i] != others[k]) {
                i++;
            }
            if (i == fan->ring_count) {
                fan->ring[fan->ring_count] = others[k];
                fan->ring_use[fan->ring_count++] = 0;
            }
            fan->ring_use[i]++;
        }
        link = &s->next[c];
    }
    return fan->count == 0;
}
