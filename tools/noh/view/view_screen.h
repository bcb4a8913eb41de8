/* view_screen.h: the viewer's drawing: the canvas, accumulator layers as pictures, the panels.
 *
 *   view_screen_open / view_screen_close
 *   view_screen_begin       clears the window
 *   view_screen_picture     a canvas into a rectangle of it; view_screen_difference how two differ
 *   view_screen_layers      the accumulators' three layers into textures
 *   view_screen_data        a page of data textures there instead
 *   view_triangles_begin, view_triangles_list, view_triangles_draw, view_triangles_end   triangles of the panels
 *   view_screen_read        the window's pixels */
#ifndef NOH_NOH_VIEW_VIEW_SCREEN_H
#define NOH_NOH_VIEW_VIEW_SCREEN_H

#include "draw/data_page.h"
#include "gpu/canvas.h"
#include "noh/noh_gl.h"

/* As Dear ImGui lays them out. */
typedef struct view_vertex {
    float position[2]; /* points of the window, from its upper left */
    float uv[2];
    uint8_t color[4]; /* sRGB */
} view_vertex;

typedef struct view_screen {
    gpu *g;
    GLuint picture_program, difference_program, panel_program,
        layer_programs[2]; /* of float layers, of RGBA32UI ones */
    GLuint empty_array, panel_array, vertex_buffer, index_buffer;
    GLuint font;
    GLuint layers[3], layers_framebuffer;
    uint32_t layers_width, layers_height; /* 0: none yet */
    uint32_t width, height;               /* of the window's framebuffer, pixels */
    float scale[2];                       /* pixels per point */
} view_screen;

/* Prints an error and returns an exit code; 0 on success. */
int view_screen_open(view_screen *s, gpu *g);
void view_screen_close(view_screen *s);
/* Replace the panels' font: rgba[height][width][4]. */
void view_screen_font(view_screen *s, uint32_t width, uint32_t height, const uint8_t *rgba);

void view_screen_begin(view_screen *s);
/* x, y: of the lower left corner, pixels. */
void view_screen_picture(view_screen *s, canvas *c, int x, int y);

/* Two pictures of the same size, both shown before: black where they are equal. */
void view_screen_difference(view_screen *s, const canvas *a, const canvas *b, float gain, int x, int y);

/* gains[layer]: the share of the range from black to white for a delta of 1. */
void view_screen_layers(view_screen *s, const noh_gl_morph_plan *plan, const noh_gl_morph_binding *binding,
                        const float gains[3]);

/* Draws data textures in place of the layers; none if no target moves the page's mesh. */
void view_screen_data(view_screen *s, const data_page *page);

/* width, height of the window in points. */
void view_triangles_begin(view_screen *s, float width, float height);
void view_triangles_list(view_screen *s, const view_vertex *vertices, size_t vertex_count, const uint16_t *indices,
                         size_t index_count);
/* clip: left, top, right, bottom in points. */
void view_triangles_draw(view_screen *s, const float clip[4], GLuint texture, size_t first_index, size_t index_count);
void view_triangles_end(view_screen *s);

/* The window's pixels before they are shown: rgba[height][width][4], top row first. */
int view_screen_read(view_screen *s, uint8_t *rgba);

#endif
