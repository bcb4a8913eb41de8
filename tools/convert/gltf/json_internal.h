/* json_internal.h: between the files that see a glTF file as JSON. */
#ifndef NOH_CONVERT_GLTF_JSON_INTERNAL_H
#define NOH_CONVERT_GLTF_JSON_INTERNAL_H

#include <nlohmann/json.hpp>

namespace gltf
{

struct file;

/* After top-level arrays have been checked: members of a wrong type are left out. */
void repair_members(file &f, nlohmann::json &document);
/* After that, and after whole numbers have been checked: objects that lack a required member. */
void repair_lists(file &f, nlohmann::json &document);

} // namespace gltf

#endif
