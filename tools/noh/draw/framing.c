#include "framing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/low_core.h"

#define DIRECTIONS 26u

/* A vertex, and the joint of its skin that moves it. */
typedef struct outline_point {
    float at[3];
    uint32_t joint;
} outline_point;

typedef struct outline {
    outline_point *points;
    uint32_t count;
} outline;

struct framing {
    figure figure; /* must not move */
    outline *meshes;
    uint32_t mesh_count; /* of all kinds, one after another */
    float *matrices;     /* of the largest palette */
};

/* ---- the outline of a mesh ---- */

/* The n-th of 26: every vector of -1, 0 and 1 but 0, of unit length. */
static void direction(uint32_t n, float d[3])
{
    const uint32_t at = n < 13u ? n : n + 1u, digits[3] = { at % 3u, at / 3u % 3u, at / 9u };
    const float x[3] = { (float)digits[0] - 1.0f, (float)digits[1] - 1.0f, (float)digits[2] - 1.0f };
    const float length = sqrtf(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int c = 0; c < 3; c++) d[c] = x[c] / length;
}

/* Keep a vertex that lies farther out than a joint's present one. farthest[joint][direction]: vertex + 1 */
static void keep_farthest(const noh_mesh *mesh, uint32_t *farthest, uint32_t vertex, uint32_t joint)
{
    const float *p = mesh->positions + 3u * (size_t)vertex;
    for (uint32_t n = 0; n < DIRECTIONS; n++) {
        uint32_t *kept = &farthest[joint * DIRECTIONS + n];
        const float *q = *kept ? mesh->positions + 3u * (size_t)(*kept - 1u) : p;
        float d[3];
        direction(n, d);
        if (!*kept || d[0] * (p[0] - q[0]) + d[1] * (p[1] - q[1]) + d[2] * (p[2] - q[2]) > 0.0f) *kept = vertex + 1u;
    }
}

static int make_outline(outline *o, const noh_mesh *mesh, uint32_t joint_count)
{
    const uint32_t joints = joint_count ? joint_count : 1u;
    uint32_t *farthest = calloc((size_t)joints * DIRECTIONS, sizeof *farthest);
    o->points = malloc(sizeof *o->points * joints * DIRECTIONS);
    o->count = 0;
    for (uint32_t v = 0; farthest && o->points && v < mesh->header->vertex_count; v++) {
        uint32_t moved_by[NOH_INFLUENCES_MAX] = { 0 };
        float weights[NOH_INFLUENCES_MAX];
        if (joint_count) (void)noh_mesh_influences(mesh, v, moved_by, weights);
        keep_farthest(mesh, farthest, v, moved_by[0]);
    }
    for (uint32_t i = 0; farthest && o->points && i < joints * DIRECTIONS; i++) {
        outline_point *p = &o->points[o->count];
        if (!farthest[i]) continue;
        memcpy(p->at, mesh->positions + 3u * (size_t)(farthest[i] - 1u), sizeof p->at);
        p->joint = i / DIRECTIONS;
        o->count++;
    }
    free(farthest);
    return o->points ? 0 : tool_fail("figure", "out of memory");
}

/* ---- opening ---- */

static int make_outlines(framing *f)
{
    uint32_t most = 0, n = 0;
    int status = figure_pose(&f->figure);
    for (uint32_t k = 0; k < f->figure.stage_desc.kind_count; k++) f->mesh_count += f->figure.plan.kinds[k].mesh_count;
    f->meshes = calloc(f->mesh_count + 1u, sizeof *f->meshes);
    if (!f->meshes) return tool_fail("figure", "out of memory");
    for (uint32_t k = 0; k < f->figure.stage_desc.kind_count && !status; k++) {
        for (uint32_t i = 0; i < f->figure.plan.kinds[k].mesh_count && !status; i++) {
            noh_actor_mesh shown;
            noh_mesh mesh;
            if (noh_actor_mesh_at(f->figure.stage, f->figure.actors[k], i, &shown, NULL, NULL)) continue;
            (void)noh_pack_mesh_at(f->figure.kinds[k].mesh, shown.mesh, &mesh, NULL);
            mesh = noh_mesh_at_lod(&mesh, NOH_LOD_LEVELS_MAX);
            status = make_outline(&f->meshes[n++], &mesh, shown.joint_count);
            most = shown.joint_count > most ? shown.joint_count : most;
        }
    }
    f->mesh_count = n;
    f->matrices = malloc((most + 1u) * 12u * sizeof *f->matrices);
    return status || f->matrices ? status : tool_fail("figure", "out of memory");
}

