#!/bin/sh
# The mask is valid glTF: npm's gltf-validator has no error to tell.
. "$(dirname "$0")/lib.sh"

name='the mask is valid glTF'
if ! command -v npm >/dev/null 2>&1 || ! command -v node >/dev/null 2>&1; then
    skip "$name" 'no npm here'
    finish
fi
if [ ! -d "$build/npm/node_modules/gltf-validator" ]; then
    mkdir -p "$build/npm"
    if ! npm install --prefix "$build/npm" --no-audit --no-fund --loglevel=error gltf-validator >"$work/npm" 2>&1; then
        skip "$name" 'npm could not install gltf-validator (no network?)'
        finish
    fi
fi
NODE_PATH=$build/npm/node_modules node -e '
    const fs = require("fs"), validator = require("gltf-validator");
    validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1]))).then(report => {
        const { numErrors, numWarnings, messages } = report.issues;
        console.log(`${numErrors} errors, ${numWarnings} warnings`);
        for (const m of messages.slice(0, 20)) console.log(`${m.severity} ${m.code} ${m.pointer}: ${m.message}`);
        process.exit(numErrors === 0 ? 0 : 1);
    });' "$build/mask.glb" >"$work/report" 2>&1
result=$?
sed 's/^/# /' "$work/report"
check "$name" test $result = 0
finish
