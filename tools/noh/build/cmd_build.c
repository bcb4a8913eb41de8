/* cmd_build.c: models and clips in, one pack out: the model of the first file that has meshes, the clips of all. */
#define _POSIX_C_SOURCE 200809L /* isatty */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "build/build_options.h"
#include "build/depfile.h"
#include "cli/args.h"
#include "convert/choices.h"
#include "convert/convert.h"
#include "convert/mocap/clean.h"
#include "convert/model/model_extra.h"
#include "cli/message.h"
#include "noh/base.h"
#include "noh/format.h"
#include "platform.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"

#define INPUTS_MAX 64

typedef struct clip_args {
    const char *events, *unit_cm, *rest, *facing, *bound, *rename, *retarget, *clean, *error_cm;
    int partial, loop, open_loop;
    double rate, shell_cm, split_hz, segment_frames, effort;
    option_list clip_errors, joint_errors;
} clip_args;

typedef struct lod_args {
    const char *levels;
    option_list from;
    int fast;
    double color_edges, own_share;
    const char *faces;
} lod_args;

typedef struct skin_args {
    double influences, palette;
    int keep_parts;
    const char *seam;
    option_list dual_quaternion;
} skin_args;

typedef struct material_args {
    const char *extras;
    option_list two_streams, surfaces, tints, priorities;
} material_args;

typedef struct texture_args {
    const char *format;
    double max;
    int whole;
} texture_args;

typedef struct light_args {
    const char *transfer;
    double bounce;
} light_args;

typedef struct wrinkle_args {
    const char *make, *map, *mask, *models, *lookup;
    double size;
} wrinkle_args;

typedef struct face_args {
    const char *identity, *targets, *names;
    int eyes, lips, no_correctives;
} face_args;

typedef struct attach_args {
    option_list files;
    const char *joint;
} attach_args;

typedef struct terrain_args {
    double size, height, points;
} terrain_args;

typedef struct build_args {
    const char *inputs[INPUTS_MAX], *output, *depfile, *rects, *only;
    const char *texts[NOH_CHUNK_TYPES]; /* as in convert_options */
    option_list spring_lines;
    int input_count, quiet, warnings, plain;
    const char *error_um;
    clip_args clips;
    lod_args lod;
    skin_args skin;
    material_args materials;
    texture_args textures;
    light_args light;
    wrinkle_args wrinkles;
    color_settings colors;
    face_args face;
    attach_args attach;
    terrain_args terrain;
} build_args;

/* NAME=CM. The converter checks that something has the name. */
static int check_errors(const char *name, const option_list *list)
{
    for (int i = 0; i < list->count; i++) {
        const char *equals = strrchr(list->items[i], '=');
        double value;
        if (!equals || equals == list->items[i] || tool_number(equals + 1, &value) || value <= 0.0) {
            return tool_usage("%s must be NAME=CM with CM above 0, not '%s'", name, list->items[i]);
        }
    }
    return 0;
}

static int set_clip(const build_args *a, convert_options *o)
{
    const int asked = strcmp(a->clips.error_cm, "auto") != 0;
    if (a->clips.rate < 0.0 || a->clips.rate > 1000.0 || a->clips.shell_cm <= 0.0 ||
        (asked && (tool_number(a->clips.error_cm, &o->clip.clip.error_cm) || !(o->clip.clip.error_cm > 0.0)))) {
        return tool_usage("--rate must be 0 to 1000 Hz, and --error-cm and --shell-cm above 0");
    }
    if (a->clips.effort != 1.0 && a->clips.effort != 2.0 && a->clips.effort != 3.0) {
        return tool_usage("--effort must be 1, 2 or 3, not %g", a->clips.effort);
    }
    if (strcmp(a->clips.unit_cm, "auto") != 0 &&
        (tool_number(a->clips.unit_cm, &o->source.unit_cm) || !(o->source.unit_cm > 0.0) || o->source.unit_cm > 1e9)) {
        return tool_usage("--unit-cm must be auto or a number over 0, at most 1e9, not '%s'", a->clips.unit_cm);
    }
    if (strcmp(a->clips.rest, "bind") != 0 && strcmp(a->clips.rest, "first-frame") != 0) {
        return tool_usage("--rest must be bind or first-frame, not '%s'", a->clips.rest);
    }
    o->source.turn.rest_first_frame = a->clips.rest[0] == 'f';
    o->source.turn.faces_ahead = strcmp(a->clips.facing, "auto") == 0;
    if (!o->source.turn.faces_ahead && strcmp(a->clips.facing, "keep") != 0 &&
        (tool_number(a->clips.facing, &o->source.turn.degrees) || !(fabs(o->source.turn.degrees) <= 360.0))) {
        return tool_usage("--facing must be keep, auto or -360 to 360 degrees, not '%s'", a->clips.facing);
    }
    if (clean_parse(a->clips.clean, &o->source.clean)) {
        return tool_usage(
            "--clean must be off, all or a list of gaps, jitter, root, contacts and contact-keys, not '%s'",
            a->clips.clean);
    }
    if (a->only && strcmp(a->only, "mesh") != 0 && strcmp(a->only, "anim") != 0) {
        return tool_usage("--only must be mesh or anim, not '%s'", a->only);
    }
    if (strcmp(a->clips.bound, "sphere") != 0 && strcmp(a->clips.bound, "axes") != 0) {
        return tool_usage("--bound must be sphere or axes, not '%s'", a->clips.bound);
    }
    if (a->clips.segment_frames != 0.0 && (a->clips.segment_frames < 8.0 || a->clips.segment_frames > 40.0 ||
                                           a->clips.segment_frames != (double)(uint32_t)a->clips.segment_frames)) {
        return tool_usage("--segment-frames must be a whole number from 8 to 40, or 0, not %g",
                          a->clips.segment_frames);
    }
    if (!(a->clips.split_hz >= 0.0))
        return tool_usage("--split-hz must be 0 or more frames a second, not %g", a->clips.split_hz);
    o->source.sample_rate_hz = a->clips.rate;
    o->clip.check_loops = a->clips.loop;
    o->clip.clip.shell_cm = a->clips.shell_cm;
    o->clip.clip.axes = a->clips.bound[0] == 'a';
    o->clip.clip.segment_frames = (uint32_t)a->clips.segment_frames;
    o->clip.clip.split_hz = a->clips.split_hz == 0.0 ? INFINITY : a->clips.split_hz;
    o->clip.clip.effort = (uint32_t)a->clips.effort;
    o->clip.clip.open_loop = a->clips.open_loop;
    o->clip.clip_errors = (named_errors){ a->clips.clip_errors.items, (uint32_t)a->clips.clip_errors.count };
    o->clip.joint_errors = (named_errors){ a->clips.joint_errors.items, (uint32_t)a->clips.joint_errors.count };
    o->only = !a->only ? CONVERT_ALL : a->only[0] == 'm' ? CONVERT_MESH : CONVERT_CLIPS;
    o->events = a->clips.events;
    return 0;
}

