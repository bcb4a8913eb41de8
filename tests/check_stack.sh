#!/bin/sh
# check_stack.sh: by gcc's call graph, the deepest stack of any call of the library is at most NOH_STACK_BYTES, and
# nothing recurses. A call through a pointer counts 256 bytes: it is either a small callback of the library, or a call
# of the GL driver, whose stack is not counted.
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
export CCACHE_DISABLE=1 # a compiler cache gives back objects alone, without the call graph
for source in $(find runtime -name "*.c"); do
    object=$work/$(echo "$source" | tr / _).o
    gcc -std=c99 -O2 -ffp-contract=off -fno-math-errno -Iruntime "-I$build/gen" -fcallgraph-info=su -c "$source" -o "$object" || exit 1
done

# Node lines hold "NAME\nFILE:LINE\nN bytes (static)", edge lines two names.
cat "$work"/*.ci | awk -v limit="$limit" '
    function deepest(name, i, n, list, most, depth) {
        if (name in done) return done[name]
        if (open[name]) { recursive = name; return 0 }
        open[name] = 1
        most = 0
        n = split(calls[name], list, SUBSEP)
        for (i = 1; i <= n; i++)
            if (list[i] != "") {
                depth = list[i] == "__indirect_call" ? 256 : deepest(list[i])
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
        calls[quoted[2]] = calls[quoted[2]] SUBSEP quoted[4]
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
