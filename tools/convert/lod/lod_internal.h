/* lod_internal.h (private to lod_*.c): the surface while it is simplified.
 *
 * A point is a position of the surface: the vertices that lie there and move alike (wedges). The
 * first of them identifies it. A corner is 3 x triangle + place. */
#ifndef NOH_CONVERT_LOD_LOD_INTERNAL_H
#define NOH_CONVERT_LOD_LOD_INTERNAL_H

#include "lod.h"

#define LOD_NONE 0xffffffffu
#define LOD_FAN_MAX 96u /* triangles around a point; one with more stays */
#define LOD_RING_MAX (2u * LOD_FAN_MAX)
#define LOD_ATTRIBUTES 6u    /* u, v, r, g, b, a */
#define LOD_REST_WEIGHT 1.6f /* factor on distances at rest, the pose that is seen most */

/* ---- input: lod_check.c ---- */

/* Both return 1 and fill *error for what cannot be built; options get their defaults. */
int lod_check_mesh(const model_mesh *mesh, const lod_options *o, model_error *error);
int lod_check_options(lod_options *o, uint32_t target_count, model_error *error);

/* ---- poses: lod_poses.c ---- */

/* Pose 0 is rest; then come the targets, the mixes and the caller's poses. */
typedef struct lod_poses {
    uint32_t count, words; /* words: 64-bit words of a set of poses */
    uint32_t first_given;  /* the first of the caller's poses */
    float *weight;         /* [count] factor on squared distances, before growth (lod_measure.c) */
    float *position;       /* [vertex_count][count][3] */
    uint64_t *moves;       /* [vertex_count][words] the poses in which a vertex is not at rest */
} lod_poses;

int lod_poses_make(const model_mesh *mesh, const lod_options *o, lod_poses *out);
void lod_poses_free(lod_poses *p);

#define LOD_MIXES 24u /* by default */
/* The weights of mixes of a quarter of the targets each, [LOD_MIXES][target_count]. */
void lod_poses_mixes(uint32_t target_count, float *out);

static inline const float *lod_posed(const lod_poses *p, uint32_t vertex, uint32_t pose)
{
    return p->position + ((size_t)vertex * p->count + pose) * 3u;
}

static inline int lod_set_has(const uint64_t *set, uint32_t pose)
{
    return (int)(set[pose / 64u] >> (pose % 64u) & 1u);
}

/* Arrays for level->index_count indices. Returns 1 when out of memory. lod_cut.c */
int lod_level_alloc(lod_level *level, uint32_t submesh_count);

/* ---- the surface: lod_surface.c ---- */

/* lod_cards.c */
typedef struct lod_card {
    double full, left; /* areas at rest */
    uint32_t triangles;
} lod_card;

typedef struct lod_surface {
    const model_mesh *mesh;
    lod_poses poses;
    uint32_t triangle_count;
    uint32_t *point_of;         /* [vertex_count] */
    uint32_t *corner;           /* [triangle_count][3] vertices, as the collapses so far leave them */
    uint32_t *first, *next;     /* [vertex_count], [3 triangle_count]: the corners at a point, LOD_NONE ends */
    uint32_t *submesh, *island; /* [triangle_count]; an island: triangles joined by shared vertices */
    uint32_t *live;             /* [submesh_count] triangles left */
    uint8_t *dead;              /* [triangle_count] */
    uint8_t *locked, *removed;  /* [vertex_count] by point */
    uint8_t *face;              /* [vertex_count] by point: a target moves it */
    uint8_t *minor;             /* [submesh_count] a small part, such as teeth */
    uint32_t *part;             /* [vertex_count] by point: the submesh of one of its triangles */
    uint64_t *shows;  /* [vertex_count][poses.words] by point: the poses in which a rim opens or closes there */
    uint8_t *faceted; /* [vertex_count] by point: nearly each triangle around it has a vertex of its own there */
    uint32_t *other;  /* [vertex_count] by point: the one that touches it at rest and moves away, or LOD_NONE */
    uint32_t *card;   /* [vertex_count] by point: into cards, or LOD_NONE */
    lod_card *cards;
    uint32_t card_count;
    uint32_t *mark; /* [vertex_count] scratch of the link test */
    uint32_t stamp;
    float *attribute; /* [vertex_count][LOD_ATTRIBUTES] as lengths */
    float skin_length;
    float edge; /* the mean length of an edge at rest */
} lod_surface;

