#!/bin/sh
# noh verify of a skinned mesh that is small and far from the origin, like eyes: its bound follows from the distance,
# not from its own box. Messages of failures; a driver that draws nothing is refused.
. "$(dirname "$0")/lib.sh"

# 32-bit floats as octal escapes for printf, from decimal numbers, one a line.
floats() {
    awk '
        function bytes(bits,    i, out) {
            for (i = 0; i < 4; i++) { out = out sprintf("\\%03o", bits % 256); bits = int(bits / 256) }
            return out
        }
        function float(x,    sign, e, m) {
            if (x == 0) return bytes(0)
            sign = x < 0 ? 2147483648 : 0
            if (x < 0) x = -x
            for (e = 127; x >= 2; e++) x /= 2
            for (; x < 1; e--) x *= 2
            m = int((x - 1) * 8388608 + 0.5)
            return bytes(sign + e * 8388608 + m)
        }
        { printf "%s", float($1 + 0) }'
}

# A ball of radius 32.5 mm round (0.03, Y, 0.08) on two joints, the head and the eye: rows of 17 by 9 vertices.
ball() { # Y OUT.gltf
    awk -v y="$1" 'BEGIN {
        for (i = 0; i < 9; i++) for (k = 0; k < 17; k++) {
            a = 3.14159265 * i / 8; b = 6.2831853 * k / 16
            n[0] = sin(a) * cos(b); n[1] = cos(a); n[2] = sin(a) * sin(b)
            print 0.03 + 0.0325 * n[0]; print y + 0.0325 * n[1]; print 0.08 + 0.0325 * n[2]
        } }' | floats >"$work/positions"
    awk 'BEGIN { for (i = 0; i < 153; i++) { w = i % 5 / 4; print w; print 1 - w; print 0; print 0 } }' | floats >"$work/weights"
    awk 'BEGIN { for (i = 0; i < 153; i++) printf "\\000\\001\\000\\000" }' >"$work/joints"
    awk -v y="$1" 'BEGIN { for (j = 0; j < 2; j++) for (i = 0; i < 16; i++)
        print i % 5 == 0 ? 1 : i == 13 ? -(j ? y : y - 0.03) : j && i == 12 ? -0.03 : j && i == 14 ? -0.08 : 0 }' | floats >"$work/inverse"
    awk 'BEGIN { for (i = 0; i < 8; i++) for (k = 0; k < 16; k++) {
        a = 17 * i + k; s[0] = a; s[1] = a + 1; s[2] = a + 17; s[3] = a + 1; s[4] = a + 18; s[5] = a + 17
        for (t = 0; t < 6; t++) printf "\\%03o\\000", s[t] } }' >"$work/indices"
    for part in positions weights joints inverse indices; do
        # shellcheck disable=SC2059
        printf "$(cat "$work/$part")"
    done >"$work/ball.bin"
    low=$(awk -v y="$1" 'BEGIN { printf "%.4f", y - 0.0325 }') high=$(awk -v y="$1" 'BEGIN { printf "%.4f", y + 0.0325 }')
    cat >"$2" <<EOF
{ "asset": { "version": "2.0" },
  "buffers": [{ "uri": "ball.bin", "byteLength": $(wc -c <"$work/ball.bin") }],
  "bufferViews": [{ "buffer": 0, "byteOffset": 0, "byteLength": 1836 }, { "buffer": 0, "byteOffset": 1836, "byteLength": 2448 },
                  { "buffer": 0, "byteOffset": 4284, "byteLength": 612 }, { "buffer": 0, "byteOffset": 4896, "byteLength": 128 },
                  { "buffer": 0, "byteOffset": 5024, "byteLength": 1536 }],
  "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 153, "type": "VEC3", "min": [-0.0025, $low, 0.0475], "max": [0.0625, $high, 0.1125] },
                { "bufferView": 1, "componentType": 5126, "count": 153, "type": "VEC4" },
                { "bufferView": 2, "componentType": 5121, "count": 153, "type": "VEC4" },
                { "bufferView": 3, "componentType": 5126, "count": 2, "type": "MAT4" },
                { "bufferView": 4, "componentType": 5123, "count": 768, "type": "SCALAR" }],
  "meshes": [{ "name": "eye", "primitives": [{ "attributes": { "POSITION": 0, "WEIGHTS_0": 1, "JOINTS_0": 2 }, "indices": 4 }] }],
  "skins": [{ "joints": [1, 2], "inverseBindMatrices": 3 }],
  "nodes": [{ "name": "eye_mesh", "mesh": 0, "skin": 0 },
            { "name": "head", "translation": [0, $(awk -v y="$1" 'BEGIN { print y - 0.03 }'), 0], "children": [2] },
            { "name": "eye_joint", "translation": [0.03, 0.03, 0.08] }],
  "scenes": [{ "nodes": [0, 1] }], "scene": 0 }
