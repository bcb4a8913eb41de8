#!/bin/sh
# The display of `noh view`, by scripted input: the figure as in noh render, sliders, clips on layers, a blend space, a
# graph, root motion, pushes, LOD levels, light; all of it survives a lost context.
. tests/cli/lib.sh
. tests/support/view.sh
case $build in /*) ;; *) build=$PWD/$build ;; esac
mask=$build/mask.noh puppet=$build/demo/puppet_levels.noh
start_display

# ---- the camera, sliders, a clip, paths ----

hand 'camera, sliders, a clip, another path' "$mask" --play off <<'HAND'
save rest.png
drag 400 200 350 250
save turned.png
drag 400 200 390 190 right
save moved.png
wheel 400 200 3
save near.png
key f
save back.png
click search
type cheekpuff
drag cheekPuff 1
expect "held cheekPuff 1"
save puff.png
click "let go"
expect-not held
save released.png
click speak/play
expect "track "
expect ", repeat, on"
save speak_1.png
frames 6
save speak_2.png
key space
expect paused
save paused_1.png
frames 6
save paused_2.png
drag "face speak/at" 0.8
save scrubbed.png
click path
click path/mrt
save mrt.png
key tab
frames 1
save wide.png
key tab
frames 1
key F10
frames 3
save lost.png
HAND
draw render.png rest.png "$mask"
check 'the figure is what noh render draws' same rest.png render.png
check 'a drag turns the camera' differ rest.png turned.png
check 'the right button moves it' differ turned.png moved.png
check 'the wheel brings it nearer' differ moved.png near.png
check 'F goes back to where it was' same rest.png back.png
draw puff_render.png rest.png "$mask" --weight cheekPuff=1
check 'a slider moves the target that was searched for' alike puff.png puff_render.png
check 'let go, it goes back' same rest.png released.png
check 'a clip plays' differ speak_1.png speak_2.png
check 'space pauses it' same paused_1.png paused_2.png
check 'its time can be scrubbed' differ paused_2.png scrubbed.png
check 'another path draws the same figure' alike scrubbed.png mrt.png
check 'Tab takes the panels away' test "$(png_size wide.png)" = 820x500
check 'after a lost context all is as it was' alike mrt.png lost.png

# ---- light ----

hand 'light' "$mask" --play off --light room --rotate 20 <<'HAND'
save rest.png
key ]
save turned.png
key F10
frames 3
save lost.png
key [
save back.png
click light
click light/studio
frames 1
expect "light turned 20.0, studio"
save studio.png
key ctrl+z
frames 1
expect "light turned 20.0, room"
save undone.png
HAND
draw room.png rest.png "$mask" --light room --rotate 20
check 'its shadow and its background equal noh render' same rest.png room.png
draw turned_room.png rest.png "$mask" --light room --rotate 35
check '] turns it by 15 degrees' same turned.png turned_room.png
check 'and a lost context does not turn it back' same turned.png lost.png
check '[ turns it back' same rest.png back.png
draw studio_render.png rest.png "$mask" --light studio --rotate 20
check 'another light, turned as much' same studio.png studio_render.png
check 'is undone' same rest.png undone.png
hand 'the light of a file, by its name' "$mask" --play off --light ./rest.png <<'HAND'
expect "light turned 0.0, rest.png"
save file.png
click light
click light/none
frames 1
click light
click light/rest.png
frames 1
save file_again.png
HAND
check 'can be had again' same file.png file_again.png

# ---- LOD levels ----

hand 'LOD levels' "$build/mask_levels.noh" --play off <<'HAND'
save rest.png
key l
expect "level 1"
save level_1.png
click "level 3"
save level_3.png
click full
save full.png
click "by pixels"
frames 2
save by_pixels.png
wheel 400 200 -12
frames 30
save far.png
key l
save far_0.png
key l
save far_1.png
key l
save far_2.png
key l
save far_3.png
key l
frames 2
save far_again.png
HAND
for level in 0 1 3; do draw native_$level.png rest.png "$build/mask_levels.noh" --lod $level; done
check 'a pack with levels is shown in full' same rest.png native_0.png
check 'L shows the next level, as noh render draws it' same level_1.png native_1.png
check 'which is another picture' differ rest.png level_1.png
check 'a click on the third level shows that' same level_3.png native_3.png
check 'a click on the full one shows that again' same rest.png full.png
check 'the full mesh is shown where no other is good enough' same rest.png by_pixels.png
check 'far away it is not' differ far.png far_0.png
check 'but one of the levels' sh -c 'cd "$1" && { cmp -s far.png far_1.png || cmp -s far.png far_2.png || cmp -s far.png far_3.png; }' - "$work"
check 'which is chosen again' same far.png far_again.png

# ---- a body: picking, layers, a blend space ----

view_size=900x600 hand 'picking and layers' "$puppet" --play off <<'HAND'
save rest.png
click 422 134
expect "picked mesh 'mask', submesh 0 'paint', triangle "
expect "joint 'jaw'"
save picked.png
click 422 237
expect "picked mesh 'body', submesh 0 'cloth', triangle "
drag 415 220 405 220
expect "picked mesh 'body', submesh 0 'cloth', triangle "
key f
click 310 20
expect-not picked
save let_go.png
click walk/play
expect "track 0 body walk "
click Layers
drag fade 0
click "part, from"
click "part, from/chest"
frames 1
click layer
click layer/part
click loop
click loop/ping-pong
click bow/play
expect "track 8 part bow "
expect "ping-pong, on"
key space
drag "part bow/at" 0.5
click 401 348
expect "picked mesh 'body'"
state
save bowing.png
drag "part bow/weight" 0
state
save walking.png
drag "part bow/weight" 1
save bowing_again.png
click "part bow/mute"
expect " muted"
save muted.png
click "part bow/pose"
click "part bow/stop"
save stopped.png
expect-not "part bow"
key space
until "body: walk / foot_" 100
click "stop all"
expect-not "track "
HAND
check 'a ring marks what was clicked on' differ rest.png picked.png
check 'a click on the background lets go' same rest.png let_go.png
check 'it bows less with less weight' differ bowing.png walking.png
picked=$(sed -n 's/^picked .* at //p' "$work/out" | tail -n 2)
check 'but not in the legs, which the mask leaves out' check_near "$(echo "$picked" | sed -n '1s/.* //p')" "$(echo "$picked" | sed -n '2s/.* //p')" 0.0011
check 'with weight it bows again' alike bowing.png bowing_again.png 0.2 0.002
check 'muted it is not in the pose' alike walking.png muted.png 0.2 0.002
check 'without it the walk is the same' alike walking.png stopped.png 0.2 0.002

hand 'a blend space' "$puppet" --play off <<'HAND'
click "Blend space"
click blend/clips
click blend/clips/idle
click blend/clips/walk
click blend/clips/dance
key escape
expect-not asks
expect "pad at 0.000 0.000, idle 0.333, walk 0.333, dance 0.333"
click blend/play
frames 30
key space
expect "body dance "
state
save middle.png
drag blend/pad 0.5 0.5 0.848 0.704
state
save corner.png
drag blend/pad 0.5 0.1 0.24 0.187
state
HAND
phase_of() { sed -n "s/^track .* $1 \([0-9.]*\) s,.*/\1/p" "$work/out" | sed -n "$3p" | awk -v all="$2" '{ print $1 / all }'; }
weight_of() { sed -n "s/^track .* $1 .* weight \([0-9.]*\),.*/\1/p" "$work/out" | sed -n "$2p"; }
check 'its clips play in step' check_near "$(phase_of idle 4 1)" "$(phase_of walk 1.4 1)" 0.01
check 'at the corner of one it has all the weight' check_near "$(weight_of walk 2)" 1 0.01
check 'and the others none' check_near "$(weight_of dance 2)" 0 0.01
check 'which is another pose' differ middle.png corner.png
check 'clips can be moved, and the point stays' check_near "$(weight_of walk 3)" 1 0.03

