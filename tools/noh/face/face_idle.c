#include "face_idle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "draw/figure.h"
#include "noh/deform.h"
#include "noh/face.h"

#define PICTURE_PX 512.0
#define MOVES_PX 0.02
#define OF_REGION 0.3 /* of the farthest that its targets move a vertex */
#define LINKS_MAX 4096u
#define OUTLINES 8
#define TURN 6.28318530717958648

const char *const face_region_names[FACE_REGIONS] = { "outline", "brows", "lids", "eyes", "mouth" };

static const struct {
    uint32_t first, count;
} channels[FACE_REGIONS] = {
    { 0, 0 },
    { NOH_CHANNEL_BROWS, 1 },
    { NOH_CHANNEL_BLINK_LEFT, 2 },
    { NOH_CHANNEL_EYES, 8 },
    { NOH_CHANNEL_VISEMES + NOH_VISEME_AA, 1 },
};

/* A mesh of the figure. */
typedef struct part {
    uint32_t kind, index;
    uint8_t *regions; /* [vertex_count] a bit for each */
    double *before;   /* [vertex_count][3] */
} part;

typedef struct meter {
    figure f;
    part parts[NOH_STAGE_KINDS_MAX * NOH_STAGE_MESHES_MAX];
    uint32_t part_count;
    noh_face_link links[LINKS_MAX];
    bounds face;              /* what the picture frames */
    double ways[OUTLINES][2]; /* directions in the picture */
    double outline[OUTLINES]; /* how far it reaches in each */
    double least;             /* motion that counts, model units */
} meter;

/* The vertices that the targets of a region move. */
static int mark_region(meter *m, part *p, const noh_mesh *mesh, uint32_t region)
{
    const uint32_t count = mesh->header->target_count, first = channels[region].first;
    const noh_face_recipe own = noh_face_recipe_in_pack(mesh->pack);
    const noh_face_recipe *const recipes[] = { &own, &noh_face_recipe_arkit, &noh_face_recipe_vrm,
                                               &noh_face_recipe_units };
    const char **names = calloc(count + 1u, sizeof *names);
    float *weights = calloc(count + 1u, sizeof *weights);
    double *moved = calloc(mesh->header->vertex_count + 1u, sizeof *moved), most = 0.0;
    void *memory = malloc(noh_morph_layers_size(mesh) + 16u);
    noh_morph_layers layers;
    uint32_t links, used = 0;
    for (uint32_t t = 0; names && t < count; t++) names[t] = noh_pack_string(mesh->pack, mesh->targets[t].name);
    if (!names || !weights || !moved || !memory) {
        free(names), free(weights), free(moved), free(memory);
        return 1;
    }
    links = noh_face_recipe_bind(recipes, 4, names, count, m->links, LINKS_MAX);
    for (uint32_t i = 0; i < links && i < LINKS_MAX; i++) {
        if (m->links[i].channel - first >= channels[region].count) continue;
        weights[m->links[i].target] = 1.0f;
        used++;
    }
    noh_morph_layers_init(memory, noh_morph_layers_size(mesh) + 16u, mesh, &layers, NULL);
    if (used) noh_morph_accumulate(mesh, weights, &layers);
    for (uint32_t v = 0; used && v < mesh->header->vertex_count; v++) {
        const float *rest = mesh->positions + 3u * (size_t)v;
        noh_vertex now;
        noh_morph_vertex(mesh, &layers, v, &now);
        for (int c = 0; c < 3; c++) moved[v] += pow((double)now.position[c] - (double)rest[c], 2.0);
        most = fmax(most, moved[v]);
    }
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        if (most > 0.0 && moved[v] >= OF_REGION * OF_REGION * most) p->regions[v] |= (uint8_t)(1u << region);
    }
    free(names), free(weights), free(moved), free(memory);
    return 0;
}

static int add_part(meter *m, uint32_t kind, uint32_t index, face_idle *out)
{
    part *p = &m->parts[m->part_count];
    noh_mesh mesh;
    noh_actor_mesh shown;
    noh_vertex *vertices = figure_deform(&m->f, kind, index, NOH_LOD_LEVELS_MAX, &mesh, &shown);
    int failed = !vertices;
    if (failed) return 1;
    p->kind = kind;
    p->index = index;
    p->regions = calloc(mesh.header->vertex_count + 1u, 1);
    p->before = calloc(3u * (size_t)mesh.header->vertex_count + 1u, sizeof *p->before);
    m->part_count++;
    failed = !p->regions || !p->before;
    for (uint32_t region = FACE_BROWS; region < FACE_REGIONS && !failed; region++) {
        failed = mark_region(m, p, &mesh, region);
        for (uint32_t v = 0; v < mesh.header->vertex_count && !failed; v++) {
            out->is_there[region] |= p->regions[v] >> region & 1;
        }
    }
    free(vertices);
    return failed;
}

