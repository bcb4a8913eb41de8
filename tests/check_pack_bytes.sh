#!/bin/sh
# check_pack_bytes.sh: the demo's models and packs have the same bytes from every compiler. NOH_OTHER is the other build
# (default: build, if this build has another folder: .ci/run builds with gcc there, and with clang under sanitizers).
build=${NOH_BUILD:-build}
other=${NOH_OTHER:-$PWD/build}
compared=0 failures=0
for file in mask.glb demo/puppet.glb demo/arm.glb mask.noh wig.noh mask_levels.noh demo/puppet.noh demo/puppet_levels.noh demo/puppet_falls.noh; do
    if [ ! "$build" -ef "$other" ] && [ -f "$build/$file" ] && [ -f "$other/$file" ]; then
        compared=$((compared + 1))
        cmp "$build/$file" "$other/$file" || failures=$((failures + 1))
    fi
done
name='packs: the same bytes from another compiler'
if [ $compared = 0 ]; then
    echo "ok 1 - $name # SKIP no other build; NOH_OTHER names one"
elif [ $failures = 0 ]; then
    echo "ok 1 - $name"
else
    echo "not ok 1 - $name"
fi
echo 1..1
exit $failures
