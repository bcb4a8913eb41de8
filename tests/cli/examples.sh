#!/bin/sh
# The examples run, and their pictures are right. Pictures are .ppm files of known size: a lit figure in front of a
# plain background, which differs for another face or time.
. tests/cli/lib.sh
examples=$build/examples

run() { # PROGRAM ARGUMENTS, in the work folder
    program=$1
    shift
    (cd "$work" && "$examples/$program" "$@") >"$work/out" 2>"$work/err"
    code=$?
}
# Share of the pixels that are not background, percent, and how many different bytes there are.
look() { # FILE WIDTH HEIGHT
    tail -c $(($2 * $3 * 3)) "$1" | od -An -v -tu1 -w3 |
        awk '{ n++; if ($1 > 60 || $2 > 60 || $3 > 60) drawn++; tone[$2] = 1 } END { for (t in tone) tones++; print int(100 * drawn / n), tones + 0, n }'
}
shows() { # NAME FILE WIDTH HEIGHT LEAST MOST: a figure of LEAST to MOST percent of the picture, in at least 100 tones
    look "$2" "$3" "$4" >"$work/figures" 2>/dev/null
    read -r percent tones pixels <"$work/figures"
    check "$1 ($percent % of the pixels, $tones tones)" test "$pixels" = $(($3 * $4)) -a "$percent" -ge "$5" -a "$percent" -le "$6" -a "$tones" -ge 100
}
differ() { ! cmp -s "$1" "$2"; }

run face_cpu "$build/mask.noh" -o smile.ppm
expect 0 'face_cpu draws a smile'
shows 'and it shows a face' "$work/smile.ppm" 480 540 25 70
run face_cpu "$build/mask.noh" smile=0 -o rest.ppm
expect 0 'a face at rest'
check 'is another picture' differ "$work/smile.ppm" "$work/rest.ppm"
run face_cpu "$build/mask.noh" nobody=1
expect 1 'a target that is missing is refused'
check 'by name' grep -q nobody "$work/err"
run face_cpu README.md
expect 1 'a file that is no pack is refused'
run face_cpu
expect 2 'no file is a mistake of usage'

noh build "$build/demo/puppet.glb" -o "$work/puppet.noh" --plain --wrinkles face --effort 1 --quiet
run walker_cpu puppet.noh
expect 0 'walker_cpu walks'
check 'its feet come down in turn' sh -c 'test "$(sed -n "s/.* s  //p" "$1" | tr "\n" " ")" = "foot_left foot_right foot_left "' - "$work/out"
check 'and carry it a metre' grep -q '^1\.00 m' "$work/out"
shows 'and it shows a figure' "$work/walker_cpu.ppm" 480 540 15 60
run walker_cpu puppet.noh 1.3 -o later.ppm
expect 0 'for a shorter time'
check 'it is in another pose' differ "$work/walker_cpu.ppm" "$work/later.ppm"
run walker_cpu "$build/mask.noh"
expect 0 'of a pack without a skeleton it draws nothing'

if [ -n "${NOH_SAN:-}" ]; then
    skip 'face_gl, walker, states, cast' 'the driver leaks under the sanitizer'
