"""A recipe for Conan 2: put noh-@VERSION@.tar.gz into this folder, then `conan create .`."""
import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain
from conan.tools.files import check_sha256, copy, unzip


class Noh(ConanFile):
    name = "noh"
    version = "@VERSION@"
    license = "MIT"
    description = "Characters in fixed memory, for OpenGL ES 3"
    package_type = "static-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"gl": [True, False]}
    default_options = {"gl": True}
    exports_sources = "noh-@VERSION@.tar.gz"

    def source(self):
        archive = os.path.join(self.export_sources_folder, "noh-@VERSION@.tar.gz")
        check_sha256(self, archive, "@SHA256@")
        unzip(self, archive, strip_root=True)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["NOH_INSTALL"] = True
        toolchain.cache_variables["NOH_GL"] = bool(self.options.gl)
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure(build_script_folder="runtime")
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        self.cpp_info.libs = ["noh"]
        self.cpp_info.set_property("cmake_target_name", "noh::noh")
