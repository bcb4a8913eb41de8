/* zoom.h (private to cmd_zoom.c, zoom_*.c): a camera moves slowly out and back, and the visible differences of the LOD
 * levels chosen on the way are measured.
 *
 *   zoom_subject    a pack in a pose, on a stage
 *   zoom_path       the camera, and the levels entered
 *   zoom_target     pictures
 *   zoom_compare    the difference of two pictures
 *   zoom_surface    distance of the drawn level's surface from the full one, in the pose
 *   zoom_run        all frames
 *   zoom_strip      a picture of several frames
 *
 * The pack is on three stages: in full detail; with levels chosen by error, as in games; and the same without a
 * driver and without fades, with a camera that shakes. The scale, pixels per metre, is the stage's, at the
 * nearest point of the sphere that holds an actor in all its clips. */
#ifndef NOH_NOH_ZOOM_ZOOM_H
#define NOH_NOH_ZOOM_ZOOM_H

#include "draw/figure.h"
#include "noh/base.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#define ZOOM_TICKS 800 /* per frame: 60 frames a second */
#define ZOOM_FINE 4u   /* silhouettes are compared in pictures this many times larger */

/* ---- the subject ---- */

typedef struct zoom_subject {
    figure_desc desc; /* lod: all fields are set, because the path is planned by them. by_error is set by openings */
    const option_list *clips, *weights;
    double time_s;
} zoom_subject;

/* A figure in a fixed pose while time runs. g: NULL: nothing is drawn. Prints an error and returns
 * an exit code; 0 on success: as all below. */
int zoom_subject_open(const zoom_subject *s, gpu *g, int by_error, uint32_t fade_ticks, figure *f);

/* ---- the camera, the levels entered ---- */

/* How many times an actor entered each level, on the way out and on the way back. */
typedef struct zoom_entries {
    uint32_t entered[2][NOH_LOD_LEVELS_MAX];
    uint32_t level; /* of the frame before */
    int seen;
} zoom_entries;

typedef struct zoom_path {
    figure shaken; /* see zoom_path_jitter; also used to plan the path */
    zoom_entries entries[NOH_STAGE_KINDS_MAX];
    orbit at;              /* its distance is the frame's */
    double reach;          /* distance by which the stage's nearest point is nearer than the middle of the scene */
    double near, far;      /* from the camera to the middle of the scene */
    uint32_t frames, side; /* pictures are square */
} zoom_path;

/* near, far, side: 0 for a path that shows every level for a while, in pictures that hold the scene. */
int zoom_path_open(zoom_path *p, const zoom_subject *s, double near, double far, uint32_t side, uint32_t frames);
void zoom_path_close(zoom_path *p);

/* Move the camera to its place in a frame: its distance changes by the same factor in every frame, and by one more. The
 * distance is corrected for the difference between the stage's sphere and the scene. */
void zoom_path_place(zoom_path *p, uint32_t frame, double factor);

/* zoom_path_place, and a step and a frame of a figure there. View 0 is this frame's; view 1, which requests no
 * detail, is the next frame's, from which it draws this frame's levels. */
int zoom_path_show(zoom_path *p, uint32_t frame, double factor, figure *f);

/* Count the levels that a figure entered in a frame. */
void zoom_path_count(zoom_path *p, uint32_t frame, const figure *f);

/* The most times that any level was entered on one way; the number of levels entered on the way out (0) and back (1).
 */
uint32_t zoom_path_most_entered(const zoom_path *p);
uint32_t zoom_path_entered(const zoom_path *p, int way);

/* *most: zoom_path_most_entered of the same path with distances that jump by up to a share of `jitter` from frame to
 * frame, and without fades. No entries are left. */
int zoom_path_jitter(zoom_path *p, double jitter, uint32_t *most);

/* ---- pictures ---- */

typedef struct zoom_picture {
    uint8_t *rgba; /* [size][size][4], bottom row first; alpha is 0 where nothing was drawn */
    uint32_t size; /* side of the centre of the target: only that is drawn */
} zoom_picture;

typedef struct zoom_target {
    gpu *g;
    uint32_t side, size; /* size: of the middle */
    GLuint framebuffer, color, depth, resolved_framebuffer, resolved_color;
} zoom_target;

/* samples: per pixel; 0 for none. */
int zoom_target_open(zoom_target *t, gpu *g, uint32_t side, uint32_t samples);
void zoom_target_close(zoom_target *t);
/* Draw only the centre of the target, this share of its side. */
void zoom_target_frame(zoom_target *t, double share);
/* A view of the figure's last frame. shader: NULL: the library's. *out has room for the whole target. */
int zoom_target_draw(zoom_target *t, const figure *f, uint32_t view, noh_stage_shader *shader, zoom_picture *out);

