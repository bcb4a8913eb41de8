#!/bin/sh
# phones.sh [update]: compiles every kind of program with the compilers of phones' GPUs and compares their figures with
# table.txt; `update` writes the table. Ends like tests/run.sh. tools/phones/README.md describes it.
#
#   NOH_BUILD   the build folder; everything downloaded and made lies in its phones/
#   GPUS        only these columns: "g52 v3d"; the others keep the table's figures
#   JOBS        compilers that run at once
set -u
cd "$(dirname "$0")/../.." || exit 1
build=${NOH_BUILD:-build}
mkdir -p "$build/phones/cache" && folder=$(cd "$build/phones" && pwd) || exit 1
system=$folder/system libraries=$folder/system/usr/lib/aarch64-linux-gnu table=tools/phones/table.txt
# Column, driver of Mesa, and what its shim reads.
gpus='g52 panfrost PAN_GPU_ID=7212
g57 panfrost PAN_GPU_ID=9091
g610 panfrost PAN_GPU_ID=a867
a630 freedreno FD_GPU_ID=630,GALLIUM_THREAD=0,FD_MESA_DEBUG=shaderdb
a730 freedreno FD_GPU_ID=730,GALLIUM_THREAD=0,FD_MESA_DEBUG=shaderdb
v3d v3d V3D_DEBUG=precompile'

skip() {
    echo "phones skipped: $1"
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
}

# ---- Mesa of Debian trixie for arm64, and its shims ----

for tool in qemu-aarch64-static aarch64-linux-gnu-gcc apt-get dpkg-deb; do
    command -v $tool >/dev/null 2>&1 || skip "$tool is not installed (tools/deps.sh long)"
done

# An apt of its own: the system's packages and lists stay as they are.
apt_own() {
    apt-get -qq -o Dir::Etc::sourcelist="$folder/apt/sources.list" -o Dir::Etc::sourceparts=- \
        -o Dir::State="$folder/apt" -o Dir::State::status="$folder/apt/status" -o Dir::Cache="$folder/apt/cache" \
        -o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o APT::Install-Recommends=0 \
        -o APT::Sandbox::User= -o Acquire::Languages=none "$@"
}

get_system() {
    mkdir -p "$folder/apt/lists/partial" "$folder/apt/cache/archives/partial" "$system" || return 1
    : >"$folder/apt/status"
    debian='[signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian trixie main'
    printf 'deb %s\ndeb-src %s\n' "$debian" "$debian" >"$folder/apt/sources.list"
    apt_own update && apt_own -y --download-only install libegl1 libgles2 libegl-mesa0 libgl1-mesa-dri || return 1
    (cd "$folder" && apt_own source --download-only mesa) || return 1
    for package in "$folder"/apt/cache/archives/*.deb; do dpkg-deb -x "$package" "$system" || return 1; done
    [ -e "$system/lib" ] || ln -s usr/lib "$system/lib"
    tar -xf "$folder"/mesa_*.orig.tar.xz -C "$folder" --wildcards '*/include' '*/src/util' '*/src/drm-shim' \
        '*/src/c11' '*/src/*/drm-shim' && mv "$folder"/mesa-* "$folder/mesa"
}

# Mesa's device without a GPU: each library is preloaded, answers a driver's ioctls, and draws nothing.
build_shims() {
    (
        mkdir -p "$folder/shim" && cd "$folder/mesa" || exit 1
        set -- -std=gnu11 -O1 -fPIC -fvisibility=hidden -w -D_GNU_SOURCE -D_FILE_OFFSET_BITS=64 -DHAVE_PTHREAD \
            -DHAVE_STRUCT_TIMESPEC -DHAVE_TIMESPEC_GET -DUTIL_ARCH_LITTLE_ENDIAN=1 -DUTIL_ARCH_BIG_ENDIAN=0 \
            -DHAVE___BUILTIN_FFS -DHAVE___BUILTIN_FFSLL -DHAVE___BUILTIN_CLZ -DHAVE___BUILTIN_CLZLL \
            -DHAVE___BUILTIN_POPCOUNT -DHAVE___BUILTIN_EXPECT -DHAVE___BUILTIN_UNREACHABLE \
            -DHAVE_FUNC_ATTRIBUTE_PACKED -DHAVE_DLADDR -DHAVE_DL_ITERATE_PHDR -DHAVE_FLOCK -DHAVE_LINUX_FUTEX_H \
            -DHAVE_ENDIAN_H -DHAVE_SECURE_GETENV -DHAVE_MEMFD_CREATE -DHAVE_RANDOM_R -DHAVE_PROGRAM_INVOCATION_NAME \
            -DHAVE_DIRENT_D_TYPE -DHAVE_OPEN_MEMSTREAM \
            -Iinclude -Iinclude/drm-uapi -Isrc -Isrc/util -Isrc/drm-shim -Isrc/c11/impl -Isrc/gallium/include \
            -Isrc/panfrost -I/usr/include/libdrm
        shared=
        for name in util/hash_table util/set util/ralloc util/anon_file util/u_debug util/os_misc util/simple_mtx \
            util/futex util/log util/u_call_once util/memstream util/u_printf util/os_file util/rand_xor util/u_thread \
            util/vma util/blob util/u_math util/u_process drm-shim/device drm-shim/drm_shim c11/impl/threads_posix; do
            aarch64-linux-gnu-gcc "$@" -c "src/$name.c" -o "$folder/shim/${name##*/}.o" || exit 1
            shared="$shared $folder/shim/${name##*/}.o"
        done
        for name in panfrost/drm-shim/panfrost freedreno/drm-shim/freedreno broadcom/drm-shim/v3d; do
            # shellcheck disable=SC2086
            aarch64-linux-gnu-gcc "$@" -shared -o "$folder/shim/lib${name##*/}_noop.so" "src/${name}_noop.c" $shared \
                -L"$libraries" -l:libdrm.so.2 -ldl -lpthread -lm -Wl,--allow-shlib-undefined || exit 1
        done
    )
}

