#!/bin/sh
# check_stack.sh: the deepest stack of any call of the library is at most NOH_STACK_BYTES, and nothing recurses, as
# gcc's call graph tells. A call of a stage's module counts what the deepest of its functions takes. Any other call
# through a pointer counts 256 bytes: it is either a small callback of the library, or the GL driver, whose stack is not
# ours.
set -u
build=${NOH_BUILD:-build}
work=$build/stack
limit=$(sed -n 's/#define NOH_STACK_BYTES \([0-9]*\)u/\1/p' runtime/noh/base.h)

if ! gcc --version 2>/dev/null | grep -q . || [ -n "${NOH_SAN:-}" ]; then
    echo 'SKIP: check_stack: needs gcc (its call graph), without sanitizers'
    echo 'ok 1 - stack within NOH_STACK_BYTES # SKIP needs gcc without sanitizers'
    echo '1..1'
    exit 0
fi

rm -rf "$work"
mkdir -p "$work"
# The graphs of the library's objects (Makefile), if none is older than the sources; else they are made here.
find runtime -name '*.c' | sed "s|.*|$build/&|; s|c\$|ci|" >"$work/graphs"
oldest=$(xargs ls -t <"$work/graphs" 2>/dev/null | tail -n 1)
case $(readlink -f "$(command -v gcc)") in *ccache*) oldest= ;; esac # a compiler cache gives back objects alone
if [ -z "$oldest" ] || ! xargs ls <"$work/graphs" >/dev/null 2>&1 || find runtime -newer "$oldest" -name '*.[ch]' | grep -q .; then
    export CCACHE_DISABLE=1
    for source in $(find runtime -name "*.c"); do
        object=$work/$(echo "$source" | tr / _).o
        gcc -std=c99 -O2 -ffp-contract=off -fno-math-errno -Iruntime "-I$build/gen" -fcallgraph-info=su -c "$source" -o "$object" || exit 1
    done
    ls "$work"/*.ci >"$work/graphs"
fi

# The functions of the stage's modules (module_internal.h), as "FIELD FILE:FUNCTION": a call of one of the fields is as
# deep as the deepest of its functions.
awk '/^ +\.[a-z_]+ = [a-z_]+,$/ { sub(/,/, ""); print substr($1, 2), FILENAME ":" $3; print substr($1, 2), $3 }' \
    runtime/stage/modules/*.c >"$work/fields"

# Node lines hold "NAME\nFILE:LINE\nN bytes (static)", edge lines two names and "FILE:LINE:COLUMN" of the call.
xargs cat <"$work/graphs" | awk -v limit="$limit" -v fields="$work/fields" '
    BEGIN {
        while ((getline line < fields) > 0) {
            split(line, word, " ")
            functions[word[1]] = functions[word[1]] SUBSEP word[2]
        }
    }
    # A call through a pointer, "->FIELD(" in this line of the source.
    function indirect(at, where, n, line, list, i, depth, most) {
        most = 256
        split(at, where, ":")
        if (where[1] !~ /^runtime\/stage\/cast\//) return most
        for (n = 1; (getline line < where[1]) > 0 && n < where[2]; n++) {}
        close(where[1])
        if (!match(line, /(type|source)->[a-z_]+\(/)) return most
        line = substr(line, RSTART, RLENGTH - 1)
        sub(/.*->/, "", line)
        n = split(functions[line], list, SUBSEP)
        for (i = 1; i <= n; i++)
            if (list[i] in bytes && (depth = deepest(list[i])) > most) most = depth
        return most
    }
    function deepest(name, i, n, list, most, depth) {
        if (name in done) return done[name]
        if (open[name]) { recursive = name; return 0 }
        open[name] = 1
        most = 0
        n = split(calls[name], list, SUBSEP)
        for (i = 1; i <= n; i++)
            if (list[i] != "") {
                depth = list[i] ~ /^__indirect_call/ ? indirect(substr(list[i], 16)) : deepest(list[i])
                if (depth > most) most = depth
            }
        open[name] = 0
        return done[name] = most + bytes[name]
    }
    /^node:/ && / bytes \(/ {
        split($0, quoted, "\"")
        count = quoted[4]
        sub(/ bytes \(.*/, "", count)
        sub(/.*\\n/, "", count)
        bytes[quoted[2]] = count + 0
        if ($0 ~ /\(dynamic\)/) dynamic = quoted[2]
    }
    /^edge:/ {
        split($0, quoted, "\"")
        calls[quoted[2]] = calls[quoted[2]] SUBSEP quoted[4] (quoted[4] == "__indirect_call" ? quoted[6] : "")
    }
    END {
        for (name in bytes) {
            depth = deepest(name)
            if (depth > worst) { worst = depth; where = name }
        }
        good = worst > 0 && worst <= limit && recursive == "" && dynamic == ""
        printf "%s 1 - stack: at most %d of %d bytes (%s)%s%s\n", good ? "ok" : "not ok", worst, limit, where,
               recursive == "" ? "" : ", recursion in " recursive, dynamic == "" ? "" : ", unbounded frame in " dynamic
        print "1..1"
        exit !good
    }'
