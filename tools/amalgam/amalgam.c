/* amalgam: the library as one source file, noh.c. It is compiled with the public headers in a folder noh/ next to it.
 *
 *   amalgam -o FOLDER -I FOLDER... FILE...      files are named from an -I folder, e.g. deform/morph/morph.c
 *
 * A FILE that ends in .h is a public header: noh.c includes it. The .c files follow: first those that need no GL, then,
 * inside #ifndef NOH_WITHOUT_GL, those that do; a private header stands where it is first included. In one translation
 * unit the names that files keep to themselves would clash, so a file-scope name of a .c
 * file that occurs anywhere else gets its file's name in front (run in morph.c: deform_morph_run), and the
 * macros that a .c file defines are undefined at its end. Names that begin with noh_ or NOH_ are kept.
 *
 * Names are found by a scan of tokens, not by a parser: it knows the shapes of declarations that the library uses, and
 * the compiler finds the others, because a name that was missed is a redefinition. Errors: stderr and exit code 1. */
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FILES_MAX 1024
#define FOLDERS_MAX 8
#define NAMES_MAX 4096
#define NAME_MAX_CHARS 128

typedef struct {
    char name[256];
    char *text;
    int is_source;
    int is_written;
} input;

static input inputs[FILES_MAX];
static int input_count;
static const char *folders[FOLDERS_MAX];
static int folder_count;
static char names[NAMES_MAX][NAME_MAX_CHARS]; /* that the current file declares at file scope */
static int name_count;

static void fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("amalgam: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    exit(1);
}

static char *read_file(const char *path)
{
    FILE *in = fopen(path, "rb");
    size_t bytes = 0, room = 0;
    char *text = NULL;
    if (!in) return NULL;
    do {
        room = room ? room * 2 : 65536;
        text = realloc(text, room + 1);
        if (!text) fail("out of memory");
        bytes += fread(text + bytes, 1, room - bytes, in);
    } while (bytes == room);
    if (ferror(in)) fail("%s: cannot be read", path);
    fclose(in);
    text[bytes] = 0;
    return text;
}

/* The index of an input, read when it is first asked for; -1 when no folder has it. */
static int find_input(const char *name)
{
    for (int i = 0; i < input_count; i++)
        if (!strcmp(inputs[i].name, name)) return i;
    for (int i = 0; i < folder_count; i++) {
        char path[1024];
        char *text;
        snprintf(path, sizeof path, "%s/%s", folders[i], name);
        text = read_file(path);
        if (!text) continue;
        if (input_count == FILES_MAX || strlen(name) >= sizeof inputs[0].name)
            fail("%s: too many files, or too long a name", name);
        strcpy(inputs[input_count].name, name);
        inputs[input_count].text = text;
        return input_count++;
    }
    return -1;
}

/* ---- tokens ---- */

typedef enum { TOKEN_END, TOKEN_NAME, TOKEN_SIGN, TOKEN_TEXT, TOKEN_DIRECTIVE } token_kind;

typedef struct {
    token_kind kind;
    const char *at;
    size_t chars;
} token;

static const char *end_of_comment(const char *at)
{
    const char *end = at[1] == '*' ? strstr(at + 2, "*/") : strchr(at, '\n');
    if (!end) return at + strlen(at);
    return at[1] == '*' ? end + 2 : end;
}

static const char *end_of_quoted(const char *at)
{
    char quote = *at++;
    while (*at && *at != quote) at += *at == '\\' && at[1] ? 2 : 1;
    return *at ? at + 1 : at;
}

/* A preprocessor line with its continuations. */
static const char *end_of_directive(const char *at)
{
    while (*at && (*at != '\n' || at[-1] == '\\')) at++;
    return at;
}

static int is_name_char(int c)
{
    return isalnum(c) || c == '_';
}

/* The next token at or after *at; white space and comments are passed over. Directives are one token only where the
 * caller reads declarations; where it renames, their words are tokens like others. */