/* Returns 1 when out of memory. */
int lod_surface_make(const model_mesh *mesh, const lod_options *o, lod_surface *out);
void lod_surface_free(lod_surface *s);

/* Find the rims (lod_rims.c). Returns 1 when out of memory. */
int lod_rims_mark(lod_surface *s);

/* Find the cards; border [vertex_count] by point. Returns 1 when out of memory. */
int lod_cards_make(lod_surface *s, const uint8_t *border);
/* Triangles that the cards keep in any case. */
uint32_t lod_cards_least(const lod_surface *s);

/* The live triangles around a point. */
typedef struct lod_fan {
    uint32_t point, count, ring_count;
    uint32_t corner[LOD_FAN_MAX];
    uint32_t ring[LOD_RING_MAX];    /* neighbouring points, in the order met */
    uint8_t ring_use[LOD_RING_MAX]; /* triangles that share the edge to it */
} lod_fan;

/* Returns 1 where there are more than LOD_FAN_MAX triangles, or none. */
int lod_fan_gather(lod_surface *s, uint32_t point, lod_fan *fan);

static inline uint32_t lod_point(const lod_surface *s, uint32_t corner)
{
    return s->point_of[s->corner[corner]];
}
/* xorshift64*: a number in 0..1, below 1. */
static inline double lod_random(uint64_t *state)
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (double)((*state * UINT64_C(0x2545f4914f6cdd1d)) >> 40) / 16777216.0;
}
static inline uint32_t lod_next(uint32_t corner)
{
    return corner % 3u == 2u ? corner - 2u : corner + 1u;
}
static inline uint32_t lod_previous(uint32_t corner)
{
    return corner % 3u ? corner - 1u : corner + 2u;
}

/* ---- one collapse: lod_move.c ---- */

typedef struct lod_move {
    uint32_t from, to; /* points */
    uint32_t wedge_count;
    uint32_t wedge_from[LOD_FAN_MAX], wedge_to[LOD_FAN_MAX];
    uint32_t kept_count, gone_count;
    uint32_t kept[LOD_FAN_MAX]; /* corners at `from` of the triangles that stay */
    uint32_t gone[LOD_FAN_MAX]; /* of those that vanish */
} lod_move;

/* 1 if the collapse keeps topology, seams, borders and orientation; fills *move. */
int lod_move_allowed(lod_surface *s, const lod_fan *fan, uint32_t to, lod_move *move);
void lod_move_apply(lod_surface *s, const lod_move *move);

/* Find the points that touch. Returns 1 when out of memory. lod_contact.c */
int lod_contacts_make(lod_surface *s);
/* Where the point that touches one goes if that one goes to `to`. */
uint32_t lod_contact_goes_to(const lod_surface *s, uint32_t to);
/* 1 if the point that touches a fan's, if any, may go with it; `to` is allowed for the fan's own. */
int lod_contact_allows(lod_surface *s, const lod_fan *fan, uint32_t to);

/* Whether a card would keep its area, and the move done to it; to be called before lod_move_apply. lod_cards.c */
int lod_cards_allow(const lod_surface *s, const lod_move *move);
void lod_cards_move(lod_surface *s, const lod_move *move);

/* The triangle of a corner in a pose, with that corner moved to `point`; [3][3]. */
void lod_move_triangle(const lod_surface *s, uint32_t corner, uint32_t point, uint32_t pose, float *out);

/* ---- quadrics: lod_quadric.c ---- */

typedef struct lod_quadric {
    double a[10], area; /* symmetric 4 x 4, upper half by rows */
} lod_quadric;

/* One point: only the poses in which something around it moves, ascending, rest first. */
typedef struct lod_quadric_row {
    uint32_t count;
    uint16_t *pose;
    lod_quadric *quadric;
} lod_quadric_row;

lod_quadric_row *lod_quadrics_make(lod_surface *s); /* [vertex_count], NULL: out of memory */
void lod_quadrics_free(lod_quadric_row *rows, uint32_t count);
/* The mean squared distance to the planes of both points, at `to`, in the worst pose. */
double lod_quadric_cost(const lod_surface *s, const lod_quadric_row *rows, uint32_t from, uint32_t to);
/* Add from's to to's. Returns 1 when out of memory. */
int lod_quadric_merge(lod_quadric_row *rows, uint32_t from, uint32_t to);

/* ---- distances: lod_distance.c ---- */

#define LOD_LANES 8u

