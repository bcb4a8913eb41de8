/* bench_report.c: rows and storage, as text and as JSON. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/json.h"

void bench_add_row(bench_rows *rows, const char *name, const char *baseline, double theirs, double ours,
                   const char *unit, uint32_t runs)
{
    bench_row *row;
    if (rows->count == rows->capacity) {
        uint32_t capacity = rows->capacity ? 2 * rows->capacity : 128;
        bench_row *grown = realloc(rows->rows, capacity * sizeof *grown);
        if (!grown) {
            rows->failed = 1;
            return;
        }
        rows->rows = grown;
        rows->capacity = capacity;
    }
    row = &rows->rows[rows->count++];
    snprintf(row->name, sizeof row->name, "%s", name);
    snprintf(row->baseline, sizeof row->baseline, "%s", baseline);
    row->ratio = ours > 0.0 ? theirs / ours : HUGE_VAL;
    row->value = ours;
    row->unit = unit;
    row->runs = runs;
}

/* ---- storage: bytes per pair that is not zero ---- */

#define STORAGE_MAX 16

typedef struct storage_row {
    char name[48];
    double bytes, per_pair;
} storage_row;

static void add_storage(storage_row *rows, int *count, const char *name, double bytes, double pairs)
{
    storage_row *row = &rows[(*count)++];
    snprintf(row->name, sizeof row->name, "%s", name);
    row->bytes = bytes;
    row->per_pair = bytes / pairs;
}

static void add_path_storage(bench_job *job, storage_row *rows, int *count, noh_morph_path path, double pairs)
{
    noh_gl_morph_desc desc;
    noh_gl_morph_plan plan;
    char name[48];
    memset(&desc, 0, sizeof desc);
    desc.meshes = &job->mesh;
    desc.mesh_count = 1;
    desc.path = path;
    if (!noh_gl_morph_plan_make(&desc, &job->g.caps, &plan, NULL)) {
        snprintf(name, sizeof name, "gpu/%s", noh_morph_path_name(path));
        add_storage(rows, count, name, (double)(plan.delta_bytes + plan.table_bytes), pairs);
    }
}

/* Ours, in the pack and on the GPU; the peers' layouts as their sources have them. */
static int list_storage(bench_job *job, storage_row rows[STORAGE_MAX])
{
    const noh_mesh_header *h = job->mesh.header;
    double pairs = h->pair_count ? (double)h->pair_count : 1.0, dense = (double)h->vertex_count * h->target_count;
    int count = 0;
    add_storage(rows, &count, "pack", 12.0 * h->texel_count + 8.0 * h->rect_count + 64.0 * h->target_count, pairs);
    for (int path = NOH_MORPH_LAYERED; path <= NOH_MORPH_GATHER; path++) {
        add_path_storage(job, rows, &count, (noh_morph_path)path, pairs);
    }
    add_path_storage(job, rows, &count, NOH_MORPH_DIRECT, pairs);
    add_storage(rows, &count, "three.js", 32.0 * dense, pairs);
    add_storage(rows, &count, "filament", 24.0 * dense, pairs);
    add_storage(rows, &count, "playcanvas", 16.0 * (double)h->touched_count * h->target_count, pairs);
    add_storage(rows, &count, "unity", 40.0 * pairs, pairs);
    add_storage(rows, &count, "one rectangle per target, asset's order", 24.0 * (double)h->texels_one_rect, pairs);
    return count;
}

/* ---- text ---- */

static void print_head(const bench_job *job)
{
    const noh_mesh_header *h = job->mesh.header;
    printf("%s, mesh '%s': %u vertices, %u targets, %u pairs in %u texels of %u rectangles\n", job->files[0].path,
           job->mesh.name, h->vertex_count, h->target_count, h->pair_count, h->texel_count, h->rect_count);
    printf("%s: %s; LP_NUM_THREADS=%s\n", job->g.caps.renderer, job->g.caps.version_text, getenv("LP_NUM_THREADS"));
    printf("%s, medians of at most %u interleaved rounds; morph/ rows are costs above the unmorphed mesh with "
           "rasterisation discarded\n",
           job->gl_clock.what, job->rounds);
    printf("quad-per-target: rectangles in %s\n\n",
           job->artist ? "the asset's own vertex order"
                       : "the pack's vertex order, which favours it (for the asset's order: --source ASSET)");
}

/* So that small ratios say something too. */
static int places(double ratio)
{
    return ratio < 0.1 ? 5 : 2;
}

static void print_rows(const bench_rows *rows)
{
    printf("%-40s %10s %-8s %10s  %s\n", "", "cost", "", "ratio", "against");
    for (uint32_t i = 0; i < rows->count; i++) {
        const bench_row *r = &rows->rows[i];
        int same = i && strcmp(r->name, rows->rows[i - 1].name) == 0;
        if (same) {
            printf("%-40s %10s %-8s %10.*f  %s\n", "", "", "", places(r->ratio), r->ratio, r->baseline);
        } else {
            printf("%-40s %10.4g %-8s %10.*f  %s\n", r->name, r->value, r->unit, places(r->ratio), r->ratio,
                   r->baseline);
        }
    }
}

