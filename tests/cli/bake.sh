#!/bin/sh
# noh bake: a normal map from heights, and from a model onto itself; --json; refused input.
. "$(dirname "$0")/lib.sh"
mask=$build/mask.glb

if command -v python3 >/dev/null; then
    # a ramp that rises by one level of grey a texel to the right: 32 x 8, grey
    python3 - "$work/ramp.png" <<'END'
import struct, sys, zlib
rows = b''.join(b'\0' + bytes(range(32)) for y in range(8))
def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
open(sys.argv[1], 'wb').write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 32, 8, 8, 0, 0, 0, 0)) +
                              chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))
END
    noh bake "$work/ramp.png" -o "$work/normal.png" --depth 255
    expect 0 'a map out of heights'
    check 'names the file and its size' grep -q 'normal.png: 32 x 8 texels$' "$work/out"
    noh bake "$work/ramp.png" -o "$work/again.png" --depth 255 --json
    expect 0 'the same with --json'
    check 'is JSON' python3 -c 'import json, sys; assert json.load(open(sys.argv[1]))["width"] == 32' "$work/out"
    check 'and the same map' cmp -s "$work/normal.png" "$work/again.png"
    noh bake "$work/ramp.png" -o "$work/no.png" --depth 0
    expect 2 'heights without depth'
    says '--depth'
    noh bake "$work/ramp.png" -o "$work/no.png" --from "$mask"
    expect 2 'heights and a fine model'
    says 'a height map (.png), or a model with --from'
else
    skip 'heights' 'python3, which makes them, is not here'
fi

noh bake "$mask" -o "$work/self.png" --from "$mask" --size 128
expect 0 'a model on itself'
check 'leans nowhere' grep -q 'mean tilt of normals 0.0[0-2] degrees' "$work/out"
noh bake "$mask" -o "$work/no.png"
expect 2 'a model alone'
says 'a model with --from'
noh bake "$mask" -o "$work/no.png" --from "$mask" --size 100.5
expect 2 'half a texel'
says '--size'
noh bake "$mask" -o "$work/no.png" --from "$mask" --material nothing
expect 1 'a material that is not there'
says 'no triangle of that material has texture coordinates'
noh bake "$work/missing.png" -o "$work/no.png"
expect 1 'a file that is not there'
check 'none of these wrote anything' test ! -e "$work/no.png"
finish
