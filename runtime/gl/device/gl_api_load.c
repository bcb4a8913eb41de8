/* gl_api_load.c: filling the table of GL functions.
 *
 * Three kinds of functions are looked up. Functions that the library calls are required; functions for renderers are
 * optional. Functions beyond ES 3.0 depend on the context: eglGetProcAddress and similar functions return a pointer
 * even for an unsupported name, so the version and the extension strings decide whether a function is available and
 * under which suffix. A local table is filled first and copied only on success. */
#include "gl/device/gl_api_internal.h"
#include "gl/device/gl_names_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"

#include <string.h>

enum {
    NOH_GL_GROUP_MAP,
    NOH_GL_GROUP_GEOMETRY,
    NOH_GL_GROUP_CLIP,
    NOH_GL_GROUP_DEBUG,
    NOH_GL_GROUP_TIMER,
    NOH_GL_GROUP_COUNT
};

#define PROC_NAME_BYTES 48

static int text_starts(const char *text, const char *start)
{
    while (*start && *text == *start) {
        text++;
        start++;
    }
    return *start == 0;
}

/* Look up the function named by the first word of `sentence`. *missing keeps the sentence of the first failure. */
static noh_gl_proc get_required(noh_gl_get_proc get, void *user, const char *sentence, const char **missing)
{
    char name[PROC_NAME_BYTES];
    size_t length = 0;
    noh_gl_proc proc;
    while (sentence[length] != ' ' && length + 1 < sizeof name) {
        name[length] = sentence[length];
        length++;
    }
    name[length] = 0;
    proc = get(user, name);
    if (!proc && !*missing) *missing = sentence;
    return proc;
}

