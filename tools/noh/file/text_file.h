/* text_file.h: a text that a user wrote, whole in memory. */
#ifndef NOH_NOH_FILE_TEXT_FILE_H
#define NOH_NOH_FILE_TEXT_FILE_H

#include <stddef.h>

/* *text: the bytes and a zero after them, to be freed; it stays where `may_miss` and there is no such file. A folder, a
 * pipe, a file of more than `bytes_max` bytes and one with zero bytes are errors. Prints an error and returns an exit
 * code; 0 on success. */
int text_file_read(const char *path, int may_miss, size_t bytes_max, char **text);

#endif
