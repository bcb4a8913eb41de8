/* fbx_read.cpp: the process that reads an FBX file, and its result: a .glb and messages for the user. */
#include "fbx_read.h"

#include "convert/model/model_build.h"

#ifdef NOH_ASSIMP

#include "fbx_internal.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <sstream>

namespace fbx
{

static const rlim_t seconds_max = 300;
static const long bytes_max = 0x7fffffff;

/* --- the process that reads --- */

static std::string line_of(std::string text)
{
    for (char &c : text)
        if (static_cast<unsigned char>(c) < 32) c = ' ';
    return text.substr(0, 230);
}

/* A hostile file may loop or crash: the time is limited, and no core file is written. */
static void limit_process()
{
    const rlimit time = { seconds_max, seconds_max }, none = { 0, 0 };
    setrlimit(RLIMIT_CPU, &time);
    setrlimit(RLIMIT_CORE, &none);
}

static void write_glb(const job &j, FILE *to)
{
    std::ostringstream stream(std::ios::binary);
    tinygltf::TinyGLTF writer;
    tinygltf::Model out = j.out;
    out.asset.version = "2.0";
    if (!writer.WriteGltfSceneToStream(&out, stream, false, true)) throw std::runtime_error("it has no scene");
    const std::string bytes = stream.str();
    if (fwrite(bytes.data(), 1, bytes.size(), to) != bytes.size() || fflush(to))
        throw std::runtime_error("cannot write a temporary file: no space left");
}

static void convert(const char *path, double unit_cm, FILE *glb, FILE *words)
{
    Assimp::Importer importer;
    job j;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_CAMERAS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_LIGHTS, false);
    j.scene = importer.ReadFile(path, aiProcess_Triangulate);
    if (!j.scene) throw std::runtime_error(importer.GetErrorString());
    j.path = path;
    j.unit = unit_cm / 100.0;
    read_scene(j);
    write_glb(j, glb);
    for (const std::string &said : j.notes) fprintf(words, "note %s\n", line_of(said).c_str());
    fprintf(words, "done\n");
}

[[noreturn]] static void run_process(const char *path, double unit_cm, FILE *glb, FILE *words)
{
    limit_process();
    try {
        convert(path, unit_cm, glb, words);
    } catch (const std::exception &reason) {
        fprintf(words, "fail %s\n", line_of(reason.what()).c_str());
    }
    fflush(words);
    _exit(0);
}

/* --- the process that asks --- */

struct file_closer {
    void operator()(FILE *stream) const
    {
        fclose(stream);
    }
};
using temporary = std::unique_ptr<FILE, file_closer>;

static bool read_back(FILE *from, std::string &out)
{
    long size;
    if (fseek(from, 0, SEEK_END) || (size = ftell(from)) < 0 || size > bytes_max) return false;
    rewind(from);
    out.resize(static_cast<size_t>(size));
    return fread(&out[0], 1, out.size(), from) == out.size();
}

static bool wait_for(pid_t process)
{
    int status = 0;
    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR) return false;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* The messages of the process; 0 if it ended normally and *glb is set. */
static int read_words(const std::string &words, std::vector<std::string> &notes, model_error *error)
{
    std::istringstream lines(words);
    bool done = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.compare(0, 5, "fail ") == 0) return model_fail(error, "FBX", "%s", line.c_str() + 5);
        if (line.compare(0, 5, "note ") == 0) notes.push_back(line.substr(5));
        done = done || line == "done";
    }
    return done
               ? 0
               : model_fail(
                     error, "FBX",
                     "Assimp, which reads FBX, crashed: the file is damaged or too large; export it again, or as glTF");
}

static int read_in_process(const char *path, double unit_cm, std::string &glb, std::vector<std::string> &notes,
                           model_error *error)
{
    const temporary to(tmpfile()), said(tmpfile());
    std::string words;
    if (!to || !said) return model_fail(error, "", "cannot make a temporary file");
    fflush(nullptr); /* or the other process writes it again */
    const pid_t process = fork();
    if (process < 0) return model_fail(error, "", "cannot start a process to read FBX");
    if (process == 0) run_process(path, unit_cm, to.get(), said.get());
    const bool ended = wait_for(process);
    if (!read_back(said.get(), words) || !read_back(to.get(), glb))
        return model_fail(error, "FBX", "the model is larger than 2 GiB, which is the limit");
    return read_words(ended ? words : "", notes, error);
}

static int read(const char *path, double unit_cm, model **out, model_error *error)
{
    std::string glb;
    std::vector<std::string> notes;
    if (read_in_process(path, unit_cm, glb, notes, error) ||
        model_read_glb(reinterpret_cast<const uint8_t *>(glb.data()), glb.size(), path, out, error))
        return 1;
    for (const std::string &said : notes)
        if (model_warn(*out, "%s", said.c_str())) {
            model_free(*out);
            *out = nullptr;
            return model_fail(error, "", "out of memory");
        }
    return 0;
}

} // namespace fbx

extern "C" int fbx_read(const char *path, const fbx_options *options, model **out, model_error *error)
{
    *out = nullptr;
    try {
        return fbx::read(path, options->unit_cm, out, error);
    } catch (const std::bad_alloc &) {
        return model_fail(error, "", "there is not enough memory to read this file");
    }
}

#else

extern "C" int fbx_read(const char *, const fbx_options *, model **out, model_error *error)
{
    *out = nullptr;
    return model_fail(error, "",
                      "this noh was built without Assimp, which reads FBX: install libassimp-dev and build "
                      "again, or export glTF");
}

#endif
