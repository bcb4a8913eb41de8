/* wild_text.h: valid small files of every text format that the converter reads, and edits that keep their grammar: a
 * number becomes a wild one, a word another word of the file, a group or a line moves, repeats or goes. */
#ifndef NOH_TESTS_SUPPORT_WILD_TEXT_H
#define NOH_TESTS_SUPPORT_WILD_TEXT_H

#include <stddef.h>
#include <stdint.h>

typedef struct wild_seed {
    const char *name, *text;
} wild_seed;

extern const wild_seed wild_seeds[];
extern const size_t wild_seed_count;

/* Edit text[count] in place, at most to room bytes. JSON stays JSON. The same seed does the same. Returns its length. */
size_t wild_text(char *text, size_t count, size_t room, uint32_t seed);

#endif
