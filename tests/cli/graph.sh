#!/bin/sh
# noh build --graph, info and dump of graphs: messages with file and line, the same bytes every time; the text written
# by dump builds the same pack.
. "$(dirname "$0")/lib.sh"

puppet=$build/demo/puppet.glb
text=tools/demo_assets/puppet/puppet.graph

demo=$build/demo/puppet.noh # as the Makefile makes it: with this graph, springs and wrinkles
noh info "$demo"
expect 0 'info'
check 'shows the graph' grep -q "^graph 'puppet': 11 nodes, 7 clips, 4 parameters, 1 mask" "$work/out"
check 'its parameters' grep -q "parameter 'act': calm, look_round, dance; initially calm" "$work/out"
check 'its nodes' grep -q "one-shot 'bows' on 'bow'" "$work/out"
noh info "$demo" --json
check 'and as JSON' grep -q '"graphs"' "$work/out"

noh dump "$demo" --graph puppet -o "$work/a.graph"
expect 0 'dump --graph'
noh build "$puppet" -o "$work/b.noh" --plain --graph "$work/a.graph" --springs tools/demo_assets/puppet/puppet.springs --wrinkles auto --quiet
expect 0 'is a text that builds'
check 'to the same pack' cmp "$demo" "$work/b.noh"
noh dump "$demo" --graph all -o "$work/all.graph"
check 'all: one graph is all there is' cmp "$work/a.graph" "$work/all.graph"
noh dump "$demo" --graph pupet -o "$work/x.graph"
expect 1 'dump of a graph that is not there'
says "no graph 'pupet'; did you mean 'puppet'?"
noh dump "$build/mask.noh" --graph all -o "$work/x.graph"
expect 1 'dump of graphs where there are none'
says 'has no animation graph'
noh dump "$demo" --graph puppet --clip walk -o "$work/x.graph"
expect 2 'a graph has no clip to pose'

refused() { # LINE MESSAGE : what is in $work/bad.graph is refused so
    noh build "$puppet" -o "$work/bad.noh" --plain --only anim --graph "$work/bad.graph" --quiet
    expect 1 "refused: $2"
    says "bad.graph:$1: $2"
    check 'and nothing is written' test ! -e "$work/bad.noh"
}
printf 'graph a\nclip wlak\n' >"$work/bad.graph"
refused 2 "no input has a clip 'wlak'; did you mean 'walk'?"
printf 'graph a\nmask m\n  below nek\nclip walk\n' >"$work/bad.graph"
refused 3 "no input has a joint 'nek'; did you mean 'neck'?"
printf 'graph a\nclip walk\nclip bow\nmachine m walk bow\n  from walk to bow when ending\n' >"$work/ending.graph"
noh build "$puppet" -o "$work/ending.noh" --plain --only anim --effort 1 --graph "$work/ending.graph"
expect 0 'a state that never ends is no error'
check 'but warned of' grep -q "ending.graph:5: .from walk to bow when ending. is never true: 'walk' loops" "$work/out" "$work/err"
printf 'graph a\nclip walk sped=2\n' >"$work/bad.graph"
refused 2 "'clip' has no option 'sped', or has it twice; did you mean 'speed'?"
printf 'graph a\nclip walk loop=once sync=feet\n' >"$work/bad.graph"
noh build "$puppet" -o "$work/bad.noh" --plain --only anim --effort 1 --graph "$work/bad.graph" --quiet
expect 1 'what the runtime would refuse is refused when it is built'
says "graph 'a', node 'walk'"
noh build "$puppet" -o "$work/bad.noh" --plain --only anim --graph "$work/none.graph" --quiet
expect 1 'a file that is not there'
says none.graph
noh build "$puppet" -o "$work/bad.noh" --plain --wrinkles face --graph $text --only mesh --quiet
expect 2 'a graph belongs to clips'
cp $text "$work/kept.graph"
noh build "$puppet" -o "$work/kept.graph" --plain --wrinkles face --graph "$work/kept.graph" --quiet
expect 2 'build over its graph'
check 'which stays' cmp $text "$work/kept.graph"
finish
