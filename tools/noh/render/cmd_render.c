/* cmd_render.c: one picture. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/facing.h"
#include "draw/picture.h"
#include "gpu/gpu_args.h"
#include "cli/json.h"
#include "cli/message.h"
#include "file/png_file.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"
#include "convert/base/input_file.h"
#include "sheet/sheet_faces.h"

typedef struct render_args {
    const char *pack, *output, *pose, *path, *accumulate, *driver, *debug, *joint, *face, *springs, *hair, *wind, *tier,
        *decal_kind;
    uint32_t size[2];
    double person, time_s, lod, turn, swing;
    int show_bones, as_json;
    debug_kind shows;
    option_list weights, clips, anims, emotions, decals;
    figure_mark marks[NOH_DECALS_MAX];
    view_options view;
    light_options light;
    body_options body_wants;
    figure_desc figure;
    figure_body body;
    char own_output[256];
    int rests; /* 1: no clip was asked for */
} render_args;

static int check_body(render_args *a)
{
    int wanted;
    const int status = figure_body_parse(&a->body_wants, &a->body, &wanted);
    a->figure.body = wanted ? &a->body : NULL;
    a->view.around = a->body.has_ground;
    return status;
}

/* X,Y,Z: each as noh_hair_carrier has it. */
static int parse_wind(const char *text, float wind[3])
{
    char end;
    if (sscanf(text, "%f,%f,%f%c", &wind[0], &wind[1], &wind[2], &end) == 3 && fabsf(wind[0]) <= 100.0f &&
        fabsf(wind[1]) <= 100.0f && fabsf(wind[2]) <= 100.0f) {
        return 0;
    }
    return tool_usage("--wind must be X,Y,Z, each -100 to 100, not '%s'", text);
}

/* The picture's name without -o: the pack's, in the working folder. */
static int name_output(render_args *a)
{
    char *stem = a->output ? NULL : input_stem(a->pack);
    if (a->output) return 0;
    if (!stem) return tool_fail(a->pack, "out of memory");
    snprintf(a->own_output, sizeof a->own_output, "%s.png", stem);
    free(stem);
    a->output = a->own_output;
    return 0;
}

/* How it stands that no clip poses, once packs of clips are open. */
static int choose_pose(render_args *a, const noh_pack *pack)
{
    const int rest = strcmp(a->pose, "rest") == 0;
    if (!rest && strcmp(a->pose, "auto") != 0) return tool_usage("--pose must be auto or rest, not '%s'", a->pose);
    a->rests = !a->clips.count;
    if (rest || a->body.has_ground || a->show_bones || !figure_draws(pack)) return 0;
    if (!a->rests && !figure_rests(&a->figure, &a->clips)) return 0;
    const char *idle = a->rests ? figure_idle_clip(pack) : NULL;
    if (idle) a->clips.items[a->clips.count++] = idle;
    a->figure.stands = !idle;
    return 0;
}

static int check_args(render_args *a)
{
    int springs = 1;
    int status = parse_path(a->path, &a->figure.path);
    if (!status) status = parse_accumulate(a->accumulate, &a->figure.accumulate);
    if (!status) status = debug_parse(a->debug, &a->shows);
    if (!status && a->joint && a->shows != DEBUG_WEIGHTS) status = tool_usage("--joint needs --debug weights");
    a->figure.view = debug_view_of(a->shows);
    if (!status) status = parse_level(a->lod, &a->figure.level);
    if (!status) status = tool_switch("--face", a->face, &a->figure.alive);
    if (!status) status = tool_switch("--springs", a->springs, &springs);
    if (!status) status = figure_tier(a->tier, &a->figure.shading);
    a->figure.without_springs = !springs;
    if (!status) status = check_body(a);
    if (!status) status = tool_switch("--hair", a->hair, &a->figure.hair);
    if (!status) status = figure_read_marks(&a->decals, a->decal_kind, a->marks, &a->figure);
    if (!status && a->wind) status = parse_wind(a->wind, a->figure.wind);
    if (!status && a->clips.count > (int)NOH_LAYER_TRACKS_MAX) {
        status = tool_usage("--clip may be given at most %u times", NOH_LAYER_TRACKS_MAX);
    }
    if (!status && !(a->person >= 0.0 && a->person < 4294966000.0 && a->person == floor(a->person))) {
        status = tool_usage("--person must be a whole number from 1 to 4294965999");
    }
    if (!status && !(a->swing >= 0.0 && a->swing <= 60.0)) status = tool_usage("--swing must be 0 to 60 seconds");
    a->view.width = a->size[0];
    a->view.height = a->size[1];
    if (!status && a->as_json && a->output && report_stream(a->output) != stdout) {
        status = tool_usage("--json and -o both write to stdout");
    }
    return status;
}

