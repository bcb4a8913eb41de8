#!/bin/sh
# web_index.sh INDEX PROGRAMS NOH PACK REPORT: prints the page INDEX for PACK: with the program of the folder PROGRAMS that
# shows it (body.wasm, if the pack has no joints; face.wasm, if it has no hair either), the program's bytes, and the bytes of
# PACK that the first picture needs, by REPORT, the output of `noh pack --json`.
set -eu
program=noh
about=$("$3" info "$4" --json)
case $about in
*'"skeletons": []'*) case $about in *'"hair": null'*) program=face ;; *) program=body ;; esac ;;
esac
first=$(sed -n 's/.*"first_bytes": \([0-9]*\).*/\1/p' "$5")
[ "$first" != 0 ] || first=131072 # all of it comes before the first picture
sed "s/noh\.wasm/$program.wasm/g; s/data-program=\"0\"/data-program=\"$(($(wc -c <"$2/$program.wasm")))\"/; s/data-first=\"[0-9]*\"/data-first=\"$first\"/" "$1"
