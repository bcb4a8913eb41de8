/* help_man.c: the man page, in the man macros of troff (man(7)). */
#include <stdio.h>
#include <string.h>

#include "noh/base.h"
#include "help.h"
#include "cli/verbs.h"

/* Backslashes and hyphens are special to troff, dots and quotes at the start of a line. */
static void put_escaped(FILE *out, const char *text, int length)
{
    for (int i = 0; i < length; i++) {
        if (i == 0 && (text[i] == '.' || text[i] == '\'')) {
            fputs("\\&", out);
        }
        if (text[i] == '\\') {
            fputs("\\e", out);
        } else if (text[i] == '-') {
            fputs("\\-", out);
        } else {
            fputc(text[i], out);
        }
    }
}

static void put(FILE *out, const char *text)
{
    put_escaped(out, text, (int)strlen(text));
}

static void put_lines(FILE *out, const char *text, const char *before)
{
    while (*text) {
        const int length = (int)strcspn(text, "\n");
        fputs(before, out);
        put_escaped(out, text, length);
        fputc('\n', out);
        text += length + (text[length] == '\n');
    }
}

static void man_option(FILE *out, const option *o)
{
    fputs(".TP\n\\fB", out);
    put(out, o->name);
    fputs("\\fR", out);
    if (o->value) {
        fputs(" \\fI", out);
        put(out, o->value);
        fputs("\\fR", out);
    }
    fputc('\n', out);
    put(out, o->what);
    if (o->initial) {
        fputs("\n(default ", out);
        put(out, o->initial);
        fputc(')', out);
    }
    if (o->example) {
        fputs("\n.br\nExample: ", out);
        put(out, o->name);
        fputc(' ', out);
        put(out, o->example);
    }
    fputc('\n', out);
}

static void man_verb(FILE *out, const verb *v)
{
    fprintf(out, ".SS noh %s \\fI", v->name);
    put(out, v->files);
    fputs("\\fR\n", out);
    put(out, v->what);
    fputs(".\n", out);
    for (int i = 0; i < v->option_count; i++) {
        man_option(out, &v->options[i]);
    }
    if (v->more) {
        put_lines(out, v->more, ".P\n");
    }
    fputs(".P\nExamples:\n.P\n.nf\n", out);
    for (const char *at = v->example; *at;) {
        const int length = (int)strcspn(at, "\n");
        fprintf(out, "    noh %s ", v->name);
        put_escaped(out, at, length);
        fputc('\n', out);
        at += length + (at[length] == '\n');
    }
    fputs(".fi\n", out);
}

static void man_formats(FILE *out)
{
    for (int i = 0; help_formats_text[i]; i++) {
        const char *text = help_formats_text[i];
        if (text[0] == '#') {
            fputs(".SS ", out);
            put(out, text + 2);
            fputc('\n', out);
        } else if (text[0] == ' ') {
            fputs(".nf\n", out);
            put(out, text);
            fputs("\n.fi\n", out);
        } else {
            fputs(".P\n", out);
            put(out, text);
            fputc('\n', out);
        }
    }
}

void help_man(FILE *out)
{
    fputs(".TH NOH 1 \"\" \"noh " NOH_VERSION "\"\n.SH NAME\nnoh \\- characters in fixed memory\n"
          ".SH SYNOPSIS\n\\fBnoh\\fR \\fIVERB\\fR \\fIFILE\\fR... [\\fIoptions\\fR]\n"
          ".SH DESCRIPTION\nConverts models and clips to packs, and inspects, draws, verifies and measures packs.\n"
          ".SH VERBS\n",
          out);
    for (int i = 0; i < VERB_COUNT; i++) {
        man_verb(out, verb_at(i));
    }
    fputs(".SH FORMATS\n", out);
    man_formats(out);
    fputs(".SH EXIT STATUS\n.TP\n0\nsuccess\n.TP\n1\nthe input or the check failed\n.TP\n2\nthe command line is wrong\n"
          ".SH ENVIRONMENT\n.TP\nNOH_GL_DEBUG=1\nend the program at the first GL error that the driver reports\n",
          out);
}
