#!/bin/sh
# demo_crowd.sh BUILD: a square at a festival, drawn with a thousand puppets who stroll, buy, rest and listen; a strip of
# it closer by; and how its agents got on.
set -eu
build=$1
out=$build/demo
noh=$build/noh
place=tools/demo_assets/festival/festival.place

echo
"$build/demo_assets" --festival "$out/festival"
"$noh" build "$out/festival.obj" -o "$out/festival.noh" --unit-cm 100 --quiet
draw() { # NAME OPTION...
    name=$1
    shift
    "$noh" crowd "$out/puppet_levels.noh" --place "$place" --scenery "$out/festival.noh" --light sky -o "$out/festival$name.png" "$@"
}
draw '' --agents 1000 --time 30 --camera 18,13,24,0,0 --size 1280x640
draw _drum --agents 400 --time 40 --camera -35,9,11,-1,-5 --size 960x540
draw _stall --agents 400 --time 40 --camera 140,9,8,-15.5,-1 --size 960x540
draw _stairs --agents 400 --time 40 --camera -30,12,9,16,-8 --size 960x540
draw _strip --agents 300 --time 36 --strip 4,1 --camera -60,12,6.5,15.3,-7.7 --size 320x320
echo
"$noh" crowd --place "$place" --agents 1000 --seconds 60
echo
echo 'Pictures:'
ls "$out"/festival*.png | sed 's/^/  /'
