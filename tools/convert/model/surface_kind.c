#include "surface_kind.h"

#include <string.h>

#include "noh/format.h"

static const char *const names[] = { "plain", "skin", "eye", "teeth", "toon" }; /* in the order of NOH_SURFACE_* */

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

/* In small letters, each between spaces. */
static const char skin_words[] = " skin haut peau piel pelle pele huid skóra skora кожа ";
static const char eye_words[] =
    " eye eyes eyeball eyeballs iris irises pupil pupils sclera scleras cornea corneas auge augen augapfel œil oeil "
    "yeux "
    "ojo ojos olho olhos occhio occhi oog ogen oko oczy глаз глаза ";
static const char teeth_words[] =
    " tooth teeth gum gums tongue zahn zähne zaehne zunge zahnfleisch dent dents gencive gencives langue diente "
    "dientes "
    "encía encia lengua dente dentes dientes gengiva língua lingua denti lingue tand tanden tong zęby zeby język jezyk "
    "зуб зубы язык дёсны десны ";
/* A name with one of these words is not an eye. */
static const char around_words[] =
    " line highlight lash lashes eyelash eyelashes brow brows eyebrow eyebrows lid lids eyelid eyelids liner eyeliner "
    "eyeline shadow "
    "eyeshadow occlusion tear tears tearline glass glasses eyeglasses patch mask socket sockets wimper wimpern braue "
    "brauen lid lider cil cils sourcil sourcils pestaña pestañas ceja cejas ciglia sopracciglia ресницы брови ";
/* Languages that put no spaces between words: a name holds them anywhere. */
static const char *const joined_around[] = { "睫", "眉", "影", "眼鏡", "眼镜", "안경", "눈썹" };
static const char *const joined_eye[] = { "目", "瞳", "眼", "눈" };
static const char *const joined_teeth[] = { "歯", "舌", "牙", "齿", "이빨", "혀" };
static const char *const joined_skin[] = { "肌", "皮膚", "皮肤", "피부" };

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

static int is_in(const char *list, const char *word, size_t length)
{
    char spaced[WORD_BYTES_MAX + 3u];
    if (length > WORD_BYTES_MAX) return 0;
    spaced[0] = ' ';
    memcpy(spaced + 1, word, length);
    fold((unsigned char *)spaced + 1, length);
    memcpy(spaced + 1 + length, " ", 2);
    return strstr(list, spaced) != NULL;
}

static int has_word(const char *name, const char *list)
{
    while (*name) {
        const size_t length = word_length(name);
        if (length && is_in(list, name, length)) return 1;
        name += length ? length : 1u;
    }
    return 0;
}

static int has_part(const char *name, const char *const *parts, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (strstr(name, parts[i])) return 1;
    }
    return 0;
}

#define HAS_PART(name, parts) has_part(name, parts, sizeof(parts) / sizeof(parts)[0])

uint32_t surface_kind_of_name(const char *name)
{
    const int around = has_word(name, around_words) || HAS_PART(name, joined_around);
    if (!around && (has_word(name, eye_words) || HAS_PART(name, joined_eye))) return NOH_SURFACE_EYE;
    if (has_word(name, teeth_words) || HAS_PART(name, joined_teeth)) return NOH_SURFACE_TEETH;
    if (has_word(name, skin_words) || HAS_PART(name, joined_skin)) return NOH_SURFACE_SKIN;
    return NOH_SURFACE_PLAIN;
}

/* ---- materials ---- */

void surface_kind_set(model_material *m, uint32_t kind)
{
    static const float straight[] = { 0.04f, 0.028f, 0.025f, 0.04f, 0.04f };
    static const float shade[] = { 0.68f, 0.62f, 0.72f };
    const float before = straight[m->surface];
    if (kind == NOH_SURFACE_TOON) m->unlit = 0; /* exporters write both, for readers that know no toons */
    m->surface = m->unlit ? NOH_SURFACE_PLAIN : kind;
    if (m->surface == NOH_SURFACE_TOON && m->surface_more[0] <= 0.0f) {
        memcpy(m->surface_values, shade, sizeof shade);
        m->surface_more[0] = 0.9f; /* MToon's own */
    }
    for (int i = 0; i < 3; i++) {
        if (m->f0[i] > before - 1e-4f && m->f0[i] < before + 1e-4f) m->f0[i] = straight[m->surface];
    }
}

int surface_kind_assign(model *m, const char *assignment, model_error *error)
{
    const char *equals = strrchr(assignment, '=');
    const uint32_t kind = equals ? surface_kind_named(equals + 1) : MODEL_NONE;
    const size_t length = equals ? (size_t)(equals - assignment) : 0u;
    int found = 0;
    if (kind == MODEL_NONE) {
        return model_fail(error, "", "--surface must be MATERIAL=skin, =eye, =teeth, =toon or =plain, not '%.80s'",
                          assignment);
    }
    for (uint32_t i = 0; i < m->material_count; i++) {
        const char *name = m->materials[i].name;
        if (strlen(name) == length && memcmp(name, assignment, length) == 0) {
            surface_kind_set(&m->materials[i], kind);
            found = 1;
        }
    }
    return found ? 0
                 : model_fail(error, "", "--surface: no material is named '%.*s'; noh info lists a pack's materials",
                              (int)length, assignment);
}
