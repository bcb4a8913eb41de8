# figures.awk: reads what link.c prints of a GPU and writes FOLDER/HASH for each program, a line for each stage:
#   STAGE COST THREADS REGISTERS SPILLS:FILLS
# cost: cycles a pixel or vertex of one core (Mali), else instructions; registers: 0, not reported.
BEGIN {
    while ((getline line <hashes) > 0) {
        split(line, word)
        hash_of[word[1]] = word[2]
    }
    split("POSITION position VARYING varying FRAGMENT fragment VERTEX_BIN position VERTEX varying BVERT position " \
          "VERT varying FRAG fragment GEOMETRY geometry GEOMETRY_BIN binning GEOM geometry", names)
    for (i = 1; i in names; i += 2) stage_of[names[i]] = names[i + 1]
}
# The number before a word.
function before(word,   at) {
    return match($0, "[0-9.]+ " word) ? substr($0, RSTART, RLENGTH - length(word) - 1) + 0 : 0
}
function finish(   out, stage) {
    if (name == "") return
    out = folder "/" hash_of[name]
    printf "" >out
    for (stage in row) print stage, row[stage] >out
    close(out)
    delete row
    name = ""
}
/^begin / { finish(); name = $2; next }
/^skip / { finish(); name = $2; row["skipped"] = "0 0 0 0:0"; next }
/^fail / { row["failed"] = "0 0 0 0:0"; print "phones: " $0 >"/dev/stderr"; next }
/^end/ { finish(); next }
/ shader: / {
    stage = $1
    sub(/^MESA_SHADER_/, "", stage)
    if (!(stage in stage_of) || name == "") next
    is_mali = /cycles/
    registers = before(/max-temps/ ? "max-temps" : "full")
    threads = before(/waves/ ? "waves" : "threads")
    spills = before("stp") ":" before("ldp")
    if (match($0, /[0-9]+:[0-9]+ spills:fills/)) spills = substr($0, RSTART, RLENGTH - 13)
    row[stage_of[stage]] = sprintf("%.5g %d %d %s", before(is_mali ? "cycles" : "inst"), threads, registers, spills)
}
