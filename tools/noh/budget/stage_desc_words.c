/* stage_desc_words.c: keys of a stage's text whose value has several words. */
#include "stage_desc_reader.h"

#include <string.h>

#include "cli/args.h"
#include "noh/light.h"

/* ---- layers ---- */

static int layer_option(const reader *r, const word *w, noh_layer_desc *layer)
{
    static const char *const names[] = { "joints", "floats", "tracks" };
    const char **text = strcmp(w->text, "joints") == 0 ? &layer->joints : &layer->floats;
    uint64_t count;
    if (strcmp(w->text, "tracks") == 0) {
        if (desc_number(r, "tracks", w->value, 1, NOH_LAYER_TRACKS_MAX, &count)) return EXIT_FAILED;
        layer->track_count = (uint32_t)count;
        return 0;
    }
    if (strcmp(w->text, "joints") != 0 && strcmp(w->text, "floats") != 0) {
        return desc_fail_at(r, r->line, "a layer has no option '%.60s'%s", w->text, desc_hint(w->text, names, 3).text);
    }
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
        if (has_mode++) return desc_fail_at(r, r->line, "a layer takes no further word '%.60s'", w->text);
        if (desc_one_of(r, "a layer", w->text, modes, 3, &mode)) return EXIT_FAILED;
        layer->mode = (noh_layer_mode)mode;
    }
    return 0;
}

int desc_add_layer(reader *r)
{
    noh_kind_desc *k = r->kind;
    noh_layer_desc *layers = r->file->layers[k - r->file->kinds];
    if (k->layer_count == NOH_LAYERS_MAX) {
        return desc_fail_at(r, r->line, "a kind has more than %u layers", NOH_LAYERS_MAX);
    }
    for (uint32_t i = 0; i < k->layer_count; i++) {
        if (strcmp(layers[i].name, r->words[1].text) == 0) {
            return desc_fail_at(r, r->line, "the layer '%.60s' is given twice", layers[i].name);
        }
    }
    layers[k->layer_count].name = r->words[1].text;
    k->layers = layers;
    return layer_words(r, &layers[k->layer_count++]);
}

/* "joints", or the centres of the left and the right eye. */
int desc_set_face(reader *r)
{
    noh_kind_face *face = &r->file->faces[r->kind - r->file->kinds];
    r->kind->face = noh_face_module(face);
    if (r->word_count == 2 && strcmp(r->words[1].text, "joints") == 0) {
        return 0;
    }
    for (uint32_t i = 0; i < 6; i++) {
        double value = 0.0;
        if (r->word_count != 7 || tool_number(r->words[1 + i].text, &value) || !(value >= -1e6 && value <= 1e6)) {
            return desc_fail_at(r, r->line,
                                "face must be 'joints', or x y z of the left eye and x y z of the right eye");
        }
        face->face.eyes[i / 3][i % 3] = (float)value;
    }
    return 0;
}

/* The side of the reflections and of the shadow map. No texel is read. */
int desc_set_light(reader *r)
{
    stage_desc_file *f = r->file;
    uint64_t side, shadow = 0;
    if (desc_number(r, "light", r->words[1].text, 16, NOH_REFLECTION_SIDE_MAX, &side)) return EXIT_FAILED;
    if (!noh_reflection_size((uint32_t)side))
        return desc_fail_at(r, r->line, "light needs a side of 16, 32, 64 or 128");
    if (r->word_count > 3) return desc_fail_at(r, r->line, "light takes two numbers: reflections and shadow map");
    if (r->word_count == 3 && desc_number(r, "the shadow map", r->words[2].text, 0, 65536, &shadow)) return EXIT_FAILED;
    if (shadow & 1u) return desc_fail_at(r, r->line, "the side of a shadow map is even");
    f->reflection.side = (uint32_t)side;
    f->light.reflection = &f->reflection;
    f->light.shadow_px = (uint32_t)shadow;
    f->desc.light = &f->light;
    return 0;
}

int desc_set_nodes(reader *r)
{
    noh_kind_desc *k = r->kind;
    uint32_t *nodes = r->file->nodes[k - r->file->kinds];
    for (uint32_t i = 1; i < r->word_count; i++) {
        uint64_t node;
        if (k->node_count == NOH_STAGE_MESHES_MAX)
            return desc_fail_at(r, r->line, "a kind has more than %u nodes", NOH_STAGE_MESHES_MAX);
        if (desc_number(r, "a node", r->words[i].text, 0, UINT32_MAX - 1u, &node)) return EXIT_FAILED;
        nodes[k->node_count++] = (uint32_t)node;
    }
    k->nodes = nodes;
    return 0;
}

