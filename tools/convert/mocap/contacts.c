#include "contacts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/raw_set.h"
#include "convert/clips/raw_turn.h"
#include "track.h"

#define POINTS_MAX 64u
#define LOW_SHARE 0.12     /* of the body's height: feet, in the bind pose */
#define SPOT_SHARE 0.1     /* of it: how far a body on the spot sways */
#define CLEARANCE_LAW 0.01 /* of it: a point so high above the lowest has a quarter of its say */
#define RISE_LAW 0.05      /* of it per second: so does one that goes up or down so fast */
#define LIFT_SHARE 0.005   /* of it: hips that move less up and down were not captured */
#define CONTACT_LEAST_S 0.05
#define SIDE_SHARE 0.01   /* of the height: a foot so far from the middle is a left or a right one */
#define CLOSES_SHARE 0.02 /* of it: how far joints of a loop's last frame are from the first, local to their parents */
#define CLOSES_ANGLE 0.1  /* likewise, radians */

/* Below the first a foot comes down, above the second it leaves: shares of the body's height, and of it per second. */
static const double low[2] = { 0.03, 0.045 }, slow[2] = { 0.25, 0.4 };

/* A place of a foot: a joint's own, or the end of a last joint. */
typedef struct foot_point {
    uint32_t foot, joint;
    int is_end;
} foot_point;

struct contacts {
    uint32_t foot_count, point_count, frame_count, hips;
    uint32_t feet[CONTACT_FEET_MAX];
    int sides[CONTACT_FEET_MAX]; /* 1 left, -1 right, 0 neither */
    foot_point points[POINTS_MAX];
    double height, rate;
    double *at;              /* [frame_count][point_count][3], on the path */
    double *path;            /* [frame_count][3] how far the root goes; zeros for one that was captured */
    uint8_t *stands;         /* [frame_count][foot_count] */
    int on_the_spot, closes; /* 1: the last frame is the first again */
};

/* ---- feet ---- */

static void point_place(const raw_skeleton *skeleton, const double *pose, const foot_point *point, double out[3])
{
    const double *m = pose + (size_t)point->joint * 12u;
    const float *end = skeleton->joints[point->joint].end;
    for (int i = 0; i < 3; i++) {
        out[i] = m[9 + i];
        for (int k = 0; k < 3 && point->is_end; k++) out[i] += m[3 * k + i] * (double)end[k];
    }
}

static void body_extent(const raw_skeleton *skeleton, const double *pose, double *bottom, double *top)
{
    *bottom = HUGE_VAL;
    *top = -HUGE_VAL;
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        for (int is_end = 0; is_end < 2; is_end++) {
            const foot_point point = { 0, j, is_end };
            double place[3];
            point_place(skeleton, pose, &point, place);
            *bottom = fmin(*bottom, place[1]);
            *top = fmax(*top, place[1]);
        }
    }
}

/* is_low: each joint with all that hangs below it. */
static void find_low(const raw_skeleton *skeleton, const double *pose, double under, uint8_t *is_low)
{
    for (uint32_t j = skeleton->joint_count; j-- > 0;) {
        if (pose[(size_t)j * 12u + 10u] > under) is_low[j] = 0;
        if (skeleton->joints[j].parent != MODEL_NONE && !is_low[j]) is_low[skeleton->joints[j].parent] = 0;
    }
}

static void add_points(contacts *c, const raw_skeleton *skeleton, uint8_t *foot_of, const uint8_t *is_low)
{
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        const raw_joint *joint = &skeleton->joints[j];
        const uint32_t parent = joint->parent;
        const int has_end = joint->end[0] != 0.0f || joint->end[1] != 0.0f || joint->end[2] != 0.0f;
        foot_of[j] = CONTACT_FEET_MAX;
        if (!is_low[j] || parent == MODEL_NONE) continue;
        if (is_low[parent]) {
            foot_of[j] = foot_of[parent];
        } else if (c->foot_count < CONTACT_FEET_MAX) {
            foot_of[j] = (uint8_t)c->foot_count;
            c->feet[c->foot_count++] = j;
        }
        for (int is_end = 0; is_end <= has_end; is_end++) {
            if (foot_of[j] < CONTACT_FEET_MAX && c->point_count < POINTS_MAX) {
                c->points[c->point_count++] = (foot_point){ foot_of[j], j, is_end };
            }
        }
    }
}

