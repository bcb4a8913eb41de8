#include "file_kind.h"

#include <stddef.h>
#include <string.h>

#include "convert/base/input_file.h"

#define EXPORT "export glTF 2.0 (.glb) from the program that it is of, and give noh that file"
#define BLENDER "export glTF 2.0 in Blender (File, Export, glTF 2.0), and give noh the .glb file"
#define TO_GLTF "open it in Blender, export glTF 2.0 (File, Export, glTF 2.0), and give noh the .glb file"
#define PICTURE \
    "textures are read with the model that names them; noh render MODEL --light FILE lights by a panorama of .hdr or .png"
#define SPEECH "noh speak makes a clip of a recording"
#define ARCHIVE "unpack it, and give noh the model in it"
#define TEXT(option) "noh build MODEL " option " FILE reads it"
#define WEB_PAGE "download the file itself, not the page that shows it"

/* Rows with both a beginning and an ending are of one format; the first row that fits counts. */
static const file_kind kinds[] = {
    { ".noh", "NOHP", READER_PACK, "a pack", "it is built already: noh info, noh render and noh view take it" },
    { ".nohz", "NOHZ", READER_PACK, "the wire form of a pack",
      "it is built already: noh info, noh render and noh view take it" },
    { ".glb", "glTF", READER_GLTF, "a glTF file", NULL },
    { ".gltf", NULL, READER_GLTF, "a glTF file", NULL },
    { ".vrm", NULL, READER_GLTF, "a VRM file", NULL },
    { ".fbx", "Kaydara FBX Binary", READER_FBX, "an FBX file", NULL },
    { ".obj", NULL, READER_OBJ, "an OBJ file", NULL },
    { ".bvh", "HIERARCHY", READER_BVH, "a BVH file", NULL },
    { ".rcl", "RCL1", READER_RCL, "a raw clip", NULL },
    { ".csv", NULL, READER_FACE, "a table of facial capture", NULL },
    { ".trc", "PathFileType", READER_TRC, "a TRC file", NULL },
    { ".c3d", NULL, READER_C3D, "a C3D file", NULL },
    { ".blend", "BLENDER", READER_NONE, "a Blender file", BLENDER },
    { ".blend1", NULL, READER_NONE, "a backup of a Blender file", BLENDER },
    { ".dae", NULL, READER_NONE, "a COLLADA file", TO_GLTF },
    { ".usdz", NULL, READER_NONE, "a USD file", TO_GLTF },
    { ".usda", "#usda", READER_NONE, "a USD file", TO_GLTF },
    { ".usdc", "PXR-USDC", READER_NONE, "a USD file", TO_GLTF },
    { ".usd", NULL, READER_NONE, "a USD file", TO_GLTF },
    { ".abc", NULL, READER_NONE, "an Alembic file", TO_GLTF },
    { ".ply", "ply\n", READER_NONE, "a PLY file", TO_GLTF },
    { ".stl", NULL, READER_NONE, "an STL file", TO_GLTF },
    { ".3ds", NULL, READER_NONE, "a 3DS file", TO_GLTF },
    { ".max", NULL, READER_NONE, "a 3ds Max file", EXPORT },
    { ".ma", "//Maya ASCII", READER_NONE, "a Maya file", EXPORT },
    { ".mb", NULL, READER_NONE, "a Maya file", EXPORT },
    { ".c4d", NULL, READER_NONE, "a Cinema 4D file", EXPORT },
    { ".duf", NULL, READER_NONE, "a Daz file", EXPORT },
    { ".pmx", "PMX ", READER_NONE, "an MMD model", TO_GLTF },
    { ".pmd", "Pmd", READER_NONE, "an MMD model", TO_GLTF },
    { ".png", "\x89PNG", READER_NONE, "a PNG picture", PICTURE },
    { ".jpg", "\xff\xd8\xff", READER_NONE, "a JPEG picture", PICTURE },
    { ".jpeg", NULL, READER_NONE, "a JPEG picture", PICTURE },
    { ".hdr", "#?RADIANCE", READER_NONE, "an HDR panorama", PICTURE },
    { ".gif", "GIF8", READER_NONE, "a GIF picture", PICTURE },
    { ".exr", "\x76\x2f\x31\x01", READER_NONE, "an OpenEXR picture", PICTURE },
    { ".psd", "8BPS", READER_NONE, "a Photoshop file", PICTURE },
    { ".tif", "II*", READER_NONE, "a TIFF picture", PICTURE },
    { ".tiff", NULL, READER_NONE, "a TIFF picture", PICTURE },
    { ".bmp", NULL, READER_NONE, "a BMP picture", PICTURE },
    { ".tga", NULL, READER_NONE, "a TGA picture", PICTURE },
    { ".dds", "DDS ", READER_NONE, "a DDS picture", PICTURE },
    { ".ktx2", "\xabKTX 20", READER_NONE, "a KTX2 picture", PICTURE },
    { ".ktx", "\xabKTX 11", READER_NONE, "a KTX picture", PICTURE },
    { ".avif", "ftypavif", READER_NONE, "an AVIF picture", PICTURE },
    { ".heic", "ftypheic", READER_NONE, "a HEIC picture", PICTURE },
    { ".webp", NULL, READER_NONE, "a WebP picture", PICTURE },
    { ".mtl", NULL, READER_NONE, "materials of an OBJ file", "give noh the .obj file" },
    { ".bin", NULL, READER_NONE, "data of a glTF file", "give noh the .gltf file that names it" },
    { ".wav", "RIFF", READER_NONE, "a recording", SPEECH },
    { ".mp3", NULL, READER_NONE, "a recording", SPEECH },
    { ".ogg", "OggS", READER_NONE, "a recording", SPEECH },
    { ".flac", "fLaC", READER_NONE, "a recording", SPEECH },
    { ".zip", "PK\x03\x04", READER_NONE, "a zip archive", ARCHIVE },
    { ".gz", "\x1f\x8b", READER_NONE, "a gzip archive", ARCHIVE },
    { ".7z", "7z\xbc\xaf", READER_NONE, "a 7z archive", ARCHIVE },
    { ".unitypackage", NULL, READER_NONE, "a Unity package", ARCHIVE },
    { ".graph", NULL, READER_NONE, "a text of animation graphs", TEXT("--graph") },
    { ".recipe", NULL, READER_NONE, "a text of a face's recipe", TEXT("--recipe") },
    { ".ragdoll", NULL, READER_NONE, "a text of a ragdoll", TEXT("--ragdoll") },
    { ".springs", NULL, READER_NONE, "a text of springs", TEXT("--springs") },
    { ".hair", NULL, READER_NONE, "a text of a haircut", TEXT("--hair") },
    { ".names", NULL, READER_NONE, "a text of names", TEXT("--names") },
    { ".place", NULL, READER_NONE, "a text of a place", "noh crowd PACK --place FILE reads it" },
    { ".session", NULL, READER_NONE, "a recording of play", "noh lab replay PACK --play FILE reads it" },
    { NULL, "version https://git-lfs.", READER_NONE, "a Git LFS pointer in place of the file",
      "run git lfs pull in its repository" },
    { NULL, "<!doctype html", READER_NONE, "a web page in place of the file", WEB_PAGE },
    { NULL, "<html", READER_NONE, "a web page in place of the file", WEB_PAGE },
};