else
    run face_gl "$build/mask.noh"
    expect 0 'face_gl draws a smile'
    check 'and says what drew it' grep -q 'bytes on the GPU' "$work/out"
    shows 'and it shows a face' "$work/face_gl.ppm" 512 512 25 70
    run face_gl "$build/mask.noh" eyeBlinkLeft -o wink.ppm
    expect 0 'a wink'
    check 'is another picture' differ "$work/face_gl.ppm" "$work/wink.ppm"
    run face_gl "$build/mask.noh" nobody
    expect 1 'a target that is missing is refused'

    run walker puppet.noh -o walker.png
    expect 0 'walker walks on the GPU'
    check 'its feet come down in turn' sh -c 'test "$(sed -n "s/.* s  //p" "$1" | tr "\n" " ")" = "foot_left foot_right foot_left "' - "$work/out"
    check 'and carry it a metre' grep -q '^1\.00 m' "$work/out"
    check 'and it saves a picture' sh -c 'test "$(wc -c <"$1")" -gt 20000' - "$work/walker.png"
    run walker "$build/mask.noh"
    expect 1 'a pack without the clip is refused'
    check 'by name' grep -q actor "$work/err"

    run states "$build/demo/puppet_levels.noh" -o states.png
    expect 0 'states plays the graph of the pack'
    check 'it stands, walks, hurries, bows' sh -c 'test "$(sed -n "s/.* s  //p" "$1" | tr "\n" " ")" = "acts foot_right foot_left foot_right foot_left foot_right foot_left bowing bow "' - "$work/out"
    check 'and comes two metres far' grep -q '^2\.1. m' "$work/out"
    check 'and it saves a picture' sh -c 'test "$(wc -c <"$1")" -gt 20000' - "$work/states.png"
    run states "$build/mask.noh"
    expect 1 'a pack without a graph is refused'
    check 'by name' grep -q 'graphs of a kind' "$work/err"

    run stick "$build/demo/puppet_levels.noh" "$build/demo/roam.noh" -o stick
    expect 0 'stick goes where the stick points'
    check 'as fast as it is pushed' sh -c 'test "$(sed -n "s/.*goes //p" "$1" | tr "\n" ";")" = "0.9;0.9;0.9;0.0;"' - "$work/out"
    check 'and its pictures show it' differ "$work/stick0.png" "$work/stick1.png"
    run stick "$build/demo/puppet_levels.noh" "$build/demo/puppet_levels.noh"
    expect 1 'clips without a table are refused'
    check 'and it says what to do' grep -q 'noh build --match' "$work/err"

    run own_renderer "$build/demo/puppet_levels.noh" -o own.png
    expect 0 'own_renderer draws a stage without a GPU from its list'
    check 'six figures of some parts each' sh -c 'test "$(sed -n "s/ draws.*//p" "$1")" -ge 24' - "$work/out"
    check 'and it saves a picture' sh -c 'test "$(wc -c <"$1")" -gt 30000' - "$work/own.png"
    run own_renderer "$build/mask.noh"
    expect 0 'of a rigid head, too'

    run dressing "$build/demo/puppet_levels.noh" "$build/demo/coat.noh" mask -o room
    expect 0 'dressing puts a coat on and off and goes out, in the bytes that were planned'
    check 'and the street finds most of them on the GPU' awk '/^the street/ { found = $9; more = $3 } END { exit !(found > more) }' "$work/out"
    for i in 0 1 2 3; do
        check "and its picture $i shows it" differ "$work/room$i.png" "$work/room$((i + 1)).png"
    done
    run dressing "$build/demo/puppet_levels.noh" "$build/demo/coat.noh" nothing
    expect 1 'a mesh that is missing is refused'
    run dressing "$build/demo/puppet_levels.noh" "$build/mask.noh"
    expect 1 'what has no joint of the body is no garment'
    check 'and says so' grep -q 'no joint of the garment has the name' "$work/err"

    run conversation "$build/demo/nell.noh" -o talk
    expect 0 'conversation lets two heads talk in turns'
    check 'who speaks opens the mouth, who listens does not' awk '
        { said = $5 > 0.5; heard = $7 > 0.5; if (said == heard || said != (NR % 2)) wrong++ } END { exit wrong || NR != 3 }' "$work/out"
    check 'and its pictures show it' differ "$work/talk0.png" "$work/talk1.png"
    check 'a smile, too' differ "$work/talk0.png" "$work/talk2.png"
    run conversation "$build/demo/coat.noh"
    expect 2 'what has no eyes is refused'
    check 'and says so' grep -q '^eyes: ' "$work/err"

    run crowd "$build/demo/puppet_falls.noh" -o square
    expect 0 'crowd lets people react'
    check 'some fall, some hurry away, some turn' awk 'NR == 1 { ok = $1 > 2 && $3 > 2 && $6 > 2 && $1 + $3 + $6 == 24 } END { exit !ok }' "$work/out"
    check 'and all are up again' grep -qx '0 are down' "$work/out"
    check 'and its pictures show it' differ "$work/square0.png" "$work/square1.png"
    run crowd "$build/mask.noh"
    expect 2 'a pack without the clips is refused'

    field() { sed -n "s/.*\"$1\": \([0-9]*\).*/\1/p" "$work/out"; }
    run cast "$build/demo/puppet_levels.noh" --json --seconds 1 -o cast.png
    expect 0 'cast plays for a second'
    check 'it takes on the GPU what was predicted' test "$(field gpu_bytes)" = "$(field gpu_predicted)"
    check 'both together within 2 MiB' test $(($(field gpu_bytes) + $(field cpu_bytes))) -le 2097152
    check 'nothing is allocated once there is a stage' test "$(field allocations)" = 0
    check 'no error of GL' test "$(field gl_errors)" = 0
    check 'twenty actors put their feet down' test "$(field keys)" -ge 20
    check 'and it saves a picture' sh -c 'test "$(wc -c <"$1")" -gt 50000' - "$work/cast.png"
    run cast "$build/demo/puppet_levels.noh" --bytes 1000
    expect 1 'a bound that nothing keeps is refused'
fi
awk '/^```C$/ { inside = 1; next } /^```$/ { inside = 0 } inside' README.md >"$work/quoted"
check 'the README quotes walker_cpu.c' sh -c 'test -s "$1" && ! grep -vxF -f tools/examples/walker_cpu.c "$1"' - "$work/quoted"
for example in tools/examples/*.c; do
    name=$(basename "$example" .c)
    case $name in walker) most=60 ;; states) most=100 ;; cast) most=200 ;; *) most=150 ;; esac
    check "$name has less than $most lines" test "$(wc -l <"$example")" -lt $most
done
finish
