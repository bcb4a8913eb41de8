/* analyzer.h: included before every file that gcc -fanalyzer reads, which sees one file at a time: what a failure
 * returns is the result that it was given. */
#ifndef NOH_LINT_ANALYZER_H
#define NOH_LINT_ANALYZER_H

#include "noh/base.h"

#define noh_fail(error, result, what, where, need) ((void)(error), (void)(where), (void)(need), (result))

#endif
