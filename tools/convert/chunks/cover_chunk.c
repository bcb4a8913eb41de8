/* cover_chunk.c: what a garment hides of its wearer, and where the wearer comes through it.
 *
 * In the bind pose rays leave each vertex of the wearer: one along its normal, the others around it. Where all meet the
 * garment nearby, no eye outside sees the vertex, and a triangle of three such vertices is hidden. The rest may come
 * through when both move: the point of the garment that the first ray has met is followed through poses of all clips,
 * and the vertex's height above the garment there is how far it comes through. */
#include "chunk_maker.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/light/ray_tree.h"
#include "core/mesh/mesh_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/noh.h"
#include "noh/pack.h"

#define TILT_RAD 0.96f  /* of the rays around a normal */
#define REACH 0.06f     /* share of the wearer's size within which a ray has to meet the garment */
#define POSES 8u        /* of each clip */
#define THROUGH_MM 1.0f /* vertices are counted that come through by more */
#define AROUND 6u

/* A vertex that is under the garment and not hidden, and the point of the garment over it. */
typedef struct pin {
    uint32_t vertex;
    ray_meeting over;
} pin;

typedef struct covered_mesh {
    noh_mesh mesh;
    uint32_t triangle_count, hidden_count, crc, pin_count;
    uint32_t *bits; /* [(triangle_count + 31) / 32] */
    pin *pins;
} covered_mesh;

typedef struct cover {
    char *bytes;
    noh_pack pack; /* the wearer's */
    covered_mesh *meshes;
    uint32_t count;
} cover;

/* The garment. */
typedef struct cloth {
    const model *m;
    ray_tree tree;
    float *triangles;  /* [count][9] */
    uint32_t *corners; /* [count][4] mesh, vertices */
    uint32_t count;
    float reach;
} cloth;

/* ---- under the garment ---- */

static int cloth_make(const model *m, cloth *c)
{
    uint32_t at = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) c->count += m->meshes[i].index_count / 3u;
    c->m = m;
    c->triangles = calloc(c->count + 1u, 9u * sizeof *c->triangles);
    c->corners = calloc(c->count + 1u, 4u * sizeof *c->corners);
    if (!c->triangles || !c->corners) return 1;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t t = 0; t < m->meshes[i].index_count / 3u; t++, at++) {
            c->corners[4u * at] = i;
            for (uint32_t k = 0; k < 3; k++) {
                const uint32_t v = m->meshes[i].indices[3u * t + k];
                c->corners[4u * at + 1u + k] = v;
                memcpy(c->triangles + 9u * at + 3u * k, m->meshes[i].position + 3u * v, 3 * sizeof(float));
            }
        }
    }
    return ray_tree_make(c->triangles, c->count, &c->tree);
}

static void point_of(const float corners[9], const ray_meeting *at, float out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = (1.0f - at->u - at->v) * corners[i] + at->u * corners[3 + i] + at->v * corners[6 + i];
    }
}

