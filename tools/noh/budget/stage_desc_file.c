#define _XOPEN_SOURCE 700 /* realpath */

#include "stage_desc_file.h"

#include <errno.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/args.h"
#include "cli/message.h"
#include "convert/base/input_file.h"
#include "convert/base/nearest.h"

#define WORDS_MAX 64u

/* KEY=VALUE has a value; in a word with quotes, only an equals sign outside them counts. */
typedef struct word {
    char *text, *value; /* value NULL: none */
} word;

typedef struct reader {
    stage_desc_file *file;
    const char *path;
    char *at; /* the next line; NULL past the last */
    uint32_t line;
    word words[WORDS_MAX];
    uint32_t word_count;
    noh_kind_desc *kind; /* NULL before the first */
    uint32_t kind_line;
    uint32_t given[32]; /* the line of each key of this section, by its row; 0: not yet */
} reader;

MESSAGE_FORMAT(3, 4) static int fail_at(const reader *r, uint32_t line, const char *format, ...)
{
    char subject[512], what[512];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    (void)snprintf(subject, sizeof subject, "%s:%u", r->path, line);
    return tool_fail(subject, "%s", what);
}

static int out_of_memory(const char *path)
{
    return tool_fail(path, "out of memory while reading this file");
}

/* "; did you mean 'bytes_max'?", or nothing. */
typedef struct hint {
    char text[96];
} hint;

static hint hint_of(const char *name, const char *const *candidates, size_t count)
{
    const char *near = nearest_name(name, candidates, count);
    hint h = { "" };
    if (near) (void)snprintf(h.text, sizeof h.text, "; did you mean '%.60s'?", near);
    return h;
}

/* ---- words ---- */

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* A word at *at: blanks end it, except between quotes, which are taken out. */
static int take_word(const reader *r, char **at, word *out)
{
    char *to = *at, *from = *at;
    int quoted = 0;
    out->text = to;
    out->value = NULL;
    for (; *from && (quoted || !is_blank(*from)); from++) {
        if (*from == '"') {
            quoted = !quoted;
        } else if (*from == '=' && !quoted && !out->value) {
            *to++ = '\0';
            out->value = to;
        } else {
            *to++ = *from;
        }
    }
    *at = *from ? from + 1 : from;
    *to = '\0';
    return quoted ? fail_at(r, r->line, "a quote is not closed") : 0;
}

/* The words of the next line, none in one that is empty or a comment. */
static int split_line(reader *r)
{
    char *at = r->at, *end = strchr(at, '\n');
    r->at = end ? end + 1 : NULL;
    if (end) *end = '\0';
    r->line++;
    r->word_count = 0;
    for (;;) {
        while (is_blank(*at)) at++;
        if (!*at || *at == '#') {
            return 0;
        }
        if (r->word_count == WORDS_MAX) {
            return fail_at(r, r->line, "a line has more than %u words", WORDS_MAX);
        }
        if (take_word(r, &at, &r->words[r->word_count++])) {
            return EXIT_FAILED;
        }
    }
}

/* ---- values ---- */

static int whole_number(const reader *r, const char *key, const char *text, uint64_t least, uint64_t most,
                        uint64_t *out)
{
    char *end = NULL;
    unsigned long long value;
    errno = 0;
    value = strtoull(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || *end) {
        return fail_at(r, r->line, "%s must be a whole number, not '%.60s'", key, text);
    }
    if (errno || value < least || value > most) {
        return fail_at(r, r->line, "%s is %.60s: it must be %llu to %llu", key, text, (unsigned long long)least,
                       (unsigned long long)most);
    }
    *out = value;
    return 0;
}

static int one_of(const reader *r, const char *key, const char *text, const char *const *names, uint32_t count,
                  uint32_t *out)
{
    for (*out = 0; *out < count; ++*out) {
        if (strcmp(text, names[*out]) == 0) {
            return 0;
        }
    }
    return fail_at(r, r->line, "%s has no value '%.60s'%s", key, text, hint_of(text, names, count).text);
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
        if (one_of(r, "root_axes", at, names, 5, &name)) {
            return EXIT_FAILED;
        }
        r->kind->root_axes |= bits[name];
    }
    return 0;
}

