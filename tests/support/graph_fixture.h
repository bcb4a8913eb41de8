/* graph_fixture.h: a graph with every kind of node, over the clips of set_fixture.h, and a pack that holds it. */
#ifndef TESTS_GRAPH_FIXTURE_H
#define TESTS_GRAPH_FIXTURE_H

#include "set_fixture.h"

#include "convert/graph/graph_text.h"

#define GRAPH_FIXTURE_TEXT                                                                                       \
    "graph all\nnumber speed 0 2 initial=0.5\nnumber x -1 1\nnumber y -1 1\ninteger gear 0 1\n"                  \
    "enum mood calm glad initial=glad\ntrigger wave\ntrigger leap\n"                                             \
    "mask upper floats=0.5\n  below joint2\n  joint joint3 weight=0.25\n"                                        \
    "clip walk clip0 sync=feet\nclip run clip1 speed=1.5 sync=feet\nspace go walk 0 run 2 by=speed\n"            \
    "clip a clip0\nclip b clip1 start=0.1\nclip c clip2 loop=ping-pong\nspace aim a -1 -1 b 1 -1 c 0 1 by=x,y\n" \
    "clip d clip2 speed=-1\nclip e clip0 paused=yes\nblend mixed d e by=0.25\n"                                  \
    "clip f clip1\nclip g clip2\nadd added f g by=speed reference=clip0\n"                                       \
    "machine states go aim mixed\n  from go to aim when x above 0.5 fade=0.2 curve=smooth\n"                     \
    "  from aim to go when x below 0.5 inertia=0.1 enter=keep\n  from any to mixed when leap fade=0.1\n"         \
    "  from mixed to go when ending\n"                                                                           \
    "select choice states added by=mood fade=0.15\nclip h clip1\nselect second choice h by=gear inertia=0.1\n"   \
    "clip i clip2\nlayer layered second i mask=upper by=speed\n"                                                 \
    "clip waving clip1 speed=2\none-shot root layered waving on=wave in=0.1 out=0.2 mask=upper\n"

static inline graph_file *graph_fixture_read(const char *text)
{
    const char *path = test_path("fixture.graph");
    graph_file *file = NULL;
    model_error error = { "", "" };
    uint32_t line = 0;
    test_write_file(path, text, strlen(text));
    if (graph_text_read(path, &file, &line, &error)) fail_msg("line %u: %s", line, error.what);
    return file;
}

/* Three clips of 5 joints. */
static inline set_fixture graph_fixture_pack(const char *text)
{
    static const uint32_t frames[] = { 31, 25, 40 };
    graph_file *file = graph_fixture_read(text);
    const set_fixture x = set_fixture_make_graphs(5, 3, frames, file);
    graph_text_free(file);
    return x;
}

#endif
