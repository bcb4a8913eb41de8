/* cmd_face.c: the face channels that a pack's targets can show, with their recipes and fallbacks. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "face_idle.h"
#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "noh/base.h"
#include "noh/face.h"
#include "noh/format.h"
#include "noh/low_life.h"
#include "noh/pack.h"
#include "file/pack_file.h"
#include "life/face/recipe_internal.h"

#define LINKS_MAX 4096u

typedef struct face_args {
    const char *pack;
    double idle_s;
    option_list anims, clips, feels;
    int as_json;
} face_args;

/* How a channel is shown. */
typedef enum coverage { COVERED, PARTLY, FALLS_BACK, NOTHING, COVERAGES } coverage;

static const char *const coverage_names[COVERAGES] = { "covered", "partly", "falls_back", "nothing" };

typedef struct face_report {
    const pack_file *file;
    noh_face_recipe own;
    const noh_face_recipe *recipes[4]; /* the best first */
    uint32_t recipe_count;
    /* of one mesh */
    noh_mesh mesh;
    const char *names[NOH_TARGETS_MAX];
    uint8_t used[NOH_TARGETS_MAX];
    noh_face_link links[LINKS_MAX];
    uint32_t link_count, counts[COVERAGES];
    noh_face_source sources[NOH_CHANNEL_COUNT];
    noh_corrective_term terms[NOH_FACE_ROWS_MAX];
    uint32_t term_count;
    noh_weight_rule rules[NOH_FACE_ROWS_MAX];
    uint32_t rule_count;
} face_report;

static void list_recipes(face_report *r)
{
    r->own = noh_face_recipe_in_pack(&r->file->pack);
    r->recipes[r->recipe_count++] = &r->own;
    r->recipes[r->recipe_count++] = &noh_face_recipe_arkit;
    r->recipes[r->recipe_count++] = &noh_face_recipe_vrm;
    r->recipes[r->recipe_count++] = &noh_face_recipe_units;
}

static coverage coverage_of(const noh_face_source *source, uint32_t channel)
{
    return !source->recipe                           ? NOTHING
           : source->channel != channel              ? FALLS_BACK
           : source->found_count < source->row_count ? PARTLY
                                                     : COVERED;
}

static void read_mesh(face_report *r)
{
    const uint32_t count = r->mesh.header->target_count;
    memset(r->used, 0, sizeof r->used);
    memset(r->counts, 0, sizeof r->counts);
    for (uint32_t t = 0; t < count; t++) {
        r->names[t] = noh_pack_string(r->mesh.pack, r->mesh.targets[t].name);
        r->used[t] = (r->mesh.targets[t].flags & NOH_TARGET_IDENTITY) != 0;
    }
    r->link_count = noh_face_recipe_bind(r->recipes, r->recipe_count, r->names, count, r->links, LINKS_MAX);
    r->link_count = r->link_count < LINKS_MAX ? r->link_count : LINKS_MAX;
    for (uint32_t i = 0; i < r->link_count; i++) r->used[r->links[i].target] = 1;
    r->term_count = noh_correctives_bind(&r->mesh, r->terms, NOH_FACE_ROWS_MAX);
    for (uint32_t i = 0; i < r->term_count; i++) r->used[r->terms[i].target] = 1;
    r->rule_count = noh_weight_rules_bind(&r->mesh, r->rules, NOH_FACE_ROWS_MAX);
    for (uint32_t i = 0; i < r->rule_count; i++) {
        if (r->rules[i].kind == NOH_WEIGHT_ADD) r->used[r->rules[i].other] = r->used[r->rules[i].target] = 1;
    }
    for (uint32_t c = 0; c < NOH_CHANNEL_COUNT; c++) {
        noh_face_recipe_source(r->recipes, r->recipe_count, r->names, count, c, &r->sources[c]);
        r->counts[coverage_of(&r->sources[c], c)]++;
    }
}

/* ---- text ---- */

