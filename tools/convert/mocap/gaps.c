#include "gaps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/quat.h"
#include "track.h"

#define DEGREE (3.14159265358979323846 / 180.0)
#define AROUND 4u      /* steps on each side of a run that give its motion */
#define WINDOW 16u     /* steps on each side of a jump that give the usual step */
#define SLOPE_STEPS 3u /* on each side of a gap */

/* The state of one track's search. */
typedef struct search {
    mocap_track track;
    double *steps;     /* [frame_count - 1] from each frame to the next */
    uint8_t *lost;     /* [frame_count] */
    double held, away; /* jumps at least so large: radians, or units */
    uint32_t longest;  /* frames */
} search;

/* ---- held ---- */

/* The mean of the steps around frames first to last, which are not among them. */
static double mean_around(const search *s, uint32_t first, uint32_t last)
{
    const uint32_t from = first > AROUND ? first - AROUND : 0, step_count = s->track.frame_count - 1u;
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t f = from; f < first; f++, count++) sum += s->steps[f];
    for (uint32_t f = last + 1u; f < step_count && f <= last + AROUND; f++, count++) sum += s->steps[f];
    return count ? sum / count : 0.0;
}

static void find_held(search *s)
{
    const uint32_t count = s->track.frame_count;
    for (uint32_t first = 1, last; first + 1u < count; first = last + 1u) {
        for (last = first; last + 1u < count && s->steps[last] == 0.0; last++) {}
        const uint32_t repeats = last - first;
        if (repeats < 2 || last + 1u == count) continue;
        if (s->steps[last] > s->held &&
            s->steps[last] > fmin(0.5 * (repeats + 1u), 3.0) * mean_around(s, first, last)) {
            memset(s->lost + first + 1u, 1, repeats);
        }
    }
}

/* ---- away ---- */

static double common_step(const search *s, uint32_t step)
{
    double near[2u * WINDOW + 1u];
    const uint32_t from = step > WINDOW ? step - WINDOW : 0;
    uint32_t count = 0;
    for (uint32_t f = from; f < s->track.frame_count - 1u && f <= step + WINDOW; f++) near[count++] = s->steps[f];
    return mocap_rank(near, count, count / 2u);
}

static int jumps(const search *s, uint32_t step)
{
    return s->steps[step] > s->away && s->steps[step] > 6.0 * common_step(s, step);
}

/* The step at which a track that jumped away at `out` jumps back; 0: it does not. */
static uint32_t way_back(const search *s, uint32_t out)
{
    for (uint32_t back = out + 1u; back + 2u < s->track.frame_count && back <= out + s->longest; back++) {
        const double least = fmin(s->steps[out], s->steps[back]);
        const int alone = back == out + 1u || (s->steps[out + 1u] < 0.25 * least && s->steps[back - 1u] < 0.25 * least);
        if (!alone || s->steps[back + 1u] > 0.25 * least || !jumps(s, back)) continue;
        if (mocap_track_distance(&s->track, out, back + 1u) < 0.5 * least) return back;
    }
    return 0;
}

static void find_away(search *s)
{
    for (uint32_t out = 1; out + 3u < s->track.frame_count; out++) {
        uint32_t back;
        if (s->steps[out] <= s->away || s->steps[out - 1u] > 0.25 * s->steps[out] || !jumps(s, out)) continue;
        back = way_back(s, out);
        if (!back) continue;
        memset(s->lost + out + 1u, 1, back - out);
        out = back;
    }
}

/* ---- filling ---- */

/* Where a frame is, as seen from another: three numbers in which short ways are nearly straight. */
static void place_of(const mocap_track *track, uint32_t frame, uint32_t from, double out[3])
{
    const double *x = track->x + (size_t)frame * track->width, *x0 = track->x + (size_t)from * track->width;
    if (track->kind == MOCAP_ROTATION) {
        const double inverse[4] = { -x0[0], -x0[1], -x0[2], x0[3] };
        double q[4];
        const double one[4] = { 0.0, 0.0, 0.0, 1.0 };
        quat_multiply(inverse, x, q);
        (void)quat_normalize(q);
        quat_align(q, one);
        for (int i = 0; i < 3; i++) out[i] = q[i] / (1.0 + q[3]);
        return;
    }
    for (int i = 0; i < 3; i++) out[i] = x[i] - x0[i];
}

