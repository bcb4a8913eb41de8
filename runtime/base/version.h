/* version.h: the library's version, semantic: MAJOR.MINOR.PATCH. Before 1.0 a new MINOR may change the API. */
#ifndef NOH_BASE_VERSION_H
#define NOH_BASE_VERSION_H

#define NOH_VERSION "0.2.0"

#endif
