/* clip_encoder.h (private to clip_*.c): types shared by the parts of the encoder.
 *
 * clip_prepare.c  raw clip to double, in one hemisphere; object space
 * clip_analyse.c  finds animated tracks, levers, references, mixes
 * clip_basis.c    which transform
 * clip_search.c   which way coefficients are rounded
 * clip_fit.c      one track of one segment: the largest step that holds the bound
 * clip_segment.c  one segment: tracks in order, parents first, in a closed loop
 * clip_write.c    bits
 * clip_certify.c  decodes and measures the result; chooses the segments to split
 * clip_encode.c   calls these in order, and tightens where the bound does not hold */
#ifndef NOH_CONVERT_CODEC_CLIP_ENCODER_H
#define NOH_CONVERT_CODEC_CLIP_ENCODER_H

#include "motion/clip/clip_coefs_internal.h"
#include "motion/clip/clip_internal.h"
#include "motion/clip/clip_synth_internal.h"
#include "clip_encode.h"
#include "clip_space.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#define ENC_FRAMES_MAX NOH_CLIP_SEGMENT_FRAMES_MAX
#define ENC_PARTS 8     /* errors are measured at eighths of a frame */
#define ENC_RIG_MAX 48u /* points of a joint's rigid descendants that are checked */
#define ENC_DROP 0.15   /* a track whose effect stays below this share of the bound is constant */
#define ENC_NONE 0xffffffffu
#define ENC_PROBES 10u /* of a joint's points, how many a search looks at */

/* A descendant that a joint carries rigidly. */
typedef struct enc_point {
    uint32_t joint;
    int still; /* it has no rotation of its own: where its shell is, the carrying joint alone decides */
    double offset[3], linear[9]; /* its place in the carrying joint's space; `linear` if it is still */
} enc_point;

typedef struct enc_joint {
    uint32_t parent;
    uint8_t modes[3];           /* NOH_CLIP_MODE_*: rotation, translation, scale */
    uint32_t tracks[3];         /* indices, ENC_NONE where not animated */
    space_local rest;           /* the constant parts, as the decoder has them */
    uint32_t constant_width;    /* of the rotation */
    uint32_t constant_codes[4]; /* the last is the index of the omitted component */
    uint32_t linear_width[2];   /* class 0..3 of constant translation and scale */
    double lever;               /* units: distance of the farthest point that only its rotation places */
    double scale_lever;         /* units: the radius of all that its scale moves */
    double bound;               /* units */
    double reach;               /* how far from it its error is measured, in units of the bind pose's world, ... */
    double shell[3];            /* ... and in its own unit along each of its axes */
    int turned;                 /* nothing scales it, in any frame: its linear part is a rotation */
    double depth;               /* 0 at the root of its longest chain of turning joints, 1 at the tip */
    enc_point *points;
    uint32_t point_count;
} enc_joint;

typedef struct enc_track {
    noh_clip_track track; /* as the decoder has it */
    uint8_t explicit_reference;
    uint32_t reference_codes[4], mix_codes[4];
    int32_t scale_ids[3]; /* floats: relative steps, id units */
    double bounds[3];     /* floats */
    int step_guess;       /* id at which the search for a step starts */
} enc_track;

/* One track of one segment, quantised. */
typedef struct enc_piece {
    uint8_t raw, last;
    uint8_t step;
    uint8_t negative; /* wild: the reference's sign */
    uint32_t wild_codes[4];
    int32_t (*coefs)[4]; /* [last] */
    float *values;       /* raw: [frames][4 or 3] */
} enc_piece;

typedef struct enc_segment {
    uint32_t first, count;
    uint32_t split;    /* 1: its high frequencies lie apart (enc_choose_splits) */
    enc_piece *pieces; /* [track_count] */
} enc_segment;

/* How a segment spends its bound:
 *   rho_root, rho_tip  a joint's share of the bound for what it carries, at the root and at the tip of its chain
 *   headroom           share of the bound that a frame gets beyond its parents' error
 *   linear_part        share of the bound for translations
 *   correction         how much of a joint's position error its rotation compensates
 *   shell_weight       weight of the shell's points in that correction
 *   dead_zone          widening of the quantiser's zero, in steps
 *   nudges             attempts to save a step that just fails
 *   searches           coefficients are searched for in place of nudging (clip_search.c), and then ...
 *   thins              ... moved towards zero where there is room */