static int set_skin(const build_args *a, convert_options *o)
{
    if (a->skin.influences < 1 || a->skin.influences > MODEL_INFLUENCES_MAX ||
        a->skin.influences != (double)(uint32_t)a->skin.influences) {
        return tool_usage("--influences must be a whole number from 1 to %u", MODEL_INFLUENCES_MAX);
    }
    if (a->skin.palette < 4 || a->skin.palette > NOH_PALETTE_JOINTS_MAX ||
        a->skin.palette != (double)(uint32_t)a->skin.palette) {
        return tool_usage("--palette must be a whole number of joints from 4 to %u", NOH_PALETTE_JOINTS_MAX);
    }
    o->source.skin.influences = (uint32_t)a->skin.influences;
    o->source.skin.palette = (uint32_t)a->skin.palette;
    o->source.skin.keep_parts = a->skin.keep_parts;
    o->source.seam = strcmp(a->skin.seam, "mend") == 0  ? SEAM_MEND
                     : strcmp(a->skin.seam, "off") == 0 ? SEAM_OFF
                                                        : SEAM_CHECK;
    if (o->source.seam == SEAM_CHECK && strcmp(a->skin.seam, "check") != 0) {
        return tool_usage("--seam must be check, mend or off, not '%s'", a->skin.seam);
    }
    o->source.attached = a->attach.files.items;
    o->source.attached_count = (uint32_t)a->attach.files.count;
    o->source.attach_joint = a->attach.joint;
    o->source.two_streams = a->materials.two_streams.items;
    o->source.two_stream_count = (uint32_t)a->materials.two_streams.count;
    o->surfaces = a->materials.surfaces.items;
    o->surface_count = (uint32_t)a->materials.surfaces.count;
    o->tints = a->materials.tints.items;
    o->tint_count = (uint32_t)a->materials.tints.count;
    o->priorities = a->materials.priorities.items;
    o->priority_count = (uint32_t)a->materials.priorities.count;
    o->source.skin.dual_quaternion = a->skin.dual_quaternion.items;
    o->source.skin.dual_quaternion_count = (uint32_t)a->skin.dual_quaternion.count;
    return 0;
}

/* The finest level with virtual joints: `joints` is the coarsest that there is. */
static int parse_faces(const char *text, uint32_t *level)
{
    const int is_level = !strncmp(text, "joints:", 7) && text[7] > '0' && text[7] < '0' + (int)NOH_LOD_LEVELS_MAX;
    *level = is_level ? (uint32_t)(text[7] - '0') : strcmp(text, "joints") ? 0u : NOH_LOD_LEVELS_MAX - 1u;
    return strcmp(text, "targets") && strcmp(text, "joints") && (!is_level || text[8]);
}

static int set_lod(const build_args *a, convert_options *o)
{
    uint32_t level;
    size_t name_bytes;
    for (int i = 0; i < a->lod.from.count; i++) {
        if (strip_level_parse(a->lod.from.items[i], &name_bytes, &level)) {
            return tool_usage("--lod-from must be K or MESH=K, K from 0 to %u, not '%s'", NOH_LOD_LEVELS_MAX - 1u,
                              a->lod.from.items[i]);
        }
    }
    o->lod_from = (strip_levels){ a->lod.from.items, (uint32_t)a->lod.from.count };
    if (!(a->lod.color_edges > 0.0 && a->lod.color_edges <= 100.0)) {
        return tool_usage("--lod-color must be a number over 0, up to 100");
    }
    o->lod.color_edges = (float)a->lod.color_edges;
    if (!(a->lod.own_share >= 0.0 && a->lod.own_share <= 1.0)) {
        return tool_usage("--lod-own must be a share from 0 to 1");
    }
    o->lod.own_share = a->lod.own_share > 0.0 ? (float)a->lod.own_share : -1.0f;
    o->lod.mode = a->lod.fast ? LOD_FAST : LOD_QUALITY;
    if (parse_faces(a->lod.faces, &o->lod.face_joints)) {
        return tool_usage("--lod-faces must be targets, joints or joints:K, K from 1 to %u, not '%s'",
                          NOH_LOD_LEVELS_MAX - 1u, a->lod.faces);
    }
    o->source.skin.rigid_faces = o->lod.face_joints > 0;
    return a->lod.levels ? parse_levels(a->lod.levels, &o->lod.level_count, &o->lod.by_error) : 0;
}

