/* gltf_view.cpp: buffer views: a range of a buffer, or data decoded from EXT_meshopt_compression or by gltf_draco.cpp.
 */
#include "gltf_internal.h"

namespace gltf
{

/* Decoded once, then kept. */
static span compressed_view(file &f, size_t index, const tinygltf::Value &extension, const std::string &where)
{
    const tinygltf::BufferView &view = f.json.bufferViews[index];
    bytes &decoded = f.decoded_views[index];
    if (decoded.empty()) decoded = decode_meshopt(f, extension, where);
    if (decoded.size() < view.byteLength)
        fail(where, text("EXT_meshopt_compression decodes to %zu bytes, but 'byteLength' says %zu", decoded.size(),
                         view.byteLength));
    return { decoded.data(), view.byteLength, view.byteStride };
}

span view_bytes(file &f, int index, const std::string &where)
{
    if (index < 0 || static_cast<size_t>(index) >= f.json.bufferViews.size())
        fail(where, text("buffer view %d does not exist: the file has %zu", index, f.json.bufferViews.size()));
    const tinygltf::BufferView &view = f.json.bufferViews[static_cast<size_t>(index)];
    std::string inner = where + text(", buffer view %d", index);
    auto extension = view.extensions.find("EXT_meshopt_compression");
    if (extension != view.extensions.end())
        return compressed_view(f, static_cast<size_t>(index), extension->second, inner);
    const bytes &decoded = f.decoded_views[static_cast<size_t>(index)]; /* of Draco */
    if (!decoded.empty()) return { decoded.data(), decoded.size(), view.byteStride };
    span s = buffer_bytes(f, view.buffer, view.byteOffset, view.byteLength, inner);
    s.stride = view.byteStride;
    return s;
}

} // namespace gltf
