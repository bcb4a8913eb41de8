#!/bin/sh
# web_cc.sh OUT: writes OUT, a script that compiles as emcc does: emscripten's clang with its flags, without what emcc does
# around each call, which takes longer than most files; and by ccache, where that is. It links nothing.
set -eu
case ${1:-} in '' | -*) echo 'usage: web_cc.sh OUT' >&2; exit 2 ;; esac
command -v emcc >/dev/null 2>&1 || { echo 'make web needs emscripten (emcc)' >&2; exit 1; }
export NODE_PATH="${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs"
flags=$(emcc -fwasm-exceptions -msimd128 -msse2 --cflags | tail -n 1 | sed 's/-fwasm-exceptions//')
{
    echo '#!/bin/sh'
    echo "exec $(command -v ccache || true) $(em-config LLVM_ROOT)/clang $flags \"\$@\""
} >"$1.new"
chmod +x "$1.new"
mv "$1.new" "$1"
