/* gl_debug.c: labels and groups of KHR_debug. */
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "gl/device/gl_names_internal.h"
#include "gl/device/gl_debug_internal.h"

#define GROUP_ID 0x6e6f68u /* "noh": distinguishes the library's groups from the application's */

static void join(char text[NOH_GL_LABEL_BYTES], const char *what, const char *of)
{
    uint32_t length = 0;
    while (*what && length + 1 < NOH_GL_LABEL_BYTES) text[length++] = *what++;
    if (of && *of && length + 1 < NOH_GL_LABEL_BYTES) text[length++] = ' ';
    while (of && *of && length + 1 < NOH_GL_LABEL_BYTES) text[length++] = *of++;
    text[length] = 0;
}

void noh_gl_label(const noh_gl_api *api, GLenum kind, GLuint name, const char *what, const char *of)
{
    char text[NOH_GL_LABEL_BYTES];
    NOH_ASSERT(api && what);
    if (!api->ObjectLabel) return;
    join(text, what, of);
    api->ObjectLabel(kind, name, -1, text);
}

void noh_gl_group_begin(const noh_gl_api *api, const char *what, const char *of)
{
    char text[NOH_GL_LABEL_BYTES];
    NOH_ASSERT(api && what);
    if (!api->PushDebugGroup || !api->PopDebugGroup) return;
    join(text, what, of);
    api->PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, GROUP_ID, -1, text);
}

void noh_gl_group_end(const noh_gl_api *api)
{
    if (api->PushDebugGroup && api->PopDebugGroup) api->PopDebugGroup();
}
