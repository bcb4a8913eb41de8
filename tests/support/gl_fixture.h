/* gl_fixture.h: a GL context, a set of morphing meshes in it, and what the GPU must hold according to the CPU. */
#ifndef NOH_TESTS_SUPPORT_GL_FIXTURE_H
#define NOH_TESTS_SUPPORT_GL_FIXTURE_H

#include "support.h"

#include "gpu/readback.h"
#include "gl/device/gl_memory_internal.h"
#include "noh/pack.h"
#include "noh/gl_device.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

/* One context for the whole program, of EGL or of the driver that NOH_TEST_DRIVER names (tests/gl/matrix.sh); skips the
 * test where there is none. Starts with no GL errors counted. Its caps tell of one sample, because four take a software
 * rasteriser half of a test's time; set samples_max to 4, which every driver has, for a test of edges. */
gpu *fixture_gpu(void);
/* Close it at the end. Fits cmocka's group teardown. */
int fixture_tear_down(void **state);

/* Calls of glGetUniformLocation so far: a draw makes none. */
unsigned fixture_uniform_lookups(void);

/* Fails where glGetError or the debug callback has reported an error since fixture_gpu. */
void fixture_expect_no_errors(void);

/* Every path in both formats. */
typedef struct fixture_way {
    noh_morph_path path;
    noh_accumulate accumulate;
} fixture_way;
#define FIXTURE_WAYS 11
extern const fixture_way fixture_ways[FIXTURE_WAYS];

/* "mrt f16" */
const char *fixture_way_name(fixture_way way);

/* Three meshes of different widths, one of them without targets, in one pack. */
#define FIXTURE_MESHES 3u
#define FIXTURE_BARE 1u /* the one without targets */
typedef struct fixture_meshes {
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh meshes[FIXTURE_MESHES];
} fixture_meshes;
void fixture_meshes_open(fixture_meshes *f);
void fixture_meshes_close(fixture_meshes *f);

/* A noh_gl_morph in exact memory. `caps` may differ from what the GPU has. */
typedef struct fixture_morph {
    void *memory;
    noh_gl_caps caps;
    noh_gl_morph_plan plan;
    noh_gl_morph *morph;
    noh_gl_ledger ledger;
    const noh_gl_morph_desc *desc;
    float **weights;  /* [instance], what was set last */
    uint32_t *levels; /* [instance], likewise */
} fixture_morph;
void fixture_morph_open(fixture_morph *m, const noh_gl_morph_desc *desc, const noh_gl_caps *caps);
void fixture_morph_close(fixture_morph *m);

/* The mesh that an instance shows. */
const noh_mesh *fixture_mesh_of(const fixture_morph *m, uint32_t instance);

/* The same at the level that was set for it. */
noh_mesh fixture_view_of(const fixture_morph *m, uint32_t instance);

/* Set an instance's level and remember it. */
void fixture_set_level(fixture_morph *m, uint32_t instance, uint32_t level);

/* Set an instance's weights and remember them. */
void fixture_set(fixture_morph *m, uint32_t instance, const float *weights);
void fixture_set_random(fixture_morph *m, uint32_t instance, test_random *r);

/* The layers that path and format should give for the remembered weights: layers[3][...], to be freed. *exact is 0
 * where this driver's rounding is not modelled. */
float *fixture_reference(const fixture_morph *m, uint32_t instance, int *exact);

/* Read one instance's accumulator back and compare it with the reference: every value equal,
 * or within the pack's bound where the rounding is not modelled. */
void fixture_expect_instance(const fixture_morph *m, uint32_t instance);
void fixture_expect_all(const fixture_morph *m);

/* The values that an instance's accumulator holds: layers[3][...] of its view, to be freed. */
float *fixture_layers(const fixture_morph *m, uint32_t instance);

/* The n-th ```glsl block of a file, to be freed; skips the test where the file is not. */
char *test_example(const char *path, int n);

/* A file of shaders_es/ behind its #version, to be freed; skips the test where the file is not. */
char *test_shader_body(const char *path);

/* A square of pixels to draw to, RGBA8 with depth, cleared to zeros and bound. */
typedef struct fixture_frame {
    noh_gl_ledger ledger; /* its own, and what is made while it is open */
    noh_gl_renderbuffer color, depth;
    GLuint framebuffer;
    uint32_t side;
} fixture_frame;
void fixture_frame_open(fixture_frame *f, uint32_t side);
/* rgba[side][side][4], the lowest row first, to be freed. */
uint8_t *fixture_frame_read(const fixture_frame *f);
/* Everything that its ledger counts must have been deleted. */
void fixture_frame_close(fixture_frame *f);

#endif