static float apart(const float a[3], const float b[3])
{
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static int meets(const cloth *c, const float at[3], const float way[3], float reach, ray_meeting *over)
{
    float point[3];
    if (!ray_tree_nearest(&c->tree, at, way, 1e-4f * reach, over)) return 0;
    point_of(c->triangles + 9u * over->triangle, over, point);
    return apart(at, point) < reach;
}

static void normal_of(const float t[9], float n[3])
{
    float a[3], b[3], length;
    for (int i = 0; i < 3; i++) a[i] = t[3 + i] - t[i], b[i] = t[6 + i] - t[i];
    for (int i = 0; i < 3; i++) n[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3 && length > 0.0f; i++) n[i] /= length;
}

/* 0: not under the garment; 1: under it; 2: hidden by it */
static int covering(const cloth *c, const noh_vertex *v, ray_meeting *over)
{
    const float *n = v->normal;
    const int axis = fabsf(n[0]) < 0.6f ? 0 : 1;
    float side[3], up[3], length = 0.0f;
    if (!meets(c, v->position, n, c->reach, over)) return 0;
    normal_of(c->triangles + 9u * over->triangle, side);
    if (!(side[0] * n[0] + side[1] * n[1] + side[2] * n[2] > 0.0f)) return 0; /* it faces the garment from outside */
    for (int i = 0; i < 3; i++) side[i] = (i == axis ? 1.0f : 0.0f) - n[axis] * n[i];
    for (int i = 0; i < 3; i++) length += side[i] * side[i];
    for (int i = 0; i < 3; i++) side[i] /= sqrtf(length);
    for (int i = 0; i < 3; i++) up[i] = n[(i + 1) % 3] * side[(i + 2) % 3] - n[(i + 2) % 3] * side[(i + 1) % 3];
    for (uint32_t k = 0; k < AROUND; k++) {
        const float turn = 6.2831853f * (float)k / (float)AROUND;
        ray_meeting other;
        float way[3];
        for (int i = 0; i < 3; i++)
            way[i] = cosf(TILT_RAD) * n[i] + sinf(TILT_RAD) * (cosf(turn) * side[i] + sinf(turn) * up[i]);
        if (!meets(c, v->position, way, c->reach / cosf(TILT_RAD), &other)) return 1;
    }
    return 2;
}

/* hidden: [vertex_count] 1: by the garment */
static void mark_triangles(covered_mesh *m, const uint8_t *hidden)
{
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        if (!hidden[noh_mesh_index_of_all(&m->mesh, 3u * t)] || !hidden[noh_mesh_index_of_all(&m->mesh, 3u * t + 1u)] ||
            !hidden[noh_mesh_index_of_all(&m->mesh, 3u * t + 2u)])
            continue;
        m->bits[t / 32u] |= 1u << t % 32u;
        m->hidden_count++;
    }
}

/* Vertices of the finest level with a triangle that is not hidden. */
static void mark_seen(const covered_mesh *m, uint8_t *seen)
{
    for (uint32_t i = 0; i < m->mesh.header->index_count; i++) {
        if (!(m->bits[i / 3u / 32u] >> i / 3u % 32u & 1u)) seen[noh_mesh_index_of_all(&m->mesh, i)] = 1;
    }
}

static int cover_mesh(const cloth *c, covered_mesh *m)
{
    const noh_mesh_header *h = m->mesh.header;
    uint8_t *hidden = calloc(2u, h->vertex_count), *seen = hidden ? hidden + h->vertex_count : NULL;
    uint32_t indices = 0;
    for (uint32_t k = h->level; k < h->level_count; k++) indices += h[k - h->level].index_count;
    m->triangle_count = indices / 3u;
    m->crc = noh_crc32c(0, m->mesh.indices, (size_t)indices * h->index_bytes);
    m->bits = calloc(m->triangle_count / 32u + 1u, sizeof *m->bits);
    m->pins = calloc(h->vertex_count, sizeof *m->pins);
    if (!hidden || !m->bits || !m->pins) {
        free(hidden);
        return 1;
    }
    for (uint32_t v = 0; v < h->vertex_count; v++) {
        noh_vertex vertex;
        int how;
        noh_mesh_vertex(&m->mesh, v, &vertex);
        how = covering(c, &vertex, &m->pins[m->pin_count].over);
        hidden[v] = how == 2;
        m->pins[m->pin_count].vertex = v;
        m->pin_count += how != 0;
    }
    mark_triangles(m, hidden);
    mark_seen(m, seen);
    for (uint32_t i = 0, count = m->pin_count; i < count; i++) { /* what is not drawn cannot come through */
        if (!i) m->pin_count = 0;
        if (seen[m->pins[i].vertex]) m->pins[m->pin_count++] = m->pins[i];
    }
    free(hidden);
    return 0;
}

/* ---- through the garment ---- */

typedef struct poser {
    noh_stage *stage;
    noh_stage_plan plan;
    void *memory;
    noh_actor actor;
    float *joints;     /* [joint_count][12] what moves a point of the bind pose with each joint of the wearer */
    uint8_t *is_known; /* [joint_count] 1: in `joints` */
    float *palette;
    uint32_t joint_count;
} poser;

typedef struct depth {
    float worst;
    uint32_t clip, ticks, node, through;
    float at[3]; /* in the bind pose */
} depth;