[ -f "$folder/system.done" ] || { get_system >"$folder/get.log" 2>&1 && touch "$folder/system.done"; } ||
    skip "Mesa of Debian trixie cannot be downloaded: $folder/get.log"
[ -f "$folder/shim.done" ] || { build_shims >"$folder/shim.log" 2>&1 && touch "$folder/shim.done"; } ||
    skip "Mesa's shims do not build: $folder/shim.log"
aarch64-linux-gnu-gcc -std=c99 -O1 -Wall -Wextra -idirafter /usr/include tools/phones/link.c -o "$folder/link" \
    -L"$libraries" -l:libEGL.so.1 -l:libGLESv2.so.2 -Wl,--allow-shlib-undefined,-rpath-link,"$libraries" \
    >"$folder/link.log" 2>&1 || skip "link.c does not build: $folder/link.log"

# ---- compiling what is new ----

rm -rf "$folder/texts" && mkdir "$folder/texts"
"$folder/texts.bin" "$folder/texts" >"$folder/names" || exit 1
version=$(sed -n 's/^Version: //p' "$folder"/mesa_*.dsc | head -n 1)
# What compilers see of a program: the text after its defines, so that a change compiles only the kinds that it concerns.
text_of() {
    for file in "$folder/texts/$1".*; do
        sed '/^#line/d; s/^#\(version\|extension\)/\1/' "$file" | aarch64-linux-gnu-gcc -E -P -undef -nostdinc -x c -
    done
}
while read -r name; do
    echo "$name $(text_of "$name" | sha256sum | cut -c1-32)-$version"
done <"$folder/names" >"$folder/hashes"

# compile GPU DRIVER VARIABLES: a file of figures for each program without one.
compile() {
    mkdir -p "$folder/cache/$1"
    while read -r name hash; do
        [ -f "$folder/cache/$1/$hash" ] || echo "$name"
    done <"$folder/hashes" >"$folder/$1.names"
    [ -s "$folder/$1.names" ] || return 0
    timeout 3600 qemu-aarch64-static -L "$system" \
        -E LD_LIBRARY_PATH="$libraries" -E LIBGL_DRIVERS_PATH="$libraries/dri" \
        -E LD_PRELOAD="$folder/shim/lib$2_noop.so" -E MESA_SHADER_CACHE_DISABLE=true -E "$3" \
        -E __EGL_VENDOR_LIBRARY_FILENAMES="$system/usr/share/glvnd/egl_vendor.d/50_mesa.json" \
        "$folder/link" "$folder/texts" <"$folder/$1.names" >"$folder/$1.out" 2>"$folder/$1.log"
    awk -f tools/phones/figures.awk -v hashes="$folder/hashes" -v folder="$folder/cache/$1" "$folder/$1.out"
}
# JOBS at once.
wanted=${GPUS:-$(echo "$gpus" | cut -d' ' -f1)} running=0
for gpu in $wanted; do
    line=$(echo "$gpus" | grep "^$gpu ") || { echo "phones.sh: no GPU '$gpu'" >&2; exit 2; }
    # shellcheck disable=SC2086
    compile $line &
    running=$((running + 1))
    [ $((running % ${JOBS:-2})) != 0 ] || wait
done
wait

# ---- the table ----

for gpu in $wanted; do
    while read -r name hash; do
        if [ -f "$folder/cache/$gpu/$hash" ]; then
            sed "s/^/$gpu $name /" "$folder/cache/$gpu/$hash"
        else
            echo "$gpu $name missing"
        fi
    done <"$folder/hashes"
done >"$folder/figures"
if [ "${1:-}" = update ]; then
    awk -f tools/phones/table.awk -v update=1 $table "$folder/figures" >"$folder/table.txt"
    code=$?
    mv "$folder/table.txt" $table
    exit $code
else
    awk -f tools/phones/table.awk $table "$folder/figures"
fi
