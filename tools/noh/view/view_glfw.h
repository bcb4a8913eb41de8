/* view_glfw.h: loads GLFW when a window is opened, so that noh runs without its library.
 *
 * The viewer and the panels' backend call GLFW's functions by their names; these are defined here, and forward. */
#ifndef NOH_NOH_VIEW_VIEW_GLFW_H
#define NOH_NOH_VIEW_VIEW_GLFW_H

/* Call it before any of GLFW's functions. Prints an error and returns an exit code; 0 on success. */
int view_glfw_load(void);

#endif
