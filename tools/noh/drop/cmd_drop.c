/* cmd_drop.c: drops ragdolls of a character and measures how they fall, where they end and their cost. */
#include <stdio.h>
#include <string.h>

#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "convert/base/byte_buffer.h"
#include "drop_picture.h"
#include "drop_scene.h"
#include "file/png_file.h"

#define TILE 360u

typedef struct drop_args {
    const char *pack, *dump, *output;
    double dolls, seconds, substeps, seed;
    int as_json;
} drop_args;

static void dump_frame(byte_buffer *out, const drop_scene *s)
{
    for (uint32_t d = 0; d < s->dolls; d++) {
        noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
        noh_ragdoll_bodies(s->set, d, poses);
        for (uint32_t i = 0; i < s->rig.body_count; i++) {
            const float *p = poses[i].position, *q = poses[i].rotation;
            buffer_print(out, "%u,%u,%u,%.7g,%.7g,%.7g,%.7g,%.7g,%.7g,%.7g\n", s->step, d, i, (double)p[0],
                         (double)p[1], (double)p[2], (double)q[0], (double)q[1], (double)q[2], (double)q[3]);
        }
    }
}

/* After how many steps a tile of the strip shows the fall: at once, twice in the air, as it lies, at the end. */
static uint32_t step_of_tile(const drop_scene *s, uint32_t tile)
{
    static const uint32_t steps[DROP_TILES - 1u] = { 0, 18, 36, 72 };
    return tile < DROP_TILES - 1u && steps[tile] < s->steps ? steps[tile] : s->steps;
}

static void play(drop_scene *s, byte_buffer *dump, drop_picture *picture)
{
    for (;;) {
        while (picture && picture->drawn < DROP_TILES && step_of_tile(s, picture->drawn) == s->step) {
            drop_picture_draw(picture, s);
        }
        if (dump) dump_frame(dump, s);
        if (s->step == s->steps) return;
        drop_scene_step(s);
    }
}

static int write_dump(const drop_args *a, const byte_buffer *out)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    if (out->failed || noh_file_write(a->dump, out->bytes, out->count, &error)) {
        return tool_fail(a->dump, "cannot write: %s", out->failed ? "out of memory" : error.what);
    }
    return 0;
}

static double ns_per_body_step(const drop_scene *s)
{
    return s->awake_steps ? s->cpu_ns / ((double)s->awake_steps * s->rig.body_count) : 0.0;
}

static int print_json(const drop_scene *s)
{
    char hash[16];
    json j = json_begin();
    json_integer(&j, "dolls", s->dolls);
    json_integer(&j, "bodies", s->rig.body_count);
    json_number(&j, "limit_max_deg", (double)s->worst.limit * 57.29577951);
    json_number(&j, "penetration_max_mm", (double)s->worst.penetration * 1e3);
    json_number(&j, "separation_mean_mm", (double)s->worst.separation_mean * 1e3);
    json_number(&j, "settle_s", s->settled);
    json_integer(&j, "asleep", drop_scene_asleep(s));
    json_integer(&j, "bytes_per_doll", (s->bytes + s->dolls - 1u) / s->dolls);
    json_number(&j, "ns_per_body_step", ns_per_body_step(s));
    snprintf(hash, sizeof hash, "%08x", drop_scene_hash(s));
    json_text(&j, "hash", hash);
    return json_end(&j);
}

static int print_text(const drop_args *a, const drop_scene *s)
{
    printf("%s: %u dolls of %u bodies, %.3g s in %.0f substeps a frame\n", a->pack, s->dolls, s->rig.body_count,
           (double)s->steps / 60.0, a->substeps);
    printf("  largest excess: joint limits %.1f degrees, floor %.1f mm; joints %.2f mm apart (mean of the worst)\n",
           (double)s->worst.limit * 57.29577951, (double)s->worst.penetration * 1e3,
           (double)s->worst.separation_mean * 1e3);
    printf("  asleep: %u of %u, the last after %.2f s; %zu bytes a doll; %.0f ns a body and step; hash %08x\n",
           drop_scene_asleep(s), s->dolls, s->settled, (s->bytes + s->dolls - 1u) / s->dolls, ns_per_body_step(s),
           drop_scene_hash(s));
    return 0;
}

