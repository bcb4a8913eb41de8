/* cmd_verify.c: every path and format against the CPU reference, value for value, and
 * memory used against memory predicted. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "load.h"
#include "verify_skin.h"
#include "gpu_args.h"
#include "json.h"
#include "message.h"
#include "options.h"
#include "readback.h"
#include "verbs.h"

#define ROUNDS 4 /* sets of random weights per path */
#define NORMAL_BOUND 1e-5 /* of a component of a fetched normal: what a GPU's reciprocal root may be off */

typedef struct verify_row {
    const char *path, *accumulate, *reason;
    int available, exact; /* exact: equality is demanded */
    uint64_t values, differing, vertex_values, vertex_differing;
    double max_error_um, bound_um; /* f16 against f32 */
    double max_normal_error;       /* of fetched normals: the GPU's reciprocal root is not exact */
    uint64_t cpu_predicted, cpu_used, gpu_predicted, gpu_used;
    const char *failure; /* which of its values is past its bound: below, NULL: none */
    double failure_value, failure_bound;
} verify_row;

typedef struct verify_job {
    pack_file file;
    scene scene;
    gpu g;
    uint64_t state; /* of the random weights */
    verify_row rows[16];
    int row_count, failed;
    double bound_scale; /* of skinned vertices */
    const char *memory_failure; /* NULL: memory is as predicted */
    load_options load;  /* of the load whose memory is compared with its budget */
    uint64_t gpu_predicted, gpu_used, cpu_predicted, cpu_used;
} verify_job;

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

/* The exact model of what this path and format leave, or 0 when the driver's rounding is unknown. */
static int reference(const verify_job *job, const noh_gl_morph_plan *plan, const noh_mesh *mesh, const float *weights,
                     const noh_morph_layers *layers)
{
    if (plan->accumulate != NOH_ACCUMULATE_F16) {
        noh_morph_accumulate_scalar(mesh, weights, layers);
        return plan->path == NOH_MORPH_GATHER || plan->path == NOH_MORPH_CPU || job->g.caps.blend_f32_exact;
    }
    if (plan->path == NOH_MORPH_CPU || plan->path == NOH_MORPH_GATHER) {
        noh_half_mode mode = plan->path == NOH_MORPH_CPU ? NOH_HALF_RNE : job->g.caps.f16_store_mode;
        noh_morph_accumulate_scalar(mesh, weights, layers);
        noh_morph_round_f16(mesh, mode, layers);
        return mode != NOH_HALF_UNKNOWN;
    }
    noh_morph_accumulate_f16(mesh, weights, job->g.caps.f16_blend_mode, layers);
    return job->g.caps.f16_blend_mode != NOH_HALF_UNKNOWN;
}

static void compare_layers(verify_row *row, const noh_mesh *mesh, const float *got, const float *expected)
{
    size_t texels = (size_t)mesh->header->morph_height << mesh->header->morph_width_log2;
    for (size_t layer = 0; layer < 3; layer++) {
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

/* The fetched vertices: position is one exact sum; directions are compared within what a
 * GPU's normalize may differ. */
static void compare_vertices(verify_row *row, const noh_mesh *mesh, const noh_morph_layers *layers, const float *positions,
                             const float *normals)
{
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        noh_vertex expected;
        noh_morph_vertex(mesh, layers, v, &expected);
        for (size_t c = 0; c < 3; c++) {
            row->vertex_values += 1;
            row->vertex_differing += positions[3 * v + c] != expected.position[c];
            row->max_normal_error = fmax(row->max_normal_error, fabs((double)normals[3 * v + c] - (double)expected.normal[c]));
        }
    }
}

typedef struct verify_buffers {
    float *weights, *got, *positions, *normals, *tangents;
    void *expected, *exact;
} verify_buffers;

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
    return !b->weights || !b->got || !b->expected || !b->exact || !b->positions || !b->normals || !b->tangents;
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
}