/* ---- packs ---- */

/* A path of the text: relative to its folder. NULL when out of memory. */
static char *beside(const char *text, const char *path)
{
    const char *slash = strrchr(text, '/');
    const size_t folder = slash && path[0] != '/' ? (size_t)(slash - text) + 1u : 0, length = strlen(path) + 1u;
    char *joined = malloc(folder + length);
    if (joined) {
        memcpy(joined, text, folder);
        memcpy(joined + folder, path, length);
    }
    return joined;
}

static int open_pack(const reader *r, char *path, const noh_pack **out)
{
    stage_desc_file *f = r->file;
    char subject[512], *real = realpath(path, NULL);
    int status;
    while (f->reader_of) f = f->reader_of;
    for (uint32_t i = 0; real && i < f->pack_count; i++) {
        if (strcmp(f->pack_paths[i], real) == 0) {
            *out = &f->packs[i].pack;
            free(real);
            return 0;
        }
    }
    if (f->pack_count == STAGE_DESC_PACKS_MAX) {
        free(real);
        return fail_at(r, r->line, "this file and its peers name more than %u packs", STAGE_DESC_PACKS_MAX);
    }
    (void)snprintf(subject, sizeof subject, "%s:%u: %s", r->path, r->line, path);
    status = pack_file_open_as(&f->packs[f->pack_count], path, subject);
    if (!status && !real) status = out_of_memory(r->path);
    if (status) {
        pack_file_close(&f->packs[f->pack_count]);
        free(real);
        return status;
    }
    f->packs[f->pack_count].path = f->pack_paths[f->pack_count] = real;
    *out = &f->packs[f->pack_count++].pack;
    return 0;
}

static int pack_beside(const reader *r, const char *text, const noh_pack **out)
{
    char *path = beside(r->path, text);
    const int status = path ? open_pack(r, path, out) : out_of_memory(r->path);
    free(path);
    return status;
}

static int add_clips(reader *r, const char *text)
{
    noh_kind_desc *k = r->kind;
    const noh_pack **list = r->file->clips[k - r->file->kinds];
    if (k->clip_pack_count == STAGE_DESC_CLIPS_MAX) {
        return fail_at(r, r->line, "a kind has more than %u packs of clips", STAGE_DESC_CLIPS_MAX);
    }
    k->clip_packs = list;
    return pack_beside(r, text, &list[k->clip_pack_count++]);
}

/* ---- layers ---- */

static int layer_option(const reader *r, const word *w, noh_layer_desc *layer)
{
    static const char *const names[] = { "joints", "floats", "tracks" };
    const char **text = strcmp(w->text, "joints") == 0 ? &layer->joints : &layer->floats;
    uint64_t count;
    if (strcmp(w->text, "tracks") == 0) {
        if (layer->track_count) return fail_at(r, r->line, "tracks= is given twice for this layer");
        if (whole_number(r, "tracks", w->value, 1, NOH_LAYER_TRACKS_MAX, &count)) return EXIT_FAILED;
        layer->track_count = (uint32_t)count;
        return 0;
    }
    if (strcmp(w->text, "joints") != 0 && strcmp(w->text, "floats") != 0) {
        return fail_at(r, r->line, "a layer has no option '%.60s'%s", w->text, hint_of(w->text, names, 3).text);
    }
    if (*text) return fail_at(r, r->line, "%s= is given twice for this layer", w->text);
    *text = w->value;
    return 0;
}

