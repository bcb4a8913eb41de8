/* pack_skin.h (private to the pack writer): the bytes of a skin chunk, and of the skin data in a mesh chunk. */
#ifndef NOH_CONVERT_PACK_PACK_SKIN_H
#define NOH_CONVERT_PACK_PACK_SKIN_H

#include "convert/base/byte_buffer.h"
#include "mesh_layout.h"
#include "noh/format.h"

/* Append a skin chunk. skeleton: the n-th skeleton chunk. */
void pack_skin(const model_skin *skin, uint32_t skeleton, byte_buffer *out);

/* Append the influences, palettes and palette joints of a mesh, and each joint's box; h gets their offsets. */
void pack_influences(const model_mesh *m, const mesh_layout *l, noh_mesh_header *h, size_t base, byte_buffer *out);
void pack_joint_boxes(const model_mesh *m, uint32_t joint_count, noh_mesh_header *h, size_t base, byte_buffer *out);

/* Append the chunk of a mesh whose vertices have more than NOH_INFLUENCES_MAX joints to an empty buffer; nothing where
 * none has, or where dual quaternions move them. mesh: the n-th mesh chunk. */
void pack_influence_list(const model_mesh *m, const mesh_layout *l, uint32_t mesh, byte_buffer *out);

/* Extend a box (smallest, then largest x, y, z) to a point. */
void pack_grow_box(float box[6], const float point[3]);

#endif
