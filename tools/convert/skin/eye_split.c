#include "eye_split.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/affine.h"
#include "convert/model/islands.h"
#include "convert/model/model_build.h"

#define VERTICES_MIN 24u
#define RESIDUAL_MAX 0.1 /* a cornea that bulges is within it */
#define CANDIDATES_MAX 64u

typedef struct candidate {
    uint32_t island; /* its first vertex */
    eye_sphere sphere;
} candidate;

typedef struct split {
    const model_mesh *mesh;
    mesh_islands islands; /* room: the vertices of one eye */
    double size;          /* the diagonal of the mesh's bounds */
    candidate found[CANDIDATES_MAX];
    uint32_t count;
} split;

/* ---- a sphere ---- */

static double coordinate(const float *positions, uint32_t vertex, int c)
{
    return (double)positions[3 * (size_t)vertex + (size_t)c];
}

/* Gauss with pivots: a is [4][5]. */
static int solve(double a[4][5], double x[4])
{
    for (int i = 0; i < 4; i++) {
        int best = i;
        for (int r = i + 1; r < 4; r++) best = fabs(a[r][i]) > fabs(a[best][i]) ? r : best;
        if (fabs(a[best][i]) < 1e-9) return 1;
        for (int c = 0; c < 5; c++) {
            const double swap = a[i][c];
            a[i][c] = a[best][c];
            a[best][c] = swap;
        }
        for (int r = 0; r < 4; r++) {
            const double by = r == i ? 0.0 : a[r][i] / a[i][i];
            for (int c = i; c < 5; c++) a[r][c] -= by * a[i][c];
        }
    }
    for (int i = 0; i < 4; i++) x[i] = a[i][4] / a[i][i];
    return 0;
}

/* About their mean, and as shares of their spread, so that the equations are well conditioned. */
int eye_sphere_fit(const float *positions, const uint32_t *vertices, uint32_t count, eye_sphere *out)
{
    double mean[3] = { 0 }, spread = 0.0, a[4][5] = { { 0 } }, x[4], square = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) mean[c] += coordinate(positions, vertices[i], c) / count;
    }
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) spread += pow(coordinate(positions, vertices[i], c) - mean[c], 2.0) / count;
    }
    spread = sqrt(spread);
    if (!(spread > 0.0)) return 1;
    for (uint32_t i = 0; i < count; i++) {
        double row[5] = { 0, 0, 0, 1.0, 0 };
        for (int c = 0; c < 3; c++) {
            const double p = (coordinate(positions, vertices[i], c) - mean[c]) / spread;
            row[c] = 2.0 * p;
            row[4] += p * p;
        }
        for (int r = 0; r < 4; r++) {
            for (int c = 0; c < 5; c++) a[r][c] += row[r] * row[c] / count;
        }
    }
    if (solve(a, x)) return 1;
    out->radius = sqrt(x[3] + x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) * spread;
    if (!(out->radius > 0.0)) return 1;
    for (int c = 0; c < 3; c++) out->centre[c] = mean[c] + x[c] * spread;
    for (uint32_t i = 0; i < count; i++) {
        double way = 0.0;
        for (int c = 0; c < 3; c++) way += pow(coordinate(positions, vertices[i], c) - out->centre[c], 2.0);
        square += pow(sqrt(way) - out->radius, 2.0) / count;
    }
    out->residual = sqrt(square) / out->radius;
    return 0;
}

#define BALL_VERTICES_MIN 24u
#define BALL_RESIDUAL_MAX 0.1
#define TRIMS_MAX 4
#define TRIMMED 1.5 /* residuals inside the sphere */

/* Bring the vertices that are not far inside to the front. Returns their count. */
static uint32_t trim(const float *positions, uint32_t *vertices, uint32_t count, const eye_sphere *s)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t v = vertices[i];
        double way = 0.0;
        for (int c = 0; c < 3; c++) way += pow(coordinate(positions, v, c) - s->centre[c], 2.0);
        if (1.0 - sqrt(way) / s->radius > TRIMMED * s->residual) continue;
        vertices[i] = vertices[kept];
        vertices[kept++] = v;
    }
    return kept;
}

