/* verify_rows.c: rows judged and printed. */
#include <stdio.h>

#include "cli/json.h"
#include "verify.h"

#define NORMAL_BOUND 1e-5 /* of a component of a fetched normal: the inexactness of a GPU's reciprocal root */

#define UV_BOUND 4e-6 /* of fetched texture coordinates: products and sums that a GPU may fuse */

static void fail_row(verify_row *row, const char *what, double value, double bound)
{
    if (!row->failure) {
        row->failure = what;
        row->failure_value = value;
        row->failure_bound = bound;
    }
}

/* A row fails when a value that must be equal differs, when half floats or skins exceed their bound, or when memory is
 * not what was predicted. The first reason is kept. */
int verify_row_failed(verify_row *row)
{
    if (row->exact && (row->differing || row->vertex_differing)) {
        fail_row(row, "differing values", (double)(row->differing + row->vertex_differing), 0.0);
    }
    if (row->bound_um > 0.0 && !(row->max_error_um <= row->bound_um)) {
        fail_row(row, "position error, um", row->max_error_um, row->bound_um);
    }
    if (row->exact && !(row->max_uv_error <= UV_BOUND)) {
        fail_row(row, "texture coordinate error", row->max_uv_error, UV_BOUND);
    }
    if (!(row->max_normal_error <= row->normal_bound + NORMAL_BOUND)) {
        fail_row(row, "normal error", row->max_normal_error, row->normal_bound + NORMAL_BOUND);
    }
    if (row->cpu_predicted != row->cpu_used) {
        fail_row(row, "CPU bytes used (bound: predicted)", (double)row->cpu_used, (double)row->cpu_predicted);
    }
    if (row->gpu_predicted != row->gpu_used) {
        fail_row(row, "GPU bytes used (bound: predicted)", (double)row->gpu_used, (double)row->gpu_predicted);
    }
    return row->failure != NULL;
}

void verify_check_memory(verify_job *job, int ok, const char *failure)
{
    if (!ok) {
        job->failed = 1;
        job->memory_failure = job->memory_failure ? job->memory_failure : failure;
    }
}

static void print_failures(const verify_job *job)
{
    for (int i = 0; i < job->row_count; i++) {
        const verify_row *row = &job->rows[i];
        if (row->failure) {
            printf("FAILED: %s %s: %s: %.6g, bound %.6g\n", row->path, row->accumulate, row->failure,
                   row->failure_value, row->failure_bound);
        }
    }
    if (job->memory_failure) {
        printf("FAILED: memory: %s\n", job->memory_failure);
    }
}

int verify_print(const verify_job *job)
{
    printf("%s: %s\n", job->g.caps.renderer, job->g.caps.version_text);
    printf("%-12s %-4s %10s %10s %12s %12s  %s\n", "path", "", "values", "differing", "error, um", "bound, um", "");
    for (int i = 0; i < job->row_count; i++) {
        const verify_row *row = &job->rows[i];
        if (!row->available) {
            printf("%-12s %-4s %10s %10s %12s %12s  unavailable: %s\n", row->path, row->accumulate, "-", "-", "-", "-",
                   row->reason);
            continue;
        }
        printf("%-12s %-4s %10llu %10llu %12.4g %12.4g  %s\n", row->path, row->accumulate,
               (unsigned long long)(row->values + row->vertex_values),
               (unsigned long long)(row->differing + row->vertex_differing), row->max_error_um, row->bound_um,
               row->exact ? "" : "only within the bound: this driver's rounding is not modelled");
    }
    printf("memory: CPU %llu bytes predicted, %llu used; GPU %llu predicted, %llu used\n",
           (unsigned long long)job->cpu_predicted, (unsigned long long)job->cpu_used,
           (unsigned long long)job->gpu_predicted, (unsigned long long)job->gpu_used);
    print_failures(job);
    printf("%s: %s\n", job->file.path, job->failed ? "FAILED" : "ok");
    return 0;
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

int verify_print_json(const verify_job *job)
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