static int set_rects(const build_args *a, convert_options *o)
{
    double rects;
    if (strcmp(a->rects, "auto") == 0) {
        return 0;
    }
    if (tool_number(a->rects, &rects) || rects < 1 || rects > 65535 || rects != (double)(uint32_t)rects) {
        return tool_usage("--rects must be auto or a whole number from 1 to 65535, not '%s'", a->rects);
    }
    o->morph.rects = (uint32_t)rects;
    return 0;
}

/* The order of the transfer, and whether its lobes are about normals, as in the sample. */
static int set_transfer(const build_args *a, convert_options *o)
{
    static const struct {
        const char *name;
        uint32_t order, flags;
    } all[] = {
        { "4", 4, 0 }, { "6", 6, 0 }, { "seed-4", 4, NOH_TRANSFER_ON_NORMAL }, { "seed-6", 6, NOH_TRANSFER_ON_NORMAL }
    };
    for (size_t i = 0; a->light.transfer && i < sizeof all / sizeof all[0]; i++) {
        if (strcmp(a->light.transfer, all[i].name) == 0) {
            o->transfer.order = all[i].order;
            o->transfer.flags = all[i].flags;
        }
    }
    if (!(a->light.bounce >= 0.0 && a->light.bounce <= 1.0)) {
        return tool_usage("--bounce must be a number from 0 to 1");
    }
    o->transfer.bounce = (uint32_t)(255.0 * a->light.bounce + 0.5);
    return a->light.transfer && !o->transfer.order
               ? tool_usage("--transfer must be 4, 6, seed-4 or seed-6, not '%s'", a->light.transfer)
               : 0;
}

static int set_wrinkles(const build_args *a, convert_options *o)
{
    static const struct {
        const char *name;
        uint32_t bits;
    } models[] = { { "auto", 0 },
                   { "area", NOH_WRINKLE_BY_AREA },
                   { "region", NOH_WRINKLE_BY_REGION },
                   { "channel", NOH_WRINKLE_BY_CHANNEL } };
    static const char *const made[] = { "off", "auto", "face" }; /* WRINKLES_* */
    size_t kind = 0;
    const char *make = a->wrinkles.make ? a->wrinkles.make : a->plain ? "off" : "face";
    while (o->wrinkles.automatic < 3 && strcmp(make, made[o->wrinkles.automatic]) != 0) o->wrinkles.automatic++;
    if (o->wrinkles.automatic == 3) {
        return tool_usage("--wrinkles must be auto, face or off, not '%s'", make);
    }
    while (kind < sizeof models / sizeof models[0] && strcmp(a->wrinkles.models, models[kind].name) != 0) kind++;
    if (kind == sizeof models / sizeof models[0]) {
        return tool_usage("--wrinkle-model must be auto, area, region or channel, not '%s'", a->wrinkles.models);
    }
    o->wrinkles.models = models[kind].bits;
    o->wrinkles.size = a->wrinkles.size >= 64.0 && a->wrinkles.size <= 2048.0 ? (uint32_t)a->wrinkles.size : 0;
    if (a->wrinkles.size != (double)o->wrinkles.size || (o->wrinkles.size & (o->wrinkles.size - 1u))) {
        return tool_usage("--wrinkle-size must be a power of two from 64 to 2048, or 0 to choose it");
    }
    o->wrinkles.by_pixel = strcmp(a->wrinkles.lookup, "pixel") == 0;
    if (!o->wrinkles.by_pixel && strcmp(a->wrinkles.lookup, "vertex") != 0) {
        return tool_usage("--wrinkle-lookup must be vertex or pixel, not '%s'", a->wrinkles.lookup);
    }
    o->colors = a->colors;
    o->wrinkles.map = a->wrinkles.map;
    o->wrinkles.mask = a->wrinkles.mask;
    return 0;
}

static int set_extras(const build_args *a, convert_options *o)
{
    model_error error = { "", "" };
    return extras_parse(a->materials.extras, &o->source.extras, &error) ? tool_usage("%s", error.what) : 0;
}

static int set_textures(const build_args *a, convert_options *o)
{
    o->whole_textures = a->textures.whole;
    static const char *const formats[] = { "raw", "etc2", "astc" }; /* MODEL_BLOCKS_* */
    while (o->blocks < 3u && strcmp(a->textures.format, formats[o->blocks]) != 0) o->blocks++;
    if (o->blocks == 3u) return tool_usage("--textures must be etc2, astc or raw, not '%s'", a->textures.format);
    o->texture_max = a->textures.max >= 1.0 && a->textures.max <= NOH_TEXTURE_SIZE_MAX ? (uint32_t)a->textures.max : 0;
    return a->textures.max != (double)o->texture_max
               ? tool_usage("--texture-max must be a whole number from 1 to %u", NOH_TEXTURE_SIZE_MAX)
               : 0;
}

