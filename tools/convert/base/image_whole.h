/* image_whole.h: whether a PNG or JPEG file goes on to its end. Decoders fill up what is missing with grey, or tell of
 * damage and not where. */
#ifndef NOH_CONVERT_BASE_IMAGE_WHOLE_H
#define NOH_CONVERT_BASE_IMAGE_WHOLE_H

#include <stddef.h>

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

#define IMAGE_NO_END 2
#define IMAGE_END "\xff\xd9" /* of a JPEG */

/* Follow the chunks of a PNG, or the segments of a JPEG, to the last. Returns 0, or 1 and *error, which says what is
 * missing and at which byte; IMAGE_NO_END and *error for a JPEG that ends in pixels: decoders read it if IMAGE_END is
 * appended, and fill up what is missing. Bytes between a JPEG's first segment and its frame that belong to none are
 * skipped, as decoders do.
 * source  PNG (W3C, third edition), 5.3; ITU-T T.81, B.1.1 */
int image_is_cut(const unsigned char *bytes, size_t count, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