/* Return a sentence about the first missing required function, or NULL. */
static const char *load_required(noh_gl_api *api, noh_gl_get_proc get, void *user)
{
    const char *missing = NULL;
#define NOH_GL_TAKE(field, result, parameters) \
    api->field = (result(NOH_GL_CALL *) parameters)get_required(get, user, "gl" #field " is missing", &missing);
    NOH_GL_REQUIRED(NOH_GL_TAKE)
#undef NOH_GL_TAKE
#define NOH_GL_TAKE(field, result, parameters) api->field = (result(NOH_GL_CALL *) parameters)get(user, "gl" #field);
    NOH_GL_EXTRA(NOH_GL_TAKE)
#undef NOH_GL_TAKE
    return missing;
}

static noh_result read_version(noh_gl_api *api, noh_error *error)
{
    const char *text = (const char *)api->GetString(GL_VERSION);
    if (!text)
        return noh_fail(error, NOH_ERR_GL, "no GL context is current on this thread: make one current first",
                        noh_gl_error_take(api), 0);
    GLint major = 0, minor = 0;
    api->GetIntegerv(GL_MAJOR_VERSION, &major);
    api->GetIntegerv(GL_MINOR_VERSION, &minor);
    api->is_es = text_starts(text, "OpenGL ES");
    api->version = major * 100 + minor * 10;
    /* ES 2.0 has no GL_MAJOR_VERSION: the query raises an error and the zeros stay. */
    if (noh_gl_error_take(api) != GL_NO_ERROR || api->version < 300) {
        return noh_fail(error, NOH_ERR_UNSUPPORTED, "the context is below OpenGL ES 3.0: create a newer one",
                        (uint64_t)api->version, 300);
    }
    return NOH_OK;
}

/* WebGL 2 calls itself OpenGL ES 3.0. */
static int is_webgl(const noh_gl_api *api)
{
    const char *text = (const char *)api->GetString(GL_VERSION);
    for (; text && *text; text++) {
        if (text_starts(text, "WebGL")) return 1;
    }
    return 0;
}

/* Suffix of each group's functions in this context; NULL: not available. */
static void choose_suffixes(noh_gl_api *api, const char *suffix[NOH_GL_GROUP_COUNT])
{
    memset(suffix, 0, sizeof(*suffix) * NOH_GL_GROUP_COUNT);
    api->geometry_ext = 0;
    if (!is_webgl(api)) suffix[NOH_GL_GROUP_MAP] = ""; /* WebGL cannot map buffers */
    if (api->version >= 320) {
        suffix[NOH_GL_GROUP_GEOMETRY] = "";
    } else if (api->is_es && noh_gl_has_extension(api, "GL_EXT_geometry_shader")) {
        suffix[NOH_GL_GROUP_GEOMETRY] = "EXT";
        api->geometry_ext = 1;
    } else if (api->is_es && noh_gl_has_extension(api, "GL_OES_geometry_shader")) {
        suffix[NOH_GL_GROUP_GEOMETRY] = "OES";
        api->geometry_ext = 2;
    }
    if (api->is_es ? noh_gl_has_extension(api, "GL_EXT_clip_control")
                   : api->version >= 450 || noh_gl_has_extension(api, "GL_ARB_clip_control")) {
        suffix[NOH_GL_GROUP_CLIP] = api->is_es ? "EXT" : "";
    }
    if (api->version >= (api->is_es ? 320 : 430)) {
        suffix[NOH_GL_GROUP_DEBUG] = "";
    } else if (noh_gl_has_extension(api, "GL_KHR_debug")) {
        suffix[NOH_GL_GROUP_DEBUG] = api->is_es ? "KHR" : "";
    }
    if (!api->is_es && api->version >= 330) {
        suffix[NOH_GL_GROUP_TIMER] = "";
    } else if (noh_gl_has_extension(api, "GL_EXT_disjoint_timer_query")) {
        suffix[NOH_GL_GROUP_TIMER] = "EXT";
    }
}

static int has_etc2(const noh_gl_api *api)
{
    if (is_webgl(api)) {
        return noh_gl_has_extension(api, "WEBGL_compressed_texture_etc") ||
               noh_gl_has_extension(api, "GL_WEBGL_compressed_texture_etc");
    }
    return api->is_es || api->version >= 430 || noh_gl_has_extension(api, "GL_ARB_ES3_compatibility");
}

static int has_astc(const noh_gl_api *api)
{
    if (is_webgl(api)) {
        return noh_gl_has_extension(api, "WEBGL_compressed_texture_astc") ||
               noh_gl_has_extension(api, "GL_WEBGL_compressed_texture_astc");
    }
    return (api->is_es && api->version >= 320) || noh_gl_has_extension(api, "GL_KHR_texture_compression_astc_ldr");
}

static noh_gl_proc get_suffixed(noh_gl_get_proc get, void *user, const char *name, const char *suffix)
{
    char full[PROC_NAME_BYTES];
    size_t length = 0;
    if (!suffix) return NULL;
    while (*name && length < sizeof full - 4) full[length++] = *name++;
    while (*suffix && length < sizeof full - 1) full[length++] = *suffix++;
    full[length] = 0;
    return get(user, full);
}

static void load_optional(noh_gl_api *api, noh_gl_get_proc get, void *user)
{
    const char *suffix[NOH_GL_GROUP_COUNT];
    choose_suffixes(api, suffix);
#define NOH_GL_TAKE(field, result, parameters, name, group) \
    api->field = (result(NOH_GL_CALL *) parameters)get_suffixed(get, user, name, suffix[group]);
    NOH_GL_OPTIONAL(NOH_GL_TAKE)
#undef NOH_GL_TAKE
}

noh_result noh_gl_api_load(noh_gl_api *api, noh_gl_get_proc get, void *user, noh_error *error)
{
    if (!api) return noh_fail(error, NOH_ERR_ARG, "api is NULL", 0, 0);
    if (!get) return noh_fail(error, NOH_ERR_ARG, "get is NULL: pass a lookup function", 0, 0);
    noh_gl_api table;
    memset(&table, 0, sizeof table);
    const char *missing = load_required(&table, get, user);
    if (missing) return noh_fail(error, NOH_ERR_UNSUPPORTED, missing, 0, 0);
    noh_result result = read_version(&table, error);
    if (result != NOH_OK) return result;
    load_optional(&table, get, user);
    table.etc2 = has_etc2(&table);
    table.astc = has_astc(&table);
    *api = table;
    return NOH_OK;
}