static int drop(const drop_args *a, drop_scene *s)
{
    byte_buffer dump = { NULL, 0, 0, 0 };
    drop_picture picture = { 0, 0, NULL };
    int status = 0;
    if (a->output && drop_picture_open(&picture, TILE)) return tool_fail(a->output, "out of memory");
    if (a->dump) buffer_print(&dump, "frame,doll,body,x,y,z,qx,qy,qz,qw\n");
    play(s, a->dump ? &dump : NULL, a->output ? &picture : NULL);
    if (a->dump) status = write_dump(a, &dump);
    if (!status && a->output) status = tool_write_png(a->output, DROP_TILES * TILE, TILE, picture.rgba);
    if (!status) status = a->as_json ? print_json(s) : print_text(a, s);
    drop_picture_close(&picture);
    buffer_free(&dump);
    return status;
}

static int is_whole(double value, double low, double high)
{
    return value >= low && value <= high && value == (double)(uint32_t)value;
}

static int check_args(const drop_args *a)
{
    if (!is_whole(a->dolls, 1.0, NOH_RAGDOLLS_MAX)) {
        return tool_usage("--dolls must be a whole number from 1 to %u", NOH_RAGDOLLS_MAX);
    }
    if (!is_whole(a->substeps, 5.0, NOH_RAGDOLL_SUBSTEPS_MAX)) {
        return tool_usage("--substeps must be a whole number from 5 to %u", NOH_RAGDOLL_SUBSTEPS_MAX);
    }
    if (!(a->seconds > 0.0 && a->seconds <= 3600.0)) return tool_usage("--seconds must be a number up to 3600");
    return is_whole(a->seed, 0.0, 4294967295.0) ? 0 : tool_usage("--seed must be a whole number below 2^32");
}

static int run(void *args)
{
    drop_args *a = args;
    pack_file file;
    drop_scene scene;
    int status = check_args(a);
    if (!status) status = pack_file_open_draft(&file, a->pack);
    if (status) return status;
    status = drop_scene_open(&scene, &file, (uint32_t)a->dolls, a->seconds, (uint32_t)a->substeps, (uint32_t)a->seed);
    if (!status) {
        status = drop(a, &scene);
        drop_scene_close(&scene);
    }
    pack_file_close(&file);
    return status;
}

static drop_args arguments;

static const option options[] = {
    { .name = "--dolls",
      .kind = OPTION_NUMBER,
      .at = offsetof(drop_args, dolls),
      .value = "N",
      .initial = "16",
      .what = "number of ragdolls, 1 to 1024; they do not collide with each other",
      .example = "4" },
    { .name = "--seconds",
      .kind = OPTION_NUMBER,
      .at = offsetof(drop_args, seconds),
      .value = "S",
      .initial = "10",
      .what = "simulated time, seconds",
      .example = "3" },
    { .name = "--substeps",
      .kind = OPTION_NUMBER,
      .at = offsetof(drop_args, substeps),
      .value = "N",
      .initial = "10",
      .what = "substeps per 1/60 s, 5 to 20: more keep joints tighter",
      .example = "20" },
    { .name = "--seed",
      .kind = OPTION_NUMBER,
      .at = offsetof(drop_args, seed),
      .value = "N",
      .initial = "1",
      .what = "seed of the random turns and throws",
      .example = "7" },
    { .name = "--dump",
      .kind = OPTION_OUTPUT,
      .at = offsetof(drop_args, dump),
      .value = "OUT.csv",
      .what = "the pose of every body in every frame: frame,doll,body,x,y,z,qx,qy,qz,qw",
      .example = "fall.csv" },
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(drop_args, output),
      .value = "OUT.png",
      .what = "a picture strip of the fall, with bodies as capsules",
      .example = "fall.png" },
    OPTION_JSON(drop_args, as_json),
};

const verb verb_drop = {
    .name = "lab drop",
    .files = "PACK|MODEL",
    .what = "drop ragdolls of a character and measure how they fall",
    .more =
        "Bodies follow from joint names, and their capsules from the skin. Each ragdoll starts 1.5 m up, turned at random, with up to 3 m/s sideways, and falls onto a floor with a friction of 0.6. Prints the largest angle past a joint's limits, the largest depth below the floor, the mean distance of the worst joint's anchors, the time at which the last ragdoll fell asleep, and the CPU time per body in 1/60 s. The hash covers all final poses, and is the same on every processor.",
    .example = "body.noh\nbody.noh --dolls 4 --seconds 3 -o fall.png\nbody.noh --substeps 20 --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(drop_args, pack),
    .args = &arguments,
    .run = run,
};
