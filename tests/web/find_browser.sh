# find_browser.sh, to be sourced. find_browser FOLDER PACKAGE... sets $chromium, and NODE_PATH so that node finds the
# npm packages; missing packages are installed into FOLDER. find_packages only sets NODE_PATH. If something is not
# available, leave_out is called with the reason.
find_browser() {
    chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || leave_out 'no chromium here'
    find_packages "$@"
}
find_packages() {
    command -v node >/dev/null 2>&1 || leave_out 'no node here'
    folder=$1
    shift
    mkdir -p "$folder"
    export NODE_PATH="$folder/node_modules${NODE_PATH:+:$NODE_PATH}"
    for package in "$@"; do
        is_there "$package" || (cd "$folder" && npm install --prefix . --no-save --silent "$@" >/dev/null 2>&1)
        is_there "$package" || leave_out "the npm package $package cannot be had here"
    done
}
is_there() { node -e "try { require.resolve('$1') } catch { require.resolve('$1/package.json') }" 2>/dev/null; } # types have no program
