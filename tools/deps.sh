#!/bin/sh
# deps.sh SET...: install the Debian packages that are missing.
#   build  compiler, converter libraries, headless GL     check  test tools
#   fuzz   clang and its fuzzer                           cross  other processors
#   web    the page and its test                          view   the window of noh view
#   lint   clang-tidy and cppcheck                        docs   the API reference
#   long   what make check-long adds: memcheck, AFL++
#   ear    synthesisers that teach the ear (make ear-tables)
# Optional packages ("?") may be unavailable: what needs them is left out, or its test is skipped with the reason.
# Where there is no apt, the list is printed and the script stops.
set -eu

packages_build='make:the build
gcc:the C compiler
libc6-dev:the C library
g++:tinygltf is C++
pkg-config:finding libraries
libegl-dev:GL ES headers
libgles-dev:GL ES headers
libegl1:a GL context
libgles2:a GL context
libegl-mesa0:a GL context without a display
libgl1-mesa-dri:the software rasteriser
libtinygltf-dev:reading glTF
nlohmann-json3-dev:reading glTF
libstb-dev:reading and writing pictures
libmeshoptimizer-dev:reading compressed glTF
?libdraco-dev:reading Draco meshes in glTF'
packages_view='?libglfw3-dev:noh view
?libimgui-dev:noh view'
packages_check='libcmocka-dev:unit tests
?lld:linking them in a third of the time
?libglfw3:windows
?xvfb:a display for them
?assimp-testmodels:real BVH files
?mesa-vulkan-drivers:a third GL, zink on lavapipe
?xdotool:keys and mouse for them
?libx11-dev:files dropped on them
?x11-utils:a dense display
libosmesa6:a second GL
?clang:a second compiler
?cmake:using the installed library
?ninja-build:packs in a build system
?gcc-12-multilib:32 bits
?libsdl2-dev:the first program of the guide
?libglew-dev:noh_gl.h with its header
?python3-glad:noh_gl.h with its headers
?libespeak-ng1:noh speak
?espeak-ng-data:noh speak
?libsndfile1:noh speak on recordings
?libwebp7:WebP textures
?astcenc:noh build --textures astc
binutils:the check of the archive'"'"'s symbols
patch:mutants of the table of techniques'
packages_fuzz='clang:libFuzzer
libclang-rt-dev:libFuzzer and the sanitizers'

packages_cross='?gcc-aarch64-linux-gnu:aarch64
?libc6-dev-arm64-cross:aarch64
?gcc-arm-linux-gnueabihf:armv7
?libc6-dev-armhf-cross:armv7
?qemu-user-static:running both
?emscripten:wasm
?nodejs:running wasm
?gcc-mingw-w64-x86-64-win32:Windows
?wine64:running it
?wine:running it'
packages_web='?emscripten:the page
?nodejs:its test
?npm:its test
?esbuild:its scripts, smaller
?chromium:its test
?dpkg-dev:its converter, out of sources
libcmocka-dev:its test'
packages_lint='clang-tidy:static analysis
cppcheck:static analysis'
packages_long='?valgrind:memcheck
?afl++:fuzzing noh build
?gcc-aarch64-linux-gnu:compilers of phones
?libc6-dev-arm64-cross:compilers of phones
?qemu-user-static:running them
?libdrm-dev:their shims
?frama-c-base:proofs of the checkers
?firefox-esr:the page in a second browser
?webkit2gtk-driver:the page in a third browser
?debhelper:Debian packages
?lintian:the check of Debian packages'
packages_ear='libespeak-ng-dev:formants in every language
flite:statistics of four voices
festival:voices cut out of recordings
festvox-kallpc16k:an American
festvox-kdlpc16k:an American
festvox-us-slt-hts:an American
festvox-italp16k:an Italian
festvox-itapc16k:an Italian
festvox-czech-dita:a Czech
festvox-czech-krb:a Czech
festvox-czech-machac:a Czech
festvox-czech-ph:a Czech
festvox-suopuhe-lj:a Finn
festvox-suopuhe-mv:a Finn
festvox-ru:a Russian
festvox-ca-ona-hts:a Catalan'
packages_docs='doxygen:the API reference'

# Or the command of that name is here from elsewhere.
installed() {
    command -v "$1" >/dev/null 2>&1 || dpkg-query -W -f '${Status}' "$1" 2>/dev/null | grep -q 'install ok installed'
}

all=
for set in "$@"; do
    case $set in
    build) all="$all
$packages_build" ;;
    view) all="$all
$packages_view" ;;
    check) all="$all
$packages_check" ;;
    fuzz) all="$all
$packages_fuzz" ;;
    cross) all="$all
$packages_cross" ;;
    web) all="$all
$packages_web" ;;
    lint) all="$all
$packages_lint" ;;
    long) all="$all
$packages_long" ;;
    ear) all="$all
$packages_ear" ;;
    docs) all="$all
$packages_docs" ;;
    *) echo "deps.sh: no set '$set'" >&2; exit 2 ;;
    esac
done

if ! command -v dpkg-query >/dev/null 2>&1 || ! command -v apt-get >/dev/null 2>&1; then
    echo 'This is not a Debian system. noh needs what these Debian packages hold (DEPS=0 skips this check):'
    echo "$all" | tr -d '?' | sed -n 's/\(.*\):\(.*\)/  \1 (\2)/p'
    exit 1
fi

missing=$(echo "$all" | while IFS=: read -r name why; do
    [ -z "$name" ] || installed "${name#\?}" || echo "$name:$why"
done)
[ -n "$missing" ] || exit 0

echo 'Installing what is missing:'
echo "$missing" | sed 's/^?\(.*\):\(.*\)/  \1 (\2; optional)/; s/^\([^ ].*\):\(.*\)/  \1 (\2)/'
names=$(echo "$missing" | grep -v '^?' | cut -d: -f1)
optional=$(echo "$missing" | sed -n 's/^?\(.*\):.*/\1/p')
sudo=
if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null 2>&1 || { echo 'deps.sh: not root and no sudo; install them yourself' >&2; exit 1; }
    sudo=sudo
fi
export DEBIAN_FRONTEND=noninteractive LC_ALL=C

# apt-get ARGUMENT...: on a fresh machine another process often holds one of apt's locks; apt itself waits for dpkg's,
# not for the lock of the package lists. Tries for five minutes.
apt() {
    deadline=$(($(date +%s) + 300))
    until said=$($sudo apt-get -o DPkg::Lock::Timeout=300 -qq "$@" 2>&1); do
        case $said in *'Could not get lock'* | *'Unable to lock'*) ;; *) deadline=0 ;; esac
        [ "$(date +%s)" -lt "$deadline" ] || { echo "$said" >&2; return 1; }
        sleep 1
    done
}

apt update
# shellcheck disable=SC2086
[ -z "$names" ] || apt install -y --no-install-recommends $names
# shellcheck disable=SC2086
[ -z "$optional" ] || apt install -y --no-install-recommends $optional 2>/dev/null || for name in $optional; do
    apt install -y --no-install-recommends "$name" 2>/dev/null || echo "  $name is not available: what needs it is left out"
done
