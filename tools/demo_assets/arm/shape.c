#include "shape.h"

#include "shared/grab.h"

#include <stdlib.h>

static void add_vertex(Shape *shape, const Place *place, V3 colour)
{
    int n = shape->count++;
    shape->position[n] = place->at;
    shape->normal[n] = place->normal;
    shape->colour[n] = colour;
    for (int i = 0; i < HOLDERS; i++) {
        shape->weight[HOLDERS * n + i] = place->weight[i];
    }
}

static int same_place(V3 a, V3 b)
{
    return v3_length(v3_sub(a, b)) <= 0;
}

/* At a pole two corners of a face coincide: one of its triangles vanishes. */
static void add_triangle(Shape *shape, int a, int b, int c)
{
    const V3 *at = shape->position;
    const int corner[3] = { a, b, c };
    if (same_place(at[a], at[b]) || same_place(at[b], at[c]) || same_place(at[c], at[a])) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        shape->indices[shape->index_count++] = (uint32_t)corner[i];
    }
}

static void add_square(Shape *shape, const Grid *grid, int band, int block)
{
    int first = shape->count, width = grid->sides + 1, around = grid->blocks * grid->sides;
    int is_end = band == 0 || band == grid->bands - 1;
    V3 colour = is_end ? grid->dye.end : (band + block) % 2 ? grid->dye.light : grid->dye.dark;
    for (int step = 0; step <= grid->steps; step++) {
        for (int side = 0; side < width; side++) {
            Place place = grid->place(grid->what, band, step, (block * grid->sides + side) % around);
            add_vertex(shape, &place, colour);
        }
    }
    for (int step = 0; step < grid->steps; step++) {
        for (int side = 0; side < grid->sides; side++) {
            int corner = first + step * width + side;
            add_triangle(shape, corner, corner + width, corner + width + 1);
            add_triangle(shape, corner, corner + width + 1, corner + 1);
        }
    }
}

Shape shape_build(const Grid *grid)
{
    int squares = grid->bands * grid->blocks, vertices = squares * (grid->steps + 1) * (grid->sides + 1);
    Shape shape = { 0 };
    shape.position = grab(NULL, vertices, (int)sizeof(V3));
    shape.normal = grab(NULL, vertices, (int)sizeof(V3));
    shape.colour = grab(NULL, vertices, (int)sizeof(V3));
    shape.weight = grab(NULL, HOLDERS * vertices, (int)sizeof(double));
    shape.indices = grab(NULL, squares * grid->steps * grid->sides * 6, (int)sizeof(uint32_t));
    for (int band = 0; band < grid->bands; band++) {
        for (int block = 0; block < grid->blocks; block++) {
            add_square(&shape, grid, band, block);
        }
    }
    return shape;
}

void shape_free(Shape *shape)
{
    free(shape->position);
    free(shape->normal);
    free(shape->colour);
    free(shape->weight);
    free(shape->indices);
}
