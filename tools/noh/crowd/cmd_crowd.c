/* cmd_crowd.c: draws a crowd and reports its cost, or runs agents through a scene and measures them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "crowd_bodies.h"
#include "crowd_test.h"
#include "place_draw.h"
#include "gpu/canvas.h"
#include "gpu/gpu_args.h"
#include "cli/message.h"
#include "file/ground_file.h"
#include "file/png_file.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"

#define FRAME_TICKS 800u /* 60 frames a second */

typedef struct crowd_args {
    const char *pack, *output, *debug, *driver, *test, *dump, *place, *scenery, *camera, *ground, *hit, *strip;
    light_options light;
    double pixels, instances, time_s, agents, seconds, seed;
    uint32_t size[2];
    int plain, as_json, orca;
    crowd_options options;
    place_hit push; /* of `hit` */
    uint32_t pictures;
    double apart_s; /* of `strip` */
} crowd_args;

static int check_args(crowd_args *a)
{
    int status = parse_instances(a->instances, &a->options.count);
    if (!status && !(a->pixels > 0.0 && a->pixels <= 1e6)) {
        status = tool_usage("--pixels must be a number above 0");
    }
    if (!status && !(a->time_s >= 0.0 && a->time_s <= 3600.0)) {
        status = tool_usage("--time must be 0 to 3600 seconds");
    }
    if (!status && a->debug && strcmp(a->debug, "lod") != 0) {
        status = tool_usage("--debug must be lod, not '%s'", a->debug);
    }
    a->options.view = a->debug ? NOH_VIEW_LOD : NOH_VIEW_LIT;
    a->options.pixels = (float)a->pixels;
    a->options.spots = 1;
    a->options.people = 1;
    a->options.light = &a->light;
    a->options.plain = a->plain;
    a->options.width = a->size[0];
    a->options.height = a->size[1];
    return status;
}

/* The report on the picture, printed once it is written. */
typedef struct crowd_drawn {
    noh_stage_stats stats;
    uint32_t level_count;
    uint64_t cpu_bytes, gpu_bytes, gpu_used;
} crowd_drawn;

static void print_crowd(const crowd_drawn *d, const crowd_args *a)
{
    FILE *out = report_stream(a->output);
    fprintf(out, "%s: %u bodies, %u visible", a->output, a->options.count, d->stats.seen);
    for (uint32_t k = 0; k < d->level_count && !a->plain; k++) {
        fprintf(out, "%s %u", k ? "," : "; by level:", d->stats.at_level[k]);
    }
    fprintf(out, "; %u fading\nCPU %llu bytes, GPU %llu; planned: CPU %llu, GPU %llu\n", d->stats.fading,
            (unsigned long long)d->cpu_bytes, (unsigned long long)d->gpu_used, (unsigned long long)d->cpu_bytes,
            (unsigned long long)d->gpu_bytes);
}

static void take_drawn(const crowd *c, crowd_drawn *d)
{
    uint64_t cpu, on_gpu;
    drawn_hair_bytes(&c->hair, &cpu, &on_gpu);
    d->stats = *noh_stage_stats_of(c->stage);
    d->level_count = c->plan.kinds[0].level_count;
    d->cpu_bytes = c->plan.cpu_bytes + cpu; /* noh_stage_init takes exactly these */
    d->gpu_bytes = c->plan.gpu_bytes + on_gpu + (c->shader ? NOH_GL_RENDERER_BYTES : 0);
    d->gpu_used = noh_gl_ledger_bytes(&c->ledger);
}

/* Run every frame up to the time, as a game would, and draw the last. */
static int draw(crowd *c, gpu *g, const crowd_args *a, uint8_t *rgba)
{
    const noh_stage_view camera = crowd_camera_start(c);
    canvas target;
    int status = canvas_open(&target, g, a->size[0], a->size[1]);
    if (status) {
        return status;
    }
    for (uint32_t frame = 0; frame <= (uint32_t)(a->time_s * NOH_TICKS_PER_SECOND / FRAME_TICKS); frame++) {
        crowd_frame(c, FRAME_TICKS, &camera);
    }
    canvas_begin(&target);
    g->gl.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    crowd_draw(c);
    g->gl.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    status = canvas_read(&target, rgba);
    canvas_close(&target);
    return status;
}

