# Kernels against threads, shares of kernels, phases, and Mmg. Run in the folder of the tables.
set terminal svg size 900,400 noenhanced font "sans,12" background rgb "white"
set datafile separator ","
set style fill solid 0.8 border lc rgb "white"
present(file) = system("test -f '".file."' && echo yes") eq "yes"
names(pattern, prefix) = system("ls ".pattern." 2>/dev/null | sed 's/^".prefix."_//; s/.csv$//'")

# Kernels, renumbering and the total: as measured.
parts = "2 3 4 5 7 9"
part(i) = int(word(parts, i))
set linetype 6 lc rgb "black"
set key outside below horizontal
do for [name in names("measured_seconds_*.csv", "measured_seconds")] {
  set output "threads_".name.".svg"
  set multiplot layout 1,2 title name
  set xlabel "threads"
  set logscale x 2
  set xrange [0.9:*]
  do for [what in "seconds efficiency"] {
    measured = "measured_".what."_".name.".csv"
    if (what eq "seconds") {
      set logscale y
      set yrange [*:*]
      set ylabel "seconds"
    } else {
      unset logscale y
      set yrange [0:1.2]
      set ylabel "parallel efficiency"
    }
    plot for [i=1:words(parts)] measured using 1:(column(part(i))) \
           with linespoints lw 2 pt 7 ps 0.7 lt i title columnheader(part(i))
  }
  unset multiplot
  unset logscale
  set autoscale
}

set linetype 6 lc rgb "#0072b2"
set style data histograms
set style histogram rowstacked
set boxwidth 0.75
set key outside right top vertical invert
unset xlabel
set yrange [0:*]
if (present("shares.csv")) {
  set output "kernels.svg"
  set ylabel "% of the time"
  set xtics rotate by 20 right font ",9"
  plot for [k=2:8] "shares.csv" using k:xtic(1) title columnheader(k)
  set xtics norotate autojustify font ",12"
}
do for [name in names("phases_*.csv", "phases")] {
  set output "phases_".name.".svg"
  set title name
  set ylabel "seconds"
  plot for [k=2:7] "phases_".name.".csv" using k:xtic(1) title columnheader(k)
  unset title
}
if (present("ratios.csv")) {
  set output "pairs.svg"
  set style histogram clustered gap 1
  set ylabel "processor seconds"
  set logscale y
  set yrange [*:*]
  plot "ratios.csv" skip 1 using 3:xtic(1) title "Ductile", "" skip 1 using 4 title "Mmg"
}
