# Lines "SECONDS NAME", the longest first: their sum and the names of the longest. -v most=N: N of them at most.
{ all += $1 }
NR <= most && $1 > 4 { longest = longest sprintf("%s%s %d", longest == "" ? "" : ", ", $2, $1) }
END { printf "seconds of processors: %d%s\n", all, longest == "" ? "" : "; of them " longest }
