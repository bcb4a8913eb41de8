#include "surface_kind.h"

#include <stdlib.h>
#include <string.h>

#include "convert/base/names.h"
#include "convert/model/model_build.h"
#include "noh/format.h"

#define WHITE_MIN (1.0f - 0.05f)

static const char *const names[] = {
    "plain", "skin", "eye", "teeth", "toon", "hair"
}; /* in the order of NOH_SURFACE_* */

uint32_t surface_kind_named(const char *word)
{
    for (uint32_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(word, names[i]) == 0) {
            return i;
        }
    }
    return MODEL_NONE;
}

/* ---- words ---- */

#define WORD_BYTES_MAX 32u

/* The small letter of a capital: Latin, with the accents of Latin-1, and Cyrillic. */
static void fold(unsigned char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        const unsigned char c = text[i], before = i ? text[i - 1] : 0;
        if ((c >= 'A' && c <= 'Z') || (before == 0xc3u && c >= 0x80u && c <= 0x9eu) ||
            (before == 0xd0u && c >= 0x90u && c <= 0x9fu)) {
            text[i] = (unsigned char)(c + 32u);
        } else if (before == 0xd0u && c >= 0xa0u && c <= 0xafu) {
            text[i - 1] = 0xd1u;
            text[i] = (unsigned char)(c - 32u);
        }
    }
}

static int is_small(unsigned char c)
{
    return c >= 'a' && c <= 'z';
}

static int is_capital(unsigned char c)
{
    return c >= 'A' && c <= 'Z';
}

/* Bytes of the word that a text begins with; 0: it begins with none. */
static size_t word_length(const char *text)
{
    const unsigned char *t = (const unsigned char *)text;
    size_t length = 0;
    while ((is_small(t[length]) || is_capital(t[length]) || t[length] >= 0x80u) &&
           !(length && is_capital(t[length]) && is_small(t[length - 1]))) {
        length++;
    }
    return length;
}

static int is_in(const char *material, const char *word, size_t length)
{
    char folded[WORD_BYTES_MAX];
    if (length > WORD_BYTES_MAX) return 0;
    memcpy(folded, word, length);
    fold((unsigned char *)folded, length);
    return names_has_word(material, folded, length);
}

/* Whether the table has a word or a part of the name for this kind. */
static int is_of(const char *name, const char *material)
{
    for (const char *at = name; *at;) {
        const size_t length = word_length(at);
        if (length && is_in(material, at, length)) return 1;
        at += length ? length : 1u;
    }
    return names_has_part(material, name);
}

static int is_eye_edge(const char *name)
{
    return is_of(name, "eye") && is_of(name, "eye-edge");
}

uint32_t surface_kind_of_name(const char *name)
{
    if (is_of(name, "plain")) return NOH_SURFACE_PLAIN;
    if (!is_of(name, "beside-eye") && !is_eye_edge(name) && is_of(name, "eye")) return NOH_SURFACE_EYE;
    if (is_of(name, "teeth") || is_of(name, "gums")) return NOH_SURFACE_TEETH;
    if (is_of(name, "skin")) return NOH_SURFACE_SKIN;
    if (!is_of(name, "beside-eye") && is_of(name, "hair")) return NOH_SURFACE_HAIR;
    return is_of(name, "toon") ? NOH_SURFACE_TOON : NOH_SURFACE_PLAIN;
}

uint32_t surface_kind_by_name(const char *name, model_alpha alpha)
{
    const uint32_t kind = surface_kind_of_name(name);
    return kind == NOH_SURFACE_HAIR && alpha == MODEL_ALPHA_OPAQUE ? NOH_SURFACE_PLAIN : kind;
}

int surface_is_white(const model_mesh *mesh, const model_submesh *part)
{
    for (uint32_t i = 0; mesh->color && i < part->index_count; i++) {
        const float *color = mesh->color + 4 * (size_t)mesh->indices[part->first_index + i];
        for (size_t c = 0; c < 3; c++) {
            if (color[c] < WHITE_MIN) return 0;
        }
    }
    return 1;
}

int surface_is_lashes(const char *name)
{
    return is_of(name, "lashes");
}

