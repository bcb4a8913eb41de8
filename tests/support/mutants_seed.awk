# mutants_seed.awk SURVIVORS RESULTS: the table of tests/mutants_seed.sh. SURVIVORS is tests/survivors.txt: a
# line "FILE: CHANGE" for each mutant, and its reason in indented lines. RESULTS has a line for each mutant: the program
# that failed, "-" or, where none runs the line, "?"; operator, file, line, change.
BEGIN { FS = "\t" }
NR == FNR {
    if ($0 ~ /^[^# ]/) known[$0] = 1
    next
}
{
    split($3, path, "/")
    cell = path[2] SUBSEP $2
    rooms[path[2]]; operators[$2]
    all[cell]++; total++
    if ($1 !~ /^[-?]$/) {
        killed[cell]++; dead++
        next
    }
    key = $3 ": " $5
    listed += key in known
    lines[++survivors] = sprintf("  %s:%s %s%s%s", $3, $4, $5, $1 == "?" ? " (no test runs the line)" : "",
                                 key in known ? " (listed)" : "")
}
function row(name, cells,    o) {
    line = sprintf("%-8s", name)
    for (o = 1; o <= operator_count; o++) line = line sprintf(" %12s", cells[o])
    print line
}
END {
    operator_count = split("arithmetic compare constant order", operator, " ")
    room_count = split("core motion deform life stage gl noh", room, " ")
    print "killed of all, by room and operator:"
    row("", operator)
    for (r = 1; r <= room_count; r++) {
        if (!(room[r] in rooms)) continue
        for (o = 1; o <= operator_count; o++) {
            cell = room[r] SUBSEP operator[o]
            cells[o] = all[cell] ? killed[cell] + 0 " of " all[cell] : "-"
        }
        row(room[r], cells)
    }
    if (survivors) print "survivors:"
    for (i = 1; i <= survivors; i++) print lines[i]
    counted = total - listed
    share = counted ? 100 * dead / counted : 0
    printf "%d of %d killed (%.1f %%); without the %d in survivors.txt %.1f %%: at least 95 %% is required\n",
        dead, total, total ? 100 * dead / total : 0, listed, share
    few = share < 95 ? survivors - listed : 0
    printf "%d passed, %d failed, %d skipped\n", dead, few, survivors - few
    exit few > 0 || !dead
}