static int is_in(const bounds *b, const double p[3])
{
    return p[0] >= b->low[0] && p[0] <= b->high[0] && p[1] >= b->low[1] && p[1] <= b->high[1];
}

/* Compare a mesh with the picture before. Returns the regions that moved. */
static uint32_t compare_part(meter *m, part *p, double *outline, int first)
{
    noh_mesh mesh;
    noh_actor_mesh shown;
    noh_vertex *vertices = figure_deform(&m->f, p->kind, p->index, NOH_LOD_LEVELS_MAX, &mesh, &shown);
    uint32_t moved = 0;
    for (uint32_t v = 0; vertices && v < mesh.header->vertex_count; v++) {
        double *before = p->before + 3u * (size_t)v, now[3], way = 0.0;
        for (int r = 0; r < 3; r++) {
            const float *row = shown.world + 4 * r, *at = vertices[v].position;
            now[r] = (double)row[0] * at[0] + (double)row[1] * at[1] + (double)row[2] * at[2] + (double)row[3];
            way = r < 2 ? fmax(way, fabs(now[r] - before[r])) : way;
        }
        if (first && is_in(&m->face, now)) p->regions[v] |= 1u << FACE_OUTLINE;
        memcpy(before, now, sizeof now);
        for (int d = 0; d < OUTLINES && p->regions[v] >> FACE_OUTLINE & 1u; d++) {
            outline[d] = fmax(outline[d], now[0] * m->ways[d][0] + now[1] * m->ways[d][1]);
        }
        if (way >= m->least) moved |= p->regions[v];
    }
    free(vertices);
    return moved & ~(1u << FACE_OUTLINE);
}

static void compare(meter *m, int first, face_idle *out)
{
    double now[OUTLINES];
    uint32_t moved = 0;
    for (int d = 0; d < OUTLINES; d++) now[d] = -INFINITY;
    for (uint32_t i = 0; i < m->part_count; i++) moved |= compare_part(m, &m->parts[i], now, first);
    for (int d = 0; d < OUTLINES; d++) {
        if (fabs(now[d] - m->outline[d]) >= m->least) moved |= 1u << FACE_OUTLINE;
    }
    for (uint32_t r = 0; r < FACE_REGIONS && !first; r++) out->still[r] += !(moved >> r & 1u);
    out->pairs += !first;
    memcpy(m->outline, now, sizeof now);
}

static int measure(meter *m, double seconds, face_idle *out)
{
    int status = figure_live(&m->f, 1.0 / FACE_IDLE_RATE, 0.0);
    for (uint32_t k = 0; k < m->f.stage_desc.kind_count && !status; k++) {
        for (uint32_t i = 0; i < m->f.plan.kinds[k].mesh_count && !status; i++) {
            status = add_part(m, k, i, out) ? tool_fail(m->f.desc.file->path, "out of memory") : 0;
        }
    }
    for (int d = 0; d < OUTLINES; d++) {
        m->ways[d][0] = cos(d * (TURN / OUTLINES));
        m->ways[d][1] = sin(d * (TURN / OUTLINES));
    }
    m->face = figure_bounds(&m->f, FRAME_FACE);
    m->least = (m->face.high[1] - m->face.low[1]) * (MOVES_PX / PICTURE_PX);
    for (uint32_t i = 0; i <= (uint32_t)(seconds * FACE_IDLE_RATE) && !status; i++) {
        if (i) status = figure_live(&m->f, 1.0 / FACE_IDLE_RATE, 0.0);
        if (!status) compare(m, !i, out);
    }
    return status;
}

static int play(meter *m, const face_idle_desc *desc)
{
    const int status = figure_feel(&m->f, desc->feels);
    return status ? status : figure_play_options(&m->f, desc->clips, 0.0);
}

int face_idle_measure(const face_idle_desc *desc, face_idle *out)
{
    figure_anims *anims = calloc(1, sizeof *anims);
    meter *m = calloc(1, sizeof *m);
    figure_desc made = { .file = desc->file, .alive = 1, .face_layer = 1 };
    const char *path = desc->file->path;
    int opened = 0, status = m && anims ? 0 : tool_fail(path, "out of memory");
    memset(out, 0, sizeof *out);
    out->is_there[FACE_OUTLINE] = 1;
    if (!status && desc->clips->count) status = figure_open_anims(anims, desc->anims, desc->file, &made);
    if (!status) status = figure_open(&m->f, &made, NULL);
    opened = !status;
    if (!status && !m->f.faces_found) status = tool_fail(path, "no eyes were found, so it has no live face");
    if (!status) status = play(m, desc);
    if (!status) status = measure(m, desc->seconds, out);
    if (opened) figure_close(&m->f);
    if (anims) figure_close_anims(anims);
    for (uint32_t i = 0; m && i < m->part_count; i++) {
        free(m->parts[i].regions);
        free(m->parts[i].before);
    }
    free(m);
    free(anims);
    return status;
}