/* One mesh, one path: several sets of weights. */
static int verify_mesh(verify_job *job, gpu_morph *m, readback *r, uint32_t mesh_index, const noh_gl_mesh *gl_mesh, verify_row *row)
{
    const noh_mesh *mesh = &job->scene.meshes[mesh_index];
    const noh_gl_morph_plan *plan = noh_gl_morph_plan_of(m->morph);
    uint32_t instance = noh_gl_morph_instance(m->morph, mesh_index, 0);
    size_t bytes = noh_morph_layers_size(mesh);
    noh_gl_morph_binding binding = noh_gl_morph_binding_of(m->morph, instance);
    verify_buffers b;
    int status = buffers_open(&b, mesh) ? tool_fail(job->file.path, "out of memory") : 0;
    for (int round = 0; round < ROUNDS && !status; round++) {
        noh_morph_layers expected, exact;
        random_weights(&job->state, round, b.weights, mesh->header->target_count);
        noh_morph_layers_init(b.expected, bytes + 16, mesh, &expected, NULL);
        noh_morph_layers_init(b.exact, bytes + 16, mesh, &exact, NULL);
        row->exact &= reference(job, plan, mesh, b.weights, &expected);
        noh_morph_accumulate_scalar(mesh, b.weights, &exact);
        noh_gl_morph_weights(m->morph, instance, b.weights, NULL);
        noh_gl_morph_update(m->morph, NULL);
        status = readback_layers(r, mesh, &binding, b.got);
        if (!status) {
            status = readback_vertices(r, gl_mesh, &binding, b.positions, b.normals, b.tangents);
        }
        if (!status) {
            compare_layers(row, mesh, b.got, b.expected);
            compare_vertices(row, mesh, &expected, b.positions, b.normals);
            measure_f16(row, mesh, b.got, b.exact);
        }
    }
    buffers_close(&b);
    return status;
}

static void set_bound(verify_job *job, verify_row *row, int half)
{
    for (uint32_t i = 0; half && i < job->file.pack.mesh_count; i++) {
        const noh_mesh_header *h = job->scene.meshes[i].header;
        row->bound_um = fmax(row->bound_um, 1e6 * (double)h->world_scale * (double)h->f16_position_bound);
    }
}

static void fail_row(verify_row *row, const char *what, double value, double bound)
{
    if (!row->failure) {
        row->failure = what;
        row->failure_value = value;
        row->failure_bound = bound;
    }
}

/* A row fails when a value differs where equality is demanded, when half floats or skins stray past their bound, or when
 * memory is not what was predicted. The first reason is kept. */
static int row_failed(verify_row *row)
{
    if (row->exact && (row->differing || row->vertex_differing)) {
        fail_row(row, "differing values", (double)(row->differing + row->vertex_differing), 0.0);
    }
    if (row->bound_um > 0.0 && !(row->max_error_um <= row->bound_um)) {
        fail_row(row, "position error, um", row->max_error_um, row->bound_um);
    }
    if (!(row->max_normal_error <= NORMAL_BOUND)) {
        fail_row(row, "normal error", row->max_normal_error, NORMAL_BOUND);
    }
    if (row->cpu_predicted != row->cpu_used) {
        fail_row(row, "CPU bytes used (bound: predicted)", (double)row->cpu_used, (double)row->cpu_predicted);
    }
    if (row->gpu_predicted != row->gpu_used) {
        fail_row(row, "GPU bytes used (bound: predicted)", (double)row->gpu_used, (double)row->gpu_predicted);
    }
    return row->failure != NULL;
}

/* The block that init takes: one byte less is refused and leaves it untouched. Returns the
 * bytes that suffice, or 0 when a smaller block was accepted or written to. */
static uint64_t least_block(verify_job *job, const noh_gl_morph_desc *desc, uint64_t predicted)
{
    noh_gl_morph *morph = NULL;
    noh_error error = { NOH_OK, "", 0, 0 };
    uint8_t *memory = malloc((size_t)predicted + 64);
    int ok = memory != NULL;
    if (ok) {
        memset(memory, 0xa5, (size_t)predicted + 64);
        ok = noh_gl_morph_init(memory, (size_t)predicted - 1, &job->g.gl, &job->g.caps, &job->g.ledger, desc, &morph, NULL, 0,
                               &error) == NOH_ERR_MEMORY && error.need == predicted;
        for (size_t i = 0; i < (size_t)predicted + 64; i++) {
            ok &= memory[i] == 0xa5;
        }
    }
    free(memory);
    return ok ? predicted : 0;
}

