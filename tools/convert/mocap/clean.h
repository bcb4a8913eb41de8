/* clean.h: recordings cleaned up as they come in (noh build --clean): gaps, jitter, roots, contacts, in this order. */
#ifndef NOH_CONVERT_MOCAP_CLEAN_H
#define NOH_CONVERT_MOCAP_CLEAN_H

#include <stdio.h>

#include "convert/clips/raw_clip.h"

/* Bits of the steps. */
enum {
    CLEAN_GAPS = 1,     /* gaps.h */
    CLEAN_JITTER = 2,   /* jitter.h */
    CLEAN_ROOT = 4,     /* contacts.h: of clips that stay on the spot */
    CLEAN_CONTACTS = 8, /* sync markers where feet come down, in clips without markers */
    CLEAN_KEYS = 16     /* callback keys there; not part of "all" */
};

/* "gaps,jitter", "all", "off". Returns 0, or 1: a word is unknown. */
int clean_parse(const char *text, unsigned *what);

/* Clean the clips of a set, each by itself. report: a line for each clip with its changes and the distance it moved;
 * warnings: a line for each clip that stays without callback keys. NULL: none. Returns 1 when out of memory. */
int clean_set(raw_set *set, unsigned what, FILE *report, FILE *warnings);

#endif
