/* verify_paths.c: the same random weights on every path that the driver has, and on the CPU. Sums of one vertex's
 * deltas are taken in the pack's order everywhere, so that f32 accumulators are equal bit for bit; where half floats
 * are blended, the CPU models the driver's rounding if the probe could name it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "deform/morph/morph_internal.h"
#include "deform/morph/morph_finish_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gpu/readback.h"
#include "half_bound.h"
#include "verify.h"
#include "verify_skin.h"

#define ROUNDS 4 /* sets of random weights per path */
#define HALF_PI 1.5707963267948966

typedef struct verify_buffers {
    float *weights, *got, *positions, *normals, *tangents, *uvs;
    void *expected, *exact;
    double *errors; /* of the accumulation texels' normals */
} verify_buffers;

/* xorshift64*: the same weights on every machine. */
static double random_unit(uint64_t *state)
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (double)((*state * 2685821657736338717ull) >> 40) / 16777216.0;
}

/* Weights from -1 to 2; in some rounds most are zero, as in real use. */
static void random_weights(uint64_t *state, int round, float *weights, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        double skip = random_unit(state), value = random_unit(state) * 3.0 - 1.0;
        weights[i] = (round & 1) && skip < 0.6 ? 0.0f : (float)value;
    }
}

/* Leave the weights of those targets that streams add. */
static void keep_streamed(const noh_mesh *mesh, float *weights)
{
    uint32_t targets[NOH_MORPH_STREAMS_MAX];
    const uint32_t count = noh_gl_morph_streamed(mesh, weights, targets);
    for (uint32_t t = 0, k = 0; t < mesh->header->target_count; t++) {
        if (k < count && targets[k] == t) {
            k++;
        } else {
            weights[t] = 0.0f;
        }
    }
}

static half_range half_range_of(const verify_job *job, const noh_gl_morph_plan *plan, const float *weights)
{
    const int once = plan->path == NOH_MORPH_CPU || plan->path == NOH_MORPH_GATHER || plan->path == NOH_MORPH_DIRECT;
    const noh_half_mode mode = plan->path == NOH_MORPH_CPU      ? NOH_HALF_RNE
                               : plan->path == NOH_MORPH_GATHER ? job->g.caps.f16_store_mode
                                                                : job->g.caps.f16_blend_mode;
    return (half_range){ weights, weights, once, mode };
}

/* The exact model of the accumulator of this path and format; 0 if the driver's rounding is unknown. */
static int reference(const verify_job *job, const noh_gl_morph_plan *plan, const noh_mesh *mesh, const float *weights,
                     const noh_morph_layers *layers)
{
    const half_range range = half_range_of(job, plan, weights);
    if (plan->accumulate != NOH_ACCUMULATE_F16) {
        noh_morph_accumulate_scalar(mesh, weights, layers);
        return range.once || job->g.caps.blend_f32_exact;
    }
    if (range.once) {
        noh_morph_accumulate_scalar(mesh, weights, layers);
        noh_morph_round_f16(mesh, range.mode, layers);
    } else {
        noh_morph_accumulate_f16(mesh, weights, range.mode, layers);
    }
    return range.mode != NOH_HALF_UNKNOWN;
}

static void compare_layers(const verify_job *job, verify_row *row, const noh_mesh *mesh, const float *got,
                           const float *expected)
{
    size_t texels = (size_t)mesh->header->morph_height << mesh->header->morph_width_log2;
    for (size_t layer = 0; layer < (job->without_tangents ? 2u : 3u); layer++) {
        for (size_t i = 0; i < 3 * (size_t)mesh->header->touched_count; i++) {
            size_t at = layer * texels * 3 + i;
            row->values += 1;
            row->differing += got[at] != expected[at]; /* -0 equals 0; a NaN differs from all */
        }
    }
}

/* f16 against exact: how far from f32 the positions are, in micrometres. */
static void measure_f16(verify_row *row, const noh_mesh *mesh, const float *got, const float *exact)
{
    for (size_t v = 0; v < mesh->header->touched_count; v++) {
        double square = 0.0;
        for (size_t c = 0; c < 3; c++) {
            double d = (double)got[3 * v + c] - (double)exact[3 * v + c];
            square += d * d;
        }
        row->max_error_um = fmax(row->max_error_um, 1e6 * (double)mesh->header->world_scale * sqrt(square));
    }
}

/* How far a unit normal may be off whose sum is off by errors[]: it turns by asin(error / length) at most, and asin x
 * is at most pi / 2 x. errors NULL: not at all. */
