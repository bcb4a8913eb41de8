/* noh_gl.h: all of noh with OpenGL ES 3.x. Includes noh.h.
 *
 * noh creates no context and links no GL. It includes no GL header and defines no GL names: include your GL header or
 * loader before or after this one. Make a context current, then:
 *
 *     noh_gl_api_load         fill a table of GL functions through your lookup (eglGetProcAddress and the like)
 *     noh_gl_caps_probe       find out what this GPU can do
 *     noh_gl_mesh_create      upload a mesh of the pack; noh_gl_picture_create uploads a texture
 *     noh_gl_morph_init       an accumulator for the morph targets of all instances
 *     noh_gl_skin_init        palettes for the skins of all instances
 *     noh_gl_renderer_create  the plain renderer; or use your own shaders (gl_shader_text.h)
 *
 * In a frame, call noh_gl_morph_set_weights and noh_gl_skin_set_matrices for each instance that moved, then
 * noh_gl_morph_update and noh_gl_skin_update once, then draw.
 *
 * Memory. As in noh.h: you provide it, and its exact size is known first. noh_gl_morph_plan_make and
 * noh_gl_skin_plan_make compute the bytes on the CPU and the GPU without GL calls. GL objects are made at init and
 * never grow; a ledger counts them (gl_memory.h).
 *
 * Errors. If the driver refuses a call, the create or init fails with NOH_ERR_GL, or with NOH_ERR_MEMORY if the GPU is
 * out of memory. `where` is then the GL error code, and all objects made so far are deleted.
 *
 * State. Render state is yours: noh saves and restores it. Bindings are left empty. gl_state.h has the table.
 *
 * Threads. Make all calls on the thread of the context that the objects were made in, unless a header says otherwise.
 *
 * Lost context. The _restore functions recreate the objects from the pack (gl_lost.h). */
#ifndef NOH_GL_H
#define NOH_GL_H

#include "noh.h"

/* ---- what a game calls first ---- */

#include "gl/stage/stage_gl.h"        /* drawing a stage */
#include "gl/stage/backdrop.h"        /* the background of a lit stage */
#include "gl/stage/stage_blob.h"      /* blob shadows, without a shadow map */
#include "gl/stage/stage_floor.h"     /* a floor that only receives shadows */
#include "gl/stage/stage_decal.h"     /* marks on actors */
#include "gl/stage/stage_patch.h"     /* marks as triangles of the mesh */
#include "gl/stage/stage_hair.h"      /* hair of actors */
#include "gl/stage/stage_hairs.h"     /* hair of crowds */
#include "gl/stage/stage_terrain.h"   /* a height field as ground */
#include "gl/device/gl_api.h"         /* the table of GL functions */
#include "gl/device/gl_caps.h"        /* capabilities of the GPU, found by tests */
#include "gl/device/gl_open.h"        /* all of that in one object */
#include "gl/morph/gl_morph.h"        /* morph targets of many instances, accumulated on the GPU */
#include "gl/draw/gl_skin.h"          /* joint palettes of many instances on the GPU */
#include "gl/draw/gl_light.h"         /* environment light and shadow maps */
#include "gl/draw/gl_draw.h"          /* meshes on the GPU, and a plain renderer */
#include "gl/device/gl_state.h"       /* the GL state that calls need and leave */
#include "gl/device/gl_shader_text.h" /* the library's GLSL, for your own shaders */

/* ---- lost contexts, debugging, driver quirks, timing ---- */

#include "gl/device/gl_lost.h"   /* recovery after a lost context */
#include "gl/device/gl_debug.h"  /* names for RenderDoc and apitrace */
#include "gl/device/gl_quirks.h" /* workarounds by renderer name */
#include "gl/device/gl_timer.h"  /* GPU time */

/* ---- low-level parts, for your own renderers ---- */

#include "gl/device/gl_memory.h"  /* GL objects, counted by a ledger */
#include "gl/device/gl_program.h" /* compiling and linking shaders */
#include "gl/draw/gl_variants.h"  /* the programs of the plain renderer */

#endif
