/* gl_skin_fixture.h: an asset's skinned meshes on the GPU, posed at random, and the CPU's result for the same poses. */
#ifndef NOH_TESTS_SUPPORT_GL_SKIN_FIXTURE_H
#define NOH_TESTS_SUPPORT_GL_SKIN_FIXTURE_H

#include "gl_fixture.h"

#include "convert/convert.h"
#include "noh/pack.h"
#include "noh/gl_device.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

/* A pack of an asset without its clips, built once per asset and options and kept until the program ends. Skips the
 * test where the asset is not. */
const noh_pack *fixture_skinned_pack(const char *asset, const skin_options *options);

typedef struct fixture_skin_desc {
    const char *asset;
    skin_options options;
    uint32_t copies; /* instances of each mesh; 0: 1 */
    noh_palette_mode mode;
} fixture_skin_desc;

typedef struct fixture_skin {
    const noh_pack *pack;
    uint32_t mesh_count, copies;
    noh_mesh *meshes;
    noh_gl_mesh *gl_meshes;
    uint32_t *counts;
    noh_gl_morph_desc morph_desc;
    fixture_morph morph;
    void *memory;
    noh_gl_skin_plan plan;
    noh_gl_skin *skin;
    noh_gl_ledger ledger; /* of skin and meshes; morph has its own */
    float **matrices;     /* [instance], what was set last; NULL for rigid meshes */
} fixture_skin;
void fixture_skin_open(fixture_skin *f, const fixture_skin_desc *desc);
void fixture_skin_close(fixture_skin *f);

/* Turn and stretch every joint at random, set random weights, and send both. */
void fixture_skin_pose(fixture_skin *f, test_random *r);

/* One instance's vertices by the CPU: [vertex_count], to be freed. */
noh_vertex *fixture_skin_reference(const fixture_skin *f, uint32_t instance);

/* The same by the GPU, each vertex through the shader that draws: [crowd, at least 1][vertex_count], to be freed.
 * influences: as in noh_gl_skin_binding. crowd: as in readback_skinned. */
readback_vertex *fixture_skin_read(const fixture_skin *f, uint32_t mesh, uint32_t copy, uint32_t influences,
                                   uint32_t crowd);

/* The largest distance of positions, and the diagonal of the reference's box. */
typedef struct fixture_error {
    double position, normal, tangent, box;
    uint32_t handedness; /* vertices whose handedness differs */
} fixture_error;
fixture_error fixture_skin_compare(const readback_vertex *got, const noh_vertex *expected, uint32_t count);

/* Positions within 2e-6 of the box, normals and tangents within 2e-5. */
void fixture_expect_close(const fixture_error *e, const char *what);

#endif
