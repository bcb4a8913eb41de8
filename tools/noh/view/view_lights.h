/* view_lights.h: the light around the figure: from the command line, or built in. */
#ifndef NOH_NOH_VIEW_VIEW_LIGHTS_H
#define NOH_NOH_VIEW_VIEW_LIGHTS_H

#include "draw/lighting.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VIEW_LIGHT_NAME 16u
#define VIEW_LIGHT_COUNT 5u
extern const char *const view_light_names[VIEW_LIGHT_COUNT]; /* "none" and four environments */

typedef struct view_lights {
    lighting slots[2];
    int opened[2];
    lighting *first;            /* of the command line; NULL: none */
    char name[VIEW_LIGHT_NAME]; /* "": first, which is a file's */
} view_lights;

/* Begin with the light of the command line. */
void view_lights_open(view_lights *l, lighting *first);

/* The name of the one that is shown. */
const char *view_lights_shown(const view_lights *l);

/* The light file of the command line, without its folders; NULL: its light is built in. */
const char *view_lights_file(const view_lights *l);

struct view_app;
/* name: of view_light_names, or "". Keeps rotation, shadow and background. Takes effect with
 * view_app_after. */
void view_light_choose(struct view_app *a, const char *name);
void view_lights_close(view_lights *l);

#ifdef __cplusplus
}
#endif
#endif
