#include "transfer_make.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/light.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/pack.h"
#include "transfer_fit.h"

/* A vertex that is darker than this in the bind pose takes the form of its lobe from the target that opens it most: a
 * tooth behind closed lips. */
#define DARK 0.02f

typedef struct maker {
    light_surface surface;
    const light_rays *rays;
    const transfer_settings *settings;
    uint8_t *blocked;   /* [rays->count] */
    uint8_t *still;     /* [vertex_count] of transfer_mark_still */
    float *normals;     /* [vertex_count][3] in the bind pose */
    float *direct;      /* [vertex_count][NOH_SH_COUNT_MAX] in the bind pose, without reflections */
    float *transfers;   /* [vertex_count][NOH_SH_COUNT_MAX] that the lobes are of */
    float *occlusion;   /* [vertex_count] in the bind pose */
    float *brightest;   /* [vertex_count] of the transfers */
    float *targets;     /* [texel_count][NOH_SH_COUNT_MAX] with one target each at weight 1 */
    float *turned;      /* [texel_count][3] the normals then */
    uint32_t *vertices; /* [touched_count] a vertex of each accumulation texel */
    float *weights;     /* [target_count] */
} maker;

static int open(maker *k, const noh_pack *pack, uint32_t mesh, model_error *error)
{
    size_t vertices, texels;
    if (light_surface_open(pack, mesh, &k->surface, error)) {
        return 1;
    }
    vertices = k->surface.mesh.header->vertex_count;
    texels = k->surface.mesh.header->texel_count;
    k->blocked = model_zeros(k->rays->count, 1);
    k->still = model_zeros(vertices, 1);
    k->normals = model_zeros(vertices, 3u * sizeof(float));
    k->direct = model_zeros(vertices, NOH_SH_COUNT_MAX * sizeof(float));
    k->transfers = model_zeros(vertices, NOH_SH_COUNT_MAX * sizeof(float));
    k->occlusion = model_zeros(vertices, sizeof(float));
    k->brightest = model_zeros(vertices, sizeof(float));
    k->targets = model_zeros(texels, NOH_SH_COUNT_MAX * sizeof(float));
    k->turned = model_zeros(texels, 3u * sizeof(float));
    k->vertices = model_zeros(k->surface.mesh.header->touched_count, sizeof(uint32_t));
    k->weights = model_zeros(k->surface.mesh.header->target_count, sizeof(float));
    if (k->vertices) memset(k->vertices, 0xff, k->surface.mesh.header->touched_count * sizeof(uint32_t));
    return k->blocked && k->still && k->normals && k->direct && k->transfers && k->occlusion && k->brightest &&
                   k->targets && k->turned && k->vertices && k->weights
               ? 0
               : model_fail(error, k->surface.mesh.name, "out of memory");
}

static void close(maker *k)
{
    light_surface_close(&k->surface);
    free(k->blocked);
    free(k->still);
    free(k->normals);
    free(k->direct);
    free(k->transfers);
    free(k->occlusion);
    free(k->brightest);
    free(k->targets);
    free(k->turned);
    free(k->vertices);
    free(k->weights);
}

/* The integral of a transfer: white light from everywhere. */
static float integral(const float *transfer)
{
    return transfer[0] * 3.5449077f; /* sqrt(4 pi) */
}

/* One reflection, at the rays in `blocked`; the reflecting surface is lit as in the bind pose. */
static void add_bounce(maker *k, uint32_t vertex, float *transfer)
{
    if (k->settings->bounce) {
        light_rays_bounce(k->rays, &k->surface, vertex, k->blocked, (float)k->settings->bounce / 255.0f, k->direct,
                          NOH_SH_COUNT_MAX, transfer);
    }
}

static void measure_bind_pose(maker *k)
{
    const uint32_t count = k->surface.mesh.header->vertex_count;
    memcpy(k->normals, k->surface.normal, 3u * sizeof(float) * (size_t)count);
    for (uint32_t v = 0; v < count; v++) {
        light_rays_transfer(k->rays, &k->surface, v, k->blocked, k->direct + NOH_SH_COUNT_MAX * (size_t)v);
    }
    memcpy(k->transfers, k->direct, NOH_SH_COUNT_MAX * sizeof(float) * (size_t)count);
    for (uint32_t v = count; v-- > 0;) {
        float *transfer = k->transfers + NOH_SH_COUNT_MAX * (size_t)v;
        const uint32_t texel = noh_mesh_accumulation_texel(&k->surface.mesh, v);
        if (k->settings->bounce) light_rays_blocked(k->rays, &k->surface, v, k->blocked);
        add_bounce(k, v, transfer);
        k->occlusion[v] = k->brightest[v] = integral(transfer);
        if (texel < k->surface.mesh.header->touched_count) {
            k->vertices[texel] = v;
        }
    }
}