/* The last joint that all feet hang from. */
static void find_hips(contacts *c, const raw_skeleton *skeleton, uint8_t *count)
{
    memset(count, 0, skeleton->joint_count);
    for (uint32_t foot = 0; foot < c->foot_count; foot++) count[c->feet[foot]] = 1;
    for (uint32_t j = skeleton->joint_count; j-- > 1;) {
        if (skeleton->joints[j].parent != MODEL_NONE) {
            count[skeleton->joints[j].parent] = (uint8_t)(count[skeleton->joints[j].parent] + count[j]);
        }
    }
    c->hips = 0;
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        if (count[j] == c->foot_count) c->hips = j;
    }
}

/* By names, else by the side of the middle on which the foot is in the bind pose: +x is left as a model faces +z. */
static void find_sides(contacts *c, const raw_skeleton *skeleton, const double *pose)
{
    for (uint32_t foot = 0; foot < c->foot_count; foot++) {
        const double x = pose[(size_t)c->feet[foot] * 12u + 9u], far = SIDE_SHARE * c->height;
        c->sides[foot] = raw_side(skeleton, c->feet[foot]);
        if (!c->sides[foot]) c->sides[foot] = (x > far) - (x < -far);
    }
}

static int find_feet(contacts *c, const raw_skeleton *skeleton, double *pose)
{
    uint8_t *marks = malloc(2u * (size_t)skeleton->joint_count);
    double bottom, top;
    if (!marks) return 1;
    raw_pose_object(skeleton, NULL, 0, pose);
    body_extent(skeleton, pose, &bottom, &top);
    c->height = top - bottom;
    memset(marks, 1, skeleton->joint_count);
    find_low(skeleton, pose, bottom + LOW_SHARE * c->height, marks);
    add_points(c, skeleton, marks + skeleton->joint_count, marks);
    find_hips(c, skeleton, marks);
    find_sides(c, skeleton, pose);
    free(marks);
    return 0;
}

/* ---- where the root was ---- */

/* The say of a point over the root's step: of what is lowest, and least on its way up or down, as a foot is that begins
 * to swing. */
static double say_of(const contacts *c, double over, double rise)
{
    const double high = over / (CLEARANCE_LAW * c->height), fast = rise * c->rate / (RISE_LAW * c->height);
    const double once = 1.0 / ((1.0 + high * high) * (1.0 + fast * fast));
    return once * once;
}

/* How the points say the body moved from one frame to the next: against those that stand. */
static void step_of_root(const contacts *c, uint32_t frame, double out[3])
{
    const double *a = c->at + (size_t)frame * c->point_count * 3u, *b = a + c->point_count * 3u;
    double low_a = HUGE_VAL, low_b = HUGE_VAL, sum = 0.0;
    for (uint32_t p = 0; p < c->point_count; p++) {
        low_a = fmin(low_a, a[3u * p + 1u]);
        low_b = fmin(low_b, b[3u * p + 1u]);
    }
    out[0] = out[1] = out[2] = 0.0;
    for (uint32_t p = 0; p < c->point_count; p++) {
        const double over_a = a[3u * p + 1u] - low_a, over_b = b[3u * p + 1u] - low_b;
        const double say = say_of(c, 0.5 * (over_a + over_b), over_b - over_a);
        out[0] -= say * (b[3u * p] - a[3u * p]);
        out[2] -= say * (b[3u * p + 2u] - a[3u * p + 2u]);
        sum += say;
    }
    out[0] /= sum;
    out[2] /= sum;
}

static double lowest_of(const contacts *c, uint32_t frame)
{
    double lowest = HUGE_VAL;
    for (uint32_t p = 0; p < c->point_count; p++) {
        lowest = fmin(lowest, c->at[((size_t)frame * c->point_count + p) * 3u + 1u]);
    }
    return lowest;
}