static int set_values(const build_args *a, convert_options *o)
{
    int status;
    double error_um = 0.0;
    const int asked = strcmp(a->error_um, "auto") != 0;
    if (asked && tool_number(a->error_um, &error_um)) {
        return tool_usage("--error-um must be a number, not '%s'", a->error_um);
    }
    if (asked && !(error_um > 0.0 && error_um <= 1e6)) {
        return tool_usage("--error-um must be a number over 0 and up to 1000000");
    }
    o->morph.error_um = (float)error_um;
    status = set_clip(a, o);
    if (!status) status = check_errors("--clip-error", &a->clips.clip_errors);
    if (!status) status = check_errors("--joint-error", &a->clips.joint_errors);
    if (!status) status = set_skin(a, o);
    if (!status) status = set_lod(a, o);
    if (!status) status = set_rects(a, o);
    if (!status) status = set_transfer(a, o);
    if (!status) status = set_wrinkles(a, o);
    if (!status) status = set_textures(a, o);
    if (!status) status = set_extras(a, o);
    return status;
}

static int set_terrain(const build_args *a, convert_options *o)
{
    const double points = a->terrain.points;
    if (!(a->terrain.size >= 0.0 && a->terrain.size <= 1e5)) {
        return tool_usage("--terrain-size must be 0 to 100000 metres");
    }
    if (!(a->terrain.height >= 0.0 && a->terrain.height <= 1e5)) {
        return tool_usage("--terrain-height must be 0 to 100000 metres");
    }
    if (!(points >= 2.0 && points <= NOH_TERRAIN_SIZE_MAX && points == (double)(uint32_t)points)) {
        return tool_usage("--terrain-points must be a whole number from 2 to %u", NOH_TERRAIN_SIZE_MAX);
    }
    o->ground.size_m = a->terrain.size;
    o->ground.height_m = a->terrain.height;
    o->ground.points = (uint32_t)points;
    return 0;
}

/* --targets needs an .obj input. */
static int check_targets(const build_args *a)
{
    for (int i = 0; a->face.targets && i < a->input_count; i++) {
        const char *dot = strrchr(a->inputs[i], '.');
        if (dot && (strcmp(dot, ".obj") == 0 || strcmp(dot, ".OBJ") == 0)) return 0;
    }
    return a->face.targets ? tool_usage("--targets needs an .obj model: a glTF file holds its own targets") : 0;
}

static int set_options(const build_args *a, convert_options *o)
{
    int status;
    memset(o, 0, sizeof *o);
    status = set_values(a, o);
    if (!status) status = check_targets(a);
    if (!status) status = set_terrain(a, o);
    o->source.identity = a->face.identity;
    o->source.targets = a->face.targets;
    o->joints.names = a->clips.rename;
    o->joints.partial = a->clips.partial;
    o->joints.retarget = a->clips.retarget;
    o->source.split_eyes = a->face.eyes;
    memcpy(o->texts, a->texts, sizeof o->texts);
    o->spring_lines = a->spring_lines.items;
    o->spring_line_count = (uint32_t)a->spring_lines.count;
    o->source.lips = a->face.lips;
    /* Other joints would part the model from clips of other files. Clips fit with or without a target more if they are
     * built without it. */
    if (!a->plain && a->input_count == 1) {
        const unsigned lips = a->face.lips || o->only == CONVERT_CLIPS ? 0u : CHOICE_LIPS;
        o->source.choices = (a->face.eyes ? 0u : CHOICE_EYES) | lips;
    }
    o->keep_looks = a->plain;
    o->choose_levels = !a->plain && !a->lod.levels;
    o->no_correctives = a->face.no_correctives;
    o->names = a->face.names;
    return status;
}

static int write_pack(const build_args *a, const input_list *inputs, const byte_buffer *pack, FILE *report)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const int status = a->depfile ? depfile_write(a->depfile, a->output, inputs) : 0;
    if (status) return status;
    if (noh_file_write(a->output, pack->bytes, pack->count, &error)) {
        return tool_fail(a->output, "cannot write: %s", error.what);
    }
    if (report) fprintf(report, "%s: %zu bytes\n", a->output, pack->count);
    return 0;
}

static int run(void *args)
{
    const build_args *a = args;
    convert_options o;
    convert_failure failure;
    input_list inputs = { NULL, 0, 0 };
    byte_buffer pack = { NULL, 0, 0, 0 };
    FILE *report = a->quiet || a->warnings ? NULL : report_stream(a->output);
    int status = set_options(a, &o);
    if (status) {
        return status;
    }
    o.report = report;
    o.warnings = a->warnings ? stderr : NULL;
    o.progress = report && isatty(STDERR_FILENO) ? stderr : NULL;
    o.inputs = a->depfile ? &inputs : NULL;
    status = convert_files(a->inputs, a->input_count, &o, &pack, &failure) ? build_fail(&failure)
                                                                           : write_pack(a, &inputs, &pack, report);
    buffer_free(&pack);
    inputs_free(&inputs);
    return status;
}

static build_args arguments;

int build_options_read(int argc, char **argv, convert_options *o)
{
    memset(&arguments, 0, sizeof arguments);
    return args_read(&verb_build, argc, argv) ? EXIT_USAGE : set_options(&arguments, o);
}

