/* crowd_test.h: `noh crowd --test` and `--place`: agents run and measured. */
#ifndef NOH_NOH_CROWD_CROWD_TEST_H
#define NOH_NOH_CROWD_CROWD_TEST_H

#include "crowd_scene.h"
#include "noh/body.h"

/* dump: a .csv of every agent in every step, or NULL. Returns an exit code. */
int crowd_test_run(const crowd_scene_options *options, const char *dump, int as_json);

/* The same in the place of a file: its path in options->name; flags are not used. seconds 0: 60. ground NULL: level */
int crowd_place_run(const crowd_scene_options *options, const noh_field *ground, const char *dump, int as_json);

#endif
