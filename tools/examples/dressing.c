/* dressing.c: a dressing room. Two figures walk on the spot; one puts a coat on, takes it off and lends it to the
 * other, each in one frame, and what the coat hides of them is not drawn. Then the street opens, with the room's packs
 * on the GPU, and the room is closed. Saves a picture of each change.
 *
 *   dressing BODY.noh GARMENT.noh [MESH] [-o NAME]
 *
 * Writes NAME0.png to NAME4.png (default: dressing). MESH: a mesh of the body to take off in the last picture. Build
 * the garment with noh build --wear BODY.noh. Links EGL. */
#include <string.h>

#include "start.h"
#include "target.h"
#include "noh/noh_gl.h"

enum { BODIES, GARMENTS, KINDS };
#define WIDTH 960
#define HEIGHT 720
#define BODIES_MAX 3u

static noh_gl gl;

typedef struct room {
    noh_pack packs[KINDS];
    noh_kind_desc kinds[KINDS];
    noh_stage_desc desc;
    noh_stage_peers share;
    noh_stage_plan plan;
    noh_stage *stage;
    noh_actor bodies[BODIES_MAX], garment;
    target picture;
} room;

/* peer: a stage that is open; NULL: none */
static int room_open(room *r, uint32_t body_count, const noh_stage_peer *peer)
{
    noh_error e;
    void *memory;
    r->kinds[BODIES] = (noh_kind_desc){ .name = "bodies", .mesh = &r->packs[BODIES], .actor_count = body_count };
    r->kinds[BODIES].near_count = body_count;
    r->kinds[BODIES].cover_count = 1;
    r->kinds[GARMENTS] = (noh_kind_desc){ .name = "garments", .mesh = &r->packs[GARMENTS], .actor_count = 1 };
    r->kinds[GARMENTS].worn_by = 1u << BODIES;
    r->kinds[GARMENTS].springs = noh_springs_module(NULL);
    r->share = (noh_stage_peers){ peer, peer ? 1 : 0 };
    r->desc = (noh_stage_desc){ .kinds = r->kinds, .kind_count = KINDS, .height_px = HEIGHT, .gpu = &noh_stage_on_gl };
    r->desc.share = &r->share;
    if (noh_stage_plan_make(&r->desc, &gl.caps, &r->plan, &e)) return start_fail(&gl, "plan", &e);
    memory = malloc((size_t)r->plan.cpu_bytes);
    if (!memory || noh_stage_init(memory, (size_t)r->plan.cpu_bytes, &gl.device, &r->desc, &r->plan, &r->stage, &e))
        return start_fail(&gl, "stage", &e);
    for (uint32_t i = 0; i < body_count; i++) {
        const float x = 0.85f * ((float)i - 0.5f * (float)(body_count - 1u));
        const noh_place place = { { x, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 1.0f };
        if (noh_stage_spawn(r->stage, BODIES, &place, &r->bodies[i], &e)) return start_fail(&gl, "body", &e);
        (void)noh_actor_play(r->stage, r->bodies[i], 0, i % 2u ? "idle" : "dance", NULL, NULL); /* if the pack has it */
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

/* The street opens while the room is there, then the room closes: what both draw is uploaded once. */
static int go_out(room *r, const char *name)
{
    static room street;
    const noh_stage_peer from = { &r->desc, &r->plan };
    noh_error e;
    memcpy(street.packs, r->packs, sizeof street.packs);
    if (room_open(&street, BODIES_MAX, &from)) return 1;
    if (noh_actor_wear(street.stage, street.garment, street.bodies[0], &e)) return start_fail(&gl, "coat", &e);
    printf("the street: %llu bytes more on the GPU, %llu are there\n", (unsigned long long)street.plan.gpu_bytes,
           (unsigned long long)street.plan.shared_bytes);
    if (noh_gl_ledger_bytes(&gl.ledger) != r->plan.gpu_bytes + street.plan.gpu_bytes) return 1; /* as planned */
    noh_stage_delete(r->stage);
    if (noh_gl_ledger_bytes(&gl.ledger) != street.plan.gpu_bytes + street.plan.shared_bytes) return 1;
    if (show(&street, 0.4f, name, 4)) return 1;
    noh_stage_delete(street.stage);
    return noh_gl_ledger_bytes(&gl.ledger) != 0;
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
        start_gl(&gl) || room_open(&r, 2, NULL)) {
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
    return noh_gl_ledger_bytes(&gl.ledger) != r.plan.gpu_bytes || go_out(&r, name); /* as planned */
}
