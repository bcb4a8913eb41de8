/* noh_gl.h: all of noh with OpenGL ES 3.x. Includes noh.h.
 *
 * noh creates no context and links no GL. It includes no GL header and defines no GL name: include the header or loader
 * that you use, before or after this one. Make a context current, then:
 *
 *     noh_gl_api_load         fill a table of GL functions through your lookup (eglGetProcAddress and the like)
 *     noh_gl_caps_probe       find out what this GPU can do
 *     noh_gl_mesh_create      upload a mesh of the pack; noh_gl_picture_create uploads a texture
 *     noh_gl_morph_init       an accumulator for the morph targets of all instances
 *     noh_gl_skin_init        palettes for the skins of all instances
 *     noh_gl_renderer_create  the plain renderer; or use shaders of your own (gl_shader_text.h)
 *
 * In a frame, call noh_gl_morph_set_weights and noh_gl_skin_set_matrices for each instance that moved, then
 * noh_gl_morph_update and noh_gl_skin_update once, then draw.
 *
 * Memory. As in noh.h: you bring it, and the exact size is known first. noh_gl_morph_plan_make and
 * noh_gl_skin_plan_make tell the bytes on the CPU and on the GPU without touching GL. GL objects are made at init and
 * never grow; a ledger counts them (gl_memory.h).
 *
 * Errors. When the driver refuses a call, the create or init that made it fails with NOH_ERR_GL, or with NOH_ERR_MEMORY
 * where the GPU is out of memory. `where` is then the GL error code, and no object is left behind.
 *
 * State. Render state is yours: noh reads it and puts it back. Bindings are left empty. gl_state.h has the table.
 *
 * Threads. All calls on the thread of the context that the objects were made in, unless a header says otherwise.
 *
 * Lost context. The _restore functions make the same objects again from the pack (gl_lost.h). */
#ifndef NOH_GL_H
#define NOH_GL_H

#include "noh.h"

/* ---- what a game calls first ---- */

#include "gl/stage/stage_gl.h"        /* a stage, drawn */
#include "gl/stage/backdrop.h"        /* what is behind it, where it is lit */
#include "gl/stage/stage_blob.h"      /* soft spots under them, where there is no shadow map */
#include "gl/stage/stage_floor.h"     /* their shadow, where there is no mesh for it to fall on */
#include "gl/stage/stage_decal.h"     /* marks on them */
#include "gl/stage/stage_patch.h"     /* as triangles that were grown */
#include "gl/stage/stage_hair.h"      /* hair of its actors */
#include "gl/stage/stage_hairs.h"     /* hair of a crowd */
#include "gl/stage/stage_terrain.h"   /* a height field as their ground */
#include "gl/device/gl_api.h"         /* the functions that noh calls */
#include "gl/device/gl_caps.h"        /* what this GPU can do, found by trying it */
#include "gl/device/gl_open.h"        /* all of that in one object */
#include "gl/morph/gl_morph.h"        /* morph targets of many instances, accumulated on the GPU */
#include "gl/draw/gl_skin.h"          /* joint palettes of many instances on the GPU */
#include "gl/draw/gl_light.h"         /* light for it: an environment, a shadow map */
#include "gl/draw/gl_draw.h"          /* meshes on the GPU, and a plain renderer */
#include "gl/device/gl_state.h"       /* what calls ask of GL's state and leave */
#include "gl/device/gl_shader_text.h" /* the library's GLSL, for your own shaders */

/* ---- when a context is lost, a frame is slow, or a driver is odd ---- */

#include "gl/device/gl_lost.h"   /* after a context was lost */
#include "gl/device/gl_debug.h"  /* names for RenderDoc and apitrace */
#include "gl/device/gl_quirks.h" /* what is known of a renderer by its name only */
#include "gl/device/gl_timer.h"  /* how long the GPU took */

/* ---- parts, for renderers of your own ---- */

#include "gl/device/gl_memory.h"  /* GL objects, counted against a budget */
#include "gl/device/gl_program.h" /* shaders compiled and linked */
#include "gl/draw/gl_variants.h"  /* the programs of the plain renderer */

#endif
