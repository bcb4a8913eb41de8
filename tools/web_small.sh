#!/bin/sh
# web_small.sh <IN >OUT: a script or module without what a browser does not need: by esbuild, if it is there; otherwise
# without lines that are comments, a fifth larger.
set -eu
if command -v esbuild >/dev/null 2>&1; then
    esbuild --minify --log-level=warning
else
    sed '/^ *\/\/ /d'
fi
