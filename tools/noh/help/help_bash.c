/* help_bash.c: completion for bash: verbs, their options, the words that options take, else files. */
#include <stdio.h>
#include <string.h>

#include "help.h"
#include "cli/verbs.h"

/* The words to choose from: all of "auto|f32|f16", those in lower case of "face|body|AZ,EL[,DIST]". */
static void put_words(FILE *out, const char *value)
{
    int first = 1;
    while (*value) {
        const int length = (int)strcspn(value, "|");
        if (value[0] >= 'a' && value[0] <= 'z') {
            fprintf(out, "%s%.*s", first ? "" : " ", length, value);
            first = 0;
        }
        value += length + (value[length] == '|');
    }
}

static void bash_option(FILE *out, const verb *v, const option *o)
{
    if (o->kind == OPTION_FLAG || o->kind == OPTION_INPUT || o->kind == OPTION_INPUTS || o->kind == OPTION_OUTPUT) {
        return; /* no value, or a file name: bash's default */
    }
    fprintf(out, "    '%s %s') words='", v->name, o->name);
    put_words(out, o->value);
    fputs("' files= ;;\n", out);
}

static void bash_verb(FILE *out, const verb *v)
{
    fprintf(out, "    '%s') words='", v->name);
    for (int i = 0; i < v->option_count; i++) {
        fprintf(out, "%s ", v->options[i].name);
    }
    fputs("--help' ;;\n", out);
}

static void put_verbs(FILE *out, int lab)
{
    for (int i = 0; i < VERB_COUNT; i++) {
        const verb *v = verb_at(i);
        if (verb_is_lab(v) == lab) fprintf(out, "%s ", v->name + (lab ? strlen(LAB_PREFIX) : 0));
    }
}

void help_bash(FILE *out)
{
    fputs("# noh.bash: completion of noh for bash. Made by `noh help --bash`.\n"
          "_noh() {\n"
          "    local verb=${COMP_WORDS[1]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
          "    local words= files=1 verbs='",
          out);
    put_verbs(out, 0);
    fputs("lab' lab='", out);
    put_verbs(out, 1);
    fputs("'\n    COMPREPLY=()\n"
          "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
          "        COMPREPLY=($(compgen -W \"$verbs help --version\" -- \"$word\"))\n"
          "        return\n    fi\n"
          "    [ \"$verb\" != lab ] || [ \"$COMP_CWORD\" = 2 ] || verb=\"lab ${COMP_WORDS[2]}\"\n"
          "    case $verb in\n    help) words=\"$verbs FORMATS\" files= ;;\n"
          "    lab) words=\"$lab --help\" files= ;;\n",
          out);
    for (int i = 0; i < VERB_COUNT; i++) {
        bash_verb(out, verb_at(i));
    }
    fputs(
        "    esac\n    [ -z \"$files\" ] || case $word in -*) files= ;; *) words= ;; esac\n    case \"$verb $before\" in\n",
        out);
    for (int i = 0; i < VERB_COUNT; i++) {
        const verb *v = verb_at(i);
        for (int k = 0; k < v->option_count; k++) {
            bash_option(out, v, &v->options[k]);
        }
    }
    fputs("    esac\n"
          "    [ -z \"$words\" ] || COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
          "    [ -z \"$files\" ] || COMPREPLY+=($(compgen -f -- \"$word\"))\n"
          "}\n"
          "complete -o filenames -F _noh noh\n",
          out);
}
