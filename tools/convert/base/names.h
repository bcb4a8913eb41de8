/* names.h: what exporters call targets, joints and materials: one table (names_table.c), which a file of the same lines
 * extends (noh help FORMATS).
 *
 * A name is compared without case and separators, without what stands before a ':' or '|' and number endings (.001),
 * and with its side apart: eyeBlinkLeft, Eye_Blink_L, L_eyeBlink and mixamorig:leftEyeBlink are one name. */
#ifndef NOH_CONVERT_BASE_NAMES_H
#define NOH_CONVERT_BASE_NAMES_H

#include <stddef.h>
#include <stdint.h>

#include "convert/base/error.h"
#include "noh/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum name_kind { NAME_TARGET, NAME_JOINT, NAME_MATERIAL, NAME_STRIP } name_kind;

/* Use the table and the lines of a file, which come first (NULL: none), on this thread, until names_free. 0, or 1 and
 * the error. Without a call the table alone is used. */
int names_use(const char *path, model_error *error);
void names_free(void);

/* What a target or a joint of this name is: 1 and the table's own name for it, else 0. *is_own: 1 where the name is
 * that one already, but for case, separators and the way its side is written (NULL: not wanted). */
int names_find(name_kind kind, const char *name, char means[NOH_NAME_BYTES_MAX], int *is_own);

/* Whether a word, in small letters, is of a kind of material: "skin", "beside-eye". */
int names_has_word(const char *material, const char *word, size_t length);
/* Whether a name has a part of the kind, of those that the table gives as *PART. */
int names_has_part(const char *material, const char *name);

#ifdef __cplusplus
}
#endif

#endif
