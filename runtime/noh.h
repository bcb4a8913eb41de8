/* noh.h: characters in fixed memory; all of noh that needs no GL. With GL include noh_gl.h instead.
 *
 * noh opens a pack of meshes, skeletons and compressed clips (made by `noh build`), plays the clips, morphs faces and
 * skins bodies, on the CPU or with OpenGL ES 3.x. It is C99 and links only memcpy, memset and memcmp. It never
 * allocates, prints, reads clocks or files, or keeps globals.
 *
 * Memory. Ask for an object's exact size, provide the memory and build the object in it. Objects need no free: reuse
 * the memory when you are done. No object needs more memory after init. Memory must be aligned to NOH_MEMORY_ALIGN
 * bytes (16; 8 on 32-bit ARM and wasm), which malloc guarantees.
 *
 *     bytes = noh_x_size(&desc);                        0: the desc is invalid; init returns the error
 *     noh_x_init(memory, bytes, &desc, &x, &error)      builds it in place, writes not a byte past `bytes`
 *
 * A pack is read in place, and objects made from it refer to its bytes: keep them readable and unchanged.
 *
 * Names. noh_noun_verb() is a function, noh_noun a type, NOH_NOUN a constant. A desc is a struct of settings in which
 * zero means the documented default. x_count is a count, x_bytes a count of bytes, x_max a limit. Times end in their
 * unit: _ticks, _s. A header whose name ends in _internal.h is private and is not installed. Matrices are 3 rows of 4
 * floats that multiply columns, quaternions x y z w, triangles counter-clockwise.
 *
 * Errors. A function that can fail returns a noh_result, NOH_OK (0) or an error, and leaves its outputs untouched on
 * error. Its last parameter is a noh_error, which may be NULL: `what` is a sentence, never NULL after a failure;
 * `where` is the byte or index at fault; `need` is the size or count required; either is 0 where it does not apply.
 * Setters of one number and noh_gl_timer_poll have no noh_error. Bad data, too little memory and missing capabilities
 * are errors. A caller's bug (a NULL, an index past its count) is an assert, in two tiers that a build can enable:
 * assert.h.
 *
 * Not found. A function that finds an index by name returns NOH_NONE if there is none. A function that returns a
 * noh_result returns NOH_ERR_NOT_FOUND.
 *
 * Inits. NULL or misaligned memory is NOH_ERR_ARG, too little is NOH_ERR_MEMORY; `need` is then the bytes needed.
 *
 * Threads. Objects opened from bytes (packs, meshes, skins, skeletons, clips) and descs are read-only: any number of
 * threads may share them. An object made by an init belongs to one thread at a time; two characters may be posed on two
 * threads. Sampling from a clip bank changes its cache: to pose on several threads give each its own view
 * (clip_bank.h). Functions without an object (base/, deform/) keep no state. GL objects belong to the thread of the GL
 * context. The library takes no locks. Each header has a "Threads:" line with its rule. */
#ifndef NOH_H
#define NOH_H

/* ---- what a game calls first ---- */