static void json_vector(json *j, const char *key, const float v[3])
{
    json_open(j, key, '[');
    for (int i = 0; i < 3; i++) json_number(j, NULL, (double)v[i]);
    json_close(j, ']');
}

/* What another renderer needs for the same picture. */
static int print_json(const render_args *a, const noh_gl_camera *camera)
{
    const float *m = camera->view_projection;
    json j = json_begin();
    json_text(&j, "picture", a->output);
    json_integer(&j, "width", a->size[0]);
    json_integer(&j, "height", a->size[1]);
    json_open(&j, "camera", '{');
    json_vector(&j, "eye", camera->eye);
    json_vector(&j, "forward", (const float[3]){ m[3], m[7], m[11] }); /* of the row of w */
    json_number(&j, "view_deg", ORBIT_VIEW_RAD * 57.29577951308232);
    json_close(&j, '}');
    if (a->figure.light) {
        const noh_lighting *told = &a->figure.light->told;
        json_open(&j, "light", '{');
        json_text(&j, "name", a->figure.light->name);
        json_number(&j, "exposure", (double)told->exposure);
        json_vector(&j, "key_direction", told->key_direction);
        json_close(&j, '}');
    }
    return json_end(&j);
}

/* Once the picture is written. plan: NULL where bones were drawn. */
static void print_done(const render_args *a, const noh_gl_morph_plan *plan)
{
    FILE *out = report_stream(a->output);
    if (!plan) {
        fprintf(out, "%s: %ux%u, bones\n", a->output, a->size[0], a->size[1]);
        return;
    }
    fprintf(out, "%s: %ux%u, %s-%s (%s)\n", a->output, a->size[0], a->size[1], noh_morph_path_name(plan->path),
            noh_accumulate_name(plan->accumulate), plan->reason);
}

/* On the figure at rest, as the camera would see it. */
static int strike(picture *p, const render_args *a)
{
    noh_gl_camera camera;
    int status = a->figure.mark_count ? figure_pose(&p->figure) : 0;
    if (status || !a->figure.mark_count) return status;
    const bounds box = picture_bounds(p, figure_framed(&p->figure, view_frame_of(&a->view), &a->clips));
    status = view_camera(&a->view, &box, &camera);
    return status ? status : figure_strike(&p->figure, &camera, a->size[0], a->size[1]);
}

/* The person of a seed; 0: as it was modelled. */
static int take_person(picture *p, const render_args *a)
{
    sheet_faces faces;
    int status = a->person > 0.0 ? sheet_faces_open(&faces, a->figure.file) : 0;
    if (status || !(a->person > 0.0)) return status;
    status = sheet_faces_hold(&faces, &p->figure, (uint32_t)a->person, 0);
    sheet_faces_close(&faces);
    return status;
}

#define FELT_S 0.01 /* by then an emotion has come */

static int draw(picture *p, const render_args *a, noh_gl_camera *camera, uint8_t *rgba)
{
    const int alive = a->figure.alive;
    const int lives = alive || a->figure.stands || a->body.has_ground;
    const double life_s = alive && a->emotions.count ? fmax(a->time_s, FELT_S) : a->time_s;
    const int hangs = !alive && !a->body.has_ground && a->rests && p->figure.hair.is_there;
    int status = p->shows_bones ? 0 : take_person(p, a);
    if (!status && !p->shows_bones) status = strike(p, a);
    if (!status) status = figure_play_options(&p->figure, &a->clips, lives ? 0.0 : a->time_s);
    if (!status && alive) status = figure_feel(&p->figure, &a->emotions);
    if (!status && (lives || hangs))
        status = figure_live(&p->figure, (lives ? life_s : 0.0) + (hangs ? a->swing : 0.0), a->turn);
    if (!status) status = figure_hold_options(&p->figure, &a->weights);
    if (!status) status = figure_pose(&p->figure);
    if (!status) {
        const bounds box = picture_bounds(p, figure_framed(&p->figure, view_frame_of(&a->view), &a->clips));
        if (p->figure.shows_floor) figure_fit_floor(&p->figure, figure_bounds(&p->figure, FRAME_FULL).low[1]);
        status = view_camera(&a->view, &box, camera);
    }
    return status ? status : picture_read(p, camera, rgba);
}

