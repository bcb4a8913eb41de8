/* view_pad.h: a blend space with a point to drag: clips at places of a square all play, weighted by the point's
 * position.
 *
 *   view_pad_toggle      put a clip on the pad, or take it off
 *   view_pad_take        a blend space of one of the pack's graphs
 *   view_pad_play        start all of its clips, view_pad_stop
 *   view_pad_move        the point; view_pad_move_clip a clip
 *   view_pad_frame       stop if another clip took the layer
 *
 * The clips play together on the body layer, in one sync group. */
#ifndef NOH_NOH_VIEW_VIEW_PAD_H
#define NOH_NOH_VIEW_VIEW_PAD_H

#include "view/view_model.h"
#include "noh/base.h"

#define VIEW_PAD_CLIPS NOH_LAYER_TRACKS_MAX

typedef struct view_pad {
    uint32_t count;
    uint32_t clips[VIEW_PAD_CLIPS]; /* of the model's list; all can play on `kind` */
    int32_t speeds[VIEW_PAD_CLIPS]; /* as in noh_play; of a graph's blend space its own */
    uint32_t kind;
    float points[VIEW_PAD_CLIPS][2]; /* -1..1, y up */
    uint32_t triangle_count;         /* of the noh_blend_space_2d that they make */
    uint8_t triangles[NOH_BLEND_SPACE_TRIANGLES_MAX][3];
    float at[2];
    float weights[VIEW_PAD_CLIPS];
    uint32_t tracks[VIEW_PAD_CLIPS]; /* of the kind's controller, while it plays */
    int plays, synced;
} view_pad;

/* Whether a clip is on the pad, and whether a track is the pad's. */
int view_pad_has(const view_pad *pad, uint32_t clip);
int view_pad_plays(const view_pad *pad, uint32_t kind, uint32_t track);

/* These print an error and return an exit code; 0 on success. */
int view_pad_toggle(view_pad *pad, view_model *m, uint32_t clip);
int view_pad_play(view_pad *pad, view_model *m);

void view_pad_stop(view_pad *pad, view_model *m);
void view_pad_move(view_pad *pad, view_model *m, float x, float y);
void view_pad_move_clip(view_pad *pad, view_model *m, uint32_t i, float x, float y);
void view_pad_frame(view_pad *pad, const view_model *m);

/* The n-th blend space of the pack's graphs whose children are clips of the model: "graph / node" to name. Returns 0
 * past the last. */
int view_pad_space(const view_model *m, uint32_t n, char *name, size_t bytes);
int view_pad_take(view_pad *pad, view_model *m, uint32_t n);

#endif
