/* stage_desc_keys.c: the keys of a stage's text, and the fields that they set. */
#include "stage_desc_reader.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"

/* ---- values ---- */

int desc_number(const reader *r, const char *key, const char *text, uint64_t least, uint64_t most, uint64_t *out)
{
    char *end = NULL;
    unsigned long long value;
    errno = 0;
    value = strtoull(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || *end) {
        return desc_fail_at(r, r->line, "%s must be a whole number, not '%.60s'", key, text);
    }
    if (errno || value < least || value > most) {
        return desc_fail_at(r, r->line, "%s is %.60s: it must be %llu to %llu", key, text, (unsigned long long)least,
                            (unsigned long long)most);
    }
    *out = value;
    return 0;
}

int desc_one_of(const reader *r, const char *key, const char *text, const char *const *names, uint32_t count,
                uint32_t *out)
{
    for (*out = 0; *out < count; ++*out) {
        if (strcmp(text, names[*out]) == 0) {
            return 0;
        }
    }
    return desc_fail_at(r, r->line, "%s has no value '%.60s'%s", key, text, desc_hint(text, names, count).text);
}

/* "ground", or axes and "heading" separated by commas. */
static int root_axes(reader *r, char *text)
{
    static const char *const names[] = { "x", "y", "z", "heading", "ground" };
    static const uint32_t bits[] = { NOH_ROOT_X, NOH_ROOT_Y, NOH_ROOT_Z, NOH_ROOT_HEADING, NOH_ROOT_GROUND };
    for (char *at = text, *next; at; at = next) {
        uint32_t name;
        next = strchr(at, ',');
        if (next) *next++ = '\0';
        if (desc_one_of(r, "root_axes", at, names, 5, &name)) {
            return EXIT_FAILED;
        }
        r->kind->root_axes |= bits[name];
    }
    return 0;
}

static int add_clips(reader *r, const char *text)
{
    noh_kind_desc *k = r->kind;
    const noh_pack **list = r->file->clips[k - r->file->kinds];
    if (k->clip_pack_count == STAGE_DESC_CLIPS_MAX) {
        return desc_fail_at(r, r->line, "a kind has more than %u packs of clips", STAGE_DESC_CLIPS_MAX);
    }
    k->clip_packs = list;
    return desc_pack(r, text, &list[k->clip_pack_count++]);
}

/* ---- settings ---- */

typedef enum setting_kind {
    SET_BYTES,
    SET_COUNT,
    SET_FLAG,
    SET_PIXELS,
    SET_HELD,
    SET_ROOT,
    SET_MESH,
    SET_CLIPS,
    SET_FINER,
    SET_MAP,
    SET_OTHER_OF,
    SET_GRAPHS,
    SET_FACE,
    SET_RAGDOLLS,
    SET_MATCH,
    SET_SHARE,
    SET_PEER,
    SET_LAYER,
    SET_HALVES,
    SET_SHADING,
    SET_LIGHT,
    SET_NODES,
    SET_SKELETON,
    SET_TEXTURES,
    SET_SPRINGS,
    SET_WORLD,
    SET_MODIFIER
} setting_kind;

typedef struct setting {
    const char *name;
    setting_kind kind;
    int of_kind, repeats;
    size_t at; /* in noh_kind_desc or noh_stage_desc */
    uint64_t least, most;
} setting;