static int draw_and_write(gpu *g, const render_args *a, int shows_bones)
{
    picture p;
    noh_gl_camera camera;
    uint8_t *rgba = malloc((size_t)a->size[0] * a->size[1] * 4);
    noh_gl_morph_plan plan;
    int status = rgba ? picture_open(&p, g, &a->figure, shows_bones, a->size[0], a->size[1])
                      : tool_fail(a->output, "out of memory");
    if (!status) {
        const figure *f = &p.figure;
        status = picture_debug(&p, g, a->shows, a->joint);
        if (!status) status = draw(&p, a, &camera, rgba);
        if (!shows_bones) (void)noh_stage_morph_plan(&f->stage_desc, &g->caps, &f->plan, &plan, NULL);
        picture_close(&p);
    }
    if (!status) status = tool_write_png(a->output, a->size[0], a->size[1], rgba);
    if (!status && a->as_json) status = print_json(a, &camera);
    if (!status && !a->as_json) print_done(a, shows_bones ? NULL : &plan);
    free(rgba);
    return status;
}

static int render(render_args *a, const pack_file *file)
{
    figure_anims anims = { .count = 0 };
    lighting light;
    gpu g;
    const int shows_bones = picture_shows_bones(file, a->show_bones);
    const int lit = a->figure.view == NOH_VIEW_LIT && a->shows != DEBUG_JOINTS && a->shows != DEBUG_WEIGHTS;
    int status = shows_bones < 0 ? EXIT_FAILED : 0;
    if (view_frames(&a->view)) a->view.facing = pack_facing(&file->pack);
    a->light.facing = a->view.facing;
    if (!status && lighting_wanted(&a->light, &file->pack, !shows_bones && lit)) {
        status = lighting_open(&light, &a->light);
        if (status) return status;
        a->figure.light = &light;
    }
    a->figure.file = file;
    if (!status && a->clips.count) status = figure_open_anims(&anims, &a->anims, file, &a->figure);
    if (!status) status = choose_pose(a, &file->pack);
    if (!status && a->clips.count && !a->figure.clips) status = figure_open_anims(&anims, &a->anims, file, &a->figure);
    a->figure.track_count = (uint32_t)a->clips.count;
    a->figure.face_layer = a->clips.count > 1;
    a->figure.held_float_count = a->person > 0.0 ? FIGURE_HELD_ALL : (uint32_t)a->weights.count;
    a->figure.complexions = a->person > 0.0;
    if (!status) status = gpu_open_drawing(&g, a->driver);
    if (!status) {
        status = draw_and_write(&g, a, shows_bones);
        gpu_close(&g);
    }
    figure_close_anims(&anims);
    if (a->figure.light) lighting_close(&light);
    return status;
}

static int run(void *args)
{
    render_args *a = args;
    pack_file file;
    int status = check_args(a);
    if (!status) {
        status = pack_file_open_draft(&file, a->pack);
        if (!status) {
            status = name_output(a);
            if (!status) status = render(a, &file);
            pack_file_close(&file);
        }
    }
    figure_body_free(&a->body);
    return status;
}

