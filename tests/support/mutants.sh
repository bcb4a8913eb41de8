# mutants.sh: what tests/mutants.sh and tests/mutants_seed.sh share. They source it in the tree's folder.
#
# Sets build, tree, tab and jobs, and exports what tests read. The caller sets work, the folder of its copies, which is
# removed at the end; `copy` and `mutants_of NUMBER` are functions of the caller.
build=${NOH_BUILD:-build}
build=${build#"$PWD"/}
case $build in /* | *..*) echo "${0##*/}: NOH_BUILD has to be a folder inside $PWD"; exit 1 ;; esac
case ${NOH_ASSETS:-} in '' | /*) ;; *) NOH_ASSETS=$PWD/$NOH_ASSETS ;; esac
export NOH_ASSETS="${NOH_ASSETS:-}" NOH_SAN='' CMOCKA_MESSAGE_OUTPUT=TAP NOH_GL_DEBUG=1 CC="${CC:-gcc}"
[ -n "${NOH_ANGLE:-}" ] || [ ! -f "$build/angle/libGLESv2.so" ] || export NOH_ANGLE="$PWD/$build/angle"
jobs=${JOBS:-$(nproc 2>/dev/null || echo 2)}
tree=$PWD work='' workers='' child=''
tab=$(printf '\t')
unset MAKEFLAGS MFLAGS MAKELEVEL

clean() {
    trap - EXIT
    # shellcheck disable=SC2086 # numbers
    [ -z "$workers$child" ] || { kill $workers $child; wait; } 2>/dev/null
    [ -z "$work" ] || rm -rf "$work"
}
trap clean EXIT
trap 'clean; exit 130' INT TERM HUP

# Runs a program in the background, so that a signal reaches it: timeout ends all its processes.
limited() { # SECONDS COMMAND...: of the processor for a process, eight times as many by the clock, files of 200 MB
    (seconds=$1 && shift && ulimit -S -t "$seconds" && ulimit -S -c 0 && ulimit -S -f 400000 &&
        exec timeout -k 5 $((8 * seconds)) "$@") &
    child=$!
    wait $child
    status=$?
    child=
    return $status
}

copy_sources() { # FOLDER
    mkdir -p "$1/$build"
    for file in *; do
        case $file in build*) ;; *) cp -pR "$file" "$1/" ;; esac
    done
}

worker() { # NUMBER
    trap 'kill $child 2>/dev/null; exit 1' TERM INT HUP
    trap - EXIT
    copy "$work/$1" || exit 1
    mutants_of "$1"
}

# Starts a worker for each of $jobs copies and gives `tell` each line that they print.
run_workers() {
    mkfifo "$work/results"
    n=0
    while [ $n -lt "$jobs" ]; do
        n=$((n + 1))
        worker $n >"$work/results" &
        workers="$workers $!"
    done
    while IFS= read -r line; do
        tell "$line"
    done <"$work/results"
    for worker in $workers; do
        wait "$worker" || { echo "${0##*/}: a worker failed" && exit 1; }
    done
    workers=
}
