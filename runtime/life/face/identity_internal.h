/* identity_internal.h (private to face/): how identity targets are found to belong together.
 *
 *   identity.c          descs, memory, people
 *   identity_words.c    names
 *   identity_measure.c  deltas */
#ifndef NOH_FACE_IDENTITY_INTERNAL_H
#define NOH_FACE_IDENTITY_INTERNAL_H

#include "deform/morph/morph.h"
#include "life/face/identity.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 1 where two names have as many words, and all but one of them are equal. Words begin at capitals and behind anything
 * that is no letter or digit. */
int noh_identity_one_word_apart(const char *a, const char *b);
/* 1 where a word of the name says what goes through a whole face: age and its like. */
int noh_identity_name_leads(const char *name);

/* A target's deltas as a whole. Sums are over the vertices that targets move. */
typedef struct noh_identity_moments {
    float square;    /* of |delta|^2 */
    float length;    /* of |delta| */
    float centre[3]; /* of its vertices, weighted by |delta|^2 */
    float sum[3];    /* of deltas */
    uint32_t moved;  /* vertices */
} noh_identity_moments;

/* What only init needs. */
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

/* The deltas of one target into a field. */
void noh_identity_field(const noh_identity_scratch *s, uint32_t target, const noh_morph_layers *field);
/* Of s->field. */
noh_identity_moments noh_identity_moments_of(const noh_identity_scratch *s);
/* The cosine between s->field and s->other; over: 1, only where s->field moves anything. */
float noh_identity_cosine(const noh_identity_scratch *s, int over);
/* The vertices that lie next to each other and face each other, as lips and lids do: s->facing. */
void noh_identity_facing(noh_identity_scratch *s);
/* How much s->field stretches the edges and moves apart what faces each other, at each vertex, at weight 1: s->strain.
 */
void noh_identity_strain(noh_identity_scratch *s);
/* A delta of a vertex; zeros where no target moves it. */
void noh_identity_delta(const noh_identity_scratch *s, const noh_morph_layers *field, uint32_t vertex, float delta[3]);

/* The weight at which the closing target's lids touch, as a function of identity weights: targets[].closing[index].
 * Returns how many pairs of vertices touch; 0: that target closes nothing, and is left alone. */
uint32_t noh_identity_closing(noh_identity_scratch *s, noh_identity_target *targets, uint32_t closing, uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
