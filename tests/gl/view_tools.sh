#!/bin/sh
# The artist's tools of `noh view`, by scripted input: opening while playing, undo, copy and paste, presets, overlays,
# two figures side by side, films, background conversion, a file that changes on disk; and the figure stays in the
# picture.
. tests/cli/lib.sh
. tests/support/view.sh
case $build in /*) ;; *) build=$PWD/$build ;; esac
mask=$build/mask.noh puppet=$build/demo/puppet_levels.noh
start_display

# ---- undo, the clipboard, presets ----

hand 'undo, redo, copy, paste, presets' "$mask" --play off --presets own.presets <<'HAND'
expect "step 0 of 1"
drag smile 1
drag jawOpen 0.5
expect "held smile 1"
expect "held jawOpen 0."
expect "step 2 of 3"
save set.png
key ctrl+z
expect-not "held jawOpen"
expect "held smile 1"
key ctrl+z
expect-not held
key ctrl+z
expect-not held
key ctrl+y
key ctrl+shift+z
expect "held jawOpen 0."
save redone.png
key ctrl+c
expect-not message
click "let go"
expect-not held
key ctrl+c
expect "message no slider was moved"
key ctrl+v
expect "held smile 1"
expect "held jawOpen 0."
expect-not message
save pasted.png
click preset
type grin
key enter
expect "preset grin, own"
click "let go"
click joy
expect "held "
expect-not "held jawOpen"
save joy.png
click grin
expect "held jawOpen 0."
save grin.png
key ctrl+z
expect-not "held jawOpen"
HAND
check 'what is undone and done again is as it was' same set.png redone.png
check 'what is pasted is what was copied' same set.png pasted.png
check 'a preset of the recipes is another face' differ set.png joy.png
check "one's own is what was kept" same set.png grin.png
check 'and is text' grep -q '^smile = 1$' "$work/own.presets"
hand 'a preset is there the next time' "$mask" --play off --presets own.presets <<'HAND'
expect "preset grin, own"
click grin
expect "held smile 1"
click grin/x
expect-not "preset grin"
HAND
check 'and can be taken away' sh -c '! grep -q grin "$1"' - "$work/own.presets"
printf '[half\nsmile = 1\n' >"$work/own.presets"
hand 'a broken file of presets' "$mask" --play off --presets own.presets <<'HAND'
expect "message line 1: 'half' is neither"
HAND
rm "$work/own.presets" && mkfifo "$work/own.presets"
hand 'a pipe instead of a file of presets' "$mask" --play off --presets own.presets <<'HAND'
expect "message cannot be read: not a regular file"
HAND
(cd "$work" && timeout 60 "$build/noh" view "$mask" --script own.presets) >"$work/out" 2>"$work/err"
code=$?
expect 1 'a pipe instead of a script'
says 'not a regular file'
rm "$work/own.presets" && printf 'frames 1\n\0' >"$work/own.presets"
(cd "$work" && timeout 60 "$build/noh" view "$mask" --script own.presets) >"$work/out" 2>"$work/err"
code=$?
expect 1 'zero bytes in a script'
says 'is not a text: it contains zero bytes'
rm "$work/own.presets"

# ---- over the mesh ----

hand 'wires, normals, bones, skin' "$puppet" --play off <<'HAND'
save rest.png
key w
expect "over surface, wireframe"
save wires.png
key w
key n
save normals.png
key n
click bones
save bones.png
key F10
frames 3
save lost.png
click bones
click surface
click surface/joints
expect "over joints"
save joints.png
click surface
click surface/weights
expect "over weights of "
click "of joint"
click "of joint/hips"
expect "over weights of hips"
save hips.png
key ctrl+z
key ctrl+z
key ctrl+z
expect "over surface"
save undone.png
click surface
click surface/normal
frames 1
save normal.png
HAND
draw wires_render.png rest.png "$puppet" --light studio --debug wireframe
check 'wires equal noh render --debug wireframe' same wires.png wires_render.png
draw bones_render.png rest.png "$puppet" --light studio --debug bones
check 'bones equal --debug bones' same bones.png bones_render.png
check 'also after a lost context' same bones.png lost.png
draw joints_render.png rest.png "$puppet" --debug joints
check 'joints equal --debug joints' same joints.png joints_render.png
draw hips_render.png rest.png "$puppet" --debug weights --joint hips
check 'weights equal --debug weights' same hips.png hips_render.png
draw normal_render.png rest.png "$puppet" --debug normal
check 'a view of the shaders equals --debug normal' same normal.png normal_render.png
check 'normals are drawn over it' differ rest.png normals.png
check 'all of it is undone' same rest.png undone.png

# ---- side by side ----

hand 'two paths, two levels' "$puppet" --clip walk <<'HAND'
click Compare
click "side by side"
click "side by side/another path"
click "with path"
click "with path/gather"
frames 3
state
click "side by side"
click "side by side/another level"
frames 1
expect "compared with another level"
state
key F10
frames 3
expect "compared with another level"
click "side by side"
click "side by side/off"
expect-not compared
HAND
differing() { sed -n "s/^compared with another $1: \([0-9]*\) pixels differ.*/\1/p" "$work/out" | head -n 1; }
check 'two paths draw the same, but for roundings' test "$(differing path)" -lt 100
check 'two levels do not' test "$(differing level)" -gt 200

