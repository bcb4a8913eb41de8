/* influence_pack.h (private to the pack writer): a vertex's joints and weights as the pack stores them
 * (format.h). */
#ifndef NOH_CONVERT_SKIN_INFLUENCE_PACK_H
#define NOH_CONVERT_SKIN_INFLUENCE_PACK_H

#include "noh/base.h"
#include "convert/model/model.h"

typedef struct influence_list {
    uint32_t count;                       /* with a weight above zero, at least 1 */
    uint32_t joints[NOH_INFLUENCES_MAX];  /* places in the skin's joints, the strongest first */
    uint32_t weights[NOH_INFLUENCES_MAX]; /* in units of 2^-22; the first is one minus the others */
} influence_list;

/* The weights of a vertex as integers that sum to exactly one. Each is off by at most half a unit, the first by as many
 * halves as there are others. Of more than NOH_INFLUENCES_MAX the strongest, divided by their sum. */
void influence_quantise(const model_mesh *mesh, uint32_t vertex, influence_list *out);

/* How many joints move a vertex, 1 to MODEL_INFLUENCES_MAX. */
uint32_t influence_count(const model_mesh *mesh, uint32_t vertex);

/* 1, 2, 4 or 8: enough for the vertex with the most joints. */
uint32_t influence_width(const model_mesh *mesh);

/* One record. places[list.count]: the joints' places in the palette. Returns the words written. */
uint32_t influence_record(const influence_list *list, const uint32_t *places, uint32_t width, uint32_t words[7]);

#endif
