/* help_formats.c: the formats of files and options, as `noh help FORMATS` and the man page show them. Lines that begin
 * with a blank are not wrapped. */
#include "help.h"

const char *const help_formats_text[] = {
    "# packs (.noh)",
    "noh build makes them; the library reads them in place, without parsing. A pack of another format version is refused: convert "
    "the model again.",
    "# models and clips (noh build IN...)",
    ".gltf, .glb: glTF 2.0: meshes, morph targets, skins, materials, animations. The first input with meshes gives the model.",
    ".bvh: motion capture. Channels may be in any order; end sites do not become joints. --unit-cm is the length of a unit.",
    ".rcl: raw clips, joints only, as noh clip --dump writes them. Little-endian, 32-bit floats, centimetres:",
    "   char[4] \"RCL1\"; u32 joints; u32 frames; f32 rate_hz; u32 length; char name[length]",
    "   per joint: i32 parent (-1: a root; parents first); u32 flags (1 rotation, 2 translation, 4 scale animated);",
    "     u32 length; char name[length]; f32 bind[10]; f32 first[10]: qx qy qz qw tx ty tz sx sy sz, local to the parent",
    "   per frame, per joint: those of q[4], t[3], s[3] that are animated; the others stay at first[]",
    "# callback keys and sync markers (noh build --events FILE)",
    "One per line, words separated by blanks, names with blanks in double quotes; # begins a comment:",
    "   CLIP TIME_S NAME [PAYLOAD] [min=WEIGHT]     a callback key",
    "   CLIP TIME_S NAME marker                     a sync marker",
    "PAYLOAD is a number, passed to the callback as 8 bytes, little-endian: a whole number (also 0x and up to 16 hexadecimal digits) as a "
    "64-bit integer, a number with a point or an exponent as a 64-bit float. WEIGHT is the least weight at which the key is delivered.",
    "A marker lies before the end of its clip, and no two markers of a clip share a time. Clips that are to be synchronised have the "
    "same markers in the same order.",
    "   walk 0.00 left marker",
    "   walk 0.53 right marker",
    "   walk 0.02 step 1 min=0.25",
    "   \"wave hand\" 1.5 sound 0xff",
    "# callback keys in glTF",
    "The extras of an animation hold the same; a key that cannot be read is left out with a warning:",
    "   \"extras\": {\"loop\": true, \"events\": [{\"time\": 0.5, \"name\": \"step\", \"payload\": 7, \"weightMin\": 0.1},",
    "                                      {\"time\": 0.25, \"name\": \"left\", \"marker\": true}]}",
    "# masks",
    "A mask is not a file: a game fills one byte for each joint and each float of the clip set, 255 for full weight, 0 for none "
    "(noh_mask_subtree, noh_mask_fill). Build clips that are played through masks with --for-masks, so that no joint relies on another's error.",
    "# error bounds (noh build --clip-error, --joint-error)",
    "NAME=CM, centimetres over 0; names may contain equals signs. A clip or joint that is in no input is an error.",
    "# weights and targets",
    "--weight NAME=V sets the weight of a target to any number; 1 is the target as modelled. A name that no mesh has is an error, which "
    "suggests the nearest.",
    "noh sheet --target NAME or NAME=V adds a tile; with --lods, NAME[=V],NAME[=V]... adds a row.",
    "# paths (--path)",
    "How the deltas of targets are summed. noh verify shows which of these a driver supports, and that their sums are equal.",
    "   auto       the cheapest that the driver supports",
    "   blend      additive blending: layered where supported, per-layer elsewhere",
    "   layered    one additive pass; a geometry shader draws to three layers",
    "   mrt        one additive pass with three outputs",
    "   per-layer  three additive passes",
    "   gather     no blending: each fragment sums the list of its vertex",
    "   cpu        SIMD on the CPU, and an upload",
    "# cameras (--camera)",
    "   face        frames what targets move",
    "   body        frames everything",
    "   AZ,EL       from AZ degrees to the side and EL degrees above, -89 to 89, framing everything",
    "   AZ,EL,DIST  the same from DIST model units",
    "# JSON (--json)",
    "One object on stdout. On failure it is {\"error\": {\"result\", \"subject\", \"what\", \"where\", \"need\"}}, and the exit code is 1 or 2 "
    "as without --json. result: usage, failed, arg, memory, data, version, limit, not_found, unsupported, gl. what: a sentence. where: a byte "
    "offset or an index; need: a size or a count; both are null where they have no meaning. A check that ran and failed (verify, zoom) "
    "prints its figures with \"ok\": false.",
    "# outputs (-o)",
    "A file is replaced as a whole or left as it was. Of a symbolic link the target is replaced; devices, FIFOs and /dev/stdout are "
    "written to directly. An input is never overwritten.",
    NULL
};
