#!/bin/sh
# The mask, the puppet, the arm and the head are valid glTF: npm's gltf-validator finds no errors and no warnings.
. "$(dirname "$0")/lib.sh"

name='what demo_assets writes is valid glTF'
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
validate() {
    NODE_PATH=$build/npm/node_modules node -e '
    const fs = require("fs"), validator = require("gltf-validator");
    validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1]))).then(report => {
        const { numErrors, numWarnings, messages } = report.issues;
        console.log(`${numErrors} errors, ${numWarnings} warnings`);
        for (const m of messages.slice(0, 20)) console.log(`${m.severity} ${m.code} ${m.pointer}: ${m.message}`);
        process.exit(numErrors + numWarnings === 0 ? 0 : 1);
    });' "$1" >"$work/report" 2>&1
    result=$?
    sed 's/^/# /' "$work/report"
    check "$2" test $result = 0
}

validate "$build/mask.glb" 'the mask is valid glTF'
validate "$build/demo/puppet.glb" 'the puppet is valid glTF'
validate "$build/demo/arm.glb" 'the arm is valid glTF'
validate "$build/demo/nell.glb" 'the head is valid glTF'
finish
