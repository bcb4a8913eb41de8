/* crowd_measure.c: overlaps and waiting, found with a grid. */
#include "crowd_measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define END 0xffffffffu

int crowd_meter_open(crowd_meter *meter, uint32_t count)
{
    meter->head = malloc(CROWD_METER_SIDE * CROWD_METER_SIDE * sizeof *meter->head);
    meter->next = malloc(count * sizeof *meter->next);
    meter->slow = calloc(count, sizeof *meter->slow);
    meter->held = calloc(count, sizeof *meter->held);
    meter->count = count;
    return meter->head && meter->next && meter->slow && meter->held;
}

void crowd_meter_close(crowd_meter *meter)
{
    free(meter->head);
    free(meter->next);
    free(meter->slow);
    free(meter->held);
}

typedef struct cells {
    double low[2], edge;
} cells;

static uint32_t index_of(double at, double low, double edge)
{
    const double cell = (at - low) / edge;
    return cell >= CROWD_METER_SIDE ? CROWD_METER_SIDE - 1u : (uint32_t)cell;
}

static cells sorted(crowd_meter *meter, const noh_crowd_agent *agents)
{
    cells c = { { 1e30, 1e30 }, 0.0 };
    for (uint32_t i = 0; i < meter->count; i++) {
        for (int k = 0; k < 2; k++) c.low[k] = fmin(c.low[k], (double)agents[i].position[k]);
        c.edge = fmax(c.edge, 4.0 * (double)agents[i].radius);
    }
    memset(meter->head, 0xff, CROWD_METER_SIDE * CROWD_METER_SIDE * sizeof *meter->head);
    for (uint32_t i = 0; i < meter->count; i++) {
        const float *p = agents[i].position;
        uint32_t *head = &meter->head[index_of((double)p[1], c.low[1], c.edge) * CROWD_METER_SIDE +
                                      index_of((double)p[0], c.low[0], c.edge)];
        meter->next[i] = *head;
        *head = i;
    }
    return c;
}

/* The surroundings of one agent. */
typedef struct around {
    double overlap; /* the worst, of the sum of radii */
    int blocked;    /* someone is in front, nearer than a step's width */
} around;

static void meet(const noh_crowd_agent *a, const noh_crowd_agent *b, const double ahead[2], around *out)
{
    const double x = (double)b->position[0] - (double)a->position[0];
    const double z = (double)b->position[1] - (double)a->position[1];
    const double radii = (double)a->radius + (double)b->radius, along = x * ahead[0] + z * ahead[1];
    out->overlap = fmax(out->overlap, (radii - sqrt(x * x + z * z)) / radii);
    if (along > 0.0 && fabs(x * ahead[1] - z * ahead[0]) < radii && along < 2.0 * radii) out->blocked = 1;
}

static around look(const crowd_meter *meter, const cells *c, const noh_crowd_agent *agents, uint32_t i,
                   const double ahead[2])
{
    const uint32_t column = index_of((double)agents[i].position[0], c->low[0], c->edge);
    const uint32_t row = index_of((double)agents[i].position[1], c->low[1], c->edge);
    around out = { 0.0, 0 };
    for (uint32_t z = row ? row - 1u : 0; z <= row + 1u && z < CROWD_METER_SIDE; z++) {
        for (uint32_t x = column ? column - 1u : 0; x <= column + 1u && x < CROWD_METER_SIDE; x++) {
            for (uint32_t j = meter->head[z * CROWD_METER_SIDE + x]; j != END; j = meter->next[j]) {
                if (j != i) meet(&agents[i], &agents[j], ahead, &out);
            }
        }
    }
    return out;
}

void crowd_meter_add(crowd_meter *meter, const noh_crowd_agent *before, const noh_crowd_agent *now,
                     const float (*ways)[2], crowd_measures *m)
{
    const cells c = sorted(meter, now);
    for (uint32_t i = 0; i < meter->count; i++) {
        const noh_crowd_agent *a = &now[i], *b = &before[i];
        const double x = (double)b->goal[0] - (double)b->position[0], z = (double)b->goal[1] - (double)b->position[1];
        const double far = sqrt(x * x + z * z), ahead[2] = { (double)ways[i][0], (double)ways[i][1] };
        const double towards = (double)a->velocity[0] * ahead[0] + (double)a->velocity[1] * ahead[1];
        const double speed = hypot((double)a->velocity[0], (double)a->velocity[1]);
        const around seen = look(meter, &c, now, i, ahead);
        m->overlap_max = fmax(m->overlap_max, seen.overlap);
        m->overlapped += seen.overlap > 0.05;
        m->agent_steps++;
        const int stands = far > 2.0 * (double)a->radius && speed < 0.05 * (double)a->speed;
        meter->held[i] = stands ? meter->held[i] + 1u : 0;
        meter->slow[i] = stands && !seen.blocked ? meter->slow[i] + 1u : 0;
        m->held_max = meter->held[i] > m->held_max ? meter->held[i] : m->held_max;
        m->stuck_max = meter->slow[i] > m->stuck_max ? meter->slow[i] : m->stuck_max;
        if (far <= 2.0 * (double)a->radius || !(a->speed > 0.0f)) continue;
        m->progress += towards / (double)a->speed;
        m->under_way++;
    }
}
