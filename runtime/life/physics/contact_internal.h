/* contact_internal.h (private to physics/): contacts of a rounded box with a world. Threads: no state; any thread. */
#ifndef NOH_SIM_CONTACT_INTERNAL_H
#define NOH_SIM_CONTACT_INTERNAL_H

#include "noh/body.h"

#define NOH_CONTACTS_MAX 24u /* per body and substep; the deepest are kept */

/* All points within `radius` of a box: a ball if its sides are 0, a capsule if two of them are. */
typedef struct noh_round_box {
    noh_obb box;
    float radius;
} noh_round_box;

typedef struct noh_contact {
    float point[3], normal[3]; /* normal: unit, out of the world */
    float gap;                 /* below 0: depth of the overlap */
} noh_contact;

typedef struct noh_contacts {
    uint32_t count;
    noh_contact at[NOH_CONTACTS_MAX];
} noh_contacts;

/* Find the contacts of a body with a world. body, contacts: relative to the origin */
void noh_contacts_find(const noh_world *world, const float origin[3], const noh_round_box *body,
                       noh_contacts *contacts);

/* Find the surfaces of a world within reach of balls: what its physics answers, then its own shapes; of too many the
 * nearest.
 * shapes  balls[count] one after the other in one question, touches[count] */
void noh_touches_find(const noh_world *world, const noh_world_body *balls, uint32_t count, noh_touches *touches);

#endif
