/* conversation.c: two heads talk in turns. Who speaks looks aside to think, then at the other; who listens looks at the
 * speaker, and smiles at the end. Prints how far each mouth opens in each turn, and saves a picture of each.
 *
 *   conversation HEAD.noh [-o NAME]
 *
 * Writes NAME0.png to NAME2.png (default: conversation). Links EGL. */
#include <string.h>

#include "start.h"
#include "target.h"
#include "noh/modules.h"
#include "noh/noh_gl.h"

#define WIDTH 960
#define HEIGHT 540
#define TURNS 3
#define TURN_FRAMES 116 /* of 1/60 s; the last one is in the middle of a syllable */

static noh_gl gl;
static noh_pack pack;
static noh_stage *stage;
static noh_actor heads[2];
static target picture;
static float eyes[2][3];

static int open_stage(void)
{
    static noh_kind_face face;
    noh_kind_desc kind = { .name = "heads", .mesh = &pack, .actor_count = 2, .near_count = 2 };
    noh_stage_desc desc = { .kinds = &kind, .kind_count = 1, .height_px = HEIGHT, .gpu = &noh_stage_on_gl };
    const size_t scratch_bytes = noh_kind_find_eyes_size(&kind);
    void *memory, *scratch = malloc(scratch_bytes);
    static noh_stage_plan plan; /* the stage keeps it */
    noh_error e;
    if (!scratch || noh_kind_find_eyes(&kind, scratch, scratch_bytes, eyes, &e)) return start_fail(&gl, "eyes", &e);
    free(scratch);
    memcpy(face.face.eyes, eyes, sizeof eyes);
    kind.face = noh_face_module(&face);
    if (noh_stage_plan_make(&desc, &gl.caps, &plan, &e)) return start_fail(&gl, "plan", &e);
    memory = malloc((size_t)plan.cpu_bytes);
    if (!memory || noh_stage_init(memory, (size_t)plan.cpu_bytes, &gl.device, &desc, &plan, &stage, &e))
        return start_fail(&gl, "stage", &e);
    for (int i = 0; i < 2; i++) { /* half turned to each other */
        const float apart = 1.9f * (eyes[0][0] - eyes[1][0]);
        const noh_place place = { { i ? apart : -apart, 0.0f, 0.0f },
                                  { 0.0f, i ? -0.36f : 0.36f, 0.0f, 0.933f },
                                  1.0f };
        if (noh_stage_spawn(stage, 0, &place, &heads[i], &e)) return start_fail(&gl, "head", &e);
    }
    return 0;
}

/* Mouth shapes of made-up syllables; a game takes them from a clip of `noh speak` or from a microphone (noh_ear). */
static void speak(noh_actor actor, int frame)
{
    static const int syllables[4][2] = { { NOH_VISEME_PP, NOH_VISEME_AA },
                                         { NOH_VISEME_SS, NOH_VISEME_OH },
                                         { NOH_VISEME_DD, NOH_VISEME_E },
                                         { NOH_VISEME_FF, NOH_VISEME_AA } };
    float visemes[NOH_VISEME_COUNT] = { 0.0f };
    const int at = frame % 15;
    visemes[syllables[frame / 15 % 4][at >= 5]] = at < 5 ? 0.2f * (float)(5 - at) : 1.0f - 0.2f * (float)abs(at - 10);
    (void)noh_actor_set_visemes(stage, actor, visemes, NULL);
}

/* Who begins looks aside, and after half a second at the other. */
static void begin_turn(noh_actor speaker, noh_actor listener)
{
    const float aside[3] = { 0.0f, eyes[0][1] + 0.5f, 2.0f };
    (void)noh_actor_set_activity(stage, speaker, NOH_ACTIVITY_TALK, NULL);
    (void)noh_actor_set_activity(stage, listener, NOH_ACTIVITY_REST, NULL);
    (void)noh_actor_set_visemes(stage, listener, NULL, NULL);
    (void)noh_actor_look_at(stage, speaker, aside, NULL);
    (void)noh_actor_look_at_actor(stage, listener, speaker, NULL);
}

/* How far a mouth is open: by the shape of 'aa', or the jaw. */
static float mouth_of(noh_actor actor)
{
    noh_actor_mesh of;
    noh_mesh mesh;
    uint32_t open;
    (void)noh_pack_mesh_at(&pack, 0, &mesh, NULL);
    open = noh_mesh_find_target(&mesh, "viseme_aa");
    if (open == NOH_NONE) open = noh_mesh_find_target(&mesh, "jawOpen");
    return open == NOH_NONE || noh_actor_mesh_at(stage, actor, 0, &of, NULL, NULL) ? 0.0f : of.weights[open];
}

static int play_turn(int turn, const noh_stage_view *view, const char *name)
{
    const noh_actor speaker = heads[turn % 2], listener = heads[1 - turn % 2];
    float most[2] = { 0.0f, 0.0f };
    char path[256];
    noh_error e;
    begin_turn(speaker, listener);
    if (turn == TURNS - 1)
        (void)noh_actor_set_emotion(stage, listener, "joy", 0.9f, NOH_TICKS_PER_SECOND / 2, NOH_TICKS_PER_SECOND * 3,
                                    NOH_TICKS_PER_SECOND, NULL);
    for (int f = 0; f < TURN_FRAMES; f++) {
        if (f == 30) (void)noh_actor_look_at_actor(stage, speaker, listener, NULL);
        speak(speaker, f);
        if (noh_stage_frame(stage, NOH_TICKS_PER_SECOND / 60, view, NULL, NULL, &e))
            return start_fail(&gl, "frame", &e);
        for (int i = 0; i < 2 && f >= 20; i++) {
            const float now = mouth_of(heads[i]);
            most[i] = now > most[i] ? now : most[i];
        }
    }
    target_clear(&gl.api, &picture);
    if (noh_stage_draw(stage, NOH_PASS_COLOR, 0, NULL, &e)) return start_fail(&gl, "draw", &e);
    printf("turn %d: mouths open %.2f and %.2f\n", turn, (double)most[0], (double)most[1]);
    snprintf(path, sizeof path, "%s%d.png", name, turn);
    return target_save(&gl.api, &picture, path);
}

int main(int argc, char **argv)
{
    const char *name = argc > 3 && !strcmp(argv[2], "-o") ? argv[3] : "conversation";
    noh_stage_view view;
    float middle[3];
    if (argc < 2 || start_pack(&gl, argv[1], &pack) || start_gl(&gl) || open_stage()) return 2;
    target_make(&gl.api, WIDTH, HEIGHT, 0, &picture);
    middle[0] = 0.0f, middle[1] = eyes[0][1] - 0.03f, middle[2] = 0.0f;
    noh_view_orbit(&view, middle, 0.0f, 0.0f, 11.0f * (eyes[0][0] - eyes[1][0]), WIDTH, HEIGHT);
    for (int turn = 0; turn < TURNS; turn++) {
        if (play_turn(turn, &view, name)) return 1;
    }
    return 0;
}
