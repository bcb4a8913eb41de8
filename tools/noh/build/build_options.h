/* build_options.h: what `noh build` makes of its arguments, for other verbs that build. */
#ifndef NOH_NOH_BUILD_BUILD_OPTIONS_H
#define NOH_NOH_BUILD_BUILD_OPTIONS_H

#include "convert/convert.h"

/* The options of a command line of `noh build`, without report and progress: argv is what follows the verb. Not in the
 * verb itself. Returns an exit code. */
int build_options_read(int argc, char **argv, convert_options *o);
/* The models and clips among these arguments. */
const char *const *build_inputs(int *count);
/* Print the failure; returns an exit code. */
int build_fail(const convert_failure *f);

#endif
