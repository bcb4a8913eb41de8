/* A camera that follows keeps a figure in the picture (tools/noh/draw/framing.h): at every frame of every clip of a
 * body, at least 95 % of its silhouette (draw/silhouette.h). Without NOH_LONG every fourth frame is looked at,
 * under sanitizers every sixteenth. */
#include "draw/framing.h"
#include "draw/silhouette.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "support/support.h"

#define SEEN_LEAST 0.95

typedef struct scene {
    byte_buffer bytes;
    pack_file file;
    figure figure;
    framing *framing;
} scene;

static void open_scene(scene *s, const char *asset)
{
    const char *inputs[1] = { test_asset(asset) };
    const convert_options options = { .morph = { .error_um = 100.0f },
                                      .clip = { .clip = { .error_cm = 0.1, .shell_cm = 3.0 } },
                                      .source = { .unit_cm = 1.0 } };
    figure_desc desc = { .file = &s->file, .clips = &s->file };
    convert_failure failure;
    memset(&s->bytes, 0, sizeof s->bytes);
    assert_int_equal(convert_files(inputs, 1, &options, &s->bytes, &failure), 0);
    s->file.path = inputs[0];
    assert_int_equal(noh_pack_open(s->bytes.bytes, s->bytes.count, &s->file.pack, NULL), NOH_OK);
    assert_int_equal(figure_open(&s->figure, &desc, NULL), 0);
    s->framing = framing_open(&desc);
    assert_non_null(s->framing);
}

static void close_scene(scene *s)
{
    framing_close(s->framing);
    figure_close(&s->figure);
    buffer_free(&s->bytes);
    free(s);
}

/* ---- clips ---- */

