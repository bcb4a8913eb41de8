#!/bin/sh
# web_cc.sh OUT [FLAG...]: writes OUT, a script that compiles as emcc does with these flags: emscripten's clang, without
# what emcc does around each call, which takes longer than most files; and by ccache, where that is. emcc itself links.
set -eu
case ${1:-} in '' | -*) echo 'usage: web_cc.sh OUT [FLAG...]' >&2; exit 2 ;; esac
out=$1
shift
command -v emcc >/dev/null 2>&1 || { echo 'make web needs emscripten (emcc)' >&2; exit 1; }
export NODE_PATH="${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs"
flags=$(emcc "$@" --cflags | tail -n 1 | sed 's/-fwasm-exceptions//')
{
    echo '#!/bin/sh'
    echo 'case " $* " in *" -c "* | *" -dumpmachine "*) ;; *) exec emcc "$@" ;; esac'
    echo "exec $(command -v ccache || true) $(em-config LLVM_ROOT)/clang $flags \"\$@\""
} >"$out.new"
chmod +x "$out.new"
mv "$out.new" "$out"
