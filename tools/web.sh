#!/bin/sh
# web.sh INPUT...: links the page's program (platform/web) with emscripten, in as much memory as the plan of its stage
# says. Called by `make web`, which sets PLAN, PACK, WIRE, ACTORS, OUT, STACK, HEAP, STATIC, FLAGS and LINK. Prints the sum,
# and what goes over the wire.
set -eu
command -v emcc >/dev/null 2>&1 || { echo 'make web needs emscripten (emcc)' >&2; exit 1; }

# node's fetch does not read files, and emscripten's older loader asks it to
fetch=
node --no-experimental-fetch -e 0 2>/dev/null && fetch=--no-experimental-fetch
# shellcheck disable=SC2086
plan=$(node $fetch "$PLAN" "$PACK" "$ACTORS" "$WIRE")
noh=$(echo "$plan" | sed -n 's/^block //p')
[ -n "$noh" ] || exit 1
pack_bytes=$(echo "$plan" | sed -n 's/^wire //p') # more than the pack has: it is unpacked behind itself
pack_bytes=$(((pack_bytes + 63) / 64 * 64))
sum=$((pack_bytes + noh + STATIC + STACK + HEAP))
memory=$(((sum + 65535) / 65536 * 65536))

# Debian's emscripten uses Debian's node modules, which another node does not look for.
export NODE_PATH="${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs"
# shellcheck disable=SC2086
emcc $FLAGS -DNOH_WEB_PACK_BYTES=$pack_bytes -DNOH_WEB_MEMORY_BYTES="$noh" -DNOH_WEB_ACTORS="$ACTORS" "$@" $LINK \
    -s TOTAL_STACK="$STACK" -s INITIAL_MEMORY=$memory -o "$OUT"

cat <<END
WebAssembly memory, which cannot grow:
  the pack, while it arrives   $pack_bytes
  its block, by the plan       $noh (the most of any path)
  static data of the program   $STATIC (at most)
  stack                        $STACK
  heap of emscripten's strings $HEAP
  sum, in pages of 64 KiB      $memory
END
wasm=${OUT%.js}.wasm
echo "$(wc -c <"$wasm") bytes of WebAssembly ($(gzip -9 -c "$wasm" | wc -c) with gzip), $(wc -c <"$OUT") of JavaScript ($(gzip -9 -c "$OUT" | wc -c))"
echo "$(wc -c <"$WIRE") bytes of the pack's wire form, $(wc -c <"$PACK") as it is"
