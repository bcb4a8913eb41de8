/* help.h: the tables of the verbs as help, as a man page and as completion for bash. */
#ifndef NOH_NOH_HELP_HELP_H
#define NOH_NOH_HELP_HELP_H

#include <stdio.h>

#include "cli/args.h"

/* All verbs, one line each. */
void help_print(FILE *out);
/* The verbs of `noh lab`, one line each. */
void help_lab(FILE *out);
/* `noh help VERB`, `noh VERB --help`. */
void help_verb(FILE *out, const verb *v);
/* `noh help FORMATS`: the formats of files and options. */
void help_formats(FILE *out);
extern const char *const help_formats_text[]; /* paragraphs; "# TITLE" begins a section; ends with NULL */
/* `noh help --man`: noh.1. */
void help_man(FILE *out);
/* `noh help --bash`: a script that bash sources. */
void help_bash(FILE *out);

/* `noh help ...`. Returns an exit code. */
int help_run(int argc, char **argv);

#endif
