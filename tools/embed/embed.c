/* embed: turns GLSL sources into C.
 *
 *   embed -o OUT.c [-d DEPS.d] [-D NAME=VALUE]... FILE...
 *
 * Each FILE becomes a `noh_gl_source` (see low_gl.h) named after
 * it: probe_store.frag gives noh_shader_probe_store_frag. Its #version line is kept apart, so that a program can put
 * its own lines right after it or ask for another version. #include "x" is replaced by that file, found next to the
 * including one, once per FILE, whatever #if stands around it; the #line numbers
 * tell source files apart, and a comment in OUT.c says which number is which file.
 * Comments, indents and blanks at line ends are left out; a run of lines without code
 * becomes empty lines or a #line, whichever is shorter, so that a driver's message still
 * names the file and line of the source.
 *
 * A FILE that ends in .glsl has no #version: it becomes one zero-terminated array of
 * characters, `const char noh_shader_NAME_glsl[]`, for glShaderSource behind a #version of
 * the caller's. It may not #include, so that every file's text is there once.
 *
 * Every -D becomes a #define at the top. OUT.h, beside OUT.c, declares all of it.
 *
 * Errors go to stderr as `embed: FILE:LINE: what`, exit code 1, and neither
 * output is replaced. Wrong usage is exit code 2. */
#define _POSIX_C_SOURCE 200809L

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define INPUTS_MAX 256  /* FILEs in one run */
#define INCLUDES_MAX 64 /* files in one flattened source */
#define DEPTH_MAX 16    /* #include nesting */
#define DEFINES_MAX 256
#define PIECES_MAX 56    /* keep in step with NOH_GL_PIECES_MAX in low_gl.h */
#define PIECE_CHARS 4000 /* C99 promises string literals of 4095 characters */

typedef struct text {
    char *data;
    size_t bytes, room;
} text;

/* A file's content, and where reading stands in it. */
typedef struct source {
    const char *path;
    char *content;
    size_t bytes;
} source;

typedef struct flattened {
    char name[128];
    char version[64];
    text body;
    char *files[INCLUDES_MAX];
    size_t file_count;
    size_t stack[DEPTH_MAX]; /* indices into files: the chain of includes */
    size_t depth;
    int is_snippet;   /* a .glsl file */
    size_t at_file;   /* where the compiler believes to be in the text so far: the next line is line */
    unsigned at_line; /* at_line of files[at_file]; 0: anywhere else */
} flattened;

typedef struct job {
    const char *out_c, *deps;
    const char *defines[DEFINES_MAX];
    size_t define_count;
    const char *inputs[INPUTS_MAX];
    size_t input_count;
    text c, h, prerequisites;
} job;

/* Files to remove if the run fails. */
static char *unfinished[3];

static void stop(int code)
{
    for (size_t i = 0; i < sizeof unfinished / sizeof *unfinished; i++) {
        if (unfinished[i]) remove(unfinished[i]);
    }
    exit(code);
}

static void fail(const char *path, unsigned line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (line)
        fprintf(stderr, "embed: %s:%u: ", path, line);
    else
        fprintf(stderr, "embed: %s: ", path);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    stop(1);
}

static void usage(const char *what)
{
    fprintf(stderr, "embed: %s\nusage: embed -o OUT.c [-d DEPS.d] [-D NAME=VALUE]... FILE...\n", what);
    stop(2);
}

static void *allocate(void *old, size_t bytes)
{
    void *memory = realloc(old, bytes);
    if (!memory) fail("memory", 0, "out of memory");
    return memory;
}

static char *copy(const char *string, size_t bytes)
{
    char *memory = allocate(NULL, bytes + 1);
    memcpy(memory, string, bytes);
    memory[bytes] = 0;
    return memory;
}

static void append(text *out, const char *data, size_t bytes)
{
    if (out->bytes + bytes + 1 > out->room) {
        out->room = (out->bytes + bytes + 1) * 2;
        out->data = allocate(out->data, out->room);
    }
    memcpy(out->data + out->bytes, data, bytes);
    out->bytes += bytes;
    out->data[out->bytes] = 0;
}

static void appendf(text *out, const char *format, ...)
{
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    if (length < 0 || (size_t)length >= sizeof line) fail("output", 0, "a name is too long");
    append(out, line, (size_t)length);
}

/* --- reading --- */

