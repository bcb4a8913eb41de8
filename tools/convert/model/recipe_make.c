#include "recipe_make.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/face.h"
#include "convert/base/names.h"
#include "convert/model/lip_target.h"
#include "convert/model/model_build.h"
#include "convert/model/recipe_whole.h"

/* ---- extras ---- */

static int is_corrective(const recipe_row *row)
{
    return row->channel[0] == '+';
}

/* A rule for the weights of a target (low_life.h). */
static int is_rule(const recipe_row *row)
{
    return row->channel[0] == '-' || row->channel[0] == '=' || strncmp(row->channel, "range-", 6) == 0;
}

/* Whether two rows are of one thing: the target of a corrective, a rule and its target, or a channel. */
static int are_of_one(const recipe_row *a, const recipe_row *b)
{
    const int same_target = strcmp(a->target, b->target) == 0, same_channel = strcmp(a->channel, b->channel) == 0;
    if (is_corrective(a) || is_corrective(b)) return is_corrective(a) && is_corrective(b) && same_target;
    return same_channel && (same_target || !is_rule(a));
}

static int has_row(const recipe_text *recipe, uint32_t end, const recipe_row *row)
{
    for (uint32_t i = 0; i < end; i++) {
        if (are_of_one(&recipe->rows[i], row)) return 1;
    }
    return 0;
}

/* One line, on its own, to the rows of extras. */
static int add_line(recipe_text *extras, model *m, const model_mesh *mesh, const char *text, size_t size)
{
    model_error error = { "", "" };
    uint32_t line = 1;
    if (!recipe_add_text(extras, text, size, &line, &error)) return 0;
    return model_warn(m, "mesh '%s': the recipe in its extras: '%.*s' was left out: %s", mesh->name,
                      (int)(size < 60 ? size : 60), text, error.what);
}

/* Lines end with a line feed or a semicolon. Rows of VRM's expressions have no line, as nobody wrote them. */
static int read_mesh(recipe_text *extras, model *m, const model_mesh *mesh)
{
    const uint32_t before = extras->count;
    const char *at = mesh->recipe;
    while (at && *at) {
        const size_t size = strcspn(at, ";\n");
        if (add_line(extras, m, mesh, at, size)) return 1;
        at += size + (at[size] != '\0');
    }
    for (uint32_t i = before; i < extras->count && mesh->recipe_is_made; i++) extras->rows[i].line = 0;
    return 0;
}

/* The correctives of targets without a row in the recipe. */
static int add_wrinkles(recipe_text *recipe, uint32_t own, const recipe_text *extras)
{
    int failed = 0;
    for (uint32_t i = 0; !failed && i < extras->wrinkle_count; i++) {
        const wrinkle_row *row = &extras->wrinkles[i];
        int has = 0;
        for (uint32_t k = 0; k < own; k++) {
            has |= strcmp(recipe->wrinkles[k].target, row->target) == 0 &&
                   (recipe->wrinkles[k].region < NOH_WRINKLE_FOLDS) == (row->region < NOH_WRINKLE_FOLDS);
        }
        failed = !has && recipe_add_wrinkle(recipe, row->target, row->region, row->weight, 0);
    }
    return failed;
}

int recipe_add_extras(recipe_text *recipe, model *m)
{
    recipe_text *extras = recipe_new();
    const uint32_t own = recipe->count;
    int failed = !extras;
    for (uint32_t i = 0; i < m->mesh_count && !failed; i++) failed = read_mesh(extras, m, &m->meshes[i]);
    for (uint32_t i = 0; !failed && i < extras->count; i++) {
        const recipe_row *row = &extras->rows[i];
        if (!has_row(recipe, own, row))
            failed = recipe_add_row(recipe, row->target, row->channel, row->weight, row->line);
    }
    failed = failed || add_wrinkles(recipe, recipe->wrinkle_count, extras);
    for (uint32_t c = 0; !failed && c < 4; c++) {
        if (!recipe->tints[c]) recipe->tints[c] = extras->tints[c];
    }
    recipe->is_full |= extras && extras->is_full;
    recipe_free(extras);
    return failed;
}

/* ---- lips ---- */

#define LINKS_MAX 512u

