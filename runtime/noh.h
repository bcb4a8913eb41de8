/* noh.h: characters in fixed memory: all of noh that needs no GL. With GL include noh_gl.h instead.
 *
 * noh opens a pack of meshes, skeletons and compressed clips (made by `noh build`), plays the clips, morphs faces and
 * skins bodies, on the CPU or on OpenGL ES 3.x. It is C99, links memcpy, memset and memcmp and nothing else, and never
 * allocates, prints, reads a clock or a file, or keeps a global.
 *
 * Memory. An object tells its exact size, is built in memory that you bring, and is never freed: drop the memory and it
 * is gone. Nothing asks for memory after init. Memory is aligned to NOH_MEMORY_ALIGN bytes (16; 8 on 32-bit ARM and
 * wasm), as malloc's is.
 *
 *     bytes = noh_x_size(&desc);                        0: the desc is impossible, init says why
 *     noh_x_init(memory, bytes, &desc, &x, &error)      builds it in place, writes not a byte past `bytes`
 *
 * A pack is read where it lies, and what is made of it refers to its bytes: keep them readable and unchanged.
 *
 * Names. noh_noun_verb() is a function, noh_noun a type, NOH_NOUN a constant. A desc is a struct of settings in which
 * zero means the documented default. x_count counts, x_bytes counts bytes, x_max is a limit. Times end in their unit:
 * _ticks, _s. A header whose name ends in _internal.h is private and is not installed. Matrices are 3 rows of 4 floats
 * that multiply columns, quaternions x y z w, triangles counter-clockwise.
 *
 * Errors. What can fail returns a noh_result, NOH_OK (0) or an error, and leaves its outputs untouched on error. The
 * last parameter is then a noh_error, which may be NULL: `what` is a sentence and never NULL after a failure, `where`
 * the byte or index at fault, `need` the size or count that was wanted; 0 where that means nothing. Setters of one
 * number and noh_gl_timer_poll have none: their result says all. Bad data, short memory and a missing capability are
 * errors. A caller's bug (a NULL, an index past its count) is an assert, of two tiers that a build switches on:
 * assert.h.
 *
 * Not found. A function that finds by name returns an index, or NOH_NONE. A function that returns a noh_result returns
 * NOH_ERR_NOT_FOUND.
 *
 * Inits. NULL or misaligned memory is NOH_ERR_ARG, too little is NOH_ERR_MEMORY; `need` is always the bytes needed.
 *
 * Threads. What is opened from bytes (packs, meshes, skins, skeletons, clips) and every desc is read-only: any number
 * of threads may share it. What an init made is for one thread at a time, each object for itself: two characters may be
 * posed on two threads. Sampling from a clip bank changes its cache: to pose on several threads give each a view
 * (clip_bank.h). Functions without an object (base/, deform/) keep no state. GL objects belong to the thread of
 * the GL context. The library takes no lock. In each header a line "Threads:" says which of these holds there. */
#ifndef NOH_H
#define NOH_H

/* ---- what a game calls first ---- */

#include "stage/cast/stage.h"             /* a whole cast of characters out of one block */
#include "stage/cast/part.h"              /* what changes a pose before it is shown */
#include "stage/cast/stage_face.h"        /* faces of its actors */
#include "stage/cast/stage_feet.h"        /* actors that stand on the ground */
#include "stage/cast/stage_gaze.h"        /* actors that look at points and reach for them */
#include "stage/actors/walkers.h"         /* actors that go where agents of a crowd go */
#include "stage/cast/stage_ragdoll.h"     /* actors that fall and get up */
#include "stage/cast/fall.h"              /* pushing them, and when they get up */
#include "stage/actors/blob.h"            /* where actors darken the ground */
#include "stage/actors/decal.h"           /* marks on actors */
#include "stage/actors/decal_grow.h"      /* their triangles */
#include "stage/cast/springs.h"           /* chains of joints that swing */
#include "stage/actors/wig.h"             /* hair of actors */
#include "stage/actors/wigs.h"            /* hair of crowds */
#include "stage/cast/view.h"              /* cameras and lights for it */
#include "core/base/version.h"            /* which noh this is */
#include "core/base/result.h"             /* noh_result, noh_error */
#include "core/base/limits.h"             /* every limit, in one place */
#include "core/pack/pack.h"               /* open a pack; pack/format.h has its bytes */
#include "core/pack/etc2.h"               /* decode the blocks of compressed textures */
#include "core/wire/wire.h"               /* packs as they are sent, unpacked while they arrive */
#include "core/mesh/wrinkles.h"           /* how much morph weights wrinkle regions of skin */
#include "core/mesh/mesh.h"               /* its meshes and skins: vertices, triangles, targets, LOD levels */
#include "motion/clip/pack_clip.h"        /* its skeletons and clips */
#include "motion/bank/clip_bank.h"        /* a pack's clips, ready to be played: a set, and the cache behind it */
#include "stage/character/character.h"    /* one character: a controller, what it shows, how finely */
#include "stage/character/skin_palette.h" /* what it shows, as matrices of any skin */
#include "motion/anim/controller.h"       /* tracks: start, fade, seek, callback keys */
#include "motion/anim/controller_pose.h"  /* poses of a controller */
#include "motion/pose/local_to_model.h"   /* poses to matrices and palettes */
#include "deform/morph/morph.h"           /* targets on the CPU: the reference and the fallback */
#include "deform/morph/morph_finish.h"    /* morphed vertices in the formats of vertex buffers */
#include "deform/skin/skin.h"             /* skins on the CPU, likewise */
#include "deform/skin/skin_list.h"        /* vertices that more than eight joints move, on the CPU */
#include "deform/pick/bounds.h"           /* a box round what is deformed */
#include "deform/pick/pick.h"             /* a ray against what is deformed */

