#!/bin/sh
# web_sizes.sh FOLDER: the bytes that each part of a page takes over the wire.
set -eu
cd "$1"
zipped() { gzip -9 -c "$@" | wc -c; }
brotli() { node -e 'console.log(require("zlib").brotliCompressSync(require("fs").readFileSync(process.argv[1])).length)' "$1"; }
for program in noh body face; do echo "$(wc -c <package/$program.wasm) bytes of $program.wasm ($(zipped package/$program.wasm) with gzip, $(brotli package/$program.wasm) with brotli)"; done
echo "$(cat package/*.js | wc -c) of the package's JavaScript ($(cat package/*.js | gzip -9 | wc -c))"
echo "$(wc -c <page.nohz) bytes of the pack's wire form, $(wc -c <page.noh) as it is"
