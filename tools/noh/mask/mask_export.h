/* mask_export.h: the wrinkle regions of a pack, or those that a model would get, as a mask to paint on. */
#ifndef NOH_NOH_MASK_MASK_EXPORT_H
#define NOH_NOH_MASK_MASK_EXPORT_H

#include "convert/wrinkle/region_mask.h"

/* Whether a file is a pack or a model, and no picture. */
int mask_is_exported(const char *path);

/* The regions of the first mesh that has any. size: the side of a model's mask, 0: as noh build makes it. Prints an error and returns an exit
 * code, 0 on success; *mask is freed by the caller in all cases. */
int mask_export(const char *path, uint32_t size, region_mask *mask);

#endif