/* ---- more ways to move ---- */

#include "motion/graph/graph.h"          /* an animation graph over a controller */
#include "motion/graph/graph_pack.h"     /* the same out of a pack, played by names */
#include "motion/anim/clip_set.h"        /* the clips that controllers share: a set of your own, without a pack */
#include "motion/anim/mask.h"            /* weights per joint: which of them a track moves */
#include "motion/anim/root_motion.h"     /* root displacement of clips */
#include "motion/anim/event_queue.h"     /* callback keys collected, to be read later */
#include "motion/anim/ping_pong.h"       /* weights as functions of time: a ramp, a ping-pong */
#include "deform/skin/dual_quaternion.h" /* skins that keep their volume where joints twist */

/* ---- crowds: what is drawn and posed, how finely, how often ---- */

#include "stage/character/bounds.h"          /* where a character is */
#include "stage/character/lod.h"             /* LOD levels chosen by an error in pixels */
#include "stage/character/lod_pack.h"        /* the same, filled in from a pack */
#include "stage/character/lod_pools.h"       /* memory by LOD level, shared out among instances */
#include "stage/character/scheduler.h"       /* which characters are posed in a frame, within a budget */
#include "stage/character/time_lod.h"        /* posing less often than once a frame */
#include "stage/character/time_lod_points.h" /* what that moves vertices by */
#include "stage/character/joint_lod.h"       /* what posing fewer joints costs */

/* ---- light ---- */

#include "gl/light/environment.h" /* light from all around, built in or your own, as spherical harmonics */
#include "gl/light/reflection.h"  /* the same as a cube of texels, for surfaces that gloss */
#include "gl/light/transfer.h"    /* what light a vertex of a mesh receives, as it turns and morphs */
#include "gl/light/sh.h"          /* spherical harmonics: projected, convolved, turned */

/* ---- faces ---- */

#include "life/face/amplitude.h"   /* mouth shapes out of loudness alone */
#include "life/face/corrective.h"  /* correctives and in-betweens: targets that follow from others */
#include "life/face/ear.h"         /* live sound to mouth shapes */
#include "life/face/face.h"        /* blinks, gaze, emotions, breath */
#include "life/face/identity.h"    /* people by seed: weights of the targets that tell faces apart */
#include "life/face/recipe.h"      /* what a face shows, as weights of the targets that it has */
#include "life/face/speech.h"      /* phones to mouth shapes */
#include "life/face/weight_rule.h" /* how far targets go, and which exclude each other */

/* ---- bodies ---- */