/* scratch [frame_count] */
static void find_path(contacts *c, int lift, double *scratch)
{
    double floor_y;
    for (uint32_t f = 0; f < c->frame_count; f++) scratch[f] = lowest_of(c, f);
    floor_y = mocap_rank(scratch, c->frame_count, c->frame_count / 20u); /* where legs are straight */
    for (uint32_t f = 0; f < c->frame_count; f++) {
        double step[3] = { 0.0, 0.0, 0.0 };
        if (f) step_of_root(c, f - 1u, step);
        for (uint32_t i = 0; i < 3; i++) c->path[3u * f + i] = (f ? c->path[3u * (f - 1u) + i] : 0.0) + step[i];
        if (lift) c->path[3u * f + 1u] = floor_y - lowest_of(c, f);
    }
    for (uint32_t f = 0; f < c->frame_count; f++) {
        for (uint32_t p = 0; p < c->point_count; p++) {
            for (uint32_t i = 0; i < 3; i++) c->at[((size_t)f * c->point_count + p) * 3u + i] += c->path[3u * f + i];
        }
    }
}

/* ---- standing ---- */

static double way_of(const contacts *c, uint32_t point, uint32_t from, uint32_t to)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < 3; i++) {
        const double d = c->at[((size_t)to * c->point_count + point) * 3u + i] -
                         c->at[((size_t)from * c->point_count + point) * 3u + i];
        sum += d * d;
    }
    return sqrt(sum);
}

/* At a seam by the ways on both sides of it. */
static double speed_of(const contacts *c, uint32_t point, uint32_t frame)
{
    const uint32_t last = c->frame_count - 1u, wanted = (uint32_t)fmax(1.0, c->rate / 60.0 + 0.5);
    const uint32_t reach = wanted < last ? wanted : last;
    const uint32_t from = frame > reach ? frame - reach : 0, to = frame + reach < last ? frame + reach : last;
    const uint32_t before = c->closes ? reach - (frame - from) : 0, after = c->closes ? reach - (to - frame) : 0;
    const uint32_t frames = before + (to - from) + after;
    const double way = way_of(c, point, last - before, last) + way_of(c, point, from, to) + way_of(c, point, 0, after);
    return frames ? way * c->rate / frames : 0.0;
}

static void find_standing(contacts *c, uint32_t point, double *heights)
{
    const uint32_t foot = c->points[point].foot;
    double floor_y;
    int is_down = 0; /* of a loop: as it ends */
    for (uint32_t f = 0; f < c->frame_count; f++) heights[f] = c->at[((size_t)f * c->point_count + point) * 3u + 1u];
    floor_y = mocap_rank(heights, c->frame_count, c->frame_count / 20u);
    for (int pass = !c->closes; pass < 2; pass++) {
        for (uint32_t f = 0; f < c->frame_count; f++) {
            const double over = c->at[((size_t)f * c->point_count + point) * 3u + 1u] - floor_y;
            is_down = over < low[is_down] * c->height && speed_of(c, point, f) < slow[is_down] * c->height;
            if (is_down && pass) c->stands[(size_t)f * c->foot_count + foot] = 1;
        }
    }
}

static uint8_t *standing(const contacts *c, uint32_t foot, uint32_t frame)
{
    const uint32_t f = c->closes ? frame % (c->frame_count - 1u) : frame;
    return &c->stands[(size_t)f * c->foot_count + foot];
}

/* Whether a run of a value begins at a frame. The first frame of a loop follows the last but one. */
static int begins(const contacts *c, uint32_t foot, int value, uint32_t frame)
{
    const uint32_t before = frame ? frame - 1u : c->frame_count - 2u;
    return (frame || c->closes) && *standing(c, foot, frame) == value && *standing(c, foot, before) != value;
}

