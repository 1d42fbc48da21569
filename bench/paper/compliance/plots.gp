# Compliance against iterations, of whichever dimension was run. Run in the folder of the tables.
set terminal svg size 640,400 font "sans,12" background rgb "white"
set datafile separator ","
set key top right
set xlabel "iteration"
set ylabel "compliance"
set logscale y 2
set autoscale yfixmin
do for [d in "2d 3d"] {
  if (system("test -f adapted_".d.".csv && echo yes") eq "yes") {
    set output "history_".d.".svg"
    plot "uniform_".d.".csv" skip 1 using 1:4 with lines lw 2 lc rgb "#b0b0b0" title "uniform mesh", \
         "adapted_".d.".csv" skip 1 using 1:4 with lines lw 2 lc rgb "#1a2e52" title "adapted meshes"
  }
}
