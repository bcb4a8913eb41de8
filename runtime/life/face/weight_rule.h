/* weight_rule.h: what the author of a face allows its morph targets: how far each goes, and which exclude each other.
 *
 *   noh_weight_rules_bind  the rules of a mesh, as its pack tells them
 *   noh_weight_rules_keep  weights that break none of them
 *
 * A weight is any finite number: nothing is clamped unless it is asked for. A mouth that smiles at 0.8 and frowns at
 * 0.6 shows neither, though, and an eye that closes by 1.4 turns its lid inside out. So a pack may say, in its recipe
 * (`noh build --recipe`, or glTF extras):
 *
 *   range TARGET MIN MAX     the target is shown from MIN, at most 0, to MAX, at least 0
 *   oppose TARGET TARGET     two that exclude each other: both lose the smaller one's weight, so that at most one is
 *                            left, and as the one fades into the other neither jumps
 *   share TARGET TARGET ...  those of one group sum up to 1 at most: above that, each keeps its share
 *
 * Ranges are kept first, then opposites, then groups. Negative weights are left alone by the last two. A stage keeps
 * the rules of kinds that ask for it (noh_kind_desc.weight_rules), wherever weights come from. Correctives follow from
 * other targets (corrective.h) and have no rules.
 *
 * source   Lewis and others, "Practice and Theory of Blendshape Facial Models", Eurographics 2014, section 3.1
 * (limits); combining opposites by their difference is the two-ended slider of facial rigs
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
    uint16_t target; /* of a group, the rules of its targets follow each other */
    uint16_t other;  /* OPPOSE: the other one; SHARE: the group's first target that the mesh has; RANGE: 0 */
    uint16_t reserved;
    float low, high; /* RANGE: low at most 0, high at least 0; else 0 */
} noh_weight_rule;

/* The rules whose targets the mesh has, in the order in which they are kept. A group holds those of its targets
 * that the mesh has.
 * shapes   rules[rule_max]
 * returns  how many there are; those past rule_max are not written */
uint32_t noh_weight_rules_bind(const noh_mesh *mesh, noh_weight_rule *rules, uint32_t rule_max);

/* Change weights that break a rule. Those of no rule, and those that break none, keep their bits. NaN of a target with
 * a range becomes its lowest weight.
 * shapes  weights[as many as the rules refer to] */
void noh_weight_rules_keep(const noh_weight_rule *rules, uint32_t rule_count, float *weights);

#ifdef __cplusplus
}
#endif

#endif