static double watch(scene *s, const char *clip, double azimuth, double aspect, double *largest)
{
    const noh_play play = { .loop = NOH_LOOP_ONCE };
    const uint32_t step = getenv("NOH_LONG") ? 1u : test_is_sanitized() ? 16u : 4u;
    orbit o = { azimuth, 0.05, 0.0, { 0.0, 0.0, 0.0 }, 0.0, aspect };
    double anchor[3], before[3] = { 0.0, 0.0, 0.0 }, seconds, worst = 1.0;
    bounds box;
    assert_int_equal(framing_clip(s->framing, clip, &box), 1);
    orbit_frame(&o, &box, ORBIT_MARGIN);
    assert_int_equal(figure_reset(&s->figure), 0);
    assert_int_equal(figure_play(&s->figure, clip, &play), 0);
    assert_int_equal(figure_clip_seconds(&s->figure, clip, &seconds), 0);
    for (uint32_t frame = 0; frame <= (uint32_t)(seconds * 30.0); frame += step) {
        noh_gl_camera camera;
        silhouette seen;
        const uint32_t ticks = frame ? step * (uint32_t)(NOH_TICKS_PER_SECOND / 30) : 1u;
        assert_int_equal(noh_stage_step(s->figure.stage, ticks, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(figure_pose(&s->figure), 0);
        figure_anchor(&s->figure, anchor);
        for (int c = 0; c < 3; c++) o.center[c] += anchor[c] - before[c];
        memcpy(before, anchor, sizeof before);
        orbit_camera(&o, &camera);
        assert_int_equal(silhouette_measure(&s->figure, &camera, 0, &seen), 0);
        worst = fmin(worst, seen.inside);
        *largest = fmax(*largest, seen.height); /* so that a camera from too far away does not pass */
    }
    return worst;
}

static void every_clip_stays_in_the_picture(void **state)
{
    scene *s = calloc(1, sizeof *s);
    uint32_t clips = 0;
    (void)state;
    assert_non_null(s);
    open_scene(s, "hero/body.glb");
    for (uint32_t i = 0; i < s->file.pack.runs[NOH_CHUNK_CLIP].count; i++) {
        const double azimuths[] = { 0.0, 0.0, 2.2 }, aspects[] = { 620.0 / 668.0, 390.0 / 844.0, 16.0 / 9.0 };
        noh_pack_clip clip;
        assert_int_equal(noh_pack_clip_at(&s->file.pack, i, &clip, NULL), NOH_OK);
        if (!clip.header->joint_count) { /* of a face: there is nothing to follow */
            bounds box;
            assert_int_equal(framing_clip(s->framing, clip.name, &box), 0);
            continue;
        }
        for (int view = 0; view < (getenv("NOH_LONG") ? 3 : 1); view++) {
            const int at = getenv("NOH_LONG") ? view : (int)(i % 3u);
            double largest = 0.0;
            const double worst = watch(s, clip.name, azimuths[at], aspects[at], &largest);
            print_message("%s, aspect %.2f: at least %.1f %% of the silhouette is inside, it is up to %.0f %% high\n",
                          clip.name, aspects[at], 100.0 * worst, 100.0 * largest);
            if (worst < SEEN_LEAST) fail_msg("%s: %.3f of the silhouette", clip.name, worst);
            assert_true(largest > (aspects[at] < 0.6 ? 0.3 : 0.55));
        }
        clips++;
    }
    assert_true(clips >= 7);
    close_scene(s);
}

static void all_corners_of_a_box_are_seen(void **state)
{
    (void)state;
    for (int i = 0; i < 200; i++) {
        const bounds box = { { -0.3 * (i % 5), 0.1, -2.0 + 0.01 * i }, { 0.4, 1.0 + 0.2 * (i % 3), -1.5 + 0.02 * i } };
        orbit o = { 0.3 * i, -1.0 + 0.01 * i, 0.0, { 9.0, 9.0, 9.0 }, 0.0, 0.4 + 0.01 * i };
        noh_gl_camera camera;
        float most = 0.0f;
        orbit_frame(&o, &box, ORBIT_MARGIN);
        orbit_camera(&o, &camera);
        for (int corner = 0; corner < 8; corner++) {
            const double *side[3];
            float clip[4];
            for (int c = 0; c < 3; c++) side[c] = corner >> c & 1 ? &box.high[c] : &box.low[c];
            for (int r = 0; r < 4; r++) {
                const float *m = camera.view_projection;
                clip[r] = m[r] * (float)*side[0] + m[4 + r] * (float)*side[1] + m[8 + r] * (float)*side[2] + m[12 + r];
            }
            assert_true(clip[3] > 0.0f && fabsf(clip[2]) < clip[3]);
            most = fmaxf(most, fmaxf(fabsf(clip[0]), fabsf(clip[1])) / clip[3]);
        }
        assert_true(most < 0.953f && most > 0.6f);
    }
}

/* A body stands while only its face has clips. */
static void a_body_stands_unless_a_clip_moves_it(void **state)
{
    static const char *const packs[] = { "demo/nell.noh", "demo/puppet.noh" };
    const char *build = getenv("NOH_BUILD");
    const option_list none = { .count = 0 },
                      idle = { { "idle" }, 1 }; /* of the face in one, of the body in the other */
    pack_file files[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        char path[1024];
        (void)snprintf(path, sizeof path, "%s/%s", build ? build : "build", packs[i]);
        assert_int_equal(pack_file_open(&files[i], path), 0);
        const figure_desc desc = { .file = &files[i], .clips = &files[i] };
        assert_int_equal(figure_rests(&desc, &none), 1);
        assert_int_equal(figure_rests(&desc, &idle), i == 0);
        assert_int_equal(figure_rests(&desc, NULL), i == 0);
    }
    const figure_desc more = { .file = &files[0], .clips = &files[0], .more_clips = &files[1], .more_clip_count = 1 };
    assert_int_equal(figure_rests(&more, &idle), 0);
    for (int i = 0; i < 2; i++) pack_file_close(&files[i]);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(every_clip_stays_in_the_picture),
                                        cmocka_unit_test(all_corners_of_a_box_are_seen),
                                        cmocka_unit_test(a_body_stands_unless_a_clip_moves_it) };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