static source read_source(const char *path, const char *from, unsigned from_line)
{
    source out = { path, NULL, 0 };
    FILE *file = fopen(path, "rb");
    if (!file) fail(from, from_line, "cannot open %s: %s", path, strerror(errno));
    text content = { NULL, 0, 0 };
    append(&content, "", 0);
    char block[4096];
    size_t got;
    while ((got = fread(block, 1, sizeof block, file)) > 0) append(&content, block, got);
    if (ferror(file)) fail(path, 0, "cannot read: %s", strerror(errno));
    fclose(file);
    if (memchr(content.data, 0, content.bytes)) fail(path, 0, "has a zero byte, not a text file");
    out.content = content.data;
    out.bytes = content.bytes;
    return out;
}

static const char *skip_blanks(const char *p)
{
    while (*p == ' ' || *p == '\t') p++;
    return p;
}

/* "  #  include ..." with word "include" gives the rest of the line, else NULL. */
static const char *directive(const char *line, const char *word)
{
    const char *p = skip_blanks(line);
    if (*p != '#') return NULL;
    p = skip_blanks(p + 1);
    size_t length = strlen(word);
    if (strncmp(p, word, length) != 0 || isalnum((unsigned char)p[length]) || p[length] == '_') return NULL;
    return p + length;
}

/* Follow comments through one line. Returns whether a block comment is still
 * open at its end; *has_code tells whether anything stood outside comments. */
static int scan_comments(const char *line, int in_comment, int *has_code)
{
    *has_code = 0;
    for (const char *p = line; *p; p++) {
        if (in_comment) {
            if (p[0] == '*' && p[1] == '/') {
                in_comment = 0;
                p++;
            }
        } else if (p[0] == '/' && p[1] == '*') {
            in_comment = 1;
            p++;
        } else if (p[0] == '/' && p[1] == '/') {
            break;
        } else if (!isspace((unsigned char)*p)) {
            *has_code = 1;
        }
    }
    return in_comment;
}

/* Append what is left of a line without comments, its first and last blanks, and more than one blank in a row. A
 * comment counts as a blank. Returns whether a block comment is open at the end. */
static int append_code(text *out, const char *line, int in_comment)
{
    size_t start = out->bytes;
    int blank = 0;
    for (const char *p = line; *p; p++) {
        if (in_comment || (p[0] == '/' && p[1] == '*')) {
            const char *end = strstr(in_comment ? p : p + 2, "*/");
            in_comment = !end;
            blank = 1;
            if (!end) break;
            p = end + 1;
        } else if (p[0] == '/' && p[1] == '/') {
            break;
        } else if (isspace((unsigned char)*p)) {
            blank = 1;
        } else {
            if (blank && out->bytes > start) append(out, " ", 1);
            append(out, p, 1);
            blank = 0;
        }
    }
    return in_comment;
}

/* One line of a file. Lines without code before it become empty lines, or a #line where that is shorter. */
#define EMPTY_LINES_MAX 9u
static void write_line(flattened *out, const char *path, unsigned line, const char *content, int in_comment)
{
    const size_t file = out->stack[out->depth - 1];
    text code = { NULL, 0, 0 };
    int open = append_code(&code, content, in_comment);
    if (code.bytes) {
        if (open && code.data[0] == '#') fail(path, line, "a comment in a directive does not end in its line");
        if (out->at_file == file && line >= out->at_line && line - out->at_line <= EMPTY_LINES_MAX && out->at_line) {
            for (unsigned i = out->at_line; i < line; i++) append(&out->body, "\n", 1);
        } else if (!out->is_snippet) {
            appendf(&out->body, "#line %u %zu\n", line, file);
        }
        append(&out->body, code.data, code.bytes);
        append(&out->body, "\n", 1);
        out->at_file = file;
        out->at_line = line + 1;
    }
    free(code.data);
}

/* The path of an #include's file: next to the file that includes it. */
static char *include_path(const char *from, unsigned line, const char *rest)
{
    const char *start = skip_blanks(rest);
    const char *end = *start == '"' ? strchr(start + 1, '"') : NULL;
    if (!end || end == start + 1) fail(from, line, "expected #include \"file\"");
    int has_code;
    scan_comments(end + 1, 0, &has_code);
    if (has_code) fail(from, line, "unexpected text after #include \"file\"");
    const char *slash = strrchr(from, '/');
    size_t folder = slash ? (size_t)(slash - from) + 1 : 0;
    size_t name = (size_t)(end - start) - 1;
    char *path = allocate(NULL, folder + name + 1);
    memcpy(path, from, folder);
    memcpy(path + folder, start + 1, name);
    path[folder + name] = 0;
    return path;
}

static size_t find_file(const flattened *out, const char *path)
{
    for (size_t i = 0; i < out->file_count; i++) {
        if (strcmp(out->files[i], path) == 0) return i;
    }
    return out->file_count;
}