int eye_ball_fit(const float *positions, uint32_t *vertices, uint32_t count, eye_sphere *out)
{
    uint32_t kept = count;
    for (int i = 0; i < TRIMS_MAX && kept >= BALL_VERTICES_MIN && 2u * kept > count; i++) {
        if (eye_sphere_fit(positions, vertices, kept, out)) return 1;
        if (out->residual <= BALL_RESIDUAL_MAX) return 0;
        kept = trim(positions, vertices, kept, out);
    }
    return 1;
}

/* ---- eyes ---- */

/* A ball, or its front: as wide and high as a sphere, and deep enough that it is no dish. */
static int is_ball(const split *s, uint32_t count, const eye_sphere *sphere)
{
    double low[3], high[3];
    uint32_t wide = 0;
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            const double x = coordinate(s->mesh->position, s->islands.room[i], c);
            low[c] = !i || x < low[c] ? x : low[c];
            high[c] = !i || x > high[c] ? x : high[c];
        }
    }
    for (int c = 0; c < 3; c++) {
        if (high[c] - low[c] < 0.6 * sphere->radius) return 0;
        wide += high[c] - low[c] > 1.6 * sphere->radius;
    }
    return wide >= 2 && sphere->residual <= RESIDUAL_MAX && sphere->radius > 0.003 * s->size &&
           sphere->radius < 0.2 * s->size;
}

static void find_balls(split *s)
{
    float low[3] = { 0 }, high[3] = { 0 };
    s->count = 0;
    for (size_t i = 0; i < (size_t)s->mesh->vertex_count * 3; i++) {
        const float x = s->mesh->position[i];
        low[i % 3] = i < 3 || x < low[i % 3] ? x : low[i % 3];
        high[i % 3] = i < 3 || x > high[i % 3] ? x : high[i % 3];
    }
    s->size = sqrt(pow((double)high[0] - (double)low[0], 2.0) + pow((double)high[1] - (double)low[1], 2.0) +
                   pow((double)high[2] - (double)low[2], 2.0));
    for (uint32_t v = 0; v < s->mesh->vertex_count && s->count < CANDIDATES_MAX; v++) {
        candidate *found = &s->found[s->count];
        uint32_t count;
        if (s->islands.first[v] != v) continue;
        count = islands_list(s->islands.next, v, s->mesh->vertex_count, s->islands.room);
        if (count < VERTICES_MIN || eye_sphere_fit(s->mesh->position, s->islands.room, count, &found->sphere)) continue;
        found->island = v;
        s->count += is_ball(s, count, &found->sphere) != 0;
    }
}

static double apart(const eye_sphere *a, const eye_sphere *b)
{
    double square = 0.0;
    for (int c = 0; c < 3; c++) square += pow(a->centre[c] - b->centre[c], 2.0);
    return sqrt(square);
}

int eye_spheres_pair(const eye_sphere *a, const eye_sphere *b)
{
    const double way = apart(a, b);
    return fabs(a->radius - b->radius) < 0.1 * a->radius && way > 2.0 * a->radius && way < 10.0 * a->radius &&
           fabs(a->centre[1] - b->centre[1]) < 0.1 * way && fabs(a->centre[2] - b->centre[2]) < 0.1 * way;
}

/* The pair, left first; how many different pairs there are. Layers of one eye make one pair. */
static uint32_t find_pair(const split *s, const candidate *pair[2])
{
    uint32_t pairs = 0;
    for (uint32_t a = 0; a < s->count; a++) {
        for (uint32_t b = a + 1; b < s->count; b++) {
            const eye_sphere *x = &s->found[a].sphere, *y = &s->found[b].sphere;
            const int swap = x->centre[0] < y->centre[0];
            if (!eye_spheres_pair(x, y)) continue;
            if (pairs && (apart(&pair[0]->sphere, swap ? y : x) > 0.5 * x->radius ||
                          apart(&pair[1]->sphere, swap ? x : y) > 0.5 * x->radius)) {
                return 2;
            }
            if (!pairs || pair[0]->sphere.residual > x->residual) {
                pair[0] = &s->found[swap ? b : a];
                pair[1] = &s->found[swap ? a : b];
            }
            pairs = 1;
        }
    }
    return pairs;
}

