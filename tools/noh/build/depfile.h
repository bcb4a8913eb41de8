/* depfile.h: what was read for an output, as a rule for Make and Ninja. */
#ifndef NOH_NOH_BUILD_DEPFILE_H
#define NOH_NOH_BUILD_DEPFILE_H

#include "convert/base/input_file.h"

/* Write the rule OUTPUT: INPUT..., and an empty rule for each input, so that Make goes on after one was removed.
 * Returns an exit code. */
int depfile_write(const char *path, const char *output, const input_list *inputs);

#endif
