/* bench_look.c: what each part of a look costs, over the plain frame of the same run: maps, hair, light, wrinkles. The
 * pack is copied, and its materials lose all but the part that is measured. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "draw/picture.h"

#define SAMPLE_NS 3e7
#define EXPRESSION 0.1 /* weight of all targets: something is wrinkled */

/* The materials' original state. */
enum {
    KEEP_NORMAL = 1,
    KEEP_SURFACE = 2,
    KEEP_HAIR = 4,
    KEEP_AREA = 8,
    KEEP_REGION = 16,
    KEEP_CHANNEL = 32,
    KEEP_SKIN = 64,
    KEEP_EYE = 128,
    KEEP_TRANSFER = 256,
    KEEP_TEETH = 512,
    KEEP_EMISSIVE = 1024,
    KEEP_ALL = 2047
};

typedef struct look {
    const char *name;
    unsigned keeps;
    const char *light, *tonemap, *shadow, *background; /* as in light_options; light NULL: none */
} look;

static const look plain = { "plain", 0, NULL, NULL, NULL, NULL };
/* Each is compared with `plain`, drawn with light in an environment, whose cost is the first row. */
static const look looks[] = {
    { "normal-map", KEEP_NORMAL, NULL, NULL, NULL, NULL },
    { "surface-map", KEEP_SURFACE, NULL, NULL, NULL, NULL },
    { "hair", KEEP_HAIR, NULL, NULL, NULL, NULL },
    { "wrinkles-by-area", KEEP_AREA, NULL, NULL, NULL, NULL },
    { "wrinkles-by-region", KEEP_REGION, NULL, NULL, NULL, NULL },
    { "wrinkles-by-channel", KEEP_CHANNEL, NULL, NULL, NULL, NULL },
    { "environment", 0, "studio", "none", "off", "plain" },
    { "environment-shadow", 0, "studio", "none", "on", "plain" },
    { "environment-tonemap", 0, "studio", "filmic", "off", "plain" },
    { "environment-blob", 0, "studio", "none", "blob", "plain" },
    { "environment-backdrop", 0, "studio", "none", "off", "light" },
    { "environment-skin", KEEP_SKIN, "studio", "none", "off", "plain" },
    { "environment-eyes", KEEP_EYE, "studio", "none", "off", "plain" },
    { "environment-teeth", KEEP_TEETH, "studio", "none", "off", "plain" },
    { "emissive", KEEP_EMISSIVE, NULL, NULL, NULL, NULL },
    { "transfer", KEEP_TRANSFER, "studio", "none", "off", "plain" },
    { "all", KEEP_ALL, "studio", "filmic", "on", "light" },
};

/* ---- materials ---- */

static unsigned material_has(const noh_material *m)
{
    unsigned has = 0;
    if (m->normal_texture != NOH_NONE) has |= KEEP_NORMAL;
    if (m->surface_texture != NOH_NONE) has |= KEEP_SURFACE;
    if (m->flags & (NOH_MATERIAL_BLEND | NOH_MATERIAL_MASK)) has |= KEEP_HAIR;
    if (m->wrinkle_models & NOH_WRINKLE_BY_AREA) has |= KEEP_AREA;
    if (m->wrinkle_models & NOH_WRINKLE_BY_REGION) has |= KEEP_REGION;
    if (m->wrinkle_models & NOH_WRINKLE_BY_CHANNEL) has |= KEEP_CHANNEL;
    if (m->surface == NOH_SURFACE_SKIN) has |= KEEP_SKIN;
    if (m->surface == NOH_SURFACE_EYE) has |= KEEP_EYE;
    if (m->surface == NOH_SURFACE_TEETH) has |= KEEP_TEETH;
    if (m->emissive_texture != NOH_NONE || m->emissive[0] + m->emissive[1] + m->emissive[2] > 0.0f)
        has |= KEEP_EMISSIVE;
    return has;
}

static unsigned pack_has(const noh_pack *pack)
{
    unsigned has = pack->runs[NOH_CHUNK_TRANSFER].count ? KEEP_TRANSFER : 0;
    for (uint32_t i = 0; i < pack->material_count; i++) has |= material_has(&pack->materials[i]);
    return has;
}

static unsigned keep_of_surface(uint32_t surface)
{
    return surface == NOH_SURFACE_SKIN    ? KEEP_SKIN
           : surface == NOH_SURFACE_EYE   ? KEEP_EYE
           : surface == NOH_SURFACE_TEETH ? KEEP_TEETH
           : surface == NOH_SURFACE_HAIR  ? KEEP_HAIR
                                          : 0u;
}

static void strip_material(noh_material *m, unsigned keeps)
{
    if (!(keeps & KEEP_NORMAL)) m->normal_texture = NOH_NONE;
    if (!(keeps & KEEP_SURFACE)) m->surface_texture = NOH_NONE;
    if (!(keeps & KEEP_HAIR)) m->flags &= ~(NOH_MATERIAL_BLEND | NOH_MATERIAL_MASK);
    if (!(keeps & KEEP_AREA)) m->wrinkle_models &= (uint16_t)~NOH_WRINKLE_BY_AREA;
    if (!(keeps & KEEP_REGION)) m->wrinkle_models &= (uint16_t)~NOH_WRINKLE_BY_REGION;
    if (!(keeps & KEEP_CHANNEL)) m->wrinkle_models &= (uint16_t)~NOH_WRINKLE_BY_CHANNEL;
    if (!m->wrinkle_models) m->wrinkle_texture = NOH_NONE;
    if (!(keeps & keep_of_surface(m->surface))) m->surface = NOH_SURFACE_PLAIN;
    if (!(keeps & KEEP_EMISSIVE)) {
        m->emissive_texture = NOH_NONE;
        memset(m->emissive, 0, sizeof m->emissive);
    }
}

