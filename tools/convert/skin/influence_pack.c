#include "influence_pack.h"

#include <math.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"

uint32_t influence_count(const model_mesh *mesh, uint32_t vertex)
{
    const float *weights = mesh->joint_weights + (size_t)vertex * MODEL_INFLUENCES_MAX;
    uint32_t count = 1;
    while (count < MODEL_INFLUENCES_MAX && weights[count] > 0.0f) count++;
    return count;
}

/* The sum of the strongest weights; exactly 1 if there are no others. */
static double strongest_sum(const model_mesh *mesh, uint32_t vertex)
{
    const float *weights = mesh->joint_weights + (size_t)vertex * MODEL_INFLUENCES_MAX;
    double sum = 0.0;
    if (influence_count(mesh, vertex) <= NOH_INFLUENCES_MAX) return 1.0;
    for (uint32_t i = 0; i < NOH_INFLUENCES_MAX; i++) sum += (double)weights[i];
    return sum;
}

void influence_quantise(const model_mesh *mesh, uint32_t vertex, influence_list *out)
{
    const uint16_t *joints = mesh->joints + (size_t)vertex * MODEL_INFLUENCES_MAX;
    const float *weights = mesh->joint_weights + (size_t)vertex * MODEL_INFLUENCES_MAX;
    const double sum = strongest_sum(mesh, vertex);
    uint32_t rest = NOH_WEIGHT_ONE;
    out->count = 1;
    out->joints[0] = joints[0];
    for (uint32_t i = 1; i < NOH_INFLUENCES_MAX; i++) {
        uint32_t weight = (uint32_t)floor((double)weights[i] / sum * (double)NOH_WEIGHT_ONE + 0.5);
        uint32_t most = i == 1 ? NOH_WEIGHT_ONE / 2u
                               : NOH_WEIGHT_ONE / 2u - 1u; /* 22 and 21 bits; only rounding gets there */
        weight = weight < most ? weight : most;
        if (weight) {
            out->joints[out->count] = joints[i];
            out->weights[out->count++] = weight;
            rest -= weight;
        }
    }
    out->weights[0] = rest;
}

uint32_t influence_width(const model_mesh *mesh)
{
    uint32_t most = 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        influence_list list;
        influence_quantise(mesh, v, &list);
        most = list.count > most ? list.count : most;
    }
    return most > 4 ? 8 : most > 2 ? 4 : most;
}

static void put_bits(uint32_t *words, uint32_t bit, uint32_t value)
{
    uint64_t shifted = (uint64_t)value << bit % 32u;
    words[bit / 32u] |= (uint32_t)shifted;
    if (shifted >> 32) {
        words[bit / 32u + 1u] |= (uint32_t)(shifted >> 32);
    }
}

uint32_t influence_record(const influence_list *list, const uint32_t *places, uint32_t width, uint32_t words[7])
{
    uint32_t bit = 0, *weights = words + (width == 8 ? 2 : 1);
    memset(words, 0, 7 * sizeof *words);
    for (uint32_t i = 0; i < width; i++) {
        words[i / 4u] |= places[i < list->count ? i : 0] << 8u * (i % 4u);
        if (i && i < list->count) {
            put_bits(weights, bit, list->weights[i]);
        }
        bit += i == 0 ? 0u : i == 1 ? 22u : 21u;
    }
    return NOH_INFLUENCE_WORDS(width);
}
