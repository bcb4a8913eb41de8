/* bones.h: a skeleton drawn as bones: an octahedron from each joint's parent to the joint,
 * and a small one at the joint. Every chain between two forks has a colour of its own. */
#ifndef NOH_NOH_DRAW_BONES_H
#define NOH_NOH_DRAW_BONES_H

#include "camera.h"
#include "gpu/gpu.h"
#include "noh/clip.h"
#include "noh/low_gl.h"

typedef struct bones {
    gpu *g;
    GLuint program, vertex_array, buffer;
    GLint u_view_projection, u_key;
    uint32_t joint_count;
    float *vertices; /* [joint_count][2 octahedra][24 corners][9] */
} bones;

/* For a skeleton of that many joints. Prints an error and returns an exit code; 0 on success. */
int bones_open(bones *b, gpu *g, uint32_t joint_count);
void bones_close(bones *b);

/* Draw into the bound framebuffer, with a depth test.
 * shapes  matrices[joint_count][12], rows of 3 x 4: the joints in the world */
void bones_draw(bones *b, const noh_skeleton *skeleton, const float *matrices, const noh_gl_camera *camera);

/* The bounds of the joints. */
bounds bones_bounds(uint32_t joint_count, const float *matrices);

#endif
