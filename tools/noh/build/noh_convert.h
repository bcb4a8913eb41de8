/* noh_convert.h: `noh build` as a library, for editors, pipelines and servers: files in memory in, one pack
 * in memory out.
 * libnohconvert is a library for tools: it needs the C++ runtime and allocates. A game links libnoh alone.
 *
 *     const noh_convert_file file = { "hero.glb", bytes, count };
 *     const char *const arguments[] = { "hero.glb", "--lod", "auto" };
 *     const noh_convert_desc desc = { .files = &file, .file_count = 1, .arguments = arguments, .argument_count = 3 };
 *     noh_convert_pack pack;
 *     if (noh_convert(&desc, &pack)) fprintf(stderr, "%s\n", pack.error); // "hero.glb: no mesh (node 3)"
 *     else use(pack.bytes, pack.count), free(pack.bytes);
 *
 * The same files and arguments give the same bytes as `noh build`, on every machine. */
#ifndef NOH_CONVERT_H
#define NOH_CONVERT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_convert_file {
    const char
        *name; /* as the arguments and other files call it: "hero.glb", "textures/skin.png", "targets/smile.obj" */
    const void *bytes;
    size_t count;
} noh_convert_file;

typedef enum noh_convert_kind {
    NOH_CONVERT_WARNING,  /* what the files lost on their way: show it to the artist */
    NOH_CONVERT_REPORT,   /* a line of the report of `noh build` */
    NOH_CONVERT_PROGRESS, /* what is being made; each replaces the last one */
    NOH_CONVERT_MISSING   /* the name of a file that was looked for and is not among `files` */
} noh_convert_kind;

/* Zeros are right for all that is not needed. All pointers need to live during the call alone. */
typedef struct noh_convert_desc {
    const noh_convert_file *files; /* [file_count] all that may be read. NULL: files of the machine are read */
    uint32_t file_count;
    const char *const *arguments; /* [argument_count] what follows `noh build` on a command line (noh help build), at
                                     most 254: models, clips, options; without -o, --depfile, --quiet, --warnings */
    uint32_t argument_count;
    void *(*allocate)(void *user, size_t bytes);                          /* the block of the pack; NULL: malloc */
    void (*message)(void *user, noh_convert_kind kind, const char *text); /* one line, without its end; NULL: none */
    void *user;                                                           /* of both functions */
} noh_convert_desc;

typedef enum noh_convert_result {
    NOH_CONVERT_OK,
    NOH_CONVERT_ARGUMENTS, /* an argument is wrong, or has no effect */
    NOH_CONVERT_FILES,     /* a file is missing or wrong, or there is not enough memory to read it */
    NOH_CONVERT_MEMORY     /* allocate, or malloc, gave nothing */
} noh_convert_result;

typedef struct noh_convert_pack {
    void *bytes; /* from allocate; NULL after an error. It opens with noh_pack_open where it lies on 16 bytes */
    size_t count;
    char error[1024]; /* the file, what is wrong with it, and where; "" after success */
} noh_convert_pack;

/* One conversion at a time in a process: it takes the processors that it can use. It writes no file and prints
 * nothing. */
noh_convert_result noh_convert(const noh_convert_desc *desc, noh_convert_pack *pack);

/* The version of noh that packs are made by, "0.3.0". */
const char *noh_convert_version(void);

#ifdef __cplusplus
}
#endif
#endif
