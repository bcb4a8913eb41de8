/* json_internal.h: between the files that see a glTF file as JSON. */
#ifndef NOH_CONVERT_GLTF_JSON_INTERNAL_H
#define NOH_CONVERT_GLTF_JSON_INTERNAL_H

#include <nlohmann/json.hpp>

namespace gltf
{

/* After the types of numbers and of top-level arrays have been checked. Throws failure. */
void check_members(const nlohmann::json &document);

} // namespace gltf

#endif
