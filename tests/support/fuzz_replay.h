/* fuzz_replay.h: the fuzzers' main without libFuzzer (make check): each file given, or in a folder given, is one test:
 * it is tried as it is, then damaged in a few thousand seeded ways. */
#ifndef TESTS_FUZZ_REPLAY_H
#define TESTS_FUZZ_REPLAY_H

#include <stddef.h>
#include <stdint.h>

/* Try one input; 1 when it was accepted. */
typedef int (*fuzz_try)(const uint8_t *bytes, size_t count);

/* Returns what main must return. */
int fuzz_replay(int argument_count, char **arguments, fuzz_try try_input);

#endif
