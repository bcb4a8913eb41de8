/* fuzz_replay.h: the fuzzers' main without libFuzzer (make check): every file that is given, or lies in a
 * folder that is given, is tried as it is and damaged in a few thousand seeded ways; each is a test. */
#ifndef TESTS_FUZZ_REPLAY_H
#define TESTS_FUZZ_REPLAY_H

#include <stddef.h>
#include <stdint.h>

/* Try one input; 1 when it was accepted. */
typedef int (*fuzz_try)(const uint8_t *bytes, size_t count);

/* What main returns. */
int fuzz_replay(int argument_count, char **arguments, fuzz_try try_input);

#endif
