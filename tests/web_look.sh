#!/bin/sh
# web_look.sh MODEL...: heads and bodies in noh's lights, drawn by noh, three.js and model-viewer from the same places, as
# one sheet with figures: look.png and look.txt in the build folder's look/. `make look` runs it. A model is a glTF file,
# with :full for all of it in place of its face. It fails where a picture cannot be drawn; what is beautiful, judge by eye.
#   NOH_LOOK_LIGHTS, NOH_LOOK_ANGLES (degrees), NOH_LOOK_PX   default: room studio sky, 0 40 85, 480
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
out=$build/look
: "${NOH_LOOK_LIGHTS=room studio sky}"

leave_out() {
    echo "SKIP: the sheet of looks: $1"
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
}
. tests/web/find_browser.sh
find_browser "$out" playwright-core three @google/model-viewer
folder_of() { node -p "require('path').resolve(require.resolve('$1'), '../..')"; }
for light in $NOH_LOOK_LIGHTS; do
    "$build/tests/gl/panorama" "$light" "$out" >"$out/$light.json" || exit 1
done
NOH_LOOK_LIGHTS=$NOH_LOOK_LIGHTS node tests/web/look.js "$build/noh" "$chromium" "$out" "$(folder_of three)" \
    "$(folder_of @google/model-viewer)" "$@"