static int verify_path(verify_job *job, noh_morph_path path, noh_accumulate accumulate, const noh_gl_mesh *gl_meshes)
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
    row->path = noh_morph_path_name(path);
    row->accumulate = noh_accumulate_name(accumulate);
    desc.meshes = job->scene.meshes;
    desc.mesh_count = job->file.pack.mesh_count;
    desc.path = path;
    desc.accumulate = accumulate;
    if (noh_gl_morph_plan_make(&desc, &job->g.caps, &plan, &error)) {
        row->reason = error.what;
        return 0;
    }
    row->available = row->exact = 1;
    row->reason = plan.reason;
    row->cpu_predicted = plan.cpu_bytes;
    row->gpu_predicted = plan.gpu_bytes;
    set_bound(job, row, accumulate == NOH_ACCUMULATE_F16);
    row->cpu_used = least_block(job, &desc, plan.cpu_bytes);
    before = noh_gl_ledger_bytes(&job->g.ledger);
    status = gpu_morph_open(&m, &job->g, &desc, job->file.path);
    if (status) {
        return status;
    }
    row->gpu_used = noh_gl_ledger_bytes(&job->g.ledger) - before;
    status = readback_open(&r, &job->g, plan.layer_format == GL_RGBA32UI);
    for (uint32_t i = 0; i < desc.mesh_count && !status; i++) {
        status = verify_mesh(job, &m, &r, i, &gl_meshes[i], row);
    }
    readback_close(&r);
    gpu_morph_close(&m);
    job->failed |= status || row_failed(row);
    return status;
}

/* The SIMD build against plain C, on the same weights. */
static int verify_simd(verify_job *job)
{
    verify_row *row = &job->rows[job->row_count++];
    int status = 0;
    memset(row, 0, sizeof *row);
    row->path = "cpu-simd";
    row->accumulate = "f32";
    row->reason = noh_morph_simd();
    row->available = row->exact = 1;
    for (uint32_t i = 0; i < job->file.pack.mesh_count && !status; i++) {
        const noh_mesh *mesh = &job->scene.meshes[i];
        size_t bytes = noh_morph_layers_size(mesh);
        verify_buffers b;
        status = buffers_open(&b, mesh) ? tool_fail(job->file.path, "out of memory") : 0;
        for (int round = 0; round < ROUNDS && !status; round++) {
            noh_morph_layers expected, got;
            random_weights(&job->state, round, b.weights, mesh->header->target_count);
            noh_morph_layers_init(b.expected, bytes + 16, mesh, &expected, NULL);
            noh_morph_layers_init(b.got, bytes + 16, mesh, &got, NULL);
            noh_morph_accumulate_scalar(mesh, b.weights, &expected);
            noh_morph_accumulate(mesh, b.weights, &got);
            compare_layers(row, mesh, b.got, (float *)b.expected);
        }
        buffers_close(&b);
    }
    job->failed |= status || row_failed(row);
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
        status = verify_skin_run(&job->g, &job->file, &job->scene, gl_meshes, (noh_palette_mode)mode, &job->state, &skin);
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
        job->failed |= status || row_failed(row);
    }
    return status;
}

static void check_memory(verify_job *job, int ok, const char *failure)
{
    if (!ok) {
        job->failed = 1;
        job->memory_failure = job->memory_failure ? job->memory_failure : failure;
    }
}

static int verify_all(verify_job *job)
{
    static const noh_morph_path paths[] = { NOH_MORPH_LAYERED, NOH_MORPH_MRT, NOH_MORPH_PER_LAYER, NOH_MORPH_GATHER, NOH_MORPH_CPU };
    uint32_t count = job->file.pack.mesh_count;
    noh_gl_mesh *gl_meshes = calloc(count + 1u, sizeof *gl_meshes);
    noh_error error = { NOH_OK, "", 0, 0 };
    int status = gl_meshes ? 0 : tool_fail(job->file.path, "out of memory");
    for (uint32_t i = 0; i < count && !status; i++) {
        if (noh_gl_mesh_create(&job->g.gl, &job->g.ledger, &job->scene.meshes[i], &gl_meshes[i], &error)) {
            status = tool_fail_error(job->file.path, &error);
        }
    }
    if (!status) {
        status = verify_simd(job);
    }
    for (int a = NOH_ACCUMULATE_F32; a <= NOH_ACCUMULATE_F16 && !status; a++) {
        for (size_t p = 0; p < sizeof paths / sizeof paths[0] && !status; p++) {
            status = verify_path(job, paths[p], (noh_accumulate)a, gl_meshes);
        }
    }
    if (!status && verify_skin_wanted(&job->scene, &job->file.pack)) {
        status = verify_skins(job, gl_meshes);
    }
    for (uint32_t i = 0; gl_meshes && i < count; i++) {
        noh_gl_mesh_delete(&job->g.gl, &job->g.ledger, &gl_meshes[i]);
    }
    free(gl_meshes);
    check_memory(job, noh_gl_ledger_bytes(&job->g.ledger) == 0, "GPU memory was not given back");
    return status;
}