static int open_and_draw(gpu *g, const pack_file *file, const crowd_args *a, uint8_t *rgba, crowd_drawn *d)
{
    static crowd c;
    int status = crowd_open(&c, g, file, &a->options);
    if (!status) {
        status = draw(&c, g, a, rgba);
        take_drawn(&c, d);
        crowd_close(&c);
    }
    return status;
}

static int draw_pack(const pack_file *file, const crowd_args *a)
{
    crowd_drawn d;
    gpu g;
    uint8_t *rgba = malloc((size_t)a->size[0] * a->size[1] * 4);
    int status = rgba ? gpu_open_drawing(&g, a->driver) : tool_fail(a->pack, "out of memory");
    if (!status) {
        status = open_and_draw(&g, file, a, rgba, &d);
        gpu_close(&g);
    }
    if (!status) status = tool_write_png(a->output, a->size[0], a->size[1], rgba);
    if (!status) print_crowd(&d, a);
    free(rgba);
    return status;
}

static int is_whole(double value, double high)
{
    return value >= 0.0 && value <= high && value == (double)(uint32_t)value;
}

static int check_agents(const crowd_args *a)
{
    if (!is_whole(a->agents, NOH_CROWD_AGENTS_MAX)) {
        return tool_usage("--agents must be a whole number from 1 to %u, or 0 for the number in the scene's name",
                          NOH_CROWD_AGENTS_MAX);
    }
    if (!(a->seconds >= 0.0 && a->seconds <= 3600.0)) return tool_usage("--seconds must be a number up to 3600");
    if (!is_whole(a->seed, 4294967295.0)) return tool_usage("--seed must be a whole number below 2^32");
    return 0;
}

/* The scene named by --place; NULL: a file. */
static const char *scene_of(const char *place)
{
    static const char *const words[][2] = { { "square", "dense1000" },
                                            { "door", "door200" },
                                            { "circle", "circle250" } };
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (strcmp(place, words[i][0]) == 0) return words[i][1];
    }
    return NULL;
}

static int test(const crowd_args *a, const noh_field *ground)
{
    const char *scene = a->test ? a->test : scene_of(a->place);
    const crowd_scene_options options = {
        scene ? scene : a->place, (uint32_t)a->agents, a->seconds, (uint32_t)a->seed, 1, a->orca ? NOH_CROWD_ORCA : 0u
    };
    if (!scene && a->orca) return tool_usage("--orca compares scenes of --test, not places");
    if (!scene) return crowd_place_run(&options, ground, a->dump, a->as_json);
    return a->ground ? tool_usage("--ground needs --place FILE: scenes of --test have no ground")
                     : crowd_test_run(&options, a->dump, a->as_json);
}

/* ---- a place drawn ---- */

static void print_place(const place_drawn *d, const crowd_args *a)
{
    FILE *out = report_stream(a->output);
    fprintf(out, "%s: %u in %s, %u visible", a->output, d->agents, a->place, d->stats.seen);
    for (uint32_t k = 0; k < d->level_count; k++) fprintf(out, "%s %u", k ? "," : "; by level:", d->stats.at_level[k]);
    fprintf(out, "; feet of %u on the ground\nstage: CPU %llu bytes, GPU %llu; walkers %llu; crowd %llu\n",
            d->near_count, (unsigned long long)d->cpu_bytes, (unsigned long long)d->gpu_bytes,
            (unsigned long long)d->walkers_bytes, (unsigned long long)d->crowd_bytes);
    if (a->hit) fprintf(out, "hit: %u of a pool of %u fell, %u not on their feet\n", d->fell, PLACE_RAGDOLLS, d->down);
    if (!d->terrain_bytes) return;
    fprintf(out, "terrain: CPU %llu bytes, GPU %llu; %u triangles in %u blocks\n", (unsigned long long)d->terrain_bytes,
            (unsigned long long)d->terrain_gpu_bytes, d->terrain_triangles, d->terrain_blocks);
}