framing *framing_open(const figure_desc *desc)
{
    framing *f = calloc(1, sizeof *f);
    const figure_desc d = {
        .file = desc->file, .clips = desc->clips, .level = desc->level, .by_error = desc->by_error, .without_springs = 1
    };
    int status = f ? figure_open(&f->figure, &d, NULL) : tool_fail("figure", "out of memory");
    if (!status) status = make_outlines(f);
    if (!status) return f;
    framing_close(f);
    return NULL;
}

void framing_close(framing *f)
{
    if (!f) return;
    for (uint32_t i = 0; i < f->mesh_count; i++) free(f->meshes[i].points);
    free(f->meshes);
    free(f->matrices);
    if (f->figure.stage) figure_close(&f->figure);
    free(f);
}

/* ---- a clip ---- */

static void transform(const float m[12], const float p[3], float out[3])
{
    for (int r = 0; r < 3; r++) out[r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
}

/* Grow the box by the outline as posed, relative to the anchor. */
static void grow(framing *f, bounds *box)
{
    double anchor[3];
    uint32_t n = 0;
    figure_anchor(&f->figure, anchor);
    for (uint32_t k = 0; k < f->figure.stage_desc.kind_count; k++) {
        noh_actor_mesh shown;
        for (uint32_t i = 0;
             noh_actor_mesh_at(f->figure.stage, f->figure.actors[k], i, &shown, f->matrices, NULL) == NOH_OK;
             i++, n++) {
            for (uint32_t p = 0; p < f->meshes[n].count; p++) {
                const outline_point *point = &f->meshes[n].points[p];
                float moved[3], placed[3];
                memcpy(moved, point->at, sizeof moved);
                if (shown.joint_count) transform(f->matrices + 12u * (size_t)point->joint, point->at, moved);
                transform(shown.world, moved, placed);
                for (int c = 0; c < 3; c++) {
                    box->low[c] = fmin(box->low[c], (double)placed[c] - anchor[c]);
                    box->high[c] = fmax(box->high[c], (double)placed[c] - anchor[c]);
                }
            }
        }
    }
}

int framing_clip(framing *f, const char *clip, bounds *box)
{
    const noh_play play = { .loop = NOH_LOOP_ONCE };
    double seconds = 0.0;
    uint32_t steps, ticks;
    int moves = 0;
    *box = (bounds){ { INFINITY, INFINITY, INFINITY }, { -INFINITY, -INFINITY, -INFINITY } };
    for (uint32_t k = 0; k < f->figure.stage_desc.kind_count; k++) {
        const noh_clip_entry *entry = figure_clip(&f->figure, k, clip);
        if (!entry) continue;
        moves |= !(entry->flags & NOH_CLIP_FLOATS_ONLY);
        seconds = fmax(seconds, (double)entry->duration_ticks / (double)NOH_TICKS_PER_SECOND);
    }
    if (!moves || !f->mesh_count || figure_reset(&f->figure) || figure_play(&f->figure, clip, &play)) return 0;
    steps = (uint32_t)fmin(ceil(seconds * FRAMING_RATE_HZ), 3600.0);
    ticks = (uint32_t)noh_ticks_from_seconds(seconds / (steps ? steps : 1u));
    for (uint32_t s = 0; s <= steps; s++) {
        (void)noh_stage_step(f->figure.stage, s ? ticks : 1u, NULL, NULL, NULL);
        if (figure_pose(&f->figure)) return 0;
        grow(f, box);
    }
    return box->low[0] <= box->high[0];
}

/* ---- the camera ---- */

double orbit_sees(const figure *f, const noh_gl_camera *camera)
{
    const float *m = camera->view_projection;
    uint64_t all = 0, seen = 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        for (uint32_t i = 0; i < f->plan.kinds[k].mesh_count; i++) {
            noh_mesh mesh;
            noh_actor_mesh shown;
            noh_vertex *vertices = figure_deform(f, k, i, NOH_LOD_LEVELS_MAX, &mesh, &shown);
            for (uint32_t v = 0; vertices && v < mesh.header->vertex_count; v++, all++) {
                float p[3], x, y, w;
                transform(shown.world, vertices[v].position, p);
                x = m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12];
                y = m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13];
                w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
                seen += w > 0.0f && fabsf(x) <= w && fabsf(y) <= w;
            }
            free(vertices);
        }
    }
    return all ? (double)seen / (double)all : 1.0;
}
