/* test_gl_fetches.c: how many texels a pixel reads. The text that is compiled for a key is read as a preprocessor reads
 * it, and the texture functions that main reaches are counted, through all that it calls, both sides of each branch. */
#include "support/support.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <GLES3/gl32.h>

#include "gl/draw/gl_variants_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"

/* ---- a preprocessor: conditions, and defines without arguments ---- */

#define DEFINES_MAX 128

typedef struct reader {
    char names[DEFINES_MAX][48];
    long values[DEFINES_MAX];
    int count;
    const char *at; /* in a condition */
} reader;

static int define_of(const reader *r, const char *name)
{
    int i = r->count - 1;
    while (i >= 0 && strcmp(r->names[i], name) != 0) i--;
    return i;
}

static void blanks(reader *r)
{
    while (*r->at == ' ') r->at++;
}

static int takes(reader *r, const char *word)
{
    blanks(r);
    const size_t length = strlen(word);
    const int is = strncmp(r->at, word, length) == 0;
    if (is) r->at += length;
    return is;
}

static void name_into(reader *r, char name[48])
{
    size_t n = 0;
    blanks(r);
    while ((isalnum((unsigned char)*r->at) || *r->at == '_') && n < 47) name[n++] = *r->at++;
    name[n] = 0;
    assert_true(n > 0);
}

/* ! defined(NAME), NAME, a number */
static long unary(reader *r)
{
    char name[48];
    const int is_not = takes(r, "!"), is_defined = takes(r, "defined");
    const int in_brackets = takes(r, "(");
    name_into(r, name);
    if (in_brackets) assert_true(takes(r, ")"));
    const int i = define_of(r, name);
    const long value = is_defined                      ? i >= 0
                       : isdigit((unsigned char)*name) ? strtol(name, NULL, 10)
                       : i < 0                         ? 0
                                                       : r->values[i];
    return is_not ? !value : value;
}

static long comparison(reader *r)
{
    const long left = unary(r);
    if (takes(r, "==")) return left == unary(r);
    if (takes(r, "!=")) return left != unary(r);
    return takes(r, ">") ? left > unary(r) : left;
}

/* Comparisons with && and ||; && binds more. */
static long without_brackets(reader *r)
{
    long any = 0, all;
    do {
        all = comparison(r);
        while (takes(r, "&&")) all = comparison(r) && all;
        any = any || all;
    } while (takes(r, "||"));
    return any;
}

static long group(reader *r)
{
    long value;
    if (!takes(r, "(")) return comparison(r);
    value = without_brackets(r);
    assert_true(takes(r, ")"));
    return value;
}

/* The same of groups in brackets, which have none in them. */
static long condition(reader *r)
{
    long any = 0, all;
    do {
        all = group(r);
        while (takes(r, "&&")) all = group(r) && all;
        any = any || all;
    } while (takes(r, "||"));
    blanks(r);
    assert_true(*r->at == 0 || strncmp(r->at, "/*", 2) == 0);
    return any;
}

typedef struct branches {
    int on[16], was_on[16], depth;
} branches;

static int is_on(const branches *b)
{
    int all = 1;
    for (int i = 0; i <= b->depth; i++) all = all && b->on[i];
    return all;
}

static void push(branches *b, int on)
{
    assert_true(b->depth < 15);
    b->depth++;
    b->on[b->depth] = b->was_on[b->depth] = on;
}

static void define(reader *r)
{
    assert_true(r->count < DEFINES_MAX);
    name_into(r, r->names[r->count]);
    r->values[r->count++] = strtol(r->at, NULL, 10);
}

static void directive(reader *r, branches *b)
{
    char name[48];
    if (takes(r, "ifdef") || takes(r, "ifndef")) {
        const int is_not = r->at[-4] == 'n';
        name_into(r, name);
        push(b, (define_of(r, name) >= 0) != is_not);
    } else if (takes(r, "if")) {
        push(b, is_on(b) && condition(r));
    } else if (takes(r, "elif")) {
        b->on[b->depth] = !b->was_on[b->depth] && condition(r);
        b->was_on[b->depth] |= b->on[b->depth];
    } else if (takes(r, "else")) {
        b->on[b->depth] = !b->was_on[b->depth];
    } else if (takes(r, "endif")) {
        b->depth--;
        assert_true(b->depth >= 0);
    } else if (is_on(b) && takes(r, "define")) {
        define(r);
    }
}