static render_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(render_args, output),
      .value = "OUT.png",
      .what = "the picture; default: the pack's name with .png, in the working folder",
      .example = "face.png" },
    { .name = "--size",
      .kind = OPTION_SIZE,
      .at = offsetof(render_args, size),
      .value = "WxH",
      .initial = "1024x1024",
      .what = "size of the picture, pixels, 1 to 8192 each",
      .example = "1280x720" },
    OPTION_WEIGHT(render_args, weights, .excludes = "--bones"),
    OPTION_CLIP(render_args, clips, .needs = NULL),
    { .name = "--time",
      .kind = OPTION_NUMBER,
      .at = offsetof(render_args, time_s),
      .value = "S",
      .initial = "0",
      .what = "time in the clips, and how long a face (--face on) or a body without clips has lived, seconds",
      .example = "0.5" },
    OPTION_ANIMS(render_args, anims, .needs = "--clip"),
    { .name = "--pose",
      .kind = OPTION_TEXT,
      .at = offsetof(render_args, pose),
      .value = "auto|rest",
      .initial = "auto",
      .what = "how a figure stands if no --clip moves its joints: auto, as in the first frame of a clip named idle, "
              "otherwise with its arms lowered; rest, as it was modelled",
      .example = "rest" },
    OPTION_FACE(render_args, face, "off"),
    OPTION_FEEL(render_args, emotions, .needs = "--face"),
    { .name = "--person",
      .kind = OPTION_NUMBER,
      .at = offsetof(render_args, person),
      .value = "SEED",
      .what = "another person, by a whole number from 1 on: colours of skin, hair and eyes, and the mesh's identity "
              "targets (noh sheet --faces shows many)",
      .example = "7" },
    OPTION_SPRINGS(render_args, springs),
    OPTION_WEIGHT_RULES(render_args, figure.weight_rules),
    OPTIONS_BODY(render_args, body_wants),
    OPTION_HAIR(render_args, hair, "on"),
    { .name = "--wind",
      .kind = OPTION_TEXT,
      .at = offsetof(render_args, wind),
      .value = "X,Y,Z",
      .what = "mean wind on the hair, as an acceleration in metres per second squared",
      .example = "4,0,-2" },
    { .name = "--turn",
      .kind = OPTION_NUMBER,
      .at = offsetof(render_args, turn),
      .value = "DEG",
      .initial = "0",
      .what =
          "turn the head at this rate, degrees a second, before the picture, if no clip plays; it ends in the same place",
      .example = "180" },
    { .name = "--swing",
      .kind = OPTION_NUMBER,
      .at = offsetof(render_args, swing),
      .value = "S",
      .initial = "2",
      .what = "how long hair moves before the picture, seconds, if no clip plays",
      .example = "0.5" },
    OPTIONS_DECALS(render_args, decals, decal_kind, "--bones"),
    OPTION_CAMERA(render_args, view.camera, "auto"),
    OPTION_LOD(render_args, lod, .excludes = "--bones"),
    OPTIONS_LIGHT(render_args, light, "auto", .excludes = "--bones"),
    OPTION_TIER(render_args, tier, .excludes = "--bones"),
    { .name = "--bones",
      .kind = OPTION_FLAG,
      .at = offsetof(render_args, show_bones),
      .what = "draw the skeletons instead of the meshes; implied if the pack has no meshes" },
    { .name = "--debug",
      .kind = OPTION_TEXT,
      .at = offsetof(render_args, debug),
      .value = DEBUG_VALUES,
      .initial = "none",
      .what =
          "show this as colours instead of lighting; joints: which joints move each vertex; weights: the weight of one joint. wireframe and bones are drawn over the lit figure",
      .excludes = "--bones" },
    { .name = "--joint",
      .kind = OPTION_TEXT,
      .at = offsetof(render_args, joint),
      .value = "NAME",
      .what = "the joint for --debug weights; default: the joint that moves the most vertices",
      .example = "Head",
      .needs = "--debug" },
    OPTION_PATH(render_args, path, .initial = "auto", .excludes = "--bones"),
    OPTION_ACCUMULATE(render_args, accumulate, .initial = "auto", .excludes = "--bones"),
    OPTION_DRIVER(render_args, driver, .initial = "egl"),
    OPTION_JSON(render_args, as_json),
};

const verb verb_render = {
    .name = "render",
    .files = "PACK|MODEL",
    .what = "draw a picture of a pack",
    .example =
        "face.noh\nface.noh -o face.png --weight smile=1 --camera face,20,5\nbody.noh -o walk.png --clip walk --time 0.5",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(render_args, pack),
    .args = &arguments,
    .run = run,
};
