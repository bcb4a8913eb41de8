/* info_graph.h: the animation graphs of a pack, for `noh info`. */
#ifndef NOH_NOH_INFO_INFO_GRAPH_H
#define NOH_NOH_INFO_INFO_GRAPH_H

#include "cli/json.h"
#include "file/pack_file.h"

/* Counts, parameters, and the nodes as a tree, the root first. Return an exit code: a broken graph is an error. */
int info_print_graph(const pack_file *file, uint32_t index);
int info_json_graph(json *j, const pack_file *file, uint32_t index);

#endif
