# techniques.awk: the rows of the tables of techniques in tests/README.md, one a line, by tabs:
# code, test, mutant, command, what the row is. A table without the column of mutants has an empty one.
BEGIN { FS = " *[|] *" }
(NF == 7 || NF == 8) && $2 != "source" && $2 !~ /^-+$/ {
    gsub("`", "")
    print $4 "\t" $5 "\t" (NF == 8 ? $6 : "?") "\t" $(NF - 1) "\t" $2 ": " $3
}
