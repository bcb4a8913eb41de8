#!/bin/sh
# web.sh SOURCE...: the page's program (platform/web) with emscripten, in as much memory as the
# pack's budget says. Called by `make web`, which sets NOH_BUILD, PACK, OUT, STACK, HEAP, STATIC,
# FLAGS and LINK. Prints the sum, and what goes over the wire.
set -eu
command -v emcc >/dev/null 2>&1 || { echo 'make web needs emscripten (emcc)' >&2; exit 1; }

# The most that any path takes: which one it will be is found in the browser.
noh=0
for path in cpu gather mrt per-layer layered; do
    bytes=$("$NOH_BUILD/noh" budget "$PACK" --nominal --path $path --json | sed -n 's/^  "cpu_bytes": \([0-9]*\).*/\1/p')
    [ "$bytes" -le $noh ] || noh=$bytes
done
pack=$(wc -c <"$PACK")
pack=$(((pack + 63) / 64 * 64))
noh=$(((noh + 63) / 64 * 64))
align=1024 # what lies between at most 64 objects that begin at multiples of 16
sum=$((pack + noh + align + STATIC + STACK + HEAP))
memory=$(((sum + 65535) / 65536 * 65536))

# Debian's emscripten uses Debian's node modules, which another node does not look for.
export NODE_PATH="${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs"
# shellcheck disable=SC2086
emcc $FLAGS -DNOH_WEB_PACK_BYTES=$pack -DNOH_WEB_MEMORY_BYTES=$((noh + align)) "$@" $LINK \
    -s TOTAL_STACK="$STACK" -s INITIAL_MEMORY=$memory -o "$OUT"

cat <<END
WebAssembly memory, which cannot grow:
  the pack                     $pack
  what noh budget says         $noh
  alignment of its parts       $align (at most)
  static data of the program   $STATIC (at most)
  stack                        $STACK
  heap of emscripten's strings $HEAP
  sum, in pages of 64 KiB      $memory
END
wasm=${OUT%.js}.wasm
echo "$(wc -c <"$wasm") bytes of WebAssembly ($(gzip -9 -c "$wasm" | wc -c) with gzip), $(wc -c <"$OUT") of JavaScript ($(gzip -9 -c "$OUT" | wc -c))"