#define KIND_COUNT (sizeof kinds / sizeof kinds[0])

/* Whatever its name is. */
static const file_kind empty = { NULL, "", READER_NONE, "an empty file", "export it, or download it, once more" };

static char small_letter(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c + 32) : c;
}

int file_has_ending(const char *path, const char *ending)
{
    const size_t length = strlen(path), tail = strlen(ending);
    if (length < tail) return 0;
    for (size_t i = 0; i < tail; i++) {
        if (small_letter(path[length - tail + i]) != ending[i]) return 0;
    }
    return 1;
}

/* What came in place of a file is text: web pages begin with empty lines or a byte order mark, in any letters. */
static int begins_as(const file_kind *kind, const char *bytes, size_t count)
{
    const int is_text = !kind->ending;
    const size_t length = strlen(kind->begins);
    size_t at = strncmp(kind->begins, "ftyp", 4) == 0 ? 4 : 0; /* after the length of its box */
    while (is_text && at < count && bytes[at] && strchr("\xef\xbb\xbf \t\r\n", bytes[at])) at++;
    if (count < at + length) return 0;
    for (size_t i = 0; i < length; i++) {
        const char c = bytes[at + i];
        if ((is_text ? small_letter(c) : c) != kind->begins[i]) return 0;
    }
    return 1;
}

const file_kind *file_kind_of_bytes(const void *bytes, size_t count)
{
    for (size_t i = 0; i < KIND_COUNT; i++) {
        if (kinds[i].begins && begins_as(&kinds[i], bytes, count)) return &kinds[i];
    }
    return NULL;
}

static const file_kind *by_beginning(const char *path, int *is_there)
{
    const file_kind *found;
    const void *data;
    size_t count;
    *is_there = !input_map(path, &data, &count, NULL);
    if (!*is_there) return NULL;
    found = count ? file_kind_of_bytes(data, count) : &empty;
    input_unmap(data, count);
    return found;
}

/* Containers such as RIFF and zip hold many formats: there the ending decides. */
const file_kind *file_kind_of(const char *path)
{
    int is_there;
    const file_kind *began = by_beginning(path, &is_there), *ends = NULL;
    for (size_t i = 0; i < KIND_COUNT && !ends; i++) {
        if (kinds[i].ending && file_has_ending(path, kinds[i].ending)) ends = &kinds[i];
    }
    if (began && began->reader != READER_NONE) return began;
    if (!is_there && ends && ends->reader == READER_NONE) return NULL;
    return !began || (began->ending && ends && ends->reader == READER_NONE) ? ends : began;
}

int file_kind_is_built(const file_kind *kind)
{
    return kind && kind->reader != READER_NONE && kind->reader != READER_PACK;
}