/* What is left of a text, to be freed. */
static char *preprocessed(const char *text)
{
    reader r = { .count = 0 };
    branches b = { .on = { 1 }, .depth = 0 };
    char *out = test_zeros(strlen(text) + 1), *line = test_zeros(strlen(text) + 1), *to = out;
    for (const char *at = text; *at;) {
        const size_t length = strcspn(at, "\n");
        memcpy(line, at, length);
        line[length] = 0;
        if (*line == '#') {
            r.at = line + 1;
            directive(&r, &b);
        } else if (is_on(&b)) {
            to += sprintf(to, "%s\n", line);
        }
        at += length + (at[length] == '\n');
    }
    assert_int_equal(b.depth, 0);
    free(line);
    return out;
}

/* ---- what main reaches ---- */

/* The first place after `at` of a whole word that a bracket follows, of what begins with `word`; NULL: none. */
static const char *call_after(const char *at, const char *word, int whole)
{
    const size_t length = strlen(word);
    for (at = strstr(at, word); at; at = strstr(at + 1, word)) {
        const char *end = at + length;
        while (!whole && (isalnum((unsigned char)*end) || *end == '_')) end++;
        if (!isalnum((unsigned char)at[-1]) && at[-1] != '_' && *end == '(') break;
    }
    return at;
}

/* The end of what opens at `at`. */
static const char *closing(const char *at, char open, char close)
{
    int depth = 0;
    do {
        depth += (*at == open) - (*at == close);
        assert_true(*at);
        at++;
    } while (depth);
    return at;
}

typedef struct function {
    char name[48], *body;
} function;

typedef struct functions {
    function all[128];
    int count;
} functions;

/* Functions stand at the beginning of a line: a type, a name, a bracket. */
static void find_functions(const char *text, functions *f)
{
    f->count = 0;
    for (const char *line = text; line; line = strchr(line, '\n'), line = line ? line + 1 : NULL) {
        char type[48], name[48];
        int at = 0;
        if (sscanf(line, "%47[a-z0-9_] %47[A-Za-z0-9_](%n", type, name, &at) != 2 || !at) continue;
        const char *open = closing(line + at - 1, '(', ')');
        open += strspn(open, " \n");
        if (*open != '{' || strcmp(type, "return") == 0) continue;
        const char *end = closing(open, '{', '}');
        assert_true(f->count < 128);
        function *to = &f->all[f->count++];
        strcpy(to->name, name);
        to->body = test_zeros((size_t)(end - open) + 1);
        memcpy(to->body, open, (size_t)(end - open));
    }
}

static int calls_of(const char *body, const char *word, int whole)
{
    int count = 0;
    for (const char *at = call_after(body + 1, word, whole); at; at = call_after(at + 1, word, whole)) count++;
    return count;
}

/* A shader's functions call none below them, so a pass from the first to the last knows all that they need. */
static int fetches_of_main(const functions *f)
{
    int fetches[128] = { 0 };
    for (int i = 0; i < f->count; i++) {
        fetches[i] = calls_of(f->all[i].body, "texture", 0) + calls_of(f->all[i].body, "texelFetch", 0);
        fetches[i] -= calls_of(f->all[i].body, "textureSize", 1);
        for (int k = 0; k < i; k++) fetches[i] += fetches[k] * calls_of(f->all[i].body, f->all[k].name, 1);
    }
    assert_true(f->count > 0);
    assert_string_equal(f->all[f->count - 1].name, "main");
    return fetches[f->count - 1];
}

static int fetches_of_text(const char *text)
{
    functions f;
    char *left = preprocessed(text);
    find_functions(left, &f);
    const int fetches = fetches_of_main(&f);
    for (int i = 0; i < f.count; i++) free(f.all[i].body);
    free(left);
    return fetches;
}