/* A whole load, as `noh render` makes it, against its budget, as `noh budget` prints it. */
static int verify_load(verify_job *job)
{
    load_budget b;
    load l;
    int status = load_budget_make(&b, &job->file, &job->scene, &job->g.caps, &job->load);
    if (!status) status = scene_open_players(&job->scene, &job->file, job->load.instances ? job->load.instances : 1u);
    if (!status) {
        status = load_open(&l, &job->g, &job->file, &job->scene, &job->load);
    }
    if (!status) {
        job->cpu_predicted = b.cpu_bytes;
        job->gpu_predicted = b.gpu_bytes;
        job->gpu_used = noh_gl_ledger_bytes(&job->g.ledger);
        job->cpu_used = l.morph.bytes + l.skin.bytes + l.matrix_bytes;
        for (uint32_t i = 0; i < job->scene.player_count; i++) {
            const scene_player *p = &job->scene.players[i];
            job->cpu_used += p->set_bytes + p->controller_bytes + p->pose_bytes;
        }
        status = load_update(&l, NULL);
        check_memory(job, noh_gl_ledger_bytes(&job->g.ledger) == job->gpu_used, "GPU memory was taken after init");
        load_close(&l);
    }
    load_budget_free(&b);
    check_memory(job, job->cpu_predicted == job->cpu_used, "CPU bytes are not those predicted");
    check_memory(job, job->gpu_predicted == job->gpu_used, "GPU bytes are not those predicted");
    check_memory(job, noh_gl_ledger_bytes(&job->g.ledger) == 0, "GPU memory was not given back");
    job->failed |= status;
    return status;
}

static void print_failures(const verify_job *job)
{
    for (int i = 0; i < job->row_count; i++) {
        const verify_row *row = &job->rows[i];
        if (row->failure) {
            printf("FAILED: %s %s: %s: %.6g, bound %.6g\n", row->path, row->accumulate, row->failure, row->failure_value, row->failure_bound);
        }
    }
    if (job->memory_failure) {
        printf("FAILED: memory: %s\n", job->memory_failure);
    }
}

static void print_rows(const verify_job *job)
{
    printf("%s: %s\n", job->g.caps.renderer, job->g.caps.version_text);
    printf("%-10s %-4s %10s %10s %12s %12s  %s\n", "path", "", "values", "differing", "error, um", "bound, um", "");
    for (int i = 0; i < job->row_count; i++) {
        const verify_row *row = &job->rows[i];
        if (!row->available) {
            printf("%-10s %-4s %10s %10s %12s %12s  not here: %s\n", row->path, row->accumulate, "-", "-", "-", "-", row->reason);
            continue;
        }
        printf("%-10s %-4s %10llu %10llu %12.4g %12.4g  %s\n", row->path, row->accumulate,
               (unsigned long long)(row->values + row->vertex_values), (unsigned long long)(row->differing + row->vertex_differing),
               row->max_error_um, row->bound_um, row->exact ? "" : "within the bound only: this driver's rounding is not modelled");
    }
    printf("memory: CPU %llu bytes predicted, %llu used; GPU %llu predicted, %llu used\n", (unsigned long long)job->cpu_predicted,
           (unsigned long long)job->cpu_used, (unsigned long long)job->gpu_predicted, (unsigned long long)job->gpu_used);
    print_failures(job);
    printf("%s: %s\n", job->file.path, job->failed ? "FAILED" : "ok");
}