/* ---- comparing ---- */

/* How far two silhouettes differ, both ways, as a Hausdorff distance in pixels, at most ZOOM_FAR. covered: from a pixel
 * that one picture covers and the other does not, to the nearest that the other covers; uncovered: likewise of
 * background. */
#define ZOOM_FAR 64
typedef struct zoom_shift {
    double covered, uncovered;
} zoom_shift;
zoom_shift zoom_compare_silhouettes(const zoom_picture *a, const zoom_picture *b);

/* Mean colour difference, 0 to 255, of the pixels that either picture covers; at least 32 x 32 are counted, since the
 * eye averages over smaller areas. The pictures are aligned at their centres. */
double zoom_compare_colors(const zoom_picture *a, const zoom_picture *b);

/* ---- surfaces ---- */

/* A cache of measured distances, by mesh, level, joints posed and weights. */
typedef struct zoom_surface {
    struct zoom_surface_entry *entries;
    uint32_t count;
} zoom_surface;

/* One mesh of a figure. */
typedef struct zoom_mesh {
    uint32_t kind, index; /* as figure_deform takes them */
    uint32_t level, joint_count;
} zoom_mesh;

/* The distance in metres, both ways, between a mesh of `kept` at a level and the mesh of `full`, each in its figure's
 * last pose, but with all influences. */
int zoom_surface_distance(zoom_surface *z, const figure *full, const figure *kept, const zoom_mesh *at, double *metres);
void zoom_surface_close(zoom_surface *z);

/* ---- all frames ---- */

/* Bounds. */
#define ZOOM_SLACK 1.25 /* times the allowed error in pixels: of silhouettes and surfaces */
/* Of 255, as zoom_compare_colors measures: the largest effect of a level change in a frame, the least 8-bit step. */
#define ZOOM_POP 1.02

/* The worst of all frames. */
typedef struct zoom_result {
    double silhouette_px; /* zoom_shift.covered */
    double hole_px;     /* zoom_shift.uncovered; has no bound: a slit narrower than the error may close along its whole
                           length */
    double position_px; /* from the drawn surface to the full one, in the pose */
    double claimed_px;  /* noh_actor_detail.error_m, in pixels */
    double pop;         /* effect of a change of level on the picture with a camera at rest; of 255 */
    double excess; /* additional change of pictures with levels from frame to frame, compared with full ones; of 255 */
    double zoom_change;                /* mean change of the full pictures from frame to frame; of 255 */
    uint32_t entered[2], most_entered; /* levels entered on the way out and back; the most times that one was */
    uint32_t most_entered_shaken;      /* zoom_path_jitter */
    uint32_t targets_left_out;         /* at once, at most */
} zoom_result;

int zoom_result_ok(const zoom_result *r, double pixels);

/* The state of a measurement. */
typedef struct zoom {
    const zoom_subject *subject;
    gpu *g;
    zoom_path path;
    figure full, kept; /* in full detail, and with chosen levels */
    uint32_t every;    /* silhouettes are measured in every n-th frame, and where a level changes */
    noh_actor_detail details[NOH_STAGE_KINDS_MAX]; /* of `kept` in this frame */
    float *weights;                                /* of all its meshes, one after another */
    zoom_target fine, seen;
    zoom_picture fine_full, fine_kept, seen_full[2], seen_kept[2]; /* two frames each; the current one is frame % 2 */
    zoom_picture standing;                                         /* the frame before, from this frame's place */
    zoom_surface surface;
    struct zoom_strip *strip; /* NULL: none */
    zoom_result worst;
} zoom;

/* The caller sets z->subject, g, path and every before, and strip before zoom_run. */
int zoom_run_open(zoom *z);
void zoom_run_close(zoom *z);
int zoom_run(zoom *z, double jitter);

/* ---- the picture of it ---- */

#define ZOOM_STRIP 12u /* frames of the way out */

typedef struct zoom_strip {
    noh_stage_shader *shader; /* of zoom.kept, in the colours of levels */
    void *shader_memory;
    zoom_picture pictures[3][ZOOM_STRIP]; /* with levels, full, colours */
    char labels[ZOOM_STRIP][16];
    uint32_t count;
} zoom_strip;

int zoom_strip_open(zoom_strip *s, const zoom *z); /* after zoom_run_open */
/* Before zoom_run_close. */
void zoom_strip_close(zoom_strip *s);
/* After a frame was drawn: keep it if the strip shows it. */
int zoom_strip_take(zoom_strip *s, zoom *z, uint32_t frame);
int zoom_strip_write(const zoom_strip *s, const char *path);

#endif