#include "stage/cast/stage.h"             /* a cast of characters in one block of memory */
#include "stage/cast/part.h"              /* modifiers: functions that change a pose before it is shown */
#include "stage/cast/stage_face.h"        /* faces of actors */
#include "stage/cast/stage_feet.h"        /* actors that stand on the ground */
#include "stage/cast/stage_gaze.h"        /* actors that look at points and reach for them */
#include "stage/actors/walkers.h"         /* actors that follow the agents of a crowd */
#include "stage/cast/stage_ragdoll.h"     /* ragdolls of actors, and getting up */
#include "stage/cast/fall.h"              /* pushes, falls and when actors get up */
#include "stage/actors/blob.h"            /* blob shadows of actors */
#include "stage/actors/decal.h"           /* marks on actors */
#include "stage/actors/decal_grow.h"      /* triangles of marks */
#include "stage/cast/springs.h"           /* chains of joints that swing */
#include "stage/actors/wig.h"             /* hair of actors */
#include "stage/actors/wigs.h"            /* hair of crowds */
#include "stage/cast/view.h"              /* cameras and lights */
#include "core/base/version.h"            /* which noh this is */
#include "core/base/result.h"             /* noh_result, noh_error */
#include "core/base/limits.h"             /* all limits */
#include "core/pack/pack.h"               /* open a pack; pack/format.h defines its bytes */
#include "core/pack/etc2.h"               /* decode the blocks of compressed textures */
#include "core/wire/wire.h"               /* packs compressed for transfer, unpacked as they arrive */
#include "core/mesh/wrinkles.h"           /* wrinkle weights of skin regions, from morph weights */
#include "core/mesh/mesh.h"               /* meshes and skins of a pack: vertices, triangles, targets, LOD levels */
#include "motion/clip/pack_clip.h"        /* skeletons and clips of a pack */
#include "motion/bank/clip_bank.h"        /* a pack's clips, ready to play: a set and its cache */
#include "stage/character/character.h"    /* one character: a controller, its pose, its detail */
#include "stage/character/skin_palette.h" /* its pose, as matrices of any skin */
#include "motion/anim/controller.h"       /* tracks: start, fade, seek, callback keys */
#include "motion/anim/controller_pose.h"  /* poses of a controller */
#include "motion/pose/local_to_model.h"   /* matrices and palettes of poses */
#include "deform/morph/morph.h"           /* targets on the CPU: the reference and the fallback */
#include "deform/morph/morph_finish.h"    /* morphed vertices in the formats of vertex buffers */
#include "deform/skin/skin.h"             /* skins on the CPU: the reference and the fallback */
#include "deform/skin/skin_list.h"        /* vertices with more than eight joints, on the CPU */
#include "deform/pick/bounds.h"           /* bounding boxes of deformed meshes */
#include "deform/pick/pick.h"             /* rays against deformed meshes */

/* ---- animation ---- */

#include "motion/graph/graph.h"          /* an animation graph over a controller */
#include "motion/graph/graph_pack.h"     /* animation graphs in a pack, played by name */
#include "motion/anim/clip_set.h"        /* the clips that controllers share; a set of your own, without a pack */
#include "motion/anim/mask.h"            /* which joints a track moves, as weights per joint */
#include "motion/anim/root_motion.h"     /* root motion of clips */
#include "motion/anim/event_queue.h"     /* callback keys, collected for later */
#include "motion/anim/ping_pong.h"       /* weights as functions of time: ramps, ping-pong */
#include "deform/skin/dual_quaternion.h" /* skinning that keeps volume where joints twist */

/* ---- level of detail: what is drawn and posed, in which detail, how often ---- */

#include "stage/character/bounds.h"          /* bounding spheres of characters */
#include "stage/character/lod.h"             /* LOD levels chosen by an error in pixels */
#include "stage/character/lod_pack.h"        /* LOD tables from a pack */
#include "stage/character/lod_pools.h"       /* slots of each LOD level, assigned to instances */
#include "stage/character/scheduler.h"       /* which characters a frame poses, within a budget */
#include "stage/character/time_lod.h"        /* time LOD: characters posed less often than every frame */
#include "stage/character/time_lod_points.h" /* errors of time LOD at vertices */
#include "stage/character/joint_lod.h"       /* errors of posing fewer joints */

/* ---- light ---- */

#include "gl/light/environment.h" /* environments as spherical harmonics, built in or your own */
#include "gl/light/reflection.h"  /* environments as cube maps, for glossy surfaces */
#include "gl/light/transfer.h"    /* transfer of light to the vertices of a mesh as it turns and morphs */
#include "gl/light/sh.h"          /* spherical harmonics: projection, convolution, rotation */

/* ---- faces ---- */

#include "life/face/amplitude.h"   /* mouth shapes from loudness */
#include "life/face/corrective.h"  /* correctives and in-betweens: targets driven by other targets */
#include "life/face/ear.h"         /* live sound to mouth shapes */
#include "life/face/face.h"        /* blinks, gaze, emotions, breath */
#include "life/face/identity.h"    /* faces by seed: weights of identity targets */
#include "life/face/recipe.h"      /* target weights for what a face shows */
#include "life/face/speech.h"      /* phones to mouth shapes */
#include "life/face/weight_rule.h" /* ranges of target weights, and targets that exclude each other */

/* ---- bodies ---- */