static token next_token(const char **at, int with_directives)
{
    token t = { TOKEN_END, NULL, 0 };
    const char *p = *at;
    for (;;) {
        while (isspace((unsigned char)*p)) p++;
        if (p[0] != '/' || (p[1] != '*' && p[1] != '/')) break;
        p = end_of_comment(p);
    }
    t.at = p;
    if (!*p) {
        *at = p;
        return t;
    }
    if (*p == '#' && with_directives) {
        t.kind = TOKEN_DIRECTIVE;
        p = end_of_directive(p);
    } else if (*p == '"' || *p == '\'') {
        t.kind = TOKEN_TEXT;
        p = end_of_quoted(p);
    } else if (isalpha((unsigned char)*p) || *p == '_') {
        t.kind = TOKEN_NAME;
        while (is_name_char((unsigned char)*p)) p++;
    } else if (isdigit((unsigned char)*p)) {
        t.kind = TOKEN_TEXT;
        while (is_name_char((unsigned char)*p) || *p == '.') p++;
    } else {
        t.kind = TOKEN_SIGN;
        p++;
    }
    t.chars = (size_t)(p - t.at);
    *at = p;
    return t;
}

static int token_is(token t, const char *text)
{
    return t.chars == strlen(text) && !memcmp(t.at, text, t.chars);
}

static int occurs(const char *text, const char *name)
{
    size_t chars = strlen(name);
    for (const char *at = strstr(text, name); at; at = strstr(at + 1, name))
        if ((at == text || !is_name_char((unsigned char)at[-1])) && !is_name_char((unsigned char)at[chars])) return 1;
    return 0;
}

/* ---- the names of a file ---- */

static void add_name(token t)
{
    static const char *const keywords[] = { "static", "const",  "void",   "int",     "char",     "float",  "double",
                                            "struct", "enum",   "union",  "typedef", "unsigned", "signed", "long",
                                            "short",  "inline", "extern", "sizeof",  "defined" };
    char name[NAME_MAX_CHARS];
    if (t.chars >= sizeof name) fail("too long a name: %.*s", (int)t.chars, t.at);
    memcpy(name, t.at, t.chars);
    name[t.chars] = 0;
    if (!strncmp(name, "noh_", 4) || !strncmp(name, "NOH_", 4) || !strncmp(name, "__", 2)) return;
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++)
        if (!strcmp(name, keywords[i])) return;
    for (int i = 0; i < name_count; i++)
        if (!strcmp(names[i], name)) return;
    if (name_count == NAMES_MAX) fail("too many names");
    strcpy(names[name_count++], name);
}

/* Where a scan of declarations stands. */
typedef struct {
    int braces, parens;
    int in_enum;   /* its enumerators are file-scope names too */
    int in_value;  /* between = and the ; or , that ends it */
    int in_assert; /* NOH_STATIC_ASSERT(condition, name) declares its last word */
    token before, before_that, last_name;
} scan;

static void scan_sign(scan *s, char sign)
{
    if (sign == '{') s->braces++;
    if (sign == '}' && --s->braces == 0) s->in_enum = 0;
    if (sign == '(') s->parens++;
    if (sign == ')' && --s->parens == 0 && s->in_assert) {
        add_name(s->last_name);
        s->in_assert = 0;
    }
    if (s->braces || s->parens) return;
    if (sign == '=') s->in_value = 1;
    if (sign == ';' || sign == ',') s->in_value = 0;
}

/* Collects what a .c file declares at file scope: a word in front of ( [ = ; , or { outside of braces and parentheses,
 * the word of (*name), and enumerators. */
static void collect_names(const char *text)
{
    scan s;
    memset(&s, 0, sizeof s);
    name_count = 0;
    for (token t = next_token(&text, 1); t.kind != TOKEN_END; t = next_token(&text, 1)) {
        const char *ahead = text;
        token next = next_token(&ahead, 1);
        char sign = next.kind == TOKEN_SIGN ? *next.at : ' ';
        int is_outside = !s.braces && !s.in_value;
        if (t.kind == TOKEN_SIGN) {
            scan_sign(&s, *t.at);
        } else if (t.kind == TOKEN_NAME) {
            if (is_outside && !s.parens && token_is(t, "enum")) s.in_enum = 1;
            if (is_outside && !s.parens && token_is(t, "NOH_STATIC_ASSERT")) s.in_assert = 1;
            if (is_outside && !s.parens && strchr("([=;,{", sign)) add_name(t);
            if (is_outside && s.parens == 1 && token_is(s.before, "*") && token_is(s.before_that, "(") && sign == ')')
                add_name(t);
            if (s.in_enum && s.braces == 1 && strchr(",=}", sign)) add_name(t);
            s.last_name = t;
        }
        s.before_that = s.before;
        s.before = t;
    }
}

