/* crowd_see.c: the nearest neighbours of each agent: by distance, and by id where distances are equal, so that the list
 * does not depend on the order of agents. */
#include "stage/crowd/crowd_internal.h"
#include "noh/crowd.h"

#define BATCH 64u                   /* agents whose distances are looked at before any is compared */
#define KEPT (CROWD_NEIGHBORS + 1u) /* one more tells whether the last is as far as another */

/* A neighbour's key: the bits of its squared distance, which sort like the distance, then its name. */
#define NOBODY UINT64_MAX

static inline uint32_t square_of(uint64_t key)
{
    return (uint32_t)(key >> 32);
}

/* Keys of neighbours within the limit; returns their number. No branch on the distance, which would be
 * unpredictable. */
static inline uint32_t gather(const crowd_body *bodies, uint32_t self, uint32_t begin, uint32_t end, uint32_t name,
                              float limit, uint64_t keys[BATCH])
{
    const vec2 at = bodies[self].at;
    uint32_t count = 0;
    for (uint32_t j = begin; j < end; j++, name++) {
        const vec2 away = v2_sub(bodies[j].at, at);
        const float square = v2_dot(away, away);
        uint32_t bits;
        memcpy(&bits, &square, sizeof bits);
        keys[count] = (uint64_t)bits << 32 | name;
        count += (uint32_t)(square <= limit) & (uint32_t)(j != self);
    }
    return count;
}

/* The least, in order: of `count` one more, up to KEPT; likewise without a branch. returns how many there are now */
static inline uint32_t keep(uint64_t best[KEPT], uint32_t count, uint64_t key)
{
    for (uint32_t k = 0; k < count; k++) {
        const uint64_t there = best[k];
        best[k] = key < there ? key : there;
        key = key < there ? there : key;
    }
    if (count == KEPT) return KEPT;
    best[count] = key;
    return count + 1u;
}

static void find_nearest(const noh_crowd *c, uint32_t rank, const crowd_runs *runs, uint64_t best[KEPT])
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body);
    float limit = c->reach * c->reach; /* nothing further away is of use */
    uint32_t kept = 0;
    for (uint32_t k = 0; k < KEPT; k++) best[k] = NOBODY;
    for (uint32_t run = 0; run < runs->count; run++) {
        const uint32_t first = runs->first[run], end = runs->end[run];
        const uint32_t stop = end - first > CROWD_RUN_MAX ? first + CROWD_RUN_MAX : end;
        for (uint32_t begin = first; begin < stop; begin += BATCH) {
            const uint32_t until = stop - begin > BATCH ? begin + BATCH : stop;
            uint64_t keys[BATCH];
            const uint32_t count = gather(bodies, rank, begin, until, run << 14 | (begin - first), limit, keys);
            for (uint32_t k = 0; k < count; k++) {
                if (keys[k] < best[KEPT - 1u]) kept = keep(best, kept, keys[k]);
            }
            if (best[KEPT - 1u] != NOBODY) {
                const uint32_t bits = square_of(best[KEPT - 1u]);
                memcpy(&limit, &bits, sizeof limit);
            }
        }
    }
}

/* ---- equal distances ---- */

/* Whether ids must break ties. */
static int is_tied(const uint64_t best[KEPT])
{
    int tied = 0;
    for (uint32_t k = 1; k < KEPT; k++) {
        tied |= best[k] != NOBODY && square_of(best[k - 1u]) == square_of(best[k]);
    }
    return tied;
}

typedef struct seen {
    float square[CROWD_NEIGHBORS];
    uint32_t rank[CROWD_NEIGHBORS];
    uint16_t name[CROWD_NEIGHBORS];
    uint32_t count;
} seen;

static uint32_t id_of(const noh_crowd *c, uint32_t rank)
{
    return CROWD_CONST(uint32_t, c, id)[CROWD_ITEM(CROWD_CONST(crowd_body, c, body) + rank)];
}

static inline int is_before(const noh_crowd *c, float square, uint32_t rank, const seen *s, uint32_t at)
{
    return square < s->square[at] || (square == s->square[at] && id_of(c, rank) < id_of(c, s->rank[at]));
}

static void insert(const noh_crowd *c, seen *s, float square, uint32_t rank, uint32_t name)
{
    uint32_t at = s->count < CROWD_NEIGHBORS ? s->count++ : CROWD_NEIGHBORS - 1u;
    for (; at && is_before(c, square, rank, s, at - 1u); at--) {
        s->square[at] = s->square[at - 1u];
        s->rank[at] = s->rank[at - 1u];
        s->name[at] = s->name[at - 1u];
    }
    s->square[at] = square;
    s->rank[at] = rank;
    s->name[at] = (uint16_t)name;
}

/* Select one by one, comparing ids for equal distances. */
static void find_by_id(const noh_crowd *c, uint32_t rank, const crowd_runs *runs, seen *s)
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body);
    const uint32_t last = CROWD_NEIGHBORS - 1u;
    float limit = c->reach * c->reach;
    s->count = 0;
    for (uint32_t run = 0; run < runs->count; run++) {
        const uint32_t first = runs->first[run], end = runs->end[run];
        const uint32_t stop = end - first > CROWD_RUN_MAX ? first + CROWD_RUN_MAX : end;
        for (uint32_t j = first; j < stop; j++) {
            const vec2 away = v2_sub(bodies[j].at, bodies[rank].at);
            const float square = v2_dot(away, away);
            if (square > limit || j == rank) continue;
            if (s->count > last && !is_before(c, square, j, s, last)) continue;
            insert(c, s, square, j, run << 14 | (j - first));
            if (s->count > last) limit = s->square[last];
        }
    }
}

void noh_crowd_see(noh_crowd *c, uint32_t rank, const crowd_runs *runs)
{
    uint16_t *names = CROWD_ARRAY(uint16_t, c, neighbor) + (size_t)rank * CROWD_NEIGHBORS;
    uint64_t best[KEPT];
    seen s;
    find_nearest(c, rank, runs, best);
    if (!is_tied(best)) {
        for (uint32_t k = 0; k < CROWD_NEIGHBORS; k++) {
            names[k] = best[k] == NOBODY ? CROWD_NO_NEIGHBOR : (uint16_t)best[k];
        }
        return;
    }
    find_by_id(c, rank, runs, &s);
    for (uint32_t k = 0; k < CROWD_NEIGHBORS; k++) names[k] = k < s.count ? s.name[k] : CROWD_NO_NEIGHBOR;
}