static double normal_allowance(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t v, const double *errors)
{
    const size_t texel = noh_mesh_accumulation_texel(mesh, v);
    double square = 0.0;
    noh_vertex rest;
    if (!errors || texel >= mesh->header->touched_count) return 0.0;
    noh_mesh_vertex(mesh, v, &rest);
    for (size_t c = 0; c < 3; c++) {
        const double sum = (double)rest.normal[c] + (double)layers->normal[3u * texel + c];
        square += sum * sum;
    }
    return fmin(2.0, HALF_PI * errors[texel] / sqrt(square));
}

/* The fetched vertices: position is one exact sum; directions are compared within the
 * tolerance of a GPU's normalize and the bounds normal_errors[] of the sums. */
static void compare_vertices(verify_row *row, const noh_mesh *mesh, const noh_morph_layers *layers,
                             const verify_buffers *b, const double *normal_errors)
{
    const float *positions = b->positions, *normals = b->normals, *uvs = b->uvs;
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        const double allowed = normal_allowance(mesh, layers, v, normal_errors);
        noh_vertex expected;
        noh_morph_vertex(mesh, layers, v, &expected);
        for (size_t c = 0; c < 3; c++) {
            row->vertex_values += 1;
            row->vertex_differing += positions[3 * v + c] != expected.position[c];
            row->max_normal_error = fmax(row->max_normal_error,
                                         fabs((double)normals[3 * v + c] - (double)expected.normal[c]) - allowed);
        }
        for (size_t c = 0; c < 2; c++) {
            const double off = fabs((double)uvs[2 * v + c] - (double)expected.uv[c]);
            row->max_uv_error = fmax(row->max_uv_error, off / fmax(1.0, fabs((double)expected.uv[c])));
        }
    }
}

static int buffers_open(verify_buffers *b, const noh_mesh *mesh)
{
    size_t layers = noh_morph_layers_size(mesh) + 16, vertices = (size_t)mesh->header->vertex_count * 12;
    b->weights = calloc(mesh->header->target_count + 1u, sizeof *b->weights);
    b->got = malloc(layers);
    b->expected = malloc(layers);
    b->exact = malloc(layers);
    b->positions = malloc(vertices);
    b->normals = malloc(vertices);
    b->tangents = malloc(vertices);
    b->uvs = malloc(vertices);
    b->errors = malloc(sizeof *b->errors * (mesh->header->touched_count + 1u));
    return !b->errors || !b->weights || !b->got || !b->expected || !b->exact || !b->positions || !b->normals ||
           !b->tangents || !b->uvs;
}

static void buffers_close(verify_buffers *b)
{
    free(b->weights);
    free(b->got);
    free(b->expected);
    free(b->exact);
    free(b->positions);
    free(b->normals);
    free(b->tangents);
    free(b->uvs);
    free(b->errors);
}

/* Streams leave no sums to read: vertices are compared, and how far their positions are off. A GPU may fuse the
 * shader's products and sums, so equal bits are not asked for. */
static int verify_streams(verify_row *row, readback *r, const noh_gl_mesh *gl_mesh, const noh_gl_morph_binding *binding,
                          const noh_morph_layers *expected, const verify_buffers *b)
{
    const noh_mesh *mesh = &gl_mesh->mesh;
    const uint64_t differing = row->vertex_differing;
    const int status = readback_vertices_uv(r, gl_mesh, binding, b->positions, b->normals, b->tangents, b->uvs);
    if (status) return status;
    row->exact = 0;
    compare_vertices(row, mesh, expected, b, NULL);
    row->values += 3u * (uint64_t)mesh->header->vertex_count;
    row->differing += row->vertex_differing - differing;
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        float want[3];
        double square = 0.0;
        noh_morph_position(mesh, expected, v, want);
        for (int c = 0; c < 3; c++) {
            const double d = (double)b->positions[3 * v + (uint32_t)c] - (double)want[c];
            square += d * d;
        }
        row->max_error_um = fmax(row->max_error_um, 1e6 * (double)mesh->header->world_scale * sqrt(square));
    }
    return 0;
}

/* Finished vertices: every word of the vertex buffer equals the reference in plain C; drawn, positions are equal to the
 * bit and directions within the precision of their pairs of 16 bits. */
