/* names_table.h: the table of names that exporters use (names.h). */
#ifndef NOH_CONVERT_BASE_NAMES_TABLE_H
#define NOH_CONVERT_BASE_NAMES_TABLE_H

/* Lines as in a file of `noh build --names`; ends with NULL. */
extern const char *const names_table[];

#endif
