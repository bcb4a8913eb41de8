/* gltf_internal.h: shared by the glTF reader's files (C++, because tinygltf is).
 *
 * tinygltf turns JSON into structs and decodes images. The reader itself handles all that a hostile file could abuse:
 * it opens the container, checks the JSON before tinygltf sees it, loads the buffers, and reads every accessor with its
 * bounds checked. Errors are thrown as gltf::failure and become a model_error at the boundary (model_read_gltf).
 *
 *   gltf_read.cpp      model_read_gltf: the container, the order of the steps
 *   gltf_json.cpp      the JSON: checks, repairs, tinygltf
 *   gltf_members.cpp   members and their types
 *   gltf_file.cpp      failures, warnings, names
 *   gltf_buffer.cpp    files, URIs, buffers
 *   gltf_meshopt.cpp   EXT_meshopt_compression, KHR_meshopt_compression
 *   gltf_draco.cpp     KHR_draco_mesh_compression
 *   gltf_view.cpp      buffer views, plain or compressed
 *   gltf_accessor.cpp  accessors to floats and indices
 *   gltf_mesh.cpp      meshes, primitives, targets
 *   gltf_scene.cpp     nodes; instances (EXT_mesh_gpu_instancing)
 *   gltf_influences.cpp joints and weights of vertices
 *   gltf_skin.cpp      skins, and the nodes whose meshes they move
 *   gltf_animation.cpp animations
 *   gltf_extras.cpp    an animation's extras: callback keys, sync markers, loops
 *   gltf_material.cpp  materials, textures, images
 *   gltf_curves.cpp    lines as curves
 *   gltf_vrm.cpp       VRM: bones of a person, expressions, direction
 *   gltf_springs.cpp   springs: VRMC_springBone, VRM 0, extras
 *   gltf_left_out.cpp  warnings about features that the model does not store */
#ifndef NOH_CONVERT_GLTF_GLTF_INTERNAL_H
#define NOH_CONVERT_GLTF_GLTF_INTERNAL_H

#include "convert/base/curves.h"
#include "convert/model/model_build.h"

