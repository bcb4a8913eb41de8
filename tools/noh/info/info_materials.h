/* info_materials.h: a pack's materials with their maps, and what each texture takes on the GPU. */
#ifndef NOH_NOH_INFO_INFO_MATERIALS_H
#define NOH_NOH_INFO_INFO_MATERIALS_H

#include "cli/json.h"
#include "noh/pack.h"

void info_print_materials(const noh_pack *pack);
/* "material_list": an array of objects. */
void info_json_materials(json *j, const noh_pack *pack);

/* A line for each material: what its textures take on the GPU, and how many of them a pixel reads. */
void info_print_costs(const noh_pack *pack);
/* "material_costs": an array of objects. */
void info_json_costs(json *j, const noh_pack *pack);

/* A line for each texture: size, mip levels, bytes. */
void info_print_textures(const noh_pack *pack);
/* "texture_list": an array of objects. */
void info_json_textures(json *j, const noh_pack *pack);

#endif
