# find_browser.sh, to be sourced. find_browser FOLDER PACKAGE... sets $chromium, and NODE_PATH so that node finds the npm
# packages; those that are missing are installed into FOLDER. If something cannot be had, it calls leave_out with the
# reason.
find_browser() {
    command -v node >/dev/null 2>&1 || leave_out 'no node here'
    chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || leave_out 'no chromium here'
    folder=$1
    shift
    mkdir -p "$folder"
    export NODE_PATH="$folder/node_modules${NODE_PATH:+:$NODE_PATH}"
    for package in "$@"; do
        node -e "require.resolve('$package')" 2>/dev/null || (cd "$folder" && npm install --no-save --silent "$@" >/dev/null 2>&1)
        node -e "require.resolve('$package')" 2>/dev/null || leave_out "the npm package $package cannot be had here"
    done
}