/* Turn a direction by the smallest rotation from one normal to another. */
static void turn(const float from[3], const float to[3], float direction[3])
{
    noh_lobe lobe;
    memcpy(lobe.axis, direction, sizeof lobe.axis);
    noh_lobe_turn(&lobe, from, to);
    memcpy(direction, lobe.axis, sizeof lobe.axis);
}

/* The delta texels of a target, in their order: the vertex of each, or NOH_NONE past the last accumulation texel. */
typedef struct texel_walk {
    const maker *k;
    uint32_t rect, end, x, y, texel;
} texel_walk;

static texel_walk walk_target(const maker *k, uint32_t target)
{
    const noh_target *t = &k->surface.mesh.targets[target];
    const texel_walk w = { k, t->first_rect, t->first_rect + t->rect_count, 0, 0, t->first_texel };
    return w;
}

static int next_texel(texel_walk *w, uint32_t *texel, uint32_t *vertex)
{
    const noh_mesh *mesh = &w->k->surface.mesh;
    const noh_rect *r;
    uint32_t place;
    if (w->rect == w->end) {
        return 0;
    }
    r = &mesh->rects[w->rect];
    place = ((uint32_t)(r->y + w->y) << mesh->header->morph_width_log2) + r->x + w->x;
    *vertex = place < mesh->header->touched_count ? w->k->vertices[place] : NOH_NONE;
    *texel = w->texel++;
    w->x = w->x + 1u < r->w ? w->x + 1u : 0u;
    w->y += w->x == 0;
    if (w->y == r->h) {
        w->y = 0;
        w->rect++;
    }
    return 1;
}

/* Whether the target moves the vertex at its delta texel: the library sums differences of those alone. */
static int moves(const maker *k, uint32_t texel)
{
    const uint32_t *words = k->surface.mesh.texels + 3u * (size_t)texel;
    return (words[0] | words[1] | words[2]) != 0;
}

/* The transfers of the vertices that a target moves, with it alone at weight 1; of dark ones all in its rectangles. */
static int measure_target(maker *k, uint32_t target, model_error *error)
{
    texel_walk w = walk_target(k, target);
    uint32_t texel, v;
    int failed;
    k->weights[target] = 1.0f;
    failed = light_surface_pose(&k->surface, k->weights, error);
    k->weights[target] = 0.0f;
    while (!failed && next_texel(&w, &texel, &v)) {
        float *transfer = k->targets + NOH_SH_COUNT_MAX * (size_t)texel;
        if (v == NOH_NONE || !(moves(k, texel) || k->occlusion[v] < DARK)) {
            continue;
        }
        light_rays_transfer(k->rays, &k->surface, v, k->blocked, transfer);
        add_bounce(k, v, transfer);
        memcpy(k->turned + 3u * (size_t)texel, k->surface.normal + 3u * (size_t)v, 3u * sizeof(float));
        if (k->occlusion[v] < DARK && integral(transfer) > k->brightest[v]) {
            k->brightest[v] = integral(transfer);
        }
    }
    return failed;
}

/* Where a dark vertex is brightest: the form of that transfer's lobe, about the axis turned back. */
static void take_brightest(maker *k, uint32_t target)
{
    texel_walk w = walk_target(k, target);
    uint32_t texel, v;
    while (next_texel(&w, &texel, &v)) {
        const float *transfer = k->targets + NOH_SH_COUNT_MAX * (size_t)texel;
        if (v != NOH_NONE && k->occlusion[v] < DARK && k->brightest[v] > k->occlusion[v] &&
            integral(transfer) == k->brightest[v]) {
            float *own = k->transfers + NOH_SH_COUNT_MAX * (size_t)v, axis[3], back[3];
            noh_lobe lobe;
            transfer_axis(transfer, k->turned + 3u * (size_t)texel, axis);
            transfer_lobe(transfer, axis, &lobe);
            memcpy(back, axis, sizeof back);
            turn(k->turned + 3u * (size_t)texel, k->normals + 3u * (size_t)v, back);
            noh_sh_basis(NOH_SH_ORDER_MAX, back, own);
            noh_sh_convolve(NOH_SH_ORDER_MAX, lobe.shape, own);
        }
    }
}

/* ---- what no target moves, and yet comes into sight ---- */

#define SEEN 0.5f /* of the occlusion of the brightest vertex: what is in front of the lids */

