#include "choices.h"

#include <stdlib.h>
#include <string.h>

#include "convert/base/names.h"
#include "convert/model/lip_target.h"
#include "convert/model/model_build.h"
#include "convert/model/recipe_make.h"
#include "convert/skin/eye_split.h"
#include "noh/face.h"

#define LINKS_MAX 4096u

/* ---- is it a face ---- */

/* What a model says about its targets: the rows of extras and of known names. Lines that cannot be read have no row
 * here; the recipe of the pack warns of them. NULL: out of memory. */
static recipe_text *known_rows(const model *m)
{
    recipe_text *recipe = recipe_new();
    uint32_t count, line;
    model_error unread;
    for (uint32_t i = 0; recipe && i < m->mesh_count; i++) {
        const char *lines = m->meshes[i].recipe;
        if (lines) (void)recipe_add_text(recipe, lines, strlen(lines), &line, &unread);
    }
    if (recipe) (void)recipe_add_known(recipe, m, &count);
    return recipe;
}

/* What targets move. */
typedef struct face_moves {
    int blinks, opens, looks; /* both lids; the mouth, for aa; both eyes to the sides */
    int bites;                /* the mouth, for f and v, by a target of the artist's own */
} face_moves;

static face_moves moves_of(const model_mesh *mesh, const noh_face_recipe *own)
{
    const noh_face_recipe *recipes[] = { own, &noh_face_recipe_arkit, &noh_face_recipe_vrm, &noh_face_recipe_units };
    const uint32_t targets = mesh->target_count < NOH_TARGETS_MAX ? mesh->target_count : NOH_TARGETS_MAX;
    const uint32_t eyes = NOH_CHANNEL_EYES;
    noh_face_link *links = calloc(LINKS_MAX, sizeof *links);
    const char *names[NOH_TARGETS_MAX];
    uint8_t moved[NOH_CHANNEL_COUNT] = { 0 };
    face_moves found = { 0, 0, 0, 0 };
    uint32_t count;
    for (uint32_t t = 0; t < targets; t++) names[t] = mesh->targets[t].name;
    count = links ? noh_face_recipe_bind(recipes, 4, names, targets, links, LINKS_MAX) : 0;
    for (uint32_t i = 0; i < count && i < LINKS_MAX; i++) moved[links[i].channel] |= links[i].weight > 0.0f;
    free(links);
    found.blinks = moved[NOH_CHANNEL_BLINK_LEFT] && moved[NOH_CHANNEL_BLINK_RIGHT];
    found.opens = moved[NOH_CHANNEL_VISEMES + NOH_VISEME_AA];
    found.looks = moved[eyes + 2] && moved[eyes + 3] && moved[eyes + 6] && moved[eyes + 7]; /* out, in of each */
    return found;
}

/* Of all meshes together: a face may have a mesh for its lids. */
static face_moves find_moves(const model *m)
{
    noh_face_row rows[NOH_FACE_ROWS_MAX];
    noh_face_recipe own = { "own", rows, 0, NULL };
    recipe_text *recipe = known_rows(m);
    face_moves all = { 0, 0, 0, 0 };
    for (uint32_t i = 0; recipe && i < recipe->count && own.row_count < NOH_FACE_ROWS_MAX; i++) {
        const recipe_row *row = &recipe->rows[i];
        const uint32_t channel = noh_face_channel_find(row->channel);
        if (channel != NOH_NONE) {
            rows[own.row_count++] = (noh_face_row){ row->target, (uint16_t)channel, row->weight };
            all.bites |= channel == NOH_CHANNEL_VISEMES + NOH_VISEME_FF;
        }
    }
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const face_moves now = moves_of(&m->meshes[i], &own);
        all.blinks |= now.blinks;
        all.opens |= now.opens;
        all.looks |= now.looks;
    }
    recipe_free(recipe);
    return all;
}

static int is_face(const face_moves *moves)
{
    return moves->blinks && moves->opens;
}

/* ---- eyes and lips ---- */

static void say(FILE *report, const char *line)
{
    if (report) fprintf(report, "%s\n", line);
}

static int has_eye_joints(const model *m)
{
    for (uint32_t n = 0; n < m->node_count; n++) {
        char means[NOH_NAME_BYTES_MAX];
        if (m->nodes[n].mesh == MODEL_NONE && m->nodes[n].name &&
            names_find(NAME_JOINT, m->nodes[n].name, means, NULL) && strcmp(means, "leftEye") == 0) {
            return 1;
        }
    }
    return 0;
}

/* Joints of eyes are for heads that have no joints: on a skeleton they would part the model from clips of other files,
 * which have the skeleton's own joints. */
static int choose_eyes(model *m, const face_moves *moves, FILE *report, model_error *error)
{
    const char *turn = moves->looks ? "targets turn them" : "nothing turns them";
    static const char asked[] = "--eyes: "; /* the program's user did not ask */
    model_error own = { "", "" };
    const char *what = own.what;
    if (has_eye_joints(m)) {
        say(report, "eyes: joints turn them");
        return 0;
    }
    if (m->skin_count) {
        if (report) {
            fprintf(report,
                    "eyes: %s (--eyes adds joints: then only clips of builds with --eyes fit, without --only anim)\n",
                    turn);
        }
        return 0;
    }
    if (!eyes_split(m, report, &own)) {
        say(report, "eyes: two joints turn them (--plain: none)");
        return 0;
    }
    if (strcmp(own.what, "out of memory") == 0) return model_fail(error, own.where, "%s", own.what);
    if (report) fprintf(report, "eyes: %s\n", turn);
    if (moves->looks) return 0;
    if (strncmp(own.what, asked, sizeof asked - 1u) == 0) what += sizeof asked - 1u;
    return model_warn(m, "eyes get no joints, and %s: %s%s%s", turn, own.where, own.where[0] ? ": " : "", what)
               ? model_fail_memory(error)
               : 0;
}