static int verify_finished(verify_row *row, readback *r, const noh_gl_mesh *gl_mesh,
                           const noh_gl_morph_binding *binding, const noh_morph_layers *expected,
                           const verify_buffers *b)
{
    const noh_mesh *mesh = &gl_mesh->mesh;
    const size_t words = (size_t)noh_morph_finished_stride(mesh) / 4u * mesh->header->vertex_count;
    uint32_t *want = malloc(words * 4u + 4u), *got = malloc(words * 4u + 4u);
    int status = want && got ? readback_buffer(r, binding->vertex_buffer, binding->vertex_offset, words * 4u, got)
                             : tool_fail("verify", "out of memory");
    if (!status) {
        noh_morph_finish_scalar(mesh, expected, 0, mesh->header->vertex_count, want);
        row->values += words;
        for (size_t i = 0; i < words; i++) row->differing += got[i] != want[i];
        status = readback_vertices_uv(r, gl_mesh, binding, b->positions, b->normals, b->tangents, b->uvs);
    }
    if (!status) compare_vertices(row, mesh, expected, b, NULL);
    free(want);
    free(got);
    return status;
}

static void clear_layers(const verify_job *job, void *memory, size_t bytes, const noh_mesh *mesh,
                         noh_morph_layers *layers)
{
    noh_morph_layers_init(memory, bytes, mesh, layers, NULL);
    layers->tangent = job->without_tangents ? NULL : layers->tangent;
}

/* Sums with known bits give the CPU's vertices. For other sums the error has a bound for these weights: a row's bound
 * of positions is the largest over its sets of weights, and normals are held to the bounds of their own sums. */
static int verify_vertices(const verify_job *job, const noh_gl_morph_plan *plan, const noh_mesh *mesh,
                           const noh_morph_layers *expected, const noh_morph_layers *exact, const verify_buffers *b,
                           verify_row *row)
{
    const half_range range = half_range_of(job, plan, b->weights);
    const int inexact = plan->accumulate == NOH_ACCUMULATE_F16 && !row->exact;
    if (plan->accumulate == NOH_ACCUMULATE_F16) {
        const double bound = half_bound(mesh, &range);
        if (bound < 0.0) return tool_fail(job->file.path, "out of memory");
        row->bound_um = fmax(row->bound_um, 1e6 * (double)mesh->header->world_scale * bound);
    }
    if (inexact && half_errors(mesh, &range, HALF_NORMAL, b->errors)) return tool_fail(job->file.path, "out of memory");
    compare_vertices(row, mesh, inexact ? exact : expected, b, inexact ? b->errors : NULL);
    return 0;
}

/* One mesh, one path: several sets of weights. */
static int verify_mesh(verify_job *job, gpu_morph *m, readback *r, uint32_t mesh_index, const noh_gl_mesh *gl_mesh,
                       verify_row *row)
{
    const noh_mesh *mesh = &job->meshes[mesh_index];
    const noh_gl_morph_plan *plan = noh_gl_morph_plan_of(m->morph);
    uint32_t instance = noh_gl_morph_instance(m->morph, mesh_index, 0);
    size_t bytes = noh_morph_layers_size(mesh);
    noh_gl_morph_binding binding = noh_gl_morph_binding_of(m->morph, instance);
    verify_buffers b;
    int status = buffers_open(&b, mesh) ? tool_fail(job->file.path, "out of memory") : 0;
    for (int round = 0; round < ROUNDS && !status; round++) {
        noh_morph_layers expected, exact;
        random_weights(&job->state, round, b.weights, mesh->header->target_count);
        clear_layers(job, b.expected, bytes + 16, mesh, &expected);
        clear_layers(job, b.exact, bytes + 16, mesh, &exact);
        if (plan->path == NOH_MORPH_STREAMS) keep_streamed(mesh, b.weights);
        row->exact &= reference(job, plan, mesh, b.weights, &expected);
        noh_morph_accumulate_scalar(mesh, b.weights, &exact);
        noh_gl_morph_set_weights(m->morph, instance, b.weights, NULL);
        noh_gl_morph_update(m->morph, NULL);
        if (plan->path == NOH_MORPH_STREAMS) {
            binding = noh_gl_morph_binding_of(m->morph, instance);
            status = verify_streams(row, r, gl_mesh, &binding, &expected, &b);
            continue;
        }
        if (plan->vertex_ring) {
            binding = noh_gl_morph_binding_of(m->morph, instance);
            if (binding.vertex_buffer) status = verify_finished(row, r, gl_mesh, &binding, &expected, &b);
            continue;
        }
        status = readback_layers(r, mesh, &binding, b.got);
        if (!status) {
            status = readback_vertices_uv(r, gl_mesh, &binding, b.positions, b.normals, b.tangents, b.uvs);
        }
        if (!status) {
            compare_layers(job, row, mesh, b.got, b.expected);
            status = verify_vertices(job, plan, mesh, &expected, &exact, &b, row);
            measure_f16(row, mesh, b.got, b.exact);
        }
    }
    buffers_close(&b);
    return status;
}

