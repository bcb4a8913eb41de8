/* gpu_args.h: the values of GPU options. */
#ifndef NOH_NOH_GPU_GPU_ARGS_H
#define NOH_NOH_GPU_GPU_ARGS_H

#include "cli/args.h"
#include "noh/noh_gl.h"

/* Of --path, --accumulate and --instances. Return 0, or EXIT_USAGE after printing an error. */
int parse_path(const char *text, noh_morph_path *path);
int parse_accumulate(const char *text, noh_accumulate *accumulate);
int parse_instances(double value, uint32_t *instances);

#endif
