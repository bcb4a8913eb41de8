/* bench_face.c: rows face/: a thousand living faces, from the clock to weights of a mesh's targets, against a
 * thousand controllers of two tracks that only step. */
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "life/face/recipe_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/face.h"
#include "noh/pack.h"

#define SAMPLE_NS 5e6
#define FACES 1000u
#define FRAME_TICKS 800u /* 60 frames a second */
#define LINKS_MAX 1024u

typedef struct face_bench {
    noh_face_desc desc;
    noh_face *faces; /* [FACES] */
    noh_face_pose pose;
    noh_face_rules rules;
    noh_face_link links[LINKS_MAX];
    uint32_t link_count, target_count;
    float channels[NOH_CHANNEL_COUNT];
    float weights[NOH_TARGETS_MAX];
    noh_clip_entry clips[2];
    noh_clip_set set;
    noh_transform none;
    size_t controller_bytes;
    uint8_t *controllers; /* [FACES][controller_bytes] */
    const void *volatile seen;
} face_bench;

/* ---- timed code ---- */

static void run_controllers(void *self, uint32_t frame)
{
    face_bench *b = self;
    (void)frame;
    for (size_t i = 0; i < FACES; i++) {
        noh_controller *c = (noh_controller *)(void *)(b->controllers + i * b->controller_bytes);
        noh_controller_step(c, &b->set, FRAME_TICKS, NULL, NULL);
        b->seen = c;
    }
}

static void run_steps(void *self, uint32_t frame)
{
    face_bench *b = self;
    (void)frame;
    for (uint32_t i = 0; i < FACES; i++) {
        noh_face_step(&b->faces[i], &b->desc, FRAME_TICKS);
        b->seen = &b->faces[i];
    }
}

static void run_faces(void *self, uint32_t frame)
{
    face_bench *b = self;
    (void)frame;
    for (uint32_t i = 0; i < FACES; i++) {
        noh_face_step(&b->faces[i], &b->desc, FRAME_TICKS);
        noh_face_pose_of(&b->faces[i], &b->desc, &b->pose);
        noh_face_channels(&b->pose, NULL, NOH_MOUTH_NONE, b->channels);
        noh_face_share(&b->rules, 0.0f, 0.0f, b->channels);
        memset(b->weights, 0, b->target_count * sizeof *b->weights);
        noh_face_apply(b->links, b->link_count, b->channels, b->weights);
        b->seen = b->weights;
    }
}

/* ---- making ---- */

static int make_faces(face_bench *b)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (int e = 0; e < 2; e++) {
        b->desc.eyes[e][0] = e ? -0.032f : 0.032f;
        b->desc.eyes[e][1] = 0.09f;
        b->desc.eyes[e][2] = 0.08f;
    }
    b->faces = calloc(FACES, sizeof *b->faces);
    for (uint32_t i = 0; b->faces && i < FACES; i++) {
        const float point[3] = { (float)(i % 7u) - 3.0f, 0.1f, 2.0f };
        if (noh_face_init(&b->faces[i], &b->desc, i, 0, &error) ||
            noh_face_look_at(&b->faces[i], &b->desc, point, &error) ||
            noh_face_set_emotion(&b->faces[i], (noh_emotion)(i % NOH_EMOTION_COUNT), 0.5f, 0, 0, 0, &error)) {
            return tool_fail_error("bench", &error);
        }
    }
    return b->faces ? 0 : tool_fail("bench", "out of memory");
}

/* Steps do not sample. */
static void sample_nothing(void *user, uint32_t clip, uint32_t tick, uint32_t joints, noh_transform *pose,
                           uint32_t floats, float *values)
{
    (void)user, (void)clip, (void)tick, (void)joints, (void)pose;
    memset(values, 0, floats * sizeof *values);
}

/* Each on two tracks at their own speeds, one of them fading. */
static int make_controllers(face_bench *b)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_controller_desc desc;
    memset(&desc, 0, sizeof desc);
    for (int i = 0; i < 2; i++) {
        b->clips[i].duration_ticks = 48000u * (uint32_t)(i + 1);
        b->clips[i].loop = NOH_LOOP_REPEAT;
    }
    b->set.clips = b->clips;
    b->set.clip_count = 2;
    b->set.float_count = 1;
    b->set.bind_pose = &b->none;
    b->set.sample = sample_nothing;
    desc.set = &b->set;
    desc.track_count = 2;
    b->controller_bytes = noh_controller_size(&desc);
    b->controllers = b->controller_bytes ? malloc(FACES * b->controller_bytes) : NULL;
    for (uint32_t i = 0; b->controllers && i < FACES; i++) {
        noh_controller *c;
        if (noh_controller_init(b->controllers + i * b->controller_bytes, b->controller_bytes, &desc, &c, &error)) {
            return tool_fail_error("bench", &error);
        }
        for (uint32_t t = 0; t < 2; t++) {
            noh_track_desc track;
            memset(&track, 0, sizeof track);
            track.clip = t;
            track.speed = 60000 + (int32_t)(i % 13u) * 500;
            track.weight = 0.5f;
            if (noh_controller_start(c, &b->set, t, &track, &error)) return tool_fail_error("bench", &error);
        }
    }
    return b->controllers ? 0 : tool_fail("bench", "out of memory");
}

static void bind(face_bench *b, const noh_mesh *mesh)
{
    const noh_face_recipe own = noh_face_recipe_in_pack(mesh->pack);
    const noh_face_recipe *const recipes[4] = { &own, &noh_face_recipe_arkit, &noh_face_recipe_vrm,
                                                &noh_face_recipe_units };
    const char *names[NOH_TARGETS_MAX];
    b->target_count = mesh->header->target_count;
    for (uint32_t t = 0; t < b->target_count; t++) names[t] = noh_pack_string(mesh->pack, mesh->targets[t].name);
    b->link_count = noh_face_recipe_bind(recipes, 4, names, b->target_count, b->links, LINKS_MAX);
    b->link_count = b->link_count < LINKS_MAX ? b->link_count : LINKS_MAX;
}

static int measure(bench_job *job, face_bench *b)
{
    bench_cells cells = { NULL, 0, 0, 0, 0 };
    const uint32_t beside = bench_add_cell(&cells, run_controllers, b), step = bench_add_cell(&cells, run_steps, b),
                   whole = bench_add_cell(&cells, run_faces, b);
    const int status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "faces");
    if (!status) {
        const double controllers = bench_median(&cells, beside) / FACES;
        bench_add_row(&job->rows, "face/step", "noh_controller_step", controllers, bench_median(&cells, step) / FACES,
                      "ns", cells.rounds);
        bench_add_row(&job->rows, "face/weights", "noh_controller_step", controllers,
                      bench_median(&cells, whole) / FACES, "ns", cells.rounds);
    }
    bench_free_cells(&cells);
    return status;
}

int bench_face(bench_job *job)
{
    face_bench *b = calloc(1, sizeof *b);
    int status;
    if (!b) {
        return tool_fail("bench", "out of memory");
    }
    status = make_faces(b);
    if (!status) status = make_controllers(b);
    if (!status) {
        bind(b, &job->mesh);
        status = measure(job, b);
    }
    free(b->faces);
    free(b->controllers);
    free(b);
    return status;
}