/* A word, or all of one that languages without spaces have as a part. */
static int is_all_of(const char *material, const char *word, size_t length)
{
    char part[WORD_BYTES_MAX + 1u] = "*";
    if (length > WORD_BYTES_MAX) return 0;
    memcpy(part + 1, word, length);
    return is_in(material, word, length) || names_has_word(material, part, length + 1u);
}

/* Whether a name has a word of either kind, and all others are neutral. */
static int is_only_of(const char *name, const char *material, const char *other)
{
    int found = 0;
    for (const char *at = name; *at;) {
        const size_t length = word_length(at);
        if (length && (is_all_of(material, at, length) || is_all_of(other, at, length))) {
            found = 1;
        } else if (length && !is_in("neutral", at, length)) {
            return 0; /* HeadLight, Zombie_Skin, Mouth_Guard, Shoe_Tongue */
        }
        at += length ? length : 1u;
    }
    return found;
}

int surface_is_gums(const char *name)
{
    return is_only_of(name, "gums", "gums");
}

int surface_is_bare(const char *name)
{
    return is_only_of(name, "bare", "skin");
}

/* Each capital of the pattern stands for one, each 0 for a digit. */
static int begins_as(const char *name, const char *pattern)
{
    for (; *pattern; name++, pattern++) {
        const int fits = *pattern == '0'                       ? *name >= '0' && *name <= '9'
                         : is_capital((unsigned char)*pattern) ? is_capital((unsigned char)*name)
                                                               : *name == *pattern;
        if (!fits) return 0;
    }
    return 1;
}

int surface_is_of_vroid(const char *name)
{
    static const char *const parts[] = { "_SKIN", "_FACE", "_EYE", "_HAIR", "_CLOTH" };
    int found = 0;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) found |= strstr(name, parts[i]) != NULL;
    return found && begins_as(name, "N00_000_");
}

/* ---- materials ---- */

static void forget_toon(model_material *m)
{
    memset(m->surface_values, 0, sizeof m->surface_values);
    memset(m->surface_more, 0, sizeof m->surface_more);
    m->toon_shade = m->outline_lit = m->toon_masks = 0;
    for (int i = 0; i < 3; i++) m->more_textures[i] = MODEL_NONE;
}

void surface_kind_set(model_material *m, uint32_t kind)
{
    static const float straight[] = { 0.04f, 0.028f, 0.025f, 0.04f, 0.04f, 0.04f };
    static const float shade[] = { 0.88f, 0.78f, 0.8f };
    const float before = straight[m->surface];
    if (kind == NOH_SURFACE_TOON) m->unlit = 0; /* exporters write both, for readers that know no toons */
    if (m->surface == NOH_SURFACE_TOON && kind != NOH_SURFACE_TOON) forget_toon(m);
    m->surface = m->unlit ? NOH_SURFACE_PLAIN : kind;
    if (m->surface == NOH_SURFACE_TOON && m->surface_more[0] <= 0.0f) {
        memcpy(m->surface_values, shade, sizeof shade);
        m->surface_more[0] = 0.9f; /* MToon's own */
    }
    for (int i = 0; i < 3; i++) {
        if (m->f0[i] > before - 1e-4f && m->f0[i] < before + 1e-4f) m->f0[i] = straight[m->surface];
    }
}

/* Black with an alpha multiplies what is behind it by the rest. */
static void set_alpha(model_material *shell, float alpha)
{
    shell->alpha = MODEL_ALPHA_BLEND;
    shell->base_color_texture = MODEL_NONE;
    memset(shell->base_color, 0, 3 * sizeof *shell->base_color);
    shell->base_color[3] = alpha;
    memset(shell->f0, 0, sizeof shell->f0);
    memset(shell->emissive, 0, sizeof shell->emissive);
    shell->specular_texture = shell->surface_texture = shell->normal_texture = shell->emissive_texture = MODEL_NONE;
    shell->metallic = 0.0f;
    shell->roughness = 1.0f;
    shell->f90_loss = 1.0f;
}

void surface_hide(model_material *m)
{
    set_alpha(m, 0.0f);
}

