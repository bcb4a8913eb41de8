/* gl_api.c: errors and extensions of a context. */
#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/device/gl_names_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"

GLenum noh_gl_error_take(const noh_gl_api *api)
{
    NOH_ASSERT(api && api->GetError);
    GLenum first = api->GetError();
    GLenum next = first;
    for (int i = 1; i < 16 && next != GL_NO_ERROR; i++) next = api->GetError();
    return first;
}

noh_result noh_gl_error_check(const noh_gl_api *api, const char *what, uint64_t need, noh_error *error)
{
    GLenum code = noh_gl_error_take(api);
    if (code == GL_NO_ERROR) return NOH_OK;
    return noh_fail(error, code == GL_OUT_OF_MEMORY ? NOH_ERR_MEMORY : NOH_ERR_GL, what, code, need);
}

int noh_gl_has_extension(const noh_gl_api *api, const char *name)
{
    NOH_ASSERT(api && name);
    GLint count = 0;
    api->GetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; i++) {
        const GLubyte *extension = api->GetStringi(GL_EXTENSIONS, (GLuint)i);
        if (extension && noh_names_equal((const char *)extension, name)) return 1;
    }
    return 0;
}
