/* fbx_internal.h: an Assimp scene while it becomes glTF (C++, because both libraries are).
 *
 *   fbx_read.cpp       the process that reads, and its result
 *   fbx_scene.cpp      nodes, axes, the unit
 *   fbx_mesh.cpp       meshes, shapes, skins
 *   fbx_material.cpp   materials and pictures
 *   fbx_animation.cpp  animations */
#ifndef NOH_CONVERT_FBX_FBX_INTERNAL_H
#define NOH_CONVERT_FBX_FBX_INTERNAL_H

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <assimp/scene.h>
#include <tiny_gltf.h>

namespace fbx
{

struct job {
    const aiScene *scene = nullptr;
    std::string path;
    double unit = 0.01;             /* metres per unit of the file */
    aiQuaternion to_y_up;           /* from the file's axes */
    tinygltf::Model out;            /* its first buffer holds everything */
    std::vector<std::string> notes; /* for the user */
    std::map<const aiNode *, int> node_of;
    std::map<std::string, int> node_named;
    double widest_s = 0.0; /* between two keys of different values */
};

/* Bytes behind those that are there, as an accessor of `out`. type: TINYGLTF_TYPE_*. */
int add_floats(job &j, const std::vector<float> &values, int type);
int add_u16(job &j, const std::vector<uint16_t> &values, int type);
int add_u32(job &j, const std::vector<uint32_t> &values);
int add_view(job &j, const void *bytes, size_t size);

void note(job &j, const std::string &text);

void read_scene(job &j); /* nodes; then the others, which name them */
void read_materials(job &j);
void read_meshes(job &j);
void read_animations(job &j);

/* Whether a node stands on no other of `out`: it carries the turn of the axes. */
bool is_root(const job &j, int node);

} // namespace fbx
#endif
