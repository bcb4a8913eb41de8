#!/bin/sh
# noh mask: a clean and a damaged region mask, the repair, the picture, --json, refused input, outputs that cannot be
# written.
. "$(dirname "$0")/lib.sh"

if ! command -v python3 >/dev/null; then
    skip 'masks' 'python3, which makes them, is not here'
    finish
    exit
fi

# An RGBA picture of 32 x 32 out of a formula of x and y for each channel, by python's zlib.
picture() { # OUT RED GREEN BLUE ALPHA
    python3 - "$@" <<'EOF'
import struct, sys, zlib
out, formulas = sys.argv[1], sys.argv[2:]
rows = b''
for y in range(32):
    rows += b'\0' + bytes(eval(f, {'x': x, 'y': y}) for x in range(32) for f in formulas)
def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
colour = {4: 6, 3: 2, 1: 0}[len(formulas)]
open(out, 'wb').write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 32, 32, 8, colour, 0, 0, 0)) +
                      chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))
EOF
}

picture "$work/clean.png" '75*(x<16)' '165*(y<8)' '255*(y>20)' 0
noh mask "$work/clean.png"
expect 0 'a clean mask'
check 'says so' grep -q '^no damage' "$work/out"
check 'has a row for each region' sh -c 'test "$(grep -cE "^[0-9]+ +(red|green|blue|alpha)" "$1")" = 12' - "$work/out"
check 'counts texels and their box' grep -qE '^4 +green +90-165 +256 +256 +1.000 +0, 0 to 31, 7$' "$work/out"
noh mask "$work/clean.png" -o "$work/same.png"
expect 0 'repair a clean mask'
check 'changes nothing' grep -q ': 0 texels changed' "$work/out"

picture "$work/no_alpha.png" '75*(x<16)' '0' '0'
noh mask "$work/no_alpha.png"
expect 0 'a mask without alpha'
check 'has no regions there' sh -c 'test "$(grep -cE "^[0-9]+ +alpha .*empty" "$1")" = 3' - "$work/out"

picture "$work/green.png" '0' '77*(y<8)+166*(y>16)' '0' '0'
noh mask "$work/green.png" --show "$work/damage.png" -o "$work/repaired.png"
expect 0 'a damaged mask'
check 'counts illegal codes' grep -q ', 736 illegal codes,' "$work/out"
check 'names the cause' grep -q '^damage: block-compression' "$work/out"
check 'shows it' test -s "$work/damage.png"
noh mask "$work/repaired.png" --json
expect 0 'the repair'
cp "$work/out" "$work/mask.json"
if [ -n "$json" ]; then
    for holds in 'j.illegal === 0 && j.damage.length === 0 && j.gamma === null' \
        'j.width === 32 && j.height === 32 && j.channels.length === 4 && j.regions.length === 12' \
        'j.channels[1].histogram[75] === 256 && j.channels[1].histogram[165] === 480' \
        'j.regions[3].texels === 256 && j.regions[3].full === 256 && j.regions[4].top === 17'; do
        check "JSON: $holds" $json "$holds" <"$work/mask.json"
    done
fi

noh mask "$work/none.png"
expect 1 'a file that is not there'
printf 'P6 1 1 255 abc' >"$work/other.png"
noh mask "$work/other.png"
expect 1 'a file that is no picture'
says 'not a PNG, JPEG, WebP, TGA, BMP or Photoshop picture'
head -c 60 "$work/clean.png" >"$work/cut.png"
noh mask "$work/cut.png"
expect 1 'a file that is cut'
noh mask "$work/clean.png" -o "$work/none/out.png"
expect 1 'an output that cannot be written'
noh mask
expect 2 'no file'
noh mask "$work/clean.png" --json -o /dev/stdout
expect 2 'two outputs to stdout'
finish