static int poser_open(const noh_pack *pack, poser *p, noh_error *error)
{
    static const noh_appearance posed = { .posed = 1 };
    noh_kind_desc kind;
    noh_stage_desc desc;
    memset(p, 0, sizeof *p);
    memset(&kind, 0, sizeof kind);
    memset(&desc, 0, sizeof desc);
    kind.mesh = pack;
    kind.actor_count = 1;
    desc.kinds = &kind;
    desc.kind_count = 1;
    desc.full_detail = 1;
    if (noh_stage_plan_make(&desc, NULL, &p->plan, error)) return 1;
    p->memory = malloc((size_t)p->plan.cpu_bytes);
    p->joint_count = p->plan.kinds[0].joint_count;
    p->joints = calloc(p->joint_count + 1u, 12u * sizeof *p->joints);
    p->is_known = calloc(p->joint_count + 1u, 1);
    p->palette = calloc(NOH_JOINTS_MAX, 12u * sizeof *p->palette);
    if (!p->memory || !p->joints || !p->is_known || !p->palette) return 1;
    return noh_stage_init(p->memory, (size_t)p->plan.cpu_bytes, NULL, &desc, &p->plan, &p->stage, error) ||
           noh_stage_spawn(p->stage, 0, NULL, &p->actor, error) ||
           noh_actor_set_appearance(p->stage, p->actor, &posed, error);
}

static void poser_close(poser *p)
{
    free(p->memory);
    free(p->joints);
    free(p->is_known);
    free(p->palette);
}

/* The joint of the wearer that moves a node of the garment: the nearest of its name or its parents' names. */
static uint32_t joint_of(const cloth *c, const poser *p, uint32_t node)
{
    for (; node != MODEL_NONE; node = c->m->nodes[node].parent) {
        const char *name = c->m->nodes[node].name;
        const uint32_t joint = name ? noh_stage_find(p->stage, 0, NOH_NAME_JOINT, name) : NOH_NONE;
        if (joint != NOH_NONE && p->is_known[joint]) return joint;
    }
    return NOH_NONE;
}

static const model_skin *skin_of(const model *m, uint32_t mesh)
{
    for (uint32_t n = 0; n < m->node_count; n++) {
        if (m->nodes[n].mesh == mesh && m->nodes[n].skin < m->skin_count) return &m->skins[m->nodes[n].skin];
    }
    return NULL;
}

static void move(const float m[12], const float p[3], float weight, float sum[3])
{
    for (int i = 0; i < 3; i++) {
        sum[i] += weight * (m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3]);
    }
}

/* A vertex of the garment as the wearer's joints move it. Returns 0: no joint of the wearer does. */
static int worn_vertex(const cloth *c, const poser *p, uint32_t mesh, uint32_t vertex, float out[3])
{
    const model_mesh *m = &c->m->meshes[mesh];
    const model_skin *skin = skin_of(c->m, mesh);
    memset(out, 0, 3 * sizeof *out);
    if (!skin || !m->joints) return 0;
    for (uint32_t i = 0; i < MODEL_INFLUENCES_MAX; i++) {
        const float weight = m->joint_weights[MODEL_INFLUENCES_MAX * vertex + i];
        uint32_t joint;
        if (!(weight > 0.0f)) continue;
        joint = joint_of(c, p, skin->joints[m->joints[MODEL_INFLUENCES_MAX * vertex + i]]);
        if (joint == NOH_NONE) return 0;
        move(p->joints + 12u * joint, m->position + 3u * vertex, weight, out);
    }
    return 1;
}

static float above(const float corners[9], const ray_meeting *over, const float at[3])
{
    float n[3], point[3];
    normal_of(corners, n);
    point_of(corners, over, point);
    return n[0] * (at[0] - point[0]) + n[1] * (at[1] - point[1]) + n[2] * (at[2] - point[2]);
}

/* How far a vertex is through the garment in a pose. */
static float height_of(const cloth *c, const poser *p, const covered_mesh *m, const pin *at)
{
    const uint32_t *corners = c->corners + 4u * at->over.triangle;
    float worn[9], posed[3];
    for (uint32_t k = 0; k < 3; k++) {
        if (!worn_vertex(c, p, corners[0], corners[1u + k], worn + 3u * k)) return -1.0f;
    }
    noh_skin_position(&m->mesh, p->palette, NULL, at->vertex, posed);
    return above(worn, &at->over, posed);
}