static void print_source(const noh_face_source *source, uint32_t channel)
{
    char text[64];
    switch (coverage_of(source, channel)) {
    case NOTHING: printf("-"); return;
    case FALLS_BACK: (void)snprintf(text, sizeof text, "as %s", noh_face_channel_name(source->channel)); break;
    case PARTLY:
        (void)snprintf(text, sizeof text, "%s, %u of %u", source->recipe->name, source->found_count, source->row_count);
        break;
    default: (void)snprintf(text, sizeof text, "%s", source->recipe->name); break;
    }
    printf("%-16s", text);
}

static void print_channel(const face_report *r, uint32_t channel)
{
    printf("  %-16s", noh_face_channel_name(channel));
    print_source(&r->sources[channel], channel);
    for (uint32_t i = 0; i < r->link_count; i++) {
        if (r->links[i].channel != channel) continue;
        printf(" %s %g", r->names[r->links[i].target], (double)r->links[i].weight);
    }
    printf("\n");
}

/* Whether a term is the first of its corrective. */
static int begins(const face_report *r, uint32_t term)
{
    return !term || r->terms[term - 1u].target != r->terms[term].target;
}

static void print_correctives(const face_report *r)
{
    for (uint32_t i = 0; i < r->term_count; i++) {
        const noh_corrective_term *t = &r->terms[i];
        if (begins(r, i)) printf("%s  corrective %s:", i ? "\n" : "", r->names[t->target]);
        printf(" %s", r->names[t->driver]);
        if (t->peak < 1.0f) printf(" at %g (%g to %g)", (double)t->peak, (double)t->from, (double)t->to);
    }
    if (r->term_count) printf("\n");
}

/* Whether a rule is another target of the group, or of the expression, of the one before. */
static int goes_on(const face_report *r, uint32_t rule)
{
    const noh_weight_rule *own = &r->rules[rule];
    return rule && (own->kind == NOH_WEIGHT_SHARE || own->kind == NOH_WEIGHT_ADD) && own[-1].kind == own->kind &&
           own->other == own[-1].other;
}

static void print_share(const face_report *r, const noh_weight_rule *rule)
{
    printf(" %s", r->names[rule->target]);
    if (rule->kind == NOH_WEIGHT_ADD) printf(" %g", (double)rule->high);
}

static void print_rules(const face_report *r)
{
    for (uint32_t i = 0; i < r->rule_count; i++) {
        const noh_weight_rule *rule = &r->rules[i];
        const char *name = r->names[rule->target];
        if (i && !goes_on(r, i)) printf("\n");
        if (rule->kind == NOH_WEIGHT_ADD && !goes_on(r, i)) printf("  expression %s:", r->names[rule->other]);
        if (rule->kind == NOH_WEIGHT_SHARE && !goes_on(r, i)) printf("  share 1:");
        if (rule->kind == NOH_WEIGHT_ADD || rule->kind == NOH_WEIGHT_SHARE) print_share(r, rule);
        if (rule->kind == NOH_WEIGHT_BINARY) printf("  binary %s", name);
        if (rule->kind == NOH_WEIGHT_RANGE) printf("  range %s: %g to %g", name, (double)rule->low, (double)rule->high);
        if (rule->kind == NOH_WEIGHT_OPPOSE) printf("  opposed: %s %s", name, r->names[rule->other]);
    }
    if (r->rule_count) printf("\n");
}

static const char *const users[3] = { "lids", "eyes", "speech" }, *const hows[] = { "", "block", "blend" };

/* The rules that a stage applies: the pack's, which emotions with another's targets share. */
static void read_rules(const face_report *r, noh_face_rules *rules)
{
    uint32_t taken = 0;
    for (uint32_t e = 0; e < NOH_EMOTION_COUNT; e++) {
        const uint32_t channel = NOH_CHANNEL_UPPER + e;
        if (coverage_of(&r->sources[channel], channel) == FALLS_BACK) taken |= 1u << e;
    }
    noh_face_rules_of_pack(r->mesh.pack, rules);
    noh_face_share_rules(r->mesh.pack, taken, rules);
}

/* How an emotion affects a user of the face. */
static uint8_t override_of(const face_report *r, int emotion, int user)
{
    noh_face_rules rules;
    read_rules(r, &rules);
    return user == 0 ? rules.lids[emotion] : user == 1 ? rules.eyes[emotion] : rules.speech[emotion];
}

