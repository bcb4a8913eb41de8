/* clip_bank_fixture.h: packs with clips of joints, made by the converter out of .bvh files that the tests write.
 *
 * A chain of joints swings while its root walks; after CLIP_PASS_FRAMES frames at 30 Hz the pose is the first one
 * again, except for the distance walked. */
#ifndef NOH_TESTS_SUPPORT_CLIP_BANK_FIXTURE_H
#define NOH_TESTS_SUPPORT_CLIP_BANK_FIXTURE_H

#include "convert/convert.h"
#include "noh/clip.h"

#define CLIP_PASS_FRAMES 61u

/* Write NAME.bvh: `names` is one letter for each joint. Returns its path (see test_path). */
const char *clip_bvh(const char *name, const char *names, uint32_t frames);

/* Build a pack from inputs: aligned bytes, to be freed. Fails the test where that fails. */
uint8_t *clip_pack(const char *const *inputs, int count, const convert_options *options, size_t *bytes);

/* A model with weights, and with a joint that one of its clips moves: test_model of one mesh with
 * `targets` targets whose clip "linear" moves node 0, has a key and two markers. Free with model_free. */
model *clip_model(uint32_t targets);

/* A controller and its scratch over a set. */
typedef struct clip_player {
    noh_clip_bank *set;
    noh_controller *c;
    noh_pose_scratch scratch;
    void *memory, *scratch_memory;
    noh_transform *pose; /* [joint_count] */
    float *floats;       /* [float_count] */
} clip_player;

void clip_player_open(clip_player *p, noh_clip_bank *set);
void clip_player_close(clip_player *p);
void clip_start(clip_player *p, uint32_t clip, noh_loop loop, int32_t speed, int64_t tick);
/* One frame of a game: all calls that clip.h names, in its order. */
void clip_frame(clip_player *p, uint32_t ticks, uint32_t ahead_ticks, uint32_t budget);

#endif