static const setting settings[] = {
    { "bytes_max", SET_BYTES, 0, 0, offsetof(noh_stage_desc, bytes_max), 1, UINT64_MAX },
    { "cpu_bytes_max", SET_BYTES, 0, 0, offsetof(noh_stage_desc, cpu_bytes_max), 1, UINT64_MAX },
    { "gpu_bytes_max", SET_BYTES, 0, 0, offsetof(noh_stage_desc, gpu_bytes_max), 1, UINT64_MAX },
    { "pixels", SET_PIXELS, 0, 0, 0, 0, 0 },
    { "height_px", SET_COUNT, 0, 0, offsetof(noh_stage_desc, height_px), 1, 65536 },
    { "jobs", SET_COUNT, 0, 0, offsetof(noh_stage_desc, job_count), 1, NOH_STAGE_JOBS_MAX },
    { "event_count", SET_COUNT, 0, 0, offsetof(noh_stage_desc, event_count), 1, NOH_STEP_EVENTS_MAX },
    { "load_bytes", SET_COUNT, 0, 0, offsetof(noh_stage_desc, load_bytes), 1, UINT32_MAX },
    { "halves", SET_HALVES, 0, 0, 0, 0, 0 },
    { "tangents", SET_FLAG, 0, 0, offsetof(noh_stage_desc, tangents), 0, 1 },
    { "full_detail", SET_FLAG, 0, 0, offsetof(noh_stage_desc, full_detail), 0, 1 },
    { "shading", SET_SHADING, 0, 0, 0, 0, 0 },
    { "light", SET_LIGHT, 0, 0, 0, 0, 0 },
    { "without_depth", SET_FLAG, 0, 0, offsetof(noh_stage_desc, without_depth), 0, 1 },
    { "without_shader", SET_FLAG, 0, 0, offsetof(noh_stage_desc, without_shader), 0, 1 },
    { "without_transfer", SET_FLAG, 0, 0, offsetof(noh_stage_desc, without_transfer), 0, 1 },
    { "user_values", SET_FLAG, 0, 0, offsetof(noh_stage_desc, user_values), 0, NOH_USER_COMPLEXION },
    { "morph_sums", SET_FLAG, 0, 0, offsetof(noh_stage_desc, morph_sums), 0, 1 },
    { "motion", SET_FLAG, 0, 0, offsetof(noh_stage_desc, motion), 0, 1 },
    { "sort_blended", SET_FLAG, 0, 0, offsetof(noh_stage_desc, sort_blended), 0, 1 },
    { "texture_reserve", SET_BYTES, 0, 0, offsetof(noh_stage_desc, texture_reserve), 1, UINT64_MAX },
    { "share", SET_SHARE, 0, 0, 0, 0, 1 },
    { "peer", SET_PEER, 0, 1, 0, 0, 0 },
    { "mesh", SET_MESH, 1, 0, 0, 0, 0 },
    { "clips", SET_CLIPS, 1, 1, 0, 0, 0 },
    { "actor_count", SET_COUNT, 1, 0, offsetof(noh_kind_desc, actor_count), 1, NOH_STAGE_ACTORS_MAX },
    { "visible_max", SET_COUNT, 1, 0, offsetof(noh_kind_desc, visible_max), 1, NOH_STAGE_ACTORS_MAX },
    { "near_count", SET_COUNT, 1, 0, offsetof(noh_kind_desc, near_count), 0, NOH_STAGE_ACTORS_MAX },
    { "middle_count", SET_COUNT, 1, 0, offsetof(noh_kind_desc, middle_count), 0, NOH_STAGE_ACTORS_MAX },
    { "nodes", SET_NODES, 1, 0, 0, 0, 0 },
    { "skeleton", SET_SKELETON, 1, 0, 0, 0, 0 },
    { "levels_by_number", SET_FLAG, 1, 0, offsetof(noh_kind_desc, levels_by_number), 0, 1 },
    { "weight_rules", SET_FLAG, 1, 0, offsetof(noh_kind_desc, weight_rules), 0, 1 },
    { "change_count", SET_COUNT, 1, 0, offsetof(noh_kind_desc, change_count), 1, NOH_CHANGES_MAX },
    { "unpickable", SET_FLAG, 1, 0, offsetof(noh_kind_desc, unpickable), 0, 1 },
    { "texture_set", SET_TEXTURES, 1, 1, 0, 0, 0 },
    { "springs", SET_SPRINGS, 1, 0, 0, 0, 0 },
    { "ragdoll_world", SET_WORLD, 1, 0, 0, 0, 0 },
    { "modifier", SET_MODIFIER, 1, 1, 0, 0, 0 },
    { "finest_level", SET_COUNT, 1, 0, offsetof(noh_kind_desc, finest_level), 0, NOH_LOD_LEVELS_MAX - 1u },
    { "worn_by", SET_COUNT, 1, 0, offsetof(noh_kind_desc, worn_by), 1, (1u << NOH_STAGE_KINDS_MAX) - 1u },
    { "cover_count", SET_COUNT, 1, 0, offsetof(noh_kind_desc, cover_count), 0, 255 },
    { "clip_reserve", SET_COUNT, 1, 0, offsetof(noh_kind_desc, clip_reserve), 1, NOH_CLIP_RESERVE_MAX },
    { "inertia", SET_FLAG, 1, 0, offsetof(noh_kind_desc, inertia), 0, 1 },
    { "held_float_count", SET_HELD, 1, 0, offsetof(noh_kind_desc, held_float_count), 0, NOH_FLOATS_MAX },
    { "sample_rate_needed", SET_COUNT, 1, 0, offsetof(noh_kind_desc, sample_rate_needed), 1, 1000 },
    { "root_axes", SET_ROOT, 1, 0, 0, 0, 0 },
    { "layer", SET_LAYER, 1, 1, 0, 0, 0 },
    { "map", SET_MAP, 1, 0, 0, 0, 0 },
    { "finer", SET_FINER, 1, 0, 0, 0, 0 },
    { "changes", SET_FLAG, 1, 0, offsetof(noh_kind_desc, changes), 0, 2 },
    { "other_of", SET_OTHER_OF, 1, 0, 0, 0, 0 },
    { "graphs", SET_GRAPHS, 1, 0, 0, 0, 0 },
    { "face", SET_FACE, 1, 0, 0, 0, 0 },
    { "ragdolls", SET_RAGDOLLS, 1, 0, 0, 1, NOH_RAGDOLLS_MAX },
    { "match", SET_MATCH, 1, 0, 0, 0, 1 },
};
#define SETTING_COUNT (sizeof settings / sizeof settings[0])

