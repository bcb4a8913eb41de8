/* fbx_picture.cpp: the pictures of textures, in the file or in its folder. */
#include "fbx_internal.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "convert/base/input_file.h"

namespace fbx
{

static std::string base_name(const std::string &path)
{
    const size_t slash = path.find_last_of("/\\");
    return slash == std::string::npos ? path : path.substr(slash + 1);
}

/* --- in the file --- */

static int digit_of(char c)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = c ? strchr(digits, c) : nullptr;
    return found ? static_cast<int>(found - digits) : -1;
}

static std::string from_base64(const std::string &text)
{
    std::string out;
    unsigned bits = 0;
    int count = 0;
    for (char c : text) {
        const int digit = digit_of(c);
        if (digit < 0) continue;
        bits = (bits << 6 | static_cast<unsigned>(digit)) & 0xffffff;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        out += static_cast<char>(bits >> count & 0xff);
    }
    return out;
}

/* ASCII files may write a picture in several pieces. */
static std::string content_of(const scene &s, size_t video)
{
    const node *content = s.objects[video].from->child("Content");
    std::string out;
    for (size_t i = 0; content && i < content->values.size(); ++i)
        out += s.file.ascii ? from_base64(content->text(i)) : content->text(i);
    return out;
}

static std::string file_name(const scene &s, size_t object)
{
    for (const char *name : { "RelativeFilename", "Filename", "FileName" }) {
        const node *given = s.objects[object].from->child(name);
        if (given && !given->text(0).empty()) return given->text(0);
    }
    return "";
}

/* The bytes of the texture's video, or of another that has its name. */
static std::string embedded(const scene &s, size_t texture, const std::string &name)
{
    for (size_t video : s.below(texture, "Video", nullptr)) {
        const std::string bytes = content_of(s, video);
        if (!bytes.empty()) return bytes;
    }
    for (size_t i = 0; i < s.objects.size(); ++i)
        if (s.objects[i].kind == "Video" && base_name(file_name(s, i)) == name) {
            const std::string bytes = content_of(s, i);
            if (!bytes.empty()) return bytes;
        }
    return "";
}

/* --- in the folder --- */

/* The name of a picture that is there, from the model's folder; empty: there is none. */
static std::string name_there(const std::filesystem::path &folder, const std::string &name, bool any_case)
{
    std::error_code ignored;
    const std::string picture = (folder / name).string();
    char other[4096];
    if (any_case && !input_find_any_case(picture.c_str(), other, sizeof other)) return std::string();
    const char *path = any_case ? other : picture.c_str();
    const bool found = inputs_are_held() ? input_find_held(path) != nullptr
                                         : std::filesystem::is_regular_file(path, ignored);
    inputs_note(path, found);
    return !found ? std::string() : std::string(path).substr(picture.size() - name.size());
}

/* Paths are from the author's machine: the picture is looked up by its name, where exporters put it. */
static std::string beside(const job &j, const std::string &path)
{
    const std::filesystem::path file(j.path);
    const std::string name = base_name(path);
    std::string as_given = path;
    std::replace(as_given.begin(), as_given.end(), '\\', '/');
    /* a name as it is may have backslashes: some programs unpack the archives of Windows so */
    const std::string tries[] = { path == as_given ? std::string() : path,
                                  as_given,
                                  name,
                                  file.stem().string() + ".fbm/" + name,
                                  "textures/" + name,
                                  "Textures/" + name,
                                  "../textures/" + name,
                                  "../Textures/" + name };
    for (bool any_case : { false, true })
        for (const std::string &try_at : tries) {
            const bool local = !try_at.empty() && try_at[0] != '/' && try_at[0] != '\\' &&
                               try_at.find(':') == std::string::npos && try_at.find('\0') == std::string::npos;
            const std::string found = local ? name_there(file.parent_path(), try_at, any_case) : std::string();
            if (!found.empty()) return found;
        }
    return std::string();
}

static std::string percent_encode(const std::string &path)
{
    static const char digits[] = "0123456789ABCDEF";
    std::string out;
    for (char c : path) {
        const unsigned char byte = static_cast<unsigned char>(c);
        const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                           strchr("-_.~/", c);
        if (plain && c)
            out += c;
        else
            (((out += '%') += digits[byte >> 4]) += digits[byte & 15]);
    }
    return out;
}

/* --- textures --- */

std::string picture_path(const scene &s, size_t texture)
{
    const std::string own = file_name(s, texture);
    for (size_t video : s.below(texture, "Video", nullptr)) {
        if (!own.empty()) break;
        return file_name(s, video);
    }
    return own;
}

static bool is_moved(const scene &s, size_t texture)
{
    const vec turn = s.vector(texture, "Rotation", 0.0), place = s.vector(texture, "Translation", 0.0);
    const vec scale = s.vector(texture, "Scaling", 1.0) - vec{ { 1.0, 1.0, 1.0 } };
    return dot(turn, turn) + dot(place, place) + scale[0] * scale[0] + scale[1] * scale[1] > 1e-12;
}

static bool find_image(job &j, size_t texture, tinygltf::Image &out)
{
    const std::string path = picture_path(j.in, texture), name = base_name(path);
    const std::string bytes = embedded(j.in, texture, name);
    out.name = name_of(j.in, name);
    if (!bytes.empty()) {
        out.mimeType = bytes.compare(0, 2, "\xff\xd8") == 0 ? "image/jpeg" : "image/png";
        out.bufferView = add_view(j, bytes.data(), bytes.size());
        return true;
    }
    const std::string at = beside(j, path);
    if (at.empty()) {
        j.in.warn("the picture '" + out.name + "'", " is neither in the file nor in its folder and was left out");
        return false;
    }
    out.uri = percent_encode(at);
    return true;
}

int texture_of(job &j, size_t texture)
{
    const auto known = j.texture_of.find(texture);
    tinygltf::Image image;
    tinygltf::Texture out;
    if (known != j.texture_of.end()) return known->second;
    if (j.in.objects[texture].kind == "LayeredTexture") {
        const std::vector<size_t> layers = j.in.below(texture, "Texture", nullptr);
        if (layers.size() > 1) j.in.warn(place_of(j.in, texture), " has layers; only the first was read");
        return j.texture_of[texture] = layers.empty() ? -1 : texture_of(j, layers[0]);
    }
    if (!find_image(j, texture, image)) return j.texture_of[texture] = -1;
    if (is_moved(j.in, texture))
        j.in.warn(place_of(j.in, texture), " is moved, turned or scaled, which was left out: apply it to the texture "
                                           "coordinates");
    out.source = static_cast<int>(j.out.images.size());
    for (size_t i = 0; i < j.out.images.size() && !image.uri.empty(); ++i)
        if (j.out.images[i].uri == image.uri) return j.texture_of[texture] = static_cast<int>(i);
    j.out.images.push_back(image);
    j.out.textures.push_back(out);
    return j.texture_of[texture] = static_cast<int>(j.out.textures.size() - 1);
}

} // namespace fbx
