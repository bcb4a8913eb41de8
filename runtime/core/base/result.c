#include "noh/base.h"

const char *noh_result_text(noh_result result)
{
    switch (result) {
    case NOH_OK: return "ok";
    case NOH_ERR_ARG: return "argument out of range";
    case NOH_ERR_MEMORY: return "too little memory";
    case NOH_ERR_DATA: return "broken data";
    case NOH_ERR_VERSION: return "another format version";
    case NOH_ERR_LIMIT: return "over a limit";
    case NOH_ERR_NOT_FOUND: return "not found";
    case NOH_ERR_UNSUPPORTED: return "not supported here";
    case NOH_ERR_GL: return "refused by the graphics driver";
    }
    return "unknown result";
}

noh_result noh_fail(noh_error *error, noh_result result, const char *what, uint64_t where, uint64_t need)
{
    if (error) {
        error->result = result;
        error->what = what;
        error->where = where;
        error->need = need;
    }
    return result;
}
