#!/bin/sh
# check_names.sh: every noh_ and NOH_ name in a comment or a document exists in the sources, so that no text mentions a
# renamed function. A name that ends in _ stands for all names with this beginning; noh.h's noh_noun_verb and noh_x are
# patterns. Public headers speak of public names only. Also, the top level has no unexpected file.
set -u
. tests/cli/lib.sh

find runtime platform shaders_es tools tests -type f \
    \( -name '*.[ch]' -o -name '*.cpp' -o -name '*.glsl' -o -name '*.vert' -o -name '*.frag' -o -name '*.geom' \) |
    grep -v '/cross/cmocka' | sort >"$work/sources"
find . -name '*.md' ! -name CHANGELOG.md ! -path './.git/*' ! -path "./${build#./}/*" ! -path './build*' | sort >"$work/documents"

awk -v code="$work/code" -v text="$work/text" -f tests/support/comments.awk $(cat "$work/sources")
for document in $(cat "$work/documents"); do sed "s|^|$document: |" "$document"; done >>"$work/text"

cat tests/*.sh tests/*/*.sh tools/*.sh >>"$work/code" # scripts have names, too: what they take from the environment
grep -oE '\b(noh|NOH)_[A-Za-z0-9_]+' "$work/code" | sort -u >"$work/names"
check 'names were found' test "$(wc -l <"$work/names")" -gt 1000
grep -oE '\b(noh|NOH)_[A-Za-z0-9_]+' "$work/text" | sort -u |
    grep -vE '^(noh_noun.*|NOH_NOUN|noh_x_.*|noh_shader_.*)$' >"$work/spoken"
check 'and spoken of' test "$(wc -l <"$work/spoken")" -gt 300
# Known: a name, or the beginning of one.
awk 'NR == FNR { known[$0] = 1; all = all "\n" $0; next }
     !($0 in known) && !index(all, "\n" $0) { print }' "$work/names" "$work/spoken" >"$work/strange"
while read -r name; do grep -m 1 -wF "$name" "$work/text"; done <"$work/strange" | sed 's/^/#   /'
check 'no comment or document names what does not exist' test ! -s "$work/strange"

# Public headers speak only of names that a game has: what they or shaders declare, and what a build may define.
awk -v code="$work/public_code" -v text="$work/public_text" -f tests/support/comments.awk runtime/noh/*.h
{ cat "$work/public_code" shaders_es/*.*; echo NOH_ASSERT_LEVEL NOH_ASSERT_FAILED; } | grep -oE '\b(noh|NOH)_[A-Za-z0-9_]+' | sort -u >"$work/public_names"
# Headers are no names, and a chunk's constants come from a list.
sed 's/noh_[a-z_]*\.h//g' "$work/public_text" | grep -oE '\b(noh|NOH)_[A-Za-z0-9_]+' | sort -u |
    grep -vE '^(noh_noun.*|NOH_NOUN|noh_x_.*|NOH_(CHUNK|TAG)_STRINGS)$' >"$work/public_spoken"
check 'public headers speak of names' test "$(wc -l <"$work/public_spoken")" -gt 100
awk 'NR == FNR { known[$0] = 1; all = all "\n" $0; next }
     !($0 in known) && !index(all, "\n" $0) { print }' "$work/public_names" "$work/public_spoken" >"$work/private_spoken"
check 'and of none that is private' sh -c '! grep . "$1"' - "$work/private_spoken"

# Files left by a command were committed by mistake before.
if git ls-files >"$work/files" 2>/dev/null && [ -s "$work/files" ]; then
    sed 's|/.*||' "$work/files" | sort -u |
        grep -vxE '\..+|CHANGELOG\.md|CONTRIBUTING\.md|LICENSE|Makefile|README\.md|platform|runtime|shaders_es|tests|tools' |
        sed 's/^/# at the top level: /' >"$work/odd"
    cat "$work/odd"
    check 'the top level holds what README.md says, and nothing else' test ! -s "$work/odd"
else
    skip 'the top level holds what README.md says, and nothing else' 'not a checkout of git'
fi
finish
