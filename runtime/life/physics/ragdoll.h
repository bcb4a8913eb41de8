/* low_life.h: what the library keeps to itself of runtime/noh/low_life.h. */
#ifndef NOH_SIM_RAGDOLL_H
#define NOH_SIM_RAGDOLL_H

#include <stddef.h>
#include <stdint.h>

#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- rigs ---- */

#define NOH_RAGDOLL_HINGE 1u  /* rotates about z of its frame only: twist is the angle, there is no swing */
#define NOH_RAGDOLL_SLIDES 2u /* slides within linear_min..linear_max; else the anchors coincide */
#define NOH_RAGDOLL_LOOSE 4u  /* no limits of swing and twist: a ball joint */

/* Make masses more equal, so that heavy bodies do not pull light joints apart: child over parent within 0.8..1.2, with
 * the same total; a parent's inertia is raised to at most twice its own if its children have more.
 * source  Strunk: Stop my constraints from blowing up, as implemented in Jolt */
void noh_ragdoll_stabilize(noh_ragdoll_rig *rig);

/* Check a rig.
 * errors  ARG a number out of its range (where: the body); LIMIT too many bodies or pairs */
noh_result noh_ragdoll_rig_check(const noh_ragdoll_rig *rig, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
