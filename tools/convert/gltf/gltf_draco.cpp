/* gltf_draco.cpp: KHR_draco_mesh_compression, by Google's decoder where the build found it (NOH_DRACO).
 *
 * The accessors of a compressed primitive have no bytes of their own: each is given a buffer view of decoded ones, of
 * the type that the accessor has, and is read and checked as any other. */
#include "gltf_internal.h"

#include <cstring>
#include <limits>
#include <memory>

#ifdef NOH_DRACO
#include <draco/compression/decode.h>
#endif

namespace gltf
{

static const char extension_name[] = "KHR_draco_mesh_compression";

bool reads_draco()
{
#ifdef NOH_DRACO
    return true;
#else
    return false;
#endif
}

static const tinygltf::Value *extension_of(const tinygltf::Primitive &p)
{
    auto found = p.extensions.find(extension_name);
    return found == p.extensions.end() || !found->second.IsObject() ? nullptr : &found->second;
}

#ifdef NOH_DRACO

struct job {
    file &f;
    tinygltf::Primitive &primitive;
    const tinygltf::Value &extension;
    std::string where;
    std::unique_ptr<draco::Mesh> mesh;
};

/* Let an accessor read these bytes. */
static void give_bytes(file &f, int accessor, const bytes &data)
{
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = 0;
    view.byteLength = data.size();
    view.byteStride = 0;
    f.json.bufferViews.push_back(view);
    f.decoded_views.push_back(data);
    tinygltf::Accessor &a = f.json.accessors[static_cast<size_t>(accessor)];
    a.bufferView = static_cast<int>(f.json.bufferViews.size() - 1);
    a.byteOffset = 0;
}

static void check_count(const job &j, int accessor, uint64_t count, const std::string &where)
{
    const uint64_t says = accessor_at(j.f, accessor, where).count;
    if (says != count)
        fail(where, text("accessor %d has %llu elements, but Draco decodes to %llu", accessor,
                         static_cast<unsigned long long>(says), static_cast<unsigned long long>(count)));
}

static void give_indices(job &j)
{
    const int accessor = j.primitive.indices;
    const uint64_t count = uint64_t{ j.mesh->num_faces() } * 3;
    if (accessor < 0) fail(j.where, "a primitive with Draco compression needs indices");
    check_count(j, accessor, count, j.where + " indices");
    charge(j.f, count, sizeof(uint32_t), j.where);
    bytes data(static_cast<size_t>(count) * sizeof(uint32_t));
    for (uint32_t i = 0; i < j.mesh->num_faces(); ++i) {
        const draco::Mesh::Face &face = j.mesh->face(draco::FaceIndex(i));
        for (uint32_t c = 0; c < 3; ++c) {
            const uint32_t vertex = face[c].value();
            memcpy(&data[(size_t{ i } * 3 + c) * sizeof vertex], &vertex, sizeof vertex);
        }
    }
    give_bytes(j.f, accessor, data);
    j.f.json.accessors[static_cast<size_t>(accessor)].componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

template <class T>
static bool convert(const draco::PointAttribute &attribute, uint32_t points, uint32_t components, bytes &out)
{
    std::vector<T> element(components);
    out.resize(size_t{ points } * components * sizeof(T));
    for (uint32_t i = 0; i < points; ++i) {
        const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
        if (value.value() >= attribute.size() ||
            !attribute.ConvertValue<T>(value, static_cast<int8_t>(components), element.data()))
            return false;
        memcpy(&out[size_t{ i } * components * sizeof(T)], element.data(), components * sizeof(T));
    }
    return true;
}

static bool convert_to(int type, const draco::PointAttribute &attribute, uint32_t points, uint32_t components,
                       bytes &out)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return convert<int8_t>(attribute, points, components, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return convert<uint8_t>(attribute, points, components, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return convert<int16_t>(attribute, points, components, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return convert<uint16_t>(attribute, points, components, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return convert<uint32_t>(attribute, points, components, out);
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return convert<float>(attribute, points, components, out);
    default: return false;
    }
}

static void give_attribute(job &j, const std::string &name, int id)
{
    const auto found = j.primitive.attributes.find(name);
    const std::string where = j.where + " " + printable(name);
    if (found == j.primitive.attributes.end()) fail(where, "Draco has an attribute that the primitive does not");
    const tinygltf::Accessor &a = accessor_at(j.f, found->second, where);
    const int components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(a.type));
    const draco::PointAttribute *attribute = j.mesh->GetAttributeByUniqueId(static_cast<uint32_t>(id));
    bytes data;
    check_count(j, found->second, j.mesh->num_points(), where);
    if (!attribute || components < 1 || components > 4 || attribute->num_components() != components)
        fail(where, "Draco's data has no such attribute, or one with another number of components");
    charge(j.f, j.mesh->num_points(), 4u * static_cast<uint32_t>(components), where);
    if (!convert_to(a.componentType, *attribute, j.mesh->num_points(), static_cast<uint32_t>(components), data))
        fail(where, "Draco's data does not fit the accessor's type");
    give_bytes(j.f, found->second, data);
}

static void decode(job &j)
{
    const tinygltf::Value &view = j.extension.Get("bufferView"), &attributes = j.extension.Get("attributes");
    if (!view.IsInt() || !attributes.IsObject())
        fail(j.where, "KHR_draco_mesh_compression needs 'bufferView' and 'attributes'");
    const span s = view_bytes(j.f, view.Get<int>(), j.where);
    draco::DecoderBuffer buffer;
    draco::Decoder decoder;
    buffer.Init(reinterpret_cast<const char *>(s.data), static_cast<size_t>(s.size));
    const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
    if (!type.ok() || type.value() != draco::TRIANGULAR_MESH) fail(j.where, "its Draco data is not a triangle mesh");
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) fail(j.where, "its Draco data is damaged: " + printable(decoded.status().error_msg_string()));
    j.mesh = std::move(decoded).value();
    give_indices(j);
    for (const std::string &name : attributes.Keys()) {
        if (!attributes.Get(name).IsInt()) fail(j.where, "KHR_draco_mesh_compression: an attribute is not a number");
        give_attribute(j, name, attributes.Get(name).Get<int>());
    }
}

#else

struct job {
    file &f;
    tinygltf::Primitive &primitive;
    const tinygltf::Value &extension;
    std::string where;
};

/* Where the extension is not required, the accessors have bytes of their own. */
static void decode(const job &j)
{
    const auto position = j.primitive.attributes.find("POSITION");
    if (position != j.primitive.attributes.end() &&
        accessor_at(j.f, position->second, j.where + " POSITION").bufferView >= 0)
        return;
    fail(j.where,
         "it uses KHR_draco_mesh_compression, and noh was built without Draco: export without it, or install Draco "
         "(Debian: apt install libdraco-dev) and rebuild noh");
}

#endif

void decode_draco(file &f)
{
    for (size_t m = 0; m < f.json.meshes.size(); ++m) {
        tinygltf::Mesh &mesh = f.json.meshes[m];
        for (size_t i = 0; i < mesh.primitives.size(); ++i) {
            const tinygltf::Value *extension = extension_of(mesh.primitives[i]);
            if (!extension) continue;
            const std::string where = "mesh '" + printable(name_or(mesh.name, "mesh", m)) + "'" +
                                      text(" primitive %zu", i);
#ifdef NOH_DRACO
            job j = { f, mesh.primitives[i], *extension, where, nullptr };
#else
            const job j = { f, mesh.primitives[i], *extension, where };
#endif
            decode(j);
        }
    }
}

} // namespace gltf
