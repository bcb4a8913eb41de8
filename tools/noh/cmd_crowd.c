/* cmd_crowd.c: a crowd drawn, and what it took. */
#include <stdlib.h>
#include <string.h>

#include "crowd.h"
#include "view.h"

#define FRAME_TICKS 800u /* 60 frames a second */

typedef struct crowd_args {
    const char *pack, *output, *debug, *driver;
    double pixels, instances, time_s;
    uint32_t size[2];
    int plain;
    crowd_options options;
} crowd_args;

static int read_args(int argc, char **argv, crowd_args *a)
{
    const option options[] = { { "-o", OPTION_TEXT, &a->output },         { "--size", OPTION_SIZE, a->size },
                               { "--pixels", OPTION_NUMBER, &a->pixels }, { "--instances", OPTION_NUMBER, &a->instances },
                               { "--time", OPTION_NUMBER, &a->time_s },   { "--debug", OPTION_TEXT, &a->debug },
                               { "--plain", OPTION_FLAG, &a->plain },     { "--driver", OPTION_TEXT, &a->driver } };
    int count, status = tool_options(argc, argv, options, sizeof options / sizeof options[0], &a->pack, 1, &count);
    if (!status) status = parse_instances(a->instances, &a->options.count);
    if (!status && (!a->pack || !a->output)) {
        status = tool_usage("crowd wants a pack and -o OUT.png");
    }
    if (!status && !(a->pixels > 0.0 && a->pixels <= 1e6)) {
        status = tool_usage("--pixels wants a number above 0");
    }
    if (!status && !(a->time_s >= 0.0 && a->time_s <= 3600.0)) {
        status = tool_usage("--time wants seconds, 0 to 3600");
    }
    if (!status && a->debug && strcmp(a->debug, "lod") != 0) {
        status = tool_usage("--debug wants lod, not '%s'", a->debug);
    }
    a->options.view = a->debug ? NOH_VIEW_LOD : NOH_VIEW_LIT;
    a->options.pixels = (float)a->pixels;
    a->options.plain = a->plain;
    a->options.width = a->size[0];
    a->options.height = a->size[1];
    return status;
}

static void print_crowd(const crowd *c, const crowd_args *a)
{
    const crowd_plan *p = c->plan;
    printf("%s: %u bodies, %u seen", a->output, p->options.count, c->stats.seen);
    for (uint32_t k = 0; k < p->level_count && !p->options.plain; k++) {
        printf("%s %u", k ? "," : "; by level", c->stats.levels[k]);
    }
    printf("; %u fade\n%llu bytes CPU, %llu GPU; planned %llu and %llu\n", c->stats.fading, (unsigned long long)p->cpu_bytes,
           (unsigned long long)noh_gl_ledger_bytes(&c->ledger), (unsigned long long)p->cpu_bytes, (unsigned long long)p->gpu_bytes);
}

/* Frame after frame up to the time, as a game comes there. */
static int draw(crowd *c, const crowd_args *a, uint8_t *rgba)
{
    const crowd_camera camera = crowd_camera_start(c);
    canvas target;
    int status = canvas_open(&target, c->g, a->size[0], a->size[1]);
    if (status) {
        return status;
    }
    for (uint32_t frame = 0; frame <= (uint32_t)(a->time_s * NOH_TICKS_PER_SECOND / FRAME_TICKS); frame++) {
        crowd_step(c, FRAME_TICKS);
        crowd_look(c, &camera);
        crowd_show(c);
    }
    crowd_send(c);
    canvas_begin(&target);
    crowd_draw(c, &camera);
    status = canvas_read(&target, rgba);
    canvas_close(&target);
    return status;
}

static int open_and_draw(gpu *g, const pack_file *file, const crowd_args *a, uint8_t *rgba)
{
    static crowd_plan plan;
    crowd c;
    void *memory;
    int status = crowd_plan_make(&plan, file, &g->caps, &a->options);
    if (status) {
        return status;
    }
    memory = malloc((size_t)plan.cpu_bytes);
    status = memory ? crowd_open(&c, &plan, memory, (size_t)plan.cpu_bytes, g, file) : tool_fail(file->path, "out of memory");
    if (!status) {
        status = draw(&c, a, rgba);
        if (!status) print_crowd(&c, a);
        crowd_close(&c);
    }
    free(memory);
    return status;
}

int verb_crowd(int argc, char **argv)
{
    crowd_args a;
    pack_file file;
    gpu g;
    uint8_t *rgba;
    int status;
    memset(&a, 0, sizeof a);
    a.pixels = 1.0;
    a.instances = 1000.0;
    a.time_s = 2.0;
    a.size[0] = 1280;
    a.size[1] = 720;
    status = read_args(argc, argv, &a);
    if (!status) status = pack_file_open(&file, a.pack);
    if (status) {
        return status;
    }
    rgba = malloc((size_t)a.size[0] * a.size[1] * 4);
    status = rgba ? gpu_open(&g, a.driver) : tool_fail(a.pack, "out of memory");
    if (!status) {
        status = open_and_draw(&g, &file, &a, rgba);
        gpu_close(&g);
    }
    if (!status) {
        status = tool_write_png(a.output, a.size[0], a.size[1], rgba);
    }
    free(rgba);
    pack_file_close(&file);
    return status;
}