static int is_binary(const face_report *r, int emotion)
{
    noh_face_rules rules;
    read_rules(r, &rules);
    return rules.binary >> emotion & 1;
}

/* The next row at or after *row in which an expression overrides a user; 0: there is none. */
static int next_override(const face_report *r, uint32_t *row, const char **name, uint32_t *user, uint8_t *how)
{
    const noh_pack *pack = r->mesh.pack;
    for (; *row < pack->recipe_row_count; ++*row) {
        const noh_recipe_row *at = &pack->recipe_rows[*row];
        const char *channel = noh_pack_string(pack, at->channel);
        *name = noh_pack_string(pack, at->target);
        if (strncmp(channel, "override-", 9) != 0 || noh_face_channel_find(*name) != NOH_NONE) continue;
        *user = strcmp(channel + 9, "lids") == 0 ? 0 : strcmp(channel + 9, "eyes") == 0 ? 1 : 2;
        *how = at->weight > 1.5f ? NOH_OVERRIDE_BLEND : NOH_OVERRIDE_BLOCK;
        return 1;
    }
    return 0;
}

static void print_overrides(const face_report *r)
{
    const char *name;
    uint32_t user;
    uint8_t by;
    for (int i = 0; i < NOH_EMOTION_COUNT; i++) {
        if (is_binary(r, i)) printf("  binary %s\n", noh_face_channel_name(NOH_CHANNEL_UPPER + (uint32_t)i));
    }
    for (int i = 0; i < 3 * NOH_EMOTION_COUNT; i++) {
        const uint8_t how = override_of(r, i / 3, i % 3);
        if (!how) continue;
        printf("  override %s %s %s\n", noh_face_channel_name(NOH_CHANNEL_UPPER + (uint32_t)i / 3u), users[i % 3],
               hows[how]);
    }
    for (uint32_t row = 0; next_override(r, &row, &name, &user, &by); row++)
        printf("  override %s %s %s\n", name, users[user], hows[by]);
}

static void print_mesh(const face_report *r)
{
    uint32_t unused = 0;
    printf("mesh '%s': %u targets; of %u channels %u are covered, %u partly, %u fall back, %u show nothing\n",
           r->mesh.name, r->mesh.header->target_count, (unsigned)NOH_CHANNEL_COUNT, r->counts[COVERED],
           r->counts[PARTLY], r->counts[FALLS_BACK], r->counts[NOTHING]);
    for (uint32_t c = 0; c < NOH_CHANNEL_COUNT; c++) print_channel(r, c);
    print_correctives(r);
    print_rules(r);
    print_overrides(r);
    for (uint32_t t = 0; t < r->mesh.header->target_count; t++) {
        if (!r->used[t]) printf("%s%s", unused++ ? ", " : "  targets without a channel: ", r->names[t]);
    }
    if (unused) printf("\n");
}

/* ---- JSON ---- */

static void json_channel(json *j, const face_report *r, uint32_t channel)
{
    const noh_face_source *source = &r->sources[channel];
    json_open(j, NULL, '{');
    json_text(j, "channel", noh_face_channel_name(channel));
    json_text(j, "coverage", coverage_names[coverage_of(source, channel)]);
    if (source->recipe) {
        json_text(j, "recipe", source->recipe->name);
        json_text(j, "from", noh_face_channel_name(source->channel));
    }
    json_integer(j, "rows", source->row_count);
    json_integer(j, "found", source->found_count);
    json_open(j, "targets", '[');
    for (uint32_t i = 0; i < r->link_count; i++) {
        if (r->links[i].channel != channel) continue;
        json_open(j, NULL, '{');
        json_text(j, "name", r->names[r->links[i].target]);
        json_number(j, "weight", (double)r->links[i].weight);
        json_close(j, '}');
    }
    json_close(j, ']');
    json_close(j, '}');
}

