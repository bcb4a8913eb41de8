/* Catmull-Clark subdivision of a closed cage. */
#ifndef PUPPET_SUBDIVIDE_H
#define PUPPET_SUBDIVIDE_H

#include "cage.h"

/* Every face becomes four. Positions and joint weights follow the rules of Catmull and Clark ("Recursively
 * generated B-spline surfaces on arbitrary topological meshes", 1978); texture coordinates are halved within each face,
 * so that seams stay where they are; each face passes on its paint. */
Cage subdivide(const Cage *cage);

#endif
