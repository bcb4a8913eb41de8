/* gl_shader_text.h: the library's GLSL files as text.
 *
 *   noh_gl_shader_text      the text of a file of shaders_es/
 *
 * For your own shaders use noh_gl_shader_prefix (gl_variants.h), which has all files in order, with the defines for a
 * key. Use single files for what does not fit a noh_gl_mesh: your own vertex formats, or other uses of delta tiles. The
 * text is in the library; nothing is read at run time. Pass the source of a shader to GL in one call:
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

/* The text of a file: GLSL ES 3.00 without a #version line and without comments, a zero-terminated string constant.
 * name    "common_layers.glsl"      noh_morph_fetch adds an instance's deltas
 *         "common_attributes.glsl"  normals and tangents from the pack's integers
 *         "common_skin.glsl"        noh_skin_vertex moves a vertex by its joints; after common_layers.glsl
 *         "common_face.glsl"        vertex outputs for skin, eyes and teeth; after common_skin.glsl
 *         "common_vertex.glsl"      noh_fetch, the whole vertex of a noh_gl_mesh; after these four
 *         "common_fade.glsl"        noh_fade_noise, the fade pattern of LOD levels
 *         "common_fragment.glsl"    noh_fade, noh_cut, noh_base, noh_encode; after common_fade.glsl
 *         "common_wrinkle.glsl"     wrinkle weights of a pixel; after common_fragment.glsl
 *         "common_environment.glsl" noh_ambient, noh_mirror, noh_key_shadow, noh_expose: the light if NOH_LIT is
 *                                   defined; after common_fragment.glsl
 *         "common_material.glsl"    noh_surface_of, a material's maps; after common_wrinkle.glsl
 *         "common_scatter.glsl"     light scattered in skin; after common_environment.glsl
 *         "common_eye.glsl"         light on eyes and teeth; after common_environment.glsl
 *         "common_light.glsl"       noh_light, the light on a surface; after all of these
 * errors  NULL for any other name */
const char *noh_gl_shader_text(const char *name);

#ifdef __cplusplus
}
#endif

#endif