# ---- films ----

hand 'numbered pictures of a clip' "$puppet" --play off <<'HAND'
click walk/play
click Film
drag film/rate 0
click film/.png
click film/save
until "film noh.png: frame 3 of 7" 20
window filming.png
frames 5
expect-not "film noh"
HAND
check 'are there, one for each fifth of a second' sh -c 'test -f "$1/noh_0006.png" && ! test -f "$1/noh_0007.png"' - "$work"
check 'of the size of the picture' test "$(png_size noh_0003.png)" = 160x384
check 'and move' differ noh_0000.png noh_0003.png
rm -f "$work"/noh_*.png
hand 'a film that is stopped' "$mask" --play off <<'HAND'
click Film
click film/of
click "film/of/one turn"
click film/.png
click film/save
expect "frame"
click film/stop
expect-not "film noh"
HAND
check 'leaves nothing' sh -c '! ls "$1"/noh_*.png 2>/dev/null' - "$work"
noh view "$puppet" --clip walk --frames 5 --size 700x400 --film "$work/walk.png"
expect 0 'frames as a film, without a hand'
check 'every second one' sh -c 'test -f "$1/walk_0002.png" && ! test -f "$1/walk_0003.png"' - "$work"
noh view "$puppet" --clip walk --frames 1 --size 700x400 --film "$work/walk.avi"
expect 1 'a film of an unknown kind'
says 'must end in .gif, .mp4, .webm or .apng'
(PATH=/nowhere && export PATH && "$build/noh" view "$puppet" --frames 3 --size 700x400 --film "$work/walk.gif") >"$work/out" 2>"$work/err"
code=$?
expect 1 'a GIF without ffmpeg'
says 'ffmpeg, which is not installed'
check 'leaves no file' test ! -e "$work/walk.gif"
if command -v ffmpeg >/dev/null 2>&1; then
    noh view "$puppet" --clip walk --frames 5 --size 700x400 --film "$work/walk.gif"
    expect 0 'a GIF by ffmpeg'
    check 'is one' sh -c 'head -c 6 "$1" | grep -q GIF89a' - "$work/walk.gif"
else
    skip 'a GIF by ffmpeg' 'ffmpeg is not installed'
fi

# ---- conversion, a file that changes, leaving ----

