/* zoom.h (private to cmd_zoom.c, zoom_*.c): a camera moves slowly out and back, and what can be seen of the LOD levels
 * chosen on the way is measured.
 *
 *   zoom_path       the camera, and the levels chosen
 *   zoom_target     pictures
 *   zoom_compare    how far two pictures differ
 *   zoom_surface    distance of the drawn level's surface from the full one, in the pose
 *   zoom_run        all frames
 *   zoom_strip      a picture of frames of all of it */
#ifndef NOH_NOH_ZOOM_ZOOM_H
#define NOH_NOH_ZOOM_ZOOM_H

#include "draw/scene_lod.h"
#include "draw/camera.h"
#include "draw/load.h"

#define ZOOM_TICKS 800 /* per frame: 60 frames a second */
#define ZOOM_FINE 4u   /* silhouettes are compared in pictures this many times larger */

/* ---- the camera, the levels chosen ---- */

/* How many times an item entered each level, on the way out and on the way back. */
typedef struct zoom_entries {
    uint32_t entered[2][NOH_LOD_LEVELS_MAX];
} zoom_entries;

typedef struct zoom_path {
    scene_lod lod;
    zoom_entries *entries; /* [lod.item_count] */
    noh_lod_settings settings;
    orbit at;              /* its distance is the frame's */
    double near, far;      /* from the camera to the middle of the scene */
    uint32_t frames, side; /* pictures are square */
} zoom_path;

/* near, far, side: 0 for a path on which every level is chosen for a while, in pictures that hold the scene.
 * Prints an error and returns an exit code; 0 on success. */
int zoom_path_open(zoom_path *p, const pack_file *file, const scene *s, const noh_lod_settings *settings, double near,
                   double far, uint32_t side, uint32_t frames);
void zoom_path_close(zoom_path *p);

/* Move the camera to its place in a frame, nearer or farther by a factor. Returns pixels per metre at the scene's
 * nearest point. */
float zoom_path_place(zoom_path *p, uint32_t frame, double factor);

/* Choose the levels of a frame; count those entered. */
void zoom_path_choose(zoom_path *p, uint32_t frame, float pixels_per_metre);

/* The most times that any level was entered on one way; the number of levels entered on the way out (0) and back (1).
 */
uint32_t zoom_path_most_entered(const zoom_path *p);
uint32_t zoom_path_entered(const zoom_path *p, int way);

/* zoom_path_most_entered of the same path, restarted, with distances that jump by up to a share of `jitter` from frame
 * to frame, and without fades. */
uint32_t zoom_path_jitter(zoom_path *p, double jitter);

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

/* samples: per pixel; 0 for none. Prints an error and returns an exit code; 0 on success: as all below. */
int zoom_target_open(zoom_target *t, gpu *g, uint32_t side, uint32_t samples);
void zoom_target_close(zoom_target *t);
/* Draw only the centre of the target, this share of its side. */
void zoom_target_frame(zoom_target *t, double share);
/* *out has room for the whole target. */
int zoom_target_draw(zoom_target *t, load *l, const noh_gl_camera *camera, zoom_picture *out);

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
 * eye takes smaller things as a whole. The pictures are aligned at their centres. */
double zoom_compare_colors(const zoom_picture *a, const zoom_picture *b);

/* ---- surfaces ---- */

/* A cache of measured distances, by item, level and weights. */
typedef struct zoom_surface {
    struct zoom_surface_entry *entries;
    uint32_t count;
} zoom_surface;

/* The distance in metres, both ways, between an item at a level with the weights of `kept` and the full mesh with those
 * of `full`. Prints an error and returns an exit code; 0 on success. */
int zoom_surface_distance(zoom_surface *z, const pack_file *file, const scene *full, const scene *kept, uint32_t item,
                          uint32_t level, double *metres);
void zoom_surface_close(zoom_surface *z);

/* ---- all frames ---- */

/* Bounds. */
#define ZOOM_SLACK 1.25 /* times the allowed error in pixels: of silhouettes and surfaces */
#define ZOOM_POP                                                                                                      \
    1.0 /* of 255, as zoom_compare_colors measures: what a level change may do in one frame; the least step of 8 bits \
         */

/* The worst of all frames. */
typedef struct zoom_result {
    double silhouette_px; /* zoom_shift.covered */
    double hole_px;     /* zoom_shift.uncovered; has no bound: a slit narrower than the error may close along its whole
                           length */
    double position_px; /* from the drawn surface to the full one, in the pose */
    double claimed_px;  /* noh_lod_error_pixels */
    double pop;         /* what a change of level changes in the picture of a camera at rest; of 255 */
    double excess;      /* how much more than full pictures those with levels change from frame to frame; of 255 */
    double zoom_change; /* mean change of the full pictures from frame to frame; of 255 */
    uint32_t entered[2], most_entered; /* levels entered on the way out and back; the most times that one was */
    uint32_t most_entered_shaken;      /* zoom_path_jitter */
    uint32_t targets_left_out;         /* at once, at most */
} zoom_result;

int zoom_result_ok(const zoom_result *r, double pixels);

/* What a zoom is measured with. */
typedef struct zoom {
    const pack_file *file;
    gpu *g;
    zoom_path path;
    const scene *full; /* posed, with all weights */
    scene *kept;       /* the same without targets left out */
    uint32_t every;    /* silhouettes are measured in every n-th frame, and where a level changes */
    load full_load, kept_load;
    load_lod *before; /* [item_count] of the frame before */
    zoom_target fine, seen;
    zoom_picture fine_full, fine_kept, seen_full[2], seen_kept[2],
        standing; /* two frames each; the current one is frame % 2 */
    zoom_surface surface;
    struct zoom_strip *strip; /* NULL: none */
    zoom_result worst;
} zoom;

/* The caller sets z->file, g, path, full, kept and every before, and strip before zoom_run. */
int zoom_run_open(zoom *z);
void zoom_run_close(zoom *z);
int zoom_run(zoom *z, double jitter);

/* ---- the picture of it ---- */

#define ZOOM_STRIP 12u /* frames of the way out */

typedef struct zoom_strip {
    load colors;                          /* as kept_load, coloured by level */
    zoom_picture pictures[3][ZOOM_STRIP]; /* with levels, full, colours */
    char labels[ZOOM_STRIP][16];
    uint32_t count;
} zoom_strip;

int zoom_strip_open(zoom_strip *s, const zoom *z);
void zoom_strip_close(zoom_strip *s);
/* After a frame was drawn: keep it if the strip shows it. */
int zoom_strip_take(zoom_strip *s, zoom *z, const noh_gl_camera *camera, uint32_t frame);
int zoom_strip_write(const zoom_strip *s, const char *path);

#endif