static void take_version(flattened *out, const char *path, unsigned line, const char *text_line, int at_top)
{
    if (out->depth > 1) fail(path, line, "#version in an included file");
    if (out->is_snippet) fail(path, line, "#version in a .glsl file");
    if (out->version[0]) fail(path, line, "a second #version");
    if (!at_top) fail(path, line, "#version must come first");
    if (strlen(text_line) + 2 > sizeof out->version) fail(path, line, "the #version line is too long");
    snprintf(out->version, sizeof out->version, "%s\n", skip_blanks(text_line));
}

static void flatten(flattened *out, const char *path, const char *from, unsigned from_line);

/* Put the included file in place of line `line` of `path`, then come back. */
static void take_include(flattened *out, const char *path, unsigned line, const char *rest)
{
    char *included = include_path(path, line, rest);
    size_t index = find_file(out, included);
    for (size_t i = 0; i < out->depth; i++) {
        if (out->stack[i] == index) fail(path, line, "%s includes itself", included);
    }
    if (index == out->file_count) flatten(out, included, path, line);
    free(included);
}

static void flatten_lines(flattened *out, source *in)
{
    int in_comment = 0, code_seen = 0;
    unsigned line = 1, comment_line = 0;
    const char *path = in->path;
    for (char *p = in->content; *p; line++) {
        char *end = strchr(p, '\n');
        char *next = end ? end + 1 : p + strlen(p);
        if (!end) end = next;
        if (end > p && end[-1] == '\r') end[-1] = 0;
        *end = 0; /* next was found before; the buffer has a zero at its end */
        int has_code;
        int was_in_comment = in_comment;
        in_comment = scan_comments(p, in_comment, &has_code);
        if (in_comment && !was_in_comment) comment_line = line;
        const char *rest;
        if (!was_in_comment && (rest = directive(p, "include")) != NULL) {
            if (out->is_snippet) fail(path, line, "a .glsl file includes nothing when it is embedded by itself");
            if (out->depth == 1 && !out->version[0]) fail(path, line, "#include before #version");
            take_include(out, path, line, rest);
        } else if (!was_in_comment && directive(p, "version")) {
            take_version(out, path, line, p, !code_seen);
        } else {
            write_line(out, path, line, p, was_in_comment);
        }
        code_seen |= has_code;
        p = next;
    }
    if (in_comment) fail(path, comment_line, "this comment is not closed");
}

/* Append a file and, in place, all that it includes. `from` names it in errors. */
static void flatten(flattened *out, const char *path, const char *from, unsigned from_line)
{
    if (out->depth == DEPTH_MAX) fail(from, from_line, "#include nests deeper than %d", DEPTH_MAX);
    if (out->file_count == INCLUDES_MAX) fail(from, from_line, "more than %d files in one source", INCLUDES_MAX);
    source in = read_source(path, from, from_line);
    size_t index = out->file_count++;
    out->files[index] = copy(path, strlen(path));
    out->stack[out->depth++] = index;
    flatten_lines(out, &in);
    out->depth--;
    free(in.content);
}

/* --- writing --- */

/* One source character as it stands in a C string literal. '?' is escaped
 * because C99 still has trigraphs. */
static void append_escaped(text *out, char c)
{
    unsigned char u = (unsigned char)c;
    if (c == '\n')
        append(out, "\\n", 2);
    else if (c == '"' || c == '\\' || c == '?')
        appendf(out, "\\%c", c);
    else if (u < 32 || u > 126)
        appendf(out, "\\%03o", u);
    else
        append(out, &c, 1);
}

/* Where the piece that starts at `start` ends: after a line where possible. */
static size_t piece_end(const text *body, size_t start)
{
    size_t end = start + PIECE_CHARS;
    if (end >= body->bytes) return body->bytes;
    for (size_t i = end; i > start; i--) {
        if (body->data[i - 1] == '\n') return i;
    }
    return end;
}

static void write_piece(text *c, const text *body, size_t start, size_t end)
{
    append(c, "    \"", 5);
    for (size_t i = start; i < end; i++) {
        append_escaped(c, body->data[i]);
        if (body->data[i] == '\n' && i + 1 < end) append(c, "\"\n    \"", 7);
    }
    append(c, "\",\n", 3);
}

