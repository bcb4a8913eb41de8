#!/bin/sh
# prose.sh: plain English in comments, strings and documents. `make lint` calls it. It prints FILE:LINE: PHRASE -> REMEDY
# for each phrase of the list below, also where a line break splits the phrase, and closes with "N passed, N failed,
# N skipped" (files). Code outside comments and strings is ignored. A machine finds only some of what makes a native
# reader stumble, so read the text aloud as well.
set -u
cd "$(dirname "$0")/../.." || exit 1

# Folders and files that are clean and must stay clean.
clean='README.md CONTRIBUTING.md platform runtime shaders_es'
clean="$clean CHANGELOG.md Makefile .ci/run tests/*.sh tests/README.md tests/cli tests/cross tests/fuzz tests/gl"
clean="$clean tests/golden tests/memory tests/support tests/web tests/unit tools/*.sh tools/*.md tools/amalgam"
clean="$clean tools/clip_tables tools/convert tools/demo_assets tools/docs tools/embed tools/install tools/lod_compare tools/mk tools/noh"
clean="$clean tools/phones tools/release tools/train_ear/*.[ch] tools/web_convert"

if ! command -v perl >/dev/null 2>&1; then
    echo 'prose skipped: perl is not installed'
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
fi
# shellcheck disable=SC2086 # words
exec perl tools/lint/prose.pl $clean <<'END'
(that|those) of\b -> repeat the noun: the mesh's vertices, the weights of the pose
so (many|much)\b -> give the number, or: enough
anew\b -> again
of (before|old)\b -> earlier, previous, older
beside (the|a|an|it|its|them|that|this|each|those|these|which|what|other|others|another|clips|all)\b -> next to (a place), with, as well as, compared with
with a word\b -> with a warning, with a message
hang(s|ing)? on\b -> is attached to, depends on
(is|are|was|were|be|been) told\b(?! apart) -> receives, gets, is passed, is reported
told (what|how|where|when|by|that|which|whether)\b -> receives, gets, is passed
who (falls?|has|have|builds?|walks?|hits?|looks?|is|are)\b -> an actor that, a program that
says? what (it|they)\b -> describes, states, documents
of which\b -> split the sentence, or: whose
whoever\b -> any actor that, any caller that
whom\b -> name the thing
(that|which) (is|are) none\b -> is not a number, is not a pack
(come|comes|came) of\b -> results from, is the result of
what of\b -> which parts of
how near\b -> how close
nothing of\b -> none of the, no part of
no (one|object|actor|mesh|texture|joint|kind)'s\b -> belongs to no object
namesakes?\b -> of the same name
lets? go of\b -> detaches, releases, frees
(has|have) not\s*[.,;:)] -> does not have
(is|are) not one\s*[.,;:)] -> is not a pack, is not a number
there (is|are) (such|so)\b -> there is a ...
goes by\b -> uses, follows
go(es)? on as\b -> continues as
(lest|whither|thereof|therein|thereby|whereof|whereby|nought|betimes|erst)\b -> modern English
upon\b -> on
but for (a|an|the|its|their|what|one|that|those|these|`)\b -> except for
stands? in for\b -> replaces
the like\b -> such as
what there is\b -> what is available, the files that exist
(hence|thus)\b -> so, therefore
(anything|something) of\b -> any part of
END
