/* gl_program.c: compiling and linking. Pending GL errors are cleared first and read last, so that no refused call goes
 * unnoticed. */
#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"

#include "gl/device/gl_names_internal.h"
#include "gl/device/gl_debug_internal.h"

#include <string.h>

enum { STAGE_VERTEX, STAGE_GEOMETRY, STAGE_FRAGMENT, STAGE_COUNT };

/* An append-only log, always zero-terminated. */
typedef struct log_text {
    char *text;
    size_t room, length;
} log_text;

static void log_append(log_text *log, const char *text)
{
    if (!log->room) return;
    while (*text && log->length + 1 < log->room) log->text[log->length++] = *text++;
    log->text[log->length] = 0;
}

static void log_head(log_text *log, const char *name, const char *stage)
{
    if (name) {
        log_append(log, name);
        log_append(log, ": ");
    }
    log_append(log, stage);
    log_append(log, ": ");
}

/* Bytes that the driver may write, terminating zero included. */
static GLsizei log_rest(const log_text *log)
{
    size_t rest = log->room - log->length;
    return rest > 1u << 20 ? 1 << 20 : (GLsizei)rest;
}

static const char *check_source(const noh_gl_source *source)
{
    if (!source->version || !source->pieces) return "a shader stage has no text";
    if (source->piece_count == 0 || source->piece_count > NOH_GL_PIECES_MAX)
        return "piece_count of a shader stage must be 1 to NOH_GL_PIECES_MAX";
    return NULL;
}

static const char *check_desc(const noh_gl_program_desc *desc)
{
    if (!desc->vertex) return "the program desc has no vertex stage";
    if (!desc->fragment) return "the program desc has no fragment stage";
    const char *what = check_source(desc->vertex);
    if (!what) what = check_source(desc->fragment);
    if (!what && desc->geometry) what = check_source(desc->geometry);
    return what;
}

static noh_result compile(const noh_gl_api *api, const noh_gl_program_desc *desc, int stage, GLuint *out, log_text *log,
                          noh_error *error)
{
    static const char *const failed[] = { "the vertex shader does not compile", "the geometry shader does not compile",
                                          "the fragment shader does not compile" };
    static const char *const names[] = { "vertex", "geometry", "fragment" };
    static const GLenum types[] = { GL_VERTEX_SHADER, GL_GEOMETRY_SHADER, GL_FRAGMENT_SHADER };
    const noh_gl_source *source = stage == STAGE_GEOMETRY            ? desc->geometry
                                  : types[stage] == GL_VERTEX_SHADER ? desc->vertex
                                                                     : desc->fragment;
    const GLchar *strings[NOH_GL_PIECES_MAX + 3];
    GLsizei count = 0;
    strings[count++] = desc->version ? desc->version : source->version;
    if (desc->defines) strings[count++] = desc->defines;
    if (desc->geometry_defines && stage == STAGE_GEOMETRY) strings[count++] = desc->geometry_defines;
    for (uint32_t i = 0; i < source->piece_count; i++) strings[count++] = source->pieces[i];

    GLuint shader = api->CreateShader(types[stage]);
    if (!shader) return noh_fail(error, NOH_ERR_GL, "the driver returned no name for a shader", 0, 0);
    api->ShaderSource(shader, count, strings, NULL);
    api->CompileShader(shader);
    GLint compiled = GL_FALSE;
    api->GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) {
        log_head(log, desc->name, names[stage]);
        if (log->room) api->GetShaderInfoLog(shader, log_rest(log), NULL, log->text + log->length);
        api->DeleteShader(shader);
        return noh_fail(error, NOH_ERR_DATA, failed[stage], types[stage], 0);
    }
    *out = shader;
    return NOH_OK;
}

static noh_result link_program(const noh_gl_api *api, const noh_gl_program_desc *desc, GLuint program, log_text *log,
                               noh_error *error)
{
    if (desc->varying_count) {
        api->TransformFeedbackVaryings(program, (GLsizei)desc->varying_count, desc->varyings, GL_INTERLEAVED_ATTRIBS);
    }
    api->LinkProgram(program);
    GLint linked = GL_FALSE;
    api->GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked) return NOH_OK;
    log_head(log, desc->name, "link");
    if (log->room) api->GetProgramInfoLog(program, log_rest(log), NULL, log->text + log->length);
    return noh_fail(error, NOH_ERR_DATA, "the program does not link", 0, 0);
}

/* ---- inputs ---- */

typedef struct input_kind {
    GLenum scalar;
    uint32_t components;
} input_kind;

/* Meshes have no matrix attributes: a matrix has no kind. */
static input_kind kind_of(GLenum type)
{
    static const GLenum types[3][4] = {
        { GL_FLOAT, GL_FLOAT_VEC2, GL_FLOAT_VEC3, GL_FLOAT_VEC4 },
        { GL_INT, GL_INT_VEC2, GL_INT_VEC3, GL_INT_VEC4 },
        { GL_UNSIGNED_INT, GL_UNSIGNED_INT_VEC2, GL_UNSIGNED_INT_VEC3, GL_UNSIGNED_INT_VEC4 },
    };
    for (uint32_t scalar = 0; scalar < 3; scalar++) {
        for (uint32_t i = 0; i < 4; i++) {
            if (types[scalar][i] == type) return (input_kind){ types[scalar][0], i + 1u };
        }
    }
    return (input_kind){ 0, 0 };
}