#define STREAM_ULPS 16.0 /* of the largest coordinate: roundings of four products and sums, fused or not */

static void set_stream_bound(const verify_job *job, verify_row *row)
{
    for (uint32_t i = 0; i < job->file.pack.runs[NOH_CHUNK_MESH].count; i++) {
        const noh_mesh_header *h = job->meshes[i].header;
        double most = 0.0;
        for (int c = 0; c < 3; c++) {
            most = fmax(most, fmax(fabs((double)h->bounds_min[c]), fabs((double)h->bounds_max[c])));
        }
        row->bound_um = fmax(row->bound_um, 1e6 * (double)h->world_scale * STREAM_ULPS * 1.1920929e-7 * most);
    }
}

/* init must accept a block of the predicted size, and must refuse one byte less and leave it untouched. Returns the
 * predicted bytes, or 0 if a smaller block was accepted or written to. */
static uint64_t least_block(verify_job *job, const noh_gl_morph_desc *desc, uint64_t predicted)
{
    noh_gl_morph *morph = NULL;
    noh_error error = { NOH_OK, "", 0, 0 };
    uint8_t *memory = malloc((size_t)predicted + 64);
    int ok = memory != NULL;
    if (ok) {
        memset(memory, 0xa5, (size_t)predicted + 64);
        ok = noh_gl_morph_init(memory, (size_t)predicted - 1,
                               &(noh_gl_device){ &job->g.gl, &job->g.caps, &job->g.ledger, NULL, 0 }, desc, &morph,
                               &error) == NOH_ERR_MEMORY &&
             error.need == predicted;
        for (size_t i = 0; i < (size_t)predicted + 64; i++) {
            ok &= memory[i] == 0xa5;
        }
    }
    free(memory);
    return ok ? predicted : 0;
}

/* vertices: of the path cpu, as noh_gl_morph_desc has it */
static int verify_path(verify_job *job, noh_morph_path path, noh_accumulate accumulate, int vertices,
                       const noh_gl_mesh *gl_meshes)
{
    verify_row *row = &job->rows[job->row_count++];
    noh_gl_morph_desc desc;
    noh_gl_morph_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    gpu_morph m;
    readback r;
    uint64_t before;
    int status;
    memset(row, 0, sizeof *row);
    memset(&desc, 0, sizeof desc);
    row->path = vertices ? "cpu-vertices" : noh_morph_path_name(path);
    row->accumulate = noh_accumulate_name(accumulate);
    desc.vertices = vertices;
    row->normal_bound = vertices ? (double)NOH_FINISHED_NORMAL_ERROR : 0.0;
    desc.meshes = job->meshes;
    desc.mesh_count = job->file.pack.runs[NOH_CHUNK_MESH].count;
    desc.path = path;
    desc.accumulate = accumulate;
    desc.without_tangents = job->without_tangents;
    if (noh_gl_morph_plan_make(&desc, &job->g.caps, &plan, &error)) {
        row->reason = error.what;
        return 0;
    }
    if (vertices && !plan.vertex_ring) {
        row->reason =
            "cannot write finished vertices: a mesh with a light transfer or texture coordinate targets needs sums";
        return 0;
    }
    row->available = row->exact = 1;
    row->reason = plan.reason;
    row->cpu_predicted = plan.cpu_bytes;
    row->gpu_predicted = plan.gpu_bytes;
    if (path == NOH_MORPH_STREAMS) set_stream_bound(job, row);
    row->cpu_used = least_block(job, &desc, plan.cpu_bytes);
    before = noh_gl_ledger_bytes(&job->g.ledger);
    status = gpu_morph_open(&m, &job->g, &desc, job->file.path);
    if (status) {
        return status;
    }
    row->gpu_used = noh_gl_ledger_bytes(&job->g.ledger) - before;
    status = readback_open(&r, &job->g, noh_gl_morph_binding_of(m.morph, 0).is_uint);
    for (uint32_t i = 0; i < desc.mesh_count && !status; i++) {
        status = verify_mesh(job, &m, &r, i, &gl_meshes[i], row);
    }
    readback_close(&r);
    gpu_morph_close(&m);
    job->failed |= status || verify_row_failed(row);
    return status;
}

