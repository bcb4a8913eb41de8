#!/bin/sh
# npm.sh OUT FOLDER PROGRAMS LICENSE CONVERTER WORKER...: OUT/noh-character-$VERSION.tgz, as `npm pack` would make it: FOLDER,
# the programs of the folder PROGRAMS, their sentences, the tables of the ear and the licence, with VERSION in package.json, and in convert/ the worker's scripts and what the folder
# CONVERTER has of the converter, if it was built. The same files give the same bytes.
set -eu
out=$1
name=noh-character-$VERSION
rm -rf "$out/package"
mkdir -p "$out/package"
cp "$2"/* "$3/noh.wasm" "$3/body.wasm" "$3/face.wasm" "$3/noh.txt" "$3/body.txt" "$3/face.txt" "$3/ear.bin" "$4" "$out/package"
sed "s/\"version\": \"[^\"]*\"/\"version\": \"$VERSION\", \"license\": \"MIT\"/" "$2/package.json" >"$out/package/package.json"
if [ -f "$5/convert.wasm" ]; then
    mkdir "$out/package/convert"
    cp "$5/convert.js" "$5/convert.wasm" "$out/package/convert"
    shift 5
    cp "$@" "$out/package/convert"
fi
tar -C "$out" --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=u=rw,go=r,a+X -cf - package | gzip -9n >"$out/$name.tgz.new"
mv "$out/$name.tgz.new" "$out/$name.tgz"
echo "$out/$name.tgz: $(wc -c <"$out/$name.tgz") bytes, $(find "$out/package" -type f | wc -l) files"
