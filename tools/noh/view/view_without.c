/* view_without.c: instead of the viewer, if its libraries were missing when noh was built. */
#include "cli/message.h"
#include "view/view_window.h"

int view_window_run(const view_run *run)
{
    (void)run;
    return tool_fail("view",
                     "noh was built without %s (Debian: apt install libglfw3-dev libimgui-dev, then make again)",
                     NOH_VIEW_WITHOUT);
}
