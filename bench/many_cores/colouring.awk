# Google Benchmark's JSON, a line for each member: names are "colouring/GRAPH/ductile.METHOD/threads:N/...".
function add(seconds,    part, method, threads) {
  if (split(name, part, "/") < 4) return
  method = substr(part[3], index(part[3], ".") + 1)
  threads = substr(part[4], index(part[4], ":") + 1)
  if (method == "serial") { serial[part[2]] = seconds; return }
  graph[++lines] = part[2]
  line[lines] = "colouring, " method "\t" part[2] "\t" threads "\t" seconds
}
BEGIN { FS = "\""; in_seconds["ns"] = 1e-9; in_seconds["us"] = 1e-6; in_seconds["ms"] = 1e-3; in_seconds["s"] = 1 }
$2 == "name" { name = $4 }
$2 == "real_time" { time = $3; gsub(/[:, ]/, "", time) }
$2 == "time_unit" { add(time * in_seconds[$4]) }
END { for (i = 1; i <= lines; ++i) print line[i] "\t" (graph[i] in serial ? serial[graph[i]] : "-") }