static int choose_lips(model *m, const face_moves *moves, FILE *report, model_error *error)
{
    char why[LIP_WHY_BYTES];
    if (moves->bites) {
        say(report, "lips: a target of the model's own shows f and v");
        return 0;
    }
    if (lip_target_add(m, report, why, error)) return 1;
    if (report && why[0]) fprintf(report, "lips: no target brings them to the teeth: %s\n", why);
    if (!why[0]) say(report, "lips: they meet the teeth for f and v (--plain: not)");
    return 0;
}

/* What is chosen before skins are made, in this order. */
static const struct {
    unsigned bit;
    int (*choose)(model *m, const face_moves *moves, FILE *report, model_error *error);
} shapes[] = { { CHOICE_EYES, choose_eyes }, { CHOICE_LIPS, choose_lips } };

int choices_shape(model *m, unsigned bits, FILE *report, model_error *error)
{
    if (!bits) return 0;
    const face_moves moves = find_moves(m);
    for (size_t i = 0; i < sizeof shapes / sizeof shapes[0] && is_face(&moves); i++) {
        if ((bits & shapes[i].bit) && shapes[i].choose(m, &moves, report, error)) return 1;
    }
    return 0;
}

/* ---- levels ---- */

/* Nanoseconds of one core, measured on five models: a build takes 0.45 us for each texel of its textures, 7 us for each
 * vertex that a target moves, 35 us for each joint of each frame; LOD_FAST for each vertex and pose, by the number of
 * levels, what levels_of has. */
#define TEXEL_NS 450.0
#define PAIR_NS 7000.0
#define FRAME_NS 35000.0
#define MIXES 24.0      /* poses of several targets, and */
#define CLIP_POSES 12.0 /* of clips, that a level has to follow */
#define SHARE 0.8       /* of the build's own work: an estimate may be off by a fifth */

static const struct {
    uint32_t count;
    double ns;
} levels_of[] = { { 3, 3000.0 }, { 2, 2100.0 } }; /* a fourth by LOD_FAST is too far off to be seen near */

static double texels_of(const model *m)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < m->texture_count; i++) {
        const model_texture *t = &m->textures[i];
        double texels = (double)t->width * t->height;
        uint32_t side = t->width > t->height ? t->width : t->height;
        for (; t->size_max && side > t->size_max; side /= 2u) texels /= 4.0;
        sum += t->blocks == MODEL_BLOCKS_ETC2 ? texels : 0.0;
    }
    return sum;
}

static double pairs_of(const model *m)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t t = 0; t < m->meshes[i].target_count; t++) {
            const float *delta = m->meshes[i].targets[t].position;
            for (size_t v = 0; delta && v < m->meshes[i].vertex_count; v++) {
                sum += delta[3 * v] != 0.0f || delta[3 * v + 1] != 0.0f || delta[3 * v + 2] != 0.0f;
            }
        }
    }
    return sum;
}

static double poses_of(const model *m)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        const double poses = (mesh->target_count > 1u ? MIXES : 1.0) + mesh->target_count +
                             (mesh->joints ? CLIP_POSES : 0.0);
        sum += poses * mesh->vertex_count;
    }
    return sum;
}

static double work_of(const model *m, raw_set *const *sets, uint32_t set_count)
{
    double frames = 0.0;
    for (uint32_t s = 0; s < set_count; s++) {
        for (uint32_t c = 0; c < sets[s]->clip_count; c++) {
            frames += (double)sets[s]->clips[c].frame_count * sets[s]->clips[c].joint_count;
        }
    }
    return TEXEL_NS * texels_of(m) + PAIR_NS * pairs_of(m) + FRAME_NS * frames;
}

/* Levels that nobody asked for must not end a build. */
static int fits_memory(const model *m)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (lod_bytes(&m->meshes[i], (uint32_t)CLIP_POSES, 0) > LOD_BYTES_MAX) return 0;
    }
    return 1;
}

void choices_levels(const model *m, raw_set *const *sets, uint32_t set_count, lod_settings *levels, FILE *report)
{
    const double work = work_of(m, sets, set_count), poses = poses_of(m);
    const face_moves moves = find_moves(m);
    const size_t count = sizeof levels_of / sizeof levels_of[0];
    size_t i = 0;
    if (!is_face(&moves) || !(poses > 0.0)) return;
    if (!fits_memory(m)) i = count;
    while (i < count && levels_of[i].ns * poses > SHARE * work) i++;
    if (i < count) {
        levels->level_count = levels_of[i].count;
        levels->mode = LOD_FAST;
    }
    if (report && i < count) {
        fprintf(report, "LOD: %u levels by --lod-fast, %.0f %% more work (--lod 1: none; --lod %u: smaller errors)\n",
                levels->level_count, 100.0 * levels_of[i].ns * poses / work, levels->level_count);
    } else if (report) {
        fprintf(
            report,
            "LOD: no levels, which would take longer than all else, or too much memory (--lod 3 --lod-fast makes them)\n");
    }
}
