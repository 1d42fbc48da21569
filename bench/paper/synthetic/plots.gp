# Kernels against threads, errors against elements. Run in the folder of the tables.
set terminal svg size 900,380 font "sans,12" background rgb "white"
set datafile separator ","
present(file) = system("test -f ".file." && echo yes") eq "yes"
do for [d in "2d 3d"] {
  if (present("seconds_".d.".csv")) {
    set output "kernels_".d.".svg"
    set multiplot layout 1,2
    set xlabel "threads"
    set logscale x 2
    set xrange [0.9:*]
    set yrange [0:*]
    set ylabel "seconds per step"
    set key outside below horizontal
    plot for [k=2:5] "seconds_".d.".csv" using 1:k with linespoints lw 2 pt 7 title columnheader(k)
    set yrange [0:1.2]
    set ylabel "parallel efficiency"
    plot for [k=2:5] "efficiency_".d.".csv" using 1:k with linespoints lw 2 pt 7 title columnheader(k), \
         1 with lines dt 2 lc rgb "black" title "ideal"
    unset multiplot
    set autoscale
  }
  if (present("errors_".d.".csv")) {
    set output "errors_".d.".svg"
    first(column) = real(system("sed -n 2p errors_".d.".csv | cut -d, -f".column))
    rate = d eq "2d" ? -1.0 : -2.0 / 3
    set logscale xy
    set xlabel "elements"
    set ylabel "interpolation error"
    set key inside vertical bottom left
    plot "errors_".d.".csv" skip 1 using 1:2 with linespoints lw 2 pt 7 title "L2 beside the jump", \
         "" skip 1 using 1:4 with linespoints lw 2 pt 7 title "L1 everywhere", \
         (x < first(1) ? NaN : first(2) * (x / first(1))**rate) with lines dt 2 lc rgb "black" title "elements^{-2/d}"
    unset logscale
  }
}
