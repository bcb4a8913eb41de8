/* lod_move.c: whether a point may move to its neighbour, and the move itself.
 *
 * A collapse is refused where it would change the surface's topology (the link condition of Dey et al. 1999: the two
 * rings may share only the triangles that disappear), tear a seam (every wedge of the point needs one of the
 * neighbour's to become), turn a triangle over at rest, or leave a sliver. */
#include "lod_internal.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define TURN_COSINE 0.2588190451 /* 75 degrees at rest */
#define FACET_NORMALS 0.25f      /* of a squared edge: the cost of a difference of normals of 1 */
#define FACET_REACH 0.5f         /* of the edge: attributes of more belong to another part of the texture */
#define SLIVER 0.01f             /* the least ratio of a new triangle's height to its longest edge */

void lod_move_triangle(const lod_surface *s, uint32_t corner, uint32_t point, uint32_t pose, float *out)
{
    memcpy(out, lod_posed(&s->poses, point, pose), 3u * sizeof *out);
    memcpy(out + 3, lod_posed(&s->poses, lod_point(s, lod_next(corner)), pose), 3u * sizeof *out);
    memcpy(out + 6, lod_posed(&s->poses, lod_point(s, lod_previous(corner)), pose), 3u * sizeof *out);
}

static uint32_t find_wedge(const lod_move *m, uint32_t vertex)
{
    uint32_t w = 0;
    while (w < m->wedge_count && m->wedge_from[w] != vertex) {
        w++;
    }
    return w;
}

/* The cost of a vertex of `to` in place of one of `from`: the squared difference of attributes as lengths; then of
 * normals, as shares of the edge. */
static float facet_misfit(const lod_surface *s, uint32_t from, uint32_t to, float edge)
{
    const float *a = s->attribute + (size_t)from * LOD_ATTRIBUTES, *b = s->attribute + (size_t)to * LOD_ATTRIBUTES;
    float sum = 0.0f;
    for (uint32_t k = 0; k < LOD_ATTRIBUTES; k++) {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    }
    if (sum > edge * (FACET_REACH * FACET_REACH)) {
        return FLT_MAX;
    }
    for (uint32_t k = 0; k < 3u; k++) {
        const float d = s->mesh->normal[from * 3u + k] - s->mesh->normal[to * 3u + k];
        sum += FACET_NORMALS * edge * d * d;
    }
    return sum;
}

/* A facet that stays has no vertex on the edge along which its point moves: it takes the one of `to` that is most like
 * its own, in its submesh. 0: there is none. */
static int add_facet(const lod_surface *s, lod_move *m, uint32_t corner)
{
    const uint32_t vertex = s->corner[corner], submesh = s->submesh[corner / 3u];
    const float *p = lod_posed(&s->poses, m->from, 0), *q = lod_posed(&s->poses, m->to, 0);
    const float edge = (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]);
    float least = FLT_MAX;
    uint32_t best = LOD_NONE;
    for (uint32_t c = s->first[m->to]; c != LOD_NONE; c = s->next[c]) {
        const int fits = !s->dead[c / 3u] && s->submesh[c / 3u] == submesh;
        const float misfit = fits ? facet_misfit(s, vertex, s->corner[c], edge) : FLT_MAX;
        if (misfit < least) {
            least = misfit;
            best = s->corner[c];
        }
    }
    if (best == LOD_NONE) {
        return 0;
    }
    m->wedge_from[m->wedge_count] = vertex;
    m->wedge_to[m->wedge_count++] = best;
    return 1;
}

/* Find the wedge of `to` that each wedge of `from` becomes. 0 if one has none, or two. */
static int map_wedges(const lod_surface *s, const lod_fan *fan, lod_move *m)
{
    const int faceted = s->faceted[m->from] && s->mesh->normal;
    m->wedge_count = m->kept_count = m->gone_count = 0;
    for (uint32_t i = 0; i < fan->count; i++) {
        uint32_t c = fan->corner[i], other = lod_point(s, lod_next(c)) == m->to ? lod_next(c) : lod_previous(c), w;
        if (lod_point(s, other) != m->to) {
            m->kept[m->kept_count++] = c;
            continue;
        }
        m->gone[m->gone_count++] = c;
        w = find_wedge(m, s->corner[c]);
        if (w == m->wedge_count) {
            m->wedge_from[w] = s->corner[c];
            m->wedge_to[m->wedge_count++] = s->corner[other];
        } else if (m->wedge_to[w] != s->corner[other] && !faceted) {
            return 0;
        }
    }
    for (uint32_t i = 0; i < m->kept_count; i++) {
        if (find_wedge(m, s->corner[m->kept[i]]) == m->wedge_count && (!faceted || !add_facet(s, m, m->kept[i]))) {
            return 0;
        }
    }
    return m->kept_count > 0; /* a piece of the surface never vanishes as a whole */
}

/* A border point stays on its border. */
static int border_allows(const lod_fan *fan, uint32_t to)
{
    uint32_t borders = 0;
    int along = 0;
    for (uint32_t i = 0; i < fan->ring_count; i++) {
        borders += fan->ring_use[i] == 1u;
        along |= fan->ring[i] == to && fan->ring_use[i] == 1u;
    }
    return borders == 0 || (borders == 2u && along);
}

