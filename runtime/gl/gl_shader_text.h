/* gl_shader_text.h: the library's GLSL as text, to put into your own shaders.
 *
 *   noh_gl_shader_text      the text of one of the files of shaders_es/ that are made for this
 *   noh_gl_variant_defines  (gl_variants.h) the defines that they need for a mesh
 *
 * shaders_es/README.md has a whole vertex shader with the uniforms and textures to set. The text is in the library:
 * nothing is read at run time. The source of a shader is given to GL in one call:
 *
 *   char defines[NOH_GL_DEFINES_BYTES];
 *   noh_gl_variant_defines(key, defines);
 *   const char *parts[] = { "#version 300 es\n", defines, "precision highp float;\nprecision highp int;\n",
 *                           noh_gl_shader_text("common_layers.glsl"), noh_gl_shader_text("common_attributes.glsl"),
 *                           noh_gl_shader_text("common_skin.glsl"), your_text };
 *   glShaderSource(shader, 7, parts, NULL);
 *
 * Threads: any; no GL is called. */
#ifndef NOH_GL_GL_SHADER_TEXT_H
#define NOH_GL_GL_SHADER_TEXT_H

#ifdef __cplusplus
extern "C" {
#endif

/* GLSL ES 3.00 without a #version line and without comments; a zero-terminated string constant.
 * name    "common_layers.glsl"      morph_fetch adds an instance's deltas
 *         "common_attributes.glsl"  normals and tangents from the pack's integers
 *         "common_skin.glsl"        skin moves a vertex by its joints; goes behind common_layers.glsl
 *         "common_fade.glsl"        fade_noise, for fragment shaders that fade between LOD levels
 * errors  NULL for any other name */
const char *noh_gl_shader_text(const char *name);

#ifdef __cplusplus
}
#endif

#endif
