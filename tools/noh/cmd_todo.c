#include "noh_tool.h"
int verb_info(int argc, char **argv){(void)argc;(void)argv;return 0;}
int verb_budget(int argc, char **argv){(void)argc;(void)argv;return 0;}
int verb_render(int argc, char **argv){(void)argc;(void)argv;return 0;}
int verb_sheet(int argc, char **argv){(void)argc;(void)argv;return 0;}
int verb_dump(int argc, char **argv){(void)argc;(void)argv;return 0;}
int verb_bench(int argc, char **argv){(void)argc;(void)argv;return 0;}