static void put(mocap_track *track, uint32_t frame, uint32_t from, const double place[3])
{
    double *x = track->x + (size_t)frame * track->width;
    const double *x0 = track->x + (size_t)from * track->width;
    if (track->kind == MOCAP_ROTATION) {
        const double square = place[0] * place[0] + place[1] * place[1] + place[2] * place[2];
        double q[4] = { 0.0, 0.0, 0.0, (1.0 - square) / (1.0 + square) };
        for (int i = 0; i < 3; i++) q[i] = 2.0 * place[i] / (1.0 + square);
        quat_multiply(x0, q, x);
        return;
    }
    for (int i = 0; i < 3; i++) x[i] = x0[i] + place[i];
}

/* The slope per frame at a gap's edge, of frames that were seen. way: -1 before it, 1 after it. */
static void slope_at(const search *s, uint32_t edge, int way, uint32_t from, double out[3])
{
    double here[3], there[3];
    uint32_t far = edge, steps = 0;
    while (steps < SLOPE_STEPS && (way > 0 ? far + 1u < s->track.frame_count : far > 0) &&
           !s->lost[way > 0 ? far + 1u : far - 1u]) {
        far = way > 0 ? far + 1u : far - 1u;
        steps++;
    }
    place_of(&s->track, edge, from, here);
    place_of(&s->track, far, from, there);
    for (int i = 0; i < 3; i++) out[i] = steps ? way * (there[i] - here[i]) / steps : 0.0;
}

/* Frames a + 1 to b - 1. */
static void fill(search *s, uint32_t a, uint32_t b)
{
    double end[3], slope_a[3], slope_b[3];
    const double length = b - a;
    place_of(&s->track, b, a, end);
    slope_at(s, a, -1, a, slope_a);
    slope_at(s, b, 1, a, slope_b);
    for (uint32_t f = a + 1u; f < b; f++) {
        const double t = (f - a) / length, t2 = t * t, t3 = t2 * t;
        double place[3];
        for (int i = 0; i < 3; i++) {
            place[i] = (3.0 * t2 - 2.0 * t3) * end[i] + (t3 - 2.0 * t2 + t) * length * slope_a[i] +
                       (t3 - t2) * length * slope_b[i];
        }
        put(&s->track, f, a, place);
    }
}

static void fill_all(search *s, raw_clip *clip, gaps_report *report)
{
    const uint32_t before = report->filled;
    for (uint32_t f = 1; f < s->track.frame_count; f++) {
        uint32_t a = f - 1u, b = f;
        if (!s->lost[f]) continue;
        while (s->lost[b]) b++; /* a track's last frame is never lost */
        f = b;
        if (b - a - 1u > s->longest) {
            report->left++;
            continue;
        }
        fill(s, a, b);
        mocap_track_write(&s->track, a + 1u, b, clip);
        report->filled++;
        report->frames += b - a - 1u;
        report->longest_s = fmax(report->longest_s, (b - a - 1u) / clip->sample_rate_hz);
    }
    report->tracks += report->filled > before;
}

int gaps_fill(const raw_skeleton *skeleton, raw_clip *clip, gaps_report *report)
{
    search s = { .longest = (uint32_t)(GAPS_LONGEST_S * clip->sample_rate_hz) };
    int failed = mocap_track_alloc(clip, &s.track);
    if (clip->frame_count < 6u) {
        mocap_track_free(&s.track);
        return failed;
    }
    s.steps = malloc((clip->frame_count - 1u) * sizeof *s.steps);
    s.lost = malloc(clip->frame_count);
    failed = failed || !s.steps || !s.lost;
    for (uint32_t t = 0; t < 2u * clip->joint_count && !failed; t++) {
        const int turns = t % 2u == 0;
        mocap_track_read(clip, t / 2u, turns ? MOCAP_ROTATION : MOCAP_TRANSLATION, &s.track);
        memset(s.lost, 0, clip->frame_count);
        for (uint32_t f = 0; f + 1u < clip->frame_count; f++) s.steps[f] = mocap_track_distance(&s.track, f, f + 1u);
        s.held = turns ? 0.5 * DEGREE : 0.5 / skeleton->unit_cm;
        s.away = 10.0 * s.held;
        find_held(&s);
        find_away(&s);
        fill_all(&s, clip, report);
    }
    mocap_track_free(&s.track);
    free(s.steps);
    free(s.lost);
    return failed;
}