/* ---- the library's texts ---- */

/* Behind the prefix goes mesh.frag without its #version. To be freed. */
static char *whole_text(noh_gl_variant_key key)
{
    const size_t bytes = noh_gl_shader_prefix(key, GL_FRAGMENT_SHADER, NULL, 0);
    FILE *file = fopen("shaders_es/mesh.frag", "rb");
    char *text = test_zeros(bytes + 65536);
    assert_non_null(file);
    (void)noh_gl_shader_prefix(key, GL_FRAGMENT_SHADER, text, bytes);
    assert_true(fread(text + bytes - 1, 1, 65535, file) > 100);
    fclose(file);
    return text;
}

/* transfer: as in the key; light is then noh_gl.h's */
static int fetches_of_transfer(uint32_t features, int lit, int crowd, uint32_t transfer)
{
    noh_gl_variant_key key = { 0 };
    key.features = features;
    key.lit = (uint8_t)(transfer && !lit ? 1 : lit);
    key.transfer = (uint8_t)transfer;
    key.crowd = key.texture = crowd != 0;
    key.fade = key.encode_srgb = 1;
    char *text = whole_text(key);
    const int fetches = fetches_of_text(text);
    free(text);
    return fetches;
}

static int fetches_of(uint32_t features, int lit, int crowd)
{
    return fetches_of_transfer(features, lit, crowd, 0);
}

#define MAPS (NOH_FEATURE_NORMAL_MAP | NOH_FEATURE_SURFACE_MAP | NOH_FEATURE_EMISSIVE | NOH_FEATURE_WRINKLES)
#define MORE_MAPS (MAPS | NOH_FEATURE_WRINKLE_PIXEL | NOH_FEATURE_SPECULAR_MAP | NOH_FEATURE_COLORS)

/* As many maps as packs may have, of those that a pixel reads. */
static int is_material(uint32_t features)
{
    uint32_t count = 0;
    for (uint32_t bit = 1; bit <= NOH_FEATURE_COLORS; bit *= 2) count += (features & bit & MORE_MAPS) != 0;
    return !(features & ~(uint32_t)(MORE_MAPS | NOH_FEATURE_SPECULAR_ROUGHNESS)) && count <= NOH_MATERIAL_MAPS_MAX &&
           (features & NOH_FEATURE_WRINKLES || !(features & NOH_FEATURE_WRINKLE_PIXEL)) &&
           (features & NOH_FEATURE_SPECULAR_MAP || !(features & NOH_FEATURE_SPECULAR_ROUGHNESS));
}

static void the_counter_counts(void **state)
{
    static const char text[] = "#define A 2\n"
                               "#if A > 1 && (defined(B) || !defined(C))\n"
                               "float one(vec2 p)\n{\n    return texture(t, p).x;\n}\n"
                               "#elif A == 2\n"
                               "float one(vec2 p)\n{\n    return 9.0 + texture(t, p).x + texture(t, p).y;\n}\n"
                               "#else\nbroken {\n"
                               "#endif\n"
                               "float never(vec2 p)\n{\n    return texture(t, p).x;\n}\n"
                               "float two(vec2 p)\n{\n    return one(p) + texelFetch(t, ivec2(p), 0).x;\n}\n"
                               "void main()\n{\n    o = two(x) + one(y) * my_texture(3) + textureLod(t, x, 0.0);\n}\n";
    (void)state;
    assert_int_equal(fetches_of_text(text), 4);
}