cp "$build/demo/arm.glb" "$work/arm.glb"
cp "$mask" "$work/changes.noh"
cp "$build/mask.glb" "$work/slow.glb" # with levels that takes seconds
hand 'a model is converted in the background' "$work/changes.noh" --play off --lod 4 <<HAND
drag smile 1
save before.png
drop arm.glb
expect "converting arm.glb"
frames 1
expect "state of $work/changes.noh"
loaded
expect "state of arm.glb"
save arm.png
drop hand.txt
expect "message "
expect "state of arm.glb"
drop slow.glb
expect "converting slow.glb"
frames 2
window converting.png
click cancel
expect-not converting
drop changes.noh
frames 1
expect-not held
save again.png
HAND
check 'and shown' differ before.png arm.png
printf 'this is no glTF' >"$work/broken.glb"
hand 'a model that cannot be converted' "$mask" --play off <<'HAND'
drop broken.glb
until "message " 600
expect-not converting
expect "mask.noh"
HAND
noh view "$work/broken.glb" --frames 1 --size 700x400
expect 1 'nor opened'
says 'broken.glb: '
noh view "$work/arm.glb" --lod 3 --frames 2 --size 700x400 --screenshot "$work/opened.png"
expect 0 'a model is converted with levels when it is opened'

# The script ends only after the file has changed: a reload keeps the settings.
cp "$mask" "$work/changes.noh"
(
    tries=0
    while [ ! -f "$work/ready.png" ] && [ $tries -lt 3000 ]; do sleep 0.1; tries=$((tries + 1)); done
    cp "$build/mask_levels.noh" "$work/new.noh" && mv "$work/new.noh" "$work/changes.noh"
) &
changer=$!
hand 'a file that changes on disk' changes.noh --play off <<'HAND'
drag smile 1
click speak/play
key space
expect-not "level 1"
save ready.png
until "reloads 1" 3000
expect "held smile 1"
expect "face speak"
key l
expect "level 1"
HAND
wait $changer

hand 'Esc asks before it quits' "$mask" --play off <<'HAND'
key escape
expect "asks whether to quit"
key escape
expect-not asks
key escape
click stay
expect-not asks
key escape
key enter
frames 10
expect "never reached"
HAND

# ---- capture ----

# A pose by the VMC protocol, to the port that is printed, until the sender is stopped; and one packet that is damaged.
cat >"$work/send.py" <<'PY'
import math, socket, struct, sys, time
def text(s):
    b = s.encode() + b'\0'
    return b + b'\0' * (-len(b) % 4)
def message(address, *values):
    types = ',' + ''.join('s' if isinstance(v, str) else 'f' for v in values)
    body = b''.join(text(v) if isinstance(v, str) else struct.pack('>f', v) for v in values)
    return text(address) + text(types) + body
def bundle(*elements):
    return b'#bundle\0' + struct.pack('>Q', 1) + b''.join(struct.pack('>i', len(e)) + e for e in elements)
def bone(name, axis, degrees):
    h = math.radians(degrees) / 2
    q = [math.sin(h) * a for a in axis] + [math.cos(h)]
    return message('/VMC/Ext/Bone/Pos', name, 0.0, 0.0, 0.0, *q)
for tries in range(600):
    lines = [l for l in open(sys.argv[1]) if l.startswith('listens for VMC at 127.0.0.1:')]
    if lines: break
    time.sleep(0.05)
port = int(lines[0].rsplit(':', 1)[1])
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.sendto(b'neither', ('127.0.0.1', port))
while True:
    s.sendto(bundle(bone('LeftUpperArm', (0, 0, 1), 70), bone('RightUpperArm', (0, 0, 1), 70), bone('Head', (0, 1, 0), 40),
                    message('/VMC/Ext/Blend/Val', 'Joy', 1.0), message('/VMC/Ext/Blend/Val', 'jawOpen', 0.5),
                    message('/VMC/Ext/Blend/Apply'), message('/VMC/Ext/OK', 1.0)), ('127.0.0.1', port))
    time.sleep(0.02)
