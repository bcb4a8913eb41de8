/* view_glfw.h: GLFW, opened when a window is: noh runs where its library is not.
 *
 * The viewer and the panels' backend call GLFW's functions by their names; these are defined here, and forward. */
#ifndef NOH_NOH_VIEW_VIEW_GLFW_H
#define NOH_NOH_VIEW_VIEW_GLFW_H

/* Call it before any of GLFW's functions. Prints an error and returns an exit code; 0 on success. */
int view_glfw_load(void);

#endif