static int add_bite(recipe_text *recipe, const model_mesh *mesh)
{
    const char *names[NOH_TARGETS_MAX], *bite = noh_face_channel_name(NOH_CHANNEL_VISEMES + NOH_VISEME_FF);
    noh_face_link links[LINKS_MAX];
    const recipe_row row = { (char *)LIP_TARGET, (char *)bite, 1.0f, 0 };
    const uint32_t targets = mesh->target_count < NOH_TARGETS_MAX ? mesh->target_count : NOH_TARGETS_MAX;
    uint32_t count;
    if (has_row(recipe, recipe->count, &row)) return 0;
    for (uint32_t t = 0; t < targets; t++) names[t] = mesh->targets[t].name;
    count = noh_face_recipe_bind(NULL, 0, names, targets, links, LINKS_MAX);
    for (uint32_t l = 0; l < count && l < LINKS_MAX; l++) {
        if (links[l].channel != NOH_CHANNEL_VISEMES + NOH_VISEME_FF) continue;
        if (recipe_add_row(recipe, names[links[l].target], bite, links[l].weight, 0)) return 1;
    }
    return recipe_add_row(recipe, LIP_TARGET, bite, 1.0f, 0);
}

int recipe_add_lips(recipe_text *recipe, const model *m)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (model_find_target(&m->meshes[i], LIP_TARGET) != MODEL_NONE) return add_bite(recipe, &m->meshes[i]);
    }
    return 0;
}

/* ---- the table of names ---- */

typedef struct known {
    const char *names[NOH_TARGETS_MAX]; /* of all meshes, each once */
    const char *means[NOH_TARGETS_MAX]; /* the table's, or its own */
    char text[NOH_TARGETS_MAX][NOH_NAME_BYTES_MAX];
    uint8_t held[NOH_TARGETS_MAX]; /* another target of the same meaning is used */
    uint32_t count;
} known;

static int is_listed(const known *k, const char *name)
{
    for (uint32_t i = 0; i < k->count; i++) {
        if (strcmp(k->names[i], name) == 0) return 1;
    }
    return 0;
}

/* A separator: what stands before it may be no part of a target's own name. */
static int is_separator(char c)
{
    return c == '_' || c == '.' || c == '-' || c == ' ';
}

/* The bytes that all names of a mesh's targets begin with. */
static size_t shared_bytes(const model_mesh *mesh)
{
    size_t shared = mesh->target_count > 1u ? strlen(mesh->targets[0].name) : 0u;
    for (uint32_t t = 1; t < mesh->target_count; t++) {
        size_t same = 0;
        while (same < shared && mesh->targets[t].name[same] == mesh->targets[0].name[same]) same++;
        shared = same;
    }
    return shared;
}

/* A name of one letter is a vowel only where others are: A, I and U, but not Variant_A and Variant_B. */
#define VOWELS_LEAST 3u

static int is_letter(const char *name)
{
    const size_t length = strlen(name);
    return length == 1u || (length > 1u && (name[length - 2u] == '.' || name[length - 2u] == ':'));
}

/* What a name means; where it has no meaning, what it means without words that all of the mesh's names begin with. */
static int find_meaning(const char *name, size_t shared, char means[NOH_NAME_BYTES_MAX], uint8_t *is_vowel)
{
    const char *own = name;
    int found = names_find(NAME_TARGET, name, means, NULL);
    for (size_t at = 0; at < shared && !found; at++) {
        own = name + at + 1u;
        found = is_separator(name[at]) && names_find(NAME_TARGET, own, means, NULL);
    }
    *is_vowel = (uint8_t)(found && is_letter(own));
    return found;
}

static int list_known(known *k, const model *m)
{
    uint32_t meaning[NOH_TARGETS_MAX];
    uint8_t found[NOH_TARGETS_MAX], vowel[NOH_TARGETS_MAX];
    uint32_t vowels = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        const size_t shared = shared_bytes(mesh);
        for (uint32_t t = 0; t < mesh->target_count && k->count < NOH_TARGETS_MAX; t++) {
            if (is_listed(k, mesh->targets[t].name)) continue;
            k->names[k->count] = mesh->targets[t].name;
            found[k->count] = (uint8_t)find_meaning(k->names[k->count], shared, k->text[k->count], &vowel[k->count]);
            vowels += vowel[k->count++];
        }
    }
    for (uint32_t i = 0; i < k->count; i++) {
        found[i] &= !vowel[i] || vowels >= VOWELS_LEAST;
        k->means[i] = found[i] && !is_listed(k, k->text[i]) ? k->text[i] : k->names[i];
        for (meaning[i] = 0; strcmp(k->means[meaning[i]], k->means[i]) != 0;) meaning[i]++;
    }
    return targets_find_held(m, k->names, meaning, k->count, k->held);
}

/* A row for each target that means this. */
static int add_meant(recipe_text *recipe, const known *k, const char *meant, uint32_t channel, float weight)
{
    const char *name = noh_face_channel_name(channel);
    for (uint32_t i = 0; i < k->count; i++) {
        if (strcmp(k->means[i], meant) == 0 && !k->held[i] && recipe_add_row(recipe, k->names[i], name, weight, 0))
            return 1;
    }
    return 0;
}

