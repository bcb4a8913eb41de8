#include "stage_budget.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/json.h"
#include "cli/message.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"

/* ---- planning ---- */

/* The needs of a stage that gives up all it can, and the limits it should meet. */
static int fail_too_small(const stage_budget *b, const noh_error *error)
{
    noh_stage_desc desc = *b->desc;
    noh_stage_plan least;
    noh_error e = *error;
    char what[400];
    const int only_cpu = !desc.bytes_max && !desc.gpu_bytes_max, only_gpu = !desc.bytes_max && !desc.cpu_bytes_max;
    const uint64_t sum = desc.cpu_bytes_max + desc.gpu_bytes_max;
    e.where = desc.bytes_max ? desc.bytes_max : sum;
    desc.cpu_bytes_max = desc.gpu_bytes_max = 0;
    desc.bytes_max = error->need;
    if (noh_stage_plan_make(&desc, b->caps, &least, NULL) == NOH_OK) {
        (void)snprintf(what, sizeof what, "%s; the smallest takes %llu bytes on the CPU and %llu on the GPU",
                       error->what, (unsigned long long)least.cpu_bytes, (unsigned long long)least.gpu_bytes);
        e.what = what;
        e.need = only_cpu ? least.cpu_bytes : only_gpu ? least.gpu_bytes : least.cpu_bytes + least.gpu_bytes;
    }
    return tool_fail_error(b->subject, &e);
}

static int list_parts(stage_budget *b)
{
    b->part_count = noh_stage_plan_parts(b->desc, b->caps, &b->plan, NULL, 0);
    b->parts = calloc(b->part_count, sizeof *b->parts);
    if (!b->parts) {
        return tool_fail(b->subject, "out of memory");
    }
    (void)noh_stage_plan_parts(b->desc, b->caps, &b->plan, b->parts, b->part_count);
    b->cpu_bytes = b->plan.cpu_bytes;
    b->gpu_bytes = b->plan.gpu_bytes;
    return 0;
}

int stage_budget_add(stage_budget *b, const char *what, uint64_t cpu_bytes, uint64_t gpu_bytes)
{
    noh_stage_bytes *more = realloc(b->parts, (b->part_count + 1u) * sizeof *more);
    if (!more) return tool_fail(b->subject, "out of memory");
    b->parts = more;
    more[b->part_count++] = (noh_stage_bytes){
        .what = what, .kind = NOH_NONE, .cpu_bytes = cpu_bytes, .gpu_bytes = gpu_bytes
    };
    b->cpu_bytes += cpu_bytes;
    b->gpu_bytes += gpu_bytes;
    return 0;
}

int stage_budget_make(stage_budget *b, const char *subject, const noh_stage_desc *desc, const noh_gl_caps *caps)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_result result;
    memset(b, 0, sizeof *b);
    b->subject = subject;
    b->desc = desc;
    b->caps = caps;
    result = noh_stage_plan_make(desc, caps, &b->plan, &error);
    if (result == NOH_ERR_MEMORY) {
        return fail_too_small(b, &error);
    }
    return result == NOH_OK ? list_parts(b) : tool_fail_error(subject, &error);
}

void stage_budget_free(stage_budget *b)
{
    free(b->parts);
    b->parts = NULL;
    b->part_count = 0;
}

/* ---- as text ---- */

static const char *kind_name(const stage_budget *b, uint32_t kind)
{
    return kind == NOH_NONE ? "" : b->desc->kinds[kind].name;
}

static void print_parts(const stage_budget *b)
{
    printf("%-28s %-16s %12s %12s\n", b->subject, "kind", "CPU bytes", "GPU bytes");
    for (uint32_t i = 0; i < b->part_count; i++) {
        const noh_stage_bytes *p = &b->parts[i];
        printf("  %-26s %-16s %12llu %12llu\n", p->what, kind_name(b, p->kind), (unsigned long long)p->cpu_bytes,
               (unsigned long long)p->gpu_bytes);
    }
    printf("  %-26s %-16s %12llu %12llu\n", "sum", "", (unsigned long long)b->cpu_bytes,
           (unsigned long long)b->gpu_bytes);
    if (b->desc->share) {
        printf("  %-26s %-16s %12s %12llu  not in the sum: its peers have them\n", "shared", "", "",
               (unsigned long long)b->plan.shared_bytes);
    }
    printf("  %-26s %-16s %12llu %12s  of the total: a saved state\n", "state", "",
           (unsigned long long)b->plan.state_bytes, "");
    printf("  %-26s %-16s %12llu %12s  read in place\n", "the packs themselves", "",
           (unsigned long long)b->plan.pack_bytes, "");
    printf("  %-26s %-16s %12u %12s  at most, for any call\n", "stack", "", NOH_STACK_BYTES, "");
}

static void print_kind(const stage_budget *b, uint32_t kind)
{
    const noh_kind_plan *k = &b->plan.kinds[kind];
    const uint32_t actors = b->desc->kinds[kind].actor_count;
    printf("kind '%s': %u actor%s, %u mesh%s, %u joint%s, %u float%s, %u track%s; %u of %u segments cached\n",
           kind_name(b, kind), actors, plural(actors), k->mesh_count, k->mesh_count == 1u ? "" : "es", k->joint_count,
           plural(k->joint_count), k->float_count, plural(k->float_count), k->track_count, plural(k->track_count),
           k->cached_segment_count, k->segment_count);
    printf("  %-8s %12s %12s %10s   mesh levels\n", "level", "error mm", "triangles", "slots");
    for (uint32_t l = k->finest_level; l < k->level_count; l++) {
        const noh_actor_level *level = &k->levels[l];
        printf("  %-8u %12.3f %12u %10u  ", l, 1e3 * (double)level->error_m, level->triangle_count, level->slot_count);
        for (uint32_t m = 0; m < k->mesh_count; m++) {
            printf(" %u", level->mesh_levels[m]);
        }
        putchar('\n');
    }
}