static void write_source(job *work, const flattened *in)
{
    text *c = &work->c;
    size_t pieces = 0;
    appendf(c, "\n");
    for (size_t i = 0; i < in->file_count; i++) appendf(c, "/* source %zu: %s */\n", i, in->files[i]);
    appendf(c, "static const char *const %s_pieces[] = {\n", in->name);
    for (size_t at = 0; at < in->body.bytes; pieces++) {
        size_t end = piece_end(&in->body, at);
        write_piece(c, &in->body, at, end);
        at = end;
    }
    if (pieces > PIECES_MAX) fail(in->files[0], 0, "the source is longer than %d bytes", PIECES_MAX * PIECE_CHARS);
    appendf(c, "};\nconst noh_gl_source %s = {\n    \"", in->name);
    for (const char *p = in->version; *p; p++) append_escaped(c, *p);
    appendf(c, "\", %s_pieces, %zu\n};\n", in->name, pieces);
    appendf(&work->h, "extern const noh_gl_source %s; /* %s */\n", in->name, in->files[0]);
}

/* As an array: literals of C99 end at 4095 characters. */
static void write_snippet(job *work, const flattened *in)
{
    text *c = &work->c;
    appendf(c, "\n/* %s */\nconst char %s[] = {", in->files[0], in->name);
    for (size_t i = 0; i < in->body.bytes; i++) {
        if (i % 24 == 0) append(c, "\n    ", 5);
        appendf(c, "%d,", in->body.data[i]);
    }
    append(c, "0\n};\n", 5);
    appendf(&work->h, "extern const char %s[]; /* %s */\n", in->name, in->files[0]);
}

/* "shaders/probe_store.frag" gives "noh_shader_probe_store_frag". */
static void name_source(flattened *out, const char *path)
{
    const char *base = strrchr(path, '/');
    base = base ? base + 1 : path;
    int length = snprintf(out->name, sizeof out->name, "noh_shader_%s", base);
    if (length < 0 || (size_t)length >= sizeof out->name) fail(path, 0, "the file's name is too long");
    for (char *p = out->name; *p; p++) {
        if (!isalnum((unsigned char)*p)) *p = '_';
    }
}

/* Make's file names: blanks, '#' and '$' need an escape. */
static void append_make_path(text *out, const char *path)
{
    for (const char *p = path; *p; p++) {
        if (*p == ' ' || *p == '#') append(out, "\\", 1);
        if (*p == '$') append(out, "$", 1);
        append(out, p, 1);
    }
}

static void note_prerequisites(job *work, const flattened *in)
{
    for (size_t i = 0; i < in->file_count; i++) {
        append(&work->prerequisites, " \\\n  ", 5);
        append_make_path(&work->prerequisites, in->files[i]);
    }
}

static char *header_path(const char *out_c)
{
    size_t length = strlen(out_c);
    if (length < 3 || strcmp(out_c + length - 2, ".c") != 0) usage("-o needs a name that ends in .c");
    char *path = copy(out_c, length);
    path[length - 1] = 'h';
    return path;
}

/* Write to a temporary file; it is renamed when all files are written. */
static void write_unfinished(size_t slot, const char *goal, const text *content)
{
    size_t room = strlen(goal) + 32;
    char *path = allocate(NULL, room);
    snprintf(path, room, "%s.tmp%ld", goal, (long)getpid());
    FILE *file = fopen(path, "wb");
    if (!file) fail(path, 0, "cannot create: %s", strerror(errno));
    unfinished[slot] = path;
    if (fwrite(content->data, 1, content->bytes, file) != content->bytes || fflush(file) != 0) {
        fail(path, 0, "cannot write: %s", strerror(errno));
    }
    if (fclose(file) != 0) fail(path, 0, "cannot write: %s", strerror(errno));
}

static void finish(size_t slot, const char *goal)
{
    if (rename(unfinished[slot], goal) != 0) fail(goal, 0, "cannot replace: %s", strerror(errno));
    free(unfinished[slot]);
    unfinished[slot] = NULL;
}

static text deps_text(const job *work, const char *out_h)
{
    text deps = { NULL, 0, 0 };
    append_make_path(&deps, work->out_c);
    append(&deps, " ", 1);
    append_make_path(&deps, out_h);
    append(&deps, ":", 1);
    append(&deps, work->prerequisites.data, work->prerequisites.bytes);
    append(&deps, "\n", 1);
    /* An empty rule for each, so that a file may be removed or renamed. */
    const char *p = work->prerequisites.data;
    while ((p = strstr(p, " \\\n  ")) != NULL) {
        p += 5;
        const char *end = strstr(p, " \\\n  ");
        append(&deps, "\n", 1);
        append(&deps, p, end ? (size_t)(end - p) : strlen(p));
        append(&deps, ":\n", 2);
    }
    return deps;
}