/* The link condition: both points' only common neighbours are the far corners of the triangles
 * that vanish; and no triangle comes to lie on another. */
static int link_allows(lod_surface *s, const lod_fan *fan, const lod_move *m)
{
    uint32_t common = 0, triangles = 0, stamp = s->stamp += 2u;
    for (uint32_t i = 0; i < fan->ring_count; i++) {
        s->mark[fan->ring[i]] = stamp;
    }
    for (uint32_t c = s->first[m->to]; c != LOD_NONE; c = s->next[c]) {
        uint32_t a = lod_point(s, lod_next(c)), b = lod_point(s, lod_previous(c));
        if (s->dead[c / 3u]) {
            continue;
        }
        triangles++;
        if (s->mark[a] >= stamp && s->mark[b] >= stamp && a != m->from && b != m->from) {
            return 0;
        }
        common += s->mark[a] == stamp && a != m->from;
        s->mark[a] += s->mark[a] == stamp;
        common += s->mark[b] == stamp && b != m->from;
        s->mark[b] += s->mark[b] == stamp;
    }
    return common == m->gone_count && triangles + m->kept_count - m->gone_count <= LOD_FAN_MAX;
}

static float cross_of(const float *t, float *out)
{
    float a[3] = { t[3] - t[0], t[4] - t[1], t[5] - t[2] }, b[3] = { t[6] - t[0], t[7] - t[1], t[8] - t[2] };
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
    return out[0] * out[0] + out[1] * out[1] + out[2] * out[2];
}

static float longest_edge(const float *t)
{
    float longest = 0.0f;
    for (uint32_t i = 0; i < 3u; i++) {
        const float *a = t + i * 3u, *b = t + (i + 1u) % 3u * 3u;
        float d = (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
        longest = d > longest ? d : longest;
    }
    return longest; /* squared */
}

/* At rest no triangle may turn too far or become a line, unless it was one. */
static int shape_allows(const lod_surface *s, const lod_move *m)
{
    for (uint32_t i = 0; i < m->kept_count; i++) {
        float before[9], after[9], n0[3], n1[3], l0, l1, longest;
        lod_move_triangle(s, m->kept[i], m->from, 0, before);
        lod_move_triangle(s, m->kept[i], m->to, 0, after);
        l0 = cross_of(before, n0);
        l1 = cross_of(after, n1);
        longest = longest_edge(after);
        if (l1 <= SLIVER * SLIVER * longest * longest && l1 <= l0) {
            return 0;
        }
        if (l0 > 0.0f && n0[0] * n1[0] + n0[1] * n1[1] + n0[2] * n1[2] < (float)TURN_COSINE * sqrtf(l0 * l1)) {
            return 0;
        }
    }
    return 1;
}

static uint32_t wedge_after(const lod_move *m, uint32_t wedge)
{
    uint32_t w = 0;
    while (m->wedge_from[w] != wedge) {
        w++;
    }
    return m->wedge_to[w];
}

static double uv_area(const float *a, const float *b, const float *c)
{
    return ((double)b[0] - a[0]) * ((double)c[1] - a[1]) - ((double)b[1] - a[1]) * ((double)c[0] - a[0]);
}

/* No triangle may flip in UV space, or shrink to a line there. */
static int uv_allows(const lod_surface *s, const lod_move *m)
{
    const float *uv = s->mesh->uv;
    for (uint32_t i = 0; uv && i < m->kept_count; i++) {
        uint32_t c = m->kept[i], from = s->corner[c], to = wedge_after(m, from);
        const float *a = uv + (size_t)s->corner[lod_next(c)] * 2u, *b = uv + (size_t)s->corner[lod_previous(c)] * 2u;
        double before = uv_area(uv + (size_t)from * 2u, a, b), after = uv_area(uv + (size_t)to * 2u, a, b);
        if ((before > 0.0 && after <= 0.0) || (before < 0.0 && after >= 0.0)) {
            return 0;
        }
    }
    return 1;
}

int lod_move_allowed(lod_surface *s, const lod_fan *fan, uint32_t to, lod_move *m)
{
    m->from = fan->point;
    m->to = to;
    return !s->locked[fan->point] && border_allows(fan, to) && map_wedges(s, fan, m) && link_allows(s, fan, m) &&
           uv_allows(s, m) && shape_allows(s, m) && lod_cards_allow(s, m);
}

void lod_move_apply(lod_surface *s, const lod_move *m)
{
    uint32_t *end = &s->first[m->to];
    lod_cards_move(s, m);
    for (uint32_t i = 0; i < m->gone_count; i++) {
        uint32_t t = m->gone[i] / 3u;
        s->dead[t] = 1;
        s->live[s->submesh[t]]--;
    }
    while (*end != LOD_NONE) {
        end = &s->next[*end];
    }
    for (uint32_t i = 0; i < m->kept_count; i++) {
        uint32_t c = m->kept[i];
        s->corner[c] = wedge_after(m, s->corner[c]);
        s->next[c] = LOD_NONE;
        *end = c;
        end = &s->next[c];
    }
    s->first[m->from] = LOD_NONE;
    s->removed[m->from] = 1;
}