#include "life/reach/feet.h"           /* feet placed on the ground */
#include "life/reach/gaze.h"           /* bodies that look at a point */
#include "life/hair/hair.h"            /* control hairs of a head */
#include "life/hair/haircut.h"         /* haircuts of a pack, and their strips */
#include "life/reach/ik.h"             /* two-bone IK, and aiming a head */
#include "life/reach/ik_chain.h"       /* IK chains of any length, with limits */
#include "life/physics/motion.h"       /* fixed steps, integrators, a distance constraint */
#include "life/physics/ragdoll.h"      /* ragdolls */
#include "life/physics/ragdoll_pose.h" /* ragdoll bodies to and from poses */
#include "life/physics/ragdoll_rig.h"  /* a ragdoll built from a character */
#include "life/reach/reach.h"          /* hands that reach for moving points */
#include "life/physics/rigid.h"        /* a free rigid body, forces and torques at points */
#include "life/physics/shape.h"        /* boxes, rays */
#include "life/physics/spring.h"       /* swinging chains: hair, sleeves, tails */
#include "life/physics/terrain.h"      /* the height field of a pack */
#include "life/physics/terrain_lod.h"  /* LOD of terrain */
#include "life/physics/world.h"        /* collision geometry: planes, capsules, boxes, a height field */

/* ---- crowds ---- */

#include "stage/crowd/crowd.h"        /* agents that walk to goals and avoid each other */
#include "stage/crowd/flock.h"        /* flocking rules */
#include "stage/crowd/smart_object.h" /* objects that agents use, one agent per slot */

/* ---- low-level parts, for your own tools and engines ---- */

#include "core/base/arena.h"        /* allocation within a block */
#include "core/base/half.h"         /* 16-bit floats */
#include "core/base/hash.h"         /* hashes of names, checksums */
#include "core/base/quat.h"         /* quaternions */
#include "core/base/trig.h"         /* trigonometry without libm, the same bits everywhere */
#include "motion/pose/blend.h"      /* blending and adding poses */
#include "motion/clip/clip_cache.h" /* decoded frames in a fixed block, and sampling */
#include "motion/clip/clip_view.h"  /* a thread's own view of a clip cache */
#include "motion/clip/clip_codec.h" /* one compressed clip */

/* Glossary: one word for one thing, in names, documents, the command line and messages.
 *
 *   pack, chunk          a .noh file; one of its parts: a mesh, a skeleton, a clip...
 *   skeleton, bind pose  joints and their parents; the pose in which a mesh was attached to them
 *   joint                a node of a skeleton; others call it a bone
 *   palette              the matrices of the joints that one draw uses
 *   target, pair         a morph target; one vertex moved by one target
 *   delta texel          a stored difference of one vertex in one target: position, normal, tangent
 *   accumulation texel   the sum of a vertex's weighted delta texels, in an accumulator
 *   environment          light from all around
 *   surface              the lighting model of a material: plain, skin, eye, teeth, toon
 *   scatter              light that enters skin and leaves it nearby
 *   transfer, lobe       the light that a mesh receives from an environment; for one vertex, symmetric about an axis
 *   occlusion            the share of the light on a matte surface that the mesh itself lets through: 1 is open
 *   clip                 a compressed animation of joints and floats
 *   clip set             the interface of shared clips for controllers: names, durations, keys, and a function that
 *                        samples a pose; short: set. A game may fill in its own (noh_clip_set)
 *   clip bank            the opened clips of a pack for one skeleton, with their cache and clip set (noh_clip_bank)
 *   track                a clip that a controller plays: its position, weight and playback speed
 *   controller           the tracks of one character, and their changes over time
 *   graph, node          a graph decides which clips play and how they blend; a node is a part of it, named in a pack
 *   state                a child of a machine, select or one-shot
 *   parameter            a number of an instance of a graph, which the game sets
 *   callback key         a named moment of a clip that is reported when a track passes it
 *   stage, kind, actor   a cast in one block of memory; a type of character in it; one character
 *   layer                one activity of an actor: walk, wave, talk
 *   agent                a member of a crowd: a disc on the ground, with a goal
 *   flow field           directions of the shortest paths to one goal, by cells of the ground
 *   tick                 1/48,000 second
 *   sample rate          frames per second of a clip
 *   playback speed       speed of a track; 1 is the clip's own
 *   update rate          how often an instance is posed: every frame, 30, 15 or 8 times a second
 *   cached segment       decoded frames of a clip; an entry of the clip cache
 *   LOD level            a version of a mesh or skeleton; 0 is the full one, higher ones are coarser
 *   slot                 a place in a fixed pool, held by an instance
 *   radius               the farthest distance from a centre, or of a movement
 *
 * A noh_clip is an opened compressed clip, a noh_clip_entry a clip of a set, a noh_pack_clip a clip of a pack. */

#endif
