#include "moved_vertices.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- vertices ---- */

static int grow(moved_vertices *v, uint32_t vertices, uint32_t holds)
{
    uint32_t *first = realloc(v->first, ((size_t)v->vertex_count + vertices + 1u) * sizeof *first);
    vertex_hold *all;
    if (!first) return 1;
    v->first = first;
    all = realloc(v->holds, ((size_t)v->hold_count + (size_t)vertices * holds + 1u) * sizeof *all);
    if (!all) return 1;
    v->holds = all;
    return 0;
}

static void transform(const double *m, const float *p, float *out)
{
    for (int r = 0; r < 3; r++) {
        out[r] = (float)(m[r] * (double)p[0] + m[3 + r] * (double)p[1] + m[6 + r] * (double)p[2] + m[9 + r]);
    }
}

static void bind_columns(const float *bind, double *out)
{
    for (int i = 0; i < 12; i++) {
        out[i] = (double)bind[i / 3 * 4 + i % 3];
    }
}

int moved_vertices_add(moved_vertices *v, const model_mesh *mesh, const model_skin *skin, const uint32_t *joints)
{
    if (grow(v, mesh->vertex_count, mesh->influence_max)) return 1;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        v->first[v->vertex_count++] = v->hold_count;
        for (uint32_t k = 0; k < mesh->influence_max; k++) {
            const size_t at = (size_t)i * MODEL_INFLUENCES_MAX + k;
            vertex_hold *h = &v->holds[v->hold_count];
            double place[12];
            if (!(mesh->joint_weights[at] > 0.0f)) break; /* zeros are last */
            bind_columns(skin->inverse_bind + 16u * (size_t)mesh->joints[at], place);
            h->joint = joints[mesh->joints[at]];
            h->weight = mesh->joint_weights[at];
            transform(place, mesh->position + 3u * (size_t)i, h->place);
            v->hold_count++;
        }
    }
    return 0;
}

int moved_vertices_add_rigid(moved_vertices *v, const model_mesh *mesh, uint32_t joint, const double *place)
{
    if (grow(v, mesh->vertex_count, 1)) return 1;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        vertex_hold *h = &v->holds[v->hold_count];
        v->first[v->vertex_count++] = v->hold_count++;
        h->joint = joint;
        h->weight = 1.0f;
        transform(place, mesh->position + 3u * (size_t)i, h->place);
    }
    return 0;
}

int moved_vertices_add_bound(moved_vertices *v, const model *m, uint32_t set)
{
    for (uint32_t i = 0; m && i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        const model_skin *skin = mesh->bound && mesh->joints ? &m->skins[mesh->skin] : NULL;
        if (skin && skin->skeleton_joints && skin->set == set &&
            moved_vertices_add(v, mesh, skin, skin->skeleton_joints)) {
            return 1;
        }
    }
    return 0;
}

static void raise_box(float *box, const float *p)
{
    for (int k = 0; k < 3; k++) {
        box[k] = fminf(box[k], p[k]);
        box[3 + k] = fmaxf(box[3 + k], p[k]);
    }
}

int moved_vertices_close(moved_vertices *v, uint32_t joint_count)
{
    v->joint_count = joint_count;
    v->boxes = malloc((joint_count + 1u) * sizeof *v->boxes);
    if (!v->boxes || grow(v, 0, 0)) return 1;
    v->first[v->vertex_count] = v->hold_count;
    for (uint32_t j = 0; j < joint_count; j++) {
        for (int k = 0; k < 6; k++) v->boxes[j][k] = k < 3 ? FLT_MAX : -FLT_MAX;
    }
    for (uint32_t i = 0; i < v->hold_count; i++) raise_box(v->boxes[v->holds[i].joint], v->holds[i].place);
    return 0;
}

void moved_vertices_free(moved_vertices *v)
{
    free(v->first);
    free(v->holds);
    free(v->boxes);
    memset(v, 0, sizeof *v);
}

/* ---- distances ---- */

static void difference(const double *a, const double *b, const float *p, double *out)
{
    for (int r = 0; r < 3; r++) {
        out[r] = (a[r] - b[r]) * (double)p[0] + (a[3 + r] - b[3 + r]) * (double)p[1] +
                 (a[6 + r] - b[6 + r]) * (double)p[2] + (a[9 + r] - b[9 + r]);
    }
}

static double square(const double *d)
{
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

/* What a joint holds lies in its box, and a box moves most at a corner. */
static double corner_apart(const double *a, const double *b, const float *box)
{
    double worst = 0.0;
    for (int corner = 0; corner < 8; corner++) {
        const float p[3] = { box[corner & 1 ? 3 : 0], box[corner & 2 ? 4 : 1], box[corner & 4 ? 5 : 2] };
        double d[3];
        difference(a, b, p, d);
        worst = fmax(worst, square(d));
    }
    return sqrt(worst);
}

double moved_vertices_apart(const moved_vertices *v, const double *a, const double *b, double floor, double *scratch)
{
    double worst = floor, most = 0.0;
    for (uint32_t j = 0; j < v->joint_count; j++) {
        const int holds = v->boxes[j][0] <= v->boxes[j][3];
        scratch[j] = holds ? corner_apart(a + 12u * (size_t)j, b + 12u * (size_t)j, v->boxes[j]) : 0.0;
        most = fmax(most, scratch[j]);
    }
    for (uint32_t i = 0; most > worst && i < v->vertex_count; i++) {
        double bound = 0.0, sum[3] = { 0.0, 0.0, 0.0 };
        for (uint32_t h = v->first[i]; h < v->first[i + 1u]; h++) {
            bound += (double)v->holds[h].weight * scratch[v->holds[h].joint];
        }
        if (bound <= worst) continue;
        for (uint32_t h = v->first[i]; h < v->first[i + 1u]; h++) {
            const size_t at = 12u * (size_t)v->holds[h].joint;
            double d[3];
            difference(a + at, b + at, v->holds[h].place, d);
            for (int k = 0; k < 3; k++) sum[k] += (double)v->holds[h].weight * d[k];
        }
        worst = fmax(worst, sqrt(square(sum)));
    }
    return worst;
}

void moved_vertices_reach(const moved_vertices *v, const raw_skeleton *skeleton, const double *pose, int own,
                          double *out)
{
    for (uint32_t i = 0; i < v->hold_count; i++) {
        const vertex_hold *h = &v->holds[i];
        float point[3];
        if (h->weight < MOVED_WEIGHT_LEAST) continue;
        transform(pose + 12u * (size_t)h->joint, h->place, point);
        for (uint32_t j = h->joint; j != MODEL_NONE; j = own ? MODEL_NONE : skeleton->joints[j].parent) {
            const double *at = pose + 12u * (size_t)j + 9;
            const double way[3] = { (double)point[0] - at[0], (double)point[1] - at[1], (double)point[2] - at[2] };
            out[j] = fmax(out[j], sqrt(square(way)) * skeleton->unit_cm);
        }
    }
}