static int set_pixels(reader *r, const char *text)
{
    double value;
    if (tool_number(text, &value) || !(value > 0.0 && value <= 1e6)) {
        return desc_fail_at(r, r->line, "pixels must be a number above 0 and at most 1000000, not '%.60s'", text);
    }
    r->file->desc.lod.pixels = (float)value;
    return 0;
}

static int set_number(reader *r, const setting *s, const char *text)
{
    char *in = s->of_kind ? (char *)r->kind : (char *)&r->file->desc;
    uint64_t value;
    if (desc_number(r, s->name, text, s->least, s->most, &value)) {
        return EXIT_FAILED;
    }
    switch (s->kind) {
    case SET_RAGDOLLS:
        r->file->ragdolls[r->kind - r->file->kinds].count = (uint32_t)value;
        r->kind->ragdoll = noh_ragdoll_module(&r->file->ragdolls[r->kind - r->file->kinds]);
        break;
    case SET_MATCH:
        if (value) r->kind->match = noh_match_module(NULL);
        break;
    case SET_SHARE:
        if (value) r->file->desc.share = &r->file->share;
        break;
    case SET_BYTES: *(uint64_t *)(void *)(in + s->at) = value; break;
    case SET_FLAG: *(int *)(void *)(in + s->at) = (int)value; break;
    case SET_HELD: *(uint32_t *)(void *)(in + s->at) = value ? (uint32_t)value : NOH_NONE; break;
    default: *(uint32_t *)(void *)(in + s->at) = (uint32_t)value; break;
    }
    return 0;
}

static int set_halves(reader *r, const char *text)
{
    static const char *const names[] = { "0", "1", "never" };
    uint32_t which;
    if (desc_one_of(r, "halves", text, names, 3, &which)) return EXIT_FAILED;
    r->file->desc.halves = which == 2u ? -1 : (int)which;
    return 0;
}

static int set_shading(reader *r, const char *text)
{
    static const char *const names[] = { "full", "phone" };
    uint32_t which;
    if (desc_one_of(r, "shading", text, names, 2, &which)) return EXIT_FAILED;
    r->file->desc.shading = which ? NOH_SHADING_PHONE : NOH_SHADING_FULL;
    return 0;
}