static void print_slopes(const bench_job *job)
{
    printf("\n%-40s %10s %14s %8s %6s\n", "100 heads, over active pairs", "ns/pair", "fixed, us/head", "R^2", "draws");
    for (uint32_t i = 0; i < job->slope_count; i++) {
        const bench_slope *s = &job->slopes[i];
        printf("%-40s %10.3f %14.2f %8.4f %6u\n", s->path, s->ns_per_pair, s->fixed_us, s->fit, s->draws);
    }
}

static void print_storage(bench_job *job)
{
    storage_row rows[STORAGE_MAX];
    int count = list_storage(job, rows);
    printf("\n%-40s %10s %14s %8s\n", "storage of the targets", "bytes", "bytes per pair", "of pack");
    for (int i = 0; i < count; i++) {
        printf("%-40s %10.0f %14.2f %8.2f\n", rows[i].name, rows[i].bytes, rows[i].per_pair,
               rows[i].bytes / rows[0].bytes);
    }
}

static void print_memories(const bench_job *job)
{
    if (job->memory_count) {
        printf("\n%-32s %14s %14s %14s %14s  (%llu events in each)\n", "memory", "CPU, planned", "taken",
               "GPU, planned", "taken", (unsigned long long)job->crowd_events);
    }
    for (uint32_t i = 0; i < job->memory_count; i++) {
        const bench_memory *m = &job->memories[i];
        printf("%-32s %14llu %14llu %14llu %14llu\n", m->name, (unsigned long long)m->planned_cpu,
               (unsigned long long)m->cpu, (unsigned long long)m->planned_gpu, (unsigned long long)m->gpu);
    }
}

void bench_print(bench_job *job)
{
    if (job->has_mesh) {
        print_head(job);
    } else {
        printf("%s: clips; %s, medians of at most %u interleaved rounds\n\n", job->files[0].path, job->cpu_clock.what,
               job->rounds);
    }
    print_rows(&job->rows);
    print_memories(job);
    if (job->has_mesh && !job->only) {
        print_slopes(job);
        print_storage(job);
    }
}

/* ---- JSON ---- */

static void json_rows(json *j, const bench_rows *rows)
{
    json_open(j, "rows", '[');
    for (uint32_t i = 0; i < rows->count; i++) {
        json_open(j, NULL, '{');
        json_text(j, "name", rows->rows[i].name);
        json_text(j, "baseline", rows->rows[i].baseline);
        json_number(j, "ratio", rows->rows[i].ratio);
        json_text(j, "unit", rows->rows[i].unit);
        json_number(j, "value", rows->rows[i].value);
        json_integer(j, "runs", rows->rows[i].runs);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_slopes(json *j, const bench_job *job)
{
    json_open(j, "slopes", '[');
    for (uint32_t i = 0; i < job->slope_count; i++) {
        json_open(j, NULL, '{');
        json_text(j, "path", job->slopes[i].path);
        json_number(j, "ns_per_pair", job->slopes[i].ns_per_pair);
        json_number(j, "fixed_us_per_head", job->slopes[i].fixed_us);
        json_number(j, "r_squared", job->slopes[i].fit);
        json_integer(j, "draws", job->slopes[i].draws);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_head(json *j, const bench_job *job)
{
    json_text(j, "driver", job->g.caps.renderer);
    json_text(j, "gl_version", job->g.caps.version_text);
    json_text(j, "clock", job->gl_clock.what);
    json_text(j, "raster_threads", getenv("LP_NUM_THREADS"));
    json_text(j, "mesh", job->mesh.name);
    json_text(j, "quad_order", job->artist ? "asset" : "pack");
}

static void json_storage(json *j, bench_job *job)
{
    storage_row rows[STORAGE_MAX];
    int count = list_storage(job, rows);
    json_open(j, "storage", '[');
    for (int i = 0; i < count; i++) {
        json_open(j, NULL, '{');
        json_text(j, "name", rows[i].name);
        json_number(j, "bytes", rows[i].bytes);
        json_number(j, "bytes_per_pair", rows[i].per_pair);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_memories(json *j, const bench_job *job)
{
    json_open(j, "memory", '[');
    for (uint32_t i = 0; i < job->memory_count; i++) {
        const bench_memory *m = &job->memories[i];
        json_open(j, NULL, '{');
        json_text(j, "name", m->name);
        json_integer(j, "planned_cpu_bytes", m->planned_cpu);
        json_integer(j, "cpu_bytes", m->cpu);
        json_integer(j, "planned_gpu_bytes", m->planned_gpu);
        json_integer(j, "gpu_bytes", m->gpu);
        json_close(j, '}');
    }
    json_close(j, ']');
}

int bench_print_json(bench_job *job)
{
    json j = json_begin();
    if (job->has_mesh) {
        json_head(&j, job);
    } else {
        json_text(&j, "clock", job->cpu_clock.what);
    }
    json_rows(&j, &job->rows);
    if (job->memory_count) json_integer(&j, "crowd_events", job->crowd_events);
    json_memories(&j, job);
    if (job->has_mesh) {
        json_slopes(&j, job);
        json_storage(&j, job);
    }
    return json_end(&j);
}
