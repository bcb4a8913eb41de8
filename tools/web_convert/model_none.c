/* model_none.c: tools/noh/file/model_pack.c builds models for verbs that read packs; a page builds them before. */
#include <string.h>

#include "file/model_pack.h"

int model_pack_make(const model_pack_desc *desc, byte_buffer *pack, convert_failure *failure)
{
    memset(pack, 0, sizeof *pack);
    memset(failure, 0, sizeof *failure);
    failure->file = desc->path;
    return model_fail(&failure->error, "", "a page reads packs alone: noh build makes one of a model");
}