# ---- root motion, graphs, pushes ----

hand 'a walk over the floor' "$puppet" --clip walk --walk <<'HAND'
state
frames 60
key space
state
save with_floor.png
click floor
save without.png
click floor
save again.png
click "back to the start"
expect "place 0.0000 0.0000 0.0000"
save home.png
click "root motion"
key space
frames 10
expect "place 0.0000 0.0000 0.0000"
expect "body walk"
HAND
z_of() { sed -n "s/^$1 [^ ]* [^ ]* //p" "$work/out" | sed -n "$2p"; }
check 'it gets on' awk -v a="$(z_of place 1)" -v b="$(z_of place 2)" 'BEGIN { exit !(b > a + 0.2) }'
moved() { awk -v a="$(z_of "$1" 1)" -v b="$(z_of "$1" 2)" 'BEGIN { print b - a }'; }
check 'and the camera goes with it' check_near "$(moved center)" "$(moved place)" 0.002
check 'the floor can be taken away' differ with_floor.png without.png
check 'and laid again' same with_floor.png again.png
check 'sent back, its path is gone' differ with_floor.png home.png

hand 'a graph' "$puppet" --play off <<'HAND'
click Graph
click moves/play
expect "graph moves, speed 0.000, attention 0.000, "
expect "bows: acts"
drag graph/speed 0.5
expect "graph moves, speed 0."
expect-not "graph moves, speed 0.000"
click graph/bow
until "bows: bowing" 20
HAND

hand 'pushes' "$build/demo/puppet_falls.noh" --clip walk <<'HAND'
expect "body stands"
save standing.png
alt-click 380 175
until "body falls" 60
expect-not picked
save falling.png
until "body gets up" 900
expect "body get_up_"
until "body stands" 600
expect "body walk "
alt-click 310 20
frames 2
expect "body stands"
key space
key p
until "body falls" 60
key F10
until "body gets up" 900
HAND
check 'it shows' differ standing.png falling.png
finish