/* eye[vertex]: 1 left, 2 right, 0 neither. What is concentric goes along. */
static void mark_eyes(split *s, const candidate *const pair[2], uint8_t *eye)
{
    for (uint32_t v = 0; v < s->mesh->vertex_count; v++) {
        for (uint32_t e = 0; e < 2; e++) {
            const eye_sphere *ball = &pair[e]->sphere;
            for (uint32_t i = 0; i < s->count; i++) {
                const int concentric = apart(&s->found[i].sphere, ball) < 0.5 * ball->radius &&
                                       s->found[i].sphere.radius < 1.5 * ball->radius;
                if (s->islands.first[v] == s->found[i].island && concentric) eye[v] = (uint8_t)(e + 1);
            }
        }
    }
}

/* ---- joints ---- */

static uint32_t add_node(model *m, const char *name, uint32_t parent)
{
    model_node *grown = realloc(m->nodes, ((size_t)m->node_count + 1) * sizeof *grown), *node;
    if (!grown) return MODEL_NONE;
    m->nodes = grown;
    node = &grown[m->node_count];
    memset(node, 0, sizeof *node);
    node->name = model_string(name);
    if (!node->name) return MODEL_NONE;
    node->parent = parent;
    node->mesh = node->skin = MODEL_NONE;
    node->rotation[3] = node->scale[0] = node->scale[1] = node->scale[2] = 1.0f;
    affine_identity(node->world);
    return m->node_count++;
}

/* A joint of a skin; its place, MODEL_NONE when out of memory. */
static uint32_t add_joint(model_skin *skin, uint32_t node, const float inverse_bind[16])
{
    uint32_t *joints = realloc(skin->joints, ((size_t)skin->joint_count + 1) * sizeof *joints);
    float *binds;
    if (!joints) return MODEL_NONE;
    skin->joints = joints;
    binds = realloc(skin->inverse_bind, ((size_t)skin->joint_count + 1) * 16 * sizeof *binds);
    if (!binds) return MODEL_NONE;
    skin->inverse_bind = binds;
    joints[skin->joint_count] = node;
    memcpy(binds + 16 * (size_t)skin->joint_count, inverse_bind, 16 * sizeof *binds);
    return skin->joint_count++;
}

/* Below a joint, at a point of the mesh; bind: the inverse bind matrix of that joint. */
static uint32_t add_eye(model *m, model_skin *skin, const char *name, uint32_t parent, const float bind[16],
                        const double centre[3])
{
    const uint32_t node = add_node(m, name, parent);
    float own[16];
    double local[16];
    if (node == MODEL_NONE) return MODEL_NONE;
    memcpy(own, bind, sizeof own);
    affine_identity(local);
    for (int c = 0; c < 3; c++) {
        const double at = (double)bind[c] * centre[0] + (double)bind[4 + c] * centre[1] +
                          (double)bind[8 + c] * centre[2] + (double)bind[12 + c];
        m->nodes[node].translation[c] = (float)at;
        own[12 + c] = (float)((double)bind[12 + c] - at);
        local[12 + c] = at;
    }
    affine_multiply(m->nodes[parent].world, local, m->nodes[node].world);
    return add_joint(skin, node, own);
}

