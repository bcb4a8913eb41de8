/* refused_memory.h: a message where a library cannot report that memory was refused. */
#ifndef NOH_REFUSED_MEMORY_H
#define NOH_REFUSED_MEMORY_H

#ifdef __cplusplus
extern "C" {
#endif

/* Exit with status 1 and "noh: out of memory" where a C++ library throws std::bad_alloc from a function that must not
 * throw, such as the destructor of its JSON; by default the process aborts there. No output is half-written, since
 * noh_file_write replaces whole files. For programs, not for libraries: it is one handler for the whole process. */
void exit_where_memory_is_refused(void);

#ifdef __cplusplus
}
#endif

#endif
