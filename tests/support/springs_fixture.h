/* springs_fixture.h: a small pack with springs: a body of ten joints that a .bvh brings, a tail that forks, a scarf.
 */
#ifndef NOH_TESTS_SUPPORT_SPRINGS_FIXTURE_H
#define NOH_TESTS_SUPPORT_SPRINGS_FIXTURE_H

#include <string.h>

#include "convert/convert.h"
#include "support.h"

#define SPRINGS_FIXTURE_TURNS "CHANNELS 3 Zrotation Xrotation Yrotation\n"

/* clang-format off */
static const char springs_fixture_bvh[] =
    "HIERARCHY\nROOT hips\n{\nOFFSET 0 100 0\n"
    "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "JOINT tail1\n{\nOFFSET 0 -5 -10\n" SPRINGS_FIXTURE_TURNS
    "JOINT tail2\n{\nOFFSET 0 -10 -10\n" SPRINGS_FIXTURE_TURNS
    "JOINT tail3\n{\nOFFSET 0 -5 0\n" SPRINGS_FIXTURE_TURNS
    "JOINT tail6\n{\nOFFSET 0 -5 0\n" SPRINGS_FIXTURE_TURNS
    "End Site\n{\nOFFSET 0 -12 0\n}\n}\n}\n"
    "JOINT tail4\n{\nOFFSET 3 -10 0\n" SPRINGS_FIXTURE_TURNS
    "JOINT tail5\n{\nOFFSET 0 -9 0\n" SPRINGS_FIXTURE_TURNS
    "End Site\n{\nOFFSET 0 -10 0\n}\n}\n}\n}\n}\n"
    "JOINT chest\n{\nOFFSET 0 30 0\n" SPRINGS_FIXTURE_TURNS
    "JOINT scarf1\n{\nOFFSET 10 10 0\n" SPRINGS_FIXTURE_TURNS
    "JOINT scarf2\n{\nOFFSET 0 -20 0\n" SPRINGS_FIXTURE_TURNS
    "End Site\n{\nOFFSET 0 -20 0\n}\n}\n}\n}\n"
    "}\nMOTION\nFrames: 2\nFrame Time: 0.05\n"
    "0 100 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n"
    "0 101 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n";
/* clang-format on */

static const char *const springs_fixture_lines[] = {
    "collider hips 0.12  0 0 0  0 20 0",
    "collider chest 0.15",
    "chain tail* stiffness 0.8 drag 0.3 gravity 0.5 radius 0.02",
    "chain scarf1 to scarf2 stiffness 0.2 hits chest",
};

/* The pack of a .bvh with these lines; NULL and *failure where it is refused. */
static inline uint8_t *springs_fixture_build(const char *const *lines, uint32_t line_count, const char *file,
                                             size_t *count, convert_failure *failure)
{
    const char *input = test_path("springs.bvh");
    byte_buffer out = { NULL, 0, 0, 0 };
    convert_options options;
    uint8_t *bytes;
    memset(&options, 0, sizeof options);
    options.texts[NOH_CHUNK_SPRINGS] = file;
    options.spring_lines = lines;
    options.spring_line_count = line_count;
    test_write_file(input, springs_fixture_bvh, sizeof springs_fixture_bvh - 1);
    if (convert_files(&input, 1, &options, &out, failure)) return NULL;
    bytes = test_aligned(out.bytes, out.count);
    *count = out.count;
    buffer_free(&out);
    return bytes;
}

static inline uint8_t *springs_fixture_pack(size_t *count)
{
    convert_failure failure;
    uint8_t *bytes = springs_fixture_build(springs_fixture_lines, 4, NULL, count, &failure);
    if (!bytes) fail_msg("%s", failure.error.what);
    return bytes;
}

#endif