/* The words after a layer's name. */
static int layer_words(const reader *r, noh_layer_desc *layer)
{
    static const char *const modes[] = { "base", "over", "add" };
    int has_mode = 0;
    for (uint32_t i = 2; i < r->word_count; i++) {
        const word *w = &r->words[i];
        uint32_t mode;
        if (w->value) {
            if (layer_option(r, w, layer)) return EXIT_FAILED;
            continue;
        }
        if (has_mode++) return fail_at(r, r->line, "a layer takes no further word '%.60s'", w->text);
        if (one_of(r, "a layer", w->text, modes, 3, &mode)) return EXIT_FAILED;
        layer->mode = (noh_layer_mode)mode;
    }
    return 0;
}

static int add_layer(reader *r)
{
    noh_kind_desc *k = r->kind;
    noh_layer_desc *layers = r->file->layers[k - r->file->kinds];
    if (k->layer_count == NOH_LAYERS_MAX) {
        return fail_at(r, r->line, "a kind has more than %u layers", NOH_LAYERS_MAX);
    }
    for (uint32_t i = 0; i < k->layer_count; i++) {
        if (strcmp(layers[i].name, r->words[1].text) == 0) {
            return fail_at(r, r->line, "the layer '%.60s' is given twice", layers[i].name);
        }
    }
    layers[k->layer_count].name = r->words[1].text;
    k->layers = layers;
    return layer_words(r, &layers[k->layer_count++]);
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
    SET_OTHER_OF,
    SET_GRAPHS,
    SET_FACE,
    SET_RAGDOLLS,
    SET_MATCH,
    SET_SHARE,
    SET_PEER,
    SET_LAYER
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
    { "halves", SET_FLAG, 0, 0, offsetof(noh_stage_desc, halves), 0, 1 },
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
    { "finest_level", SET_COUNT, 1, 0, offsetof(noh_kind_desc, finest_level), 0, NOH_LOD_LEVELS_MAX - 1u },
    { "worn_by", SET_COUNT, 1, 0, offsetof(noh_kind_desc, worn_by), 1, (1u << NOH_STAGE_KINDS_MAX) - 1u },
    { "cover_count", SET_COUNT, 1, 0, offsetof(noh_kind_desc, cover_count), 0, 255 },
    { "clip_reserve", SET_COUNT, 1, 0, offsetof(noh_kind_desc, clip_reserve), 1, NOH_CLIP_RESERVE_MAX },
    { "inertia", SET_FLAG, 1, 0, offsetof(noh_kind_desc, inertia), 0, 1 },
    { "held_float_count", SET_HELD, 1, 0, offsetof(noh_kind_desc, held_float_count), 0, NOH_FLOATS_MAX },
    { "sample_rate_needed", SET_COUNT, 1, 0, offsetof(noh_kind_desc, sample_rate_needed), 1, 1000 },
    { "root_axes", SET_ROOT, 1, 0, 0, 0, 0 },
    { "layer", SET_LAYER, 1, 1, 0, 0, 0 },
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
        return fail_at(r, r->line, "pixels must be a number above 0 and at most 1000000, not '%.60s'", text);
    }
    r->file->desc.lod.pixels = (float)value;
    return 0;
}