static void json_correctives(json *j, const face_report *r)
{
    json_open(j, "correctives", '[');
    for (uint32_t i = 0; i < r->term_count; i++) {
        const noh_corrective_term *t = &r->terms[i];
        if (begins(r, i)) {
            json_open(j, NULL, '{');
            json_text(j, "target", r->names[t->target]);
            json_open(j, "drivers", '[');
        }
        json_open(j, NULL, '{');
        json_text(j, "name", r->names[t->driver]);
        json_number(j, "from", (double)t->from);
        json_number(j, "peak", (double)t->peak);
        json_number(j, "to", (double)t->to);
        json_close(j, '}');
        if (i + 1u < r->term_count && !begins(r, i + 1u)) continue;
        json_close(j, ']');
        json_close(j, '}');
    }
    json_close(j, ']');
}

static const char *const rule_names[] = { "range", "oppose", "share", "binary", "expression" };
static const char *const rule_others[] = { "", "other", "group", "", "name" };

static void json_override(json *j, const char *channel, const char *over, const char *how)
{
    json_open(j, NULL, '{');
    json_text(j, "channel", channel);
    json_text(j, "over", over);
    json_text(j, "how", how);
    json_close(j, '}');
}

static void json_overrides(json *j, const face_report *r)
{
    const char *name;
    uint32_t user;
    uint8_t by;
    json_open(j, "binary", '[');
    for (int i = 0; i < NOH_EMOTION_COUNT; i++) {
        if (is_binary(r, i)) json_text(j, NULL, noh_face_channel_name(NOH_CHANNEL_UPPER + (uint32_t)i));
    }
    json_close(j, ']');
    json_open(j, "overrides", '[');
    for (int i = 0; i < 3 * NOH_EMOTION_COUNT; i++) {
        const uint8_t how = override_of(r, i / 3, i % 3);
        if (how) json_override(j, noh_face_channel_name(NOH_CHANNEL_UPPER + (uint32_t)i / 3u), users[i % 3], hows[how]);
    }
    for (uint32_t row = 0; next_override(r, &row, &name, &user, &by); row++)
        json_override(j, name, users[user], hows[by]);
    json_close(j, ']');
}