static uint32_t node_of(const cloth *c, const pin *at)
{
    const uint32_t *corners = c->corners + 4u * at->over.triangle;
    const model_skin *skin = skin_of(c->m, corners[0]);
    return skin->joints[c->m->meshes[corners[0]].joints[MODEL_INFLUENCES_MAX * corners[1]]];
}

static void measure_pose(const cloth *c, poser *p, const covered_mesh *m, uint8_t *through, depth *d, uint32_t clip,
                         uint32_t ticks)
{
    for (uint32_t i = 0; i < m->pin_count; i++) {
        const float height = height_of(c, p, m, &m->pins[i]);
        if (height > 0.001f * THROUGH_MM) through[i] = 1;
        if (height <= d->worst) continue;
        d->worst = height;
        d->clip = clip;
        d->ticks = ticks;
        d->node = node_of(c, &m->pins[i]);
        memcpy(d->at, m->mesh.positions + 3u * m->pins[i].vertex, sizeof d->at);
    }
}

/* Take the palette of one mesh of the actor. Returns 0: the mesh is not skinned. */
static int take_palette(poser *p, const noh_pack *pack, const noh_mesh *mesh)
{
    noh_actor_mesh drawn;
    noh_skin skin;
    memset(p->is_known, 0, p->joint_count);
    for (uint32_t i = 0; noh_actor_mesh_at(p->stage, p->actor, i, &drawn, NULL, NULL) == NOH_OK; i++) {
        noh_mesh own;
        (void)noh_pack_mesh_at(pack, drawn.mesh, &own, NULL);
        if (own.header != mesh->header || noh_pack_skin_at(pack, own.header->skin, &skin, NULL)) continue;
        (void)noh_actor_mesh_at(p->stage, p->actor, i, &drawn, p->palette, NULL);
        for (uint32_t k = 0; k < drawn.joint_count; k++) {
            memcpy(p->joints + 12u * skin.joints[k], p->palette + 12u * k, 12 * sizeof(float));
            p->is_known[skin.joints[k]] = 1;
        }
        return 1;
    }
    return 0;
}

static int measure_clips(const cloth *c, const cover *worn, const covered_mesh *m, depth *d, noh_error *error)
{
    uint8_t *through = calloc(m->pin_count + 1u, 1);
    const noh_clip_set *set;
    const char *name;
    poser p;
    int failed = !through || poser_open(&worn->pack, &p, error);
    for (uint32_t clip = 0; !failed && (name = noh_stage_name(p.stage, 0, NOH_NAME_CLIP, clip)) != NULL; clip++) {
        (void)noh_actor_controller(p.stage, p.actor, &set);
        for (uint32_t k = 0; k < POSES && !failed; k++) {
            const uint32_t ticks = (uint32_t)((uint64_t)set->clips[clip].duration_ticks * k / POSES);
            const noh_play play = { .fade_ticks = 1, .start_ticks = ticks, .weight = 1.0f };
            failed = noh_actor_play(p.stage, p.actor, 0, name, &play, error) ||
                     noh_stage_frame(p.stage, 2, NULL, NULL, NULL, error);
            if (!failed && take_palette(&p, &worn->pack, &m->mesh)) measure_pose(c, &p, m, through, d, clip, ticks);
        }
    }
    for (uint32_t i = 0; through && i < m->pin_count; i++) d->through += through[i];
    if (through) poser_close(&p);
    free(through);
    return failed;
}

static void report_mesh(FILE *out, const cloth *c, const cover *worn, const covered_mesh *m, const depth *d)
{
    noh_pack_clip clip;
    fprintf(out, "'%s' is worn over '%s': it hides %u of %u triangles\n", c->m->meshes[0].name, m->mesh.name,
            m->hidden_count, m->triangle_count);
    if (d->worst > 0.0f && noh_pack_clip_at(&worn->pack, d->clip, &clip, NULL) == NOH_OK) {
        fprintf(out,
                "  the rest comes through by %.1f mm at most: in clip '%s' at %.2f s, by joint '%s', from (%.3f %.3f "
                "%.3f); %u of %u vertices by more than %g mm\n",
                1000.0 * (double)d->worst, clip.name, (double)d->ticks / NOH_TICKS_PER_SECOND,
                c->m->nodes[d->node].name, (double)d->at[0], (double)d->at[1], (double)d->at[2], d->through,
                m->pin_count, (double)THROUGH_MM);
    } else if (m->pin_count) {
        fprintf(out, "  no vertex of the rest comes through\n");
    }
}