EOF
}

for height in 0 1.63 40; do
    ball $height "$work/ball.gltf"
    noh build "$work/ball.gltf" -o "$work/ball.noh" --quiet
    expect 0 "a small ball $height m above the origin"
    noh verify "$work/ball.noh"
    if [ $code != 0 ] && grep -q 'no GL context' "$work/err"; then
        skip 'verify' 'no GL context here'
        finish
    fi
    expect 0 'is verified'
    grep '^skin/' "$work/out" | sed 's/^/# /'
    check 'within a bound of at most 2e-6 of its distance' awk -v h=$height '
        /^skin\// { n++; if ($6 > 2.1 * (h + 0.12) || $5 > $6) bad++ } END { exit !(n == 2 && !bad) }' "$work/out"
done

# ---- a driver that draws nothing ----

# Budgets need only its limits; a picture or a comparison would be a false result.
for path in '' "$build/mask.noh"; do
    pack=${path:-$work/ball.noh}
    noh verify "$pack" --driver null
    expect 1 'verify with the null driver'
    says "this driver's pictures cannot be read back"
    check 'and prints no result' test ! -s "$work/out"
done
noh render "$build/mask.noh" -o "$work/null.png" --driver null
expect 1 'render with the null driver'
check 'and writes no picture' test ! -e "$work/null.png"
noh bench "$build/mask.noh" --driver null --quick --only morph
expect 1 'bench with the null driver'
noh verify "$build/mask.noh" --driver null --json
expect 1 'verify --json with the null driver'
check 'gives the error as JSON' grep -q '"subject": "null"' "$work/out"
noh budget "$build/mask.noh" --driver null
expect 0 'budget with the null driver'

# ---- a failure ----

# A thousandth of the bound is less than a float can hold at this distance.
noh verify "$work/ball.noh" --bound-scale 0.001
expect 1 'a bound that is too tight fails'
check 'FAILED names the row, the value and the bound' grep -Eq '^FAILED: skin/(block|tex) f32: position error, um: [0-9.e+-]+, bound [0-9.e+-]+$' "$work/out"
noh verify "$work/ball.noh" --bound-scale 0.001 --json
expect 1 'with --json likewise'
if [ -n "$json" ]; then
    check 'failures names them' $json 'j.ok === false && j.failures[0].what === "position error, um" && j.failures[0].value !== 0 && j.failures[0].bound !== 0' <"$work/out"
else
    check 'failures names them' grep -q '"what": "position error, um"' "$work/out"
fi

# Bounds of half floats are useful: they hold, and are at most three times the real error.
noh verify "$build/mask.noh"
expect 0 'the mask'
check 'half floats are within their bounds, which are tight' \
    awk '$2 == "f16" && $5 ~ /^[0-9.]+$/ { rows++; if (!($5 > 0 && $5 <= $6 && $6 <= 3 * $5)) bad = 1 } END { exit !(rows >= 3 && !bad) }' "$work/out"
noh info "$build/mask.noh" --json
check 'weights of 0 to 1 are off by less than weights of -2 to 2' \
    awk '/"f16_bound_0_to_1_um"/ { gsub(/[^0-9.]/, "", $2); one = $2 } /"f16_bound_um"/ { gsub(/[^0-9.]/, "", $2); two = $2 } END { exit !(one > 0 && 2 * one <= two) }' "$work/out"
finish
