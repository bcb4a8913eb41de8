/* identity_internal.h (private to face/): grouping of identity targets.
 *
 *   identity.c          descs, memory, people
 *   identity_words.c    names
 *   identity_measure.c  deltas */
#ifndef NOH_FACE_IDENTITY_INTERNAL_H
#define NOH_FACE_IDENTITY_INTERNAL_H

#include "noh/deform.h"
#include "noh/face.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the weight at which target closings[i] closes a person's lids: 0.5..2, 1 on the mesh's own face.
 * shapes  weights[target_count] of the person */
float noh_identity_shut(const noh_identity *identity, const float *weights, uint32_t i);

/* Returns 1 if two names have the same number of words and differ in one. Words begin at capitals and after characters
 * other than letters and digits. */
int noh_identity_one_word_apart(const char *a, const char *b);
/* Returns 1 if a word of the name is a property of the whole face: age and similar. */
int noh_identity_name_leads(const char *name);

/* Moments of a target's deltas. Sums are over the vertices that targets move. */
typedef struct noh_identity_moments {
    float square;    /* of |delta|^2 */
    float length;    /* of |delta| */
    float centre[3]; /* of its vertices, weighted by |delta|^2 */
    float sum[3];    /* of deltas */
    uint32_t moved;  /* vertices */
} noh_identity_moments;

/* Working memory of init. */
typedef struct noh_identity_scratch {
    const noh_mesh *mesh;
    noh_morph_layers field, other; /* positions only: the deltas of two targets */
    float *variance, *strain;      /* [vertex_count] */
    uint32_t *partner, *next;      /* [vertex_count] */
    uint32_t *facing;              /* [vertex_count] */
    const char **names;            /* [target_count] */
    noh_identity_moments *moments; /* [target_count] */
    float middle, size;            /* x of the mesh's middle; the diagonal of its bounds */
} noh_identity_scratch;

/* Accumulate the deltas of one target into a field. */
void noh_identity_field(const noh_identity_scratch *s, uint32_t target, const noh_morph_layers *field);
/* Get the moments of s->field. */
noh_identity_moments noh_identity_moments_of(const noh_identity_scratch *s);
/* Get the cosine between s->field and s->other. over: 1 uses only vertices that s->field moves. */
float noh_identity_cosine(const noh_identity_scratch *s, int over);
/* Find vertices that are close and face each other, as lips and lids do: s->facing. */
void noh_identity_facing(noh_identity_scratch *s);
/* Compute how much s->field, at weight 1, stretches edges and separates facing vertices, per vertex: s->strain. */
void noh_identity_strain(noh_identity_scratch *s);
/* Get the delta of a vertex; zeros if no target moves it. */
void noh_identity_delta(const noh_identity_scratch *s, const noh_morph_layers *field, uint32_t vertex, float delta[3]);

/* Compute the weight at which the closing target's lids touch, as a function of identity weights:
 * targets[].closing[index]. Returns the number of touching pairs of vertices; 0: that target closes nothing and is
 * ignored. */
uint32_t noh_identity_closing(noh_identity_scratch *s, noh_identity_target *targets, uint32_t closing, uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
