/* pack_order.h: a pack whose triangles and vertices are in an order that makes its wire form small. */
#ifndef CONVERT_PACK_PACK_ORDER_H
#define CONVERT_PACK_PACK_ORDER_H

#include "convert/base/byte_buffer.h"
#include "convert/base/error.h"
#include "noh/pack.h"

/* The same pack in `out`, of the same size: triangles of a submesh follow each other over their edges, unless it is
 * blended, where their order shows; vertices that the same targets move are in the order in which triangles come to
 * them. What is drawn is the same. 0, or 1 and a filled error. */
int pack_order(const noh_pack *pack, byte_buffer *out, model_error *error);

#endif
