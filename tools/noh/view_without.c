/* view_without.c: the verb `view` where the window's libraries were missing at build time. */
#include "noh_tool.h"

int verb_view(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    return tool_fail("view", "noh was built without %s (Debian: apt install libglfw3-dev libimgui-dev, then make again)", NOH_VIEW_WITHOUT);
}