/* Keeps those that occur in another file. */
static void keep_shared_names(int own)
{
    int kept = 0;
    for (int i = 0; i < name_count; i++) {
        int is_shared = 0;
        for (int k = 0; k < input_count && !is_shared; k++) is_shared = k != own && occurs(inputs[k].text, names[i]);
        if (is_shared && kept++ != i) strcpy(names[kept - 1], names[i]);
    }
    name_count = kept;
}

/* ---- writing ---- */

/* "deform/morph/morph.c" -> "deform_morph_" */
static void write_prefix(FILE *out, const char *file)
{
    const char *end = strrchr(file, '.');
    for (; *file && file != end; file++) fputc(is_name_char((unsigned char)*file) ? *file : '_', out);
    fputc('_', out);
}

/* What renaming needs to know of the tokens before: whether they are ., -> or the beginning of a struct. */
typedef struct {
    token before, before_that;
    int struct_braces; /* how many are open, counted from the brace of the outermost struct or union */
} place;

static int is_struct(token t)
{
    return t.kind == TOKEN_NAME && (token_is(t, "struct") || token_is(t, "union"));
}

static void move_on(place *p, token t)
{
    if (t.kind == TOKEN_SIGN && *t.at == '{' && (p->struct_braces || is_struct(p->before) || is_struct(p->before_that)))
        p->struct_braces++;
    if (t.kind == TOKEN_SIGN && *t.at == '}' && p->struct_braces) p->struct_braces--;
    p->before_that = p->before;
    p->before = t;
}

/* Whether a name is a struct's member: where one is declared, or behind . or ->. */
static int is_member(const place *p, const char *behind)
{
    token next = next_token(&behind, 0);
    if (p->before.kind == TOKEN_SIGN && *p->before.at == '.') return 1;
    if (p->before.kind == TOKEN_SIGN && *p->before.at == '>' && p->before.at[-1] == '-') return 1;
    return p->struct_braces && next.kind == TOKEN_SIGN && strchr(";,[:", *next.at);
}

/* Text with the names of its file renamed, but not where they are members. */
static void write_renamed(FILE *out, const char *text, size_t chars, const char *file)
{
    const char *at = text, *end = text + chars, *written = text;
    place here;
    memset(&here, 0, sizeof here);
    while (at < end) {
        token t = next_token(&at, 0);
        if (t.kind == TOKEN_END || t.at >= end) break;
        for (int i = 0; i < name_count && t.kind == TOKEN_NAME; i++) {
            if (!token_is(t, names[i]) || is_member(&here, at)) continue;
            fwrite(written, 1, (size_t)(t.at - written), out);
            write_prefix(out, file);
            written = t.at;
        }
        move_on(&here, t);
    }
    fwrite(written, 1, (size_t)(end - written), out);
}

/* The name in #include "name", or 0. */
static int included_name(const char *line, char *name, size_t room)
{
    size_t chars;
    while (*line == ' ') line++;
    if (*line++ != '#') return 0;
    while (*line == ' ') line++;
    if (strncmp(line, "include", 7)) return 0;
    line += 7;
    while (*line == ' ') line++;
    if (*line++ != '"') return 0;
    chars = strcspn(line, "\"\n");
    if (chars >= room) fail("too long a name in #include");
    memcpy(name, line, chars);
    name[chars] = 0;
    return 1;
}

static void write_file(FILE *out, int index, int depth);

/* The file's lines: includes of the library's own headers are replaced by them, once; templates each time. */
static void write_lines(FILE *out, int index, int depth)
{
    const input *in = &inputs[index];
    const char *run = in->text, *line = in->text;
    while (*line) {
        const char *end = line + strcspn(line, "\n");
        char name[256];
        int header = included_name(line, name, sizeof name) ? find_input(name) : -1;
        if (*end) end++;
        if (header >= 0) {
            if (in->is_source)
                write_renamed(out, run, (size_t)(line - run), in->name);
            else
                fwrite(run, 1, (size_t)(line - run), out);
            write_file(out, header, depth + 1);
            run = end;
        }
        line = end;
    }
    if (in->is_source)
        write_renamed(out, run, (size_t)(line - run), in->name);
    else
        fwrite(run, 1, (size_t)(line - run), out);
}

