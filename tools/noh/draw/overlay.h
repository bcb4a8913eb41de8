/* overlay.h: a figure's meshes once more, morphed and skinned on the CPU: their edges over the picture, or their skin
 * as colours in its place.
 *
 *   overlay_open / overlay_close
 *   overlay_draw          into the framebuffer that is bound, after the figure, or instead of it
 *   overlay_joint         a joint by name; overlay_main_joint the one that moves the most vertices
 *   overlay_joint_color   of OVERLAY_JOINTS
 *   overlay_heat          of OVERLAY_WEIGHTS */
#ifndef NOH_NOH_DRAW_OVERLAY_H
#define NOH_NOH_DRAW_OVERLAY_H

#include "figure.h"
#include "noh/low_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum overlay_kind {
    OVERLAY_WIREFRAME, /* the edges of the shown level */
    OVERLAY_NORMALS,   /* a line for the normal of each vertex */
    OVERLAY_JOINTS,    /* surfaces: the colours of the joints that move a vertex, by weight. Rigid: grey */
    OVERLAY_WEIGHTS    /* surfaces: the weight of one joint, from dark blue over green and yellow to red */
} overlay_kind;

typedef struct overlay {
    gpu *g;
    GLuint program, vertex_array, vertex_buffer, index_buffer;
    GLint u_view_projection, u_key, u_nearer, u_shaded;
} overlay;

/* Print an error and return an exit code; 0 on success. */
int overlay_open(overlay *o, gpu *g);
void overlay_close(overlay *o);
/* joint  of OVERLAY_WEIGHTS, of the first kind; NOH_NONE: no joint */
int overlay_draw(overlay *o, const figure *f, overlay_kind kind, uint32_t joint, const noh_gl_camera *camera);

/* name  NULL: overlay_main_joint. Prints an error if the joint or the skeleton is missing. */
int overlay_joint(const figure *f, const char *name, uint32_t *joint);
/* NOH_NONE: nothing is skinned. */
uint32_t overlay_main_joint(const figure *f);

/* Linear light, 0..1. Neighbouring joints differ. */
void overlay_joint_color(uint32_t joint, float rgb[3]);
void overlay_heat(float weight, float rgb[3]);

#ifdef __cplusplus
}
#endif
#endif
