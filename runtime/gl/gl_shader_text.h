/* gl_shader_text.h: the library's GLSL as text, to put into your own shaders.
 *
 *   noh_gl_shader_text      one of the files of shaders_es/ that are made for it
 *   noh_gl_variant_defines  (gl_variants.h) the defines that they want for a mesh
 *
 * shaders_es/README.md has a whole vertex shader with the uniforms and textures to set. The text is in the library:
 * nothing is read at run time. A shader is then one call:
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

/* GLSL ES 3.00 without a #version line, zero-terminated, constant; comments are left out.
 * name   "common_layers.glsl"      morph_fetch: an instance's deltas; defines LAYERS_UINT
 *        "common_attributes.glsl"  directions out of the pack's integers
 *        "common_skin.glsl"        skin: joints; goes behind common_layers.glsl; its defines are in its head
 *        "common_fade.glsl"        fade_noise, for fragment shaders of LOD levels that fade
 * errors NULL for any other name */
const char *noh_gl_shader_text(const char *name);

#ifdef __cplusplus
}
#endif

#endif