PY
if command -v python3 >/dev/null 2>&1; then
    : >"$work/out"
    cp "$mask" "$work/other.noh"
    python3 "$work/send.py" "$work/out" >"$work/sender" 2>&1 &
    sender=$!
    hand 'a captured person moves it' "$puppet" --play off --vmc 0 <<'HAND'
save rest.png
until "capture: 3 bones for 22 joints, 2 expressions for 9 targets" 100000
frames 2
expect "1 left out"
expect-not "held "
save captured.png
click Compare
click "side by side"
click "side by side/another level"
frames 2
expect "compared with another level"
click "side by side"
click "side by side/off"
key F10
frames 3
save restored.png
drop other.noh
until "state of other.noh" 100
until "capture: 3 bones for 0 joints, 2 expressions for 9 targets" 100000
HAND
    says 'a message is damaged'
    check 'it is another picture' differ rest.png captured.png
    check 'also after a lost context' same captured.png restored.png
    kill $sender 2>/dev/null
else
    skip 'capture' 'no python3 here'
fi
noh view "$puppet" --vmc 127.0.0.1:port --frames 1
expect 2 'a port that is not a number'
says 'must be PORT or ADDRESS:PORT'
noh view "$puppet" --vmc 192.0.2.1:39539 --frames 1
expect 1 "an address that is another machine's"
says 'cannot be listened at'

# ---- the figure stays in the picture ----

hand 'it opens playing, and is seen whole' "$puppet" <<'HAND'
expect "body idle "
expect playing
expect "seen 1.0000"
click dance/play
frames 20
expect "seen 1.0000"
click turntable
frames 20
expect "turning"
expect "seen 1.0000"
HAND
# In every frame of every clip at least 95 % of the silhouette; with NOH_LONG of all of it, else of its first second.
inside_script() { # PACK
    "$build/noh" info "$1" | sed -n "s/^clip '\([^']*\)': \([0-9.]*\) s, \([0-9]*\) joints.*/\1 \2 \3/p" | while read -r clip seconds joints; do
        [ "$joints" != 0 ] || continue
        frames=$(awk -v s="$seconds" -v long="${NOH_LONG:-0}" 'BEGIN { n = int(s * 60) + 1; print long == 1 || n < 60 ? n : 60 }')
        printf 'click "stop all"\nclick "%s/play"\nexpect "body %s "\ninside 0.95 %s\n' "$clip" "$clip" "$frames"
    done
}
inside_script "$puppet" >"$work/inside.txt"
check 'the puppet has clips' grep -q 'dance/play' "$work/inside.txt"
hand 'every clip of the puppet stays in the picture' "$puppet" <"$work/inside.txt"
view_size=700x900 hand 'as in a narrow one' "$puppet" <"$work/inside.txt"
printf 'key f\nwheel 400 200 12\ninside 0.95 1\n' >"$work/near.txt"
noh view "$puppet" --face off --size 900x600 --script "$work/near.txt"
expect 1 'and what is outside is found'
says 'of the silhouette'

body=${NOH_ASSETS:-}/hero/body.glb
if [ ! -f "$body" ]; then
    skip 'every clip of a body' 'no assets'
    finish
fi
"$build/noh" build "$body" -o "$work/body.noh" --plain --wrinkles face --error-cm 0.1 --effort 1 --quiet
for clip in walk jump dance_jetes punch; do
    printf 'click %s/play\nframes 2\nexpect "seen 1.0000"\ndrag "body %s/at" 0.35\nframes 2\nexpect "seen 1.0000"\ndrag "body %s/at" 0.7\nframes 2\nexpect "seen 1.0000"\n' $clip $clip $clip
done >"$work/clips.txt"
hand 'every clip of a body is seen whole' "$work/body.noh" <"$work/clips.txt"
inside_script "$work/body.noh" >"$work/inside.txt"
hand 'and stays in the picture' "$work/body.noh" <"$work/inside.txt"
finish
