/* picture_diff A.png B.png MEAN SHARE: the mean difference per channel of two pictures of one
 * size, in 1/255, and the share of pixels in which a channel differs by more than 8. Prints both;
 * exit code 0 if neither is above its limit, 1 if one is, 2 if they cannot be compared. */
#include <stb/stb_image.h>

#include <stdio.h>
#include <stdlib.h>

#define FAR 8

int main(int argument_count, char **arguments)
{
    int size[2][2], channels;
    unsigned char *pixels[2];
    double sum = 0.0, far = 0.0;
    if (argument_count != 5) return 2;
    for (int i = 0; i < 2; i++) {
        pixels[i] = stbi_load(arguments[1 + i], &size[i][0], &size[i][1], &channels, 3);
        if (!pixels[i]) {
            printf("%s: not a picture\n", arguments[1 + i]);
            return 2;
        }
    }
    if (size[0][0] != size[1][0] || size[0][1] != size[1][1]) {
        printf("%d x %d and %d x %d\n", size[0][0], size[0][1], size[1][0], size[1][1]);
        return 2;
    }
    size_t count = (size_t)size[0][0] * (size_t)size[0][1];
    for (size_t i = 0; i < count; i++) {
        int worst = 0;
        for (size_t c = 0; c < 3; c++) {
            int difference = abs((int)pixels[0][3 * i + c] - (int)pixels[1][3 * i + c]);
            sum += (double)difference;
            worst = difference > worst ? difference : worst;
        }
        far += worst > FAR;
    }
    double mean = sum / (3.0 * (double)count), share = far / (double)count;
    printf("mean %.4f/255, %.4f %% of the pixels off by more than %d\n", mean, 100.0 * share, FAR);
    free(pixels[0]);
    free(pixels[1]);
    return mean > atof(arguments[3]) || share > atof(arguments[4]);
}