typedef struct enc_tuning {
    double rho_root, rho_tip, headroom, linear_part, correction, shell_weight, dead_zone;
    int nudges, searches, thins;
} enc_tuning;

/* A point that a rotation moves: where the rotation is off by the small vector w, it is off by base + w x arm, and all
 * points of a sphere of radius `shell` about it by a little more. `weight`: 1 / (what is allowed)^2. */
typedef struct enc_probe {
    double base[3], arm[3], shell, weight;
} enc_probe;

/* A rotation track of a segment near its targets. */
typedef struct enc_model {
    uint32_t probe_count;
    double weights[ENC_FRAMES_MAX];     /* 1 / (the frame's limit)^2 */
    double turns[ENC_FRAMES_MAX][3];    /* the target's own error: a vector about the axis, radians */
    double turns_by[ENC_FRAMES_MAX][9]; /* 3 x 3: the effect of a change of the components on it */
    enc_probe probes[ENC_FRAMES_MAX * ENC_PROBES];
} enc_model;

typedef enum enc_basis { ENC_BASIS_GUESSED, ENC_BASIS_COSINES, ENC_BASIS_PARABOLA } enc_basis;

typedef struct encoder {
    const raw_skeleton *skeleton;
    const raw_clip *clip;
    clip_options options;
    enc_tuning tuning; /* of the current attempt */
    const struct attempt *attempt;
    uint32_t attempt_frames;   /* wanted length of its segments; 0: the usual ones */
    enc_basis basis;           /* that is wanted */
    const enc_tuning *tunings; /* [tuning_count] every segment is encoded with each; the smallest result is kept */
    uint32_t tuning_count;
    model_error *error;
    double unit_cm, bound; /* unit_cm: centimetres per unit; bound in units */
    double tight;          /* the share of the bound that is aimed at: below 1 if single precision needs the rest */
    int level, wide, single;
    double drop;
    uint32_t joint_count, frame_count, float_count, group_count;
    noh_transform *bind; /* [joint_count] rotations unit */
    enc_joint *joints;
    space_local *local;   /* [frame][joint] raw */
    space_global *global; /* [frame][joint] */
    float *floats;        /* [frame][float_count] */
    double *float_bounds; /* [float_count] */
    enc_track *tracks;
    uint32_t track_count, rotation_count;
    enc_segment *segments;
    uint32_t segment_count;
    uint32_t parabola; /* which of the NOH_CLIP_BASES */
    uint32_t splits;   /* 1: some segments are split */
    noh_clip_basis bases[ENC_FRAMES_MAX + 1];
    double *transforms[ENC_FRAMES_MAX + 1]; /* [frames][frames], from the bases */
    struct enc_loop *loop;                  /* clip_segment.c */
    clip_report report;
} encoder;

/* The decoded values of the current segment, [joint][frame], and their references. */
typedef struct enc_loop {
    space_local *local; /* [joint][ENC_FRAMES_MAX] */
    space_global *global;
    space_global *raw_between; /* [frames][ENC_PARTS - 1][joint]: the raw clip between a frame and the one before */
    space_local *before;       /* [joint] last frame of the previous segment */
    space_local *end;          /* [joint] last frame of the best attempt so far */
    space_global *between;     /* as raw_between, as decoded */
    space_local *local_before; /* [ENC_FRAMES_MAX] of the joint that is being fitted, before that */
    space_global *global_before;
    double *errors; /* [ENC_FRAMES_MAX][ENC_PARTS][joint] as shares of the bound: at each frame, then before it */
    double *errors_before, *errors_end; /* [joint] likewise of the last frames */
    double *turns;          /* [ENC_FRAMES_MAX][joint] radians that it and its parents turn from the frame before */
    uint8_t *stale, *moved; /* [joint] to be fitted again; its motion has changed since it was measured */
    double *slack;          /* [joint][ENC_FRAMES_MAX] share of the bound that is aimed at */
    enc_model model;
    double *floor; /* [joint][ENC_FRAMES_MAX] share of it that a rotation's parents take, however exact it is */
    double rho_scale;
    uint8_t *raw; /* [joint] its tracks are stored raw */
    int all_raw;
    int gives_up; /* tracks that cause the error are stored raw */
} enc_loop;

