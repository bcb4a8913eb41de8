/* zoom.h (private to cmd_zoom.c, zoom_*.c): a camera that goes out slowly and comes back, and what shows of the levels
 * of detail that are chosen on its way.
 *
 *   zoom_path       where the camera is, and what is chosen there
 *   zoom_target     pictures
 *   zoom_compare    how far two pictures differ
 *   zoom_surface    how far the shown level's surface is from the full one, in the pose shown
 *   zoom_run        all frames, measured
 *   zoom_strip      the picture of a zoom */
#ifndef NOH_TOOL_ZOOM_H
#define NOH_TOOL_ZOOM_H

#include "scene_detail.h"
#include "camera.h"
#include "load.h"

#define ZOOM_TICKS 800    /* of a frame: sixty a second */
#define ZOOM_FINE 4u      /* silhouettes are compared in pictures that are so many times larger */

/* ---- where the camera is, what is chosen ---- */

/* How often an item entered each level, on the way out and on the way in. */
typedef struct zoom_entries {
    uint32_t entered[2][NOH_LEVELS_MAX];
} zoom_entries;

typedef struct zoom_path {
    scene_detail detail;
    zoom_entries *entries; /* [detail.item_count] */
    noh_detail_settings settings;
    orbit at;          /* its distance is the frame's */
    double near, far;  /* from the camera to the middle of the scene */
    uint32_t frames, side; /* pictures are square */
} zoom_path;

/* near, far, side: 0 for a way on which every level is the one chosen for a while, in pictures that hold the scene.
 * Prints an error and returns an exit code; 0 on success. */
int zoom_path_open(zoom_path *p, const pack_file *file, const scene *s, const noh_detail_settings *settings, double near, double far,
                   uint32_t side, uint32_t frames);
void zoom_path_close(zoom_path *p);

/* Put the camera to a frame's place, nearer or farther by a factor. Returns pixels per metre at the scene's nearest point. */
float zoom_path_place(zoom_path *p, uint32_t frame, double factor);

/* Choose for a frame; counts levels entered. */
void zoom_path_choose(zoom_path *p, uint32_t frame, float pixels_per_metre);

/* The most times that any level was entered on one way, and how many levels were entered on the way out and in. */
uint32_t zoom_path_most_entered(const zoom_path *p);
uint32_t zoom_path_entered(const zoom_path *p, int way);

/* The same way from its start, seen from distances that jump by up to `jitter` of themselves from frame to frame, with
 * levels that change at once: zoom_path_most_entered of that. */
uint32_t zoom_path_jitter(zoom_path *p, double jitter);

/* ---- pictures ---- */

typedef struct zoom_picture {
    uint8_t *rgba;  /* [size][size][4], the lowest row first; alpha is 0 where nothing is */
    uint32_t size;  /* of the middle of the target, which alone is drawn */
} zoom_picture;

typedef struct zoom_target {
    gpu *g;
    uint32_t side, size; /* size: of the middle */
    GLuint framebuffer, color, depth, resolved_framebuffer, resolved_color;
} zoom_target;

/* samples: 0, or of each pixel. Prints an error and returns an exit code; 0 on success: as all below. */
int zoom_target_open(zoom_target *t, gpu *g, uint32_t side, uint32_t samples);
void zoom_target_close(zoom_target *t);
/* The share of the height that the scene fills. */
void zoom_target_frame(zoom_target *t, double share);
/* out has room for all of the target. */
int zoom_target_draw(zoom_target *t, load *l, const noh_gl_camera *camera, zoom_picture *out);

/* ---- comparing ---- */

/* The largest distance from a pixel that is covered in one picture alone to the nearest that the other covers; and from
 * one that is not covered in one alone to the nearest such one of the other. Pixels; no more than ZOOM_FAR. */
#define ZOOM_FAR 64
typedef struct zoom_shift {
    double covered, uncovered;
} zoom_shift;
zoom_shift zoom_compare_silhouettes(const zoom_picture *a, const zoom_picture *b);

/* The mean difference of the colours of all pixels that one of both covers, of 255; of 32 x 32 pixels where they are
 * fewer: smaller things are seen as a whole. Their middles lie on each other. */
double zoom_compare_colors(const zoom_picture *a, const zoom_picture *b);

/* ---- surfaces ---- */

/* Distances that were measured, by item, level and weights. */
typedef struct zoom_surface {
    struct zoom_surface_entry *entries;
    uint32_t count;
} zoom_surface;

/* In metres, of one item at a level with the weights that `kept` has to the full one with those of `full`; both ways.
 * Prints an error and returns an exit code; 0 on success. */
int zoom_surface_distance(zoom_surface *z, const pack_file *file, const scene *full, const scene *kept, uint32_t item, uint32_t level,
                          double *metres);
void zoom_surface_close(zoom_surface *z);

/* ---- all frames ---- */

/* What may show at most. */
#define ZOOM_SLACK 1.25 /* of the knob: how far silhouettes and surfaces may be off */
#define ZOOM_POP 1.0    /* of 255: what detail may change in one frame, in the mean (zoom_compare_colors): the least that 8 bits show */

/* The worst of all frames. */
typedef struct zoom_result {
    double silhouette_px;    /* zoom_shift.covered */
    double hole_px;          /* zoom_shift.uncovered: a slit that is narrower than the error may close, however long it is: no bound */
    double position_px;      /* from the shown surface to the full one, in the pose shown */
    double claimed_px;       /* noh_detail_error_pixels */
    double pop;              /* what a change of detail changes in the picture of a camera that stands; of 255 */
    double excess;           /* by how much a picture with levels changes more than a full one from frame to frame; of 255 */
    double zoom_change;      /* the mean of all frames: what a full one changes; of 255 */
    uint32_t entered[2], most_entered; /* levels on the way out and in, and the most times that one of them was */
    uint32_t most_entered_shaken;      /* zoom_path_jitter */
    uint32_t targets_left_out;         /* the most at once */
} zoom_result;

int zoom_result_ok(const zoom_result *r, double pixels);

/* What a zoom is measured with. */
typedef struct zoom {
    const pack_file *file;
    gpu *g;
    zoom_path path;
    const scene *full;  /* in its pose, with all weights */
    scene *kept;        /* the same, less what is left out */
    uint32_t every;     /* silhouettes are measured in each frame whose number it divides, and where detail changes */
    load full_load, kept_load;
    load_detail *before; /* [item_count] of the frame before */
    zoom_target fine, seen;
    zoom_picture fine_full, fine_kept, seen_full[2], seen_kept[2], standing; /* of two frames: this one's at frame % 2 */
    zoom_surface surface;
    struct zoom_strip *strip;  /* NULL: none is wanted */
    zoom_result worst;
} zoom;

/* z->file, g, path, full, kept and every are set; strip before zoom_run. */
int zoom_run_open(zoom *z);
void zoom_run_close(zoom *z);
int zoom_run(zoom *z, double jitter);

/* ---- the picture of it ---- */

#define ZOOM_STRIP 12u /* frames of the way out */

typedef struct zoom_strip {
    load colors;           /* as kept_load, in the colours of the levels */
    zoom_picture pictures[3][ZOOM_STRIP]; /* with levels, full, colours */
    char labels[ZOOM_STRIP][16];
    uint32_t count;
} zoom_strip;

int zoom_strip_open(zoom_strip *s, const zoom *z);
void zoom_strip_close(zoom_strip *s);
/* After the frame was drawn: keep it if it is one of those. */
int zoom_strip_take(zoom_strip *s, zoom *z, const noh_gl_camera *camera, uint32_t frame);
int zoom_strip_write(const zoom_strip *s, const char *path);

#endif