/* A name, suffix=TEXT and pack=PATH. */
int desc_add_texture_set(reader *r)
{
    static const char *const names[] = { "suffix", "pack" };
    noh_kind_desc *k = r->kind;
    noh_texture_set *sets = r->file->texture_sets[k - r->file->kinds], *set = &sets[k->texture_set_count];
    if (k->texture_set_count == STAGE_DESC_TEXTURE_SETS_MAX)
        return desc_fail_at(r, r->line, "a kind has more than %u texture sets", STAGE_DESC_TEXTURE_SETS_MAX);
    set->name = r->words[1].text;
    for (uint32_t i = 2; i < r->word_count; i++) {
        const word *w = &r->words[i];
        uint32_t which;
        if (!w->value) return desc_fail_at(r, r->line, "a texture set takes no further word '%.60s'", w->text);
        if (desc_one_of(r, "a texture set", w->text, names, 2, &which)) return EXIT_FAILED;
        if (!which) set->suffix = w->value;
        if (which && desc_pack(r, w->value, &set->pack)) return EXIT_FAILED;
    }
    k->texture_sets = sets;
    k->texture_set_count++;
    return 0;
}

static void leave(noh_modifier_work *work)
{
    (void)work;
}

/* One of the library's by its name, or any name with state=BYTES and scratch=BYTES. */
int desc_add_modifier(reader *r)
{
    static const noh_gaze_rig gaze;
    static const noh_kind_feet feet;
    static const noh_reach_rig hands;
    static const noh_kind_stand stand;
    static const char *const names[] = { "state", "scratch" };
    noh_kind_desc *k = r->kind;
    noh_modifier *list = r->file->modifiers[k - r->file->kinds], *m = &list[k->modifier_count];
    const char *name = r->words[1].text;
    if (k->modifier_count == NOH_MODIFIERS_MAX)
        return desc_fail_at(r, r->line, "a kind has more than %u modifiers", NOH_MODIFIERS_MAX);
    *m = strcmp(name, "gaze") == 0    ? noh_gaze_modifier(&gaze)
         : strcmp(name, "feet") == 0  ? noh_feet_modifier(&feet)
         : strcmp(name, "hands") == 0 ? noh_reach_modifier(&hands)
         : strcmp(name, "stand") == 0 ? noh_stand_modifier(&stand)
                                      : (noh_modifier){ .name = name, .modify = leave };
    if (m->modify != leave && r->word_count > 2)
        return desc_fail_at(r, r->line, "the bytes of the modifier '%.60s' are known: leave out '%.60s'", name,
                            r->words[2].text);
    if (m->modify == leave && r->word_count == 2)
        return desc_fail_at(r, r->line,
                            "there is no modifier '%.60s': give its state=BYTES, or gaze, feet, hands or stand", name);
    for (uint32_t i = 2; i < r->word_count; i++) {
        const word *w = &r->words[i];
        uint64_t bytes;
        uint32_t which;
        if (!w->value) return desc_fail_at(r, r->line, "a modifier takes no further word '%.60s'", w->text);
        if (desc_one_of(r, "a modifier", w->text, names, 2, &which)) return EXIT_FAILED;
        if (desc_number(r, w->text, w->value, 0, 1u << 30, &bytes)) return EXIT_FAILED;
        *(which ? &m->scratch_bytes : &m->state_bytes) = (uint32_t)bytes;
    }
    k->modifiers = list;
    k->modifier_count++;
    return 0;
}

static int read_rig(const reader *r, const noh_pack *pack, uint32_t skeleton, noh_skeleton *joints,
                    noh_retarget_rig *rig)
{
    noh_ragdoll_source source;
    noh_error error = { NOH_OK, "the pack has no skeleton", 0, 0 };
    memset(&source, 0, sizeof source);
    source.pack = pack;
    source.skeleton = skeleton;
    if (noh_pack_skeleton_at(pack, skeleton, &source.joints, NULL, NULL) || noh_retarget_rig_make(&source, rig, &error))
        return desc_fail_at(r, r->kind_line, "map of kind '%.60s': %s", r->kind->name, error.what);
    *joints = source.joints;
    rig->skeleton = joints;
    return 0;
}

int desc_make_map(reader *r)
{
    stage_desc_file *f = r->file;
    const size_t at = (size_t)(r->kind - f->kinds);
    noh_retarget_rig from, to;
    noh_error error;
    if (!f->map_packs[at]) return 0;
    if (read_rig(r, f->map_packs[at], 0, &f->map_skeletons[at][0], &from) ||
        read_rig(r, r->kind->mesh, r->kind->skeleton, &f->map_skeletons[at][1], &to))
        return EXIT_FAILED;
    if (noh_retarget_init(&f->maps[at], &from, &to, NOH_RETARGET_FEET | NOH_RETARGET_HANDS, f->map_joints[at], &error))
        return desc_fail_at(r, r->kind_line, "map of kind '%.60s': %s", r->kind->name, error.what);
    r->kind->map = &f->maps[at].clips;
    return 0;
}