/* The fastest kernel of this processor against plain C, on the same weights. */
static int verify_simd(verify_job *job)
{
    verify_row *row = &job->rows[job->row_count++];
    noh_morph_kernel kernel;
    int status = 0;
    memset(row, 0, sizeof *row);
    row->path = "cpu-simd";
    row->accumulate = "f32";
    (void)noh_morph_kernel_find(NULL, &kernel, NULL);
    row->reason = kernel.name;
    row->available = row->exact = 1;
    for (uint32_t i = 0; i < job->file.pack.runs[NOH_CHUNK_MESH].count && !status; i++) {
        const noh_mesh *mesh = &job->meshes[i];
        size_t bytes = noh_morph_layers_size(mesh);
        verify_buffers b;
        status = buffers_open(&b, mesh) ? tool_fail(job->file.path, "out of memory") : 0;
        for (int round = 0; round < ROUNDS && !status; round++) {
            noh_morph_layers expected, got;
            random_weights(&job->state, round, b.weights, mesh->header->target_count);
            clear_layers(job, b.expected, bytes + 16, mesh, &expected);
            clear_layers(job, b.got, bytes + 16, mesh, &got);
            noh_morph_accumulate_scalar(mesh, b.weights, &expected);
            kernel.accumulate(mesh, b.weights, &got);
            compare_layers(job, row, mesh, b.got, (float *)b.expected);
        }
        buffers_close(&b);
    }
    job->failed |= status || verify_row_failed(row);
    return status;
}

/* Palettes in a uniform block, in a texture: skinned vertices within their bound of the CPU's. */
static int verify_skins(verify_job *job, const noh_gl_mesh *gl_meshes)
{
    static const char *const names[] = { "", "skin/block", "skin/tex" };
    int status = 0;
    for (int mode = NOH_PALETTE_UNIFORM; mode <= NOH_PALETTE_TEXTURE && !status; mode++) {
        verify_row *row = &job->rows[job->row_count++];
        verify_skin skin;
        memset(row, 0, sizeof *row);
        skin.bound_scale = job->bound_scale;
        status = verify_skin_run(&job->g, &job->file, job->meshes, gl_meshes, (noh_palette_mode)mode, &job->state,
                                 &skin);
        row->path = names[mode];
        row->accumulate = "f32";
        row->reason = "skinned vertices";
        row->available = row->exact = 1;
        row->vertex_values = skin.values;
        row->max_error_um = skin.error_um;
        row->bound_um = skin.bound_um;
        row->max_normal_error = skin.normal_error;
        row->cpu_predicted = row->cpu_used = skin.cpu_predicted;
        row->gpu_predicted = skin.gpu_predicted;
        row->gpu_used = skin.gpu_used;
        job->failed |= status || verify_row_failed(row);
    }
    return status;
}

int verify_paths(verify_job *job)
{
    static const noh_morph_path paths[] = { NOH_MORPH_LAYERED, NOH_MORPH_MRT, NOH_MORPH_PER_LAYER, NOH_MORPH_GATHER,
                                            NOH_MORPH_DIRECT,  NOH_MORPH_CPU, NOH_MORPH_STREAMS };
    uint32_t count = job->file.pack.runs[NOH_CHUNK_MESH].count;
    noh_gl_mesh *gl_meshes = calloc(count + 1u, sizeof *gl_meshes);
    noh_error error = { NOH_OK, "", 0, 0 };
    int status = gl_meshes ? 0 : tool_fail(job->file.path, "out of memory");
    for (uint32_t i = 0; i < count && !status; i++) {
        if (noh_gl_mesh_create(&job->g.gl, &job->g.ledger, &job->meshes[i], &gl_meshes[i], &error)) {
            status = tool_fail_error(job->file.path, &error);
        }
    }
    if (!status) {
        status = verify_simd(job);
    }
    for (int a = NOH_ACCUMULATE_F32; a <= NOH_ACCUMULATE_F16 && !status; a++) {
        for (size_t p = 0; p < sizeof paths / sizeof paths[0] && !status; p++) {
            status = verify_path(job, paths[p], (noh_accumulate)a, 0, gl_meshes);
        }
    }
    if (!status) status = verify_path(job, NOH_MORPH_CPU, NOH_ACCUMULATE_F32, 1, gl_meshes);
    if (!status && verify_skin_wanted(job->meshes, &job->file.pack)) {
        status = verify_skins(job, gl_meshes);
    }
    for (uint32_t i = 0; gl_meshes && i < count; i++) {
        noh_gl_mesh_delete(&job->g.gl, &job->g.ledger, &gl_meshes[i]);
    }
    free(gl_meshes);
    verify_check_memory(job, noh_gl_ledger_bytes(&job->g.ledger) == 0, "GPU memory was not freed");
    return status;
}
