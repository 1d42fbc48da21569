# Lines "what, input, threads, seconds, serial", between tabs, sorted, become a Markdown table; serial may be "-".
function row(    i, count, line, last) {
  if (what == "") return
  line = "| " what " | " input " | " serial " | " (1 in of ? shown(of[1]) : "-") " |"
  for (i = 2; i <= n; ++i) {
    count = counts[i]
    line = line (count in of && 1 in of ? sprintf(" %.2f |", of[1] / of[count]) : " - |")
  }
  last = counts[n]
  print line (n > 1 && last in of && 1 in of ? sprintf(" %.2f |", of[1] / of[last] / last) : " - |")
}
function shown(seconds) { return sprintf("%.3g", seconds) }
BEGIN {
  FS = "\t"
  n = split(threads, counts, ",")
  line = "| what | input | serial, s | 1 thread, s |"
  rule = "|---|---|---|---|"
  for (i = 2; i <= n; ++i) { line = line " " counts[i] " |"; rule = rule "---|" }
  print line " efficiency |"
  print rule "---|"
}
$1 != what || $2 != input { row(); what = $1; input = $2; serial = "-"; delete of }
{ of[$3] = $4; if ($5 != "-") serial = shown($5) }
END { row() }