/* Symbol counts, to train the tables. */
typedef struct clip_histogram {
    uint64_t triple[NOH_CLIP_TRIPLE_CONTEXTS][NOH_CLIP_TRIPLE_SYMBOLS];
    uint64_t last[NOH_CLIP_LAST_CONTEXTS][NOH_CLIP_LAST_SYMBOLS];
    uint64_t dc[NOH_CLIP_DC_CONTEXTS][NOH_CLIP_DC_SYMBOLS];
    uint64_t step[NOH_CLIP_STEP_CONTEXTS][NOH_CLIP_STEP_SYMBOLS];
} clip_histogram;

static inline space_local *enc_local(const encoder *e, uint32_t frame, uint32_t joint)
{
    return &e->local[(size_t)frame * e->joint_count + joint];
}
static inline space_global *enc_global(const encoder *e, uint32_t frame, uint32_t joint)
{
    return &e->global[(size_t)frame * e->joint_count + joint];
}
static inline const space_global *enc_parent(const space_global *pose, uint32_t parent)
{
    return parent == ENC_NONE ? NULL : &pose[parent];
}

/* How far the points about a joint are from the raw clip's, units. */
static inline double enc_error(const encoder *e, uint32_t joint, const space_global *raw, const space_global *lossy)
{
    const enc_joint *t = &e->joints[joint];
    if (e->options.axes) return space_error_axes(raw, lossy, t->shell);
    return t->turned ? space_error_turned(raw, lossy, t->reach) : space_error_sphere(raw, lossy, t->shell);
}

/* Each returns 0, or 1 with e->error filled. */
int enc_prepare(encoder *e);
int enc_analyse(encoder *e);
int enc_choose_basis(encoder *e);
void enc_free_bases(encoder *e);
int enc_segment_fit(encoder *e, uint32_t index, double *worst);
void enc_free_pieces(const encoder *e, enc_piece *pieces);
int enc_segment_cost(encoder *e, const enc_segment *s, size_t *bytes);
int enc_write(encoder *e, double max_error, double rms_error, uint32_t joint, uint32_t time_parts, byte_buffer *out);
int enc_choose_splits(encoder *e); /* of a clip of a high rate: once all segments are fitted */
int enc_certify(encoder *e, const byte_buffer *blob, size_t begin, double *worst_part, double *max_error,
                double *rms_error, uint32_t *joint, uint32_t *time_parts);

/* Judges decoded frames: violations [frames] gets each frame's error over the allowed one; returns the largest. */
typedef double (*enc_check)(encoder *e, void *user, const uint8_t *frames, double *violations);

/* The requirements on a fitted track. */
typedef struct enc_goal {
    const float *reference; /* [4] */
    double (*targets)[3];   /* [frames] components, relative to the reference */
    enc_check check;
    void *user;             /* passed to check */
    const enc_model *model; /* guides the search; NULL: targets are nudged */
} enc_goal;

/* Fit one track (clip_fit.c). */
int enc_fit(encoder *e, enc_track *track, enc_piece *piece, uint32_t count, const enc_goal *goal);

/* Change quantised coefficients so that all frames hold (clip_search.c). Returns whether they do by the model.
 * `spectrum` [count][3]: the coefficients before quantisation with steps of `size`. */
int enc_search(const encoder *e, const enc_model *m, uint32_t count, double (*spectrum)[3], enc_piece *piece,
               double size);

/* Smallest-three codes of a quaternion of either sign; codes[3] is the index of the omitted component. Returns 1 if q
 * was negated. */
int enc_quat_codes(const double q[4], uint32_t width, uint32_t codes[4]);
void enc_quat_value(const uint32_t codes[4], uint32_t width, float q[4]);

/* Fill the error (printf form) and return 1. */
int enc_fail(encoder *e, const char *what);
void *enc_alloc(encoder *e, size_t count, size_t size);

#endif