static int set_number(reader *r, const setting *s, const char *text)
{
    char *in = s->of_kind ? (char *)r->kind : (char *)&r->file->desc;
    uint64_t value;
    if (whole_number(r, s->name, text, s->least, s->most, &value)) {
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

/* "joints", or the centres of the left and the right eye. */
static int set_face(reader *r)
{
    noh_kind_face *face = &r->file->faces[r->kind - r->file->kinds];
    r->kind->face = noh_face_module(face);
    if (r->word_count == 2 && strcmp(r->words[1].text, "joints") == 0) {
        return 0;
    }
    for (uint32_t i = 0; i < 6; i++) {
        double value = 0.0;
        if (r->word_count != 7 || tool_number(r->words[1 + i].text, &value) || !(value >= -1e6 && value <= 1e6)) {
            return fail_at(r, r->line, "face must be 'joints', or x y z of the left eye and x y z of the right eye");
        }
        face->face.eyes[i / 3][i % 3] = (float)value;
    }
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
            return fail_at(r, r->line, "the kind '%.60s' stays: add a line 'changes 1' to it", name);
        r->file->slot_of[r->kind - f->kinds] = 1u + i;
        return 0;
    }
    return fail_at(r, r->line, "no kind before this one has a slot and the name '%.60s'%s", name,
                   hint_of(name, names, count).text);
}

static int read_file(const char *path, stage_desc_file *reader_of, stage_desc_file **out);

/* Another text, of a stage with which this one shares. */
static int add_peer(const reader *r, const char *text)
{
    stage_desc_file *f = r->file, *of = f;
    char *path;
    int status;
    uint32_t depth = 0;
    while ((of = of->reader_of) != NULL) depth++;
    if (f->share.peer_count == STAGE_DESC_PEERS_MAX || depth == STAGE_DESC_PEERS_MAX) {
        return fail_at(r, r->line, "more than %u peers, or peers of each other", STAGE_DESC_PEERS_MAX);
    }
    path = beside(r->path, text);
    if (!path) return out_of_memory(r->path);
    status = read_file(path, f, &f->peer_files[f->share.peer_count]);
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
    case SET_MESH: return pack_beside(r, text, &r->kind->mesh);
    case SET_CLIPS: return add_clips(r, text);
    case SET_LAYER: return add_layer(r);
    case SET_FINER: return pack_beside(r, text, &r->kind->finer);
    case SET_OTHER_OF: return set_other_of(r, text);
    case SET_GRAPHS: r->kind->graphs = noh_graph_module(text); return 0;
    case SET_FACE: return set_face(r);
    default: return set_number(r, s, text);
    }
}

/* The words after a key: one, or for a layer any number; a value with an equals sign is none. */
static int check_words(const reader *r, const char *key, int any)
{
    if (r->word_count < 2 || !r->words[1].text[0]) {
        return fail_at(r, r->line, "%s needs a value", key);
    }
    if (r->words[0].value || r->words[1].value) {
        return fail_at(r, r->line, "write '%s VALUE' without an equals sign, or put quotes around the value", key);
    }
    return r->word_count > 2 && !any
               ? fail_at(r, r->line, "'%.60s' is one word too many after %s", r->words[2].text, key)
               : 0;
}

static int read_setting(reader *r, const setting *s)
{
    uint32_t *line = &r->given[s - settings];
    if (s->of_kind && !r->kind) {
        return fail_at(r, r->line, "'%s' belongs to a kind: write 'kind NAME' before it", s->name);
    }
    if (!s->of_kind && r->kind) {
        return fail_at(r, r->line, "'%s' belongs to the whole stage: move it before the first kind", s->name);
    }
    if (*line && !s->repeats) {
        return fail_at(r, r->line, "'%s' is given twice; the first is in line %u", s->name, *line);
    }
    *line = r->line;
    return check_words(r, s->name, s->kind == SET_LAYER || s->kind == SET_FACE) || set(r, s) ? EXIT_FAILED : 0;
}

static int unknown_key(const reader *r)
{
    const char *names[SETTING_COUNT + 1] = { "kind" };
    for (size_t i = 0; i < SETTING_COUNT; i++) {
        names[i + 1] = settings[i].name;
    }
    return fail_at(r, r->line, "there is no setting '%.60s'%s", r->words[0].text,
                   hint_of(r->words[0].text, names, SETTING_COUNT + 1).text);
}

/* ---- kinds ---- */

static int end_kind(reader *r)
{
    noh_kind_desc *k = r->kind;
    if (!k) {
        return 0;
    }
    if (!k->mesh) return fail_at(r, r->kind_line, "kind '%.60s' has no mesh: add a line 'mesh PATH'", k->name);
    if (!k->actor_count)
        return fail_at(r, r->kind_line, "kind '%.60s' has no actor_count: add a line 'actor_count N'", k->name);
    return 0;
}

