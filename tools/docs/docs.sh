#!/bin/sh
# docs.sh: the guide (tools/docs/guide) and the API reference (the public headers) as one site with search, in
# $NOH_BUILD/docs/html. A warning of Doxygen's is a failure, such as a name in the guide that no header has. `make docs`
# calls it.
set -eu
cd "$(dirname "$0")/../.."
build=${NOH_BUILD:-build}
out=$build/docs
command -v doxygen >/dev/null 2>&1 || { echo 'docs skipped: no doxygen here'; echo '0 passed, 0 failed, 1 skipped'; exit 0; }
rm -rf "$out"
mkdir -p "$out"
headers=$(sh tools/headers.sh | sed 's|^|runtime/|' | tr '\n' ' ')
cat >"$out/style.css" <<'END'
.contents img, .contents object { max-width: 100%; height: auto; }
.contents h1 { font-size: 150%; }
.contents .fragment { line-height: 1.35; }
END
cat >"$out/Doxyfile" <<END
PROJECT_NAME           = noh
PROJECT_NUMBER         = ${VERSION:-}
PROJECT_BRIEF          = "Characters in fixed memory, for OpenGL ES 3.x"
OUTPUT_DIRECTORY       = $out
INPUT                  = tools/docs/main.dox tools/docs/guide $headers
INPUT_FILTER           = "awk -f tools/docs/filter.awk"
FILTER_PATTERNS        = "*.dox=cat" "*.md=awk -f tools/docs/guide.awk"
FILE_PATTERNS          = *.md
IMAGE_PATH             = tools/docs/guide tools/docs/guide/pictures tools/demo_assets/festival
STRIP_FROM_PATH        = runtime
STRIP_FROM_INC_PATH    = runtime
OPTIMIZE_OUTPUT_FOR_C  = YES
MARKDOWN_SUPPORT       = YES
AUTOLINK_SUPPORT       = YES
SEARCHENGINE           = YES
SERVER_BASED_SEARCH    = NO
JAVADOC_AUTOBRIEF      = YES
EXTRACT_ALL            = YES
EXTRACT_STATIC         = YES
TYPEDEF_HIDES_STRUCT   = YES
SORT_MEMBER_DOCS       = NO
MACRO_EXPANSION        = YES
EXPAND_ONLY_PREDEF     = YES
PREDEFINED             = __cplusplus_off NOH_DOCS
SEARCH_INCLUDES        = NO
HAVE_DOT               = NO
GENERATE_LATEX         = NO
GENERATE_TREEVIEW      = YES
HTML_EXTRA_STYLESHEET  = $out/style.css
DISABLE_INDEX          = NO
HTML_TIMESTAMP         = NO
QUIET                  = YES
WARN_IF_UNDOCUMENTED   = NO
WARN_IF_DOC_ERROR      = YES
WARN_LOGFILE           = $out/warnings.txt
END
doxygen "$out/Doxyfile" >"$out/log.txt" 2>&1 || { tail -n 20 "$out/log.txt"; echo '0 passed, 1 failed, 0 skipped'; exit 1; }
if [ -s "$out/warnings.txt" ]; then
    head -n 40 "$out/warnings.txt"
    echo "0 passed, 1 failed, 0 skipped"
    exit 1
fi
awk -f tools/docs/search.awk "$out/html/search/searchdata.js" "$out"/html/search/all_*.js tools/docs/guide/*.md
echo "$out/html/index.html: $(echo "$headers" | wc -w) headers, $(ls tools/docs/guide/*.md | wc -l) pages, no warning"
echo '1 passed, 0 failed, 0 skipped'
