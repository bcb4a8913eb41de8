#include "help.h"

#include <stdio.h>
#include <string.h>

#include "noh/base.h"
#include "cli/message.h"
#include "cli/verbs.h"

#define WIDTH 100 /* columns */

/* Text broken at blanks into lines indented by `indent`; the first line begins at column `at`. */
static void print_wrapped(FILE *out, const char *text, int at, int indent)
{
    while (*text) {
        const int length = (int)strcspn(text, " ");
        if (at > indent && at + 1 + length > WIDTH) {
            fprintf(out, "\n%*s", indent, "");
            at = indent;
        } else if (at > indent) {
            fputc(' ', out);
            at++;
        }
        fprintf(out, "%.*s", length, text);
        at += length;
        text += length + (text[length] == ' ');
    }
    fputc('\n', out);
}

/* "(default 512x512; example: --size 640x480)" */
static void print_facts(FILE *out, const option *o)
{
    char facts[256] = "";
    int count = 0;
    if (o->initial) {
        count += snprintf(facts, sizeof facts, "default %s", o->initial);
    }
    if (o->example) {
        snprintf(facts + count, sizeof facts - (size_t)count, "%sexample: %s %s", count ? "; " : "", o->name,
                 o->example);
    }
    if (facts[0]) {
        fprintf(out, "%24s(%s)\n", "", facts);
    }
}

static void print_option(FILE *out, const option *o)
{
    const int count = fprintf(out, "  %s%s%s", o->name, o->value ? " " : "", o->value ? o->value : "");
    if (count > 22) {
        fprintf(out, "\n%24s", "");
    } else {
        fprintf(out, "%*s", 24 - count, "");
    }
    print_wrapped(out, o->what, 24, 24);
    print_facts(out, o);
}

static void print_paragraphs(FILE *out, const char *text)
{
    while (*text) {
        char line[1024];
        const int length = (int)strcspn(text, "\n");
        snprintf(line, sizeof line, "%.*s", length, text);
        print_wrapped(out, line, 0, 0);
        text += length + (text[length] == '\n');
    }
}

void help_verb(FILE *out, const verb *v)
{
    fprintf(out, "noh %s: %s\n\nusage: noh %s %s", v->name, v->what, v->name, v->files);
    for (int i = 0; i < v->option_count; i++) {
        if (v->options[i].required) {
            fprintf(out, " %s %s", v->options[i].name, v->options[i].value);
        }
    }
    fputs(" [options]\n\noptions:\n", out);
    for (int i = 0; i < v->option_count; i++) {
        print_option(out, &v->options[i]);
    }
    fprintf(out, "  %-22s%s\n", "-h, --help", "show this help");
    if (v->more) {
        fputc('\n', out);
        print_paragraphs(out, v->more);
    }
    fputs("\nexamples:\n", out);
    for (const char *at = v->example; *at;) {
        const int length = (int)strcspn(at, "\n");
        fprintf(out, "  noh %s %.*s\n", v->name, length, at);
        at += length + (at[length] == '\n');
    }
}

static void print_verbs(FILE *out, int lab)
{
    for (int i = 0; i < VERB_COUNT; i++) {
        const verb *v = verb_at(i);
        if (verb_is_lab(v) == lab) fprintf(out, "  noh %-*s %s\n", lab ? 11 : 7, v->name, v->what);
    }
}

void help_lab(FILE *out)
{
    fputs("noh lab: measurements for the library's developers\n\n", out);
    print_verbs(out, 1);
    fputs("\nnoh lab VERB --help   options and examples of a verb (also: noh help lab VERB)\n", out);
}

void help_print(FILE *out)
{
    fputs("noh " NOH_VERSION ": characters in fixed memory\n\n", out);
    print_verbs(out, 0);
    fputs(
        "  noh lab     measurements for the library's developers (noh lab --help)\n"
        "\nnoh VERB --help     options and examples of a verb (also: noh help VERB)\n"
        "noh help FORMATS    formats of files and options\n"
        "noh help --man      the whole help as a man page; --bash: completion for bash\n"
        "noh --version\n\n"
        "PACK|MODEL: a pack, its wire form, or a model (.glb .gltf .vrm .fbx .obj, clips: .bvh .csv .trc\n"
        ".c3d .rcl). A model is built as by noh build without options, and kept for the next run (noh help\n"
        "FORMATS)\n\n"
        "exit code: 0 success, 1 the input or the check failed, 2 the command line is wrong\n",
        out);
}

void help_formats(FILE *out)
{
    for (int i = 0; help_formats_text[i]; i++) {
        const char *text = help_formats_text[i];
        if (text[0] == '#') {
            fprintf(out, "%s%s\n", i ? "\n" : "", text + 2);
        } else if (text[0] == ' ') {
            fprintf(out, "  %s\n", text);
        } else {
            fputs("  ", out);
            print_wrapped(out, text, 2, 2);
        }
    }
}

static int help_of_verb(int argc, char **argv)
{
    int count;
    const verb *v = verb_read(argc, argv, &count);
    if (!v) return EXIT_USAGE;
    if (argc > count) return tool_usage("noh help takes one verb or FORMATS: remove '%s'", argv[count]);
    help_verb(stdout, v);
    return 0;
}

int help_run(int argc, char **argv)
{
    if (argc == 0 || strcmp(argv[0], "--help") == 0 || strcmp(argv[0], "-h") == 0) {
        help_print(stdout);
        return 0;
    }
    if (argc > 1) return help_of_verb(argc, argv);
    if (strcmp(argv[0], "lab") == 0) {
        help_lab(stdout);
    } else if (strcmp(argv[0], "FORMATS") == 0 || strcmp(argv[0], "formats") == 0) {
        help_formats(stdout);
    } else if (strcmp(argv[0], "--man") == 0) {
        help_man(stdout);
    } else if (strcmp(argv[0], "--bash") == 0) {
        help_bash(stdout);
    } else {
        return help_of_verb(argc, argv);
    }
    return 0;
}
