/* fbx_none.c: convert/fbx/ unpacks arrays by zlib; a page has none. */
#include "convert/fbx/fbx_read.h"

int fbx_read(const char *path, const fbx_options *options, model **out, model_error *error)
{
    (void)path;
    (void)options;
    *out = NULL;
    return model_fail(error, "", "a page does not convert FBX: noh build does");
}