void transfer_mark_still(const noh_mesh *mesh, uint32_t material, uint32_t surface, uint8_t value, uint8_t *mark)
{
    if (mesh->pack->materials[material].surface != surface) return;
    for (uint32_t k = mesh->header->level_first; k < mesh->header->level_count; k++) {
        const noh_mesh level = noh_mesh_at_lod(mesh, k);
        for (uint32_t s = 0; s < level.header->submesh_count; s++) {
            const noh_submesh *part = &level.submeshes[s];
            for (uint32_t i = 0; part->material == material && i < part->index_count; i++) {
                const uint32_t v = noh_mesh_index(&level, part->first_index + i);
                if (noh_mesh_accumulation_texel(mesh, v) >= mesh->header->touched_count) mark[v] = value;
            }
        }
    }
}

/* The mean lobe about the normals of the eyes' vertices that are brighter than `least`, without vertices of coarse levels
 * alone, whose light is another vertex's. Returns their number. */
static uint32_t mean_lobe(const maker *k, float least, noh_lobe *mean)
{
    uint32_t count = 0;
    memset(mean, 0, sizeof *mean);
    for (uint32_t v = 0; v < k->surface.mesh.header->vertex_count; v++) {
        noh_lobe lobe;
        if (!k->still[v] || k->surface.stand_in[v] != v || !(k->occlusion[v] > least)) continue;
        transfer_lobe(k->transfers + NOH_SH_COUNT_MAX * (size_t)v, k->normals + 3u * (size_t)v, &lobe);
        for (uint32_t band = 0; band < NOH_SH_ORDER_MAX; band++) mean->shape[band] += lobe.shape[band];
        mean->occlusion += k->occlusion[v];
        count++;
    }
    for (uint32_t band = 0; count && band < NOH_SH_ORDER_MAX; band++) mean->shape[band] /= (float)count;
    if (count) mean->occlusion /= (float)count;
    return count;
}

/* Eyeballs that no target moves follow joints: all their vertices take the light of those that are seen at rest. */
static void even_out_eyes(maker *k)
{
    const uint32_t count = k->surface.mesh.header->vertex_count;
    for (uint32_t i = 0; i < k->surface.mesh.pack->material_count; i++) {
        float brightest = 0.0f;
        noh_lobe mean;
        memset(k->still, 0, count);
        transfer_mark_still(&k->surface.mesh, i, NOH_SURFACE_EYE, 1, k->still);
        for (uint32_t v = 0; v < count; v++) {
            if (k->still[v] && k->surface.stand_in[v] == v) brightest = fmaxf(brightest, k->occlusion[v]);
        }
        if (!(brightest > 0.0f) || !mean_lobe(k, SEEN * brightest, &mean)) continue;
        for (uint32_t v = 0; v < count; v++) {
            float *own = k->transfers + NOH_SH_COUNT_MAX * (size_t)v;
            if (!k->still[v]) continue;
            noh_sh_basis(NOH_SH_ORDER_MAX, k->normals + 3u * (size_t)v, own);
            noh_sh_convolve(NOH_SH_ORDER_MAX, mean.shape, own);
            k->occlusion[v] = mean.occlusion;
        }
    }
}

/* The target that opens the lips most; NOH_NONE: none does. */
static uint32_t opening_target(const noh_mesh *mesh)
{
    uint32_t opening = NOH_NONE;
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        if (mesh->targets[t].lips > (opening == NOH_NONE ? 0 : mesh->targets[opening].lips)) opening = t;
    }
    return opening;
}

/* Teeth that no target moves have no differences of occlusion: they take the light of the surface's pose, in which the
 * lips are open. Behind closed lips, shaders darken them by their depth. */
static void open_teeth(maker *k)
{
    const noh_mesh *mesh = &k->surface.mesh;
    memset(k->still, 0, mesh->header->vertex_count);
    for (uint32_t i = 0; i < mesh->pack->material_count; i++) {
        transfer_mark_still(mesh, i, NOH_SURFACE_TEETH, 1, k->still);
    }
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        float transfer[NOH_SH_COUNT_MAX];
        if (!k->still[v]) continue;
        light_rays_transfer(k->rays, &k->surface, v, k->blocked, transfer);
        add_bounce(k, v, transfer);
        if (!(integral(transfer) > k->occlusion[v])) continue;
        memcpy(k->transfers + NOH_SH_COUNT_MAX * (size_t)v, transfer, sizeof transfer);
        k->occlusion[v] = integral(transfer);
    }
}

