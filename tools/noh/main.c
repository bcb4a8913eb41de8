/* noh: the one command line program. Each verb has its own file, cmd_VERB.c. */
#include <string.h>

#include "noh_tool.h"

static const struct verb {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *usage, *what;
} verbs[] = {
    { "build", verb_build,
      "IN... -o OUT.noh [--error-um 10] [--rects auto|N] [--rate HZ] [--error-cm 0.01] [--shell-cm 3]\n"
      "                 [--loop] [--for-masks] [--events FILE] [--unit-cm 1] [--only mesh|anim] [--quiet]\n"
      "                 [--influences 8] [--palette 256] [--dual-quaternion MESH|all]... [--keep-parts]\n"
      "                 [--two-stream SOURCE=TARGET]... [--clip-error CLIP=CM]... [--joint-error JOINT=CM]...\n"
      "                 [--lod auto|N] [--lod-fast]",
      "convert .gltf, .glb, .bvh and .rcl to a pack: the first model, the clips of all" },
    { "info", verb_info, "PACK [--json]", "chunks, counts, names, errors certified at build" },
    { "clip", verb_clip, "PACK [--json] [--dump OUT.rcl [--clip NAME]]",
      "compressed motion: bytes, certified errors; a clip decoded" },
    { "budget", verb_budget, "PACK [--anim PACK] [--instances N] [--path P] [--accumulate A] [--lod K] [--driver D | --nominal] [--json]",
      "bytes before a load: CPU and GPU, by part" },
    { "render", verb_render,
      "PACK -o OUT.png [--size 512x512] [--weight NAME=V]... [--clip NAME]... [--time S] [--anim PACK]\n"
      "                 [--path P] [--accumulate auto|f32|f16] [--driver egl|osmesa|angle|glfw]\n"
      "                 [--camera face|body|AZ,EL,DIST] [--debug none|position|normal|tangent|lod] [--bones] [--lod K]",
      "a picture" },
    { "sheet", verb_sheet, "PACK -o OUT.png [--clip NAME... [--anim PACK] [--tiles 24] | --target NAME[=V]...] [--tile 192] [--columns N] [--camera face]\n"
      "                 [--blend CLIP | --to CLIP [--transition fade|inertia] [--over 0.3]] [--bones]\n"
      "                 [--lods [--target NAME[=V][,NAME[=V]]...]] [--path P] [--accumulate A] [--driver D]",
      "a contact sheet: every target at full weight, a clip in time, or the levels of detail" },
    { "zoom", verb_zoom, "PACK [-o OUT.png] [--frames 600] [--pixels 1] [--near M] [--far M] [--size NxN] [--weight NAME=V]...\n"
      "                 [--clip NAME]... [--time S] [--anim PACK] [--every 1] [--jitter 0.03] [--no-fades] [--driver D] [--json]",
      "a slow zoom out and in by levels of detail against the full mesh: silhouettes, surfaces, pops, flicker" },
    { "dump", verb_dump, "PACK -o OUT.obj [--weight NAME=V]... [--clip NAME]... [--time S] [--anim PACK] [--path P] [--lod K]",
      "the deformed mesh, as drawn, baked to a plain one" },
    { "verify", verb_verify, "PACK [--anim PACK] [--seed N] [--instances N] [--lod K] [--driver D] [--json]", "every path and format against the CPU reference" },
    { "view", verb_view, "PACK|MODEL [--anim PACK] [--clip NAME] [--path P] [--accumulate A] [--driver egl|native] [--size 1280x800]\n"
      "                 [--bones] [--lod auto|N] [--frames N [--screenshot OUT.png]]",
      "a window: sliders, clips, events, memory and times; files dropped on it are converted and shown" },
    { "crowd", verb_crowd,
      "PACK -o OUT.png [--instances 1000] [--pixels 1] [--time 2] [--plain] [--debug lod] [--size 1280x720] [--driver D]",
      "a crowd of a pack's skinned mesh, each as detailed as its pixels want it; --plain: without" },
    { "bench", verb_bench, "PACK... [--source ASSET] [--driver D] [--rounds N] [--quick] [--json]\n"
      "                 [--only morph|morph-cpu|skin-cpu|skin-gpu|heads|clip|pose|crowd]", "ratios against the named baselines, in one run" },
};

static int help(void)
{
    puts("noh: characters in fixed memory\n");
    for (size_t i = 0; i < sizeof verbs / sizeof verbs[0]; i++) {
        printf("  noh %-7s %s\n                 %s\n", verbs[i].name, verbs[i].usage, verbs[i].what);
    }
    puts("\npaths (P): auto (the cheapest here), blend (layered where supported, else per-layer), layered mrt per-layer gather cpu\n"
         "exit code: 0, 1 (the input or the check failed), 2 (usage)");
    return 0;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        help();
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "help") == 0 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        return help();
    }
    for (size_t i = 0; i < sizeof verbs / sizeof verbs[0]; i++) {
        if (strcmp(argv[1], verbs[i].name) == 0) {
            return verbs[i].run(argc - 2, argv + 2);
        }
    }
    return tool_usage("there is no verb '%s'", argv[1]);
}
