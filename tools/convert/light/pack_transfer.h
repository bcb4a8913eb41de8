/* pack_transfer.h: a pack with the transfers of its meshes, made from the finished pack. */
#ifndef NOH_CONVERT_LIGHT_PACK_TRANSFER_H
#define NOH_CONVERT_LIGHT_PACK_TRANSFER_H

#include "convert/base/byte_buffer.h"
#include "transfer_make.h"
#include "noh/pack.h"

/* Copy a pack that has no transfers, with one for each mesh after the last mesh. Every other chunk stays as it is. 0,
 * or 1 and a filled error. */
int pack_transfer(const noh_pack *pack, const transfer_settings *settings, byte_buffer *out, model_error *error);

#endif
