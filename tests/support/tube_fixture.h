/* tube_fixture.h: copies of a mesh with joints and targets, morphed, posed and placed, and drawn in every way. */
#ifndef NOH_TESTS_SUPPORT_TUBE_FIXTURE_H
#define NOH_TESTS_SUPPORT_TUBE_FIXTURE_H

#include "gl_fixture.h"
#include "noh/pack.h"
#include "noh/gl_device.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

#define COPIES 2u

/* The mesh, and all that it takes to draw copies of it. */
typedef struct tube {
    noh_mesh mesh;
    noh_gl_mesh gl;
    noh_gl_morph_desc morph_desc;
    fixture_morph morph;
    noh_gl_skin_plan plan;
    void *memory;
    noh_gl_skin *skin;
    noh_gl_ledger ledger;
} tube;

/* Upload, morph and pose the copies of a mesh of three targets, on the morph path cpu. */
void tube_open(tube *t, const noh_mesh *mesh, noh_palette_mode mode);
/* The same with a path, with layers of tangents or without, and with capabilities that may differ from what the GPU
 * has; NULL: what it has. */
void tube_open_with(tube *t, const noh_mesh *mesh, noh_palette_mode mode, noh_morph_path path, int without_tangents,
                    const noh_gl_caps *caps);
void tube_close(tube *t);

/* Pose and place the copies, as they are when opened. */
void tube_pose(tube *t);

/* Sees all copies. */
extern const noh_gl_camera tube_camera;

typedef enum draw_kind { RIGID, SKINNED, FEWER, CROWD } draw_kind;

/* Draw a pass of the copies: without joints, with them, with fewer influences, or as a crowd, which needs palettes in a
 * texture. gl: the mesh, or one like it. */
void tube_draw(noh_gl_renderer *r, const tube *t, const noh_gl_mesh *gl, draw_kind kind, const noh_gl_lod *drawn,
               int pass);

#endif