/* How much of what a built-in recipe wants for a channel is there. */
static float covered(const noh_face_source *source, uint32_t channel)
{
    const int is_own = source->recipe && source->channel == channel && source->row_count;
    return is_own ? (float)source->found_count / (float)source->row_count : 0.0f;
}

/* Targets of both sides, for channels that nothing else of a file shows. */
static const struct {
    uint32_t channel;
    const char *meant;
} of_both[] = { { NOH_CHANNEL_BLINK_LEFT, "blink" },
                { NOH_CHANNEL_BLINK_RIGHT, "blink" },
                { NOH_CHANNEL_MOUTH + NOH_EMOTION_JOY, "smile" },
                { NOH_CHANNEL_MOUTH + NOH_EMOTION_SADNESS, "frown" } };

static int add_channel(recipe_text *recipe, const known *k, uint32_t channel)
{
    const recipe_row row = { (char *)"", (char *)noh_face_channel_name(channel), 0.0f, 0 };
    noh_face_source now, then;
    if (has_row(recipe, recipe->count, &row)) return 0;
    noh_face_recipe_source(NULL, 0, k->names, k->count, channel, &now);
    noh_face_recipe_source(NULL, 0, k->means, k->count, channel, &then);
    for (uint32_t i = 0; i < k->count; i++) {
        const int is_taken = k->means[i] != k->text[i] && now.recipe == &noh_face_recipe_vrm; /* which has aa, too */
        if (!is_taken && strcmp(k->means[i], row.channel) == 0) return add_meant(recipe, k, row.channel, channel, 1.0f);
    }
    for (size_t i = 0; !(covered(&then, channel) > 0.0f) && i < sizeof of_both / sizeof of_both[0]; i++) {
        if (of_both[i].channel == channel) return add_meant(recipe, k, of_both[i].meant, channel, 1.0f);
    }
    for (uint32_t i = 0; covered(&then, channel) > covered(&now, channel) && i < then.recipe->row_count; i++) {
        const noh_face_row *from = &then.recipe->rows[i];
        if (from->channel == channel && add_meant(recipe, k, from->target, channel, from->weight)) return 1;
    }
    return 0;
}

int recipe_add_known(recipe_text *recipe, const model *m, uint32_t *count)
{
    const uint32_t before = recipe->count;
    known *k = calloc(1, sizeof *k);
    int failed = !k || list_known(k, m);
    for (uint32_t c = 0; c < NOH_CHANNEL_COUNT && !failed; c++) failed = add_channel(recipe, k, c);
    free(k);
    *count = recipe->count - before;
    return failed;
}

/* The first joint of a meaning; *is_own: the runtime finds it by its name. NULL: there is none. */
static const char *find_meant(const char *const *joints, uint32_t joint_count, const char *meant, int *is_own)
{
    for (uint32_t j = 0; j < joint_count; j++) {
        char means[NOH_NAME_BYTES_MAX];
        if (names_find(NAME_JOINT, joints[j], means, is_own) && strcmp(means, meant) == 0) return joints[j];
    }
    return NULL;
}

int recipe_add_joints(recipe_text *recipe, const char *const *joints, uint32_t joint_count)
{
    static const char *const means[5][2] = {
        { "head", NULL }, { "neck", NULL }, { "upperChest", "chest" }, { "leftEye", NULL }, { "rightEye", NULL }
    };
    for (size_t r = 0; r < 5; r++) {
        const recipe_row row = { (char *)"", (char *)recipe_joint_channels[r], 1.0f, 0 };
        const char *found = NULL;
        int is_own = 0;
        for (int i = 0; i < 2 && means[r][i] && !found; i++) {
            found = find_meant(joints, joint_count, means[r][i], &is_own);
        }
        if (!found || is_own || has_row(recipe, recipe->count, &row)) continue;
        if (recipe_add_row(recipe, found, row.channel, 1.0f, 0)) return 1;
    }
    return 0;
}

/* ---- names of correctives ---- */

#define PARTS_MAX NOH_CORRECTIVE_DRIVERS_MAX
#define JOINTS_MAX 10 /* underscores of a name that are tried as joints between parts */

typedef struct part {
    char name[NOH_NAME_BYTES_MAX];
    float peak;
} part;

typedef struct parts {
    part all[PARTS_MAX];
    uint32_t count;
} parts;

/* Parts of one name, from the start or behind a joint, up to a joint or the end: each is looked up once, and not for
 * each cut. */
typedef struct part_finder {
    const char **names; /* [count] the mesh's targets, sorted */
    uint32_t count;
    uint8_t tried[JOINTS_MAX + 1][JOINTS_MAX + 2], is_part[JOINTS_MAX + 1][JOINTS_MAX + 2];
    part parts[JOINTS_MAX + 1][JOINTS_MAX + 2];
} part_finder;

