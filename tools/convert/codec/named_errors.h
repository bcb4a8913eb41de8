/* named_errors.h: error bounds of single clips and joints, as given on the command line: "NAME=CM". */
#ifndef NOH_CONVERT_CODEC_NAMED_ERRORS_H
#define NOH_CONVERT_CODEC_NAMED_ERRORS_H

#include "convert/clips/raw_clip.h"

typedef struct named_errors {
    const char *const *items; /* [count] "NAME=CM" */
    uint32_t count;
} named_errors;

/* The bound given for a name, the last one if there are several; 0: none. */
double named_error(const named_errors *errors, const char *name);

/* Bounds of a skeleton's joints: [joint_count], 0 = none; to be freed. NULL if no joint is named, or when out of memory
 * (*failed). */
double *named_joint_errors(const named_errors *errors, const raw_skeleton *skeleton, int *failed);

/* Refuse an item that is not "NAME=CM" with a number above 0, or that names none of the sets' clips (or joints). 0, or
 * 1 and a filled error. */
int named_errors_check(const named_errors *clips, const named_errors *joints, raw_set *const *sets, uint32_t set_count,
                       model_error *error);

#endif
