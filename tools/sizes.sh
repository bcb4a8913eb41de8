#!/bin/sh
# sizes.sh [--update]: code and constants of the library, by object and by function, for armv7 -Os, aarch64, x86-64 and
# wasm, and how they differ from tools/sizes.txt, the table of the last commit. --update writes that table. A target whose
# compiler is missing is skipped, and its column keeps what the table says. `make sizes` and `make sizes-update` call it.
#
# tools/sizes.txt has a line "OBJECT:FUNCTION ARMV7 AARCH64 X86-64 WASM" in bytes for each function, constant and string
# table, and "OBJECT ..." for each object; "-" is none there: inlined, or not built for that processor.
set -eu
cd "$(dirname "$0")/.."
export LC_ALL=C
build=${NOH_BUILD:-build}
work=$build/sizes
table=tools/sizes.txt
mkdir -p "$work"

# The library's objects, by its sources: an archive's members have no folders, and two may have one name; objects of
# files that have moved may still lie next to them.
files() { # TARGET
    { find runtime -name '*.c' | sed 's/c$/o/' && echo gen/shaders.gen.o; } | sed "s|^|$work/$1/|" | sort
}
# Lines "OBJECT:NAME BYTES". WebAssembly's have addresses in the code section, no sizes.
symbols() { # TARGET NM
    if [ "$1" = wasm ]; then
        files "$1" | xargs "$2" --defined-only 2>/dev/null | sed "s|^$work/$1/||" | awk '
            /:$/ { object = $1; sub(/:$/, "", object); next }
            NF == 3 && $2 ~ /[tT]/ { print object, $1, $3 }' | sort | awk '
            function number(h, i, n) { n = 0; for (i = 1; i <= length(h); i++) n = n * 16 + index("0123456789abcdef", substr(h, i, 1)) - 1; return n }
            { at = number($2) }
            $1 == object && at > before { print object ":" name, at - before }
            { object = $1; name = $3; before = at }'
    else
        files "$1" | xargs "$2" -S -t d --defined-only | sed "s|^$work/$1/||" | awk '
            /:$/ { object = $1; sub(/:$/, "", object); next }
            NF == 4 && $3 ~ /[tTrRdD]/ { name = $4; sub(/\.(constprop|part|isra|[0-9]+).*/, "", name); sum[object ":" name] += $2 }
            END { for (key in sum) print key, sum[key] }'
    fi
}

# Lines "OBJECT BYTES".
objects() { # TARGET SIZE
    files "$1" | xargs "$2" 2>/dev/null | sed "s|$work/$1/||" | awk 'NR > 1 { print $6, $1 + $2 }'
}

# target NAME CC AR NM SIZE OPT
target() {
    if ! command -v "${2%% *}" >/dev/null 2>&1; then
        echo "$1: skipped, no ${2%% *} here"
        return 0
    fi
    make --no-print-directory -j"${JOBS:-2}" BUILD="$work/$1" CC="$2" AR="$3" OPT="$6" WERROR= DEPS=0 CFLAGS= CPPFLAGS= lib >"$work/$1.log" 2>&1 ||
        { echo "$1: does not build"; tail -n 5 "$work/$1.log"; exit 1; }
    { symbols "$1" "$4"; objects "$1" "$5"; } | sort >"$work/$1.sizes"
}
rm -f "$work"/*.sizes
target armv7 'arm-linux-gnueabihf-gcc' arm-linux-gnueabihf-ar arm-linux-gnueabihf-nm arm-linux-gnueabihf-size -Os
target aarch64 aarch64-linux-gnu-gcc aarch64-linux-gnu-ar aarch64-linux-gnu-nm aarch64-linux-gnu-size -O2
target x86-64 "${X86_64_CC:-gcc}" ar nm size -O2
target wasm emcc emar "$(command -v llvm-nm || echo emnm)" "$(command -v llvm-size || echo emsize)" -Os

# One line a name, a column a target; columns of skipped targets are the table's.
[ -f "$table" ] || echo '# name armv7-Os aarch64-O2 x86-64-O2 wasm-Os' >"$work/none"
old=$table
[ -f "$old" ] || old=$work/none
awk -v folder="$work" '
    BEGIN { split("armv7 aarch64 x86-64 wasm", targets, " ") }
    /^#/ { next }
    { for (t = 1; t <= 4; t++) was[$1, t] = $(t + 1); known[$1] = 1 }
    END {
        for (t = 1; t <= 4; t++) {
            file = folder "/" targets[t] ".sizes"
            while ((getline line < file) > 0) {
                split(line, word, " ")
                is[word[1], t] = word[2]
                known[word[1]] = ran[t] = 1
            }
        }
        for (name in known) {
            line = name
            some = 0
            for (t = 1; t <= 4; t++) {
                bytes = ran[t] ? is[name, t] : was[name, t]
                if (bytes == "") bytes = "-"
                if (bytes != "-") some = 1
                line = line " " bytes
            }
            if (some) print line
        }
    }' "$old" | sort >"$work/table"
{ echo '# name armv7-Os aarch64-O2 x86-64-O2 wasm-Os'; cat "$work/table"; } >"$work/new"

# Objects, their sum, and what changed.
awk '
    function shown(bytes, before) { return bytes == "-" ? "-" : before == "" || before == "-" || before == bytes ? bytes : sprintf("%d (%+d)", bytes, bytes - before) }
    /^#/ { next }
    NR == FNR { for (t = 2; t <= 5; t++) was[$1, t] = $t; old[$1] = 1; next }
    {
        new[$1] = 1
        differs = 0
        for (t = 2; t <= 5; t++) if (was[$1, t] != $t) differs = 1
        line = sprintf("%-44s", $1)
        for (t = 2; t <= 5; t++) line = line sprintf(" %16s", shown($t, was[$1, t]))
        if ($1 ~ /:/) { if (differs && length(old)) changed = changed line (old[$1] ? "" : "  new") "\n" }
        else {
            for (t = 2; t <= 5; t++) { sum[t] += $t; sum_was[t] += was[$1, t] }
            print line
        }
    }
    END {
        line = sprintf("%-44s", "all objects")
        for (t = 2; t <= 5; t++) line = line sprintf(" %16s", shown(sum[t], sum_was[t] ? sum_was[t] : ""))
        print line
        for (name in old) if (name ~ /:/ && !new[name]) changed = changed sprintf("%-44s gone\n", name)
        if (changed != "") printf "\nfunctions that changed:\n%s", changed
    }' "$old" "$work/new" | sed '1i\
name                                                 armv7 -Os      aarch64 -O2       x86-64 -O2         wasm -Os'

if [ "${1:-}" = --update ]; then
    cp "$work/new" "$table"
    echo "written: $table"
fi