static int by_name(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static int part_finder_make(part_finder *f, const model_mesh *mesh)
{
    memset(f, 0, sizeof *f);
    f->names = malloc(((size_t)mesh->target_count + 1u) * sizeof *f->names);
    if (!f->names) return 1;
    for (; f->count < mesh->target_count; f->count++) f->names[f->count] = mesh->targets[f->count].name;
    qsort(f->names, f->count, sizeof *f->names, by_name);
    return 0;
}

static int is_target(const part_finder *f, const char *name)
{
    return bsearch(&name, f->names, f->count, sizeof *f->names, by_name) != NULL;
}

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* A target's name followed by two digits, 10 to 90, is the target at that many hundredths; target_110 is the 110th of a
 * row. */
static int read_part(const part_finder *f, const char *from, size_t size, part *out)
{
    if (size == 0 || size >= sizeof out->name - 1u) return 0;
    memcpy(out->name, from, size);
    out->name[size] = '\0';
    out->peak = 1.0f;
    if (size > 2 && is_digit(from[size - 1]) && is_digit(from[size - 2]) && from[size - 2] != '0' &&
        !is_digit(from[size - 3])) {
        out->name[size - 2] = '\0';
        if (is_target(f, out->name)) {
            out->peak = (float)(10 * (from[size - 2] - '0') + (from[size - 1] - '0')) / 100.0f;
            return 1;
        }
        out->name[size - 2] = from[size - 2];
    }
    return is_target(f, out->name);
}

static const part *find_part(part_finder *f, uint32_t first, uint32_t last, const char *from, size_t size)
{
    if (!f->tried[first][last]) {
        f->tried[first][last] = 1;
        f->is_part[first][last] = (uint8_t)read_part(f, from, size, &f->parts[first][last]);
    }
    return f->is_part[first][last] ? &f->parts[first][last] : NULL;
}

/* Cut a name at those underscores whose bits are set. 0: not all parts are targets, or one is there twice. */
static int cut(part_finder *f, const char *name, uint32_t bits, parts *out)
{
    const char *from = name;
    uint32_t joint = 0, first = 0;
    out->count = 0;
    for (const char *at = name;; at++) {
        if (*at && (*at != '_' || joint >= JOINTS_MAX || !(bits >> joint++ & 1u))) continue;
        const part *found = out->count < PARTS_MAX
                                ? find_part(f, first, *at ? joint : JOINTS_MAX + 1, from, (size_t)(at - from))
                                : NULL;
        if (!found) return 0;
        for (uint32_t i = 0; i < out->count; i++) {
            if (strcmp(out->all[i].name, found->name) == 0) return 0;
        }
        out->all[out->count++] = *found;
        from = at + 1;
        first = joint;
        if (!*at) break;
    }
    return out->count > 1 || out->all[0].peak < 1.0f;
}

/* The cut into the most parts, so that jawOpen_smile_frown is of three targets and not of jawOpen_smile and frown. */
static int split_name(part_finder *f, const char *name, parts *best)
{
    uint32_t joints = 0;
    memset(f->tried, 0, sizeof f->tried);
    best->count = 0;
    for (const char *at = name; *at; at++) joints += *at == '_';
    joints = joints < JOINTS_MAX ? joints : JOINTS_MAX;
    for (uint32_t bits = 0; bits < 1u << joints; bits++) {
        parts now;
        if (cut(f, name, bits, &now) && now.count > best->count) *best = now;
    }
    return best->count > 0;
}

static int add_named_of(recipe_text *recipe, part_finder *f, const model_mesh *mesh, uint32_t *count)
{
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        recipe_row row = { mesh->targets[t].name, "+", 1.0f, 0 };
        parts found;
        if (!split_name(f, row.target, &found) || has_row(recipe, recipe->count, &row)) continue;
        for (uint32_t p = 0; p < found.count; p++) {
            char channel[NOH_NAME_BYTES_MAX + 1u];
            (void)snprintf(channel, sizeof channel, "+%s", found.all[p].name);
            if (recipe_add_row(recipe, row.target, channel, found.all[p].peak, 0)) return 1;
        }
        ++*count;
    }
    return 0;
}

int recipe_add_named(recipe_text *recipe, const model *m, uint32_t *count)
{
    int failed = 0;
    *count = 0;
    for (uint32_t i = 0; i < m->mesh_count && !failed; i++) {
        part_finder finder;
        failed = part_finder_make(&finder, &m->meshes[i]) || add_named_of(recipe, &finder, &m->meshes[i], count);
        free(finder.names);
    }
    return failed;
}
