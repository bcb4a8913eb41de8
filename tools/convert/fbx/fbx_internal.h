/* fbx_internal.h: a scene while it becomes glTF (C++, because tinygltf is). The .glb is read like any other: one reader
 * checks everything.
 *
 *   fbx_read.cpp       fbx_read: the order of the steps
 *   fbx_tree.*         values of nodes; fbx_binary.cpp and fbx_ascii.cpp read them
 *   fbx_math.*         vectors, matrices, rotations
 *   fbx_scene.*        objects, properties, connections, axes and unit, nodes
 *   fbx_curve.*        keys and the values between them
 *   fbx_takes.cpp      takes, layers and their curves; fbx_takes6.cpp: of version 6
 *   fbx_pose.*         layers blended, transforms of nodes at a time
 *   fbx_output.cpp     accessors of the .glb
 *   fbx_nodes.cpp      nodes, and the parent that each is written under
 *   fbx_mesh.cpp       corners and triangles; fbx_element.cpp: normals, texture coordinates, colours
 *   fbx_shape.cpp      blend shapes: targets, weights, in-betweens
 *   fbx_skin.cpp       clusters
 *   fbx_material.cpp   materials; fbx_picture.cpp: their pictures
 *   fbx_clips.cpp      one animation for each take */
#ifndef NOH_CONVERT_FBX_FBX_INTERNAL_H
#define NOH_CONVERT_FBX_FBX_INTERNAL_H

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <tiny_gltf.h>

#include "convert/model/model.h"
#include "convert/obj/obj_polygon.h"
#include "fbx_pose.h"

namespace fbx
{

/* One way to a full shape: 0 at percent 0, 1 at `full`; between two stations, both. */
struct station {
    double full; /* percent */
    int target;  /* of the mesh; -1: the shape at rest */
};

/* A value in percent that drives one shape, or an in-between and a shape. */
struct shape_channel {
    size_t object;
    std::string property;
    double rest;                   /* percent */
    std::vector<station> stations; /* by `full`, at least two */
};

/* A mesh that has been written: nodes with the same geometry, pivot and materials share it. */
struct drawn_mesh {
    int mesh = -1, skin = -1;
    size_t target_count = 0;
    std::vector<shape_channel> channels;
};

struct job {
    scene in;
    std::string path;
    double unit_m = 0.01;                                 /* metres per unit of the file */
    uint64_t steps = OBJ_CUT_STEPS;                       /* left to cut polygons */
    const extra_list *extras = nullptr;                   /* further sets of texture coordinates; null: none */
    std::vector<size_t> holder;                           /* [models] the node that each is written under, or none */
    std::vector<std::pair<size_t, drawn_mesh>> drawn;     /* by place in models */
    std::map<std::pair<size_t, size_t>, int> material_of; /* by object and texture of its colours */
    std::map<size_t, int> texture_of;                     /* by object; -1: it has no picture */
    tinygltf::Model out;                                  /* nodes are in.models; its first buffer holds everything */
};

/* --- fbx_output.cpp --- */
/* list_of, of coordinates: a number that is not finite or too large becomes 0, with a warning, before it spreads to the
 * other axes. */
std::vector<double> finite_list(job &j, const node &parent, const char *child);
/* type: TINYGLTF_TYPE_*. Numbers that are not finite or too large become 0, with a warning. */
int add_view(job &j, const void *bytes, size_t size);
int add_floats(job &j, std::vector<float> values, int type);
int add_positions(job &j, std::vector<float> values); /* with their bounds */
/* Of `count` values, zero except for these. */
int add_sparse(job &j, const std::vector<uint32_t> &places, const std::vector<float> &values, size_t count);
int add_u16(job &j, const std::vector<uint16_t> &values, int type);
int add_u32(job &j, const std::vector<uint32_t> &values);

/* --- fbx_clips.cpp --- */
void write_clips(job &j);

/* --- fbx_nodes.cpp --- */
void write_nodes(job &j);
/* As translation in metres, rotation, scale, below its holder or the y-up world. */
parts parts_of(job &j, const std::vector<placed> &pose, size_t model);

/* --- fbx_mesh.cpp --- */
void write_meshes(job &j);

/* --- fbx_element.cpp --- */
/* Values of a mesh's corners, points or polygons. */
struct element {
    enum class mapping { corner, point, polygon, all } by = mapping::all;
    std::vector<double> values;
    std::vector<double> index; /* into values; empty: in order */
    size_t width = 1;

    /* Null: there is none. */
    const double *at(size_t corner, size_t point, size_t polygon) const;
};
/* The first layer of its kind; false: there is none that can be read. names: layer, values, index. */
bool read_element(job &j, size_t geometry, const char *const names[3], size_t width, element &out);

/* The sets of texture coordinates of a mesh, in the file's order. */
struct uv_layer {
    std::string name;
    element of;
    bool is_read = false;
};
struct uv_layers {
    std::vector<uv_layer> all;
    std::vector<size_t> kept; /* n of each TEXCOORD_n that the build keeps, from 1 on */

    bool has(size_t layer) const;
    /* The layer that the picture of a node's material uses. */
    size_t of_material(job &j, size_t model, size_t material) const;
    /* The layer that is TEXCOORD_n where TEXCOORD_0 is the layer `shown`: the others follow in the file's order. */
    size_t further(size_t n, size_t shown) const;
    /* As glTF has them: from the top of the picture. Left as they are where the layer has none. */
    void fill(size_t layer, size_t corner, size_t point, size_t polygon, float uv[2]) const;
};
uv_layers read_uvs(job &j, size_t geometry);

/* --- fbx_shape.cpp --- */
/* Points that a target moves, in order, and by how much. */
using target_deltas = std::vector<std::pair<uint32_t, vec>>;
struct shapes {
    std::vector<target_deltas> targets;
    std::vector<std::string> names;
    std::vector<shape_channel> channels;
};
shapes read_shapes(job &j, size_t geometry, size_t point_count);
/* The weight of each target. percent: [channels] */
std::vector<double> weights_of(const std::vector<shape_channel> &channels, const std::vector<double> &percent,
                               size_t target_count);

/* --- fbx_skin.cpp --- */
struct influence {
    uint16_t joint; /* of the skin */
    float weight;
};
struct skin {
    std::vector<int> joints; /* nodes */
    std::vector<float> inverse_bind;
    std::vector<std::vector<influence>> points; /* [points], the largest first */
};
/* False: the geometry has no skin. model: the place of the node that draws it. */
bool read_skin(job &j, size_t geometry, size_t model, size_t point_count, skin &out);

/* --- fbx_material.cpp, fbx_picture.cpp --- */
/* The material of a node's place, or -1. */
int material_of(job &j, size_t material, size_t model);
/* The names of the texture coordinates of its pictures, of its colours' first; empty: the first layer. */
std::vector<std::string> uv_layers_of(job &j, size_t material, size_t model);
/* The texture of an object, or -1. */
int texture_of(job &j, size_t texture);
/* What it is a picture of, for comparison; "" if there is none. */
std::string picture_path(const scene &s, size_t texture);

} // namespace fbx
#endif
