/* help_formats.c: the text formats, as `noh help FORMATS` and the man page show them. A line that begins with a blank
 * is printed as it is. */
#include "help.h"

const char *const help_formats_text[] = {
    "# packs (.noh)",
    "Made by noh build, read by the library where they lie in memory, without parsing. A pack is of one format version: another is "
    "refused, and the model has to be converted again.",
    "# models and clips (noh build IN...)",
    ".gltf, .glb: glTF 2.0: meshes, morph targets, skins, materials, animations. The first input with meshes gives the model.",
    ".bvh: motion capture. Channels may stand in any order; end sites become no joints. --unit-cm says how long a unit is.",
    ".rcl: raw clips without loss, joints only, as noh clip --dump writes them. Little endian, 32-bit floats, centimetres:",
    "   char[4] \"RCL1\"; u32 joints; u32 frames; f32 rate_hz; u32 length; char name[length]",
    "   per joint: i32 parent (-1: a root; parents first); u32 flags (1 rotation, 2 translation, 4 scale animated);",
    "     u32 length; char name[length]; f32 bind[10]; f32 first[10]: qx qy qz qw tx ty tz sx sy sz, local to the parent",
    "   per frame, per joint: the animated ones of q[4], t[3], s[3]; the others equal first[]",
    "# callback keys and sync markers (noh build --events FILE)",
    "One per line, words separated by blanks, names with blanks in double quotes; # begins a comment:",
    "   CLIP TIME_S NAME [PAYLOAD] [min=WEIGHT]     a callback key",
    "   CLIP TIME_S NAME marker                     a sync marker",
    "PAYLOAD is a number, which the callback gets as 8 bytes, little endian: a whole number (also 0x and up to 16 hexadecimal digits) as a "
    "64-bit integer, one with a point or an exponent as a 64-bit float. WEIGHT is the least weight at which the key is delivered.",
    "A marker lies before the end of its clip, and no two markers of a clip share a time. Clips that are to keep step have the same markers "
    "in the same order.",
    "   walk 0.00 left marker",
    "   walk 0.53 right marker",
    "   walk 0.02 step 1 min=0.25",
    "   \"wave hand\" 1.5 sound 0xff",
    "# callback keys in glTF",
    "The extras of an animation say the same; a key that cannot be understood is left out with a warning:",
    "   \"extras\": {\"loop\": true, \"events\": [{\"time\": 0.5, \"name\": \"step\", \"payload\": 7, \"weightMin\": 0.1},",
    "                                      {\"time\": 0.25, \"name\": \"left\", \"marker\": true}]}",
    "# masks",
    "A mask is no file: a game fills bytes, one for each joint and each float of the clip set, 255 for full weight and 0 for untouched "
    "(noh_mask_subtree, noh_mask_fill). Build clips that are played through masks with --for-masks, so that no joint relies on another's error.",
    "# error bounds (noh build --clip-error, --joint-error)",
    "NAME=CM, centimetres over 0; the last equals sign divides. A clip or joint that no input has is refused.",
    "# weights and targets",
    "--weight NAME=V sets a target; V is any number, 1 is the target as it was modelled. A name that no mesh has is refused with the nearest one.",
    "noh sheet --target NAME or NAME=V is a tile; with --lods NAME[=V],NAME[=V]... is a row.",
    "# paths (--path)",
    "How deltas of targets are summed: auto, the cheapest that the driver has; blend, additive blending: layered where supported, else per-layer; layered, one additive pass to three layers through a geometry "
    "shader; mrt, one additive pass with three outputs; per-layer, three additive passes; gather, without blending, a fragment sums the list "
    "of its vertex; cpu, SIMD on the CPU and an upload. noh verify shows which the driver has, and that their sums are equal.",
    "# cameras (--camera)",
    "face: what targets move; body: everything; AZ,EL or AZ,EL,DIST: degrees round the middle and above it (EL within 89), and a distance in "
    "model units.",
    "# JSON (--json)",
    "One object on stdout. On failure it is {\"error\": {\"result\", \"subject\", \"what\", \"where\", \"need\"}}, and the exit code is 1 or 2 "
    "as without --json. result: usage, failed, arg, memory, data, version, limit, not_found, unsupported, gl. what: a sentence. where: a byte "
    "offset or an index; need: a size or a count; both null where they mean nothing. A check that was made and failed (verify, zoom) prints its "
    "figures with \"ok\": false.",
    "# outputs (-o)",
    "Files are replaced as a whole or left as they were. A symbolic link stays and its target is replaced; devices, FIFOs and /dev/stdout are "
    "written to directly. A file that is read is never written over.",
    NULL
};
