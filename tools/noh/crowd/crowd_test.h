/* crowd_test.h: `noh crowd --test`: a scene of agents run and measured. */
#ifndef NOH_NOH_CROWD_CROWD_TEST_H
#define NOH_NOH_CROWD_CROWD_TEST_H

#include "crowd_scene.h"

/* dump: a .csv of every agent in every step, or NULL. Returns an exit code. */
int crowd_test_run(const crowd_scene_options *options, const char *dump, int as_json);

#endif
