/* view_script.h: `noh view --script FILE`: replays user input from a text, frame by frame, for tests, demonstrations
 * and bug reports. A frame is 1/60 s of clip time, however long it takes to draw.
 *
 *   frames N                 draw N frames
 *   click WHAT               WHAT: the name of a control, as it is written in the window: click "walk/play"
 *   alt-click X Y            or a point of the window, from its upper left
 *   drag WHAT SHARE          a slider's handle to 0 (left) to 1 (right)
 *   drag X Y X Y [right]     from one point to another
 *   wheel X Y STEPS          4 and up: nearer
 *   key NAME                 space, f, F11, escape, enter, tab, ctrl+z, ctrl+shift+z and so on
 *   type TEXT                into the text that was clicked on
 *   drop FILE                a file, as if dropped
 *   state                    print the state
 *   expect TEXT              a line of the state contains this; expect-not TEXT: none does
 *   until TEXT N             draw frames until one does, at most N
 *   inside SHARE N           draw N frames; in each at least this share of the silhouette is in the picture
 *   loaded                   wait until a conversion is done, without drawing more than it takes
 *   save FILE, window FILE   a picture of the figure, of the window
 *
 * Only pictures that are saved, filmed or compared are drawn; the rest of each frame runs. # begins a comment.
 * After the last line the window is closed. */
#ifndef NOH_NOH_VIEW_VIEW_SCRIPT_H
#define NOH_NOH_VIEW_VIEW_SCRIPT_H

#include "view/view_events.h"

typedef struct view_script view_script;

/* Prints an error and returns NULL. */
view_script *view_script_open(const char *path);
void view_script_close(view_script *s);

/* Before a frame. Returns 1 at the end of the script, 0 if a frame must be drawn, -1 after printing the failure and its
 * line. */
int view_script_step(view_script *s, view_window *w);

#endif
