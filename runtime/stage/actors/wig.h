/* wig.h: hair of the actors of a kind.
 *
 *   noh_wig_make    a haircut and the joint that carries it
 *   noh_wig_part    the part that moves it, for noh_kind_desc.parts
 *   noh_wig_points  where its control hairs are
 *   noh_wig_seen    where its head is, as it was shown
 *
 * Control hairs (hair.h) are state of the stage like all that parts have (part.h): planned, saved, forked and
 * hashed, with the same bits for any number of jobs. stage_hair.h draws them.
 *
 * Threads: as part.h. `wind` may be changed between frames. */
#ifndef NOH_ACTORS_WIG_H
#define NOH_ACTORS_WIG_H

#include "life/hair/haircut.h"
#include "stage/cast/part.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_wig {
    const noh_haircut *cut;
    uint32_t joint; /* NOH_NONE: the actor itself */
    float wind[3];  /* as in noh_hair_carrier, world */
} noh_wig;

/* skeleton  of the kind; in one without, joint_count is 0
 * errors    NOT_FOUND the skeleton has no such joint */
noh_result noh_wig_make(const noh_haircut *cut, const noh_pack *pack, uint32_t skeleton, noh_wig *out,
                        noh_error *error);

/* The part; the wig and its haircut must outlive the stage. Of each actor 16 bytes and those of noh_hair_size. */
noh_stage_part noh_wig_part(const noh_wig *wig);

/* shapes  state: of noh_actor_part; points[hair_count][point_count][3], head space; at rest where none was posed */
void noh_wig_points(const noh_wig *wig, const void *state, float *points);

/* Where the head of an actor is, as the last frame showed it.
 * shapes   world[12]: from head space (metres); pixels_per_metre: of head space; views: a bit for each view that sees
 *          it
 * returns  0 if it was not shown; nothing is written then */
int noh_wig_seen(const noh_wig *wig, const noh_stage *stage, noh_actor actor, float world[12], float *pixels_per_metre,
                 uint32_t *views);

#ifdef __cplusplus
}
#endif

#endif