static void json_failures(json *j, const verify_job *job)
{
    json_open(j, "failures", '[');
    for (int i = 0; i < job->row_count; i++) {
        const verify_row *row = &job->rows[i];
        if (row->failure) {
            json_open(j, NULL, '{');
            json_text(j, "path", row->path);
            json_text(j, "accumulate", row->accumulate);
            json_text(j, "what", row->failure);
            json_number(j, "value", row->failure_value);
            json_number(j, "bound", row->failure_bound);
            json_close(j, '}');
        }
    }
    if (job->memory_failure) {
        json_open(j, NULL, '{');
        json_text(j, "what", job->memory_failure);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static int print_json(const verify_job *job)
{
    json j = json_begin();
    json_text(&j, "driver", job->g.caps.renderer);
    json_text(&j, "gl_version", job->g.caps.version_text);
    json_open(&j, "paths", '[');
    for (int i = 0; i < job->row_count; i++) {
        const verify_row *row = &job->rows[i];
        json_open(&j, NULL, '{');
        json_text(&j, "path", row->path);
        json_text(&j, "accumulate", row->accumulate);
        json_bool(&j, "available", row->available);
        json_text(&j, "reason", row->reason);
        json_integer(&j, "values", row->values + row->vertex_values);
        json_integer(&j, "differing", row->differing + row->vertex_differing);
        json_bool(&j, "exact", row->exact);
        json_number(&j, "max_error_um", row->max_error_um);
        json_number(&j, "bound_um", row->bound_um);
        json_close(&j, '}');
    }
    json_close(&j, ']');
    json_open(&j, "memory", '{');
    json_integer(&j, "cpu_predicted", job->cpu_predicted);
    json_integer(&j, "cpu_used", job->cpu_used);
    json_integer(&j, "gpu_predicted", job->gpu_predicted);
    json_integer(&j, "gpu_used", job->gpu_used);
    json_close(&j, '}');
    json_failures(&j, job);
    json_bool(&j, "ok", !job->failed);
    return json_end(&j);
}

typedef struct verify_args {
    const char *pack, *anim, *driver;
    double seed, instances, lod, bound_scale;
    int as_json;
} verify_args;

static int verify_scene(verify_job *job, const verify_args *a, uint32_t level)
{
    int status = scene_set_level(&job->scene, &job->file, level);
    if (!status) status = scene_open_anim(&job->scene, &job->file, a->anim);
    if (!status) status = gpu_open(&job->g, a->driver);
    if (status) {
        return status;
    }
    status = verify_all(job);
    if (!status) status = verify_load(job);
    if (!status && a->as_json) {
        status = print_json(job);
    } else if (!status) {
        print_rows(job);
    }
    gpu_close(&job->g);
    return status;
}

static int run(void *args)
{
    static verify_job job;
    const verify_args *a = args;
    uint32_t level = 0;
    int status = parse_instances(a->instances, &job.load.instances);
    if (!status) status = parse_level(a->lod, &level);
    if (status) {
        return status;
    }
    if (!(a->bound_scale > 0.0)) {
        return tool_usage("--bound-scale wants a number over 0");
    }
    job.bound_scale = a->bound_scale;
    job.state = 0x9e3779b97f4a7c15ull ^ (uint64_t)fabs(a->seed) << 20;
    status = pack_file_open(&job.file, a->pack);
    if (status) {
        return status;
    }
    status = scene_init(&job.scene, &job.file);
    if (!status) {
        status = verify_scene(&job, a, level);
        scene_free(&job.scene);
    }
    pack_file_close(&job.file);
    return status ? status : job.failed ? EXIT_FAILED : 0;
}

static verify_args arguments;

static const option options[] = {
    OPTION_ANIM(verify_args, anim, .needs = NULL),
    { .name = "--seed", .kind = OPTION_NUMBER, .at = offsetof(verify_args, seed), .value = "N", .initial = "1",
      .what = "of the random weights and poses: the same on every machine", .example = "7" },
    { .name = "--bound-scale", .kind = OPTION_NUMBER, .at = offsetof(verify_args, bound_scale), .value = "X", .initial = "1",
      .what = "multiply the bounds of skinned vertices, over 0: to see how near they come, or a check fail", .example = "0.1" },
    OPTION_INSTANCES(verify_args, instances, "1", .what = "copies of the scene whose memory is compared with the budget, 1 to 65536"),
    OPTION_LOD(verify_args, lod, .needs = NULL),
    OPTION_DRIVER(verify_args, driver, .initial = "egl"),
    OPTION_JSON(verify_args, as_json),
};

const verb verb_verify = {
    .name = "verify",
    .files = "PACK",
    .what = "every path and format against the CPU reference, memory against its budget",
    .more = "Fails (exit code 1) where a value differs that has to be equal, or one is past its bound; each FAILED line names the row, the "
            "value and the bound.",
    .example = "face.noh\nbody.noh --instances 100 --lod 1 --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(verify_args, pack),
    .args = &arguments,
    .run = run,
};
