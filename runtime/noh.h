/* noh.h: one header for all of noh, a character runtime in fixed memory.
 *
 * A game hands noh one block of memory and one .noh pack (made by `noh build`).
 * Every object tells its exact size, is placed in memory that you bring, and is
 * never freed: drop the block and it is gone. Nothing is asked for after init.
 *
 *   memory in, object out     noh_x_size(...) -> bytes
 *                             noh_x_init(memory, bytes, ..., &x, &error)
 *
 * What is where, in the order in which you need it:
 *   base/result.h        result codes and what went wrong
 *   base/limits.h        every limit, in one place
 *   pack/pack.h          open a pack where it lies; format.h has its bytes
 *   mesh/mesh.h          vertices, triangles, morph targets and levels of detail of a pack
 *   anim/pack_motion.h   skeletons and compressed motion of a pack
 *   anim/clip_codec.h    a compressed clip, ready to be played
 *   anim/clip_cache.h    its frames in a fixed block, and poses from them
 *   anim/controller.h    tracks, changes over time, callback keys; controller_pose.h: poses of them
 *   anim/motion_set.h    a pack's clips joined to the controller: start here
 *   anim/graph.h         a small animation graph over a controller
 *   anim/local_to_model.h  joint matrices and palettes
 *   deform/morph.h       morph targets on the CPU: reference and fallback
 *   character/character.h  one character: controller, detail, what it shows
 *   character/detail.h   detail chosen by pixels; level_pools.h: memory by level of detail, shared out among instances
 *   character/time_lod.h posing less often than once a frame; time_lod_points.h: what that moves vertices by
 *   character/detail_pack.h  what a pack says of both; joint_lod.h: what posing fewer joints costs
 *   character/scheduler.h  who is posed in a frame, within a budget; bounds.h: where a character is
 *   gl/gl_api.h          the GL ES functions that noh calls: you bring the lookup
 *   gl/gl_caps.h         what this GPU can really do, found by trying
 *   gl/gl_quirks.h       what a renderer's name tells and a probe cannot
 *   gl/gl_morph.h        morph targets accumulated on the GPU, five ways
 *   gl/gl_skin.h         joints of many instances on the GPU
 *   gl/gl_draw.h         meshes on the GPU and a plain renderer; gl_variants.h: its programs
 *   gl/gl_shader_text.h  the library's GLSL, for your own shaders
 *   gl/gl_debug.h        names for what RenderDoc and apitrace show
 *   gl/gl_lost.h         after a lost context
 *
 * The library needs memcpy, memset and memcmp, and nothing else. */
#ifndef NOH_H
#define NOH_H

#include "base/arena.h"
#include "base/hash.h"
#include "base/limits.h"
#include "base/result.h"
#include "pack/pack.h"
#include "mesh/mesh.h"
#include "anim/pack_motion.h"
#include "anim/clip_codec.h"
#include "anim/clip_cache.h"
#include "anim/controller.h"
#include "anim/controller_pose.h"
#include "anim/event_queue.h"
#include "anim/motion_set.h"
#include "anim/graph.h"
#include "anim/local_to_model.h"
#include "anim/ping_pong.h"
#include "deform/morph.h"
#include "deform/skin.h"
#include "deform/dual_quaternion.h"
#include "deform/bounds.h"
#include "deform/pick.h"
#include "gl/gl_api.h"
#include "gl/gl_caps.h"
#include "gl/gl_quirks.h"
#include "gl/gl_memory.h"
#include "gl/gl_morph.h"
#include "gl/gl_skin.h"
#include "gl/gl_variants.h"
#include "gl/gl_draw.h"
#include "gl/gl_shader_text.h"
#include "gl/gl_debug.h"
#include "gl/gl_lost.h"
#include "character/bounds.h"
#include "character/character.h"
#include "character/detail.h"
#include "character/detail_pack.h"
#include "character/joint_lod.h"
#include "character/level_pools.h"
#include "character/scheduler.h"
#include "character/time_lod.h"
#include "character/time_lod_points.h"

#endif
