/* wild_bytes.h: valid small files and packets of the binary formats that are read, and edits that keep their layout: a
 * number that is there becomes a wild one, words are copied, a part is cut, repeated or moved. */
#ifndef NOH_TESTS_SUPPORT_WILD_BYTES_H
#define NOH_TESTS_SUPPORT_WILD_BYTES_H

#include <stddef.h>
#include <stdint.h>

enum { WILD_C3D, WILD_C3D_FLOATS, WILD_C3D_MIPS, WILD_WAV, WILD_WAV_FLOATS, WILD_OSC, WILD_BYTES_COUNT };
#define WILD_BYTES_ROOM 8192u

extern const char *const wild_bytes_names[WILD_BYTES_COUNT];

/* A valid one, into to[WILD_BYTES_ROOM]. Returns its length. */
size_t wild_bytes_seed(int which, uint8_t *to);
/* Edit bytes[count] in place, at most to room bytes. The same seed does the same. Returns their new count. */
size_t wild_bytes(uint8_t *bytes, size_t count, size_t room, uint32_t seed);

#endif
