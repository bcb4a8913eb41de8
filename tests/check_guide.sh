#!/bin/sh
# check_guide.sh: the guide (tools/docs/guide) agrees with the code.
#   - a page begins with a picture or a short program, has at most 1,500 words and ends with the next page
#   - links and pictures lead to files, and pictures have at most 120 KB
#   - commands are verbs and options of the tool, and targets of the Makefile
#   - names of the library are in its public headers, except on pages about the code (tests/check_names.sh)
#   - files that pages about the code name are there, and have the names that the table of searches gives
set -u
. tests/cli/lib.sh
guide=tools/docs/guide

for page in $guide/*.md; do
    awk -v page="$page" '
        NR == 1 && !/^# / { print page ": does not begin with a title" }
        NR == 3 && !/^!\[|^```/ { print page ": does not begin with a picture or a program" }
        { words += NF; if (NF) last = $0 }
        END {
            if (words > 1500) print page ": " words " words"
            if (last !~ /^Next: /) print page ": does not end with the next page"
        }' "$page"
done >"$work/shape"
check 'pages begin with a picture or a program, have at most 1,500 words, and end with the next page' \
    sh -c '! grep . "$1"' - "$work/shape"

for page in $guide/*.md; do
    grep -oE '\]\([^)#]+' "$page" | sed 's/^](//' | grep -v '^https\?:' | while read -r target; do
        test -e "$guide/$target" || echo "$page: $target"
    done
done >"$work/links"
check 'links and pictures lead to files' sh -c '! grep . "$1"' - "$work/links"
find $guide -name '*.png' -size +120k >"$work/large"
check 'pictures have at most 120 KB' sh -c '! grep . "$1"' - "$work/large"

# "VERB --option" of each command: in programs of lines, and in backticks.
cat $guide/*.md | awk '
    /^```/ { fence = !fence; next }
    fence { print; next }
    { n = split($0, part, "`"); for (i = 2; i <= n; i += 2) print part[i] }' >"$work/code"
grep -oE '(^|build/)noh [a-z]+( .*)?$' "$work/code" | sed -E 's/^(build\/)?noh //; s/ #.*//; s/&&.*//' | awk '{
    verb = $1; i = 2
    if (verb == "lab") verb = verb " " $(i++)
    print verb
    for (; i <= NF; i++) if ($i ~ /^--[a-z]/) print verb " " $i }' | sort -u >"$work/commands"
while read -r line; do
    option=$(echo "$line" | grep -oE -- '--[a-z0-9-]+$')
    verb=${line% --*}
    case $verb in help | lab) continue ;; esac
    # shellcheck disable=SC2086 # "lab drop" are two words
    noh $verb --help
    test $code -eq 0 || { echo "noh $verb: no such verb"; continue; }
    test -z "$option" || grep -qE -- "^ *(-[a-z], )?$option( |\$)" "$work/out" || echo "noh $verb $option"
done <"$work/commands" >"$work/bad_commands"
echo "# $(wc -l <"$work/commands") verbs and options"
check 'commands are verbs and options of the tool' sh -c '! grep . "$1"' - "$work/bad_commands"
grep -oE '(^|[ ;])make [a-z][a-z-]*( |$|`)' "$work/code" | awk '{ print $NF }' | sort -u | while read -r target; do
    cat Makefile tools/mk/*.mk | grep -qE "^([a-z-]+ )*$target[ :]" || echo "make $target"
done >"$work/targets"
check 'targets are in the Makefile' sh -c '! grep . "$1"' - "$work/targets"

# Names end in a letter or a number: noh_gl_morph_NAME and noh_ are patterns.
names() {
    sed 's/noh_[a-z_]*\.h//g' "$@" | grep -oE '\<(noh|NOH)_[a-zA-Z0-9_]*[a-z0-9A-Z]\>' | grep -vE '[a-z]_[A-Z]' | sort -u
}
cat runtime/noh/*.h >"$work/headers"
cat shaders_es/*.glsl shaders_es/README.md runtime/CMakeLists.txt tools/install/nohConfig.cmake.in tools/noh/build/noh_convert.h tests/run.sh >>"$work/headers"
pages=$(ls $guide/*.md | grep -v 'find_your_way\|/add_')
# shellcheck disable=SC2086 # a list
names $pages | grep -vE '^(NOH_WITHOUT_GL|NOH_GL_DEBUG)$' | while read -r name; do
    grep -qw "$name" "$work/headers" || echo "$name"
done >"$work/unknown"
check 'names are in the public headers' sh -c '! grep . "$1"' - "$work/unknown"
cat $guide/find_your_way.md $guide/add_*.md | grep -oE '`[a-z_]+(/[a-z_0-9]+)+\.(c|h|cpp|sh|glsl)`' | tr -d '`' |
    sort -u | while read -r file; do
    for root in '' runtime/ tools/ tools/convert/ tools/noh/; do test -e "$root$file" && continue 2; done
    echo "$file"
done >"$work/files"
check 'files that they name are there' sh -c '! grep . "$1"' - "$work/files"
minor=$(sed -n 's/^#define NOH_VERSION "\([0-9]*\.[0-9]*\)\..*"/\1/p' runtime/noh/base.h)
grep -rhoE 'find_package\(noh [0-9.]+' $guide | grep -vxF "find_package(noh $minor" >"$work/versions"
check 'CMake is asked for this version' sh -c '! grep . "$1"' - "$work/versions"
# "`file`: `name`, `name`" in a cell of the table of searches.
awk '/^\| .*\.(c|glsl)`/ {
    cells = split($0, cell, "|")
    for (c = 3; c < cells; c++) {
        n = split(cell[c], part, "`")
        for (i = 4; i <= n; i += 2) if (part[2] ~ /[a-z]\.(c|glsl)$/ && part[i] !~ /\.|NAME/) print part[2], part[i]
    }
}' $guide/find_your_way.md >"$work/places"
while read -r file name; do
    root=runtime/
    test -e "$root$file" || root=
    grep -qw "$name" "$root$file" || echo "$file: $name"
done <"$work/places" >"$work/misplaced"
echo "# $(wc -l <"$work/places") names in files"
check 'names are in the files that the searches give' sh -c '! grep . "$1"' - "$work/misplaced"
finish
