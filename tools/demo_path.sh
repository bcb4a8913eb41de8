#!/bin/sh
# demo_path.sh NOH PACK: how a demo draws. Line 1 is the policy for --path: `blend`, or `auto` where no blending into
# float32 is possible. Line 2 says which way that is here, how it compares with the CPU (noh verify), and what `auto`
# would take and why.
set -eu
noh=$1
pack=$2

# The value of a key: the first in the JSON on stdin.
field() {
    sed -n "s/^ *\"$1\": \"\\{0,1\\}\\([^\"]*[^\",]\\)\"\\{0,1\\},\\{0,1\\}\$/\\1/p" | sed -n 1p
}

auto=$("$noh" budget "$pack" --json)
auto_says="auto would take $(echo "$auto" | field path) ($(echo "$auto" | field reason | sed 's/^[a-z-]*: //'))"
if ! blend=$("$noh" budget "$pack" --path blend --json 2>&1); then
    echo auto
    echo "Drawn by $(echo "$auto" | field path)-$(echo "$auto" | field accumulate), not by blending: $(echo "$blend" | sed -n 's/^noh: [^:]*: //p' | sed -n 1p)."
    exit 0
fi
path=$(echo "$blend" | field path)
format=$(echo "$blend" | field accumulate)
row=$("$noh" verify "$pack" --json | grep -A 6 "\"path\": \"$path\"" | sed -n 1,7p)
echo blend
echo "Drawn by $path-$format ($(echo "$blend" | field reason | sed 's/^[a-z-]*: //')): $(echo "$row" | field differing) of \
$(echo "$row" | field values) values differ from the CPU's in any bit; $auto_says."