static void no_pixel_reads_more_than_eight_texels(void **state)
{
    static const uint32_t surfaces[] = { 0, NOH_FEATURE_SKIN, NOH_FEATURE_EYE, NOH_FEATURE_TEETH, NOH_FEATURE_HAIR };
    int most = 0;
    (void)state;
    for (uint32_t k = 0; k < 4096; k++) {
        const uint32_t features = (k & 2047u) | (k & 2048u ? NOH_FEATURE_COLORS : 0);
        for (int i = 0; i < 20 && is_material(features); i++) {
            const int lit = i & 1, crowd = i >> 1 & 1;
            const int fetches = fetches_of(features | surfaces[i >> 2], lit, crowd);
            assert_in_range(fetches, 1, NOH_GL_FETCHES_MAX);
            most = fetches > most ? fetches : most;
        }
    }
    for (uint32_t i = 0; i < 128; i++) { /* a toon reads no surface and specular maps */
        const uint32_t maps = (i & 32u ? NOH_FEATURE_COLORS : 0) | (i & 1u ? NOH_FEATURE_NORMAL_MAP : 0) |
                              (i & 2u ? NOH_FEATURE_EMISSIVE : 0) | (i & 4u ? NOH_FEATURE_TOON_SHADE : 0) |
                              (i & 8u ? NOH_FEATURE_MATCAP : 0) | (i & 64u ? NOH_FEATURE_TOON_MASKS : 0);
        if ((i & 0x6fu) != 0x6fu) /* a pack has at most five of the six */
            assert_in_range(fetches_of(NOH_FEATURE_TOON | maps, i >> 4 & 1u, 0), 1, NOH_GL_FETCHES_MAX);
    }
    assert_int_equal(fetches_of(NOH_FEATURE_TOON | NOH_FEATURE_OUTLINE, 1, 0), 1);
    for (uint32_t features = 0; features < 128; features++) {
        for (uint32_t i = 0; i < 40 && !(features & ~(uint32_t)MAPS);
             i++) { /* a transfer's records are read at vertices */
            const uint32_t transfer = (i & 1u ? 6u : 4u) | (i & 2u ? NOH_TRANSFER_ON_NORMAL : 0u);
            const int crowd = i >> 2 & 1;
            const uint32_t all = features | surfaces[i >> 3];
            assert_in_range(fetches_of_transfer(all, 1, crowd, transfer), 1, fetches_of(all, 1, crowd));
        }
    }
    print_message("a pixel of skin with everything reads %d texels, a plain one %d, a plain one that is lit %d\n",
                  fetches_of(MAPS | NOH_FEATURE_SKIN, 1, 0), fetches_of(0, 0, 0), fetches_of(0, 1, 0));
    assert_int_equal(most, NOH_GL_FETCHES_MAX); /* the shadow map takes what is left */
    assert_int_equal(fetches_of(MAPS | NOH_FEATURE_SKIN, 1, 0), 8);
    assert_int_equal(fetches_of(0, 0, 0), 1);
    assert_int_equal(fetches_of(NOH_FEATURE_COLORS, 0, 0), 2); /* one for four regions, also of a toon with a shade */
    assert_int_equal(fetches_of(NOH_FEATURE_COLORS | NOH_FEATURE_TOON | NOH_FEATURE_TOON_SHADE, 0, 0), 3);
    assert_int_equal(fetches_of(0, 1, 0), 6); /* base colour, environment, four of the shadow map */
    assert_int_equal(fetches_of(NOH_FEATURE_PHONE, 1, 0), 3);
    assert_int_equal(fetches_of(0, NOH_LIT_SOFT, 0), 3); /* one of a soft map */
    assert_int_equal(fetches_of(MAPS | NOH_FEATURE_SKIN, NOH_LIT_SOFT, 0), 7);
}

/* One more anywhere is a ninth. */
static void a_ninth_fetch_is_seen(void **state)
{
    noh_gl_variant_key key = { 0 };
    (void)state;
    key.features = MAPS | NOH_FEATURE_SKIN;
    key.lit = 1;
    char *text = whole_text(key), *at = strstr(text, "s.albedo = base.rgb;");
    assert_non_null(at);
    char *more = test_zeros(strlen(text) + 64);
    memcpy(more, text, (size_t)(at - text));
    sprintf(more + (at - text), "s.albedo = texture(noh_base_color_texture, uv).rgb;%s", at + 20);
    assert_int_equal(fetches_of_text(more), 9);
    free(more);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_counter_counts),
        cmocka_unit_test(no_pixel_reads_more_than_eight_texels),
        cmocka_unit_test(a_ninth_fetch_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