static int draw_place_of(const pack_file *file, const place_file *place, const crowd_args *a)
{
    const place_draw_options options = {
        (uint32_t)a->agents, (uint32_t)a->seed, (float)a->pixels, a->time_s,  a->pictures, a->apart_s, a->camera,
        a->scenery,          a->light,          a->size[0],       a->size[1], a->push,     0
    };
    place_drawn d;
    gpu g;
    uint8_t *rgba = malloc((size_t)a->size[0] * a->pictures * a->size[1] * 4);
    int status = rgba ? gpu_open_drawing(&g, a->driver) : tool_fail(a->pack, "out of memory");
    if (!status) {
        status = place_draw(&g, file, place, &options, rgba, &d);
        gpu_close(&g);
    }
    if (!status) status = tool_write_png(a->output, a->pictures * a->size[0], a->size[1], rgba);
    if (!status) print_place(&d, a);
    free(rgba);
    return status;
}

static int draw_place(const crowd_args *a, const noh_field *ground)
{
    place_file *place = NULL;
    pack_file file;
    int status = scene_of(a->place) ? tool_usage("--place %s cannot be drawn: -o needs --place FILE", a->place) : 0;
    if (!status) status = place_read(a->place, &place);
    if (!status) place->ground = ground;
    if (!status) status = pack_file_open_draft(&file, a->pack);
    if (!status) {
        status = draw_place_of(&file, place, a);
        pack_file_close(&file);
    }
    place_free(place);
    return status;
}

/* One picture, or a strip within the largest width. */
static int parse_strip(crowd_args *a)
{
    char end;
    const int count = a->strip ? sscanf(a->strip, "%u,%lf%c", &a->pictures, &a->apart_s, &end) : 0;
    if (count < 1) a->pictures = 1;
    if (count < 2) a->apart_s = 0.5;
    if (a->strip && (count < 1 || count > 2 || a->pictures < 1 || !(a->apart_s > 0.0 && a->apart_s <= 60.0))) {
        return tool_usage(
            "--strip must be N[,S]: a number of pictures, and the seconds between two, at most 60; not '%s'", a->strip);
    }
    return (uint64_t)a->pictures * a->size[0] <= 8192u
               ? 0
               : tool_usage("--strip: %u pictures are wider than 8192 pixels together: use fewer, or a smaller --size",
                            a->pictures);
}

static int parse_hit(crowd_args *a)
{
    place_hit *h = &a->push;
    char end;
    const int count = sscanf(a->hit, "%f,%f,%f,%f,%f%c", &h->time_s, &h->at[0], &h->at[1], &h->radius, &h->impulse,
                             &end);
    if (count < 4) h->radius = 2.0f;
    if (count < 5) h->impulse = 90.0f;
    h->is_given = 1;
    return count >= 3 && count <= 5 && h->time_s >= 0.0f && h->time_s <= 3600.0f && fabsf(h->at[0]) <= 1e5f &&
                   fabsf(h->at[1]) <= 1e5f && h->radius >= 0.0f && h->radius <= 1e5f && h->impulse >= 0.0f &&
                   h->impulse <= 1e4f
               ? 0
               : tool_usage("--hit must be S,X,Z[,RADIUS[,NS]] in seconds, metres and newton seconds, not '%s'",
                            a->hit);
}

static int run_on(crowd_args *a, const noh_field *ground)
{
    pack_file file;
    int status;
    if (!a->output && (a->scenery || a->camera || a->hit || a->strip)) {
        return tool_usage("--scenery, --camera, --hit and --strip have no effect without -o");
    }
    status = a->hit ? parse_hit(a) : 0;
    if (!status) status = parse_strip(a);
    if (status) return status;
    if (a->test || (a->place && !a->output)) {
        return a->pack ? tool_usage("measuring agents takes no PACK; to draw one, use --place FILE -o OUT.png")
                       : test(a, ground);
    }
    if (!a->output) return tool_usage("noh crowd needs -o OUT.png, --test SCENE or --place PLACE");
    if (!a->pack) return tool_usage("noh crowd -o OUT.png needs a PACK with the bodies to draw");
    status = check_args(a);
    if (!status && a->place) return draw_place(a, ground);
    if (!status) status = pack_file_open_draft(&file, a->pack);
    if (!status) {
        status = draw_pack(&file, a);
        pack_file_close(&file);
    }
    return status;
}

