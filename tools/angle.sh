#!/bin/sh
# angle.sh FOLDER: puts ANGLE's libraries and SwiftShader into FOLDER, for the platform `angle`; installs nothing. They
# are in Debian's chromium-common. Some of its versions have only empty libEGL.so and libGLESv2.so, so every version
# that apt knows is tried, the oldest first. If none will do, FOLDER/missing.txt says why, and later calls do not try
# again (remove FOLDER to retry). Never fails: tests that need ANGLE are then skipped.
set -u
folder=$1
[ ! -f "$folder/libGLESv2.so" ] && [ ! -f "$folder/missing.txt" ] || exit 0
mkdir -p "$folder" && folder=$(cd "$folder" && pwd) || exit 0
work=$folder/work

give_up() {
    echo "ANGLE is not available: $1" | tee "$folder/missing.txt"
    rm -rf "$work"
    exit 0
}

command -v apt-get >/dev/null 2>&1 && command -v dpkg-deb >/dev/null 2>&1 || give_up 'not a Debian system'
list() {
    apt-cache madison chromium-common 2>/dev/null | awk -F'|' '{ gsub(/ /, "", $2); print $2 }' | sort -uV
}
versions=$(list)
if [ -z "$versions" ] && [ "$(id -u)" = 0 ]; then
    timeout -k 5 360 apt-get -o DPkg::Lock::Timeout=300 update -qq >/dev/null 2>&1
    versions=$(list)
fi
[ -n "$versions" ] || give_up 'apt knows no chromium-common'

for version in $versions; do
    rm -rf "$work" && mkdir "$work" && cd "$work" || give_up "no $work"
    timeout -k 5 60 apt-get download -qq "chromium-common=$version" >/dev/null 2>&1 || continue
    dpkg-deb --fsys-tarfile ./*.deb | tar -xf - --wildcards './usr/lib/chromium/lib*.so*' './usr/lib/chromium/*_icd.json' || continue
    # An empty library is some kilobytes.
    [ -n "$(find usr/lib/chromium -name libGLESv2.so -size +1000k)" ] || continue
    for file in libEGL.so libvk_swiftshader.so libvulkan.so.1 vk_swiftshader_icd.json libGLESv2.so; do
        mv "usr/lib/chromium/$file" "$folder/" || give_up "chromium-common $version has no $file"
    done
    rm -rf "$work"
    echo "ANGLE from chromium-common $version"
    exit 0
done
# shellcheck disable=SC2086
give_up "chromium-common $(echo $versions | sed 's/ /, /g'): cannot be downloaded, or have no ANGLE"