/* ---- a frame ---- */

typedef struct scene {
    void *bytes; /* of the copy */
    pack_file file;
    lighting light;
    picture picture;
    noh_gl_camera camera;
    noh_stage_view views[2];
    uint32_t view_count;
    int is_open, is_lit, failed;
} scene;

static int copy_pack(scene *s, const pack_file *from, unsigned keeps)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    s->bytes = malloc(from->pack.byte_count);
    s->file.path = from->path;
    if (!s->bytes) {
        return tool_fail(from->path, "out of memory");
    }
    memcpy(s->bytes, from->pack.bytes, from->pack.byte_count);
    if (noh_pack_open(s->bytes, from->pack.byte_count, &s->file.pack, &error)) {
        return tool_fail_error(from->path, &error);
    }
    for (uint32_t i = 0; i < s->file.pack.material_count; i++) {
        const size_t at = (size_t)((const uint8_t *)&s->file.pack.materials[i] - (const uint8_t *)s->bytes);
        strip_material((noh_material *)((uint8_t *)s->bytes + at), keeps);
    }
    return 0;
}

static int open_light(scene *s, const look *l)
{
    const light_options o = { l->light,      l->tonemap, l->shadow, l->keeps & KEEP_TRANSFER ? "on" : "off",
                              l->background, 0.0,        0.0 };
    int status = 0;
    if (l->light) {
        status = lighting_open(&s->light, &o);
        s->is_lit = !status;
    }
    return status;
}

static void close_scene(scene *s)
{
    if (s->is_open) picture_close(&s->picture);
    if (s->is_lit) lighting_close(&s->light);
    free(s->bytes);
}

static int pose_scene(scene *s)
{
    const view_options view = { "face", BENCH_FRAME_SIZE, BENCH_FRAME_SIZE, 0, 0.0 };
    figure *f = &s->picture.figure;
    int status = figure_hold_all(f, EXPRESSION);
    if (!status) status = figure_pose(f);
    if (!status) {
        const bounds box = picture_bounds(&s->picture, FRAME_FACE);
        status = view_camera(&view, &box, &s->camera);
    }
    if (!status) s->view_count = figure_views(f, &s->camera, BENCH_FRAME_SIZE, s->views);
    return status;
}

static int open_scene(scene *s, bench_job *job, const look *l)
{
    figure_desc d;
    int status;
    memset(s, 0, sizeof *s);
    status = copy_pack(s, &job->files[0], l->keeps);
    if (!status) status = open_light(s, l);
    if (status) {
        return status;
    }
    memset(&d, 0, sizeof d);
    d.file = &s->file;
    d.held_float_count = FIGURE_HELD_ALL;
    d.level = figure_level_first(&s->file.pack);
    d.light = s->is_lit ? &s->light : NULL;
    status = picture_open(&s->picture, &job->g, &d, 0, BENCH_FRAME_SIZE, BENCH_FRAME_SIZE);
    s->is_open = !status;
    return status ? status : pose_scene(s);
}

/* Where the shadow falls is known beforehand: to find it is the tool's work, not the library's. */
static void run_frame(void *self, uint32_t number)
{
    scene *s = self;
    figure *f = &s->picture.figure;
    (void)number;
    s->failed |= figure_frame(f, s->views, s->view_count) || figure_shade(f);
    canvas_begin(&s->picture.canvas);
    s->failed |= figure_draw(f);
}

/* ---- rows ---- */

static int measure(bench_job *job, const look *l)
{
    scene *scenes = calloc(2, sizeof *scenes); /* a figure must not move */
    bench_cells cells = { NULL, 0, 0, 0, 0 };
    char name[64];
    int status = scenes ? open_scene(&scenes[0], job, &plain) : tool_fail(job->files[0].path, "out of memory");
    snprintf(name, sizeof name, "look/%s", l->name);
    if (!status) status = open_scene(&scenes[1], job, l);
    if (!status) {
        for (int i = 0; i < 2; i++) bench_add_cell(&cells, run_frame, &scenes[i]);
        status = bench_run_cells(&cells, &job->gl_clock, job->rounds, SAMPLE_NS, name);
    }
    if (!status && (scenes[0].failed || scenes[1].failed)) status = EXIT_FAILED;
    if (!status) {
        bench_add_row(&job->rows, name, plain.name, 1e-6 * bench_median(&cells, 0), 1e-6 * bench_median(&cells, 1),
                      "ms", cells.rounds);
    }
    bench_free_cells(&cells);
    for (int i = 0; scenes && i < 2; i++) close_scene(&scenes[i]);
    free(scenes);
    return status;
}

int bench_look(bench_job *job)
{
    const unsigned has = pack_has(&job->files[0].pack);
    int status = 0;
    for (size_t i = 0; i < sizeof looks / sizeof looks[0] && !status; i++) {
        const unsigned keeps = looks[i].keeps;
        if (!keeps || keeps == KEEP_ALL || keeps & has) status = measure(job, &looks[i]);
    }
    return status;
}