/* A skin of one joint that stands where the mesh's node stood, for a mesh that had none. */
static int add_skin(model *m, model_mesh *mesh, uint32_t node)
{
    static const float identity[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    model_skin *grown = realloc(m->skins, ((size_t)m->skin_count + 1) * sizeof *grown);
    const size_t slots = (size_t)mesh->vertex_count * MODEL_INFLUENCES_MAX;
    uint32_t face;
    if (!grown) return 1;
    m->skins = grown;
    memset(&grown[m->skin_count], 0, sizeof *grown);
    m->skin_count++;
    face = add_node(m, "Face", m->nodes[node].parent);
    free(mesh->joints); /* a file may have them without a skin */
    free(mesh->joint_weights);
    mesh->joints = model_zeros(slots, sizeof *mesh->joints);
    mesh->joint_weights = model_zeros(slots, sizeof *mesh->joint_weights);
    grown[m->skin_count - 1].name = model_string("face");
    if (face == MODEL_NONE || !mesh->joints || !mesh->joint_weights || !grown[m->skin_count - 1].name) return 1;
    memcpy(m->nodes[face].translation, m->nodes[node].translation, sizeof m->nodes[face].translation);
    memcpy(m->nodes[face].rotation, m->nodes[node].rotation, sizeof m->nodes[face].rotation);
    memcpy(m->nodes[face].scale, m->nodes[node].scale, sizeof m->nodes[face].scale);
    memcpy(m->nodes[face].world, m->nodes[node].world, sizeof m->nodes[face].world);
    for (size_t v = 0; v < mesh->vertex_count; v++) mesh->joint_weights[v * MODEL_INFLUENCES_MAX] = 1.0f;
    mesh->influence_max = mesh->joint_limit = 1;
    m->nodes[node].skin = m->skin_count - 1;
    return add_joint(&grown[m->skin_count - 1], face, identity) == MODEL_NONE;
}

/* The one node that draws a mesh; MODEL_NONE: none, or several. */
static uint32_t node_of(const model *m, uint32_t mesh)
{
    uint32_t found = MODEL_NONE, count = 0;
    for (uint32_t n = 0; n < m->node_count; n++) {
        if (m->nodes[n].mesh != mesh) continue;
        found = n;
        count++;
    }
    return count == 1 ? found : MODEL_NONE;
}

static int is_animated(const model *m, uint32_t node)
{
    for (uint32_t c = 0; c < m->clip_count; c++) {
        for (uint32_t i = 0; i < m->clips[c].channel_count; i++) {
            const model_channel *channel = &m->clips[c].channels[i];
            if (channel->node == node && channel->path != MODEL_PATH_WEIGHTS) return 1;
        }
    }
    return 0;
}

/* The place of the joint that moves all vertices of both eyes; MODEL_NONE: several do. */
static uint32_t mover_of(const model_mesh *mesh, const uint8_t *eye)
{
    uint32_t place = MODEL_NONE;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        const uint16_t *joints = mesh->joints + v * MODEL_INFLUENCES_MAX;
        if (!eye[v]) continue;
        if (mesh->joint_weights[v * MODEL_INFLUENCES_MAX] < 0.99f) return MODEL_NONE;
        if (place != MODEL_NONE && place != joints[0]) return MODEL_NONE;
        place = joints[0];
    }
    return place;
}

static int bind_eyes(model *m, model_mesh *mesh, model_skin *skin, const candidate *const pair[2], const uint8_t *eye,
                     model_error *error)
{
    static const char *const names[2] = { "LeftEye", "RightEye" };
    const uint32_t mover = mover_of(mesh, eye);
    uint32_t places[2];
    float bind[16];
    if (mover == MODEL_NONE || mover >= skin->joint_count) {
        return model_fail(error, mesh->name, "--eyes: more than one joint moves the eyes: bind them to the head alone");
    }
    memcpy(bind, skin->inverse_bind + 16 * (size_t)mover, sizeof bind);
    for (uint32_t e = 0; e < 2; e++) {
        places[e] = add_eye(m, skin, names[e], skin->joints[mover], bind, pair[e]->sphere.centre);
        if (places[e] == MODEL_NONE) return model_fail(error, mesh->name, "out of memory");
    }
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        if (!eye[v]) continue;
        memset(mesh->joints + v * MODEL_INFLUENCES_MAX, 0, MODEL_INFLUENCES_MAX * sizeof *mesh->joints);
        memset(mesh->joint_weights + v * MODEL_INFLUENCES_MAX, 0, MODEL_INFLUENCES_MAX * sizeof *mesh->joint_weights);
        mesh->joints[v * MODEL_INFLUENCES_MAX] = (uint16_t)places[eye[v] - 1];
        mesh->joint_weights[v * MODEL_INFLUENCES_MAX] = 1.0f;
    }
    mesh->joint_limit = places[1] + 1 > mesh->joint_limit ? places[1] + 1 : mesh->joint_limit;
    return 0;
}

