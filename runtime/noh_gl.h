/* noh_gl.h: all of noh with OpenGL ES 3.x; includes noh.h.
 *
 * noh creates no context and links no GL: noh_gl_api_load fills a table of functions by a lookup of yours
 * (eglGetProcAddress and its like), and every GL object is made, drawn and deleted through that table. An object
 * is sized, placed and checked as those of noh.h are; its GL memory is counted (gl_memory.h), created at init and never
 * grown. Creating fails with the driver's error: GL, with the GL error code in `where`.
 *
 * noh changes GL state and does not put it back: what a call leaves bound is in its comment.
 *
 * Threads: all calls on the thread of the context that the objects were made in.
 *
 * After a lost context, call the _restore functions (gl_lost.h): they make the same objects again out of the pack. */
#ifndef NOH_GL_H
#define NOH_GL_H

#include "noh.h"

/* ---- what a game calls first ---- */

#include "gl/gl_api.h"         /* the functions that noh calls */
#include "gl/gl_caps.h"        /* what this GPU can really do, found by trying */
#include "gl/gl_morph.h"       /* targets of many instances accumulated on the GPU */
#include "gl/gl_skin.h"        /* palettes of many instances on the GPU */
#include "gl/gl_draw.h"        /* meshes on the GPU, and a plain renderer */
#include "gl/gl_shader_text.h" /* the library's GLSL, for your own shaders */

/* ---- when something is lost or slow ---- */

#include "gl/gl_lost.h"   /* a lost context */
#include "gl/gl_debug.h"  /* names that RenderDoc and apitrace show */
#include "gl/gl_quirks.h" /* what a renderer's name tells and a probe cannot */
#include "gl/gl_timer.h"  /* GPU time */

/* ---- parts, for renderers of your own ---- */

#include "gl/gl_memory.h"   /* GL objects, counted against a budget */
#include "gl/gl_program.h"  /* shaders out of pieces */
#include "gl/gl_variants.h" /* the programs of the plain renderer */

#endif
