/* gl_shader_text.h: the library's GLSL as text, file by file.
 *
 *   noh_gl_shader_text      the text of one of the files of shaders_es/ that are made for this
 *
 * Your own shaders want noh_gl_shader_prefix (gl_variants.h), which is all of them in order, with the defines for a
 * key. A single file is for what fits no noh_gl_mesh: your own vertex formats, or a tile of deltas in another use. The
 * text is in the library: nothing is read at run time. The source of a shader is given to GL in one call:
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
 * name    "common_layers.glsl"      noh_morph_fetch adds an instance's deltas
 *         "common_attributes.glsl"  normals and tangents from the pack's integers
 *         "common_skin.glsl"        noh_skin_vertex moves a vertex by its joints; goes behind common_layers.glsl
 *         "common_face.glsl"        what eyes and teeth need of a vertex; goes behind common_skin.glsl
 *         "common_vertex.glsl"      noh_fetch, all of it for a noh_gl_mesh; goes behind the four
 *         "common_fade.glsl"        noh_fade_noise, the pattern by which LOD levels fade
 *         "common_fragment.glsl"    noh_fade, noh_cut, noh_base, noh_encode; goes behind common_fade.glsl
 *         "common_wrinkle.glsl"     how much a pixel is wrinkled; goes behind common_fragment.glsl
 *         "common_environment.glsl" noh_ambient, noh_mirror, noh_key_shadow, noh_expose: what light there is where
 *                                   NOH_LIT is defined; goes behind common_fragment.glsl
 *         "common_material.glsl"    noh_surface_of, a material's maps; goes behind common_wrinkle.glsl
 *         "common_scatter.glsl"     what skin does with light; goes behind common_environment.glsl
 *         "common_eye.glsl"         what eyes and teeth do with it; goes behind common_environment.glsl
 *         "common_light.glsl"       noh_light, the light on a surface; goes behind all of these
 * errors  NULL for any other name */
const char *noh_gl_shader_text(const char *name);

#ifdef __cplusplus
}
#endif

#endif
