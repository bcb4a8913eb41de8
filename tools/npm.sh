#!/bin/sh
# npm.sh OUT FOLDER WASM LICENSE: OUT/noh-character-$VERSION.tgz, as `npm pack` would make it: FOLDER, the program and the
# licence, with VERSION in package.json. The same files give the same bytes.
set -eu
out=$1
name=noh-character-$VERSION
rm -rf "$out/package"
mkdir -p "$out/package"
cp "$2"/* "$3" "$4" "$out/package"
sed "s/\"version\": \"[^\"]*\"/\"version\": \"$VERSION\", \"license\": \"MIT\"/" "$2/package.json" >"$out/package/package.json"
tar -C "$out" --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=u=rw,go=r,a+X -cf - package | gzip -9n >"$out/$name.tgz.new"
mv "$out/$name.tgz.new" "$out/$name.tgz"
echo "$out/$name.tgz: $(wc -c <"$out/$name.tgz") bytes, $(ls "$out/package" | wc -l) files"
