# Whole seconds of the processors that a shell's children have taken, out of what `times` prints: "1m2.34s 0m0.56s",
# its second line.
NR == 2 {
    split($1 "m" $2, part, /[ms]+/)
    print int(part[1] * 60 + part[2] + part[3] * 60 + part[4])
}
