#include "info_terrain.h"

#include <stdio.h>

#include "noh/body.h"
#include "noh/format.h"
#include "noh/pack.h"

/* The lowest and the highest of its heights, metres. */
static void range_of(const noh_field *f, double range[2])
{
    uint16_t low = 65535, high = 0;
    for (size_t i = 0; i < (size_t)f->width * f->depth; i++) {
        if (f->heights[i] < low) low = f->heights[i];
        if (f->heights[i] > high) high = f->heights[i];
    }
    range[0] = (double)f->origin[1] + (double)f->scale * low;
    range[1] = (double)f->origin[1] + (double)f->scale * high;
}

static double side_of(const noh_field *f, uint32_t count)
{
    return (double)f->spacing * (double)(count - 1u);
}

void info_print_terrain(const noh_pack *pack)
{
    noh_field f;
    double range[2];
    if (noh_terrain_of(pack, &f, NULL)) return;
    range_of(&f, range);
    printf("terrain: %u x %u heights, %.3f m apart: %.2f x %.2f m, %.3f to %.3f m high, in steps of %.3f mm\n", f.width,
           f.depth, (double)f.spacing, side_of(&f, f.width), side_of(&f, f.depth), range[0], range[1],
           1000.0 * (double)f.scale);
}

void info_json_terrain(json *j, const noh_pack *pack)
{
    noh_field f;
    double range[2];
    if (noh_terrain_of(pack, &f, NULL)) {
        json_null(j, "terrain");
        return;
    }
    range_of(&f, range);
    json_open(j, "terrain", '{');
    json_integer(j, "width", f.width);
    json_integer(j, "depth", f.depth);
    json_number(j, "x_m", (double)f.origin[0]);
    json_number(j, "z_m", (double)f.origin[2]);
    json_number(j, "wide_m", side_of(&f, f.width));
    json_number(j, "deep_m", side_of(&f, f.depth));
    json_number(j, "low_m", range[0]);
    json_number(j, "high_m", range[1]);
    json_number(j, "step_mm", 1000.0 * (double)f.scale);
    json_integer(j, "bytes", (uint64_t)f.width * f.depth * 2u + sizeof(noh_pack_terrain_header));
    json_close(j, '}');
}