/* The error message of an input; NULL: none. */
static const char *check_input(const noh_gl_program_desc *desc, GLuint location, GLenum type)
{
    const input_kind wants = kind_of(type);
    for (uint32_t i = 0; i < desc->input_count; i++) {
        const input_kind has = kind_of(desc->inputs[i].type);
        if (desc->inputs[i].location != location) continue;
        if (wants.scalar != has.scalar)
            return "a vertex shader reads an attribute of another kind (float, integer or unsigned)";
        if (wants.components > has.components && wants.scalar != GL_FLOAT)
            return "a vertex shader reads more components than the attribute has";
        return NULL;
    }
    return "a vertex shader reads an attribute that is not in the desc's inputs";
}

static noh_result check_inputs(const noh_gl_api *api, const noh_gl_program_desc *desc, GLuint program, log_text *log,
                               noh_error *error)
{
    GLint count = 0;
    if (!desc->input_count) return NOH_OK;
    api->GetProgramiv(program, GL_ACTIVE_ATTRIBUTES, &count);
    for (GLint i = 0; i < count; i++) {
        GLchar name[NOH_NAME_BYTES_MAX] = "";
        GLint size = 0, location;
        GLenum type = 0;
        api->GetActiveAttrib(program, (GLuint)i, (GLsizei)sizeof name, NULL, &size, &type, name);
        location = api->GetAttribLocation(program, name);
        const char *wrong = location < 0 ? NULL : check_input(desc, (GLuint)location, type); /* < 0: gl_VertexID */
        if (!wrong) continue;
        log_head(log, desc->name, "vertex");
        log_append(log, name);
        log_append(log, ": ");
        log_append(log, wrong);
        return noh_fail(error, NOH_ERR_DATA, wrong, (uint64_t)location, 0);
    }
    return NOH_OK;
}

/* ---- stages ---- */

/* Compile and attach every stage. The shaders are marked for deletion at once, so they live exactly as long as the
 * program. */
static noh_result attach_stages(const noh_gl_api *api, const noh_gl_program_desc *desc, GLuint program, log_text *log,
                                noh_error *error)
{
    for (int stage = 0; stage < STAGE_COUNT; stage++) {
        if (stage == STAGE_GEOMETRY && !desc->geometry) continue;
        GLuint shader = 0;
        noh_result result = compile(api, desc, stage, &shader, log, error);
        if (result != NOH_OK) return result;
        api->AttachShader(program, shader);
        api->DeleteShader(shader);
    }
    return NOH_OK;
}

static void bind_names(const noh_gl_api *api, const noh_gl_program_desc *desc, GLuint program)
{
    api->UseProgram(program);
    for (uint32_t i = 0; i < desc->sampler_count; i++) {
        GLint location = api->GetUniformLocation(program, desc->samplers[i]);
        if (location >= 0) api->Uniform1i(location, (GLint)i);
    }
    for (uint32_t i = 0; i < desc->block_count; i++) {
        GLuint block = api->GetUniformBlockIndex(program, desc->blocks[i]);
        if (block != GL_INVALID_INDEX) api->UniformBlockBinding(program, block, i);
    }
    api->UseProgram(0);
    if (desc->name) noh_gl_label(api, GL_PROGRAM, program, "program", desc->name);
}

noh_result noh_gl_program_create(const noh_gl_api *api, const noh_gl_program_desc *desc, GLuint *program, char *log,
                                 size_t log_bytes, noh_error *error)
{
    NOH_ASSERT(api && desc && program);
    log_text words = { log, log ? log_bytes : 0, 0 };
    if (words.room) log[0] = 0;
    const char *wrong = check_desc(desc);
    if (wrong) return noh_fail(error, NOH_ERR_ARG, wrong, 0, 0);
    noh_gl_error_take(api);
    GLuint name = api->CreateProgram();
    noh_result result = noh_gl_error_check(api, "the driver refused a program", 0, error);
    if (result == NOH_OK && !name)
        result = noh_fail(error, NOH_ERR_GL, "the driver returned no name for a program", 0, 0);
    if (result != NOH_OK) {
        if (name) api->DeleteProgram(name);
        return result;
    }
    result = attach_stages(api, desc, name, &words, error);
    if (result == NOH_OK) result = link_program(api, desc, name, &words, error);
    if (result == NOH_OK) result = check_inputs(api, desc, name, &words, error);
    if (result == NOH_OK) bind_names(api, desc, name);
    /* Report a refused call first: it may have caused the failed compile. */
    noh_result refused = noh_gl_error_check(api, "the driver refused a call while making a program", 0, error);
    if (refused != NOH_OK) result = refused;
    if (result != NOH_OK) {
        api->DeleteProgram(name);
        return result;
    }
    if (desc->ledger) desc->ledger->programs++;
    *program = name;
    return NOH_OK;
}

void noh_gl_program_delete(const noh_gl_api *api, noh_gl_ledger *ledger, GLuint *program)
{
    NOH_ASSERT(api && program);
    if (!*program) return;
    NOH_ASSERT(!ledger || ledger->programs > 0);
    api->DeleteProgram(*program);
    if (ledger) ledger->programs--;
    *program = 0;
}