static int run(void *args)
{
    crowd_args *a = args;
    ground_file ground;
    int status = check_agents(a);
    memset(&ground, 0, sizeof ground);
    if (!status && a->ground) status = ground_file_open(&ground, a->ground);
    if (!status) status = run_on(a, a->ground ? &ground.field : NULL);
    ground_file_close(&ground);
    return status;
}

static crowd_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(crowd_args, output),
      .value = "OUT.png",
      .what = "the picture; required unless agents are measured",
      .example = "crowd.png",
      .excludes = "--test" },
    OPTION_INSTANCES(crowd_args, instances, "1000", .what = "number of bodies, 1 to 65536"),
    { .name = "--pixels",
      .kind = OPTION_NUMBER,
      .at = offsetof(crowd_args, pixels),
      .value = "N",
      .initial = "1",
      .what = "the largest error that LOD levels may have on screen, pixels, over 0",
      .example = "4",
      .excludes = "--plain" },
    { .name = "--time",
      .kind = OPTION_NUMBER,
      .at = offsetof(crowd_args, time_s),
      .value = "S",
      .initial = "2",
      .what = "the moment of the picture, seconds, 0 to 3600; all frames before it are run",
      .example = "0.5" },
    { .name = "--plain",
      .kind = OPTION_FLAG,
      .at = offsetof(crowd_args, plain),
      .what = "draw every body with the full mesh and pose it in every frame, without LOD" },
    { .name = "--debug",
      .kind = OPTION_TEXT,
      .at = offsetof(crowd_args, debug),
      .value = "lod",
      .what = "colour each body by its LOD level" },
    { .name = "--size",
      .kind = OPTION_SIZE,
      .at = offsetof(crowd_args, size),
      .value = "WxH",
      .initial = "1280x720",
      .what = "size of the picture, pixels, 1 to 8192 each",
      .example = "1920x1080" },
    OPTION_DRIVER(crowd_args, driver, .initial = "egl"),
    { .name = "--test",
      .kind = OPTION_TEXT,
      .at = offsetof(crowd_args, test),
      .value = "circle250|door200|dense1000|open10000|maze400|stalls600",
      .what = "run agents through this scene and measure them, without drawing" },
    { .name = "--place",
      .kind = OPTION_TEXT,
      .at = offsetof(crowd_args, place),
      .value = "FILE|square|door|circle",
      .what =
          "run agents in a place (noh help FORMATS, places) and measure them, or with -o draw them as bodies of the pack; square, door and circle are scenes of --test",
      .example = "festival.place",
      .excludes = "--test" },
    { .name = "--scenery",
      .kind = OPTION_TEXT,
      .at = offsetof(crowd_args, scenery),
      .value = "PACK",
      .what = "with --place FILE -o: a pack drawn as it stands, with the bodies",
      .example = "festival.noh",
      .needs = "--place" },
    { .name = "--camera",
      .kind = OPTION_TEXT,
      .at = offsetof(crowd_args, camera),
      .value = "AZ,EL,DIST[,X,Z]",
      .what =
          "with --place FILE -o: azimuth and elevation in degrees, and metres from the middle of the place or from X, Z",
      .example = "30,12,14,0,4",
      .needs = "--place" },
    { .name = "--ground",
      .kind = OPTION_INPUT,
      .at = offsetof(crowd_args, ground),
      .value = "FILE",
      .what =
          "with --place FILE: put the place on a height field, which -o draws with LOD: a pack with a terrain (noh build --terrain), or a .png or .glb file that --terrain accepts",
      .example = "hill.noh",
      .needs = "--place" },
    { .name = "--hit",
      .kind = OPTION_TEXT,
      .at = offsetof(crowd_args, hit),
      .value = "S,X,Z[,RADIUS[,NS]]",
      .what =
          "with --place FILE -o: after S seconds, push the bodies within RADIUS (2) metres of X, Z away from there by NS (90) newton seconds, the nearest first, at most 16; they fall, and get up by clips whose names begin with get_up",
      .example = "10,0,4,3",
      .needs = "--place" },
    { .name = "--strip",
      .kind = OPTION_TEXT,
      .at = offsetof(crowd_args, strip),
      .value = "N[,S]",
      .what = "with --place FILE -o: N pictures of --size side by side, S (0.5) seconds apart, the first at --time",
      .example = "4,0.4",
      .needs = "--place" },
    OPTION_LIGHT_NAME(crowd_args, light.light, "auto", .excludes = "--test"),
    { .name = "--agents",
      .kind = OPTION_NUMBER,
      .at = offsetof(crowd_args, agents),
      .value = "N",
      .initial = "0",
      .what =
          "number of agents, up to 262144; 0: the number in the scene's name, or 100 in a place. Scenes grow with the number, so each agent keeps the same space",
      .example = "2000",
      .needs = "--test --place" },
    { .name = "--seconds",
      .kind = OPTION_NUMBER,
      .at = offsetof(crowd_args, seconds),
      .value = "S",
      .initial = "0",
      .what =
          "longest run, seconds, up to 3600; 0: 300 for circle250, 120 for door200, maze400 and stalls600, 60 in a place, else 30",
      .example = "10",
      .needs = "--test --place" },
    { .name = "--seed",
      .kind = OPTION_NUMBER,
      .at = offsetof(crowd_args, seed),
      .value = "N",
      .initial = "1",
      .what = "seed of their starts and goals",
      .example = "7",
      .needs = "--test --place" },
    { .name = "--orca",
      .kind = OPTION_FLAG,
      .at = offsetof(crowd_args, orca),
      .what = "use optimal reciprocal collision avoidance for all agents, for comparison",
      .needs = "--test" },
    { .name = "--dump",
      .kind = OPTION_OUTPUT,
      .at = offsetof(crowd_args, dump),
      .value = "OUT.csv",
      .what = "the position of every agent in every step of 1/30 s: frame,agent,x,z,vx,vz,radius",
      .example = "agents.csv",
      .needs = "--test --place" },
    { .name = "--json",
      .kind = OPTION_FLAG,
      .at = offsetof(crowd_args, as_json),
      .what = "print JSON on stdout; errors too: {\"error\": {...}}",
      .needs = "--test --place" },
};