/* Contacts shorter than CONTACT_LEAST_S, and gaps in one as short, are none. */
static void smooth_standing(contacts *c, uint32_t foot, int value)
{
    const uint32_t least = (uint32_t)(CONTACT_LEAST_S * c->rate + 0.5);
    for (uint32_t f = 0; f < c->frame_count; f++) {
        uint32_t end = f + 1u;
        if (!begins(c, foot, value, f)) continue;
        while ((c->closes || end < c->frame_count) && end - f < least && *standing(c, foot, end) == value) end++;
        if (end - f >= least || (!c->closes && end == c->frame_count)) continue;
        for (uint32_t k = f; k < end; k++) *standing(c, foot, k) = (uint8_t)!value;
    }
    if (c->closes) c->stands[(size_t)(c->frame_count - 1u) * c->foot_count + foot] = *standing(c, foot, 0);
}

static double spread(const double *values, uint32_t count)
{
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (uint32_t i = 0; i < count; i++) {
        least = fmin(least, values[3u * i]);
        most = fmax(most, values[3u * i]);
    }
    return most - least;
}

/* Whether the joints of the last frame are in the places of the first frame. Roots may differ. */
static int ends_as_it_began(const contacts *c, const raw_skeleton *skeleton, const raw_clip *clip)
{
    const size_t last = (size_t)(clip->frame_count - 1u) * clip->joint_count;
    for (uint32_t j = 0; j < clip->joint_count; j++) {
        const float *t = clip->translations + 3u * (size_t)j, *q = clip->rotations + 4u * (size_t)j;
        double off = 0.0, dot = 0.0;
        if (skeleton->joints[j].parent == MODEL_NONE) continue;
        for (size_t i = 0; i < 3; i++) off = hypot(off, (double)t[3u * last + i] - (double)t[i]);
        for (size_t i = 0; i < 4; i++) dot += (double)q[4u * last + i] * (double)q[i];
        if (off > CLOSES_SHARE * c->height || fabs(dot) < cos(0.5 * CLOSES_ANGLE)) return 0;
    }
    return clip->frame_count > 2;
}

static int find(contacts *c, const raw_skeleton *skeleton, const raw_clip *clip, double *pose)
{
    double *hips = malloc((size_t)c->frame_count * 3u * sizeof *hips);
    if (!hips) return 1;
    for (uint32_t f = 0; f < c->frame_count; f++) {
        raw_pose_object(skeleton, clip, f, pose);
        memcpy(hips + 3u * f, pose + (size_t)c->hips * 12u + 9u, 3u * sizeof *hips);
        for (uint32_t p = 0; p < c->point_count; p++) {
            point_place(skeleton, pose, &c->points[p], c->at + ((size_t)f * c->point_count + p) * 3u);
        }
    }
    c->on_the_spot = fmax(spread(hips, c->frame_count), spread(hips + 2, c->frame_count)) < SPOT_SHARE * c->height;
    if (c->on_the_spot) find_path(c, spread(hips + 1, c->frame_count) < LIFT_SHARE * c->height, hips);
    c->closes = ends_as_it_began(c, skeleton, clip);
    for (uint32_t p = 0; p < c->point_count; p++) find_standing(c, p, hips);
    for (uint32_t foot = 0; foot < c->foot_count; foot++) {
        smooth_standing(c, foot, 0);
        smooth_standing(c, foot, 1);
    }
    free(hips);
    return 0;
}

contacts *contacts_find(const raw_skeleton *skeleton, const raw_clip *clip, int *failed)
{
    contacts *c;
    double *pose;
    *failed = 0;
    if (clip->joint_count != skeleton->joint_count || clip->joint_count == 0 || clip->frame_count < 2) return NULL;
    c = calloc(1, sizeof *c);
    pose = malloc((size_t)skeleton->joint_count * 12u * sizeof *pose);
    *failed = !c || !pose || find_feet(c, skeleton, pose);
    if (!*failed && c->foot_count && c->height > 0.0) {
        c->frame_count = clip->frame_count;
        c->rate = clip->sample_rate_hz;
        c->at = malloc((size_t)c->frame_count * c->point_count * 3u * sizeof *c->at);
        c->path = calloc((size_t)c->frame_count * 3u, sizeof *c->path);
        c->stands = calloc(c->frame_count, c->foot_count);
        *failed = !c->at || !c->path || !c->stands || find(c, skeleton, clip, pose);
    }
    free(pose);
    if (*failed || !c->stands) {
        contacts_free(c);
        return NULL;
    }
    return c;
}

