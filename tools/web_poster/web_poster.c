/* web_poster.c IN.png OUT.jpg BYTES: the picture as the best JPEG of at most BYTES, which a page shows before its
 * program has arrived. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#define BEST 90  /* quality, 1 to 100 */
#define WORST 10 /* still a face when it is blurred */

typedef struct picture {
    unsigned char bytes[65536];
    size_t count; /* more than sizeof bytes: too large */
} picture;

static void append(void *user, void *data, int size)
{
    picture *p = user;
    if (p->count + (size_t)size <= sizeof p->bytes) memcpy(p->bytes + p->count, data, (size_t)size);
    p->count += (size_t)size;
}

static int fail(const char *name, const char *why)
{
    fprintf(stderr, "web_poster: %s: %s\n", name, why);
    return 1;
}

int main(int count, char **args)
{
    static picture p;
    int width, height, quality = BEST;
    size_t most;
    FILE *file;
    if (count != 4) return fail("usage", "web_poster IN.png OUT.jpg BYTES");
    most = (size_t)strtoul(args[3], NULL, 10);
    stbi_uc *pixels = stbi_load(args[1], &width, &height, NULL, 3);
    if (!pixels) return fail(args[1], stbi_failure_reason());
    do {
        p.count = 0;
        stbi_write_jpg_to_func(append, &p, width, height, 3, pixels, quality);
        quality -= 2;
    } while (p.count > most && quality >= WORST);
    stbi_image_free(pixels);
    if (p.count > most || p.count > sizeof p.bytes)
        return fail(args[1], "too large for the poster: draw a smaller one");
    file = fopen(args[2], "wb");
    if (!file) return fail(args[2], "cannot be written");
    most = fwrite(p.bytes, 1, p.count, file);
    return fclose(file) || most != p.count ? fail(args[2], "cannot be written") : 0;
}