static int set_skeleton(reader *r, const char *text)
{
    uint64_t skeleton = NOH_NONE;
    if (strcmp(text, "none") != 0 && desc_number(r, "skeleton", text, 0, UINT32_MAX - 1u, &skeleton))
        return EXIT_FAILED;
    r->kind->skeleton = (uint32_t)skeleton;
    return 0;
}

static void no_rays(void *user, const noh_world_ray *rays, uint32_t count, noh_world_hit *hits)
{
    (void)user, (void)rays, (void)count, (void)hits;
}

static void no_touches(void *user, const noh_world_body *bodies, uint32_t count, noh_touches *touches)
{
    (void)user, (void)bodies, (void)count, (void)touches;
}

/* Worlds with the bytes of a game's: a plan reads no shape of them. */
static const noh_world_physics physics = { no_rays, no_touches, NULL, 1 };
static const noh_world worlds[2] = { { .physics = NULL }, { .physics = &physics } };

static int set_springs(reader *r, const char *text)
{
    static const char *const names[] = { "none", "free", "world" };
    uint32_t which;
    if (desc_one_of(r, "springs", text, names, 3, &which)) return EXIT_FAILED;
    r->kind->springs = noh_springs_module(which == 2u ? &worlds[1] : NULL);
    if (!which) r->kind->springs = (noh_module){ NULL, NULL };
    return 0;
}

static int set_world(reader *r, const char *text)
{
    static const char *const names[] = { "shapes", "physics" };
    uint32_t which;
    if (desc_one_of(r, "ragdoll_world", text, names, 2, &which)) return EXIT_FAILED;
    r->file->ragdolls[r->kind - r->file->kinds].world = &worlds[which];
    return 0;
}

/* This kind takes the slot of an earlier one, which changes, and has no index of its own. */
static int set_other_of(reader *r, const char *name)
{
    const stage_desc_file *f = r->file;
    const char *names[NOH_STAGE_KINDS_MAX];
    uint32_t count = 0;
    for (uint32_t i = 0; &f->kinds[i] != r->kind; i++) {
        if (f->slot_of[i]) continue;
        names[count++] = f->kinds[i].name;
        if (strcmp(f->kinds[i].name, name) != 0) continue;
        if (!f->kinds[i].changes)
            return desc_fail_at(r, r->line, "the kind '%.60s' stays: add a line 'changes 1' to it", name);
        r->file->slot_of[r->kind - f->kinds] = 1u + i;
        return 0;
    }
    return desc_fail_at(r, r->line, "no kind before this one has a slot and the name '%.60s'%s", name,
                        desc_hint(name, names, count).text);
}

/* Another text, of a stage with which this one shares. */
static int add_peer(const reader *r, const char *text)
{
    stage_desc_file *f = r->file, *of = f;
    char *path;
    int status;
    uint32_t depth = 0;
    while ((of = of->reader_of) != NULL) depth++;
    if (f->share.peer_count == STAGE_DESC_PEERS_MAX || depth == STAGE_DESC_PEERS_MAX) {
        return desc_fail_at(r, r->line, "more than %u peers, or peers of each other", STAGE_DESC_PEERS_MAX);
    }
    path = desc_path(r->path, text);
    if (!path) return desc_out_of_memory(r->path);
    status = desc_read_file(path, f, &f->peer_files[f->share.peer_count]);
    free(path);
    if (status) return status;
    of = f->peer_files[f->share.peer_count];
    of->desc.share = &of->share;
    f->peers[f->share.peer_count] = (noh_stage_peer){ &of->desc, &f->peer_plans[f->share.peer_count] };
    f->share.peer_count++;
    f->share.peers = f->peers;
    f->desc.share = &f->share;
    return 0;
}