void contacts_free(contacts *c)
{
    if (!c) return;
    free(c->at);
    free(c->path);
    free(c->stands);
    free(c);
}

/* ---- what was found ---- */

uint32_t contacts_feet(const contacts *c)
{
    return c->foot_count;
}

uint32_t contacts_joint(const contacts *c, uint32_t foot)
{
    return c->feet[foot];
}

int contacts_stands(const contacts *c, uint32_t foot, uint32_t frame)
{
    return c->stands[(size_t)frame * c->foot_count + foot];
}

int contacts_on_the_spot(const contacts *c)
{
    return c->on_the_spot;
}

double contacts_move_root(const contacts *c, const raw_skeleton *skeleton, raw_clip *clip)
{
    double gone = 0.0;
    for (uint32_t f = 0; f < clip->frame_count; f++) {
        const double *at = c->path + 3u * f;
        for (uint32_t j = 0; j < clip->joint_count; j++) {
            float *t = clip->translations + ((size_t)f * clip->joint_count + j) * 3u;
            for (int i = 0; i < 3 && skeleton->joints[j].parent == MODEL_NONE; i++) {
                t[i] = (float)((double)t[i] + at[i]);
            }
        }
        if (f) gone += sqrt((at[0] - at[-3]) * (at[0] - at[-3]) + (at[2] - at[-1]) * (at[2] - at[-1]));
    }
    return gone;
}

/* The frames at which feet come down, within the clip. */
static int comes_down(const contacts *c, uint32_t foot, uint32_t frame)
{
    return frame + 1u < c->frame_count && begins(c, foot, 1, frame);
}

int contacts_mark(const contacts *c, const raw_skeleton *skeleton, raw_clip *clip, uint32_t *added)
{
    *added = 0;
    for (uint32_t f = 0; f < clip->frame_count; f++) {
        for (uint32_t foot = 0; foot < c->foot_count; foot++) {
            const raw_event event = { .name = skeleton->joints[c->feet[foot]].name,
                                      .time_s = f / clip->sample_rate_hz,
                                      .is_marker = 1 };
            if (!comes_down(c, foot, f)) continue;
            if (raw_clip_add_event(clip, &event)) return 1;
            *added += 1u;
            break; /* a clip has no two markers at one time */
        }
    }
    return 0;
}

/* Whether another foot of its side came down just before, or one of a lower number does now: rigs have several joints
 * to a foot. */
static int is_told(const contacts *c, uint32_t foot, uint32_t frame)
{
    const uint32_t span = c->frame_count - 1u, least = (uint32_t)(CONTACT_LEAST_S * c->rate + 0.5);
    for (uint32_t k = 0; k <= least && (k <= frame || (c->closes && k < span)); k++) {
        const uint32_t at = k <= frame ? frame - k : frame + span - k;
        for (uint32_t other = 0; other < c->foot_count; other++) {
            if (other == foot || c->sides[other] != c->sides[foot] || (!k && other > foot)) continue;
            if (comes_down(c, other, at)) return 1;
        }
    }
    return 0;
}

int contacts_add_keys(const contacts *c, raw_clip *clip, uint32_t *added)
{
    static char names[3][16] = { "right_foot", "foot", "left_foot" };
    *added = 0;
    for (uint32_t f = 0; f < clip->frame_count; f++) {
        for (uint32_t foot = 0; foot < c->foot_count && clip->event_count < RAW_EVENTS_MAX; foot++) {
            const raw_event event = { .name = names[1 + c->sides[foot]],
                                      .time_s = f / clip->sample_rate_hz,
                                      .payload = { (uint8_t)foot } };
            if (!comes_down(c, foot, f) || is_told(c, foot, f)) continue;
            if (raw_clip_add_event(clip, &event)) return 1;
            *added += 1u;
        }
    }
    return 0;
}
