# table.awk: table.txt, then lines "GPU NAME STAGE COST THREADS REGISTERS SPILLS:FILLS". With update=1 it prints the
# table with these figures, else what is worse. A field of the table: COST/THREADS/REGISTERS, and :SPILLS:FILLS if there
# are any; -: not measured, and not compared.
function read_field(text, to,   part) {
    split(text, part, /[\/:]/)
    to["cost"] = part[1]; to["threads"] = part[2]; to["spills"] = part[4] + 0; to["fills"] = part[5] + 0
}
BEGIN { limit = 1.03 }
FNR == NR && /^#/ { if (update) print; next }
FNR == NR && $1 == "program" { for (i = 3; i <= NF; i++) gpus[++gpu_count] = $i; next }
FNR == NR {
    for (i = 3; i <= NF; i++) old[$1, $2, gpus[i - 2]] = $i
    if (!seen[$1, $2]++) rows[++row_count] = $1 " " $2
    next
}
$3 == "failed" { print $1 ": " $2 " does not compile" >"/dev/stderr"; failed++; next }
$3 == "missing" { print $1 ": " $2 " has no figure: the compiler stopped before it" >"/dev/stderr"; failed++; next }
$3 == "skipped" { skipped++; next }
{
    new[$2, $3, $1] = $4 "/" $5 "/" $6 ($7 == "0:0" ? "" : ":" $7)
    if (!known[$2, $3]++) fresh[++fresh_count] = $2 " " $3
    if (!($1 in is_gpu)) { is_gpu[$1] = 1; if (!gpu_count) first_gpus[++first_count] = $1 }
}
# 1: worse; -1: there is nothing to compare with.
function compare(name, stage, gpu,   was, is, what) {
    if (!((name, stage, gpu) in old) || old[name, stage, gpu] == "-") {
        unknown++
        return -1
    }
    read_field(old[name, stage, gpu], was)
    read_field(new[name, stage, gpu], is)
    what = is["spills"] > was["spills"] || is["fills"] > was["fills"] ? "spills" : \
           is["cost"] > was["cost"] * limit ? "costs more" : is["threads"] < was["threads"] ? "has fewer threads" : ""
    if (what != "") print gpu ": " name " " stage " " what ": " new[name, stage, gpu] ", was " old[name, stage, gpu]
    return what != ""
}
END {
    if (!gpu_count) for (i = 1; i <= first_count; i++) gpus[++gpu_count] = first_gpus[i]
    if (!update) {
        for (i = 1; i <= fresh_count; i++) {
            split(fresh[i], word, " ")
            for (g = 1; g <= gpu_count; g++) {
                if (!((word[1], word[2], gpus[g]) in new)) continue
                worse = compare(word[1], word[2], gpus[g])
                if (worse > 0) failed++
                if (worse == 0) passed++
            }
        }
        if (unknown) print unknown " figures have none in the table to compare with: make phones-update"
        skipped += unknown
        printf "%d passed, %d failed, %d skipped\n", passed, failed, skipped
        exit failed > 0
    }
    line = sprintf("%-22s %-8s", "program", "stage")
    for (g = 1; g <= gpu_count; g++) line = line sprintf(" %14s", gpus[g])
    print line
    for (i = 1; i <= fresh_count; i++) {
        split(fresh[i], word, " ")
        line = sprintf("%-22s %-8s", word[1], word[2])
        for (g = 1; g <= gpu_count; g++) {
            key = word[1] SUBSEP word[2] SUBSEP gpus[g]
            line = line sprintf(" %14s", key in new ? new[key] : key in old ? old[key] : "-")
        }
        print line
    }
    exit failed > 0
}
