#include "track.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/quat.h"

int mocap_track_alloc(const raw_clip *clip, mocap_track *out)
{
    memset(out, 0, sizeof *out);
    out->x = malloc((size_t)clip->frame_count * 4u * sizeof *out->x);
    return !out->x;
}

void mocap_track_free(mocap_track *track)
{
    free(track->x);
    memset(track, 0, sizeof *track);
}

void mocap_track_read(const raw_clip *clip, uint32_t joint, mocap_kind kind, mocap_track *track)
{
    const uint32_t width = kind == MOCAP_ROTATION ? 4u : 3u;
    const float *from = kind == MOCAP_ROTATION ? clip->rotations : clip->translations;
    track->kind = kind;
    track->joint = joint;
    track->width = width;
    track->frame_count = clip->frame_count;
    for (uint32_t f = 0; f < clip->frame_count; f++) {
        double *x = track->x + (size_t)f * width;
        for (uint32_t i = 0; i < width; i++) {
            x[i] = (double)from[((size_t)f * clip->joint_count + joint) * width + i];
        }
        if (f && kind == MOCAP_ROTATION) quat_align(x, x - 4);
    }
}

void mocap_track_write(const mocap_track *track, uint32_t first, uint32_t last, raw_clip *clip)
{
    float *to = track->kind == MOCAP_ROTATION ? clip->rotations : clip->translations;
    for (uint32_t f = first; f < last; f++) {
        double x[4] = { 0.0, 0.0, 0.0, 1.0 };
        memcpy(x, track->x + (size_t)f * track->width, track->width * sizeof *x);
        if (track->kind == MOCAP_ROTATION) (void)quat_normalize(x);
        for (uint32_t i = 0; i < track->width; i++) {
            to[((size_t)f * clip->joint_count + track->joint) * track->width + i] = (float)x[i];
        }
    }
}

double mocap_track_distance(const mocap_track *track, uint32_t a, uint32_t b)
{
    const double *p = track->x + (size_t)a * track->width, *q = track->x + (size_t)b * track->width;
    double sum = 0.0;
    if (track->kind == MOCAP_ROTATION) return quat_angle(p, q);
    for (uint32_t i = 0; i < 3; i++) sum += (p[i] - q[i]) * (p[i] - q[i]);
    return sqrt(sum);
}

static int in_order(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double mocap_rank(double *values, uint32_t count, uint32_t k)
{
    qsort(values, count, sizeof *values, in_order);
    return values[k];
}