const char *const *build_inputs(int *count)
{
    *count = arguments.input_count;
    return arguments.inputs;
}

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(build_args, output),
      .required = 1,
      .value = "OUT.noh",
      .what = "the pack",
      .example = "face.noh" },
    { .name = "--only",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, only),
      .value = "mesh|anim",
      .what = "write only meshes and skeletons, or only clips (for --anim)" },
    { .name = "--plain",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, plain),
      .what =
          "choose none of the following for a face. Otherwise a model whose targets blink and open the mouth gets --wrinkles face, LOD levels by --lod-fast if they do not double the work, and, if IN is one file, --lips and (without a skeleton) --eyes. An option that is given wins. Blank eyes, grey faces and lashes stay as they are with --plain; teeth of one colour get gums, and bands of teeth lines, all the same" },
    { .name = "--quiet", .kind = OPTION_FLAG, .at = offsetof(build_args, quiet), .what = "no report" },
    { .name = "--warnings",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, warnings),
      .what = "of the report, only the warnings, on stderr: for build systems",
      .excludes = "--quiet" },
    { .name = "--depfile",
      .kind = OPTION_OUTPUT,
      .at = offsetof(build_args, depfile),
      .value = "FILE",
      .what =
          "write what was read, such as the .bin files and textures of a .gltf file, as a rule for Make and Ninja (depfile)",
      .example = "face.noh.d" },
    { .name = "--error-um",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, error_um),
      .value = "auto|UM",
      .initial = "auto",
      .what =
          "largest error of target positions, micrometres, above 0, at most 1000000; auto: 10, or less on a figure of less than a centimetre",
      .example = "2",
      .excludes = "--only=anim" },
    { .name = "--rects",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, rects),
      .value = "auto|N",
      .initial = "auto",
      .what = "most rectangles per target, 1 to 65535; auto: the number that is cheapest to draw",
      .example = "4",
      .excludes = "--only=anim" },
    { .name = "--lod",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, lod.levels),
      .value = "auto|N",
      .what =
          "number of LOD levels including the full mesh, 1 to 8; auto: up to five, by error; default: 1; for faces see --plain",
      .example = "4",
      .excludes = "--only=anim" },
    { .name = "--lod-from",
      .kind = OPTION_LIST,
      .at = offsetof(build_args, lod.from),
      .value = "K|MESH=K",
      .what = "leave out the levels finer than K, 0 to 7, of all meshes or of one, as noh strip does; may repeat",
      .example = "2",
      .needs = "--lod" },
    { .name = "--lod-fast",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, lod.fast),
      .what = "simplify in seconds, with larger errors",
      .needs = "--lod" },
    { .name = "--lod-color",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, lod.color_edges),
      .value = "EDGES",
      .initial = "0.24",
      .what =
          "cost of turning white into black, in mesh edges: a higher value preserves vertex colours better, and shape less",
      .example = "1.2",
      .needs = "--lod" },
    { .name = "--lod-own",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, lod.own_share),
      .value = "SHARE",
      .initial = "0.25",
      .what =
          "give the coarsest levels that together use at most this share of a mesh's vertices their own vertices, which may lie off the surface: their errors fall by a third, and the mesh grows by these vertices; 0: all levels share the mesh's vertices",
      .example = "0",
      .needs = "--lod" },
    { .name = "--lod-faces",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, lod.faces),
      .value = "targets|joints|joints:K",
      .initial = "targets",
      .what =
          "joints: the coarsest level, or those from level K on, follow the targets by up to 32 virtual joints a mesh, and are drawn as skinned meshes: no targets, no accumulators, larger errors. A face without joints gets one. Meshes whose targets move texture coordinates, meshes skinned by dual quaternions and those whose skin has 4096 joints keep their targets",
      .example = "joints",
      .needs = "--lod" },
    { .name = "--transfer",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, light.transfer),
      .value = "4|6|seed-4|seed-6",
      .what =
          "precompute light transfer per vertex, with occlusion that follows the targets, in spherical harmonics of order 4 (6 bytes a vertex) or 6 (8 bytes); seed-: about the normal, as in the SparseMorphTargets sample (4 and 6 bytes). Never chosen unasked: a build takes 10 to 30 times as long",
      .example = "4",
      .excludes = "--only=anim" },
    { .name = "--bounce",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, light.bounce),
      .value = "ALBEDO",
      .initial = "0",
      .what = "add one bounce of light between the mesh's own surfaces to --transfer: its albedo, 0 to 1",
      .example = "0.5",
      .needs = "--transfer" },
    { .name = "--wrinkles",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, wrinkles.make),
      .value = "auto|face|off",
      .what =
          "generate wrinkles from the compression of each target: a normal map, twelve regions, and the weight of each target in each region. face: a mesh whose targets blink and smile gets folds where faces have them, if its texture coordinates do not overlap; auto: other meshes get creases, too; default: face, or off with --plain",
      .example = "off",
      .excludes = "--only=anim" },
    { .name = "--wrinkle-map",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, wrinkles.map),
      .value = "FILE",
      .what = "a painted normal map of wrinkles, PNG, JPEG or TGA, in place of a generated one",
      .example = "wrinkles.png",
      .excludes = "--only=anim" },
    { .name = "--region-mask",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, wrinkles.mask),
      .value = "FILE",
      .what = "a painted mask of twelve wrinkle regions (check it with noh mask), in place of generated regions",
      .example = "regions.png",
      .excludes = "--only=anim" },
    { .name = "--wrinkle-model",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, wrinkles.models),
      .value = "auto|area|region|channel",
      .initial = "auto",
      .what =
          "what drives the wrinkle map: the change of area in the pose, the regions that the expression wrinkles, or three channels of the first weight map; auto: region on a face with generated folds, else the larger of area and region",
      .example = "area",
      .excludes = "--only=anim" },
    { .name = "--wrinkle-lookup",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, wrinkles.lookup),
      .value = "vertex|pixel",
      .initial = "vertex",
      .what =
          "where wrinkle regions are read: per vertex, free per pixel but smoothed to the mesh, or per pixel, exact to the texel for one more fetch",
      .example = "pixel",
      .excludes = "--only=anim" },
    { .name = "--wrinkle-size",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, wrinkles.size),
      .value = "N",
      .initial = "0",
      .what =
          "side of a generated crease map, texels, a power of two from 64 to 2048; 0: 256 or 512, the smallest that shows each crease",
      .example = "256",
      .excludes = "--only=anim" },
    { .name = "--color-map",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, colors.map),
      .value = "FILE",
      .what =
          "colours that fade in with targets, such as a blush: a painted picture, PNG, JPEG or TGA, whose channels r, g, b and a say where each of four colours shows; rows `tint` and `color` of a recipe give the colours and the targets (noh help formats)",
      .example = "blush.png",
      .excludes = "--only=anim" },
    { .name = "--color-material",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, colors.material),
      .value = "NAME",
      .what = "the material that --color-map is for; without it, in each mesh the material of the most triangles",
      .example = "skin",
      .needs = "--color-map" },
    { .name = "--textures",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, textures.format),
      .value = "etc2|astc|raw",
      .initial = "etc2",
      .what =
          "how textures are stored: in ETC2 and EAC blocks, which GPUs read directly (a quarter to an eighth of the bytes; noh info lists the loss of each), in ASTC blocks for GPUs that have them (about half of that; needs astcenc; textures whose alpha cuts or blends stay ETC2), or exact",
      .example = "raw",
      .excludes = "--only=anim" },
    { .name = "--texture-max",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, textures.max),
      .value = "N",
      .initial = "2048",
      .what = "halve textures until both sides are at most this long, texels, 1 to 2048",
      .example = "1024",
      .excludes = "--only=anim" },
    { .name = "--whole-textures",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, textures.whole),
      .what =
          "keep texture rows and columns that no triangle reads, cutoffs that cut nothing, and the file's texture coordinates: for textures that a game paints or that other packs supply",
      .excludes = "--only=anim" },
    { .name = "--influences",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, skin.influences),
      .value = "N",
      .initial = "8",
      .what =
          "most joints per vertex, 1 to 32; the heaviest are kept. Drawing uses up to 8; the CPU has a list of all (noh/deform.h)",
      .example = "4",
      .excludes = "--only=anim" },
    { .name = "--palette",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, skin.palette),
      .value = "N",
      .initial = "256",
      .what = "most joints per draw, 4 to 256; a mesh with more is split",
      .example = "64",
      .excludes = "--only=anim" },
    { .name = "--dual-quaternion",
      .kind = OPTION_LIST,
      .at = offsetof(build_args, skin.dual_quaternion),
      .value = "MESH|all",
      .what = "skin this mesh with dual quaternions; may repeat",
      .example = "arm",
      .excludes = "--only=anim" },
    { .name = "--keep-parts",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, skin.keep_parts),
      .what = "keep rigid meshes below joints separate, instead of joining them into one skinned mesh",
      .excludes = "--only=anim" },
    { .name = "--attach",
      .kind = OPTION_LIST,
      .at = offsetof(build_args, attach.files),
      .value = "FILE",
      .what =
          "add the meshes of this model to the first model, such as a head to a body: joints of the same name merge; a mesh without joints follows --attach-joint; may repeat",
      .example = "head.glb",
      .excludes = "--only=anim" },
    { .name = "--attach-joint",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, attach.joint),
      .value = "NAME",
      .what =
          "the joint that carries --attach meshes without joints, from where they stand; default: the first with 'head' in its name",
      .example = "mixamorig:Head",
      .needs = "--attach" },
    { .name = "--seam",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, skin.seam),
      .value = "check|mend|off",
      .initial = "check",
      .what =
          "seams between skinned meshes, such as head and body: check warns where positions, normals, weights or targets differ; mend makes them equal",
      .example = "mend",
      .excludes = "--only=anim" },
    { .name = "--two-stream",
      .kind = OPTION_LIST,
      .at = offsetof(build_args, materials.two_streams),
      .value = "SOURCE=TARGET",
      .what =
          "make the second mesh a target of the first: both need the same triangles, and the same vertices in the same order; may repeat",
      .example = "arm=arm_bent",
      .excludes = "--only=anim" },
    { .name = "--attributes",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, materials.extras),
      .value = "NAME[:BITS],...",
      .what =
          "keep up to 5 attributes of vertices for shaders of your own, in this order: TEXCOORD_1, or names that begin with _; BITS: 8 or 16 for each component; default: as the file has them, 16 for floats",
      .example = "TEXCOORD_1,_WIND:8",
      .excludes = "--only=anim" },
    { .name = "--surface",
      .kind = OPTION_LIST,
      .at = offsetof(build_args, materials.surfaces),
      .value = "MATERIAL=skin|eye|teeth|toon|plain",
      .what =
          "draw a material as skin, eye, teeth (also gums and tongue), hair, two-tone toon, or plain; may repeat; default: from its extras (\"surface\") or VRM's MToon, else from its name: VRoid's are toons, and words tell the others",
      .example = "face=skin",
      .excludes = "--only=anim" },
    { .name = "--tint",
      .kind = OPTION_LIST,
      .at = offsetof(build_args, materials.tints),
      .value = "MATERIAL=on|off",
      .what =
          "whether a material takes the tint of an instance; may repeat; default: from its extras (\"tint\"), else off for skin, eyes and teeth, by surface or name",
      .example = "hair=off",
      .excludes = "--only=anim" },
    { .name = "--priority",
      .kind = OPTION_LIST,
      .at = offsetof(build_args, materials.priorities),
      .value = "MATERIAL=N",
      .what =
          "draw order of a blended material within a figure, -128 to 127, lower first; for equal priorities the farther mesh comes first; may repeat; default: from its extras (\"priority\") or VRM's MToon (renderQueueOffsetNumber), else 0",
      .example = "lashes=1",
      .excludes = "--only=anim" },
    { .name = "--identity",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, face.identity),
      .value = "FILE",
      .what =
          "add the targets of this model as identity targets, which make different people (noh sheet --faces); its meshes need the same vertices in the same order",
      .example = "people.glb",
      .excludes = "--only=anim" },
    { .name = "--rate",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, clips.rate),
      .value = "HZ",
      .initial = "0",
      .what = "sample rate of clips, Hz, at most 1000; 0: the file's rate",
      .example = "30",
      .excludes = "--only=mesh" },
    { .name = "--error-cm",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, clips.error_cm),
      .value = "auto|CM",
      .initial = "auto",
      .what =
          "largest error of clips at the shell, centimetres, over 0; auto: 0.01, or less where the figure is so small that it would show",
      .example = "0.02",
      .excludes = "--only=mesh" },
    { .name = "--shell-cm",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, clips.shell_cm),
      .value = "CM",
      .initial = "3",
      .what =
          "distance from a joint at which its error is measured, centimetres, over 0; farther where it moves vertices that lie farther",
      .example = "6",
      .excludes = "--only=mesh" },
    { .name = "--bound",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, clips.bound),
      .value = "sphere|axes",
      .initial = "sphere",
      .what =
          "which shell points the error bound covers: all of them, or the three on each joint's axes, as other libraries measure",
      .example = "axes",
      .excludes = "--only=mesh" },
    { .name = "--segment-frames",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, clips.segment_frames),
      .value = "N",
      .initial = "0",
      .what =
          "frames per clip segment, 8 to 40: short segments need less cache and seek faster, long ones take fewer bytes; 0: the smallest result, near a third of a second",
      .example = "16",
      .excludes = "--only=mesh" },
    { .name = "--split-hz",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, clips.split_hz),
      .value = "HZ",
      .initial = "100",
      .what = "store clips of at least this rate so that playing every second frame decodes half as much; 0: none",
      .example = "60",
      .excludes = "--only=mesh" },
    { .name = "--effort",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, clips.effort),
      .value = "1-3",
      .initial = "2",
      .what =
          "search effort for smaller clips: 1 takes a third of the time of 2, and 3 four times as long; more effort never gives a larger pack",
      .example = "3",
      .excludes = "--only=mesh" },
    { .name = "--clip-error",
      .kind = OPTION_LIST,
      .at = offsetof(build_args, clips.clip_errors),
      .value = "CLIP=CM",
      .what = "--error-cm of one clip; may repeat",
      .example = "walk=0.1",
      .excludes = "--only=mesh" },
    { .name = "--joint-error",
      .kind = OPTION_LIST,
      .at = offsetof(build_args, clips.joint_errors),
      .value = "JOINT=CM",
      .what = "--error-cm of one joint; may repeat",
      .example = "hand_l=0.005",
      .excludes = "--only=mesh" },
    { .name = "--loop",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, clips.loop),
      .what = "mark every clip as a loop, and report the gap between its ends",
      .excludes = "--only=mesh" },
    { .name = "--for-masks",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, clips.open_loop),
      .what = "do not let joints compensate for errors of their parents: for clips that are played through masks",
      .excludes = "--only=mesh" },
    { .name = "--events",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, clips.events),
      .value = "FILE",
      .what = "callback keys and sync markers, a text file (noh help FORMATS)",
      .example = "keys.txt",
      .excludes = "--only=mesh" },
    { .name = "--graph",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, texts[NOH_CHUNK_GRAPH]),
      .value = "FILE",
      .what = "animation graphs that play the clips, a text file (noh help FORMATS)",
      .example = "hero.graph",
      .excludes = "--only=mesh" },
    { .name = "--eyes",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, face.eyes),
      .what =
          "find the two eyeballs, connected parts of a mesh with vertices on a sphere, and give them joints LeftEye and RightEye at their centres, so that a gaze turns them",
      .excludes = "--only=anim" },
    { .name = "--targets",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, face.targets),
      .value = "FOLDER",
      .what =
          "for an .obj model: each other .obj file in the folder, with the same vertices in the same order, becomes a target of its name",
      .example = "expressions",
      .excludes = "--only=anim" },
    { .name = "--lips",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, face.lips),
      .what =
          "find lips and upper teeth, and make a target lipToTeeth that brings the lower lip to the teeth, used for f and v",
      .excludes = "--only=anim" },
    { .name = "--recipe",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, texts[NOH_CHUNK_RECIPE]),
      .value = "FILE",
      .what = "text file of what the face's targets show: blinks, gaze, emotions, mouth shapes (noh help FORMATS)",
      .example = "hero.recipe",
      .excludes = "--only=anim" },
    { .name = "--names",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, face.names),
      .value = "FILE",
      .what =
          "text file of names of targets, joints and materials, before those that noh knows of Oculus, ARKit, VRoid, Character Creator, Daz, Mixamo, Unreal, Unity and others (noh help FORMATS)",
      .example = "studio.names" },
    { .name = "--ragdoll",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, texts[NOH_CHUNK_RAGDOLL]),
      .value = "FILE",
      .what = "text file of the ragdoll's bodies and joint limits (noh help FORMATS)",
      .example = "hero.ragdoll",
      .excludes = "--only=anim" },
    { .name = "--springs",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, texts[NOH_CHUNK_SPRINGS]),
      .value = "FILE",
      .what =
          "text file of spring chains and colliders (noh help FORMATS), in place of the glTF file's springs (VRMC_springBone, VRM, extras)",
      .example = "hero.springs",
      .excludes = "--only=anim" },
    { .name = "--spring",
      .kind = OPTION_LIST,
      .at = offsetof(build_args, spring_lines),
      .value = "LINE",
      .what = "one line of such a file; may repeat",
      .example = "\"chain ponytail* stiffness 0.5\"",
      .excludes = "--only=anim" },
    { .name = "--match",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, texts[NOH_CHUNK_MATCH]),
      .value = "FILE",
      .what =
          "text file of the clips of a table for motion matching (noh help FORMATS): an actor then plays, at any moment, whatever of them goes where the game wants (noh_match_module)",
      .example = "walk.match",
      .excludes = "--only=mesh" },
    { .name = "--wear",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, texts[NOH_CHUNK_COVER]),
      .value = "BODY.noh",
      .what =
          "the model is a garment for the figure of this pack: keep which of the figure's triangles it hides (noh_actor_wear), and report where the rest comes through it in the figure's clips",
      .example = "hero.noh",
      .excludes = "--only=anim" },
    { .name = "--hair",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, texts[NOH_CHUNK_HAIR]),
      .value = "FILE",
      .what = "text file of a haircut: where hair grows, how it is combed and how it looks (noh help FORMATS)",
      .example = "hero.hair",
      .excludes = "--only=anim" },
    { .name = "--terrain",
      .kind = OPTION_INPUT,
      .at = offsetof(build_args, texts[NOH_CHUNK_TERRAIN]),
      .value = "FILE",
      .what =
          "the ground: a .png with heights as brightness, or a .glb or .gltf file, whose highest surface is used. Without IN, the pack holds the ground alone",
      .example = "hill.png" },
    { .name = "--terrain-size",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, terrain.size),
      .value = "M",
      .initial = "0",
      .what = "metres along x; 0: a metre per pixel for a picture, the model's own size for a model",
      .example = "64",
      .needs = "--terrain" },
    { .name = "--terrain-height",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, terrain.height),
      .value = "M",
      .initial = "0",
      .what = "metres from black to white; 0: a tenth of the size",
      .example = "8",
      .needs = "--terrain" },
    { .name = "--terrain-points",
      .kind = OPTION_NUMBER,
      .at = offsetof(build_args, terrain.points),
      .value = "N",
      .initial = "257",
      .what = "heights along the longer side of a model, 2 to 4097; a picture has one per pixel",
      .example = "129",
      .needs = "--terrain" },
    { .name = "--no-correctives",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, face.no_correctives),
      .what =
          "treat targets named after others (jawOpen_smile, jawOpen50) as ordinary targets, not as correctives and in-betweens",
      .excludes = "--only=anim" },
    { .name = "--rename",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, clips.rename),
      .value = "FILE",
      .what =
          "text file that maps joint names of clip files to the model's, lines of THEIRS OURS; a namespace, as in mixamorig7:Hips, is ignored anyway",
      .example = "mixamo.txt" },
    { .name = "--partial",
      .kind = OPTION_FLAG,
      .at = offsetof(build_args, clips.partial),
      .what =
          "accept clips if at least half of their joints, or half of the pack's, match; other joints keep the bind pose or are left out" },
    { .name = "--retarget",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, clips.retarget),
      .value = "auto|FILE",
      .what =
          "move clips of all other humanoids to the model's, as without the option those whose joints differ: bones by their names, feet on the ground, hands as far out; or also by a text file of lines BONE THEIRS OURS (VRM's names of bones) and 'reference FRAME', the frame that stands upright where the bind pose does not",
      .excludes = "--rename",
      .example = "auto" },
    { .name = "--unit-cm",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, clips.unit_cm),
      .value = "auto|CM",
      .initial = "auto",
      .what =
          "centimetres per unit of .bvh, .obj, .fbx, .trc and .c3d files, above 0; auto: 1 for .bvh, for .obj 100 or what the distance of the eyes tells, the file's unit for the others",
      .example = "2.54" },
    { .name = "--rest",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, clips.rest),
      .value = "bind|first-frame",
      .initial = "bind",
      .what = "rest pose of .bvh and .rcl files: the file's bind pose, or its first frame",
      .example = "first-frame" },
    { .name = "--facing",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, clips.facing),
      .value = "keep|auto|DEG",
      .initial = "keep",
      .what =
          "turn .bvh and .rcl files about +y: by degrees from +z towards +x; auto: so that the rest pose faces +z, judged by joints named left and right",
      .example = "auto" },
    { .name = "--clean",
      .kind = OPTION_TEXT,
      .at = offsetof(build_args, clips.clean),
      .value = "off|all|LIST",
      .initial = "off",
      .what =
          "clean up recorded clips, any of: gaps (fill them), jitter (filter out noise), root (move it by the feet if it stays in place), contacts (add a sync marker where a foot comes down), contact-keys (add a callback key there: noh help FORMATS); all: the first four",
      .example = "gaps,jitter",
      .excludes = "--only=mesh" },
};

const verb verb_build = {
    .name = "build",
    .files = "IN...",
    .what =
        "convert .gltf, .glb, .fbx, .obj, .bvh, .trc, .c3d, .csv and .rcl files to one pack: the first model, the clips of all",
    .example =
        "head.glb -o head.noh --lod 4\nbody.glb walk.bvh run.bvh -o body.noh --events keys.txt\nwalk.bvh -o walk.noh --error-cm 0.02 --clip-error walk=0.1\n--terrain hill.png -o hill.noh --terrain-size 64 --terrain-height 8",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = INPUTS_MAX,
    .without = "--terrain",
    .files_at = offsetof(build_args, inputs),
    .file_count_at = offsetof(build_args, input_count),
    .args = &arguments,
    .run = run,
};
