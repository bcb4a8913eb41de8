/* lit_source_internal.h (private to stage_gl/): fragment shaders of what is drawn beside the stage by its light. */
#ifndef NOH_STAGE_GL_LIT_SOURCE_INTERNAL_H
#define NOH_STAGE_GL_LIT_SOURCE_INTERNAL_H

#include "gl/device/gl_program.h"
#include "gl/device/gl_shader_text.h"

#define NOH_LIT_PIECES_MAX 8u

/* A shader behind the functions of the light: the pieces that `source` points to. */
typedef struct noh_lit_source {
    const char *pieces[NOH_LIT_PIECES_MAX];
    noh_gl_source source;
} noh_lit_source;

static inline void noh_lit_source_of(const noh_gl_source *fragment, noh_lit_source *out)
{
    const char *const first[4] = { "precision highp float;\n#define NOH_LIT\n", noh_gl_shader_text("common_fade.glsl"),
                                   noh_gl_shader_text("common_fragment.glsl"),
                                   noh_gl_shader_text("common_environment.glsl") };
    NOH_ASSERT(4u + fragment->piece_count <= NOH_LIT_PIECES_MAX);
    for (uint32_t i = 0; i < 4u; i++) out->pieces[i] = first[i];
    for (uint32_t i = 0; i < fragment->piece_count; i++) out->pieces[4u + i] = fragment->pieces[i];
    out->source = *fragment;
    out->source.piece_count += 4u;
    out->source.pieces = out->pieces;
}

#endif
