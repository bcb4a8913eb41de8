/* gl_morph_cost.c: a cost model of paths on a GPU, for `auto`.
 *
 * The unit is one texel blended into three layers of RGBA32F. All terms are of one instance of each mesh in a frame:
 * its update, with the expected share of its targets active, and what its draws add for it.
 *   mrt     its texels; a quad costs as much as 4 of them, or on a software rasteriser, which shades whole blocks, all
 *           16 of each block instead; twice all that if the layers do not fit a known tile memory; a third of it
 *           for halves, which GPUs blend at a higher rate; the clear
 *   gather  16 texels of each block at a factor, and 0.3 for each texel written once; the upload
 *   both    a pass, shared by all instances of an update, and a fetch of each moved vertex in each draw
 *   direct  in each draw, a turn for each moved vertex and active target of its block, and its start; the upload
 *   cpu     pairs and vertices, and the upload: sums, or finished vertices
 * The factors for software, and for one GPU, an NVIDIA H100, were measured (runtime/deform/LOG.md); for other GPUs,
 * tilers above all, they are estimates: a game that knows better pins the path (desc.path). A turn of direct on a GPU
 * was not measured: it is taken for a turn of a loop over active targets, which fetches as often. Tilers shade
 * positions and varyings apart: by Mesa's model of a Mali-G52, 8.5 cycles where a turn of gather takes 2.5. */
#include <string.h>

#include "gl/morph/gl_morph_internal.h"
#include "gl/device/gl_quirks_internal.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"

#define QUAD_TEXELS 4.0f     /* a quad's vertices and setup */
#define GATHER_SOFTWARE 0.9f /* a texel that gather reads and adds */
#define GATHER_GPU 0.3f
#define HALF_BLEND_GPU 0.35f /* a blended texel of halves */
#define WRITE 0.3f           /* a texel written once */
#define FETCH_SOFTWARE 1.5f  /* the layers of a vertex, fetched by a draw */
#define FETCH_GPU 0.3f
#define TURN_SOFTWARE 1.35f /* an entry of direct, added to a vertex */
#define TURN_GPU 0.36f
#define TURN_TILER 1.0f
#define START_SOFTWARE 4.5f /* the start of a vertex's list */
#define START_GPU 0.36f
#define PASS_GPU 13000.0f    /* 18 us */
#define UPLOADED_BYTES 32.0f /* that cost as much as one texel; estimated */
#define CPU_PAIR 0.17f       /* 1.4 ns; a blended texel takes 8 ns on the same processor */
#define CPU_VERTEX 0.12f     /* 1 ns, to write to the texture */

/* Bytes per pixel that fit a GPU's tile memory at full tile size; 0: no tile memory, or unknown. */
static uint32_t tile_bytes(const char *renderer)
{
    static const noh_quirk sizes[] = { NOH_QUIRK_TILE_16, NOH_QUIRK_TILE_32, NOH_QUIRK_TILE_64 };
    const noh_gl_quirk *first = NULL;
    uint32_t bytes = 0;
    for (uint32_t i = 0; i < 3u; i++) { /* the first in the table is the most special */
        const noh_gl_quirk *quirk = noh_gl_quirk_find(renderer, sizes[i]);
        if (!quirk || (first && first < quirk)) continue;
        first = quirk;
        bytes = 16u << i;
    }
    return bytes;
}

/* Bytes uploaded by the path cpu. */
static float cpu_upload(const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan)
{
    const int finished = noh_gl_morph_finishes(desc, plan->accumulate);
    float bytes = 0.0f;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const uint32_t sums = (plan->accumulate == NOH_ACCUMULATE_F16 ? 6u : 12u) * plan->layer_count;
        const uint32_t stride = finished ? noh_morph_finished_stride(&desc->meshes[i]) : sums;
        if (desc->instance_counts && !desc->instance_counts[i]) continue;
        bytes += (float)stride * (float)desc->meshes[i].header->touched_count;
    }
    return bytes;
}

static uint32_t strips_of(const noh_gl_morph_desc *desc, uint32_t mesh)
{
    return desc->coarse ? desc->later_strips : noh_gl_morph_strips(&desc->meshes[mesh]);
}

/* What draws add to the paths with sums, and the pass; and the path direct. */
static void weigh_draws(const noh_gl_morph_desc *desc, const noh_gl_morph_plan *plan, int software,
                        noh_gl_morph_costs *c)
{
    const float turn = software ? TURN_SOFTWARE : c->tile_bytes ? TURN_TILER : TURN_GPU;
    const float start = software ? START_SOFTWARE : START_GPU;
    const float fetches = (software ? FETCH_SOFTWARE : FETCH_GPU) * c->touched * (float)c->draws;
    const float pass = software ? 0.0f : PASS_GPU * (float)desc->mesh_count / (float)plan->instance_count;
    c->mrt += pass + fetches;
    c->per_layer += pass * (float)plan->layer_count + fetches;
    c->gather += pass + fetches;
    c->cpu += fetches;
    c->direct = (16.0f * c->blocks * turn + c->touched * start) * (float)c->draws + c->upload_bytes / UPLOADED_BYTES;
}

void noh_gl_morph_weigh(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, noh_gl_morph_plan *plan)
{
    const int software = noh_gl_quirk_find(caps->renderer, NOH_QUIRK_SOFTWARE) != NULL;
    const float share = desc->expected_active > 0.0f ? desc->expected_active : 0.5f;
    noh_gl_morph_costs *c = &plan->costs;
    memset(c, 0, sizeof *c);
    c->tile_bytes = tile_bytes(caps->renderer);
    c->draws = desc->draws ? desc->draws : 1u;
    c->pixel_bytes = (plan->accumulate == NOH_ACCUMULATE_F16 ? 8u : 16u) * plan->layer_count;
    for (uint32_t i = 0; i < desc->mesh_count; i++) {
        const noh_mesh_header *h = desc->meshes[i].header;
        const float blocks = (float)(desc->coarse ? desc->later_blocks : noh_gl_morph_blocks(&desc->meshes[i]));
        if (desc->instance_counts && !desc->instance_counts[i]) continue;
        c->texels += share * (float)h->texel_count;
        c->quads += share * (float)strips_of(desc, i);
        c->blocks += share * blocks;
        c->pairs += share * (float)h->pair_count;
        c->touched += (float)h->touched_count;
    }
    c->mrt = software ? 16.0f * c->blocks : c->texels + QUAD_TEXELS * c->quads;
    if (c->tile_bytes && c->pixel_bytes > c->tile_bytes) c->mrt *= 2.0f;
    if (!software && plan->accumulate == NOH_ACCUMULATE_F16) c->mrt *= HALF_BLEND_GPU;
    c->mrt += c->touched;
    c->per_layer = c->mrt + (software ? 0.0f : QUAD_TEXELS * c->quads * (float)(plan->layer_count - 1u));
    c->upload_bytes = 16.0f * c->blocks + 0.25f * c->touched; /* entries and starts of lists */
    c->gather = 16.0f * c->blocks * (software ? GATHER_SOFTWARE : GATHER_GPU) + WRITE * c->touched +
                c->upload_bytes / UPLOADED_BYTES;
    c->cpu = CPU_PAIR * c->pairs + CPU_VERTEX * c->touched +
             (software ? 0.0f : cpu_upload(desc, plan) / UPLOADED_BYTES);
    weigh_draws(desc, plan, software, c);
}