static void json_rules(json *j, const face_report *r)
{
    json_open(j, "weight_rules", '[');
    for (uint32_t i = 0; i < r->rule_count; i++) {
        const noh_weight_rule *rule = &r->rules[i];
        json_open(j, NULL, '{');
        json_text(j, "rule", rule_names[rule->kind]);
        json_text(j, "target", r->names[rule->target]);
        if (rule->kind == NOH_WEIGHT_RANGE) {
            json_number(j, "min", (double)rule->low);
            json_number(j, "max", (double)rule->high);
        } else if (rule->kind != NOH_WEIGHT_BINARY) {
            json_text(j, rule_others[rule->kind], r->names[rule->other]);
        }
        if (rule->kind == NOH_WEIGHT_ADD) json_number(j, "weight", (double)rule->high);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_mesh(json *j, const face_report *r)
{
    json_open(j, NULL, '{');
    json_text(j, "name", r->mesh.name);
    json_integer(j, "target_count", r->mesh.header->target_count);
    for (uint32_t i = 0; i < COVERAGES; i++) json_integer(j, coverage_names[i], r->counts[i]);
    json_open(j, "channels", '[');
    for (uint32_t c = 0; c < NOH_CHANNEL_COUNT; c++) json_channel(j, r, c);
    json_close(j, ']');
    json_correctives(j, r);
    json_rules(j, r);
    json_overrides(j, r);
    json_open(j, "unused", '[');
    for (uint32_t t = 0; t < r->mesh.header->target_count; t++) {
        if (!r->used[t]) json_text(j, NULL, r->names[t]);
    }
    json_close(j, ']');
    json_close(j, '}');
}

/* ---- idle ---- */

static double share(const face_idle *idle, uint32_t region)
{
    return (double)idle->still[region] / (double)idle->pairs;
}

static int json_idle(const face_idle *idle, const face_args *a)
{
    json j = json_begin();
    json_text(&j, "pack", a->pack);
    json_number(&j, "seconds", a->idle_s);
    json_integer(&j, "pairs", idle->pairs);
    json_open(&j, "still", '{');
    for (uint32_t r = 0; r < FACE_REGIONS; r++) {
        if (idle->is_there[r]) json_number(&j, face_region_names[r], share(idle, r));
    }
    json_close(&j, '}');
    return json_end(&j);
}

static int report_idle(const face_args *a, const pack_file *file)
{
    face_idle idle;
    const face_idle_desc desc = { file, a->idle_s, &a->anims, &a->clips, &a->feels };
    const int status = face_idle_measure(&desc, &idle);
    if (status) return status;
    if (a->as_json) return json_idle(&idle, a);
    printf("idle for %g s, %u pairs of pictures; without motion:", a->idle_s, idle.pairs);
    for (uint32_t r = 0; r < FACE_REGIONS; r++) {
        if (idle.is_there[r]) printf("%s %s %.1f %%", r ? "," : "", face_region_names[r], 100.0 * share(&idle, r));
    }
    printf("\n");
    return 0;
}

/* ---- all ---- */

static int report_pack(face_report *r, int as_json)
{
    json j = { NULL, 0, 0, 0, 0, 0 };
    uint32_t meshes = 0;
    list_recipes(r);
    if (as_json) {
        j = json_begin();
        json_text(&j, "pack", r->file->path);
        json_integer(&j, "recipe_rows", r->file->pack.recipe_row_count);
        json_open(&j, "meshes", '[');
    } else if (r->own.row_count) {
        printf("the pack's own recipe has %u rows\n", r->own.row_count);
    }
    for (uint32_t i = 0; noh_pack_mesh_at(&r->file->pack, i, &r->mesh, NULL) == NOH_OK; i++) {
        if (!r->mesh.header->target_count) continue;
        meshes++;
        read_mesh(r);
        if (as_json) {
            json_mesh(&j, r);
        } else {
            print_mesh(r);
        }
    }
    if (!meshes) {
        json_drop(&j);
        return tool_fail(r->file->path, "no mesh has morph targets");
    }
    if (!as_json) return 0;
    json_close(&j, ']');
    return json_end(&j);
}

static int run(void *args)
{
    const face_args *a = args;
    pack_file file;
    face_report *report = calloc(1, sizeof *report);
    int status = report ? 0 : tool_fail(a->pack, "out of memory");
    if (!status && !(a->idle_s >= 0.0 && a->idle_s <= 600.0)) status = tool_usage("--idle must be 0 to 600 seconds");
    if (!status) status = pack_file_open(&file, a->pack);
    if (!status) {
        report->file = &file;
        status = a->idle_s > 0.0 ? report_idle(a, &file) : report_pack(report, a->as_json);
        pack_file_close(&file);
    }
    free(report);
    return status;
}

static face_args arguments;

static const option options[] = {
    { .name = "--idle",
      .kind = OPTION_NUMBER,
      .at = offsetof(face_args, idle_s),
      .value = "S",
      .what =
          "instead, let the face live for S seconds: the share of pairs of pictures, 30 a second and 512 pixels high, in which outline, brows, lids, eyes or mouth do not move",
      .example = "10" },
    { .name = "--clip",
      .kind = OPTION_LIST,
      .at = offsetof(face_args, clips),
      .value = "NAME",
      .what = "what it says or does meanwhile; may repeat",
      .example = "speech",
      .needs = "--idle" },
    OPTION_ANIMS(face_args, anims, .needs = "--clip"),
    OPTION_FEEL(face_args, feels, .needs = "--idle"),
    OPTION_JSON(face_args, as_json),
};

const verb verb_face = {
    .name = "face",
    .files = "PACK|MODEL",
    .what = "show which targets of a face make blinks, gaze, emotions and mouth shapes, with the recipe of each",
    .more =
        "Each channel uses the first recipe that fits the targets' names: the pack's own (noh build --recipe), then the built-in recipes for ARKit, VRM and facial units. A mouth shape without a recipe uses the nearest other shape.",
    .example =
        "head.noh\nhead.noh --json\nhead.noh --idle 10\nhead.noh --idle 3 --anim line.noh --clip speech --feel joy=0.8",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(face_args, pack),
    .args = &arguments,
    .run = run,
};