static void write_outputs(job *work)
{
    char *out_h = header_path(work->out_c);
    write_unfinished(0, work->out_c, &work->c);
    write_unfinished(1, out_h, &work->h);
    if (work->deps) {
        text deps = deps_text(work, out_h);
        write_unfinished(2, work->deps, &deps);
        free(deps.data);
        finish(2, work->deps);
    }
    finish(1, out_h);
    finish(0, work->out_c);
    free(out_h);
}

/* --- the whole run --- */

static void check_define(const char *define)
{
    const char *p = define;
    if (!isalpha((unsigned char)*p) && *p != '_') usage("-D needs NAME=VALUE");
    while (isalnum((unsigned char)*p) || *p == '_') p++;
    if (*p != '=' || p[1] == 0) usage("-D needs NAME=VALUE");
    if (strchr(p, '\n')) usage("-D: a value is one line");
}

static void parse(job *work, int count, char **arguments)
{
    for (int i = 1; i < count; i++) {
        const char *argument = arguments[i];
        int takes_value = argument[0] == '-' && argument[1] && !argument[2] && strchr("odD", argument[1]) != NULL;
        if (takes_value && i + 1 == count) usage("a flag lacks its value");
        if (takes_value) {
            const char *value = arguments[++i];
            if (argument[1] == 'o')
                work->out_c = value;
            else if (argument[1] == 'd')
                work->deps = value;
            else if (work->define_count == DEFINES_MAX)
                usage("too many -D");
            else {
                check_define(value);
                work->defines[work->define_count++] = value;
            }
        } else if (argument[0] == '-') {
            usage("unknown flag");
        } else if (work->input_count == INPUTS_MAX) {
            usage("too many files");
        } else {
            work->inputs[work->input_count++] = argument;
        }
    }
    if (!work->out_c) usage("-o OUT.c is missing");
    if (work->input_count == 0) usage("no files");
}

static void embed_file(job *work, const char *path, char names[][128], size_t index)
{
    flattened *out = allocate(NULL, sizeof *out);
    memset(out, 0, sizeof *out);
    name_source(out, path);
    out->is_snippet = strlen(path) > 5 && strcmp(path + strlen(path) - 5, ".glsl") == 0;
    for (size_t i = 0; i < index; i++) {
        if (strcmp(names[i], out->name) == 0)
            fail(path, 0, "gives the same name as %s: %s", work->inputs[i], out->name);
    }
    memcpy(names[index], out->name, sizeof out->name);
    for (size_t i = 0; i < work->define_count && !out->is_snippet; i++) {
        const char *equals = strchr(work->defines[i], '=');
        append(&out->body, "#define ", 8);
        append(&out->body, work->defines[i], (size_t)(equals - work->defines[i]));
        append(&out->body, " ", 1);
        append(&out->body, equals + 1, strlen(equals + 1));
        append(&out->body, "\n", 1);
    }
    flatten(out, path, path, 0);
    if (!out->version[0] && !out->is_snippet) fail(path, 1, "no #version line");
    if (!out->body.bytes) append(&out->body, "\n", 1); /* C has no empty arrays */
    if (out->is_snippet)
        write_snippet(work, out);
    else
        write_source(work, out);
    note_prerequisites(work, out);
    for (size_t i = 0; i < out->file_count; i++) free(out->files[i]);
    free(out->body.data);
    free(out);
}

static void write_preamble(job *work)
{
    char *out_h = header_path(work->out_c);
    const char *slash = strrchr(out_h, '/');
    const char *base = slash ? slash + 1 : out_h;
    char guard[128];
    int length = snprintf(guard, sizeof guard, "NOH_%s", base);
    if (length < 0 || (size_t)length >= sizeof guard) fail(out_h, 0, "the file's name is too long");
    for (char *p = guard; *p; p++) *p = isalnum((unsigned char)*p) ? (char)toupper((unsigned char)*p) : '_';
    appendf(&work->h, "/* Made by tools/embed. Do not edit. */\n#ifndef %s\n#define %s\n\n", guard, guard);
    appendf(&work->h, "#include \"noh/low_gl.h\"\n\n");
    appendf(&work->c, "/* Made by tools/embed. Do not edit. */\n#include \"%s\"\n", base);
    free(out_h);
}

int main(int argument_count, char **arguments)
{
    static job work;
    static char names[INPUTS_MAX][128];
    parse(&work, argument_count, arguments);
    write_preamble(&work);
    for (size_t i = 0; i < work.input_count; i++) embed_file(&work, work.inputs[i], names, i);
    append(&work.h, "\n#endif\n", 8);
    write_outputs(&work);
    free(work.c.data);
    free(work.h.data);
    free(work.prerequisites.data);
    return 0;
}