/* A corner, the edge from it, and the plane through that edge perpendicular to the triangle. */
typedef struct lod_edge {
    float at[3], along[3], side[3], inverse; /* inverse: 1 / |along|^2, 0 for an edge without length */
} lod_edge;

/* A triangle that many points are measured to. */
typedef struct lod_prepared {
    lod_edge edges[3];
    float normal[3], inverse; /* 1 / |normal|^2, 0 for a triangle without area */
} lod_prepared;

void lod_prepare(const float *triangle, lod_prepared *out);
/* The squared distance to one, and the weights of the nearest place on it, [3]. */
float lod_distance_weights(const lod_prepared *p, const float *point, float *barycentric);

/* squared[i] = min(squared[i], squared distance of sample i to the triangle [3][3]); count is a multiple of LOD_LANES.
 */
void lod_distance_triangle(const float *triangle, const float *x, const float *y, const float *z, uint32_t count,
                           float *squared);
/* The same, and nearest[i] = which where it fell. */
void lod_distance_nearest(const float *triangle, uint32_t which, const float *x, const float *y, const float *z,
                          uint32_t count, float *squared, uint32_t *nearest);
/* LOD_LANES triangles side by side, for one point at a time. */
typedef struct lod_block {
    float edges[3][10][LOD_LANES]; /* lod_edge, number by number */
    float normal[3][LOD_LANES], inverse[LOD_LANES];
} lod_block;

/* 1 to LOD_LANES triangles, [count][9]; the lanes behind them have the last one. */
void lod_block_prepare(const float *triangles, uint32_t count, lod_block *out);
/* The squared distances of a point to all of them, [LOD_LANES]. */
void lod_block_distances(const lod_block *restrict b, const float *point, float *restrict squared);
/* One point. */
float lod_distance_point(const float *triangle, const float *point);

/* The weights of the nearest place alone, [3]. */
void lod_distance_place(const float *triangle, const float *point, float *out);

/* The normal of a triangle [3][3], as long as twice its area. */
static inline void lod_normal(const float *t, float *out)
{
    const float a[3] = { t[3] - t[0], t[4] - t[1], t[5] - t[2] }, b[3] = { t[6] - t[0], t[7] - t[1], t[8] - t[2] };
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* The squared distance of a point to the place of given weights on a triangle [3][3]. */
static inline float lod_distance_from(const float *c, const float *w, float x, float y, float z)
{
    x -= w[0] * c[0] + w[1] * c[3] + w[2] * c[6];
    y -= w[0] * c[1] + w[1] * c[4] + w[2] * c[7];
    z -= w[0] * c[2] + w[1] * c[5] + w[2] * c[8];
    return x * x + y * y + z * z;
}

/* ---- tracked samples: lod_track.c, lod_measure.c ---- */

typedef struct lod_track lod_track;

lod_track *lod_track_make(lod_surface *s);
void lod_track_free(lod_track *t);
/* Open one fan: find its attached samples, and the poses in which it moves. Returns 1 when out of memory. */
int lod_track_open(lod_track *t, const lod_fan *fan);
/* How many distances were measured so far. */
uint64_t lod_track_work(const lod_track *t);
/* The mesh's triangles whose centroids are attached to the open fan. */
const uint32_t *lod_track_triangles(const lod_track *t, uint32_t *count);
/* The cost of a move: the largest weighted squared distance, over the fan's poses, between the samples and the surface
 * that the move leaves, both ways; stops at `bound`. *squared: the largest one unweighted. */
double lod_track_cost(lod_track *t, const lod_move *move, double bound, double *squared);
/* Less than the cost of a move, by the samples at rest alone. */
double lod_track_least(lod_track *t, const lod_move *move);
/* Attach the fan's samples, and the removed point itself, to the triangles that stay. To be called before
 * lod_move_apply. */
void lod_track_commit(lod_track *t, const lod_move *move);

/* ---- attributes: lod_attribute.c ---- */

int lod_attributes_make(lod_surface *s, const lod_options *o);
/* The largest squared error, as lengths, of UVs and colours at the centroids of triangles (their corners are in
 * source: the mesh's indices, or lod_surface.corner), and of the skin weights of the point that goes.
 * *parts: the largest squared distance at rest of triangles to what is left of their submesh, which is in it too. */
double lod_attribute_cost(const lod_surface *s, const lod_move *move, const uint32_t *triangles, uint32_t count,
                          const uint32_t *source, double *parts);

#endif