const verb verb_crowd = {
    .name = "crowd",
    .files = "PACK|MODEL",
    .what = "draw a crowd of a pack's skinned mesh with LOD, or run agents through a scene and measure them",
    .more =
        "--test runs agents without a pack. circle250: 250 of 3 m across, at 2 m/s, on a circle of 200 m, each to the opposite side. door200: 200 of half a metre, at 1.3 m/s, a metre apart, out through a door of 1.6 m. dense1000: 1,000 of half a metre on a square with a square metre for each, to one random place after the other; open10000: 10,000 of 0.6 m with 4 square metres for each. maze400: 400 of half a metre, from corner to corner of a maze, by flow fields; stalls600: 600 from one of 12 stalls to another, where each stays for 5 to 15 s. Printed are when half and all of them were there, the worst overlap of two, how often one overlapped by more than 5 %, the mean speed towards the goal (of the speed that they like), the longest time in which one stood still with room in front, CPU time and bytes, and a hash of where all are: the same on every processor. --place does the same in a place of a file: its agents walk from goal to goal and use what they need; all are there when each has been at a first goal.",
    .example =
        "body.noh -o crowd.png\nbody.noh -o crowd.png --instances 200 --pixels 4 --debug lod\n--test door200 --seed 2 --json\n--place festival.place --agents 300 --json\nbody.noh --place festival.place --agents 300 --time 20 -o festival.png",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .instead = "--test",
    .without = "--place",
    .files_at = offsetof(crowd_args, pack),
    .args = &arguments,
    .run = run,
};