static int set_shell(model *m, model_material *shell, float alpha, const char *what)
{
    set_alpha(shell, alpha);
    return model_warn(
        m, "material '%s': an opaque shell would hide its eye, so it %s; to keep it, use --surface '%s=plain'",
        shell->name, what, shell->name);
}

int surface_shells_set(model *m)
{
    int failed = 0;
    for (uint32_t i = 0; i < m->material_count && !failed; i++) {
        model_material *shell = &m->materials[i];
        if (shell->alpha != MODEL_ALPHA_OPAQUE || shell->surface_given) continue;
        if (is_of(shell->name, "eye") && is_of(shell->name, "occlusion-shell")) {
            failed = set_shell(m, shell, 0.2f, "darkens the eye by a fifth");
        } else if (is_of(shell->name, "tear-shell") || is_eye_edge(shell->name)) {
            failed = set_shell(m, shell, 0.0f, "is left out");
        }
    }
    return failed;
}

/* What objects are by their names, as bits. */
#define WORN_BY_EYES 1u
#define WORN_BY_OTHERS 2u

static uint8_t bit_of(const char *name)
{
    return surface_kind_of_name(name ? name : "") == NOH_SURFACE_EYE ? WORN_BY_EYES : WORN_BY_OTHERS;
}

/* Whether neither the name nor the look of a material tells its kind: eyes of robots are metal. */
static int is_unknown(const model_material *m)
{
    return m->surface == NOH_SURFACE_PLAIN && !m->surface_given && m->alpha == MODEL_ALPHA_OPAQUE &&
           (m->metallic < 0.5f || m->surface_texture != MODEL_NONE) &&
           surface_kind_of_name(m->name) == NOH_SURFACE_PLAIN && !is_of(m->name, "plain") &&
           !is_of(m->name, "beside-eye") && !is_eye_edge(m->name);
}

int surface_kinds_of_objects(model *m)
{
    uint8_t *meshes = model_zeros(m->mesh_count, 1), *worn = model_zeros(m->material_count, 1);
    const int failed = !meshes || !worn;
    for (uint32_t i = 0; i < m->node_count && !failed; i++) {
        if (m->nodes[i].mesh != MODEL_NONE) meshes[m->nodes[i].mesh] |= bit_of(m->nodes[i].name);
    }
    for (uint32_t i = 0; i < m->mesh_count && !failed; i++) {
        const model_mesh *mesh = &m->meshes[i];
        if (meshes[i] && bit_of(mesh->name) == WORN_BY_EYES) meshes[i] = WORN_BY_EYES;
        for (uint32_t s = 0; s < mesh->submesh_count; s++) {
            if (mesh->submeshes[s].material != MODEL_NONE) worn[mesh->submeshes[s].material] |= meshes[i];
        }
    }
    for (uint32_t i = 0; i < m->material_count && !failed; i++) {
        if (worn[i] == WORN_BY_EYES && is_unknown(&m->materials[i]))
            surface_kind_set(&m->materials[i], NOH_SURFACE_EYE);
    }
    free(meshes);
    free(worn);
    return failed;
}

int surface_kind_assign(model *m, const char *assignment, model_error *error)
{
    const char *equals = strrchr(assignment, '=');
    const uint32_t kind = equals ? surface_kind_named(equals + 1) : MODEL_NONE;
    const size_t length = equals ? (size_t)(equals - assignment) : 0u;
    int found = 0;
    if (kind == MODEL_NONE) {
        return model_fail(error, "",
                          "--surface must be MATERIAL=skin, =eye, =teeth, =hair, =toon or =plain, not '%.80s'",
                          assignment);
    }
    for (uint32_t i = 0; i < m->material_count; i++) {
        const char *name = m->materials[i].name;
        if (strlen(name) == length && memcmp(name, assignment, length) == 0) {
            surface_kind_set(&m->materials[i], kind);
            m->materials[i].surface_given = 1;
            found = 1;
        }
    }
    return found ? 0
                 : model_fail(error, "", "--surface: no material is named '%.*s'; noh info lists a pack's materials",
                              (int)length, assignment);
}
