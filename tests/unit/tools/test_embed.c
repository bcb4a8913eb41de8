/* tools/embed, run as the build runs it, on sources made here.
 *
 * The tool is named by the environment variable NOH_EMBED, else build/embed. What
 * it writes is compiled into a small program that prints the strings back, so the
 * test reads what glShaderSource would get. The compiler is CC, else cc. */
#define _XOPEN_SOURCE 700

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char tool[4096];
static char compiler[1024];
static char folder[64] = "/tmp/noh_embed_XXXXXX";

static void write_file(const char *name, const char *content, size_t bytes)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(content, 1, bytes, file), bytes);
    assert_int_equal(fclose(file), 0);
}

static void write_text(const char *name, const char *content)
{
    write_file(name, content, strlen(content));
}

static int exists(const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}

/* Run a command in the folder; its output, both streams, goes to `output`. */
static int run(char *output, size_t room, const char *format, ...)
{
    char command[8192], whole[16384];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(command, sizeof command, format, arguments);
    va_end(arguments);
    snprintf(whole, sizeof whole, "cd %s && { %s; } 2>&1", folder, command);
    FILE *pipe = popen(whole, "r");
    assert_non_null(pipe);
    size_t length = fread(output, 1, room - 1, pipe);
    output[length] = 0;
    int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static int set_up(void **state)
{
    (void)state;
    const char *named = getenv("NOH_EMBED");
    const char *cc = getenv("CC");
    if (!realpath(named ? named : "build/embed", tool)) tool[0] = 0;
    snprintf(compiler, sizeof compiler, "%s", cc && *cc ? cc : "cc");
    return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    char output[256];
    return run(output, sizeof output, "cd / && rm -r %s", folder);
}

static void need_tool(void)
{
    char output[256];
    if (!tool[0]) {
        print_message("SKIP: build/embed is not built (NOH_EMBED may name it)\n");
        skip();
    }
    assert_int_equal(run(output, sizeof output, "rm -rf ./* && mkdir -p noh gl"), 0);
}

/* A stand-in for the real header: the tool's output needs only the struct. */
static const char program_header[] = "#ifndef PROGRAM_H\n#define PROGRAM_H\ntypedef struct noh_gl_source {\n"
                                     "const char *version; const char *const *pieces; unsigned piece_count;\n"
                                     "} noh_gl_source;\n#endif\n";

/* Embed is done: compile out.c and print one source back, pieces joined. */
static void read_back(const char *name, char *output, size_t room)
{
    char main_text[1024];
    write_text("noh/low_gl.h", program_header);
    snprintf(main_text, sizeof main_text,
             "#include <stdio.h>\n#include \"out.h\"\nint main(void) {\n"
             "fputs(%s.version, stdout);\n"
             "for (unsigned i = 0; i < %s.piece_count; i++) fputs(%s.pieces[i], stdout);\nreturn 0; }\n",
             name, name, name);
    write_text("main.c", main_text);
    const char *flags = "-std=c99 -Wall -Wextra -Wpedantic -Werror -I.";
    if (run(output, room, "%s %s -o main main.c out.c", compiler, flags) != 0) {
        print_error("%s", output);
        fail();
    }
    assert_int_equal(run(output, room, "./main"), 0);
}

/* --- what comes out --- */

static void plain_file(void **state)
{
    (void)state;
    char output[8192];
    need_tool();
    write_text("plain.vert", "// first a comment\n#version 300 es\nvoid main() {}\n");
    assert_int_equal(run(output, sizeof output, "%s -o out.c plain.vert", tool), 0);
    assert_string_equal(output, "");
    read_back("noh_shader_plain_vert", output, sizeof output);
    assert_string_equal(output, "#version 300 es\n#line 3 0\nvoid main() {}\n");
}

static void odd_bytes(void **state)
{
    (void)state;
    char output[8192];
    need_tool();
    /* Quotes, trigraphs, a backslash, UTF-8, CR LF, no newline at the end. */
    write_text("odd.frag", "#version 300 es\r\n\"q\" \?\?= \?\?/ \\ \303\2511\r\nvoid main() {}");
    assert_int_equal(run(output, sizeof output, "%s -o out.c odd.frag", tool), 0);
    read_back("noh_shader_odd_frag", output, sizeof output);
    assert_string_equal(output, "#version 300 es\n#line 2 0\n\"q\" \?\?= \?\?/ \\ \303\2511\nvoid main() {}\n");
}

static void defines_come_first(void **state)
{
    (void)state;
    char output[8192];
    need_tool();
    write_text("a.vert", "#version 300 es\nA\n");
    assert_int_equal(run(output, sizeof output, "%s -o out.c -D LAYERS=3 -D 'NAME=(1 + 2)' a.vert", tool), 0);
    read_back("noh_shader_a_vert", output, sizeof output);
    assert_string_equal(output, "#version 300 es\n#define LAYERS 3\n#define NAME (1 + 2)\n#line 2 0\nA\n");
}

static void includes_once_with_lines(void **state)
{
    (void)state;
    char output[8192];
    need_tool();
    assert_int_equal(run(output, sizeof output, "mkdir sub sub/deep"), 0);
    write_text("sub/a.vert",
               "#version 300 es\nbefore\n  # include \"deep/b.glsl\" // why\nbetween\n#include \"c.glsl\"\nafter\n");
    write_text("sub/deep/b.glsl", "b1\n#include \"e.glsl\"\nb3\n");
    write_text("sub/deep/e.glsl", "e\n");
    write_text("sub/c.glsl", "c1\n#include \"deep/e.glsl\"\nc3\n");
    assert_int_equal(run(output, sizeof output, "%s -o out.c -d out.d sub/a.vert", tool), 0);
    read_back("noh_shader_a_vert", output, sizeof output);
    assert_string_equal(output, "#version 300 es\n#line 2 0\nbefore\n"
                                "#line 1 1\nb1\n#line 1 2\ne\n#line 3 1\nb3\n#line 4 0\nbetween\n"
                                "#line 1 3\nc1\n\nc3\n#line 6 0\nafter\n");
    assert_int_equal(run(output, sizeof output, "cat out.d"), 0);
    assert_string_equal(output,
                        "out.c out.h: \\\n  sub/a.vert \\\n  sub/deep/b.glsl \\\n  sub/deep/e.glsl \\\n  sub/c.glsl\n"
                        "\nsub/a.vert:\n\nsub/deep/b.glsl:\n\nsub/deep/e.glsl:\n\nsub/c.glsl:\n");
    assert_int_equal(run(output, sizeof output, "grep -c '/\\* source . : *' out.c; grep '/\\* source' out.c"), 0);
    assert_non_null(strstr(output, "/* source 3: sub/c.glsl */"));
}

static void each_file_includes_for_itself(void **state)
{
    (void)state;
    char output[8192];
    need_tool();
    write_text("a.vert", "#version 300 es\n#include \"c.glsl\"\n");
    write_text("a.frag", "#version 310 es\n#include \"c.glsl\"\n");
    write_text("c.glsl", "common\n");
    assert_int_equal(run(output, sizeof output, "%s -o out.c a.vert a.frag", tool), 0);
    read_back("noh_shader_a_vert", output, sizeof output);
    assert_string_equal(output, "#version 300 es\n#line 1 1\ncommon\n");
    read_back("noh_shader_a_frag", output, sizeof output);
    assert_string_equal(output, "#version 310 es\n#line 1 1\ncommon\n");
}

static void comments_hide_directives(void **state)
{
    (void)state;
    char output[8192];
    need_tool();
    write_text("a.vert", "/*\n#version 100\n#include \"no.glsl\"\n*/\n#version 300 es\n// #include \"no.glsl\"\n");
    assert_int_equal(run(output, sizeof output, "%s -o out.c a.vert", tool), 0);
    read_back("noh_shader_a_vert", output, sizeof output);
    assert_string_equal(output, "#version 300 es\n\n");
}

/* Comments, indents and blanks go; the lines keep their numbers. */
static void comments_and_indents_go(void **state)
{
    (void)state;
    char output[8192];
    need_tool();
    write_text(
        "a.vert",
        "#version 300 es\n/* about\n   this */\n  #define  F(x)\t(x) /* one */ + 1 // two\n\n\n\tint  a =/*b*/3; /* c\n"
        "*/ int b; /**/ int c;//\n\n\n\n\n\n\n\n\n\n\n\n\nlast / 2 /* 3\n // */ * 4\n");
    assert_int_equal(run(output, sizeof output, "%s -o out.c a.vert", tool), 0);
    assert_string_equal(output, "");
    read_back("noh_shader_a_vert", output, sizeof output);
    assert_string_equal(output, "#version 300 es\n#line 4 0\n#define F(x) (x) + 1\n\n\nint a = 3;\nint b; int c;\n"
                                "#line 21 0\nlast / 2\n* 4\n");
    write_text("b.vert", "#version 300 es\n#define A /* one\ntwo */ 1\n");
    assert_int_equal(run(output, sizeof output, "%s -o out.c b.vert", tool), 1);
    assert_string_equal(output, "embed: b.vert:2: a comment in a directive does not end in its line\n");
}

/* A .glsl file alone: an array of characters without #version and #line. */
static void snippets(void **state)
{
    (void)state;
    char output[8192];
    need_tool();
    write_text("piece.glsl", "/* about */\nint a;\n\n  /* b */\n\n\n\n\n\n\n\n\n\nint f() { return 1; }\n");
    write_text("noh/low_gl.h", program_header);
    write_text(
        "main.c",
        "#include <stdio.h>\n#include \"out.h\"\nint main(void) { fputs(noh_shader_piece_glsl, stdout); return 0; }\n");
    assert_int_equal(run(output, sizeof output, "%s -o out.c -D A=1 piece.glsl", tool), 0);
    assert_int_equal(run(output, sizeof output,
                         "%s -std=c99 -Wall -Wextra -Wpedantic -Werror -I. -o main main.c out.c && ./main", compiler),
                     0);
    assert_string_equal(output, "int a;\nint f() { return 1; }\n");
    write_text("bad.glsl", "int a;\n#include \"piece.glsl\"\n");
    assert_int_equal(run(output, sizeof output, "%s -o out.c bad.glsl", tool), 1);
    assert_string_equal(output, "embed: bad.glsl:2: a .glsl file includes nothing when it is embedded by itself\n");
}

/* Sources longer than a C99 literal come in pieces that join to the same text. */
static void long_sources(void **state)
{
    (void)state;
    static char source[70000], output[80000], want[80000];
    need_tool();
    size_t length = (size_t)snprintf(source, sizeof source, "#version 300 es\n");
    for (unsigned i = 0; length < 60000; i++) {
        /* Now and then a line that alone is longer than a piece. */
        if (i % 300 == 299) {
            memset(source + length, 'x', 9001);
            source[length + 9001] = '\n';
            length += 9002;
        } else {
            length += (size_t)snprintf(source + length, sizeof source - length, "line %u \"?\"\n", i);
        }
    }
    write_file("long.vert", source, length);
    assert_int_equal(run(output, sizeof output, "%s -o out.c long.vert", tool), 0);
    read_back("noh_shader_long_vert", output, sizeof output);
    snprintf(want, sizeof want, "#version 300 es\n#line 2 0\n%.*s", (int)(length - 16), source + 16);
    assert_int_equal(strlen(output), strlen(want));
    assert_memory_equal(output, want, strlen(want));
}

static void same_bytes_twice(void **state)
{
    (void)state;
    char output[8192];
    need_tool();
    write_text("a.vert", "#version 300 es\nA\n");
    assert_int_equal(run(output, sizeof output, "%s -o out.c -d out.d a.vert && cat out.* | cksum > 1", tool), 0);
    assert_int_equal(run(output, sizeof output, "%s -o out.c -d out.d a.vert && cat out.* | cksum > 2", tool), 0);
    assert_int_equal(run(output, sizeof output, "cmp 1 2"), 0);
}

/* --- what is refused --- */

/* The tool must stop with this message and exit code and write nothing. */
static void expect_refusal(const char *arguments, int code, const char *message)
{
    char output[8192];
    write_text("out.c", "old");
    int got = run(output, sizeof output, "%s -o out.c -d out.d %s", tool, arguments);
    if (got != code || strncmp(output, message, strlen(message)) != 0) {
        print_error("exit %d, not %d; said: %s  not: %s\n", got, code, output, message);
        fail();
    }
    assert_int_equal(run(output, sizeof output, "cat out.c; ls *tmp* out.h out.d 2>/dev/null"), 2);
    assert_string_equal(output, "old");
}

static void refused_sources(void **state)
{
    (void)state;
    need_tool();
    write_text("none.vert", "void main() {}\n");
    write_text("late.vert", "void main() {}\n#version 300 es\n");
    write_text("two.vert", "#version 300 es\n#version 300 es\n");
    write_text("early.vert", "#include \"version.glsl\"\n#version 300 es\n");
    write_text("version.glsl", "#version 300 es\n");
    write_text("inner.vert", "#version 300 es\n\n#include \"version.glsl\"\n");
    write_text("self.vert", "#version 300 es\n#include \"loop1.glsl\"\n");
    write_text("loop1.glsl", "\n\n#include \"loop2.glsl\"\n");
    write_text("loop2.glsl", "\n#include \"loop1.glsl\"\n");
    write_text("lost.vert", "#version 300 es\n\n\n#include \"lost.glsl\"\n");
    write_text("angle.vert", "#version 300 es\n#include <a.glsl>\n");
    write_text("open.vert", "#version 300 es\n#include \"a.glsl\n");
    write_text("junk.vert", "#version 300 es\n#include \"version.glsl\" junk\n");
    write_text("comment.vert", "#version 300 es\n/* never\nclosed\n");
    write_file("zero.vert", "#version 300 es\n\0\n", 18);
    write_text("empty.vert", "");
    expect_refusal("none.vert", 1, "embed: none.vert:1: no #version line\n");
    expect_refusal("empty.vert", 1, "embed: empty.vert:1: no #version line\n");
    expect_refusal("late.vert", 1, "embed: late.vert:2: #version must come first\n");
    expect_refusal("two.vert", 1, "embed: two.vert:2: a second #version\n");
    expect_refusal("early.vert", 1, "embed: early.vert:1: #include before #version\n");
    expect_refusal("inner.vert", 1, "embed: version.glsl:1: #version in an included file\n");
    expect_refusal("self.vert", 1, "embed: loop2.glsl:2: loop1.glsl includes itself\n");
    expect_refusal("lost.vert", 1, "embed: lost.vert:4: cannot open lost.glsl: ");
    expect_refusal("angle.vert", 1, "embed: angle.vert:2: expected #include \"file\"\n");
    expect_refusal("open.vert", 1, "embed: open.vert:2: expected #include \"file\"\n");
    expect_refusal("junk.vert", 1, "embed: junk.vert:2: unexpected text after #include \"file\"\n");
    expect_refusal("comment.vert", 1, "embed: comment.vert:2: this comment is not closed\n");
    expect_refusal("zero.vert", 1, "embed: zero.vert: has a zero byte");
    expect_refusal("absent.vert", 1, "embed: absent.vert: cannot open absent.vert: ");
    expect_refusal("gl", 1, "embed: gl: cannot read: ");
}

static void refused_names_and_depths(void **state)
{
    (void)state;
    char name[32], text[64], output[256];
    need_tool();
    assert_int_equal(run(output, sizeof output, "mkdir other"), 0);
    write_text("a.vert", "#version 300 es\n");
    write_text("other/a.vert", "#version 300 es\n");
    expect_refusal("a.vert other/a.vert", 1, "embed: other/a.vert: gives the same name as a.vert: noh_shader_a_vert\n");
    write_text("deep.vert", "#version 300 es\n#include \"d0.glsl\"\n");
    for (int i = 0; i < 20; i++) {
        snprintf(name, sizeof name, "d%d.glsl", i);
        snprintf(text, sizeof text, "#include \"d%d.glsl\"\n", i + 1);
        write_text(name, text);
    }
    expect_refusal("deep.vert", 1, "embed: d14.glsl:1: #include nests deeper than 16\n");
}

static void refused_usage(void **state)
{
    (void)state;
    char output[8192];
    need_tool();
    write_text("a.vert", "#version 300 es\n");
    expect_refusal("", 2, "embed: no files\n");
    expect_refusal("-x a.vert", 2, "embed: unknown flag\n");
    expect_refusal("a.vert -D", 2, "embed: a flag lacks its value\n");
    expect_refusal("a.vert -D 3=4", 2, "embed: -D needs NAME=VALUE\n");
    expect_refusal("a.vert -D NAME", 2, "embed: -D needs NAME=VALUE\n");
    expect_refusal("a.vert -D NAME=", 2, "embed: -D needs NAME=VALUE\n");
    assert_int_equal(run(output, sizeof output, "%s a.vert", tool), 2);
    assert_int_equal(run(output, sizeof output, "%s -o out.h a.vert", tool), 2);
    assert_int_equal(run(output, sizeof output, "%s -o none/out.c a.vert", tool), 1);
    assert_false(exists("none"));
}

int main(int argument_count, char **arguments)
{
    if (argument_count == 2) cmocka_set_test_filter(arguments[1]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_file),
        cmocka_unit_test(odd_bytes),
        cmocka_unit_test(defines_come_first),
        cmocka_unit_test(includes_once_with_lines),
        cmocka_unit_test(each_file_includes_for_itself),
        cmocka_unit_test(comments_hide_directives),
        cmocka_unit_test(comments_and_indents_go),
        cmocka_unit_test(snippets),
        cmocka_unit_test(long_sources),
        cmocka_unit_test(same_bytes_twice),
        cmocka_unit_test(refused_sources),
        cmocka_unit_test(refused_names_and_depths),
        cmocka_unit_test(refused_usage),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