static int set(reader *r, const setting *s)
{
    char *text = r->words[1].text;
    switch (s->kind) {
    case SET_PIXELS: return set_pixels(r, text);
    case SET_ROOT: return root_axes(r, text);
    case SET_PEER: return add_peer(r, text);
    case SET_MESH: return desc_pack(r, text, &r->kind->mesh);
    case SET_CLIPS: return add_clips(r, text);
    case SET_LAYER: return desc_add_layer(r);
    case SET_MAP: return desc_pack(r, text, &r->file->map_packs[r->kind - r->file->kinds]);
    case SET_FINER: return desc_pack(r, text, &r->kind->finer);
    case SET_OTHER_OF: return set_other_of(r, text);
    case SET_GRAPHS: r->kind->graphs = noh_graph_module(text); return 0;
    case SET_FACE: return desc_set_face(r);
    case SET_HALVES: return set_halves(r, text);
    case SET_SHADING: return set_shading(r, text);
    case SET_LIGHT: return desc_set_light(r);
    case SET_NODES: return desc_set_nodes(r);
    case SET_SKELETON: return set_skeleton(r, text);
    case SET_TEXTURES: return desc_add_texture_set(r);
    case SET_SPRINGS: return set_springs(r, text);
    case SET_WORLD: return set_world(r, text);
    case SET_MODIFIER: return desc_add_modifier(r);
    default: return set_number(r, s, text);
    }
}

/* An option has one value, and only keys with options take any. */
static int check_options(const reader *r, const char *key, desc_words takes)
{
    for (uint32_t i = 2; i < r->word_count; i++) {
        const word *w = &r->words[i];
        if (!w->value) continue;
        if (takes != DESC_OPTIONS)
            return desc_fail_at(r, r->line, "%s takes no '%.60s=': write values alone", key, w->text);
        for (uint32_t j = 2; j < i; j++) {
            if (r->words[j].value && strcmp(r->words[j].text, w->text) == 0)
                return desc_fail_at(r, r->line, "%.60s= is given twice for this %s", w->text, key);
        }
    }
    return 0;
}

int desc_check_words(const reader *r, const char *key, desc_words takes)
{
    const word *first = &r->words[0], *second = &r->words[1];
    if (first->value || (r->word_count > 1 && second->value))
        return desc_fail_at(r, r->line, "write '%s VALUE' without an equals sign, or put quotes around the value", key);
    if (r->word_count < 2 || !second->text[0]) return desc_fail_at(r, r->line, "%s needs a value", key);
    if (r->word_count > 2 && takes == DESC_ONE_WORD)
        return desc_fail_at(r, r->line, "'%.60s' is one word too many after %s", r->words[2].text, key);
    return check_options(r, key, takes);
}

static desc_words takes(setting_kind kind)
{
    if (kind == SET_FACE || kind == SET_LIGHT || kind == SET_NODES) return DESC_WORDS;
    return kind == SET_LAYER || kind == SET_TEXTURES || kind == SET_MODIFIER ? DESC_OPTIONS : DESC_ONE_WORD;
}

static int read_setting(reader *r, const setting *s)
{
    uint32_t *line = &r->given[s - settings];
    if (s->of_kind && !r->kind) {
        return desc_fail_at(r, r->line, "'%s' belongs to a kind: write 'kind NAME' before it", s->name);
    }
    if (!s->of_kind && r->kind) {
        return desc_fail_at(r, r->line, "'%s' belongs to the whole stage: move it before the first kind", s->name);
    }
    if (*line && !s->repeats) {
        return desc_fail_at(r, r->line, "'%s' is given twice; the first is in line %u", s->name, *line);
    }
    *line = r->line;
    return desc_check_words(r, s->name, takes(s->kind)) || set(r, s) ? EXIT_FAILED : 0;
}

int desc_read_key(reader *r)
{
    const char *names[SETTING_COUNT + 1] = { "kind" };
    for (size_t i = 0; i < SETTING_COUNT; i++) {
        if (strcmp(r->words[0].text, settings[i].name) == 0) return read_setting(r, &settings[i]);
        names[i + 1] = settings[i].name;
    }
    return desc_fail_at(r, r->line, "there is no setting '%.60s'%s", r->words[0].text,
                        desc_hint(r->words[0].text, names, SETTING_COUNT + 1).text);
}