/* ---- the chunk ---- */

static float size_of(const noh_mesh *m)
{
    return apart(m->header->bounds_min, m->header->bounds_max);
}

static int cover_all(const convert_options *options, const cloth *c, cover *worn, convert_failure *failure)
{
    noh_error error = { NOH_ERR_MEMORY, "out of memory", 0, 0 };
    for (uint32_t i = 0; i < worn->count; i++) {
        covered_mesh *m = &worn->meshes[i];
        depth d;
        if (cover_mesh(c, m)) return model_fail_memory(&failure->error);
        if (!options->report || !m->pin_count) continue;
        memset(&d, 0, sizeof d);
        if (measure_clips(c, worn, m, &d, &error)) return model_fail(&failure->error, "", "%s", error.what);
        report_mesh(options->report, c, worn, m, &d);
    }
    return 0;
}

static int open_wearer(const char *path, cover *worn, cloth *c, convert_failure *failure)
{
    noh_error error;
    size_t bytes;
    worn->bytes = input_read(path, &bytes, &failure->error);
    if (!worn->bytes) return 1;
    if (noh_pack_open(worn->bytes, bytes, &worn->pack, &error)) {
        return model_fail(&failure->error, "", "%s: --wear takes the pack of the wearer", error.what);
    }
    worn->meshes = calloc(worn->pack.runs[NOH_CHUNK_MESH].count + 1u, sizeof *worn->meshes);
    if (!worn->meshes) return model_fail_memory(&failure->error);
    for (uint32_t i = 0; i < worn->pack.runs[NOH_CHUNK_MESH].count; i++) {
        covered_mesh *m = &worn->meshes[worn->count];
        if (noh_pack_mesh_at(&worn->pack, i, &m->mesh, NULL) || m->mesh.header->skin == NOH_NONE) continue;
        if (REACH * size_of(&m->mesh) > c->reach) c->reach = REACH * size_of(&m->mesh);
        worn->count++;
    }
    return worn->count ? 0 : model_fail(&failure->error, "", "no mesh of the wearer has joints");
}

static int read_cover(const convert_options *options, const source *s, void **made, convert_failure *failure)
{
    cover *worn;
    cloth c;
    int failed;
    if (!options->texts[NOH_CHUNK_COVER] || options->only == CONVERT_CLIPS) return 0;
    failure->file = options->texts[NOH_CHUNK_COVER];
    *made = worn = calloc(1, sizeof *worn);
    if (!worn) return model_fail_memory(&failure->error);
    memset(&c, 0, sizeof c);
    failed = open_wearer(failure->file, worn, &c, failure);
    if (!failed && cloth_make(s->m, &c)) failed = model_fail_memory(&failure->error);
    failed = failed || cover_all(options, &c, worn, failure);
    ray_tree_free(&c.tree);
    free(c.triangles);
    free(c.corners);
    return failed;
}

static void write_cover(pack_writer *w, const void *made)
{
    const cover *worn = made;
    for (uint32_t i = 0; worn && i < worn->count; i++) {
        const covered_mesh *m = &worn->meshes[i];
        noh_pack_cover_header h;
        if (!m->hidden_count) continue;
        memset(&h, 0, sizeof h);
        chunk_begin(w, NOH_CHUNK_COVER, m->mesh.name);
        chunk_name(w, m->mesh.name, &h.mesh, &h.mesh_hash);
        h.triangle_count = m->triangle_count;
        h.indices_crc = m->crc;
        h.hidden_count = m->hidden_count;
        h.bits_offset = sizeof h;
        buffer_append(&w->out, &h, sizeof h);
        buffer_append(&w->out, m->bits, (m->triangle_count + 31u) / 32u * sizeof *m->bits);
        chunk_end(w);
    }
}

static void free_cover(void *made)
{
    cover *worn = made;
    for (uint32_t i = 0; worn && i < worn->count; i++) {
        free(worn->meshes[i].bits);
        free(worn->meshes[i].pins);
    }
    if (worn) free(worn->meshes);
    if (worn) free(worn->bytes);
    free(worn);
}

const chunk_maker chunk_cover = { read_cover, 0, free_cover, write_cover, NULL };
