/* contact_internal.h (private to sim/): where a rounded box touches a world. Threads: no state; any thread. */
#ifndef NOH_SIM_CONTACT_INTERNAL_H
#define NOH_SIM_CONTACT_INTERNAL_H

#include "life/physics/world.h"

#define NOH_CONTACTS_MAX 24u /* of a body in one substep; of more the deepest are kept */

/* All that is no farther than `radius` from a box: a ball where its sides are 0, a capsule where two are. */
typedef struct noh_round_box {
    noh_obb box;
    float radius;
} noh_round_box;

typedef struct noh_contact {
    float point[3], normal[3]; /* normal: unit, out of the world */
    float gap;                 /* below 0: it overlaps by so much */
} noh_contact;

typedef struct noh_contacts {
    uint32_t count;
    noh_contact at[NOH_CONTACTS_MAX];
} noh_contacts;

/* What of a body overlaps a world. body, contacts: from the origin */
void noh_contacts_find(const noh_world *world, const float origin[3], const noh_round_box *body,
                       noh_contacts *contacts);

#endif
