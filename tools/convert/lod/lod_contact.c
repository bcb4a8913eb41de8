/* lod_contact.c: where the surface touches itself at rest and a pose takes it apart, as closed lips do.
 *
 * Both sides have a point at each place of the slit. If one side lost a point that the other keeps, the slit would gape
 * there, and what is behind it would show. So the two points go together, to the two points of one place or to the
 * point where the slit ends. */
#include "lod_internal.h"

#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"

/* Two points of one place are each other's; where more meet, none may go. place: [vertex_count] */
static void pair_points(lod_surface *s, const uint32_t *place, uint32_t *first)
{
    for (uint32_t v = 0; v < s->mesh->vertex_count; v++) {
        s->other[v] = first[v] = LOD_NONE;
    }
    for (uint32_t p = 0; p < s->mesh->vertex_count; p++) {
        uint32_t *at = &first[place[p]];
        if (s->first[p] == LOD_NONE || s->point_of[p] != p) {
            continue;
        }
        if (*at == LOD_NONE) {
            *at = p;
        } else if (s->other[*at] == LOD_NONE) {
            s->other[*at] = p;
            s->other[p] = *at;
        } else {
            s->locked[*at] = s->locked[s->other[*at]] = s->locked[p] = 1;
        }
    }
}

int lod_contacts_make(lod_surface *s)
{
    const size_t vertices = (size_t)s->mesh->vertex_count + 1u;
    model_mesh still = *s->mesh;
    uint32_t *place = calloc(vertices, sizeof *place), *first = calloc(vertices, sizeof *first);
    int failed;
    s->other = calloc(vertices, sizeof *s->other);
    still.target_count = 0;
    failed = !place || !first || !s->other || weld_vertices(&still, place);
    if (!failed) {
        pair_points(s, place, first);
    }
    free(place);
    free(first);
    return failed;
}

static int is_neighbour(const lod_fan *fan, uint32_t point)
{
    uint32_t i = 0;
    while (i < fan->ring_count && fan->ring[i] != point) {
        i++;
    }
    return i < fan->ring_count;
}

uint32_t lod_contact_goes_to(const lod_surface *s, uint32_t to)
{
    return s->other[to] == LOD_NONE ? to : s->other[to];
}

/* At the end of a slit, `to` gets new neighbours by the first move; the second finds the link as it was if they share
 * none but those that `to` has. So the last two points of a slit stay. */
static int end_allows(lod_surface *s, const lod_fan *fan, const lod_fan *across, uint32_t to)
{
    lod_fan end;
    if (lod_fan_gather(s, to, &end)) {
        return 0;
    }
    for (uint32_t i = 0; i < fan->ring_count; i++) {
        const uint32_t shared = fan->ring[i];
        if (shared != to && is_neighbour(across, shared) && !is_neighbour(&end, shared)) {
            return 0;
        }
    }
    return 1;
}

int lod_contact_allows(lod_surface *s, const lod_fan *fan, uint32_t to)
{
    const uint32_t other = s->other[fan->point], there = lod_contact_goes_to(s, to);
    lod_fan across;
    lod_move move;
    if (other == LOD_NONE) {
        return 1;
    }
    if (lod_fan_gather(s, other, &across) || !is_neighbour(&across, there) || is_neighbour(fan, other) ||
        !lod_move_allowed(s, &across, there, &move)) {
        return 0;
    }
    return there == to ? end_allows(s, fan, &across, to) : !is_neighbour(fan, there);
}
