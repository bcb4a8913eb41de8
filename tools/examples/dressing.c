/* dressing.c: a dressing room. Two figures walk on the spot; one puts a coat on, takes it off and lends it to the
 * other, each in one frame, and what the coat hides of them is not drawn. Saves a picture of each change.
 *
 *   dressing BODY.noh GARMENT.noh [MESH] [-o NAME]
 *
 * Writes NAME0.png to NAME3.png (default: dressing). MESH: a mesh of the body to take off in the last picture. Build
 * the garment with noh build --wear BODY.noh. Links EGL. */
#include <string.h>

#include "start.h"
#include "target.h"
#include "noh/noh_gl.h"

enum { BODIES, GARMENTS, KINDS };
#define WIDTH 960
#define HEIGHT 720

static noh_gl gl;

typedef struct room {
    noh_pack packs[KINDS];
    noh_stage_plan plan;
    noh_stage *stage;
    noh_actor bodies[2], garment;
    target picture;
} room;

static int room_open(room *r)
{
    const noh_kind_desc kinds[KINDS] = {
        { .name = "bodies", .mesh = &r->packs[BODIES], .actor_count = 2, .near_count = 2, .cover_count = 1 },
        { .name = "garments",
          .mesh = &r->packs[GARMENTS],
          .actor_count = 1,
          .worn_by = 1u << BODIES,
          .springs = noh_springs_module(NULL) },
    };
    const noh_stage_desc desc = { .kinds = kinds, .kind_count = KINDS, .height_px = HEIGHT, .gpu = &noh_stage_on_gl };
    noh_error e;
    void *memory;
    if (noh_stage_plan_make(&desc, &gl.caps, &r->plan, &e)) return start_fail(&gl, "plan", &e);
    memory = malloc((size_t)r->plan.cpu_bytes);
    if (!memory || noh_stage_init(memory, (size_t)r->plan.cpu_bytes, &gl.device, &desc, &r->plan, &r->stage, &e))
        return start_fail(&gl, "stage", &e);
    for (int i = 0; i < 2; i++) {
        const noh_place place = { { i ? 0.5f : -0.5f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 0.0f }, 1.0f };
        if (noh_stage_spawn(r->stage, BODIES, &place, &r->bodies[i], &e)) return start_fail(&gl, "body", &e);
        (void)noh_actor_play(r->stage, r->bodies[i], 0, i ? "idle" : "dance", NULL, NULL); /* if the pack has it */
    }
    if (noh_stage_spawn(r->stage, GARMENTS, NULL, &r->garment, &e)) return start_fail(&gl, "garment", &e);
    target_make(&gl.api, WIDTH, HEIGHT, 0, &r->picture);
    return 0;
}

/* Half a second, and a picture of its last frame. */
static int show(room *r, float angle, const char *name, int number)
{
    static const float middle[3] = { 0.0f, 0.85f, 0.0f };
    char path[256];
    noh_stage_view view;
    noh_error e;
    noh_view_orbit(&view, middle, angle, 0.1f, 3.0f, WIDTH, HEIGHT);
    for (int i = 0; i < 30; i++) {
        if (noh_stage_frame(r->stage, NOH_TICKS_PER_SECOND / 60, &view, NULL, NULL, &e))
            return start_fail(&gl, "frame", &e);
    }
    target_clear(&gl.api, &r->picture);
    if (noh_stage_draw(r->stage, NOH_PASS_COLOR, 0, NULL, &e)) return start_fail(&gl, "draw", &e);
    snprintf(path, sizeof path, "%s%d.png", name, number);
    return target_save(&gl.api, &r->picture, path);
}

static void appear(const room *r, noh_actor actor, const noh_appearance *look)
{
    (void)noh_actor_set_appearance(r->stage, actor, look, NULL);
}

int main(int argc, char **argv)
{
    static room r;
    const noh_appearance away = { .hidden = 1 }, plain = { .hidden = 0 };
    const char *name = argc > 4 && !strcmp(argv[argc - 2], "-o") ? argv[argc - 1] : "dressing";
    const char *mesh = argc > 3 && strcmp(argv[3], "-o") ? argv[3] : NULL;
    noh_appearance bare = { .hidden = 0 };
    noh_error e;
    if (argc < 3 || start_pack(&gl, argv[1], &r.packs[BODIES]) || start_pack(&gl, argv[2], &r.packs[GARMENTS]) ||
        start_gl(&gl) || room_open(&r)) {
        return 2;
    }
    appear(&r, r.garment, &away); /* in the wardrobe */
    if (show(&r, 0.4f, name, 0)) return 1;
    appear(&r, r.garment, &plain);
    if (noh_actor_wear(r.stage, r.garment, r.bodies[0], &e)) return start_fail(&gl, "the first puts it on", &e);
    if (show(&r, 0.4f, name, 1)) return 1;
    if (noh_actor_wear(r.stage, r.garment, r.bodies[1], &e)) return start_fail(&gl, "the second puts it on", &e);
    if (show(&r, 2.7f, name, 2)) return 1;
    if (mesh) {
        const uint32_t index = noh_stage_find(r.stage, BODIES, NOH_NAME_MESH, mesh);
        if (index == NOH_NONE) {
            fprintf(stderr, "the body has no mesh '%s'\n", mesh);
            return 1;
        }
        bare.hidden_meshes = 1u << index;
        appear(&r, r.bodies[1], &bare);
    }
    if (show(&r, 0.4f, name, 3)) return 1;
    printf("%llu bytes and %llu on the GPU\n", (unsigned long long)r.plan.cpu_bytes,
           (unsigned long long)noh_gl_ledger_bytes(&gl.ledger));
    return noh_gl_ledger_bytes(&gl.ledger) != r.plan.gpu_bytes; /* as planned */
}
