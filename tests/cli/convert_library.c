/* convert_library.c: libnohconvert on files in memory, for convert_library.sh.
 *   convert_library OUT.noh FOLDER FILE... -- ARGUMENT...   the files of a folder, by these names; prints messages
 * Environment: REFUSE=1: allocate gives nothing. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <noh_convert.h>

static const char *const kinds[] = { "warning", "report", "progress", "missing" };

static void message(void *user, noh_convert_kind kind, const char *text)
{
    ++*(int *)user;
    printf("%s: %s\n", kinds[kind], text);
}

static void *allocate(void *user, size_t bytes)
{
    (void)user;
    return getenv("REFUSE") ? NULL : malloc(bytes);
}

static noh_convert_file read_file(const char *folder, const char *name)
{
    noh_convert_file file = { name, NULL, 0 };
    char path[4096];
    long size;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "rb");
    if (!f || fseek(f, 0, SEEK_END) || (size = ftell(f)) < 0) exit(3);
    file.bytes = malloc((size_t)size + 1);
    rewind(f);
    file.count = fread((void *)file.bytes, 1, (size_t)size, f);
    fclose(f);
    return file;
}

int main(int argc, char **argv)
{
    noh_convert_file files[16];
    noh_convert_desc desc = { 0 };
    noh_convert_pack pack;
    noh_convert_result result;
    int messages = 0, i = 3;
    for (; i < argc && strcmp(argv[i], "--") != 0; i++) files[desc.file_count++] = read_file(argv[2], argv[i]);
    desc.files = files;
    desc.arguments = (const char *const *)argv + i + 1;
    desc.argument_count = (uint32_t)(argc - i - 1);
    desc.allocate = allocate;
    desc.message = message;
    desc.user = &messages;
    result = noh_convert(&desc, &pack);
    for (uint32_t f = 0; f < desc.file_count; f++) free((void *)files[f].bytes);
    printf("result %d, %s, error: %s\n", (int)result, noh_convert_version(), pack.error);
    if (!result) {
        FILE *out = fopen(argv[1], "wb");
        if (!out || fwrite(pack.bytes, 1, pack.count, out) != pack.count || fclose(out)) return 3;
    }
    free(pack.bytes);
    return (int)result;
}
