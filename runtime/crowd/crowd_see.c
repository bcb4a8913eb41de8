/* crowd_see.c: the nearest neighbours of each agent. */
#include "crowd/crowd_internal.h"

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

/* By distance, and by id where distances are equal: so the list does not depend on the order of agents. */
static inline int is_before(const noh_crowd *c, float square, uint32_t rank, const seen *s, uint32_t at)
{
    return square < s->square[at] || (square == s->square[at] && id_of(c, rank) < id_of(c, s->rank[at]));
}

static inline void insert(const noh_crowd *c, seen *s, float square, uint32_t rank, uint32_t name)
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

void noh_crowd_see(noh_crowd *c, uint32_t rank, const crowd_runs *runs)
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body);
    uint16_t *names = CROWD_ARRAY(uint16_t, c, neighbor) + (size_t)rank * CROWD_NEIGHBORS;
    const vec2 at = bodies[rank].at;
    const uint32_t last = CROWD_NEIGHBORS - 1u;
    float limit = c->reach * c->reach; /* nothing further away is of use */
    seen s;
    s.count = 0;
    for (uint32_t run = 0; run < runs->count; run++) {
        const uint32_t first = runs->first[run], end = runs->end[run];
        const uint32_t stop = end - first > CROWD_RUN_MAX ? first + CROWD_RUN_MAX : end;
        for (uint32_t j = first; j < stop; j++) {
            const vec2 away = v2_sub(bodies[j].at, at);
            const float square = v2_dot(away, away);
            if (square > limit || j == rank) continue;
            if (s.count > last && !is_before(c, square, j, &s, last)) continue;
            insert(c, &s, square, j, run << 14 | (j - first));
            if (s.count > last) limit = s.square[last];
        }
    }
    for (uint32_t k = 0; k < CROWD_NEIGHBORS; k++) names[k] = k < s.count ? s.name[k] : CROWD_NO_NEIGHBOR;
}
