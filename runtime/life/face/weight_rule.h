/* weight_rule.h: limits that the author of a face sets on its morph targets: ranges and mutual exclusion.
 *
 *   noh_weight_rules_bind   get the rules of a mesh from its pack
 *   noh_weight_rules_apply  apply them to weights
 *
 * By default a weight is any finite number and nothing is clamped. But a mouth that smiles at 0.8 and frowns at 0.6
 * shows neither, and an eye that closes by 1.4 turns its lid inside out. So the recipe of a pack (`noh build --recipe`,
 * or glTF extras) may contain:
 *
 *   range TARGET MIN MAX     clamp the target to MIN, at most 0, to MAX, at least 0
 *   oppose TARGET TARGET     two targets that exclude each other: subtract the smaller weight from both, so that at
 *                            most one remains, and a fade from one to the other is continuous
 *   share TARGET TARGET ...  the sum of a group is at most 1: above that, all are scaled down
 *
 * Ranges are applied first, then opposites, then groups. The last two ignore negative weights. A stage applies the
 * rules of kinds that request it (noh_kind_desc.weight_rules), whatever the source of the weights. Correctives follow
 * from other targets (corrective.h) and have no rules.
 *
 * source   Lewis and others, "Practice and Theory of Blendshape Facial Models", Eurographics 2014, section 3.1
 *          (limits); combining opposites by their difference is the two-ended slider of facial rigs
 * Threads  no state; any thread */
#ifndef NOH_FACE_WEIGHT_RULE_H
#define NOH_FACE_WEIGHT_RULE_H

#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_weight_rule_kind { NOH_WEIGHT_RANGE = 0, NOH_WEIGHT_OPPOSE, NOH_WEIGHT_SHARE } noh_weight_rule_kind;

typedef struct noh_weight_rule {
    uint16_t kind;   /* noh_weight_rule_kind */
    uint16_t target; /* the rules of a group's targets are consecutive */
    uint16_t other;  /* OPPOSE: the other target; SHARE: the group's first target in the mesh; RANGE: 0 */
    uint16_t reserved;
    float low, high; /* RANGE: low at most 0, high at least 0; else 0 */
} noh_weight_rule;

/* Get the rules for targets of the mesh, in the order in which they are applied. A group contains
 * only its targets in the mesh.
 * shapes   rules[rule_max]
 * returns  the number of rules; rules past rule_max are not written */
uint32_t noh_weight_rules_bind(const noh_mesh *mesh, noh_weight_rule *rules, uint32_t rule_max);

/* Apply the rules to weights. Weights that break no rule keep their bits. NaN of a target with a range becomes its
 * lowest weight.
 * shapes  weights[as many as the rules refer to] */
void noh_weight_rules_apply(const noh_weight_rule *rules, uint32_t rule_count, float *weights);

#ifdef __cplusplus
}
#endif

#endif