static void write_undefs(FILE *out, const char *file, const char *text)
{
    for (token t = next_token(&text, 1); t.kind != TOKEN_END; t = next_token(&text, 1)) {
        const char *at = t.at + 1;
        token word;
        if (t.kind != TOKEN_DIRECTIVE) continue;
        word = next_token(&at, 0);
        if (!token_is(word, "define")) continue;
        word = next_token(&at, 0);
        fprintf(out, "#undef ");
        write_renamed(out, word.at, word.chars, file);
        fputc('\n', out);
    }
}

static void write_file(FILE *out, int index, int depth)
{
    if (inputs[index].is_written && !strstr(inputs[index].name, "_template.h")) return;
    if (depth > 64) fail("%s: includes itself", inputs[index].name);
    inputs[index].is_written = 1;
    fprintf(out, "/* ---- %s ---- */\n\n", inputs[index].name);
    write_lines(out, index, depth);
    if (inputs[index].is_source) write_undefs(out, inputs[index].name, inputs[index].text);
    fputc('\n', out);
}

/* Whether a source draws: of gl/ all but light, and the embedded shaders. */
static int needs_gl(const char *name)
{
    return (!strncmp(name, "gl/", 3) && strncmp(name, "gl/light/", 9)) || strchr(name, '/') == NULL;
}

static FILE *open_output(const char *folder, const char *name)
{
    char path[1024];
    FILE *out;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    out = fopen(path, "wb");
    if (!out) fail("%s: cannot be written", path);
    return out;
}

static void close_output(FILE *out, const char *name)
{
    if (ferror(out) || fclose(out)) fail("%s: cannot be written", name);
}

static int is_header(const char *name)
{
    size_t chars = strlen(name);
    return chars > 2 && !strcmp(name + chars - 2, ".h");
}

/* Reads the headers that a file includes. */
static void read_included(int index)
{
    for (const char *line = inputs[index].text; *line;) {
        char name[256];
        if (included_name(line, name, sizeof name)) (void)find_input(name);
        line += strcspn(line, "\n");
        if (*line) line++;
    }
}

static void write_sources(FILE *out, int with_gl, const int *sources, int count)
{
    for (int i = 0; i < count; i++) {
        input *in = &inputs[sources[i]];
        if (is_header(in->name) || needs_gl(in->name) != with_gl) continue;
        collect_names(in->text);
        keep_shared_names(sources[i]);
        in->is_source = 1;
        write_file(out, sources[i], 0);
    }
}

int main(int argc, char **argv)
{
    const char *folder = NULL;
    static int sources[FILES_MAX];
    int count = 0;
    FILE *out;
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "-o") && i + 1 < argc)
            folder = argv[++i];
        else if (!strcmp(argv[i], "-I") && i + 1 < argc && folder_count < FOLDERS_MAX)
            folders[folder_count++] = argv[++i];
        else if (count < FILES_MAX && (sources[count] = find_input(argv[i])) >= 0)
            count++;
        else
            fail("%s: not a file of the -I folders", argv[i]);
    }
    if (!folder || !count) fail("usage: amalgam -o FOLDER -I FOLDER... FILE...");
    /* This reads every header before the first name is looked up. */
    for (int i = 0; i < input_count; i++) read_included(i);

    out = open_output(folder, "noh.c");
    fputs(
        "/* noh.c: the library in one file. Compile it with -ffp-contract=off -fno-math-errno, so that results have the same bits\n"
        " * everywhere, and with -ffunction-sections -fdata-sections, so that the linker's --gc-sections drops what a program\n"
        " * does not call. NOH_WITHOUT_GL leaves out what draws. */\n",
        out);
    for (int i = 0; i < count; i++) {
        if (!is_header(inputs[sources[i]].name)) continue;
        fprintf(out, "#include \"%s\"\n", inputs[sources[i]].name);
        inputs[sources[i]].is_written = 1;
    }
    fputc('\n', out);
    write_sources(out, 0, sources, count);
    fputs("#ifndef NOH_WITHOUT_GL\n\n", out);
    write_sources(out, 1, sources, count);
    fputs("#endif\n", out);
    close_output(out, "noh.c");
    return 0;
}
