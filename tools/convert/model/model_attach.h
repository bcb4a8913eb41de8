/* model_attach.h: the meshes of one model, added to another one: a head to a body. */
#ifndef NOH_CONVERT_MODEL_MODEL_ATTACH_H
#define NOH_CONVERT_MODEL_MODEL_ATTACH_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Move meshes, materials, textures, nodes and skins of `other` to `m`. A node without a mesh whose name `m` has too is
 * that one, namespaces before a colon aside, so that joints of both are the same ones; what lies below it follows it.
 * Other nodes are added. Clips and springs of `other` stay behind, with a warning, and its warnings become m's.
 * A model without skins is put below a joint of `m`, where it stands; nodes that no skin moves are, too, where the
 * joint is named.
 * joint   the name of that joint; NULL: the first with 'head' in its name; without one a warning says that nothing
 *         moves it
 * path    of `other`, for messages
 * errors  1: `other` has no meshes or is skinned and shares no joint with `m`, or `m` has no joint of
 *         that name (*error); out of memory */
int model_attach(model *m, model *other, const char *joint, const char *path, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