#include <array>
#include <cstdint>
#include <map>
#include <new>
#include <set>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace gltf
{

using bytes = std::vector<uint8_t>;

/* Why the file is refused; see model_error. */
struct failure {
    std::string what, where;
};
[[noreturn]] void fail(const std::string &where, const std::string &what);

/* tinygltf would load buffers and images itself, but a fallback buffer has no data
 * to load, and a bad image would fail the whole file: so the reader loads both. */
struct buffer {
    uint64_t byte_length = UINT64_MAX; /* that: all of the data */
    std::string uri;
    bool has_uri = false;
    bool fallback = false; /* only for readers without EXT_meshopt_compression: never loaded */
    bool has_data = false;
    bytes data;
};
struct image {
    std::string name, uri;
    int view = -1;
};

/* The bytes of a buffer view. */
struct span {
    const uint8_t *data;
    uint64_t size;
    uint64_t stride; /* 0 = tightly packed */
};

/* One kind of thing that the model has no place for. */
struct left_out {
    std::string first, what; /* the place of the first one; the text of the warning */
    size_t count;
};

/* A file while a model is built from it. */
struct file {
    std::string path, directory; /* directory: with its slash, or empty */
    tinygltf::Model json;
    std::vector<buffer> buffers;
    std::vector<image> images;
    std::vector<std::string> cameras; /* their names */
    bytes bin;                        /* the BIN chunk of a .glb */
    bool has_bin = false;
    std::vector<bytes> decoded_views; /* by meshopt, empty until used; by Draco, behind the file's own */
    uint64_t input_bytes = 0;         /* of all files read */
    uint64_t output_bytes = 0;        /* bytes that the model needs so far */
    ::model *out = nullptr;
    std::vector<uint32_t> mesh_of; /* [json.meshes] index into out->meshes or MODEL_NONE */
    std::vector<uint32_t> node_of; /* [json.nodes] likewise */
    std::vector<uint32_t> skin_of; /* [json.skins] likewise */
    size_t in_scene = 0;           /* of out->nodes; what follows are joints outside the scene, then instances */
    /* from {use, texture, -1}, or {DATA, occlusion, metallic-roughness}, to an index into out->textures or MODEL_NONE
     */
    std::map<std::array<int, 4>, uint32_t> texture_of;
    std::vector<left_out> losses;          /* in the order in which they were met */
    std::map<std::string, size_t> loss_of; /* what -> its place in losses */
    /* mesh -> expressions of VRM that a game calls by name, for add_expressions */
    std::map<uint32_t, std::set<std::string>> expressions;
};

/* --- gltf_file.cpp --- */
template <class... Arguments> void warn(file &f, const char *format, Arguments... arguments)
{
    if (model_warn(f.out, format, arguments...)) throw std::bad_alloc();
}
/* Note that something at `where` is left out, or read as something else; `what` continues the sentence (" was skipped:
 * ...", ": the normal texture was left out"). After the file has been read there is one warning for each `what`, which
 * names the first place and counts the others: a file of a thousand nodes cannot bury other warnings. */
void leave_out(file &f, const std::string &where, const std::string &what);
/* `what` of a loss as a clause of its own, for a message that says where at its end: "a part was skipped: ...". */
std::string clause_of(const left_out &loss);
/* Why a version is refused, and what reads it. */
std::string old_version(const std::string &version);
/* Read a part that the model can do without: where it fails, note why and `lost` ("; its channel was left out"). */
template <class Reader> bool attempt(file &f, const char *lost, Reader reader)
{
    try {
        reader();
        return true;
    } catch (const failure &reason) {
        leave_out(f, reason.where, ": " + reason.what + lost);
        return false;
    }
}
/* Give those warnings. */
void warn_left_out(file &f);
/* Count bytes of the model before they are allocated; refuse more than an honest file of this size needs. */
uint64_t uncharged(const file &f);
void charge(file &f, uint64_t count, uint64_t element_size, const std::string &where);
/* A zeroed array of the model, charged. */
template <class T> T *allocate(file &f, uint64_t count, const std::string &where)
{
    charge(f, count, sizeof(T), where);
    T *array = static_cast<T *>(model_zeros(static_cast<size_t>(count), sizeof(T)));
    if (!array) throw std::bad_alloc();
    return array;
}
char *copy_string(const std::string &text);
/* A name for messages: short, without control characters. */
std::string printable(const std::string &name);
/* The given name, or "<kind>_<index>". */
std::string name_or(const std::string &name, const char *kind, size_t index);
std::string text(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* A JSON number as a float; throws failure if a float cannot hold it. */
float to_float(double value, const std::string &where);

/* --- gltf_json.cpp --- */
void parse_json(file &f, const char *text, size_t size);
bool uses_extension(const file &f, const char *name);
bool is_supported(const std::string &extension);

/* --- gltf_buffer.cpp --- */
void load_buffers(file &f);
bytes read_whole_file(const std::string &path, const std::string &where);
/* The bytes behind a URI: data: or a file in the folder of the glTF. Throws failure. */
bytes read_uri(file &f, const std::string &uri, const std::string &where);
/* A range of a buffer, checked. */
span buffer_bytes(file &f, int buffer, uint64_t offset, uint64_t size, const std::string &where);

/* --- gltf_meshopt.cpp --- */
bytes decode_meshopt(file &f, const tinygltf::Value &extension, const std::string &where);

/* --- gltf_draco.cpp --- */
/* Whether noh was built with Draco. */
bool reads_draco();
/* Decode compressed primitives: their accessors then have bytes. */
void decode_draco(file &f);

/* --- gltf_view.cpp --- */
/* A buffer view's bytes, decompressed if need be; checked to lie inside its buffer. */
span view_bytes(file &f, int view, const std::string &where);

/* --- gltf_accessor.cpp --- */
/* Component types as bits, so that each use can name what it accepts; _n = normalised. */
enum component : uint32_t {
    c_i8 = 1,
    c_i8n = 2,
    c_u8 = 4,
    c_u8n = 8,
    c_i16 = 16,
    c_i16n = 32,
    c_u16 = 64,
    c_u16n = 128,
    c_u32 = 256,
    c_f32 = 512
};
const tinygltf::Accessor &accessor_at(const file &f, int accessor, const std::string &where);
/* Read an accessor as floats. What is infinite or above 1e12 becomes NaN: the caller repairs it.
 * components  1 to 4 per element, or 16: a 4 x 4 matrix
 * accepted    a set of component bits
 * count       the number of elements in `out`; any other count in the file is an error */
void read_floats(file &f, int accessor, uint32_t components, uint32_t accepted, uint64_t count,
                 const std::string &where, float *out);
/* The vertices of a primitive: all elements of its accessors, or those that its triangles use. */
struct vertex_list {
    uint64_t total = 0;                  /* elements of each accessor */
    std::vector<uint32_t> used;          /* empty: all of them */
    std::vector<uint32_t> sorted, place; /* `used` increasing, and the place in it of each */
    size_t count() const
    {
        return used.empty() ? static_cast<size_t>(total) : used.size();
    }
    size_t at(size_t i) const
    {
        return used.empty() ? i : used[i];
    }
};
/* The same for those elements alone, with a warning and 0 for every NaN. */
void read_vertices(file &f, int accessor, uint32_t components, uint32_t accepted, const vertex_list &vertices,
                   const std::string &where, float *out);
/* Read an accessor as vertex indices; the caller checks their range. The largest number of a type, which ends a strip
 * elsewhere and is no index in glTF (3.7.2.1), is MODEL_NONE. */
std::vector<uint32_t> read_indices(file &f, int accessor, const std::string &where);

/* --- the parts of the model --- */
void read_materials(file &f);
void read_meshes(file &f);
/* The weights of a mesh or a node; out[target_count] is zeros before. */
void read_target_weights(file &f, const std::vector<double> &given, const std::string &where, uint32_t target_count,
                         float *out);
bool has_influences(const tinygltf::Primitive &p);
void allocate_influences(file &f, const std::string &where, model_mesh &out);
/* How the weights of one mesh's vertices were changed. */
struct influence_changes {
    size_t truncated = 0, rescaled = 0; /* vertices: over MODEL_INFLUENCES_MAX joints; weights that do not sum to 1 */
    size_t unbound = 0;                 /* vertices without any weight */
    double most_lost = 0.0;             /* the largest share of a vertex's weight that was dropped */
    double farthest_sum = 1.0;          /* the sum farthest from 1 */
};
void read_influences(file &f, const tinygltf::Primitive &p, const vertex_list &vertices, const model_submesh &part,
                     const std::string &where, model_mesh &out, influence_changes &changes);
void bind_to_first_joint(const model_submesh &part, model_mesh &out);
void warn_influence_changes(file &f, const influence_changes &changes, const std::string &where);
/* The UV set that a primitive's base colour texture uses ("TEXCOORD_1"), or the first where the primitive lacks it. */
/* The texture coordinates of a material, and KHR_texture_transform on them, taken from its first texture. */
struct uv_use {
    int set = 0;
    double offset[2] = { 0.0, 0.0 }, scale[2] = { 1.0, 1.0 }, rotation = 0.0;
};
uv_use uv_use_of(const tinygltf::Material &m);
std::string uv_name(const file &f, const tinygltf::Primitive &p);
void check_influences(file &f, model_mesh &mesh, uint32_t joint_count);
void read_nodes(file &f);
void read_skins(file &f); /* after read_nodes */
void read_animations(file &f);
/* Whether the file's figure faces -z, as VRM's did before 1.0. */
bool faces_back(const file &f);
void read_vrm(file &f); /* after read_nodes and read_meshes */
/* A target without deltas for each expression of a mesh, moved by its recipe: after read_animations. */
void add_expressions(file &f);
/* A member of an object, or NULL. */
const tinygltf::Value *member(const tinygltf::Value &object, const char *key);
const tinygltf::Value *array_member(const tinygltf::Value &object, const char *key);
std::string text_member(const tinygltf::Value &object, const char *key); /* "": it has none */
const tinygltf::Value *vrm_extension(const file &f, const char *name);   /* of the file */
/* The textures of a toon, indices in the file, or -1. */
struct toon_maps {
    bool given = false; /* it is a toon of VRM (MToon) */
    int shade = -1, matcap = -1, width = -1, shift = -1, rim = -1;
    double matcap_factor[3] = { 1.0, 1.0, 1.0 }, shift_scale = 1.0;
    int priority = 0; /* of what blends: VRM's order */
};
/* MToon of a material: sets its tones, rim and outline. After its base colour. */
toon_maps read_toon(file &f, size_t index, const std::string &where, model_material &out);
/* All that the curves of a file need; then the curves, as in base/curves.h. */
void read_scene(file &f, const bytes &data);
void read_curves(file &f, const bytes &data, curve_list &out);
void read_springs(file &f); /* after read_nodes */
/* Notes what no reader above handles: textures other than the base colour's, further UV sets and colours, cameras,
 * nodes outside the scene. */
void find_left_out(file &f);
void hide_nodes(file &f); /* after read_nodes */
/* KHR_animation_pointer of a channel; empty: it has none. */
std::string pointer_of(const tinygltf::AnimationChannel &c);
void read_extras(file &f, const tinygltf::Animation &a, const std::string &where, model_clip &out);

} // namespace gltf

#endif
