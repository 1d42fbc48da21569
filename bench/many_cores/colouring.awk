# Google Benchmark's CSV: names are "colouring/GRAPH/ductile.METHOD/threads:N/real_time", times as said.
function seconds() { return $3 * ($5 == "ns" ? 1e-9 : $5 == "us" ? 1e-6 : $5 == "ms" ? 1e-3 : 1) }
/^"?colouring\// {
  gsub(/"/, "", $1)
  split($1, part, "/")
  method = substr(part[3], index(part[3], ".") + 1)
  threads = substr(part[4], index(part[4], ":") + 1)
  if (method == "serial") serial[part[2]] = seconds()
  else { ++lines; graph[lines] = part[2]; line[lines] = "colouring, " method "\t" part[2] "\t" threads "\t" seconds() }
}
END { for (i = 1; i <= lines; ++i) print line[i] "\t" (graph[i] in serial ? serial[graph[i]] : "-") }