static int split_mesh(model *m, uint32_t index, const candidate *const pair[2], const uint8_t *eye, model_error *error)
{
    model_mesh *mesh = &m->meshes[index];
    const uint32_t node = node_of(m, index);
    if (node == MODEL_NONE) {
        return model_fail(error, mesh->name, "--eyes: the mesh with the eyes is drawn by several nodes, or by none");
    }
    for (uint32_t n = 0; n < m->node_count; n++) {
        if (m->nodes[n].name &&
            (strcmp(m->nodes[n].name, "LeftEye") == 0 || strcmp(m->nodes[n].name, "RightEye") == 0)) {
            return model_fail(error, mesh->name, "--eyes: a node '%s' already exists", m->nodes[n].name);
        }
    }
    if (m->nodes[node].skin == MODEL_NONE) {
        if (is_animated(m, node)) {
            return model_fail(error, mesh->name, "--eyes: the mesh has no skin, and an animation moves its node");
        }
        if (add_skin(m, mesh, node)) return model_fail(error, mesh->name, "out of memory");
    }
    if (!mesh->joints)
        return model_fail(error, mesh->name, "--eyes: the mesh has a skin but no joints in its vertices");
    if (bind_eyes(m, mesh, &m->skins[m->nodes[node].skin], pair, eye, error)) return 1;
    return 0;
}

static void report_eyes(FILE *report, const model_mesh *mesh, const candidate *const pair[2])
{
    for (uint32_t e = 0; e < 2 && report; e++) {
        const eye_sphere *s = &pair[e]->sphere;
        fprintf(
            report, "mesh '%s': %s eye, a sphere of radius %.4f at %.4f %.4f %.4f; vertices are off by %.1f %% of it\n",
            mesh->name, e ? "right" : "left", s->radius, s->centre[0], s->centre[1], s->centre[2], 100.0 * s->residual);
    }
}

/* 1 done, 0 no eyes here, -1 failed. */
static int try_mesh(model *m, uint32_t index, split *s, FILE *report, model_error *error)
{
    const candidate *pair[2] = { NULL, NULL };
    uint8_t *eye;
    uint32_t pairs;
    int failed;
    s->mesh = &m->meshes[index];
    find_balls(s);
    pairs = find_pair(s, pair);
    if (!pairs) return 0;
    if (pairs > 1) {
        (void)model_fail(error, s->mesh->name, "--eyes: more than two spheres could be eyes");
        return -1;
    }
    eye = model_zeros(s->mesh->vertex_count, 1);
    if (!eye) return model_fail(error, s->mesh->name, "out of memory") ? -1 : 0;
    mark_eyes(s, pair, eye);
    failed = split_mesh(m, index, pair, eye, error);
    if (!failed) report_eyes(report, s->mesh, pair);
    free(eye);
    return failed ? -1 : 1;
}

int eyes_split(model *m, FILE *report, model_error *error)
{
    split *s = calloc(1, sizeof *s);
    int done = 0;
    for (uint32_t i = 0; s && i < m->mesh_count && !done; i++) {
        done = islands_open(&m->meshes[i], &s->islands) ? (model_fail_memory(error), -1)
                                                        : try_mesh(m, i, s, report, error);
        islands_close(&s->islands);
    }
    if (!s) return model_fail_memory(error);
    free(s);
    if (!done) {
        return model_fail(error, "",
                          "--eyes: no mesh has two spheres side by side, each in one piece and separate from the rest");
    }
    return done < 0;
}