static int begin_kind(reader *r)
{
    noh_stage_desc *d = &r->file->desc;
    if (end_kind(r) || check_words(r, "kind", 0)) {
        return EXIT_FAILED;
    }
    if (d->kind_count == NOH_STAGE_KINDS_MAX) {
        return fail_at(r, r->line, "there are more than %u kinds", NOH_STAGE_KINDS_MAX);
    }
    for (uint32_t i = 0; i < d->kind_count; i++) {
        if (strcmp(r->file->kinds[i].name, r->words[1].text) == 0) {
            return fail_at(r, r->line, "the kind '%.60s' is given twice", r->words[1].text);
        }
    }
    memset(r->given, 0, sizeof r->given);
    r->kind = &r->file->kinds[d->kind_count++];
    r->kind_line = r->line;
    r->kind->name = r->words[1].text;
    r->kind->root_up = 1; /* y, as packs have it */
    r->kind->springs = noh_springs_module(NULL);
    return 0;
}

static int read_line(reader *r)
{
    if (split_line(r)) {
        return EXIT_FAILED;
    }
    if (!r->word_count) {
        return 0;
    }
    if (strcmp(r->words[0].text, "kind") == 0) {
        return begin_kind(r);
    }
    for (size_t i = 0; i < SETTING_COUNT; i++) {
        if (strcmp(r->words[0].text, settings[i].name) == 0) {
            return read_setting(r, &settings[i]);
        }
    }
    return unknown_key(r);
}

/* Move the kinds that take slots of others out of the list. What they point to stays. */
static void sort_kinds(stage_desc_file *f)
{
    const uint32_t count = f->desc.kind_count;
    uint32_t others = 0, kinds = 0;
    for (uint32_t i = 0; i < count; i++) {
        noh_kind_desc *k = &f->kinds[i];
        if (f->slot_of[i]) continue;
        for (uint32_t o = i + 1u; o < count; o++) {
            if (f->slot_of[o] != 1u + i) continue;
            if (!k->other_count++) k->others = &f->others[others];
            f->others[others++] = f->kinds[o];
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!f->slot_of[i]) f->kinds[kinds++] = f->kinds[i];
    }
    f->desc.kind_count = kinds;
    f->desc.kinds = f->kinds;
}

/* ---- the file ---- */

static int read_all(reader *r)
{
    stage_desc_file *f = r->file;
    model_error error = { "", "" };
    size_t bytes = 0;
    int status = 0;
    f->text = input_read_text(r->path, &bytes, &error);
    if (!f->text) {
        return tool_fail(r->path, "%s", error.what);
    }
    if (memchr(f->text, 0, bytes)) {
        return tool_fail(r->path, "this is not a text file: it contains a zero byte");
    }
    r->at = f->text + (strncmp(f->text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0); /* a byte order mark */
    while (r->at && !status) {
        status = read_line(r);
    }
    if (!status) status = end_kind(r);
    if (!status && !f->desc.kind_count) status = tool_fail(r->path, "the file has no kind: add a line 'kind NAME'");
    sort_kinds(f);
    return status;
}

static int read_file(const char *path, stage_desc_file *reader_of, stage_desc_file **out)
{
    reader r;
    int status;
    memset(&r, 0, sizeof r);
    r.path = path;
    r.file = calloc(1, sizeof *r.file);
    *out = NULL;
    if (!r.file) {
        return out_of_memory(path);
    }
    r.file->reader_of = reader_of;
    status = read_all(&r);
    if (status) {
        stage_desc_file_free(r.file);
        return status;
    }
    *out = r.file;
    return 0;
}

int stage_desc_file_read(const char *path, stage_desc_file **out)
{
    return read_file(path, NULL, out);
}

void stage_desc_file_free(stage_desc_file *file)
{
    if (!file) {
        return;
    }
    for (uint32_t i = 0; i < file->share.peer_count; i++) stage_desc_file_free(file->peer_files[i]);
    for (uint32_t i = 0; i < file->pack_count; i++) {
        pack_file_close(&file->packs[i]);
        free(file->pack_paths[i]);
    }
    free(file->text);
    free(file);
}
