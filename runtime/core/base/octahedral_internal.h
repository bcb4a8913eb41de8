/* octahedral_internal.h: unit vectors as two numbers. Threads: no state; any thread. */
#ifndef NOH_BASE_OCTAHEDRAL_INTERNAL_H
#define NOH_BASE_OCTAHEDRAL_INTERNAL_H

/* Decode an octahedral direction from x and y in -1..1. The sphere is projected on the octahedron |x| + |y| + |z| = 1;
 * its upper half lies in the square as it is, the lower half is folded outwards over the four edges. So z is what x and
 * y leave of 1, and where it is negative x and y are folded back by it. The result is not unit.
 * source  Meyer, Suessmuth, Sussner, Stamminger, Greiner: On floating-point normal vectors, 2010 */
static inline void noh_octahedral_unfold(float x, float y, float out[3])
{
    float z = 1.0f - (x < 0.0f ? -x : x) - (y < 0.0f ? -y : y);
    float fold = z < 0.0f ? -z : 0.0f;
    out[0] = x + (x >= 0.0f ? -fold : fold);
    out[1] = y + (y >= 0.0f ? -fold : fold);
    out[2] = z;
}

#endif
