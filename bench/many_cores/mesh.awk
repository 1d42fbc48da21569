# samples.csv of adapt_bench: medians of the seconds of the whole and of each kernel.
function add(name, column) {
  key = name (mode == "colours" ? " by colours" : "") "\t" $of["case"] "\t" $of["threads"]
  if (!(key in count)) keys[++lines] = key
  value[key, ++count[key]] = $of[column]
}
function median(key,    i, j, n, held) {
  n = count[key]
  for (i = 2; i <= n; ++i) {
    held = value[key, i]
    for (j = i - 1; j >= 1 && value[key, j] > held; --j) value[key, j + 1] = value[key, j]
    value[key, j + 1] = held
  }
  return n % 2 ? value[key, (n + 1) / 2] : (value[key, n / 2] + value[key, n / 2 + 1]) / 2
}
NR == 1 { for (i = 1; i <= NF; ++i) of[$i] = i; next }
{
  mode = $of["mode"]
  wrong = $of["valid"] + 0 == 1 || $of["valid"] == "true" ? "" : ", NOT VALID"
  add("adaptation" wrong, "total_s")
  add("adaptation, coarsen", "coarsen_s")
  add("adaptation, smooth", "smooth_s")
  if (mode == "tiles") { add("adaptation, refine", "refine_s"); add("adaptation, swap", "swap_s") }
}
END { for (i = 1; i <= lines; ++i) print keys[i] "\t" median(keys[i]) "\t-" }