static void print_concession(const stage_budget *b, const noh_concession *c)
{
    printf("gave up %s", c->what);
    if (c->kind != NOH_NONE) printf(" (kind %s)", kind_name(b, c->kind));
    printf(": now %u, at most %.3g pixels, for %llu bytes\n", c->value, (double)c->loss_pixels,
           (unsigned long long)(c->cpu_bytes + c->gpu_bytes));
}

static const char *path_name(const stage_budget *b)
{
    return b->plan.morph_path ? noh_morph_path_name((noh_morph_path)b->plan.morph_path) : NULL;
}

void stage_budget_print(const stage_budget *b)
{
    print_parts(b);
    for (uint32_t i = 0; i < b->desc->kind_count; i++) {
        print_kind(b, i);
    }
    for (uint32_t i = 0; i < b->plan.concession_count; i++) {
        print_concession(b, &b->plan.concessions[i]);
    }
    if (!b->caps) {
        puts("nothing is drawn");
    } else if (path_name(b)) {
        printf("%s, %s accumulators, on %s\n", path_name(b), b->plan.halves ? "half-float" : "float",
               b->caps->renderer);
    } else {
        printf("no targets, on %s\n", b->caps->renderer);
    }
}

/* ---- as JSON ---- */

static void json_kind_name(json *j, const stage_budget *b, uint32_t kind)
{
    if (kind == NOH_NONE) {
        json_null(j, "kind");
    } else {
        json_text(j, "kind", kind_name(b, kind));
    }
}

static void json_parts(json *j, const stage_budget *b)
{
    json_open(j, "parts", '[');
    for (uint32_t i = 0; i < b->part_count; i++) {
        json_open(j, NULL, '{');
        json_text(j, "name", b->parts[i].what);
        json_kind_name(j, b, b->parts[i].kind);
        json_integer(j, "cpu_bytes", b->parts[i].cpu_bytes);
        json_integer(j, "gpu_bytes", b->parts[i].gpu_bytes);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_levels(json *j, const noh_kind_plan *k)
{
    json_open(j, "levels", '[');
    for (uint32_t l = k->finest_level; l < k->level_count; l++) {
        const noh_actor_level *level = &k->levels[l];
        json_open(j, NULL, '{');
        json_integer(j, "level", l);
        json_number(j, "error_mm", 1e3 * (double)level->error_m);
        json_integer(j, "triangles", level->triangle_count);
        json_integer(j, "slots", level->slot_count);
        json_open(j, "mesh_levels", '[');
        for (uint32_t m = 0; m < k->mesh_count; m++) {
            json_integer(j, NULL, level->mesh_levels[m]);
        }
        json_close(j, ']');
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_kind(json *j, const stage_budget *b, uint32_t kind)
{
    const noh_kind_plan *k = &b->plan.kinds[kind];
    json_open(j, NULL, '{');
    json_text(j, "name", kind_name(b, kind));
    json_integer(j, "actors", b->desc->kinds[kind].actor_count);
    json_integer(j, "meshes", k->mesh_count);
    json_integer(j, "joints", k->joint_count);
    json_integer(j, "floats", k->float_count);
    json_integer(j, "tracks", k->track_count);
    json_integer(j, "clip_segments_held", k->cached_segment_count);
    json_integer(j, "clip_segments", k->segment_count);
    json_integer(j, "finest_level", k->finest_level);
    json_levels(j, k);
    json_close(j, '}');
}

static void json_concessions(json *j, const stage_budget *b)
{
    json_open(j, "concessions", '[');
    for (uint32_t i = 0; i < b->plan.concession_count; i++) {
        const noh_concession *c = &b->plan.concessions[i];
        json_open(j, NULL, '{');
        json_text(j, "what", c->what);
        json_kind_name(j, b, c->kind);
        json_integer(j, "value", c->value);
        json_number(j, "loss_pixels", (double)c->loss_pixels);
        json_integer(j, "cpu_bytes", c->cpu_bytes);
        json_integer(j, "gpu_bytes", c->gpu_bytes);
        json_close(j, '}');
    }
    json_close(j, ']');
}

int stage_budget_json(const stage_budget *b)
{
    json j = json_begin();
    json_integer(&j, "cpu_bytes", b->cpu_bytes);
    json_integer(&j, "gpu_bytes", b->gpu_bytes);
    if (b->desc->share) json_integer(&j, "shared_bytes", b->plan.shared_bytes);
    json_integer(&j, "state_bytes", b->plan.state_bytes);
    json_integer(&j, "pack_bytes", b->plan.pack_bytes);
    json_integer(&j, "stack_bytes", NOH_STACK_BYTES);
    json_bool(&j, "half_floats", (int)b->plan.halves);
    if (path_name(b)) {
        json_text(&j, "path", path_name(b));
    } else {
        json_null(&j, "path");
    }
    if (b->caps) {
        json_text(&j, "device", b->caps->renderer);
    } else {
        json_null(&j, "device");
    }
    json_parts(&j, b);
    json_open(&j, "kinds", '[');
    for (uint32_t i = 0; i < b->desc->kind_count; i++) {
        json_kind(&j, b, i);
    }
    json_close(&j, ']');
    json_concessions(&j, b);
    return json_end(&j);
}
