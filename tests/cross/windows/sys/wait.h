/* wait.h: for Windows, where the tests start no program. */
#ifndef NOH_TESTS_CROSS_WINDOWS_SYS_WAIT_H
#define NOH_TESTS_CROSS_WINDOWS_SYS_WAIT_H

#include <sys/types.h>

#define fork() ((pid_t)-1)
#define waitpid(child, status, options) ((void)(child), (void)(status), (pid_t)-1)
#define WIFEXITED(status) 1
#define WEXITSTATUS(status) (status)

#endif