#include "life/reach/feet.h"           /* feet that stand on the ground */
#include "life/reach/gaze.h"           /* bodies that look at a point */
#include "life/hair/hair.h"            /* control hairs of a head */
#include "life/hair/haircut.h"         /* hair of a pack, and its strips */
#include "life/reach/ik.h"             /* two bones that reach a point, a head that looks at one */
#include "life/reach/ik_chain.h"       /* chains of any length, with limits */
#include "life/physics/motion.h"       /* fixed steps, integrators, a distance that is kept */
#include "life/physics/ragdoll.h"      /* bodies that fall */
#include "life/physics/ragdoll_pose.h" /* between its bodies and a pose */
#include "life/physics/ragdoll_rig.h"  /* a ragdoll out of a character */
#include "life/reach/reach.h"          /* hands that reach for points that move */
#include "life/physics/rigid.h"        /* a free rigid body, forces and torques at points */
#include "life/physics/shape.h"        /* boxes, rays */
#include "life/physics/spring.h"       /* chains that swing: hair, sleeves, tails */
#include "life/physics/terrain.h"      /* the height field of a pack */
#include "life/physics/terrain_lod.h"  /* its levels, as a picture needs them */
#include "life/physics/world.h"        /* what bodies collide with: planes, capsules, boxes, a height field */

/* ---- many of them, on the ground ---- */

#include "stage/crowd/crowd.h"        /* agents that walk to their goals and stay out of each other's way */
#include "stage/crowd/flock.h"        /* rules of a flock, one by one */
#include "stage/crowd/smart_object.h" /* things that agents use, one at a time */

/* ---- parts, for tools and engines of your own ---- */

#include "core/base/arena.h"        /* carve a block */
#include "core/base/half.h"         /* 16-bit floats */
#include "core/base/hash.h"         /* names as hashes, checksums */
#include "core/base/quat.h"         /* quaternions */
#include "core/base/trig.h"         /* trigonometry without libm, the same bits everywhere */
#include "motion/pose/blend.h"      /* poses mixed and added */
#include "motion/clip/clip_cache.h" /* decoded frames in a fixed block, and samples of them */
#include "motion/clip/clip_view.h"  /* a thread's own view of a clip cache */
#include "motion/clip/clip_codec.h" /* one compressed clip */

/* Glossary: one word for one thing, in names, documents, the command line and messages.
 *
 *   pack, chunk          a .noh file; one of its parts: a mesh, a skeleton, a clip...
 *   skeleton, bind pose  joints and their parents; the pose in which a mesh was attached to them
 *   joint                a node of a skeleton, elsewhere called a bone
 *   palette              the matrices of the joints that one draw uses
 *   target, pair         a morph target; one vertex moved by one target
 *   delta texel          a stored difference of one vertex in one target: position, normal, tangent
 *   accumulation texel   the sum of a vertex's weighted delta texels, in an accumulator
 *   environment          light from all around
 *   surface              what a material is made of, which decides how it is lit: plain, skin, eye, teeth, toon
 *   scatter              what skin does with light: it comes out beside where it went in
 *   transfer, lobe       how a mesh answers to such light; the answer of one vertex, round about an axis
 *   occlusion            the share of the light on a matte surface that the mesh itself lets through: 1 is open
 *   clip                 a compressed animation of joints and floats
 *   clip set             what controllers see of the clips they share: names, durations, keys, and a function that
 *                        samples a pose; short: set. A game may fill in one of its own (noh_clip_set)
 *   clip bank            the clips of a pack that fit one skeleton, opened, with their cache; it makes a clip set of
 *                        them (noh_clip_bank)
 *   track                a clip that a controller plays: its position, weight and playback speed
 *   controller           the tracks of one character, and their changes over time
 *   graph, node          what decides which clips play, and how they are blended; a part of it, with a name in a pack
 *   state                a child of a machine, select or one-shot: what it shows
 *   parameter            a number of an instance of a graph, which the game sets
 *   callback key         a named moment of a clip that is reported when a track passes it
 *   stage, kind, actor   a cast out of one block; a sort of character on it; one character
 *   layer                one thing that an actor can do at a time: walk, wave, talk
 *   agent                one of a crowd: a disc on the ground, with a goal
 *   flow field           directions of the shortest ways to one goal, by cells of the ground
 *   tick                 1/48,000 second, of time and nothing else
 *   sample rate          frames per second that a clip was made with
 *   playback speed       how fast a track runs: 1 is as made
 *   update rate          how often an instance is posed: every frame, 30, 15 or 8 times a second
 *   cached segment       decoded frames of a clip, an entry of the clip cache
 *   LOD level            a version of a mesh or skeleton; 0 is the full one, higher ones are coarser
 *   slot                 a place in a fixed pool, held by an instance
 *   radius               the farthest that something reaches from its centre, or is moved
 *
 * A noh_clip is a compressed clip that has been opened, a noh_clip_entry a clip of a set, a noh_pack_clip one of a
 * pack. */

#endif