static void make_records(const maker *k, transfer_data *out)
{
    const transfer_settings *s = k->settings;
    for (uint32_t v = 0; v < k->surface.mesh.header->vertex_count; v++) {
        const float *transfer = k->transfers + NOH_SH_COUNT_MAX * (size_t)v, *normal = k->normals + 3u * (size_t)v;
        uint8_t *record = out->records + (size_t)v * NOH_TRANSFER_RECORD_BYTES(s->order, s->flags);
        const float occlusion = k->occlusion[v];
        float axis[3];
        memcpy(axis, normal, sizeof axis);
        if (!(s->flags & NOH_TRANSFER_ON_NORMAL)) {
            transfer_axis(transfer, normal, axis);
        }
        transfer_record(transfer, axis, s->order, s->flags, record);
        record[0] = (uint8_t)roundf(255.0f * (occlusion < 0.0f ? 0.0f : occlusion > 1.0f ? 1.0f : occlusion));
    }
}

/* The differences of occlusion from the records, in whole steps of the target's own scale. */
static void make_deltas(const maker *k, uint32_t target, float *differences, transfer_data *out)
{
    const noh_target *t = &k->surface.mesh.targets[target];
    const uint32_t stride = NOH_TRANSFER_RECORD_BYTES(k->settings->order, k->settings->flags);
    texel_walk w = walk_target(k, target);
    uint32_t texel, v;
    float largest = 0.0f;
    memset(differences, 0, t->texel_count * sizeof *differences);
    while (next_texel(&w, &texel, &v)) {
        float *difference = &differences[texel - t->first_texel];
        if (v != NOH_NONE && moves(k, texel)) {
            *difference = integral(k->targets + NOH_SH_COUNT_MAX * (size_t)texel) -
                          (float)out->records[(size_t)v * stride] / 255.0f;
        }
        largest = fabsf(*difference) > largest ? fabsf(*difference) : largest;
    }
    out->scales[target] = largest / 127.0f;
    for (uint32_t i = 0; i < t->texel_count && largest > 0.0f; i++) {
        out->deltas[t->first_texel + i] = (int8_t)roundf(127.0f * differences[i] / largest);
    }
}

static int make_all_deltas(const maker *k, transfer_data *out, model_error *error)
{
    const noh_mesh_header *h = k->surface.mesh.header;
    float *differences = model_zeros(h->texel_count, sizeof *differences);
    for (uint32_t t = 0; differences && t < h->target_count; t++) {
        make_deltas(k, t, differences, out);
    }
    free(differences);
    return differences ? 0 : model_fail(error, k->surface.mesh.name, "out of memory");
}

static void say(const maker *k, uint32_t target)
{
    if (k->settings->progress) {
        fprintf(k->settings->progress, "\r\033[Klight of '%s', target %u of %u ", k->surface.mesh.name, target + 1u,
                k->surface.mesh.header->target_count);
        fflush(k->settings->progress);
    }
}

static int make(maker *k, transfer_data *out, model_error *error)
{
    const uint32_t target_count = k->surface.mesh.header->target_count, opening = opening_target(&k->surface.mesh);
    int failed = 0;
    measure_bind_pose(k);
    for (uint32_t t = 0; t < target_count && !failed; t++) {
        say(k, t);
        failed = measure_target(k, t, error);
        if (!failed && t == opening) open_teeth(k);
    }
    for (uint32_t t = 0; t < target_count && !failed; t++) {
        take_brightest(k, t);
    }
    if (!failed) {
        even_out_eyes(k);
        make_records(k, out);
        failed = make_all_deltas(k, out, error);
    }
    return failed;
}

int transfer_make(const noh_pack *pack, uint32_t mesh, const light_rays *rays, const transfer_settings *settings,
                  transfer_data *out, model_error *error)
{
    maker k;
    int failed;
    memset(&k, 0, sizeof k);
    memset(out, 0, sizeof *out);
    k.rays = rays;
    k.settings = settings;
    failed = open(&k, pack, mesh, error);
    if (!failed) {
        const noh_mesh_header *h = k.surface.mesh.header;
        out->records = model_zeros(h->vertex_count, NOH_TRANSFER_RECORD_BYTES(settings->order, settings->flags));
        out->scales = model_zeros(h->target_count, sizeof *out->scales);
        out->deltas = model_zeros(h->texel_count, 1);
        failed = out->records && out->scales && out->deltas ? make(&k, out, error)
                                                            : model_fail(error, k.surface.mesh.name, "out of memory");
    }
    close(&k);
    return failed;
}

void transfer_data_free(transfer_data *d)
{
    free(d->records);
    free(d->scales);
    free(d->deltas);
    memset(d, 0, sizeof *d);
}
